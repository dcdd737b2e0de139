// What runs over CAN lines in words, whatever is spoken there: MOVILINK and variable telegrams, CANopen, or both on
// one line. Each line is listened to by itself, since a CANopen node is known by what was written to it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/canopen/words.hpp"
#include "runtime/bus/movilink/describe.hpp"

namespace ipos::runtime {

struct CanLineNames {
  TelegramNames movilink;
  std::vector<canopen::NodeName> nodes;
};

struct CanNames {
  CanLineNames all;                           // of lines that are not known by name
  std::map<std::string, CanLineNames> lines;  // by name
  bool canopen = false;                       // nodes may be there that are not known
};

// What an identifier of a line is for: "TPDO1 of saw", "PO of feed", "object of saw"; empty when nobody knows.
std::string identifier_text(const CanLineNames& names, bool canopen, uint32_t id);

// One line, listened to from its beginning.
class CanLineWords {
 public:
  // `unknown_nodes`: some may be there that have no name.
  explicit CanLineWords(CanLineNames names, bool unknown_nodes = false);

  // Of the next frame on the line. Where MOVILINK and CANopen share it, what concerns a known unit is MOVILINK.
  Description describe(const Frame& frame);
  // Whether its words are those of CANopen: then they depend on what went before.
  bool is_canopen(const Frame& frame) const { return canopen_ && !concerns(names_.movilink, frame); }

  // The same for a frame whose words nobody wants: what it says of nodes is kept.
  void listen(const Frame& frame) {
    if (is_canopen(frame)) canopen_->listen(frame);
  }

  // Others from now on; what was heard of nodes stays.
  void use(CanLineNames names);

 private:
  CanLineNames names_;
  std::optional<canopen::LineWords> canopen_;  // nothing: no node is there
};

class CanWords {
 public:
  explicit CanWords(CanNames names = {}) : names_(std::make_shared<CanNames>(std::move(names))) {}

  // Of the next frame on the line.
  Description describe(std::string_view line, const Frame& frame) { return listened(line).describe(frame); }
  void listen(std::string_view line, const Frame& frame) { listened(line).listen(frame); }
  // Others from now on; what was heard of nodes stays.
  void use(CanNames names);
  const CanNames& names() const { return *names_; }

 private:
  const CanLineNames& names_of(const std::string& line) const;
  CanLineWords& listened(std::string_view line);

  std::shared_ptr<const CanNames> names_;
  std::map<std::string, CanLineWords, std::less<>> lines_;
};

}  // namespace ipos::runtime

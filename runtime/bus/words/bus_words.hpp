// What runs over the lines of a plant in words, of every kind of line: the one decoder that `ipos bus decode`, the
// monitor, the page and the reports of tests ask. A front end fills the names (bus_plan/names.hpp) and hands over what
// it sees, in the order in which it came.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/bus/words/can_words.hpp"
#include "runtime/bus/words/dp_words.hpp"

namespace ipos::runtime {

struct BusNames {
  CanNames can;
  TelegramNames serial;  // P810 as address, P811 as group
  DpNames dp{};
};

class BusWords {
 public:
  explicit BusWords(BusNames names = {});

  // Others from now on; what was heard of nodes stays.
  void use(BusNames names);

  // Of the next frame on the line: words of CANopen depend on what went before.
  Description describe(std::string_view line, const Frame& frame) { return can_.describe(line, frame); }
  // The same for a frame whose words nobody wants: it costs next to nothing.
  void listen(std::string_view line, const Frame& frame) { can_.listen(line, frame); }

  // A telegram, or why there is none and its bytes.
  std::string describe(const Reception& reception) const;
  // Of the next frame on the line: how process data are divided was said before.
  std::string describe(std::string_view line, const profibus::Reception& reception) { return listened(line).describe(reception); }

  const CanNames& can_names() const { return can_.names(); }
  const TelegramNames& serial_names() const { return serial_; }

 private:
  DpLineWords& listened(std::string_view line);
  const std::vector<DpSlaveNames>& slaves_of(std::string_view line) const;

  CanWords can_;
  TelegramNames serial_;
  DpNames dp_;
  std::map<std::string, DpLineWords, std::less<>> dp_lines_;
};

}  // namespace ipos::runtime

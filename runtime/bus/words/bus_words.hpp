// What runs over the lines of a plant in words, of every kind of line: the one decoder that `ipos bus decode`, the
// monitor, the page and the reports of tests ask. A front end fills the names (bus_plan/names.hpp) and hands over what
// it sees, in the order in which it came.
#pragma once

#include <string>
#include <string_view>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/bus/words/can_words.hpp"

namespace ipos::runtime {

struct BusNames {
  CanNames can;
  TelegramNames serial;  // P810 as address, P811 as group
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
  std::string describe(const profibus::Reception& reception) const;

  const CanNames& can_names() const { return can_.names(); }
  const TelegramNames& serial_names() const { return serial_; }

 private:
  CanWords can_;
  TelegramNames serial_;
};

}  // namespace ipos::runtime

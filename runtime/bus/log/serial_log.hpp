// The log of RS-485 lines (format ours): one telegram a line with begin and end in seconds of virtual time,
// line, bytes and meaning; what was not a telegram with the bytes up to the error and the reason.
//
//   0.003455 0.014913 line1 02 01 05 00 06 3A 98 01 F4 57 | request to 1, 3PD cyclic, PO 0006 3A98 01F4
#pragma once

#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/bus/log/candump.hpp"
#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/node.hpp"

namespace ipos::runtime {

// What a telegram says, or why it is void.
std::string reception_text(const Reception& reception);

// "0.003455"
std::string serial_time_text(Time time);

// One line without line end.
std::string serial_log_line(std::string_view line, const Reception& reception);

class SerialLog final : public SerialObserver {
 public:
  explicit SerialLog(std::ostream& out) : out_(out) {}

  void on_character(const Rs485Line& line, NodeId sender, const Character& character) override;
  void on_serial_event(const Rs485Line&, const SerialEvent&) override {}

  // At the end of a run: telegrams that were not completed.
  void finish();

 private:
  std::ostream& out_;
  std::map<std::string, SerialReceiver, std::less<>> receivers_;  // by line
};

// A line of the log, or a bare telegram: its bytes in hexadecimal, "02 01 05 00 06 3A 98 01 F4 57".
struct SerialEntry {
  std::optional<Time> time;  // begin; a bare telegram has none, and no line
  std::string line;
  Reception reception{tl::unexpected(SerialError::Start), {}, 0, 0};
};

// It begins like one of these: with a digit or a byte. A line of a candump log begins with '('.
bool is_serial_line(std::string_view text);
tl::expected<SerialEntry, LogError> parse_serial_line(std::string_view text, size_t line = 1);

}  // namespace ipos::runtime

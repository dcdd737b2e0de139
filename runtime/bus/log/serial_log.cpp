// Writes what the receivers make of the characters.
#include "runtime/bus/log/serial_log.hpp"

#include <fmt/format.h>

#include <ostream>

#include "runtime/bus/rs485/line.hpp"

namespace ipos::runtime {

std::string serial_time_text(Time time) {
  return fmt::format("{}.{:06d}", time / kSecond, time % kSecond / kMicrosecond);
}

std::string reception_text(const Reception& reception) {
  return reception.telegram ? describe(*reception.telegram)
                            : "void: " + std::string(serial_error_text(reception.telegram.error()));
}

std::string serial_log_line(std::string_view line, const Reception& reception) {
  return fmt::format("{} {} {} {:02X} | {}", serial_time_text(reception.start),
                     serial_time_text(reception.end), line, fmt::join(reception.bytes.span(), " "),
                     reception_text(reception));
}

void SerialLog::on_character(const Rs485Line& line, NodeId /*sender*/, const Character& character) {
  if (const auto reception = receivers_[line.name()].take(character))
    out_ << serial_log_line(line.name(), *reception) << '\n';
}

void SerialLog::finish() {
  for (auto& [name, receiver] : receivers_)
    if (const auto reception = receiver.give_up()) out_ << serial_log_line(name, *reception) << '\n';
}

}  // namespace ipos::runtime

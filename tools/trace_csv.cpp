// CSV after RFC 4180, but with plain line ends.
#include "tools/trace_csv.hpp"

#include <fmt/format.h>

namespace ipos::tools {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

void write_csv(std::ostream& out, const Recording& recording) {
  out << "time_ms";
  for (const Signal& signal : recording.signals)
    out << ',' << field(signal.unit.empty() ? signal.name : fmt::format("{} [{}]", signal.name, signal.unit));
  out << '\n';
  for (size_t row = 0; row < recording.times.size(); ++row) {
    out << recording.times[row] / runtime::kMillisecond;
    for (size_t n = 0; n < recording.signals.size(); ++n)
      out << ',' << recording.signals[n].text(recording.samples[n][row]);
    out << '\n';
  }
}

}  // namespace ipos::tools

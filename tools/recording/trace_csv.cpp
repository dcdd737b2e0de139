// CSV after RFC 4180, but with plain line ends.
#include "tools/recording/trace.hpp"

#include <fmt/format.h>

namespace ipos::tools {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// candump's "40A#8006", or the bytes of a telegram.
std::string bytes_text(const Recording& recording, const RecordedFrame& frame) {
  return recording.tracks[frame.track].is_can ? frame.text
                                              : fmt::format("{:02X}", fmt::join(frame.bytes, " "));
}

}  // namespace

void write_csv(std::ostream& out, const Recording& recording) {
  out << "time_ms";
  for (const Signal& signal : recording.signals)
    out << ',' << field(signal.unit.empty() ? signal.name : fmt::format("{} [{}]", signal.name, signal.unit));
  for (const FrameTrack& track : recording.tracks) out << ',' << field(track.bus + ".frames");
  out << '\n';
  auto frame = recording.frames.begin();
  for (size_t row = 0; row < recording.times.size(); ++row) {
    out << recording.times[row] / runtime::kMillisecond;
    for (size_t n = 0; n < recording.signals.size(); ++n)
      out << ',' << recording.signals[n].text(recording.samples[n][row]);
    std::vector<std::string> frames(recording.tracks.size());
    for (; frame != recording.frames.end() && frame->time <= recording.times[row]; ++frame)
      frames[frame->track] += (frames[frame->track].empty() ? "" : "; ") + bytes_text(recording, *frame);
    for (const std::string& text : frames) out << ',' << text;
    out << '\n';
  }
}

}  // namespace ipos::tools

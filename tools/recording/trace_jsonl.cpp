// Of equal times frames come first, then events, then samples: a sample is what all before has led to.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "tools/recording/trace.hpp"

namespace ipos::tools {
namespace {

std::string in_quotes(const std::string& text) {
  return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

// Milliseconds, exact to the nanosecond.
std::string time_text(runtime::Time time) {
  std::string text = fmt::format("{}", time / runtime::kMillisecond);
  if (const runtime::Time rest = time % runtime::kMillisecond; rest != 0) {
    text += fmt::format(".{:06}", rest);
    while (text.back() == '0') text.pop_back();
  }
  return text;
}

std::string frame_text(const FrameTrack& track, const RecordedFrame& frame) {
  std::string line = fmt::format("{{\"time_ms\":{},\"frame\":{}", time_text(frame.time), in_quotes(track.bus));
  if (track.is_can)
    line += fmt::format(",\"id\":{},\"extended\":{},\"remote\":{}", frame.id, frame.extended, frame.remote);
  line += fmt::format(",\"data\":\"{:02X}\"", fmt::join(frame.bytes, ""));
  if (!track.is_can) line += fmt::format(",\"text\":{}", in_quotes(frame.text));
  return line + "}\n";
}

}  // namespace

void write_jsonl(std::ostream& out, const Recording& recording) {
  for (const Signal& signal : recording.signals)
    out << fmt::format("{{\"signal\":{},\"unit\":{}}}\n", in_quotes(signal.name), in_quotes(signal.unit));
  auto frame = recording.frames.begin();
  auto event = recording.events.begin();
  const auto write_until = [&](runtime::Time time) {
    for (; frame != recording.frames.end() && frame->time <= time; ++frame)
      out << frame_text(recording.tracks[frame->track], *frame);
    for (; event != recording.events.end() && event->time <= time; ++event)
      out << fmt::format("{{\"time_ms\":{},\"event\":{},\"fault\":{}}}\n", time_text(event->time),
                         in_quotes(event->text), event->is_fault);
  };
  for (size_t row = 0; row < recording.times.size(); ++row) {
    write_until(recording.times[row]);
    for (size_t n = 0; n < recording.signals.size(); ++n) {
      const std::vector<int64_t>& samples = recording.samples[n];
      if (row != 0 && samples[row] == samples[row - 1]) continue;
      out << fmt::format("{{\"time_ms\":{},\"signal\":{},\"value\":{}}}\n", time_text(recording.times[row]),
                         in_quotes(recording.signals[n].name), recording.signals[n].text(samples[row]));
    }
  }
  write_until(runtime::kNever);
}

}  // namespace ipos::tools

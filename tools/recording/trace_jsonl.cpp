// Of equal times frames come first, then events, then samples: a sample is what all before has led to.
#include <fmt/format.h>

#include <iterator>
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
  std::string line =
      fmt::format("{{\"time_ms\":{},\"frame\":{}", time_text(frame.time), in_quotes(track.bus));
  if (track.is_can)
    line += fmt::format(",\"id\":{},\"extended\":{},\"remote\":{}", frame.id, frame.extended, frame.remote);
  line += fmt::format(",\"data\":\"{:02X}\"", fmt::join(frame.bytes, ""));
  if (!track.is_can) line += fmt::format(",\"text\":{}", in_quotes(frame.text));
  return line + "}\n";
}

class JsonlTrace final : public TraceWriter {
 public:
  JsonlTrace(std::ostream& out, const std::vector<Signal>& signals, const std::vector<FrameTrack>& tracks)
      : out_(out), signals_(signals), tracks_(tracks) {
    for (const Signal& signal : signals) {
      const std::string name = in_quotes(signal.name);
      text_ += fmt::format("{{\"signal\":{},\"unit\":{}}}\n", name, in_quotes(signal.unit));
      middles_.push_back(fmt::format(",\"signal\":{},\"value\":", name));
    }
    give();
  }

  void take(const RecordedPart& part) override {
    const std::vector<Change>& changes = by_row_.of(part);
    auto change = changes.begin();
    auto frame = part.frames.begin();
    auto event = part.events.begin();
    const auto write_until = [&](runtime::Time time) {
      for (; frame != part.frames.end() && frame->time <= time; ++frame)
        text_ += frame_text(tracks_[frame->track], *frame);
      for (; event != part.events.end() && event->time <= time; ++event)
        text_ += fmt::format("{{\"time_ms\":{},\"event\":{},\"fault\":{}}}\n", time_text(event->time),
                             in_quotes(event->text), event->is_fault);
    };
    for (size_t row = 0; row < part.times.size(); ++row) {
      write_until(part.times[row]);
      if (change == changes.end() || change->row != row) continue;
      const std::string begin = "{\"time_ms\":" + time_text(part.times[row]);
      for (; change != changes.end() && change->row == row; ++change) {
        text_.append(begin).append(middles_[change->signal]);
        signals_[change->signal].append_text(text_, change->sample);
        text_ += "}\n";
      }
    }
    write_until(runtime::kNever);
    give();
  }

 private:
  void give() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& out_;
  const std::vector<Signal>& signals_;
  const std::vector<FrameTrack>& tracks_;
  std::vector<std::string> middles_;  // of the lines, as the signals
  std::string text_;                  // of this part
  ByRow by_row_;
};

}  // namespace

std::unique_ptr<TraceWriter> jsonl_trace(std::ostream& out, const std::vector<Signal>& signals,
                                         const std::vector<FrameTrack>& tracks) {
  return std::make_unique<JsonlTrace>(out, signals, tracks);
}

}  // namespace ipos::tools

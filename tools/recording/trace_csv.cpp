// CSV after RFC 4180, but with plain line ends.
#include <fmt/format.h>

#include <utility>

#include "tools/recording/trace.hpp"

namespace ipos::tools {
namespace {

std::string field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// A value keeps its text until it changes, and so does a whole row without its time.
class CsvTrace final : public TraceWriter {
 public:
  CsvTrace(std::ostream& out, const std::vector<Signal>& signals, const std::vector<FrameTrack>& tracks)
      : out_(out), signals_(signals), tracks_(tracks), cells_(signals.size()), frames_(tracks.size()) {
    text_ = "time_ms";
    for (const Signal& signal : signals)
      text_ +=
          "," + field(signal.unit.empty() ? signal.name : fmt::format("{} [{}]", signal.name, signal.unit));
    for (const FrameTrack& track : tracks) text_ += "," + field(track.bus + ".frames");
    text_ += '\n';
    give();
    make_row();
  }

  void take(const RecordedPart& part) override {
    const std::vector<Change>& changes = by_row_.of(part);
    auto change = changes.begin();
    auto frame = part.frames.begin();
    for (size_t row = 0; row < part.times.size(); ++row) {
      const auto first = change;
      for (; change != changes.end() && change->row == row; ++change) {
        cells_[change->signal].clear();
        signals_[change->signal].append_text(cells_[change->signal], change->sample);
      }
      const bool had_frames = std::exchange(has_frames_, false);
      for (; frame != part.frames.end() && frame->time <= part.times[row]; ++frame) add(*frame);
      if (change != first || has_frames_ || had_frames) make_row();
      text_ += fmt::to_string(part.times[row] / runtime::kMillisecond);
      text_ += row_;
    }
    give();
  }

 private:
  // candump's "40A#8006", or the bytes of a telegram.
  void add(const RecordedFrame& frame) {
    std::string& cell = frames_[frame.track];
    if (!cell.empty()) cell += "; ";
    cell += tracks_[frame.track].is_can ? frame.text : fmt::format("{:02X}", fmt::join(frame.bytes, " "));
    has_frames_ = true;
  }

  void make_row() {
    row_.clear();
    for (const std::string& cell : cells_) row_.append(1, ',').append(cell);
    for (std::string& frames : frames_) {
      row_.append(1, ',').append(frames);
      frames.clear();
    }
    row_ += '\n';
  }

  void give() {
    out_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
    text_.clear();
  }

  std::ostream& out_;
  const std::vector<Signal>& signals_;
  const std::vector<FrameTrack>& tracks_;
  std::vector<std::string> cells_;   // as the signals
  std::vector<std::string> frames_;  // of this row, as the tracks
  bool has_frames_ = false;          // there are some in this row
  std::string row_;                  // after the time
  std::string text_;                 // of this part
  ByRow by_row_;
};

}  // namespace

std::unique_ptr<TraceWriter> csv_trace(std::ostream& out, const std::vector<Signal>& signals,
                                       const std::vector<FrameTrack>& tracks) {
  return std::make_unique<CsvTrace>(out, signals, tracks);
}

void write_trace(TraceForm form, std::ostream& out, const Recording& recording) {
  const auto writer = form(out, recording.signals, recording.tracks);
  writer->take(part_of(recording));
  writer->finish();
}

}  // namespace ipos::tools

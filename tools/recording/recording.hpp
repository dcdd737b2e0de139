// What `ipos run --plot` and `--trace` record: chosen signals of the stations once a virtual millisecond, the
// frames of chosen buses, and what happened to the units meanwhile. It comes in parts, rows that follow each other: a
// trace is written part by part, and a plot keeps them all (Recording).
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "runtime/signals/find.hpp"

namespace ipos::tools {

using Signal = signals::Signal;

struct RecordedEvent {
  runtime::Time time;
  std::string text;  // "unit1: enable"
  bool is_fault;
};

struct FrameTrack {
  std::string bus;
  bool is_can = true;
};

struct RecordedFrame {
  runtime::Time time;  // of delivery
  size_t track;        // number of its bus among the tracks
  uint32_t id = 0;     // CAN
  bool extended = false, remote = false;
  std::vector<uint8_t> bytes;
  std::string text;  // CAN: as candump writes it, "40A#8006"; else what it says, or why it is void
};

struct Change {
  size_t row, signal;
  int64_t sample;
};

// Rows, and what happened since those of the part before. The last part may have no rows.
struct RecordedPart {
  std::vector<runtime::Time> times;   // of the rows
  std::vector<Change> changes;        // by signal, then row; the first row of all has every signal
  std::vector<RecordedEvent> events;  // in order of time
  std::vector<RecordedFrame> frames;  // in order of time
};

// The changes of a part by row, then signal, as texts want them. It keeps its memory from part to part.
class ByRow {
 public:
  const std::vector<Change>& of(const RecordedPart& part);

 private:
  std::vector<Change> changes_;
  std::vector<size_t> places_;  // of the changes of a row, from the row after it on
};

class PartReader {
 public:
  virtual ~PartReader() = default;
  virtual void take(const RecordedPart& part) = 0;
};

struct Recording {
  std::vector<Signal> signals;
  std::vector<runtime::Time> times;           // of the samples
  std::vector<std::vector<int64_t>> samples;  // one list a signal, as long as `times`
  std::vector<RecordedEvent> events;
  std::vector<FrameTrack> tracks;
  std::vector<RecordedFrame> frames;  // of the tracks, in order of time
};

// The whole as one part; and one part more.
RecordedPart part_of(const Recording& recording);
void add_part(Recording& recording, const RecordedPart& part);

// On or off: a plot shows it as a strip. Also a plain number that was only 0 and 1.
bool is_binary(const Recording& recording, size_t signal);

class Recorder final : private runtime::BusObserver {
 public:
  // Signals and patterns as find_signals() takes them, and "sbus1.frames": the frames of that bus. None:
  // speed, setpoint and status of every station that has them. A name that leads nowhere is a Failure that
  // lists what exists. Before the plant runs; each must outlive the other's part in the run.
  Recorder(runtime::Plant& plant, const std::vector<std::string>& names);
  ~Recorder();

  const std::vector<Signal>& signals() const { return recording_.signals; }
  const std::vector<FrameTrack>& tracks() const { return recording_.tracks; }

  // Before the run: who takes the parts as they come. Without `keep` recording() has none of them.
  void give_to(PartReader& reader, bool keep);

  // For Plant::run_until: takes a sample at whole milliseconds, after all that happened at that time.
  void sample(runtime::Time now);

  // At the end of a run: telegrams that were not completed, and the last part.
  void finish();

  // All there is by now.
  const Recording& recording();

 private:
  // The samples of a signal, or the condition of a station, as its changes since the last part.
  struct Point {
    runtime::Time time;
    int64_t sample;
  };
  struct Course {
    std::vector<Point> points;
    int64_t known = 0;  // in the last row of the part before
    int64_t last = 0;   // in the last one of `points`

    void note(runtime::Time time, int64_t sample) {
      if (sample == last) return;
      last = sample;
      points.push_back({time, sample});
    }
  };
  // What only a decision of the drive changes is not asked for every millisecond.
  class Decided;

  void add(const std::string& name);
  void add(Signal signal);
  bool add_frames(std::string_view name);
  std::optional<size_t> track_of(const std::string& bus) const;
  Decided& decided_of(runtime::Station& station);
  void gather(bool all);
  template <typename Take>
  void take_points(Course& course, const std::vector<runtime::Time>& rows, Take take);
  void take_changes(RecordedPart& part);
  void take_events(RecordedPart& part);
  void take_frames(RecordedPart& part, bool all);
  void on_message(const runtime::Bus& bus, const runtime::BusMessage& message) override;

  runtime::Plant& plant_;
  Recording recording_;  // what is kept of it
  PartReader* reader_ = nullptr;
  bool keeps_ = true;
  bool begun_ = false;                // there was a part with rows
  std::vector<runtime::Time> times_;  // of the next part
  std::deque<Course> courses_;        // as the signals
  std::vector<size_t> asked_;         // signals that are read every millisecond
  std::vector<std::unique_ptr<Decided>> decided_;
  std::vector<Decided*> watched_;      // whose conditions make events
  std::vector<RecordedFrame> frames_;  // of the next part, in order of time
  RecordedPart part_;                  // kept from part to part, so that its memory is
};

}  // namespace ipos::tools

// What `ipos run --plot` and `--trace` record: chosen signals of the stations once a virtual millisecond, the
// frames of chosen buses, and what happened to the units meanwhile. Plain data; the writers of its forms
// (trace, plot_svg) only read it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant_signals.hpp"

namespace ipos::tools {

using Signal = runtime::PlantSignal;

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
  size_t track;        // number of its bus in Recording::tracks
  uint32_t id = 0;     // CAN
  bool extended = false, remote = false;
  std::vector<uint8_t> bytes;
  std::string text;  // CAN: as candump writes it, "40A#8006"; else what it says, or why it is void
};

struct Recording {
  std::vector<Signal> signals;
  std::vector<runtime::Time> times;           // of the samples
  std::vector<std::vector<int64_t>> samples;  // one list a signal, as long as `times`
  std::vector<RecordedEvent> events;
  std::vector<FrameTrack> tracks;
  std::vector<RecordedFrame> frames;  // of the tracks, in order of time
};

// On or off: a plot shows it as a strip. Also a plain number that was only 0 and 1.
bool is_binary(const Recording& recording, size_t signal);

class Recorder final : private runtime::BusObserver {
 public:
  // Signals and patterns as find_signals() takes them, and "sbus1.frames": the frames of that bus. None:
  // speed, setpoint and status of every station that has them. A name that leads nowhere is a Failure that
  // lists what exists. Before the plant runs; each must outlive the other's part in the run.
  Recorder(runtime::Plant& plant, const std::vector<std::string>& names);

  // For Plant::run_until: takes a sample at whole milliseconds, after all that happened at that time.
  void sample(runtime::Time now);

  // At the end of a run: telegrams that were not completed.
  void finish();

  const Recording& recording() const { return recording_; }

 private:
  struct Watched {
    const runtime::Station* station;
    std::string state;  // last one told
  };

  void add(const std::string& name);
  void add(Signal signal);
  bool add_frames(std::string_view name);
  std::optional<size_t> track_of(const std::string& bus) const;
  void note_changes(runtime::Time now);
  void on_message(const runtime::Bus& bus, const runtime::BusMessage& message) override;

  runtime::Plant& plant_;
  Recording recording_;
  std::vector<Watched> watched_;
};

}  // namespace ipos::tools

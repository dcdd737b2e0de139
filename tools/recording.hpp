// What `ipos run --plot` and `--trace` record: chosen signals of the stations once a virtual millisecond, and
// what happened to the units meanwhile. Plain data; the writers of its forms (trace_csv, plot_svg) only read
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

struct Signal {
  std::string name;   // "unit1.speed"
  std::string unit;   // of the number shown; empty: a plain number
  double factor = 1;  // number shown = sample x factor
  int decimals = 0;
  bool is_status = false;  // a plot shows its changes as events

  std::string text(int64_t sample) const;  // "1500.000"
};

struct RecordedEvent {
  runtime::Time time;
  std::string text;  // "unit1: enable"
  bool is_fault;
};

struct Recording {
  std::vector<Signal> signals;
  std::vector<runtime::Time> times;           // of the samples
  std::vector<std::vector<int64_t>> samples;  // one list a signal, as long as `times`
  std::vector<RecordedEvent> events;
};

class Recorder {
 public:
  // Signals as "unit1.speed", "unit1.P094" or its index, "unit1.H500" or "unit1.symbol"; with one station its
  // name may be left out. None: speed, setpoint and status of every station that has them. A name that leads
  // nowhere is a Failure that lists what exists. The plant must outlive the recorder.
  Recorder(runtime::Plant& plant, const std::vector<std::string>& names);

  // For Plant::run_until: takes a sample at whole milliseconds, after all that happened at that time.
  void sample(runtime::Time now);

  const Recording& recording() const { return recording_; }

 private:
  using Reader = std::function<int64_t()>;
  struct Watched {
    runtime::Station* station;
    std::string state;  // last one told
  };

  void add(const std::string& name);
  bool add(runtime::Station& station, std::string_view name);
  void add(Signal signal, Reader reader);
  void note_changes(runtime::Time now);

  runtime::Plant& plant_;
  Recording recording_;
  std::vector<Reader> readers_;
  std::vector<Watched> watched_;
};

}  // namespace ipos::tools

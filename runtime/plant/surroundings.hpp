// What is outside of the stations and acts on them: wires between terminals, encoder cables, switches at the axis, light barriers over
// conveyors, and the stimuli of the plant file. It acts at the beginning of a millisecond, before any station's tick, on all
// stations alike: so a wire brings the level its output had at the end of the millisecond before (ours).
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/clock/event_queue.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant/belt.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/signals/holds.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::runtime {

class Surroundings final : private EventTarget {
 public:
  // `source` must be below those of the stations. The journal must outlive this.
  Surroundings(EventQueue& queue, uint32_t source, Journal& journal)
      : queue_(queue), source_(source), journal_(journal) {}

  // Finds the signals of the file; adds what is missing to `errors`.
  void connect(const PlantFile& file, const PlantParts& plant, std::vector<PlantError>& errors);

  // At power-on, before the stations.
  void start();

  // While the plant runs: one more stimulus, or anything else that acts from outside. Both happen at the
  // beginning of the millisecond of their time, or of the next one if that has begun, after what is due
  // then already.
  void add(const signals::Signal& signal, const Stimulus& stimulus);
  void act(Time at, std::function<void()> action);

  // At once: held from now on by `by`, as a stimulus with force holds it, for `length` if that is not 0. What is refused is
  // not held.
  signals::Refusal force(const signals::Signal& signal, int64_t value, std::string_view by, Time length = 0);
  // Whatever holds its terminal does so no more.
  void release(const signals::Signal& signal) { holds_.release(signal); }
  const signals::Holds& holds() const { return holds_; }

  // Of a station that drives a conveyor with parts; else null.
  const Belt* belt_of(const Station& station) const;

 private:
  struct LiveWire {  // a wire
    signals::Signal from;
    signals::Signal to;
    bool invert;
  };
  struct Cam {
    signals::Signal input;
    Station* station;
    int32_t from;
    int32_t to;
    bool active_high;
  };
  struct EncoderCable {  // from the motor encoder of one station to a socket of another one
    const Station* from;
    Station* to;
    EncoderSocket socket;
  };
  struct Conveyor {
    const Station* station;
    Belt belt;
  };
  struct Barrier {
    signals::Signal input;
    const Belt* belt;
    int64_t way;
    bool active_high;
  };
  struct Script {
    signals::Signal signal;
    Stimulus stimulus;
    int64_t done = 0;  // how often it has happened
  };
  struct Due {
    size_t script;
    uint64_t ends = 0;             // number of the hold that ends; 0: the stimulus happens
    std::function<void()> action;  // of act(), which has no script
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void perform(Time now, size_t script);
  void hold(const signals::Signal& signal, int32_t value, std::string_view by, Time now, Time length, bool pulse);
  void write(Time now, const signals::Signal& signal, int32_t value);
  void schedule_next(Time now);
  void wake(Time at);

  EventQueue& queue_;
  uint32_t source_;
  Journal& journal_;
  std::vector<LiveWire> wires_;
  std::vector<Cam> cams_;
  std::vector<EncoderCable> cables_;
  std::deque<Conveyor> conveyors_;
  std::vector<Barrier> barriers_;
  std::vector<Script> scripts_;
  signals::Holds holds_{[this](const signals::Signal& signal, const std::string& text) {
    journal_.note(queue_.now(), Weight::Warning, signal.station, "stimulus refused: " + text);
  }};
  std::multimap<Time, Due> due_;  // equal times in the order of the file
  EventId event_ = kNoEvent;
  Time event_at_ = kNever;  // of event_; kNever: none is pending
};

}  // namespace ipos::runtime

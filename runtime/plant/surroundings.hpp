// What is outside of the stations and acts on them: wires between terminals, switches at the axis, and the
// stimuli of the plant file. It acts at the beginning of a millisecond, before any station's tick, on all
// stations alike: so a wire brings the level its output had at the end of the millisecond before (ours).
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "runtime/clock/event_queue.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/signals/signal_port.hpp"

namespace ipos::runtime {

class Surroundings final : private EventTarget {
 public:
  // `source` must be below those of the stations. The journal must outlive this.
  Surroundings(EventQueue& queue, uint32_t source, Journal& journal)
      : queue_(queue), source_(source), journal_(journal) {}

  // Finds the signals of the file; adds what is missing to `errors`.
  void connect(const PlantFile& file, const std::vector<std::unique_ptr<Station>>& stations,
               std::vector<PlantError>& errors);

  // At power-on, before the stations.
  void start();

  // While the plant runs: one more stimulus, or anything else that acts from outside. Both happen at the
  // beginning of the millisecond of their time, or of the next one if that has begun, after what is due
  // then already.
  void add(const signals::SignalPort& port, const Stimulus& stimulus);
  void act(Time at, std::function<void()> action);

  // At once: held from now on, as a stimulus with force holds it; and whatever holds its terminal no more.
  void force(const signals::SignalPort& port, int32_t value);
  void release(const signals::SignalPort& port) { release(port, 0); }

 private:
  struct Lead {  // a wire
    signals::SignalPort from;
    signals::SignalPort to;
    bool invert;
  };
  struct Cam {
    signals::SignalPort input;
    Station* station;
    int32_t from;
    int32_t to;
    bool active_high;
  };
  struct Script {
    signals::SignalPort port;
    Stimulus stimulus;
    int64_t done = 0;  // how often it has happened
  };
  struct Hold {  // a signal that is forced
    signals::SignalPort port;
    int32_t value;
    uint64_t number;
    std::optional<int32_t> before;  // to be written at the end
  };
  struct Due {
    size_t script;
    uint64_t ends = 0;             // number of the hold that ends; 0: the stimulus happens
    std::function<void()> action;  // of act(), which has no script
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void perform(Time now, size_t script);
  void hold(Time now, size_t script);
  Hold& hold(const signals::SignalPort& port, int32_t value);
  void release(const signals::SignalPort& port, uint64_t number);
  void write(Time now, const signals::SignalPort& port, int32_t value);
  void schedule_next(Time now);
  void wake(Time at);

  EventQueue& queue_;
  uint32_t source_;
  Journal& journal_;
  std::vector<Lead> leads_;
  std::vector<Cam> cams_;
  std::vector<Script> scripts_;
  std::vector<Hold> holds_;
  uint64_t holds_made_ = 0;
  std::multimap<Time, Due> due_;  // equal times in the order of the file
  EventId event_ = kNoEvent;
  Time event_at_ = kNever;  // of event_; kNever: none is pending
};

}  // namespace ipos::runtime

// The machines of the plant file that ipos did not write ([[machine]]), on the clock of the plant. A machine stands still until
// its step is over: then it takes what the signals of its inputs are, goes through the step with them, and gives its outputs to
// their signals. It does so before everything else of its millisecond, so what it gives acts in the tick of that time, as a
// stimulus does.
#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/clock/event_queue.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/signals/physical_units.hpp"
#include "runtime/signals/signal.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::runtime {

// Is told what each machine gives to its signals.
class MachineWatcher {
 public:
  virtual void on_given(size_t machine, Time now, std::span<const int64_t> samples) = 0;

 protected:
  ~MachineWatcher() = default;
};

class Machines {
 public:
  // Takes a number for each machine, so that they come in the order of the file. The file and the journal must outlive it.
  Machines(EventQueue& queue, uint32_t& next_source, const PlantFile& file, Journal& journal);

  // Names and units; signals must outlive it.
  void connect(const PlantParts& plant, std::vector<PlantError>& errors);
  // Their programs start with the first event.
  void start();
  void add_watcher(MachineWatcher& watcher) { watchers_.push_back(&watcher); }

  // Those that have given up, with the place in the plant file. What they have moved stays as it is.
  const std::vector<PlantError>& failures() const { return failures_; }

  // Of a copy of the plant that goes on at a later time. Nothing where one of them cannot give its state; an empty text is of
  // one that has not begun.
  bool gives_states() const;
  std::optional<std::vector<std::string>> save();
  void restore(const std::vector<std::string>& states);

 private:
  struct Link {
    signals::Signal signal;
    double per_sample = 1;     // of the signal's own number
    PhysicalUnit of_signal{};  // both plain where nothing is to be converted
    PhysicalUnit of_variable{};
    FilePlace place;
    std::optional<int64_t> written{};
    bool given_up = false;  // the signal has refused a value
  };
  struct Machine final : EventTarget {
    Machine(Machines& of_all, const MachineConfig& of_file, size_t row, uint32_t of_events)
        : all(of_all), config(of_file), number(row), source(of_events) {}
    void on_event(Time now, uint32_t kind, uint64_t argument) override;

    Machines& all;
    const MachineConfig& config;
    size_t number;
    uint32_t source;
    MachineModel::Wiring wiring{};
    std::vector<Link> inputs{}, outputs{};
    std::vector<double> in{}, out{};
    std::vector<int64_t> samples{};
    std::unique_ptr<MachineRun> run{};
    size_t told = 0;  // lines
  };

  void connect(const PlantParts& plant, Machine& machine, std::vector<PlantError>& errors);
  void wire(const PlantParts& plant, const Machine& machine, const MachineWire& row, MachineVariable::Role role,
            std::vector<Link>& links, std::vector<uint32_t>& numbers, std::vector<PlantError>& errors);
  void pass(Machine& machine, Time now);
  void give(Machine& machine, Time now);
  void tell_words(Machine& machine, Time now);
  void fail(Machine& machine, Time now, const std::string& why);

  EventQueue& queue_;
  Journal& journal_;
  std::deque<Machine> machines_;
  std::vector<MachineWatcher*> watchers_;
  std::vector<PlantError> failures_;
};

}  // namespace ipos::runtime

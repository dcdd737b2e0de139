// A plant: lines and stations on one virtual clock. Deterministic: the same plant file and programs give the
// same run on any build.
#pragma once

#include <cassert>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/journal/journal.hpp"
#include "runtime/plant/islands.hpp"
#include "runtime/plant/machines.hpp"
#include "runtime/plant/surroundings.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/plant_parts.hpp"

namespace ipos::runtime {

struct ExpectationResult {
  const Expectation* expectation;
  bool met;
  int64_t actual;  // as Expectation::equals
};

class Plant final : public PlantParts {
 public:
  // One program for each station of the file, empty where it has none. `rates` overrides P938 and P939.
  // Errors (unknown parameters, refused values, programs the unit refuses, unknown variables) come back in
  // `errors`; a plant with errors must not be run.
  Plant(PlantFile file, std::vector<std::optional<vm::Image>> programs, std::optional<vm::Rates> rates,
        std::vector<PlantError>& errors, const Execution& execution = {});

  // Of all lines of a kind, for logs of that kind.
  void add_observer(CanObserver& observer);
  void add_observer(SerialObserver& observer);

  // Runs until `end`; expectations that fall due are checked. Returns false when `keep_going` said so: it is
  // asked once a millisecond of virtual time. A machine that gives up ends it there, too.
  bool run_until(Time end, const std::function<bool(Time)>& keep_going = {});

  // The run is over: what is still to be stored is stored. False: the journal says what could not be.
  bool store_memories();

  bool programs_over() const;
  bool has_fault() const;
  // Stations that a fault has stopped which no [[expect]] of the plant looked for and found.
  std::vector<const Station*> unforeseen_faults() const;
  Time now() const override { return queue_.now(); }
  Time next_time() const { return islands_->next_time(); }  // of the next event

  // For what joins the plant from outside, before the first event runs: its events, and the number that puts
  // them after those of all others. Not for a plant whose islands run apart.
  EventQueue& queue() {
    assert(islands_->count() == 1);
    return queue_;
  }
  const Islands& islands() const { return *islands_; }
  size_t island_of(const Bus& bus) const;
  uint32_t next_source() { return next_source_++; }

  // For a test that acts on the plant from outside while it runs.
  Surroundings& surroundings() { return *surroundings_; }
  const Surroundings& surroundings() const { return *surroundings_; }
  Machines& machines() { return *machines_; }
  const Machines& machines() const { return *machines_; }
  // The power of a station or a gateway, which exists. The journal tells each change.
  void set_power(std::string_view name, bool on);
  // Plants a fault of a line, whose times are those of the plant. False: its station is not on the bus.
  bool plant_fault(const FaultConfig& config);
  // Ends what was planted with the same bus, station, kind and identifier; false: there is no such fault.
  bool repair_fault(const FaultConfig& config);
  // Before the first event: what the file says of the lines disturbs no frame. For a plan, which wants to see them all.
  void calm_lines();

  const PlantFile& file() const { return file_; }
  std::vector<std::unique_ptr<Station>>& stations() { return stations_; }
  const std::vector<std::unique_ptr<Station>>& stations() const override { return stations_; }
  const std::vector<std::unique_ptr<Control>>& controls() const override { return controls_; }
  const std::vector<std::unique_ptr<Bus>>& buses() const override { return buses_; }
  const Journal& journal() const {
    look();
    return journal_;
  }
  // A line for the journal about what happens to the plant from outside; each one is told.
  void tell(Weight weight, std::string_view station, std::string text) {
    journal_.tell(queue_.now(), weight, station, std::move(text));
  }
  const std::vector<ExpectationResult>& results() const { return results_; }

 private:
  void look() const;  // what stations are late with they make up for
  Bus& add_bus(const BusConfig& config, Islands::Place place);
  StationLines lines_of(size_t station);
  void add_station(size_t number, std::optional<vm::Image> program, std::optional<vm::Rates> rates,
                   std::vector<PlantError>& errors, const Execution& execution);
  void power_on();
  void disturb_lines();
  void plant_faults();
  void check_expectations(Time until);
  void resolve_expectations(std::vector<PlantError>& errors);

  PlantFile file_;
  EventQueue queue_;
  uint32_t next_source_ = 0;
  Journal journal_;
  std::unique_ptr<Islands> islands_;
  std::deque<BusConfig> keypads_;  // lines that are not in the file
  std::vector<FaultConfig> of_lines_;  // that the file says of them without a [[fault]]
  std::vector<std::unique_ptr<Bus>> buses_;
  std::vector<size_t> island_of_bus_;  // for each of them
  std::unique_ptr<Machines> machines_;
  std::unique_ptr<Surroundings> surroundings_;
  std::vector<std::unique_ptr<Station>> stations_;
  std::vector<std::unique_ptr<Control>> controls_;

  struct Due {
    const Expectation* expectation;
    signals::Signal signal;
  };
  std::vector<Due> due_;  // in order of time
  size_t next_due_ = 0;
  std::vector<ExpectationResult> results_;
};

}  // namespace ipos::runtime

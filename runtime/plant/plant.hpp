// A plant: lines and stations on one virtual clock. Deterministic: the same plant file and programs give the
// same run on any build.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/line_check.hpp"
#include "runtime/bus/movilink/sbus_check.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/plant/plant_file.hpp"
#include "runtime/plant/signal_port.hpp"
#include "runtime/plant/station.hpp"
#include "runtime/plant/surroundings.hpp"
#include "runtime/unit/journal.hpp"

namespace ipos::runtime {

struct ExpectationResult {
  const Expectation* expectation;
  bool met;
  int32_t actual;
};

// An RS-485 line and what is watched on it.
struct SerialLine {
  SerialLine(EventQueue& queue, uint32_t source, const std::string& name, uint32_t baud,
             LineCheck::Report report)
      : line(queue, source, name, baud), check(std::move(report)) {
    line.add_observer(check);
  }
  Rs485Line line;
  LineCheck check;
};

// A master control and its place on a line.
struct PlantControl {
  const ControlConfig* config;
  CanLine* line;
  std::unique_ptr<SbusControl> control;
  std::unique_ptr<LinePort> port;
};

class Plant final : private LineObserver, private SbusCheckClient {
 public:
  // One program for each station of the file, empty where it has none. `rates` overrides P938 and P939.
  // Errors (unknown parameters, refused values, programs the unit refuses, unknown variables) come back in
  // `errors`; a plant with errors must not be run.
  Plant(PlantFile file, std::vector<std::optional<vm::Image>> programs, std::optional<vm::Rates> rates,
        std::vector<PlantError>& errors, const Execution& execution = {});

  void add_observer(CanObserver& observer);
  void add_observer(SerialObserver& observer);

  // Runs until `end`; expectations that fall due are checked. Returns false when `keep_going` said so: it is
  // asked once a millisecond of virtual time.
  bool run_until(Time end, const std::function<bool(Time)>& keep_going = {});

  // The run is over: what is still to be stored is stored. False: the journal says what could not be.
  bool store_memories();

  bool programs_over() const;
  bool has_fault() const;
  // Stations that a fault has stopped which no [[expect]] of the plant looked for and found.
  std::vector<const Station*> unforeseen_faults() const;
  Time now() const { return queue_.now(); }
  Time next_time() const { return queue_.next_time(); }  // of the next event

  // For what joins the plant from outside, before the first event runs: its events, and the number that puts
  // them behind those of all others.
  EventQueue& queue() { return queue_; }
  uint32_t next_source() { return next_source_++; }

  // For a test that acts on the plant from outside while it runs.
  Surroundings& surroundings() { return *surroundings_; }
  // Plants a fault of a line, whose times are those of the plant. False: its station is not on the bus.
  bool plant_fault(const FaultConfig& config);
  // Ends what was planted with the same bus, station, kind and identifier; false: there is no such fault.
  bool repair_fault(const FaultConfig& config);

  const PlantFile& file() const { return file_; }
  std::vector<std::unique_ptr<Station>>& stations() { return stations_; }
  const std::vector<std::unique_ptr<Station>>& stations() const { return stations_; }
  const std::vector<PlantControl>& controls() const { return controls_; }
  const std::vector<std::unique_ptr<CanLine>>& lines() const { return lines_; }
  const std::vector<std::unique_ptr<SerialLine>>& serial_lines() const { return serial_lines_; }
  const Journal& journal() const {
    look();
    return journal_;
  }
  const std::vector<ExpectationResult>& results() const { return results_; }

 private:
  void look() const;  // what stations are late with they make up for
  void on_line_event(const CanLine& line, const LineEvent& event) override;
  void on_sbus_finding(Time now, std::string text) override;
  void make_lines();
  StationLines lines_of(const StationConfig& station);
  void add_serial_line(const std::string& name, uint32_t baud, uint32_t source);
  void tell_findings();
  CanLine* find_line(std::string_view name) const;
  void add_station(size_t number, std::optional<vm::Image> program, std::optional<vm::Rates> rates,
                   std::vector<PlantError>& errors, const Execution& execution);
  void power_on();
  void start_checks();
  void plant_faults();
  NodeId find_node(const CanLine& line, std::string_view station) const;
  void check_expectations(Time until);
  void resolve_expectations(std::vector<PlantError>& errors);

  PlantFile file_;
  EventQueue queue_;
  uint32_t next_source_ = 0;
  Journal journal_;
  std::vector<std::unique_ptr<CanLine>> lines_;
  std::vector<std::unique_ptr<SerialLine>> serial_lines_;  // of the file, then those to keypads
  std::vector<std::unique_ptr<SbusCheck>> checks_;         // one a line
  std::unique_ptr<Surroundings> surroundings_;
  std::vector<std::unique_ptr<Station>> stations_;
  std::vector<PlantControl> controls_;

  struct Due {
    const Expectation* expectation;
    SignalPort port;
  };
  std::vector<Due> due_;  // in order of time
  size_t next_due_ = 0;
  std::vector<ExpectationResult> results_;
};

}  // namespace ipos::runtime

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
#include "runtime/bus/rs485/line.hpp"
#include "runtime/plant/plant_file.hpp"
#include "runtime/plant/station.hpp"
#include "runtime/services/journal.hpp"

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

class Plant final : private CanObserver {
 public:
  // One program for each station of the file, empty where it has none. `rates` overrides P938 and P939.
  // Errors (unknown parameters, refused values, programs the unit refuses, unknown variables) come back in
  // `errors`; a plant with errors must not be run.
  Plant(PlantFile file, std::vector<std::optional<vm::Image>> programs, std::optional<vm::Rates> rates,
        std::vector<PlantError>& errors);

  void add_observer(CanObserver& observer);
  void add_observer(SerialObserver& observer);

  // Runs until `end`; expectations that fall due are checked. Returns false when `keep_going` said so: it is
  // asked once a millisecond of virtual time.
  bool run_until(Time end, const std::function<bool(Time)>& keep_going = {});

  bool programs_over() const;
  bool has_fault() const;
  Time now() const { return queue_.now(); }
  Time next_time() const { return queue_.next_time(); }  // of the next event

  // For what joins the plant from outside, before the first event runs: its events, and the number that puts
  // them behind those of all others.
  EventQueue& queue() { return queue_; }
  uint32_t next_source() { return next_source_++; }

  const PlantFile& file() const { return file_; }
  std::vector<std::unique_ptr<Station>>& stations() { return stations_; }
  const std::vector<std::unique_ptr<CanLine>>& lines() const { return lines_; }
  const std::vector<std::unique_ptr<SerialLine>>& serial_lines() const { return serial_lines_; }
  const Journal& journal() const { return journal_; }
  const std::vector<ExpectationResult>& results() const { return results_; }

 private:
  void on_frame(const CanLine& line, const FrameRecord& record) override;
  void on_line_event(const CanLine& line, const LineEvent& event) override;
  void make_lines();
  StationLines lines_of(const StationConfig& station);
  void add_serial_line(const std::string& name, uint32_t baud, uint32_t source);
  void tell_findings();
  void check_expectations(Time until);
  void resolve_expectations(std::vector<PlantError>& errors);

  PlantFile file_;
  EventQueue queue_;
  uint32_t next_source_ = 0;
  Journal journal_;
  std::vector<std::unique_ptr<CanLine>> lines_;
  std::vector<std::unique_ptr<SerialLine>> serial_lines_;  // of the file, then those to keypads
  std::vector<std::unique_ptr<Station>> stations_;

  struct Due {
    const Expectation* expectation;
    Station* station;
    uint32_t variable;
  };
  std::vector<Due> due_;  // in order of time
  size_t next_due_ = 0;
  std::vector<ExpectationResult> results_;
};

}  // namespace ipos::runtime

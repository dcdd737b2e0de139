// Synchronous operation of one station: carries parameters, inputs and the counts of both encoders to the
// SynchronousOperation, its order to the drive, and a lag error to drive and journal. Called before the drive's tick.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/drive/drive.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/positioning/synchronous.hpp"

namespace ipos::runtime {

class SynchronousService {
 public:
  // All must outlive it. The unit has a DRS card.
  SynchronousService(Drive& drive, ParameterStore& parameters, Journal& journal, std::string_view station);

  // What the drive is to do: what positioning has ordered, or in a mode with SYNC. what the master leads to.
  const PositionControl& order(Time now, const PositionControl& positioning);
  // P700 is such a mode.
  bool selected() const { return drive_.decisions().can_synchronize; }
  const SynchronousOperation& operation() const { return operation_; }

 private:
  void read_settings();
  SynchronousInputs inputs() const;
  void report_lag_error(Time now);

  Drive& drive_;
  ParameterStore& parameters_;
  Journal& journal_;
  std::string station_;

  struct Cell {
    int32_t SynchronousSettings::*member;
    uint16_t index;
  };
  std::vector<Cell> cells_;
  SynchronousSettings settings_;
  uint32_t settings_version_;
  SynchronousOperation operation_;
  PositionControl ordered_;
};

}  // namespace ipos::runtime

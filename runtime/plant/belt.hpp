// The belt of a conveyor with the parts on it ([station.machine] with kind = "conveyor"; all ours). It moves as the motor
// shaft does; parts come at its beginning, ride on it and fall off behind its end. Light barriers ask where parts are.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "runtime/plant_file/driven_machine.hpp"

namespace ipos::runtime {

class Belt {
 public:
  // Of a conveyor with travel.
  explicit Belt(const DrivenMachine& machine);

  // The shaft is here now: increments turned ever. The first call says where it is at the start.
  void move(int32_t shaft);

  // Increments of the shaft from the beginning of the belt to a place in the unit, rounded.
  int64_t way_to(double place) const;
  // A part lies there, its ends included.
  bool covers(int64_t way) const;
  // The fronts of the parts, in the unit; in the order in which they came.
  std::vector<double> fronts() const;

 private:
  const DrivenMachine& machine_;
  int64_t length_;
  int64_t part_length_;
  int64_t pitch_;  // 0: no parts come
  // All in increments of the shaft, forwards on the belt: how far it has moved, and the fronts of the parts on the belt,
  // as if it had not moved.
  std::deque<int64_t> parts_;
  int64_t moved_ = 0;
  int64_t next_ = 0;  // when it has moved so far the next part comes
  std::optional<int32_t> shaft_;
};

}  // namespace ipos::runtime

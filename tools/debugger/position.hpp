// A moment of a plant's run as a debugger counts it: by the commands that all its tasks have executed. The
// same number is the same moment in every run of the plant.
#pragma once

#include <compare>
#include <cstdint>

#include "runtime/clock/event_queue.hpp"

namespace ipos::tools::debug {

// Where in the course of events: behind a command, between two milliseconds, or before the next command.
enum class Phase : uint8_t { Behind, Between, Before };

struct Position {
  uint64_t commands = 0;  // executed so far
  runtime::Time time = 0;
  Phase phase = Phase::Between;

  auto operator<=>(const Position&) const = default;
};

}  // namespace ipos::tools::debug

// What Machine::idle_ticks() has found out: the ticks to come lead nowhere, as all tasks wait, have ended or go round in
// loops that leave everything as it was. It is true of the state it was found in, so that state stands here, and
// Machine::skip_ticks() uses it for no other one (docs/inside/cycle.md).
#pragma once

#include <array>
#include <cstdint>

#include "vm/context/context.hpp"

namespace ipos::vm {

inline constexpr uint64_t kIdleForever = UINT64_MAX;

struct Idle {
  // Loops that use more variables, all tasks together, are executed.
  static constexpr uint32_t kMostUsed = 192;

  // The loop of a task, from where its context stands.
  struct Loop {
    uint32_t length = 0;  // commands; 0: the task executes none
    int context = 0;
    uint32_t pc = 0;
    uint64_t commands = 0;  // executed by then
  };

  uint64_t ticks = 0;  // 0: the next one may lead somewhere. kIdleForever: no end to it
  bool steady = true;  // no variable changes, not even for a moment
  uint32_t begun = 0;  // contexts, by then: none has restarted
  std::array<Loop, kTasks> loops{};
  // What the loops read and write, and the values of it.
  uint32_t used = 0;
  std::array<uint16_t, kMostUsed> numbers;
  std::array<int32_t, kMostUsed> values;
};

}  // namespace ipos::vm

// The installed interrupts as data: those of task 1 (SETINT, IPOSplus p. 45, 342) and the four variable
// interrupts (VARINT, p. 45, 347). Plain values, part of the machine's state; the rules are in
// interrupts.cpp.
#pragma once

#include <array>
#include <cstdint>

#include "vm/context/context.hpp"

namespace ipos::vm {

inline constexpr uint32_t kVarIntReq = 530;  // bits 0..3 request variable interrupts 0..3 (IPOSplus p. 38)
inline constexpr int32_t kAllRequests = (1 << kVariableInterrupts) - 1;
inline constexpr int32_t kMaxPriority = 10;  // of variable interrupts; ours

enum class CompareMode : uint8_t {
#define COMPARE_MODE(value, name, constant, meaning) name = value,
#include "vm/exec/compare_modes.def"
};
inline constexpr int32_t kCompareModes = 10;

struct EventInterrupt {
  bool installed = false;
  bool pending = false;  // the event has come and its routine has not begun
  uint32_t address = 0;
};

struct VariableInterrupt {
  bool installed = false;
  bool held = false;  // the condition was true at the last look
  CompareMode mode = CompareMode::Never;
  uint8_t task = 0;        // 2 or 3
  uint8_t priority = 0;    // 1..kMaxPriority
  uint16_t source = 0;     // number of the watched variable
  uint16_t structure = 0;  // where VARINT stood, for its element IntEvent
  int32_t compare = 0;
  int32_t last = 0;  // value at the last look
  uint32_t address = 0;

  // Looks at the variable; true when this is the event.
  bool look(int32_t value);
};

struct Interrupts {
  std::array<EventInterrupt, kEvents> events{};
  std::array<VariableInterrupt, kVariableInterrupts> variables{};
  uint8_t turn = 0;  // which of the installed events is looked at next
};

}  // namespace ipos::vm

// What belongs to what in a program, read from its code: which task reads and writes a variable, who calls whom, which
// telegrams it sets up, and the states of a variable that a `switch` follows.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "vm/image/image.hpp"

namespace ipos::compiler {

// Who executes a command: a task, or an interrupt routine.
struct Runner {
  int task = 0;            // 1 to 3; 0: an interrupt
  std::string routine{};  // of an interrupt
  std::string text() const;  // "task 1", "interrupt Clock"
  bool operator==(const Runner&) const = default;
};

struct VariableMap {
  std::string name;  // as the program calls it; empty: by its number alone
  uint16_t variable = 0;
  uint16_t count = 1;
  bool kept = false;               // H0 to H127 outlast the power (non-volatile)
  std::vector<Runner> read, written;  // in order
};

struct CallMap {
  enum class How : uint8_t { Calls, Starts, Installs };
  std::string from, to;
  uint32_t line = 0;
  How how = How::Calls;
  int task = 0;  // as which it starts it
  std::string text() const;  // "calls", "starts as task 2", "installs as an interrupt"
  bool operator==(const CallMap&) const = default;
};

// Of a command that sets up an object; a member is there where the code gives it a constant.
struct TelegramMap {
  uint32_t address = 0;
  uint32_t line = 0;
  std::string kind;  // "cyclic", "acyclic", "receive"
  std::optional<int64_t> object, cycle_ms, offset_ms, format, data;  // data: the variable that it begins at
};

struct StateMap {
  struct Way {
    std::optional<int64_t> from;  // none: from any state
    int64_t to = 0;
    uint32_t line = 0;
    bool operator==(const Way&) const = default;
  };
  std::string name;
  uint16_t variable = 0;
  std::vector<int64_t> states;  // that the program compares it with, or gives it
  std::vector<Way> ways;
};

struct ProgramMaps {
  std::vector<VariableMap> variables;
  std::vector<CallMap> calls;
  std::vector<TelegramMap> telegrams;
  std::vector<StateMap> states;
};

// `variables`: how many the unit has. The image has been verified.
ProgramMaps program_maps(const vm::Image& image, uint32_t variables);

}  // namespace ipos::compiler

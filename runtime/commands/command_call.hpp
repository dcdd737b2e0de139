// One system command on its way to the service that carries it out, and what all services may work on. Each
// command of a program that the host executes is a function over a CommandCall.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "runtime/clock/event_queue.hpp"
#include "runtime/clock/own_milliseconds.hpp"
#include "runtime/commands/movilink_command.hpp"
#include "runtime/commands/positioning_commands.hpp"
#include "runtime/drive/drive.hpp"
#include "runtime/nv_memory/kept/retained_memory.hpp"
#include "runtime/scom/variable_objects.hpp"
#include "runtime/services/timers.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

// The parts of a station its program can reach.
struct ProgramServices {
  const EventQueue& clock;
  const OwnMilliseconds& milliseconds;
  Drive& drive;
  ParameterStore& parameters;
  Timers& timers;
  RetainedMemory& memory;
  MovilinkCommand& movilink;
  std::array<VariableObjects*, 2> objects{};   // of SBus 1 and 2; null for a bus the station is not on
  PositioningCommands* positioning = nullptr;  // null for a unit that cannot position
};

struct CommandCall {
  const ProgramServices& services;
  vm::Machine& machine;
  int context;  // vm/context/context.hpp
  const vm::Instruction& command;

  // What the user has to be told, whatever the answer is.
  std::string why;
  // A fault of the drive that the command causes while the program goes on (F77, F99), and how.
  uint8_t caused_fault = 0;
  std::string cause;

  std::span<int32_t> h() const { return machine.variables(); }
  int32_t operand(size_t n) const { return command.operands[n]; }
  int32_t& variable(size_t operand_number, size_t element = 0) const {
    return h()[static_cast<size_t>(operand(operand_number)) + element];
  }
};

constexpr vm::HostReply illegal(const char* reason) { return {vm::Answer::Fault, vm::kFaultIllop, reason}; }
// The reason of a command that the simulated drive does not know.
inline constexpr const char* kNotSimulated = "this command is not simulated yet, see docs/reference/limits.md";

// A function with the name of its row for each row of opcodes.def that the host executes.
namespace commands {
#define COMMAND_Never(Name)
#define COMMAND_Zero(Name)
#define COMMAND_Index(Name)
#define COMMAND_Depth(Name)
#define COMMAND_Host(Name) vm::HostReply Name(CommandCall& call);
#define OPCODE(code, Name, text, flow, reads, writes, faults, meaning) COMMAND_##faults(Name)
#include "vm/isa/opcodes.def"
#undef COMMAND_Host
}  // namespace commands

}  // namespace ipos::runtime

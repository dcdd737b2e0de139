// What was done to a plant from outside, and when, as plain data: enough to do it again, and as bytes to keep it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/library/signal_id.hpp"

namespace ipos::library {

enum class Act : uint8_t {
  Write,       // signal, value
  Force,       // signal, value
  Release,     // signal
  PowerOff,    // signal.station
  PowerOn,     // signal.station
  Program,     // signal.station, value: ProgramOrder
  DriveFault,  // signal.station, value
  ResetFault,  // signal.station
  Join,        // number: bus
  Send,        // number: bus; value: tag; frame
  SerialSend,  // number: bus; bytes
  LineFault,   // bytes: the text of the tables
  // Of CanNodes; signal.number: node
  NodesJoin,     // number: bus; value: how many
  NodeSend,      // number: bus; frame
  NodeRate,      // number: bus; value: bit/s
  NodeState,     // number: bus; value: runtime::ErrorState
  NodeDiscards,  // number: bus; value: 1: what loses the arbitration is given up
  // Of FmsOperator
  Fms,           // number: bus; bytes: address, connection, service, index high and low, data
};
inline constexpr Act kLastAct = Act::Fms;

struct Action {
  runtime::Time at = 0;
  Act act = Act::Write;
  SignalId signal{};
  uint32_t number = 0;
  int64_t value = 0;
  std::vector<uint8_t> bytes{};  // of Send: flags, length and data after the identifier
};

// A saved state: what leads from time 0 to it.
struct SavedState {
  uint64_t identity = 0;  // of the contents
  runtime::Time time = 0;
  uint64_t digest = 0;  // of the state the actions lead to
  std::vector<Action> actions;
};

// Bytes that are the same on every platform, with a checksum.
std::vector<uint8_t> to_bytes(uint64_t identity, runtime::Time time, uint64_t digest,
                              std::span<const Action> actions);
// The error says what is wrong with them. Whether the plant has the signals is not looked at.
tl::expected<SavedState, std::string> from_bytes(std::span<const uint8_t> bytes);

}  // namespace ipos::library

// States of a node, the commands that change them, and what a node may do in each (CiA 301).
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/canopen/connections.hpp"

namespace ipos::runtime::canopen {

enum class State : uint8_t {
#define NMT_STATE(name, code, text) name = code,
#include "runtime/bus/canopen/nmt_commands.def"
};

enum class NmtCommand : uint8_t {
#define NMT_COMMAND(name, code, text) name = code,
#include "runtime/bus/canopen/nmt_commands.def"
};

// Empty for a code that is none.
constexpr std::string_view state_text(uint8_t code) {
#define NMT_STATE(name, value, text) \
  if (code == (value)) return text;
#include "runtime/bus/canopen/nmt_commands.def"
  return {};
}
constexpr std::string_view command_text(uint8_t code) {
#define NMT_COMMAND(name, value, text) \
  if (code == (value)) return text;
#include "runtime/bus/canopen/nmt_commands.def"
  return {};
}

constexpr bool has_sdo(State state) { return state == State::PreOperational || state == State::Operational; }
constexpr bool has_sync(State state) { return has_sdo(state); }
constexpr bool has_emergency(State state) { return has_sdo(state); }
constexpr bool has_pdo(State state) { return state == State::Operational; }

constexpr Frame nmt_frame(NmtCommand command, uint8_t node) {  // 0: all nodes
  return {identifier(Connection::Nmt), 2, {static_cast<uint8_t>(command), node}};
}

}  // namespace ipos::runtime::canopen

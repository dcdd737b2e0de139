// The logic of enable: which of the control sources (terminals, control word of a bus, control word of the
// program) restricts the drive most (MOVITRAC 07 chapter 6.3 and figure 19; MDX60B/61B p. 29). Pure
// functions.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runtime/drive/fault_state.hpp"
#include "runtime/drive/terminals.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// What the drive is told to do; the most restrictive comes first.
enum class Command : uint8_t { Inhibit, EmergencyStop, RapidStop, Stop, HoldControl, Enable };

enum class Block : uint8_t {
#define BLOCK(name, text) name,
#include "runtime/drive/blocks.def"
};
std::string block_text(Block block, const stdlib::UnitType& unit);

struct Verdict {
  Command command = Command::Enable;
  Block reason = Block::None;

  // The more restrictive of the two; of equals the one that came first.
  void restrict_to(Command other, Block why) {
    if (other < command) *this = {other, why};
  }
};

struct ControlInputs {
  Terminals terminals;
  stdlib::Traits traits{};
  bool cw = false;  // direction terminals, after the three-wire latch
  bool ccw = false;
  bool sign_decides = false;            // bus setpoint: its sign is the direction, the terminals only enable
  uint32_t ipos_word = 0;               // H484
  bool positioning = false;             // IPOS controls the axis: a position has its direction itself
  Command axis_stop = Command::Enable;  // of the program
  FaultStop fault_stop = FaultStop::None;
  bool fault_is_warning = false;
  bool factory_setting = false;
  bool starting_up = false;
  bool link_is_low = false;                   // no mains, and no DC link any more
  std::optional<Command> mains_response;      // of P521, while it acts
  bool waiting = false;                  // display t
  std::optional<uint16_t> bus_word;      // of the bus of P101; nothing: terminals
  Block bus_word_missing = Block::None;  // why bus_word is a made-up 0
  bool follows_master = false;           // bus_word is of a master (P100), whatever P101 is
};

Verdict decide(const ControlInputs& inputs);

// What terminals and program alone say: a bus and faults left out. Monitoring of process data asks this
// (M07-MON-05).
Verdict decide_locally(const ControlInputs& inputs);

}  // namespace ipos::runtime

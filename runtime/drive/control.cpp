// Every source is heard, the most restrictive one wins.
#include "runtime/drive/control.hpp"

#include "runtime/drive/process_data.hpp"
#include "stdlib/unit_text.hpp"

namespace ipos::runtime {
namespace {

using stdlib::Trait;

constexpr std::string_view kTexts[] = {
#define BLOCK(name, text) text,
#include "runtime/drive/blocks.def"
};

// Bits of H484: figure 19 of the MOVITRAC 07 manual keeps only these labels.
constexpr uint32_t kIposNoEnable = 1U << 1;
constexpr uint32_t kIposInhibit = 1U << 30;

void hear_terminals(const ControlInputs& in, Verdict& verdict) {
  using F = InputFunction;
  const Terminals& t = in.terminals;
  if (t.off(F::ControllerInhibit)) verdict.restrict_to(Command::Inhibit, Block::TerminalInhibit);
  if (t.off(F::Enable)) {
    if (in.traits.has(Trait::EnableIsRapidStop))
      verdict.restrict_to(Command::RapidStop, Block::RapidStopTerminal);
    else
      verdict.restrict_to(Command::Stop, Block::EnableTerminal);
  }
  // A travel needs no direction, but an input that could give one still means stop at 0 (ours).
  const bool no_input = in.positioning && !t.assigned(F::Cw) && !t.assigned(F::Ccw);
  if (!in.cw && !in.ccw && !no_input) verdict.restrict_to(Command::Stop, Block::NoDirection);
  // Where the sign of a bus setpoint is the direction, MOVIDRIVE wants or allows both (MDX60B/61B p. 29).
  const bool may_be_both = in.sign_decides && in.traits.has(Trait::BothDirections);
  if (in.cw && in.ccw && !in.positioning && !may_be_both)
    verdict.restrict_to(Command::Stop, Block::BothDirections);
  if (t.off(F::HoldControl)) verdict.restrict_to(Command::HoldControl, Block::HoldTerminal);
}

void hear_program(const ControlInputs& in, Verdict& verdict) {
  if ((in.ipos_word & kIposInhibit) != 0) verdict.restrict_to(Command::Inhibit, Block::IposInhibit);
  if ((in.ipos_word & kIposNoEnable) != 0) verdict.restrict_to(Command::Stop, Block::IposNoEnable);
  verdict.restrict_to(in.axis_stop, in.axis_stop == Command::Stop ? Block::SlaveStands : Block::AxisStop);
}

void hear_bus(const ControlInputs& in, Verdict& verdict) {
  if (!in.bus_word) return;
  const uint16_t word = *in.bus_word;
  if (in.bus_word_missing != Block::None) {
    if (in.waiting) return;  // which says the same
    verdict.restrict_to(Command::RapidStop, in.bus_word_missing);
    return;
  }
  using namespace control_bits;
  const auto of = [&](Block bus, Block master) { return in.follows_master ? master : bus; };
  if ((word & kInhibit) != 0)
    verdict.restrict_to(Command::Inhibit, of(Block::BusInhibit, Block::MasterInhibit));
  if ((word & kRapidStop) == 0)
    verdict.restrict_to(Command::RapidStop, of(Block::BusRapidStop, Block::MasterRapidStop));
  if ((word & kStop) == 0) verdict.restrict_to(Command::Stop, of(Block::BusStop, Block::MasterStop));
  if ((word & kHold) != 0 && in.traits.has(Trait::HoldControl))
    verdict.restrict_to(Command::HoldControl, of(Block::BusHold, Block::MasterHold));
}

void hear_faults(const ControlInputs& in, Verdict& verdict) {
  const Block why = in.fault_is_warning ? Block::Warning : Block::Fault;
  if (in.starting_up) verdict.restrict_to(Command::Inhibit, Block::StartUp);
  if (in.factory_setting) verdict.restrict_to(Command::Inhibit, Block::FactorySetting);
  if (in.link_is_low) verdict.restrict_to(Command::Inhibit, Block::NoMains);
  if (in.mains_response) verdict.restrict_to(*in.mains_response, Block::MainsOff);
  switch (in.fault_stop) {
    case FaultStop::None: break;
    case FaultStop::Rapid: verdict.restrict_to(Command::RapidStop, why); break;
    case FaultStop::Emergency: verdict.restrict_to(Command::EmergencyStop, why); break;
    case FaultStop::Immediate: verdict.restrict_to(Command::Inhibit, why); break;
  }
}

}  // namespace

std::string block_text(Block block, const stdlib::UnitType& unit) {
  return stdlib::unit_text(unit, kTexts[static_cast<size_t>(block)]);
}

Verdict decide_locally(const ControlInputs& inputs) {
  Verdict verdict;
  hear_terminals(inputs, verdict);
  hear_program(inputs, verdict);
  return verdict;
}

Verdict decide(const ControlInputs& inputs) {
  Verdict verdict;
  hear_faults(inputs, verdict);
  hear_terminals(inputs, verdict);
  hear_program(inputs, verdict);
  if (inputs.waiting) verdict.restrict_to(Command::Stop, Block::Waiting);
  hear_bus(inputs, verdict);
  return verdict;
}

}  // namespace ipos::runtime

// A drive has a control word with enable, a direction at its terminals, or waits for something that its orders need. What
// a program or a master holds back on purpose is no trouble (all ours).
#include "tools/serve/host/station_order.hpp"

#include "runtime/drive/terminals.hpp"
#include "runtime/plant_file/signal.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Block;

constexpr uint16_t kControlBits = 7, kEnable = 6;  // of control word 1: no inhibit, no rapid stop, no stop

bool has_direction(const runtime::Station& station) {
  for (const runtime::BinaryTerminal& terminal : runtime::binary_inputs()) {
    if (terminal.parameter.empty() || station.inputs().line(terminal.bit).value() == 0) continue;
    const auto function = static_cast<runtime::InputFunction>(station.drive().value(terminal.parameter));
    if (function == runtime::InputFunction::Cw || function == runtime::InputFunction::Ccw) return true;
  }
  return false;
}

}  // namespace

bool is_ordered(const runtime::Station& station) {
  const runtime::Drive& drive = station.drive().state();
  switch (drive.verdict().reason) {
    case Block::None:
    case Block::Warning:
    case Block::Waiting:
    case Block::NoControlWord:
    case Block::PoDisabled:
    case Block::BothDirections:
    case Block::LimitCw:
    case Block::LimitCcw: return true;
    case Block::TerminalInhibit:
    case Block::RapidStopTerminal:
    case Block::EnableTerminal:
    case Block::NoDirection: return has_direction(station) || (drive.po()[0] & kControlBits) == kEnable;
    default: return false;
  }
}

}  // namespace ipos::tools::serve

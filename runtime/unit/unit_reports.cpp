// What a unit tells the journal.
#include <fmt/format.h>

#include "runtime/unit/unit.hpp"
#include "stdlib/faults.hpp"

namespace ipos::runtime {

void Unit::report_reasons(Time now) {
  // MOVLNK to the own unit.
  if (std::string refused = drive_.take_reason(); !refused.empty())
    note(now, Weight::Why, "refused " + std::move(refused));
  for (std::string& obstacle : drive_.take_obstacles()) note(now, Weight::Why, std::move(obstacle));
}

void Unit::report_fault(Time now) {
  fault_reported_ = true;
  const vm::Fault& fault = machine_->fault();
  for (VariableObjects* objects : objects_)
    if (objects != nullptr) objects->stop();
  movilink_.stop();
  timers_.stop_watchdog();
  drive().raise_fault(fault.number);
  resets_seen_ = drive().resets();
  const std::string place = source_place(fault.address);
  note(now, Weight::Fault,
       fmt::format("F{:02} in task {}{} at {}word {}: {}", fault.number, fault.task,
                   fault.context == fault.task ? "" : fmt::format(" ({})", vm::context_name(fault.context)),
                   place.empty() ? "" : place + ", ", fault.address, fault.reason));
}

// Faults, and with --why every change of the reason why the drive is not enabled or takes another setpoint.
void Unit::report_drive(Time now) {
  const Drive& d = drive();
  const uint8_t fault = d.fault();
  if (fault != told_fault_ && fault != 0 && fault != (machine_ ? machine_->fault().number : 0)) {
    const stdlib::FaultRow* row = stdlib::find_fault(fault);
    note(now, d.error() ? Weight::Fault : Weight::Warning,
         row == nullptr ? fmt::format("F{:02}", fault)
                        : fmt::format("F{:02} {}: {}", fault, row->name, stdlib::meaning_on(config_.type, *row)));
  }
  told_fault_ = fault;
  if (const uint16_t reserved = d.reserved_control_bits(); reserved != told_reserved_) {
    told_reserved_ = reserved;
    if (reserved != 0)
      note(now, Weight::Warning,
           fmt::format("reserved bits of the control word are 1 ({:04X}h): they have no effect and are to be "
                       "sent as 0",
                       reserved));
  }
  if (const Block block = d.verdict().reason; block != told_block_) {
    told_block_ = block;
    note(now, Weight::Why,
         (block == Block::None ? "" : "not enabled: ") + block_text(block, config_.type));
  }
  if (const SetpointNote setpoint_note = d.setpoint().note; setpoint_note != told_note_) {
    told_note_ = setpoint_note;
    if (setpoint_note != SetpointNote::None)
      note(now, Weight::Why, setpoint_note_text(setpoint_note, config_.type));
  }
}

void Unit::report_memory(Time now) {
  for (UnitMemory::Message& message : drive_.memory().take_messages())
    note(now, message.weight, std::move(message.text));
}

}  // namespace ipos::runtime

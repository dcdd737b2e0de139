// Power, program start and memory of a station.
#include <fmt/format.h>

#include <array>

#include "runtime/plant/station.hpp"
#include "stdlib/system_variables.hpp"
#include "vm/verify/writes.hpp"

namespace ipos::runtime {
namespace {

static_assert(vm::kFirstSystemVariable == stdlib::kFirstSystemVariable);
static_assert(vm::kLastSystemVariable == stdlib::kLastSystemVariable);

constexpr size_t kControlWord = stdlib::system_variable("ControlWord");

}  // namespace

// The bus ports are off the line until the next power-on makes them anew.
void Station::power_off() {
  if (!powered_) return;
  leave_steady();
  store_memory();
  powered_ = false;
  was_off_ = true;
  queue_.cancel(tick_);
  if (machine_) machine_->stop_all();
  movilink_.stop();
  for (const auto& port : sbus_)
    if (port) port->power_off();
  if (x13_) x13_->power_off();
  if (xt_) xt_->power_off();
  if (keypad_) keypad_->set_powered(false);
}

void Station::reconnect_serial() {
  if (x13_) {
    x13_->power_on(queue_.now());
    movilink_.connect(MovilinkBus::SerialX13, x13_->master());
  }
  if (xt_) xt_->power_on(queue_.now());
  if (xt_ && !keypad_) movilink_.connect(MovilinkBus::SerialXt, xt_->master());
  if (keypad_) keypad_->set_powered(true);
}

void Station::restart_program_memory() {
  const std::span<const uint32_t> program =
      image_ ? std::span<const uint32_t>(image_->code) : std::span<const uint32_t>();
  if (!drive_.memory().program().restart(program))
    journal_.note(queue_.now(), Weight::Warning, config_.name,
                  "the memory holds a change of another program; it is dropped");
  if (drive_.memory().program().code().empty()) return;
  if (const auto refused = start_program())
    journal_.note(queue_.now(), Weight::Warning, config_.name, "program not started: " + *refused);
}

std::optional<std::string> Station::start_program() {
  if (!powered_) return "the station is off";
  wake();
  return load_program();
}

// Also in the middle of a tick, before the tasks.
std::optional<std::string> Station::load_program() {
  const vm::Limits limits = limits_of(*config_.unit);
  std::vector<uint32_t> code = drive_.memory().program().code();
  std::array<vm::Violation, 1> violations{};
  const vm::Verification checked = vm::verify(code, limits, violations);
  if (!checked.image) {
    const vm::RuleInfo& rule = vm::info(violations[0].rule);
    return fmt::format("word {}: {} [{}]", violations[0].address, rule.meaning, rule.code);
  }
  stop_tasks();
  drive_.disconnect_program();
  code_ = std::move(code);
  timers_ = {};
  mirrored_.emplace(drive_.parameters());
  if (config_.unit->generation == stdlib::Generation::B) pid_.emplace(drive_.parameters());
  const bool of_image = image_ && code_ == image_->code;
  commands_.emplace(services(), static_cast<Sleeper&>(*this), journal_, config_.name,
                    of_image ? &*image_ : nullptr);
  const vm::VerifiedImage program = *vm::verify(code_, limits, {}).image;
  machine_.emplace(program, commands_->host());
  steady_ = false;
  quiet_ = !vm::may_write(program, stdlib::kFirstSystemVariable, stdlib::kLastSystemVariable);
  may_order_ = vm::may_write(program, kControlWord, kControlWord);
  choose_engine(program);
  if (positioning_commands_) positioning_commands_->cancel_all();
  drive_.connect_program(*machine_);
  for (const auto& port : sbus_)
    if (port) port->connect_program(*machine_);
  start_machine();
  resets_seen_ = drive_.state().resets();
  error_seen_ = 0;
  return std::nullopt;
}

void Station::start_machine() {
  machine_->start();
  forget_reach();
  fault_reported_ = false;
}

void Station::choose_engine(const vm::VerifiedImage& program) {
  if (!execution_.fast) return;
  slots_.assign(vm::fast::Predecoded::slots_needed(code_.size()), {});
  predecoded_.emplace(program, slots_);
  native_ = execution_.compiler == nullptr ? nullptr : execution_.compiler(program);
  machine_->use(&*predecoded_, native_.get());
}

void Station::stop_program() {
  wake();
  stop_tasks();
}

void Station::stop_tasks() {
  if (machine_) machine_->stop_all();
  movilink_.stop();
  for (const auto& port : sbus_)
    if (port) port->stop_program();
}

bool Station::store_memory() {
  make_up();
  const bool stored = drive_.memory().commit();
  drive_.memory().report_wear();
  for (const auto* port : {&x13_, &xt_})
    if (*port) (*port)->report(queue_.now());
  note_memory(queue_.now());
  return stored;
}

void Station::note_memory(Time now) {
  for (UnitMemory::Message& message : drive_.memory().take_messages())
    journal_.note(now, message.weight, config_.name, std::move(message.text));
}

}  // namespace ipos::runtime

// Power, program start and memory of a unit.
#include <fmt/format.h>

#include "runtime/unit/unit.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::runtime {
namespace {

static_assert(vm::kFirstSystemVariable == stdlib::kFirstSystemVariable);
static_assert(vm::kLastSystemVariable == stdlib::kLastSystemVariable);

}  // namespace

void Unit::power_on() {
  fault_reported_ = false;
  told_fault_ = 0;
  if (was_off_) {
    drive_.disconnect_program();
    machine_.reset();
    drive_.power_cycle();
  }
  movilink_.power_on(clock_.now(), config_.options.start_up_ms == 0);
  if (const uint8_t fault = drive_.memory().fault(); fault != 0) drive().raise_fault(fault);
  if (!has_variables()) return;
  begin_variables();
  if (!config_.type.has(stdlib::Trait::Positioning)) return;
  positioning_.emplace(milliseconds_, drive(), drive_.parameters(), journal_, config_.name,
                       [this](uint32_t address) { return source_place(address); });
  positioning_commands_.emplace(*positioning_);
  if (config_.options.master_encoder) synchronous_.emplace(drive(), drive_.parameters(), journal_, config_.name);
}

void Unit::restart_program_memory(Time now) {
  for (std::string& setting : drive_.parameters().tell_settings()) note(now, Weight::Why, std::move(setting));
  const std::span<const uint32_t> program =
      image_ ? std::span<const uint32_t>(image_->code) : std::span<const uint32_t>();
  if (!drive_.memory().program().restart(program))
    note(now, Weight::Warning, "the memory holds a change of another program; it is dropped");
  if (drive_.memory().program().empty()) return;
  if (const auto refused = load_program()) note(now, Weight::Warning, "program not started: " + *refused);
}

void Unit::power_off() {
  was_off_ = true;
  if (machine_) machine_->stop_all();
  movilink_.stop();
}

ProgramServices Unit::services() {
  return {clock_,
          milliseconds_,
          drive(),
          drive_.parameters(),
          timers_,
          drive_.memory(),
          movilink_,
          objects_,
          positioning_commands_ ? &*positioning_commands_ : nullptr};
}

std::optional<std::string> Unit::load_program() {
  auto made = UnitProgram::of(drive_.memory().program().code(), limits_of(config_.type), execution_);
  if (!made) return std::move(made).error();
  stop_tasks();
  in_tasks_ = false;  // of the program before, where a runner has stopped in it
  drive_.disconnect_program();
  machine_.reset();  // it stands on the program before
  program_ = *std::move(made);
  begin_variables();
  commands_.emplace(services(), journal_, config_.name, runs_image() ? &*image_ : nullptr);
  machine_.emplace(program_->verified(), commands_->host());
  machine_->use(program_->predecoded(), program_->native());
  if (positioning_commands_) positioning_commands_->cancel_all();
  drive_.connect_program(*machine_);
  start_machine();
  resets_seen_ = drive().resets();
  drive_changes_ = drive().changes() - 1;
  return std::nullopt;
}

std::optional<std::string> Unit::take_program(vm::Image image) {
  std::array<vm::Violation, 1> violations{};
  if (!vm::verify(image.code, limits_of(config_.type), violations).image) {
    const vm::RuleInfo& rule = vm::info(violations[0].rule);
    return fmt::format("word {}: {} [{}]", violations[0].address, rule.meaning, rule.code);
  }
  stop_tasks();
  image_ = std::move(image);
  drive_.memory().program().set_kept(std::nullopt);
  drive_.memory().program().restart(image_->code);
  return load_program();
}

void Unit::begin_variables() {
  timers_ = {};
  mirrored_.emplace(drive_.parameters());
  if (config_.type.has(stdlib::Trait::PidBlock)) pid_.emplace(drive_.parameters());
}

void Unit::start_machine() {
  machine_->start();
  ++programs_;
  fault_reported_ = false;
}

void Unit::stop_tasks() {
  if (machine_) machine_->stop_all();
  movilink_.stop();
  for (VariableObjects* objects : objects_)
    if (objects != nullptr) objects->stop();
}

bool Unit::store_memory(Time now) {
  const bool stored = drive_.memory().commit();
  drive_.memory().report_wear();
  report_memory(now);
  return stored;
}

}  // namespace ipos::runtime

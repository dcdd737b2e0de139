// Status words, process data and the little a standing drive does.
#include "runtime/drive/unit_state.hpp"

#include <algorithm>

#include "runtime/drive/error_memory.hpp"
#include "runtime/drive/indices.hpp"

namespace ipos::runtime {
namespace {

// Settings of P870..P872 and P873..P875 (1053 1610 p. 82).
enum PoAssignment : int32_t { kControlWord1 = 9, kControlWord2 = 10 };
enum PiAssignment : int32_t { kStatusWord1 = 6, kStatusWord2 = 7, kIposPiData = 9, kStatusWord3 = 11 };

// Functions of inputs (P600); 32 is MOVITRAC 07's.
enum InputFunction : int32_t { kLimitSwitchCw = 14, kLimitSwitchCcw = 15, kControllerInhibit = 32 };

constexpr uint16_t kControlInhibit = 1 << 0;
constexpr uint16_t kControlReset = 1 << 6;

// How long installing the factory setting takes; ours.
constexpr uint32_t kFactorySettingMs = 2000;

struct Source {
  PoSource source;
  int32_t p100;
  int32_t p101;
};
constexpr Source kSources[] = {{PoSource::Rs485, 2, 1}, {PoSource::Fieldbus, 3, 2}, {PoSource::Sbus, 10, 3}};

}  // namespace

UnitState::UnitState(ParameterStore& parameters)
    : parameters_(parameters), is_m07_(parameters.unit().generation == stdlib::Generation::M07) {
  parameters.connect(*this);
}

bool UnitState::controls(PoSource source) const {
  for (const Source& row : kSources)
    if (row.source == source) return parameters_.value(index::kControlSource) == row.p101;
  return false;
}

// P876 and a source that is a bus (MDX60B/61B p. 93).
bool UnitState::po_data_enabled() const {
  if (parameters_.value(index::kPoEnable) != 1) return false;
  const int32_t p100 = parameters_.value(index::kSetpointSource);
  const int32_t p101 = parameters_.value(index::kControlSource);
  return std::any_of(std::begin(kSources), std::end(kSources),
                     [&](const Source& row) { return p100 == row.p100 || p101 == row.p101; });
}

void UnitState::take_po(PoSource source, std::span<const uint16_t> words) {
  std::copy_n(words.begin(), std::min(words.size(), kWords), po_.begin());
  if (parameters_.value(index::kPoEnable) != 1 || !controls(source)) return;
  // The same assignment on several words: the first one counts (MOVITRAC B, unit profile).
  for (size_t n = 0; n < std::min(words.size(), kWords); ++n) {
    const int32_t assignment = parameters_.value(static_cast<uint16_t>(index::kPo1Description + n));
    if (assignment != kControlWord1 && assignment != kControlWord2) continue;
    control_source_ = source;
    take_control_word(po_[n]);
    return;
  }
}

void UnitState::take_control_word(uint16_t word) {
  const bool reset_edge = (word & kControlReset) != 0 && (control_word_ & kControlReset) == 0;
  control_word_ = word;
  if (reset_edge) reset_fault();
}

bool UnitState::bus_inhibit() const {
  return parameters_.value(index::kPoEnable) == 1 && controls(control_source_) &&
         (control_word_ & kControlInhibit) != 0;
}

bool UnitState::any_input(int32_t function, bool level) const {
  const auto has = [&](uint16_t index, unsigned bit) {
    return parameters_.table().find(index) != nullptr && parameters_.value(index) == function &&
           ((inputs_ >> bit) & 1) == (level ? 1 : 0);
  };
  for (uint16_t n = 1; n <= 5; ++n)
    if (has(static_cast<uint16_t>(index::kInputFunction + n), n)) return true;
  for (uint16_t n = 0; n < 8; ++n)
    if (has(static_cast<uint16_t>(index::kOptionInputFunction + n), 8U + n)) return true;
  return false;
}

// DI00 is /CONTROLLER INHIBIT on MOVIDRIVE; on MOVITRAC 07 an input can be given that function.
bool UnitState::terminal_inhibit() const {
  return is_m07_ ? any_input(kControllerInhibit, false) : (inputs_ & 1) == 0;
}

// MOVITRAC 07 need not have an inhibit terminal, so there a standing drive is enough for R parameters (ours).
bool UnitState::controller_inhibited() const {
  return is_m07_ ? !output_stage_on() : terminal_inhibit() || bus_inhibit();
}

UnitCondition UnitState::evaluate() const {
  if (parameters_.factory_setting_running()) return UnitCondition::FactorySetting;
  if (fault_ != 0) return UnitCondition::NotReady;
  if (terminal_inhibit() || bus_inhibit()) return UnitCondition::ControllerInhibit;
  return UnitCondition::NoEnable;
}

uint8_t UnitState::status_block() const {
  unsigned block = 0;
  if (output_stage_on()) block |= 1U << 0;
  if (ready()) block |= 1U << 1;
  if (po_data_enabled()) block |= 1U << 2;
  if (fault_ != 0) block |= 1U << 5;
  // Low-active terminals; MOVITRAC 07 keeps the bits at 0.
  if (!is_m07_ && any_input(kLimitSwitchCw, false)) block |= 1U << 6;
  if (!is_m07_ && any_input(kLimitSwitchCcw, false)) block |= 1U << 7;
  return static_cast<uint8_t>(block);
}

uint16_t UnitState::status_word_1() const {
  constexpr uint8_t kM07FactorySetting = 5;
  const UnitCondition condition = evaluate();
  uint8_t high = static_cast<uint8_t>(condition);
  if (is_m07_ && condition == UnitCondition::FactorySetting) high = kM07FactorySetting;
  if (fault_ != 0) high = fault_;
  return static_cast<uint16_t>((high << 8) | status_block());
}

UnitState::Words UnitState::pi() const {
  Words words{};
  for (size_t n = 0; n < kWords; ++n) words[n] = pi_word(n);
  return words;
}

// Speed, currents and position of a standing drive are 0, and so are words without function.
uint16_t UnitState::pi_word(size_t n) const {
  switch (parameters_.value(static_cast<uint16_t>(index::kPi1Description + n))) {
    case kStatusWord1: return status_word_1();
    case kStatusWord2: return status_word_2();
    case kStatusWord3: return status_word_3();
    case kIposPiData: return ipos_pi_[n];
    default: return 0;
  }
}

void UnitState::raise_fault(uint8_t number) {
  if (fault_ != 0) return;  // the first one stays shown
  fault_ = number;
  remember_fault(parameters_, number);
}

void UnitState::tick() {
  constexpr uint32_t kMinute = 60'000;
  if (++minute_ms_ == kMinute) {
    minute_ms_ = 0;
    parameters_.set_display(index::kMainsOnTime, parameters_.value(index::kMainsOnTime) + 1);
  }
  if (!parameters_.factory_setting_running()) return;
  if (++factory_setting_ms_ < kFactorySettingMs) return;
  factory_setting_ms_ = 0;
  parameters_.finish_factory_setting();
}

std::optional<int32_t> UnitState::live_value(uint16_t index) const {
  if (index >= index::kPoShown && index < index::kPoShown + kWords) return po_[index - index::kPoShown];
  if (index >= index::kPiShown && index < index::kPiShown + kWords) return pi_word(index - index::kPiShown);
  switch (index) {
    case index::kStatus: return status_word_1();
    case index::kInputs: return inputs_ & (is_m07_ ? 0x3E : 0x3F);  // M07 has no DI00
    case index::kOptionInputs: return inputs_ >> 8;
    default: return std::nullopt;
  }
}

void UnitState::on_parameter_written(uint16_t index, int32_t value) {
  if (index == index::kManualReset && value == 1) reset_fault();
}

}  // namespace ipos::runtime

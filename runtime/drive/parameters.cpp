// Parameter services of one unit. Where the list leaves something open, the conformance list's reading is
// taken.
#include "runtime/drive/parameters.hpp"

#include <algorithm>
#include <utility>

#include "runtime/drive/error_memory.hpp"
#include "runtime/drive/indices.hpp"
#include "stdlib/unsimulated.hpp"

namespace ipos::runtime {
namespace {

using stdlib::Parameter;
using stdlib::ReturnCode;
namespace codes = stdlib::return_codes;

struct AreaRow {
  uint16_t first;
  uint16_t count;
  bool everywhere;
};

constexpr AreaRow kAreas[] = {
#define INDEX_AREA(name, first, count, everywhere, meaning) {first, count, everywhere},
#include "stdlib/index_areas.def"
};
static_assert(std::size(kAreas) == 7, "ParameterStore::windows_ has one entry an area");

enum Attribute : int32_t {
#define ATTRIBUTE(name, bit, text) k##name = 1 << (bit),
#include "stdlib/access_attributes.def"
};

// P870..P875.
constexpr bool describes_process_data(uint16_t index) {
  return index >= index::kPo1Description && index < index::kPi1Description + 3;
}

constexpr int32_t bits(int64_t number) { return static_cast<int32_t>(static_cast<uint32_t>(number)); }

}  // namespace

ParameterStore::ParameterStore(const stdlib::UnitType& unit, DriveOptions options)
    : unit_(unit), table_(stdlib::parameter_table(unit)), options_(options) {
  slots_.reserve(table_.by_index().size());
  for (const Parameter* parameter : table_.by_index()) {
    const int32_t value = bits(parameter->default_value);
    slots_.push_back({parameter, value, value});
  }
}

bool ParameterStore::knows_service(uint8_t service) const {
  if (service > static_cast<uint8_t>(ParameterService::ReadAttribute)) return false;
  if (unit_.has(stdlib::Trait::ReadsLimits)) return true;
  const auto s = static_cast<ParameterService>(service);
  return s != ParameterService::ReadMinimum && s != ParameterService::ReadMaximum &&
         s != ParameterService::ReadScale;
}

std::optional<ParameterStore::Place> ParameterStore::locate(uint16_t index) const {
  for (size_t i = 0; i < std::size(kAreas); ++i) {
    const auto area = static_cast<IndexArea>(i);
    uint16_t count = kAreas[i].count;
    if (area == IndexArea::Variables) count = unit_.variables;
    if (area == IndexArea::Program) count = unit_.parameter_words;
    if (!kAreas[i].everywhere && !unit_.has(stdlib::Trait::IndexAreas)) continue;
    if (index >= kAreas[i].first && index - kAreas[i].first < count)
      return Place{area, static_cast<uint16_t>(index - kAreas[i].first), count};
  }
  return std::nullopt;
}

ParameterStore::Slot* ParameterStore::find(uint16_t index) {
  return const_cast<Slot*>(static_cast<const ParameterStore*>(this)->find(index));
}

const ParameterStore::Slot* ParameterStore::find(uint16_t index) const {
  const auto at =
      std::lower_bound(slots_.begin(), slots_.end(), index,
                       [](const Slot& slot, uint16_t wanted) { return slot.parameter->index < wanted; });
  return at != slots_.end() && at->parameter->index == index ? &*at : nullptr;
}

ParameterReply ParameterStore::read(uint16_t index) const {
  if (injected_) return tl::unexpected(*injected_);
  if (const Slot* slot = find(index)) return read(*slot);
  const std::optional<Place> place = locate(index);
  if (!place) return tl::unexpected(codes::kInvalidIndex);
  IndexWindow* window = windows_[static_cast<size_t>(place->area)];
  if (window == nullptr) return tl::unexpected(codes::kNotImplemented);
  return window->read(place->offset);
}

ParameterReply ParameterStore::execute(uint8_t service, uint16_t index, int32_t value) {
  if (!knows_service(service)) return tl::unexpected(codes::kWrongManagement);
  if (service == static_cast<uint8_t>(ParameterService::None)) return 0;
  if (injected_) return tl::unexpected(*injected_);
  const auto known = static_cast<ParameterService>(service);
  if (Slot* slot = find(index)) return serve(*slot, known, value);
  const std::optional<Place> place = locate(index);
  if (!place) return tl::unexpected(codes::kInvalidIndex);
  return serve_window(*place, known, index, value);
}

ParameterReply ParameterStore::serve(Slot& slot, ParameterService service, int32_t value) {
  const Parameter& parameter = *slot.parameter;
  switch (service) {
    case ParameterService::None: return 0;
    case ParameterService::Read: return read(slot);
    case ParameterService::ReadMinimum: return bits(parameter.minimum());
    case ParameterService::ReadMaximum: return bits(parameter.maximum());
    case ParameterService::ReadDefault: return bits(parameter.default_value);
    case ParameterService::ReadScale:
      return (parameter.quantity << 8) | static_cast<uint8_t>(parameter.conversion);
    case ParameterService::ReadAttribute: return attribute(slot);
    case ParameterService::Write:
    case ParameterService::WriteVolatile: break;
  }
  if (const auto code = refusal(slot, value)) return tl::unexpected(*code);
  const bool describes = describes_process_data(parameter.index);
  const int32_t before = describes ? read(slot) : 0;
  const bool stored = store(slot, value, service == ParameterService::Write);
  take_effect(parameter.index, value);
  if (describes && read(slot) != before) block_process_data(parameter);
  tell(parameter.index);
  if (!stored) return tl::unexpected(codes::kNotSaved);  // the working value is the new one
  return value;
}

ParameterReply ParameterStore::serve_window(const Place& place, ParameterService service, uint16_t index,
                                            int32_t value) {
  IndexWindow* window = windows_[static_cast<size_t>(place.area)];
  if (!window) return tl::unexpected(codes::kNotImplemented);
  if (is_write(service) && factory_setting_) return tl::unexpected(codes::kFactorySetting);
  switch (service) {
    case ParameterService::Read: return window->read(place.offset);
    case ParameterService::Write: return window->write(place.offset, value, true);
    case ParameterService::WriteVolatile: return window->write(place.offset, value, false);
    case ParameterService::ReadMinimum: return INT32_MIN;
    case ParameterService::ReadMaximum: return INT32_MAX;
    case ParameterService::ReadAttribute: {
      const int32_t next = place.offset + 1 < place.count ? index + 1 : 0;
      const int32_t kept = window->stored(place.offset) ? kStored | kRestored : 0;
      return bits(int64_t{next} << 16) | kWritable | kNoInhibitNeeded | kept;
    }
    case ParameterService::None:
    case ParameterService::ReadDefault:
    case ParameterService::ReadScale: break;  // 0; quantity and conversion index 0 = plain number
  }
  return 0;
}

int32_t ParameterStore::read(const Slot& slot) const {
  if (drive_)
    if (const auto live = drive_->live_value(slot.parameter->index)) return *live;
  return slot.working;
}

int32_t ParameterStore::value(uint16_t index) const {
  const Slot* slot = find(index);
  return slot ? read(*slot) : 0;
}

int32_t ParameterStore::stored(uint16_t index) const {
  const Slot* slot = find(index);
  return slot ? slot->working : 0;
}

std::optional<size_t> ParameterStore::slot_of(uint16_t index) const {
  const Slot* slot = find(index);
  return slot ? std::optional(static_cast<size_t>(slot - slots_.data())) : std::nullopt;
}

bool ParameterStore::has_card(stdlib::OptionCard card) const {
  switch (card) {
    case stdlib::OptionCard::Drs: return options_.drs;
    case stdlib::OptionCard::Dio: return options_.dio;
    case stdlib::OptionCard::Aio: return options_.aio;
    case stdlib::OptionCard::None: break;
  }
  return true;
}

std::optional<ReturnCode> ParameterStore::refusal(const Slot& slot, int32_t value) const {
  const Parameter& parameter = *slot.parameter;
  if (!parameter.writable) return codes::kReadOnly;
  // 1Eh answers a second order to do what is being done (ours; 1053 1610 p. 66 gives only its text).
  if (factory_setting_)
    return parameter.index == index::kFactorySetting && value == 1 ? codes::kFactorySettingStarted
                                                                   : codes::kFactorySetting;
  if (!has_card(parameter.option)) return codes::kOptionMissing;
  if (!parameter.writable_locked && this->value(index::kParameterLock) == 1) return codes::kParameterLock;
  if (parameter.needs_inhibit && drive_ && !drive_->controller_inhibited()) return codes::kInhibitRequired;
  if (parameter.needs_output_stage_off && drive_ && drive_->output_stage_on())
    return codes::kOutputStageEnabled;
  return value_refusal(parameter, value);
}

std::optional<ReturnCode> ParameterStore::value_refusal(const Parameter& parameter, int32_t value) const {
  const int64_t number = parameter.number_of(value);
  if (number < parameter.minimum()) return codes::kTooSmall;
  if (number > parameter.maximum()) return codes::kTooLarge;
  if (parameter.ranges.empty() && parameter.texts.empty()) return std::nullopt;
  // Off the grid and in a gap between codes: 1Dh (PAR-21).
  for (const stdlib::ValueRange& range : parameter.ranges)
    if (number >= range.minimum && number <= range.maximum && (number - range.minimum) % range.step == 0)
      return std::nullopt;
  for (const stdlib::ValueText& row : parameter.texts)
    if (row.value == number && (options_.logodrive || !row.logodrive_only) &&
        options_.firmware_from(row.from_standard, row.from_logodrive))
      return std::nullopt;
  return codes::kIncorrectValue;
}

// False: service Write could not store it, and the EEPROM keeps the value it had.
bool ParameterStore::store(Slot& slot, int32_t value, bool nonvolatile) {
  ++changes_;
  slot.working = value;
  if (!nonvolatile || !slot.parameter->nonvolatile) return true;
  count_eeprom_write(slot.parameter->index);
  const int32_t before = std::exchange(slot.eeprom, value);
  if (memory_ == nullptr || memory_->save(slot.parameter->index)) return true;
  slot.eeprom = before;
  return false;
}

void ParameterStore::tell_memory() {
  if (memory_ != nullptr) memory_->changed();
}

void ParameterStore::take_effect(uint16_t index, int32_t value) {
  switch (index) {
    case index::kFactorySetting: factory_setting_ = value == 1; break;
    case index::kResetStatistics:
      if (value == 1) clear_error_memory(*this);
      if (value == 2) set_display(index::kEnergy, 0);
      if (value == 3) {
        set_display(index::kMainsOnTime, 0);
        set_display(index::kEnabledTime, 0);
      }
      break;
    default: break;
  }
  if (drive_) drive_->on_parameter_written(index, value);
  // Orders, not settings: they read as 0 again once carried out.
  if (index == index::kResetStatistics || index == index::kManualReset) find(index)->working = 0;
}

// A unit of the newer unit profile takes no process data any more when their description is changed, until
// P876 is written ON again (documentation of MOVITRAC B; that MDX60B/61B does the same, and only its working
// value, is ours).
void ParameterStore::block_process_data(const Parameter& changed) {
  if (!unit_.has(stdlib::Trait::BlocksProcessData) || stored(index::kPoEnable) == 0) return;
  set_working(index::kPoEnable, 0);
  if (!told_.emplace(changed.index, nullptr).second) return;
  news_.push_back("P" + std::string(changed.number) + " " + std::string(changed.name) +
                  " was changed: PO data have no effect until P876 PO data enable is written ON again");
}

bool ParameterStore::counts(const stdlib::Unsimulated& one) const {
  using Scope = stdlib::UnsimulatedScope;
  if (one.row->scope == Scope::Uncoupled) return !options_.master_encoder;
  return one.row->scope != Scope::Ideal || !options_.real_control;
}

void ParameterStore::tell(uint16_t index) {
  for (const stdlib::Unsimulated& one : stdlib::unsimulated(unit_, index)) {
    const int32_t value = this->value(index);
    if (counts(one) && one.applies(value) && told_.emplace(index, one.row).second) news_.push_back(one.text(value));
  }
}

std::vector<std::string> ParameterStore::tell_settings() {
  auto slot = slots_.cbegin();
  for (const stdlib::Unsimulated& one : stdlib::unsimulated(unit_)) {  // in the order of the indices, as the slots
    while (slot->parameter != one.parameter) ++slot;
    const int32_t value = read(*slot);
    if (counts(one) && one.applies(value) && told_.emplace(one.parameter->index, one.row).second) news_.push_back(one.text(value));
  }
  return take_news();
}

ParameterReply ParameterStore::preset(uint16_t index, int32_t value) {
  Slot* slot = find(index);
  if (!slot) return execute(ParameterService::Write, index, value);
  if (!slot->parameter->writable) return tl::unexpected(codes::kReadOnly);
  if (const auto code = value_refusal(*slot->parameter, value)) return tl::unexpected(*code);
  ++changes_;
  slot->working = value;
  slot->eeprom = value;
  tell_memory();
  return value;
}

void ParameterStore::set_display(uint16_t index, int32_t value) {
  Slot* slot = find(index);
  if (!slot) return;
  slot->working = value;
  // Counters and error memory survive power-off; the drive spreads these writes, so they do not count as
  // wear.
  slot->eeprom = value;
  if (slot->parameter->nonvolatile) tell_memory();
}

void ParameterStore::set_working(uint16_t index, int32_t value) {
  Slot* slot = find(index);
  if (!slot) return;
  const Parameter& parameter = *slot->parameter;
  ++changes_;
  slot->working = bits(std::clamp(parameter.number_of(value), parameter.minimum(), parameter.maximum()));
}

void ParameterStore::power_cycle() {
  ++changes_;
  factory_setting_ = false;
  for (Slot& slot : slots_)
    slot.working = slot.parameter->nonvolatile ? slot.eeprom : bits(slot.parameter->default_value);
}

void ParameterStore::finish_factory_setting() {
  ++changes_;
  factory_setting_ = false;
  for (Slot& slot : slots_) {
    if (!slot.parameter->writable) continue;  // counters and error memory stay
    const int32_t value = bits(slot.parameter->default_value);
    slot.working = value;
    if (slot.parameter->nonvolatile && slot.eeprom != value) count_eeprom_write(slot.parameter->index);
    slot.eeprom = value;
  }
  tell_memory();
}

std::vector<std::pair<uint16_t, int32_t>> ParameterStore::kept() const {
  std::vector<std::pair<uint16_t, int32_t>> values;
  values.reserve(slots_.size());
  for (const Slot& slot : slots_)
    if (slot.parameter->nonvolatile) values.emplace_back(slot.parameter->index, slot.eeprom);
  return values;
}

std::vector<uint16_t> ParameterStore::restore(std::span<const std::pair<uint16_t, int32_t>> values) {
  ++changes_;
  for (Slot& slot : slots_) slot.working = slot.eeprom = bits(slot.parameter->default_value);
  std::vector<uint16_t> dropped;
  for (const auto& [index, value] : values) {
    Slot* slot = find(index);
    const bool legal = slot != nullptr && slot->parameter->nonvolatile &&
                       (!slot->parameter->writable || !value_refusal(*slot->parameter, value));
    if (legal)
      slot->working = slot->eeprom = value;
    else
      dropped.push_back(index);
  }
  return dropped;
}

uint32_t ParameterStore::eeprom_writes(uint16_t index) const {
  const auto found = eeprom_writes_.find(index);
  return found == eeprom_writes_.end() ? 0 : found->second;
}

int32_t ParameterStore::attribute(const Slot& slot) const {
  const Parameter& parameter = *slot.parameter;
  int32_t attributes = 0;
  if (parameter.writable)
    attributes |= kWritable | kFactoryRam | (parameter.nonvolatile ? kFactoryEeprom : 0);
  if (parameter.nonvolatile) attributes |= kStored | kRestored;
  if (!parameter.needs_inhibit) attributes |= kNoInhibitNeeded;
  const bool last = &slot == &slots_.back();
  const int32_t next = last ? 0 : (&slot + 1)->parameter->index;
  return bits(int64_t{next} << 16) | attributes;
}

}  // namespace ipos::runtime

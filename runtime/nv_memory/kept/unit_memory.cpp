// What a unit keeps, to and from the medium.
#include "runtime/nv_memory/kept/unit_memory.hpp"

#include <cassert>

#include <fmt/format.h>

namespace ipos::runtime {
namespace {

struct Area {
  uint16_t first;
  uint16_t count;
};
constexpr Area kMemoryAreas[] = {
#define INDEX_AREA(name, first, count, everywhere, meaning) {first, count},
#include "stdlib/index_areas.def"
};
constexpr const Area& area(IndexArea which) { return kMemoryAreas[static_cast<size_t>(which)]; }

constexpr uint8_t kEepromFault = 25, kChecksumFault = 94;

constexpr uint16_t kKeptVariables = 128;  // H0..H127 (IPOSplus p. 320)

}  // namespace

UnitMemory::UnitMemory(ParameterStore& parameters)
    : parameters_(parameters),
      variables_(*this, area(IndexArea::Variables).first, parameters.unit().variables, kKeptVariables),
      curve_points_(*this, area(IndexArea::CurvePoints).first, area(IndexArea::CurvePoints).count,
                    area(IndexArea::CurvePoints).count),
      program_(*this, area(IndexArea::Program).first, parameters.unit().parameter_words) {
  parameters_.connect(*this);
  parameters_.plug(IndexArea::Variables, variables_);
  parameters_.plug(IndexArea::CurvePoints, curve_points_);
  parameters_.plug(IndexArea::Program, program_);
}

std::optional<std::string> UnitMemory::open(std::unique_ptr<NvMedium> medium, std::string name) {
  assert(!slots_);  // once
  medium_ = std::move(medium);
  name_ = std::move(name);
  slots_.emplace(*medium_, parameters_.unit().code);
  const NvLoad loaded = load();
  if (loaded.outcome != NvOutcome::Refused && loaded.outcome != NvOutcome::Failed) return std::nullopt;
  slots_.reset();
  medium_.reset();
  return fmt::format("{}: {}", name_, loaded.text);
}

void UnitMemory::reload() {
  if (!slots_) {  // kept for the run only
    for (ValueWindow* window : windows()) window->restart();
    return;
  }
  const NvLoad loaded = load();
  if (loaded.outcome != NvOutcome::Refused && loaded.outcome != NvOutcome::Failed) return;
  tell(Weight::Warning, loaded.text + ": factory values, and nothing is stored any more");
  fault_ = kEepromFault;
  slots_.reset();
}

NvLoad UnitMemory::load() {
  NvLoad loaded = slots_->load();
  const bool whole = loaded.outcome == NvOutcome::Loaded;
  fault_ = loaded.outcome == NvOutcome::Damaged ? kChecksumFault : 0;
  if (loaded.outcome == NvOutcome::Damaged)
    tell(Weight::Warning, loaded.text + ": the unit starts with factory values");
  if (whole && !loaded.text.empty()) tell(Weight::Why, loaded.text);
  take_over(loaded.content);
  dirty_ = !whole;
  return loaded;
}

void UnitMemory::take_over(const NvContent& content) {
  std::vector<std::pair<uint16_t, int32_t>> parameters;
  for (ValueWindow* window : windows()) std::fill(window->kept().begin(), window->kept().end(), 0);
  for (const auto& [index, value] : content.values) {
    int32_t* place = nullptr;
    for (ValueWindow* window : windows())
      if (place == nullptr) place = window->kept_at(index);
    if (place != nullptr)
      *place = value;
    else
      parameters.emplace_back(index, value);
  }
  for (const uint16_t index : parameters_.restore(parameters))
    tell(Weight::Warning,
         fmt::format("holds a value of index {} that this unit refuses; it is dropped", index));
  parameters_.restore_writes({content.writes.begin(), content.writes.end()});
  program_.set_kept(content.program);
  for (ValueWindow* window : windows()) window->restart();
}

NvContent UnitMemory::content() const {
  NvContent content;
  content.values = parameters_.kept();
  for (const ValueWindow* window : {&variables_, &curve_points_})
    for (size_t n = 0; n < window->kept().size(); ++n)
      if (window->kept()[n] != 0)
        content.values.emplace_back(static_cast<uint16_t>(window->first_index() + n), window->kept()[n]);
  content.writes.assign(parameters_.eeprom_writes().begin(), parameters_.eeprom_writes().end());
  content.program = program_.kept();
  return content;
}

bool UnitMemory::commit() {
  if (!dirty_ && !failed_) return true;
  dirty_ = failed_ = false;
  if (!slots_) return true;
  const auto why = slots_->save(content());
  if (!why) return true;
  failed_ = true;
  tell(Weight::Warning, "not stored: " + *why);
  return false;
}

void UnitMemory::report_wear() {
  for (const WearWatch::Use& use : wear_.uses())
    messages_.push_back(
        {Weight::Why,
         fmt::format("{} was stored {} times, every {}.{:03} s on average: at this rate the memory lasts {}",
                     stdlib::index_name(parameters_.table(), use.index), use.writes, use.interval / kSecond,
                     use.interval / kMillisecond % 1000, memory_life(use.interval))});
}

void UnitMemory::count(uint16_t index) {
  const std::string name = stdlib::index_name(parameters_.table(), index);
  if (auto warning = wear_.note(now_, index, parameters_.eeprom_writes(index), name))
    messages_.push_back({Weight::Warning, std::move(*warning)});
}

bool UnitMemory::save(uint16_t index) {
  // A parameter has been counted by its store.
  if (parameters_.table().find(index) == nullptr) parameters_.count_eeprom_write(index);
  count(index);
  dirty_ = true;
  return commit();
}

bool UnitMemory::memorize(Memorize what) {
  const bool all = what == Memorize::StoreAll;
  if (what == Memorize::LoadAll)
    std::copy(variables_.kept().begin(), variables_.kept().end(), variables_.words().begin());
  if (all || what == Memorize::StoreProgram) program_.keep();
  if (all || what == Memorize::StoreData) {
    for (size_t n = 0; n < variables_.kept().size(); ++n) {
      if (variables_.kept()[n] == variables_.words()[n]) continue;  // nothing is written, nothing wears
      variables_.kept()[n] = variables_.words()[n];
      const auto index = static_cast<uint16_t>(variables_.first_index() + n);
      parameters_.count_eeprom_write(index);
      count(index);
      dirty_ = true;
    }
  }
  dirty_ |= all || what == Memorize::StoreProgram;
  return commit();
}

void UnitMemory::tell(Weight weight, const std::string& text) {
  messages_.push_back({weight, name_ + ": " + text});
}

}  // namespace ipos::runtime

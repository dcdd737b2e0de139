// Goes through the table of telegrams.
#include "runtime/bus/movilink/profile.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

constexpr int32_t kGroupBase = 100;

std::vector<IdentifierUse> sorted(std::vector<IdentifierUse> uses) {
  std::sort(uses.begin(), uses.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return uses;
}

}  // namespace

std::vector<IdentifierUse> slave_identifiers(const SlaveSettings& settings) {
  std::vector<IdentifierUse> uses;
  for (const TelegramType& type : kTelegrams) {
    if (!has_telegram(settings, type.telegram)) continue;
    const uint8_t address = type.grouped ? settings.group : settings.address;
    uses.push_back({sbus_identifier(type.telegram, address), type.telegram, address, !type.from_master});
  }
  return sorted(std::move(uses));
}

std::vector<IdentifierUse> master_identifiers(int32_t address, const SlaveSettings& settings) {
  SlaveSettings called = settings;
  called.second_channel = false;
  const bool group = address >= kGroupBase;
  const auto number = static_cast<uint8_t>(group ? address - kGroupBase : address);
  std::vector<IdentifierUse> uses;
  for (const TelegramType& type : kTelegrams)
    if (type.grouped == group && has_telegram(called, type.telegram))
      uses.push_back({sbus_identifier(type.telegram, number), type.telegram, number, type.from_master});
  return sorted(std::move(uses));
}

}  // namespace ipos::runtime

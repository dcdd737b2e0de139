// Collects addresses, groups and identifiers of the stations asked for.
#include "runtime/bus/movilink/station_filter.hpp"

#include <algorithm>
#include <charconv>

namespace ipos::runtime {
namespace {

template <typename Value>
bool contains(const std::vector<Value>& values, Value value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

}  // namespace

std::optional<uint8_t> station_number(std::string_view text) {
  uint8_t address = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), address);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return address;
}

bool StationFilter::add(const TelegramNames& names, std::string_view station) {
  bool known = false;
  for (const UnitNames& unit : names.units)
    if (unit.name == station) {
      add(names, unit);
      known = true;
    }
  if (known) return true;
  const auto address = station_number(station);
  if (!address) return false;
  if (const UnitNames* unit = names.unit_at(*address)) add(names, *unit);
  addresses_.push_back(*address);
  all_ = false;
  return true;
}

void StationFilter::add(uint32_t identifier) {
  all_ = false;
  identifiers_.push_back(identifier);
}

void StationFilter::add(const TelegramNames& names, const UnitNames& unit) {
  all_ = false;
  addresses_.push_back(unit.settings.address);
  groups_.push_back(unit.settings.group);
  if (unit.settings.synchronous) identifiers_.push_back(unit.settings.sync_id);
  for (const ObjectNames& object : names.objects)
    if (object.station == unit.name) identifiers_.push_back(object.id);
}

bool StationFilter::is_addressed(uint8_t address, bool group) const {
  return contains(group ? groups_ : addresses_, address);
}

bool StationFilter::passes(const Frame& frame) const {
  if (all_) return true;
  if (!is_plain(frame)) return false;
  if (contains(identifiers_, frame.id)) return true;
  const auto identifier = classify_identifier(frame.id);
  return identifier && is_addressed(identifier->address, telegram_type(identifier->telegram).grouped);
}

bool StationFilter::passes(const SerialTelegram& telegram) const {
  if (all_) return true;
  switch (address_kind(telegram.address)) {
    case AddressKind::Broadcast:
    case AddressKind::Universal: return true;
    case AddressKind::Group: return is_addressed(telegram.address, true);
    default: return is_addressed(telegram.address, false);
  }
}

}  // namespace ipos::runtime

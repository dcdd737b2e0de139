// Reading and writing objects, and what an entry asks of a value (CiA 301; pages 53 and 54 of 11264926 for
// EMCY, guarding and heartbeat).
#include "runtime/bus/canopen/object_access.hpp"

#include <algorithm>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/mapping.hpp"
#include "stdlib/index_areas.hpp"
#include "stdlib/parameters.hpp"

namespace ipos::runtime::canopen {
namespace {

constexpr uint16_t kFirstParameter = 0x2000;
constexpr uint32_t kShortestLifeTime = 10;  // ms, page 54
constexpr uint16_t kPdoObjects = 0x200;     // from a communication to its mapping parameter

std::vector<uint8_t> low_byte_first(uint32_t value, uint8_t bytes) {
  std::vector<uint8_t> data;
  for (uint8_t n = 0; n < bytes; ++n) data.push_back(static_cast<uint8_t>(value >> 8 * n));
  return data;
}

uint32_t number_of(std::span<const uint8_t> data) {
  uint32_t value = 0;
  for (size_t n = 0; n < data.size(); ++n) value |= uint32_t{data[n]} << 8 * n;
  return value;
}

// The identifier with bit 29, which makes it one of 29 bits; no unit has those.
constexpr uint32_t kFrame = objects::kExtended | (objects::kExtended - 1);

// An 11-bit identifier that may be chosen, of whichever object. What is off may have 0 in its place, which is none (ours:
// CiA 301 restricts 0, and masters switch off with 80000000h).
bool is_identifier(uint32_t cob_id) {
  const uint32_t id = cob_id & kFrame;
  if ((cob_id & objects::kOff) != 0 && id == 0) return true;
  return id <= objects::kIdMask && !is_restricted(id);
}

// Between the two there is one object less that may be written: guarding or heartbeat, never both.
std::optional<Abort> check_life_time(uint32_t guard_time, uint32_t factor, uint32_t producer) {
  const uint32_t life_time = guard_time * factor;
  if (life_time == 0) return std::nullopt;
  if (life_time < kShortestLifeTime) return Abort::TooLow;
  return producer != 0 ? std::optional(Abort::Incompatible) : std::nullopt;
}

std::optional<Abort> check_consumer(uint32_t value, uint8_t own_node) {
  const uint32_t node = value >> 16;
  if (node > kMaxNode) return Abort::Value;
  return node == own_node ? std::optional(Abort::Incompatible) : std::nullopt;
}

std::optional<Abort> unless(bool good, Abort abort) { return good ? std::nullopt : std::optional(abort); }

}  // namespace

Mapping mapping_of(const ObjectDictionary& dictionary, uint16_t mapping_index) {
  Mapping mapping;
  const uint32_t count = std::min<uint32_t>(dictionary.value(mapping_index), objects::kMappedObjects);
  for (uint8_t n = 1; n <= count; ++n) mapping.push_back(mapped_of(dictionary.value(mapping_index, n)));
  return mapping;
}

unsigned bits_of(const Mapping& mapping) {
  unsigned bits = 0;
  for (const Mapped& mapped : mapping) bits += mapped.bits;
  return bits;
}

ObjectAccess::ObjectAccess(ObjectDictionary& dictionary, const stdlib::UnitType& type,
                           ParameterServer& parameters, Unit& unit, const State& state, Listener& listener)
    : dictionary_(dictionary),
      type_(type),
      parameters_(parameters),
      unit_(unit),
      state_(state),
      listener_(listener) {}

std::string ObjectAccess::text(Time now, Rule rule) {
  if (rule == Rule::DeviceName) return std::string(type_.title);
  if (rule == Rule::HardwareVersion) return std::string(type_.name);
  const stdlib::Parameter* firmware = stdlib::parameter_table(type_).find(stdlib::kFirmwareIndex);
  const auto value = parameters_.serve(now, {Service::Read, stdlib::kFirmwareIndex, 0, 0});
  return firmware == nullptr || !value ? "unknown" : stdlib::parameter_text(*firmware, *value);
}

tl::expected<std::vector<uint8_t>, Abort> ObjectAccess::read(Time now, Address address) {
  const ObjectDictionary::Entry* entry = dictionary_.find(address);
  if (entry == nullptr) {
    if (find_object(address.index) != nullptr) return tl::unexpected(Abort::NoSubindex);
    return read_parameter(now, address);
  }
  const EntryRow& row = *entry->row;
  if (row.access == Access::Dummy) return tl::unexpected(Abort::NoObject);
  if (row.type == DataType::VisibleString) {
    const std::string value = text(now, row.rule);
    return std::vector<uint8_t>(value.begin(), value.end());
  }
  // The list of errors is as long as there are errors.
  if (row.rule == Rule::ErrorEntry && address.sub > dictionary_.value(address.index))
    return tl::unexpected(Abort::NoData);
  const auto word = static_cast<size_t>(address.sub - 1);  // of an input
  const uint32_t value =
      row.rule == Rule::Input ? unit_.input(now, static_cast<uint16_t>(1U << word))[word] : entry->value;
  return low_byte_first(value, bytes_of(row.type));
}

tl::expected<std::vector<uint8_t>, Abort> ObjectAccess::read_parameter(Time now, Address address) {
  if (address.index < kFirstParameter) return tl::unexpected(Abort::NoObject);
  const auto value = parameters_.serve(now, {Service::Read, address.index, 0, 0});
  if (!value) return tl::unexpected(abort_of(value.error()));
  if (address.sub != 0) return tl::unexpected(Abort::NoSubindex);
  return low_byte_first(static_cast<uint32_t>(*value), 4);
}

std::optional<Abort> ObjectAccess::refuses(Time now, Address address) {
  const ObjectDictionary::Entry* entry = dictionary_.find(address);
  if (entry != nullptr && entry->row->access != Access::Dummy)
    return unless(is_writable(entry->row->access), Abort::ReadOnly);
  if (find_object(address.index) != nullptr) return Abort::NoSubindex;
  if (address.index < kFirstParameter) return Abort::NoObject;
  if (address.sub == 0) return std::nullopt;  // the unit says
  const auto found = read_parameter(now, address);
  return found ? std::nullopt : std::optional(found.error());
}

std::optional<Abort> ObjectAccess::write(Time now, Address address, std::span<const uint8_t> data) {
  if (const auto refused = refuses(now, address)) return refused;
  const ObjectDictionary::Entry* entry = dictionary_.find(address);
  if (entry == nullptr) return write_parameter(now, address, data);
  const EntryRow& row = *entry->row;
  if (data.size() != bytes_of(row.type)) return Abort::Length;
  const uint32_t value = number_of(data);
  if (const auto refused = check(now, *entry, value)) return refused;
  dictionary_.set(address, value);
  listener_.on_written(now, address, row.rule);
  return std::nullopt;
}

// It is stored like a write over any other bus (ours: the manual names no service).
std::optional<Abort> ObjectAccess::write_parameter(Time now, Address address, std::span<const uint8_t> data) {
  if (data.size() != 4) return Abort::Length;
  const auto written =
      parameters_.serve(now, {Service::Write, address.index, 0, static_cast<int32_t>(number_of(data))});
  return written ? std::nullopt : std::optional(abort_of(written.error()));
}

bool ObjectAccess::pdo_is_on(uint16_t index) const {
  return (dictionary_.value(index, objects::kCobId) & objects::kOff) == 0;
}

std::optional<Abort> ObjectAccess::check(Time now, const ObjectDictionary::Entry& entry, uint32_t value) {
  const Address at = entry.address;
  const auto present = [&](uint16_t index) { return dictionary_.value(index); };
  switch (entry.row->rule) {
    case Rule::ErrorCount: return unless(value == 0, Abort::Value);
    case Rule::SyncId:
      // The unit sends no SYNC, and bit 31 says nothing here.
      return unless((value & objects::kNoRemote) == 0 && is_identifier(value & ~objects::kOff), Abort::Value);
    case Rule::EmergencyId:
      if (state_ != State::PreOperational) return Abort::State;
      return unless((value & objects::kNoRemote) == 0 && is_identifier(value), Abort::Value);
    case Rule::GuardTime:
      return check_life_time(value, present(objects::kLifeFactor), present(objects::kProducerHeartbeat));
    case Rule::LifeFactor:
      return check_life_time(present(objects::kGuardTime), value, present(objects::kProducerHeartbeat));
    case Rule::Producer:
      return unless(value == 0 || present(objects::kGuardTime) * present(objects::kLifeFactor) == 0,
                    Abort::Incompatible);
    case Rule::Consumer: return check_consumer(value, dictionary_.node());
    case Rule::PdoId: return check_pdo_id(at, entry.value, value);
    case Rule::ReceiveType: return unless(value <= 240 || value >= 254, Abort::Value);
    case Rule::TransmitType: return unless(value <= 240 || value >= 252, Abort::Value);
    case Rule::InhibitTime: return unless(!pdo_is_on(at.index), Abort::Value);
    case Rule::MappingCount: return check_mapping_count(now, at.index, value);
    case Rule::MappingEntry:
      if (pdo_is_on(at.index - kPdoObjects) || present(at.index) != 0) return Abort::Access;
      return value == 0 ? std::nullopt : check_mapped(now, at.index, value);
    case Rule::Output: return unless(has_pdo(state_), Abort::State);
    case Rule::None:
    case Rule::DeviceName:
    case Rule::HardwareVersion:
    case Rule::SoftwareVersion:
    case Rule::ErrorEntry:
    case Rule::Input: break;
  }
  return std::nullopt;
}

// Its identifier changes only while the PDO is off. One that carries nothing is not switched on (ours).
std::optional<Abort> ObjectAccess::check_pdo_id(Address address, uint32_t old, uint32_t value) const {
  if (!is_identifier(value)) return Abort::Value;
  if ((value & objects::kOff) != 0) return std::nullopt;
  if ((old & objects::kOff) == 0 && (old & kFrame) != (value & kFrame)) return Abort::Value;
  return unless(dictionary_.value(address.index + kPdoObjects) != 0, Abort::Value);
}

std::optional<Abort> ObjectAccess::check_mapping_count(Time now, uint16_t index, uint32_t count) {
  if (pdo_is_on(index - kPdoObjects)) return Abort::Access;
  if (count > objects::kMappedObjects) return Abort::TooHigh;
  unsigned bits = 0;
  for (uint8_t n = 1; n <= count; ++n) {
    const uint32_t entry = dictionary_.value(index, n);
    if (const auto refused = check_mapped(now, index, entry)) return refused;
    bits += mapped_of(entry).bits;
  }
  return unless(bits <= kPdoBits, Abort::PdoTooLong);
}

std::optional<Abort> ObjectAccess::check_mapped(Time now, uint16_t mapping_index, uint32_t value) {
  const Mapped mapped = mapped_of(value);
  const ObjectDictionary::Entry* entry = dictionary_.find(mapped.address);
  if (entry == nullptr) {
    const auto found = read(now, mapped.address);
    return found ? Abort::NotMappable : found.error();
  }
  const EntryRow& row = *entry->row;
  const bool receive = mapping_index < objects::kTransmitPdo;
  const bool mappable =
      receive ? row.access == Access::Receive || row.access == Access::Dummy : row.access == Access::Transmit;
  return unless(mappable && mapped.bits == 8 * bytes_of(row.type), Abort::NotMappable);
}

}  // namespace ipos::runtime::canopen

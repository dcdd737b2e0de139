// The object dictionary of a node as data, from objects.def: what there is, and the values of what can be set.
// The parameters of the unit are not in it; they keep their values where they always are.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::runtime::canopen {

enum class ObjectKind : uint8_t { Variable = 7, Array = 8, Record = 9 };  // codes of CiA 301

enum class DataType : uint8_t {  // codes of CiA 301
  Integer32 = 4,
  Unsigned8 = 5,
  Unsigned16 = 6,
  Unsigned32 = 7,
  VisibleString = 9
};
constexpr uint8_t bytes_of(DataType type) {  // 0: as many as the text has
  switch (type) {
    case DataType::Unsigned8: return 1;
    case DataType::Unsigned16: return 2;
    case DataType::Integer32:
    case DataType::Unsigned32: return 4;
    case DataType::VisibleString: break;
  }
  return 0;
}

enum class Access : uint8_t { Constant, ReadOnly, ReadWrite, Receive, Transmit, Dummy };
constexpr bool is_writable(Access access) { return access == Access::ReadWrite || access == Access::Receive; }

enum class Rule : uint8_t {
  None,
  DeviceName,
  HardwareVersion,
  SoftwareVersion,
  ErrorCount,
  ErrorEntry,
  SyncId,
  EmergencyId,
  GuardTime,
  LifeFactor,
  Consumer,
  Producer,
  PdoId,
  ReceiveType,
  TransmitType,
  InhibitTime,
  MappingCount,
  MappingEntry,
  Output,
  Input,
};

struct Address {
  uint16_t index = 0;
  uint8_t sub = 0;
  friend auto operator<=>(const Address&, const Address&) = default;
};

struct ObjectRow {
  uint16_t index;
  ObjectKind kind;
  std::string_view name;
};

struct EntryRow {
  uint16_t index;
  uint8_t sub;
  uint8_t subs;
  std::string_view name;
  DataType type;
  Access access;
  uint32_t value;
  uint32_t step;
  bool own;  // the node number is added to the default
  Rule rule;

  uint32_t default_of(uint8_t sub_index) const {
    return value + step * static_cast<uint32_t>(sub_index - sub);
  }
};

std::span<const ObjectRow> object_rows();
std::span<const EntryRow> entry_rows();
const ObjectRow* find_object(uint16_t index);  // nullptr when there is none

// "PO3", "TPDO1 mapped object 2", "Guard time"; empty when there is none.
std::string entry_name(Address address);

namespace objects {
inline constexpr uint16_t kErrorRegister = 0x1001, kErrorField = 0x1003, kSyncId = 0x1005,
                          kGuardTime = 0x100C, kLifeFactor = 0x100D, kEmergencyId = 0x1014,
                          kEmergencyInhibit = 0x1015, kConsumerHeartbeat = 0x1016,
                          kProducerHeartbeat = 0x1017, kReceivePdo = 0x1400, kReceiveMapping = 0x1600,
                          kTransmitPdo = 0x1800, kTransmitMapping = 0x1A00, kOutput = 0x2000, kInput = 0x2001;
inline constexpr uint8_t kPdos = 4;           // each way
inline constexpr uint8_t kMappedObjects = 8;  // of a PDO
inline constexpr uint8_t kProcessWords = 10;
// Sub-indices of PDO communication parameters.
inline constexpr uint8_t kCobId = 1, kType = 2, kInhibitTime = 3, kEventTimer = 5;
// Bits of COB-ID entries.
inline constexpr uint32_t kOff = 1U << 31, kNoRemote = 1U << 30, kExtended = 1U << 29, kIdMask = 0x7FF;
}  // namespace objects

// The numbers, from 0, of the process words of which the bit is set, in rising order.
template <typename Visit>
void each_word(uint16_t which, Visit visit) {
  for (unsigned left = which & ((1U << objects::kProcessWords) - 1); left != 0; left &= left - 1)
    visit(static_cast<size_t>(std::countr_zero(left)));
}

class ObjectDictionary {
 public:
  explicit ObjectDictionary(uint8_t node);

  // All values as after power-on.
  void restore();

  struct Entry {
    Address address;
    const EntryRow* row;
    uint32_t value;
  };
  uint8_t node() const { return node_; }
  std::span<const Entry> entries() const { return entries_; }  // in rising order
  const Entry* find(Address address) const;                    // nullptr when there is none

  // Of an entry that there is.
  uint32_t value(uint16_t index, uint8_t sub = 0) const { return find({index, sub})->value; }
  void set(Address address, uint32_t value);
  // The process words PO1 to PO10 of which the bit is set, PO1 in bit 0.
  void set_outputs(const std::array<uint16_t, objects::kProcessWords>& words, uint16_t which);

 private:
  static std::vector<Entry> defaults();  // of node 0, in rising order

  uint8_t node_;
  std::vector<Entry> entries_;
  size_t outputs_;  // the place of PO1
};

}  // namespace ipos::runtime::canopen

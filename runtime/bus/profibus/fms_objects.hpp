// The object list of the FMS card and what reading and writing its objects does (MOVITRAC 31 PROFIBUS, 4.2).
// Objects below 1000 are the card's own; from 1000 on they are the parameters of the inverter.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/bus/movilink/return_code.hpp"
#include "runtime/bus/profibus/dp_slave.hpp"
#include "runtime/bus/profibus/fieldbus_parameters.hpp"

namespace ipos::profibus {

enum class FmsAccess : uint8_t { All, Read, Write };

// As Get-OV describes it: a simple variable (object code 7) of type octet string (10), without password,
// groups, name and extension.
struct FmsObject {
  static constexpr uint8_t kObjectCode = 7;
  static constexpr uint8_t kDataType = 10;

  uint16_t index;
  uint8_t length;
  FmsAccess access;
  std::string_view name;  // for people; the description has none
  friend bool operator==(const FmsObject&, const FmsObject&) = default;
};

// --- contents of the longer objects

struct BlockEntry {
  uint16_t index;  // on the fieldbus
  uint32_t data;
  friend bool operator==(const BlockEntry&, const BlockEntry&) = default;
};
inline constexpr size_t kMostBlockEntries = 38;

// Octet 1 reserved, 2 the number, then six octets an entry; always 230 octets.
Octets encode_block(std::span<const BlockEntry> entries);
std::optional<std::vector<BlockEntry>> decode_block(std::span<const uint8_t> octets);

struct ReadPointer {  // figure 59 is lost: the order of the two is ours
  uint16_t index = kFirstParameterIndex;
  uint16_t increment = 0;  // without sign; beyond FFFFh it starts from 0 again (ours)
};

// The errors of the object list; the inverter's own pass through. Codes of FMS class 6, access.
namespace fms_errors {
inline constexpr ReturnCode kAccessDenied{6, 3, 0};
inline constexpr ReturnCode kUnsupported{6, 6, 0};
inline constexpr ReturnCode kNoObject{6, 7, 0};
inline constexpr ReturnCode kTypeConflict = runtime::return_codes::kTypeConflict;
}  // namespace fms_errors

// What an access costs beside the frames on the line: so many parameter services of the inverter.
struct FmsAccessed {
  Octets data;  // of a read
  uint32_t services = 0;
};

class FmsObjects {
 public:
  FmsObjects(FieldbusParameters& parameters, runtime::ProcessDataServer& drive, DpSlave& slave)
      : parameters_(parameters), drive_(drive), slave_(slave) {}

  std::vector<FmsObject> list() const;
  std::optional<FmsObject> find(uint16_t index) const;

  tl::expected<FmsAccessed, ReturnCode> read(Time now, uint16_t index);
  tl::expected<FmsAccessed, ReturnCode> write(Time now, uint16_t index, std::span<const uint8_t> data);

  // The default of the switch is back, and the pointer; the outputs are 0.
  void power_on();

 private:
  tl::expected<FmsAccessed, ReturnCode> read_parameter(Time now, uint16_t index, size_t length);
  tl::expected<FmsAccessed, ReturnCode> write_parameter(Time now, uint16_t index, uint32_t data);
  tl::expected<FmsAccessed, ReturnCode> write_block(Time now, std::span<const uint8_t> data);
  Octets outputs(size_t length) const;

  FieldbusParameters& parameters_;
  runtime::ProcessDataServer& drive_;
  DpSlave& slave_;
  ReadPointer pointer_;
  Octets outputs_ = Octets(6);  // written over FMS
};

}  // namespace ipos::profibus

// The object list of the FMS card and what reading and writing its objects does (MOVITRAC 31 PROFIBUS, 4.2).
// Objects below 1000 are the card's own; from 1000 on they are the parameters of the inverter.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/bus/profibus/dp_slave.hpp"
#include "runtime/bus/profibus/fieldbus_parameters.hpp"
#include "runtime/bus/profibus/fms/objects.hpp"

namespace ipos::profibus {

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

class FmsObjects final : public fms::ObjectList {
 public:
  FmsObjects(FieldbusParameters& parameters, runtime::ProcessDataServer& drive, DpSlave& slave)
      : parameters_(parameters), drive_(drive), slave_(slave) {}

  std::vector<fms::Object> list() const;
  std::optional<fms::Object> find(uint16_t index) const override;

  tl::expected<fms::Accessed, ReturnCode> read(Time now, uint16_t index) override;
  tl::expected<fms::Accessed, ReturnCode> write(Time now, uint16_t index, std::span<const uint8_t> data) override;

  // The default of the switch is back, and the pointer; the outputs are 0.
  void power_on();

 private:
  tl::expected<fms::Accessed, ReturnCode> read_parameter(Time now, uint16_t index, size_t length);
  tl::expected<fms::Accessed, ReturnCode> write_parameter(Time now, uint16_t index, uint32_t data);
  tl::expected<fms::Accessed, ReturnCode> write_block(Time now, std::span<const uint8_t> data);
  Octets outputs(size_t length) const;

  FieldbusParameters& parameters_;
  runtime::ProcessDataServer& drive_;
  DpSlave& slave_;
  ReadPointer pointer_;
  Octets outputs_ = Octets(6);  // written over FMS
};

}  // namespace ipos::profibus

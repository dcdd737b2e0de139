// Stands in for CANlib: channels 0 to 3 are plugged in, and speak on the shared bus.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>

#include "runtime/os_port/adapters/kvaser_api.hpp"
#include "tests/runtime/os_port/stand_in/shared_bus.hpp"

namespace {

using namespace ipos::tests;            // NOLINT
using namespace ipos::runtime::kvaser;  // NOLINT

constexpr int kChannels = 4;
struct Circuit {
  explicit Circuit(uint32_t bit) : channel(*the_bus(), bit) {}
  BusChannel channel;
  uint32_t scale = 1000;
  bool is_on = false;
};
std::map<Handle, std::unique_ptr<Circuit>> circuits;
bool is_initialized = false;

bool is_there(int channel) {
  return is_initialized && the_bus() != nullptr && channel >= 0 && channel < kChannels &&
         (the_bus()->switches.gone >> (kKvaserChannels + static_cast<uint32_t>(channel)) & 1U) == 0;
}

Status find(Handle handle, Circuit*& circuit) {
  const auto known = circuits.find(handle);
  if (known == circuits.end()) return kNoHandle;
  circuit = known->second.get();
  return circuit->channel.has(circuit->channel.switches().gone) ? kHardware : kOk;
}

}  // namespace

IPOS_EXPORTED void canInitializeLibrary() { is_initialized = true; }

IPOS_EXPORTED Status canGetNumberOfChannels(int* count) {
  *count = 0;
  while (is_there(*count)) ++*count;
  return kOk;
}

IPOS_EXPORTED Status canGetChannelData(int channel, int item, void* value, size_t size) {
  if (!is_there(channel)) return kNotFound;
  if (item == kDeviceDescription)
    std::snprintf(static_cast<char*>(value), size, "Stand-in Leaf");
  else
    std::memset(value, 0, size);
  return kOk;
}

IPOS_EXPORTED Handle canOpenChannel(int channel, int) {
  if (!is_there(channel)) return kNotFound;
  auto circuit = std::make_unique<Circuit>(kKvaserChannels + static_cast<uint32_t>(channel));
  if (circuit->channel.has(circuit->channel.switches().in_use)) return kNoAccess;
  Handle handle = 0;
  while (circuits.count(handle) != 0) ++handle;
  circuits[handle] = std::move(circuit);
  return handle;
}

IPOS_EXPORTED Status canSetBusParams(Handle handle, long rate, unsigned, unsigned, unsigned, unsigned, unsigned) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  // canBITRATE_1M to canBITRATE_10K of canlib.h
  static constexpr uint32_t kRateOf[] = {1'000'000, 500'000, 250'000, 125'000, 100'000, 62'500, 50'000, 83'333, 10'000};
  if (rate > -1 || rate < -9) return kBadParameter;
  circuit->channel.baud = kRateOf[-1 - rate];
  return kOk;
}

IPOS_EXPORTED Status canBusOn(Handle handle) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  if (!circuit->is_on) circuit->channel.clear(circuit->channel.switches().off);
  circuit->is_on = true;
  return kOk;
}

IPOS_EXPORTED Status canBusOff(Handle handle) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  circuit->is_on = false;
  return kOk;
}

IPOS_EXPORTED Status canClose(Handle handle) { return circuits.erase(handle) != 0 ? kOk : kNoHandle; }

IPOS_EXPORTED Status canRead(Handle handle, long* id, void* data, unsigned* length, unsigned* flags, unsigned long* time) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  if (!circuit->is_on) return kNoMessage;
  const auto heard = circuit->channel.read();
  if (!heard) return kNoMessage;
  *id = static_cast<long>(heard->id);
  std::memcpy(data, heard->data, sizeof heard->data);
  *length = heard->length;
  *flags = (heard->extended ? kExtended : kStandard) | (heard->remote ? kRemote : 0);
  if (heard->kind == BusSlot::kError) {
    *flags = kErrorFrame;
    if ((heard->id & 1) != 0) *flags |= kBit0Error;
    if ((heard->id & 2) != 0) *flags |= kFormError;
    if ((heard->id & 4) != 0) *flags |= kStuffError;
  }
  if (circuit->channel.has(circuit->channel.switches().lost)) {
    circuit->channel.clear(circuit->channel.switches().lost);
    *flags |= kSoftwareOverrun;
  }
  *time = static_cast<unsigned long>(heard->microseconds / circuit->scale);
  return kOk;
}

IPOS_EXPORTED Status canReadWait(Handle handle, long* id, void* data, unsigned* length, unsigned* flags, unsigned long* time,
                                 unsigned long) {
  return canRead(handle, id, data, length, flags, time);
}

IPOS_EXPORTED Status canWrite(Handle handle, long id, void* data, unsigned length, unsigned flags) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  const BusSwitches& switches = circuit->channel.switches();
  if (circuit->channel.has(switches.bad_frame)) return kBadParameter;
  if (circuit->channel.has(switches.full) || circuit->channel.has(switches.off)) return kSendBufferFull;
  circuit->channel.write(static_cast<uint32_t>(id), static_cast<uint8_t>(length), (flags & kExtended) != 0, (flags & kRemote) != 0,
                         data);
  return kOk;
}

IPOS_EXPORTED Status canWriteSync(Handle, unsigned long) { return kOk; }
IPOS_EXPORTED Status canSetBusOutputControl(Handle, unsigned) { return kOk; }
IPOS_EXPORTED Status canSetAcceptanceFilter(Handle, unsigned, unsigned, int) { return kOk; }
IPOS_EXPORTED Status kvReadTimer(Handle, unsigned* time) {
  *time = 0;
  return kOk;
}

IPOS_EXPORTED Status canReadStatus(Handle handle, unsigned long* flags) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  const BusSwitches& switches = circuit->channel.switches();
  *flags = kActive;
  if (circuit->channel.has(switches.warning)) *flags = kWarning;
  if (circuit->channel.has(switches.passive)) *flags = kPassive;
  if (circuit->channel.has(switches.off)) *flags = kBusOff;
  return kOk;
}

IPOS_EXPORTED Status canIoCtl(Handle handle, unsigned function, void* value, unsigned size) {
  Circuit* circuit = nullptr;
  if (const Status status = find(handle, circuit); status != kOk) return status;
  if (function == kSetTimerScale && size == sizeof circuit->scale) std::memcpy(&circuit->scale, value, size);
  return kOk;
}

IPOS_EXPORTED Status canGetErrorText(Status status, char* text, unsigned size) {
  const char* const known = status == kBadParameter ? "Error in parameter"
                            : status == kHardware   ? "Hardware error"
                            : status == kNoHandle   ? "Handle is invalid"
                                                    : "Stand-in error";
  std::snprintf(text, size, "%s", known);
  return kOk;
}

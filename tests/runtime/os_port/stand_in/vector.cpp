// Stands in for the XL Driver Library: channels 0 to 3 are plugged in, and speak on the shared bus; channel 4 is of LIN.
#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>

#include "runtime/os_port/adapters/vector_api.hpp"
#include "tests/runtime/os_port/stand_in/shared_bus.hpp"

namespace {

using namespace ipos::tests;            // NOLINT
using namespace ipos::runtime::vector;  // NOLINT

constexpr uint8_t kChannels = 4;
struct Port {
  Port(uint8_t its_index, Access its_mask) : channel(*the_bus(), kVectorChannels + its_index), mask(its_mask) {}
  BusChannel channel;
  Access mask;
  bool may_set = true;
  bool is_active = false;
  bool chip_asked = false;
};
std::map<PortHandle, std::unique_ptr<Port>> ports;
int drivers = 0;
uint32_t rates[kChannels];

bool is_there(uint8_t channel) {
  return the_bus() != nullptr && channel < kChannels && (the_bus()->switches.gone >> (kVectorChannels + channel) & 1U) == 0;
}

Status find(PortHandle handle, Access mask, Port*& port) {
  const auto known = ports.find(handle);
  if (drivers == 0 || known == ports.end()) return kInvalidPort;
  port = known->second.get();
  if ((port->mask & mask) == 0) return kWrongParameter;
  return port->channel.has(port->channel.switches().gone) ? kNotPresent : kSuccess;
}
constexpr Access kAny = ~Access{0};

}  // namespace

IPOS_EXPORTED Status xlOpenDriver() {
  ++drivers;
  return kSuccess;
}
IPOS_EXPORTED Status xlCloseDriver() {
  --drivers;
  return kSuccess;
}

IPOS_EXPORTED Status xlGetDriverConfig(DriverConfig* config) {
  *config = {};
  for (uint8_t channel = 0; channel <= kChannels; ++channel) {
    if (channel < kChannels && !is_there(channel)) continue;
    if (the_bus() == nullptr) break;
    ChannelConfig& row = config->channel[config->channels++];
    std::snprintf(row.name, sizeof row.name, "Stand-in VN1610 Channel %u", channel + 1U);
    row.hardware_type = 55;  // VN1610
    row.hardware_channel = channel;
    row.index = channel;
    row.mask = Access{1} << channel;
    row.bus_capabilities = channel < kChannels ? kActiveCan : 2U << 16;
    row.bus_type = channel < kChannels ? kBusTypeCan : 2U;
    row.bit_rate = channel < kChannels ? rates[channel] : 0;
    if (channel < kChannels && (the_bus()->switches.in_use >> (kVectorChannels + channel) & 1U) != 0) row.bit_rate = 125'000;
    row.bus_parameters[16] = 1;  // CAN 2.0
  }
  return kSuccess;
}

IPOS_EXPORTED Status xlOpenPort(PortHandle* handle, char*, Access channels, Access* permission, uint32_t queue, uint32_t version,
                                uint32_t bus) {
  uint8_t index = 0;
  while (index < 64 && (channels >> index & 1U) == 0) ++index;
  if (!is_there(index)) return kNotPresent;
  if (queue < 16 || queue > 32768 || (queue & (queue - 1)) != 0 || version != kInterfaceVersion || bus != kBusTypeCan)
    return kWrongParameter;
  auto port = std::make_unique<Port>(index, channels);
  port->may_set = !port->channel.has(port->channel.switches().in_use);
  if (!port->may_set) *permission = 0;
  port->channel.baud = port->may_set ? 500'000 : 125'000;
  *handle = 1;
  while (ports.count(*handle) != 0) ++*handle;
  ports[*handle] = std::move(port);
  return kSuccess;
}

IPOS_EXPORTED Status xlClosePort(PortHandle handle) { return ports.erase(handle) != 0 ? kSuccess : kInvalidPort; }

IPOS_EXPORTED Status xlCanSetChannelBitrate(PortHandle handle, Access mask, uint32_t baud) {
  Port* port = nullptr;
  if (const Status status = find(handle, mask, port); status != kSuccess) return status;
  if (!port->may_set) return kInvalidAccess;
  if (baud < 15'000 || baud > 1'000'000) return kWrongParameter;
  port->channel.baud = baud;
  for (uint8_t index = 0; index < kChannels; ++index)
    if ((mask >> index & 1U) != 0) rates[index] = baud;
  return kSuccess;
}

IPOS_EXPORTED Status xlCanSetChannelMode(PortHandle, Access, int, int) { return kSuccess; }
IPOS_EXPORTED Status xlCanSetChannelAcceptance(PortHandle, Access, uint32_t, uint32_t, uint32_t) { return kSuccess; }

IPOS_EXPORTED Status xlActivateChannel(PortHandle handle, Access mask, uint32_t, uint32_t) {
  Port* port = nullptr;
  if (const Status status = find(handle, mask, port); status != kSuccess) return status;
  if (!port->is_active) port->channel.clear(port->channel.switches().off);
  port->is_active = true;
  return kSuccess;
}

IPOS_EXPORTED Status xlDeactivateChannel(PortHandle handle, Access mask) {
  Port* port = nullptr;
  if (const Status status = find(handle, mask, port); status != kSuccess) return status;
  port->is_active = false;
  return kSuccess;
}

IPOS_EXPORTED Status xlReceive(PortHandle handle, uint32_t* count, Event* event) {
  Port* port = nullptr;
  if (const Status status = find(handle, kAny, port); status != kSuccess) return status;
  if (!port->is_active) return kQueueEmpty;
  const BusSwitches& switches = port->channel.switches();
  *event = {};
  *count = 1;
  if (port->chip_asked) {
    port->chip_asked = false;
    event->tag = kChipState;
    event->chip.bus = port->channel.has(switches.off)       ? kBusOff
                      : port->channel.has(switches.passive) ? kPassive
                      : port->channel.has(switches.warning) ? kWarning
                                                            : kActive;
    return kSuccess;
  }
  const auto heard = port->channel.read();
  if (!heard) {
    *count = 0;
    return kQueueEmpty;
  }
  event->tag = kReceive;
  event->time = heard->microseconds * 1000;
  if (port->channel.has(switches.lost)) {
    port->channel.clear(port->channel.switches().lost);
    event->flags = kEventOverrun;
  }
  event->message.id = heard->id | (heard->extended ? kExtendedId : 0);
  event->message.flags = heard->remote ? kRemote : 0;
  event->message.length = heard->length;
  std::copy(std::begin(heard->data), std::end(heard->data), event->message.data);
  if (heard->kind == BusSlot::kError) {
    event->message = {};
    event->message.flags = kErrorFrame;
  }
  return kSuccess;
}

IPOS_EXPORTED Status xlCanTransmit(PortHandle handle, Access mask, uint32_t* count, void* events) {
  Port* port = nullptr;
  if (const Status status = find(handle, mask, port); status != kSuccess) return status;
  const BusSwitches& switches = port->channel.switches();
  if (port->channel.has(switches.bad_frame)) return kWrongParameter;
  if (port->channel.has(switches.full) || port->channel.has(switches.off)) {
    *count = 0;
    return kQueueFull;
  }
  for (uint32_t number = 0; number < *count; ++number) {
    const Event& event = static_cast<const Event*>(events)[number];
    if (event.tag != kTransmit) return kWrongParameter;
    const Message& message = event.message;
    port->channel.write(message.id & ~kExtendedId, static_cast<uint8_t>(message.length), (message.id & kExtendedId) != 0,
                        (message.flags & kRemote) != 0, message.data);
  }
  return kSuccess;
}

IPOS_EXPORTED Status xlCanRequestChipState(PortHandle handle, Access mask) {
  Port* port = nullptr;
  if (const Status status = find(handle, mask, port); status != kSuccess) return status;
  port->chip_asked = true;
  return kSuccess;
}

IPOS_EXPORTED Status xlGetSyncTime(PortHandle, uint64_t* time) {
  *time = 0;
  return kSuccess;
}

IPOS_EXPORTED const char* xlGetErrorString(Status status) {
  switch (status) {
    case kNotPresent: return "XL_ERR_HW_NOT_PRESENT";
    case kWrongParameter: return "XL_ERR_WRONG_PARAMETER";
    default: return "XL_ERROR";
  }
}

// What python-can asks for as it loads the library, and does not call here.
#define IPOS_NOT_CALLED(name) \
  IPOS_EXPORTED Status name() { return 117; }
IPOS_NOT_CALLED(xlGetApplConfig)
IPOS_NOT_CALLED(xlSetApplConfig)
IPOS_NOT_CALLED(xlGetChannelIndex)
IPOS_NOT_CALLED(xlGetChannelMask)
IPOS_NOT_CALLED(xlGetChannelTime)
IPOS_NOT_CALLED(xlSetNotification)
IPOS_NOT_CALLED(xlCanFdSetConfiguration)
IPOS_NOT_CALLED(xlCanReceive)
IPOS_NOT_CALLED(xlCanSetChannelParams)
IPOS_NOT_CALLED(xlCanTransmitEx)
IPOS_NOT_CALLED(xlCanFlushTransmitQueue)
IPOS_NOT_CALLED(xlCanResetAcceptance)
IPOS_NOT_CALLED(xlCanSetChannelOutput)
IPOS_NOT_CALLED(xlPopupHwConfig)
IPOS_NOT_CALLED(xlSetTimerRate)
IPOS_NOT_CALLED(xlGetEventString)
IPOS_NOT_CALLED(xlCanGetEventString)
IPOS_NOT_CALLED(xlGetReceiveQueueLevel)
IPOS_NOT_CALLED(xlGenerateSyncPulse)
IPOS_NOT_CALLED(xlFlushReceiveQueue)

// Stands in for PCAN-Basic: USB1 to USB4 are plugged in, and speak on the shared bus.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>

#include "runtime/os_port/adapters/pcan_api.hpp"
#include "tests/runtime/os_port/stand_in/shared_bus.hpp"

namespace {

using namespace ipos::tests;         // NOLINT
using namespace ipos::runtime::pcan;  // NOLINT

constexpr Handle kFirst = 0x51;
std::array<std::unique_ptr<BusChannel>, 4> channels;
uint32_t error_frames[4];

struct Rate {
  uint16_t timing;
  uint32_t baud;
};
// Any timing of the same rate is that rate on the wire; these are those of PEAK's header and of CiA.
constexpr Rate kRates[] = {{0x0014, 1'000'000}, {0x0016, 800'000}, {0x001C, 500'000}, {0x011C, 250'000}, {0x031C, 125'000},
                           {0x432F, 100'000},   {0x041C, 100'000}, {0x472F, 50'000},  {0x091C, 50'000},  {0x532F, 20'000},
                           {0x181C, 20'000},    {0x672F, 10'000},  {0x311C, 10'000}};

bool is_there(Handle handle) {
  if (the_bus() == nullptr || handle < kFirst || handle >= kFirst + channels.size()) return false;
  return (the_bus()->switches.gone >> (kPcanChannels + handle - kFirst) & 1U) == 0;
}

// The channel, or why there is none.
Status find(Handle handle, BusChannel*& channel) {
  if (!is_there(handle)) return 0x1400;  // ILLHW
  channel = channels[handle - kFirst].get();
  return channel == nullptr ? kNotInitialized : kOk;
}

}  // namespace

IPOS_EXPORTED Status CAN_Initialize(Handle handle, uint16_t timing, uint8_t, uint32_t, uint16_t) {
  if (!is_there(handle)) return 0x1400;
  auto channel = std::make_unique<BusChannel>(*the_bus(), kPcanChannels + handle - kFirst);
  if (channel->has(channel->switches().in_use)) return kHardwareInUse;
  const auto rate = std::find_if(std::begin(kRates), std::end(kRates), [&](const Rate& row) { return row.timing == timing; });
  if (rate == std::end(kRates)) return kBadValue;
  channel->baud = rate->baud;
  channel->clear(channel->switches().off);
  channels[handle - kFirst] = std::move(channel);
  error_frames[handle - kFirst] = 0;
  return kOk;
}

IPOS_EXPORTED Status CAN_Uninitialize(Handle handle) {
  if (handle >= kFirst && handle < kFirst + channels.size()) channels[handle - kFirst].reset();
  return kOk;
}

IPOS_EXPORTED Status CAN_Reset(Handle) { return kOk; }

IPOS_EXPORTED Status CAN_GetStatus(Handle handle) {
  BusChannel* channel = nullptr;
  if (const Status status = find(handle, channel); status != kOk) return status;
  Status status = kOk;
  if (channel->has(channel->switches().off)) status |= kBusOff;
  if (channel->has(channel->switches().passive)) status |= kPassive;
  if (channel->has(channel->switches().warning)) status |= kWarning;
  if (channel->has(channel->switches().lost)) status |= kQueueOverrun;
  return status;
}

IPOS_EXPORTED Status CAN_Read(Handle handle, Message* message, Stamp* stamp) {
  BusChannel* channel = nullptr;
  if (const Status status = find(handle, channel); status != kOk) return status;
  for (;;) {
    const auto heard = channel->read();
    if (!heard) return kNoMessage;
    if (heard->kind == BusSlot::kError && error_frames[handle - kFirst] == 0) continue;
    *message = {};
    message->id = heard->id;
    message->length = heard->length;
    std::copy(std::begin(heard->data), std::end(heard->data), message->data);
    message->type = static_cast<uint8_t>((heard->extended ? kExtended : 0) | (heard->remote ? kRemote : 0));
    if (heard->kind == BusSlot::kError) {
      message->type = kErrorFrame;
      message->length = 4;
      message->id = heard->id == 16 ? 8 : heard->id;
      message->data[1] = heard->id == 16 ? 0x19 : 0;
    }
    if (stamp != nullptr) {
      const uint64_t millis = heard->microseconds / 1000;
      *stamp = {static_cast<uint32_t>(millis), static_cast<uint16_t>(millis >> 32),
                static_cast<uint16_t>(heard->microseconds % 1000)};
    }
    return kOk;
  }
}

IPOS_EXPORTED Status CAN_Write(Handle handle, Message* message) {
  BusChannel* channel = nullptr;
  if (const Status status = find(handle, channel); status != kOk) return status;
  if (channel->has(channel->switches().bad_frame)) return 0x20000;  // ILLDATA
  if (channel->has(channel->switches().full) || channel->has(channel->switches().off)) return kQueueFull;
  channel->write(message->id, message->length, (message->type & kExtended) != 0, (message->type & kRemote) != 0, message->data);
  return kOk;
}

IPOS_EXPORTED Status CAN_GetValue(Handle handle, uint8_t parameter, void* value, uint32_t size) {
  if (parameter == kApiVersion) {
    std::snprintf(static_cast<char*>(value), size, "4.6.0.0");
    return kOk;
  }
  if (parameter != kChannelCondition || size < sizeof(uint32_t)) return 0x4000;  // ILLPARAMTYPE
  const uint32_t there = is_there(handle) ? 1 : 0;
  std::memcpy(value, &there, sizeof there);
  return kOk;
}

IPOS_EXPORTED Status CAN_SetValue(Handle handle, uint8_t parameter, void* value, uint32_t size) {
  if (parameter == kAllowErrorFrames && is_there(handle) && size >= sizeof(uint32_t))
    std::memcpy(&error_frames[handle - kFirst], value, sizeof(uint32_t));
  return kOk;
}

IPOS_EXPORTED Status CAN_GetErrorText(Status status, uint16_t, char* text) {
  switch (status) {
    case 0x1400: std::strcpy(text, "The given hardware handle is invalid"); return kOk;
    case 0x20000: std::strcpy(text, "The data is invalid"); return kOk;
    default: return kBadValue;
  }
}

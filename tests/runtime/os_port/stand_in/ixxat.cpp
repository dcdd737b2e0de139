// Stands in for VCI: two devices with two CAN lines each are plugged in, and speak on the shared bus.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <set>

#include "runtime/os_port/adapters/ixxat_api.hpp"
#include "tests/runtime/os_port/stand_in/shared_bus.hpp"

namespace {

using namespace ipos::tests;           // NOLINT
using namespace ipos::runtime::ixxat;  // NOLINT

constexpr uint32_t kDevices = 2, kLines = 2;
constexpr uint32_t kClock = 10'000'000, kStampDivisor = 10;

struct List {
  uint32_t next = 0;
};
struct Device {
  uint32_t number;
};
struct Line {
  Line(uint32_t device, uint32_t its_number) : channel(*the_bus(), kIxxatChannels + device * kLines + its_number) {}
  BusChannel channel;
  bool is_active = false;
};
struct Control {
  uint32_t bit;
};
// Of a line, whoever has opened it.
struct Controller {
  uint8_t timing0 = 0, timing1 = 0, mode = 0;
  bool is_started = false;
} controllers[kDevices * kLines];

bool is_there(uint32_t device) {
  return the_bus() != nullptr && device < kDevices &&
         (the_bus()->switches.gone >> (kIxxatChannels + device * kLines) & 1U) == 0;
}

uint32_t baud_of(const Controller& controller) {
  switch (controller.timing0 << 8 | controller.timing1) {
    case 0x0014: return 1'000'000;
    case 0x0016: return 800'000;
    case 0x001C: return 500'000;
    case 0x011C: return 250'000;
    case 0x031C: return 125'000;
    case 0x041C: return 100'000;
    case 0x091C: return 50'000;
    case 0x181C: return 20'000;
    case 0x311C: return 10'000;
    default: return 0;
  }
}

bool is_set(const std::atomic<uint32_t>& of_switches, uint32_t bit) { return (of_switches >> (kIxxatChannels + bit) & 1U) != 0; }
Result check(const Control& control) { return is_set(the_bus()->switches.gone, control.bit) ? kDisconnected : kOk; }

}  // namespace

IPOS_EXPORTED Result vciInitialize() { return kOk; }

IPOS_EXPORTED void vciFormatError(Result result, char* text, uint32_t size) {
  std::snprintf(text, size, "%s", result == kDisconnected ? "device disconnected" : "stand-in error");
}

IPOS_EXPORTED Result vciEnumDeviceOpen(Handle* list) {
  *list = new List;
  return kOk;
}
IPOS_EXPORTED Result vciEnumDeviceNext(Handle list, DeviceInfo* info) {
  auto& at = *static_cast<List*>(list);
  while (at.next < kDevices && !is_there(at.next)) ++at.next;
  if (at.next >= kDevices) return kNoMoreItems;
  *info = {};
  info->id = 100 + at.next;
  std::snprintf(info->hardware_id, sizeof info->hardware_id, "HW%u", at.next);
  std::snprintf(info->description, sizeof info->description, "Stand-in USB-to-CAN");
  ++at.next;
  return kOk;
}
IPOS_EXPORTED Result vciEnumDeviceClose(Handle list) {
  delete static_cast<List*>(list);
  return kOk;
}

IPOS_EXPORTED Result vciDeviceOpen(const int64_t* id, Handle* device) {
  const auto number = static_cast<uint32_t>(*id - 100);
  if (!is_there(number)) return kDisconnected;
  *device = new Device{number};
  return kOk;
}
IPOS_EXPORTED Result vciDeviceClose(Handle device) {
  delete static_cast<Device*>(device);
  return kOk;
}

IPOS_EXPORTED Result canChannelOpen(Handle device, uint32_t number, Bool, Handle* channel) {
  if (number >= kLines) return kInvalidIndex;
  *channel = new Line(static_cast<Device*>(device)->number, number);
  return kOk;
}
IPOS_EXPORTED Result canChannelInitialize(Handle, uint16_t receive, uint16_t, uint16_t send, uint16_t) {
  return receive != 0 && send != 0 ? kOk : vci_error(4);
}
IPOS_EXPORTED Result canChannelActivate(Handle channel, Bool on) {
  static_cast<Line*>(channel)->is_active = on != 0;
  return kOk;
}
IPOS_EXPORTED Result canChannelClose(Handle channel) {
  delete static_cast<Line*>(channel);
  return kOk;
}

namespace {

uint32_t bit_of(const Line& line) {
  for (uint32_t bit = 0; bit < kDevices * kLines; ++bit)
    if (line.channel.bit() == kIxxatChannels + bit) return bit;
  return 0;
}

}  // namespace

IPOS_EXPORTED Result canChannelReadMessage(Handle channel, uint32_t, Message* message) {
  Line& line = *static_cast<Line*>(channel);
  const uint32_t bit = bit_of(line);
  if (is_set(the_bus()->switches.gone, bit)) return kDisconnected;
  line.channel.baud = baud_of(controllers[bit]);
  if (!line.is_active || !controllers[bit].is_started) return kNoMessage;
  for (;;) {
    const auto heard = line.channel.read();
    if (!heard) return kNoMessage;
    if (heard->kind == BusSlot::kError && (controllers[bit].mode & kErrorFrameMode) == 0) continue;
    *message = {};
    message->time = static_cast<uint32_t>(heard->microseconds);  // kClock / kStampDivisor is 1 MHz
    message->id = heard->id;
    message->flags = static_cast<uint8_t>(heard->length | (heard->remote ? kRemote : 0) | (heard->extended ? kExtended : 0));
    std::copy(std::begin(heard->data), std::end(heard->data), message->data);
    if (heard->kind == BusSlot::kError) {
      *message = {};
      message->time = static_cast<uint32_t>(heard->microseconds);
      message->type = kError;
      message->data[0] = heard->id == 1    ? kBitError
                         : heard->id == 2  ? kFormError
                         : heard->id == 4  ? kStuffError
                         : heard->id == 16 ? kAcknowledgeError
                                           : uint8_t{7};
    }
    if (is_set(the_bus()->switches.lost, bit)) {
      line.channel.clear(line.channel.switches().lost);
      message->flags |= kOverrunFlag;
    }
    return kOk;
  }
}
IPOS_EXPORTED Result canChannelPeekMessage(Handle channel, Message* message) { return canChannelReadMessage(channel, 0, message); }
IPOS_EXPORTED Result canChannelWaitRxEvent(Handle, uint32_t) { return kOk; }
IPOS_EXPORTED Result canChannelWaitTxEvent(Handle, uint32_t) { return kOk; }

IPOS_EXPORTED Result canChannelPostMessage(Handle channel, Message* message) {
  Line& line = *static_cast<Line*>(channel);
  const uint32_t bit = bit_of(line);
  const BusSwitches& switches = the_bus()->switches;
  if (is_set(switches.gone, bit)) return kDisconnected;
  if (is_set(switches.bad_frame, bit)) return vci_error(4);
  if (is_set(switches.full, bit) || is_set(switches.off, bit)) return kSendFull;
  line.channel.baud = baud_of(controllers[bit]);
  line.channel.write(message->id, message->flags & kLengthBits, (message->flags & kExtended) != 0, (message->flags & kRemote) != 0,
                     message->data);
  return kOk;
}
IPOS_EXPORTED Result canChannelSendMessage(Handle channel, uint32_t, Message* message) {
  return canChannelPostMessage(channel, message);
}

IPOS_EXPORTED Result canControlOpen(Handle device, uint32_t number, Handle* control) {
  const uint32_t bit = static_cast<Device*>(device)->number * kLines + number;
  *control = new Control{bit};
  if (!is_set(the_bus()->switches.in_use, bit)) return kOk;
  controllers[bit] = {0x03, 0x1C, kStandardMode, true};  // the other program: 125 kbit/s
  return kAccessDenied;
}
IPOS_EXPORTED Result canControlInitialize(Handle handle, uint8_t mode, uint8_t timing0, uint8_t timing1) {
  const Control& control = *static_cast<Control*>(handle);
  if (const Result result = check(control); result != kOk) return result;
  if (is_set(the_bus()->switches.in_use, control.bit)) return kAccessDenied;
  controllers[control.bit] = {timing0, timing1, mode, false};
  return baud_of(controllers[control.bit]) != 0 ? kOk : vci_error(4);
}
IPOS_EXPORTED Result canControlStart(Handle handle, Bool on) {
  const Control& control = *static_cast<Control*>(handle);
  if (const Result result = check(control); result != kOk) return result;
  Controller& controller = controllers[control.bit];
  if (on != 0 && !controller.is_started) the_bus()->switches.off &= ~(1U << (kIxxatChannels + control.bit));
  controller.is_started = on != 0;
  return kOk;
}
IPOS_EXPORTED Result canControlReset(Handle handle) { return check(*static_cast<Control*>(handle)); }
IPOS_EXPORTED Result canControlGetStatus(Handle handle, LineStatus* status) {
  const Control& control = *static_cast<Control*>(handle);
  if (const Result result = check(control); result != kOk) return result;
  const Controller& controller = controllers[control.bit];
  const BusSwitches& switches = the_bus()->switches;
  *status = {controller.mode, controller.timing0, controller.timing1, 0, 0};
  if (is_set(switches.off, control.bit)) status->status |= kBusOff;
  if (is_set(switches.passive, control.bit) || is_set(switches.warning, control.bit)) status->status |= kErrorLimit;
  return kOk;
}
IPOS_EXPORTED Result canControlGetCaps(Handle, Capabilities* capabilities) {
  *capabilities = {};
  capabilities->features = kErrorFrameFeature;
  capabilities->clock = kClock;
  capabilities->stamp_divisor = kStampDivisor;
  return kOk;
}
IPOS_EXPORTED Result canControlClose(Handle handle) {
  delete static_cast<Control*>(handle);
  return kOk;
}

// What python-can asks for as it loads the library, and does not call here.
#define IPOS_NOT_CALLED(name) \
  IPOS_EXPORTED Result name() { return vci_error(2); }
IPOS_NOT_CALLED(canChannelGetStatus)
IPOS_NOT_CALLED(canControlSetAccFilter)
IPOS_NOT_CALLED(canControlAddFilterIds)
IPOS_NOT_CALLED(canControlRemFilterIds)
IPOS_NOT_CALLED(canSchedulerOpen)
IPOS_NOT_CALLED(canSchedulerClose)
IPOS_NOT_CALLED(canSchedulerGetCaps)
IPOS_NOT_CALLED(canSchedulerActivate)
IPOS_NOT_CALLED(canSchedulerAddMessage)
IPOS_NOT_CALLED(canSchedulerRemMessage)
IPOS_NOT_CALLED(canSchedulerStartMessage)
IPOS_NOT_CALLED(canSchedulerStopMessage)

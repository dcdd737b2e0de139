// Virtual CAN Interface: vcinpl.dll, which VCI 3 and VCI 4 bring. After HMS' "VCI: C-API for Windows, Software Design Guide"
// (ixxat.com) and python-can's interface ixxat (canlib_vcinpl), which declares the same with ctypes. vcinpl2.dll of VCI 4 has
// other structures, for CAN FD, which is not wanted here.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ipos::runtime::ixxat {

using Result = int32_t;  // HRESULT
using Handle = void*;
using Bool = int32_t;

inline constexpr uint32_t kVciError = 0xE0010000U;  // severity error, customer code, facility VCI
constexpr Result vci_error(uint32_t number) { return static_cast<Result>(kVciError | number); }
inline constexpr Result kOk = 0, kInvalidHandle = vci_error(0x07), kAccessDenied = vci_error(0x0A), kTimeout = vci_error(0x0B),
                        kNoMoreItems = vci_error(0x0F), kNoMessage = vci_error(0x12), kSendFull = vci_error(0x13),
                        kInvalidIndex = vci_error(0x17), kDisconnected = vci_error(0x19);

inline constexpr uint8_t kStandardMode = 0x01, kExtendedMode = 0x02, kErrorFrameMode = 0x04;  // of initialize()
inline constexpr uint32_t kErrorFrameFeature = 0x08;
inline constexpr uint32_t kOverrun = 0x02, kErrorLimit = 0x04, kBusOff = 0x08, kInitMode = 0x10;  // of LineStatus

// Types of messages, and their flags.
inline constexpr uint8_t kData = 0, kError = 2;
inline constexpr uint8_t kLengthBits = 0x0F, kOverrunFlag = 0x10, kRemote = 0x40, kExtended = 0x80;
// First byte of an error message.
inline constexpr uint8_t kStuffError = 1, kFormError = 2, kAcknowledgeError = 3, kBitError = 4, kCrcError = 6;

struct DeviceInfo {
  int64_t id;  // VCIID
  uint8_t device_class[16];
  uint8_t driver_major, driver_minor;
  uint16_t driver_build;
  uint8_t hardware_branch, hardware_major, hardware_minor, hardware_build;
  char hardware_id[16];
  char description[128];
  char manufacturer[126];
  uint16_t driver_release;
};
static_assert(sizeof(DeviceInfo) == 304 && offsetof(DeviceInfo, description) == 48);

struct LineStatus {
  uint8_t mode, bit_timing0, bit_timing1, bus_load;
  uint32_t status;
};
static_assert(sizeof(LineStatus) == 8);

struct Capabilities {
  uint16_t controller, coupling;
  uint32_t features, clock, stamp_divisor;
  uint32_t cyclic_divisor, cyclic_ticks, delayed_divisor, delayed_ticks;
};
static_assert(sizeof(Capabilities) == 32);

struct Message {
  uint32_t time;  // ticks
  uint32_t id;
  uint8_t type, more_flags, flags, accept;
  uint8_t data[8];
};
static_assert(sizeof(Message) == 20);

struct Functions {
  Result (*initialize_library)();
  void (*format_error)(Result, char* text, uint32_t size);
  Result (*enum_open)(Handle*);
  Result (*enum_next)(Handle, DeviceInfo*);
  Result (*enum_close)(Handle);
  Result (*device_open)(const int64_t* id, Handle*);
  Result (*device_close)(Handle);
  Result (*channel_open)(Handle device, uint32_t number, Bool exclusive, Handle* channel);
  Result (*channel_initialize)(Handle, uint16_t receive, uint16_t receive_threshold, uint16_t send, uint16_t send_threshold);
  Result (*channel_activate)(Handle, Bool);
  Result (*channel_close)(Handle);
  Result (*read_message)(Handle, uint32_t milliseconds, Message*);
  Result (*post_message)(Handle, Message*);
  Result (*control_open)(Handle device, uint32_t number, Handle* control);
  Result (*control_initialize)(Handle, uint8_t mode, uint8_t bit_timing0, uint8_t bit_timing1);
  Result (*control_start)(Handle, Bool);
  Result (*control_reset)(Handle);
  Result (*control_status)(Handle, LineStatus*);
  Result (*control_capabilities)(Handle, Capabilities*);
  Result (*control_close)(Handle);
};

}  // namespace ipos::runtime::ixxat

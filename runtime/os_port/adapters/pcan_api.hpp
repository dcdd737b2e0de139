// PCAN-Basic: PCANBasic.dll and libpcanbasic.so. After PEAK-System's "PCAN-Basic API documentation" (peak-system.com, version 4)
// and python-can's interface pcan, which declares the same with ctypes.
#pragma once

#include <cstdint>

namespace ipos::runtime::pcan {

using Handle = uint16_t;  // of a channel
using Status = uint32_t;

inline constexpr Status kOk = 0, kControllerFull = 0x1, kOverrun = 0x2, kWarning = 0x8, kBusOff = 0x10, kNoMessage = 0x20,
                        kQueueOverrun = 0x40, kQueueFull = 0x80, kNoDriver = 0x200, kHardwareInUse = 0x400,
                        kNetInUse = 0x800, kNoHandle = 0x1000, kBadValue = 0x8000, kPassive = 0x40000,
                        kNotInitialized = 0x4000000;
inline constexpr Status kAnyBusError = 0x4 | kWarning | kBusOff | kPassive;  // 4: light

inline constexpr uint8_t kRemote = 0x01, kExtended = 0x02, kErrorFrame = 0x40, kStatusFrame = 0x80;

// Parameters of getValue() and setValue(); the values are 32 bits.
inline constexpr uint8_t kApiVersion = 0x05, kBusSpeed = 0x1A, kChannelCondition = 0x0D, kAllowStatusFrames = 0x1E,
                         kAllowErrorFrames = 0x20;
inline constexpr uint16_t kEnglish = 0x09;

struct Message {
  uint32_t id;
  uint8_t type;
  uint8_t length;
  uint8_t data[8];
};
static_assert(sizeof(Message) == 16);

struct Stamp {
  uint32_t millis;
  uint16_t millis_overflow;  // how often millis has begun again
  uint16_t micros;           // 0..999
};
static_assert(sizeof(Stamp) == 8);

struct Functions {
  Status (*initialize)(Handle, uint16_t btr0btr1, uint8_t type, uint32_t io_port, uint16_t interrupt);  // the last three: 0
  Status (*uninitialize)(Handle);
  Status (*get_status)(Handle);
  Status (*read)(Handle, Message*, Stamp*);
  Status (*write)(Handle, Message*);
  Status (*get_value)(Handle, uint8_t parameter, void* value, uint32_t size);
  Status (*set_value)(Handle, uint8_t parameter, void* value, uint32_t size);
  Status (*get_error_text)(Status, uint16_t language, char* text);  // 256 bytes
};

// Channels by kind: USB1 is 51h, USB9 509h.
struct Kind {
  const char* name;
  Handle first;
  unsigned channels;
  Handle ninth;
};
inline constexpr Kind kKinds[] = {{"USB", 0x51, 16, 0x509}, {"PCI", 0x41, 16, 0x409}, {"LAN", 0x801, 16, 0x809},
                                  {"PCC", 0x61, 2, 0},      {"ISA", 0x21, 8, 0},      {"DNG", 0x31, 1, 0}};

}  // namespace ipos::runtime::pcan

// CANlib: canlib32.dll (of 64 bits, too) and libcanlib.so. After Kvaser's "CANlib SDK" documentation of canlib.h and canstat.h
// (kvaser.com/canlib-webhelp) and python-can's interface kvaser, which declares the same with ctypes. `long` is that of the
// system: 32 bits on Windows, 64 on Linux.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ipos::runtime::kvaser {

using Handle = int;
using Status = int;  // negative: an error

inline constexpr Status kOk = 0, kBadParameter = -1, kNoMessage = -2, kNotFound = -3, kNoChannels = -5, kNoHandle = -10,
                        kDriver = -12, kSendBufferFull = -13, kHardware = -15, kDriverFailed = -24, kNoCard = -26,
                        kNoAccess = -31;

inline constexpr unsigned kRemote = 0x1, kStandard = 0x2, kExtended = 0x4, kErrorFrame = 0x20, kHardwareOverrun = 0x200,
                          kSoftwareOverrun = 0x400, kStuffError = 0x800, kFormError = 0x1000, kCrcError = 0x2000,
                          kBit0Error = 0x4000, kBit1Error = 0x8000;

// Of read_status().
inline constexpr unsigned long kPassive = 0x1, kBusOff = 0x2, kWarning = 0x4, kActive = 0x8;

inline constexpr int kAcceptVirtual = 0x20;           // of open_channel()
inline constexpr unsigned kSetTimerScale = 6;         // of io_ctl(): microseconds a tick
inline constexpr int kDeviceDescription = 26;         // of get_channel_data(): a text

// Rates by name, for set_bus_params() with zeros behind them.
struct Rate {
  uint32_t baud;
  long name;
};
inline constexpr Rate kRates[] = {{1'000'000, -1}, {500'000, -2}, {250'000, -3}, {125'000, -4},
                                  {100'000, -5},   {50'000, -7},  {10'000, -9}};

struct Functions {
  void (*initialize_library)();
  Status (*get_number_of_channels)(int*);
  Status (*get_channel_data)(int channel, int item, void* value, size_t size);
  Handle (*open_channel)(int channel, int flags);  // negative: an error
  Status (*set_bus_params)(Handle, long rate, unsigned tseg1, unsigned tseg2, unsigned sjw, unsigned samples, unsigned sync);
  Status (*bus_on)(Handle);
  Status (*bus_off)(Handle);
  Status (*close)(Handle);
  Status (*read)(Handle, long* id, void* data, unsigned* length, unsigned* flags, unsigned long* time);
  Status (*write)(Handle, long id, void* data, unsigned length, unsigned flags);
  Status (*read_status)(Handle, unsigned long* flags);
  Status (*io_ctl)(Handle, unsigned function, void* value, unsigned size);
  Status (*get_error_text)(Status, char* text, unsigned size);
};

}  // namespace ipos::runtime::kvaser

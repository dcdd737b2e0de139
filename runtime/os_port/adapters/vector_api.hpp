// XL Driver Library: vxlapi64.dll. After Vector's "XL Driver Library Manual" (vector.com) and python-can's interface vector,
// which declares the same with ctypes.
#pragma once

#include <cstddef>
#include <cstdint>

namespace ipos::runtime::vector {

using Status = int16_t;
using PortHandle = int32_t;  // long of 32-bit and 64-bit Windows
using Access = uint64_t;     // a bit for each channel

inline constexpr Status kSuccess = 0, kQueueEmpty = 10, kQueueFull = 11, kWrongParameter = 101, kInvalidAccess = 112,
                        kOffline = 113, kInvalidPort = 118, kNotReady = 120, kNotPresent = 129, kBroken = 210, kClosed = 211;

inline constexpr uint32_t kInterfaceVersion = 3, kBusTypeCan = 1, kActiveCan = 1U << 16, kResetClock = 8;
inline constexpr PortHandle kInvalidPortHandle = -1;

// Tags of events, flags of messages, and of the event itself.
inline constexpr uint8_t kReceive = 1, kChipState = 4, kTransmit = 10, kEventOverrun = 1;
inline constexpr uint16_t kErrorFrame = 1, kOverrun = 2, kRemote = 16, kTransmitted = 64, kTransmitRequest = 128;
inline constexpr uint32_t kExtendedId = 0x80000000U;

// Of ChipState::bus.
inline constexpr uint8_t kBusOff = 1, kPassive = 2, kWarning = 4, kActive = 8;

struct Message {
  uint32_t id;
  uint16_t flags;
  uint16_t length;
  uint64_t reserved1;
  uint8_t data[8];
  uint64_t reserved2;
};

struct ChipState {
  uint8_t bus;
  uint8_t send_errors;
  uint8_t receive_errors;
};

struct Event {
  uint8_t tag;
  uint8_t channel;
  uint16_t transaction;
  uint16_t port;
  uint8_t flags;
  uint8_t reserved;
  uint64_t time;  // ns
  union {
    Message message;
    ChipState chip;
  };
};
static_assert(sizeof(Event) == 48 && offsetof(Event, message) == 16);

#pragma pack(push, 1)
struct ChannelConfig {
  char name[32];
  uint8_t hardware_type, hardware_index, hardware_channel;
  uint16_t transceiver_type, transceiver_state, config_error;
  uint8_t index;
  uint64_t mask;
  uint32_t capabilities, bus_capabilities;
  uint8_t is_on_bus;
  uint32_t connected_bus_type;
  uint32_t bus_type;
  uint32_t bit_rate;  // of CAN; then its timing
  uint8_t bus_parameters[24];
  uint32_t unused, driver_version, interface_version;
  uint32_t raw[10];
  uint32_t serial_number, article_number;
  char transceiver_name[32];
  uint32_t special_cab_flags, dominant_timeout;
  uint8_t dominant_recessive_delay, recessive_dominant_delay, connection_info, time_stamps;
  uint16_t least_voltage, most_voltage;
  uint32_t most_bit_rate;
  uint8_t fpga_capabilities, special_state;
  uint16_t bus_active_capabilities, break_offset, delimiter_offset;
  uint32_t reserved[3];
};
#pragma pack(pop)
static_assert(sizeof(ChannelConfig) == 227 && offsetof(ChannelConfig, mask) == 42);

struct DriverConfig {
  uint32_t dll_version;
  uint32_t channels;
  uint32_t reserved[10];
  ChannelConfig channel[64];
};

struct Functions {
  Status (*open_driver)();
  Status (*close_driver)();
  Status (*get_driver_config)(DriverConfig*);
  Status (*open_port)(PortHandle*, char* application, Access channels, Access* permission, uint32_t queue, uint32_t version,
                      uint32_t bus);
  Status (*close_port)(PortHandle);
  Status (*set_bit_rate)(PortHandle, Access, uint32_t bits);
  Status (*set_channel_mode)(PortHandle, Access, int sent, int requested);
  Status (*activate)(PortHandle, Access, uint32_t bus, uint32_t flags);
  Status (*deactivate)(PortHandle, Access);
  Status (*receive)(PortHandle, uint32_t* count, Event*);
  Status (*transmit)(PortHandle, Access, uint32_t* count, void* events);
  Status (*request_chip_state)(PortHandle, Access);
  const char* (*get_error_string)(Status);
};

}  // namespace ipos::runtime::vector

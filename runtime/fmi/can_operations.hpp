// Operations of FMI-LS-BUS 1.0 for CAN, low cut: what FMUs tell each other of a line. Little-endian, one behind the other.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/can/error_counters.hpp"
#include "runtime/bus/can/frame.hpp"

namespace ipos::fmi {

enum class CanOperation : uint32_t {
  FormatError = 0x01,
  Transmit = 0x10,
  Confirm = 0x20,
  ArbitrationLost = 0x30,
  BusError = 0x31,
  Configuration = 0x40,
  Status = 0x41,
  Wakeup = 0x42,
};

enum class BusErrorCode : uint8_t { Bit = 1, Stuffing = 2, Form = 3, Crc = 4, Acknowledge = 5, BrokenErrorFrame = 6 };

std::string transmit_operation(const runtime::Frame& frame);
std::string confirm_operation(uint32_t id);
std::string arbitration_lost_operation(uint32_t id);
// `primary`: who gets it has found the error.
std::string bus_error_operation(uint32_t id, BusErrorCode code, bool primary, bool is_sender);
std::string wakeup_operation();
// The rate of the line; and that a bus simulation keeps and repeats what has lost the arbitration.
std::string configuration_operations(uint32_t baud);
// What came in `operation` cannot be read.
std::string format_error_operation(std::string_view operation);

struct ReadOperation {
  CanOperation kind = CanOperation::FormatError;
  uint32_t id = 0;            // of Transmit, Confirm, ArbitrationLost, BusError
  runtime::Frame frame;       // of Transmit
  bool is_sender = false;     // of BusError
  uint32_t baud = 0;          // of Configuration, of CAN; 0: it is about something else
  std::optional<bool> discards{};  // of Configuration: what loses the arbitration
  runtime::ErrorState state = runtime::ErrorState::Active;  // of Status
  bool is_good = false;       // else it cannot be read
  std::string_view bytes{};   // of it
};
// All of them; what has no length of its own is the last one.
std::vector<ReadOperation> read_operations(std::string_view bytes);

}  // namespace ipos::fmi

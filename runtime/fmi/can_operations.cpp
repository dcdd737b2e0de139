// Numbers into bytes and back.
#include "runtime/fmi/can_operations.hpp"

#include <algorithm>

namespace ipos::fmi {
namespace {

constexpr size_t kHeadBytes = 8, kTransmitHead = 16;
constexpr size_t kRateBytes = kHeadBytes + 5, kBehaviorBytes = kHeadBytes + 2, kStatusBytes = kHeadBytes + 1, kIdBytes = kHeadBytes + 4;
constexpr size_t kBusErrorBytes = 15, kIsSender = 14;
constexpr uint8_t kRate = 1, kXlRate = 3, kArbitrationLost = 4, kBufferAndRepeat = 1, kDiscardAndNotify = 2;
constexpr uint8_t kPrimary = 1, kSecondary = 2;
constexpr size_t kMostQuoted = 200;  // bytes of a format error (ours)

void put(std::string& out, uint64_t number, int bytes) {
  for (int n = 0; n < bytes; ++n) out += static_cast<char>(number >> (8 * n));
}
uint32_t take(std::string_view bytes, size_t at, size_t count) {
  uint32_t number = 0;
  for (size_t n = 0; n < count; ++n) number |= uint32_t{static_cast<uint8_t>(bytes[at + n])} << (8 * n);
  return number;
}
std::string head(CanOperation kind, size_t length) {
  std::string out;
  put(out, static_cast<uint32_t>(kind), 4);
  put(out, length, 4);
  return out;
}

std::string of_identifier(CanOperation kind, uint32_t id) {
  std::string out = head(kind, kIdBytes);
  put(out, id, 4);
  return out;
}

// Tables "Overview of the available configuration parameters" and "... Arbitration Lost Behavior values". Rates of CAN FD and XL are
// read and change nothing.
void read_configuration(ReadOperation& read) {
  const std::string_view bytes = read.bytes;
  if (bytes.size() <= kHeadBytes) return;
  const auto parameter = static_cast<uint8_t>(bytes[kHeadBytes]);
  if (parameter >= kRate && parameter <= kXlRate && bytes.size() == kRateBytes) {
    const uint32_t baud = take(bytes, kHeadBytes + 1, 4);
    read.is_good = baud != 0;
    if (parameter == kRate) read.baud = baud;
  } else if (parameter == kArbitrationLost && bytes.size() == kBehaviorBytes) {
    const auto behavior = static_cast<uint8_t>(bytes[kHeadBytes + 1]);
    read.is_good = behavior == kBufferAndRepeat || behavior == kDiscardAndNotify;
    read.discards = behavior == kDiscardAndNotify;
  }
}

// Table "Overview of the available status values": 1, 2, 3.
void read_status(ReadOperation& read) {
  if (read.bytes.size() != kStatusBytes) return;
  const auto status = static_cast<uint8_t>(read.bytes[kHeadBytes]);
  read.is_good = status >= 1 && status <= 3;
  if (read.is_good) read.state = static_cast<runtime::ErrorState>(status - 1);
}

void read_transmit(ReadOperation& read) {
  const std::string_view bytes = read.bytes;
  if (bytes.size() < kTransmitHead) return;
  runtime::Frame& frame = read.frame;
  frame.id = read.id;
  frame.extended = bytes[12] != 0;
  frame.remote = bytes[13] != 0;
  const uint32_t length = take(bytes, 14, 2);
  if (length > frame.data.size() || bytes.size() != kTransmitHead + length) return;
  frame.length = static_cast<uint8_t>(length);
  for (size_t n = 0; n < length; ++n) frame.data[n] = static_cast<uint8_t>(bytes[kTransmitHead + n]);
  read.is_good = runtime::is_valid(frame);
}

ReadOperation read_operation(std::string_view bytes) {
  ReadOperation read;
  read.bytes = bytes;
  read.kind = static_cast<CanOperation>(take(bytes, 0, 4));
  if (bytes.size() >= 12) read.id = take(bytes, 8, 4);
  switch (read.kind) {
    case CanOperation::Transmit: read_transmit(read); break;
    case CanOperation::Confirm:
    case CanOperation::ArbitrationLost: read.is_good = bytes.size() == kIdBytes; break;
    case CanOperation::BusError:
      read.is_good = bytes.size() == kBusErrorBytes;
      read.is_sender = read.is_good && bytes[kIsSender] != 0;
      break;
    case CanOperation::Configuration: read_configuration(read); break;
    case CanOperation::Status: read_status(read); break;
    case CanOperation::Wakeup: read.is_good = bytes.size() == kHeadBytes; break;
    case CanOperation::FormatError: read.is_good = true; break;  // never answered by another one
  }
  return read;
}

}  // namespace

std::string transmit_operation(const runtime::Frame& frame) {
  const size_t length = frame.remote ? 0 : frame.length;
  std::string out = head(CanOperation::Transmit, kTransmitHead + length);
  put(out, frame.id, 4);
  put(out, frame.extended ? 1 : 0, 1);
  put(out, frame.remote ? 1 : 0, 1);
  put(out, length, 2);
  for (size_t n = 0; n < length; ++n) put(out, frame.data[n], 1);
  return out;
}

std::string confirm_operation(uint32_t id) { return of_identifier(CanOperation::Confirm, id); }
std::string arbitration_lost_operation(uint32_t id) { return of_identifier(CanOperation::ArbitrationLost, id); }

std::string bus_error_operation(uint32_t id, BusErrorCode code, bool primary, bool is_sender) {
  std::string out = head(CanOperation::BusError, kBusErrorBytes);
  put(out, id, 4);
  put(out, static_cast<uint8_t>(code), 1);
  put(out, primary ? kPrimary : kSecondary, 1);
  put(out, is_sender ? 1 : 0, 1);
  return out;
}

std::string wakeup_operation() { return head(CanOperation::Wakeup, kHeadBytes); }

std::string configuration_operations(uint32_t baud) {
  std::string out = head(CanOperation::Configuration, kRateBytes);
  put(out, kRate, 1);
  put(out, baud, 4);
  out += head(CanOperation::Configuration, kBehaviorBytes);
  put(out, kArbitrationLost, 1);
  put(out, kBufferAndRepeat, 1);
  return out;
}

std::string format_error_operation(std::string_view operation) {
  operation = operation.substr(0, std::min(operation.size(), kMostQuoted));
  std::string out = head(CanOperation::FormatError, kHeadBytes + 2 + operation.size());
  put(out, operation.size(), 2);
  return out.append(operation);
}

std::vector<ReadOperation> read_operations(std::string_view bytes) {
  std::vector<ReadOperation> all;
  while (!bytes.empty()) {
    const size_t length = bytes.size() < kHeadBytes ? 0 : take(bytes, 4, 4);
    if (length < kHeadBytes || length > bytes.size()) {
      all.emplace_back().bytes = bytes;
      break;
    }
    all.push_back(read_operation(bytes.substr(0, length)));
    bytes.remove_prefix(length);
  }
  return all;
}

}  // namespace ipos::fmi

// PCAN-Basic by PEAK-System: USB, PCI, LAN adapters. A stamp has microseconds; error frames come where the driver has them;
// there is no single shot.
#include <fmt/format.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "runtime/os_port/adapters/adapter_channel.hpp"
#include "runtime/os_port/adapters/pcan_api.hpp"

namespace ipos::runtime::pcan {
namespace {

std::optional<Handle> handle_of(std::string_view channel) {
  for (const Kind& kind : kKinds) {
    const std::string_view name = kind.name;
    if (channel.size() <= name.size() ||
        !std::equal(name.begin(), name.end(), channel.begin(), [](char letter, char given) {
          return letter == std::toupper(static_cast<unsigned char>(given));
        }))
      continue;
    const auto number = channel_number(channel.substr(name.size()));
    if (!number || *number < 1 || *number > kind.channels) return std::nullopt;
    return static_cast<Handle>(*number < 9 ? kind.first + *number - 1 : kind.ninth + *number - 9);
  }
  return std::nullopt;
}

std::vector<std::string> channels_there(const Functions& library) {
  std::vector<std::string> there;
  for (const Kind& kind : kKinds)
    for (unsigned number = 1; number <= kind.channels; ++number) {
      std::string name = fmt::format("{}{}", kind.name, number);
      uint32_t condition = 0;
      if (library.get_value(*handle_of(name), kChannelCondition, &condition, sizeof condition) == kOk && condition != 0)
        there.push_back(std::move(name));
    }
  return there;
}

std::string text_of(const Functions& library, Status status) {
  std::array<char, 256> text{};
  if (library.get_error_text(status, kEnglish, text.data()) != kOk) return fmt::format("PCAN-Basic error {:X}h", status);
  text.back() = 0;
  return text.data();
}

// The identifier says what was wrong, the second byte where, as the register ECC of an SJA1000 has it.
CanArrival error_of(const Message& message) {
  constexpr uint8_t kPlaceBits = 0x1F, kAcknowledgeSlot = 0x19;
  if (message.length > 1 && (message.data[1] & kPlaceBits) == kAcknowledgeSlot) return error_arrival(CAN_ERR_ACK);
  switch (message.id) {
    case 1: return error_arrival(CAN_ERR_PROT, 0, CAN_ERR_PROT_BIT);
    case 2: return error_arrival(CAN_ERR_PROT, 0, CAN_ERR_PROT_FORM);
    case 4: return error_arrival(CAN_ERR_PROT, 0, CAN_ERR_PROT_STUFF);
    default: return error_arrival(CAN_ERR_BUSERROR);
  }
}

class PcanChannel final : public AdapterChannel {
 public:
  PcanChannel(const Functions& library, std::string port, Handle handle, uint16_t timing)
      : library_(library), port_(std::move(port)), handle_(handle), timing_(timing) {}
  ~PcanChannel() override { library_.uninitialize(handle_); }
  PcanChannel(const PcanChannel&) = delete;
  PcanChannel& operator=(const PcanChannel&) = delete;

  Status initialize(PortNotes& notes) {
    const Status status = library_.initialize(handle_, timing_, 0, 0, 0);
    if (status != kOk) return status;
    uint32_t off = 0, on = 1;
    library_.set_value(handle_, kAllowStatusFrames, &off, sizeof off);  // get_status() says the same
    if (library_.set_value(handle_, kAllowErrorFrames, &on, sizeof on) != kOk)
      notes.note("the driver gives no error frames: only the state of the controller is told");
    return kOk;
  }

  tl::expected<bool, PortError> write(const Frame& frame) override {
    Message message{frame.id, static_cast<uint8_t>((frame.extended ? kExtended : 0) | (frame.remote ? kRemote : 0)),
                    frame.length, {}};
    std::copy(frame.data.begin(), frame.data.end(), message.data);
    const Status status = library_.write(handle_, &message);
    if ((status & (kControllerFull | kQueueFull)) != 0) return false;
    if ((status & ~kAnyBusError) == kOk) return true;
    return tl::unexpected(error(status));
  }

  tl::expected<std::optional<CanArrival>, PortError> read() override {
    if (std::exchange(overrun_, false)) return overrun_arrival();
    Message message{};
    Stamp stamp{};
    const Status status = library_.read(handle_, &message, &stamp);
    if ((status & kNoMessage) != 0) return std::nullopt;
    if ((status & (kOverrun | kQueueOverrun)) != 0) return overrun_arrival();
    if ((status & ~kAnyBusError) != kOk) return tl::unexpected(error(status));
    if (status != kOk || (message.type & kStatusFrame) != 0) return std::nullopt;  // state() says it
    CanArrival arrival = (message.type & kErrorFrame) != 0 ? error_of(message) : CanArrival{};
    arrival.device_time = (static_cast<Time>(stamp.millis_overflow) << 32) * kMillisecond +
                          stamp.millis * kMillisecond + stamp.micros * kMicrosecond;
    if (arrival.error) return arrival;
    Frame& frame = arrival.frame;
    frame.extended = (message.type & kExtended) != 0;
    frame.remote = (message.type & kRemote) != 0;
    frame.id = message.id;
    frame.length = std::min<uint8_t>(message.length, 8);
    std::copy(std::begin(message.data), std::end(message.data), frame.data.begin());
    frame = canonical(frame);
    return arrival;
  }

  tl::expected<ControllerState, PortError> state() override {
    const Status status = library_.get_status(handle_);
    if ((status & (kNoHandle | kNoDriver | kNotInitialized)) != 0) return tl::unexpected(error(status));
    overrun_ = (status & (kOverrun | kQueueOverrun)) != 0 && !std::exchange(overrun_told_, true);
    if ((status & kBusOff) != 0) return ControllerState::Off;
    if ((status & kPassive) != 0) return ControllerState::Passive;
    return (status & kWarning) != 0 ? ControllerState::Warning : ControllerState::Active;
  }

  // What ends bus-off is a new beginning.
  tl::expected<void, PortError> restart() override {
    library_.uninitialize(handle_);
    PortNotes told_before;
    const Status status = initialize(told_before);
    overrun_told_ = false;
    if (status != kOk) return tl::unexpected(error(status));
    return {};
  }

 private:
  PortError error(Status status) const {
    const bool gone = (status & (kNoHandle | kNoDriver | kNotInitialized)) != 0;
    return port_error(gone ? PortFault::Gone : PortFault::Refused, port_, text_of(library_, status));
  }

  Functions library_;
  std::string port_;
  Handle handle_;
  uint16_t timing_;
  bool overrun_ = false;
  bool overrun_told_ = false;  // the status keeps it until the channel begins anew
};

}  // namespace

ChannelResult open(const SharedLibrary& library, const ChannelWish& wish) {
  Functions functions{};
  FunctionFinder finder(library);
  finder.take(functions.initialize, "CAN_Initialize")
      .take(functions.uninitialize, "CAN_Uninitialize")
      .take(functions.get_status, "CAN_GetStatus")
      .take(functions.read, "CAN_Read")
      .take(functions.write, "CAN_Write")
      .take(functions.get_value, "CAN_GetValue")
      .take(functions.set_value, "CAN_SetValue")
      .take(functions.get_error_text, "CAN_GetErrorText");
  if (!finder.missing().empty()) return tl::unexpected(lacks_function(wish, finder.missing()));
  const auto handle = handle_of(wish.channel);
  if (!handle) return tl::unexpected(port_error(PortFault::BadName, wish.port, "write pcan:USB1, pcan:PCI2 or pcan:LAN1"));
  const auto timing = sja1000_timing(wish.baud);
  if (!timing) return tl::unexpected(no_such_rate(wish));
  auto channel = std::make_unique<PcanChannel>(functions, wish.port, *handle, *timing);
  const Status status = channel->initialize(wish.notes);
  if (status == kOk) return channel;
  if ((status & kNoHandle) != 0) return tl::unexpected(no_such_channel(wish, channels_there(functions)));
  if ((status & (kHardwareInUse | kNetInUse)) != 0) return tl::unexpected(port_error(PortFault::InUse, wish.port));
  return tl::unexpected(port_error(PortFault::Refused, wish.port, text_of(functions, status)));
}

}  // namespace ipos::runtime::pcan

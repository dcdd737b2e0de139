// The XL Driver Library by Vector. A stamp has nanoseconds; error frames come without their kind; the state of the
// controller comes as an event, asked for; there is no single shot.
#include <fmt/format.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/os_port/adapters/adapter_channel.hpp"
#include "runtime/os_port/adapters/vector_api.hpp"

namespace ipos::runtime::vector {
namespace {

constexpr uint32_t kReceiveQueue = 4096;  // events; the library takes powers of 2 from 16 to 32768 (ours)

std::string text_of(const Functions& library, Status status) {
  const char* const text = library.get_error_string(status);
  return text != nullptr ? text : fmt::format("XL error {}", status);
}

bool is_for_can(const ChannelConfig& channel) { return (channel.bus_capabilities & kActiveCan) != 0; }

// The driver is open while this lives; the library counts.
class Driver {
 public:
  explicit Driver(const Functions& library) : library_(library), opened_(library.open_driver()) {}
  ~Driver() {
    if (opened_ == kSuccess) library_.close_driver();
  }
  Driver(const Driver&) = delete;
  Driver& operator=(const Driver&) = delete;

  const Functions& library() const { return library_; }
  Status opened() const { return opened_; }

 private:
  Functions library_;
  Status opened_;
};

class VectorChannel final : public AdapterChannel {
 public:
  VectorChannel(std::unique_ptr<Driver> driver, std::string port, PortHandle handle, Access mask)
      : driver_(std::move(driver)), port_(std::move(port)), handle_(handle), mask_(mask) {}
  ~VectorChannel() override {
    library().deactivate(handle_, mask_);
    library().close_port(handle_);
  }
  VectorChannel(const VectorChannel&) = delete;
  VectorChannel& operator=(const VectorChannel&) = delete;

  // Without receipts of what we send.
  Status activate() {
    library().set_channel_mode(handle_, mask_, 0, 0);
    return library().activate(handle_, mask_, kBusTypeCan, kResetClock);
  }

  tl::expected<bool, PortError> write(const Frame& frame) override {
    Event event{};
    event.tag = kTransmit;
    event.message.id = frame.id | (frame.extended ? kExtendedId : 0);
    event.message.flags = frame.remote ? kRemote : 0;
    event.message.length = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), event.message.data);
    uint32_t count = 1;
    const Status status = library().transmit(handle_, mask_, &count, &event);
    if (status == kQueueFull || (status == kSuccess && count == 0)) return false;
    if (status == kSuccess) return true;
    return tl::unexpected(error(status));
  }

  tl::expected<std::optional<CanArrival>, PortError> read() override {
    for (;;) {
      if (std::exchange(overrun_, false)) return overrun_arrival();
      Event event{};
      uint32_t count = 1;
      const Status status = library().receive(handle_, &count, &event);
      if (status == kQueueEmpty || (status == kSuccess && count == 0)) return std::nullopt;
      if (status != kSuccess) return tl::unexpected(error(status));
      overrun_ = (event.flags & kEventOverrun) != 0;
      if (event.tag == kChipState) state_ = state_of(event.chip);
      if (event.tag != kReceive) continue;  // as many as we have asked for, and few more
      const Message& message = event.message;
      overrun_ |= (message.flags & kOverrun) != 0;
      if ((message.flags & (kTransmitted | kTransmitRequest)) != 0) continue;
      CanArrival arrival = (message.flags & kErrorFrame) != 0 ? error_arrival(CAN_ERR_BUSERROR) : CanArrival{};
      arrival.device_time = static_cast<Time>(event.time);
      if (arrival.error) return arrival;
      Frame& frame = arrival.frame;
      frame.extended = (message.id & kExtendedId) != 0;
      frame.remote = (message.flags & kRemote) != 0;
      frame.id = message.id & ~kExtendedId;
      frame.length = static_cast<uint8_t>(std::min<uint16_t>(message.length, 8));
      std::copy(std::begin(message.data), std::end(message.data), frame.data.begin());
      frame = canonical(frame);
      return arrival;
    }
  }

  // The answer comes as an event: this is the one to the question before.
  tl::expected<ControllerState, PortError> state() override {
    if (const Status status = library().request_chip_state(handle_, mask_); status != kSuccess)
      return tl::unexpected(error(status));
    return state_;
  }

  tl::expected<void, PortError> restart() override {
    library().deactivate(handle_, mask_);
    state_ = ControllerState::Active;
    if (const Status status = activate(); status != kSuccess) return tl::unexpected(error(status));
    return {};
  }

 private:
  const Functions& library() const { return driver_->library(); }

  static ControllerState state_of(const ChipState& chip) {
    if ((chip.bus & kBusOff) != 0) return ControllerState::Off;
    if ((chip.bus & kPassive) != 0) return ControllerState::Passive;
    return (chip.bus & kWarning) != 0 ? ControllerState::Warning : ControllerState::Active;
  }

  PortError error(Status status) const {
    static constexpr Status kGone[] = {kOffline, kInvalidPort, kNotReady, kNotPresent, kBroken, kClosed};
    const bool gone = std::find(std::begin(kGone), std::end(kGone), status) != std::end(kGone);
    return port_error(gone ? PortFault::Gone : PortFault::Refused, port_, text_of(library(), status));
  }

  std::unique_ptr<Driver> driver_;
  std::string port_;
  PortHandle handle_;
  Access mask_;
  ControllerState state_ = ControllerState::Active;
  bool overrun_ = false;
};

}  // namespace

ChannelResult open(const SharedLibrary& library, const ChannelWish& wish) {
  Functions functions{};
  FunctionFinder finder(library);
  finder.take(functions.open_driver, "xlOpenDriver")
      .take(functions.close_driver, "xlCloseDriver")
      .take(functions.get_driver_config, "xlGetDriverConfig")
      .take(functions.open_port, "xlOpenPort")
      .take(functions.close_port, "xlClosePort")
      .take(functions.set_bit_rate, "xlCanSetChannelBitrate")
      .take(functions.set_channel_mode, "xlCanSetChannelMode")
      .take(functions.activate, "xlActivateChannel")
      .take(functions.deactivate, "xlDeactivateChannel")
      .take(functions.receive, "xlReceive")
      .take(functions.transmit, "xlCanTransmit")
      .take(functions.request_chip_state, "xlCanRequestChipState")
      .take(functions.get_error_string, "xlGetErrorString");
  if (!finder.missing().empty()) return tl::unexpected(lacks_function(wish, finder.missing()));
  const auto refused = [&](Status status) {
    return tl::unexpected(port_error(PortFault::Refused, wish.port, text_of(functions, status)));
  };
  const auto number = channel_number(wish.channel);
  if (!number) return tl::unexpected(port_error(PortFault::BadName, wish.port, "write vector:0"));
  auto driver = std::make_unique<Driver>(functions);
  if (driver->opened() != kSuccess) return refused(driver->opened());
  const auto config = std::make_unique<DriverConfig>();
  if (const Status status = functions.get_driver_config(config.get()); status != kSuccess) return refused(status);
  const auto channels = std::span(config->channel).first(std::min<size_t>(config->channels, std::size(config->channel)));
  const auto wanted = std::find_if(channels.begin(), channels.end(), [&](const ChannelConfig& channel) {
    return channel.index == *number && is_for_can(channel);
  });
  if (wanted == channels.end()) {
    std::vector<std::string> there;
    for (const ChannelConfig& channel : channels)
      if (is_for_can(channel))
        there.push_back(fmt::format("{} ({})", channel.index, std::string(channel.name, strnlen(channel.name, sizeof channel.name))));
    return tl::unexpected(no_such_channel(wish, there));
  }
  const Access mask = wanted->mask;
  Access permission = mask;
  PortHandle handle = kInvalidPortHandle;
  char application[] = "ipos";
  Status status = functions.open_port(&handle, application, mask, &permission, kReceiveQueue, kInterfaceVersion, kBusTypeCan);
  if (status == kInvalidAccess) return tl::unexpected(port_error(PortFault::InUse, wish.port));
  if (status != kSuccess) return refused(status);
  auto channel = std::make_unique<VectorChannel>(std::move(driver), wish.port, handle, mask);
  if ((permission & mask) == 0) {
    // Another program has it and has set its rate.
    if (wanted->bit_rate != wish.baud)
      return tl::unexpected(port_error(PortFault::WrongBitRate, wish.port,
                                       fmt::format("{} instead of {} bit/s, set by another program",
                                                   uint32_t{wanted->bit_rate}, wish.baud)));
  } else {
    status = functions.set_bit_rate(handle, mask, wish.baud);
    if (status == kWrongParameter) return tl::unexpected(no_such_rate(wish));
    if (status != kSuccess) return refused(status);
  }
  if (status = channel->activate(); status != kSuccess) return refused(status);
  return channel;
}

}  // namespace ipos::runtime::vector

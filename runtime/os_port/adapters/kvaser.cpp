// CANlib by Kvaser. A stamp has microseconds; error frames come with their kind; single shot is not asked for.
#include <fmt/format.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <utility>

#include "runtime/os_port/adapters/adapter_channel.hpp"
#include "runtime/os_port/adapters/kvaser_api.hpp"

namespace ipos::runtime::kvaser {
namespace {

std::string text_of(const Functions& library, Status status) {
  std::array<char, 128> text{};
  if (library.get_error_text(status, text.data(), text.size()) != kOk) return fmt::format("CANlib error {}", status);
  text.back() = 0;
  return text.data();
}

std::vector<std::string> channels_there(const Functions& library) {
  int count = 0;
  if (library.get_number_of_channels(&count) != kOk) return {};
  std::vector<std::string> there;
  for (int channel = 0; channel < count; ++channel) {
    std::array<char, 80> text{};
    const bool named = library.get_channel_data(channel, kDeviceDescription, text.data(), text.size() - 1) == kOk;
    there.push_back(named ? fmt::format("{} ({})", channel, text.data()) : fmt::format("{}", channel));
  }
  return there;
}

CanArrival error_of(unsigned flags) {
  uint8_t protocol = 0;
  if ((flags & kStuffError) != 0) protocol |= CAN_ERR_PROT_STUFF;
  if ((flags & kFormError) != 0) protocol |= CAN_ERR_PROT_FORM;
  if ((flags & kBit0Error) != 0) protocol |= CAN_ERR_PROT_BIT0;
  if ((flags & kBit1Error) != 0) protocol |= CAN_ERR_PROT_BIT1;
  const bool is_protocol = protocol != 0 || (flags & kCrcError) != 0;
  return error_arrival(is_protocol ? CAN_ERR_PROT : CAN_ERR_BUSERROR, 0, protocol);
}

class KvaserChannel final : public AdapterChannel {
 public:
  KvaserChannel(const Functions& library, std::string port, Handle handle)
      : library_(library), port_(std::move(port)), handle_(handle) {}
  ~KvaserChannel() override {
    library_.bus_off(handle_);
    library_.close(handle_);
  }
  KvaserChannel(const KvaserChannel&) = delete;
  KvaserChannel& operator=(const KvaserChannel&) = delete;

  void ask_for_microseconds() {
    uint32_t scale = 1;
    has_microseconds_ = library_.io_ctl(handle_, kSetTimerScale, &scale, sizeof scale) == kOk;
  }

  tl::expected<bool, PortError> write(const Frame& frame) override {
    std::array<uint8_t, 8> data = frame.data;
    const unsigned flags = (frame.extended ? kExtended : kStandard) | (frame.remote ? kRemote : 0);
    const Status status = library_.write(handle_, static_cast<long>(frame.id), data.data(), frame.length, flags);
    if (status == kSendBufferFull) return false;
    if (status >= kOk) return true;
    return tl::unexpected(error(status));
  }

  tl::expected<std::optional<CanArrival>, PortError> read() override {
    if (std::exchange(overrun_, false)) return overrun_arrival();
    long id = 0;
    std::array<uint8_t, 64> data{};  // as long as one of CAN FD, whatever comes
    unsigned length = 0, flags = 0;
    unsigned long time = 0;
    const Status status = library_.read(handle_, &id, data.data(), &length, &flags, &time);
    if (status == kNoMessage) return std::nullopt;
    if (status < kOk) return tl::unexpected(error(status));
    overrun_ = (flags & (kHardwareOverrun | kSoftwareOverrun)) != 0;
    CanArrival arrival = (flags & kErrorFrame) != 0 ? error_of(flags) : CanArrival{};
    const auto ticks = static_cast<Time>(ticks_.extend(static_cast<uint32_t>(time)));
    arrival.device_time = ticks * (has_microseconds_ ? kMicrosecond : kMillisecond);
    if (arrival.error) return arrival;
    Frame& frame = arrival.frame;
    frame.extended = (flags & kExtended) != 0;
    frame.remote = (flags & kRemote) != 0;
    frame.id = static_cast<uint32_t>(id);
    frame.length = static_cast<uint8_t>(std::min(length, 8U));
    std::copy_n(data.begin(), frame.data.size(), frame.data.begin());
    frame = canonical(frame);
    return arrival;
  }

  tl::expected<ControllerState, PortError> state() override {
    unsigned long flags = 0;
    if (const Status status = library_.read_status(handle_, &flags); status < kOk) return tl::unexpected(error(status));
    if ((flags & kBusOff) != 0) return ControllerState::Off;
    if ((flags & kPassive) != 0) return ControllerState::Passive;
    return (flags & kWarning) != 0 ? ControllerState::Warning : ControllerState::Active;
  }

  tl::expected<void, PortError> restart() override {
    library_.bus_off(handle_);
    if (const Status status = library_.bus_on(handle_); status < kOk) return tl::unexpected(error(status));
    return {};
  }

 private:
  PortError error(Status status) const {
    static constexpr Status kGone[] = {kNotFound, kNoHandle, kDriver, kHardware, kDriverFailed, kNoCard};
    const bool gone = std::find(std::begin(kGone), std::end(kGone), status) != std::end(kGone);
    return port_error(gone ? PortFault::Gone : PortFault::Refused, port_, text_of(library_, status));
  }

  Functions library_;
  std::string port_;
  Handle handle_;
  WideTicks ticks_;
  bool has_microseconds_ = false;
  bool overrun_ = false;
};

}  // namespace

ChannelResult open(const SharedLibrary& library, const ChannelWish& wish) {
  Functions functions{};
  FunctionFinder finder(library);
  finder.take(functions.initialize_library, "canInitializeLibrary")
      .take(functions.get_number_of_channels, "canGetNumberOfChannels")
      .take(functions.get_channel_data, "canGetChannelData")
      .take(functions.open_channel, "canOpenChannel")
      .take(functions.set_bus_params, "canSetBusParams")
      .take(functions.bus_on, "canBusOn")
      .take(functions.bus_off, "canBusOff")
      .take(functions.close, "canClose")
      .take(functions.read, "canRead")
      .take(functions.write, "canWrite")
      .take(functions.read_status, "canReadStatus")
      .take(functions.io_ctl, "canIoCtl")
      .take(functions.get_error_text, "canGetErrorText");
  if (!finder.missing().empty()) return tl::unexpected(lacks_function(wish, finder.missing()));
  const auto number = channel_number(wish.channel);
  if (!number || *number > INT16_MAX)
    return tl::unexpected(port_error(PortFault::BadName, wish.port, "write kvaser:0"));
  const auto rate = std::find_if(std::begin(kRates), std::end(kRates),
                                 [&](const Rate& row) { return row.baud == wish.baud; });
  if (rate == std::end(kRates)) return tl::unexpected(no_such_rate(wish));
  functions.initialize_library();
  const Handle handle = functions.open_channel(static_cast<int>(*number), kAcceptVirtual);
  if (handle < 0) {
    if (handle == kNotFound || handle == kBadParameter || handle == kNoChannels)
      return tl::unexpected(no_such_channel(wish, channels_there(functions)));
    if (handle == kNoAccess) return tl::unexpected(port_error(PortFault::InUse, wish.port));
    return tl::unexpected(port_error(PortFault::Refused, wish.port, text_of(functions, handle)));
  }
  auto channel = std::make_unique<KvaserChannel>(functions, wish.port, handle);
  channel->ask_for_microseconds();
  Status status = functions.set_bus_params(handle, rate->name, 0, 0, 0, 0, 0);
  if (status >= kOk) status = functions.bus_on(handle);
  if (status < kOk) return tl::unexpected(port_error(PortFault::Refused, wish.port, text_of(functions, status)));
  return channel;
}

}  // namespace ipos::runtime::kvaser

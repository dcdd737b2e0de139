// VCI by HMS (IXXAT). A stamp has the ticks of the adapter; error frames come with their kind where the controller has them;
// single shot is not asked for. `ixxat:0` is the first CAN line of the first device, `ixxat:1.2` the third one of the second.
// Devices have numbers in the order in which VCI lists them, so one that is pulled out leaves its number to another;
// `ixxat:HW123456` is always the same.
#include <fmt/format.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "runtime/os_port/adapters/adapter_channel.hpp"
#include "runtime/os_port/adapters/ixxat_api.hpp"

namespace ipos::runtime::ixxat {
namespace {

constexpr uint16_t kReceiveQueue = 4096, kSendQueue = 128;  // messages (ours)

struct Place {
  std::string_view hardware;  // of the device; empty: it has a number
  uint32_t device = 0, line = 0;
};
std::optional<Place> place_of(std::string_view channel) {
  const size_t dot = channel.find('.');
  const std::string_view name = channel.substr(0, dot);
  const std::string_view hardware = name.starts_with("HW") ? name : std::string_view();
  const auto device = hardware.empty() ? channel_number(name) : std::optional(0U);
  const auto line = dot == std::string_view::npos ? std::optional(0U) : channel_number(channel.substr(dot + 1));
  if (!device || !line) return std::nullopt;
  return Place{hardware, *device, *line};
}

template <size_t kSize>
std::string_view text_in(const char (&field)[kSize]) {
  return {field, strnlen(field, kSize)};
}

const DeviceInfo* find_device(const std::vector<DeviceInfo>& devices, const Place& place) {
  if (place.hardware.empty()) return place.device < devices.size() ? &devices[place.device] : nullptr;
  const auto found = std::find_if(devices.begin(), devices.end(), [&](const DeviceInfo& info) {
    return text_in(info.hardware_id) == place.hardware;
  });
  return found != devices.end() ? &*found : nullptr;
}

std::string text_of(const Functions& library, Result result) {
  std::array<char, 256> text{};
  library.format_error(result, text.data(), text.size());
  text.back() = 0;
  return text[0] != 0 ? text.data() : fmt::format("VCI error {:08X}h", static_cast<uint32_t>(result));
}

std::vector<DeviceInfo> devices_there(const Functions& library) {
  std::vector<DeviceInfo> devices;
  Handle list = nullptr;
  if (library.enum_open(&list) != kOk) return devices;
  for (DeviceInfo info{}; library.enum_next(list, &info) == kOk;) devices.push_back(info);
  library.enum_close(list);
  return devices;
}

std::string describe(size_t number, const DeviceInfo& info) {
  return fmt::format("{} ({}, {})", number, text_in(info.description), text_in(info.hardware_id));
}

CanArrival error_of(const Message& message) {
  switch (message.data[0]) {
    case kStuffError: return error_arrival(CAN_ERR_PROT, 0, CAN_ERR_PROT_STUFF);
    case kFormError: return error_arrival(CAN_ERR_PROT, 0, CAN_ERR_PROT_FORM);
    case kAcknowledgeError: return error_arrival(CAN_ERR_ACK);
    case kBitError: return error_arrival(CAN_ERR_PROT, 0, CAN_ERR_PROT_BIT);
    case kCrcError: return error_arrival(CAN_ERR_PROT);
    default: return error_arrival(CAN_ERR_BUSERROR);
  }
}

// What is open is closed at the end of its life, in this order.
class IxxatChannel final : public AdapterChannel {
 public:
  IxxatChannel(const Functions& library, std::string port) : library_(library), port_(std::move(port)) {}
  ~IxxatChannel() override {
    if (channel_ != nullptr) library_.channel_close(channel_);
    if (control_ != nullptr) {
      if (is_master_) {
        library_.control_start(control_, false);
        library_.control_reset(control_);
      }
      library_.control_close(control_);
    }
    if (device_ != nullptr) library_.device_close(device_);
  }
  IxxatChannel(const IxxatChannel&) = delete;
  IxxatChannel& operator=(const IxxatChannel&) = delete;

  tl::expected<void, PortError> open(const DeviceInfo& info, uint32_t line, uint16_t timing, const ChannelWish& wish) {
    if (const Result result = library_.device_open(&info.id, &device_); result != kOk)
      return tl::unexpected(error(result));
    if (const Result result = library_.channel_open(device_, line, false, &channel_); result != kOk) {
      if (result == kInvalidIndex)
        return tl::unexpected(port_error(PortFault::NoSuchChannel, port_,
                                         fmt::format("{} has no CAN line {}", text_in(info.hardware_id), line)));
      return tl::unexpected(result == kAccessDenied ? port_error(PortFault::InUse, port_) : error(result));
    }
    Result result = library_.channel_initialize(channel_, kReceiveQueue, 1, kSendQueue, 1);
    if (result == kOk) result = library_.channel_activate(channel_, true);
    if (result == kOk) result = library_.control_open(device_, line, &control_);
    if (result != kOk && result != kAccessDenied) return tl::unexpected(error(result));
    const auto timing0 = static_cast<uint8_t>(timing >> 8), timing1 = static_cast<uint8_t>(timing & 0xFF);
    constexpr uint8_t kMode = kStandardMode | kExtendedMode | kErrorFrameMode;
    is_master_ = result == kOk;
    if (is_master_) {
      result = library_.control_initialize(control_, kMode, timing0, timing1);
      is_master_ = result != kAccessDenied;
      if (result == kOk) result = library_.control_start(control_, true);
      if (result != kOk && is_master_) return tl::unexpected(error(result));
    }
    if (!is_master_) return check_rate(timing0, timing1, wish);
    return look_at_capabilities(wish);
  }

  tl::expected<bool, PortError> write(const Frame& frame) override {
    Message message{};
    message.id = frame.id;
    message.type = kData;
    message.flags = static_cast<uint8_t>(frame.length | (frame.remote ? kRemote : 0) | (frame.extended ? kExtended : 0));
    std::copy(frame.data.begin(), frame.data.end(), message.data);
    const Result result = library_.post_message(channel_, &message);
    if (result == kSendFull) return false;
    if (result == kOk) return true;
    return tl::unexpected(error(result));
  }

  tl::expected<std::optional<CanArrival>, PortError> read() override {
    for (;;) {
      if (std::exchange(overrun_, false)) return overrun_arrival();
      Message message{};
      const Result result = library_.read_message(channel_, 0, &message);
      if (result == kNoMessage || result == kTimeout) return std::nullopt;
      if (result != kOk) return tl::unexpected(error(result));
      overrun_ = (message.flags & kOverrunFlag) != 0;
      if (message.type != kData && message.type != kError) continue;  // that it has started, its state: few
      CanArrival arrival = message.type == kError ? error_of(message) : CanArrival{};
      if (tick_rate_ != 0) {
        const uint64_t ticks = ticks_.extend(message.time);
        arrival.device_time = static_cast<Time>(ticks / tick_rate_) * kSecond +
                              static_cast<Time>(ticks % tick_rate_ * static_cast<uint64_t>(kSecond) / tick_rate_);
      }
      if (arrival.error) return arrival;
      Frame& frame = arrival.frame;
      frame.extended = (message.flags & kExtended) != 0;
      frame.remote = (message.flags & kRemote) != 0;
      frame.id = message.id;
      frame.length = std::min<uint8_t>(message.flags & kLengthBits, 8);
      std::copy(std::begin(message.data), std::end(message.data), frame.data.begin());
      frame = canonical(frame);
      return arrival;
    }
  }

  // VCI tells error warning, and error passive not apart from it.
  tl::expected<ControllerState, PortError> state() override {
    if (control_ == nullptr) return ControllerState::Active;
    LineStatus line{};
    if (const Result result = library_.control_status(control_, &line); result != kOk) return tl::unexpected(error(result));
    if ((line.status & kBusOff) != 0) return ControllerState::Off;
    return (line.status & kErrorLimit) != 0 ? ControllerState::Warning : ControllerState::Active;
  }

  tl::expected<void, PortError> restart() override {
    if (!is_master_) return {};  // the program does it that has the controller
    library_.control_start(control_, false);
    if (const Result result = library_.control_start(control_, true); result != kOk)
      return tl::unexpected(error(result));
    return {};
  }

 private:
  // Another program has the controller, and has set its rate.
  tl::expected<void, PortError> check_rate(uint8_t timing0, uint8_t timing1, const ChannelWish& wish) {
    LineStatus line{};
    if (control_ == nullptr || library_.control_status(control_, &line) != kOk) {
      wish.notes.note(fmt::format("another program has the controller, with a bit rate that VCI does not tell; the bus has {} bit/s",
                                  wish.baud));
      return {};
    }
    if (line.bit_timing0 != timing0 || line.bit_timing1 != timing1)
      return tl::unexpected(port_error(PortFault::WrongBitRate, port_,
                                       fmt::format("another program has set the timing {:02X}h {:02X}h, {} bit/s is {:02X}h {:02X}h",
                                                   line.bit_timing0, line.bit_timing1, wish.baud, timing0, timing1)));
    return look_at_capabilities(wish);
  }

  tl::expected<void, PortError> look_at_capabilities(const ChannelWish& wish) {
    Capabilities has{};
    if (library_.control_capabilities(control_, &has) != kOk) has = {};
    if (has.stamp_divisor != 0) tick_rate_ = has.clock / has.stamp_divisor;
    if (tick_rate_ == 0) wish.notes.note("the adapter does not tell the rate of its clock: its time stamps are left out");
    if ((has.features & kErrorFrameFeature) == 0)
      wish.notes.note("the adapter gives no error frames: only the state of the controller is told");
    return {};
  }

  PortError error(Result result) const {
    const bool gone = result == kDisconnected || result == kInvalidHandle;
    return port_error(gone ? PortFault::Gone : PortFault::Refused, port_, text_of(library_, result));
  }

  Functions library_;
  std::string port_;
  Handle device_ = nullptr, channel_ = nullptr, control_ = nullptr;
  bool is_master_ = false;  // the controller is ours, and no other program's
  uint32_t tick_rate_ = 0;  // 1/s
  WideTicks ticks_;
  bool overrun_ = false;
};

}  // namespace

ChannelResult open(const SharedLibrary& library, const ChannelWish& wish) {
  Functions functions{};
  FunctionFinder finder(library);
  finder.take(functions.initialize_library, "vciInitialize")
      .take(functions.format_error, "vciFormatError")
      .take(functions.enum_open, "vciEnumDeviceOpen")
      .take(functions.enum_next, "vciEnumDeviceNext")
      .take(functions.enum_close, "vciEnumDeviceClose")
      .take(functions.device_open, "vciDeviceOpen")
      .take(functions.device_close, "vciDeviceClose")
      .take(functions.channel_open, "canChannelOpen")
      .take(functions.channel_initialize, "canChannelInitialize")
      .take(functions.channel_activate, "canChannelActivate")
      .take(functions.channel_close, "canChannelClose")
      .take(functions.read_message, "canChannelReadMessage")
      .take(functions.post_message, "canChannelPostMessage")
      .take(functions.control_open, "canControlOpen")
      .take(functions.control_initialize, "canControlInitialize")
      .take(functions.control_start, "canControlStart")
      .take(functions.control_reset, "canControlReset")
      .take(functions.control_status, "canControlGetStatus")
      .take(functions.control_capabilities, "canControlGetCaps")
      .take(functions.control_close, "canControlClose");
  if (!finder.missing().empty()) return tl::unexpected(lacks_function(wish, finder.missing()));
  const auto place = place_of(wish.channel);
  if (!place) return tl::unexpected(port_error(PortFault::BadName, wish.port, "write ixxat:0, ixxat:0.1 or ixxat:HW123456"));
  const auto timing = sja1000_timing(wish.baud);
  if (!timing) return tl::unexpected(no_such_rate(wish));
  if (const Result result = functions.initialize_library(); result != kOk)
    return tl::unexpected(port_error(PortFault::Refused, wish.port, text_of(functions, result)));
  const std::vector<DeviceInfo> devices = devices_there(functions);
  const DeviceInfo* const device = find_device(devices, *place);
  if (device == nullptr) {
    std::vector<std::string> there;
    for (const DeviceInfo& info : devices) there.push_back(describe(there.size(), info));
    return tl::unexpected(no_such_channel(wish, there));
  }
  auto channel = std::make_unique<IxxatChannel>(functions, wish.port);
  if (auto opened = channel->open(*device, place->line, *timing, wish); !opened)
    return tl::unexpected(opened.error());
  return channel;
}

}  // namespace ipos::runtime::ixxat

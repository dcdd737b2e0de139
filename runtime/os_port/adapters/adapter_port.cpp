// Most libraries wake nobody, or each in a way of its own: the channel is looked at once a millisecond.
#include "runtime/os_port/adapter_port.hpp"

#include <fmt/format.h>
#include <linux/can/error.h>

#include <algorithm>
#include <deque>
#include <utility>

#include "runtime/os_port/adapters/adapter_channel.hpp"

namespace ipos::runtime {
namespace {

constexpr Time kAdapterPause = kMillisecond;           // from one look to the next (ours)
constexpr Time kStatePause = 20 * kMillisecond;        // the same for the controller's state (ours)
constexpr Time kBusOffPause = 100 * kMillisecond;      // until it is restarted (ours); Linux: restart-ms of the interface
constexpr uint32_t kMostInARow = 256;                  // then the others have their turn (ours)

struct CanAdapter {
  std::string_view prefix, library, package;
  ChannelResult (*open)(const SharedLibrary& library, const ChannelWish& wish);
};
constexpr CanAdapter kAdapters[] = {
#ifdef _WIN32
#define CAN_ADAPTER(prefix, sample, windows, linux_, package, open) {prefix, windows, package, open},
#else
#define CAN_ADAPTER(prefix, sample, windows, linux_, package, open) {prefix, linux_, package, open},
#endif
#include "runtime/os_port/adapters/can_adapters.def"
};

CanArrival arrival_of(ControllerState state) {
  switch (state) {
    case ControllerState::Active: return error_arrival(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE);
    case ControllerState::Warning:
      return error_arrival(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING);
    case ControllerState::Passive:
      return error_arrival(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE);
    case ControllerState::Off: break;
  }
  return error_arrival(CAN_ERR_BUSOFF);
}

class AdapterPort final : public CanPort {
 public:
  AdapterPort(std::string name, std::unique_ptr<AdapterChannel> channel, RealClock& clock, PortNotes notes)
      : name_(std::move(name)), channel_(std::move(channel)), clock_(clock), notes_(std::move(notes)) {}

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return {-1, false, clock_.now() + (more_ ? 0 : kAdapterPause)}; }
  std::string_view absence() const override {
    return restart_ != kNever ? "the controller is bus-off" : std::string_view();
  }
  size_t waiting() const override { return queue_.size(); }
  const PortCounts& counts() const override { return counts_; }
  std::vector<std::string> take_notes() override { return notes_.take(); }
  std::vector<std::string> repeats() const override { return notes_.repeats(); }

  void send(const Frame& frame) override {
    if (queue_.size() >= kCanPortQueue) {
      ++counts_.lost_out;
      notes_.note(
          fmt::format("frames are lost: {} wait to be sent and the adapter takes none; is there another "
                      "station on the bus, and the same bit rate?",
                      queue_.size()));
      return;
    }
    queue_.push_back(frame);
    if (retry_ == kNever) (void)flush();  // an error is seen by the loop's next flush
  }

  tl::expected<void, PortError> flush() override {
    const Time now = clock_.now();
    if (restart_ != kNever) {
      if (now < restart_) return {};  // frames wait
      if (auto restarted = channel_->restart(); !restarted) return restarted;
      restart_ = kNever;
      state_ = ControllerState::Active;
      look_ = now + kStatePause;
      told_.push_back(error_arrival(CAN_ERR_RESTARTED));
    }
    if (retry_ != kNever && now < retry_) return {};
    retry_ = kNever;
    while (!queue_.empty()) {
      const auto taken = channel_->write(queue_.front());
      if (taken && !*taken) {
        ++counts_.waited;
        retry_ = now + kAdapterPause;
        return {};
      }
      if (!taken && taken.error().fault != PortFault::Refused) return tl::unexpected(taken.error());
      queue_.pop_front();
      ++(taken ? counts_.sent : counts_.lost_out);
      if (!taken) notes_.note(fmt::format("a frame is lost: {}", without_name(taken.error())));
    }
    return {};
  }

  tl::expected<std::optional<CanArrival>, PortError> receive() override {
    if (!told_.empty()) {
      const CanArrival arrival = told_.front();
      told_.pop_front();
      return dated(arrival);
    }
    more_ = ++in_a_row_ > kMostInARow;
    if (more_) return none();
    const auto got = channel_->read();
    if (!got) {
      if (got.error().fault != PortFault::Refused) return tl::unexpected(got.error());
      notes_.note(without_name(got.error()));
      return none();
    }
    if (!*got) return look_at_state();
    if (!(*got)->error)
      ++counts_.received;
    else if (((*got)->error->classes & CAN_ERR_CRTL) != 0 &&
             ((*got)->error->data[1] & CAN_ERR_CRTL_RX_OVERFLOW) != 0)
      ++counts_.lost_in;
    return dated(**got);
  }

 private:
  std::optional<CanArrival> none() {
    in_a_row_ = 0;
    return std::nullopt;
  }

  std::optional<CanArrival> dated(CanArrival arrival) {
    arrival.at = last_ = std::max(last_, clock_.now());
    return arrival;
  }

  std::string_view without_name(const PortError& error) const {
    return std::string_view(error.text).substr(name_.size() + 2);
  }

  tl::expected<std::optional<CanArrival>, PortError> look_at_state() {
    if (restart_ != kNever || clock_.now() < look_) return none();
    look_ = clock_.now() + kStatePause;
    const auto state = channel_->state();
    if (!state && state.error().fault != PortFault::Refused) return tl::unexpected(state.error());
    if (!state || *state == state_) return none();
    state_ = *state;
    if (state_ == ControllerState::Off) restart_ = clock_.now() + kBusOffPause;
    return dated(arrival_of(state_));
  }

  std::string name_;
  std::unique_ptr<AdapterChannel> channel_;
  RealClock& clock_;
  std::deque<Frame> queue_;
  std::deque<CanArrival> told_;  // by the port itself
  Time retry_ = kNever;          // the adapter had no room
  Time restart_ = kNever;        // it is bus-off until then
  Time look_ = 0;                // at the state
  ControllerState state_ = ControllerState::Active;
  uint32_t in_a_row_ = 0;  // since receive() said last that there is nothing
  bool more_ = false;      // of which some may be there still
  Time last_ = 0;
  PortCounts counts_;
  PortNotes notes_;
};

}  // namespace

CanPortResult open_adapter_port(std::string_view name, uint32_t baud, RealClock& clock, const std::string& library) {
  const auto adapter = std::find_if(std::begin(kAdapters), std::end(kAdapters),
                                    [name](const CanAdapter& row) { return name.starts_with(row.prefix); });
  const std::string file = library.empty() ? std::string(adapter->library) : library;
  if (file.empty()) return tl::unexpected(port_error(PortFault::WindowsOnly, name, adapter->package));
  const auto loaded = SharedLibrary::load(file);
  if (!loaded)
    return tl::unexpected(port_error(PortFault::NoLibrary, name,
                                     fmt::format("{}; it comes with {}", loaded.error(), adapter->package)));
  PortNotes notes;
  auto channel = adapter->open(
      *loaded, {std::string(name), std::string(name.substr(adapter->prefix.size())), baud, notes});
  if (!channel) return tl::unexpected(channel.error());
  return std::make_unique<AdapterPort>(std::string(name), std::move(*channel), clock, std::move(notes));
}

}  // namespace ipos::runtime

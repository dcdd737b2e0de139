// What CAN ports and serial ports have in common here is a template; each adds how it sends and receives.
#include "runtime/os_port/returning_port.hpp"

#include <string>
#include <utility>

namespace ipos::runtime {
namespace {

constexpr std::string_view kNumberedPseudoTerminal = "/dev/pts/";

void add(PortCounts& sum, const PortCounts& more) {
  sum.sent += more.sent;
  sum.received += more.received;
  sum.lost_out += more.lost_out;
  sum.lost_in += more.lost_in;
  sum.waited += more.waited;
}

template <typename Kind>
class Returning : public Kind {
 public:
  using Open = std::function<tl::expected<std::unique_ptr<Kind>, PortError>()>;

  Returning(std::unique_ptr<Kind> port, Open open, RealClock& clock)
      : name_(port->name()), port_(std::move(port)), open_(std::move(open)), clock_(clock) {}

  const std::string& name() const override { return name_; }
  PortNeeds needs() const override { return port_ ? port_->needs() : PortNeeds{-1, false, retry_}; }
  std::string_view absence() const override { return port_ ? port_->absence() : std::string_view(lost_); }
  size_t waiting() const override { return port_ ? port_->waiting() : 0; }
  const PortCounts& counts() const override {
    total_ = former_;
    if (port_) add(total_, port_->counts());
    return total_;
  }
  std::vector<std::string> take_notes() override {
    std::vector<std::string> notes = std::exchange(notes_, {});
    if (port_)
      for (std::string& note : port_->take_notes()) notes.push_back(std::move(note));
    return notes;
  }
  std::vector<std::string> repeats() const override {
    return port_ ? port_->repeats() : std::vector<std::string>();
  }

  tl::expected<void, PortError> flush() override {
    if (port_) {
      if (const auto flushed = port_->flush(); !flushed) lose(flushed.error());
    } else if (clock_.now() >= retry_) {
      open_again();
    }
    return {};
  }

 protected:
  Kind* port() { return port_.get(); }  // nullptr while it is away
  void lost_out(size_t number) { former_.lost_out += number; }

  void lose(const PortError& error) {
    notes_ = take_notes();
    add(former_, port_->counts());
    lost_ = error.text.substr(error.text.find(": ") + 2);  // the name stands before it
    port_.reset();
    retry_ = name_.starts_with(kNumberedPseudoTerminal) ? kNever : clock_.now() + kReopenPause;
  }

 private:
  void open_again() {
    auto opened = open_();
    if (opened)
      port_ = std::move(*opened);
    else
      retry_ = clock_.now() + kReopenPause;
  }

  std::string name_;
  std::unique_ptr<Kind> port_;
  Open open_;
  RealClock& clock_;
  std::string lost_;  // why it is away
  Time retry_ = kNever;
  std::vector<std::string> notes_;  // of the last one
  PortCounts former_;               // of those that have gone
  mutable PortCounts total_;
};

class ReturningCan final : public Returning<CanPort> {
 public:
  using Returning::Returning;

  void send(const Frame& frame) override { port() != nullptr ? port()->send(frame) : lost_out(1); }
  tl::expected<std::optional<CanArrival>, PortError> receive() override {
    if (port() == nullptr) return std::nullopt;
    auto arrival = port()->receive();
    if (arrival) return arrival;
    lose(arrival.error());
    return std::nullopt;
  }
};

class ReturningSerial final : public Returning<BytePort> {
 public:
  ReturningSerial(std::unique_ptr<BytePort> port, Open open, RealClock& clock)
      : Returning(std::move(port), std::move(open), clock),
        parity_(this->port()->has_parity()),
        paces_(this->port()->paces()),
        latency_(this->port()->latency()) {}

  // Of its kind, also while it is away.
  bool has_parity() const override { return parity_; }
  bool paces() const override { return paces_; }
  Time latency() const override { return latency_; }

  void send(std::span<const uint8_t> bytes) override {
    port() != nullptr ? port()->send(bytes) : lost_out(bytes.size());
  }
  tl::expected<size_t, PortError> receive(std::span<ByteArrival> into) override {
    if (port() == nullptr) return size_t{0};
    const auto count = port()->receive(into);
    if (count) return count;
    lose(count.error());
    return size_t{0};
  }

 private:
  bool parity_;
  bool paces_;
  Time latency_;
};

template <typename Returned, typename Open>
auto open_as(Open open, RealClock& clock) -> decltype(open()) {
  auto port = open();
  if (!port) return port;
  return std::make_unique<Returned>(std::move(*port), std::move(open), clock);
}

}  // namespace

CanPortResult open_returning(OpenCanPort open, RealClock& clock) {
  return open_as<ReturningCan>(std::move(open), clock);
}

SerialPortResult open_returning(OpenSerialPort open, RealClock& clock) {
  return open_as<ReturningSerial>(std::move(open), clock);
}

}  // namespace ipos::runtime

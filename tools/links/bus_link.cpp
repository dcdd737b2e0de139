// The lines a PC can be on, and the loop that waits for an answer.
#include "tools/links/bus_link.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/sdo_master.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"
#include "runtime/bus/movilink/serial_master.hpp"
#include "runtime/os_port/can_bridge.hpp"
#include "runtime/os_port/port_names.hpp"
#include "runtime/os_port/serial_bridge.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"

namespace ipos::tools {
namespace {

using namespace runtime;  // NOLINT: all of this is about its lines and ports

constexpr int32_t kParameterOnly = 134;   // TYP and Format 86h: parameter channel, acyclic
constexpr Time kIdle = 5 * kMillisecond;  // how often a port without descriptor is looked at
// Gaps this host tears into an answer are closed; nobody else's pauses depend on it here (ours).
constexpr Time kGapSlack = 10 * kMillisecond;
constexpr Time kForEver = 60 * kSecond;  // no exchange takes so long
// This process was stopped, or had no processor (ours). Process data are about now: they are neither begun nor repeated
// after that.
constexpr Time kNap = 200 * kMillisecond;

// The line runs until the exchange is done.
class LineSimulation final : public Simulation {
 public:
  LineSimulation(EventQueue& queue, const std::optional<MovilinkResult>& result, Time longest_nap)
      : queue_(queue), result_(result), longest_nap_(longest_nap) {}
  Time now() const override { return queue_.now(); }
  Time next_time() const override { return std::min(queue_.next_time(), queue_.now() + kIdle); }
  bool run_until(Time end) override {
    if (end - queue_.now() > longest_nap_) return false;
    queue_.run_until(end);
    return !result_ && !interrupted();
  }

 private:
  EventQueue& queue_;
  const std::optional<MovilinkResult>& result_;
  Time longest_nap_;
};

// A PC on a CAN line, whatever is spoken there.
class CanLink : public BusLink, private CanNode {
 public:
  CanLink(const LinkFlags& link, uint32_t baud)
      : BusLink(link), line_(queue(), 0, "CAN", baud), sender_(line_, line_.attach(kNode, baud, *this)) {
    auto port = open_can_port(link.port, baud, clock());
    if (!port) throw Failure(kIoError, port.error().text);
    port_ = std::move(*port);
    bridge_.emplace(queue(), 2, line_, *port_);
  }
  CanLine* can_line() override { return &line_; }

 protected:
  FrameSender& sender() { return sender_; }
  std::string nobody_hint(std::string_view rate_parameters) const {
    return fmt::format("nothing is heard at all: unit on, {} bit/s ({}), wiring, terminators?", line_.baud(),
                       rate_parameters);
  }
  uint32_t baud() const { return line_.baud(); }

 private:
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  Bridge& bridge() override { return *bridge_; }
  uint64_t heard() const override { return port_->counts().received; }

  CanLine line_;
  LinePort sender_;
  std::unique_ptr<CanPort> port_;
  std::optional<CanBridge> bridge_;
};

class SbusLink final : public CanLink {
 public:
  SbusLink(const LinkFlags& link, uint32_t baud)
      : CanLink(link, baud), master_(queue(), 1, sender(), 1, kSbusReplyTimeout + link.host_delay(), client()) {}
  uint8_t last_address() const override { return kSbusAddresses - 1; }

 private:
  void on_frame(Time now, const Frame& frame) override { master_.on_frame(now, frame); }
  void on_sent(Time now, const Frame&, uint64_t tag) override { master_.on_sent(now, tag); }
  MovilinkMaster& master() override { return master_; }
  std::string hint(uint8_t address, uint64_t heard) const override {
    if (heard > 0)
      return fmt::format("others are heard, so the rate of {} bit/s is right: is P813 (P881) = {} anywhere?",
                         baud(), address);
    return nobody_hint("P816, P884");
  }

  SbusMaster master_;
};

class CanopenLink final : public CanLink {
 public:
  CanopenLink(const LinkFlags& link, uint32_t baud)
      : CanLink(link, baud), master_({queue(), 1, sender(), 1}, kSbusReplyTimeout + link.host_delay(), client()) {}
  uint8_t first_address() const override { return 1; }
  uint8_t last_address() const override { return canopen::kMaxNode; }
  bool carries_process_data() const override { return false; }

 private:
  void on_frame(Time now, const Frame& frame) override { master_.on_frame(now, frame); }
  void on_sent(Time, const Frame&, uint64_t) override {}
  MovilinkMaster& master() override { return master_; }
  std::string hint(uint8_t address, uint64_t heard) const override {
    if (heard > 0)
      return fmt::format(
          "others are heard, so the rate of {} bit/s is right: is P880 = CANopen and P886 = {} anywhere, and "
          "the node not stopped?",
          baud(), address);
    return nobody_hint("P884");
  }

  canopen::SdoMaster master_;
};

RequesterTiming timing_of(const LinkFlags& link, uint32_t baud, Time latency) {
  RequesterTiming timing;
  timing.character = character_time(baud);
  // The bridge hands characters over one later, in both directions.
  timing.response_delay = kResponseDelay + 2 * timing.character + latency + link.host_delay();
  if (!link.repeats) timing.repeats = 0;
  return timing;
}

std::unique_ptr<BytePort> open_port(const LinkFlags& link, uint32_t baud, RealClock& clock) {
  auto port = open_serial_port(link.port, {baud, true}, clock);
  if (!port) throw Failure(kIoError, port.error().text);
  return std::move(*port);
}

class SerialLink final : public BusLink, private SerialNode {
 public:
  SerialLink(const LinkFlags& link, uint32_t baud)
      : BusLink(link),
        port_(open_port(link, baud, clock())),
        line_(queue(), 0, "RS-485", baud),
        sender_(line_, line_.attach(kNode, baud, *this)),
        requester_(queue(), 1, sender_, timing_of(link, baud, std::max(port_->latency(), kGapSlack))),
        master_(queue(), requester_, client()),
        bridge_(queue(), 2, line_, *port_, kGapSlack) {}
  Rs485Line* serial_line() override { return &line_; }
  uint8_t last_address() const override { return kNoGroupAddress - 1; }
  bool has_address(int address) const override {
    return address == kUniversalAddress || BusLink::has_address(address);
  }

 private:
  void on_character(Time now, const Character& character) override {
    requester_.on_character(now, character);
  }
  void on_sent(Time now) override { requester_.on_sent(now); }

  MovilinkMaster& master() override { return master_; }
  Bridge& bridge() override { return bridge_; }
  uint64_t heard() const override { return port_->counts().received - bridge_.echoed_bytes(); }
  std::string hint(uint8_t address, uint64_t heard) const override {
    if (bridge_.bad_bytes() > 0)
      return fmt::format(
          "{} bytes came with parity or framing errors: this side has even parity (8E1) and {} baud, the "
          "unit "
          "may have another rate (9600 or 57600), or an adapter in between another parity",
          bridge_.bad_bytes(), line_.baud());
    if (heard > 0)
      return "bytes came that are no answer: another rate, disturbance, or several units with this address?";
    return fmt::format("nothing came back: unit on, P810 = {}, {} baud, A and B not exchanged?", address,
                       line_.baud());
  }

  std::unique_ptr<BytePort> port_;
  Rs485Line line_;
  SerialLinePort sender_;
  SerialRequester requester_;
  SerialMaster master_;
  SerialBridge bridge_;
};

}  // namespace

Time LinkFlags::host_delay() const { return parse_duration(patience); }

std::unique_ptr<BusLink> BusLink::open(const LinkFlags& flags) {
  catch_interrupts();
  constexpr uint32_t kCanBaud = 500'000, kSerialBaud = 9'600;
  std::unique_ptr<BusLink> link;
  if (kind_of_port(flags.port) == PortKind::Serial && flags.canopen)
    throw Failure(kUsage, fmt::format("--canopen: {} is a serial port", flags.port));
  if (kind_of_port(flags.port) == PortKind::Serial)
    link = std::make_unique<SerialLink>(flags, flags.baud == 0 ? kSerialBaud : flags.baud);
  else if (flags.canopen)
    link = std::make_unique<CanopenLink>(flags, flags.baud == 0 ? kCanBaud : flags.baud);
  else
    link = std::make_unique<SbusLink>(flags, flags.baud == 0 ? kCanBaud : flags.baud);
  return link;
}

void BusLink::on_exchange_done(Time /*now*/, const MovilinkResult& result) { result_ = result; }

RealTimeLoop::End BusLink::run(Time limit, Time longest_nap) {
  LineSimulation simulation(queue_, result_, longest_nap);
  RealTimeLoop loop(clock_, simulation);
  loop.add(bridge());
  const RealTimeLoop::End end = loop.run(queue_.now() + limit);
  if (!flags_.quiet || end == RealTimeLoop::End::PortGone) tell();
  if (end == RealTimeLoop::End::PortGone) throw Failure(kIoError, "");
  return end;
}

void BusLink::tell() {
  for (const std::string& text : bridge().take_notes()) fmt::print(stderr, "ipos: {}\n", text);
}

bool BusLink::serve(Time duration) {
  result_.reset();
  return run(duration) == RealTimeLoop::End::Reached;
}

bool BusLink::send_process_data(uint8_t address, const std::array<uint16_t, 3>& words) {
  MovilinkJob job;
  job.address = address;
  job.format = format_code({false, 3, false});
  std::copy(words.begin(), words.end(), job.output.begin());
  result_.reset();
  if (master().start(queue_.now(), job)) return false;
  run(kForEver, kNap);
  if (result_) return result_->reason.empty();
  master().abort();
  if (interrupted()) throw Failure(kInterrupted, "");
  return false;
}

AccessReply BusLink::execute(uint8_t address, stdlib::Service service, uint16_t index, int32_t value) {
  before_question();
  MovilinkJob job;
  job.address = address;
  job.format = kParameterOnly;
  job.service = static_cast<int32_t>(service);
  job.index = index;
  job.write_value = value;
  result_.reset();
  const uint64_t before = heard();
  if (const auto refused = master().start(queue_.now(), job))
    return tl::unexpected(AccessError{*refused, {}});
  run(kForEver);
  if (!result_) {
    master().abort();
    throw Failure(kInterrupted, "");
  }
  if (!result_->reason.empty())
    return tl::unexpected(
        AccessError{{}, fmt::format("{}; {}", result_->reason, hint(address, heard() - before))});
  if (result_->result != 0)
    return tl::unexpected(AccessError{stdlib::ReturnCode::unpack(result_->result), {}});
  return result_->read_value.value_or(value);
}

}  // namespace ipos::tools

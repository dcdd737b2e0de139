// What the buses of a station ask of its unit: parameters, process data, setpoints of master/slave operation,
// the end of an exchange of MOVLNK. Each comes in through the door.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/movilink/exchange.hpp"
#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/unit/door.hpp"

namespace ipos::runtime {

// As ProcessDataServer it serves the SBus, rs485_data() serves both RS-485 interfaces.
class UnitServer final : public ParameterServer, public ProcessDataServer, public MasterSlaveDrive {
 public:
  // `leads`: it is SBus 1, where masters of master/slave operation are heard (MDX60B/61B chapter 5.5.1).
  explicit UnitServer(Door& door, bool leads = true) : door_(door), leads_(leads), rs485_data_(door) {}
  UnitServer(const UnitServer&) = delete;
  UnitServer& operator=(const UnitServer&) = delete;

  tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) override {
    return door_.touch().server().serve(now, request);
  }
  bool has_subindices() const override { return door_.look().server().has_subindices(); }
  void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override {
    if (channel != OutputChannel::Group && hear_again(words)) return;
    UnitInterface& server = door_.touch().server();
    if (channel == OutputChannel::Group && !leads_ && server.follows_sbus_master()) return;
    if (!leads_) return server.take_sbus2(words);
    server.take_output(now, channel, words);
  }
  ProcessWords input(Time /*now*/) override { return door_.look().drive().pi(); }
  ProcessWords input_after_tick(Time /*now*/) override { return door_.look_after_tick().drive().pi(); }
  void synchronize(Time now) override { door_.synchronize(now); }
  ProcessDataServer& rs485_data() { return rs485_data_; }
  // What telegrams wanted and did not get, in words; each is told once.
  std::vector<std::string> take_reasons() {
    if (!door_.has_reasons()) return {};
    UnitInterface& drive = door_.touch().server();
    std::string refused = drive.take_reason();
    std::vector<std::string> reasons = drive.take_obstacles();
    if (!refused.empty()) reasons.insert(reasons.begin(), "refused " + refused);
    return reasons;
  }

  ProcessWords setpoint_to_send(Time now) override { return door_.touch().server().setpoint_to_send(now); }
  void setpoint_received(Time now, const ProcessWords& words) override {
    door_.touch().server().setpoint_received(now, words);
  }
  void link_lost(Time now) override { door_.touch().server().link_lost(now); }

 private:
  // Process data of both RS-485 interfaces: one source, one monitoring.
  class Rs485Data final : public ProcessDataServer {
   public:
    explicit Rs485Data(Door& door) : door_(door) {}
    void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override {
      door_.touch().server().rs485_data().take_output(now, channel, words);
    }
    ProcessWords input(Time /*now*/) override { return door_.look().drive().pi(); }
    void synchronize(Time) override {}  // there is no sync telegram on RS-485
    void cyclic_request(Time now) override { door_.touch().server().rs485_data().cyclic_request(now); }

   private:
    Door& door_;
  };

  bool hear_again(std::span<const uint16_t> words) {
    Unit* const going_on = door_.while_it_goes_on();
    return going_on != nullptr && going_on->server().hear_again(leads_ ? PoSource::Sbus : PoSource::Sbus2, words);
  }

  Door& door_;
  bool leads_;
  Rs485Data rs485_data_;
};

// An exchange that MOVLNK has begun comes to its end: its result is written to variables.
class ExchangeDoor final : public MovilinkClient {
 public:
  ExchangeDoor(Door& door, MovilinkClient& client) : door_(door), client_(client) {}
  void on_exchange_done(Time now, const MovilinkResult& result) override {
    door_.touch();
    client_.on_exchange_done(now, result);
  }

 private:
  Door& door_;
  MovilinkClient& client_;
};

}  // namespace ipos::runtime

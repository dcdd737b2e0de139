// One SBus connection of a station: the slave of its MOVILINK profile, the master of MOVLNK, the variable
// objects and the group telegrams of master/slave operation share one place on the line.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/canopen/sdo_master.hpp"
#include "runtime/bus/movilink/sbus_group_master.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"
#include "runtime/bus/movilink/sbus_slave.hpp"
#include "runtime/commands/movilink_command.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/scom/variable_objects.hpp"
#include "runtime/station/station_port.hpp"
#include "runtime/station/unit_server.hpp"
#include "runtime/unit/door.hpp"

namespace ipos::runtime {

// The parameters of a unit for SBus 1 or 2; empty where it has none for that.
struct SbusNumbers {
  std::string_view protocol, address, group, baud, sync_id, second_channel, canopen_address;
};
const SbusNumbers& sbus_numbers(const stdlib::UnitType& unit, int sbus);

// Settings of SBus 1 or 2 from the parameters of a unit: P813.. (1053 1610 p. 41), MOVIDRIVE B P881.. and
// P891...
struct SbusSettings {
  SlaveSettings slave;
  uint32_t baud = 500'000;
  bool movilink = true;         // P880 and P890 can select CANopen
  uint8_t canopen_address = 0;  // P886, P896
};
SbusSettings sbus_settings(const UnitInterface& drive, int sbus);

// A port attaches to its line, or takes the place `node` of one that went with a power-off.
NodeId join(CanLine& line, std::optional<NodeId> node, std::string_view station, uint32_t baud,
            CanNode& port);

class SbusPort final : public StationPort, private CanNode, private SlaveObserver, private TelegramReader {
 public:
  // Attaches to the line, or takes the place `node` of a port that went with a power-off. `sbus` is 1 or 2.
  // All references must outlive the port.
  SbusPort(EventQueue& queue, uint32_t source, CanLine& line, std::optional<NodeId> node, int sbus,
           std::string_view station, const SbusSettings& settings, Door& door, Journal& journal);

  void power_off() override;
  bool leads() const { return group_master_.active(); }
  // The group telegram of one that leads, then the cyclic objects.
  Time tick(Time now) override {
    if (leads()) [[unlikely]]
      return lead(now);
    const OwnMilliseconds& own = door_.milliseconds();
    const int64_t due = objects_.tick(own.number(now), door_.variables_in_turn());
    return due == INT64_MAX ? kNever : own.begin_of(due, now);
  }
  Time tick_at_rest(Time now, Time until) override;
  void rest_ends() override {
    if (std::exchange(line_sends_, false)) take_back();
  }
  bool has_waiting_frames() const override { return line_.has_waiting(node()); }
  void want_again() override {
    if (std::exchange(rests_, false)) want_each_again();
  }

  NodeId node() const { return sender_.node(); }
  CanLine& line() const { return line_; }
  const SbusSettings& settings() const { return settings_; }
  VariableObjects& objects() { return objects_; }
  const VariableObjects& objects() const { return objects_; }
  // Whom the program has called by MOVLNK over this bus.
  const std::vector<MovilinkCommand::Partner>& partners() const { return movilink_.partners(bus_); }
  const GroupMaster& group_master() const { return group_master_; }

 private:
  Time lead(Time now);
  void on_frame(Time now, const Frame& frame) override;
  void want_each_again();
  void take_back();
  bool calls() const { return master_.busy() || (client_ && client_->busy()); }
  bool waits(const Frame& frame);
  bool receive(Time now, const Frame& frame);
  void read(size_t object, const TelegramData& data) override;
  void tell_reasons(Time now);
  void tell_shared(Time now, const Frame& frame);
  void on_sent(Time now, const Frame& frame, uint64_t tag) override;
  bool minds_repeats() const override { return false; }  // acyclic telegrams are not sent again
  void on_not_sent(Time now, const Frame& frame, uint64_t tag, NotSent reason) override;
  void on_bus_off(Time now) override;
  void on_ignored(Time now, const Frame& frame, Ignored reason, ReturnCode code) override;
  void note(Time now, Weight weight, std::string text);

  // What every tick looks at stands together.
  bool rests_ = false;  // the line need not tell it of some frames
  bool powered_ = true;
  bool line_sends_ = false;  // the cyclic objects, as long as the station rests
  uint32_t source_;
  Door& door_;
  LinePort sender_;
  VariableObjects objects_;

  CanLine& line_;
  std::string_view station_;
  SbusSettings settings_;
  Journal& journal_;
  UnitServer server_;
  SbusSlave slave_;
  const MovilinkCommand& movilink_;
  MovilinkBus bus_;
  ExchangeDoor exchanges_;
  SbusMaster master_;
  ExchangeDoor client_exchanges_;
  std::optional<canopen::SdoMaster> client_;  // MOVITRAC 07: MOVLNK over CANopen
  GroupMaster group_master_;
};

}  // namespace ipos::runtime

// The drive of a unit as telegrams see it: it serves parameters and process data from the drive's parameters
// and state, for MOVLNK address 253 and, through UnitServer (runtime/plant), for the buses. It holds the memory.
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/sbus_slave.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/drive/drive.hpp"
#include "runtime/drive/parameters.hpp"
#include "runtime/nv_memory/kept/unit_memory.hpp"
#include "vm/exec/machine.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::runtime {

// What an RS-485 interface has to know of the unit.
struct SerialParameters {
  uint8_t address;          // P810
  uint8_t group;            // P811
  int32_t slave_setpoint;   // P750
  int32_t setpoint_source;  // P100
};

// As ProcessDataServer it serves the SBus, rs485_data() serves both RS-485 interfaces.
class UnitInterface final : public ParameterServer, public ProcessDataServer, public MasterSlaveDrive {
 public:
  explicit UnitInterface(const stdlib::UnitType& unit, const MachineData& machine = {},
                       DriveOptions options = {});
  UnitInterface(const UnitInterface&) = delete;
  UnitInterface& operator=(const UnitInterface&) = delete;

  // Sets a parameter before power-on, named "P813" or by index; nothing when accepted, else why not.
  std::optional<std::string> set_parameter(std::string_view parameter, int32_t value);

  // Working value of a parameter by its number ("813"); 0 for one the unit does not have.
  int32_t value(std::string_view number) const;

  // Commands per millisecond from P938 and P939 (IPOSplus p. 44). Both together add 9 at most, as in the
  // table there; what is more task 2 does not get (ours).
  const vm::Rates& rates() const {
    if (rates_for_ != parameters_.changes()) find_rates();
    return rates_;
  }

  // From now on 11000 + n leads to the machine's variables, and 16000 + n is open while it does not run.
  void connect_program(vm::Machine& machine);
  // Before the machine vanishes.
  void disconnect_program();

  // Power was off and is back: values from the memory, no fault, no process data.
  void power_cycle();

  Drive& state() { return state_; }
  const Drive& state() const { return state_; }
  ParameterStore& parameters() { return parameters_; }
  const ParameterStore& parameters() const { return parameters_; }
  const stdlib::UnitType& unit() const { return parameters_.unit(); }
  UnitMemory& memory() { return memory_; }
  const UnitMemory& memory() const { return memory_; }

  // Why the last access was refused, empty when it was not. Reading it clears it.
  std::string take_reason() { return std::exchange(reason_, {}); }

  // One of the two has something.
  bool has_reasons() const { return !reason_.empty() || !obstacles_.empty() || parameters_.has_news(); }

  // What keeps process data that came over a bus, or a setting, from acting, each told once.
  std::vector<std::string> take_obstacles() {
    for (std::string& news : parameters_.take_news()) obstacles_.push_back(std::move(news));
    return std::exchange(obstacles_, {});
  }

  tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) override;
  bool has_subindices() const override { return unit().has(stdlib::Trait::Subindices); }
  void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override;
  // The words of the last telegram of this bus once more, to the unit alone: Drive::hear_again(). False: take_output() or
  // take_sbus2().
  bool hear_again(PoSource link, std::span<const uint16_t> words) {
    return looked_for_[static_cast<size_t>(PoSource::Sbus)][0] == parameters_.changes() + 1 && state_.hear_again(link, words);
  }
  // Over SBus 2, which is monitored by P893.
  void take_sbus2(std::span<const uint16_t> words);
  bool follows_sbus_master() const;  // P100 = MASTER-SBus
  bool is_slave() const;             // of master/slave operation, over SBus or RS-485
  ProcessWords input(Time now) override;
  void synchronize(Time now) override;
  bool follows_sync() const;  // P887
  uint32_t syncs() const { return syncs_; }  // sync telegrams so far

  // Some of P870..P872 says so.
  bool has_control_word() const {
    return has_po_word({PoAssignment::ControlWord1, PoAssignment::ControlWord2});
  }
  bool has_speed_word() const { return has_po_word({PoAssignment::Speed, PoAssignment::RelativeSpeed}); }

  ProcessDataServer& rs485_data() { return rs485_data_; }
  SerialParameters serial_parameters() const;

  // Process data over a fieldbus card, and the end of them that the card's watchdog finds.
  void take_fieldbus(std::span<const uint16_t> words);
  // The master exchanges data, with or without new words.
  void fieldbus_request() { state_.take_request(PoSource::Fieldbus); }
  void fieldbus_lost() { state_.lose(PoSource::Fieldbus); }
  // Of a PROFIBUS card: what the unit finds at power-on.
  void show_fieldbus_card(uint8_t address);

  // Master/slave operation over RS-485 and SBus: what the master sends, and a slave takes.
  ProcessWords setpoint_to_send(Time now) override;
  void setpoint_received(Time now, const ProcessWords& words) override;
  void link_lost(Time now) override;

 private:
  // Process data of both RS-485 interfaces: one source, one monitoring.
  class Rs485Data final : public ProcessDataServer {
   public:
    explicit Rs485Data(UnitInterface& drive) : drive_(drive) {}
    void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override;
    ProcessWords input(Time now) override;
    void synchronize(Time) override {}  // there is no sync telegram on RS-485
    void cyclic_request(Time now) override;

   private:
    UnitInterface& drive_;
  };

  enum class Obstacle : uint8_t { PoDisabled, ControlSource, SetpointSource, NoControlWord, Reserved, Slave };
  struct DataBus;  // a bus as P100 and P101 name it
  void look_for_obstacles(const DataBus& bus, bool slave);
  void obstruct(const DataBus& bus, Obstacle obstacle, std::string_view what, std::string_view number,
                int32_t wanted);
  void tell_once(Obstacle obstacle, uint32_t shift, std::string_view text);
  static uint32_t told_bit(Obstacle obstacle, uint32_t shift) {
    return 1U << (static_cast<uint32_t>(obstacle) + shift);
  }
  bool was_told(Obstacle obstacle, uint32_t shift) const {
    return (told_obstacles_ & told_bit(obstacle, shift)) != 0;
  }

  bool has_po_word(std::initializer_list<PoAssignment> wanted) const;
  void find_rates() const;
  uint16_t index_of(std::string_view number) const;  // 0 for a parameter the unit does not have

  ParameterStore parameters_;
  UnitMemory memory_;
  Drive state_;
  Rs485Data rs485_data_{*this};
  struct SerialIndices {
    uint16_t address, group, slave_setpoint, setpoint_source;
  };
  SerialIndices serial_;  // P810, P811, P750, P100
  uint16_t task1_speed_;  // index of P938
  uint16_t task2_speed_;  // index of P939
  mutable vm::Rates rates_;
  mutable uint32_t rates_for_ = UINT32_MAX;  // ParameterStore::changes()
  uint32_t syncs_ = 0;
  std::string reason_;
  std::vector<std::string> obstacles_;
  uint32_t told_obstacles_ = 0;  // a bit each
  // The settings for which it was told what there is, for each bus, and as a slave: ParameterStore::changes() + 1.
  std::array<std::array<uint32_t, 2>, kPoSources> looked_for_{};
};

}  // namespace ipos::runtime

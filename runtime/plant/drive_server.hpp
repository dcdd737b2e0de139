// The drive of a station as the rest of the station sees it: it serves the bus's parameter and process data
// telegrams and MOVLNK address 253 from the drive's parameters and unit state, and opens the areas that
// belong to the program.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/drive/drive.hpp"
#include "runtime/drive/parameters.hpp"
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
class DriveServer final : public ParameterServer, public ProcessDataServer, public MasterSlaveDrive {
 public:
  explicit DriveServer(const stdlib::UnitType& unit, const MachineData& machine = {},
                       DriveOptions options = {});
  DriveServer(const DriveServer&) = delete;
  DriveServer& operator=(const DriveServer&) = delete;

  // Sets a parameter before power-on, named "P813" or by index; nothing when accepted, else why not.
  std::optional<std::string> set_parameter(std::string_view parameter, int32_t value);

  // Working value of a parameter by its number ("813"); 0 for one the unit does not have.
  int32_t value(std::string_view number) const;

  // Commands per millisecond from P938 and P939 (IPOSplus p. 44).
  vm::Rates rates() const;

  // From now on 11000 + n and 16000 + n lead to the machine's variables and code.
  void connect_program(vm::Machine& machine);

  Drive& state() { return state_; }
  const Drive& state() const { return state_; }
  ParameterStore& parameters() { return parameters_; }

  // Why the last access was refused, empty when it was not. Reading it clears it.
  std::string take_reason() { return std::exchange(reason_, {}); }

  tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) override;
  void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override;
  ProcessWords input(Time now) override;
  void synchronize(Time now) override;

  ProcessDataServer& rs485_data() { return rs485_data_; }
  SerialParameters serial_parameters() const;

  // Master/slave operation over RS-485.
  ProcessWords setpoint_to_send(Time now) override;
  void setpoint_received(Time now, const ProcessWords& words) override;
  void link_lost(Time now) override;

 private:
  // Process data of both RS-485 interfaces: one source, one monitoring.
  class Rs485Data final : public ProcessDataServer {
   public:
    explicit Rs485Data(DriveServer& drive) : drive_(drive) {}
    void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override;
    ProcessWords input(Time now) override;
    void synchronize(Time) override {}  // there is no sync telegram on RS-485
    void cyclic_request(Time now) override;

   private:
    DriveServer& drive_;
  };
  // IPOS variables, index 11000 + n. They are there without a program, too. Volatile and non-volatile writes
  // are the same until there is a non-volatile memory.
  class Variables final : public IndexWindow {
   public:
    explicit Variables(uint16_t count) : without_program_(count) {}
    void connect(vm::Machine& machine) { h_ = machine.variables(); }
    ParameterReply read(uint16_t offset) override { return h_[offset]; }
    ParameterReply write(uint16_t offset, int32_t value, bool /*nonvolatile*/) override {
      return h_[offset] = value;
    }

   private:
    std::vector<int32_t> without_program_;
    std::span<int32_t> h_ = without_program_;
  };
  // IPOS program code, index 16000 + n: readable, words behind the program are 0. Writing is refused while it
  // runs.
  class Code final : public IndexWindow {
   public:
    void connect(const vm::Machine& machine) { code_ = machine.program().code(); }
    ParameterReply read(uint16_t offset) override;
    ParameterReply write(uint16_t offset, int32_t value, bool nonvolatile) override;

   private:
    std::span<const uint32_t> code_;
  };

  uint16_t index_of(std::string_view number) const;  // 0 for a parameter the unit does not have

  ParameterStore parameters_;
  Drive state_;
  Variables variables_;
  Code code_;
  Rs485Data rs485_data_{*this};
  struct SerialIndices {
    uint16_t address, group, slave_setpoint, setpoint_source;
  };
  SerialIndices serial_;  // P810, P811, P750, P100
  uint16_t task1_speed_;  // index of P938
  uint16_t task2_speed_;  // index of P939
  std::string reason_;
};

}  // namespace ipos::runtime

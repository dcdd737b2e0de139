// One station: the VM with its program, the drive with its parameters, and the ports to the buses. Everything
// that happens in it happens in its millisecond tick or on the arrival of a frame; docs/cycle.md has the
// order.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/keypad.hpp"
#include "runtime/plant/drive_server.hpp"
#include "runtime/plant/plant_file.hpp"
#include "runtime/plant/sbus_port.hpp"
#include "runtime/plant/serial_port.hpp"
#include "runtime/services/journal.hpp"
#include "runtime/services/system_commands.hpp"
#include "vm/exec/machine.hpp"
#include "vm/image/image.hpp"
#include "vm/sched/scheduler.hpp"

namespace ipos::runtime {

// What a unit type allows a program.
vm::Limits limits_of(const stdlib::UnitType& unit);

// The lines of a station; null where it is not connected.
struct StationLines {
  std::array<CanLine*, 2> sbus{};  // SBus 1 and 2
  Rs485Line* x13 = nullptr;
  Rs485Line* xt = nullptr;  // with a keypad the line to it
};

class Station final : private EventTarget {
 public:
  // `program` is empty for a station without IPOS program. The config and the journal must outlive the
  // station. Parameters of the config must be checked before (plant.cpp). The program must pass verify() for
  // the unit.
  Station(EventQueue& queue, uint32_t source, const StationConfig& config, std::optional<vm::Image> program,
          StationLines lines, Journal& journal, std::optional<vm::Rates> rates);

  // Applies a parameter of the plant file; nothing when it was accepted, else why not.
  std::optional<std::string> set_parameter(const ParameterSetting& setting);

  // After all parameters are set: connects to the bus and starts the program.
  void power_on();

  const StationConfig& config() const { return config_; }
  const vm::Image* image() const { return image_ ? &*image_ : nullptr; }
  const vm::Machine* machine() const { return machine_ ? &*machine_ : nullptr; }
  DriveServer& drive() { return drive_; }
  const DriveServer& drive() const { return drive_; }

  // SBus 1 or 2; null when the station is not on it.
  const SbusPort* sbus(int number) const { return sbus_[static_cast<size_t>(number - 1)].get(); }
  SbusPort* sbus(int number) { return sbus_[static_cast<size_t>(number - 1)].get(); }

  // The program has ended, was never there, or a fault has stopped it.
  bool program_over() const;
  uint8_t fault() const;  // error or warning, 0 is none
  bool error() const;     // a fault that stops the drive until it is reset
  uint16_t status_word_1() const;

  // Number of a variable by symbol or as Hn; nothing when there is none.
  std::optional<uint32_t> find_variable(std::string_view name) const;
  int32_t variable(uint32_t number) const { return machine_->variables()[number]; }

  // "SCOM1.IPC:12:5" of a word address, or empty.
  std::string source_place(uint32_t address) const;

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void connect_sbus(int number);
  void connect_serial();
  void report_fault(Time now);
  void report_drive(Time now);

  EventQueue& queue_;
  uint32_t source_;
  const StationConfig& config_;
  StationLines lines_;
  Journal& journal_;
  DriveServer drive_;
  MovilinkCommand movilink_;
  std::optional<vm::Image> image_;
  std::array<std::unique_ptr<SbusPort>, 2> sbus_;

  // RS-485; empty without a line.
  std::unique_ptr<SerialPort> x13_;
  std::unique_ptr<SerialPort> xt_;
  std::unique_ptr<Keypad> keypad_;

  std::optional<SystemCommands> commands_;
  std::optional<vm::Machine> machine_;
  std::optional<vm::Rates> rates_;  // instead of P938 and P939
  bool fault_reported_ = false;     // of the program
  // What was last told of the drive.
  uint8_t told_fault_ = 0;
  uint16_t told_reserved_ = 0;  // bits of the control word
  Block told_block_ = Block::None;
  SetpointNote told_note_ = SetpointNote::None;
};

}  // namespace ipos::runtime

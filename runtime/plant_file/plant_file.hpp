// The plant file (TOML): buses, stations, their parameters and inputs, and what is expected of them. Reading
// it checks names, types, units and cross references; every error has line and column, and all are reported
// at once. The keys are listed in docs/guide/plant-file.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "runtime/bus/can/line_fault.hpp"
#include "runtime/bus/canopen/master.hpp"
#include "runtime/bus/movilink/sbus_control.hpp"
#include "runtime/bus/rs485/octet_fault.hpp"
#include "runtime/drive/parameters.hpp"
#include "runtime/drive/setpoint.hpp"
#include "runtime/motion/machine_data.hpp"
#include "runtime/nv_memory/medium/file_medium.hpp"
#include "runtime/plant_file/bus_kind.hpp"
#include "runtime/plant_file/driven_machine.hpp"
#include "runtime/plant_file/encoder_socket.hpp"
#include "runtime/plant_file/foreign_machine.hpp"
#include "runtime/plant_file/profibus_config.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/plant_file/toml_text.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

struct BusConfig {
  std::string name;
  BusKind kind = BusKind::Can;
  uint32_t baud = 500'000;  // bit/s
  std::string port;         // of the real bus it is joined to, or empty
  FilePlace port_place;
  FilePlace place;
  // The cable, for planning only; 0: not given.
  uint32_t length_mm = 0;
  uint32_t impedance = 0;    // ohm
  uint32_t capacitance = 0;  // pF/m
  double loop_resistance = 0;  // ohm/km, of PROFIBUS as the next two
  double core_diameter = 0;    // mm
  double core_section = 0;     // mm2
  bool shielded = false;
  bool terminated = false;  // external terminating resistors
};

// A value for a parameter named "P813" or by its index.
struct ParameterSetting {
  std::string parameter;
  int32_t value = 0;
  FilePlace place;
};

// A binary input, DI00..DI17, held from the start.
struct InputSetting {
  uint8_t input = 0;  // bit of InputLevel H483
  bool level = false;
  FilePlace place;
};

// The RS-485 side of a station. Which of it a unit type has is checked by serial_plan.hpp.
struct SerialConfig {
  BusUse x13;           // terminals X13: RS-485 no. 2, bus type 2 of MOVLNK
  BusUse xt;            // socket XT or TERMINAL: RS-485 no. 1, bus type 1
  bool keypad = false;  // plugged in there
  bool uss21a = false;  // serial option there, MOVIDRIVE A
  bool s13 = false;     // DIP switch of MOVIDRIVE B: ON is 9.6 kbaud at XT, OFF 57.6 (factory setting)
  FilePlace keypad_place;
  FilePlace uss21a_place;
  FilePlace s13_place;
};

struct StationConfig {
  std::string name;
  const stdlib::UnitType* unit = nullptr;
  DriveOptions options;
  std::string program;  // as written, relative to the plant file; empty: no program
  std::string sbus;     // name of a bus, or empty
  std::string sbus2;    // SBus 2 of a MOVIDRIVE B
  std::string nvram;    // file of the non-volatile memory; empty: kept for the run only
  FileUse nvram_use = FileUse::Write;
  SerialConfig serial;
  ProfibusUse profibus;
  std::string device;  // type designation, where a rule needs it: "MCH42A"
  // The switches of the terminating resistors, for `ipos bus plan` and the journal.
  std::optional<bool> terminator;   // S12, of the SBus
  std::optional<bool> terminator2;  // R of DFC11B, of SBus 2 (MDX60B/61B chapter 3.3.1)
  bool branch = false;              // the cable goes on over SC21/SC22
  std::vector<ParameterSetting> parameters;
  std::vector<InputSetting> inputs;
  AnalogInputs analog;
  MachineData machine;           // [station.motor], .unit_rating, .brake, .load; the rest is the default machine's
  std::optional<DrivenMachine> driven;  // [station.machine]
  std::vector<EncoderUse> encoders;     // [station.encoders]
  std::vector<std::string> hex;  // variables the watch shows in hexadecimal
  FilePlace place;
  FilePlace program_place;
  FilePlace nvram_place;
};

inline constexpr size_t kMostGatewayDrives = 8;
inline constexpr int32_t kSbusAddressCount = 64;
inline constexpr int64_t kGatewayCycle = 10'000'000;  // ns between two telegrams to a drive (ours)

// A gateway is the master of its SBus: its DP side, and its drives by their addresses in rising order; empty: those of
// the plant.
struct GatewayConfig {
  ProfibusUse profibus;
  std::vector<uint8_t> drives;
};

// What sends without being a station with a drive. A master control on an SBus: process data to units, and the sync
// telegram; or a master of CANopen, or one of DP or FMS on a PROFIBUS, or a gateway. Each has a class in runtime/station/control.hpp.
struct ControlConfig {
  std::string name;
  std::string sbus;  // empty: only on a PROFIBUS
  std::variant<ControlSettings, canopen::MasterSettings, ProfibusMasterConfig, FmsMasterConfig, GatewayConfig> kind{};
  std::optional<bool> terminator;
  FilePlace place;

  // Null when it is of another kind.
  template <typename Kind>
  const Kind* as() const {
    return std::get_if<Kind>(&kind);
  }
};

// A planted fault of a line; its node is found when it is planted.
struct FaultConfig {
  std::string bus;
  std::string station;  // empty: all
  LineFault fault;      // of an SBus
  std::optional<OctetFault> octets{};  // of a line of another kind
  FilePlace place;

  // Its times count from `start` on.
  void begin_at(Time start, uint64_t more_seed) {
    const auto move = [&](auto& moved) {
      moved.from += start;
      if (moved.until != kNever) moved.until += start;
      moved.seed += more_seed;
    };
    move(fault);
    if (octets) move(*octets);
  }
};

// Something outside of the stations that happens at its time: a hand on a switch, a write of an operator.
struct Stimulus {
  enum class Action : uint8_t {
    Set,      // once
    Force,    // held against program, wires and switches
    Release,  // ends Force
    Pulse,    // Force for a while, then what was before
  };
  Signal signal;
  Action action = Action::Set;
  int32_t value = 0;
  std::string written;  // of a signal of any kind, as it stands in the file: its value is read when the signal is known
  int64_t at = 0;      // ns
  int64_t length = 0;  // ns, of Pulse; of Force 0: until Release
  int64_t every = 0;   // ns; 0: only once
  int64_t times = 0;   // with `every`; 0: without end
  FilePlace place;
};

// A binary output of a station on a binary input, of another one or the same.
struct Wire {
  Signal from;
  Signal to;
  bool invert = false;
  FilePlace place;
};

// A limit switch or cam: an input that tells whether the axis is between two positions, both included.
struct PositionSwitch {
  Signal input;
  int32_t from = INT32_MIN;  // increments
  int32_t to = INT32_MAX;
  bool active_high = true;  // level within
  FilePlace place;
};

// At a point of virtual time a signal of a station has a value.
struct Expectation {
  Signal signal;
  int64_t at = 0;  // ns
  int64_t equals = 0;  // in units of the last decimal of the signal
  FilePlace place;
};

struct PlantFile {
  std::vector<BusConfig> buses;
  std::vector<StationConfig> stations;
  std::vector<ControlConfig> controls;
  std::vector<FaultConfig> faults;
  std::vector<Stimulus> stimuli;
  std::vector<Wire> wires;
  std::vector<PositionSwitch> switches;
  std::vector<LightBarrier> barriers;
  std::vector<MachineConfig> machines;
  std::vector<Expectation> expectations;
  uint64_t line_seed = 0;            // by how much that of what lines disturb by themselves has been moved
  size_t expectations_of_tests = 0;  // [[expect]] of kinds that only `ipos test` looks at
};

// What a key takes, where that is a short list or a range of numbers.
struct AllowedValues {
  std::vector<std::string> each{};  // as the file writes them; empty: the numbers from least to most
  int64_t least = 0;
  int64_t most = 0;
  std::string_view unit{};  // of the numbers
};

struct PlantError {
  FilePlace place;
  std::string text;
  std::optional<AllowedValues> allowed = std::nullopt;  // for editors: instead of the value that is wrong
};

struct PlantFileResult {
  PlantFile plant;
  std::vector<PlantError> errors;  // empty: the plant can be used
};

// The path decides only whether a file with nothing but the name of a plant is a test or a campaign (toml_kind.hpp).
PlantFileResult read_plant_file(std::string_view text, std::string_view path = {});

// Another seed for all that goes by chance: line faults, what lines disturb by themselves, and the noise of actual
// values. By 0 nothing changes.
void move_seeds(PlantFile& plant, uint64_t by);

// The [[fault]] tables of a text, for a plant that is there; the result has only them.
PlantFileResult read_fault_tables(std::string_view text, const PlantFile& plant);

// "500ms", "1.5s", "20us", "2min": nanoseconds, or -1 when it is no duration.
int64_t parse_duration(std::string_view text);

}  // namespace ipos::runtime

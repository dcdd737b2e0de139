// The plant file (TOML): buses, stations, their parameters and inputs, and what is expected of them. Reading
// it checks names, types, units and cross references; every error has line and column, and all are reported
// at once. The keys are listed in docs/plant-file.md.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/drive/parameters.hpp"
#include "runtime/drive/setpoint.hpp"
#include "runtime/motion/machine_data.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

// Where something stands in the plant file, from 1; 0 when it does not stand there.
struct FilePlace {
  uint32_t line = 0;
  uint32_t column = 0;
};

enum class BusKind : uint8_t { Can, Rs485, Rs232, Profibus };

constexpr bool is_serial(BusKind kind) { return kind == BusKind::Rs485 || kind == BusKind::Rs232; }

struct BusConfig {
  std::string name;
  BusKind kind = BusKind::Can;
  uint32_t baud = 500'000;  // bit/s
  std::string port;         // of the real bus it is joined to, or empty
  FilePlace port_place;
  FilePlace place;
  // Of a serial line, for the planning checks only (serial_plan.hpp).
  uint32_t length_mm = 0;  // 0: not given
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

// A bus by its name, and where the station names it.
struct BusUse {
  std::string bus;  // empty: not connected
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
  SerialConfig serial;
  std::vector<ParameterSetting> parameters;
  std::vector<InputSetting> inputs;
  AnalogInputs analog;
  MachineData machine;           // [station.load] on the default machine
  std::vector<std::string> hex;  // variables the watch shows in hexadecimal
  FilePlace place;
  FilePlace program_place;
};

// At a point of virtual time a variable of a station has a value.
struct Expectation {
  std::string station;
  int64_t at = 0;        // ns
  std::string variable;  // symbol or Hn
  int32_t equals = 0;
  FilePlace place;
};

struct PlantFile {
  std::vector<BusConfig> buses;
  std::vector<StationConfig> stations;
  std::vector<Expectation> expectations;
};

struct PlantError {
  FilePlace place;
  std::string text;
};

struct PlantFileResult {
  PlantFile plant;
  std::vector<PlantError> errors;  // empty: the plant can be used
};

PlantFileResult read_plant_file(std::string_view text);

// "500ms", "1.5s", "20us", "2min": nanoseconds, or -1 when it is no duration.
int64_t parse_duration(std::string_view text);

// "DI03" or "DI12": bit of InputLevel H483, or -1. DI00..DI07 are bits 0..7, DI10..DI17 bits 8..15 (ours).
int parse_input(std::string_view name);

}  // namespace ipos::runtime

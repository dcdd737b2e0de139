// MOVILINK and variable telegrams in words and units: "20B read 8318 Speed -> unit1". Names come from a
// dictionary, which the caller fills from the plant or the programs.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/movilink/process_words.hpp"
#include "runtime/bus/movilink/profile.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {

struct VariableName {
  uint16_t number;
  std::string name;
};

struct UnitNames {
  std::string name;
  const stdlib::UnitType* unit = nullptr;
  SlaveSettings settings;
  WordAssignment output{};  // P870..P872
  WordAssignment input{};   // P873..P875
  std::vector<VariableName> variables;
  uint16_t first_index = 0;  // indices on the bus are higher by this: 1000 of a MOVITRAC 31 over PROFIBUS

  // "lTrDataLow", or "H426" for a variable without a name.
  std::string variable(uint32_t number) const;
};

// A variable telegram and what its sender, or without one a receiver, calls its variables.
struct ObjectNames {
  uint32_t id = 0;
  std::string station;
  bool sent = false;
  VariableFormat format;
  std::array<std::string, 2> variables;  // DPointer and DPointer + 1
  int32_t cycle = 0;                     // ms; 0: acyclic or only received
};

struct TelegramNames {
  std::vector<UnitNames> units;
  std::vector<ObjectNames> objects;

  const UnitNames* unit_at(uint8_t address) const;
  const ObjectNames* object(uint32_t id) const;
};

struct Description {
  bool known;  // false: nothing is known about the identifier, the text shows the bytes
  std::string text;
};

// Without a dictionary, parameters are those of MOVIDRIVE MD_60A and process data words are shown in
// hexadecimal.
Description describe(const TelegramNames& names, const Frame& frame);

// Somebody in the dictionary sends or takes it: an object, or a telegram of MOVILINK.
bool concerns(const TelegramNames& names, const Frame& frame);

}  // namespace ipos::runtime

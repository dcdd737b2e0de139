// What the plant file says about PROFIBUS: the card of a station, and a model master with its slaves and what it does
// when.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/profibus/master.hpp"
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::profibus {
struct OptionType;
}

namespace ipos::runtime {

// A bus by its name, and where the station names it.
struct BusUse {
  std::string bus;  // empty: not connected
  FilePlace place;
};

struct ProfibusUse {
  const profibus::OptionType* option = nullptr;
  FilePlace option_place;
  BusUse bus;
  uint8_t address = profibus::kNoAddressYet;  // of the switches on the card
  std::optional<bool> terminator{};           // the one of the card, for `ipos bus plan` and the journal
};

// New outputs, as octets from the first or, with the words alone, after the parameter channel.
struct ProfibusOutput {
  Time at = 0;
  size_t slave = 0;  // in the order of the file
  size_t first = 0;  // octet
  profibus::Octets octets;
};

struct ProfibusOrder {
  enum class Kind : uint8_t { Control, Start, Stop };
  Time at = 0;
  Kind kind = Kind::Control;
  profibus::GlobalCommand command;
};

struct ProfibusMasterConfig {
  std::string bus;
  profibus::MasterSettings settings;
  std::vector<profibus::SlavePlan> slaves;
  std::vector<ProfibusOutput> outputs;
  std::vector<ProfibusOrder> orders;
};

}  // namespace ipos::runtime

// What the plant file says about PROFIBUS: the card of a station, and a model master with its slaves and what it does
// when.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/profibus/fms/service.hpp"
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

// Which MOVITRAC 31 has which option pcb, as far as the file says (MOVITRAC 31 PROFIBUS, 2.1.2): for `ipos bus plan`.
struct ProfibusFit {
  char pcb = 0;     // FFP 31A or 31C, 'A' or 'C'
  char series = 0;  // MOVITRAC 31B or 31C, 'B' or 'C'
  std::optional<uint8_t> size{};
  std::optional<uint8_t> service_code{};  // of component 4
};

struct ProfibusUse {
  const profibus::OptionType* option = nullptr;
  FilePlace option_place;
  BusUse bus;
  uint8_t address = profibus::kNoAddressYet;  // of the switches on the card
  bool fms_switch = false;                    // FMS/DP of a combislave, else DP
  std::optional<bool> terminator{};           // the one of the card, for `ipos bus plan` and the journal
  ProfibusFit fit{};
};

// New outputs, as octets from the first or, with the words alone, after the parameter channel.
struct ProfibusOutput {
  Time at = 0;
  size_t slave = 0;  // in the order of the file
  size_t first = 0;  // octet
  profibus::Octets octets;
};

struct ProfibusOrder {
  enum class Kind : uint8_t { Control, Start, Stop, Activate, Deactivate };
  Time at = 0;
  Kind kind = Kind::Control;
  profibus::GlobalCommand command;
  size_t slave = 0;  // of Activate and Deactivate, in the order of the file
};

struct ProfibusMasterConfig {
  std::string bus;
  profibus::MasterSettings settings;
  std::vector<profibus::SlavePlan> slaves;
  std::vector<ProfibusOutput> outputs;
  std::vector<ProfibusOrder> orders;
};

// A master of FMS: which connections of which slaves it has, and what it asks when.
struct FmsMasterConfig {
  struct Link {
    uint8_t address = 0;
    const profibus::fms::Connection* connection = nullptr;
    profibus::fms::MasterEntry entry;
  };
  struct Request {
    size_t link = 0;  // in the order of the file
    Time at = 0;
    Time every = 0;  // 0: once
    profibus::fms::Request request;
  };
  std::string bus;
  profibus::MasterSettings settings;
  std::vector<Link> links;
  std::vector<Request> requests;
};

}  // namespace ipos::runtime

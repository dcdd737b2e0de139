// What a plant puts on its lines, and what is wrong with it before it is built: of SBus identifiers, closed
// numbers, load, response times, cable; of RS-485 addresses and telegrams. The plant runs for a short trial
// first, because programs fill their structures at run time.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus_plan/response_time.hpp"
#include "runtime/plant/plant.hpp"

namespace ipos::runtime {

enum class FindingKind : uint8_t {
#define FINDING(name, code, weight, meaning) name,
#include "runtime/bus_plan/findings.def"
};
enum class FindingWeight : uint8_t { Error, Hint };

struct FindingType {
  FindingKind kind;
  std::string_view code;
  FindingWeight weight;
  std::string_view meaning;
};
std::span<const FindingType> finding_types();
const FindingType& finding_type(FindingKind kind);

struct Finding {
  FindingKind kind;
  std::string line;  // name of the bus
  std::string text;
};

// Somebody sends or receives an identifier.
struct PlannedUse {
  std::string station;
  std::string what;  // "PO of address 33", "object TrCycl"
  bool transmits;
  bool movilink;  // of the profile, else a variable object
};

struct PlannedIdentifier {
  uint32_t id;
  std::vector<PlannedUse> uses;
};

enum class Rhythm : uint8_t {
  Cyclic,   // its period is set
  Answer,   // follows a cyclic telegram
  Acyclic,  // sent by a program when it likes: the period is assumed
};

struct PlannedTelegram {
  uint32_t id;
  std::string sender;
  std::string what;
  uint8_t bytes;
  Rhythm rhythm;
  Time period;
  Time wait = 0;           // before it is queued: of answers
  uint32_t request = ~0U;  // identifier of the telegram it answers
  ResponseTime response;
};

// The identifiers closed to variable objects of a station (1053 1610 p. 51-53).
struct ClosedIdentifiers {
  std::string station;
  std::vector<uint32_t> transmit;
  std::vector<uint32_t> receive;
};

struct LinePlan {
  std::string name;
  uint32_t baud = 0;
  size_t stations = 0;
  uint32_t length = 0;  // m, 0: not given
  uint32_t length_limit = 0;
  std::vector<PlannedIdentifier> identifiers;  // rising
  std::vector<ClosedIdentifiers> closed;       // stations with a program
  std::vector<PlannedTelegram> telegrams;      // rising identifier
  uint64_t load_bits = 0;                      // per second, worst case
};

struct PlannedSerialStation {
  std::string name;
  std::string socket;  // X13 or XT
  int32_t address;     // P810
  int32_t group;       // P811
};

// As the trial run showed it.
struct PlannedSerialTelegram {
  std::string sender;
  uint8_t address;
  bool response;
  std::string format;  // "PARAM + 3PD cyclic"
  uint8_t bytes;
  Time wire;  // time it takes
  uint64_t count;
  Time closest;  // kNever: seen once
};

struct SerialLinePlan {
  std::string name;
  std::string kind;  // RS-485 or RS-232
  uint32_t baud = 0;
  uint32_t length = 0;  // m, 0: not given
  uint32_t length_limit = 0;
  std::vector<PlannedSerialStation> stations;    // in the order of the file
  std::vector<PlannedSerialTelegram> telegrams;  // rising address, request before response
};

struct PlannedProfibusStation {
  std::string name;
  uint8_t address;
  uint16_t ident;  // as the master's configuration has it
  uint8_t octets;  // in each direction; 0: no master configures it
  Time watchdog;   // kNever: off
};

struct ProfibusLinePlan {
  std::string name;
  uint32_t baud = 0;
  uint32_t length = 0;  // m, 0: not given
  uint32_t length_limit = 0;
  std::vector<uint8_t> masters;
  std::vector<PlannedProfibusStation> stations;  // in the order of the file
  uint64_t cycle_bits = 0;                       // docs/reference/protocols/profibus.md
  Time cycle = 0;
};

struct BusPlan {
  std::vector<LinePlan> lines;
  std::vector<SerialLinePlan> serial_lines;
  std::vector<ProfibusLinePlan> profibus_lines;
  std::vector<Finding> findings;
  Time trial = 0;
  Time acyclic = 0;

  bool has_errors() const;
};

struct PlanOptions {
  Time trial = 100 * kMillisecond;
  Time acyclic =
      10 * kMillisecond;  // assumed distance of an acyclic telegram that the trial showed at most once
};

// Runs the plant for the trial; it must be fresh from its constructor.
BusPlan make_plan(Plant& plant, const PlanOptions& options);

}  // namespace ipos::runtime

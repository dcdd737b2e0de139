// What happens to a plant from outside, drawn from a seed: faults of its lines, hostile peers on them, power cuts, hands on
// inputs and parameters, and a host that lets time go on in bursts. All of it is data, so that a run that fails can be
// made smaller by leaving parts out.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::tests {

struct Action {
  enum class Kind : uint8_t { PowerOff, PowerOn, Send, Force, Write, Store, Look };
  Kind kind = Kind::Look;
  runtime::Time at = 0;
  size_t target = 0;    // number of a station, or of a bus
  std::string message;  // Send
  int value = 0;        // Force: level; Write, Store: value
  uint16_t index = 0;   // Write, Store; Force: the input
};

struct Trouble {
  uint64_t seed = 0;
  std::string plant;  // the plant file without faults
  std::map<std::string, std::string> programs;
  std::vector<std::string> faults;  // [[fault]] tables
  std::vector<Action> actions;          // in the order of their times
  runtime::Time end = 0;
  bool files = false;  // the stations keep their memory in files

  std::string text(const std::string& folder) const;  // of the plant file; files are in this folder
};

Trouble draw_trouble(uint64_t seed);

std::string describe(const Trouble& trouble);

}  // namespace ipos::tests

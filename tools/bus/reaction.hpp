// The worst reaction over a line: from an input of one station, by the object that it sends, to an output of another one. What the
// programs take is what compiler/analysis counts, what the line takes is what the bus plan computes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus_plan/plan.hpp"

namespace ipos::tools {

// The turns of one program's loops on the longest way from something to something else.
struct ProgramTurns {
  struct OfTask {
    int task = 0;
    uint64_t turns = 0, ms = 0;  // ms of one
  };
  bool depends = false;
  std::vector<OfTask> tasks;
  uint64_t ms = 0;      // of all
  std::string because;  // why nothing bounds them
};

struct Reaction {
  std::string line;
  std::string sender, receiver;
  uint32_t object = 0;
  // None: `because` says why nothing bounds it.
  std::optional<runtime::Time> from_input;
  std::optional<runtime::Time> from_telegram;  // from when it is due
  std::string because;
  // What it is made of.
  ProgramTurns sent, received;
  std::string line_because, cycle_because;  // why the line, or the sender's cycle, bounds nothing
  runtime::Time period = 0, response = 0;
  // By the number of a reaction whose sender is the receiver of this one: from its variables to those that go on.
  std::map<size_t, ProgramTurns> onward;
};

// Of each object that one station sends and another one receives. The plant has run the trial of its plan.
std::vector<Reaction> reactions(const runtime::Plant& plant, const runtime::BusPlan& plan);

std::string reactions_text(const std::vector<Reaction>& all);

}  // namespace ipos::tools

// The worst reaction over a line: from an input of one station, by the object that it sends, to an output of another one. What the
// programs take is what compiler/analysis counts, what the line takes is what the bus plan computes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/bus_plan/plan.hpp"

namespace ipos::tools {

struct Reaction {
  std::string line;
  std::string sender, receiver;
  uint32_t object = 0;
  // Of what each program does within one turn of its loop. None: `because` says why nothing bounds it.
  std::optional<runtime::Time> from_input;
  std::optional<runtime::Time> from_telegram;  // from when it is due
  std::string because;
  // What it is made of.
  uint64_t sender_turn = 0, receiver_turn = 0;  // ms
  int sender_task = 0, receiver_task = 0;
  runtime::Time period = 0, response = 0;
};

// Of each object that one station sends and another one receives. The plant has run the trial of its plan.
std::vector<Reaction> reactions(const runtime::Plant& plant, const runtime::BusPlan& plan);

std::string reactions_text(const std::vector<Reaction>& all);

}  // namespace ipos::tools

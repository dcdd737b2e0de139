// What `ipos run` prints when the run is over: watch windows and bus load as text, or one JSON object.
#pragma once

#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

struct WatchChoice {
  bool on = false;
  std::vector<std::string> names;  // empty: every named variable
};

// Of --watch: "" none, "*" all, else names with commas.
WatchChoice watch_choice(const std::string& flag);

// Warnings and faults to stderr, with `why` the notes, too.
void print_journal(const runtime::Plant& plant, bool why);

std::string text_report(runtime::Plant& plant, const WatchChoice& watch);

// The object of the command line contract: time_us, stations, buses.
std::string json_report(runtime::Plant& plant, const WatchChoice& watch);

// Load of a line over the whole run in percent, not rounded to whole numbers.
double load_percent(const runtime::LineLoad& load);

}  // namespace ipos::tools

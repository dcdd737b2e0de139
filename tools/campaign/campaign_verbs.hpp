// The verbs of `ipos campaign`, one file each, and what they share.
#pragma once

#include <string>

#include "tools/campaign/case_runner.hpp"
#include "tools/cli/verb.hpp"

namespace ipos::tools::campaign {

void add_plan(cli::Verb& verb);
void add_run(cli::Verb& verb);
void add_merge(cli::Verb& verb);
void add_show(cli::Verb& verb);

struct CampaignFlags {
  std::string file;
  CompileFlags compile;
};
// FILE and the options of the compiler.
void add_campaign_options(cli::Verb& verb, CampaignFlags& flags);

// "2 min 3 s".
std::string duration_text(double seconds);

// The command that runs one case of a plan again, with its name or with its values.
std::string command_of(const std::string& file, uint64_t id);
std::string command_of(const std::string& file, const Outline& outline, const Levels& levels);

// The levels of a case by the beginning of its name; a Failure without one.
Levels find_case(const Outline& outline, const std::string& name);

}  // namespace ipos::tools::campaign

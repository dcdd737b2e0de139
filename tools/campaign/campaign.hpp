// A campaign as its file says it, NAME.campaign.toml: a plant or tests, factors with their levels, measures. Plain data;
// read_campaign() makes it. docs/reference/campaign-file.md has the keys.
#pragma once

#include <string>
#include <vector>

#include "tools/campaign/measure.hpp"
#include "tools/campaign/outline.hpp"
#include "tools/input/program.hpp"
#include "tools/test_file/test_case.hpp"

namespace ipos::tools::campaign {

using runtime::FilePlace;
using runtime::Time;

// What a factor changes.
enum class Target : uint8_t {
  Parameter,
  Stimulus,  // a variable or an input, binary or analog, at 0 ms
  Key,       // of the plant file; of [station.load], too
  FaultSeed,
  FaultTime,
};

struct Setting {
  std::string toml;    // as the plant file writes it
  int64_t number = 0;  // Parameter, Stimulus: the sample; FaultSeed; FaultTime: ns
  uint8_t line = 0;    // Stimulus on an analog input
};

struct Factor {
  Target target = Target::Key;
  std::string station;
  std::string key;  // Parameter: its name; Key: "bus.sbus.baud"
  runtime::Signal signal;  // Stimulus
  std::string_view signal_key{};  // "variable", "input", "analog"
  size_t fault = 0;               // FaultSeed, FaultTime: which of the campaign
  std::vector<Setting> settings;  // one a level of its outline
  std::vector<FilePlace> places;  // of the levels
};

struct Fault {
  runtime::FaultConfig config;
  std::string toml;  // as a plant file has it, without from and until, and without a seed that is a factor
  bool has_seeds = false;
};

struct Campaign {
  std::string file;    // its path
  std::string plant;   // path; empty: tests
  std::string plant_text;
  std::vector<testing::TestCase> tests;
  Time duration = 0;   // virtual; of tests 0: until they are over
  Time limit = 0;      // of a case, on the clock
  std::vector<Factor> factors;
  std::vector<Fault> faults;
  std::vector<Measure> measures;
  Outline outline;     // a factor and a measure a row of the above
  size_t later = 0;    // [[expect]] of the plant that lie after the end of a case and are not looked at

  // How a person calls a file of the campaign: from the folder of the campaign on, so that results are the same wherever
  // it is started.
  std::string name_of(const std::string& path) const;
};

// Mistakes are printed with their places; then a Failure.
Campaign read_campaign(const std::string& path, const CompileFlags& compile);

}  // namespace ipos::tools::campaign

// What came out of a test: plain data that the reports read.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/clock/event_queue.hpp"
#include "runtime/plant_file/toml_text.hpp"

namespace ipos::tools::testing {

// One expectation that was not met, or a step that could not be carried out.
struct Finding {
  std::string file;
  runtime::FilePlace place;
  runtime::Time time = 0;
  std::string text;                 // "lPieces of belt is 2 at 2200 ms, expected 3"
  std::string note;                 // in the words of the test file
  std::vector<std::string> source;  // the lines of the test file, the failing one first
  std::vector<std::string> values;  // what the signals of the test were
  std::vector<std::string> tasks;   // where the programs stood
  std::vector<std::string> frames;  // the last ones
  std::vector<std::string> reasons;
};

enum class Outcome : uint8_t {
  Passed,
  Failed,
  Malformed,  // the test or its program has errors
  NotRun,     // another one failed before it
};

struct TestResult {
  std::string name;
  std::string file;
  runtime::FilePlace place;
  Outcome outcome = Outcome::Passed;
  uint64_t seed = 0;
  size_t checks = 0;       // expectations that were looked at
  runtime::Time time = 0;  // virtual
  double seconds = 0;      // on the wall
  std::vector<Finding> findings;
  std::string messages;  // of reader and compiler, with their places; Malformed
};

}  // namespace ipos::tools::testing

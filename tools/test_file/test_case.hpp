// A test as its file says it: a plant, and steps and expectations in the order in which they are carried out.
// Plain data; read_tests() makes it, run_test() carries it out. docs/guide/testing.md has the keys.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "runtime/plant/actions.hpp"
#include "runtime/plant/plant.hpp"

namespace ipos::tools::testing {

using runtime::FilePlace;
using runtime::Time;

// What an expectation looks at. Frames and telegrams are events, everything else has a value at every time.
struct Subject {
  enum class Kind : uint8_t { Signal, ProcessData, Message };
  Kind kind = Kind::Signal;
  runtime::Signal signal;  // Signal; of the others station and name
  std::string bus;
  std::string message;  // "frame", "telegram"
  std::string pattern;  // glob over "400#5566778811223344", "02 01 85 .." or the meaning

  bool is_event() const { return kind == Kind::Message; }
  bool is_old() const;  // a state that counts in another scale than the signal of its name
  std::string text() const;  // "lPieces of belt", "frame 400#* on sbus"
  std::string value_text(int64_t value) const;  // "7", "4.43"
  bool operator==(const Subject& other) const;
};

// Which values are right.
struct Condition {
  std::vector<std::pair<int64_t, int64_t>> ranges;  // both ends included
  bool negated = false;

  bool holds(int64_t value) const;
  std::string text(const Subject& of) const;  // "7", "5 to 9", "not 0", "one of 1, 3"
};

struct Expect {
  enum class Kind : uint8_t {
    Now,       // at its time
    Within,    // becomes so, and the test waits for it
    Always,    // at every time
    Never,     // at no time
    Count,     // becomes so `least` to `most` times
    Every,     // becomes so again and again, `period` apart
    Sequence,  // takes these values, or these frames come
  };
  Subject subject;
  Condition condition;
  Kind kind = Kind::Now;
  std::optional<Time> within;  // the test waits until it is met, so long at most
  std::optional<Time> during;  // how long it is watched; until the test ends when empty
  uint64_t least = 0;
  uint64_t most = UINT64_MAX;
  Time period = 0;
  Time tolerance = 0;
  std::vector<int64_t> values;        // Sequence of a value
  std::vector<std::string> patterns;  // Sequence of frames
  bool repeat = false;                // Sequence: from its beginning again
};

// Steps.
struct Wait {};  // how long is in Item::after, until when in Item::at
struct ProcessDataStep {
  enum class Action : uint8_t { Set, Force, Release };
  std::string station;
  std::string word;  // "PO1"
  Action action = Action::Set;
  uint16_t value = 0;
};
struct SendStep {
  std::string bus;
  std::string text;  // which its line takes
};
struct AwaitStep {
  Expect frame;
};
// Ends what an earlier fault of the line, or one of the plant file, has begun.
struct RepairStep {
  runtime::FaultConfig fault;
};
struct DriveFaultStep {
  std::string station;
  uint8_t number = 0;
};
struct ResetStep {
  std::string station;
};
struct ProgramStep {
  std::string station;
  runtime::ProgramOrder action = runtime::ProgramOrder::Start;
};
struct PowerStep {
  std::string station;
  bool on = false;
};
using Step = std::variant<Wait, runtime::Stimulus, ProcessDataStep, SendStep, AwaitStep, runtime::FaultConfig,
                          RepairStep, DriveFaultStep, ResetStep, ProgramStep, PowerStep>;

struct Item {
  FilePlace place;
  std::string note;        // what it is for, in the words of the file
  std::optional<Time> at;  // else `after` after the item before
  Time after = 0;
  bool at_end = false;    // when every program has ended
  bool in_plant = false;  // it stands in the plant file
  std::variant<Step, Expect> what;
};

// What the compiler must say about a program.
struct ExpectedDiagnostic {
  uint32_t line;
  std::string code;
  auto operator<=>(const ExpectedDiagnostic&) const = default;
};

struct TestCase {
  std::string name;  // path without its ending, with "/CASE"
  std::string file;  // as messages call it
  FilePlace place;
  std::shared_ptr<const std::vector<std::string>> lines;  // of the file
  std::vector<runtime::PlantError> errors;                // malformed: why
  std::string errors_in;                                  // the file they are in, if it is another one

  std::string plant_path;      // programs are relative to it
  bool plant_expects = false;  // the [[expect]] of the plant it names are looked at
  runtime::PlantFile plant;
  std::vector<Item> items;
  // Steps act as a hand on the page of `ipos serve` does: when everything of their millisecond has happened.
  bool by_hand = false;
  uint32_t speed = 0;                           // commands per ms of every task; 0: P938 and P939
  std::vector<ExpectedDiagnostic> diagnostics;  // of the program, if it is the test file
  bool is_program = false;
};

// "900 ms", "900.125 ms"
std::string time_text(Time time);

}  // namespace ipos::tools::testing

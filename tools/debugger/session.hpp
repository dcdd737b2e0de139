// What a debugging session is beside the plant itself: breakpoints, what the user has changed, what is under
// way. Plain data that goes as JSON to the process that takes over when time goes back.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/debugger/position.hpp"
#include "tools/debugger/values.hpp"

namespace ipos::tools::debug {

using Json = nlohmann::json;

struct TaskRef {
  uint32_t station = 0;
  int task = 0;  // 1..3; 0: none

  bool operator==(const TaskRef&) const = default;
};

struct Breakpoint {
  int id = 0;
  uint32_t station = 0;
  uint32_t address = 0;
  std::string condition;      // empty: always
  std::string hit_condition;  // ">= 5", "% 3": each third, or a number: from that one on
  std::string log;            // a logpoint: printed instead of stopping, {expressions} with their values
  bool temporary = false;
  bool enabled = true;
  uint64_t hits = 0;
};

// Stops after a change of a variable or parameter, no matter what changed it.
struct Watchpoint {
  int id = 0;
  uint32_t station = 0;
  ValuePlace place;
  std::string condition;
  bool enabled = true;
  uint64_t hits = 0;
  std::string hit_condition{};  // as of a breakpoint
};

// What the user has written, and when: done again when that moment is passed again.
struct Change {
  Position at;
  ValuePlace place;
  int32_t value = 0;
  Json action = nullptr;  // of the front end, in place of the former
};

enum class Motion : uint8_t { Continue, Into, Over, Out, Instruction, InstructionOver, ToAddress, ToTime };

struct Order {
  Motion motion = Motion::Continue;
  bool backward = false;
  TaskRef task;            // of steps
  uint32_t address = 0;    // ToAddress
  runtime::Time time = 0;  // ToTime
  // Where the task stands when the order is given.
  int context = 0;
  uint32_t depth = 0;
};

enum class Reason : uint8_t {
  Entry,
  Breakpoint,
  Data,
  Step,
  Pause,
  Fault,
  TaskEnded,
  AllEnded,
  Limit,
  Beginning
};

struct Stop {
  Reason reason = Reason::Entry;
  TaskRef task;          // who stopped; task 0: nobody in particular
  std::vector<int> ids;  // of break- and watchpoints
  std::string text;      // "speed: 3 -> 7"
};

// What the debugger is running for.
struct Goal {
  // Replay and Visit: again what has been once, up to a position or a time; Visit can be interrupted.
  enum class Kind : uint8_t { Forward, Search, Replay, Visit };
  Kind kind = Kind::Forward;
  Order order;
  Position end;        // Search: what was is looked for before this; Replay: stops here
  bool found = false;  // Search
  Position candidate;  // Search: the last place found
  Stop stop;           // Search: at the candidate; Replay and Visit: what to tell at the end
  bool repeats() const { return kind == Kind::Replay || kind == Kind::Visit; }
};

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Position, commands, time, phase)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(ValuePlace, station, elements, name)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(TaskRef, station, task)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Breakpoint, id, station, address, condition, hit_condition, log, temporary,
                                   enabled, hits)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Watchpoint, id, station, place, condition, enabled, hits, hit_condition)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Change, at, place, value, action)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Order, motion, backward, task, address, time, context, depth)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Stop, reason, task, ids, text)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Goal, kind, order, end, found, candidate, stop)

}  // namespace ipos::tools::debug

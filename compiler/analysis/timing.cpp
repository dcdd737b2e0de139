// The longest way through each function: its commands in order, each loop as one of them with as many turns as it can have. A
// function that another one calls costs there what it costs by itself.
#include "compiler/analysis/timing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "compiler/analysis/loops.hpp"

namespace ipos::compiler {
namespace {

using namespace analysis;
using vm::Opcode;

constexpr uint64_t kTooMany = uint64_t{1} << 40;  // commands that no one waits for: half a year at one a millisecond

// What comes together on a way. Commands and time are maximal each for itself, maybe on different ways.
struct Cost {
  uint64_t commands = 0;
  uint64_t time = 0;            // in commands of the task, constant waits included
  std::set<uint32_t> lines{};   // of the way with the most commands

  void add(const Cost& other) {
    commands = std::min(kTooMany, commands + other.commands);
    time = std::min(kTooMany, time + other.time);
    lines.insert(other.lines.begin(), other.lines.end());
  }
  void add_turns(const Cost& turn, uint64_t turns) {
    if (turns == 0) return;
    commands = turn.commands > kTooMany / turns ? kTooMany : std::min(kTooMany, commands + turn.commands * turns);
    time = turn.time > kTooMany / turns ? kTooMany : std::min(kTooMany, time + turn.time * turns);
    lines.insert(turn.lines.begin(), turn.lines.end());
  }
  void or_else(const Cost& other) {
    time = std::max(time, other.time);
    if (other.commands <= commands && !lines.empty()) return;
    commands = std::max(commands, other.commands);
    lines = other.lines;
  }
};

// Why there is no number, or what it counts on.
struct Reasons {
  std::string no_commands;
  std::string no_time;
  std::vector<std::string> loops;  // "the loop at line 8 goes round 10 times at most"

  void add(const Reasons& other) {
    if (no_commands.empty()) no_commands = other.no_commands;
    if (no_time.empty()) no_time = other.no_time;
    loops.insert(loops.end(), other.loops.begin(), other.loops.end());
  }
  std::string text() const {
    return !no_commands.empty() ? no_commands : !no_time.empty() ? no_time : fmt::format("{}", fmt::join(loops, "; "));
  }
};

struct Longest {
  std::optional<Cost> call;  // to its return; none where it never returns
  Reasons of_call;
  std::optional<Cost> turn;  // of its longest endless loop
  Reasons of_turn;
  std::vector<LoopTiming> loops;
};

// With a rate of commands a millisecond.
class Analysis {
 public:
  Analysis(const vm::Image& image, const Graph& graph, const Values& values, uint64_t rate)
      : image_(image), graph_(graph), values_(values), rate_(rate) {}

  const Longest& function(size_t entry) {
    const auto [found, is_new] = known_.try_emplace(entry);
    if (!is_new) {
      if (open_.contains(entry)) found->second.of_call.no_commands = fmt::format("{} calls itself", name_of(entry));
      return found->second;
    }
    open_.insert(entry);
    Longest made;
    const Ways ways = walk(graph_.function_at(entry), entry, false, made, made.of_call);
    for (const auto& [command, cost] : ways.ends) {
      if (!made.call) made.call.emplace();
      made.call->or_else(cost);
    }
    open_.erase(entry);
    Longest& kept = known_.at(entry);
    if (!kept.of_call.no_commands.empty()) made.of_call.no_commands = kept.of_call.no_commands;  // found while it was open
    kept = std::move(made);
    return kept;
  }

  std::string name_of(size_t entry) const {
    const uint32_t address = graph_.commands[entry].address;
    for (const vm::FunctionEntry& function : image_.functions)
      if (function.address == address) return function.name.substr(0, function.name.find('@'));
    return fmt::format("the code at word {}", address);
  }

  uint32_t line_of(size_t command) const { return analysis::line_of(image_, graph_.commands[command].address); }

 private:
  struct Ways {
    std::map<size_t, Cost> outside;  // by the command that they lead to, from the beginning to there
    std::map<size_t, Cost> ends;     // to a return; by the command
    std::optional<Cost> back;        // to the beginning again
  };

  std::string place(size_t command) const {
    const uint32_t line = line_of(command);
    return line == 0 ? fmt::format("word {}", graph_.commands[command].address) : fmt::format("line {}", line);
  }
  static void because(std::string& kept, std::string reason) {
    if (kept.empty()) kept = std::move(reason);
  }

  // The unit decides how long.
  bool waits_for_host(const vm::Instruction& code) const {
    switch (code.opcode) {
      case Opcode::Movlnk: return true;
      case Opcode::GoAbsH:
      case Opcode::GoAbsK:
      case Opcode::GoRelH:
      case Opcode::GoRelK: return code.operands[0] == 1;
      case Opcode::Go0: return (code.operands[0] & 1) == 0 && code.operands[0] != 8;
      default: return false;
    }
  }

  Cost cost_of(size_t number, Reasons& out) {
    const Command& command = graph_.commands[number];
    Cost cost{1, 1, {}};
    if (const uint32_t line = line_of(number); line != 0) cost.lines.insert(line);
    if (waits_for_host(command.code)) because(out.no_time, fmt::format("waits at {}", place(number)));
    if (command.code.opcode == Opcode::WaitK || command.code.opcode == Opcode::WaitH) {
      const Interval wait = command.code.opcode == Opcode::WaitK
                                ? Interval{command.code.operands[0], command.code.operands[0]}
                                : values_.at(number, static_cast<uint32_t>(command.code.operands[0]));
      if (wait.most == INT32_MAX)
        because(out.no_time, fmt::format("waits at {}", place(number)));
      else  // and what is left of the millisecond in which it begins
        cost.time += static_cast<uint64_t>(std::max<int64_t>(0, wait.most) + 1) * rate_;
    }
    if (!command.calls || command.label == kNone) return cost;
    const Longest& called = function(command.label);
    because(out.no_commands, called.of_call.no_commands);
    because(out.no_time, called.of_call.no_time);
    if (called.call) {
      cost.commands = std::min(kTooMany, cost.commands + called.call->commands);
      cost.time = std::min(kTooMany, cost.time + called.call->time);
    } else if (called.of_call.no_commands.empty() && !open_.contains(command.label)) {
      because(out.no_commands, fmt::format("{}, called at {}, never returns", name_of(command.label), place(number)));
    }
    return cost;
  }

  // From `head` through these commands; endless loops go to `function`.
  Ways walk(const std::vector<size_t>& commands, size_t head, bool is_loop, Longest& function, Reasons& out) {
    const std::set<size_t> inside(commands.begin(), commands.end());
    std::map<size_t, Cost> begins{{head, {}}};
    Ways ways;
    const auto leave = [&](size_t to, const Cost& cost) {
      if (is_loop && to == head) {
        if (!ways.back) ways.back.emplace();
        ways.back->or_else(cost);
      } else {
        (inside.contains(to) ? begins : ways.outside)[to].or_else(cost);
      }
    };
    for (const std::vector<size_t>& part : parts_in_order(graph_, commands, is_loop ? head : kNone)) {
      const size_t first = part.front();
      const std::vector<size_t> next = graph_.successors(first);
      const bool goes_round = part.size() > 1 || (std::find(next.begin(), next.end(), first) != next.end() && !(is_loop && first == head));
      if (!goes_round) {
        const auto found = begins.find(first);
        if (found == begins.end()) continue;  // nobody comes here
        Cost cost = found->second;
        cost.add(cost_of(first, out));
        if (graph_.commands[first].ends) ways.ends[first].or_else(cost);
        for (const size_t to : next) leave(to, cost);
        continue;
      }
      std::vector<size_t> doors;
      for (const size_t command : part)
        if (begins.contains(command)) doors.push_back(command);
      if (doors.empty()) continue;
      if (doors.size() > 1) because(out.no_commands, fmt::format("the loop at {} begins at several places", place(doors.front())));
      round(part, doors.front(), begins.at(doors.front()), ways, leave, function, out);
    }
    return ways;
  }

  template <class Leave>
  void round(const std::vector<size_t>& loop, size_t head, const Cost& before, Ways& ways, Leave leave, Longest& function,
             Reasons& out) {
    Reasons inside;
    const Ways once = walk(loop, head, true, function, inside);
    const Cost turn = once.back.value_or(Cost{});
    LoopTiming& told = function.loops.emplace_back();
    told.line = line_of(head);
    if (inside.no_commands.empty() && turn.commands < kTooMany) told.commands = turn.commands;
    if (once.outside.empty() && once.ends.empty()) {  // for ever
      if (!function.turn) function.turn.emplace();
      function.turn->or_else(turn);
      function.of_turn.add(inside);
      return;
    }
    out.add(inside);
    const auto turns = turns_of(graph_, values_, loop, head);
    if (turns) told.turns = turns->most + 1;
    if (!turns)
      because(out.no_commands, fmt::format("nothing tells how often the loop at {} goes round", place(head)));
    else
      out.loops.push_back(fmt::format("the loop at {} goes round {} times at most", place(head), turns->most + 1));
    const auto whole = [&](const Cost& last) {
      Cost cost = before;
      cost.add_turns(turn, turns ? turns->most : 0);
      cost.add(last);
      return cost;
    };
    for (const auto& [to, cost] : once.outside) leave(to, whole(cost));
    for (const auto& [command, cost] : once.ends) ways.ends[command].or_else(whole(cost));
  }

  const vm::Image& image_;
  const Graph& graph_;
  const Values& values_;
  uint64_t rate_;
  std::map<size_t, Longest> known_;
  std::set<size_t> open_;
};

}  // namespace

std::vector<FunctionTiming> function_timings(const vm::Image& image, uint32_t variables,
                                             const std::array<uint32_t, 3>& commands_a_ms) {
  const Graph graph(image);
  if (graph.commands.empty()) return {};
  const Values values(graph, variables);
  // A function that several tasks call has the slowest one's rate.
  std::map<size_t, uint8_t> tasks;
  std::set<size_t> interrupts;
  const auto rate = [&](uint8_t task) { return std::max<uint32_t>(1, commands_a_ms[task - 1U]); };
  for (const Root& root : graph.roots) {
    for (const size_t command : graph.reached_from(root.entry)) {
      const auto [known, is_new] = tasks.try_emplace(command, root.task);
      if (!is_new && rate(root.task) < rate(known->second)) known->second = root.task;
    }
    if (root.how == Root::How::Interrupt) interrupts.insert(root.entry);
  }
  std::map<uint8_t, Analysis> analyses;
  std::vector<FunctionTiming> all;
  for (const size_t entry : graph.entries) {
    const auto task = tasks.find(entry);
    if (task == tasks.end()) continue;  // nobody calls it
    const uint64_t a_ms = rate(task->second);
    Analysis& analysis = analyses.try_emplace(task->second, image, graph, values, a_ms).first->second;
    const Longest& longest = analysis.function(entry);
    FunctionTiming& row = all.emplace_back();
    row.name = analysis.name_of(entry);
    row.line = analysis.line_of(entry);
    row.task = task->second;
    if (longest.turn) row.kind = FunctionTiming::Kind::Turn;
    if (interrupts.contains(entry)) row.kind = FunctionTiming::Kind::Interrupt;
    const std::optional<Cost>& cost = longest.turn ? longest.turn : longest.call;
    row.loops = longest.loops;
    const Reasons& reasons = longest.turn ? longest.of_turn : longest.of_call;
    row.because = reasons.text();
    if (!cost) continue;
    row.longest.assign(cost->lines.begin(), cost->lines.end());
    if (!reasons.no_commands.empty() || cost->commands >= kTooMany) continue;
    row.commands = cost->commands;
    if (reasons.no_time.empty() && cost->time < kTooMany) row.ms = (cost->time + a_ms - 1) / a_ms;
  }
  std::stable_sort(all.begin(), all.end(), [](const FunctionTiming& a, const FunctionTiming& b) { return a.line < b.line; });
  return all;
}

}  // namespace ipos::compiler

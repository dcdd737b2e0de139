// Each step at its worst (docs/inside/cycle.md, One millisecond):
//
//   an input that changes just behind a tick is seen in the next one                                  1 ms
//   the loop has just looked at it: it ends its turn and does another one                              2 turns
//   its object was due just before: it is sampled once in a period, in the millisecond of the write   period - 1 ms
//   the frame waits for the line and passes it                                                        response
//   the receiver sees its variables in its next tick                                                  1 ms
//   its loop, as above                                                                                2 turns
//
// Turns are whole milliseconds, the first of them that of the tick itself, and an output is on its terminal one tick after the
// write; so the ticks at the ends of both ways cancel each other out.
#include "tools/bus/reaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "compiler/analysis/maps.hpp"
#include "compiler/analysis/timing.hpp"
#include "runtime/bus_plan/roster.hpp"

namespace ipos::tools {
namespace {

using runtime::kMillisecond;
using runtime::Member;
using runtime::ObjectDefinition;
using runtime::Time;

// One turn of the slowest task that works on the variables of an object.
struct Turn {
  std::optional<uint64_t> ms;
  int task = 0;  // 0: nobody works on them
  std::string because;
};

class ProgramTurns {
 public:
  explicit ProgramTurns(const runtime::Station& station)
      : station_(station),
        maps_(compiler::program_maps(*station.image(), station.config().unit->variables)),
        timings_(compiler::function_timings(*station.image(), station.config().unit->variables, station.drive().rates().commands)) {}

  Turn of(uint32_t first, uint32_t count, std::vector<compiler::Runner> compiler::VariableMap::*who) const {
    Turn worst;
    for (const compiler::VariableMap& row : maps_.variables) {
      if (row.variable + uint32_t{row.count} <= first || row.variable >= first + count) continue;
      for (const compiler::Runner& one : row.*who) add(worst, one);
    }
    if (worst.task != 0 && worst.because.empty()) worst.because = in_between();
    if (!worst.because.empty()) worst.ms.reset();
    return worst;
  }

 private:
  void add(Turn& worst, const compiler::Runner& who) const {
    const int task = who.task;
    if (task == 0) {
      worst.task = std::max(worst.task, 1);
      worst.because = fmt::format("{} of {} has no loop", who.text(), station_.config().name);
      return;
    }
    if (worst.task == 0) worst.task = task;
    if (task != 1 && task_commands(task) > 1 && worst.because.empty())
      worst.because = fmt::format("{} of {} is started or stopped at several places", who.text(), station_.config().name);
    for (const std::string& function : functions_of(task)) {
      const auto row = std::find_if(timings_.begin(), timings_.end(), [&](const auto& one) { return one.name == function; });
      if (row == timings_.end()) continue;
      if (row->kind != compiler::FunctionTiming::Kind::Turn || !row->ms) {
        if (worst.because.empty())
          worst.because = fmt::format("{} of {}: {}", who.text(), station_.config().name,
                                      row->kind == compiler::FunctionTiming::Kind::Turn || !row->because.empty()
                                          ? row->because
                                          : fmt::format("'{}' has no endless loop", function));
        continue;
      }
      if (worst.ms && *worst.ms >= *row->ms) continue;
      worst.ms = row->ms;
      worst.task = task;
    }
  }

  std::vector<std::string> functions_of(int task) const {
    if (task == 1) return {"main"};
    std::vector<std::string> names;
    for (const compiler::CallMap& call : maps_.calls)
      if (call.how == compiler::CallMap::How::Starts && call.task == task) names.push_back(call.to);
    return names;
  }

  // A task that is stopped has no turns.
  size_t task_commands(int task) const {
    const std::vector<uint32_t>& code = station_.image()->code;
    size_t count = 0;
    for (uint32_t address = 0; address < code.size();) {
      const vm::Decoded decoded = vm::decode(code, address);
      if (decoded.status != vm::DecodeStatus::Ok) break;
      count += decoded.instruction.opcode == (task == 2 ? vm::Opcode::Task2 : vm::Opcode::Task) ? 1 : 0;
      address += decoded.words;
    }
    return count;
  }

  std::string in_between() const {
    for (const compiler::CallMap& call : maps_.calls)
      if (call.how == compiler::CallMap::How::Installs)
        return fmt::format("the interrupt routine {} of {} may come in between", call.to, station_.config().name);
    return {};
  }

  const runtime::Station& station_;
  compiler::ProgramMaps maps_;
  std::vector<compiler::FunctionTiming> timings_;
};

class LineReactions {
 public:
  LineReactions(const runtime::LineRoster& roster, const runtime::LinePlan& plan) : roster_(roster), plan_(plan) {}

  void collect(std::vector<Reaction>& all) {
    for (const Member& sender : roster_.members)
      for (const Member& receiver : roster_.members)
        if (&sender != &receiver && sender.station != nullptr && receiver.station != nullptr) between(sender, receiver, all);
  }

 private:
  void between(const Member& sender, const Member& receiver, std::vector<Reaction>& all) {
    for (const ObjectDefinition& sent : objects_of(sender).definitions())
      for (const ObjectDefinition& taken : objects_of(receiver).definitions())
        if (sent.accepted && taken.accepted && sent.object == taken.object && sent.kind != runtime::ObjectKind::Receive &&
            taken.kind == runtime::ObjectKind::Receive && sent.format == taken.format)
          all.push_back(of(sender, sent, receiver, taken));
  }

  const ProgramTurns& turns_of(const Member& member) {
    auto& kept = turns_[member.station];
    if (!kept) kept.emplace(*member.station);
    return *kept;
  }

  Reaction of(const Member& sender, const ObjectDefinition& sent, const Member& receiver, const ObjectDefinition& taken) {
    Reaction out{plan_.name, sender.name, receiver.name, static_cast<uint32_t>(sent.object), {}, {}, {}, 0, 0, 0, 0, 0, 0};
    const auto because = [&](std::string reason) {
      if (out.because.empty()) out.because = std::move(reason);
    };
    const Turn from = turns_of(sender).of(sent.data, sent.format->variables(), &compiler::VariableMap::written);
    const Turn to = turns_of(receiver).of(taken.data, taken.format->variables(), &compiler::VariableMap::read);
    out.sender_task = from.task;
    out.receiver_task = to.task;
    out.sender_turn = from.ms.value_or(0);
    out.receiver_turn = to.ms.value_or(0);
    const auto telegram = std::find_if(plan_.telegrams.begin(), plan_.telegrams.end(), [&](const runtime::PlannedTelegram& one) {
      return one.id == out.object && one.sender == sender.name;
    });
    out.period = sent.cycle * kMillisecond;
    if (telegram != plan_.telegrams.end()) out.response = telegram->response.worst;
    const bool cyclic = sent.kind == runtime::ObjectKind::TransmitCyclic;
    if (!objects_of(receiver).started()) because(fmt::format("{} has not reached _SBusCommOn", receiver.name));
    if (cyclic && !objects_of(sender).started()) because(fmt::format("{} has not reached _SBusCommOn", sender.name));
    if (telegram == plan_.telegrams.end() || !telegram->response.bounded)
      because("the line cannot carry all its telegrams");
    else if (cyclic && out.response > out.period)
      because("the telegram may be overtaken by its next one");
    if (to.task == 0) because(fmt::format("nothing in {} reads what it receives", receiver.name));
    because(to.because);
    if (out.because.empty()) out.from_telegram = out.response + static_cast<Time>(2 * *to.ms + 1) * kMillisecond;
    if (!cyclic) because(fmt::format("the program of {} decides when it sends the object", sender.name));
    if (from.task == 0) because(fmt::format("nothing in {} writes what it sends", sender.name));
    because(from.because);
    if (out.because.empty())
      out.from_input = *out.from_telegram + out.period + static_cast<Time>(2 * *from.ms - 1) * kMillisecond;
    return out;
  }

  const runtime::LineRoster& roster_;
  const runtime::LinePlan& plan_;
  std::map<const runtime::Station*, std::optional<ProgramTurns>> turns_;
};

std::string time_text(Time time) {
  return fmt::format("{}.{:03} ms", time / kMillisecond, time % kMillisecond / runtime::kMicrosecond);
}

std::string turn_text(const std::string& station, int task, uint64_t ms) {
  return fmt::format("2 turns of {} ms of task {} of {}", ms, task, station);
}

}  // namespace

std::vector<Reaction> reactions(const runtime::Plant& plant, const runtime::BusPlan& plan) {
  std::vector<Reaction> all;
  for (const runtime::LineRoster& roster : runtime::line_rosters(plant))
    for (const runtime::LinePlan& line : plan.lines)
      if (line.name == roster.config->name) LineReactions(roster, line).collect(all);
  return all;
}

std::string reactions_text(const std::vector<Reaction>& all) {
  std::string text = "reactions, worst case, of what each program does within one turn of its loop\n";
  for (const Reaction& one : all) {
    text += fmt::format("  {}: input of {}, object {}, output of {}: {}", one.line, one.sender, runtime::object_words(static_cast<int32_t>(one.object)),
                        one.receiver, one.from_input ? time_text(*one.from_input) : "unbounded");
    if (!one.because.empty()) text += ": " + one.because;
    text += "\n";
    if (one.from_input)
      text += fmt::format("    {}, {} until it is due, {} on the line, {}, and the ticks between them\n",
                          turn_text(one.sender, one.sender_task, one.sender_turn), time_text(one.period), time_text(one.response),
                          turn_text(one.receiver, one.receiver_task, one.receiver_turn));
    if (one.from_telegram) text += fmt::format("    from the telegram when it is due: {}\n", time_text(*one.from_telegram));
  }
  if (all.empty()) text += "  no object of this plant has a sender and a receiver\n";
  return text + "\n";
}

}  // namespace ipos::tools

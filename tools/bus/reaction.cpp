// Each step at its worst (docs/inside/cycle.md, One millisecond):
//
//   an input that changes just behind a tick is seen in the next one                                  1 ms
//   the loop has just looked at it: it ends its turn and does another one, and as many more as the
//   value or the decision goes through from turn to turn (compiler/analysis/influence)                 2 turns or more
//   its object was due just before: it is sampled once in a period, in the millisecond of the write   period - 1 ms
//   the frame waits for the line and passes it                                                        response
//   the receiver sees its variables in its next tick                                                  1 ms
//   its loop, as above                                                                                2 turns or more
//
// Turns are whole milliseconds, the first of them that of the tick itself, and an output is on its terminal one tick after the
// write; so the ticks at the ends of both ways cancel each other out.
#include "tools/bus/reaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "compiler/analysis/influence.hpp"
#include "compiler/analysis/maps.hpp"
#include "compiler/analysis/timing.hpp"
#include "runtime/bus_plan/roster.hpp"

namespace ipos::tools {
namespace {

using compiler::analysis::Span;
using runtime::kMillisecond;
using runtime::Member;
using runtime::ObjectDefinition;
using runtime::Time;

using Users = std::vector<compiler::Runner> compiler::VariableMap::*;

// One turn of each task of a program, and how many of them what comes from outside takes.
class Program {
 public:
  explicit Program(const runtime::Station& station)
      : station_(station),
        maps_(compiler::program_maps(*station.image(), station.config().unit->variables)),
        timings_(compiler::function_timings(*station.image(), station.config().unit->variables, station.drive().rates().commands)) {
    for (int task = 1; task <= 3; ++task) time_turns(task);
    influence_.emplace(*station.image(), station.config().unit->variables, turn_ms_);
  }

  ProgramTurns into(const Span& sent) const { return told(influence_->into(sent), sent, &compiler::VariableMap::written); }
  ProgramTurns to_outputs(const Span& taken, bool together) const {
    return told(influence_->to_outputs(taken, together), taken, &compiler::VariableMap::read);
  }
  ProgramTurns between(const Span& taken, const Span& sent) const {
    return told(influence_->between(taken, sent, false), sent, &compiler::VariableMap::written);
  }

  bool has_users(const Span& span, Users who) const { return !users(span, who).empty(); }

 private:
  std::vector<compiler::Runner> users(const Span& span, Users who) const {
    std::vector<compiler::Runner> all;
    for (const compiler::VariableMap& row : maps_.variables)
      if (row.variable + int64_t{row.count} > span.first && row.variable <= span.last) all.insert(all.end(), (row.*who).begin(), (row.*who).end());
    return all;
  }

  ProgramTurns told(const compiler::InfluencePath& way, const Span& span, Users who) const {
    ProgramTurns out;
    out.depends = way.depends;
    out.ms = way.ms;
    for (int task = 1; task <= 3; ++task)
      if (const uint64_t turns = way.turns[static_cast<size_t>(task)]; turns != 0)
        out.tasks.push_back({task, turns, turn_ms_[static_cast<size_t>(task)]});
    const auto because = [&](const std::string& reason) {
      if (out.because.empty()) out.because = reason;
    };
    for (const compiler::Runner& one : users(span, who)) {
      if (one.task == 0)
        because(fmt::format("{} of {} has no loop", one.text(), station_.config().name));
      else if (!influence_->has_turn(static_cast<uint8_t>(one.task)))
        because(reasons_.at(one.task));
    }
    for (const uint8_t task : way.tasks) because(reasons_.at(task));
    if (!way.because.empty()) because(fmt::format("{}: {}", station_.config().name, way.because));
    if (way.depends) because(in_between());
    return out;
  }

  // Its longest one, or why nobody knows it.
  void time_turns(int task) {
    std::string& reason = reasons_[task];
    if (task != 1 && task_commands(task) > 1)
      reason = fmt::format("task {} of {} is started or stopped at several places", task, station_.config().name);
    for (const std::string& function : functions_of(task)) {
      const auto row = std::find_if(timings_.begin(), timings_.end(), [&](const auto& one) { return one.name == function; });
      if (row == timings_.end()) continue;
      if (row->kind == compiler::FunctionTiming::Kind::Turn && row->ms) {
        turn_ms_[static_cast<size_t>(task)] = std::max(turn_ms_[static_cast<size_t>(task)], *row->ms);
      } else if (reason.empty()) {
        reason = fmt::format("task {} of {}: {}", task, station_.config().name,
                             row->kind == compiler::FunctionTiming::Kind::Turn || !row->because.empty()
                                 ? row->because
                                 : fmt::format("'{}' has no endless loop", function));
      }
    }
    if (turn_ms_[static_cast<size_t>(task)] == 0 && reason.empty())
      reason = fmt::format("task {} of {} has no endless loop", task, station_.config().name);
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
  std::map<int, std::string> reasons_;
  std::array<uint64_t, 4> turn_ms_{};
  std::optional<compiler::Influence> influence_;
};

Span variables_of(const ObjectDefinition& definition) {
  return {definition.data, static_cast<int64_t>(definition.data) + definition.format->variables() - 1};
}

// With the variables of an object at both ends.
struct Hop {
  Reaction reaction;
  const runtime::Station *sender, *receiver;
  Span sent, taken;
};

class LineReactions {
 public:
  LineReactions(const runtime::LineRoster& roster, const runtime::LinePlan& plan, std::map<const runtime::Station*, std::optional<Program>>& programs)
      : roster_(roster), plan_(plan), programs_(programs) {}

  void collect(std::vector<Hop>& all) {
    for (const Member& sender : roster_.members)
      for (const Member& receiver : roster_.members)
        if (&sender != &receiver && sender.station != nullptr && receiver.station != nullptr) between(sender, receiver, all);
  }

 private:
  void between(const Member& sender, const Member& receiver, std::vector<Hop>& all) {
    for (const ObjectDefinition& sent : objects_of(sender).definitions())
      for (const ObjectDefinition& taken : objects_of(receiver).definitions())
        if (sent.accepted && taken.accepted && sent.object == taken.object && sent.kind != runtime::ObjectKind::Receive &&
            taken.kind == runtime::ObjectKind::Receive && sent.format == taken.format)
          all.push_back({of(sender, sent, receiver, taken), sender.station, receiver.station, variables_of(sent), variables_of(taken)});
  }

  const Program& program_of(const Member& member) {
    auto& kept = programs_[member.station];
    if (!kept) kept.emplace(*member.station);
    return *kept;
  }

  Reaction of(const Member& sender, const ObjectDefinition& sent, const Member& receiver, const ObjectDefinition& taken) {
    Reaction out;
    out.line = plan_.name;
    out.sender = sender.name;
    out.receiver = receiver.name;
    out.object = static_cast<uint32_t>(sent.object);
    const auto telegram = std::find_if(plan_.telegrams.begin(), plan_.telegrams.end(), [&](const runtime::PlannedTelegram& one) {
      return one.id == out.object && one.sender == sender.name;
    });
    out.period = sent.cycle * kMillisecond;
    if (telegram != plan_.telegrams.end()) out.response = telegram->response.worst;
    const bool cyclic = sent.kind == runtime::ObjectKind::TransmitCyclic;
    if (!objects_of(receiver).started())
      out.line_because = fmt::format("{} has not reached _SBusCommOn", receiver.name);
    else if (cyclic && !objects_of(sender).started())
      out.line_because = fmt::format("{} has not reached _SBusCommOn", sender.name);
    else if (telegram == plan_.telegrams.end() || !telegram->response.bounded)
      out.line_because = "the line cannot carry all its telegrams";
    else if (cyclic && out.response > out.period)
      out.line_because = "the telegram may be overtaken by its next one";
    if (!cyclic) out.cycle_because = fmt::format("the program of {} decides when it sends the object", sender.name);
    out.sent = program_of(sender).into(variables_of(sent));
    if (!program_of(sender).has_users(variables_of(sent), &compiler::VariableMap::written))
      out.sent.because = fmt::format("nothing in {} writes what it sends", sender.name);
    else if (!out.sent.depends && out.sent.because.empty())
      out.sent.because = fmt::format("what {} sends comes of nothing from outside", sender.name);
    const Span span = variables_of(taken);
    const bool is_read = program_of(receiver).has_users(span, &compiler::VariableMap::read);
    const auto to_outputs = [&](bool together) {
      ProgramTurns turns = program_of(receiver).to_outputs(span, together);
      if (!is_read)
        turns.because = fmt::format("nothing in {} reads what it receives", receiver.name);
      else if (!turns.depends && turns.because.empty())
        turns.because = fmt::format("what {} receives goes to no output of it", receiver.name);
      return turns;
    };
    out.received = to_outputs(false);
    const ProgramTurns at_once = to_outputs(true);  // all that the telegram has
    if (out.line_because.empty() && at_once.because.empty())
      out.from_telegram = out.response + static_cast<Time>(at_once.ms + 1) * kMillisecond;
    for (const std::string* reason : {&out.line_because, &out.received.because, &out.cycle_because, &out.sent.because})
      if (out.because.empty()) out.because = *reason;
    if (out.because.empty())
      out.from_input = out.response + out.period + static_cast<Time>(out.received.ms + out.sent.ms) * kMillisecond;
    return out;
  }

  const runtime::LineRoster& roster_;
  const runtime::LinePlan& plan_;
  std::map<const runtime::Station*, std::optional<Program>>& programs_;
};

std::string time_text(Time time) {
  return fmt::format("{}.{:03} ms", time / kMillisecond, time % kMillisecond / runtime::kMicrosecond);
}

std::string turn_text(const std::string& station, const ProgramTurns& turns) {
  std::vector<std::string> all;
  for (const ProgramTurns::OfTask& one : turns.tasks)
    all.push_back(fmt::format("{} turns of {} ms of task {} of {}", one.turns, one.ms, one.task, station));
  return fmt::format("{}", fmt::join(all, ", "));
}

}  // namespace

std::vector<Reaction> reactions(const runtime::Plant& plant, const runtime::BusPlan& plan) {
  std::map<const runtime::Station*, std::optional<Program>> programs;
  std::vector<Hop> hops;
  for (const runtime::LineRoster& roster : runtime::line_rosters(plant))
    for (const runtime::LinePlan& line : plan.lines)
      if (line.name == roster.config->name) LineReactions(roster, line, programs).collect(hops);
  for (Hop& hop : hops)
    for (size_t n = 0; n < hops.size(); ++n)
      if (hops[n].sender == hop.receiver) hop.reaction.onward[n] = programs.at(hop.receiver)->between(hop.taken, hops[n].sent);
  std::vector<Reaction> all;
  for (Hop& hop : hops) all.push_back(std::move(hop.reaction));
  return all;
}

std::string reactions_text(const std::vector<Reaction>& all) {
  std::string text = "reactions, worst case\n";
  for (const Reaction& one : all) {
    text += fmt::format("  {}: input of {}, object {}, output of {}: {}", one.line, one.sender, runtime::object_words(static_cast<int32_t>(one.object)),
                        one.receiver, one.from_input ? time_text(*one.from_input) : "unbounded");
    if (!one.because.empty()) text += ": " + one.because;
    text += "\n";
    if (one.from_input)
      text += fmt::format("    {}, {} until it is due, {} on the line, {}, and the ticks between them\n",
                          turn_text(one.sender, one.sent), time_text(one.period), time_text(one.response),
                          turn_text(one.receiver, one.received));
    if (one.from_telegram) text += fmt::format("    from the telegram when it is due: {}\n", time_text(*one.from_telegram));
  }
  if (all.empty()) text += "  no object of this plant has a sender and a receiver\n";
  return text + "\n";
}

}  // namespace ipos::tools

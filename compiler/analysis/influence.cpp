// From the places where something ends, backwards to all that they come of: by values, and by the branches that decide whether a
// command is reached. What comes of itself only within a turn is new in each turn; what comes of itself over turns has no bound.
// When something comes from outside, the turn that has just looked ends, and the next one sees it; what a turn takes of the one
// before follows one turn later; what another task keeps is to it as from outside.
// Nothing bounds it, either, where a branch that something else decides may leave the old value as it is (sample and hold), and
// where others may look between two writes of a turn.
#include "compiler/analysis/influence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "compiler/analysis/places.hpp"
#include "compiler/analysis/settling.hpp"

namespace ipos::compiler {
namespace {

using namespace analysis;

using Origin = uint64_t;  // a variable from outside with its bits, or what goes on by itself over turns
constexpr Origin kTurning = uint64_t{1} << 63;
Origin origin(const Read& read) { return uint64_t{read.variable} << 32 | read.mask; }
uint32_t variable_of(Origin one) { return static_cast<uint32_t>(one >> 32); }

struct Question {
  std::optional<Span> source;  // none: anything from outside
  bool together = false;
  std::vector<size_t> sinks;
};

enum class Passes : uint8_t { SameTurn, NextTurn, OtherTask };

struct Edge {
  size_t from;  // what was written
  Passes how;
  size_t turn;  // that takes it
  bool operator<(const Edge& other) const { return std::tie(from, how, turn) < std::tie(other.from, other.how, other.turn); }
};

struct Inputs {
  std::vector<Edge> edges;
  std::set<Origin> outside;
};

struct Length {
  uint64_t ms = 0;
  std::array<uint64_t, 4> turns{};
  bool operator<(const Length& other) const { return ms < other.ms; }
};

class Search {
 public:
  Search(const Places& places, const std::array<uint64_t, 4>& turn_ms, const Question& question)
      : places_(places), turn_ms_(turn_ms), question_(question) {
    for (size_t place = 0; place < places.all.size(); ++place) {
      first_.push_back(nodes_.size());
      for (const Write& write : places.all[place].writes) nodes_.push_back({place, write});
    }
    first_.push_back(nodes_.size());
  }

  InfluencePath run() {
    collect();
    order();
    for (size_t group = 0; group < groups_.size(); ++group) follow(group);
    InfluencePath way;
    std::optional<Length> longest;
    std::set<uint8_t> tasks;
    for (const size_t one : cone_) {
      const Node& node = nodes_[one];
      if (!node.length) continue;
      tasks.insert(turn(node).task());
      if (node.is_sink && (!longest || *longest < *node.length)) longest = node.length;
    }
    if (!longest) return way;
    way.depends = true;
    way.turns = longest->turns;
    way.ms = longest->ms;
    way.tasks.assign(tasks.begin(), tasks.end());
    for (const std::vector<size_t>& group : groups_)
      for (const size_t one : group)
        if (way.because.empty() && nodes_[one].length) way.because = trouble(nodes_[one]);
    return way;
  }

 private:
  // What one command writes at a place.
  struct Node {
    size_t place;
    Write write;
    bool seen = false;
    bool is_sink = false;
    bool is_kept = false;            // a later turn takes it, or somebody else sees it
    bool is_read_elsewhere = false;
    std::set<Edge> in{};
    std::set<Origin> outside{};      // directly
    std::set<Origin> origins{};      // all
    size_t group = kNone;
    bool turning = false;
    std::optional<Length> length{};  // from the source
  };
  // Of a place in a turn.
  struct Reach {
    std::vector<size_t> strong;
    Turn::Set unwritten, to_the_end;
  };
  // Of what is written.
  struct Goes {
    Turn::Set to;
    bool lasts;
  };

  const Turn& turn(size_t number) const { return *places_.turns[number]; }
  const Turn& turn(const Node& node) const { return turn(node.write.turn); }
  const Place& place_of(const Node& node) const { return places_.all[node.place]; }

  const Reach& reach(size_t place, size_t number) {
    const auto [found, is_new] = reaches_.try_emplace({place, number});
    if (!is_new) return found->second;
    std::vector<size_t> strong;
    for (const Write& write : places_.all[place].writes)
      if (write.turn == number && write.strong) strong.push_back(write.command);
    found->second = {strong, turn(number).before(strong), turn(number).to_the_end(strong)};
    return found->second;
  }

  const Goes& goes(size_t one) {
    const auto [found, is_new] = goes_.try_emplace(one);
    if (!is_new) return found->second;
    const Node& node = nodes_[one];
    const std::vector<size_t>& walls = reach(node.place, node.write.turn).strong;
    found->second = {turn(node).after(node.write.command, walls), turn(node).lasts(node.write.command, walls)};
    return found->second;
  }

  const Inputs& inputs(size_t number, size_t command) {
    if (const auto known = inputs_.find({number, command}); known != inputs_.end()) return known->second;
    Inputs made;
    for (const Read& read : places_.read_by(command)) {
      if (places_.comes_from_outside(read.variable) || is_source(read.variable)) made.outside.insert(origin(read));
      for (const size_t place : places_.of(read.variable, read.mask))
        for (size_t from = first_[place]; from < first_[place + 1]; ++from) {
          if (nodes_[from].write.turn != number) {
            made.edges.push_back({from, Passes::OtherTask, number});
            continue;
          }
          if (goes(from).to[command]) made.edges.push_back({from, Passes::SameTurn, number});
          if (goes(from).lasts && reach(place, number).unwritten[command]) made.edges.push_back({from, Passes::NextTurn, number});
        }
    }
    return inputs_[{number, command}] = std::move(made);
  }

  std::vector<size_t> decided_by(const Write& write) {
    std::vector<size_t> all = places_.turns[write.turn]->deciders(write.command);
    if (std::find(all.begin(), all.end(), write.command) == all.end()) all.push_back(write.command);
    return all;
  }

  bool is_source(uint32_t variable) const { return question_.source && question_.source->has(variable); }
  bool is_asked_for(Origin one) const {
    return (one & kTurning) == 0 && (!question_.source || question_.source->has(variable_of(one)));
  }
  bool is_asked_for(const std::set<Origin>& all) const {
    return std::any_of(all.begin(), all.end(), [&](Origin one) { return is_asked_for(one); });
  }
  bool is_one(Origin a, Origin b) const { return a == b || (question_.together && is_asked_for(a) && is_asked_for(b)); }

  // All that leads to the sinks.
  void collect() {
    for (const size_t place : question_.sinks)
      for (size_t one = first_[place]; one < first_[place + 1]; ++one) {
        nodes_[one].seen = nodes_[one].is_sink = nodes_[one].is_kept = true;
        cone_.push_back(one);
      }
    for (size_t n = 0; n < cone_.size(); ++n) {
      Node& node = nodes_[cone_[n]];
      const Place& place = place_of(node);
      for (const size_t command : decided_by(node.write)) {
        const Inputs& in = inputs(node.write.turn, command);
        node.outside.insert(in.outside.begin(), in.outside.end());
        for (const Edge& edge : in.edges) {
          node.in.insert(edge);
          Node& from = nodes_[edge.from];
          from.is_read_elsewhere = from.is_read_elsewhere || edge.how == Passes::OtherTask;
          from.is_kept = from.is_kept || edge.how != Passes::SameTurn;
          if (from.seen) continue;
          from.seen = true;
          cone_.push_back(edge.from);
        }
      }
      const bool by_itself = place.order == kNone && places_.goes_on_by_itself(place.variable);
      if (by_itself || std::any_of(place.writes.begin(), place.writes.end(), [&](const Write& other) { return other.turn != node.write.turn; }))
        node.in.insert({cone_[n], Passes::OtherTask, node.write.turn});
    }
  }

  // What comes of each other is a group; what a group comes of stands before it (Kosaraju).
  void order() {
    std::vector<size_t> finished;
    std::map<size_t, std::vector<size_t>> out;
    for (const size_t one : cone_)
      for (const Edge& edge : nodes_[one].in) out[edge.from].push_back(one);
    std::vector<bool> seen(nodes_.size());
    for (const size_t first : cone_) {
      if (seen[first]) continue;
      seen[first] = true;
      std::vector<std::pair<size_t, std::set<Edge>::const_iterator>> way{{first, nodes_[first].in.begin()}};
      while (!way.empty()) {
        auto& [one, next] = way.back();
        if (next == nodes_[one].in.end()) {
          finished.push_back(one);
          way.pop_back();
          continue;
        }
        const size_t from = (next++)->from;
        if (seen[from]) continue;
        seen[from] = true;
        way.emplace_back(from, nodes_[from].in.begin());
      }
    }
    for (size_t n = finished.size(); n-- > 0;) {
      if (nodes_[finished[n]].group != kNone) continue;
      std::vector<size_t> group{finished[n]};
      nodes_[finished[n]].group = groups_.size();
      for (size_t k = 0; k < group.size(); ++k)
        for (const size_t to : out[group[k]])
          if (nodes_[to].group == kNone) {
            nodes_[to].group = groups_.size();
            group.push_back(to);
          }
      groups_.push_back(std::move(group));
    }
    std::reverse(groups_.begin(), groups_.end());
    for (size_t n = 0; n < groups_.size(); ++n)
      for (const size_t one : groups_[n]) nodes_[one].group = n;
  }

  Length longer(const Length& length, size_t number, uint64_t turns) const {
    Length out = length;
    const uint8_t task = turn(number).task();
    out.turns[task] += turns;
    out.ms += turns * turn_ms_[task];
    return out;
  }

  // Origins and length of a group, those of all before it known.
  void follow(size_t number) {
    const std::vector<size_t>& group = groups_[number];
    std::set<Origin> origins;
    std::optional<Length> length;
    const auto take = [&](const Length& other) {
      if (!length || *length < other) length = other;
    };
    bool turning = false;
    for (const size_t one : group) {
      origins.insert(nodes_[one].outside.begin(), nodes_[one].outside.end());
      if (is_asked_for(nodes_[one].outside)) take(longer({}, nodes_[one].write.turn, 2));
      for (const Edge& edge : nodes_[one].in) {
        const Node& from = nodes_[edge.from];
        if (from.group == number) {
          turning = turning || edge.how != Passes::SameTurn;
          continue;
        }
        origins.insert(from.origins.begin(), from.origins.end());
        if (from.length) take(longer(*from.length, edge.turn, edge.how == Passes::SameTurn ? 0 : edge.how == Passes::NextTurn ? 1 : 2));
      }
    }
    if (turning && length) {
      if (const auto rest = until_rest(group)) {
        turning = false;
        length = rest;
      }
    }
    if (turning) origins.insert(kTurning | number);
    for (const size_t one : group) {
      nodes_[one].origins = origins;
      nodes_[one].turning = turning;
      nodes_[one].length = length;
    }
  }

  // Of a group that comes of itself over turns, in one task: from what reaches it and what it comes of in this task, until these turns
  // repeat themselves.
  std::optional<Length> until_rest(const std::vector<size_t>& group) {
    const size_t number = nodes_[group.front()].write.turn;
    std::set<size_t> seen(group.begin(), group.end());
    std::vector<size_t> open(seen.begin(), seen.end());
    std::set<uint32_t> kept;
    Length base;
    for (size_t n = 0; n < open.size(); ++n) {
      const Node& node = nodes_[open[n]];
      const Place& place = place_of(node);
      if (node.write.turn != number || place.order != kNone || places_.goes_on_by_itself(place.variable)) return std::nullopt;
      if (is_asked_for(node.outside)) base = std::max(base, longer({}, number, 2));
      for (const Edge& edge : node.in) {
        const Node& from = nodes_[edge.from];
        if (edge.how == Passes::OtherTask) {
          if (from.turning || edge.from == open[n]) return std::nullopt;
          if (from.length) base = std::max(base, longer(*from.length, number, 2));
          continue;
        }
        if (edge.how == Passes::NextTurn) kept.insert(place_of(from).variable);
        if (seen.insert(edge.from).second) open.push_back(edge.from);
      }
    }
    const auto turns = turns_until_rest(places_, turn(number), kept);
    if (!turns) return std::nullopt;
    return longer(base, number, *turns);
  }

  std::set<Origin> origins_of(size_t number, size_t command) {
    const Inputs& in = inputs(number, command);
    std::set<Origin> all = in.outside;
    for (const Edge& edge : in.edges) all.insert(nodes_[edge.from].origins.begin(), nodes_[edge.from].origins.end());
    return all;
  }

  std::string line(size_t command) const {
    const uint32_t address = places_.graph.commands[command].address;
    const uint32_t found = line_of(places_.image, address);
    return found == 0 ? fmt::format("word {}", address) : fmt::format("line {}", found);
  }

  // Why nothing bounds when the place has followed; empty: nothing of that kind.
  std::string trouble(const Node& node) {
    const Place& place = place_of(node);
    if (node.turning) {
      std::set<uint8_t> tasks;
      for (const Write& write : place.writes) tasks.insert(turn(write.turn).task());
      if (tasks.size() > 1) return fmt::format("tasks {} write {}", fmt::join(tasks, " and "), places_.name(place));
      if (place.order == kNone && places_.goes_on_by_itself(place.variable))
        return fmt::format("{}, which {} writes, goes on by itself", places_.name(place), line(node.write.command));
      return fmt::format("{} at {} comes of what it was turns before, and nothing tells of how many", places_.name(place), line(node.write.command));
    }
    if (!node.is_kept) return {};
    if (const size_t branch = holding(node); branch != kNone) {
      const std::string done = line(node.write.command), lets = line(branch);
      return fmt::format("{} acts only when {} lets it, whatever has come", done, done == lets ? "something else" : lets);
    }
    return (node.is_sink || node.is_read_elsewhere) && place.order == kNone ? seen_between(place) : std::string{};
  }

  // A branch that something else decides than what the write waits to follow, and that may leave the place as it is.
  size_t holding(const Node& node) {
    const Write& write = node.write;
    const std::vector<size_t> commands = decided_by(write);
    std::set<Origin> sources;
    for (const size_t command : commands)
      for (const Origin found : origins_of(write.turn, command))
        if (is_asked_for(found)) sources.insert(found);
    const auto is_else = [&](size_t command) {
      for (const Origin decides : origins_of(write.turn, command))
        for (const Origin waits : sources)
          if (!is_one(decides, waits)) return true;
      return false;
    };
    if (!write.strong && is_else(write.command)) return write.command;  // an index decides where it goes
    const Reach& at = reach(node.place, write.turn);
    for (const size_t branch : commands) {
      if (branch == write.command || !at.unwritten[branch]) continue;
      const std::vector<size_t>& sides = turn(node).next(branch);
      const bool may_leave = std::any_of(sides.begin(), sides.end(), [&](size_t side) { return side == kNone || at.to_the_end[side]; });
      if (may_leave && is_else(branch)) return branch;
    }
    return kNone;
  }

  std::string seen_between(const Place& place) const {
    for (const Write& write : place.writes) {
      const Turn::Set after = turn(write.turn).after(write.command, {});
      for (const Write& other : place.writes) {
        if (other.turn != write.turn || !after[other.command]) continue;
        const std::string first = line(write.command), second = line(other.command);
        if (first == second) return fmt::format("{} writes {} in several commands, and it may be seen in between", first, places_.name(place));
        return fmt::format("{} is written at {} and at {}, and may be seen in between", places_.name(place), first, second);
      }
    }
    return {};
  }

  const Places& places_;
  const std::array<uint64_t, 4>& turn_ms_;
  const Question& question_;
  std::vector<Node> nodes_;     // place by place
  std::vector<size_t> first_;   // of a place; and one behind them
  std::vector<size_t> cone_;
  std::vector<std::vector<size_t>> groups_;  // what comes first stands first
  std::map<std::pair<size_t, size_t>, Reach> reaches_;
  std::map<size_t, Goes> goes_;
  std::map<std::pair<size_t, size_t>, Inputs> inputs_;
};

}  // namespace

struct Influence::Program {
  Places places;
  std::array<uint64_t, 4> turn_ms;

  InfluencePath answer(const Question& question) const {
    InfluencePath way = Search(places, turn_ms, question).run();
    if (!places.unclear_tasks.empty())
      way.because = fmt::format("task {} has several endless loops, or one in a function or with several beginnings", places.unclear_tasks.front());
    const auto has_part = [&](uint8_t task) {
      return std::find(way.tasks.begin(), way.tasks.end(), task) != way.tasks.end() ||
             std::none_of(places.turns.begin(), places.turns.end(), [&](const auto& turn) { return turn->task() == task; });
    };
    for (const size_t command : places.task_orders)
      if (way.because.empty())
        if (const auto started = places.graph.started_by(command))
          if (has_part(started->task))
            way.because = fmt::format("task {} is started or stopped again and again at line {}", started->task,
                                      line_of(places.image, places.graph.commands[command].address));
    return way;
  }

  std::vector<size_t> places_of(const Span& span) const {
    std::vector<size_t> all;
    for (size_t n = 0; n < places.all.size(); ++n)
      if (places.all[n].order == kNone && span.has(places.all[n].variable)) all.push_back(n);
    return all;
  }
};

Influence::Influence(const vm::Image& image, uint32_t variables, const std::array<uint64_t, 4>& turn_ms)
    : program_(new Program{Places(image, variables), turn_ms}) {}
Influence::~Influence() = default;

bool Influence::has_turn(uint8_t task) const {
  return std::any_of(program_->places.turns.begin(), program_->places.turns.end(), [&](const auto& turn) { return turn->task() == task; });
}

InfluencePath Influence::into(const Span& sink) const { return program_->answer({std::nullopt, false, program_->places_of(sink)}); }

InfluencePath Influence::between(const Span& source, const Span& sink, bool together) const {
  return program_->answer({source, together, program_->places_of(sink)});
}

InfluencePath Influence::to_outputs(const Span& source, bool together) const {
  Question question{source, together, {}};
  for (size_t n = 0; n < program_->places.all.size(); ++n) {
    const Place& place = program_->places.all[n];
    if (place.order != kNone || is_system_variable(place.variable)) question.sinks.push_back(n);
  }
  return program_->answer(question);
}

}  // namespace ipos::compiler

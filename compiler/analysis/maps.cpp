// Each map is a walk over the commands; what a variable can be at one comes from the intervals of its values.
#include "compiler/analysis/maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "compiler/analysis/graph.hpp"
#include "compiler/analysis/uses.hpp"
#include "compiler/analysis/values.hpp"
#include "stdlib/language_tables.hpp"
#include "vm/isa/effects.hpp"

namespace ipos::compiler {
namespace {

using namespace analysis;
using vm::Opcode;

constexpr uint16_t kKept = 128;         // H0 to H127 are non-volatile (IPOSplus p. 320)
constexpr uint32_t kMostOfAPointer = 64;  // a store that may lead to more variables is nobody's use

class Maps {
 public:
  Maps(const vm::Image& image, uint32_t variables) : image_(image), graph_(image), values_(graph_, variables), variables_(variables) {}

  ProgramMaps make() {
    ProgramMaps maps;
    maps.calls = calls();
    maps.telegrams = telegrams();
    find_uses();
    maps.variables = variables();
    maps.states = states();
    return maps;
  }

 private:
  uint32_t line_of(size_t command) const { return analysis::line_of(image_, graph_.commands[command].address); }
  std::string function_name(size_t entry) const {
    const uint32_t address = graph_.commands[entry].address;
    for (const vm::FunctionEntry& function : image_.functions)
      if (function.address == address) return function.name.substr(0, function.name.find('@'));
    return fmt::format("word {}", address);
  }
  Runner runner(const Root& root) const {
    if (root.entry == 0) return {1};
    if (root.how == Root::How::Task) return {root.task};
    return {0, function_name(root.entry)};
  }

  std::vector<CallMap> calls() const {
    std::vector<CallMap> all;
    for (const size_t entry : graph_.entries)
      for (const size_t command : graph_.function_at(entry)) {
        const Command& code = graph_.commands[command];
        if (code.calls && code.label != kNone) add(all, {function_name(entry), function_name(code.label), line_of(command)});
        if (const auto started = graph_.started_by(command))
          add(all, {function_name(entry), function_name(started->entry), line_of(command),
                    started->how == Root::How::Task ? CallMap::How::Starts : CallMap::How::Installs, started->task});
      }
    std::stable_sort(all.begin(), all.end(), [](const CallMap& a, const CallMap& b) { return a.line < b.line; });
    return all;
  }
  static void add(std::vector<CallMap>& all, CallMap call) {
    if (std::find(all.begin(), all.end(), call) == all.end()) all.push_back(std::move(call));
  }

  std::vector<TelegramMap> telegrams() const {
    std::vector<TelegramMap> all;
    for (size_t command = 0; command < graph_.commands.size(); ++command) {
      const vm::Instruction& code = graph_.commands[command].code;
      if (code.opcode != Opcode::Scom) continue;
      constexpr const char* kKinds[] = {"", "cyclic", "acyclic", "receive"};
      constexpr const char* kTypes[] = {"", "SCTRCYCL", "SCTRACYCL", "SCREC"};
      const auto kind = static_cast<size_t>(code.operands[0]);
      if (kind == 0 || kind >= std::size(kKinds)) continue;
      TelegramMap& telegram = all.emplace_back();
      telegram.address = graph_.commands[command].address;
      telegram.line = line_of(command);
      telegram.kind = kKinds[kind];
      const stdlib::Structure& structure = *stdlib::find_structure(kTypes[kind]);
      for (uint32_t n = 0; n < structure.members.size(); ++n) {
        const Interval value = values_.at(command, static_cast<uint32_t>(code.operands[1]) + n);
        if (value.least != value.most) continue;
        const std::string_view name = structure.members[n].front();
        if (name == "ObjectNo") telegram.object = value.least;
        if (name == "CycleTime") telegram.cycle_ms = value.least;
        if (name == "Offset") telegram.offset_ms = value.least;
        if (name == "Format") telegram.format = value.least;
        if (name == "DPointer") telegram.data = value.least;
      }
    }
    return all;
  }

  // --- who reads and writes

  struct Use {
    std::vector<Runner> read, written;
  };

  void note(const std::vector<Span>& spans, const Runner& who, std::vector<Runner> Use::*list) {
    for (const Span& span : spans) {
      if (span.last - span.first >= static_cast<int64_t>(kMostOfAPointer)) continue;
      for (int64_t v = std::max<int64_t>(0, span.first); v <= span.last && v < variables_; ++v) {
        std::vector<Runner>& all = uses_[static_cast<uint32_t>(v)].*list;
        if (std::find(all.begin(), all.end(), who) == all.end()) all.push_back(who);
      }
    }
  }

  void find_uses() {
    for (const Root& root : graph_.roots)
      for (const size_t command : graph_.reached_from(root.entry)) {
        note(read_by(graph_, values_, command), runner(root), &Use::read);
        note(values_.written_by(command), runner(root), &Use::written);
      }
  }

  std::vector<VariableMap> variables() const {
    std::vector<VariableMap> all;
    std::set<uint32_t> named;
    const auto merge = [](std::vector<Runner>& to, const std::vector<Runner>& from) {
      for (const Runner& one : from)
        if (std::find(to.begin(), to.end(), one) == to.end()) to.push_back(one);
    };
    for (const vm::Symbol& symbol : image_.symbols) {
      VariableMap& row = all.emplace_back(VariableMap{symbol.name, symbol.variable, symbol.count, symbol.variable < kKept, {}, {}});
      for (uint32_t v = symbol.variable; v < static_cast<uint32_t>(symbol.variable) + symbol.count; ++v) {
        named.insert(v);
        if (const auto use = uses_.find(v); use != uses_.end()) {
          merge(row.read, use->second.read);
          merge(row.written, use->second.written);
        }
      }
    }
    for (const auto& [variable, use] : uses_)
      if (!named.contains(variable))
        all.push_back({"", static_cast<uint16_t>(variable), 1, variable < kKept, use.read, use.written});
    std::stable_sort(all.begin(), all.end(), [](const VariableMap& a, const VariableMap& b) { return a.variable < b.variable; });
    return all;
  }

  // --- states

  // The numbers that are the only ones left behind a comparison with a constant.
  std::vector<int64_t> singled_out(size_t command) const {
    const vm::Instruction& code = graph_.commands[command].code;
    const bool equal = code.opcode == Opcode::JmpEqHK || code.opcode == Opcode::JmpNeHK;
    if (!equal && code.opcode != Opcode::JmpLtHK && code.opcode != Opcode::JmpGeHK) return {};
    const Interval before = values_.at(command, static_cast<uint32_t>(code.operands[0]));
    const int64_t limit = code.operands[1];
    std::vector<int64_t> numbers;
    if (before.least == limit - 1 && before.most >= limit && (!equal || before.most == limit)) numbers.push_back(before.least);
    if (before.most == limit + (equal ? 1 : 0) && before.least <= limit && (!equal || before.least == limit)) numbers.push_back(before.most);
    return numbers;
  }

  // A variable is a state where the code compares it, or what was copied of it just before, with two numbers or more for
  // equality, and gives it numbers.
  std::vector<StateMap> states() const {
    std::map<uint32_t, std::set<int64_t>> compared, left_over;
    std::map<uint32_t, uint32_t> copies;  // of the commands before this one, in their order
    for (size_t n = 0; n < graph_.commands.size(); ++n) {
      const vm::Instruction& code = graph_.commands[n].code;
      const auto first = static_cast<uint32_t>(code.operands[0]);
      if (code.opcode == Opcode::SetHH) copies[first] = static_cast<uint32_t>(code.operands[1]);
      const auto copy = copies.find(first);
      const auto add = [&](std::map<uint32_t, std::set<int64_t>>& to, int64_t number) {
        to[first].insert(number);
        if (copy != copies.end()) to[copy->second].insert(number);
      };
      if (code.opcode == Opcode::JmpEqHK || code.opcode == Opcode::JmpNeHK) add(compared, code.operands[1]);
      for (const int64_t number : singled_out(n)) add(left_over, number);
    }
    // A switch of many cases asks for halves of them; the last number of a range is then what is left over.
    for (auto& [variable, numbers] : compared)
      if (numbers.size() > 1) numbers.merge(left_over[variable]);
    std::vector<StateMap> all;
    for (const auto& [variable, numbers] : compared) {
      if (numbers.size() < 2) continue;
      StateMap map{variable_name(image_, variable), static_cast<uint16_t>(variable), {numbers.begin(), numbers.end()}, {}};
      for (size_t n = 0; n < graph_.commands.size(); ++n) {
        const vm::Instruction& code = graph_.commands[n].code;
        if (code.opcode != Opcode::SetHK || static_cast<uint32_t>(code.operands[0]) != variable) continue;
        const Interval from = values_.at(n, variable);
        if (from.is_empty()) continue;
        StateMap::Way way{from.least == from.most ? std::optional(from.least) : std::nullopt, code.operands[1], line_of(n)};
        if (std::find(map.ways.begin(), map.ways.end(), way) == map.ways.end()) map.ways.push_back(way);
        if (std::find(map.states.begin(), map.states.end(), way.to) == map.states.end()) map.states.push_back(way.to);
      }
      std::sort(map.states.begin(), map.states.end());
      if (!map.ways.empty()) all.push_back(std::move(map));
    }
    return all;
  }

  const vm::Image& image_;
  Graph graph_;
  Values values_;
  uint32_t variables_;
  std::map<uint32_t, Use> uses_;
};

}  // namespace

std::string Runner::text() const { return task == 0 ? fmt::format("interrupt {}", routine) : fmt::format("task {}", task); }

std::string CallMap::text() const {
  switch (how) {
    case How::Starts: return fmt::format("starts as task {}", task);
    case How::Installs: return "installs as an interrupt";
    case How::Calls: break;
  }
  return "calls";
}

ProgramMaps program_maps(const vm::Image& image, uint32_t variables) {
  if (image.code.empty()) return {};
  return Maps(image, variables).make();
}

}  // namespace ipos::compiler

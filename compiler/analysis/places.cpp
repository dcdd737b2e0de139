// Each command of the loops is looked at once. Commands that set, clear or copy single bits write these alone.
#include "compiler/analysis/places.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <optional>
#include <set>

#include "compiler/analysis/uses.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::compiler::analysis {
namespace {

using vm::Opcode;

constexpr int kFewBits = 4;  // of a constant that sets or clears bits in a variable that is kept; more are arithmetic

// The bits that a command writes without a look at the others.
std::optional<uint32_t> single_bits(const vm::Instruction& code) {
  switch (code.opcode) {
    case Opcode::BitSet:
    case Opcode::BitClear:
    case Opcode::BitMove:
    case Opcode::BitMoveNeg: return uint32_t{1} << (code.operands[1] & 31);
    case Opcode::OrHK:
      if (std::popcount(static_cast<uint32_t>(code.operands[1])) <= kFewBits) return static_cast<uint32_t>(code.operands[1]);
      return std::nullopt;
    case Opcode::AndHK:
      if (std::popcount(~static_cast<uint32_t>(code.operands[1])) <= kFewBits) return ~static_cast<uint32_t>(code.operands[1]);
      return std::nullopt;
    default: return std::nullopt;
  }
}

// Of what is copied, the bits that the next commands leave: SET t = v, SHR t >> k, AND t & m.
uint32_t bits_taken(const Graph& graph, size_t number) {
  const uint32_t to = static_cast<uint32_t>(graph.commands[number].code.operands[0]);
  int shift = 0;
  for (size_t next = graph.commands[number].next; next != kNone; next = graph.commands[next].next) {
    const vm::Instruction& code = graph.commands[next].code;
    if (static_cast<uint32_t>(code.operands[0]) != to) break;
    if (code.opcode == Opcode::AndHK) return static_cast<uint32_t>(code.operands[1]) << shift;
    if ((code.opcode != Opcode::ShrHK && code.opcode != Opcode::AshrHK) || shift != 0) break;
    shift = code.operands[1] & 31;
  }
  return UINT32_MAX;
}

bool is_order(Opcode opcode) {
  switch (opcode) {
    case Opcode::GoAbsH:
    case Opcode::GoAbsK:
    case Opcode::GoRelH:
    case Opcode::GoRelK:
    case Opcode::Go0:
    case Opcode::AxisStop:
    case Opcode::SetSys:
    case Opcode::SetFault:
    case Opcode::Reset:
    case Opcode::Movlnk: return true;
    default: return false;
  }
}

const stdlib::SystemVariable* system_row(uint32_t variable) {
  return is_system_variable(variable) ? stdlib::find_system_variable(static_cast<uint16_t>(variable)) : nullptr;
}

// The unit changes it by itself.
bool unit_writes(uint32_t variable) {
  const stdlib::SystemVariable* row = system_row(variable);
  return row != nullptr && row->use != stdlib::VariableUse::Follows && row->use != stdlib::VariableUse::Nothing;
}

}  // namespace

Places::Places(const vm::Image& of_image, uint32_t variables) : image(of_image), graph(of_image), values(graph, variables), variables_(variables) {
  for (size_t n = 0; n < graph.roots.size(); ++n) {
    const Root& root = graph.roots[n];
    for (const size_t command : graph.reached_from(root.entry))
      for (const Span& span : values.written_by(command))
        for (int64_t v = std::max<int64_t>(0, span.first); v <= span.last && v < variables; ++v) {
          std::vector<size_t>& writers = roots_[static_cast<uint32_t>(v)];
          if (writers.empty() || writers.back() != n) writers.push_back(n);
        }
    if (root.how != Root::How::Task) continue;
    auto turn = std::make_unique<Turn>(graph, root);
    if (turn->is_unclear()) unclear_tasks.push_back(root.task);
    if (turn->is_found()) turns.push_back(std::move(turn));
  }
  collect_writes();
}

void Places::collect_writes() {
  struct Found {
    Span span;
    std::optional<uint32_t> bits;
    Write write;
  };
  std::vector<Found> found;
  std::map<uint32_t, uint32_t> bits;  // of each variable that are written by themselves
  for (size_t turn = 0; turn < turns.size(); ++turn)
    for (const size_t command : turns[turn]->commands()) {
      const vm::Instruction& code = graph.commands[command].code;
      if (code.opcode == Opcode::Task || code.opcode == Opcode::Task2) task_orders.push_back(command);
      if (is_order(code.opcode)) all.push_back({0, -1, command, {{turn, command, true}}});
      const std::optional<uint32_t> single = single_bits(code);
      for (Span span : values.written_by(command)) {
        span = {std::max<int64_t>(0, span.first), std::min<int64_t>(variables_ - 1, span.last)};
        if (span.first > span.last) continue;
        if (single) bits[static_cast<uint32_t>(span.first)] |= *single;
        const bool strong = code.opcode != Opcode::SetiStore || span.first == span.last;
        found.push_back({span, single, {turn, command, strong}});
      }
    }
  const auto place = [&](uint32_t variable, int bit) -> Place& {
    for (const size_t one : by_variable_[variable])
      if (all[one].bit == bit) return all[one];
    by_variable_[variable].push_back(all.size());
    return all.emplace_back(Place{variable, bit, kNone, {}});
  };
  const auto add = [](Place& to, const Write& write) {
    for (Write& known : to.writes)
      if (known.turn == write.turn && known.command == write.command) {
        known.strong = known.strong && write.strong;
        return;
      }
    to.writes.push_back(write);
  };
  for (const Found& one : found)
    for (int64_t v = one.span.first; v <= one.span.last; ++v) {
      const auto variable = static_cast<uint32_t>(v);
      if (!one.bits) add(place(variable, -1), one.write);
      const auto by_bits = bits.find(variable);
      if (by_bits == bits.end()) continue;
      for (int bit = 0; bit < 32; ++bit)
        if ((one.bits ? *one.bits : by_bits->second) >> bit & 1U) add(place(variable, bit), one.write);
    }
}

std::vector<size_t> Places::of(uint32_t variable, uint32_t mask) const {
  std::vector<size_t> found;
  if (const auto places = by_variable_.find(variable); places != by_variable_.end())
    for (const size_t one : places->second)
      if (all[one].bit < 0 || (mask >> all[one].bit & 1U) != 0) found.push_back(one);
  return found;
}

std::vector<Read> Places::read_by(size_t number) const {
  const vm::Instruction& code = graph.commands[number].code;
  std::set<Read> reads;
  const vm::Flow flow = vm::coding(code.opcode).flow;
  if (flow == vm::Flow::SystemCall || (flow == vm::Flow::System && !values.written_by(number).empty()))
    reads.insert({kAnswers + static_cast<uint32_t>(number)});
  if (code.opcode == Opcode::BitMove || code.opcode == Opcode::BitMoveNeg) {
    reads.insert({static_cast<uint32_t>(code.operands[2]), uint32_t{1} << (code.operands[3] & 31)});
  } else if (!single_bits(code)) {
    const uint32_t mask = code.opcode == Opcode::SetHH ? bits_taken(graph, number) : UINT32_MAX;
    for (const Span& span : analysis::read_by(graph, values, number))
      for (int64_t v = std::max<int64_t>(0, span.first); v <= span.last && v < variables_; ++v)
        reads.insert({static_cast<uint32_t>(v), mask});
  }
  return {reads.begin(), reads.end()};
}

bool Places::is_shared_with_the_unit(uint32_t variable) const {
  if (const auto roots = roots_.find(variable); roots != roots_.end() && roots->second.size() > 1) return false;
  return std::any_of(turns.begin(), turns.end(), [&](const auto& turn) {
    if (!values.is_shared(turn->head(), variable)) return false;
    const auto roots = roots_.find(variable);
    return roots == roots_.end() || graph.roots[roots->second.front()].task == turn->task();
  });
}

bool Places::comes_from_outside(uint32_t variable) const {
  if (variable >= kAnswers || unit_writes(variable)) return true;
  const bool is_written = by_variable_.contains(variable);
  if (is_system_variable(variable)) return !is_written;
  return !roots_.contains(variable) || is_shared_with_the_unit(variable);
}

bool Places::goes_on_by_itself(uint32_t variable) const {
  if (!by_variable_.contains(variable)) return false;
  return is_system_variable(variable) ? unit_writes(variable) : is_shared_with_the_unit(variable);
}

std::string Places::name(const Place& place) const {
  if (place.order != kNone) return "the order";
  const std::string variable = variable_name(image, place.variable);
  return place.bit < 0 ? variable : fmt::format("bit {} of {}", place.bit, variable);
}

}  // namespace ipos::compiler::analysis

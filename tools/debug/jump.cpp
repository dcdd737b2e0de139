// Which commands begin statements, and what the code behind them needs of the code before them.
#include "tools/debug/jump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "compiler/analysis/graph.hpp"
#include "tools/debug/statements.hpp"
#include "tools/input/sources.hpp"
#include "vm/isa/effects.hpp"

namespace ipos::tools::debug {
namespace {

namespace analysis = compiler::analysis;

// Whether a program calls the variable by a name or, in a text of it, by its number: all others are the compiler's own.
bool is_named(const vm::Image& image, uint32_t variable) {
  if (variable >= vm::kFirstSystemVariable && variable <= vm::kLastSystemVariable) return true;
  for (const vm::Symbol& symbol : image.symbols)
    if (variable >= symbol.variable && variable < uint32_t{symbol.variable} + symbol.count) return true;
  const std::string number = fmt::format("H{}", variable);
  for (const std::string& file : image.files) {
    const std::string text = source_text(file).value_or("");
    for (size_t at = text.find(number); at != std::string::npos; at = text.find(number, at + 1))
      if (at + number.size() >= text.size() || std::isdigit(static_cast<unsigned char>(text[at + number.size()])) == 0) return true;
  }
  return false;
}

// SET and its like read what stands behind the first operand; all other commands that write it also read it.
bool reads_target(const vm::Instruction& code) {
  switch (code.opcode) {
    case vm::Opcode::SetHH:
    case vm::Opcode::SetHK:
    case vm::Opcode::SetiLoad:
    case vm::Opcode::NotH:
    case vm::Opcode::Copy: return false;
    default: return true;
  }
}

// A variable of the compiler that the code from there on reads before it writes it.
std::optional<uint32_t> needed_at(const vm::Image& image, uint32_t address) {
  const analysis::Graph graph(image);
  const auto begin = std::find_if(graph.commands.begin(), graph.commands.end(),
                                  [address](const analysis::Command& command) { return command.address == address; });
  if (begin == graph.commands.end()) return std::nullopt;
  std::map<uint32_t, bool> named;
  const auto own = [&](uint32_t variable) {
    const auto [entry, is_new] = named.try_emplace(variable, false);
    if (is_new) entry->second = is_named(image, variable);
    return !entry->second;
  };
  // Of each command the variables that are written on every way to it so far.
  std::map<size_t, std::set<uint32_t>> written;
  std::vector<size_t> next{static_cast<size_t>(begin - graph.commands.begin())};
  written[next.front()] = {};
  while (!next.empty()) {
    const size_t number = next.back();
    next.pop_back();
    std::set<uint32_t> known = written[number];
    const vm::Instruction& code = graph.commands[number].code;
    const vm::VariableRange target = vm::named_target(code);
    std::optional<uint32_t> needed;
    bool is_target = target.count != 0 && !reads_target(code);  // the first one is
    vm::each_named(code, [&](vm::VariableRange range) {
      if (std::exchange(is_target, false)) return;
      for (uint32_t variable = range.first; variable < range.end(); ++variable)
        if (!known.contains(variable) && own(variable)) needed = variable;
    });
    if (needed) return needed;
    for (uint32_t variable = target.first; variable < target.end(); ++variable) known.insert(variable);
    for (const size_t to : graph.successors(number)) {
      const auto [entry, is_new] = written.try_emplace(to, known);
      std::set<uint32_t> both;
      std::set_intersection(entry->second.begin(), entry->second.end(), known.begin(), known.end(), std::inserter(both, both.end()));
      if (!is_new && both == entry->second) continue;
      entry->second = std::move(both);
      next.push_back(to);
    }
  }
  return std::nullopt;
}

std::string where(const CodeMap& code, uint32_t address) {
  const SourcePlace place = code.place(address);
  return place.line == 0 ? fmt::format("word {}", address) : place.text();
}

// Why no statement begins at the command; empty: one does. Assembler text has no lines: each command is one.
std::string why_no_statement(const CodeMap& code, uint32_t address) {
  if (!code.is_command(address)) return fmt::format("no command begins at word {}", address);
  const SourcePlace place = code.place(address);
  if (place.line == 0) return "";
  const auto text = source_text(place.file);
  if (!text) return fmt::format("the text of {} is not at hand, so nobody knows where its statements begin", place.file);
  const std::vector<bool> begins = statement_lines(*text);
  if (place.line >= begins.size() || !begins[place.line])
    return fmt::format("{} goes on with the statement of a line before", place.text());
  for (const compiler::CodeItem& item : code.items()) {
    if (item.address >= address) break;
    const SourcePlace other = code.place(item.address);
    if (other.line == place.line && other.file == place.file && code.function(item.address) == code.function(address))
      return fmt::format("word {} is in the middle of what {} does", address, place.text());
  }
  return "";
}

}  // namespace

std::vector<uint32_t> statements_at(const Debugger& debugger, uint32_t station, const std::string& file, uint32_t line) {
  std::vector<uint32_t> all;
  const CodeMap* code = debugger.code(station);
  if (code == nullptr || !code->has_file(file)) return all;
  const auto first = code->address_of(file, line);
  if (!first || code->place(*first).line != line) return all;
  const std::string known = code->place(*first).file;
  for (const compiler::CodeItem& item : code->items()) {
    const SourcePlace place = code->place(item.address);
    if (place.line == line && place.file == known && why_no_statement(*code, item.address).empty()) all.push_back(item.address);
  }
  return all;
}

void jump(Debugger& debugger, TaskRef task, uint32_t address) {
  const CodeMap* code = debugger.code(task.station);
  if (task.task == 0 || code == nullptr) throw ValueError("no task runs");
  const std::vector<Frame> frames = debugger.frames(task);
  if (const std::string why = why_no_statement(*code, address); !why.empty()) throw ValueError(why);
  if (!frames.empty() && code->function(frames.front().address) != code->function(address))
    throw ValueError(fmt::format("{} is in {}, and {} stands in {}: a jump leaves no function", where(*code, address),
                                 code->function(address), debugger.task_name(task), code->function(frames.front().address)));
  const vm::Image& image = *debugger.plant().stations()[task.station]->image();
  if (!image.lines.empty())
    if (const auto needed = needed_at(image, address))
      throw ValueError(fmt::format("{} goes on with H{}, which the code before it computes", where(*code, address), *needed));
  debugger.go_on_at(task, address);
}

}  // namespace ipos::tools::debug

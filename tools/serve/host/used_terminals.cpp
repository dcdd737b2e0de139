// A terminal with a function is used. So is one without that is named in the plant file, or in the program's own source:
// programs read InputLevel (H483) and write OutputLevel (H480) of terminals whatever their function.
#include "tools/serve/host/used_terminals.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "runtime/drive/terminals.hpp"
#include "runtime/plant_file/signal.hpp"

namespace ipos::tools::serve {

UsedTerminals::UsedTerminals(const runtime::PlantFile& file, const runtime::StationConfig& station, std::string program)
    : file_(file), station_(station), program_(std::move(program)) {}

bool UsedTerminals::has(const runtime::BinaryTerminal& terminal, int32_t function) const {
  return terminal.parameter.empty() || function != static_cast<int32_t>(runtime::InputFunction::None) ||
         is_in_file(terminal.name) || is_in_program(terminal.name);
}

bool UsedTerminals::is_named(const runtime::Signal& signal, std::string_view terminal) const {
  return signal.station == station_.name && signal.name == terminal;
}

bool UsedTerminals::is_in_file(std::string_view terminal) const {
  const auto any = [](const auto& rows, auto names) { return std::any_of(rows.begin(), rows.end(), names); };
  return any(station_.inputs, [&](const auto& row) { return runtime::input_name(row.input) == terminal; }) ||
         any(file_.wires, [&](const auto& row) { return is_named(row.from, terminal) || is_named(row.to, terminal); }) ||
         any(file_.switches, [&](const auto& row) { return is_named(row.input, terminal); }) ||
         any(file_.barriers, [&](const auto& row) { return is_named(row.input, terminal); }) ||
         any(file_.stimuli, [&](const auto& row) { return is_named(row.signal, terminal); }) ||
         any(file_.expectations, [&](const auto& row) { return is_named(row.signal, terminal); });
}

// As a word of its own.
bool UsedTerminals::is_in_program(std::string_view terminal) const {
  const auto is_part = [&](size_t at) {
    return at < program_.size() && (std::isalnum(static_cast<unsigned char>(program_[at])) != 0 || program_[at] == '_');
  };
  for (size_t at = program_.find(terminal); at != std::string::npos; at = program_.find(terminal, at + 1))
    if ((at == 0 || !is_part(at - 1)) && !is_part(at + terminal.size())) return true;
  return false;
}

}  // namespace ipos::tools::serve

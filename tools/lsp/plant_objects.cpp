// A plant is built of its programs as the editor shows them, without a run.
#include "tools/lsp/plant_objects.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <tuple>

#include "runtime/plant/plant.hpp"
#include "runtime/plant_file/toml_kind.hpp"
#include "runtime/unit/program_image.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/lsp/features.hpp"
#include "tools/lsp/toml_lines.hpp"

namespace ipos::tools::lsp {
namespace {

constexpr int kWarning = 2;

std::string row_of(std::string_view text, uint32_t line) {
  const auto rows = lines_of(text);
  return line == 0 || line > rows.size() ? std::string() : std::string(trimmed(rows[line - 1]));
}

// The line with that text, the nearest one; 0: there is none any more.
uint32_t line_of_row(std::string_view text, const std::string& row, uint32_t before) {
  const auto rows = lines_of(text);
  uint32_t nearest = 0;
  const auto far = [before](uint32_t line) { return line > before ? line - before : before - line; };
  for (uint32_t n = 0; n < rows.size(); ++n)
    if (trimmed(rows[n]) == row && (nearest == 0 || far(n + 1) < far(nearest))) nearest = n + 1;
  return nearest;
}

}  // namespace

std::map<std::string, Json> PlantObjects::diagnostics(Workspace& workspace) {
  if (std::exchange(outdated_, false)) look(workspace);
  std::map<std::string, Json> all;
  for (const Found& one : found_) {
    const auto text = workspace.text(one.path);
    const uint32_t line = text ? line_of_row(*text, one.row, one.line) : 0;
    if (line == 0) continue;
    const std::string_view row = lines_of(*text)[line - 1];
    const size_t begin = std::min<size_t>(one.column == 0 ? 0 : one.column - 1, row.size());
    size_t end = begin;
    while (end < row.size() && is_word(row[end])) ++end;
    const auto start = static_cast<uint32_t>(row.data() - text->data());
    Json& target = all.try_emplace(one.path, Json::array()).first->second;
    target.push_back({{"range", range_of(*text, start + static_cast<uint32_t>(begin), start + static_cast<uint32_t>(end), workspace.encoding)},
                      {"severity", kWarning},
                      {"code", one.code},
                      {"source", "ipos"},
                      {"message", one.text},
                      {"relatedInformation",
                       Json::array({Json{{"location", {{"uri", uri_of(one.plant)}, {"range", range_of("", 0, 0, workspace.encoding)}}},
                                         {"message", "in this plant"}}})}});
  }
  return all;
}

void PlantObjects::look(Workspace& workspace) {
  found_.clear();
  const std::vector<std::string> open = workspace.open_documents();
  if (open.empty()) return;
  for (const std::string& plant : workspace.plants()) look_at(workspace, plant);
  // A program may be in several plants.
  std::stable_sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.key() < b.key(); });
  found_.erase(std::unique(found_.begin(), found_.end(), [](const Found& a, const Found& b) { return a.key() == b.key(); }), found_.end());
}

// Where anything of it is wrong other messages say so.
void PlantObjects::look_at(Workspace& workspace, const std::string& plant) {
  if (runtime::named_test(plant)) return;
  const auto text = workspace.text(plant);
  if (!text) return;
  runtime::PlantFileResult read = runtime::read_plant_file(*text, plant);
  if (!read.errors.empty()) return;
  bool open = workspace.is_open(plant);
  for (const runtime::StationConfig& station : read.plant.stations)
    open = open || (!station.program.empty() && workspace.is_open(tidy(beside(plant, station.program))));
  if (!open) return;
  std::vector<std::optional<vm::Image>> images;
  for (runtime::StationConfig& station : read.plant.stations) {
    station.nvram.clear();
    images.emplace_back();
    if (station.program.empty()) continue;
    images.back() = workspace.image(tidy(beside(plant, station.program)), station.unit);
    if (!images.back()) return;
    const stdlib::UnitType* unit = stdlib::find_unit(images.back()->unit);
    if (unit == nullptr || unit->tasks == 0 || (station.unit != nullptr && station.unit != unit)) return;
    station.unit = unit;
  }
  read.plant.expectations.clear();
  read.plant.stimuli.clear();
  read.plant.machines.clear();
  std::vector<runtime::PlantError> errors;
  const runtime::Plant made(std::move(read.plant), std::move(images), std::nullopt, errors);
  if (!errors.empty()) return;
  for (const ObjectFinding& one : object_findings(made)) {
    Found found{one.place.file.empty() ? plant : tidy(one.place.file), std::max(one.place.line, 1U), one.place.column, "", one.place.text,
                one.place.code, plant};
    found.row = row_of(workspace.text(found.path).value_or(""), found.line);
    found_.push_back(std::move(found));
  }
}

}  // namespace ipos::tools::lsp

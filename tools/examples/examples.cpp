// Folders of the embedded files, and what their plants say of themselves.
#include "tools/examples/examples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/plant_file/plant_file.hpp"
#include "stdlib/embedded.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/head_story.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools {

namespace new_project {
std::span<const stdlib::EmbeddedFile> embedded_files();
}
namespace example_files {
std::span<const stdlib::EmbeddedFile> embedded_files();
}

namespace {

namespace fs = std::filesystem;

constexpr size_t kStory = 2;  // sentences

// Files of the template that lie elsewhere in a project.
constexpr std::pair<std::string_view, std::string_view> kPlaces[] = {
    {"github.yml", ".github/workflows/ipos.yml"},
    {"gitlab.yml", ".gitlab-ci.yml"},
};

std::string kind_of(const runtime::PlantFile& plant) {
  std::map<std::string, int> units;
  for (const runtime::StationConfig& station : plant.stations)
    ++units[station.unit == nullptr ? "drive" : std::string(station.unit->name)];
  std::vector<std::string> parts;
  for (const auto& [unit, count] : units) parts.push_back(fmt::format("{} × {}", count, unit));
  std::string text = fmt::format("{}", fmt::join(parts, ", "));
  std::vector<std::string> lines;
  for (const runtime::BusConfig& bus : plant.buses)
    if (const std::string word(runtime::info(bus.kind).word); std::find(lines.begin(), lines.end(), word) == lines.end())
      lines.push_back(word);
  return lines.empty() ? text : fmt::format("{} on {}", text, fmt::join(lines, ", "));
}

std::vector<Example> read_all() {
  std::vector<Example> all;
  for (const stdlib::EmbeddedFile& file : example_files::embedded_files()) {
    const size_t slash = file.name.find('/');
    const std::string folder(file.name.substr(0, slash));
    const std::string name(file.name.substr(slash + 1));
    if (all.empty() || all.back().name != folder) all.push_back({folder, "", "", "", {}});
    all.back().files[name] = file.text;
    if (!name.ends_with(".toml") || name.ends_with(".test.toml") || name.ends_with(".campaign.toml")) continue;
    all.back().plant = name;
    all.back().story = head_story(file.text, kStory);
    all.back().kind = kind_of(runtime::read_plant_file(std::string(file.text)).plant);
  }
  return all;
}

}  // namespace

const std::vector<Example>& all_examples() {
  static const std::vector<Example> all = read_all();
  return all;
}

const Example* find_example(std::string_view name) {
  for (const Example& example : all_examples())
    if (example.name == name) return &example;
  return nullptr;
}

NewFiles template_files() {
  NewFiles files;
  for (const stdlib::EmbeddedFile& file : new_project::embedded_files()) {
    std::string path(file.name);
    for (const auto& [name, place] : kPlaces)
      if (path == name) path = place;
    files[path] = file.text;
  }
  return files;
}

void write_new_files(const std::string& name, const NewFiles& files) {
  const fs::path folder = name;
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)) && !fs::is_directory(folder, error))
    throw Failure(kIoError, fmt::format("{}: is no folder", name));
  for (const auto& [path, text] : files)
    if (fs::exists(fs::symlink_status(folder / path, error)))
      throw Failure(kIoError, fmt::format("{}: is there already; nothing was written", (folder / path).generic_string()));
  for (const auto& [path, text] : files) {
    fs::create_directories((folder / path).parent_path(), error);
    if (error)
      throw Failure(kIoError, fmt::format("{}: {}", (folder / path).parent_path().generic_string(), error.message()));
    replace_file((folder / path).generic_string(), text);
  }
}

}  // namespace ipos::tools

// Coverage of a shard as JSON.
#include "tools/campaign/case_coverage.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/cli/files.hpp"
#include "tools/cli/json_text.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/coverage/collector.hpp"

namespace ipos::tools::campaign {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json json_of(const coverage::Place& place) { return {place.line, place.column}; }
coverage::Place place_from(const Json& json) { return {json.at(0), json.at(1)}; }

Json json_of(const coverage::SourceFile& file) {
  Json lines = Json::array();
  for (const auto& [line, count] : file.lines) lines.push_back({line, count});
  Json conditions = Json::array();
  for (const auto& [key, condition] : file.conditions) {
    Json row{json_of(key.at), key.number};
    for (const auto& way : condition.ways) row.push_back({json_of(way.to), way.count});
    conditions.push_back(std::move(row));
  }
  Json functions = Json::object();
  for (const auto& [name, function] : file.functions) functions[name] = {function.line, function.count};
  return {{"lines", std::move(lines)}, {"conditions", std::move(conditions)}, {"functions", std::move(functions)}};
}

coverage::SourceFile file_of(const Json& json) {
  coverage::SourceFile file;
  for (const Json& row : json.at("lines")) file.lines[row.at(0)] = row.at(1);
  for (const Json& row : json.at("conditions")) {
    coverage::Condition& condition = file.conditions[{place_from(row.at(0)), row.at(1)}];
    for (size_t n = 0; n < condition.ways.size(); ++n) condition.ways[n] = {place_from(row.at(n + 2).at(0)), row.at(n + 2).at(1)};
  }
  for (const auto& [name, row] : json.at("functions").items()) file.functions[name] = {row.at(0), row.at(1)};
  return file;
}

std::string file_name(const Shard& shard, const Outline& outline) {
  return fs::path(shard.file_name()).stem().string() + "-" + hex(outline.identity) + ".coverage.json";
}

}  // namespace

std::string coverage_json(const coverage::Coverage& coverage) {
  Json json = Json::object();
  for (const auto& [path, file] : coverage.files) json[path] = json_of(file);
  return json_text(json);
}

std::optional<coverage::Coverage> read_coverage_json(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    coverage::Coverage coverage;
    for (const auto& [path, file] : json.items()) coverage.files[path] = file_of(file);
    return coverage;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

void CaseCoverage::attach(CaseRunner& runner, WorkListener& listener) {
  runner.use_watcher([this](runtime::Plant& plant) {
    return std::shared_ptr<void>(new coverage::Collector(plant), [this](coverage::Collector* collector) {
      seen_.merge(collector->coverage());
      delete collector;
    });
  });
  listener.extra = [this] { return coverage_json(seen_); };
  listener.on_extra = [this](const std::string& text) {
    if (const auto seen = read_coverage_json(text)) total_.merge(*seen);
  };
}

void CaseCoverage::write(const std::string& folder, const Shard& shard, const Outline& outline) const {
  const std::string path = (fs::path(folder) / file_name(shard, outline)).string();
  coverage::Coverage all = total_;
  if (const auto before = try_read_file(path))
    if (const auto seen = read_coverage_json(*before)) all.merge(*seen);
  rewrite_file(path, coverage_json(all) + "\n");
}

std::optional<coverage::Coverage> read_coverage(const std::vector<std::string>& folders, const Outline& outline) {
  std::optional<coverage::Coverage> all;
  for (const std::string& folder : folders) {
    std::vector<std::string> names = list_files(folder);
    std::sort(names.begin(), names.end());
    for (const std::string& name : names) {
      if (!name.ends_with("-" + hex(outline.identity) + ".coverage.json")) continue;
      if (const auto seen = read_coverage_json(read_file((fs::path(folder) / name).string()))) {
        if (!all) all.emplace();
        all->merge(*seen);
      }
    }
  }
  return all;
}

}  // namespace ipos::tools::campaign

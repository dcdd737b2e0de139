// The last of a campaign's reading: what a plant that is built says of factors and measures, and one number over everything that
// decides a result.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/plant/trace_hash.hpp"
#include "tools/campaign/case_runner.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"

namespace ipos::tools::campaign {
namespace {

// So many levels are tried before the first case; a level that is refused later is a result.
constexpr size_t kTriedLevels = 1000;

uint64_t identity_of(const std::string& text) {
  runtime::NumberHash hash;
  hash.add_text(text);
  return hash.value();
}

// A program with what it includes; of a file that cannot be read nothing.
void add_program(const std::string& path, const stdlib::UnitType* unit, const CompileFlags& compile, std::map<std::string, std::string>& texts) {
  if (const auto text = try_read_file(path)) texts[path] = *text;
  if (!is_source(path)) return;
  CompileFlags flags = compile;
  if (unit != nullptr) flags.unit = unit->name;
  for (const std::string& file : included_files(path, flags))
    if (const auto text = try_read_file(file)) texts[file] = *text;
}

void add_plant(const std::string& path, const runtime::PlantFile& plant, const CompileFlags& compile, std::map<std::string, std::string>& texts) {
  texts[path] = read_file(path);
  for (const runtime::StationConfig& station : plant.stations) {
    if (!station.program.empty()) add_program(beside(path, station.program), station.unit, compile, texts);
    if (const auto memory = station.nvram.empty() ? std::nullopt : try_read_file(station.nvram)) texts[station.nvram] = *memory;
  }
  for (const runtime::MachineConfig& machine : plant.machines)
    if (const auto fmu = try_read_file(beside(path, machine.fmu))) texts[beside(path, machine.fmu)] = *fmu;
}

// A key that names a program stands for what is in it.
void identify_programs(Campaign& campaign, const CompileFlags& compile) {
  const std::string& plant = campaign.tests.empty() ? campaign.plant : campaign.tests.front().plant_path;
  for (size_t n = 0; n < campaign.factors.size(); ++n) {
    if (campaign.factors[n].target != Target::Key || !campaign.factors[n].key.ends_with(".program")) continue;
    for (Level& level : campaign.outline.factors[n].levels) {
      std::map<std::string, std::string> texts;
      add_program(beside(plant, level.text), nullptr, compile, texts);
      runtime::NumberHash hash;
      hash.add(level.identity);
      for (const auto& [file, text] : texts) hash.add_text(text);
      level.identity = hash.value();
    }
  }
}

void identify(Campaign& campaign, const CompileFlags& compile) {
  std::map<std::string, std::string> texts;
  if (campaign.tests.empty()) add_plant(campaign.plant, Subject(campaign, compile).prepared(Levels(campaign.factors.size())).plant, compile, texts);
  for (const testing::TestCase& test : campaign.tests) {
    texts[test.file] = read_file(test.file);
    add_plant(test.plant_path, test.plant, compile, texts);
  }
  Outline& outline = campaign.outline;
  outline.campaign = campaign.name_of(campaign.file);
  outline.version = IPOS_VERSION;
  runtime::NumberHash hash;
  hash.add_text(outline.version);
  for (const auto& [file, text] : texts) {
    outline.inputs[campaign.name_of(file)] = identity_of(text);
    hash.add_text(campaign.name_of(file));
    hash.add_text(text);
  }
  for (const auto* words : {&compile.include_dirs, &compile.defines})
    for (const std::string& word : *words) hash.add_text(word);
  hash.add_text(compile.unit);
  if (compile.optimization != "1") hash.add_text("-O" + compile.optimization);
  hash.add_all(compile.atomic, campaign.duration, campaign.tests.size());
  for (const Factor& factor : campaign.factors) {
    hash.add_text(fmt::format("{} {} {} {} {}", static_cast<int>(factor.target), factor.station, factor.key, factor.signal.name, factor.signal_key));
    hash.add(factor.fault);
  }
  for (const Fault& fault : campaign.faults) {
    hash.add_text(fault.toml);
    hash.add_all(fault.config.fault.from, fault.config.fault.until);
  }
  for (size_t n = 0; n < campaign.measures.size(); ++n) {
    const Measure& measure = campaign.measures[n];
    const MeasureOutline& row = outline.measures[n];
    const auto limit = [](const std::optional<double>& one) { return one ? fmt::format("{}", *one) : "none"; };
    hash.add_text(fmt::format("{} {} {} {} {} {} {} {}", row.name, measure.signal, static_cast<int>(measure.take), measure.band,
                              static_cast<int>(measure.when), measure.threshold, limit(row.at_least), limit(row.at_most)));
  }
  outline.identity = hash.value();
}

}  // namespace

std::vector<runtime::PlantError> finish_campaign(Campaign& campaign, const CompileFlags& compile) {
  std::vector<runtime::PlantError> errors;
  identify_programs(campaign, compile);
  CaseRunner runner(campaign, compile);
  std::set<std::string> told;  // what is wrong with one factor is so for every level of the others
  Levels levels;
  for (const FactorOutline& factor : campaign.outline.factors) levels.push_back(factor.middle());
  for (size_t n = 0; n < campaign.factors.size(); ++n) {
    const Factor& factor = campaign.factors[n];
    const bool any_will_do = factor.target != Target::Key && factor.target != Target::Parameter;
    const size_t tried = any_will_do ? 1 : std::min(factor.settings.size(), kTriedLevels);
    const uint32_t middle = levels[n];
    for (levels[n] = 0; levels[n] < tried; ++levels[n])
      if (const auto why = runner.refused(levels); !why.empty() && told.insert(why).second) errors.push_back({factor.places[levels[n]], why});
    levels[n] = middle;
  }
  if (!errors.empty()) return errors;
  for (size_t n = 0; n < campaign.measures.size(); ++n) {
    const Measure& measure = campaign.measures[n];
    const auto unit = runner.unit_of(measure.signal, levels);
    if (!unit)
      errors.push_back({measure.signal_place, unit.error()});
    else if (campaign.outline.measures[n].unit.empty())
      campaign.outline.measures[n].unit = *unit;
  }
  identify(campaign, compile);
  return errors;
}

}  // namespace ipos::tools::campaign

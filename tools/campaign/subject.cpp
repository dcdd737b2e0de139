// The plant or the tests of a case. Keys change the text, which is read again; the rest changes what was read, as the reader
// would have made it of the text.
#include "tools/campaign/subject.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/machines/open_machines.hpp"
#include "tools/running/real_time_run.hpp"
#include "tools/test_file/read_tests.hpp"

namespace ipos::tools::campaign {
namespace {

using testing::TestCase;

void use_memories(const std::string& path, runtime::PlantFile& plant) {
  for (runtime::StationConfig& station : plant.stations) {
    if (!station.nvram.empty()) station.nvram = beside(path, station.nvram);
    station.nvram_use = runtime::FileUse::Look;
  }
}

bool has_keys(const Campaign& campaign) {
  return std::any_of(campaign.factors.begin(), campaign.factors.end(), [](const Factor& one) { return one.target == Target::Key; });
}

runtime::FaultConfig fault_of(const Campaign& campaign, size_t number, const Levels& levels) {
  runtime::FaultConfig fault = campaign.faults[number].config;
  for (size_t n = 0; n < campaign.factors.size(); ++n) {
    const Factor& factor = campaign.factors[n];
    if (factor.fault != number) continue;
    const int64_t value = factor.settings[levels[n]].number;
    if (factor.target == Target::FaultTime) fault.begin_at(value, 0);
    if (factor.target != Target::FaultSeed) continue;
    fault.fault.seed = static_cast<uint64_t>(value);
    if (fault.octets) fault.octets->seed = static_cast<uint64_t>(value);
  }
  return fault;
}

}  // namespace

runtime::PlantFile read_plant_subject(Campaign& campaign, const CompileFlags& compile) {
  campaign.plant_text = read_file(campaign.plant);
  PlantInput input = read_plant_input(campaign.plant, compile);
  refuse_ports(input.file, campaign.plant);
  runtime::PlantFile plant = input.file;
  make_plant(std::move(input), runtime::FileUse::Look);
  return plant;
}

runtime::PlantFile read_test_subject(const std::vector<std::string>& files, Campaign& campaign, const CompileFlags& compile) {
  testing::Programs programs(compile);
  for (const std::string& file : files)
    for (TestCase& test : testing::read_tests(file)) {
      print_mistakes(test.errors_in.empty() ? test.file : test.errors_in, test.errors);
      if (!test.errors.empty()) throw Failure(kBadInput, "");
      for (runtime::StationConfig& station : test.plant.stations) {
        if (station.program.empty()) continue;
        const auto program = programs.load(beside(test.plant_path, station.program), station.unit);
        if (!program->image && test.diagnostics.empty()) {
          fmt::print(stderr, "{}", program->messages);
          throw Failure(kBadInput, "");
        }
        if (station.unit == nullptr) station.unit = program->unit;
      }
      campaign.tests.push_back(std::move(test));
    }
  if (campaign.tests.empty()) throw Failure(kBadInput, fmt::format("{}: its tests have no test", campaign.file));
  return campaign.tests.front().plant;
}

// --- keys ---

TomlEdit Subject::with_keys(const Levels& levels, std::string text, std::string& refused) const {
  TomlEdit edit(std::move(text));
  for (size_t n = 0; n < campaign_.factors.size(); ++n) {
    const Factor& factor = campaign_.factors[n];
    if (factor.target != Target::Key) continue;
    if (const auto why = edit.set(factor.key, factor.settings[levels[n]].toml)) refused = *why;
  }
  return edit;
}

Prepared Subject::prepare(const Levels& levels) {
  Prepared prepared;
  const auto refuse = [&](const std::string& file, const std::vector<runtime::PlantError>& errors) {
    if (!errors.empty()) prepared.refused = fmt::format("{}: {}", campaign_.name_of(file), errors.front().text);
  };
  if (campaign_.tests.empty()) {
    const TomlEdit edit = with_keys(levels, campaign_.plant_text, prepared.refused);
    runtime::PlantFileResult read = runtime::read_plant_file(edit.text(), campaign_.plant);
    // What the file says where: lines that a key has added are not in it.
    for (runtime::Expectation& one : read.plant.expectations) one.place.line = edit.original_line(one.place.line);
    if (read.errors.empty()) read.errors = open_machines(read.plant, campaign_.plant, programs_.allow_fmu());
    refuse(campaign_.plant, read.errors);
    prepared.plant = std::move(read.plant);
    use_memories(campaign_.plant, prepared.plant);
    if (prepared.refused.empty()) load_programs(prepared);
    return prepared;
  }
  prepared.tests = campaign_.tests;
  if (!has_keys(campaign_)) return prepared;
  for (TestCase& test : prepared.tests) {
    const std::string text = with_keys(levels, read_file(test.plant_path), prepared.refused).text();
    if (test.plant_path == test.file) {
      for (TestCase& changed : testing::read_test_file(test.file, text))
        if (changed.name == test.name) {
          refuse(test.file, changed.errors);
          test.plant = std::move(changed.plant);
        }
    } else {
      runtime::PlantFileResult read = runtime::read_plant_file(text);
      refuse(test.plant_path, read.errors);
      test.plant = std::move(read.plant);
      test.plant.expectations.clear();
      for (runtime::StationConfig& station : test.plant.stations) station.nvram.clear();
    }
  }
  return prepared;
}

void Subject::load_programs(Prepared& prepared) {
  for (runtime::StationConfig& station : prepared.plant.stations) {
    prepared.programs.emplace_back();
    if (station.program.empty()) continue;
    const auto program = programs_.load(beside(campaign_.plant, station.program), station.unit);
    if (!program->image) {
      prepared.refused = program->messages;
      return;
    }
    if (station.unit != nullptr && station.unit != program->unit) {
      prepared.refused = fmt::format("{} is for another unit than '{}'", station.program, station.name);
      return;
    }
    station.unit = program->unit;
    prepared.programs.back() = program->image;
  }
}

const Prepared& Subject::prepared(const Levels& levels) {
  Levels keys;
  for (size_t n = 0; n < campaign_.factors.size(); ++n)
    if (campaign_.factors[n].target == Target::Key) keys.push_back(levels[n]);
  const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const auto& one) { return one.first == keys; });
  if (known != kept_.end())
    kept_.splice(kept_.begin(), kept_, known);
  else
    kept_.emplace_front(std::move(keys), prepare(levels));
  if (kept_.size() > kKept) kept_.pop_back();
  return kept_.front().second;
}

// --- the rest ---

void Subject::apply(const Levels& levels, runtime::PlantFile& plant) const {
  for (size_t n = 0; n < campaign_.factors.size(); ++n) {
    const Factor& factor = campaign_.factors[n];
    const Setting& setting = factor.settings[levels[n]];
    if (factor.target == Target::Parameter) {
      const auto station = std::find_if(plant.stations.begin(), plant.stations.end(), [&](const auto& one) { return one.name == factor.station; });
      if (station == plant.stations.end()) continue;
      auto& parameters = station->parameters;
      const auto known = std::find_if(parameters.begin(), parameters.end(), [&](const auto& one) { return one.parameter == factor.key; });
      if (known != parameters.end())
        known->value = static_cast<int32_t>(setting.number);
      else  // TomlEdit writes it below the head of the table
        parameters.insert(parameters.begin(), {factor.key, static_cast<int32_t>(setting.number), factor.places[levels[n]]});
    } else if (factor.target == Target::Stimulus) {
      runtime::Stimulus stimulus;
      stimulus.signal = factor.signal;
      stimulus.signal.line = setting.line;
      stimulus.value = static_cast<int32_t>(setting.number);
      stimulus.place = factor.places[levels[n]];
      plant.stimuli.push_back(std::move(stimulus));
    }
  }
  for (size_t n = 0; n < campaign_.faults.size(); ++n) plant.faults.push_back(fault_of(campaign_, n, levels));
}

std::string Subject::plant_text(const Levels& levels) const {
  std::string refused;
  TomlEdit edit = with_keys(levels, campaign_.tests.empty() ? campaign_.plant_text : read_file(campaign_.tests.front().plant_path), refused);
  for (size_t n = 0; n < campaign_.factors.size(); ++n) {
    const Factor& factor = campaign_.factors[n];
    const Setting& setting = factor.settings[levels[n]];
    if (factor.target == Target::Parameter)
      edit.set(fmt::format("station.\"{}\".parameters.{}", factor.station, factor.key), setting.toml);
    if (factor.target == Target::Stimulus)
      edit.append(fmt::format("\n[[stimulus]]\nstation = \"{}\"\nat = \"0ms\"\n{} = \"{}\"\nset = {}\n", factor.station,
                              factor.signal_key, factor.signal.name, setting.toml));
  }
  for (size_t n = 0; n < campaign_.faults.size(); ++n) {
    const runtime::FaultConfig fault = fault_of(campaign_, n, levels);
    const auto time = [&](std::string_view key, Time value) {
      if (value != 0 && value != runtime::kNever) edit.append(fmt::format("{} = \"{}us\"\n", key, static_cast<double>(value) / 1000));
    };
    edit.append("\n[[fault]]\n" + campaign_.faults[n].toml + "\n");
    time("from", fault.octets ? fault.octets->from : fault.fault.from);
    time("until", fault.octets ? fault.octets->until : fault.fault.until);
    if (campaign_.faults[n].has_seeds)
      edit.append(fmt::format("seed = {}\n", fault.octets ? fault.octets->seed : fault.fault.seed));
  }
  return edit.text();
}

}  // namespace ipos::tools::campaign

// The campaign file: the plant or the tests first, as they decide what can be varied.
#include <algorithm>
#include <filesystem>

#include "runtime/plant/trace_hash.hpp"
#include "tools/campaign/read_vary.hpp"
#include "tools/campaign/subject.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/mistakes.hpp"

namespace ipos::tools::campaign {
namespace {

namespace fs = std::filesystem;

constexpr Time kUsualTime = 60 * runtime::kSecond;  // as --for of `ipos run`, and on the clock

void read_what(PlantReader& reader, const toml::table& root, Campaign& campaign, const CompileFlags& compile) {
  const toml::node* tests = root.get("tests");
  if ((tests != nullptr) == root.contains("plant"))
    return reader.error({1, 1}, "a campaign has either plant = \"...\" or tests = [\"...\"]");
  if (tests == nullptr) {
    const std::string name = reader.text(root, "plant", "a campaign", true);
    if (name.empty()) return;
    campaign.plant = beside(campaign.file, name);
    if (const auto why = unreadable(campaign.plant))
      return reader.error(place_of(*root.get("plant")), fmt::format("plant {}: {}", campaign.plant, *why));
    reader.result.plant = read_plant_subject(campaign, compile);
    return;
  }
  const toml::array* names = tests->as_array();
  if (names == nullptr || names->empty()) return reader.error(place_of(*tests), "tests is a list of names of files");
  std::vector<std::string> files;
  for (const toml::node& name : *names) {
    if (!name.is_string()) return reader.error(place_of(name), "tests is a list of names of files");
    files.push_back(beside(campaign.file, name.as_string()->get()));
    if (const auto why = is_folder(files.back()) ? std::nullopt : unreadable(files.back()))
      return reader.error(place_of(name), fmt::format("test {}: {}", files.back(), *why));
  }
  reader.result.plant = read_test_subject(files, campaign, compile);
}

void read_times(PlantReader& reader, const toml::table& root, Campaign& campaign) {
  campaign.duration = reader.duration(root, "for", campaign.plant.empty() ? 0 : kUsualTime);
  campaign.limit = reader.duration(root, "limit", kUsualTime);
  for (const char* key : {"for", "limit"})
    if (const toml::node* node = root.get(key); node != nullptr && reader.duration(root, key, 1) == 0)
      reader.error(place_of(*node), fmt::format("{} is more than nothing", key));
}

void read_sampling(PlantReader& reader, const toml::table& root, Sampling& sampling) {
  const std::string word = root.contains("sample") ? reader.text(root, "sample", "a campaign", true) : "grid";
  const auto row = std::find_if(std::begin(kSamples), std::end(kSamples), [&](const SampleWord& one) { return one.word == word; });
  if (row == std::end(kSamples)) {
    if (!word.empty())
      reader.error(place_of(*root.get("sample")), fmt::format("sample is grid, random, latin or pairs, not '{}'", word),
                   runtime::AllowedValues{{"\"grid\"", "\"random\"", "\"latin\"", "\"pairs\""}});
    return;
  }
  sampling.sample = row->sample;
  sampling.count = reader.count(root, "count", kMostCases, 0, 1);
  sampling.seed = reader.count(root, "seed", INT32_MAX, 1);
  const bool counted = sampling.sample == Sample::Random || sampling.sample == Sample::Latin;
  if (counted && !root.contains("count")) reader.error(place_of(*root.get("sample")), fmt::format("sample = \"{}\" needs count = N", word));
  for (const char* key : {"count", "seed"})
    if (const toml::node* node = root.get(key); node != nullptr && sampling.sample == Sample::Grid)
      reader.error(place_of(*node), fmt::format("{} belongs to sample = \"random\", \"latin\" or \"pairs\"; the grid has all cases", key));
}

// "1..10000", or a list.
void read_seeds(PlantReader& reader, const toml::node& node, FactorOutline& outline, Factor& factor) {
  const auto add = [&](int64_t seed, FilePlace place) {
    if (seed < 0 || seed > INT32_MAX) return reader.error(place, fmt::format("a seed is 0 to {}", INT32_MAX));
    add_level(outline, factor, {std::to_string(seed), seed, 0}, toml::value<int64_t>(seed), place);
  };
  constexpr std::string_view kForms = "seeds is a text \"1..100\", or a list of whole numbers";
  if (const auto* text = node.as_string()) {
    long long first = 0;
    long long last = 0;
    int used = 0;
    if (std::sscanf(text->get().c_str(), "%10lld..%10lld%n", &first, &last, &used) != 2 || used != static_cast<int>(text->get().size()) || last < first || last - first >= 10'000'000)
      return reader.error(place_of(node), std::string(kForms));
    for (long long seed = first; seed <= last && reader.result.errors.empty(); ++seed) add(seed, place_of(node));
  } else if (const toml::array* list = node.as_array()) {
    for (const toml::node& seed : *list)
      if (seed.is_integer())
        add(seed.as_integer()->get(), place_of(seed));
      else
        return reader.error(place_of(seed), std::string(kForms));
  } else {
    reader.error(place_of(node), std::string(kForms));
  }
}

void read_moments(PlantReader& reader, const toml::node& node, FactorOutline& outline, Factor& factor) {
  const auto add = [&](const toml::node& moment) {
    const int64_t time = runtime::parse_duration(moment.value_or(std::string()));
    if (time < 0) return reader.error(place_of(moment), "at is a time such as 500ms, or a list of times");
    add_level(outline, factor, {toml_of(moment), time, 0}, moment, place_of(moment));
  };
  if (const toml::array* list = node.as_array())
    for (const toml::node& moment : *list) add(moment);
  else
    add(node);
}

// A plant file's own, with seeds and moments as factors.
void read_campaign_fault(PlantReader& reader, toml::table& table, Campaign& campaign) {
  const std::string name = table.contains("name") ? reader.text(table, "name", "a [[fault]]", true) : "";
  const std::string called = !name.empty() ? name : fmt::format("{}.{}", table["bus"].value_or(std::string()), table["kind"].value_or(std::string()));
  struct Key {
    std::string_view key, ending;
    Target target;
    void (*read)(PlantReader&, const toml::node&, FactorOutline&, Factor&);
  };
  static constexpr Key kKeys[] = {{"seeds", "seed", Target::FaultSeed, read_seeds}, {"at", "at", Target::FaultTime, read_moments}};
  const bool both = table.contains("seeds") && table.contains("at");
  if (table.contains("seeds") && table.contains("seed")) reader.error(place_of(*table.get("seed")), "either seeds or seed");
  for (const Key& row : kKeys) {
    const toml::node* node = table.get(row.key);
    if (node == nullptr) continue;
    FactorOutline outline{!name.empty() && !both ? name : fmt::format("{}.{}", called, row.ending), {}};
    Factor factor;
    factor.target = row.target;
    factor.fault = campaign.faults.size();
    row.read(reader, *node, outline, factor);
    check_levels(reader, outline, factor, place_of(*node));
    campaign.factors.push_back(std::move(factor));
    campaign.outline.factors.push_back(std::move(outline));
  }
  const bool has_seeds = table.contains("seeds");
  for (const std::string_view key : {"seeds", "at", "name"}) table.erase(key);
  const size_t before = reader.result.plant.faults.size();
  runtime::read_fault(reader, table);
  if (reader.result.plant.faults.size() == before) return;
  for (const std::string_view key : {"from", "until"}) table.erase(key);
  std::ostringstream toml;
  toml << table;
  campaign.faults.push_back({std::move(reader.result.plant.faults.back()), toml.str(), has_seeds});
  reader.result.plant.faults.pop_back();
}

std::optional<double> read_number(PlantReader& reader, const toml::table& table, std::string_view key) {
  const toml::node* node = table.get(key);
  if (node == nullptr) return std::nullopt;
  if (const auto number = node->value<double>(); number && node->is_number()) return number;
  reader.error(place_of(*node), fmt::format("{} is a number", key));
  return std::nullopt;
}

void read_moment_of(PlantReader& reader, const toml::table& table, Measure& measure) {
  struct Key {
    std::string_view key;
    Measure::When when;
  };
  std::string_view found;
  for (const Key& row : {Key{"above", Measure::When::Above}, Key{"below", Measure::When::Below}, Key{"equals", Measure::When::Equals}}) {
    const auto number = read_number(reader, table, row.key);
    if (!table.contains(row.key)) continue;
    if (!found.empty() || measure.take != Take::Time)
      return reader.error(place_of(*table.get(row.key)), "take = \"time\" has one of above, below, equals");
    found = row.key;
    measure.when = row.when;
    measure.threshold = number.value_or(0);
  }
  if (found.empty() && measure.take == Take::Time)
    reader.error(place_of(table), "take = \"time\" needs one of above, below, equals = N");
}

void read_band(PlantReader& reader, const toml::table& table, Measure& measure) {
  const toml::node* node = table.get("band");
  if (node == nullptr) return;
  std::string text = node->is_number() ? fmt::format("{}", *node->value<double>()) : node->value_or(std::string());
  if (text.ends_with('%')) text.pop_back();
  char* end = nullptr;
  measure.band = std::strtod(text.c_str(), &end);
  while (*end == ' ') ++end;
  if (text.empty() || *end != 0 || !(measure.band > 0) || measure.band > 100)
    reader.error(place_of(*node), "band is a part of the way, such as \"2 %\"");
  if (measure.take != Take::Settling) reader.error(place_of(*node), "band belongs to take = \"settling\"");
}

void read_measure(PlantReader& reader, const toml::table& table, Campaign& campaign) {
  constexpr std::string_view kWhat = "a [[measure]]";
  reader.known_keys(table, "[[measure]]", {"name", "signal", "take", "at_most", "at_least", "band", "above", "below", "equals"});
  Measure measure;
  measure.signal = reader.text(table, "signal", kWhat, true);
  const std::string word = reader.text(table, "take", kWhat, true);
  const auto row = std::find_if(std::begin(kTakes), std::end(kTakes), [&](const TakeWord& one) { return one.word == word; });
  if (row == std::end(kTakes)) {
    std::vector<std::string_view> words;
    for (const TakeWord& one : kTakes) words.push_back(one.word);
    if (!word.empty()) reader.error(place_of(*table.get("take")), fmt::format("take is one of {}, not '{}'", fmt::join(words, ", "), word));
    return;
  }
  if (measure.signal.empty()) return;
  measure.take = row->take;
  measure.signal_place = place_of(*table.get("signal"));
  read_moment_of(reader, table, measure);
  read_band(reader, table, measure);
  MeasureOutline outline;
  outline.name = table.contains("name") ? reader.text(table, "name", kWhat, true) : fmt::format("{}.{}", measure.signal, word);
  outline.unit = row->unit;
  outline.at_least = read_number(reader, table, "at_least");
  outline.at_most = read_number(reader, table, "at_most");
  campaign.measures.push_back(std::move(measure));
  campaign.outline.measures.push_back(std::move(outline));
}

// Columns of results have names of their own.
void check_names(PlantReader& reader, const toml::table& root, const Outline& outline) {
  std::set<std::string> names;
  const auto check = [&](const std::string& name) {
    if (!names.insert(name).second)
      reader.error(place_of(root), fmt::format("two factors or measures are called '{}'; name = \"...\" tells them apart", name));
  };
  for (const FactorOutline& factor : outline.factors) check(factor.name);
  for (const MeasureOutline& measure : outline.measures) check(measure.name);
}

void check_size(PlantReader& reader, const Outline& outline) {
  std::vector<uint32_t> counts;
  for (const FactorOutline& factor : outline.factors) counts.push_back(static_cast<uint32_t>(factor.levels.size()));
  if (outline.sampling.sample == Sample::Pairs) {
    if (pair_count(counts) > kMostPairs) reader.error({1, 1}, fmt::format("{} pairs of values are too many for sample = \"pairs\"", pair_count(counts)));
    return;
  }
  const uint64_t size = Design(outline.sampling, counts).size();
  if (size > kMostCases)
    reader.error({1, 1}, fmt::format("the grid has {} cases, at most {} are run; sample = \"random\", \"latin\" or \"pairs\" takes some of them",
                                     size == UINT64_MAX ? "more than 10^19" : std::to_string(size), kMostCases));
}

}  // namespace

std::string Campaign::name_of(const std::string& path) const {
  const fs::path folder = fs::absolute(file).lexically_normal().parent_path();
  return fs::absolute(path).lexically_normal().lexically_relative(folder).generic_string();
}

Campaign read_campaign(const std::string& path, const CompileFlags& compile) {
  Campaign campaign;
  campaign.file = path;
  PlantReader reader;
  auto root = runtime::parse_toml(reader, read_file(path));
  if (root && !runtime::refuse_others(reader, *root, path, {runtime::TomlKind::Campaign})) {
    reader.known_keys(*root, "a campaign", {"plant", "fault", "tests", "for", "limit", "sample", "count", "seed", "vary", "measure"});
    read_what(reader, *root, campaign, compile);
    read_times(reader, *root, campaign);
    read_sampling(reader, *root, campaign.outline.sampling);
  }
  if (root && reader.result.errors.empty()) {
    const runtime::PlantFile& plant = reader.result.plant;
    for (const auto& bus : plant.buses) reader.bus_names.insert(bus.name);
    for (const auto& station : plant.stations) reader.station_names.insert(station.name);
    for (const auto& control : plant.controls) {
      reader.station_names.insert(control.name);
      if (control.as<runtime::GatewayConfig>() != nullptr) reader.gateway_names.insert(control.name);
    }
    reader.for_each_table(*root, "vary", [&](const toml::table& table) { read_vary(reader, table, campaign); });
    reader.for_each_table(*root, "fault", [](const toml::table&) {});  // the form; reading takes keys out of them
    if (toml::array* faults = root->get_as<toml::array>("fault"))
      for (toml::node& fault : *faults)
        if (toml::table* table = fault.as_table()) read_campaign_fault(reader, *table, campaign);
    reader.for_each_table(*root, "measure", [&](const toml::table& table) { read_measure(reader, table, campaign); });
    check_names(reader, *root, campaign.outline);
    campaign.later = static_cast<size_t>(std::count_if(plant.expectations.begin(), plant.expectations.end(), [&](const auto& one) { return one.at > campaign.duration; }));
    if (reader.result.errors.empty()) check_size(reader, campaign.outline);
    runtime::check_plant(reader);
  }
  if (reader.result.errors.empty()) reader.result.errors = finish_campaign(campaign, compile);
  print_mistakes(path, reader.result.errors);
  if (!reader.result.errors.empty()) throw Failure(kBadInput, "");
  return campaign;
}

}  // namespace ipos::tools::campaign

// Numbers of cases, and the file of a plan.
#include "tools/campaign/outline.hpp"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>
#include <unordered_set>

#include "runtime/plant/trace_hash.hpp"
#include "tools/cli/json_text.hpp"

namespace ipos::tools::campaign {
namespace {

using Ordered = nlohmann::ordered_json;

std::vector<uint32_t> counts_of(const Outline& outline) {
  std::vector<uint32_t> counts;
  for (const FactorOutline& factor : outline.factors) counts.push_back(static_cast<uint32_t>(factor.levels.size()));
  return counts;
}

Ordered json_of(const FactorOutline& factor) {
  Ordered levels = Ordered::array();
  for (const Level& level : factor.levels)
    levels.push_back({level.text, Ordered::parse(level.json), hex(level.identity)});
  return {{"name", factor.name}, {"levels", std::move(levels)}};
}

Ordered json_of(const MeasureOutline& measure) {
  Ordered row{{"name", measure.name}, {"unit", measure.unit}};
  if (measure.at_least) row["at_least"] = *measure.at_least;
  if (measure.at_most) row["at_most"] = *measure.at_most;
  return row;
}

FactorOutline factor_of(const Ordered& row) {
  FactorOutline factor{row.at("name"), {}};
  for (const Ordered& level : row.at("levels"))
    factor.levels.push_back({level.at(0), level.at(1).dump(), number_of_hex(level.at(2).get<std::string>()).value()});
  return factor;
}

MeasureOutline measure_of(const Ordered& row) {
  MeasureOutline measure{row.at("name"), row.at("unit"), {}, {}};
  if (row.contains("at_least")) measure.at_least = row.at("at_least");
  if (row.contains("at_most")) measure.at_most = row.at("at_most");
  return measure;
}

std::string_view word_of(Sample sample) {
  for (const SampleWord& row : kSamples)
    if (row.sample == sample) return row.word;
  return "";
}

Sample sample_of(const std::string& word) {
  for (const SampleWord& row : kSamples)
    if (row.word == word) return row.sample;
  throw std::out_of_range(word);
}

}  // namespace

std::string hex(uint64_t number) { return fmt::format("{:016x}", number); }

std::optional<uint64_t> number_of_hex(std::string_view text) {
  uint64_t number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number, 16);
  if (text.size() != 16 || status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

// The multiplications of the hash mix upwards only, so the upper half comes down at the end.
uint64_t Outline::case_of(const Levels& levels) const {
  runtime::NumberHash hash;
  hash.add(identity);
  for (size_t n = 0; n < factors.size(); ++n) {
    hash.add_text(factors[n].name);
    hash.add(factors[n].levels[levels[n]].identity);
  }
  const uint64_t value = hash.value();
  return (value ^ value >> 32U) * 0x9E3779B97F4A7C15 ^ value >> 29U;
}

std::string outline_json(const Outline& outline) {
  Ordered json{{"campaign", outline.campaign}, {"version", outline.version}, {"identity", hex(outline.identity)}};
  for (const auto& [file, identity] : outline.inputs) json["inputs"][file] = hex(identity);
  json["sample"] = {{"kind", word_of(outline.sampling.sample)},
                    {"count", outline.sampling.count},
                    {"seed", outline.sampling.seed}};
  json["factors"] = Ordered::array();
  for (const FactorOutline& factor : outline.factors) json["factors"].push_back(json_of(factor));
  json["measures"] = Ordered::array();
  for (const MeasureOutline& measure : outline.measures) json["measures"].push_back(json_of(measure));
  return json_text(json) + "\n";
}

std::optional<Outline> read_outline(const std::string& text) {
  try {
    const Ordered json = Ordered::parse(text);
    Outline outline{json.at("campaign"), json.at("version"), number_of_hex(json.at("identity").get<std::string>()).value(), {}, {}, {}, {}};
    if (json.contains("inputs"))
      for (const auto& [file, identity] : json.at("inputs").items())
        outline.inputs[file] = number_of_hex(identity.get<std::string>()).value();
    const Ordered& sample = json.at("sample");
    outline.sampling = {sample_of(sample.at("kind")), sample.at("count"), sample.at("seed")};
    for (const Ordered& factor : json.at("factors")) outline.factors.push_back(factor_of(factor));
    for (const Ordered& measure : json.at("measures")) outline.measures.push_back(measure_of(measure));
    return outline;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

Plan::Plan(const Outline& outline) : design_(outline.sampling, counts_of(outline)) {
  std::unordered_set<uint64_t> known;
  const bool once = outline.sampling.sample != Sample::Latin;  // a grid, or rows of it
  Levels levels;
  cases_.reserve(design_.size());
  for (uint64_t number = 0; number < design_.size(); ++number) {
    design_.levels(number, levels);
    const uint64_t id = outline.case_of(levels);
    if (!once && !known.insert(id).second)
      ++left_out_;
    else
      cases_.push_back({id, number});
  }
}

}  // namespace ipos::tools::campaign

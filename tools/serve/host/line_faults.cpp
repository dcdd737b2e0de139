// The class of each line knows its faults (runtime/station/bus.hpp).
#include "tools/serve/host/line_faults.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>

#include "runtime/plant/actions.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::FaultConfig;
using runtime::FaultPlace;
using runtime::FaultRule;

const char* place_word(FaultPlace place) {
  switch (place) {
    case FaultPlace::Line: return "none";
    case FaultPlace::Station: return "must";
    case FaultPlace::Either: break;
  }
  return "may";
}

std::string listed(const std::vector<std::string_view>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

runtime::Bus& line_named(runtime::Plant& plant, const std::string& name) {
  if (runtime::Bus* bus = plant.find_bus(name)) return *bus;
  std::vector<std::string_view> known;
  for (const auto& bus : plant.buses()) known.push_back(bus->name());
  throw Mistake(fmt::format("there is no line '{}', only {}", name, listed(known)));
}

FaultRule rule_named(const runtime::Bus& bus, const std::string& word) {
  const std::vector<FaultRule> rules = bus.fault_rules();
  if (rules.empty())
    throw Mistake(
        fmt::format("{} is {}: such lines have no faults that can be planted", bus.name(), info(bus.kind()).line));
  std::vector<std::string_view> known;
  for (const FaultRule& rule : rules) {
    if (rule.word == word) return rule;
    known.push_back(rule.word);
  }
  throw Mistake(
      fmt::format("there is no fault '{}' of {}; there are {}", word, info(bus.kind()).line, listed(known)));
}

// What the kind does not take would be left out without a word.
void check(const FaultRule& rule, const runtime::Bus& bus, const std::string& station, const Arguments& a) {
  if (rule.at == FaultPlace::Station && station.empty())
    throw Mistake(fmt::format("'{}' needs a station", rule.word));
  if (rule.at == FaultPlace::Line && !station.empty())
    throw Mistake(fmt::format("'{}' concerns the whole line, not one station", rule.word));
  if (!rule.of_frames && a.has("rate"))
    throw Mistake(fmt::format("'{}' lasts until it is ended: it has no rate", rule.word));
  if (!rule.of_one_kind && a.has("identifier"))
    throw Mistake(rule.of_frames
                      ? fmt::format("'{}' strikes all frames of a sender: frames of {} have no identifier",
                                    rule.word, info(bus.kind()).line)
                      : fmt::format("'{}' concerns the wires: it has no identifier", rule.word));
}

// What the two kinds of faults have in common.
uint32_t per_mille(const FaultConfig& config) {
  return config.octets ? config.octets->per_mille : config.fault.per_mille;
}

FaultConfig config_of(const runtime::Bus& bus, const FaultRule& rule, const Arguments& a, runtime::Time now) {
  runtime::WantedFault wanted{rule.word, now};
  wanted.per_mille = static_cast<uint32_t>(std::lround(a.number("rate", 0.001, 1, 1) * 1000));
  if (a.has("identifier"))
    wanted.id = static_cast<uint32_t>(a.whole("identifier", 0, runtime::kExtendedIdLimit - 1));
  FaultConfig config = bus.make_fault(wanted);
  config.bus = bus.name();
  config.station = a.text("station", "");
  return config;
}

}  // namespace

void LineFaults::built(runtime::Plant& plant) {
  plant_ = &plant;
  planted_ = plant.file().faults;
}

std::string_view LineFaults::word(const FaultConfig& config) {
  return config.octets ? octet_fault_type(config.octets->kind).word
                         : runtime::fault_type(config.fault.kind).word;
}

std::pair<runtime::Time, runtime::Time> LineFaults::times(const FaultConfig& config) {
  if (config.octets) return {config.octets->from, config.octets->until};
  return {config.fault.from, config.fault.until};
}

Json LineFaults::kinds(const runtime::Bus& line) {
  Json words = Json::array();
  for (const FaultRule& rule : line.fault_rules()) words.push_back(rule.word);
  return words;
}

Json LineFaults::rules(const runtime::Bus& line) {
  Json rules = Json::object();
  for (const FaultRule& rule : line.fault_rules())
    rules[std::string(rule.word)] = {{"text", rule.text},
                                     {"station", place_word(rule.at)},
                                     {"rate", rule.of_frames},
                                     {"identifier", rule.of_one_kind}};
  return rules;
}

void LineFaults::carry_out(const Arguments& a) {
  const runtime::Bus& bus = line_named(*plant_, a.text("bus"));
  const FaultRule rule = rule_named(bus, a.text("kind"));
  check(rule, bus, a.text("station", ""), a);
  const FaultConfig config = config_of(bus, rule, a, plant_->now());
  const auto same = [&](const FaultConfig& other) {
    return runtime::are_alike(other, config) && runtime::is_active(other, plant_->now());
  };
  const auto known = std::find_if(planted_.begin(), planted_.end(), same);
  if (a.flag("on")) {
    if (known != planted_.end()) throw Mistake("this fault is there already");
    if (!plant_->plant_fault(config))
      throw Mistake(fmt::format("there is no '{}' on {}", config.station, config.bus));
    planted_.push_back(config);
    return;
  }
  if (known == planted_.end()) throw Mistake("there is no such fault");
  if (!plant_->repair_fault(*known)) throw Mistake("its end is set in the plant file");
  planted_.erase(known);
}

Json LineFaults::planted_on(const std::string& bus) const {
  Json faults = Json::array();
  for (const FaultConfig& config : planted_) {
    if (config.bus != bus || !runtime::is_active(config, plant_->now())) continue;
    Json fault{{"kind", word(config)}, {"station", config.station}};
    if (config.fault.id) fault["id"] = *config.fault.id;
    if (per_mille(config) < 1000) fault["rate"] = per_mille(config) / 1000.0;
    faults.push_back(std::move(fault));
  }
  return faults;
}

}  // namespace ipos::tools::serve

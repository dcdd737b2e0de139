// A plant whose lines run apart, on one thread or several, does what it does in one queue: the same frames, states, journal and
// expectations. The plants are several examples, or several plants of chance, in one file, with wires between them.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>

#include "runtime/plant/trace_hash.hpp"
#include "tests/examples/plants.hpp"
#include "tests/runtime/plant/reading_plant.hpp"
#include "tools/input/plant_input.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::Time;
using tools::PlantInput;

// What programs of chance are warned about is no matter here.
PlantInput read(const std::string& path) {
  tools::CompileFlags flags;
  flags.warnings = {"no-all"};
  return tools::read_plant_input(path, flags);
}

// Its names begin with `prefix`.
PlantInput named(PlantInput input, const std::string& prefix) {
  const auto rename = [&](std::string& name) {
    if (!name.empty()) name = prefix + name;
  };
  runtime::PlantFile& file = input.file;
  for (auto& bus : file.buses) rename(bus.name);
  for (auto& station : file.stations) {
    for (auto& encoder : station.encoders) rename(encoder.shaft);
    for (std::string* name : {&station.name, &station.sbus, &station.sbus2, &station.serial.x13.bus, &station.serial.xt.bus,
                              &station.profibus.bus.bus})
      rename(*name);
  }
  for (auto& control : file.controls) {
    rename(control.name);
    rename(control.sbus);
    if (auto* dp = std::get_if<runtime::ProfibusMasterConfig>(&control.kind)) rename(dp->bus);
    if (auto* fms = std::get_if<runtime::FmsMasterConfig>(&control.kind)) rename(fms->bus);
    if (auto* gateway = std::get_if<runtime::GatewayConfig>(&control.kind)) rename(gateway->profibus.bus.bus);
  }
  for (auto& fault : file.faults) rename(fault.bus), rename(fault.station);
  for (auto& stimulus : file.stimuli) rename(stimulus.signal.station);
  for (auto& wire : file.wires) rename(wire.from.station), rename(wire.to.station);
  for (auto& row : file.switches) rename(row.input.station);
  for (auto& row : file.barriers) rename(row.input.station), rename(row.belt);
  for (auto& row : file.expectations) rename(row.signal.station);
  return input;
}

template <typename Rows>
void append(Rows& to, const Rows& more) {
  to.insert(to.end(), more.begin(), more.end());
}

PlantInput together(const std::vector<PlantInput>& parts) {
  PlantInput all;
  for (size_t n = 0; n < parts.size(); ++n) {
    const PlantInput part = named(parts[n], fmt::format("p{}", n));
    append(all.file.buses, part.file.buses);
    append(all.file.stations, part.file.stations);
    append(all.file.controls, part.file.controls);
    append(all.file.faults, part.file.faults);
    append(all.file.stimuli, part.file.stimuli);
    append(all.file.wires, part.file.wires);
    append(all.file.switches, part.file.switches);
    append(all.file.barriers, part.file.barriers);
    append(all.file.expectations, part.file.expectations);
    append(all.programs, part.programs);
  }
  return all;
}

// From the first output of each part's first station to an input of the next part's that nothing holds.
void wire_parts(PlantInput& all, const std::vector<PlantInput>& parts) {
  std::vector<std::string> firsts;
  for (size_t n = 0; n < parts.size(); ++n) firsts.push_back(fmt::format("p{}{}", n, parts[n].file.stations.front().name));
  for (size_t n = 0; n + 1 < firsts.size(); ++n) {
    runtime::Wire wire;
    wire.from = {firsts[n], runtime::SignalKind::Output, "DO01", 1};
    wire.to = {firsts[n + 1], runtime::SignalKind::Input, "DI02", 2};
    all.file.wires.push_back(wire);
  }
}

struct Seen {
  uint64_t hash = 0;
  std::vector<uint64_t> digests{};
  std::vector<std::string> journal{};
  std::vector<std::pair<bool, int32_t>> results{};
  bool operator==(const Seen&) const = default;
};

// `hashed`: looks at each millisecond; else nobody looks for 50 ms.
Seen run(const PlantInput& input, unsigned threads, bool hashed, Time duration) {
  runtime::Execution execution = tools::execution_of();
  execution.threads = threads;
  const auto plant = tools::make_plant(input, runtime::FileUse::Look, {}, execution);
  Seen seen;
  if (hashed) {
    runtime::TraceHash hash(*plant, kMillisecond);
    plant->run_until(duration, [&](Time now) { return hash.sample(now), true; });
    seen.hash = hash.value();
  }
  while (plant->now() < duration) {
    plant->run_until(plant->now() + 50 * kMillisecond);
    seen.digests.push_back(runtime::state_digest(*plant));
  }
  for (const auto& entry : plant->journal().entries())
    seen.journal.push_back(fmt::format("{} {}: {}", entry.time, entry.station, entry.text));
  for (const auto& result : plant->results()) seen.results.emplace_back(result.met, result.actual);
  return seen;
}

size_t islands_of(const PlantInput& input, unsigned threads) {
  runtime::Execution execution = tools::execution_of();
  execution.threads = threads;
  return tools::make_plant(input, runtime::FileUse::Look, {}, execution)->islands().count();
}

void expect_same(const PlantInput& input, const std::string& what) {
  constexpr Time kTime = 400 * kMillisecond;
  for (const bool hashed : {false, true}) {
    Seen wanted = run(input, 0, hashed, kTime);
    for (const unsigned threads : {1U, 2U, 3U}) {
      Seen seen = run(input, threads, hashed, kTime);
      EXPECT_EQ(seen.hash, wanted.hash) << what << ", " << threads << " threads";
      EXPECT_EQ(seen.digests, wanted.digests) << what << ", " << threads << " threads, hashed " << hashed;
      EXPECT_EQ(seen.journal, wanted.journal) << what << ", " << threads << " threads, hashed " << hashed;
      EXPECT_EQ(seen.results, wanted.results) << what << ", " << threads << " threads";
    }
  }
}

TEST(Islands, OfExamples) {
  std::vector<PlantInput> inputs;
  for (const std::filesystem::path& path : example_plants()) {
    PlantInput input = read(path.string());
    const auto ported = [](const runtime::BusConfig& bus) { return !bus.port.empty(); };
    if (!input.file.machines.empty() || std::any_of(input.file.buses.begin(), input.file.buses.end(), ported)) continue;
    inputs.push_back(std::move(input));
  }
  ASSERT_GE(inputs.size(), 18U);
  for (size_t n = 0; n < inputs.size(); ++n) {
    const std::vector<PlantInput> parts{inputs[n], inputs[(n + 1) % inputs.size()], inputs[(n + 5) % inputs.size()]};
    PlantInput all = together(parts);
    EXPECT_GE(islands_of(all, 2), all.file.buses.empty() ? 1U : 2U);
    EXPECT_EQ(islands_of(all, 0), 1U);
    const std::string what = fmt::format("{}, {}, {}", parts[0].path, parts[1].path, parts[2].path);
    expect_same(all, what);
    wire_parts(all, parts);
    expect_same(all, what + ", wired");
  }
}

TEST(Islands, OfPlantsOfChance) {
  for (uint64_t seed = 1; seed <= 60; seed += 3) {
    std::vector<PlantInput> parts;
    for (uint64_t n = seed; n < seed + 3; ++n) {
      const TemporaryFolder folder;
      const ReadingPlant plant(n);
      for (const auto& [name, text] : plant.sources()) folder.write(name, text);
      parts.push_back(read(folder.write("plant.toml", plant.text())));
    }
    PlantInput all = together(parts);
    expect_same(all, fmt::format("seed {}", seed));
    wire_parts(all, parts);
    expect_same(all, fmt::format("seed {}, wired", seed));
  }
}

// A line that has something to tell before the first event: a station at another rate.
TEST(Islands, WhereAStationTakesNoPart) {
  const TemporaryFolder folder;
  const auto line = [](const char* name) {
    return fmt::format("[[bus]]\nname = '{0}'\nkind = 'can'\nbaud = 125000\n[[station]]\nname = 'of{0}'\nunit = 'mdxb'\nsbus = '{0}'\n", name);
  };
  const PlantInput one = read(folder.write("one.toml", line("a"))), two = read(folder.write("two.toml", line("a") + line("b")));
  EXPECT_EQ(islands_of(two, 2), 2U);
  expect_same(one, "one line");
  expect_same(two, "two lines");
}

// Who is on two lines joins them: by both SBuses of a unit, as a gateway, by SBus and RS-485. Who is on no line is an island with the others.
TEST(Islands, AreWhatNobodyJoins) {
  const TemporaryFolder folder;
  const auto count = [&](const std::string& text) {
    return islands_of(read(folder.write("plant.toml", text)), 4);
  };
  const auto bus = [](const char* name, const char* kind = "can") { return fmt::format("[[bus]]\nname = '{}'\nkind = '{}'\n", name, kind); };
  const auto station = [](const char* name, const std::string& keys) { return fmt::format("[[station]]\nname = '{}'\nunit = 'mdxb'\n{}", name, keys); };
  const std::string two = bus("a") + bus("b") + station("x", "sbus = 'a'\n");
  EXPECT_EQ(count(two + station("y", "sbus = 'b'\n")), 2U);
  EXPECT_EQ(count(two + station("y", "sbus = 'b'\nsbus2 = 'a'\n")), 1U);
  EXPECT_EQ(count(two + station("y", "") + station("z", "")), 3U);
  EXPECT_EQ(count(station("y", "") + station("z", "")), 1U);
  EXPECT_EQ(count(bus("a") + bus("s", "rs485") + station("x", "sbus = 'a'\nrs485 = 's'\n") + station("y", "")), 2U);
}

}  // namespace
}  // namespace ipos::tests

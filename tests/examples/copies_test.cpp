// A plant that is built again of what was read once, with what is made of its programs shared, runs as one that is read alone: to the
// trace hash over every millisecond, also after one in trouble, and where units or speeds differ.
#include <gtest/gtest.h>

#include "runtime/plant/trace_hash.hpp"
#include "runtime/unit/program_shelf.hpp"
#include "tests/examples/plants.hpp"
#include "tools/input/plant_input.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using tools::PlantInput;

runtime::Execution with_shelf(std::shared_ptr<runtime::ProgramShelf> shelf) {
  runtime::Execution execution = tools::execution_of();
  execution.shelf = std::move(shelf);
  return execution;
}

std::unique_ptr<runtime::Plant> build(PlantInput input, const runtime::Execution& execution, std::optional<vm::Rates> rates = {}) {
  return tools::make_plant(std::move(input), runtime::FileUse::Look, rates, execution);
}

uint64_t hash_of(runtime::Plant& plant, runtime::Time duration) {
  runtime::TraceHash hash(plant, kMillisecond);
  plant.run_until(duration, [&](runtime::Time now) { return hash.sample(now), true; });
  return hash.value();
}

// Faults, power, a stopped program, a program memory that is changed.
void run_in_trouble(runtime::Plant& plant) {
  const auto each = [&](runtime::Time at, const std::function<void(runtime::Station&)>& act) {
    plant.run_until(at * kMillisecond);
    for (const auto& station : plant.stations()) act(*station);
  };
  each(50, [](runtime::Station& one) { one.drive().state().raise_fault(26); });
  each(80, [](runtime::Station& one) { one.drive().state().reset_fault(); });
  each(100, [&](runtime::Station& one) { plant.set_power(one.config().name, false); });
  each(120, [&](runtime::Station& one) { plant.set_power(one.config().name, true); });
  each(150, [](runtime::Station& one) {
    one.stop_program();
    one.drive().parameters().execute(stdlib::Service::Write, 16'002, 0);
    one.start_program();
  });
  plant.run_until(250 * kMillisecond);
}

TEST(Copies, OfEveryExampleRunAsTheFirst) {
  constexpr runtime::Time kTime = 500 * kMillisecond;
  const vm::Rates slow{{3, 2, 1}};
  const auto shelf = std::make_shared<runtime::ProgramShelf>();
  const runtime::Execution alone = with_shelf(nullptr), shared = with_shelf(shelf);
  size_t compared = 0;
  for (const std::filesystem::path& path : example_plants()) {
    const PlantInput input = tools::read_plant_input(path.string(), {});
    if (!input.file.machines.empty()) continue;  // their FMUs have to be allowed
    const uint64_t wanted = hash_of(*build(input, alone), kTime);
    EXPECT_EQ(hash_of(*build(input, shared), kTime), wanted) << path;
    EXPECT_EQ(hash_of(*build(input, shared), kTime), wanted) << path;
    run_in_trouble(*build(input, shared));
    EXPECT_EQ(hash_of(*build(input, shared), kTime), wanted) << path << " after one in trouble";
    EXPECT_EQ(hash_of(*build(input, shared, slow), kTime), hash_of(*build(input, alone, slow), kTime)) << path << " slower";
    ++compared;
  }
  EXPECT_GE(compared, 18U);
}

// What is made of a program depends on the unit: the same words may be refused by another one.
TEST(Copies, OfOneProgramOnDifferentUnitsAreApart) {
  const TemporaryFolder folder;
  folder.write("A.IPC", "main() { while (1) H10 = H10 + 1; }\n");
  const auto input = [&](const char* unit) {
    return tools::read_plant_input(folder.write(std::string(unit) + ".toml", std::string("[[station]]\nname = \"a\"\nunit = \"") + unit + "\"\nprogram = \"A.IPC\"\n"), {});
  };
  const PlantInput small = input("md60a"), large = input("mdxb");
  const auto shelf = std::make_shared<runtime::ProgramShelf>();
  for (const PlantInput& one : {large, small, large, small}) {
    PlantInput same = one;
    same.programs = large.programs;  // the very words
    EXPECT_EQ(hash_of(*build(same, with_shelf(shelf)), 100 * kMillisecond), hash_of(*build(same, with_shelf(nullptr)), 100 * kMillisecond));
  }
}

}  // namespace
}  // namespace ipos::tests

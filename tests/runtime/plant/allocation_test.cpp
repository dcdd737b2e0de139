// Once everything runs, a plant takes no memory of the heap: over SBus, CANopen and PROFIBUS-DP. (A telegram over RS-485 takes
// one piece for its bits, a unit of FMS some.) The plants are examples; nothing happens in the second that is counted but
// what happens in every second.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/harness/allocations.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Row {
  const char* bus;
  const char* folder;
  const char* plant;
  runtime::Time from;  // everything has begun
};

class Allocations : public ::testing::TestWithParam<Row> {};

TEST_P(Allocations, ARunningPlantMakesNone) {
  const fs::path folder = fs::path(IPOS_SOURCE_DIR) / "examples" / GetParam().folder;
  std::map<std::string, std::string> programs;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".IPC") programs[entry.path().filename().string()] = text_of(entry.path());
  const auto plant = make_plant(text_of(folder / GetParam().plant), programs);
  ASSERT_TRUE(plant);
  plant->run_until(GetParam().from);
  const size_t before = allocations();
  plant->run_until(GetParam().from + runtime::kSecond);
  EXPECT_EQ(allocations() - before, 0U) << GetParam().bus;
}

std::string name_of(const ::testing::TestParamInfo<Row>& row) {
  return row.param.bus;
}
INSTANTIATE_TEST_SUITE_P(Buses, Allocations,
                         ::testing::Values(Row{"SBus", "scom", "scom.toml", ms(2000)}, Row{"CANopen", "canopen", "canopen.toml", ms(2000)},
                                           Row{"PROFIBUS", "profibus", "profibus.toml", ms(1300)},
                                           Row{"RS485", "movilink-rs485", "rs485.toml", ms(2000)},
                                           Row{"gateway", "gateway", "gateway.toml", ms(3000)}),
                         name_of);

}  // namespace
}  // namespace ipos::tests

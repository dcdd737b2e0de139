// Once everything runs, a plant takes no memory of the heap: over SBus, CANopen, PROFIBUS-DP, RS-485 and a gateway. (Units of FMS
// take some.) The plants are examples; nothing happens in the second that is counted but what happens in every second.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "runtime/bus/rs485/levels.hpp"
#include "runtime/bus/rs485/line.hpp"
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

// As what comes in at a real port: each character is a transmission of bits that were made elsewhere.
TEST(AllocationsOfALine, KeepLittleOfBitsFromOutside) {
  struct Silent final : runtime::SerialNode {
    void on_character(runtime::Time, const runtime::Character&) override {}
    void on_sent(runtime::Time) override {}
  } sender, hearer;
  runtime::EventQueue queue;
  runtime::Rs485Line line(queue, 0, "line", 9600);
  const runtime::NodeId node = line.attach("sender", 9600, sender);
  line.attach("hearer", 9600, hearer);
  constexpr size_t kBegin = 100;
  std::vector<std::vector<bool>> characters(10 * kBegin, runtime::wire_bits(std::vector<uint8_t>{0x55}));
  size_t before = 0;
  for (size_t n = 0; n < characters.size(); ++n) {
    if (n == kBegin) before = allocations();
    ASSERT_TRUE(line.send_bits(node, std::move(characters[n])));
    queue.run_until(queue.now() + ms(2));
  }
  EXPECT_EQ(allocations() - before, 0U);
}

}  // namespace
}  // namespace ipos::tests

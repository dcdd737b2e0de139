// Once everything runs, a plant takes no memory of the heap: over SBus, CANopen, PROFIBUS-DP and FMS, RS-485 and a gateway. The
// plants are examples, and one of FMS; nothing happens in the time that is counted but what happens in every second.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

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

// FMS beside DP: what a panel asks again and again, of the inverter and of its card, on acyclic connections and on a cyclic one,
// which is kept alive every ten seconds; some of it is refused.
TEST(AllocationsOfFms, ARunningPlantMakesNone) {
  std::string text = R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[station]]
name = "inv"
unit = "mc31"
option = "ffp31"
profibus = "dp"
profibus_address = 8
[station.parameters]
P841 = "FIELDBUS"
[station.inputs]
DI00 = 1
[[control]]
name = "plc"
profibus = "dp"
[[control.slave]]
address = 8
cfg = "F2"
po = [6, 1500]
[[control]]
name = "panel"
kind = "fms"
profibus = "dp"
)";
  const std::pair<int, std::vector<const char*>> kAsked[] = {
      {7, {"read = 1025", "write = 1025\ndata = '00 00 09 50'", "read = 991", "write = 990\ndata = '00 06 05 DC 00 00'", "ov = 1025", "status = true"}},
      {8, {"read = 995", "read = 997", "write = 999\ndata = '04 01 00 01 00 00 00 00'", "read = 1999", "write = 998\ndata = '04 01 00 01'"}},
      {2, {"read = 1025"}}};
  for (const auto& [connection, requests] : kAsked) {
    text += fmt::format("[[control.slave]]\naddress = 8\nconnection = {}\n", connection);
    for (const char* request : requests)
      text += fmt::format("[[control.slave.request]]\nat = '1500ms'\nevery = '{}'\n{}\n", connection == 2 ? "60s" : "150ms", request);
  }
  const auto plant = make_plant(text, {});
  ASSERT_TRUE(plant);
  plant->run_until(ms(4000));
  const size_t notes = plant->journal().entries().size();
  const size_t before = allocations();
  plant->run_until(ms(24'000));
  EXPECT_EQ(allocations() - before, 0U);
  EXPECT_EQ(plant->journal().entries().size(), notes) << "the same answer is told once";
  std::string told;
  for (const auto& entry : plant->journal().entries()) told += entry.text + "\n";
  for (const char* asked : {"connection 7, Read 1025: ", "connection 8, Read 995: ", "connection 2, Read 1025: "})
    EXPECT_NE(told.find(asked), std::string::npos) << asked << "\n" << told;
}

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

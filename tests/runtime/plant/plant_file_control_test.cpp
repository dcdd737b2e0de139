// [[control]] of the plant file: masters on an SBus, of MOVILINK and of CANopen. What is left out is the default of
// docs/guide/plant-file.md.
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;

const std::string kControlLine =
    "[[station]]\nname = 'u'\nunit = 'mdxb'\n[[bus]]\nname = 'b'\nkind = 'can'\n";
const std::string kSbusControl = kControlLine + "[[control]]\nname = 'c'\nsbus = 'b'\n";

ControlConfig sbus_control(const std::string& text) { return read_plant(kSbusControl + text).controls.at(0); }
const ControlSettings& settings_of(const ControlConfig& control) { return std::get<ControlSettings>(control.kind); }

TEST(PlantFileControl, OfAnSbus) {
  const ControlConfig none = sbus_control("");
  EXPECT_EQ(std::tuple(none.name, none.sbus, none.place.line), std::tuple("c", "b", 7U));
  EXPECT_FALSE(none.terminator || settings_of(none).sync_id);
  EXPECT_EQ(settings_of(none).cycle, 5 * kMillisecond);
  EXPECT_TRUE(settings_of(none).targets.empty());
  const ControlConfig full = sbus_control(R"(kind = 'sbus'
sync = 2047
cycle = '5001us'
terminator = true
[[control.target]]
address = 63
[[control.target]]
group = 50
every = '1ms'
po = [0xFFFF, -32768]
[[control.target]]
address = 0
every = '2ms'
po = [1, 2, 3]
)");
  EXPECT_EQ(full.terminator, true);
  EXPECT_EQ(settings_of(full).sync_id, 2047);
  EXPECT_EQ(settings_of(full).cycle, 5'001 * kMicrosecond);
  const auto& targets = settings_of(full).targets;
  ASSERT_EQ(targets.size(), 3U);
  EXPECT_EQ(std::tuple(targets[0].address, targets[0].group, targets[0].every, targets[0].output),
            std::tuple(63, false, 0, ProcessWords{}));
  EXPECT_EQ(std::tuple(targets[1].address, targets[1].group, targets[1].every, targets[1].output),
            std::tuple(50, true, kMillisecond, ProcessWords{0xFFFF, 0x8000, 0}));
  EXPECT_EQ(std::tuple(targets[2].address, targets[2].group, targets[2].every, targets[2].output),
            std::tuple(0, false, 2 * kMillisecond, ProcessWords{1, 2, 3}));
  EXPECT_EQ(settings_of(sbus_control("sync = 0\n")).sync_id, 0);
}

TEST(PlantFileControl, MistakesOfAnSbus) {
  const std::string target = "[[control.target]]\n";
  expect_mistakes(
      kSbusControl,
      {
          {"^node = 1\n", "unknown key 'node' in [[control]]; known are name, kind, sbus, sync, cycle"},
          {"kind = ^'can'\n", "'can' is no kind of control; known are sbus, canopen, fms"},
          {"sync = ^2048\n", "sync is 0 to 2047"},
          {"cycle = ^'4999us'\n", "a sync cycle has at least 5ms"},
          {"cycle = ^'soon'\n", "'soon' is no time"},
          {"terminator = ^1\n", "terminator is true or false"},
          {"target = ^5\n", "write [[target]], one for each"},
          {target + "^node = 1\naddress = 1\nevery = '1ms'\n", "unknown key 'node' in [[control.target]]"},
          {"^" + target + "every = '1ms'\n", "needs address = ... or group = ..."},
          {"^" + target + "address = 1\ngroup = 1\nevery = '1ms'\n", "needs address = ... or group = ..."},
          {target + "address = ^64\nevery = '1ms'\n", "address is 0 to 63"},
          {target + "group = ^64\nevery = '1ms'\n", "group is 0 to 63"},
          {"sync = 0\n" + target + "address = 1\nevery = ^'0ms'\n", "every must be more than 0"},
          {"sync = 0\n^" + target + "group = 1\n", "group process data need every"},
          {target + "address = 1\nevery = '1ms'\npo = ^[1, 2, 3, 4]\n", "there are three process data words"},
          {target + "address = 1\nevery = '1ms'\npo = [1, ^65536, ^-32769]\n",
           "a process data word has 16 bits"},
          {target + "address = 1\nevery = '1ms'\npo = [^'1', 2, ^1.5]\n",
           "a process data word must be a whole number"},
          {target + "address = 1\nevery = '1ms'\npo = ^5\n", "po is a list of up to three numbers"},
      });
  expect_mistakes(kControlLine, {{"^[[control]]\nname = 'c'\nsbus = 'b'\n" + target + "address = 1\n",
                                  "a target without every = ... is synchronous and needs sync"},
                                 {"^[[control]]\nname = 'c'\n", "a [[control]] needs sbus"},
                                 {"^[[control]]\nsbus = 'b'\n", "a [[control]] needs name"},
                                 {"[[control]]\nname = 'c'\nsbus = ^'x'\n", "there is no bus 'x'"},
                                 {"^[[control]]\nname = 'u'\nsbus = 'b'\n", "there are two of station 'u'"}});
}

// Controls are masters in the order of the file, gateways among them.
TEST(PlantFileControl, StandInTheOrderOfTheFile) {
  const PlantFile plant = read_plant(R"([[control]]
name = 'first'
sbus = 'b'
[[station]]
name = 'u'
unit = 'mdxb'
[[station]]
name = 'second'
unit = 'gateway'
profibus = 'p'
profibus_address = 5
sbus = 'b'
[[control]]
name = 'third'
sbus = 'b'
[[bus]]
name = 'b'
kind = 'can'
[[bus]]
name = 'p'
kind = 'profibus'
)");
  ASSERT_EQ(plant.controls.size(), 3U);
  EXPECT_EQ(std::tuple(plant.controls[0].name, plant.controls[1].name, plant.controls[2].name),
            std::tuple("first", "second", "third"));
  EXPECT_EQ(plant.stations.size(), 1U);
}

const std::string kCanopenMaster = kSbusControl + "kind = 'canopen'\n";
const std::string kCanopenNode = kCanopenMaster + "[[control.target]]\naddress = 5\n";

canopen::NodePlan canopen_node(const std::string& text) {
  return std::get<canopen::MasterSettings>(read_plant(kCanopenNode + text).controls.at(0).kind).nodes.at(0);
}

TEST(PlantFileCanopen, OfTheMaster) {
  const ControlConfig config = read_plant(kCanopenMaster).controls.at(0);
  EXPECT_EQ(config.sbus, "b");
  EXPECT_FALSE(config.terminator);
  const canopen::MasterSettings none = std::get<canopen::MasterSettings>(config.kind);
  EXPECT_EQ(std::tuple(none.node, none.heartbeat, none.sync_cycle, none.nodes.size()),
            std::tuple(127, 0, 5 * kMillisecond, 0U));
  const ControlConfig other = read_plant(kCanopenMaster + R"(
node = 0
cycle = '0ms'
heartbeat = '32767ms'
terminator = false
[[control.target]]
address = 127
[[control.target]]
address = 1
)")
                                  .controls.at(0);
  EXPECT_EQ(other.terminator, false);
  const canopen::MasterSettings full = std::get<canopen::MasterSettings>(other.kind);
  EXPECT_EQ(std::tuple(full.node, full.heartbeat, full.sync_cycle), std::tuple(0, 32'767, 0));
  ASSERT_EQ(full.nodes.size(), 2U);
  EXPECT_EQ(std::pair(full.nodes[0].node, full.nodes[1].node), std::pair(uint8_t{127}, uint8_t{1}));
}

TEST(PlantFileCanopen, OfItsNodes) {
  const canopen::NodePlan none = canopen_node("");
  EXPECT_EQ(std::tuple(none.node, none.guard_time, none.life_factor, none.heartbeat, none.output),
            std::tuple(5, 0, 0, 0, canopen::Words{}));
  EXPECT_TRUE(none.pdos.empty() && none.writes.empty());
  const canopen::NodePlan guarded =
      canopen_node("guard = '65535ms'\npo = [-32768, 65535, 3, 4, 5, 6, 7, 8, 9, 10]\n");
  EXPECT_EQ(std::pair(guarded.guard_time, guarded.life_factor), std::pair(uint16_t{65'535}, uint8_t{3}));
  EXPECT_EQ(guarded.output, (canopen::Words{0x8000, 0xFFFF, 3, 4, 5, 6, 7, 8, 9, 10}));
  EXPECT_EQ(canopen_node("guard = '1ms'\nlife = 255\n").life_factor, 255);
  EXPECT_EQ(canopen_node("life = 0\nguard = '1ms'\n").life_factor, 0);
  EXPECT_EQ(canopen_node("heartbeat = '50ms'\n").heartbeat, 50);
  // P130 is 8470 and P131 is 8471, in milliseconds (1053 1610 p. 92).
  const canopen::NodePlan writes = canopen_node("[control.target.parameters]\nP130 = '1 s'\n8471 = 500\n");
  ASSERT_EQ(writes.writes.size(), 2U);
  const canopen::SdoWrite number{{8471, 0}, 500, 4}, text{{8470, 0}, 1'000, 4};
  EXPECT_TRUE(std::find(writes.writes.begin(), writes.writes.end(), number) != writes.writes.end());
  EXPECT_TRUE(std::find(writes.writes.begin(), writes.writes.end(), text) != writes.writes.end());
}

TEST(PlantFileCanopen, OfItsPdos) {
  const auto pdo = [](const std::string& text) {
    return canopen_node("[[control.target.pdo]]\n" + text).pdos.at(0);
  };
  const canopen::PdoPlan none = pdo("map = []\n");
  EXPECT_EQ(std::tuple(none.number, none.transmit, none.type, none.inhibit, none.event),
            std::tuple(0, false, 1, 0, 0));
  EXPECT_TRUE(none.mapping.empty());
  const canopen::PdoPlan full =
      pdo("number = 4\ntransmit = true\ntype = 255\ninhibit = '100us'\nevent = '65535ms'\n"
          "map = ['PI3', 'PI1', 'PI10', 'PI2']\n");
  EXPECT_EQ(std::tuple(full.number, full.transmit, full.type, full.inhibit, full.event),
            std::tuple(3, true, 255, 1, 65'535));
  EXPECT_EQ(full.mapping,
            (canopen::Mapping{{{0x2001, 3}, 16}, {{0x2001, 1}, 16}, {{0x2001, 10}, 16}, {{0x2001, 2}, 16}}));
  EXPECT_EQ(pdo("map = []\ntype = 0\ninhibit = '6553500us'\n").inhibit, 65'535);
  for (uint8_t n = 1; n <= 10; ++n)
    EXPECT_EQ(pdo("map = ['PO" + std::to_string(n) + "']\n").mapping, (canopen::Mapping{{{0x2000, n}, 16}}));
}

TEST(PlantFileCanopen, MistakesOfTheMaster) {
  const std::string target = "[[control.target]]\n";
  expect_mistakes(kCanopenMaster,
                  {
                      {"^sync = 1\n", "unknown key 'sync' in [[control]]"},
                      {"node = ^128\n", "node is 0 to 127"},
                      {"cycle = ^'soon'\n", "'soon' is no time"},
                      {"heartbeat = ^'32768ms'\n", "the nodes await twice this time: at most 32767 ms"},
                      {"heartbeat = ^'65536ms'\n", "heartbeat is a multiple of 1000 us up to 65535000 us"},
                      {"heartbeat = ^'1500us'\n", "heartbeat is a multiple of 1000 us"},
                      {"^" + target, "a [[control.target]] needs address"},
                      {target + "address = ^0\n", "address is 1 to 127"},
                      {target + "address = ^128\n", "address is 1 to 127"},
                      {target + "address = 5\n^" + target + "address = 5\n", "node 5 is a target already"},
                  });
  expect_mistakes(kControlLine,
                  {{"^[[control]]\nname = 'c'\nkind = 'canopen'\n", "a [[control]] needs sbus"}});
}

TEST(PlantFileCanopen, MistakesOfItsNodes) {
  const std::string pdo = "[[control.target.pdo]]\n";
  expect_mistakes(
      kCanopenNode,
      {
          {"^group = 1\n", "unknown key 'group' in [[control.target]]"},
          {"po = ^5\n", "po is a list of up to ten numbers"},
          {"po = ^[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11]\n", "po is a list of up to ten numbers"},
          {"po = [^65536, ^-32769, 1]\n", "a process data word has 16 bits"},
          {"po = [1, ^'2']\n", "a process data word must be a whole number"},
          {"guard = ^'1001us'\n", "guard is a multiple of 1000 us up to 65535000 us"},
          {"guard = ^'65536ms'\n", "guard is a multiple of 1000 us up to 65535000 us"},
          {"guard = ^'1500us'\nheartbeat = '1ms'\n", "guard is a multiple"},
          {"life = ^256\n", "life is 0 to 255"},
          {"guard = '1ms'\nheartbeat = ^'1ms'\n", "a node has guarding or heartbeat, never both"},
          {"parameters = ^5\n", "write [station.parameters]"},
          {"[control.target.parameters]\n^P999 = 1\n", "unit mdxb has no parameter 'P999'"},
          {"[control.target.parameters]\nP130 = ^'1 rpm'\n", "P130"},
          {"pdo = ^5\n", "write [[pdo]], one for each"},
          {pdo + "map = []\n^sync = 1\n", "unknown key 'sync' in [[control.target.pdo]]"},
          {"^" + pdo, "needs map = [...]"},
          {pdo + "map = []\nnumber = ^0\n", "number is 1 to 4"},
          {pdo + "map = []\nnumber = ^5\n", "number is 1 to 4"},
          {pdo + "map = []\ntype = ^256\n", "type is 0 to 255"},
          {pdo + "map = []\ninhibit = ^'50us'\n", "inhibit is a multiple of 100 us up to 6553500 us"},
          {pdo + "map = []\ninhibit = ^'6553600us'\n", "inhibit is a multiple of 100 us up to 6553500 us"},
          {pdo + "map = []\nevent = ^'500us'\n", "event is a multiple of 1000 us"},
          {pdo + "map = [^'PI1', ^'PO0', ^'PO11', ^'PO', ^5, 'PO1']\n",
           "a node receives carries PO1 to PO10"},
          {pdo + "transmit = true\nmap = [^'PO1', ^'PI11', 'PI1']\n", "a node transmits carries PI1 to PI10"},
          {pdo + "map = ^['PO1', 'PO2', 'PO3', 'PO4', 'PO5']\n", "a PDO carries at most four words"},
      });
}

}  // namespace
}  // namespace ipos::runtime

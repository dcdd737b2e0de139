// The model master with three nodes on one line: bring-up, remapping, ten thousand SYNC cycles, what is refused and
// who stays away.
#include "runtime/bus/canopen/master.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/node_rig.hpp"

namespace ipos::tests {
namespace {

using Phase = Master::Phase;

struct MasterRig {
  explicit MasterRig(MasterSettings settings, std::vector<uint8_t> numbers = {1, 2, 3})
      : master(queue, 8, std::move(settings)), port(line, line.attach("master", line.baud(), master)) {
    for (const uint8_t number : numbers)
      stations.push_back(std::make_unique<Station>(queue, number, line, number));
  }
  void power_on() {
    for (const auto& station : stations) station->node.start(queue.now());
    master.start(queue.now(), port);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }

  EventQueue queue;
  CanLine line{queue, 9, "sbus", 1'000'000};
  Master master;
  LinePort port;
  std::vector<std::unique_ptr<Station>> stations;
};

NodePlan plan(uint8_t node) {
  NodePlan plan;
  plan.node = node;
  return plan;
}

TEST(CanopenMaster, OrderOfARemapping) {
  const PdoPlan pdo{1, true, 254, 100, 50, {{{0x2001, 4}, 16}, {{0x2001, 5}, 16}}};
  EXPECT_EQ(remapping(pdo, 5), (std::vector<SdoWrite>{{{0x1801, 1}, 0x8000'0285, 4},
                                                      {{0x1801, 2}, 254, 1},
                                                      {{0x1801, 3}, 100, 2},
                                                      {{0x1801, 5}, 50, 2},
                                                      {{0x1A01, 0}, 0, 1},
                                                      {{0x1A01, 1}, 0x2001'0410, 4},
                                                      {{0x1A01, 2}, 0x2001'0510, 4},
                                                      {{0x1A01, 0}, 2, 1},
                                                      {{0x1801, 1}, 0x0000'0285, 4}}));
}

// Setpoints of cycle n act in all nodes at the SYNC of cycle n + 1, at one moment; each answers each SYNC.
TEST(CanopenMaster, TenThousandSyncCyclesWithThreeNodes) {
  PROVES("MDB-TOC-09", "MDB-TOC-10", "MDB-TOC-11");
  MasterSettings settings;
  settings.sync_cycle = 5 * kMillisecond;
  for (const uint8_t node : {uint8_t{1}, uint8_t{2}, uint8_t{3}}) settings.nodes.push_back(plan(node));
  // The second one also sends four words at every third SYNC, the third one takes PO4 by a PDO of its own.
  settings.nodes[1].pdos.push_back(
      {1, true, 3, 0, 0, {{{0x2001, 7}, 16}, {{0x2001, 8}, 16}, {{0x2001, 9}, 16}, {{0x2001, 10}, 16}}});
  settings.nodes[2].pdos.push_back({1, false, 1, 0, 0, {{{0x2000, 4}, 16}}});
  MasterRig rig(settings);
  rig.power_on();
  rig.run(500 * kMillisecond);
  for (size_t n = 0; n < 3; ++n) {
    ASSERT_EQ(rig.master.report(n).phase, Phase::Running) << n;
    EXPECT_EQ(rig.stations[n]->node.state(), State::Operational);
  }
  rig.run(7 * kMillisecond - rig.queue.now() % (5 * kMillisecond));  // in the middle of a cycle
  for (const auto& station : rig.stations) station->unit.taken.clear();
  const std::array<uint64_t, 3> before = {rig.master.report(0).pdos, rig.master.report(1).pdos,
                                          rig.master.report(2).pdos};
  const uint64_t syncs = rig.master.syncs();
  constexpr uint64_t kCycles = 10'000;
  for (uint64_t cycle = 0; cycle < kCycles; ++cycle) {
    for (size_t n = 0; n < 3; ++n) {
      const auto word = static_cast<uint16_t>(cycle * 3 + n);
      rig.master.set_output(n, {6, word, 0, static_cast<uint16_t>(~word)});
      rig.stations[n]->unit.inputs = {7, word};
    }
    rig.run(5 * kMillisecond);
    for (size_t n = 0; n < 3; ++n) {
      ASSERT_EQ(rig.master.report(n).input[1], static_cast<uint16_t>(cycle * 3 + n)) << cycle;
      if (cycle > 0) {
        ASSERT_EQ(rig.stations[n]->unit.outputs[1], static_cast<uint16_t>(cycle * 3 + n - 3)) << cycle;
      }
      if (cycle > 0 && n == 2) {
        ASSERT_EQ(rig.stations[n]->unit.outputs[3], static_cast<uint16_t>(~(cycle * 3 + n - 3)));
      }
    }
  }
  EXPECT_EQ(rig.master.syncs() - syncs, kCycles);
  EXPECT_EQ(rig.master.report(0).pdos - before[0], kCycles);
  const uint64_t second = rig.master.report(1).pdos - before[1];
  EXPECT_TRUE(second == kCycles + kCycles / 3 || second == kCycles + kCycles / 3 + 1) << second;
  EXPECT_EQ(rig.master.report(2).pdos - before[2], kCycles);
  // At the same SYNC, to the nanosecond.
  EXPECT_EQ(rig.stations[0]->unit.taken, rig.stations[1]->unit.taken);
  EXPECT_EQ(rig.stations[0]->unit.taken.size(), kCycles);
  EXPECT_EQ(rig.stations[2]->unit.taken.size(), 2 * kCycles);
  EXPECT_EQ(rig.stations[2]->unit.taken.front(), rig.stations[0]->unit.taken.front());
  for (const auto& station : rig.stations) {
    EXPECT_TRUE(station->ignored.empty());
    EXPECT_EQ(station->foreign, 0);
  }
}

TEST(CanopenMaster, ParametersAndWhatIsRefused) {
  MasterSettings settings;
  settings.nodes = {plan(1), plan(2), plan(3)};
  settings.nodes[0].writes = {{{8318, 0}, 1234, 4}};
  settings.nodes[1].writes = {{{9999, 0}, 1, 4}};
  MasterRig rig(settings, {1, 2});
  rig.power_on();
  rig.run(kSecond);
  EXPECT_EQ(rig.stations[0]->unit.parameters[8318], 1234);
  EXPECT_EQ(rig.master.report(0).phase, Phase::Running);
  EXPECT_EQ(rig.master.report(1).phase, Phase::Refused);
  EXPECT_EQ(rig.master.report(1).refused, (Address{9999, 0}));
  EXPECT_EQ(rig.master.report(1).abort, 0x0602'0000U);
  EXPECT_EQ(rig.stations[1]->node.state(), State::PreOperational);
  EXPECT_EQ(rig.master.report(2).phase, Phase::Silent);
}

TEST(CanopenMaster, GuardsAndListens) {
  MasterSettings settings;
  settings.heartbeat = 50;
  settings.nodes = {plan(1), plan(2)};
  settings.nodes[0].guard_time = 20;
  settings.nodes[0].life_factor = 3;
  settings.nodes[1].heartbeat = 30;
  MasterRig rig(settings, {1, 2});
  rig.power_on();
  rig.run(2 * kSecond);
  for (size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(rig.master.report(n).phase, Phase::Running) << n;
    EXPECT_EQ(rig.master.report(n).losses, 0U);
    EXPECT_EQ(rig.master.report(n).state, 5);
    EXPECT_TRUE(rig.stations[n]->unit.lost.empty());
  }
  // Both nodes are cut off.
  for (size_t n = 0; n < 2; ++n) rig.line.set_connected(rig.stations[n]->port.node(), false);
  rig.run(kSecond);
  for (size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(rig.master.report(n).phase, Phase::Lost) << n;
    EXPECT_EQ(rig.master.report(n).losses, 1U) << n;
    EXPECT_EQ(rig.stations[n]->unit.lost.size(), 1U) << n;
  }
  for (size_t n = 0; n < 2; ++n) rig.line.set_connected(rig.stations[n]->port.node(), true);
  rig.run(kSecond);
  for (size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(rig.master.report(n).phase, Phase::Running) << n;
    EXPECT_EQ(rig.stations[n]->unit.back.size(), 1U) << n;
  }
}

TEST(CanopenMaster, BringsUpAgainAndHearsEmergencies) {
  MasterSettings settings;
  settings.nodes = {plan(1)};
  settings.nodes[0].writes = {{{0x1400, 2}, 255, 1}};
  MasterRig rig(settings, {1});
  rig.power_on();
  rig.run(100 * kMillisecond);
  const uint32_t boots = rig.master.report(0).boot_ups;
  rig.stations[0]->node.start(rig.queue.now());  // power off and on
  rig.run(100 * kMillisecond);
  EXPECT_EQ(rig.master.report(0).boot_ups, boots + 1);
  EXPECT_EQ(rig.master.report(0).phase, Phase::Running);
  EXPECT_EQ(rig.stations[0]->node.dictionary().value(0x1400, 2), 255U);
  rig.stations[0]->unit.state = {0x2B22, true, false};
  rig.stations[0]->node.unit_changed(rig.queue.now());
  rig.run(10 * kMillisecond);
  ASSERT_EQ(rig.master.report(0).emergencies.size(), 1U);
  EXPECT_EQ(rig.master.report(0).emergencies[0].code, 0xFF00);
  EXPECT_EQ(rig.master.report(0).emergencies[0].more, (std::array<uint8_t, 5>{0, 0x22, 0x2B, 0, 0}));
}

struct Told final : MasterObserver {
  void on_node(Time, bool wrong, std::string text) override { texts.push_back((wrong ? "! " : "") + text); }
  std::vector<std::string> texts;
};

// The master with a hand-driven node 1, frame by frame.
struct MasterBench {
  explicit MasterBench(const MasterSettings& settings)
      : master(queue, 8, settings, &told), port(line, line.attach("master", line.baud(), master)) {
    master.start(0, port);
    run(kMillisecond);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }
  void answer(const Frame& frame) {
    node.port.send(frame, 0);
    run(kMillisecond);
  }
  std::vector<Frame> heard() { return std::exchange(node.frames, {}); }

  EventQueue queue;
  CanLine line{queue, 9, "sbus", 1'000'000};
  Told told;
  Master master;
  LinePort port;
  Hand node{line, "node1"};
};

using MasterFrames = std::vector<Frame>;

// Heartbeats are one octet, the state of the master (CiA 301); nodes wait for them for twice as long.
TEST(CanopenMaster, ProducesHeartbeats) {
  MasterSettings settings;
  settings.node = 100;
  settings.heartbeat = 50;
  settings.nodes = {plan(1)};
  MasterBench bench(settings);
  const Frame heartbeat{0x764, 1, {0x05}};
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x000, 2, {0x82, 0}}, heartbeat}));
  bench.run(48 * kMillisecond);
  EXPECT_TRUE(bench.heard().empty());
  bench.run(2 * kMillisecond);
  EXPECT_EQ(bench.heard(), MasterFrames{heartbeat});
  bench.run(50 * kMillisecond);
  EXPECT_EQ(bench.heard(), MasterFrames{heartbeat});
  bench.answer({0x701, 1, {0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x23, 0x16, 0x10, 0x01, 100, 0, 100, 0}}}));
}

TEST(CanopenMaster, TellsTheWayOfANode) {
  MasterSettings settings;
  settings.nodes = {plan(1)};
  settings.nodes[0].writes = {{{0x1017, 0}, 30, 2}};
  settings.nodes[0].heartbeat = 30;
  MasterBench bench(settings);
  bench.heard();
  bench.answer({0x701, 1, {0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x2B, 0x17, 0x10, 0x00, 30}}}));
  bench.answer({0x581, 8, {0x60, 0x17, 0x10, 0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x2B, 0x17, 0x10, 0x00, 30}}}))
      << "the one of its heartbeat";
  EXPECT_EQ(bench.master.report(0).phase, Phase::Configuring);
  bench.answer({0x581, 8, {0x60, 0x17, 0x10, 0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x000, 2, {0x01, 1}}}));
  EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
  bench.run(58 * kMillisecond);
  EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
  bench.run(2 * kMillisecond);
  EXPECT_EQ(bench.master.report(0).phase, Phase::Lost) << "nothing heard for 60 ms";
  bench.answer({0x701, 1, {0x7F}});
  EXPECT_EQ(bench.master.report(0).phase, Phase::Lost) << "it is not operational";
  bench.answer({0x701, 1, {0x05}});
  EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
  bench.answer({0x701, 1, {0x00}});
  bench.run(500 * kMillisecond);
  EXPECT_EQ(bench.heard().back(), (Frame{0x601, 8, {0x80, 0x17, 0x10, 0x00, 0x00, 0x00, 0x04, 0x05}}));
  EXPECT_EQ(bench.told.texts,
            (std::vector<std::string>{
                "CANopen: node 1 boots up", "CANopen: node 1 is configured and started",
                "! CANopen: node 1 is missed: no sign of life within its time",
                "CANopen: node 1 is there again", "CANopen: node 1 boots up",
                "! CANopen: node 1 does not answer over SDO: it is not started before its next boot-up"}));
  EXPECT_EQ(bench.master.report(0).losses, 2U);
}

// Guarding asks with a remote frame of one octet; an answer whose toggle bit has not changed is no sign of life.
TEST(CanopenMaster, GuardsWithTheToggleBit) {
  MasterSettings settings;
  settings.nodes = {plan(1)};
  settings.nodes[0].guard_time = 20;
  settings.nodes[0].life_factor = 2;
  MasterBench bench(settings);
  bench.answer({0x701, 1, {0x00}});
  bench.answer({0x581, 8, {0x60, 0x0C, 0x10, 0x00}});
  bench.heard();
  bench.answer({0x581, 8, {0x60, 0x0D, 0x10, 0x00}});
  const Frame asks = remote(0x701, 1);
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x000, 2, {0x01, 1}}, asks}));
  bench.answer({0x701, 1, {0x05}});
  bench.run(17 * kMillisecond);
  EXPECT_TRUE(bench.heard().empty());
  bench.run(2 * kMillisecond);
  EXPECT_EQ(bench.heard(), MasterFrames{asks}) << "20 ms after the one before";
  bench.run(10 * kMillisecond);
  bench.answer({0x701, 1, {0x85}});
  EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
  bench.run(38 * kMillisecond);
  bench.answer({0x701, 1, {0x85}});
  EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
  bench.run(kMillisecond);
  EXPECT_EQ(bench.master.report(0).phase, Phase::Lost) << "40 ms after the last answer that counted";
}

// What is due at one moment goes out one behind the other, and nothing takes the place of another kind of frame.
TEST(CanopenMaster, SyncOutputsAndHeartbeatOfOneMoment) {
  MasterSettings settings;
  settings.heartbeat = 5;
  settings.sync_cycle = 5 * kMillisecond;
  settings.nodes = {plan(1)};
  for (uint8_t pdo = 1; pdo < 4; ++pdo)
    settings.nodes[0].pdos.push_back({pdo, false, 1, 0, 0, {{{0x2000, static_cast<uint8_t>(3 + pdo)}, 16}}});
  MasterBench bench(settings);
  bench.heard();
  bench.answer({0x701, 1, {0x00}});
  for (int writes = 0; bench.master.report(0).phase == Phase::Configuring && writes < 100; ++writes)
    for (const Frame& request : bench.heard())
      if (request.id == 0x601)
        bench.answer({0x581, 8, {0x60, request.data[1], request.data[2], request.data[3]}});
  ASSERT_EQ(bench.master.report(0).phase, Phase::Running);
  bench.run(6 * kMillisecond - bench.queue.now() % (5 * kMillisecond));  // a millisecond behind a cycle
  bench.heard();
  for (int cycle = 0; cycle < 10; ++cycle) {
    bench.run(5 * kMillisecond);
    std::vector<uint32_t> ids;
    for (const Frame& frame : bench.heard()) ids.push_back(frame.id);
    EXPECT_EQ(ids, (std::vector<uint32_t>{0x080, 0x201, 0x301, 0x401, 0x501, 0x77F}));
  }
}

// Its first PDO has three words (page 54 of 11264926); one that is too short is none, and the second is off.
TEST(CanopenMaster, InputsByTheMapping) {
  MasterSettings settings;
  settings.nodes = {plan(1), plan(2)};
  settings.nodes[1].pdos.push_back({1, true, 255, 0, 0, {{{0x2001, 10}, 16}}});
  MasterBench bench(settings);
  bench.answer({0x181, 5, {1, 2, 3, 4, 5}});
  EXPECT_EQ(bench.master.report(0).pdos, 0U);
  bench.answer({0x181, 6, {1, 2, 3, 4, 5, 6}});
  EXPECT_EQ(bench.master.report(0).input, (Words{0x0201, 0x0403, 0x0605}));
  bench.answer({0x181, 8, {9, 0, 8, 0, 7, 0, 6, 0}});
  EXPECT_EQ(bench.master.report(0).input, (Words{9, 8, 7}));
  bench.answer({0x281, 8, {1, 1, 1, 1, 1, 1, 1, 1}});
  EXPECT_EQ(bench.master.report(0).pdos, 2U) << "what is not mapped is not taken";
  EXPECT_EQ(bench.master.report(1).pdos, 0U) << "of another node";
  bench.answer({0x282, 2, {0x34, 0x12}});
  EXPECT_EQ(bench.master.report(1).input[9], 0x1234);
  EXPECT_EQ(bench.master.report(1).pdos, 1U);
  bench.answer({0x181, 6, {1}, true, false});
  bench.answer({0x181, 6, {}, false, true});
  EXPECT_EQ(bench.master.report(0).pdos, 2U);
}

TEST(CanopenMaster, FramesThatMeanNothingToIt) {
  MasterSettings settings;
  settings.nodes = {plan(1)};
  MasterBench bench(settings);
  bench.heard();
  for (const Frame& frame :
       {Frame{0x701, 2, {0, 0}}, Frame{0x701, 0}, Frame{0x581, 8, {0x60}}, Frame{0x581, 7, {0x60}},
        Frame{0x081, 7, {0, 0xFF}}, Frame{0x702, 1, {0}}, Frame{0x7FF, 1, {0}}})
    bench.answer(frame);
  EXPECT_EQ(bench.master.report(0).phase, Phase::Silent);
  EXPECT_EQ(bench.master.report(0).state, std::nullopt);
  EXPECT_TRUE(bench.master.report(0).emergencies.empty());
  EXPECT_TRUE(bench.told.texts.empty());
  EXPECT_TRUE(bench.heard().empty());
  // Before its start it hears nothing.
  EventQueue queue;
  Master silent(queue, 8, settings);
  silent.on_frame(0, {0x701, 1, {0x7F}});
  EXPECT_EQ(silent.report(0).state, std::nullopt);
}

TEST(CanopenMaster, EmergenciesAndRefusalsInWords) {
  MasterSettings settings;
  settings.nodes = {plan(1)};
  settings.nodes[0].writes = {{{0x1017, 0}, 0x1234'5678, 2}, {{0x1400, 2}, 255, 1}};
  MasterBench bench(settings);
  bench.heard();
  bench.answer({0x081, 8, {0x00, 0xFF, 0x81, 9, 0x22, 0x2B, 7, 6}});
  bench.answer({0x081, 8, {0x01, 0x00, 0x81}});
  bench.answer({0x081, 8, {}});
  ASSERT_EQ(bench.master.report(0).emergencies.size(), 3U);
  EXPECT_EQ(bench.master.report(0).emergencies[0].code, 0xFF00);
  EXPECT_EQ(bench.master.report(0).emergencies[0].error_register, 0x81);
  EXPECT_EQ(bench.master.report(0).emergencies[0].more, (std::array<uint8_t, 5>{9, 0x22, 0x2B, 7, 6}));
  EXPECT_EQ(bench.master.report(0).emergencies[1].code, 1);
  bench.answer({0x701, 1, {0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x2B, 0x17, 0x10, 0x00, 0x78, 0x56}}}));
  bench.answer({0x581, 8, {0x60, 0x17, 0x10, 0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x2F, 0x00, 0x14, 0x02, 0xFF}}}));
  bench.answer({0x581, 8, {0x80, 0x00, 0x14, 0x02, 0x30, 0x00, 0x09, 0x06}});
  EXPECT_TRUE(bench.heard().empty()) << "it is not started";
  bench.run(kSecond);
  EXPECT_EQ(bench.told.texts,
            (std::vector<std::string>{
                "! CANopen: node 1 sends EMCY FF00h fault, error register 81h, status word 1 2B22h",
                "! CANopen: node 1 sends EMCY 0001h, error register 81h",
                "CANopen: node 1 sends EMCY gone, error register 00h", "CANopen: node 1 boots up",
                "! CANopen: node 1 refuses to write 1400h:2 RPDO1 transmission type: value not allowed "
                "(06090030h); it is not started"}));
  EXPECT_EQ(bench.master.report(0).phase, Phase::Refused);
  // The next boot-up begins with the first write.
  bench.answer({0x701, 1, {0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x2B, 0x17, 0x10, 0x00, 0x78, 0x56}}}));
  EXPECT_EQ(bench.master.report(0).boot_ups, 2U);
}

// After a loss either value of the toggle bit is new, and so it is after a boot-up, which also ends the guarding.
TEST(CanopenMaster, TheToggleBitAfterALoss) {
  MasterSettings settings;
  settings.nodes = {plan(1)};
  settings.nodes[0].guard_time = 20;
  settings.nodes[0].life_factor = 2;
  for (const uint8_t byte : {uint8_t{0x05}, uint8_t{0x85}}) {
    MasterBench bench(settings);
    const auto bring_up = [&] {
      bench.answer({0x701, 1, {0x00}});
      bench.answer({0x581, 8, {0x60, 0x0C, 0x10, 0x00}});
      bench.answer({0x581, 8, {0x60, 0x0D, 0x10, 0x00}});
      EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
    };
    bring_up();
    bench.answer({0x701, 1, {byte}});
    bench.run(100 * kMillisecond);
    EXPECT_EQ(bench.master.report(0).phase, Phase::Lost);
    bench.answer({0x701, 1, {byte}});
    EXPECT_EQ(bench.master.report(0).phase, Phase::Running) << "though it is the bit of before";
    EXPECT_EQ(bench.master.report(0).losses, 1U);
    bench.heard();
    bench.answer({0x701, 1, {0x00}});
    bench.run(100 * kMillisecond);
    EXPECT_EQ(bench.heard(), (MasterFrames{{0x601, 8, {0x2B, 0x0C, 0x10, 0x00, 20}}}))
        << "no guarding meanwhile";
    EXPECT_EQ(bench.master.report(0).losses, 1U);
    bring_up();
    bench.answer({0x701, 1, {byte}});
    bench.run(39 * kMillisecond);
    EXPECT_EQ(bench.master.report(0).phase, Phase::Running);
  }
}

TEST(CanopenMaster, OutputsGoToWhatRuns) {
  MasterSettings settings;
  settings.sync_cycle = 5 * kMillisecond;
  settings.nodes = {plan(1), plan(2)};
  settings.nodes[0].output = {1, 2, 3};
  MasterBench bench(settings);
  bench.heard();
  bench.run(10 * kMillisecond);
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x080, 0}, {0x080, 0}})) << "none to a node that does not run";
  bench.answer({0x701, 1, {0x00}});
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x000, 2, {0x01, 1}}})) << "it has nothing to be written";
  bench.run(5 * kMillisecond);
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x080, 0}, {0x201, 6, {1, 0, 2, 0, 3, 0}}}));
  bench.master.set_output(0, {0x1234});
  bench.run(5 * kMillisecond);
  EXPECT_EQ(bench.heard(), (MasterFrames{{0x080, 0}, {0x201, 6, {0x34, 0x12}}}));
  EXPECT_EQ(bench.master.syncs(), 4U);
  // A receive PDO without a mapping is switched off.
  EXPECT_EQ(remapping({2, false, 1, 7, 7, {}}, 5), (std::vector<SdoWrite>{{{0x1402, 1}, 0x8000'0405, 4}}));
  EXPECT_EQ(remapping({3, false, 255, 7, 7, {{{0x2000, 1}, 16}}}, 127),
            (std::vector<SdoWrite>{{{0x1403, 1}, 0x8000'057F, 4},
                                   {{0x1403, 2}, 255, 1},
                                   {{0x1603, 0}, 0, 1},
                                   {{0x1603, 1}, 0x2000'0110, 4},
                                   {{0x1603, 0}, 1, 1},
                                   {{0x1403, 1}, 0x0000'057F, 4}}));
}

}  // namespace
}  // namespace ipos::tests

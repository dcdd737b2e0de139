// Master control, master/slave telegrams and the checks of a running SBus.
#include "runtime/bus/movilink/sbus_control.hpp"

#include <gtest/gtest.h>

#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/sbus_check.hpp"
#include "runtime/bus/movilink/sbus_group_master.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/sbus_rig.hpp"

namespace ipos::tests {
namespace {

class Log final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord& record) override { records.push_back(record); }
  void on_line_event(const CanLine&, const LineEvent&) override {}
  std::vector<FrameRecord> with(uint32_t id) const {
    std::vector<FrameRecord> found;
    for (const FrameRecord& record : records)
      if (record.frame.id == id) found.push_back(record);
    return found;
  }
  std::vector<FrameRecord> records;
};

class Findings final : public SbusCheckClient {
 public:
  void on_sbus_finding(Time, std::string text) override { texts.push_back(std::move(text)); }
  size_t count(const std::string& part) const {
    size_t n = 0;
    for (const std::string& text : texts) n += text.find(part) != std::string::npos ? 1 : 0;
    return n;
  }
  std::vector<std::string> texts;
};

struct Rig {
  explicit Rig(bool units_outside = false) : check(findings, units_outside) {
    line.add_observer(log);
    line.add_observer(check);
  }
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Log log;
  Findings findings;
  SbusCheck check;
};

struct Control {
  Control(Rig& rig, ControlSettings settings)
      : control(rig.queue, 8, std::move(settings)), port(rig.line, rig.line.attach("plc", 500'000, control)) {
    control.start(port);
  }
  SbusControl control;
  LinePort port;
};

ControlSettings synchronous(std::vector<uint8_t> addresses, uint16_t sync_id = 0) {
  ControlSettings settings;
  settings.sync_id = sync_id;
  for (const uint8_t address : addresses) settings.targets.push_back({address, false, {6, 5000, 0}, 0});
  return settings;
}

TEST(SbusControl, SyncTelegramsDivideTheTimeIntoCyclesOfFiveMilliseconds) {
  PROVES("SYNC-01");
  Rig rig;
  Unit a(rig.queue, 1, rig.line, "a", SlaveSettings{1, 0, 0});
  Unit b(rig.queue, 2, rig.line, "b", SlaveSettings{2, 0, 0});
  Unit c(rig.queue, 3, rig.line, "c", SlaveSettings{3, 0, 0});
  Control plc(rig, synchronous({1, 2, 3}));
  rig.queue.run_until(499 * kMillisecond);
  const std::vector<FrameRecord> syncs = rig.log.with(0);
  ASSERT_EQ(syncs.size(), 100U);
  for (size_t n = 0; n < syncs.size(); ++n) {
    EXPECT_EQ(syncs[n].frame.length, 0);
    EXPECT_EQ(rig.line.node_name(syncs[n].sender), "plc");
    const Time begin = static_cast<Time>(n) * 5 * kMillisecond;
    EXPECT_GE(syncs[n].start, begin);
    EXPECT_LT(syncs[n].end, begin + kMillisecond);
    if (n > 0) {
      EXPECT_EQ(syncs[n].start - syncs[n - 1].start, 5 * kMillisecond);
    }
  }
  for (const Unit* unit : {&a, &b, &c}) EXPECT_EQ(unit->syncs, 100);
  EXPECT_EQ(a.output_times, b.output_times);
  EXPECT_EQ(a.output_times, c.output_times);
}

TEST(SbusControl, SynchronousOutputKeepsItsWindow) {
  PROVES("SYNC-07");
  Rig rig;
  std::vector<std::unique_ptr<Unit>> units;
  std::vector<uint8_t> addresses;
  for (uint8_t n = 1; n <= 4; ++n) {
    addresses.push_back(n);
    units.push_back(
        std::make_unique<Unit>(rig.queue, n, rig.line, "u" + std::to_string(n), SlaveSettings{n, 0, 0}));
    rig.check.add_slave(0, rig.line, units.back()->port.node(), SlaveSettings{n, 0, 0});
  }
  Control plc(rig, synchronous(addresses));
  rig.queue.run_until(kSecond);
  size_t compared = 0;
  for (const FrameRecord& record : rig.log.records) {
    const auto identifier = classify_identifier(record.frame.id);
    if (!identifier || identifier->telegram != Telegram::ProcessOutputSync) continue;
    ++compared;
    EXPECT_GE(record.start % (5 * kMillisecond), 2500 * kMicrosecond);
    EXPECT_LE(record.end % (5 * kMillisecond), 4500 * kMicrosecond);
  }
  EXPECT_EQ(compared, 800U);
  EXPECT_TRUE(rig.findings.texts.empty());
  // Injected ones outside of it.
  Hand stranger(rig.line, "stranger");
  for (const Time at : {1200 * kMicrosecond, 4800 * kMicrosecond}) {
    Rig other;
    Unit unit(other.queue, 1, other.line, "unit", SlaveSettings{1, 0, 0});
    other.check.add_slave(0, other.line, unit.port.node(), SlaveSettings{1, 0, 0});
    Hand hand(other.line, "hand");
    hand.port.send({0, 0, {}, false, false}, 0);
    other.queue.run_until(at);
    hand.port.send(process_frame(13, {6, 0, 0}), 0);
    other.queue.run_until(10 * kMillisecond);
    EXPECT_EQ(other.findings.count("synchronous PO telegram 00Dh (13) of hand starts"), 1U);
  }
}

TEST(SbusControl, SynchronousAndOtherTargetsAreAnswered) {
  Rig rig;
  Unit a(rig.queue, 1, rig.line, "a", SlaveSettings{1, 7, 128});
  Unit b(rig.queue, 2, rig.line, "b", SlaveSettings{2, 7, 128});
  ControlSettings settings = synchronous({1}, 128);
  settings.targets.push_back({2, false, {6, 1, 2}, 10 * kMillisecond});
  settings.targets.push_back({7, true, {4, 0, 0}, 20 * kMillisecond});
  Control plc(rig, settings);
  rig.queue.run_until(99 * kMillisecond);
  EXPECT_EQ(plc.control.answers(0).answered, 19U);  // each PI after the next sync telegram
  EXPECT_EQ(plc.control.answers(1).answered, 10U);
  EXPECT_EQ(plc.control.answers(1).input, b.inputs);
  EXPECT_EQ(plc.control.answers(2).asked, 0U);
  EXPECT_EQ(rig.log.with(8 * 7 + 6).size(), 5U);
  EXPECT_EQ(a.channels.size(), 19U + 5);
}

TEST(SbusCheck, TwoSendersOfOneIdentifier) {
  Rig rig;
  Hand a(rig.line, "a");
  Hand b(rig.line, "b");
  for (int n = 0; n < 3; ++n) {
    a.port.send({1024, 1, {1}, false, false}, 0);
    rig.queue.run_until(rig.queue.now() + kMillisecond);
    b.port.send({1024, 1, {2}, false, false}, 0);
    rig.queue.run_until(rig.queue.now() + kMillisecond);
  }
  ASSERT_EQ(rig.findings.texts.size(), 1U);
  EXPECT_EQ(rig.findings.texts[0],
            "sbus: identifier 400h (1024) is sent by a and by b; an identifier may have one sender");
}

TEST(SbusCheck, AddressesNobodyHasAndAddressesTwoHave) {
  Rig rig;
  Hand master(rig.line, "master");
  Unit unit(rig.queue, 1, rig.line, "unit", SlaveSettings{3, 2, 0});
  rig.check.add_slave(0, rig.line, unit.port.node(), SlaveSettings{3, 2, 0});
  master.port.send({531, 8, {0x31, 0, 0x20, 0x7E}, false, false}, 0);
  master.port.send(process_frame(8 * 9 + 6, {6, 0, 0}), 0);
  rig.queue.run_until(kMillisecond);
  EXPECT_EQ(rig.findings.count("master calls address 2, which no station has; there are 3 (unit)"), 1U);
  EXPECT_EQ(rig.findings.count("master calls group address 9, which no station has; there are 2 (unit)"), 1U);
  rig.check.add_slave(0, rig.line, master.port.node(), SlaveSettings{3, 1, 0});
  EXPECT_EQ(rig.findings.count("unit and master both have SBus address 3"), 1U);
}

TEST(SbusCheck, UnitsBehindAPortAreNotCalledMissing) {
  Rig rig(true);
  Hand master(rig.line, "master");
  Unit unit(rig.queue, 1, rig.line, "unit", SlaveSettings{3, 2, 0});
  rig.check.add_slave(0, rig.line, unit.port.node(), SlaveSettings{3, 2, 0});
  master.port.send({531, 8, {0x31, 0, 0x20, 0x7E}, false, false}, 0);
  master.port.send(process_frame(8 * 9 + 6, {6, 0, 0}), 0);
  rig.queue.run_until(kMillisecond);
  EXPECT_EQ(rig.findings.count("which no station has"), 0U);
  rig.check.add_slave(0, rig.line, master.port.node(), SlaveSettings{3, 1, 0});  // two here are still two
  EXPECT_EQ(rig.findings.count("unit and master both have SBus address 3"), 1U);
}

TEST(SbusCheck, TwoMastersAtATime) {
  Rig rig;
  Hand a(rig.line, "a");
  Hand b(rig.line, "b");
  Unit one(rig.queue, 1, rig.line, "one", SlaveSettings{1, 0, 0});
  Unit two(rig.queue, 2, rig.line, "two", SlaveSettings{2, 0, 0});
  // One after the other: good.
  a.port.send({523, 8, {0x31, 0, 0x20, 0x7E}, false, false}, 0);
  rig.queue.run_until(10 * kMillisecond);
  b.port.send({531, 8, {0x31, 0, 0x20, 0x7E}, false, false}, 0);
  rig.queue.run_until(20 * kMillisecond);
  EXPECT_TRUE(rig.findings.texts.empty());
  a.port.send({523, 8, {0x31, 0, 0x20, 0x7E}, false, false}, 0);
  b.port.send({531, 8, {0x31, 0, 0x20, 0x7E}, false, false}, 0);
  rig.queue.run_until(30 * kMillisecond);
  EXPECT_EQ(rig.findings.texts,
            std::vector<std::string>{
                "sbus: a and b are masters at the same time; only one may be active in the network"});
}

// --- master/slave

class Drive final : public MasterSlaveDrive {
 public:
  ProcessWords setpoint_to_send(Time now) override {
    return {6, static_cast<uint16_t>(now / kMillisecond), 77};
  }
  void setpoint_received(Time, const ProcessWords&) override {}
  void link_lost(Time) override {}
};

TEST(MasterSlave, GroupTelegramEveryMillisecond) {
  PROVES("MS-02", "MS-07");
  Rig rig;
  Drive drive;
  Hand master(rig.line, "master");
  Unit slave(rig.queue, 2, rig.line, "slave", SlaveSettings{1, 2, 0});
  GroupMaster group(master.port, 5, drive);
  EXPECT_EQ(group.configure(2, 2, 500'000), "");
  for (int n = 0; n < 100; ++n) {
    group.tick(rig.queue.now());
    rig.queue.run_until(rig.queue.now() + kMillisecond);
  }
  ASSERT_EQ(rig.log.records.size(), 100U);  // frames on 22 only, no answers
  for (size_t n = 0; n < 100; ++n) {
    const FrameRecord& record = rig.log.records[n];
    EXPECT_EQ(record.frame.id, 22U);
    EXPECT_EQ(record.start / kMillisecond, static_cast<Time>(n));
    // Control word 1, setpoint, IPOS PO-data.
    EXPECT_EQ(process_words(record.frame), (ProcessWords{6, static_cast<uint16_t>(n), 77}));
  }
  EXPECT_EQ(slave.outputs.size(), 100U);
  EXPECT_EQ(slave.channels[0], OutputChannel::Group);
}

TEST(MasterSlave, CodesOfP750AndRates) {
  Rig rig;
  Drive drive;
  Hand hand(rig.line, "master");
  GroupMaster group(hand.port, 5, drive);
  for (int32_t code = 0; code <= 9; ++code) {
    const bool sbus = code == 2 || code == 3 || code == 5 || code == 6 || code == 8 || code == 9;
    EXPECT_EQ(group.configure(code, 2, 1'000'000), "");
    EXPECT_EQ(group.active(), sbus) << code;
  }
  for (const uint32_t baud : {125'000U, 250'000U}) {
    EXPECT_NE(group.configure(2, 2, baud).find("500 or 1000 kbaud"), std::string::npos);
    EXPECT_FALSE(group.active());
    group.tick(0);
    EXPECT_EQ(group.configure(0, 2, baud), "");
  }
  rig.queue.run_until(10 * kMillisecond);
  EXPECT_TRUE(rig.log.records.empty());
}

TEST(MasterSlave, ScalingOfTheSlave) {
  const auto speed = [](int32_t setpoint, int32_t p751) {
    return static_cast<int16_t>(scaled_for_slave({6, static_cast<uint16_t>(setpoint), 9}, p751)[1]);
  };
  EXPECT_EQ(speed(5000, 1000), 5000);
  EXPECT_EQ(speed(5000, 500), 2500);
  EXPECT_EQ(speed(5000, -1000), -5000);
  EXPECT_EQ(speed(-3, 500), -1);
  EXPECT_EQ(speed(5000, 10'000), INT16_MAX);
  EXPECT_EQ(speed(-5000, 10'000), INT16_MIN);
  EXPECT_EQ(speed(INT16_MIN, -1000), INT16_MAX);
  EXPECT_EQ(scaled_for_slave({6, 1, 9}, 0), (ProcessWords{6, 0, 9}));
}

TEST(MasterSlave, TheMasterFollowsNoGroupTelegramsAndASecondSenderIsReported) {
  Rig rig;
  SlaveSettings settings{1, 2, 0};
  settings.group_output = false;
  Unit master(rig.queue, 1, rig.line, "master", settings);
  Drive drive;
  GroupMaster group(master.port, 5, drive);
  group.configure(2, 2, 500'000);
  Hand other(rig.line, "other");
  group.tick(0);
  rig.queue.run_until(kMillisecond);
  other.port.send(process_frame(22, {0, 0, 0}), 0);
  rig.queue.run_until(2 * kMillisecond);
  EXPECT_TRUE(master.outputs.empty());
  EXPECT_EQ(master.ignored, std::vector<Ignored>{Ignored::GroupMaster});
  EXPECT_EQ(rig.findings.count("identifier 016h (22) is sent by master and by other"), 1U);
}

TEST(SbusMaster, GroupSixtyThree) {
  PROVES("SBUS-10");
  class Client final : public MovilinkClient {
   public:
    void on_exchange_done(Time, const MovilinkResult& result) override { done = result.result == 0; }
    bool done = false;
  };
  Rig rig;
  class Node final : public CanNode {
   public:
    void on_frame(Time, const Frame&) override {}
    void on_sent(Time now, const Frame&, uint64_t tag) override { master->on_sent(now, tag); }
    void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
    SbusMaster* master = nullptr;
  } node;
  LinePort port(rig.line, rig.line.attach("master", 500'000, node));
  Client client;
  SbusMaster master(rig.queue, 5, port, 9, 30 * kMillisecond, client);
  node.master = &master;
  Unit unit(rig.queue, 1, rig.line, "unit", SlaveSettings{1, 63, 0});
  ASSERT_FALSE(master.start(0, {163, 6, 2, 8470, 2500, {}}));
  rig.queue.run_until(10 * kMillisecond);
  EXPECT_TRUE(client.done);
  EXPECT_EQ(rig.log.with(1022).size(), 1U);
  EXPECT_EQ(unit.parameters[8470], 2500);
}

}  // namespace
}  // namespace ipos::tests

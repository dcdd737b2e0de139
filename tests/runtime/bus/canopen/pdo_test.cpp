// PDOs on a line: every transmission type, mapping, inhibit and event time, remote frames.
#include "runtime/bus/canopen/pdo.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/node_rig.hpp"

namespace ipos::tests {
namespace {

using Frames = std::vector<Frame>;

struct PdoRig : NodeRig {
  // Remaps TPDO or RPDO `number` to one word and switches it on.
  void map(bool transmit, uint8_t number, uint32_t entry, uint8_t type, uint32_t cob_id) {
    const uint16_t pdo = static_cast<uint16_t>((transmit ? 0x1800 : 0x1400) + number);
    const uint16_t mapping = static_cast<uint16_t>(pdo + 0x200);
    write(pdo, 1, 0x8000'0000 | cob_id, 4);
    write(pdo, 2, type, 1);
    write(mapping, 0, 0, 1);
    write(mapping, 1, entry, 4);
    write(mapping, 0, 1, 1);
    write(pdo, 1, cob_id, 4);
  }
  void set_input(size_t word, uint16_t value) {
    station.unit.inputs[word] = value;
    station.node.unit_changed(queue.now());
  }
};

// A mapping that was looked at once against one that is gone through for each PDO: words of both ways, some twice, and dummies
// of one to four bytes between them.
TEST(CanopenPdo, LayoutsDoWhatTheirMappingsSay) {
  std::mt19937 random(53);
  const auto below = [&random](uint32_t limit) { return static_cast<uint32_t>(random()) % limit; };
  for (int round = 0; round < 5000; ++round) {
    const uint16_t index = below(2) == 0 ? 0x2000 : 0x2001;
    Mapping mapping;
    while (below(6) != 0) {
      const auto bits = static_cast<uint8_t>(8U << below(3));
      const Mapped mapped = below(3) != 0 ? Mapped{{index, static_cast<uint8_t>(1 + below(10))}, 16} : Mapped{{5, 0}, bits};
      if (bits_of(mapping) + mapped.bits > kPdoBits) break;
      mapping.push_back(mapped);
    }
    const PdoLayout layout(mapping);
    EXPECT_EQ(layout.bytes() * 8U, bits_of(mapping));
    Words words{};
    for (uint16_t& word : words) word = static_cast<uint16_t>(random());
    PdoData data{};
    for (uint8_t& byte : data) byte = static_cast<uint8_t>(random());
    ASSERT_EQ(layout.pack(words), pack(mapping, words));
    Words plain = words, fast = words;
    ASSERT_EQ(layout.unpack(data, fast), unpack(mapping, data, plain));
    ASSERT_EQ(layout.words(), unpack(mapping, data, plain));
    ASSERT_EQ(fast, plain);
  }
}

TEST(CanopenPdo, DefaultsOnEverySync) {
  PROVES("MDB-TOC-10", "MDB-TOC-11");
  PdoRig rig;
  rig.nmt(NmtCommand::Start);
  rig.station.unit.inputs = {0x0207, 0x1388, 0xFFFE};
  EXPECT_EQ(rig.sync(), (Frames{{0x185, 6, {0x07, 0x02, 0x88, 0x13, 0xFE, 0xFF}}}));
  EXPECT_EQ(rig.sync().size(), 1U);
  // Outputs act at the next SYNC; the last ones count.
  rig.ask({0x205, 6, {0x06, 0x00, 0xE8, 0x03, 0, 0}});
  rig.ask({0x205, 6, {0x06, 0x00, 0xD0, 0x07, 0, 0}});
  EXPECT_TRUE(rig.station.unit.taken.empty());
  rig.sync();
  EXPECT_EQ(rig.station.unit.taken.size(), 1U);
  EXPECT_EQ(rig.station.unit.outputs[0], 0x0006);
  EXPECT_EQ(rig.station.unit.outputs[1], 2000);
  EXPECT_EQ(rig.station.unit.last_written, 7);
  rig.sync();
  EXPECT_EQ(rig.station.unit.taken.size(), 1U);
}

TEST(CanopenPdo, EveryCyclicType) {
  PROVES("MDB-TOC-10");
  PdoRig rig;
  rig.nmt(NmtCommand::Start);
  for (unsigned type = 1; type <= 240; ++type) {
    rig.write(0x1800, 2, type == 1 ? 2 : 1, 1);  // another one first: counting begins anew
    rig.write(0x1800, 2, type, 1);
    for (unsigned n = 1; n <= 2 * type; ++n)
      ASSERT_EQ(rig.sync().size(), n % type == 0 ? 1U : 0U) << type << " " << n;
  }
}

TEST(CanopenPdo, Type0OnChangeAtSync) {
  PROVES("MDB-TOC-10");
  PdoRig rig;
  rig.write(0x1800, 2, 0, 1);
  rig.nmt(NmtCommand::Start);
  EXPECT_EQ(rig.sync().size(), 1U);
  EXPECT_TRUE(rig.sync().empty());
  rig.clear();
  rig.set_input(1, 5);
  rig.run(10 * kMillisecond);
  EXPECT_TRUE(rig.master.frames.empty());
  EXPECT_EQ(rig.sync(), (Frames{{0x185, 6, {0, 0, 5, 0, 0, 0}}}));
  EXPECT_TRUE(rig.sync().empty());
}

TEST(CanopenPdo, RemoteTypes) {
  PROVES("MDB-TOC-10");
  PdoRig rig;
  rig.write(0x1800, 2, 252, 1);
  rig.nmt(NmtCommand::Start);
  rig.set_input(0, 1);
  EXPECT_TRUE(rig.sync().empty());  // sampled
  rig.set_input(0, 2);
  EXPECT_EQ(rig.ask(remote(0x185, 6)), (Frames{{0x185, 6, {1}}}));
  rig.sync();
  EXPECT_EQ(rig.ask(remote(0x185, 6)), (Frames{{0x185, 6, {2}}}));
  rig.write(0x1800, 2, 253, 1);
  EXPECT_TRUE(rig.sync().empty());
  rig.set_input(0, 3);
  EXPECT_EQ(rig.ask(remote(0x185, 6)), (Frames{{0x185, 6, {3}}}));
  // Bit 30: no remote frames.
  rig.write(0x1800, 1, 0x8000'0185, 4);
  rig.write(0x1800, 1, 0x4000'0185, 4);
  EXPECT_TRUE(rig.ask(remote(0x185, 6)).empty());
  // A cyclic one is not asked for.
  rig.write(0x1800, 1, 0x8000'0185, 4);
  rig.write(0x1800, 1, 0x0000'0185, 4);
  rig.write(0x1800, 2, 1, 1);
  EXPECT_TRUE(rig.ask(remote(0x185, 6)).empty());
}

TEST(CanopenPdo, EventsWithInhibitAndEventTime) {
  PROVES("MDB-TOC-10");
  for (const uint8_t type : {uint8_t{254}, uint8_t{255}}) {
    PdoRig rig;
    rig.map(true, 1, 0x2001'0410, type, 0x285);
    rig.write(0x1801, 1, 0x8000'0285, 4);
    rig.write(0x1801, 3, 100, 2);  // 10 ms
    rig.write(0x1801, 5, 50, 2);   // 50 ms
    rig.write(0x1801, 1, 0x0000'0285, 4);
    rig.clear();
    rig.master.port.send(nmt_frame(NmtCommand::Start, 5), 0);
    rig.run(5 * kMillisecond);
    EXPECT_EQ(rig.count(0x285), 1U);  // what it is at the start
    const Time first = rig.master.times.back();
    rig.set_input(3, 7);
    rig.set_input(3, 8);
    rig.run(3 * kMillisecond);
    EXPECT_EQ(rig.count(0x285), 1U);  // not before the inhibit time is over
    rig.run(5 * kMillisecond);
    ASSERT_EQ(rig.count(0x285), 2U);
    // A few bits are stuffed more or less.
    EXPECT_NEAR(static_cast<double>(rig.master.times.back() - first), 10e6, 20e3);
    EXPECT_EQ(rig.master.frames.back(), (Frame{0x285, 2, {8, 0}}));
    // Without a change every 50 ms.
    const Time second = rig.master.times.back();
    rig.run(120 * kMillisecond);
    ASSERT_EQ(rig.count(0x285), 4U);
    EXPECT_EQ(rig.master.times.back() - second, 100 * kMillisecond);
    // One that is asked for.
    rig.clear();
    rig.ask(remote(0x285, 2), 5 * kMillisecond);
    EXPECT_EQ(rig.count(0x285), 1U);
    // The same values again are no event.
    rig.clear();
    rig.set_input(3, 8);
    rig.run(20 * kMillisecond);
    EXPECT_EQ(rig.count(0x285), 0U);
    rig.nmt(NmtCommand::EnterPreOperational);
    rig.clear();
    rig.set_input(3, 9);
    rig.run(200 * kMillisecond);
    EXPECT_TRUE(rig.master.frames.empty());
  }
}

TEST(CanopenPdo, ReceivedByEventAtOnce) {
  PROVES("MDB-TOC-10");
  PdoRig rig;
  rig.map(false, 1, 0x2000'0410, 255, 0x305);
  rig.map(false, 2, 0x2000'0510, 254, 0x405);
  rig.nmt(NmtCommand::Start);
  rig.ask({0x305, 2, {0x34, 0x12}});
  EXPECT_EQ(rig.station.unit.outputs[3], 0x1234);
  EXPECT_EQ(rig.station.unit.last_written, 1 << 3);
  rig.ask({0x405, 2, {0x78, 0x56}});
  EXPECT_EQ(rig.station.unit.outputs[4], 0x5678);
  EXPECT_EQ(rig.station.node.dictionary().value(0x2000, 5), 0x5678U);
}

TEST(CanopenPdo, WrongLength) {
  PdoRig rig;
  rig.map(false, 1, 0x2000'0410, 255, 0x305);
  rig.nmt(NmtCommand::Start);
  rig.ask({0x305, 1, {0x34}});
  EXPECT_TRUE(rig.station.unit.taken.empty());
  rig.ask({0x305, 3, {0x34, 0x12, 0x99}});
  EXPECT_EQ(rig.station.unit.outputs[3], 0x1234);
  EXPECT_EQ(rig.station.ignored, (std::vector{IgnoredMessage::PdoTooShort, IgnoredMessage::PdoTooLong}));
}

// CiA 301: a PDO that is too short is told by EMCY 8210h, generic and communication error. It is gone when each of them
// has come long enough (ours).
TEST(CanopenPdo, TooShortIsAnEmergency) {
  PdoRig rig;
  rig.map(false, 1, 0x2000'0410, 255, 0x305);
  rig.map(false, 2, 0x2000'0510, 254, 0x405);
  rig.nmt(NmtCommand::Start);
  const auto emergencies = [&](const Frame& pdo) {
    std::vector<Frame> found;
    for (const Frame& frame : rig.ask(pdo))
      if (frame.id == 0x085) found.push_back(frame);
    return found;
  };
  const Frame short_one{0x305, 1, {0x34}}, other{0x405, 0};
  const std::vector<Frame> told{{0x085, 8, {0x10, 0x82, 0x11}}}, gone{{0x085, 8, {0, 0, 0}}}, nothing;
  EXPECT_EQ(emergencies(short_one), told);
  EXPECT_EQ(rig.station.node.dictionary().value(0x1001), 0x11U);
  EXPECT_EQ(rig.station.node.dictionary().value(0x1003, 1), 0x8210U);
  EXPECT_EQ(emergencies(short_one), nothing) << "it is known already";
  EXPECT_EQ(emergencies(other), nothing);
  EXPECT_EQ(emergencies({0x305, 2, {0x34, 0x12}}), nothing) << "the other one was too short, too";
  EXPECT_EQ(emergencies({0x405, 3, {0x34, 0x12, 0}}), gone) << "too long is long enough";
  EXPECT_EQ(rig.station.node.dictionary().value(0x1001), 0U);
  // Who maps less, or begins anew, has no such PDO any more.
  EXPECT_EQ(emergencies(short_one), told);
  rig.write(0x1401, 1, 0x8000'0305, 4);
  EXPECT_EQ(rig.station.node.dictionary().value(0x1001), 0U);
  rig.write(0x1401, 1, 0x0000'0305, 4);
  EXPECT_EQ(emergencies(short_one), told);
  rig.nmt(NmtCommand::ResetCommunication);
  EXPECT_EQ(rig.station.node.dictionary().value(0x1001), 0U);
}

TEST(CanopenPdo, LengthIsTheSumOfWhatIsMapped) {
  PROVES("MDB-TOC-09");
  PdoRig rig;
  for (size_t n = 0; n < 10; ++n) rig.station.unit.inputs[n] = static_cast<uint16_t>(0x1100 * (n + 1));
  for (uint8_t words = 1; words <= 4; ++words) {
    rig.write(0x1800, 1, 0x8000'0185, 4);
    rig.write(0x1A00, 0, 0, 1);
    for (uint8_t n = 1; n <= words; ++n) rig.write(0x1A00, n, 0x2001'0010U | (11U - n) << 8, 4);
    rig.write(0x1A00, 0, words, 1);
    rig.write(0x1800, 1, 0x0000'0185, 4);
    rig.nmt(NmtCommand::Start);
    const auto frames = rig.sync();
    ASSERT_EQ(frames.size(), 1U);
    EXPECT_EQ(frames[0].length, 2 * words);
    for (uint8_t n = 0; n < words; ++n) {
      EXPECT_EQ(frames[0].data[2 * n] | frames[0].data[2 * n + 1] << 8, 0x1100 * (10 - n));
    }
    rig.nmt(NmtCommand::EnterPreOperational);
  }
}

// One PDO of a master for two nodes: each takes its part.
TEST(CanopenPdo, DummiesLeaveBitsToOthers) {
  PdoRig rig;
  rig.write(0x1401, 1, 0x8000'0300, 4);
  rig.write(0x1401, 2, 255, 1);
  rig.write(0x1601, 1, 0x0006'0010, 4);
  rig.write(0x1601, 2, 0x2000'0210, 4);
  rig.write(0x1601, 3, 0x0007'0020, 4);
  rig.write(0x1601, 0, 3, 1);
  rig.write(0x1401, 1, 0x0000'0300, 4);
  rig.nmt(NmtCommand::Start);
  rig.ask({0x300, 8, {1, 2, 3, 4, 5, 6, 7, 8}});
  EXPECT_EQ(rig.station.unit.outputs[1], 0x0403);
  EXPECT_EQ(rig.station.unit.last_written, 2);
}

TEST(CanopenPdo, AnotherSyncIdentifier) {
  PROVES("MDB-TOC-11");
  PdoRig rig;
  rig.write(0x1005, 0, 0x100, 4);
  rig.nmt(NmtCommand::Start);
  EXPECT_TRUE(rig.sync().empty());
  EXPECT_EQ(rig.ask({0x100, 0}).size(), 1U);
  EXPECT_TRUE(rig.ask({0x100, 1, {1}}).empty());
  EXPECT_EQ(rig.station.ignored, std::vector{IgnoredMessage::WrongLength});
}

}  // namespace
}  // namespace ipos::tests

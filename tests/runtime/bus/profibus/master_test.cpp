// The model master: its start-up, the closed form of the cycle, faults on the line, a second master, and what
// it makes of a slave's diagnosis.
#include "runtime/bus/profibus/master.hpp"

#include <algorithm>
#include <set>

#include "tests/runtime/bus/profibus/line_rig.hpp"

namespace ipos::tests {
namespace {

// Runs until the slave's rate is found and it exchanges.
void settle(LineRig& rig, Time time = kSecond) { rig.run(time); }

TEST(DpMaster, StartUpFrameByFrame) {
  LineRig rig(1'500'000);
  auto& slave = rig.add_slave(8);
  MasterSettings settings;
  settings.gap_factor = 0;
  Master& master = rig.add_master(settings);
  master.add_slave(plan_of(8, "F2", 6, "B8 14 01 0B 31 00 00"));
  master.slave(0).set_outputs(hex("00 06 05 DC 00 00"));
  master.start();
  rig.run(4 * kMillisecond);
  std::vector<std::string> frames;
  for (const Heard& heard : rig.recorder.heard) frames.push_back(heard.text());
  const std::string token = "DC 01 01";
  // Two tokens claim the ring; the first one also gives the slave its rate.
  const std::vector<std::string> expected{token,
                                          token,
                                          "68 05 05 68 88 81 6D 3C 3E F0 16",
                                          "68 0B 0B 68 81 88 08 3E 3C 02 05 00 FF 31 00 C2 16",
                                          token,
                                          "68 0C 0C 68 88 81 5D 3D 3E B8 14 01 0B 31 00 00 EA 16",
                                          "E5",
                                          token,
                                          "68 06 06 68 88 81 7D 3E 3E F2 F4 16",
                                          "E5",
                                          token,
                                          "68 05 05 68 88 81 5D 3C 3E E0 16",
                                          "68 0B 0B 68 81 88 08 3E 3C 00 0C 00 01 31 00 C9 16",
                                          token,
                                          "68 09 09 68 08 01 7D 00 06 05 DC 00 00 6D 16",
                                          "68 09 09 68 01 08 08 01 01 01 01 01 01 17 16",
                                          token};
  ASSERT_GE(frames.size(), expected.size());
  frames.resize(expected.size());
  EXPECT_EQ(frames, expected);
  EXPECT_EQ(text_of(slave.unit.outputs), "00 06 05 DC 00 00");
}

// One Data_Exchange of 14 + 14 octets takes 606 bits with Tsdr 30 and TID1 37 (the closed form that
// docs/reference/protocols/profibus.md prints), and the whole cycle its sum.
Bits exchange_bits(Bits octets, Bits tsdr, Bits tid1) { return 33 + 2 * (99 + 11 * octets) + tsdr + tid1; }

TEST(DpMaster, CycleTimeIsTheClosedForm) {
  EXPECT_EQ(exchange_bits(14, 30, 37), 606U);
  for (const BaudRate& rate : kBaudRates)
    for (const unsigned slaves : {1U, 8U, 32U})
      for (const bool gap : {false, true}) {
        if (rate.baud < 500'000 && slaves > 8) continue;  // the same sum, only slower
        LineRig rig(rate.baud);
        rig.recorder.keep = false;
        MasterSettings settings;
        settings.address = 100;
        settings.gap_factor = gap ? 1 : 0;
        Master& master = rig.add_master(settings);
        for (unsigned n = 0; n < slaves; ++n) {
          const auto address = static_cast<uint8_t>(n);
          rig.add_slave(address).station.set_reaction(30);
          master.add_slave(plan_of(address, "F3 F2", 14));
        }
        master.start();
        const auto exchanging = [&] {
          for (unsigned n = 0; n < slaves; ++n)
            if (!master.slave(n).exchanging()) return false;
          return true;
        };
        while (!exchanging() && rig.queue.now() < 20 * kSecond) rig.run(20 * kMillisecond);
        rig.run(2 * time_of(50'000, rate.baud));  // two cycles and more
        const Bits slot = rate.slot;
        Bits expected = slaves * exchange_bits(14, 30, 37) + 33 + 33 + 150;
        if (gap) expected += 33 + 66 + slot;
        // A GAP poll that meets a slave is answered instead of timing out; one cycle may differ by that.
        std::set<Bits> seen;
        for (int n = 0; n < 130; ++n) {
          const uint64_t cycle = master.cycles();
          while (master.cycles() == cycle) rig.queue.step();
          seen.insert(master.cycle_bits());
        }
        EXPECT_TRUE(seen.count(expected)) << rate.baud << ' ' << slaves;
        seen.erase(expected);
        if (gap) seen.erase(expected - slot + 30 + 66 + 37);
        EXPECT_TRUE(seen.empty()) << *seen.begin() << " of " << expected;
        EXPECT_EQ(rig.recorder.errors, 0U);
      }
}

TEST(DpMaster, ExchangeTimesOfTheTable) {
  const std::pair<uint32_t, double> kMilliseconds[] = {{9'600, 63.1},   {19'200, 31.6},  {93'750, 6.46},
                                                       {187'500, 3.23}, {500'000, 1.21}, {1'500'000, 0.404}};
  for (const auto& [baud, ms] : kMilliseconds) {
    const double time = static_cast<double>(time_of(606, baud)) / 1e6;
    EXPECT_NEAR(time, ms, ms * 0.005) << baud;
  }
}

TEST(DpMaster, WatchdogWhenTheMasterFallsSilent) {
  PROVES("DP-WD-04");
  for (const int factor : {1, 5, 20, 100}) {
    LineRig rig;
    auto& slave = rig.add_slave(8);
    Master& master = rig.add_master({});
    master.add_slave(
        plan_of(8, "F0", 2, "88 01 " + text_of(Octets{static_cast<uint8_t>(factor)}) + " 0B 31 00 00"));
    master.start();
    settle(rig);
    EXPECT_EQ(slave.unit.expired, 0);
    const Time cycle = time_of(master.cycle_bits(), rig.line.baud());
    master.stop();
    const Time stopped = rig.queue.now();
    rig.run(3 * kSecond);
    ASSERT_EQ(slave.unit.expired, 1) << factor;
    EXPECT_NEAR(static_cast<double>(slave.unit.expired_at - stopped),
                static_cast<double>(factor * 10 * kMillisecond), static_cast<double>(cycle));
    EXPECT_EQ(slave.slave().state(), SlaveState::WaitPrm);
    master.start();
    rig.run(2 * kSecond);
    EXPECT_TRUE(master.slave(0).exchanging());
  }
}

// New outputs every cycle, and what of them the unit has seen.
struct Counting final : MasterClient {
  void on_cycle(Time) override {
    ++value;
    const auto high = static_cast<uint8_t>(value >> 8), low = static_cast<uint8_t>(value);
    // The third octet makes a mixture of two frames visible.
    master->slave(0).set_outputs({high, low, static_cast<uint8_t>(high ^ low), 0x5A});
  }
  Master* master = nullptr;
  uint32_t value = 0;
};

TEST(DpMaster, FaultsOnTheLineNeverReachTheUnit) {
  for (const OctetFaultKind kind : {OctetFaultKind::Lost, OctetFaultKind::Cut, OctetFaultKind::Parity,
                                   OctetFaultKind::Noise, OctetFaultKind::Collision})
    for (const uint32_t per_mille : {10U, 200U}) {
      LineRig rig(1'500'000);
      rig.recorder.keep = false;
      auto& slave = rig.add_slave(8);
      Counting counting;
      Master& master = rig.add_master({}, &counting);
      counting.master = &master;
      master.add_slave(plan_of(8, "F1", 4, "88 05 01 0B 31 00 00"));
      master.slave(0).set_outputs({0, 0, 0, 0x5A});
      OctetFault fault;
      fault.kind = kind;
      fault.per_mille = per_mille;
      fault.seed = 3;
      rig.line.add_fault(fault);
      master.start();
      int bad = 0;
      for (int n = 0; n < 20'000; ++n) {
        rig.run(100 * runtime::kMicrosecond);
        const Octets& out = slave.unit.outputs;
        if (slave.unit.taken > 0 && out[3] != 0) bad += (out[0] ^ out[1]) != out[2] || out[3] != 0x5A;
      }
      EXPECT_EQ(bad, 0);
      EXPECT_GT(slave.unit.taken, per_mille == 10 ? 4000 : 800) << static_cast<int>(kind) << ' ' << per_mille;
      EXPECT_GT(rig.recorder.events.size(), per_mille == 10 ? 30U : 300U);
    }
}

TEST(DpMaster, ALostAnswerIsNotExecutedTwice) {
  LineRig rig;
  auto& slave = rig.add_slave(8);
  Master& master = rig.add_master({});
  master.add_slave(plan_of(8, "F0", 2));
  master.start();
  settle(rig);
  const int taken = slave.unit.taken;
  const uint64_t repetitions = master.repetitions();
  rig.recorder.heard.clear();
  OctetFault fault;
  fault.kind = OctetFaultKind::Lost;
  fault.sender = slave.station.node();
  fault.from = rig.queue.now();
  fault.frame = 1;
  rig.line.add_fault(fault);
  rig.run(100 * kMillisecond);
  EXPECT_EQ(master.repetitions(), repetitions + 1);
  int requests = 0;
  for (const Heard& heard : rig.recorder.heard)
    requests += heard.reception.frame->is_request() && heard.reception.frame->destination == 8 &&
                !heard.reception.frame->data.empty();
  EXPECT_EQ(requests, slave.unit.taken - taken + 1);
}

TEST(DpMaster, TwoMastersShareTheRing) {
  LineRig rig;
  auto& one = rig.add_slave(10);
  auto& two = rig.add_slave(11);
  MasterSettings first, second;
  first.address = 1;
  first.gap_factor = second.gap_factor = 1;
  second.address = 3;
  Master& a = rig.add_master(first);
  Master& b = rig.add_master(second);
  a.add_slave(plan_of(10, "F0", 2, "88 32 01 0B 31 00 00"));
  b.add_slave(plan_of(11, "F0", 2, "88 32 01 0B 31 00 00"));
  a.start();
  b.start();
  rig.run(2 * kSecond);
  EXPECT_TRUE(a.in_ring() && b.in_ring());
  EXPECT_EQ(a.next_station(), 3);
  EXPECT_EQ(b.next_station(), 1);
  EXPECT_TRUE(a.slave(0).exchanging() && b.slave(0).exchanging());
  EXPECT_EQ(encode(one.slave().diagnosis(0))[3], 1);
  EXPECT_EQ(encode(two.slave().diagnosis(0))[3], 3);
  EXPECT_EQ(std::count_if(rig.recorder.events.begin(), rig.recorder.events.end(),
                          [](const LineEvent& e) { return e.kind == LineEventKind::Collision; }),
            0);
  // One falls silent: the other keeps the ring and its slave; the lost one comes back.
  a.stop();
  rig.run(3 * kSecond);
  EXPECT_EQ(b.next_station(), 3);
  EXPECT_TRUE(b.slave(0).exchanging());
  EXPECT_EQ(two.unit.expired, 0);
  EXPECT_EQ(one.unit.expired, 1);
  a.start();
  rig.run(3 * kSecond);
  EXPECT_TRUE(a.in_ring() && b.in_ring());
  EXPECT_TRUE(a.slave(0).exchanging() && b.slave(0).exchanging());
  EXPECT_EQ(two.unit.expired, 0);
}

TEST(DpMaster, LostTokensAreFoundAgain) {
  LineRig rig(1'500'000);
  rig.recorder.keep = false;
  rig.add_slave(10);
  rig.add_slave(11);
  MasterSettings first, second;
  first.address = 1;
  second.address = 2;
  Master& a = rig.add_master(first);
  Master& b = rig.add_master(second);
  a.add_slave(plan_of(10, "F0", 2));
  b.add_slave(plan_of(11, "F0", 2));
  OctetFault fault;
  fault.kind = OctetFaultKind::Noise;
  fault.per_mille = 20;
  rig.line.add_fault(fault);
  a.start();
  b.start();
  rig.run(2 * kSecond);
  const uint64_t cycles = a.cycles(), others = b.cycles();
  rig.run(4 * kSecond);
  EXPECT_GT(a.cycles(), cycles + 300);
  EXPECT_GT(b.cycles(), others + 300);
  EXPECT_GT(a.slave(0).exchanges(), 300U);
  EXPECT_GT(b.slave(0).exchanges(), 300U);
}

TEST(DpMaster, ALongRotationLeavesOneRequestAToken) {
  LineRig rig;
  MasterSettings settings;
  settings.gap_factor = 0;
  settings.rotation = 1;  // always exceeded
  Master& master = rig.add_master(settings);
  for (uint8_t address = 10; address < 14; ++address) {
    rig.add_slave(address);
    master.add_slave(plan_of(address, "F0", 2));
  }
  master.start();
  settle(rig, 2 * kSecond);
  rig.recorder.heard.clear();
  rig.run(20 * kMillisecond);
  int requests = 0, tokens = 0;
  for (const Heard& heard : rig.recorder.heard) {
    requests += heard.reception.frame->is_request();
    tokens += heard.reception.frame->is_token();
  }
  EXPECT_NEAR(requests, tokens, 1);
  EXPECT_TRUE(master.slave(3).exchanging());
}

// --- Sync and Freeze over several slaves

struct ThreeSlaves {
  ThreeSlaves() {
    MasterSettings settings;
    settings.gap_factor = 0;
    master = &rig.add_master(settings);
    for (uint8_t n = 0; n < 3; ++n) {
      slaves.push_back(&rig.add_slave(static_cast<uint8_t>(10 + n)));
      // Groups 1, 1 and 2.
      master->add_slave(plan_of(static_cast<uint8_t>(10 + n), "F0", 2,
                                std::string("B0 00 00 0B 31 00 ") + (n == 2 ? "02" : "01")));
    }
    master->start();
    rig.run(2 * kSecond);
  }
  void control(uint8_t command, uint8_t groups = 0) {
    master->control({command, groups});
    rig.run(10 * kMillisecond);
  }
  void outputs(const std::string& octets) {
    for (size_t n = 0; n < 3; ++n) master->slave(n).set_outputs(hex(octets));
    rig.run(10 * kMillisecond);
  }
  std::string acting() {
    std::string text;
    for (LineRig::Station* slave : slaves) text += text_of(slave->unit.outputs) + "|";
    return text;
  }
  LineRig rig;
  Master* master;
  std::vector<LineRig::Station*> slaves;
};

TEST(DpMaster, SyncMovesAllAtOneTime) {
  PROVES("DP-SYNC-02");
  ThreeSlaves three;
  three.outputs("00 01");
  three.control(0x20);
  three.outputs("00 02");
  EXPECT_EQ(three.acting(), "00 01|00 01|00 01|");
  three.control(0x20);
  EXPECT_EQ(three.acting(), "00 02|00 02|00 02|");
  std::set<Time> times;
  for (LineRig::Station* slave : three.slaves) times.insert(slave->unit.taken_at);
  EXPECT_EQ(times.size(), 1U);
  three.control(0x10);
  three.outputs("00 03");
  EXPECT_EQ(three.acting(), "00 03|00 03|00 03|");
}

TEST(DpMaster, FreezeTakesAllAtOneTime) {
  PROVES("DP-SYNC-05");
  ThreeSlaves three;
  three.control(0x08);
  std::set<Time> times;
  for (LineRig::Station* slave : three.slaves) times.insert(slave->unit.read_at);
  EXPECT_EQ(times.size(), 1U);
  const Octets frozen = three.master->slave(0).inputs();
  three.rig.run(50 * kMillisecond);
  EXPECT_EQ(three.master->slave(0).inputs(), frozen);
  three.control(0x08);
  std::set<Time> again;
  for (LineRig::Station* slave : three.slaves) again.insert(slave->unit.read_at);
  EXPECT_EQ(again.size(), 1U);
  EXPECT_NE(three.master->slave(0).inputs(), frozen);
}

TEST(DpMaster, GroupsAndNoAnswer) {
  PROVES("DP-SYNC-07");
  ThreeSlaves three;
  three.outputs("00 01");
  three.rig.recorder.heard.clear();
  three.control(0x20, 0x01);
  three.outputs("00 02");
  EXPECT_EQ(three.acting(), "00 01|00 01|00 02|");
  for (size_t n = 0; n + 1 < three.rig.recorder.heard.size(); ++n) {
    const FdlFrame& frame = *three.rig.recorder.heard[n].reception.frame;
    if (frame.destination != kBroadcast || !frame.has_control()) continue;
    EXPECT_TRUE(three.rig.recorder.heard[n + 1].reception.frame->needs_idle());  // no answer follows
  }
}

// --- what the master makes of diagnosis

struct OneSlave {
  explicit OneSlave(const std::string& parameters = "80 00 00 0B 31 00 00") : slave(rig.add_slave(8)) {
    MasterSettings settings;
    settings.address = 2;
    master = &rig.add_master(settings);
    master->add_slave(plan_of(8, "F0", 2, parameters));
    master->start();
    rig.run(kSecond);
  }
  std::string view() { return text_of(encode(master->slave(0).view())); }
  LineRig rig;
  LineRig::Station& slave;
  Master* master;
};

TEST(MasterView, NonExistentKeepsTheRest) {
  PROVES("DP-DIAG-12");
  OneSlave one;
  EXPECT_EQ(one.view(), "00 04 00 02 31 00");
  one.rig.line.set_connected(one.slave.station.node(), false);
  one.rig.run(kSecond);
  EXPECT_EQ(one.view(), "01 04 00 02 31 00");
  one.rig.line.set_connected(one.slave.station.node(), true);
  one.rig.run(kSecond);
  EXPECT_TRUE(one.master->slave(0).exchanging());
  EXPECT_EQ(one.view(), "00 04 00 02 31 00");
}

TEST(MasterView, InvalidAnswerIsTheMastersBit) {
  PROVES("DP-DIAG-07");
  OneSlave one;
  OctetFault fault;
  fault.kind = OctetFaultKind::Parity;
  fault.sender = one.slave.station.node();
  fault.from = one.rig.queue.now();
  fault.frame = 1;
  one.rig.line.add_fault(fault);
  bool seen = false;
  for (int n = 0; n < 1000; ++n) {
    one.rig.queue.step();
    seen = seen || one.master->slave(0).view().has(diag::kInvalidResponse);
    EXPECT_FALSE(one.slave.slave().diagnosis(one.rig.queue.now()).has(diag::kInvalidResponse));
  }
  EXPECT_TRUE(seen);
  EXPECT_FALSE(one.master->slave(0).view().has(diag::kInvalidResponse));  // a good answer came since
}

TEST(MasterView, MasterLock) {
  PROVES("DP-DIAG-05");
  LineRig rig;
  auto& slave = rig.add_slave(8);
  MasterSettings first, second;
  first.address = 5;
  second.address = 2;
  Master& owner = rig.add_master(first);
  Master& other = rig.add_master(second);
  owner.add_slave(plan_of(8, "F0", 2));
  other.add_slave(plan_of(8, "F0", 2));
  owner.start();
  rig.run(kSecond);
  other.start();
  rig.run(3 * kSecond);
  EXPECT_TRUE(owner.slave(0).exchanging());
  EXPECT_EQ(text_of(encode(other.slave(0).view())), "80 04 00 05 31 00");
  EXPECT_FALSE(owner.slave(0).view().has(diag::kMasterLock));
  EXPECT_EQ(encode(slave.slave().diagnosis(rig.queue.now()))[0] & 0x80, 0);
}

TEST(MasterView, Deactivated) {
  PROVES("DP-DIAG-13");
  OneSlave one;
  one.master->slave(0).set_active(false);
  const auto exchanged = one.master->slave(0).exchanges();
  one.rig.run(kSecond);
  EXPECT_EQ(one.view(), "00 84 00 02 31 00");
  EXPECT_EQ(one.master->slave(0).exchanges(), exchanged);
  EXPECT_FALSE(one.slave.slave().diagnosis(one.rig.queue.now()).has(diag::kDeactivated));
  one.master->slave(0).set_active(true);
  one.rig.run(kSecond);
  EXPECT_TRUE(one.master->slave(0).exchanging());
  EXPECT_EQ(one.view(), "00 04 00 02 31 00");
}

TEST(MasterView, StaticDiagnosisHoldsTheData) {
  PROVES("DP-DIAG-17");
  OneSlave one;
  one.slave.slave().set_static_diagnosis(true);
  one.rig.run(20 * kMillisecond);
  const int taken = one.slave.unit.taken;
  one.rig.recorder.heard.clear();
  one.rig.run(100 * kMillisecond);
  EXPECT_EQ(one.slave.unit.taken, taken);
  int asked = 0;
  for (const Heard& heard : one.rig.recorder.heard) asked += heard.reception.frame->dsap == 60;
  EXPECT_GT(asked, 10);
  one.slave.slave().set_static_diagnosis(false);
  one.rig.run(100 * kMillisecond);
  EXPECT_GT(one.slave.unit.taken, taken);
}

TEST(MasterView, SwappedSlavesOfTwoTypes) {
  PROVES("DP-ID-04");
  LineRig rig;
  auto& one = rig.add_slave(8, OptionKind::Size0);
  auto& two = rig.add_slave(9, OptionKind::Ffp31);
  Master& master = rig.add_master({});
  master.add_slave(plan_of(8, "F0", 2, "80 00 00 0B 31 00 00"));
  master.add_slave(plan_of(9, "F0", 2, "80 00 00 0B 31 11 00"));
  master.start();
  rig.run(2 * kSecond);
  EXPECT_EQ(master.slave(0).exchanges() + master.slave(1).exchanges(), 0U);
  EXPECT_EQ(one.unit.taken + two.unit.taken, 0);
  EXPECT_TRUE(one.slave().diagnosis(rig.queue.now()).has(diag::kPrmFault));
  EXPECT_TRUE(two.slave().diagnosis(rig.queue.now()).has(diag::kPrmFault));
}

TEST(MasterView, AFaultOfTheUnitArrives) {
  OneSlave one;
  one.slave.slave().set_fault(one.rig.queue.now(), 47);
  one.rig.run(kSecond);
  EXPECT_EQ(one.view(), "08 04 00 02 31 00 02 2F");
  EXPECT_TRUE(one.master->slave(0).exchanging());
  one.slave.slave().set_fault(one.rig.queue.now(), std::nullopt);
  one.rig.run(kSecond);
  EXPECT_EQ(one.view(), "00 04 00 02 31 00");
}

// What a client sets when all slaves have had their turn goes out in the next cycle: no value is left out.
TEST(DpMaster, OutputsOfEachCycle) {
  LineRig rig(1'500'000);
  auto& slave = rig.add_slave(8);
  Counting counting;
  Master& master = rig.add_master({}, &counting);
  counting.master = &master;
  master.add_slave(plan_of(8, "F1", 4));
  master.start();
  settle(rig);
  ASSERT_TRUE(master.slave(0).exchanging());
  EXPECT_EQ(counting.value, master.cycles());
  const auto seen = [&] { return static_cast<uint32_t>(slave.unit.outputs[0] << 8 | slave.unit.outputs[1]); };
  uint32_t last = seen();
  for (int n = 0; n < 100; ++n) {
    const int taken = slave.unit.taken;
    while (slave.unit.taken == taken) rig.queue.step();
    ASSERT_EQ(seen(), last + 1);
    ASSERT_EQ(seen(), counting.value);
    last = seen();
  }
}

}  // namespace
}  // namespace ipos::tests

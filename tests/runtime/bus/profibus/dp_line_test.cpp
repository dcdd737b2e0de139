// The line frame by frame: bit times, idle, collisions, faults, load, and the slave that finds its rate.
#include "runtime/bus/profibus/line.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "tests/runtime/bus/profibus/line_rig.hpp"

namespace ipos::tests {
namespace {

// Sends what the test wants, and keeps what it hears.
struct HandNode final : Node {
  HandNode(LineRig& r, const std::string& name) : rig(r), id(r.line.attach(name, *this)) {}
  void on_reception(Time now, const Reception& reception) override {
    heard.push_back(reception);
    heard_at.push_back(now);
  }
  void on_sent(Time now) override { sent_at = now; }
  bool send(Bits at, const std::string& octets) { return rig.line.send(id, at, hex(octets)); }
  std::string errors() const {
    std::string text;
    for (const Reception& reception : heard)
      text += (text.empty() ? "" : "; ") +
              (reception.frame ? "-" : std::string(frame_error_text(reception.frame.error())));
    return text;
  }

  LineRig& rig;
  NodeId id;
  std::vector<Reception> heard;
  std::vector<Time> heard_at;
  Time sent_at = -1;
};

const std::string kRequest = "68 05 05 68 88 81 6D 3C 3E F0 16";  // 11 octets

TEST(DpLine, IntegerBitTimes) {
  for (const BaudRate& rate : kBaudRates) {
    LineRig rig(rate.baud);
    HandNode a(rig, "a"), b(rig, "b");
    // The 1000th frame ends at its bit, rounded once: nothing adds up.
    for (Bits n = 0; n < 1000; ++n) {
      ASSERT_TRUE(a.send(n * 154, kRequest));
      rig.queue.run_until(rig.line.at(n * 154 + 121));
    }
    ASSERT_EQ(b.heard.size(), 1000U);
    const auto exact = static_cast<Time>((999 * 154 + 121) * 1'000'000'000ULL / rate.baud);
    EXPECT_EQ(b.heard_at.back(), exact);
    EXPECT_EQ(a.sent_at, exact);
    EXPECT_EQ(b.heard.back().end, exact);
    EXPECT_EQ(b.heard.back().start, static_cast<Time>(999 * 154 * 1'000'000'000ULL / rate.baud));
    for (Bits bit = 0; bit < 5000; ++bit) EXPECT_EQ(bit_from(time_of(bit, rate.baud), rate.baud), bit);
    EXPECT_EQ(b.errors().find("idle"), std::string::npos);
  }
  EXPECT_EQ(find_baud_rate(3'000'000), nullptr);
}

TEST(DpLine, IdleBeforeARequest) {
  for (const auto& [idle, text] :
       {std::pair<Bits, std::string>{33, "-; -"}, {32, "-; less than 33 idle bits before the frame"}}) {
    LineRig rig;
    HandNode a(rig, "a"), b(rig, "b");
    a.send(0, kRequest);
    rig.run(kMillisecond);
    a.send(600, kRequest);
    rig.queue.run_until(rig.line.at(600 + 121));
    b.heard.clear();
    HandNode c(rig, "c");
    a.send(800, "E5");
    rig.queue.run_until(rig.line.at(811));
    a.send(811 + idle, kRequest);
    rig.run(kMillisecond);
    EXPECT_EQ(b.errors(), text);
  }
  // Answers want no such pause.
  LineRig rig;
  HandNode a(rig, "a"), b(rig, "b");
  a.send(0, kRequest);
  rig.queue.run_until(rig.line.at(121));
  a.send(132, "E5");
  rig.run(kMillisecond);
  EXPECT_EQ(b.errors(), "-; -");
}

TEST(DpLine, Collisions) {
  LineRig rig;
  HandNode a(rig, "a"), b(rig, "b"), c(rig, "c");
  a.send(0, kRequest);
  b.send(50, kRequest);
  rig.run(kMillisecond);
  EXPECT_EQ(c.errors(), "parity error; parity error");
  EXPECT_TRUE(b.heard.empty());           // half duplex
  EXPECT_EQ(a.errors(), "parity error");  // the end of b's frame, after its own
  ASSERT_EQ(rig.recorder.texts.size(), 1U);
  EXPECT_EQ(rig.recorder.texts[0], "dp: b sends while another station does: both frames are lost");
  a.send(0, "E5");
  EXPECT_FALSE(a.send(100, "E5"));  // still sending
  rig.run(kMillisecond);
  EXPECT_EQ(c.errors(), "parity error; parity error; -");
  EXPECT_EQ(rig.line.load(rig.queue.now()).busy_bits, 171U + 11U);  // the overlap counts once
}

TEST(DpLine, PlantedFaults) {
  struct Row {
    OctetFaultKind kind;
    std::string errors;
  };
  for (const Row& row : {Row{OctetFaultKind::Lost, "-; -"}, Row{OctetFaultKind::Parity, "-; parity error; -"},
                         Row{OctetFaultKind::Collision, "-; parity error; -"}}) {
    LineRig rig;
    HandNode a(rig, "a"), b(rig, "b");
    OctetFault fault;
    fault.kind = row.kind;
    fault.frame = 2;
    rig.line.add_fault(fault);
    for (Bits n = 0; n < 3; ++n) {
      a.send(n * 200, kRequest);
      rig.queue.run_until(rig.line.at(n * 200 + 121));
    }
    EXPECT_EQ(b.errors(), row.errors);
    ASSERT_EQ(rig.recorder.texts.size(), 1U);
    EXPECT_NE(rig.recorder.texts[0].find(octet_fault_type(row.kind).text), std::string::npos);
    EXPECT_EQ(runtime::find_octet_fault("lost", runtime::OctetLine::Profibus)->kind, OctetFaultKind::Lost);
    EXPECT_EQ(runtime::find_octet_fault("nothing", runtime::OctetLine::Profibus), nullptr);
  }
  // A cut or noisy frame is never another one; a lost one may be of one sender only.
  for (const OctetFaultKind kind : {OctetFaultKind::Cut, OctetFaultKind::Noise}) {
    LineRig rig(1'500'000);
    HandNode a(rig, "a"), b(rig, "b"), c(rig, "c");
    OctetFault fault;
    fault.kind = kind;
    fault.sender = a.id;
    fault.seed = 7;
    rig.line.add_fault(fault);
    for (Bits n = 0; n < 20'000; ++n) {
      (n % 4 == 3 ? b : a).send(n * 200, kRequest);
      rig.queue.run_until(rig.line.at(n * 200 + 121));
    }
    uint64_t good = 0;
    for (const Reception& reception : c.heard) good += reception.frame.has_value();
    EXPECT_EQ(good, 5000U);
  }
}

// Those of a sender and those of all are two; what has an end of its own keeps it.
TEST(DpLine, FaultsEndByHand) {
  LineRig rig;
  HandNode a(rig, "a"), b(rig, "b");
  OctetFault of_a;
  of_a.kind = OctetFaultKind::Lost;
  of_a.sender = a.id;
  rig.line.add_fault(of_a);
  OctetFault timed;
  timed.kind = OctetFaultKind::Parity;
  timed.until = kMillisecond;
  rig.line.add_fault(timed);
  const auto send = [&](Bits n) {
    a.send(n * 200, kRequest);
    rig.queue.run_until(rig.line.at(n * 200 + 121));
  };
  send(0);
  EXPECT_EQ(b.errors(), "") << "the first one planted counts";
  EXPECT_FALSE(rig.line.end_fault(OctetFaultKind::Lost, runtime::kNoNode));
  EXPECT_FALSE(rig.line.end_fault(OctetFaultKind::Parity, runtime::kNoNode));
  EXPECT_TRUE(rig.line.end_fault(OctetFaultKind::Lost, a.id));
  EXPECT_FALSE(rig.line.end_fault(OctetFaultKind::Lost, a.id));
  send(1);
  EXPECT_EQ(b.errors(), "parity error");
  rig.queue.run_until(kMillisecond);
  send(rig.line.now() / 200 + 1);
  EXPECT_EQ(b.errors(), "parity error; -");
}

TEST(DpLine, FaultsByChanceAreTheSameForASeed) {
  const auto struck = [](uint64_t seed, uint32_t per_mille) {
    LineRig rig;
    HandNode a(rig, "a"), b(rig, "b");
    OctetFault fault;
    fault.kind = OctetFaultKind::Parity;
    fault.per_mille = per_mille;
    fault.seed = seed;
    fault.from = kMillisecond;
    rig.line.add_fault(fault);
    std::string pattern;
    for (Bits n = 0; n < 1000; ++n) {
      a.send(n * 200, kRequest);
      rig.queue.run_until(rig.line.at(n * 200 + 121));
      pattern += b.heard.back().frame ? '-' : 'x';
    }
    return pattern;
  };
  const std::string pattern = struck(5, 100);
  EXPECT_EQ(pattern, struck(5, 100));
  EXPECT_NE(pattern, struck(6, 100));
  EXPECT_EQ(pattern.substr(0, 3), "---");  // before 1 ms
  const auto count = std::count(pattern.begin(), pattern.end(), 'x');
  EXPECT_GT(count, 60);
  EXPECT_LT(count, 140);
}

TEST(DpLine, LoadCountsOccupiedBits) {
  LineRig rig(9'600);
  HandNode a(rig, "a"), b(rig, "b");
  for (Bits n = 0; n < 10; ++n) {
    a.send(n * 480, kRequest);
    rig.queue.run_until(rig.line.at(n * 480 + 121));
  }
  rig.queue.run_until(kSecond);
  const runtime::LineLoad load = rig.line.load(kSecond);
  EXPECT_EQ(load.busy_bits, 1210U);
  EXPECT_EQ(load.elapsed_bits, 9600U);
  EXPECT_EQ(load.percent, 12U);
  EXPECT_EQ(load.frames, 10U);
}

TEST(DpLine, Disconnected) {
  LineRig rig;
  HandNode a(rig, "a"), b(rig, "b");
  rig.line.set_connected(a.id, false);
  EXPECT_FALSE(a.send(0, kRequest));
  b.send(0, kRequest);
  rig.run(kMillisecond);
  EXPECT_TRUE(a.heard.empty());
  rig.line.set_connected(a.id, true);
  a.send(600, kRequest);
  rig.queue.run_until(rig.line.at(650));
  rig.line.set_connected(a.id, false);  // in the middle of a frame
  rig.run(kMillisecond);
  EXPECT_TRUE(b.heard.empty());
}

// --- the rate of a slave

TEST(BaudRate, TheSlaveLocksOnEachOfTheSix) {
  PROVES("DP-ID-08");
  std::set<uint32_t> printed{9'600, 19'200, 93'750, 187'500, 500'000, 1'500'000};
  EXPECT_EQ(std::size(kBaudRates), printed.size());
  Bits tried = 0;
  for (const BaudRate& rate : kBaudRates) {
    EXPECT_EQ(printed.count(rate.baud), 1U);
    LineRig rig(rate.baud);
    auto& slave = rig.add_slave(8);
    Master& master = rig.add_master({});
    master.add_slave(plan_of(8, "F2", 6));
    master.start();
    Time locked_at = 0;
    while (locked_at == 0 && rig.queue.now() < 3 * kSecond) {
      rig.run(kMillisecond);
      if (slave.station.rate().locked()) locked_at = rig.queue.now();
    }
    EXPECT_EQ(slave.station.rate().baud(), rate.baud);
    // Each higher rate costs 100 ms of faults, and what lies between two of them.
    EXPECT_LE(locked_at, (static_cast<Time>(tried++) * 160 + 300) * kMillisecond) << rate.baud;
    rig.run(kSecond);
    EXPECT_TRUE(master.slave(0).exchanging()) << rate.baud;
    EXPECT_GT(slave.unit.taken, 3);
  }
  // At a foreign rate everything is faulty: no other rate is ever tried.
  BaudSearch search;
  for (Time now = 0; now < 10 * kSecond; now += 5 * kMillisecond) {
    search.heard_error(now);
    EXPECT_FALSE(search.locked());
    EXPECT_EQ(printed.count(search.baud()), 1U);
    EXPECT_NE(search.baud(), 3'000'000U);
  }
}

TEST(BaudRate, RarePollsAreEnough) {
  for (const BaudRate& rate : kBaudRates) {
    LineRig rig(rate.baud);
    auto& slave = rig.add_slave(8);
    HandNode a(rig, "a");
    for (int n = 0; n < 40; ++n) {
      a.send(0, kRequest);
      rig.run(200 * kMillisecond);
    }
    EXPECT_EQ(slave.station.rate().baud(), rate.baud);
    EXPECT_TRUE(slave.station.rate().locked());
  }
}

TEST(BaudRate, IdleDoesNotUnlockButFaultsDo) {
  BaudSearch search;
  EXPECT_FALSE(search.heard_frame());
  EXPECT_TRUE(search.heard_frame());
  EXPECT_FALSE(search.heard_error(kSecond));
  EXPECT_FALSE(search.heard_error(kSecond + 99 * kMillisecond));
  EXPECT_TRUE(search.heard_frame());
  EXPECT_FALSE(search.heard_error(90 * kSecond));
  EXPECT_TRUE(search.heard_error(90 * kSecond + 100 * kMillisecond));
  EXPECT_FALSE(search.locked());
}

// --- LEDs and switches of a station on the line

TEST(SlaveStation, LedsFollowTheBus) {
  PROVES("DP-LED-01", "DP-LED-02", "DP-LED-03", "DP-LED-04", "DP-LED-07");
  LineRig rig;
  auto& slave = rig.add_slave(8);
  auto& small = rig.add_slave(9, OptionKind::Size0);
  auto& wrong = rig.add_slave(126);
  const auto pattern = [&](LineRig::Station& s) { return leds(s.station.card_state(rig.queue.now())); };
  EXPECT_EQ(pattern(slave), (LedPattern{Light::ThreeHertz, Light::Off}));
  EXPECT_EQ(pattern(small), (LedPattern{Light::On, Light::On}));  // has no such phase
  rig.run(2 * kSecond);
  EXPECT_EQ(pattern(slave), (LedPattern{Light::On, Light::On}));
  EXPECT_EQ(pattern(wrong), (LedPattern{Light::On, Light::HalfHertz}));
  wrong.station.switches().set({5});
  EXPECT_EQ(pattern(wrong), (LedPattern{Light::On, Light::HalfHertz}));
  wrong.station.power_on(false);
  rig.run(2 * kSecond);
  EXPECT_EQ(pattern(wrong), (LedPattern{Light::On, Light::On}));
  MasterSettings settings;
  settings.slot = 500;  // the min Tsdr of FMS is longer than the slot time of DP
  Master& master = rig.add_master(settings);
  master.add_slave(plan_of(8, "F2", 6, "88 14 01 0B 31 00 00"));
  master.start();
  rig.run(kSecond);
  EXPECT_EQ(pattern(slave), (LedPattern{Light::On, Light::Off}));
  master.stop();
  rig.run(kSecond);
  EXPECT_EQ(pattern(slave), (LedPattern{Light::On, Light::On}));
  // With the switch at FMS both uses count; no FMS connection: red.
  slave.station.switches().set({8, true});
  slave.station.power_on(false);
  rig.run(2 * kSecond);
  master.start();
  rig.run(kSecond);
  EXPECT_EQ(slave.slave().state(), SlaveState::DataExchange);
  EXPECT_EQ(pattern(slave), (LedPattern{Light::On, Light::On}));
  slave.station.set_hardware_fault(HardwareFault::BothFlash);
  EXPECT_EQ(pattern(slave), (LedPattern{Light::OneHertz, Light::OneHertz}));
}

TEST(SlaveStation, AnswersAfterMinTsdr) {
  LineRig rig;
  auto& slave = rig.add_slave(8);
  HandNode a(rig, "a");
  for (int n = 0; n < 200; ++n) {  // until the rate is found
    a.send(0, kRequest);
    rig.run(2 * kMillisecond);
  }
  const auto delay = [&] {
    rig.recorder.heard.clear();
    a.send(0, kRequest);
    rig.run(2 * kMillisecond);
    return (rig.recorder.heard.at(1).reception.start - rig.recorder.heard.at(0).reception.end) / 2'000;
  };
  EXPECT_EQ(delay(), 11);
  slave.slave().set_min_tsdr(60);
  EXPECT_EQ(delay(), 60);
  slave.station.set_reaction(90);
  EXPECT_EQ(delay(), 90);
}

}  // namespace
}  // namespace ipos::tests

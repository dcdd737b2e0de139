// Requests by the rules of the line, MOVLNK exchanges over it, and the sender of master/slave operation.
#include "runtime/bus/movilink/serial_master.hpp"

#include "runtime/bus/movilink/keypad.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

struct Bus {
  explicit Bus(RequesterTiming timing = {}) : master(queue, 50, line, "master", timing) {
    line.add_observer(recorder);
  }
  EventQueue queue;
  Rs485Line line{queue, 0, "line1", 9600};
  Recorder recorder;
  RequestNode master;

  MovilinkResult run(const MovilinkJob& job) {
    recorder.clear();
    const size_t before = master.results.size();
    EXPECT_FALSE(master.master.start(queue.now(), job).has_value());
    queue.run_until(queue.now() + 5 * kSecond);
    EXPECT_EQ(master.results.size(), before + 1);
    EXPECT_FALSE(master.master.busy());
    return master.results.back();
  }
  // Management bytes of requests and responses, as in figure 22: "32/32".
  std::vector<std::string> management() const {
    std::vector<std::string> out;
    for (size_t n = 0; n + 1 < recorder.heard.size(); n += 2)
      out.push_back(recorder.heard[n].text().substr(9, 2) + "/" + recorder.heard[n + 1].text().substr(9, 2));
    return out;
  }
};

const SerialTelegram kPoll{false, 1, kSetpointFormat, {}, {6, 0x3A98, 0x1F4}};
SerialTelegram poll(uint8_t address) {
  SerialTelegram telegram = kPoll;
  telegram.address = address;
  return telegram;
}

TEST(Requester, ResponseDelay) {
  PROVES("TIME-08", "MDB-RS485-12");
  for (const auto& [delay, good] :
       {std::pair<int, bool>{49'000, true}, {49'980, true}, {50'040, false}, {51'000, false}}) {
    Bus bus;
    SlaveNode slave(bus.queue, 1, bus.line, "slave", {1}, {delay * kMicrosecond, 0});
    SlaveNode next(bus.queue, 2, bus.line, "next", {2});
    bus.master.requester.start(0, kPoll, bus.master);
    bus.master.requester.start(0, poll(2), bus.master);
    bus.queue.run_until(kSecond);
    const RequestEnd first = good ? RequestEnd::Answered : RequestEnd::NoResponse;
    EXPECT_EQ(bus.master.ends, (std::vector{first, RequestEnd::Answered})) << delay;
    EXPECT_EQ(bus.master.requester.statistics().of(SerialError::NoResponse), good ? 0U : 2U);
    int requests = 0;
    for (const Heard& heard : bus.recorder.heard) requests += heard.text() == text_of(encode(kPoll).span());
    EXPECT_EQ(requests, good ? 1 : 2) << "one repeat";
  }
}

TEST(Requester, PauseBeforeEachRequest) {
  Bus bus;
  SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
  for (int n = 0; n < 20; ++n) bus.master.requester.start(0, kPoll, bus.master);
  bus.queue.run_until(2 * kSecond);
  EXPECT_EQ(bus.master.ends, std::vector<RequestEnd>(20, RequestEnd::Answered));
  for (size_t n = 1; n < bus.recorder.heard.size(); ++n) {
    const Time pause = bus.recorder.heard[n].reception.start - bus.recorder.heard[n - 1].reception.end;
    EXPECT_GE(pause, 3'440'000);
    EXPECT_LT(pause, 4'100'000) << "nothing is wasted";
  }
}

TEST(Requester, PauseAfterABroadcast) {
  PROVES("RS485-14", "MDB-RS485-22");
  Bus bus;
  std::vector<std::string> findings;
  SlaveNode one(bus.queue, 1, bus.line, "one", {1});
  SlaveNode two(bus.queue, 2, bus.line, "two", {2});
  for (const uint8_t address : std::initializer_list<uint8_t>{255, 1, 255, 255, 101, 2})
    bus.master.requester.start(0, poll(address), bus.master);
  bus.queue.run_until(kSecond);
  EXPECT_EQ(bus.master.ends.size(), 6U);
  const auto& heard = bus.recorder.heard;
  ASSERT_EQ(heard.size(), 8U) << "six requests, two answers";
  for (size_t n = 1; n < heard.size(); ++n) {
    const Time pause = heard[n].reception.start - heard[n - 1].reception.end;
    EXPECT_GE(pause, heard[n - 1].reception.telegram->address == 255 ? 25'000'000 : 3'440'000);
  }
  EXPECT_EQ(one.unit.output, (ProcessWords{6, 0x3A98, 0x1F4}));
  EXPECT_EQ(two.unit.output, (ProcessWords{6, 0x3A98, 0x1F4}));
}

TEST(Requester, PauseAfterARequestThatWasBrokenOff) {
  PROVES("RS485-06");
  for (int bits = 1; bits < 99; bits += 3) {
    Bus bus;
    SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
    bus.master.requester.start(0, kPoll, bus.master);
    bus.queue.run_until(bits * kSecond / 9600);
    bus.master.requester.abort(bus.queue.now(), bus.master);
    EXPECT_FALSE(bus.master.requester.busy());
    bus.master.requester.start(bus.queue.now(), kPoll, bus.master);
    bus.queue.run_until(kSecond);
    EXPECT_EQ(bus.master.ends, std::vector{RequestEnd::Answered}) << bits;
    ASSERT_EQ(bus.recorder.heard.size(), 3U);
    EXPECT_EQ(bus.recorder.heard[0].reception.telegram.error(), SerialError::Gap);
    EXPECT_GE(bus.recorder.heard[1].reception.start - bus.recorder.heard[0].reception.end, 6'880'000);
  }
}

// Disturbs the first `times` transmissions of a station: adds, flips or removes bits.
struct Disturb final : SerialFaults {
  std::function<void(std::vector<bool>&)> how;
  NodeId whose = 0;
  int times = 0;
  void disturb(NodeId sender, std::vector<bool>& bits) override {
    if (sender == whose && times-- > 0) how(bits);
  }
};
void flip(std::vector<bool>& bits, size_t character, std::initializer_list<size_t> which) {
  for (const size_t bit : which) bits[11 * character + bit] = !bits[11 * character + bit];
}

TEST(Requester, ReceptionErrorsAreMissingResponses) {
  PROVES("RS485-21");
  struct Row {
    SerialError error;
    std::function<void(std::vector<bool>&)> how;
  };
  const Row rows[] = {{SerialError::Parity, [](auto& bits) { flip(bits, 4, {9}); }},
                      {SerialError::Frame, [](auto& bits) { flip(bits, 4, {10}); }},
                      {SerialError::Gap, [](auto& bits) { bits.insert(bits.begin() + 55, 40, true); }},
                      {SerialError::Address,
                       [](auto& bits) {
                         flip(bits, 1, {3, 4}), flip(bits, 9, {3, 4});
                       }},
                      {SerialError::Type,
                       [](auto& bits) {
                         flip(bits, 2, {4, 5});
                       }},
                      {SerialError::BlockCheck, [](auto& bits) {
                         flip(bits, 5, {1, 2});
                       }}};
  for (const Row& row : rows)
    for (const int times : {1, 2}) {
      Bus bus;
      SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
      Disturb faults;
      faults.how = row.how;
      faults.whose = bus.master.port.node();
      faults.times = times;
      bus.line.set_faults(&faults);
      bus.master.requester.start(0, kPoll, bus.master);
      bus.queue.run_until(kSecond);
      EXPECT_EQ(bus.master.ends, std::vector{times == 1 ? RequestEnd::Answered : RequestEnd::NoResponse})
          << serial_error_text(row.error);
      ASSERT_FALSE(slave.unit.rejected.empty());
      EXPECT_EQ(slave.unit.rejected[0], row.error);
      EXPECT_EQ(slave.unit.channels.size(), times == 1 ? 1U : 0U);
    }
  // Types that do not exist, with correct BCC.
  for (const char* type : {"07", "7F", "87", "FF"}) {
    SlaveBench bench({1});
    bench.feed(telegram("02 01 " + std::string(type) + " 00 06 3A 98 01 F4"), 10 * kMillisecond);
    EXPECT_TRUE(bench.answers().empty() && bench.unit.untouched());
    EXPECT_EQ(bench.unit.rejected, std::vector{SerialError::Type});
  }
}

TEST(Requester, DisturbedResponses) {
  for (const int times : {1, 2})
    for (const int kind : {0, 1, 2, 3}) {
      Bus bus;
      SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
      Disturb faults;
      faults.how = [kind](std::vector<bool>& bits) {
        if (kind == 0) flip(bits, 4, {9});
        if (kind == 1) flip(bits, 9, {1, 2});
        if (kind == 2) bits.resize(44);
        if (kind == 3) bits.insert(bits.begin() + 22, 40, true);
      };
      faults.whose = slave.port.node();
      faults.times = times;
      bus.line.set_faults(&faults);
      bus.master.requester.start(0, kPoll, bus.master);
      bus.queue.run_until(kSecond);
      EXPECT_EQ(bus.master.ends, std::vector{times == 1 ? RequestEnd::Answered : RequestEnd::Disturbed})
          << kind;
      EXPECT_EQ(slave.unit.channels.size(), 2U);
    }
}

TEST(Requester, NobodyNoLineNoSilence) {
  Bus alone;
  alone.master.requester.start(0, kPoll, alone.master);
  alone.queue.run_until(kSecond);
  EXPECT_EQ(alone.master.ends, std::vector{RequestEnd::NoResponse});
  // Two attempts of 11.46 ms and 50 ms (and one character: it might have begun in time), a pause between
  // them.
  EXPECT_NEAR(static_cast<double>(alone.master.end_times[0]) / 1e6, 2 * (11.46 + 50 + 1.15) + 3.44, 0.1);

  Bus cut;
  cut.line.set_connected(cut.master.port.node(), false);
  cut.master.requester.start(0, kPoll, cut.master);
  cut.queue.run_until(kSecond);
  EXPECT_EQ(cut.master.ends, std::vector{RequestEnd::NoResponse});
  EXPECT_TRUE(cut.recorder.heard.empty());

  Bus torn;
  SlaveNode slave(torn.queue, 1, torn.line, "slave", {1});
  torn.master.requester.start(0, kPoll, torn.master);
  torn.queue.run_until(5 * kMillisecond);
  torn.line.set_connected(torn.master.port.node(), false);
  torn.queue.run_until(200 * kMillisecond);
  torn.line.set_connected(torn.master.port.node(), true);
  torn.queue.run_until(kSecond);
  EXPECT_EQ(torn.master.ends, std::vector{RequestEnd::NoResponse});
  torn.master.requester.start(torn.queue.now(), kPoll, torn.master);
  torn.queue.run_until(2 * kSecond);
  EXPECT_EQ(torn.master.ends.back(), RequestEnd::Answered);

  Bus noisy;
  HandNode babbler(noisy.line, "babbler");
  for (int n = 0; n < 10; ++n) noisy.queue.run_until(noisy.queue.now() + kMillisecond);
  babbler.send(Bytes(1500, 0x33));  // 1.7 s of characters
  noisy.queue.run_until(noisy.queue.now() + 10 * kMillisecond);
  noisy.master.requester.start(noisy.queue.now(), kPoll, noisy.master);
  noisy.queue.run_until(3 * kSecond);
  EXPECT_EQ(noisy.master.ends, std::vector{RequestEnd::LineBusy});
}

TEST(SerialMaster, FormatsAreTheTypes) {
  PROVES("MOVLNK-06");
  for (const int acyclic : {0, 128})
    for (int format = 0; format <= 6; ++format) {
      Bus bus;
      SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
      const MovilinkResult result =
          bus.run({1, format + acyclic, 1, format % 2 == 1 ? -77 : 8318, 0, {6, 5, 4}});
      EXPECT_EQ(result.result, 0U) << format;
      for (const Heard& heard : bus.recorder.heard)
        EXPECT_EQ(heard.reception.bytes.data[2], format + acyclic);
      const size_t exchanges = format % 2 == 1 || acyclic != 0 ? 1 : 3;
      EXPECT_EQ(bus.recorder.heard.size(), 2 * exchanges);
      EXPECT_EQ(result.read_value.has_value(), format % 2 == 0);
      if (result.read_value) {
        EXPECT_EQ(*result.read_value, 1'000'000);
      }
      EXPECT_EQ(result.words, format == 6 ? 0 : format / 2 + 1);
      if (result.words > 0) {
        EXPECT_EQ(result.input[0], 0x0407);
      }
      const ProcessWords expected = {static_cast<uint16_t>(format == 6 ? 0 : 6),
                                     static_cast<uint16_t>(format >= 2 && format < 6 ? 5 : 0),
                                     static_cast<uint16_t>(format == 4 || format == 5 ? 4 : 0)};
      EXPECT_EQ(slave.unit.output, expected);
    }
}

TEST(SerialMaster, HandshakeTrace) {
  PROVES("EX-06");
  Bus bus;
  SlaveNode slave(bus.queue, 1, bus.line, "slave", {1}, {4 * kMillisecond, 60 * kMillisecond});
  EXPECT_EQ(bus.run({1, 6, 2, 8470, 2500, {}}).result, 0U);
  const auto first = bus.management();
  // First contact: a service that does nothing shows the bit of the slave.
  EXPECT_EQ(first, (std::vector<std::string>{"30/30", "32/32", "72/32", "72/32", "72/72"}));
  EXPECT_EQ(slave.unit.parameters[8470], 2500);
  EXPECT_EQ(bus.run({1, 6, 2, 8470, 2600, {}}).result, 0U);
  EXPECT_EQ(bus.management(), (std::vector<std::string>{"72/72", "32/72", "32/72", "32/32"}));
  EXPECT_EQ(slave.unit.requests.size(), 2U);
  // Ten writes, ten executions.
  for (int n = 0; n < 10; ++n) EXPECT_EQ(bus.run({1, 6, 2, 8470, n, {}}).result, 0U);
  EXPECT_EQ(slave.unit.requests.size(), 12U);
  EXPECT_EQ(slave.unit.parameters[8470], 9);
}

TEST(SerialMaster, ASlaveThatWasSwitchedOffIsNotBelieved) {
  Bus bus;
  auto slave = std::make_unique<SlaveNode>(bus.queue, 1, bus.line, "slave", SerialSlaveSettings{1});
  EXPECT_EQ(bus.run({1, 6, 1, 8318, 0, {}}).read_value, 1'000'000);
  bus.line.set_connected(slave->port.node(), false);
  SlaveNode fresh(bus.queue, 2, bus.line, "fresh", {1});
  EXPECT_EQ(bus.run({1, 6, 1, 8318, 0, {}}).read_value, 1'000'000);
  EXPECT_GE(fresh.unit.requests.size(), 1U);
  EXPECT_EQ(bus.run({1, 6, 1, 8318, 0, {}}).read_value, 1'000'000);
}

TEST(SerialMaster, LostResponsesDoNotRepeatAService) {
  Bus bus;
  SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
  EXPECT_EQ(bus.run({1, 6, 2, 8470, 1, {}}).result, 0U);
  Disturb faults;
  faults.how = [](std::vector<bool>& bits) { flip(bits, 3, {9}); };
  faults.whose = slave.port.node();
  faults.times = 0;
  bus.line.set_faults(&faults);
  // The response to the second telegram of the exchange, the one that hands the service over, is lost.
  struct Second final : SerialFaults {
    NodeId whose;
    int number = 0;
    void disturb(NodeId sender, std::vector<bool>& bits) override {
      if (sender == whose && ++number == 2) flip(bits, 3, {9});
    }
  } second;
  second.whose = slave.port.node();
  bus.line.set_faults(&second);
  EXPECT_EQ(bus.run({1, 6, 2, 8470, 2, {}}).result, 0U);
  EXPECT_EQ(slave.unit.requests.size(), 2U);
  EXPECT_EQ(slave.unit.parameters[8470], 2);
}

TEST(SerialMaster, AddressesReachTheirUnits) {
  PROVES("MOVLNK-05");
  Bus bus;
  SlaveNode one(bus.queue, 1, bus.line, "one", {1, 101});
  SlaveNode two(bus.queue, 2, bus.line, "two", {2, 101});
  SlaveNode three(bus.queue, 3, bus.line, "three", {99, 199});
  SlaveNode* units[] = {&one, &two, &three};
  const auto reached = [&](const MovilinkJob& job) {
    for (SlaveNode* unit : units) unit->unit.parameters[8470] = 2000;
    EXPECT_EQ(bus.run(job).result, 0U);
    std::string who;
    for (SlaveNode* unit : units) who += unit->unit.parameters[8470] == 7 ? 'x' : '-';
    return who;
  };
  for (const int format : {6, 134}) {
    EXPECT_EQ(reached({1, format, 2, 8470, 7, {}}), "x--");
    EXPECT_EQ(reached({99, format, 3, 8470, 7, {}}), "--x");
    EXPECT_EQ(reached({101, format, 2, 8470, 7, {}}), "xx-");
    EXPECT_EQ(reached({199, format, 2, 8470, 7, {}}), "--x");
    EXPECT_EQ(reached({100, format, 2, 8470, 7, {}}), "---");
    EXPECT_EQ(reached({255, format, 2, 8470, 7, {}}), "xxx");
  }
  Bus point;
  SlaveNode only(point.queue, 1, point.line, "only", {47});
  EXPECT_EQ(point.run({254, 4, 1, 8318, 0, {6, 0, 0}}).read_value, 1'000'000);
  // What cannot be sent.
  for (const MovilinkJob& job : {MovilinkJob{200, 5, 0, 0, 0, {}},
                                 {252, 5, 0, 0, 0, {}},
                                 {253, 5, 0, 0, 0, {}},
                                 {256, 5, 0, 0, 0, {}},
                                 {-1, 5, 0, 0, 0, {}},
                                 {1, 7, 1, 8318, 0, {}},
                                 {1, 6, 0, 8318, 0, {}},
                                 {1, 6, 9, 8318, 0, {}},
                                 {101, 6, 1, 8318, 0, {}},
                                 {255, 134, 1, 8318, 0, {}},
                                 {1, 6, 1, -1, 0, {}}})
    EXPECT_EQ(bus.master.master.start(bus.queue.now(), job), return_codes::kWrongManagement) << job.address;
}

TEST(SerialMaster, FailuresHaveResults) {
  Bus bus;
  SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
  MovilinkResult result = bus.run({1, 132, 1, 9999, 0, {6, 0, 0}});
  EXPECT_EQ(result.result, 0x08000010U);
  EXPECT_FALSE(result.read_value.has_value());
  EXPECT_EQ(result.words, 0);
  result = bus.run({1, 4, 2, 8318, 5, {6, 0, 0}});
  EXPECT_EQ(result.result, 0x08000012U);
  const Time begin = bus.queue.now();
  result = bus.run({5, 134, 1, 8318, 0, {}});
  EXPECT_EQ(result.result, 0x06020000U);
  EXPECT_EQ(result.reason, "response delay time elapsed");
  EXPECT_LT(bus.master.end_times.back() - begin, 140 * kMillisecond);
  // A service that never ends.
  Bus hung;
  SlaveNode busy(hung.queue, 1, hung.line, "busy", {1}, {4 * kMillisecond, 60 * kSecond});
  result = hung.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(result.result, 0x06020000U);
  EXPECT_EQ(result.reason, "the handshake bit did not come back");
}

TEST(SerialMaster, AbortLeavesNothingBehind) {
  Bus bus;
  SlaveNode slave(bus.queue, 1, bus.line, "slave", {1});
  for (int ms = 1; ms < 150; ms += 7) {
    const size_t before = bus.master.results.size();
    EXPECT_FALSE(bus.master.master.start(bus.queue.now(), {1, 4, 1, 8318, 0, {6, 0, 0}}).has_value());
    bus.queue.run_until(bus.queue.now() + ms * kMillisecond);
    if (bus.master.results.size() != before) break;
    bus.master.master.abort();
    EXPECT_FALSE(bus.master.master.busy());
    bus.queue.run_until(bus.queue.now() + kSecond);
    EXPECT_EQ(bus.master.results.size(), before) << ms;
    EXPECT_EQ(bus.run({1, 4, 1, 8318, 0, {6, 0, 0}}).result, 0U) << ms;
  }
}

TEST(MasterSlave, SetpointsOverAndOver) {
  EventQueue queue;
  Rs485Line line(queue, 0, "line1", 9600);
  Recorder recorder;
  line.add_observer(recorder);
  RequestNode master(queue, 10, line, "master");
  UnitModel drive;
  drive.setpoint = {6, 5000, 0};
  SetpointSender sender(queue, 10, master.requester, drive);
  SlaveNode slave(queue, 11, line, "slave", {1, 101, false, true});
  SlaveNode other(queue, 12, line, "other", {2, 102, false, true});
  sender.start(0, 101);
  queue.run_until(kSecond);
  EXPECT_EQ(slave.unit.setpoint, (ProcessWords{6, 5000, 0}));
  EXPECT_NEAR(static_cast<double>(slave.unit.setpoints.size()), 50, 1);
  EXPECT_TRUE(other.unit.setpoints.empty());
  for (const Heard& heard : recorder.heard) EXPECT_EQ(heard.text().substr(0, 8), "02 65 05");
  // MOVLNK of the same unit goes in between.
  EXPECT_FALSE(master.master.start(queue.now(), {1, 134, 1, 8318, 0, {}}).has_value());
  queue.run_until(2 * kSecond);
  EXPECT_EQ(master.results.at(0).read_value, 1'000'000);
  EXPECT_GT(slave.unit.setpoints.size(), 95U);
  sender.stop();
  queue.run_until(3 * kSecond);
  EXPECT_EQ(slave.unit.lost.size(), 1U);
  EXPECT_EQ(slave.unit.lost[0], slave.unit.setpoints.back() + 500 * kMillisecond);
}

TEST(Keypad, SendsCyclicRequestsAllTheTime) {
  EventQueue queue;
  Rs485Line line(queue, 0, "keypad", 9600);
  SlaveNode unit(queue, 1, line, "unit", {17});
  const Keypad keypad(queue, 2, line);
  queue.run_until(10 * kSecond);
  EXPECT_NEAR(static_cast<double>(unit.unit.cyclic.size()), 100, 1);
  EXPECT_TRUE(unit.unit.requests.empty());
  EXPECT_TRUE(unit.unit.channels.empty()) << "no process data";
}

}  // namespace
}  // namespace ipos::tests

// The requester and the master of RS-485 to the nanosecond, at a sender that keeps what it is given: pauses, waits,
// repeats, what counts as the answer, and the handshake of a service.
#include "runtime/bus/movilink/serial_requester.hpp"

#include <functional>

#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

// 1053 1610 p. 19-28; a character has 11 bits of 9600 baud.
constexpr Time kChar = wire_time(1, 9600);
constexpr Time kPause = 3'440 * kMicrosecond;
constexpr Time kDelay = 50 * kMillisecond;

// A wire that can be dead, and that tells when a transmission was broken off.
class CountingWire final : public SerialSender {
 public:
  explicit CountingWire(EventQueue& queue) : queue_(queue) {}
  bool send(std::span<const uint8_t> bytes) override {
    if (dead) return false;
    sent.emplace_back(queue_.now(), text_of(bytes));
    return true;
  }
  void break_off() override { broken.push_back(queue_.now()); }
  bool dead = false;
  std::vector<std::pair<Time, std::string>> sent;
  std::vector<Time> broken;

 private:
  EventQueue& queue_;
};

struct Ended final : RequesterClient {
  void on_request_done(Time now, RequestEnd end, const SerialTelegram* response) override {
    ends.emplace_back(now, end, response != nullptr);
  }
  std::vector<std::tuple<Time, RequestEnd, bool>> ends;
};
using End = std::tuple<Time, RequestEnd, bool>;

struct Desk {
  explicit Desk(RequesterTiming timing = {.repeats = 0, .character = kChar})
      : requester(queue, 1, wire, timing) {}
  void start(uint8_t address, RequesterClient& who) {
    requester.start(queue.now(), {false, address, {false, 1, false}, {}, {1, 0, 0}}, who);
  }
  // The request is out; at its last stop bit.
  Time out() {
    queue.run_until(queue.now() + 6 * kChar);
    requester.on_sent(queue.now());
    return queue.now();
  }
  // Characters without a gap from `start` on.
  void hear(Time start, const std::string& text, uint8_t faulty = 0xFF) {
    uint8_t number = 0;
    for (const uint8_t byte : hex(text)) {
      queue.run_until(start + kChar - 1);
      Character character{start, start + kChar, byte, number == faulty, false};
      ++number;
      start = character.end;
      requester.on_character(character.end, character);
    }
  }
  EventQueue queue;
  CountingWire wire{queue};
  SerialRequester requester;
  Ended a, b;
};

const std::string kRequest = "02 01 01 00 01 03", kAnswer = "1D 01 01 00 01 1C";

TEST(Requester, AnAnswerBeginsWithinTheDelay) {
  for (const Time late : {Time{0}, Time{1}}) {
    Desk desk;
    desk.start(1, desk.a);
    desk.queue.run_until(0);
    EXPECT_EQ(desk.wire.sent, (std::vector{std::pair{Time{0}, kRequest}}));
    const Time out = desk.out();
    EXPECT_TRUE(desk.requester.busy());
    desk.hear(out + kDelay + late, kAnswer);
    desk.queue.run_until(kSecond);
    // One character longer is waited: one that begins in time is known when it has ended.
    const End expected = late == 0 ? End{out + kDelay + 6 * kChar, RequestEnd::Answered, true}
                                   : End{out + kDelay + kChar, RequestEnd::NoResponse, false};
    EXPECT_EQ(desk.a.ends, std::vector{expected});
    EXPECT_EQ(desk.requester.statistics().of(SerialError::NoResponse), late == 0 ? 0U : 1U);
    EXPECT_FALSE(desk.requester.busy());
  }
}

// The start pause is also that between a request and its response (p. 19); what comes earlier is no telegram.
TEST(Requester, AnAnswerKeepsTheStartPause) {
  for (const Time more : {Time{-1}, Time{0}}) {
    Desk desk;
    desk.start(1, desk.a);
    desk.queue.run_until(0);
    const Time out = desk.out();
    desk.hear(out + kPause + more, kAnswer);
    desk.queue.run_until(kSecond);
    const End right{out + kPause + 6 * kChar, RequestEnd::Answered, true};
    const End none{out + kDelay + kChar, RequestEnd::NoResponse, false};
    EXPECT_EQ(desk.a.ends, std::vector{more < 0 ? none : right});
    EXPECT_EQ(desk.requester.statistics().of(SerialError::Pause), more < 0 ? 1U : 0U);
  }
}

TEST(Requester, NothingElseIsTheAnswer) {
  // Another slave's, a request, and another type; then the right one, in time or not at all.
  for (const char* other :
       {"1D 02 01 00 01 1F", "02 01 01 00 01 03", "1D 01 81 00 01 9C", "1D 64 01 00 01 79"})
    for (const bool answered : {false, true}) {
      Desk desk;
      desk.start(1, desk.a);
      desk.queue.run_until(0);
      const Time out = desk.out();
      desk.hear(out + 4 * kMillisecond, other);
      EXPECT_TRUE(desk.a.ends.empty()) << other;
      if (answered) desk.hear(out + 20 * kMillisecond, kAnswer);
      desk.queue.run_until(kSecond);
      const End right{out + 20 * kMillisecond + 6 * kChar, RequestEnd::Answered, true};
      const End none{out + kDelay + kChar, RequestEnd::NoResponse, false};
      EXPECT_EQ(desk.a.ends, std::vector{answered ? right : none}) << other;
    }
  // One that lasts beyond the delay.
  Desk desk;
  desk.start(1, desk.a);
  desk.queue.run_until(0);
  const Time out = desk.out();
  desk.hear(out + kDelay - kMillisecond, "1D 02 01 00 01 1F");
  desk.queue.run_until(kSecond);
  EXPECT_EQ(desk.a.ends,
            std::vector{(End{out + kDelay - kMillisecond + 6 * kChar, RequestEnd::NoResponse, false})});
}

TEST(Requester, AResponseThatIsCutOrFaulty) {
  Desk cut;
  cut.start(1, cut.a);
  cut.queue.run_until(0);
  Time out = cut.out();
  cut.hear(out + 4 * kMillisecond, "1D 01 01");
  cut.queue.run_until(kSecond);
  // A gap of 3.43 ms, and one character that might have begun in it.
  EXPECT_EQ(cut.a.ends, std::vector{(End{out + 4 * kMillisecond + 4 * kChar + 3'430 * kMicrosecond,
                                         RequestEnd::Disturbed, false})});
  EXPECT_EQ(cut.requester.statistics().of(SerialError::Gap), 1U);
  EXPECT_EQ(cut.requester.statistics().of(SerialError::NoResponse), 0U);
  Desk faulty;
  faulty.start(1, faulty.a);
  faulty.queue.run_until(0);
  out = faulty.out();
  faulty.hear(out + 4 * kMillisecond, "1D 01 01 00", 3);
  EXPECT_EQ(faulty.a.ends,
            std::vector{(End{out + 4 * kMillisecond + 4 * kChar, RequestEnd::Disturbed, false})});
  EXPECT_EQ(faulty.requester.statistics().of(SerialError::Parity), 1U);
}

TEST(Requester, RepeatsAfterAPause) {
  for (const uint32_t repeats : {0U, 1U, 3U}) {
    Desk desk({.repeats = repeats, .character = kChar});
    desk.start(1, desk.a);
    desk.queue.run_until(0);
    for (uint32_t n = 0; n <= repeats; ++n) {
      ASSERT_EQ(desk.wire.sent.size(), n + 1);
      const Time out = desk.out();
      desk.queue.run_until(out + kDelay + kChar - 1);
      EXPECT_TRUE(desk.a.ends.empty());
      desk.queue.run_until(out + kDelay + kChar + kPause);
      if (n < repeats) {
        EXPECT_EQ(desk.wire.sent.back().first, out + kDelay + kChar + kPause);
      }
    }
    desk.queue.run_until(10 * kSecond);
    EXPECT_EQ(desk.wire.sent.size(), repeats + 1);
    ASSERT_EQ(desk.a.ends.size(), 1U);
    EXPECT_EQ(desk.requester.statistics().of(SerialError::NoResponse), repeats + 1);
    // The next request has its own repeats.
    desk.start(1, desk.a);
    desk.queue.run_until(11 * kSecond);
    EXPECT_EQ(desk.wire.sent.size(), 2 * (repeats + 1));
  }
}

TEST(Requester, PausesBeforeTheNextRequest) {
  // After its own request to a group, after a broadcast, and after what others send.
  for (const auto& [address, pause] : {std::pair<uint8_t, Time>{101, kPause}, {255, 25 * kMillisecond}}) {
    Desk desk;
    desk.start(address, desk.a);
    desk.start(1, desk.b);
    desk.queue.run_until(0);
    const Time out = desk.out();
    EXPECT_EQ(desk.a.ends, std::vector{(End{out, RequestEnd::Sent, false})});
    desk.queue.run_until(kSecond);
    ASSERT_EQ(desk.wire.sent.size(), 2U);
    EXPECT_EQ(desk.wire.sent[1].first, out + pause);
  }
  Desk desk;
  desk.hear(1000, "1D 02 01 00 01 1F");
  desk.queue.run_until(1000 + 6 * kChar);
  desk.start(1, desk.a);
  desk.queue.run_until(kSecond);
  EXPECT_EQ(desk.wire.sent.at(0).first, 1000 + 6 * kChar + kPause);
  // A character that is heard while it waits lengthens the pause, and one that came before does not shorten it.
  Desk waiting;
  waiting.start(255, waiting.a);
  waiting.start(1, waiting.b);
  waiting.queue.run_until(0);
  const Time out = waiting.out();
  waiting.hear(out + kMillisecond, "55");
  waiting.queue.run_until(kSecond);
  EXPECT_EQ(waiting.wire.sent.at(1).first, out + 25 * kMillisecond);
  Desk longer;
  longer.start(101, longer.a);
  longer.start(1, longer.b);
  longer.queue.run_until(0);
  const Time end = longer.out();
  longer.hear(end + kMillisecond, "55");
  longer.queue.run_until(kSecond);
  EXPECT_EQ(longer.wire.sent.at(1).first, end + kMillisecond + kChar + kPause);
}

TEST(Requester, ALineThatIsNeverSilent) {
  Desk desk({.line_wait = 100 * kMillisecond, .repeats = 1, .character = kChar});
  desk.hear(0, "55");
  desk.queue.run_until(kChar);
  desk.start(1, desk.a);
  for (Time at = 2 * kMillisecond; at < 150 * kMillisecond; at += 2 * kMillisecond) desk.hear(at, "55");
  EXPECT_TRUE(desk.wire.sent.empty());
  EXPECT_EQ(desk.a.ends, std::vector{(End{kChar + 100 * kMillisecond, RequestEnd::LineBusy, false})})
      << "it is not repeated";
}

TEST(Requester, ALineThatIsNotThereOrIsCut) {
  Desk dead;
  dead.wire.dead = true;
  dead.start(1, dead.a);
  dead.queue.run_until(kSecond);
  EXPECT_EQ(dead.a.ends, std::vector{(End{kDelay, RequestEnd::NoResponse, false})});
  // Without word of the end: the request and one character, then the delay.
  Desk cut;
  cut.start(1, cut.a);
  cut.queue.run_until(kSecond);
  EXPECT_EQ(cut.a.ends, std::vector{(End{7 * kChar + kDelay, RequestEnd::NoResponse, false})});
}

TEST(Requester, ItsOwnEchoIsNoNews) {
  Desk desk;
  desk.start(1, desk.a);
  desk.queue.run_until(0);
  desk.hear(0, "1D 01 01 00 01");  // while it sends
  desk.queue.run_until(6 * kChar);
  desk.requester.on_sent(6 * kChar);
  // The last character of the echo began before the end of the request.
  desk.requester.on_character(6 * kChar, {5 * kChar, 6 * kChar, 0x1D, false, false});
  desk.hear(6 * kChar + kPause, kAnswer);
  ASSERT_EQ(desk.a.ends.size(), 1U);
  EXPECT_EQ(std::get<1>(desk.a.ends[0]), RequestEnd::Answered);
  for (const SerialError error : {SerialError::Pause, SerialError::Start, SerialError::Gap})
    EXPECT_EQ(desk.requester.statistics().of(error), 0U) << serial_error_text(error);
}

TEST(Requester, AbortForgetsTheRequestsOfOneClient) {
  Desk desk;
  desk.requester.abort(0, desk.a);  // there is none
  desk.start(1, desk.a);
  desk.start(2, desk.b);
  desk.start(3, desk.a);
  desk.queue.run_until(kMillisecond);
  desk.requester.abort(kMillisecond, desk.b);
  EXPECT_TRUE(desk.wire.broken.empty()) << "one that waits";
  desk.start(4, desk.b);
  desk.requester.abort(kMillisecond, desk.a);
  EXPECT_EQ(desk.wire.broken, std::vector{kMillisecond});
  desk.queue.run_until(kSecond);
  // Twice the start pause after the character on the wire (p. 19).
  ASSERT_EQ(desk.wire.sent.size(), 2U);
  EXPECT_EQ(desk.wire.sent[1].second.substr(0, 5), "02 04");
  EXPECT_EQ(desk.wire.sent[1].first, kMillisecond + kChar + 2 * kPause);
  EXPECT_TRUE(desk.a.ends.empty());
  EXPECT_EQ(desk.b.ends.size(), 1U);
  // One that waits for its answer is not on the wire.
  Desk waiting;
  waiting.start(1, waiting.a);
  waiting.queue.run_until(0);
  const Time out = waiting.out();
  waiting.requester.abort(out, waiting.a);
  waiting.start(2, waiting.b);
  EXPECT_TRUE(waiting.wire.broken.empty());
  waiting.queue.run_until(kSecond);
  EXPECT_EQ(waiting.wire.sent.at(1).first, out + kPause);
  EXPECT_TRUE(waiting.a.ends.empty());
}

TEST(Requester, EndsHaveTexts) {
  EXPECT_EQ(request_end_text(RequestEnd::Answered), "answered");
  EXPECT_EQ(request_end_text(RequestEnd::Disturbed), "the response was disturbed");
  EXPECT_EQ(request_end_text(RequestEnd::LineBusy), "the line was never silent for the start pause");
}

// --- MOVLNK

// A slave of a few lines: what it answers to each request; without an answer nothing comes.
struct Exchange final : MovilinkClient {
  using Slave = std::function<std::optional<SerialTelegram>(const SerialTelegram&)>;
  explicit Exchange(Slave its_slave) : slave(std::move(its_slave)) {}
  void on_exchange_done(Time now, const MovilinkResult& result) override { done.emplace_back(now, result); }
  MovilinkResult run(const MovilinkJob& job) {
    const size_t before = done.size();
    EXPECT_EQ(master.start(desk.queue.now(), job), std::nullopt);
    while (done.size() == before && desk.queue.now() < 1000 * kSecond) {
      const size_t sent = desk.wire.sent.size();
      desk.queue.run_until(desk.queue.now() + 100 * kMicrosecond);
      if (desk.wire.sent.size() == sent) continue;
      const SerialTelegram request = *decode_serial(hex(desk.wire.sent.back().second));
      requests.push_back(request);
      desk.queue.run_until(desk.wire.sent.back().first + encode(request).size * kChar);
      desk.requester.on_sent(desk.queue.now());
      if (const auto answer = slave(request))
        desk.hear(desk.queue.now() + 4 * kMillisecond, text_of(encode(*answer).span()));
    }
    EXPECT_EQ(done.size(), before + 1);
    return done.back().second;
  }
  // The management bytes of the requests since the last call.
  std::string management() {
    std::string text;
    for (const SerialTelegram& request : std::exchange(requests, {}))
      text += text_of({{request.parameter.management}}) + " ";
    return text;
  }
  Desk desk;
  Slave slave;
  SerialMaster master{desk.queue, desk.requester, *this};
  std::vector<SerialTelegram> requests;
  std::vector<std::pair<Time, MovilinkResult>> done;
};

SerialTelegram answered(const SerialTelegram& request, int32_t value = 7) {
  SerialTelegram answer = request;
  answer.response = true;
  answer.parameter = parameter_response(request.parameter, value);
  answer.words = {0x8000, 2, 3};
  return answer;
}

TEST(SerialMaster, AResponseToAnotherParameterIsNone) {
  for (const int what : {0, 1, 2, 3}) {
    Exchange exchange([what](const SerialTelegram& request) {
      SerialTelegram answer = answered(request);
      if (what == 1) answer.parameter.index = 8319;
      if (what == 2) answer.parameter.management ^= 3;  // write in place of read
      if (what == 3) answer.parameter.subindex = 9;     // not looked at
      return std::optional(answer);
    });
    const MovilinkResult result = exchange.run({1, 132, 1, 8318, 0, {}});
    if (what == 0 || what == 3) {
      EXPECT_EQ(result.result, 0U);
      EXPECT_EQ(result.read_value, 7);
      EXPECT_EQ(result.words, 3);
      EXPECT_EQ(result.input, (std::array<int32_t, 3>{-32768, 2, 3}));
      continue;
    }
    EXPECT_EQ(result.result, 0x06020000U);
    EXPECT_EQ(result.reason, "the response is to another parameter");
    EXPECT_EQ(result.read_value, std::nullopt);
    EXPECT_EQ(result.words, 0);
  }
  // Without a parameter channel nobody looks there.
  Exchange words([](const SerialTelegram& request) { return std::optional(answered(request)); });
  const MovilinkResult result = words.run({0, 3, 1, 8318, 0, {0x12345, -1, 9}});
  EXPECT_EQ(result.result, 0U);
  EXPECT_EQ(result.words, 2);
  EXPECT_EQ(result.input, (std::array<int32_t, 3>{-32768, 2, 0}));
  EXPECT_EQ(result.read_value, std::nullopt);
  EXPECT_EQ(words.requests.at(0).words, (ProcessWords{0x2345, 0xFFFF, 0}));
}

TEST(SerialMaster, AWriteReadsNothingAndARefusalStoresNothing) {
  for (const int service : {1, 2, 3, 4}) {
    Exchange exchange([](const SerialTelegram& request) { return std::optional(answered(request)); });
    EXPECT_EQ(exchange.run({1, 134, service, 8470, 7, {}}).read_value.has_value(),
              service != 2 && service != 3);
    EXPECT_EQ(exchange.run({1, 6, service, 8470, 7, {}}).read_value.has_value(),
              service != 2 && service != 3);
  }
  Exchange exchange([](const SerialTelegram& request) {
    SerialTelegram answer = answered(request);
    answer.parameter = parameter_refusal(request.parameter, return_codes::kReadOnly);
    return std::optional(answer);
  });
  const MovilinkResult result = exchange.run({1, 132, 1, 8470, 7, {}});
  EXPECT_EQ(result.result, 0x08000012U);
  EXPECT_EQ(result.read_value, std::nullopt);
  EXPECT_EQ(result.words, 0);
  EXPECT_EQ(result.input, (std::array<int32_t, 3>{}));
  EXPECT_EQ(result.reason, "") << "the slave has answered";
}

// A slave whose bit changes with each service (figure 22), or stays where it is.
struct BitSlave {
  bool bit = false, hung = false;
  std::optional<SerialTelegram> operator()(const SerialTelegram& request) {
    SerialTelegram answer = answered(request);
    if (!hung) bit = request.parameter.synchronous();
    answer.parameter.management =
        static_cast<uint8_t>((answer.parameter.management & ~0x40) | (bit ? 0x40 : 0));
    return answer;
  }
};

TEST(SerialMaster, TheBitOfEachAddressIsKnownByItself) {
  std::map<uint8_t, BitSlave> slaves;
  Exchange exchange([&](const SerialTelegram& request) { return slaves[request.address](request); });
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "30 32 72 ") << "learn, prepare, hand over";
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "72 32 ");
  exchange.run({2, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "30 32 72 ") << "another slave";
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "32 72 ");
  // A group gets both values of the bit, and after it no bit is known.
  exchange.slave = [](const SerialTelegram&) { return std::nullopt; };
  EXPECT_EQ(exchange.run({101, 6, 2, 8470, 1, {}}).result, 0U);
  EXPECT_EQ(exchange.management(), "32 72 ");
  exchange.slave = [&](const SerialTelegram& request) { return slaves[request.address](request); };
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "30 32 72 ");
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "72 32 ");
  // Nor after a request without an answer, or one that was given up.
  exchange.slave = [](const SerialTelegram&) { return std::nullopt; };
  EXPECT_EQ(exchange.run({1, 6, 2, 8470, 1, {}}).result, 0x06020000U);
  EXPECT_EQ(exchange.management(), "32 ");
  exchange.slave = [&](const SerialTelegram& request) { return slaves[request.address](request); };
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "30 32 72 ");
  exchange.master.abort();
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "72 32 ") << "nothing was begun";
  EXPECT_EQ(exchange.master.start(exchange.desk.queue.now(), {1, 6, 2, 8470, 1, {}}), std::nullopt);
  exchange.master.abort();
  exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(exchange.management(), "30 32 72 ");
}

// Each step may last one second (ours); what is not confirmed is asked again with the same bit.
TEST(SerialMaster, AStepLastsASecondAtMost) {
  BitSlave slave;
  slave.bit = slave.hung = true;
  Exchange exchange([&](const SerialTelegram& request) { return slave(request); });
  const MovilinkResult result = exchange.run({1, 6, 2, 8470, 1, {}});
  EXPECT_EQ(result.result, 0x06020000U);
  EXPECT_EQ(result.reason, "the handshake bit did not come back");
  // Twelve characters each way, 4 ms and the start pause between them: 34.94 ms.
  EXPECT_EQ(exchange.requests.size(), 29U);
  EXPECT_EQ(exchange.done[0].first,
            28 * (24 * kChar + 4 * kMillisecond + kPause) + 24 * kChar + 4 * kMillisecond);
  for (const SerialTelegram& request : exchange.requests)
    EXPECT_EQ(request.parameter, parameter_request(Service::None, 0, 0, 0));
  // Two steps of 26 exchanges or 0.9 s each, and one of a single exchange between them.
  int number = 0;
  BitSlave slow;
  slow.bit = true;
  Exchange patient([&](const SerialTelegram& request) {
    ++number;
    slow.hung = number != 26 && number != 27 && number != 53;
    return slow(request);
  });
  EXPECT_EQ(patient.run({1, 6, 2, 8470, 1, {}}).result, 0U);
  EXPECT_EQ(number, 53);
}

}  // namespace
}  // namespace ipos::tests

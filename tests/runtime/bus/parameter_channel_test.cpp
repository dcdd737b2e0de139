// The parameter channel behind the telegrams: how a service reaches the unit, the handshake of cyclic telegrams (1053 1610
// p. 30, 34), and a gateway's channel from beginning to end.
#include <gtest/gtest.h>

#include "runtime/bus/movilink/gateway_channel.hpp"
#include "runtime/bus/movilink/handshake.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

struct AskedUnit final : ParameterServer {
  explicit AskedUnit(bool its_subindices = true) : subindices(its_subindices) {}
  tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) override {
    times.push_back(now);
    requests.push_back(request);
    if (request.index == 1) return tl::unexpected(return_codes::kReadOnly);
    return is_write(request.service) ? request.value : -5;
  }
  bool has_subindices() const override { return subindices; }
  bool subindices;
  std::vector<Time> times;
  std::vector<ParameterRequest> requests;
};

TEST(ParameterChannel, EveryServiceAndLength) {
  for (unsigned management = 0; management < 0x80; ++management) {
    AskedUnit unit;
    const ParameterTelegram request{static_cast<uint8_t>(management), 3, 8470, 9};
    const ParameterTelegram answer = execute(77, unit, request);
    const unsigned service = management % 16;
    const bool write = service == 2 || service == 3;
    const bool good = service <= 8 && (!write || management / 16 % 4 == 3);
    const auto kept = static_cast<uint8_t>(management & 0x4F);
    const uint8_t head = good ? 0x30 : 0xB0;
    const uint32_t data = !good ? 0x05050000 : service == 0 || write ? 9 : static_cast<uint32_t>(-5);
    EXPECT_EQ(answer, (ParameterTelegram{static_cast<uint8_t>(head | kept), 3, 8470, data})) << management;
    ASSERT_EQ(unit.requests.size(), good && service != 0 ? 1U : 0U) << management;
    if (unit.requests.empty()) continue;
    EXPECT_EQ(unit.times[0], 77);
    EXPECT_EQ(static_cast<unsigned>(unit.requests[0].service), service);
    EXPECT_EQ(unit.requests[0].index, 8470);
    EXPECT_EQ(unit.requests[0].subindex, 3);
    EXPECT_EQ(unit.requests[0].value, 9);
  }
}

// Byte 1 is reserved where there are no subindices: it goes out as 0, whatever came (1053 1610 p. 30).
TEST(ParameterChannel, ReservedByte) {
  for (const bool subindices : {false, true})
    for (const uint16_t index : {uint16_t{1}, uint16_t{8470}})
      for (const uint8_t management : {uint8_t{0x30}, uint8_t{0x31}, uint8_t{0x3F}}) {
        AskedUnit unit(subindices);
        const ParameterTelegram answer = execute(0, unit, {management, 3, index, 0});
        EXPECT_EQ(answer.subindex, subindices ? 3 : 0);
        if (!unit.requests.empty()) {
          EXPECT_EQ(unit.requests[0].subindex, 3) << "as received";
        }
      }
  AskedUnit unit;
  EXPECT_EQ(execute(0, unit, {0x32, 0, 1, 9}), (ParameterTelegram{0xB2, 0, 1, 0x08000012}));
}

TEST(CyclicChannel, OneServiceForEachChangeOfTheBit) {
  AskedUnit unit;
  CyclicChannel channel(unit, 100);
  const ParameterTelegram zero{0x32, 0, 8470, 1}, one{0x72, 0, 8470, 2}, next{0x72, 0, 8471, 3};
  EXPECT_FALSE(channel.take(0, zero)) << "0 after power-on";
  EXPECT_EQ(channel.answer(0, zero), zero) << "returned";
  EXPECT_TRUE(channel.take(10, one));
  EXPECT_EQ(unit.times, std::vector<Time>{10});
  EXPECT_EQ(channel.result(), (ParameterTelegram{0x72, 0, 8470, 2}));
  for (const Time now : {Time{10}, Time{109}}) {
    EXPECT_FALSE(channel.take(now, one));
    EXPECT_FALSE(channel.take(now, zero)) << "nothing else is begun";
    EXPECT_EQ(channel.answer(now, one), (ParameterTelegram{0x32, 0, 8470, 2})) << "the old bit";
  }
  EXPECT_EQ(channel.answer(110, one), one) << "done at the end of its time";
  EXPECT_FALSE(channel.take(110, next)) << "the bit has not changed";
  EXPECT_EQ(channel.answer(110, next), next);
  EXPECT_EQ(channel.answer(110, zero), (ParameterTelegram{0x72, 0, 8470, 1}))
      << "with the bit of the last service";
  EXPECT_TRUE(channel.take(110, zero));
  EXPECT_EQ(unit.requests.size(), 2U);
  EXPECT_FALSE(channel.take(209, one));
  EXPECT_TRUE(channel.take(210, one)) << "without an answer between";
  EXPECT_EQ(unit.requests.size(), 3U);
}

TEST(CyclicChannel, AnswersThatAreOnlyReturnedHaveNotFailed) {
  AskedUnit unit;
  CyclicChannel channel(unit, 0);
  const ParameterTelegram bad{0x72, 0, 1, 2};
  EXPECT_TRUE(channel.take(0, bad));
  EXPECT_EQ(channel.answer(0, bad), (ParameterTelegram{0xF2, 0, 1, 0x08000012}));
  EXPECT_EQ(channel.answer(0, {0xF2, 0, 1, 3}), (ParameterTelegram{0x72, 0, 1, 3}));
  EXPECT_EQ(channel.answer(0, {0xB2, 5, 1, 3}), (ParameterTelegram{0x72, 5, 1, 3}));
}

struct StubbornMaster final : MovilinkMaster {
  std::optional<ReturnCode> start(Time now, const MovilinkJob& job) override {
    times.push_back(now);
    jobs.push_back(job);
    return refusal;
  }
  void abort() override {}
  std::optional<ReturnCode> refusal;
  std::vector<Time> times;
  std::vector<MovilinkJob> jobs;
};

struct Gateway {
  StubbornMaster master;
  GatewayChannel channel{master, [](uint8_t address) { return address == 5 || address == 6; }};
  ParameterTelegram ask(const ParameterTelegram& request) {
    channel.take(3, request);
    return channel.answer(request);
  }
  void finish(uint32_t result, std::optional<int32_t> value = std::nullopt) {
    MovilinkResult done;
    done.result = result;
    done.read_value = value;
    channel.on_exchange_done(0, done);
  }
};

TEST(GatewayChannel, TheJobIsThatOfTheRequest) {
  Gateway gateway;
  gateway.ask({0x72, 6, 0xFFFF, 0xFFFFFFFE});
  EXPECT_TRUE(gateway.channel.busy());
  ASSERT_EQ(gateway.master.jobs.size(), 1U);
  const MovilinkJob& job = gateway.master.jobs[0];
  EXPECT_EQ(job.address, 6);
  EXPECT_EQ(job.format, 6) << "parameter only";
  EXPECT_EQ(job.service, 2);
  EXPECT_EQ(job.index, 0xFFFF);
  EXPECT_EQ(job.write_value, -2);
  EXPECT_EQ(job.output, (std::array<int32_t, 3>{}));
  EXPECT_EQ(gateway.master.times[0], 3);
  gateway.finish(0);
  EXPECT_FALSE(gateway.channel.busy());
  EXPECT_EQ(gateway.channel.last(), (ParameterTelegram{0x72, 6, 0xFFFF, 0xFFFFFFFE}));
  EXPECT_EQ(gateway.channel.error(), 0U);
}

// Every length but that of four bytes is refused in a write; a read carries no data.
TEST(GatewayChannel, LengthsOfWritesAndReads) {
  for (unsigned management = 0x40; management < 0x80; ++management) {
    Gateway gateway;
    const ParameterTelegram answer = gateway.ask({static_cast<uint8_t>(management), 5, 8600, 1});
    const unsigned service = management % 16;
    const bool write = service == 2 || service == 3;
    const bool begun = service >= 1 && service <= 8 && (!write || management >= 0x70);
    EXPECT_EQ(gateway.master.jobs.size(), begun ? 1U : 0U) << management;
    EXPECT_EQ(gateway.channel.busy(), begun);
    EXPECT_EQ(gateway.channel.error(), begun || service == 0 ? 0U
                                       : service > 8         ? 0x05050000U
                                                             : 0x06080000U)
        << management;
    EXPECT_EQ(answer.failed(), !begun && service != 0);
    EXPECT_EQ(answer.synchronous(), !begun) << "done at once";
  }
}

TEST(GatewayChannel, AMasterThatRefusesAndADriveThatDoes) {
  Gateway gateway;
  gateway.master.refusal = return_codes::kWrongManagement;
  EXPECT_EQ(gateway.ask({0x71, 5, 8600, 0}), (ParameterTelegram{0xF1, 5, 8600, 0x05050000}));
  EXPECT_FALSE(gateway.channel.busy());
  gateway.master.refusal.reset();
  gateway.ask({0x31, 5, 8600, 0});
  gateway.finish(0x08000010, 4);
  EXPECT_EQ(gateway.channel.error(), 0x08000010U);
  EXPECT_EQ(gateway.ask({0x31, 5, 8600, 0}), (ParameterTelegram{0xB1, 5, 8600, 0x08000010}));
  gateway.ask({0x71, 5, 8600, 0});
  gateway.finish(0, 4);
  EXPECT_EQ(gateway.channel.error(), 0U);
}

TEST(GatewayChannel, AnotherChannelIsReturnedWithTheBitOfTheLastService) {
  Gateway gateway;
  EXPECT_EQ(gateway.ask({0xB1, 5, 8600, 7}), (ParameterTelegram{0x31, 5, 8600, 7}))
      << "nothing has been done";
  EXPECT_TRUE(gateway.master.jobs.empty());
  gateway.ask({0x71, 5, 8600, 7});
  EXPECT_EQ(gateway.channel.answer({0xF1, 5, 8600, 7}), (ParameterTelegram{0x31, 5, 8600, 7}));
  gateway.finish(0, 9);
  EXPECT_EQ(gateway.channel.answer({0xF1, 5, 8600, 7}), (ParameterTelegram{0x71, 5, 8600, 7}));
  EXPECT_EQ(gateway.channel.answer({0x31, 5, 8600, 7}), (ParameterTelegram{0x71, 5, 8600, 7}));
  EXPECT_EQ(gateway.channel.answer({0x71, 5, 8600, 7}), (ParameterTelegram{0x71, 5, 8600, 9}));
}

TEST(GatewayChannel, AfterPowerOffAsAtFirst) {
  Gateway gateway;
  const ParameterTelegram request{0x71, 4, 8600, 7};
  EXPECT_EQ(gateway.ask(request).data, 0x05050000U);
  gateway.ask({0x31, 5, 8600, 7});
  EXPECT_TRUE(gateway.channel.busy());
  gateway.channel.power_off();
  EXPECT_FALSE(gateway.channel.busy());
  EXPECT_EQ(gateway.channel.last(), ParameterTelegram{});
  EXPECT_EQ(gateway.channel.error(), 0U);
  EXPECT_EQ(gateway.channel.answer(request), (ParameterTelegram{0x31, 4, 8600, 7}));
  gateway.ask({0x31, 5, 8600, 7});
  EXPECT_FALSE(gateway.channel.busy()) << "the bit is 0 again";
  gateway.ask({0x71, 5, 8600, 7});
  gateway.finish(0, 1);
  gateway.channel.power_off();
  EXPECT_EQ(gateway.channel.answer({0x71, 5, 8600, 7}), (ParameterTelegram{0x31, 5, 8600, 7}));
}

}  // namespace
}  // namespace ipos::tests

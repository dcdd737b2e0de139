// The parameter channel of a gateway, with a master whose exchanges the test ends itself.
#include "runtime/bus/movilink/gateway_channel.hpp"

#include <gtest/gtest.h>

namespace ipos::tests {
namespace {

using runtime::MovilinkJob;
using runtime::MovilinkResult;
using runtime::ParameterTelegram;
using runtime::Time;

struct FakeMaster final : runtime::MovilinkMaster {
  std::optional<runtime::ReturnCode> start(Time, const MovilinkJob& job) override {
    jobs.push_back(job);
    return std::nullopt;
  }
  void abort() override {}
  std::vector<MovilinkJob> jobs;
};

struct Bench {
  FakeMaster master;
  runtime::GatewayChannel channel{master, [](uint8_t address) { return address == 5; }};
  ParameterTelegram ask(uint8_t management, uint8_t address, uint16_t index, uint32_t data = 0) {
    const ParameterTelegram request{management, address, index, data};
    channel.take(0, request);
    return channel.answer(request);
  }
  void finish(std::optional<int32_t> value, uint32_t result = 0) {
    MovilinkResult done;
    done.result = result;
    done.read_value = value;
    channel.on_exchange_done(0, done);
  }
};

TEST(GatewayChannel, AServiceTakesItsTime) {
  Bench bench;
  EXPECT_EQ(bench.ask(0x71, 5, 8600).management, 0x31) << "the old handshake bit until it is done";
  ASSERT_EQ(bench.master.jobs.size(), 1U);
  EXPECT_EQ(bench.master.jobs[0].address, 5);
  EXPECT_EQ(bench.master.jobs[0].index, 8600) << "without the address as a subindex";
  EXPECT_EQ(bench.ask(0x71, 5, 8600).management, 0x31);
  bench.ask(0x31, 5, 8601);  // nothing else is begun
  EXPECT_EQ(bench.master.jobs.size(), 1U);
  bench.finish(7);
  const ParameterTelegram done = bench.ask(0x71, 5, 8600);
  EXPECT_EQ(done, (ParameterTelegram{0x71, 5, 8600, 7}));
  bench.ask(0x71, 5, 8600);
  EXPECT_EQ(bench.master.jobs.size(), 1U) << "once for each change of the bit";
}

TEST(GatewayChannel, ReturnCodes) {
  Bench bench;
  EXPECT_EQ(bench.ask(0x71, 4, 8600), (ParameterTelegram{0xF1, 4, 8600, 0x05050000}));
  EXPECT_EQ(bench.ask(0x3F, 5, 8600), (ParameterTelegram{0xBF, 5, 8600, 0x05050000}));
  EXPECT_EQ(bench.ask(0x62, 5, 8600), (ParameterTelegram{0xE2, 5, 8600, 0x06080000}));
  EXPECT_TRUE(bench.master.jobs.empty());
  bench.ask(0x32, 5, 8600, 9);
  bench.finish(std::nullopt, 0x06020000);
  EXPECT_EQ(bench.ask(0x32, 5, 8600, 9), (ParameterTelegram{0xB2, 5, 8600, 0x06020000}));
  bench.ask(0x72, 5, 8600, 9);  // repeated
  bench.finish(std::nullopt);
  EXPECT_EQ(bench.ask(0x72, 5, 8600, 9), (ParameterTelegram{0x72, 5, 8600, 9}));
  EXPECT_EQ(bench.ask(0x30, 5, 8600, 3), (ParameterTelegram{0x30, 5, 8600, 3})) << "no service: mirrored";
}

}  // namespace
}  // namespace ipos::tests

// MOVILINK jobs over SDO, frame by frame: what is asked of the node, and what its answer means.
#include "runtime/bus/canopen/sdo_master.hpp"

#include <gtest/gtest.h>

#include <tuple>
#include <utility>
#include <vector>

#include "tests/runtime/bus/hand.hpp"

namespace ipos::tests {
namespace {

using canopen::SdoMaster;

struct SdoMasterBench final : CanNode, MovilinkClient {
  void on_frame(Time now, const Frame& frame) override { master.on_frame(now, frame); }
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_exchange_done(Time now, const MovilinkResult& result) override {
    results.push_back(result);
    done_at = now;
  }
  std::optional<ReturnCode> start(Service service, int32_t address, int32_t index, int32_t value = 0) {
    MovilinkJob job;
    job.address = address;
    job.format = format;
    job.service = static_cast<int32_t>(service);
    job.index = index;
    job.write_value = value;
    const auto refused = master.start(queue.now(), job);
    run(kMillisecond);
    return refused;
  }
  void answer(const Frame& frame) {
    node.port.send(frame, 0);
    run(kMillisecond);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }
  std::vector<Frame> heard() { return std::exchange(node.frames, {}); }

  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  LinePort port{line, line.attach("master", 500'000, *this)};
  Hand node{line, "node5"};
  SdoMaster master{{queue, 1, port, 7}, 100 * kMillisecond, *this};
  int32_t format = 6;  // a parameter alone
  std::vector<MovilinkResult> results;
  Time done_at = 0;
};

using SdoFrames = std::vector<Frame>;

TEST(CanopenSdoMaster, ReadsWithSign) {
  SdoMasterBench bench;
  EXPECT_EQ(bench.start(Service::Read, 5, 8318), std::nullopt);
  EXPECT_EQ(bench.heard(), (SdoFrames{{0x605, 8, {0x40, 0x7E, 0x20, 0x00}}}));
  bench.answer({0x585, 8, {0x43, 0x7E, 0x20, 0x00, 0xFE, 0xFF, 0xFF, 0xFF}});
  ASSERT_EQ(bench.results.size(), 1U);
  EXPECT_EQ(bench.results[0].result, 0U);
  EXPECT_EQ(bench.results[0].read_value, -2);
  bench.start(Service::Read, 127, 0x1017);
  EXPECT_EQ(bench.heard(), (SdoFrames{{0x67F, 8, {0x40, 0x17, 0x10, 0x00}}}));
  bench.answer({0x5FF, 8, {0x4B, 0x17, 0x10, 0x00, 0x34, 0x92}});
  ASSERT_EQ(bench.results.size(), 2U);
  EXPECT_EQ(bench.results[1].read_value, 0x9234) << "two octets have no sign";
  // A text of five octets in a segment: the first four are the value.
  bench.start(Service::Read, 5, 0x1008);
  bench.answer({0x585, 8, {0x41, 0x08, 0x10, 0x00, 5}});
  bench.heard();
  bench.answer({0x585, 8, {0x05, 1, 2, 3, 4, 5}});
  ASSERT_EQ(bench.results.size(), 3U);
  EXPECT_EQ(bench.results[2].read_value, 0x0403'0201);
  bench.run(kSecond);
  EXPECT_EQ(bench.results.size(), 3U) << "the time of an answer is over";
}

TEST(CanopenSdoMaster, WritesFourOctets) {
  SdoMasterBench bench;
  EXPECT_EQ(bench.start(Service::Write, 5, 8470, 0x1234'5678), std::nullopt);
  EXPECT_EQ(bench.heard(), (SdoFrames{{0x605, 8, {0x23, 0x16, 0x21, 0x00, 0x78, 0x56, 0x34, 0x12}}}));
  bench.answer({0x585, 8, {0x80, 0x16, 0x21, 0x00, 0x31, 0x00, 0x09, 0x06}});
  ASSERT_EQ(bench.results.size(), 1U);
  EXPECT_EQ(bench.results[0].result, 0x0800'0015U) << "too large";
  EXPECT_EQ(bench.results[0].read_value, std::nullopt);
}

TEST(CanopenSdoMaster, OnlyTheAnswerOfItsNodeCounts) {
  SdoMasterBench bench;
  bench.start(Service::Read, 5, 8318);
  bench.answer({0x586, 8, {0x43, 0x7E, 0x20, 0x00, 1}});
  bench.answer({0x585, 7, {0x43, 0x7E, 0x20, 0x00, 1}});
  bench.answer({0x585, 8, {}, false, true});
  bench.answer({0x585, 8, {0x43, 0x7E, 0x20, 0x00, 1}, true});
  EXPECT_TRUE(bench.results.empty());
  bench.answer({0x585, 8, {0x43, 0x7E, 0x20, 0x00, 1}});
  EXPECT_EQ(bench.results.size(), 1U);
  bench.answer({0x585, 8, {0x43, 0x7E, 0x20, 0x00, 1}});
  EXPECT_EQ(bench.results.size(), 1U) << "nothing is under way";
}

TEST(CanopenSdoMaster, WithoutAnAnswerItAborts) {
  SdoMasterBench bench;
  bench.start(Service::Read, 5, 8318);
  bench.heard();
  bench.run(98 * kMillisecond);
  EXPECT_TRUE(bench.results.empty());
  bench.run(2 * kMillisecond);
  ASSERT_EQ(bench.results.size(), 1U);
  EXPECT_EQ(bench.done_at, 100 * kMillisecond);
  EXPECT_EQ(bench.results[0].reason, "no answer");
  EXPECT_EQ(bench.results[0].result, 0x0602'0000U) << "class 6, code 2, as on every other bus";
  EXPECT_EQ(bench.results[0].read_value, std::nullopt);
  const SdoFrames abort{{0x605, 8, {0x80, 0x7E, 0x20, 0x00, 0x00, 0x00, 0x04, 0x05}}};
  EXPECT_EQ(bench.heard(), abort);
  // The program gives up: the node hears of it, the program nothing.
  bench.start(Service::Read, 5, 8318);
  bench.heard();
  bench.master.abort();
  bench.run(kSecond);
  EXPECT_EQ(bench.heard(), abort);
  bench.master.abort();
  bench.run(kSecond);
  EXPECT_TRUE(bench.heard().empty());
  EXPECT_EQ(bench.results.size(), 1U);
}

TEST(CanopenSdoMaster, JobsThatSdoCannotCarry) {
  SdoMasterBench bench;
  for (const auto& [service, address, index] :
       std::initializer_list<std::tuple<Service, int32_t, int32_t>>{{Service::WriteVolatile, 5, 8318},
                                                                    {Service::ReadMinimum, 5, 8318},
                                                                    {Service::Read, 0, 8318},
                                                                    {Service::Read, 128, 8318},
                                                                    {Service::Read, -1, 8318},
                                                                    {Service::Read, 5, -1},
                                                                    {Service::Read, 5, 0x1'0000}}) {
    const auto refused = bench.start(service, address, index);
    ASSERT_TRUE(refused.has_value()) << address << ' ' << index;
    EXPECT_EQ(refused->packed(), 0x0505'0000U) << "class 5, code 5";
  }
  // SDO carries no process data.
  for (const int32_t format : {0, 1, 2, 3, 4, 5, 128, 133, 7, -1}) {
    bench.format = format;
    EXPECT_TRUE(bench.start(Service::Read, 5, 8318).has_value()) << format;
  }
  EXPECT_TRUE(bench.heard().empty());
  bench.format = 134;
  EXPECT_EQ(bench.start(Service::Read, 5, 8318), std::nullopt);
  bench.master.abort();
  bench.format = 6;
  EXPECT_EQ(bench.start(Service::Read, 1, 0), std::nullopt);
  bench.master.abort();
  EXPECT_EQ(bench.start(Service::Read, 127, 0xFFFF), std::nullopt);
}

}  // namespace
}  // namespace ipos::tests

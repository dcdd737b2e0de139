// One MOVLNK exchange after another, over a simulated line with real slaves.
#include "runtime/bus/movilink/sbus_master.hpp"

#include <gtest/gtest.h>

#include "runtime/bus/movilink/identifiers.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/sbus_rig.hpp"

namespace ipos::tests {
namespace {

class MasterNode final : public CanNode, public MovilinkClient {
 public:
  MasterNode(EventQueue& queue, CanLine& line)
      : port(line, line.attach("master", line.baud(), *this)),
        master(queue, 5, port, 9, 30 * kMillisecond, *this) {}
  void on_frame(Time now, const Frame& frame) override { master.on_frame(now, frame); }
  void on_sent(Time now, const Frame&, uint64_t tag) override { master.on_sent(now, tag); }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_exchange_done(Time now, const MovilinkResult& result) override {
    ++done;
    last = result;
    at = now;
  }
  LinePort port;
  SbusMaster master;
  int done = 0;
  MovilinkResult last;
  Time at = 0;
};

class Log final : public CanObserver {
 public:
  void on_frame(const CanLine&, const FrameRecord& record) override { frames.push_back(record.frame); }
  void on_line_event(const CanLine&, const LineEvent&) override {}
  std::vector<uint32_t> ids() const {
    std::vector<uint32_t> out;
    for (const Frame& frame : frames) out.push_back(frame.id);
    return out;
  }
  std::vector<Frame> frames;
};

struct Rig {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  MasterNode node{queue, line};
  Unit unit{queue, 1, line, "unit2", SlaveSettings{1, 2, 0, false}};
  Log log;
  Rig() { line.add_observer(log); }

  // Runs one job to its end; nothing when it was refused.
  std::optional<MovilinkResult> run(const MovilinkJob& job) {
    log.frames.clear();
    const int before = node.done;
    if (node.master.start(queue.now(), job)) return std::nullopt;
    EXPECT_TRUE(node.master.busy());
    EXPECT_EQ(node.done, before);
    queue.run_until(queue.now() + 100 * kMillisecond);
    EXPECT_EQ(node.done, before + 1);
    EXPECT_FALSE(node.master.busy());
    return node.last;
  }
};

TEST(SbusMaster, SampleProgram) {
  PROVES("EX-14", "MOVLNK-11");
  Rig rig;
  const auto result = rig.run({1, 4, 1, 8318, 123, {6, 5000, 15000}});
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->result, 0U);
  EXPECT_EQ(result->read_value, 1'000'000);
  EXPECT_EQ(result->words, 3);
  EXPECT_EQ(result->input, (std::array<int32_t, 3>{7, 5011, 0}));
  const std::vector<Frame> expected = {{523, 8, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0}, false, false},
                                       {524, 8, {0x31, 0, 0x20, 0x7E, 0, 0x0F, 0x42, 0x40}, false, false},
                                       {11, 6, {0x00, 0x06, 0x13, 0x88, 0x3A, 0x98}, false, false},
                                       {12, 6, {0x00, 0x07, 0x13, 0x93, 0x00, 0x00}, false, false}};
  EXPECT_EQ(rig.log.frames, expected);
}

TEST(SbusMaster, FormatsDecideWhatIsSent) {
  PROVES("MOVLNK-12");
  Rig rig;
  const std::vector<uint32_t> both = {523, 524, 11, 12};
  const std::vector<uint32_t> process = {11, 12};
  const std::vector<uint32_t> only_parameter = {523, 524};
  for (const int32_t acyclic : {0, 128})
    for (int32_t format = 0; format <= 6; ++format) {
      const auto result = rig.run({1, format + acyclic, 1, format % 2 == 1 ? -77 : 8318, 0, {6, 5, 4}});
      ASSERT_TRUE(result.has_value());
      EXPECT_EQ(result->result, 0U);
      EXPECT_EQ(rig.log.ids(), format == 6 ? only_parameter : format % 2 == 1 ? process : both);
      EXPECT_EQ(result->words, format == 6 ? 0 : format / 2 + 1);
      EXPECT_EQ(result->read_value.has_value(), format % 2 == 0);
      if (format == 6) continue;
      const ProcessWords expected = {6, static_cast<uint16_t>(format >= 2 ? 5 : 0),
                                     static_cast<uint16_t>(format >= 4 ? 4 : 0)};
      EXPECT_EQ(rig.unit.outputs.back(), expected);
    }
}

TEST(SbusMaster, WritesAndWordsWithSign) {
  PROVES("MOVLNK-16");
  Rig rig;
  auto result = rig.run({1, 6, 2, 8470, 2500, {}});
  ASSERT_TRUE(result.has_value());
  EXPECT_EQ(result->result, 0U);
  EXPECT_FALSE(result->read_value.has_value());
  EXPECT_EQ(rig.unit.parameters[8470], 2500);
  rig.unit.inputs = {0xF15A, 0x8000, 1};
  result = rig.run({1, 5, 0, 0, 0, {0x12340006, -3750, 0}});
  EXPECT_EQ(rig.unit.outputs.back(), (ProcessWords{6, 0xF15A, 0}));
  EXPECT_EQ(result->input, (std::array<int32_t, 3>{-3750, -32768, 1}));
  result = rig.run({1, 6, 1, 8318 + (5 << 16), 0, {}});
  EXPECT_EQ(rig.unit.requests.back().subindex, 5);
}

TEST(SbusMaster, ErrorsBecomePackedReturnCodes) {
  Rig rig;
  auto result = rig.run({1, 6, 1, 9999, 0, {}});
  EXPECT_EQ(result->result, 0x08000010U);
  EXPECT_FALSE(result->read_value.has_value());
  // With process data: they go out all the same, but nothing is to be stored.
  result = rig.run({1, 4, 2, 8318, 1, {6, 0, 0}});
  EXPECT_EQ(result->result, 0x08000012U);
  EXPECT_EQ(result->words, 0);
  EXPECT_EQ(rig.unit.outputs.size(), 1U);
  // Nobody at address 2.
  const Time begin = rig.queue.now();
  result = rig.run({2, 4, 1, 8318, 0, {6, 0, 0}});
  EXPECT_EQ(result->result, 0x06020000U);
  EXPECT_EQ(rig.node.at - begin, 30 * kMillisecond);
  EXPECT_EQ(rig.log.ids(), std::vector<uint32_t>{531});
  // The next exchange works as if nothing had been.
  result = rig.run({1, 4, 1, 8318, 0, {6, 0, 0}});
  EXPECT_EQ(result->result, 0U);
}

TEST(SbusMaster, GroupsGetTheirTelegramsAndGiveNone) {
  Rig rig;
  const Time begin = rig.queue.now();
  auto result = rig.run({102, 4, 2, 8470, 7, {6, 1, 2}});
  EXPECT_EQ(result->result, 0U);
  EXPECT_EQ(result->words, 0);
  EXPECT_FALSE(result->read_value.has_value());
  EXPECT_EQ(rig.log.ids(), (std::vector<uint32_t>{534, 22}));
  EXPECT_LT(rig.node.at - begin, kMillisecond);
  EXPECT_EQ(rig.unit.parameters[8470], 7);
  EXPECT_EQ(rig.unit.outputs.back(), (ProcessWords{6, 1, 2}));
  result = rig.run({102, 5, 0, 0, 0, {6, 1, 2}});
  EXPECT_EQ(rig.log.ids(), std::vector<uint32_t>{22});
}

TEST(SbusMaster, JobsThatCannotBeSentAreRefused) {
  PROVES("MOVLNK-04");
  Rig rig;
  const MovilinkJob bad[] = {{64, 5, 0, 0, 0, {}},    {-1, 5, 0, 0, 0, {}},   {99, 5, 0, 0, 0, {}},
                         {164, 5, 0, 0, 0, {}},   {253, 5, 0, 0, 0, {}},  {1, 7, 1, 8318, 0, {}},
                         {1, -1, 1, 8318, 0, {}}, {1, 6, 0, 8318, 0, {}}, {1, 6, 9, 8318, 0, {}},
                         {1, 6, -1, 8318, 0, {}}, {1, 6, 1, -1, 0, {}},   {1, 6, 1, 1 << 24, 0, {}},
                         {102, 4, 1, 8318, 0, {}}};
  for (const MovilinkJob& job : bad) {
    const auto refused = rig.node.master.start(rig.queue.now(), job);
    ASSERT_TRUE(refused.has_value()) << job.address << ' ' << job.format << ' ' << job.service;
    EXPECT_EQ(refused->packed(), 0x05050000U);
    EXPECT_FALSE(rig.node.master.busy());
  }
  rig.queue.run_until(kSecond);
  EXPECT_TRUE(rig.log.frames.empty());
  EXPECT_EQ(rig.node.done, 0);
}

TEST(SbusMaster, ALateAnswerIsNotTakenForTheNextRequest) {
  Rig rig;
  Unit slow(rig.queue, 2, rig.line, "slow", SlaveSettings{4, 9, 0, false},
            {200 * kMicrosecond, 50 * kMillisecond});
  ASSERT_FALSE(rig.node.master.start(0, {4, 6, 1, 8318, 0, {}}));
  rig.queue.run_until(31 * kMillisecond);
  EXPECT_EQ(rig.node.last.result, 0x06020000U);
  // The answer to 8318 comes at about 50 ms, while 8470 is asked for; that one comes too late as well.
  ASSERT_FALSE(rig.node.master.start(rig.queue.now(), {4, 6, 1, 8470, 0, {}}));
  rig.queue.run_until(200 * kMillisecond);
  EXPECT_EQ(rig.node.done, 2);
  EXPECT_EQ(rig.node.last.result, 0x06020000U);
}

TEST(SbusMaster, AloneOnTheLineItGivesUpAndWithdrawsItsFrame) {
  EventQueue queue;
  CanLine line(queue, 9, "sbus", 500'000);
  MasterNode node(queue, line);
  Log log;
  line.add_observer(log);
  ASSERT_FALSE(node.master.start(0, {1, 5, 0, 0, 0, {6, 0, 0}}));
  queue.run_until(29 * kMillisecond);
  EXPECT_TRUE(node.master.busy());
  queue.run_until(40 * kMillisecond);
  EXPECT_EQ(node.last.result, 0x06020000U);
  Unit late(queue, 1, line, "late", SlaveSettings{1, 2, 0, false});
  queue.run_until(kSecond);
  EXPECT_TRUE(late.outputs.empty());
  EXPECT_TRUE(log.frames.empty());
}

TEST(SbusMaster, WrongBaudRateEndsInTheTimeout) {
  EventQueue queue;
  CanLine line(queue, 9, "sbus", 500'000);
  MasterNode node(queue, line);
  Unit unit(queue, 1, line, "unit", SlaveSettings{1, 2, 0, false});
  line.set_baud(node.port.node(), 125'000);
  ASSERT_FALSE(node.master.start(0, {1, 5, 0, 0, 0, {6, 0, 0}}));
  queue.run_until(100 * kMillisecond);
  EXPECT_EQ(node.done, 1);
  EXPECT_EQ(node.last.result, 0x06020000U);
  EXPECT_TRUE(unit.outputs.empty());
}

TEST(SbusMaster, AbortLeavesNothingBehind) {
  Rig rig;
  ASSERT_FALSE(rig.node.master.start(0, {1, 4, 1, 8318, 0, {6, 0, 0}}));
  rig.node.master.abort();
  EXPECT_FALSE(rig.node.master.busy());
  rig.queue.run_until(kSecond);
  EXPECT_EQ(rig.node.done, 0);
  EXPECT_TRUE(rig.log.frames.empty());
}

}  // namespace
}  // namespace ipos::tests

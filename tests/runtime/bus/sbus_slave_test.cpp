// The SBus slave on a simulated line: the manual's frames, group telegrams, synchronous answers, wrong
// requests.
#include "runtime/bus/movilink/sbus_slave.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/sbus_rig.hpp"

namespace ipos::tests {
namespace {

struct Rig {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Hand master{line, "control"};
  Unit unit{queue, 1, line, "unit1", SlaveSettings{1, 2, 0, false}};

  void run(Time span) { queue.run_until(queue.now() + span); }
  // The frames that come within 20 ms of one sent by the master.
  std::vector<Frame> ask(const Frame& frame) {
    master.frames.clear();
    master.times.clear();
    master.port.send(frame, 0);
    run(20 * kMillisecond);
    return master.frames;
  }
};

Frame parameter(uint32_t id, std::array<uint8_t, 8> bytes) { return {id, 8, bytes, false, false}; }

TEST(SbusSlave, FramesOfTheSampleProgram) {
  PROVES("EX-14", "PD-02", "MLK-05");
  Rig rig;
  EXPECT_EQ(rig.ask(parameter(523, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0})),
            std::vector<Frame>{parameter(524, {0x31, 0, 0x20, 0x7E, 0x00, 0x0F, 0x42, 0x40})});
  EXPECT_EQ(rig.ask({11, 6, {0x00, 0x06, 0x13, 0x88, 0x3A, 0x98}, false, false}),
            (std::vector<Frame>{{12, 6, {0x00, 0x07, 0x13, 0x93, 0x00, 0x00}, false, false}}));
  EXPECT_EQ(rig.unit.outputs, (std::vector<ProcessWords>{{6, 5000, 15000}}));
  EXPECT_EQ(rig.unit.channels, std::vector<OutputChannel>{OutputChannel::Single});
}

TEST(SbusSlave, FramesOfFigure33) {
  PROVES("EX-15");
  Rig rig;
  rig.unit.parameters[8318] = 0;
  rig.unit.inputs = {0x0202, 0, 0};
  EXPECT_EQ(rig.ask(parameter(523, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0})),
            std::vector<Frame>{parameter(524, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0})});
  EXPECT_EQ(rig.ask({11, 6, {0x00, 0x06, 0x13, 0x88, 0x00, 0x00}, false, false}),
            (std::vector<Frame>{{12, 6, {0x02, 0x02, 0, 0, 0, 0}, false, false}}));
}

TEST(SbusSlave, WriteToReadOnlyIsRefused) {
  PROVES("EX-10");
  Rig rig;
  EXPECT_EQ(rig.ask(parameter(523, {0x32, 0, 0x20, 0x7E, 0, 0, 0, 1})),
            std::vector<Frame>{parameter(524, {0xB2, 0, 0x20, 0x7E, 0x08, 0x00, 0x00, 0x12})});
  EXPECT_EQ(rig.unit.parameters[8318], 1'000'000);
}

TEST(SbusSlave, WrongManagementCoding) {
  PROVES("EX-34", "MLK-13");
  Rig rig;
  EXPECT_EQ(rig.ask(parameter(523, {0x3F, 0, 0x20, 0x7E, 0, 0, 0, 0})),
            std::vector<Frame>{parameter(524, {0xBF, 0, 0x20, 0x7E, 0x05, 0x05, 0x00, 0x00})});
  for (const int code : {0x39, 0x3A, 0x3B, 0x3C, 0x3D, 0x3E, 0x3F, 0x02, 0x12, 0x22, 0x03, 0x13, 0x23}) {
    const auto answer = rig.ask(parameter(523, {static_cast<uint8_t>(code), 0, 0x21, 0x16, 0, 0, 0, 9}));
    ASSERT_EQ(answer.size(), 1U);
    const auto expected_management = static_cast<uint8_t>(0xB0 | (code & 0x0F));
    EXPECT_EQ(answer[0].data, (std::array<uint8_t, 8>{expected_management, 0, 0x21, 0x16, 5, 5, 0, 0}));
  }
  EXPECT_TRUE(rig.unit.requests.empty());
}

TEST(SbusSlave, EveryManagementByte) {
  PROVES("MLK-02");
  Rig rig;
  for (unsigned code = 0; code < 256; ++code) {
    rig.unit.requests.clear();
    rig.master.frames.clear();
    rig.master.port.send(parameter(523, {static_cast<uint8_t>(code), 0, 0x21, 0x16, 0xFF, 0xFF, 0xFF, 0xFF}),
                         0);
    rig.run(5 * kMillisecond);
    rig.master.port.send({0, 0, {}, false, false}, 0);  // sync, for those with the mode bit
    rig.run(5 * kMillisecond);
    const unsigned service = code % 16;
    const bool write = service == 2 || service == 3;
    const bool good = service <= 8 && (!write || code / 16 % 4 == 3);
    ASSERT_EQ(rig.master.frames.size(), 1U) << code;
    EXPECT_EQ(rig.master.frames[0].data[0], (good ? 0x30 : 0xB0) | (code & 0x4F)) << code;
    EXPECT_EQ(rig.unit.requests.size(), good && service != 0 ? 1U : 0U) << code;
    if (good && service != 0) {
      EXPECT_EQ(static_cast<unsigned>(rig.unit.requests[0].service), service);
    }
  }
  EXPECT_EQ(rig.unit.parameters[8470], -1);
}

TEST(SbusSlave, ReadsLookAtNeitherDataNorLength) {
  PROVES("MLK-12");
  Rig rig;
  const auto plain = rig.ask(parameter(523, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0}));
  ASSERT_EQ(plain.size(), 1U);
  EXPECT_EQ(rig.ask(parameter(523, {0x01, 0, 0x20, 0x7E, 0xFF, 0xFF, 0xFF, 0xFF})), plain);
  rig.ask(parameter(523, {0x32, 0, 0x21, 0x16, 0, 0, 0x09, 0xC4}));
  EXPECT_EQ(rig.ask(parameter(523, {0x31, 0, 0x21, 0x16, 0, 0, 0, 0})),
            std::vector<Frame>{parameter(524, {0x31, 0, 0x21, 0x16, 0, 0, 0x09, 0xC4})});
}

TEST(SbusSlave, ReactsToItsOwnIdentifiersOnly) {
  PROVES("SBUS-09");
  EventQueue queue;
  CanLine line(queue, 9, "sbus", 1'000'000);
  Hand master(line, "control");
  Unit unit(queue, 1, line, "unit7", SlaveSettings{7, 2, 2047, false});
  std::set<uint32_t> mine;
  for (uint32_t id = 0; id < kStandardIdLimit; ++id) {
    const int before = unit.foreign;
    master.port.send({id, 6, {}, false, false}, 0);
    queue.run_until(queue.now() + kMillisecond);
    if (unit.foreign == before) mine.insert(id);
  }
  EXPECT_EQ(mine, (std::set<uint32_t>{22, 59, 61, 534, 571, 2047}));
  // No answer but PI to 59, and (at the sync telegram 2047) to 61.
  EXPECT_EQ(master.frames.size(), 2U);
  EXPECT_EQ(unit.syncs, 1);
}

TEST(SbusSlave, GroupTelegramsAreTakenInSilence) {
  PROVES("PD-03", "SBUS-20");
  EventQueue queue;
  CanLine line(queue, 9, "sbus", 500'000);
  Hand master(line, "control");
  Unit a(queue, 1, line, "a", SlaveSettings{1, 2, 0, false});
  Unit b(queue, 2, line, "b", SlaveSettings{2, 2, 0, false});
  Unit c(queue, 3, line, "c", SlaveSettings{3, 3, 0, false});
  const auto send = [&](const Frame& frame) {
    master.port.send(frame, 0);
    queue.run_until(queue.now() + 10 * kMillisecond);
  };
  send(process_frame(22, {6, 100, 200}));
  EXPECT_EQ(a.outputs, (std::vector<ProcessWords>{{6, 100, 200}}));
  EXPECT_EQ(a.channels, std::vector<OutputChannel>{OutputChannel::Group});
  EXPECT_EQ(b.outputs, a.outputs);
  EXPECT_TRUE(c.outputs.empty());
  send(parameter(534, {0x32, 0, 0x21, 0x16, 0, 0, 0x09, 0xC4}));
  EXPECT_EQ(a.parameters[8470], 2500);
  EXPECT_EQ(b.parameters[8470], 2500);
  EXPECT_EQ(c.parameters[8470], 0);
  send(parameter(534, {0x31, 0, 0x21, 0x16, 0, 0, 0, 0}));  // a read
  EXPECT_EQ(a.ignored, std::vector<Ignored>{Ignored::GroupService});
  send(parameter(534, {0x32, 0, 0x20, 0x7E, 0, 0, 0, 1}));  // refused
  EXPECT_EQ(a.ignored.back(), Ignored::GroupRefused);
  EXPECT_EQ(a.last_code, return_codes::kReadOnly);
  EXPECT_TRUE(master.frames.empty());
}

TEST(SbusSlave, AsynchronousOutputIsAnsweredWithinOneMillisecond) {
  PROVES("SYNC-09");
  Rig rig;
  for (Time offset = 0; offset < 4 * kMillisecond; offset += 137 * kMicrosecond) {
    rig.master.times.clear();
    rig.run(offset);
    rig.master.port.send(process_frame(11, {6, 0, 0}), 0);
    rig.run(5 * kMillisecond);
    ASSERT_EQ(rig.master.times.size(), 1U);
    EXPECT_LE(rig.master.times[0] - rig.master.last_sent, kMillisecond);
  }
}

TEST(SbusSlave, SynchronousRequestsWaitForTheSyncTelegram) {
  PROVES("SBUS-18", "SYNC-04", "SYNC-05", "SYNC-06");
  Rig rig;
  const Frame sync{0, 0, {}, false, false};
  EXPECT_TRUE(rig.ask(sync).empty());
  rig.run(2200 * kMicrosecond);
  EXPECT_TRUE(rig.ask(parameter(523, {0x72, 0, 0x21, 0x16, 0, 0, 0x09, 0xC4})).empty());
  EXPECT_EQ(rig.unit.parameters[8470], 2500);                   // done on reception
  EXPECT_EQ(rig.ask(process_frame(11, {6, 0, 0})).size(), 1U);  // process data go on
  rig.run(kSecond);
  EXPECT_EQ(rig.ask(sync), std::vector<Frame>{parameter(524, {0x72, 0, 0x21, 0x16, 0, 0, 0x09, 0xC4})});
  EXPECT_LE(rig.master.times[0] - rig.master.last_sent, kMillisecond);
  EXPECT_TRUE(rig.ask(sync).empty());  // once
}

// The first request was carried out; only its answer is lost.
TEST(SbusSlave, AnswerThatIsReplacedBeforeTheSyncTelegram) {
  Rig rig;
  rig.ask(parameter(523, {0x72, 0, 0x21, 0x16, 0, 0, 0x09, 0xC4}));
  EXPECT_TRUE(rig.ask(parameter(523, {0x71, 0, 0x20, 0x7E, 0, 0, 0, 0})).empty());
  EXPECT_EQ(rig.unit.parameters[8470], 2500);
  EXPECT_EQ(rig.unit.ignored, std::vector<Ignored>{Ignored::AnswerReplaced});
  EXPECT_NE(ignored_text(Ignored::AnswerReplaced).find("was carried out but is not answered"),
            std::string_view::npos);
  EXPECT_EQ(rig.ask({0, 0, {}, false, false}),
            std::vector<Frame>{parameter(524, {0x71, 0, 0x20, 0x7E, 0x00, 0x0F, 0x42, 0x40})});
}

TEST(SbusSlave, SynchronousOutputTakesEffectAtTheSyncTelegram) {
  PROVES("SYNC-08", "SYNC-10");
  Rig rig;
  Unit other(rig.queue, 2, rig.line, "unit2", SlaveSettings{3, 2, 0, false});
  rig.ask(process_frame(29, {6, 9, 0}));
  rig.ask(process_frame(13, {6, 1, 0}));
  EXPECT_TRUE(rig.ask(process_frame(13, {6, 2, 0})).empty());
  EXPECT_TRUE(rig.unit.outputs.empty());
  EXPECT_EQ(rig.ask({0, 8, {1, 2, 3, 4, 5, 6, 7, 8}, false, false}),
            (std::vector<Frame>{process_frame(12, rig.unit.inputs), process_frame(28, other.inputs)}));
  EXPECT_EQ(other.outputs, (std::vector<ProcessWords>{{6, 9, 0}}));
  EXPECT_EQ(other.output_times, rig.unit.output_times);
  EXPECT_LE(rig.master.times[0] - rig.master.last_sent, kMillisecond);
  EXPECT_EQ(rig.unit.outputs, (std::vector<ProcessWords>{{6, 2, 0}}));
  EXPECT_EQ(rig.unit.channels, std::vector<OutputChannel>{OutputChannel::Sync});
  EXPECT_EQ(rig.unit.ignored, std::vector<Ignored>{Ignored::SyncReplaced});
}

TEST(SbusSlave, SyncIdentifierMayBeAnyAndMovesNothingElse) {
  PROVES("SYNC-03", "SBUS-21");
  Rig rig;
  rig.unit.slave.configure({1, 2, 2047, false});
  rig.ask({0, 0, {}, false, false});
  EXPECT_EQ(rig.unit.syncs, 0);
  rig.ask({2047, 0, {}, false, false});
  EXPECT_EQ(rig.unit.syncs, 1);
  EXPECT_EQ(rig.ask(parameter(523, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0})).size(), 1U);
}

TEST(SbusSlave, WrongLengthsRemoteAndExtendedFramesAreIgnoredWithAReason) {
  Rig rig;
  for (uint8_t length = 0; length <= 8; ++length) {
    rig.unit.ignored.clear();
    const bool answered = !rig.ask({11, length, {}, false, false}).empty();
    EXPECT_EQ(answered, length == 6);
    EXPECT_EQ(rig.unit.ignored.empty(), length == 6);
    rig.unit.ignored.clear();
    EXPECT_EQ(!rig.ask({523, length, {0x31}, false, false}).empty(), length == 8);
    EXPECT_EQ(rig.unit.ignored.empty(), length == 8);
  }
  rig.unit.ignored.clear();
  EXPECT_TRUE(rig.ask({11, 6, {}, false, true}).empty());
  EXPECT_TRUE(rig.ask({11, 6, {}, true, false}).empty());
  EXPECT_EQ(rig.unit.ignored, (std::vector<Ignored>{Ignored::Remote, Ignored::Extended}));
  EXPECT_FALSE(ignored_text(Ignored::Extended).empty());
}

TEST(SbusSlave, SecondParameterChannelOnlyWhereSet) {
  Rig rig;
  const Frame request = parameter(525, {0x31, 3, 0x20, 0x7E, 0, 0, 0, 0});
  EXPECT_TRUE(rig.ask(request).empty());
  rig.unit.slave.configure({1, 2, 0, true});
  EXPECT_EQ(rig.ask(request),
            std::vector<Frame>{parameter(527, {0x31, 3, 0x20, 0x7E, 0x00, 0x0F, 0x42, 0x40})});
  EXPECT_EQ(rig.unit.requests.back().subindex, 3);
}

TEST(SbusSlave, RequestsInARowAreAllAnswered) {
  Rig rig;
  for (int i = 0; i < 5; ++i) rig.master.port.send(process_frame(11, {6, 0, 0}), 0);
  for (int i = 0; i < 5; ++i) rig.master.port.send(parameter(523, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 0}), 0);
  rig.run(20 * kMillisecond);
  EXPECT_EQ(rig.master.frames.size(), 10U);
}

// A slave that asks its line for too little is deaf, one that asks for too much costs time.
TEST(SbusSlave, ListensToWhatItTakesAndToNothingElse) {
  struct Filter final : FrameSender {
    SendStatus send(const Frame&, uint64_t) override { return SendStatus::Queued; }
    void withdraw(uint64_t) override {}
    void listen(uint32_t id) override { ids.insert(id); }
    std::set<uint32_t> ids;
  };
  for (const uint8_t address : std::array<uint8_t, 5>{0, 1, 2, 62, 63})
    for (const uint8_t group : std::array<uint8_t, 3>{0, 2, 63})
      for (const bool synchronous : {false, true})
        for (const bool channel2 : {false, true}) {
          Rig rig;
          Filter filter;
          SbusSlave slave(rig.queue, 2, filter, 1, {address, group, 0x7F0, channel2, synchronous}, {},
                          rig.unit, rig.unit);
          std::set<uint32_t> taken;
          for (uint32_t id = 0; id < kStandardIdLimit; ++id)
            if (slave.on_frame(0, Frame{id, 6, {}, false, false})) taken.insert(id);
          EXPECT_EQ(filter.ids, taken) << int{address} << ", group " << int{group};
          EXPECT_GE(taken.size(), 4U);
        }
}

}  // namespace
}  // namespace ipos::tests

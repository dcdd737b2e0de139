// Slave, master, master control and group master of the SBus at a sender that keeps what it is given: which frames go
// out, when, with which tag, and which identifiers are listened to.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "runtime/bus/movilink/sbus_control.hpp"
#include "runtime/bus/movilink/sbus_group_master.hpp"
#include "runtime/bus/movilink/sbus_master.hpp"
#include "runtime/bus/movilink/sbus_slave.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

// Frames that are withdrawn are gone, as on a line that is busy all the time.
struct KeepingSender final : FrameSender {
  explicit KeepingSender(EventQueue& its_queue) : queue(its_queue) {}
  struct Sent {
    Time time;
    Frame frame;
    uint64_t tag;
    friend bool operator==(const Sent&, const Sent&) = default;
  };
  SendStatus send(const Frame& frame, uint64_t tag) override {
    waiting.push_back({queue.now(), frame, tag});
    return SendStatus::Queued;
  }
  void withdraw(uint64_t tag) override {
    withdrawn.push_back(tag);
    std::erase_if(waiting, [tag](const Sent& sent) { return sent.tag == tag; });
  }
  void recover() override { ++recoveries; }
  void listen(uint32_t id) override { listened.insert(id); }
  std::vector<Sent> take() { return std::exchange(waiting, {}); }
  std::vector<uint32_t> take_ids() {
    std::vector<uint32_t> ids;
    for (const Sent& sent : take()) ids.push_back(sent.frame.id);
    return ids;
  }
  EventQueue& queue;
  std::vector<Sent> waiting;
  std::vector<uint64_t> withdrawn;
  std::set<uint32_t> listened;
  int recoveries = 0;
};
using Sent = KeepingSender::Sent;

Frame channel_frame(uint32_t id, std::array<uint8_t, 8> bytes) { return {id, 8, bytes, false, false}; }

// --- slave

struct SlaveDesk final : ParameterServer, ProcessDataServer, SlaveObserver {
  explicit SlaveDesk(SlaveSettings settings, SlaveTiming timing = {})
      : slave(queue, 1, sender, 77, settings, timing, *this, *this, this) {}
  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest& request) override {
    served.push_back(request.index);
    if (request.index == 1) return tl::unexpected(return_codes::kReadOnly);
    return request.index;
  }
  void take_output(Time, OutputChannel channel, std::span<const uint16_t> words) override {
    outputs.push_back({static_cast<uint16_t>(channel), words[0]});
  }
  ProcessWords input(Time now) override { return {static_cast<uint16_t>(now / kMicrosecond), 2, 3}; }
  void synchronize(Time now) override { syncs.emplace_back(now, outputs.size()); }
  void on_ignored(Time, const Frame& frame, Ignored reason, ReturnCode code) override {
    ignored.emplace_back(frame.id, reason, code);
  }
  bool give(Time at, const Frame& frame) {
    queue.run_until(at);
    return slave.on_frame(at, frame);
  }
  EventQueue queue;
  KeepingSender sender{queue};
  SbusSlave slave;
  std::vector<uint16_t> served;
  std::vector<std::pair<uint16_t, uint16_t>> outputs;  // channel, first word
  std::vector<std::pair<Time, size_t>> syncs;          // with the outputs taken before
  std::vector<std::tuple<uint32_t, Ignored, ReturnCode>> ignored;
};

SlaveSettings both_channels() {
  SlaveSettings settings{1, 2, 100};
  settings.second_channel = true;
  return settings;
}

// 1053 1610 p. 38: 8 a + 3, 5, 515 and 517, 8 g + 6 and 518, and the sync telegram.
TEST(SbusSlave, ListensToWhatAMasterSendsIt) {
  SlaveDesk desk(both_channels());
  EXPECT_EQ(desk.sender.listened, (std::set<uint32_t>{11, 13, 22, 100, 523, 525, 534}));
  SlaveSettings m07{63, 0, 100};
  m07.synchronous = false;
  desk.sender.listened.clear();
  desk.slave.configure(m07);
  EXPECT_EQ(desk.sender.listened, (std::set<uint32_t>{6, 507, 518, 1019}));
  EXPECT_EQ(desk.slave.settings().address, 63);
}

TEST(SbusSlave, AnswersComeAfterTheirDelays) {
  SlaveDesk desk(both_channels(), {300 * kMicrosecond, 5 * kMillisecond});
  EXPECT_TRUE(desk.give(kMillisecond, process_frame(11, {6, 0, 0})));
  EXPECT_TRUE(desk.give(kMillisecond, channel_frame(523, {0x31, 4, 0x20, 0x7E, 0, 0, 0, 0})));
  EXPECT_TRUE(desk.give(kMillisecond, channel_frame(525, {0x31, 5, 0x20, 0x7F, 0, 0, 0, 0})));
  desk.queue.run_until(kSecond);
  // Input words are those of the moment they are sent at.
  EXPECT_EQ(desk.sender.take(),
            (std::vector<Sent>{
                {1300 * kMicrosecond, process_frame(12, {1300, 2, 3}), 77},
                {6 * kMillisecond, channel_frame(524, {0x31, 4, 0x20, 0x7E, 0, 0, 0x20, 0x7E}), 77},
                {6 * kMillisecond, channel_frame(527, {0x31, 5, 0x20, 0x7F, 0, 0, 0x20, 0x7F}), 77}}));
}

TEST(SbusSlave, EveryChannelWaitsForTheSyncTelegramByItself) {
  SlaveDesk desk(both_channels());
  desk.give(0, channel_frame(523, {0x71, 0, 0, 9, 0, 0, 0, 0}));
  desk.give(0, channel_frame(525, {0x71, 0, 0, 1, 0, 0, 0, 0}));
  EXPECT_TRUE(desk.ignored.empty());
  desk.give(0, process_frame(13, {5, 0, 0}));
  desk.queue.run_until(kSecond);
  EXPECT_TRUE(desk.sender.take().empty());
  EXPECT_TRUE(desk.give(kSecond, {100, 0}));
  // The output counts before the unit is told of the cycle.
  EXPECT_EQ(desk.outputs, (std::vector<std::pair<uint16_t, uint16_t>>{
                              {static_cast<uint16_t>(OutputChannel::Sync), uint16_t{5}}}));
  EXPECT_EQ(desk.syncs, (std::vector<std::pair<Time, size_t>>{{kSecond, 1}}));
  const Time answer = kSecond + 200 * kMicrosecond;  // all within the first millisecond of the cycle
  desk.queue.run_until(2 * kSecond);
  EXPECT_EQ(desk.sender.take(),
            (std::vector<Sent>{{answer, process_frame(12, {1'000'200 % 65'536, 2, 3}), 77},
                               {answer, channel_frame(524, {0x71, 0, 0, 9, 0, 0, 0, 9}), 77},
                               {answer, channel_frame(527, {0xF1, 0, 0, 1, 8, 0, 0, 0x12}), 77}}));
  desk.give(2 * kSecond, {100, 0});
  desk.queue.run_until(3 * kSecond);
  EXPECT_TRUE(desk.sender.take().empty()) << "once";
  EXPECT_EQ(desk.outputs.size(), 1U);
  desk.give(3 * kSecond, channel_frame(525, {0x71, 0, 0, 9, 0, 0, 0, 0}));
  desk.give(3 * kSecond, channel_frame(525, {0x71, 0, 0, 9, 0, 0, 0, 0}));
  ASSERT_EQ(desk.ignored.size(), 1U);
  EXPECT_EQ(desk.ignored[0], (std::tuple{525U, Ignored::AnswerReplaced, ReturnCode{}}));
}

TEST(SbusSlave, NewSettingsForgetWhatWaitsForTheSyncTelegram) {
  SlaveDesk desk(both_channels());
  desk.give(0, channel_frame(523, {0x71, 0, 0, 9, 0, 0, 0, 0}));
  desk.give(0, channel_frame(525, {0x71, 0, 0, 9, 0, 0, 0, 0}));
  desk.give(0, process_frame(13, {5, 0, 0}));
  desk.slave.configure(both_channels());
  desk.give(kMillisecond, {100, 0});
  desk.queue.run_until(kSecond);
  EXPECT_TRUE(desk.sender.take().empty());
  EXPECT_TRUE(desk.outputs.empty());
  EXPECT_EQ(desk.syncs.size(), 1U);
}

TEST(SbusSlave, FramesThatAreNotForItAndFramesThatAreNoGood) {
  SlaveDesk desk(both_channels());
  EXPECT_FALSE(desk.give(0, process_frame(19, {6, 0, 0})));
  EXPECT_FALSE(desk.give(0, process_frame(12, {6, 0, 0}))) << "an answer";
  EXPECT_FALSE(desk.give(0, Frame{11, 6, {}, true, false}));
  EXPECT_FALSE(desk.give(0, Frame{100, 6, {}, true, false}));
  EXPECT_TRUE(desk.give(0, Frame{523, 8, {}, false, true}));
  EXPECT_TRUE(desk.give(0, Frame{100, 0, {}, false, true}));
  for (const uint8_t length : {uint8_t{7}, uint8_t{6}}) EXPECT_TRUE(desk.give(0, Frame{525, length}));
  EXPECT_TRUE(desk.give(0, Frame{22, 8}));
  EXPECT_TRUE(desk.give(0, channel_frame(534, {0x39, 0, 0, 9, 0, 0, 0, 0})));
  EXPECT_TRUE(desk.give(0, channel_frame(534, {0x30, 0, 0, 9, 0, 0, 0, 0})));
  EXPECT_TRUE(desk.give(0, channel_frame(534, {0x33, 0, 0, 1, 0, 0, 0, 0})));
  EXPECT_EQ(desk.ignored, (std::vector<std::tuple<uint32_t, Ignored, ReturnCode>>{
                              {11, Ignored::Extended, {}},
                              {100, Ignored::Extended, {}},
                              {523, Ignored::Remote, {}},
                              {100, Ignored::Remote, {}},
                              {525, Ignored::WrongLength, {}},
                              {525, Ignored::WrongLength, {}},
                              {22, Ignored::WrongLength, {}},
                              {534, Ignored::GroupService, {}},
                              {534, Ignored::GroupService, {}},
                              {534, Ignored::GroupRefused, return_codes::kReadOnly}}));
  desk.queue.run_until(kSecond);
  EXPECT_TRUE(desk.sender.take().empty());
  EXPECT_TRUE(desk.syncs.empty());
  EXPECT_EQ(desk.served, std::vector<uint16_t>{1});
}

// MOVITRAC 07 chapter 4.2: bit 6 is 0; a telegram that has it is refused at once.
TEST(SbusSlave, AUnitWithoutSyncTelegramRefusesBitSix) {
  SlaveSettings settings{1, 2, 100};
  settings.synchronous = false;
  SlaveDesk desk(settings);
  EXPECT_FALSE(desk.give(0, {100, 0}));
  EXPECT_TRUE(desk.give(0, channel_frame(523, {0x71, 0, 0, 9, 0, 0, 0, 0})));
  EXPECT_TRUE(desk.give(0, channel_frame(534, {0x72, 0, 0, 9, 0, 0, 0, 0})));
  desk.queue.run_until(kSecond);
  EXPECT_EQ(desk.sender.take(),
            (std::vector<Sent>{{2 * kMillisecond, channel_frame(524, {0xF1, 0, 0, 9, 5, 5, 0, 0}), 77}}));
  EXPECT_TRUE(desk.served.empty());
  ASSERT_EQ(desk.ignored.size(), 1U);
  EXPECT_EQ(desk.ignored[0], (std::tuple{534U, Ignored::GroupRefused, return_codes::kWrongManagement}));
}

TEST(SbusSlave, GoesWithItsAnswers) {
  EventQueue queue;
  KeepingSender sender(queue);
  SlaveDesk desk({1, 2, 0});
  {
    SbusSlave slave(queue, 1, sender, 1, {1, 2, 0}, {}, desk, desk);
    EXPECT_TRUE(slave.on_frame(0, process_frame(11, {6, 0, 0})));
    EXPECT_TRUE(slave.on_frame(0, Frame{11, 0})) << "nobody is told";
  }
  queue.run_until(kSecond);
  EXPECT_TRUE(sender.take().empty());
}

// --- master of single exchanges

struct MasterDesk final : MovilinkClient {
  void on_exchange_done(Time now, const MovilinkResult& result) override { done.emplace_back(now, result); }
  bool start(const MovilinkJob& job) { return !master.start(queue.now(), job).has_value(); }
  bool give(const Frame& frame) { return master.on_frame(queue.now(), frame); }
  EventQueue queue;
  KeepingSender sender{queue};
  SbusMaster master{queue, 5, sender, 9, 30 * kMillisecond, *this};
  std::vector<std::pair<Time, MovilinkResult>> done;
};

// Lowest and highest address of a unit and of a group.
TEST(SbusMaster, IdentifiersAndAnswersOfTheAddresses) {
  struct Row {
    int32_t address;
    uint32_t request, output;
    std::set<uint32_t> answers;
  };
  for (const Row& row : {Row{0, 515, 3, {4, 516}}, Row{63, 1019, 507, {508, 1020}}, Row{100, 518, 6, {}},
                         Row{163, 1022, 510, {}}}) {
    for (const auto& [format, id] : {std::pair{6, row.request}, {5, row.output}}) {
      MasterDesk desk;
      ASSERT_TRUE(desk.start({row.address, format, 2, 8470, 1, {}}));
      EXPECT_EQ(desk.sender.take_ids(), std::vector{id});
      EXPECT_EQ(desk.sender.listened, row.answers);
    }
  }
}

TEST(SbusMaster, TakesItsAnswerAndNothingLikeIt) {
  const Frame answer = channel_frame(524, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 5});
  const Frame input = process_frame(12, {1, 0xFFFF, 3});
  std::vector<Frame> wrong(7, answer);
  wrong[0].id = 532;
  wrong[1].length = 7;
  wrong[2].data[0] = 0x32;
  wrong[3].data[3] = 0x7F;
  wrong[4].data[2] = 0x21;
  wrong[5].extended = true;
  wrong[6].remote = true;
  MasterDesk desk;
  EXPECT_FALSE(desk.give(answer)) << "nothing was asked";
  ASSERT_TRUE(desk.start({1, 2, 1, 8318, 0, {7, 8, 9}}));
  for (const Frame& frame : wrong) EXPECT_FALSE(desk.give(frame));
  EXPECT_FALSE(desk.give(input)) << "not yet asked for";
  EXPECT_EQ(desk.sender.take_ids(), std::vector<uint32_t>{523});
  EXPECT_TRUE(desk.give(answer));
  EXPECT_EQ(desk.sender.take(), (std::vector<Sent>{{0, process_frame(11, {7, 8, 0}), 9}}));
  EXPECT_FALSE(desk.give(answer)) << "no more asked for";
  wrong.assign(5, input);
  wrong[0].id = 20;
  wrong[1].length = 5;
  wrong[2].length = 7;
  wrong[3].extended = true;
  wrong[4].remote = true;
  for (const Frame& frame : wrong) EXPECT_FALSE(desk.give(frame));
  EXPECT_TRUE(desk.master.busy());
  desk.master.on_sent(0, 9);  // only a group's telegrams are done when they are sent
  EXPECT_TRUE(desk.master.busy());
  EXPECT_TRUE(desk.give(input));
  EXPECT_FALSE(desk.give(input));
  ASSERT_EQ(desk.done.size(), 1U);
  const MovilinkResult& result = desk.done[0].second;
  EXPECT_EQ(result.result, 0U);
  EXPECT_EQ(result.read_value, 5);
  EXPECT_EQ(result.words, 2);
  EXPECT_EQ(result.input, (std::array<int32_t, 3>{1, -1, 3}));
  EXPECT_EQ(result.reason, "");
  desk.queue.run_until(kSecond);
  EXPECT_EQ(desk.done.size(), 1U) << "no timer is left";
}

TEST(SbusMaster, EachAnswerHasATimeOfItsOwn) {
  MasterDesk desk;
  ASSERT_TRUE(desk.start({1, 4, 1, 8318, 0, {}}));
  desk.queue.run_until(29 * kMillisecond);
  EXPECT_TRUE(desk.give(channel_frame(524, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 5})));
  desk.queue.run_until(58 * kMillisecond);
  EXPECT_TRUE(desk.master.busy());
  desk.queue.run_until(kSecond);
  ASSERT_EQ(desk.done.size(), 1U);
  EXPECT_EQ(desk.done[0].first, 59 * kMillisecond);
  // What was read before is not stored.
  EXPECT_EQ(desk.done[0].second.result, 0x06020000U);
  EXPECT_EQ(desk.done[0].second.read_value, std::nullopt);
  EXPECT_EQ(desk.done[0].second.words, 0);
  EXPECT_EQ(desk.done[0].second.reason, "no answer");
  EXPECT_EQ(desk.sender.withdrawn, std::vector<uint64_t>{9});
  EXPECT_TRUE(desk.sender.waiting.empty() || desk.sender.waiting[0].tag != 9);
  // The next exchange knows nothing of it.
  ASSERT_TRUE(desk.start({1, 6, 1, 8318, 0, {}}));
  EXPECT_TRUE(desk.give(channel_frame(524, {0x31, 0, 0x20, 0x7E, 0, 0, 0, 6})));
  EXPECT_EQ(desk.done[1].second.result, 0U);
  EXPECT_EQ(desk.done[1].second.reason, "");
}

TEST(SbusMaster, AGroupIsDoneWhenItsTelegramsAreSent) {
  MasterDesk desk;
  ASSERT_TRUE(desk.start({102, 4, 2, 8470, 7, {6, 1, 2}}));
  EXPECT_FALSE(desk.give(channel_frame(524, {0x32, 0, 0x21, 0x16, 0, 0, 0, 7}))) << "a group answers nothing";
  desk.master.on_sent(0, 8);  // another one of the unit
  EXPECT_EQ(desk.sender.take_ids(), std::vector<uint32_t>{534});
  desk.master.on_sent(0, 9);
  EXPECT_EQ(desk.sender.take_ids(), std::vector<uint32_t>{22});
  EXPECT_TRUE(desk.done.empty());
  desk.master.on_sent(0, 8);
  EXPECT_TRUE(desk.done.empty());
  desk.master.on_sent(0, 9);
  ASSERT_EQ(desk.done.size(), 1U);
  EXPECT_EQ(desk.done[0].second.result, 0U);
  desk.master.on_sent(0, 9);
  EXPECT_EQ(desk.done.size(), 1U);
}

TEST(SbusMaster, AbortTakesBackItsOwnFrame) {
  MasterDesk desk;
  desk.master.abort();
  EXPECT_TRUE(desk.sender.withdrawn.empty()) << "there was none";
  ASSERT_TRUE(desk.start({1, 5, 0, 0, 0, {}}));
  desk.master.abort();
  EXPECT_EQ(desk.sender.withdrawn, std::vector<uint64_t>{9});
  EXPECT_FALSE(desk.give(process_frame(12, {})));
  desk.queue.run_until(kSecond);
  EXPECT_TRUE(desk.done.empty());
}

// --- master control

ControlSettings two_of_each() {
  ControlSettings settings;
  settings.sync_id = 128;
  settings.cycle = 10 * kMillisecond;
  settings.targets = {{1, false, {1, 0, 0}, 0},
                      {2, false, {2, 0, 0}, 4 * kMillisecond},
                      {3, false, {3, 0, 0}, 0},
                      {2, true, {4, 0, 0}, 5 * kMillisecond}};
  return settings;
}

struct ControlDesk {
  explicit ControlDesk(ControlSettings settings) : control(queue, 8, std::move(settings)) {}
  EventQueue queue;
  KeepingSender sender{queue};
  SbusControl control;
};

// Sync telegram, then PO-sync 3 ms later; others at their own times. Nothing of it is taken, so everything new takes the
// place of the one before it.
TEST(SbusControl, ATelegramThatWaitsIsOvertakenByTheNextOne) {
  ControlDesk desk(two_of_each());
  desk.control.start(desk.sender);
  desk.queue.run_until(Time{22'900} * kMicrosecond);
  std::map<uint32_t, std::pair<Time, uint16_t>> waiting;
  for (const Sent& sent : desk.sender.waiting)
    waiting[sent.frame.id] = {sent.time, process_words(sent.frame).value_or(ProcessWords{})[0]};
  EXPECT_EQ(desk.sender.waiting.size(), 5U);
  EXPECT_EQ(waiting, (std::map<uint32_t, std::pair<Time, uint16_t>>{{128, {20 * kMillisecond, 0}},
                                                                    {13, {13 * kMillisecond, 1}},
                                                                    {19, {20 * kMillisecond, 2}},
                                                                    {29, {13 * kMillisecond, 3}},
                                                                    {22, {20 * kMillisecond, 4}}}));
  std::set<uint64_t> tags;
  for (const Sent& sent : desk.sender.waiting) tags.insert(sent.tag);
  EXPECT_EQ(tags.size(), 5U);
  EXPECT_EQ(desk.control.answers(0).asked, 2U);
  EXPECT_EQ(desk.control.answers(1).asked, 6U);
  EXPECT_EQ(desk.control.answers(2).asked, 2U);
  EXPECT_EQ(desk.control.answers(3).asked, 0U) << "a group answers nothing";
  // New words go out with the next telegram.
  desk.control.set_output(2, {9, 8, 7});
  desk.sender.take();
  desk.queue.run_until(23 * kMillisecond);
  EXPECT_EQ(desk.sender.take_ids(), (std::vector<uint32_t>{13, 29}));
  desk.queue.run_until(33 * kMillisecond);
  for (const Sent& sent : desk.sender.take()) {
    if (sent.frame.id == 29) {
      EXPECT_EQ(sent.frame, process_frame(29, {9, 8, 7}));
    }
  }
}

TEST(SbusControl, WithoutASyncTelegramNothingIsSynchronous) {
  ControlSettings settings = two_of_each();
  settings.sync_id.reset();
  ControlDesk desk(settings);
  desk.queue.run_until(kSecond);
  desk.control.start(desk.sender);
  desk.queue.run_until(kSecond + 3900 * kMicrosecond);
  std::vector<Sent> sent = desk.sender.take();
  ASSERT_EQ(sent.size(), 2U);
  EXPECT_EQ(sent[0].time, kSecond) << "at once";
  EXPECT_EQ(sent[0].frame.id, 19U);
  EXPECT_EQ(sent[1].frame.id, 22U);
}

TEST(SbusControl, AnswersAreCountedByTarget) {
  ControlDesk desk(two_of_each());
  desk.control.start(desk.sender);
  desk.control.on_frame(5, process_frame(20, {7, 8, 9}));
  desk.control.on_frame(6, process_frame(20, {1, 2, 3}));
  desk.control.on_frame(7, process_frame(12, {4, 5, 6}));
  desk.control.on_frame(8, Frame{12, 5});
  desk.control.on_frame(8, Frame{12, 6, {}, true, false});
  desk.control.on_frame(8, process_frame(36, {}));  // a unit that is none of its targets
  desk.control.on_frame(8, process_frame(19, {}));  // no answer
  EXPECT_EQ(desk.control.answers(0).answered, 1U);
  EXPECT_EQ(desk.control.answers(0).last, 7);
  EXPECT_EQ(desk.control.answers(0).input, (ProcessWords{4, 5, 6}));
  EXPECT_EQ(desk.control.answers(1).answered, 2U);
  EXPECT_EQ(desk.control.answers(1).last, 6);
  EXPECT_EQ(desk.control.answers(1).input, (ProcessWords{1, 2, 3}));
  EXPECT_EQ(desk.control.answers(2).answered, 0U);
  EXPECT_EQ(desk.control.answers(3).answered, 0U) << "the group has the number of a unit";
  desk.control.stop();
  EXPECT_EQ(desk.control.answers(1).answered, 0U);
  EXPECT_EQ(desk.control.answers(1).asked, 0U);
  desk.sender.take();
  desk.queue.run_until(kSecond);
  EXPECT_TRUE(desk.sender.take().empty());
  desk.control.start(desk.sender);
  desk.queue.run_until(kSecond);
  EXPECT_EQ(desk.sender.take_ids(), (std::vector<uint32_t>{128, 19, 22}));
  desk.control.on_bus_off(kSecond);
  EXPECT_EQ(desk.sender.recoveries, 1);
}

// --- master/slave

struct CountingDrive final : MasterSlaveDrive {
  ProcessWords setpoint_to_send(Time now) override { return {6, static_cast<uint16_t>(now), 1}; }
  void setpoint_received(Time, const ProcessWords&) override {}
  void link_lost(Time) override {}
};

TEST(MasterSlave, ANewSetpointOvertakesTheOneThatWaits) {
  EventQueue queue;
  KeepingSender sender(queue);
  CountingDrive drive;
  GroupMaster master(sender, 5, drive);
  master.tick(1);
  EXPECT_TRUE(sender.waiting.empty()) << "not configured";
  EXPECT_EQ(master.configure(2, 63, 500'000), "");
  sender.send(Frame{7, 0}, 4);
  master.tick(2);
  master.tick(3);
  EXPECT_EQ(sender.take(), (std::vector<Sent>{{0, Frame{7, 0}, 4}, {0, process_frame(510, {6, 3, 1}), 5}}));
  EXPECT_EQ(master.configure(3, 0, 250'000),
            "P750 = 3: no slave setpoints are sent at 250 kbaud, master/slave needs 500 or 1000 kbaud");
  EXPECT_FALSE(master.active());
}

// P750 (1053 1610 p. 80): speed, torque and load sharing, each over RS-485, SBus and both.
TEST(MasterSlave, CodesAndRatesBeyondTheList) {
  for (int32_t code = -3; code <= 13; ++code) {
    const bool expected = code == 2 || code == 3 || code == 5 || code == 6 || code == 8 || code == 9;
    EXPECT_EQ(sends_over_sbus(code), expected) << code;
  }
  for (const uint32_t baud : {125'000U, 250'000U, 500'000U, 1'000'000U})
    EXPECT_EQ(is_master_slave_rate(baud), baud >= 500'000U);
}

}  // namespace
}  // namespace ipos::tests

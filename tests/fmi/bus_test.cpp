// Terminals of FMI-LS-BUS 1.0 for CAN: operations to the byte, and the manual's two stations in two FMUs, connected with and without
// a bus between them.
#include <gtest/gtest.h>

#include "runtime/fmi/can_operations.hpp"
#include "tests/fmi/event_mode.hpp"
#include "tests/fmi/functions.hpp"

namespace ipos::tests {
namespace {

using fmi::CanOperation;

runtime::Frame some_frame() {
  runtime::Frame frame;
  frame.id = 0x20B;
  frame.length = 3;
  frame.data = {0x11, 0x22, 0x33};
  return frame;
}

// Table of chapter "CAN, CAN FD, CAN XL": op code, length, ID, Ide, Rtr, data length, data.
TEST(FmiCanOperations, AreThoseOfTheTable) {
  runtime::Frame frame = some_frame();
  EXPECT_EQ(fmi::transmit_operation(frame),
            bytes({0x10, 0, 0, 0, 19, 0, 0, 0, 0x0B, 2, 0, 0, 0, 0, 3, 0, 0x11, 0x22, 0x33}));
  frame.id = 0x1ABCDEF0;
  frame.extended = true;
  frame.remote = true;
  EXPECT_EQ(fmi::transmit_operation(frame), bytes({0x10, 0, 0, 0, 16, 0, 0, 0, 0xF0, 0xDE, 0xBC, 0x1A, 1, 1, 0, 0}));
  EXPECT_EQ(fmi::configuration_operations(500'000),
            bytes({0x40, 0, 0, 0, 13, 0, 0, 0, 1, 0x20, 0xA1, 7, 0, 0x40, 0, 0, 0, 10, 0, 0, 0, 4, 1}));
  EXPECT_EQ(fmi::format_error_operation("ab"), bytes({1, 0, 0, 0, 12, 0, 0, 0, 2, 0, 'a', 'b'}));
}

TEST(FmiCanOperations, AreReadOneBehindTheOther) {
  const std::string confirm = bytes({0x20, 0, 0, 0, 12, 0, 0, 0, 5, 0, 0, 0});
  const std::string error = bytes({0x31, 0, 0, 0, 15, 0, 0, 0, 6, 0, 0, 0, 4, 1, 1});
  const std::string all = fmi::transmit_operation(some_frame()) + confirm + error + bytes({0x42, 0, 0, 0, 8, 0, 0, 0});
  const auto read = fmi::read_operations(all);
  ASSERT_EQ(read.size(), 4U);
  EXPECT_TRUE(read[0].is_good && read[1].is_good && read[2].is_good && read[3].is_good);
  EXPECT_EQ(read[0].frame, some_frame());
  EXPECT_EQ(read[1].kind, CanOperation::Confirm);
  EXPECT_EQ(read[1].id, 5U);
  EXPECT_TRUE(read[2].is_sender);
  EXPECT_EQ(read[2].id, 6U);
  for (size_t n = 1; n < all.size(); ++n)
    for (const auto& each : fmi::read_operations(all.substr(0, n))) EXPECT_LE(each.bytes.size(), n);
  for (const std::string& wrong : {bytes({0x10, 0, 0, 0}), bytes({0x10, 0, 0, 0, 7, 0, 0, 0}), bytes({0x10, 0, 0, 0, 99, 0, 0, 0}),
                                   bytes({0x99, 0, 0, 0, 8, 0, 0, 0}), bytes({0x20, 0, 0, 0, 8, 0, 0, 0})}) {
    const auto read_wrong = fmi::read_operations(wrong);
    ASSERT_EQ(read_wrong.size(), 1U);
    EXPECT_FALSE(read_wrong[0].is_good);
  }
}

// A station on a line of its own, which is a terminal; and the program that counts what it gets and sends.
constexpr const char* kPlant = R"([[bus]]
name = "sbus"
kind = "can"
baud = 500000
port = "fmi"
[[station]]
name = "u"
unit = "md60a"
program = "P.IPC"
sbus = "sbus"
)";
// Sends H430 and H431 every 10 ms as object 1025, and takes object 1026 into H440.
constexpr const char* kSender = R"(#include <const.h>
#include <io.h>
SCTRCYCL t;
SCREC r;
main() {
  t.ObjectNo = 1025; t.CycleTime = 10; t.Offset = 0; t.Format = 8; t.DPointer = 430;
  _SBusCommDef(SCD_TRCYCL, t);
  r.ObjectNo = 1026; r.Format = 8; r.DPointer = 440;
  _SBusCommDef(SCD_REC, r);
  _SBusCommOn();
  while (1) { H430 = H430 + 1; _Wait(5); }
}
)";
constexpr const char* kReceiver = R"(#include <const.h>
#include <io.h>
SCTRCYCL t;
SCREC r;
main() {
  t.ObjectNo = 1026; t.CycleTime = 10; t.Offset = 0; t.Format = 8; t.DPointer = 430;
  _SBusCommDef(SCD_TRCYCL, t);
  r.ObjectNo = 1025; r.Format = 8; r.DPointer = 440;
  _SBusCommDef(SCD_REC, r);
  _SBusCommOn();
  H430 = 4711;
  while (1) { }
}
)";

class Node {
 public:
  Node(const char* program, Told& told, bool notified = false) : resources_(kPlant, program, {{}, {"u.H430", "u.H440"}}) {
    first_ = static_cast<uint32_t>(resources_.variables().all.size() + 1);
    c_ = resources_.make3(told, true);
    const uint32_t notifications = first_ + 4;
    EXPECT_EQ(fmi3SetBoolean(c_, &notifications, 1, &notified, 1), kOk);
    EXPECT_EQ(fmi3EnterInitializationMode(c_, false, 0, 0, false, 0), kOk);
    EXPECT_EQ(fmi3ExitInitializationMode(c_), kOk);
  }
  ~Node() { fmi3FreeInstance(c_); }

  // In event mode: what goes out, nothing while the clock is not active.
  std::string fetch() {
    const uint32_t clock = first_ + 3, data = first_ + 1;
    bool active = false;
    EXPECT_EQ(fmi3GetClock(c_, &clock, 1, &active), kOk);
    if (!active) return "";
    bool again = true;
    EXPECT_EQ(fmi3GetClock(c_, &clock, 1, &again), kOk);
    EXPECT_FALSE(again) << "active once";
    size_t size = 0;
    const uint8_t* out = nullptr;
    EXPECT_EQ(fmi3GetBinary(c_, &data, 1, &size, &out, 1), kOk);
    return {reinterpret_cast<const char*>(out), size};
  }
  void give(const std::string& operations) {
    if (!operations.empty()) give_operations(c_, first_ + 2, first_, operations);
  }
  void update() { update_states(c_); }
  bool step(double from, double length) {
    bool event = false, ends = false, early = false;
    double reached = 0;
    EXPECT_EQ(fmi3EnterStepMode(c_), kOk);
    EXPECT_EQ(fmi3DoStep(c_, from, length, true, &event, &ends, &early, &reached), kOk);
    EXPECT_FALSE(early);
    EXPECT_EQ(fmi3EnterEventMode(c_), kOk);
    return event;
  }
  int get(const char* name) {
    const uint32_t reference = resources_.reference(name);
    int32_t value = 0;
    EXPECT_EQ(fmi3GetInt32(c_, &reference, 1, &value, 1), kOk);
    return value;
  }
  void* instance() { return c_; }

 private:
  Resources resources_;
  uint32_t first_ = 0;
  void* c_ = nullptr;
};

TEST(FmiBus, TwoStationsInTwoFmusMeet) {
  Told told;
  Node one(kSender, told), other(kReceiver, told);
  EXPECT_EQ(one.fetch(), fmi::configuration_operations(500'000)) << "first of all";
  one.update();
  other.fetch();
  other.update();
  size_t frames = 0;
  for (int ms = 0; ms < 200; ++ms) {
    const bool sends = one.step(ms * 1e-3, 1e-3), answers = other.step(ms * 1e-3, 1e-3);
    const std::string out = one.fetch(), back = other.fetch();
    EXPECT_EQ(sends, !out.empty());
    EXPECT_EQ(answers, !back.empty());
    frames += fmi::read_operations(out).size();
    one.give(back);
    other.give(out);
    one.update();
    other.update();
  }
  EXPECT_NEAR(static_cast<double>(frames), 20, 2) << "every 10 ms";
  EXPECT_NEAR(other.get("u.H440"), one.get("u.H430"), 3);
  EXPECT_GT(other.get("u.H440"), 20);
  EXPECT_EQ(one.get("u.H440"), 4711);
  EXPECT_EQ(told.text, "");
}

// With the parameter BusNotifications; without it a node sends and forgets, and takes no offence at what it is told.
class FmiBusNotifications : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(OnAndOff, FmiBusNotifications, ::testing::Bool());

TEST_P(FmiBusNotifications, WhatABusSimulationLosesIsSentAgainAndNonsenseIsTold) {
  Told told;
  Node node(kSender, told, GetParam());
  node.fetch();
  node.update();
  std::string out;
  for (int ms = 0; out.empty(); ++ms) {
    node.step(ms * 1e-3, 1e-3);
    out = node.fetch();
    node.update();
  }
  const uint32_t id = fmi::read_operations(out).front().id;
  const auto low = static_cast<int>(id & 0xFF), high = static_cast<int>(id >> 8);
  node.give(bytes({0x31, 0, 0, 0, 15, 0, 0, 0, low, high, 0, 0, 4, 1, 1}));
  node.update();
  EXPECT_EQ(node.fetch(), GetParam() ? out : "") << "a bus error of its own";
  node.update();
  node.give(bytes({0x30, 0, 0, 0, 12, 0, 0, 0, low, high, 0, 0}));
  node.update();
  EXPECT_EQ(node.fetch(), GetParam() ? out : "") << "an arbitration lost";
  node.update();
  node.give(bytes({0x20, 0, 0, 0, 12, 0, 0, 0, low, high, 0, 0}));
  node.update();
  EXPECT_EQ(node.fetch(), "") << "a confirmation asks for nothing";
  EXPECT_EQ(told.text, "");
  node.give("nonsense");
  node.update();
  EXPECT_TRUE(told.has("sbus: an operation of 8 bytes cannot be read")) << told.text;
  EXPECT_EQ(node.fetch(), fmi::format_error_operation("nonsense"));
}

TEST(FmiBus, AStateHasWhatWaits) {
  Told told;
  Node one(kSender, told), other(kReceiver, told);
  const auto exchange = [&](int from, int to) {
    for (int ms = from; ms < to; ++ms) {
      one.step(ms * 1e-3, 1e-3);
      other.step(ms * 1e-3, 1e-3);
      const std::string out = one.fetch(), back = other.fetch();
      one.give(back);
      other.give(out);
      one.update();
      other.update();
    }
    return std::pair(one.get("u.H440"), other.get("u.H440"));
  };
  exchange(0, 55);
  void* states[2] = {};
  ASSERT_EQ(fmi3GetFMUState(one.instance(), &states[0]), kOk);
  ASSERT_EQ(fmi3GetFMUState(other.instance(), &states[1]), kOk);
  const auto end = exchange(55, 130);
  ASSERT_EQ(fmi3SetFMUState(one.instance(), states[0]), kOk) << told.text;
  ASSERT_EQ(fmi3SetFMUState(other.instance(), states[1]), kOk) << told.text;
  EXPECT_EQ(exchange(55, 130), end);
  EXPECT_EQ(fmi3FreeFMUState(one.instance(), &states[0]), kOk);
  EXPECT_EQ(fmi3FreeFMUState(other.instance(), &states[1]), kOk);
}

TEST(FmiBus, MembersAreToldApart) {
  Told told;
  const Resources resources(kPlant, kReceiver);
  void* c = resources.begin3(told, true);
  EXPECT_EQ(fmi3EnterEventMode(c), kOk);
  const auto first = static_cast<uint32_t>(resources.variables().all.size() + 1);
  bool active = false;
  for (uint32_t member = 0; member < 6; ++member) {
    const uint32_t reference = first + member;
    active = false;
    double seconds = 0;
    int known = 0;
    EXPECT_EQ(fmi3GetClock(c, &reference, 1, &active), member == 3 ? kOk : kError) << member;
    EXPECT_EQ(fmi3SetClock(c, &reference, 1, &active), member == 2 ? kOk : kError) << member;
    EXPECT_EQ(fmi3GetIntervalDecimal(c, &reference, 1, &seconds, &known), kError) << "its clock is no countdown";
    active = member == 4;
    EXPECT_EQ(fmi3GetBoolean(c, &reference, 1, &active, 1), member == 4 ? kOk : kError) << member;
    EXPECT_FALSE(active) << "BusNotifications is off at first";
    EXPECT_EQ(fmi3SetBoolean(c, &reference, 1, &active, 1), kError) << "a fixed parameter, and the node runs";
  }
  const uint32_t data = first + 1;
  EXPECT_EQ(fmi3GetBinary(c, &data, 1, nullptr, nullptr, 1), kError);
  EXPECT_EQ(fmi3GetClock(c, nullptr, 1, &active), kError);
  double value = 0;
  EXPECT_EQ(fmi3GetFloat64(c, &data, 1, &value, 1), kError);
  fmi3FreeInstance(c);
}

}  // namespace
}  // namespace ipos::tests

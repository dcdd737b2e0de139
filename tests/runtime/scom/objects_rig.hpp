// The objects of one unit without a bus: what they send is kept, the program's variables are at hand.
#pragma once

#include "runtime/scom/variable_objects.hpp"

#include <gtest/gtest.h>

namespace ipos::runtime {

struct Outbox final : FrameSender {
  struct Sent {
    Frame frame;
    uint64_t tag;
  };
  SendStatus send(const Frame& frame, uint64_t tag) override {
    sent.push_back({frame, tag});
    return status;
  }
  void withdraw(uint64_t tag) override { withdrawn.push_back(tag); }
  void listen(uint32_t id) override { heard.push_back(id); }
  std::vector<Sent> sent;
  std::vector<uint64_t> withdrawn;
  std::vector<uint32_t> heard;
  SendStatus status = SendStatus::Queued;
};

class Objects : public ::testing::Test {
 protected:
  explicit Objects(std::string_view unit = "md60a", uint32_t baud = 500'000)
      : objects_(*stdlib::find_unit(unit), baud, outbox_, 100), h_(stdlib::find_unit(unit)->variables) {}

  // SCTRCYCL at H420 with data at H426; returns Result.
  int32_t cyclic(int32_t id, int32_t cycle, int32_t offset = 0, int32_t format = 8, int32_t data = 426) {
    const int32_t elements[] = {id, cycle, offset, format, data, 12345};
    std::copy(std::begin(elements), std::end(elements), h_.begin() + 420);
    why_.clear();
    EXPECT_TRUE(objects_.define(ObjectKind::TransmitCyclic, 420, h_, why_));
    return h_[425];
  }
  void receive(int32_t id, int32_t format = 8, int32_t data = 431) {
    h_[428] = id;
    h_[429] = format;
    h_[430] = data;
    why_.clear();
    EXPECT_TRUE(objects_.define(ObjectKind::Receive, 428, h_, why_));
  }
  // SCTRACYCL at `at` with data at H20; returns the status.
  int32_t acyclic(int32_t id, uint32_t at = 10, int32_t format = 8) {
    const int32_t elements[] = {id, format, 20, 12345};
    std::copy(std::begin(elements), std::end(elements), h_.begin() + at);
    why_.clear();
    EXPECT_TRUE(objects_.define(ObjectKind::TransmitAcyclic, at, h_, why_));
    return h_[at + 3];
  }
  bool arrives(uint32_t id, uint8_t length = 8) {
    Frame frame;
    frame.id = id;
    frame.length = length;
    frame.data = {0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44};
    return objects_.on_frame(frame, h_, why_);
  }
  std::vector<int64_t> send_times(int64_t until) {
    std::vector<int64_t> times;
    for (int64_t tick = 0; tick < until; ++tick) {
      const size_t before = outbox_.sent.size();
      objects_.tick(tick, h_);
      if (outbox_.sent.size() != before) times.push_back(tick);
    }
    return times;
  }

  Outbox outbox_;
  VariableObjects objects_;
  std::vector<int32_t> h_;
  std::string why_;
};

class ObjectsM07 : public Objects {
 protected:
  ObjectsM07() : Objects("mc07") {}
};
class ObjectsB : public Objects {
 protected:
  ObjectsB() : Objects("mdxb") {}
};
class ObjectsSlowBus : public Objects {
 protected:
  ObjectsSlowBus() : Objects("md60a", 125'000) {}
};

}  // namespace ipos::runtime

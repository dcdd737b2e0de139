// The length of collisions against a model that knows only single bits: what each node sends, the wired AND
// of all, and what each node then sees. Arbitration itself: tests/runtime/bus/campaign.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "runtime/bus/can/transfer.hpp"
#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::runtime {
namespace {

struct ModelSender {
  std::string bits;
  bool error_active = true;
};

// Senders with one identifier and different content, and one error-active listener, bit by bit. Who is error-passive falls
// silent when it sees another bit than its own. The bit behind the error delimiter; 0 when nobody disturbs the frame.
size_t collision_model(const std::vector<ModelSender>& senders, bool listener) {
  struct Station {
    std::string bits;  // what it sends by itself
    bool sender;
    bool error_active;
    size_t flag_from = ~size_t{0};
  };
  std::vector<Station> stations;
  for (const ModelSender& sender : senders) stations.push_back({sender.bits, true, sender.error_active});
  if (listener) stations.push_back({"", false, true});
  std::string bus;
  size_t length = 0;  // of the frame that a listener decodes
  bool disturbed = false;
  for (size_t i = 0; i < 400; ++i) {
    for (const ModelSender& sender : senders)
      if (sender.bits.compare(0, i, bus) == 0) length = sender.bits.size();
    char level = '1';
    for (const Station& s : stations) {
      const bool flag = s.error_active && i >= s.flag_from && i < s.flag_from + 6;
      const bool frame = s.flag_from == ~size_t{0} && i < s.bits.size();
      disturbed |= flag;
      if (flag || (frame && s.bits[i] == '0')) level = '0';
    }
    if (!disturbed && i + 9 == length) return 0;  // its acknowledge slot: the frame is whole
    bus += level;
    for (Station& s : stations) {
      if (s.flag_from != ~size_t{0}) continue;
      if (s.sender) {
        if (i < s.bits.size() && s.bits[i] != level) s.flag_from = i + 1;
        continue;
      }
      // The listener follows the bus: six equal bits are a stuff error, a dominant bit where the frame it
      // decodes has its CRC delimiter is a form error.
      if (bus.size() >= 6 && bus.substr(bus.size() - 6) == std::string(6, level)) {
        s.flag_from = i + 1;
        continue;
      }
      if (i == length - 10 && level == '0') s.flag_from = i + 1;
    }
  }
  return bus.find_last_of('0') + 1 + 8;
}

// A frame, and others with its identifier and other content.
Frame any_frame(std::mt19937& random) {
  Frame a;
  a.id = static_cast<uint32_t>(random() % kStandardIdLimit);
  a.length = static_cast<uint8_t>(random() % 9);
  for (size_t n = 0; n < a.length; ++n) a.data[n] = random() % 2 == 0 ? 0 : static_cast<uint8_t>(random());
  return a;
}
Frame other_content(const Frame& a, std::mt19937& random) {
  Frame b = a;
  if (a.length == 0 || random() % 4 == 0) {
    b.length = static_cast<uint8_t>((a.length + 1 + random() % 8) % 9);
    return canonical(b);
  }
  b.data[random() % a.length] ^= static_cast<uint8_t>(1U << random() % 8);
  return b;
}

TEST(Collision, LastsAsLongAsInTheBitModel) {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    const Frame a = any_frame(random), b = other_content(a, random);
    const bool listener = i % 2 == 0;
    KnownFrames known;
    Transfer transfer;
    transfer.senders = {{0, a, 0, true, false}, {1, b, 0, true, false}};
    resolve(transfer, {listener, listener}, known);
    ASSERT_EQ(transfer.outcome, Transfer::Outcome::Collision);
    ASSERT_EQ(transfer.end, collision_model({{tests::wire(a)}, {tests::wire(b)}}, listener))
        << tests::wire(a) << '\n'
        << tests::wire(b);
    ASSERT_EQ(transfer.bits, transfer.end + 3);
  }
}

// Two or three senders, each error-active or not. Without an error-active one that sees another bit the frame with the
// dominant bits gets through, and the others have lost.
TEST(Collision, OfPassiveSendersIsThatOfTheBitModelToo) {
  std::mt19937 random(6);
  size_t collisions = 0, delivered = 0;
  for (int i = 0; i < 6000; ++i) {
    std::vector<Frame> frames = {any_frame(random)};
    while (frames.size() < 2 + static_cast<size_t>(i % 2)) frames.push_back(other_content(frames[0], random));
    if (random() % 8 == 0) frames.push_back(frames[random() % frames.size()]);
    std::vector<ModelSender> model;
    Transfer transfer;
    for (const Frame& frame : frames) {
      const bool active = random() % 2 == 0;
      model.push_back({tests::wire(frame), active});
      transfer.senders.push_back({static_cast<NodeId>(model.size()), frame, 0, active, false});
    }
    KnownFrames known;
    resolve(transfer, {true, true}, known);
    const size_t end = collision_model(model, true);
    SCOPED_TRACE(testing::Message() << i << ", " << frames.size() << " senders");
    if (end != 0) {
      ASSERT_EQ(transfer.outcome, Transfer::Outcome::Collision);
      ASSERT_EQ(transfer.end, end);
      ++collisions;
      continue;
    }
    ASSERT_EQ(transfer.outcome, Transfer::Outcome::Delivered);
    // '0' is dominant, so what gets through is the first text in order, up to where the shorter one ends.
    const auto best = std::min_element(model.begin(), model.end(), [](const ModelSender& x, const ModelSender& y) {
      return x.bits < y.bits;
    });
    ASSERT_EQ(transfer.end, best->bits.size());
    ASSERT_EQ(transfer.bits, transfer.end + 3);
    ASSERT_EQ(tests::wire(transfer.winner().frame), best->bits);
    for (size_t n = 0; n < model.size(); ++n) ASSERT_EQ(transfer.senders[n].lost, model[n].bits != best->bits);
    ++delivered;
  }
  EXPECT_GT(collisions, 1000U);
  EXPECT_GT(delivered, 500U);
}

}  // namespace
}  // namespace ipos::runtime

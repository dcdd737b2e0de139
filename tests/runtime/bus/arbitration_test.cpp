// The length of collisions against a model that knows only single bits: what each node sends, the wired AND
// of all, and what each node then sees. Arbitration itself: tests/runtime/bus/campaign.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "runtime/bus/can/transfer.hpp"
#include "tests/runtime/bus/wire_model.hpp"

namespace ipos::runtime {
namespace {

// Two error-active senders with one identifier and different content, and one listener, bit by bit. Returns
// the bit behind the error delimiter.
size_t collision_model(const std::string& a, const std::string& b, bool listener) {
  struct Station {
    std::string bits;  // what it sends by itself
    bool sender;
    size_t flag_from = ~size_t{0};
  };
  std::vector<Station> stations = {{a, true}, {b, true}};
  if (listener) stations.push_back({"", false});
  std::string bus;
  for (size_t i = 0; i < 400; ++i) {
    char level = '1';
    for (const Station& s : stations) {
      const bool flag = i >= s.flag_from && i < s.flag_from + 6;
      const bool frame = s.flag_from == ~size_t{0} && i < s.bits.size();
      if (flag || (frame && s.bits[i] == '0')) level = '0';
    }
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
      const std::string& winner = a.substr(0, bus.size() - 1) == bus.substr(0, bus.size() - 1) ? a : b;
      if (i == winner.size() - 10 && level == '0') s.flag_from = i + 1;
    }
  }
  return bus.find_last_of('0') + 1 + 8;
}

TEST(Collision, LastsAsLongAsInTheBitModel) {
  std::mt19937 random(5);
  for (int i = 0; i < 3000; ++i) {
    Frame a;
    a.id = static_cast<uint32_t>(random() % kStandardIdLimit);
    a.length = static_cast<uint8_t>(random() % 9);
    for (size_t n = 0; n < a.length; ++n) a.data[n] = random() % 2 == 0 ? 0 : static_cast<uint8_t>(random());
    Frame b = a;
    if (a.length == 0 || random() % 4 == 0) {
      b.length = static_cast<uint8_t>((a.length + 1 + random() % 8) % 9);
      b = canonical(b);
    } else {
      b.data[random() % a.length] ^= static_cast<uint8_t>(1U << random() % 8);
    }
    const bool listener = i % 2 == 0;
    KnownFrames known;
    Transfer transfer;
    transfer.senders = {{0, a, 0, true, false}, {1, b, 0, true, false}};
    resolve(transfer, {listener, listener}, known);
    ASSERT_EQ(transfer.outcome, Transfer::Outcome::Collision);
    ASSERT_EQ(transfer.end, collision_model(tests::wire(a), tests::wire(b), listener))
        << tests::wire(a) << '\n'
        << tests::wire(b);
    ASSERT_EQ(transfer.bits, transfer.end + 3);
  }
}

}  // namespace
}  // namespace ipos::runtime

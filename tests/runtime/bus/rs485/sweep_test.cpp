// Exhaustive sweep: every telegram type in both directions, every single bit, every pair of bits, every
// character cut or added at every position, on the wire and through the receiver. Accepted must be only what
// an exclusive-or with even parity cannot tell from a telegram; those are listed by class. The counts are
// printed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <random>
#include <set>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/levels.hpp"
#include "tests/harness/proves.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT
using Bytes = std::vector<uint8_t>;

// TYP and PDU length as printed (1053 1610 p. 23-24).
const std::map<int, size_t> kPduLength = {{0x00, 10}, {0x01, 2},  {0x02, 12}, {0x03, 4}, {0x04, 14},
                                          {0x05, 6},  {0x06, 8},  {0x80, 10}, {0x81, 2}, {0x82, 12},
                                          {0x83, 4},  {0x84, 14}, {0x85, 6},  {0x86, 8}};

// The oracle: does a telegram stand at the begin of these characters? Written from the manual alone.
std::optional<Bytes> telegram_in(const Bytes& bytes) {
  if (bytes.size() < 3 || (bytes[0] != 0x02 && bytes[0] != 0x1D)) return std::nullopt;
  const auto row = kPduLength.find(bytes[2]);
  if (row == kPduLength.end() || bytes.size() < row->second + 4) return std::nullopt;
  const Bytes telegram(bytes.begin(), bytes.begin() + static_cast<long>(row->second + 4));
  uint8_t all = 0;
  for (const uint8_t byte : telegram) all ^= byte;
  if (all != 0) return std::nullopt;
  return telegram;
}

// 28 kinds of telegram, each with contents that matter: zeros, ones, start characters, the manual's, any.
std::vector<Bytes> telegrams(int random_contents) {
  std::mt19937 random(20260727);
  std::vector<Bytes> all;
  for (const uint8_t start : {uint8_t{0x02}, uint8_t{0x1D}})
    for (const auto& [type, pdu] : kPduLength)
      for (int content = 0; content < 4 + random_contents; ++content) {
        static constexpr uint8_t kManual[] = {0x31, 0x00, 0x20, 0x7E, 0x00, 0x06, 0x3A,
                                              0x98, 0x01, 0xF4, 0x00, 0x06, 0x13, 0x88};
        Bytes bytes = {start, static_cast<uint8_t>(content < 4 ? 1 : random() % 256),
                       static_cast<uint8_t>(type)};
        for (size_t n = 0; n < pdu; ++n) {
          const uint8_t fixed[] = {0x00, 0xFF, static_cast<uint8_t>(n % 2 == 0 ? 0x02 : 0x1D), kManual[n]};
          bytes.push_back(content < 4 ? fixed[content] : static_cast<uint8_t>(random()));
        }
        uint8_t check = 0;
        for (const uint8_t byte : bytes) check ^= byte;
        bytes.push_back(check);
        all.push_back(bytes);
      }
  return all;
}

// What a receiver makes of levels on the wire.
std::vector<Reception> receive(std::vector<bool> bits, uint32_t bit_ticks = 1) {
  const Transmission wire{0, 0, bit_ticks, std::move(bits)};
  const std::span<const Transmission> line(&wire, 1);
  const Ear ear{bit_ticks, kNoNode};
  SerialReceiver receiver;
  std::vector<Reception> receptions;
  for (Tick at = 0;;) {
    const auto start = next_start(line, ear, at, wire.end());
    if (!start) break;
    const Reading reading = read_character(line, ear, *start);
    at = reading.resume;
    if (!reading.character) continue;
    if (auto reception = receiver.take(*reading.character)) receptions.push_back(*reception);
  }
  if (auto reception = receiver.give_up()) receptions.push_back(*reception);
  return receptions;
}

std::vector<Bytes> accepted(const std::vector<Reception>& receptions) {
  std::vector<Bytes> found;
  for (const Reception& reception : receptions)
    if (reception.telegram) found.emplace_back(reception.bytes.span().begin(), reception.bytes.span().end());
  return found;
}

std::vector<bool> wire_of(const Bytes& bytes) { return wire_bits(bytes); }

// At one bit a tick (57.6 kbaud) 199 bits are the start pause of 3.44 ms.
void append_after_pause(std::vector<bool>& bits, const Bytes& bytes) {
  bits.insert(bits.end(), 260, true);
  const std::vector<bool> more = wire_of(bytes);
  bits.insert(bits.end(), more.begin(), more.end());
}

struct Count {
  std::map<std::string, uint64_t> rows;
  ~Count() {
    for (const auto& [what, count] : rows)
      std::printf("  %-72s %10llu\n", what.c_str(), static_cast<unsigned long long>(count));
  }
};

TEST(Sweep, UndisturbedTelegramsAreAccepted) {
  Count count;
  for (const uint32_t ticks : {1U, 6U})
    for (const Bytes& bytes : telegrams(20)) {
      ASSERT_EQ(accepted(receive(wire_of(bytes), ticks)), std::vector<Bytes>{bytes});
      ++count.rows["telegrams accepted"];
    }
}

TEST(Sweep, EverySingleBit) {
  PROVES("RS485-18", "MDB-RS485-27");
  Count count;
  for (const uint32_t ticks : {1U, 6U})
    for (const Bytes& bytes : telegrams(8)) {
      const std::vector<bool> good = wire_of(bytes);
      for (size_t n = 0; n < good.size(); ++n) {
        std::vector<bool> bits = good;
        bits[n] = !bits[n];
        const auto receptions = receive(bits, ticks);
        ASSERT_TRUE(accepted(receptions).empty()) << "bit " << n;
        ASSERT_FALSE(receptions.empty());
        const char* kind = n % 11 == 0 ? "start" : n % 11 == 9 ? "parity" : n % 11 == 10 ? "stop" : "data";
        ++count.rows[std::string(kind) +
                     " bit flipped: " + std::string(serial_error_text(receptions[0].telegram.error()))];
        // A data or parity bit is always a parity error, unless the type or start character says it first.
        if (n % 11 >= 1 && n % 11 <= 9) {
          ASSERT_EQ(receptions[0].telegram.error(), SerialError::Parity);
        }
        if (n % 11 == 10) {
          ASSERT_EQ(receptions[0].telegram.error(), SerialError::Frame);
        }
        // The next telegram is received again.
        if (ticks == 1) {
          append_after_pause(bits, bytes);
          ASSERT_EQ(accepted(receive(bits)), std::vector<Bytes>{bytes}) << "bit " << n;
        }
      }
    }
}

TEST(Sweep, EveryPairOfBits) {
  Count count;
  for (const Bytes& bytes : telegrams(0)) {
    const std::vector<bool> good = wire_of(bytes);
    for (size_t a = 0; a < good.size(); ++a)
      for (size_t b = a + 1; b < good.size(); ++b) {
        std::vector<bool> bits = good;
        bits[a] = !bits[a];
        bits[b] = !bits[b];
        const auto found = accepted(receive(std::move(bits)));
        ++count.rows["two bits flipped"];
        if (found.empty()) continue;
        if (found[0] == bytes) {
          ASSERT_EQ(a / 11, bytes.size() - 1) << "the BCC shifted by a bit reads the same";
          ++count.rows["two bits flipped: the telegram itself accepted"];
          continue;
        }
        // Parity holds when both are in one character; BCC can only hold when that changes the length.
        ASSERT_TRUE(a / 11 == 2 && b / 11 == 2 && found.size() == 1) << a << ' ' << b;
        ASSERT_LT(found[0].size(), bytes.size());
        ASSERT_EQ(telegram_in(found[0]), found[0]);
        ++count.rows["two bits flipped: wrong accept, both in TYP: a shorter type with a fitting rest"];
      }
  }
}

TEST(Sweep, EveryCut) {
  Count count;
  for (const Bytes& bytes : telegrams(100)) {
    const std::vector<bool> good = wire_of(bytes);
    // Cut off behind each bit: rest lost, then silence, then a good telegram.
    for (size_t n = 0; n < good.size(); ++n) {
      std::vector<bool> bits(good.begin(), good.begin() + static_cast<long>(n));
      const auto found = accepted(receive(bits));
      // Ones at the end are not told from silence.
      const bool complete = std::find(good.begin() + static_cast<long>(n), good.end(), false) == good.end();
      ASSERT_EQ(found.size(), complete ? 1U : 0U) << n;
      append_after_pause(bits, bytes);
      const auto both = accepted(receive(bits));
      ASSERT_EQ(both.back(), bytes);
      ASSERT_EQ(both.size(), complete ? 2U : 1U);
      ++count.rows["cut off behind a bit"];
    }
    // Each character missing.
    for (size_t n = 0; n < bytes.size(); ++n) {
      Bytes cut = bytes;
      cut.erase(cut.begin() + static_cast<long>(n));
      const auto found = accepted(receive(wire_of(cut)));
      const auto expected = telegram_in(cut);
      ASSERT_EQ(found.size(), expected ? 1U : 0U);
      ++count.rows["one character missing"];
      if (!expected) continue;
      ASSERT_EQ(found[0], *expected);
      ASSERT_LT(expected->size(), bytes.size());
      ++count.rows[n <= 2 ? "one character missing: wrong accept, ADR or TYP slipped to a shorter type"
                          : "one character missing: wrong accept, other"];
    }
  }
  EXPECT_EQ(count.rows["one character missing: wrong accept, other"], 0U);
}

TEST(Sweep, EveryExtraCharacter) {
  Count count;
  for (const Bytes& bytes : telegrams(8))
    for (size_t n = 0; n <= bytes.size(); ++n)
      for (int value = 0; value < 256; ++value) {
        Bytes longer = bytes;
        longer.insert(longer.begin() + static_cast<long>(n), static_cast<uint8_t>(value));
        const auto found = accepted(receive(wire_of(longer)));
        const auto expected = telegram_in(longer);
        ASSERT_EQ(found.size(), expected ? 1U : 0U) << n << ' ' << value;
        ++count.rows["one character added"];
        if (!expected) continue;
        ASSERT_EQ(found[0], *expected);
        if (found[0] == bytes) {
          ++count.rows
                ["one character added: the telegram itself accepted (added behind it, or equal neighbours)"];
        } else if (value == bytes.back() && found[0].size() == bytes.size()) {
          ++count.rows["one character added: wrong accept, the added one equals the BCC and stands for it"];
        } else {
          ASSERT_LE(n, 2U) << "only in front of TYP";
          ++count.rows["one character added: wrong accept, ADR or TYP slipped to another type"];
        }
      }
}

// What an exclusive-or with parity cannot see, shown to be so.
TEST(Sweep, BlindSpots) {
  Count count;
  for (const Bytes& bytes : telegrams(0)) {
    const std::vector<bool> good = wire_of(bytes);
    const auto check = [&](std::vector<bool> bits, const Bytes& content, const std::string& name) {
      const auto expected = telegram_in(content);
      const auto found = accepted(receive(std::move(bits)));
      ASSERT_EQ(found.size(), expected ? 1U : 0U) << name;
      ++count.rows[name];
      if (expected && *expected != bytes) ++count.rows[name + ": wrong accepts"];
    };
    // Two columns in two characters, parity column included: even in every character and in every column.
    for (size_t i = 0; i < bytes.size(); ++i)
      for (size_t k = i + 1; k < bytes.size(); ++k)
        for (size_t a = 1; a <= 9; ++a)
          for (size_t b = a + 1; b <= 9; ++b) {
            std::vector<bool> bits = good;
            Bytes content = bytes;
            for (const size_t character : {i, k})
              for (const size_t column : {a, b}) {
                bits[11 * character + column] = !bits[11 * character + column];
                if (column <= 8)
                  content[character] = static_cast<uint8_t>(content[character] ^ 1U << (column - 1));
              }
            check(std::move(bits), content, "two columns flipped in two characters");
          }
    for (size_t i = 0; i < bytes.size(); ++i)
      for (size_t k = i + 1; k < bytes.size(); ++k) {
        Bytes swapped = bytes;
        std::swap(swapped[i], swapped[k]);
        check(wire_of(swapped), swapped, "two characters exchanged");
      }
  }
  EXPECT_GT(count.rows["two columns flipped in two characters: wrong accepts"], 0U);
  EXPECT_GT(count.rows["two characters exchanged: wrong accepts"], 0U);
}

TEST(Sweep, MillionRoundTrips) {
  std::mt19937 random(485);
  Count count;
  for (int n = 0; n < 1'000'000; ++n) {
    SerialTelegram t;
    t.response = random() % 2 == 0;
    t.address = static_cast<uint8_t>(random());
    const int type = static_cast<int>(random() % 7 + (random() % 2) * 128);
    t.format = *telegram_format(type);
    if (t.format.parameter)
      t.parameter = {static_cast<uint8_t>(random()), static_cast<uint8_t>(random()),
                     static_cast<uint16_t>(random()), static_cast<uint32_t>(random())};
    for (size_t word = 0; word < t.format.words; ++word) t.words[word] = static_cast<uint16_t>(random());
    const SerialBytes bytes = encode(t);
    ASSERT_EQ(bytes.size, kPduLength.at(type) + 4);
    ASSERT_TRUE(telegram_in({bytes.span().begin(), bytes.span().end()}).has_value());
    const auto decoded = decode_serial(bytes.span());
    ASSERT_TRUE(decoded && *decoded == t);
    ++count.rows["telegrams encoded and decoded"];
  }
}

// Anything on the wire: never more than the oracle accepts, and nothing hangs or overruns.
TEST(Sweep, RandomLevels) {
  std::mt19937 random(11);
  Count count;
  for (int run = 0; run < 20'000; ++run) {
    std::vector<bool> bits(random() % 600);
    const auto ones = random() % 31 + 1;
    for (size_t n = 0; n < bits.size(); ++n) bits[n] = random() % 32 < ones;
    for (const Bytes& found : accepted(receive(bits))) {
      ASSERT_TRUE(telegram_in(found).has_value());
      ++count.rows["random levels: telegrams by chance"];
    }
    ++count.rows["random levels"];
  }
}

}  // namespace
}  // namespace ipos::tests

// Damage that no power cut makes: flipped bits, noise, cut files. Nothing crashes, and no content is taken
// for whole that was not stored.
#include <gtest/gtest.h>

#include <cstdio>
#include <random>

#include "runtime/nv_memory/medium/slot_store.hpp"
#include "tests/runtime/nv_memory/fake_medium.hpp"

namespace ipos::runtime {
namespace {

using tests::FakeMedium;
using tests::FoundMedium;
using tests::MediumBytes;
using tests::MediumState;

constexpr uint8_t kUnit = 1;

NvContent content_of(std::mt19937& random, size_t values) {
  NvContent content;
  uint16_t index = 8000;
  for (size_t n = 0; n < values; ++n) {
    index = static_cast<uint16_t>(index + 1 + random() % 5);
    content.values.emplace_back(index, static_cast<int32_t>(random()));
    if (random() % 3 == 0) content.writes.emplace_back(index, random());
  }
  if (random() % 2 == 0) {
    content.program = NvProgram{static_cast<uint32_t>(random()), {}};
    for (size_t n = random() % 20; n > 0; --n)
      content.program->words.push_back(static_cast<uint32_t>(random()));
  }
  return content;
}

class Corruption : public ::testing::Test {
 protected:
  Corruption() {
    FakeMedium medium(state_);
    SlotStore store(medium, kUnit);
    store.load();
    contents_[0] = contents_[1] = content_of(random_, 40);
    for (auto& value : contents_[1].values) value.second ^= 0x5A5A;  // slots of one size
    for (const NvContent& content : contents_) EXPECT_EQ(store.save(content), std::nullopt);
    size_ = state_->bytes.size() - kSlotStride;
  }

  // Newest or older content, or none: anything else is a wrong content taken for a right one.
  void check(std::span<const uint8_t> bytes) {
    FoundMedium medium(bytes);
    const NvLoad loaded = SlotStore(medium, kUnit).load();
    if (loaded.outcome == NvOutcome::Loaded)
      ++(loaded.content == contents_[0] || loaded.content == contents_[1] ? right_ : wrong_);
    else
      ++none_;
    ASSERT_EQ(wrong_, 0);
    ASSERT_NE(loaded.outcome, NvOutcome::Failed);
    ASSERT_TRUE(loaded.outcome != NvOutcome::Damaged || !loaded.text.empty());
  }

  uint8_t& byte(MediumBytes& bytes, size_t n) {  // of both slots
    return bytes[n < size_ ? n : kSlotStride + n - size_];
  }

  void report(const char* what) {
    std::printf("%s: %ld files, %ld with a stored content, %ld refused, %ld wrong\n", what,
                right_ + none_ + wrong_, right_, none_, wrong_);
  }

  std::mt19937 random_{8470};
  std::shared_ptr<MediumState> state_ = std::make_shared<MediumState>();
  NvContent contents_[2];
  size_t size_ = 0;  // of a slot's bytes
  long right_ = 0;
  long none_ = 0;
  long wrong_ = 0;
};

TEST_F(Corruption, EveryBitOfBothSlots) {
  MediumBytes bytes = state_->bytes;
  for (size_t n = 0; n < 2 * size_; ++n)
    for (int bit = 0; bit < 8; ++bit) {
      byte(bytes, n) ^= static_cast<uint8_t>(1 << bit);
      check(bytes);
      byte(bytes, n) ^= static_cast<uint8_t>(1 << bit);
    }
  EXPECT_EQ(none_, 0) << "one slot is always whole";
  report("single bits");
}

TEST_F(Corruption, EveryBitOfASlotThatIsAlone) {
  MediumBytes bytes(state_->bytes.begin(), state_->bytes.begin() + static_cast<std::ptrdiff_t>(size_));
  for (size_t n = 0; n < size_; ++n)
    for (int bit = 0; bit < 8; ++bit) {
      bytes[n] ^= static_cast<uint8_t>(1 << bit);
      check(bytes);
      bytes[n] ^= static_cast<uint8_t>(1 << bit);
    }
  EXPECT_EQ(right_, 0);
  report("single bits of one slot");
}

TEST_F(Corruption, EveryLength) {
  for (size_t n = 0; n <= 2 * size_; ++n)
    check(std::span(state_->bytes).first(n <= size_ ? n : kSlotStride + n - size_));
  report("lengths");
}

TEST_F(Corruption, Noise) {
  for (int round = 0; round < 100'000; ++round) {
    MediumBytes bytes(state_->bytes.begin(), state_->bytes.end());
    // The one slot is lost, so that every round tests the checksum of the other.
    const size_t lost = random_() % 2;
    bytes[lost * kSlotStride + 3] ^= 0xFF;
    for (size_t n = 1 + random_() % 40; n > 0; --n) {
      const size_t first = (1 - lost) * size_;
      byte(bytes, first + random_() % size_) = static_cast<uint8_t>(random_());
    }
    check(bytes);
  }
  report("noise");
}

// Any payload with a right checksum: it is no content, or one with exactly this coding.
TEST_F(Corruption, PayloadsWithARightChecksum) {
  long contents = 0;
  for (int round = 0; round < 200'000; ++round) {
    std::vector<uint8_t> bytes = encode(content_of(random_, random_() % 6));
    for (size_t n = random_() % 4; n > 0; --n)
      bytes[random_() % bytes.size()] = static_cast<uint8_t>(random_() % 3 == 0 ? random_() : random_() % 4);
    if (random_() % 4 == 0) bytes.resize(random_() % (bytes.size() + 8));
    const auto content = decode_content(bytes);
    if (!content) continue;
    ++contents;
    ASSERT_EQ(encode(*content), bytes);
  }
  EXPECT_GT(contents, 10'000);
}

}  // namespace
}  // namespace ipos::runtime

// The two slots: what is stored comes back, what is damaged is told, and the memory of others is left alone.
#include "runtime/nv_memory/medium/slot_store.hpp"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/runtime/nv_memory/fake_medium.hpp"

namespace ipos::runtime {
namespace {

using tests::FakeMedium;
using tests::MediumState;

constexpr uint8_t kUnit = 1;

NvContent numbered(int32_t n) {
  NvContent content;
  for (int32_t i = 0; i < 20; ++i) content.values.emplace_back(8300 + 7 * i, n * 1000 + i);
  content.writes.emplace_back(8470, n);
  return content;
}

class Slots : public ::testing::Test {
 protected:
  NvLoad load(uint8_t unit = kUnit) { return SlotStore(medium_, unit).load(); }
  std::shared_ptr<MediumState> state_ = std::make_shared<MediumState>();
  FakeMedium medium_{state_};
};

TEST_F(Slots, AnEmptyMediumIsFresh) {
  EXPECT_EQ(load().outcome, NvOutcome::Fresh);
  const std::vector<tests::MediumBytes> files = {
      {0}, {0, 0, 0, 0}, {'I', 'P'}, {'I', 'P', 'N', 'V'}, {'I', 'P', 'N', 'V', 0, 0, 0, 0, 0, 0}};
  for (const tests::MediumBytes& begun : files) {
    state_->bytes = begun;
    EXPECT_EQ(load().outcome, NvOutcome::Fresh) << "the power was cut in the first write";
  }
}

TEST_F(Slots, AFileOfSomebodyElseIsRefused) {
  const std::vector<tests::MediumBytes> files = {
      tests::MediumBytes(100, 0), tests::MediumBytes(3 * kSlotStride, 0), {'m', 'a', 'i', 'n'}, {'I', 'x'}};
  for (const tests::MediumBytes& other : files) {
    state_->bytes = other;
    const NvLoad loaded = load();
    EXPECT_EQ(loaded.outcome, NvOutcome::Refused);
    EXPECT_EQ(loaded.text, "this is no memory of a unit, and is left as it is");
  }
}

TEST_F(Slots, WhatIsStoredComesBack) {
  SlotStore store(medium_, kUnit);
  ASSERT_EQ(store.load().outcome, NvOutcome::Fresh);
  for (int32_t n = 1; n <= 5; ++n) {
    ASSERT_EQ(store.save(numbered(n)), std::nullopt);
    const NvLoad loaded = load();
    ASSERT_EQ(loaded.outcome, NvOutcome::Loaded);
    EXPECT_EQ(loaded.content, numbered(n));
    EXPECT_EQ(loaded.text, "");
  }
}

TEST_F(Slots, AStoreThatIsOpenedAgainGoesOn) {
  for (int32_t n = 1; n <= 5; ++n) {
    SlotStore store(medium_, kUnit);
    store.load();
    ASSERT_EQ(store.save(numbered(n)), std::nullopt);
    EXPECT_EQ(load().content, numbered(n));
  }
}

TEST_F(Slots, WritesAreSynchronisedOneByOne) {
  SlotStore store(medium_, kUnit);
  store.load();
  store.save(numbered(1));
  ASSERT_EQ(state_->writes.size(), 3U);
  EXPECT_EQ(state_->writes[0].bytes.size(), 4U) << "a new file is told from others";
  EXPECT_EQ(state_->writes[1].offset, kSlotHeaderSize) << "payload first";
  EXPECT_EQ(state_->writes[2].offset, 0U);
  EXPECT_EQ(state_->syncs, 3);
  store.save(numbered(2));
  ASSERT_EQ(state_->writes.size(), 5U);
  EXPECT_EQ(state_->writes[4].offset, kSlotStride) << "the other slot";
}

TEST_F(Slots, TheProgramIsKeptToo) {
  NvContent content = numbered(1);
  content.program = NvProgram{0x12345678, {1, 2, 0xFFFFFFFF}};
  SlotStore store(medium_, kUnit);
  store.load();
  store.save(content);
  EXPECT_EQ(load().content, content);
}

// Bytes made by Python's struct and zlib from the table of docs/inside/nv-memory.md.
TEST_F(Slots, LayoutIsThatOfThePage) {
  const std::vector<uint8_t> bytes = {
      0x49, 0x50, 0x4E, 0x56, 0x01, 0x00, 0x01, 0x00, 0x01, 0x00, 0x00, 0x00, 0x2B, 0x00, 0x00, 0x00,
      0x02, 0x00, 0x00, 0x00, 0x16, 0x21, 0xC4, 0x09, 0x00, 0x00, 0x20, 0x4E, 0xFD, 0xFF, 0xFF, 0xFF,
      0x01, 0x00, 0x00, 0x00, 0x16, 0x21, 0x2C, 0x01, 0x00, 0x00, 0x01, 0x78, 0x56, 0x34, 0x12, 0x02,
      0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xC8, 0xD4, 0x60, 0x82};
  NvContent content;
  content.values = {{8470, 2500}, {20000, -3}};
  content.writes = {{8470, 300}};
  content.program = NvProgram{0x12345678, {2, 0xFFFFFFFF}};
  SlotStore store(medium_, kUnit);
  store.load();
  ASSERT_EQ(store.save(content), std::nullopt);
  EXPECT_EQ(state_->bytes, bytes);
  state_->bytes = bytes;
  EXPECT_EQ(load().content, content);
}

TEST_F(Slots, OneDamagedSlotLeavesTheOther) {
  SlotStore store(medium_, kUnit);
  store.load();
  store.save(numbered(1));
  store.save(numbered(2));
  state_->bytes[kSlotStride + 30] ^= 1;
  const NvLoad loaded = load();
  EXPECT_EQ(loaded.outcome, NvOutcome::Loaded);
  EXPECT_EQ(loaded.content, numbered(1));
  EXPECT_EQ(loaded.text, "slot 1 at byte 131072: wrong checksum; the other slot is used");
}

TEST_F(Slots, TwoDamagedSlotsAreTold) {
  SlotStore store(medium_, kUnit);
  store.load();
  store.save(numbered(1));
  store.save(numbered(2));
  state_->bytes[30] ^= 1;
  state_->bytes[kSlotStride + 8] ^= 1;
  NvLoad loaded = load();
  EXPECT_EQ(loaded.outcome, NvOutcome::Damaged);
  EXPECT_EQ(loaded.content, NvContent{});
  EXPECT_EQ(loaded.text,
            "no state in it is whole: slot 0 at byte 0: wrong checksum; slot 1 at byte 131072: wrong "
            "checksum");
  // The unit goes on with factory values, which are stored again.
  SlotStore again(medium_, kUnit);
  again.load();
  ASSERT_EQ(again.save(numbered(3)), std::nullopt);
  EXPECT_EQ(load().content, numbered(3));
}

TEST_F(Slots, ForeignMemoryIsRefused) {
  SlotStore store(medium_, 3);
  store.load();
  store.save(numbered(1));
  EXPECT_EQ(load(3).outcome, NvOutcome::Loaded);
  const NvLoad loaded = load(4);
  EXPECT_EQ(loaded.outcome, NvOutcome::Refused);
  EXPECT_EQ(loaded.text, "the memory of unit type 3");
  EXPECT_EQ(loaded.content, NvContent{});
}

TEST_F(Slots, SequenceNumbersWrap) {
  SlotStore store(medium_, kUnit);
  store.load();
  store.save(numbered(1));
  // The same slot with the highest sequence number, made by the rules of the page.
  std::vector<uint8_t> slot(state_->bytes.begin(), state_->bytes.end());
  tests::put_bytes(slot, 8, std::vector<uint8_t>{0xFF, 0xFF, 0xFF, 0xFF});
  uint32_t crc = 0xFFFFFFFF;
  for (size_t i = 0; i + 4 < slot.size(); ++i) {
    crc ^= slot[i];
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320U : 0);
  }
  crc = ~crc;
  for (size_t i = 0; i < 4; ++i) slot[slot.size() - 4 + i] = static_cast<uint8_t>(crc >> (8 * i));
  state_->bytes = slot;
  SlotStore wrapped(medium_, kUnit);
  ASSERT_EQ(wrapped.load().content, numbered(1));
  ASSERT_EQ(wrapped.save(numbered(2)), std::nullopt);
  EXPECT_EQ(load().content, numbered(2)) << "0 is newer than 4294967295";
  ASSERT_EQ(wrapped.save(numbered(3)), std::nullopt);
  EXPECT_EQ(load().content, numbered(3));
}

// Full disk at every byte and failing synchronisation: the failure is told, the state of before is there, and
// storing works again afterwards.
TEST_F(Slots, FailuresLeaveTheOldState) {
  SlotStore store(medium_, kUnit);
  store.load();
  store.save(numbered(1));
  store.save(numbered(2));
  const size_t size = state_->writes[2].bytes.size() + state_->writes[3].bytes.size();
  for (size_t room = 0; room < size; ++room) {
    state_->room = static_cast<int64_t>(room);
    EXPECT_EQ(store.save(numbered(3)), "no space left");
    // The last bytes of the header may be those of the one before: then the new state is whole already.
    const NvContent found = load().content;
    EXPECT_TRUE(found == numbered(2) || (found == numbered(3) && room + 8 > size)) << room;
  }
  state_->room = -1;
  state_->sync_fails = true;
  EXPECT_EQ(store.save(numbered(4)), "input/output error");
  const NvContent found = load().content;  // the header of the last attempt was whole
  EXPECT_TRUE(found == numbered(2) || found == numbered(4));
  state_->sync_fails = false;
  EXPECT_EQ(store.save(numbered(3)), std::nullopt);
  EXPECT_EQ(load().content, numbered(3));
  state_->read_fails = true;
  EXPECT_EQ(load().outcome, NvOutcome::Failed);
  EXPECT_EQ(load().text, "cannot be read: read error");
}

// A payload as long as a slot has room for comes back; the header may not promise a byte more, which would be the
// next slot's.
TEST_F(Slots, TheLongestPayload) {
  constexpr size_t kRoom = kSlotStride - 16 - 4;  // header and checksum
  NvContent content;
  content.program = NvProgram{7, std::vector<uint32_t>(1)};
  const size_t bare = encode(content).size();
  content.program->words.resize(1 + (kRoom - bare) / 4, 0x12345678);
  ASSERT_LE(encode(content).size(), kRoom);
  ASSERT_GT(encode(content).size() + 4, kRoom);
  SlotStore store(medium_, kUnit);
  store.load();
  ASSERT_EQ(store.save(content), std::nullopt);
  EXPECT_EQ(load().content, content);
  const auto says = [&](size_t length) {
    for (size_t n = 0; n < 4; ++n) state_->bytes[12 + n] = static_cast<uint8_t>(length >> (8 * n));
    return load().text;
  };
  EXPECT_NE(says(kRoom + 1).find("wrong length in its header"), std::string::npos) << says(kRoom + 1);
  EXPECT_EQ(says(kRoom).find("wrong length in its header"), std::string::npos);
}

// Words of a program are 4 bytes and values are 6: contents of all odd lengths. One byte more than the slot has room
// for is too much, one byte less is not.
TEST_F(Slots, TooMuchIsRefused) {
  constexpr size_t kRoom = kSlotStride - 16 - 4;
  for (const size_t length : {kRoom - 1, kRoom + 1, kRoom + 3, kSlotStride + 17}) {
    NvContent content;
    content.program = NvProgram{0, {}};
    if ((length - encode(content).size()) % 4 != 0) content.values.emplace_back(1, 2);
    content.program->words.resize((length - encode(content).size()) / 4);
    ASSERT_EQ(encode(content).size(), length);
    state_->writes.clear();
    SlotStore store(medium_, kUnit);
    store.load();
    if (length < kRoom) {
      EXPECT_EQ(store.save(content), std::nullopt);
      EXPECT_EQ(load().content, content);
    } else {
      EXPECT_EQ(store.save(content), "the content is longer than a slot");
      EXPECT_TRUE(state_->writes.empty());
    }
  }
}

// A payload says how much there is of everything: one less or more than there is makes it none.
TEST(Payload, CountsAreThoseOfTheContent) {
  NvContent content;
  content.values = {{1, 2}, {3, 4}};
  content.writes = {{5, 6}};
  content.program = NvProgram{7, {8, 9}};
  const std::vector<uint8_t> bytes = encode(content);
  ASSERT_EQ(bytes.size(), 4U + 2 * 6 + 4 + 6 + 1 + 4 + 4 + 2 * 4);
  ASSERT_EQ(decode_content(bytes), content);
  const size_t counts[] = {0, 16, 31};
  for (const size_t at : counts)
    for (const std::vector<uint8_t>& count :
         std::initializer_list<std::vector<uint8_t>>{{static_cast<uint8_t>(bytes[at] + 1), 0, 0, 0},
                                                     {static_cast<uint8_t>(bytes[at] - 1), 0, 0, 0},
                                                     {bytes[at], 0, 0, 1},
                                                     {0xFF, 0xFF, 0xFF, 0xFF}}) {
      std::vector<uint8_t> other = bytes;
      std::copy(count.begin(), count.end(), other.begin() + static_cast<ptrdiff_t>(at));
      EXPECT_EQ(decode_content(other), std::nullopt) << at << ": " << int{count[0]};
    }
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_EQ(decode_content(std::span(bytes).first(size)), std::nullopt) << size;
  std::vector<uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(decode_content(longer), std::nullopt);
  for (const uint8_t kind : std::initializer_list<uint8_t>{0, 2, 255}) {
    std::vector<uint8_t> other = bytes;
    other[26] = kind;
    EXPECT_EQ(decode_content(other), std::nullopt) << "0 or 1, and behind 0 nothing";
    other.resize(27);
    EXPECT_EQ(decode_content(other).has_value(), kind == 0) << "0 or 1, also with nothing behind it";
  }
}

TEST(Payload, CountsWithoutValues) {
  NvContent content;
  EXPECT_EQ(encode(content), std::vector<uint8_t>(4 + 4 + 1)) << "nothing at all";
  EXPECT_EQ(decode_content(encode(content)), content);
  for (uint16_t n = 0; n < 100; ++n) content.writes.emplace_back(n, n + 1);
  EXPECT_EQ(decode_content(encode(content)), content);
}

TEST(Payload, IndicesRise) {
  NvContent content;
  for (const auto& [first, second, right] : std::initializer_list<std::tuple<uint16_t, uint16_t, bool>>{
           {0, 1, true}, {1, 1, false}, {2, 1, false}, {0xFFFE, 0xFFFF, true}, {0, 0, false}}) {
    content.values = {{first, -1}, {second, -2}};
    content.writes = {};
    EXPECT_EQ(decode_content(encode(content)).has_value(), right);
    content.values = {};
    content.writes = {{first, 1}, {second, 2}};
    EXPECT_EQ(decode_content(encode(content)).has_value(), right);
  }
}

}  // namespace
}  // namespace ipos::runtime

// What was done to a plant, as bytes and back: nothing that cannot have been saved is taken.
#include <gtest/gtest.h>

#include "runtime/library/action.hpp"
#include "runtime/library/instance.hpp"
#include "vm/image/view.hpp"

namespace ipos::library {
namespace {

Action some_deed(runtime::Time at, uint32_t n) {
  Action action;
  action.at = at;
  action.act = Act::Force;
  action.signal = {0x01020304 + n, Kind::Word, 0x11121314 + n};
  action.number = 0x21222324 + n;
  action.value = -5 - static_cast<int64_t>(n);
  action.bytes = {1, 2, static_cast<uint8_t>(n)};
  return action;
}

void with_new_checksum(std::vector<uint8_t>& bytes) {
  const uint32_t sum = vm::crc32(std::span(bytes).first(bytes.size() - 4));
  for (size_t n = 0; n < 4; ++n) bytes[bytes.size() - 4 + n] = static_cast<uint8_t>(sum >> (8 * n));
}

TEST(LibraryDeeds, ComeBackAsTheyWere) {
  const std::vector<Action> actions = {some_deed(0, 0), some_deed(0, 1), some_deed(7, 2), some_deed(1'000, 3)};
  const auto bytes = to_bytes(0x0102030405060708, 1'000, 0xF1F2F3F4F5F6F7F8, actions);
  EXPECT_EQ(bytes.size(), 8U + 4U * 8U + 4U * (8U + 2U + 12U + 8U + 4U + 3U) + 4U);
  EXPECT_EQ(bytes[8], 8) << "the lowest byte first";
  EXPECT_EQ(bytes[15], 1);
  const auto saved = from_bytes(bytes);
  ASSERT_TRUE(saved);
  EXPECT_EQ(std::tuple(saved->identity, saved->time, saved->digest),
            std::tuple(0x0102030405060708U, 1'000, 0xF1F2F3F4F5F6F7F8U));
  ASSERT_EQ(saved->actions.size(), actions.size());
  for (size_t n = 0; n < actions.size(); ++n) {
    const Action& action = saved->actions[n];
    EXPECT_EQ(std::tuple(action.at, action.act, action.number, action.value, action.bytes),
              std::tuple(actions[n].at, actions[n].act, actions[n].number, actions[n].value, actions[n].bytes));
    EXPECT_EQ(action.signal, actions[n].signal);
  }
  EXPECT_TRUE(from_bytes(to_bytes(0, 0, 0, {})));
}

TEST(LibraryDeeds, ADamagedStateIsRefused) {
  const std::vector<Action> actions = {some_deed(0, 0)};
  const auto bytes = to_bytes(1, 2, 3, actions);
  for (size_t n = 0; n < bytes.size(); ++n) {
    auto wrong = bytes;
    wrong[n] ^= 0x10;
    const auto refused = from_bytes(wrong);
    ASSERT_FALSE(refused) << n;
    EXPECT_EQ(refused.error(), n < 8 ? "these bytes are no saved state of this version"
                                     : "the saved state is damaged: its checksum is wrong");
    EXPECT_FALSE(from_bytes(std::span(bytes).first(n))) << n;
  }
}

TEST(LibraryDeeds, WhatCannotHaveBeenDoneIsRefused) {
  const auto refused = [](runtime::Time time, std::vector<Action> actions) {
    const auto saved = from_bytes(to_bytes(1, time, 3, actions));
    return saved ? "" : saved.error();
  };
  const std::string senseless = "the saved state is damaged: what was done makes no sense";
  const std::string length = "the saved state is damaged: its length is wrong";
  EXPECT_EQ(refused(5, {some_deed(5, 0)}), "");
  EXPECT_EQ(refused(5, {some_deed(6, 0)}), senseless) << "behind the end";
  EXPECT_EQ(refused(5, {some_deed(-1, 0)}), senseless);
  EXPECT_EQ(refused(5, {some_deed(4, 0), some_deed(3, 0)}), senseless);
  Action last = some_deed(0, 0);
  last.act = kLastAct;
  EXPECT_EQ(refused(5, {last}), "");
  last.act = static_cast<Act>(static_cast<int>(kLastAct) + 1);
  EXPECT_EQ(refused(5, {last}), senseless);
  Action kind = some_deed(0, 0);
  kind.signal.kind = Kind::Signal;
  EXPECT_EQ(refused(5, {kind}), senseless) << "a signal can only be read";
  EXPECT_EQ(refused(-1, {}), length);
  EXPECT_EQ(refused(runtime::kNever, {}), length);
  EXPECT_EQ(refused(runtime::kNever - 1, {}), "");
  // A count that is one too high or too low, and bytes behind the end.
  for (const uint8_t count : {uint8_t{0}, uint8_t{2}}) {
    auto bytes = to_bytes(1, 5, 3, std::vector<Action>{some_deed(0, 0)});
    bytes[8 + 24] = count;
    with_new_checksum(bytes);
    EXPECT_FALSE(from_bytes(bytes)) << int{count};
  }
  auto longer = to_bytes(1, 5, 3, {});
  longer.push_back(0);
  with_new_checksum(longer);
  EXPECT_EQ(from_bytes(longer).error(), length);
}

TEST(LibraryDeeds, FramesComeBackAsTheyWere) {
  runtime::Frame frame;
  frame.id = 0x1ABCDEF0;
  frame.extended = true;
  frame.length = 3;
  frame.data = {1, 2, 3};
  for (const bool remote : {false, true}) {
    frame.remote = remote;
    const auto bytes = frame_bytes(frame);
    EXPECT_EQ(bytes.size(), 14U);
    const auto back = frame_of(bytes);
    ASSERT_TRUE(back);
    EXPECT_EQ(std::tuple(back->id, back->extended, back->remote, back->length),
              std::tuple(0x1ABCDEF0U, true, remote, 3));
    if (!remote) {
      EXPECT_EQ(back->data, frame.data);
    }
    for (const size_t size : {size_t{0}, size_t{13}, size_t{15}}) {
      auto wrong = bytes;
      wrong.resize(size);
      EXPECT_FALSE(frame_of(wrong)) << size;
    }
  }
  runtime::Frame standard;
  standard.id = 0x7FF;
  EXPECT_FALSE(frame_of(frame_bytes(standard))->extended);
  standard.id = 0x800;
  EXPECT_FALSE(frame_of(frame_bytes(standard)));
  standard = {};
  standard.length = 9;
  EXPECT_FALSE(frame_of(frame_bytes(standard)));
}

}  // namespace
}  // namespace ipos::library

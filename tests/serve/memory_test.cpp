// The memories of scope and trace by themselves: what is kept, what is forgotten, and how copies of a process share them.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/serve/posix/forked_copies.hpp"
#include "tools/serve/host/scope_memory.hpp"
#include "tools/serve/host/trace_memory.hpp"

namespace ipos::tests {
namespace {

using tools::serve::ScopeMemory;
using tools::serve::Telegram;
using tools::serve::TraceMemory;
using Extremes = ScopeMemory::Extremes;

tools::serve::ForkedCopies copies(false);

int64_t value(uint64_t number) { return static_cast<int64_t>(number * 7919 % 1'000'003); }

// What `extremes` must be, looked for one by one.
Extremes looked_for(uint64_t begin, uint64_t end) {
  Extremes found{value(begin), value(begin)};
  for (uint64_t n = begin; n < end; ++n) found = {std::min(found.first, value(n)), std::max(found.second, value(n))};
  return found;
}

void record(ScopeMemory& memory, uint64_t from, uint64_t end) {
  for (uint64_t n = from; n < end; ++n) {
    const int64_t sample = value(n);
    memory.push(n, {&sample, 1});
  }
}

// Runs in another copy of the process, which sees what it writes in the shared memory only.
template <typename Body>
void in_a_copy(const Body& body) {
  const pid_t copy = fork();
  if (copy == 0) {
    body();
    _exit(0);
  }
  int status = 0;
  waitpid(copy, &status, 0);
  EXPECT_EQ(status, 0);
}

TEST(ScopeMemory, KeepsTheLastMillionAndForgetsTheRest) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt});
  memory.restart(1);
  record(memory, 1, 2'500'000);
  EXPECT_EQ(memory.end(), 2'500'000U);
  EXPECT_GE(memory.end() - memory.first(), ScopeMemory::kKept);
  EXPECT_LE(memory.end() - memory.first(), ScopeMemory::kKept + 64);
  EXPECT_FALSE(memory.at(0, memory.first() - 1));
  EXPECT_FALSE(memory.at(0, memory.end()));
  EXPECT_EQ(memory.at(0, memory.first()), value(memory.first()));
  EXPECT_EQ(memory.at(0, 2'499'999), value(2'499'999));
  for (const auto& [begin, end] : {std::pair{memory.first(), memory.first() + 1000}, {2'000'001UL, 2'000'777UL},
                                   {2'400'000UL, 2'500'000UL}, {2'499'990UL, 2'500'000UL}})
    EXPECT_EQ(memory.extremes(0, begin, end), looked_for(begin, end)) << begin;
  EXPECT_EQ(memory.extremes(0, 0, 2'500'000), looked_for(memory.first(), 2'500'000));
  EXPECT_FALSE(memory.extremes(0, 0, 1000));
}

TEST(ScopeMemory, ExtremesForgetWhatWasOverwritten) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt});
  memory.restart(0);
  const uint64_t turn = ScopeMemory::kKept + 1'000;
  for (uint64_t n = 0; n < 2 * turn; ++n) {
    const int64_t sample = n >= turn ? 0 : n % 2 == 0 ? 1'000'000 : -1'000'000;
    memory.push(n, {&sample, 1});
  }
  EXPECT_EQ(memory.extremes(0, turn + 64, 2 * turn), (Extremes{0, 0}));
}

TEST(ScopeMemory, ExtremesAreThoseOfThisTimeWhereTimeWentBackIntoABlock) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt});
  memory.restart(0);
  record(memory, 0, 100);
  in_a_copy([&] {
    const int64_t spike = 1'000'000'000;
    for (uint64_t n = 100; n < 400; ++n) memory.push(n, {&spike, 1});
  });
  memory.use(memory.columns());  // as load() does
  record(memory, 100, 300);
  for (const uint64_t begin : {0U, 64U, 65U, 99U, 100U, 128U})
    EXPECT_EQ(memory.extremes(0, begin, 300), looked_for(begin, 300)) << begin;
}

TEST(ScopeMemory, WhatACopyHasOverwrittenIsGone) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt});
  memory.restart(0);
  record(memory, 0, 600'000);
  EXPECT_EQ(memory.first(), 0U);
  in_a_copy([&] { record(memory, 600'000, 1'500'000); });
  EXPECT_EQ(memory.end(), 600'000U);
  EXPECT_GE(memory.first(), 499'000U);
  EXPECT_EQ(memory.extremes(0, 0, 600'000), looked_for(memory.first(), 600'000));
}

TEST(ScopeMemory, ChannelsThatStayKeepWhatTheyHave) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt, std::nullopt});
  memory.restart(0);
  for (uint64_t n = 0; n < 200; ++n) memory.push(n, std::vector<int64_t>{value(n), -value(n)});
  memory.choose({std::nullopt, 1});
  EXPECT_FALSE(memory.at(0, 150));
  EXPECT_EQ(memory.at(1, 150), -value(150));
  EXPECT_EQ(memory.first(), 0U);
  for (uint64_t n = 200; n < 290; ++n) memory.push(n, std::vector<int64_t>{value(n), -value(n)});
  EXPECT_EQ(memory.first(0), 200U);
  EXPECT_EQ(memory.extremes(0, 0, 290), looked_for(200, 290));
  // What was before is filled in by a copy; the blocks at the seam count both parts.
  in_a_copy([&] {
    for (uint64_t n = 5; n < 200; ++n) memory.fill(0, 5, n, value(n));
  });
  memory.filled(0, 5);
  EXPECT_EQ(memory.first(0), 5U);
  for (const uint64_t begin : {5U, 64U, 128U, 190U, 192U, 199U})
    EXPECT_EQ(memory.extremes(0, begin, 290), looked_for(begin, 290)) << begin;
  EXPECT_EQ(memory.extremes(1, 0, 290), (Extremes{-looked_for(0, 290).second, -looked_for(0, 290).first}));
}

// Of a word each bit counts by itself: which were on all the time, and which at some.
TEST(ScopeMemory, OfAWordItSaysTheBitsOfAllAndOfAny) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt}, {{.is_word = true}});
  memory.restart(0);
  const auto word = [](uint64_t n) -> int64_t { return 0x0402 | (n == 777 ? 0x8000 : 0) | (n % 5 == 0 ? 4 : 0) | (n == 900 ? 0 : 0x10); };
  for (uint64_t n = 0; n < 2000; ++n) {
    const int64_t sample = word(n);
    memory.push(n, {&sample, 1});
  }
  for (const auto& [begin, end] : {std::pair{0UL, 2000UL}, {770UL, 780UL}, {778UL, 899UL}, {1UL, 3UL}}) {
    Extremes expected{0xFFFF, 0};
    for (uint64_t n = begin; n < end; ++n) expected = {expected.first & word(n), expected.second | word(n)};
    EXPECT_EQ(memory.extremes(0, begin, end), expected) << begin;
  }
}

TEST(ScopeMemory, KeepsNumbersOf32BitsWithAndWithoutSign) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt, std::nullopt}, {{}, {.is_unsigned = true}});
  memory.restart(0);
  memory.push(0, std::vector<int64_t>{INT32_MIN, 0});
  memory.push(1, std::vector<int64_t>{INT32_MAX, UINT32_MAX});
  memory.push(2, std::vector<int64_t>{-1, int64_t{INT32_MAX} + 1});
  EXPECT_EQ(memory.at(0, 0), INT32_MIN);
  EXPECT_EQ(memory.at(0, 2), -1);
  EXPECT_EQ(memory.at(1, 1), int64_t{UINT32_MAX});
  EXPECT_EQ(memory.extremes(0, 0, 3), (Extremes{INT32_MIN, INT32_MAX}));
  EXPECT_EQ(memory.extremes(1, 0, 3), (Extremes{0, UINT32_MAX}));
}

TEST(ScopeMemory, BehindAHoleItBeginsAnew) {
  ScopeMemory memory(copies);
  memory.choose({std::nullopt});
  memory.restart(0);
  record(memory, 0, 100);
  const int64_t sample = 5;
  EXPECT_FALSE(memory.push(150, {&sample, 1}));
  EXPECT_EQ(memory.first(), 150U);
  EXPECT_TRUE(memory.push(151, {&sample, 1}));
}

Telegram telegram(uint8_t bus, uint32_t id, size_t bytes, std::string words = {}) {
  Telegram one;
  one.bus = bus;
  one.id = id;
  one.time = id * 1000;
  one.data.assign(bytes, static_cast<uint8_t>(id));
  one.words = std::move(words);
  one.error = id % 2 == 1;
  one.reason = 3;
  return one;
}

TEST(TraceMemory, ABusyLineTakesNothingFromAQuietOne) {
  TraceMemory memory(copies);
  memory.restart(2);
  memory.add(1, telegram(0, 77, 8, "quiet"));
  for (uint32_t n = 2; n < 400'000; ++n) memory.add(n, telegram(1, n, 9));
  EXPECT_EQ(memory.end(0), 1U);
  const auto [number, quiet] = memory.at(0, 0);
  EXPECT_EQ(number, 1U);
  EXPECT_EQ(quiet.words, "quiet");
  EXPECT_EQ(quiet.time, 77'000);
  EXPECT_TRUE(quiet.error);
  EXPECT_EQ(quiet.reason, 3);
  EXPECT_EQ(memory.end(1) - memory.first(1), TraceMemory::kKept);
  for (const uint64_t n : {memory.first(1), memory.end(1) - 1}) {
    const auto one = memory.at(1, n);
    EXPECT_EQ(one.number, n + 2);
    EXPECT_EQ(one.telegram.id, n + 2);
    EXPECT_EQ(one.telegram.data, std::vector<uint8_t>(9, static_cast<uint8_t>(n + 2)));
  }
}

TEST(TraceMemory, OfLongOnesThereAreFewerAndAllAreWhole) {
  TraceMemory memory(copies);
  memory.restart(3);
  for (uint32_t n = 0; n < 120'000; ++n) memory.add(n + 1, telegram(2, n, n % 256, std::string(n % 50, 'x')));
  const uint64_t first = memory.first(2);
  EXPECT_GT(memory.end(2) - first, 30'000U);
  EXPECT_LT(memory.end(2) - first, TraceMemory::kKept);
  for (uint64_t n = first; n < memory.end(2); ++n) {
    const auto one = memory.at(2, n);
    ASSERT_EQ(one.number, n + 1);
    ASSERT_EQ(one.telegram.data, std::vector<uint8_t>(n % 256, static_cast<uint8_t>(n)));
    ASSERT_EQ(one.telegram.words, std::string(n % 50, 'x'));
  }
}

TEST(TraceMemory, WhatACopyHasOverwrittenIsGone) {
  TraceMemory memory(copies);
  memory.restart(1);
  for (uint32_t n = 0; n < 60'000; ++n) memory.add(n + 1, telegram(0, n, 8));
  in_a_copy([&] {
    for (uint32_t n = 60'000; n < 130'000; ++n) memory.add(n + 1, telegram(0, n, 8));
  });
  EXPECT_EQ(memory.end(0), 60'000U);
  EXPECT_EQ(memory.first(0), 30'000U);
  EXPECT_EQ(memory.at(0, 30'000).telegram.id, 30'000U);
  memory.restart(1);
  EXPECT_EQ(memory.end(0), 0U);
}

}  // namespace
}  // namespace ipos::tests

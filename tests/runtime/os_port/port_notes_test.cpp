// Messages of ports: told once a kind, counted, bounded in memory, and harmless to a terminal.
#include <gtest/gtest.h>

#include "runtime/os_port/port_notes.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

using Texts = std::vector<std::string>;

TEST(PortNotes, AStateIsToldOnce) {
  PortNotes notes;
  for (int n = 0; n < 3; ++n) notes.note("the adapter hears itself");
  EXPECT_EQ(notes.take(), Texts{"the adapter hears itself"});
  EXPECT_TRUE(notes.take().empty());
  EXPECT_TRUE(notes.repeats().empty());
}

TEST(PortNotes, TheFirstOfAKindIsToldAndTheOthersAreCounted) {
  PortNotes notes;
  for (int n = 0; n < 1000; ++n) notes.count("a broken line", "t" + std::to_string(n) + "!");
  notes.count("bus-off");
  EXPECT_EQ(notes.take(), (Texts{"a broken line: 't0!'", "bus-off"}));
  EXPECT_TRUE(notes.take().empty());
  EXPECT_EQ(notes.repeats(), Texts{"a broken line: 1000 times"});
}

TEST(PortNotes, KindsAreLimited) {
  PortNotes notes;
  for (int n = 0; n < 100'000; ++n) notes.count("error " + std::to_string(n));
  const size_t told = notes.take().size();
  EXPECT_LE(told, 100U);
  EXPECT_EQ(notes.repeats(), Texts{"messages of other kinds: " + std::to_string(100'000 - told) + " times"});
}

TEST(PortNotes, WhatAPeerSendsReachesATerminalEscaped) {
  EXPECT_EQ(escaped("t100\x1B[2J"), "t100\\x1B[2J");
  EXPECT_EQ(escaped(std::string_view("\0\x7F\x80\xFF\r\n\\", 7)), "\\x00\\x7F\\x80\\xFF\\x0D\\x0A\\\\");
  PortNotes notes;
  notes.count("a broken line", "t\x1B]0;title\a");
  EXPECT_EQ(notes.take(), Texts{"a broken line: 't\\x1B]0;title\\x07'"});
}

}  // namespace
}  // namespace ipos::tests

// The maps of programs whose uses, calls, telegrams and states are told by their text.
#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/analysis/maps.hpp"
#include "compiler/compile.hpp"

namespace ipos::tests {
namespace {

using compiler::ProgramMaps;
using Names = std::vector<std::string>;

ProgramMaps maps(const std::string& text) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit("mdxb");
  const compiler::Compilation made = compiler::compile("M.IPC", "", "#include <constb.h>\n" + text, options);
  EXPECT_TRUE(made.image.has_value()) << text;
  return made.image ? compiler::program_maps(*made.image, options.unit->variables) : ProgramMaps{};
}

Names texts(const std::vector<compiler::Runner>& runners) {
  Names all;
  for (const compiler::Runner& one : runners) all.push_back(one.text());
  return all;
}

const compiler::VariableMap& variable(const ProgramMaps& maps, const std::string& name) {
  const auto found = std::find_if(maps.variables.begin(), maps.variables.end(), [&](const auto& row) { return row.name == name; });
  EXPECT_NE(found, maps.variables.end()) << name;
  return found == maps.variables.end() ? maps.variables.front() : *found;
}

TEST(Maps, WhoReadsAndWrites) {
  const ProgramMaps all = maps(
      "long a, b, c, n[4], i;\ninitial long kept;\n"
      "Clock() { c++; }\n"
      "Side() { while (1) { b = a; n[2] = 5; } }\n"
      "main() { _SetInterrupt(SI_TIMER0, Clock); _SetTask2(T2_START, Side); while (1) { a = 3; kept = kept + b; for (i = 0; i < 4; i++) n[i] = i; H300 = 1; } }\n");
  EXPECT_EQ(texts(variable(all, "a").read), (Names{"task 2"}));
  EXPECT_EQ(texts(variable(all, "a").written), (Names{"task 1"}));
  EXPECT_EQ(texts(variable(all, "b").read), (Names{"task 1"}));
  EXPECT_EQ(texts(variable(all, "b").written), (Names{"task 2"}));
  EXPECT_EQ(texts(variable(all, "c").written), (Names{"interrupt Clock"}));
  EXPECT_EQ(texts(variable(all, "n").written), (Names{"task 1", "task 2"}));  // by an index that stays in it
  EXPECT_EQ(variable(all, "n").count, 4);
  EXPECT_TRUE(variable(all, "kept").kept);
  EXPECT_FALSE(variable(all, "a").kept);
  const auto numbered = std::find_if(all.variables.begin(), all.variables.end(), [](const auto& row) { return row.variable == 300; });
  ASSERT_NE(numbered, all.variables.end());
  EXPECT_EQ(texts(numbered->written), (Names{"task 1"}));
  EXPECT_EQ(numbered->name, "");
}

TEST(Maps, WhoCallsWhom) {
  const ProgramMaps all = maps(
      "long a;\nInner() { a++; }\nClock() { Inner(); }\nSide() { while (1) ; }\n"
      "main()\n{\n  Inner();\n  _SetInterrupt(SI_TIMER0, Clock);\n  _SetTask2(T2_START, Side);\n  _SetTask(1, Side);\n  while (1) ;\n}\n");
  const auto has = [&](const std::string& from, const std::string& to, const std::string& how, uint32_t line) {
    return std::any_of(all.calls.begin(), all.calls.end(), [&](const compiler::CallMap& call) {
      return call.from == from && call.to == to && call.text() == how && call.line == line;
    });
  };
  EXPECT_TRUE(has("main", "Inner", "calls", 8));
  EXPECT_TRUE(has("Clock", "Inner", "calls", 4));
  EXPECT_TRUE(has("main", "Clock", "installs as an interrupt", 9));
  EXPECT_TRUE(has("main", "Side", "starts as task 2", 10));
  EXPECT_TRUE(has("main", "Side", "starts as task 3", 11));
  EXPECT_EQ(all.calls.size(), 5U);
}

TEST(Maps, Telegrams) {
  const ProgramMaps all = maps(
      "SCTRCYCL out; SCREC in; long data[2], other[2];\n"
      "main()\n{\n  out.ObjectNo = 1024; out.CycleTime = 20; out.Offset = 3; out.Format = 4; out.DPointer = numof(data[0]);\n"
      "  _SBusCommDef(SCD_TRCYCL, out);\n"
      "  in.ObjectNo = H300; in.Format = 8; in.DPointer = numof(other[0]);\n  _SBusCommDef(SCD_REC, in);\n  while (1) ;\n}\n");
  ASSERT_EQ(all.telegrams.size(), 2U);
  const auto& out = all.telegrams[0];
  EXPECT_EQ(out.kind, "cyclic");
  EXPECT_EQ(out.line, 6U);
  EXPECT_EQ(out.object, 1024);
  EXPECT_EQ(out.cycle_ms, 20);
  EXPECT_EQ(out.offset_ms, 3);
  EXPECT_EQ(out.format, 4);
  EXPECT_EQ(out.data, variable(all, "data").variable);
  EXPECT_EQ(all.telegrams[1].kind, "receive");
  EXPECT_FALSE(all.telegrams[1].object);  // nobody knows H300
  EXPECT_EQ(all.telegrams[1].format, 8);
}

TEST(Maps, StatesOfASwitch) {
  const ProgramMaps all = maps(
      "long state, a;\n"
      "main()\n{\n  state = 0;\n  while (1)\n  {\n    switch (state)\n    {\n"
      "      case 0:\n        if (H483 & 1) state = 1;\n        break;\n"
      "      case 1:\n        a++;\n        if (a > 5) state = 2;\n        if (H483 & 2) state = 9;\n        break;\n"
      "      case 2:\n        state = 0;\n        break;\n"
      "    }\n    if (H483 & 4) state = 0;\n  }\n}\n");
  ASSERT_EQ(all.states.size(), 1U);
  const compiler::StateMap& map = all.states.front();
  EXPECT_EQ(map.name, "state");
  EXPECT_EQ(map.states, (std::vector<int64_t>{0, 1, 2, 9}));
  const auto has = [&](std::optional<int64_t> from, int64_t to, uint32_t line) {
    return std::find(map.ways.begin(), map.ways.end(), compiler::StateMap::Way{from, to, line}) != map.ways.end();
  };
  EXPECT_TRUE(has(0, 1, 11));
  EXPECT_TRUE(has(1, 2, 15));
  EXPECT_TRUE(has(2, 0, 19));
  EXPECT_TRUE(has(std::nullopt, 0, 22));
}

// A switch of many cases asks for halves of them, and for the last one of a range not at all.
TEST(Maps, StatesOfManyCases) {
  std::string text = "long state, a;\nmain()\n{\n  state = 0;\n  while (1)\n  {\n    switch (state)\n    {\n";
  for (int n = 0; n < 12; ++n)
    text += "      case " + std::to_string(n) + ":\n        if (H483 & 1) state = " + std::to_string((n + 1) % 12) + ";\n        break;\n";
  const ProgramMaps all = maps(text + "    }\n    if (H483 & 2) a = 5;\n  }\n}\n");
  ASSERT_EQ(all.states.size(), 1U);
  EXPECT_EQ(all.states.front().states, (std::vector<int64_t>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
  EXPECT_EQ(all.states.front().ways.size(), 13U);  // from each to the next one, and the start
  for (uint32_t n = 0; n < 12; ++n) {
    const compiler::StateMap::Way way{int64_t{n}, (int64_t{n} + 1) % 12, 11 + 3 * n};
    EXPECT_NE(std::find(all.states.front().ways.begin(), all.states.front().ways.end(), way), all.states.front().ways.end()) << n;
  }
}

}  // namespace
}  // namespace ipos::tests

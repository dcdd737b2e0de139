// Forms that take fewer commands than what stands in the source: which ones, what they cost, and where they are not taken.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compiler/backend_test.hpp"
#include "vm/exec/machine.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::compiler::test {
namespace {

using Lines = std::vector<std::string>;

Compilation compile_as(const std::string& text, bool as_written, const char* unit = "mdxb") {
  CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view(unit));
  options.as_written = as_written;
  return compile("test.IPC", "", text, options);
}

std::string join(const Lines& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

// Of a main with these statements; x is H420, o H421.
std::string made(const std::string& statements) {
  return join(commands(compile_text("long x, o, i, a[8], b[8];\nset() { x = 1; i = 1; }\nmain() {\n" + statements + "\n}\n")));
}

TEST(BitMoves, OneCommandForBothWays) {
  const std::string move = "M01 : BMOV H421.1 = H420.2\nEND\n";
  const std::string inverted = "M01 : BMOVN H421.1 = NOT H420.2\nEND\n";
  for (const char* statement :
       {"if (x & 4) o |= 2; else o &= ~2;", "if (x & 4) { o |= 2; } else { o &= ~2; }", "if ((x & 4) != 0) o |= 2; else o &= ~2;",
        "if ((x & 4) == 4) o |= 2; else o &= ~2;", "if (4 & x) o = o | 2; else o = o & ~2;", "if (x >> 2 & 1) o |= 2; else o &= ~2;",
        "if ((x >> 2 & 1) == 1) o |= 2; else o &= ~2;", "if (!(x & 4)) o &= ~2; else o |= 2;", "if ((x & 4) == 0) o &= -3; else o |= 2;",
        "if (x & 4) _BitSet(o, 1); else _BitClear(o, 1);", "o = x & 4 ? o | 2 : o & ~2;"})
    EXPECT_EQ(made(statement), move) << statement;
  for (const char* statement : {"if (x & 4) o &= ~2; else o |= 2;", "if (!(x & 4)) o |= 2; else o &= ~2;",
                                "if ((x & 4) == 0) _BitSet(o, 1); else o &= ~2;", "o = x & 4 ? o & ~2 : 2 | o;"})
    EXPECT_EQ(made(statement), inverted) << statement;
  EXPECT_EQ(made("if (x & 0x80000000) o |= 1; else o &= ~1;"), "M01 : BMOV H421.0 = H420.31\nEND\n");
  EXPECT_EQ(made("if (x & 1) x |= 8; else x &= ~8;"), "M01 : BMOV H420.3 = H420.0\nEND\n");
}

TEST(BitMoves, OthersStayAsTheyAre) {
  for (const char* statement :
       {"if (x & 6) o |= 2; else o &= ~2;", "if (x & 4) o |= 2; else o &= ~4;", "if (x & 4) o |= 3; else o &= ~3;",
        "if (x & 4) o |= 2; else o |= 2;", "if (x & 4) o |= 2; else i &= ~2;", "if (x & 4) o |= 2;",
        "if ((x & 4) == 1) o |= 2; else o &= ~2;", "if ((x & 4) > 0) o |= 2; else o &= ~2;", "if (x) o |= 2; else o &= ~2;",
        "if (x & 4) { o |= 2; i++; } else o &= ~2;", "if (x & 4) a[i] |= 2; else a[i] &= ~2;", "if (x & 4) o ^= 2; else o &= ~2;"})
    EXPECT_EQ(made(statement).find("BMOV"), std::string::npos) << statement;
  const Compilation written = compile_as("long x, o;\nmain() { if (x & 4) o |= 2; else o &= ~2; }", true);
  EXPECT_EQ(join(commands(written)).find("BMOV"), std::string::npos);
}

TEST(CopyLoops, OneCopy) {
  for (const char* loop : {"for (i = 0; i < 8; i++) a[i] = b[i];", "for (i = 0; i <= 7; ++i) { a[i] = b[i]; }", "for (i = 0; i != 8; i += 1) a[i] = b[i];"})
    EXPECT_EQ(made(loop), "M01 : COPY H423 = H431 , 8\nSET H422 = 8\nEND\n") << loop;
  EXPECT_EQ(made("for (i = 2; i < 5; i++) b[i] = a[i];"), "M01 : COPY H433 = H425 , 3\nSET H422 = 5\nEND\n");
}

TEST(CopyLoops, OthersStayLoops) {
  for (const char* loop :
       {"for (i = 0; i < 9; i++) a[i] = b[i];", "for (i = -1; i < 8; i++) a[i] = b[i];", "for (i = 0; i < 8; i += 2) a[i] = b[i];",
        "for (i = 0; i < 8; i++) a[i] = b[i] + 1;", "for (i = 0; i < 8; i++) a[i] += b[i];", "for (i = 0; i < x; i++) a[i] = b[i];",
        "for (i = 0; i < 8; i++) a[i] = b[x];", "for (i = 0; i < 8; i++) { a[i] = b[i]; if (i == x) break; }", "for (x = 0; i < 8; i++) a[i] = b[i];",
        "for (i = 0; i < 8; x++) a[i] = b[i];", "for (i = 8; i > 0; i--) a[i] = b[i];"})
    EXPECT_EQ(made(loop).find("COPY"), std::string::npos) << loop;
  // Somebody looks at the counter; the counter has a number, and a bus may look; variables of the unit get their values one by one.
  const std::string head = "#include <constb.h>\nlong i, j, a[8], b[8];\n";
  for (const std::string& text :
       {head + "f() { while (1) j = i; }\nmain() { _SetTask2(T2_START, f); for (i = 0; i < 8; i++) a[i] = b[i]; }",
        head + "main() { for (i = 0; i < 8; i++) a[i] = b[i]; H420 = 0; }", head + "main() { for (H484 = 0; H484 < 8; H484++) a[H484] = b[H484]; }"})
    EXPECT_EQ(join(commands(compile_as(text, false))).find("COPY"), std::string::npos) << text;
  EXPECT_EQ(join(commands(compile_as(head + "main() { for (i = 0; i < 8; i++) a[i] = b[i]; }", true))).find("COPY"), std::string::npos);
}

// i-- copies downwards; what moves up by one is a shift register.
TEST(CopyLoops, Downwards) {
  EXPECT_EQ(made("for (i = 7; i > 0; i--) a[i] = a[i - 1];"), "M01 : COPY H424 = H423 , 7\nSET H422 = 0\nEND\n");
  EXPECT_EQ(made("for (i = 7; i >= 2; i -= 1) a[i] = b[i];"), "M01 : COPY H425 = H433 , 6\nSET H422 = 1\nEND\n");
  EXPECT_EQ(made("for (i = 0; i < 7; i++) a[i] = a[i + 1];"), "M01 : COPY H423 = H424 , 7\nSET H422 = 7\nEND\n");
  // Each hands the first one on.
  for (const char* loop : {"for (i = 1; i < 8; i++) a[i] = a[i - 1];", "for (i = 6; i >= 0; i--) a[i] = a[i + 1];", "for (i = 7; i > -2; i--) a[i] = b[i];",
                           "for (i = 0; i > -8; i++) a[i] = b[i];", "for (i = 7; i < 8; i--) a[i] = b[i];"})
    EXPECT_EQ(made(loop).find("COPY"), std::string::npos) << loop;
}

TEST(FillLoops, CopiesThatDouble) {
  EXPECT_EQ(made("for (i = 0; i < 8; i++) a[i] = 5;"),
            "M01 : SET H423 = 5\nCOPY H424 = H423 , 1\nCOPY H425 = H423 , 2\nCOPY H427 = H423 , 4\nSET H422 = 8\nEND\n");
  EXPECT_EQ(made("for (i = 6; i > 0; i--) b[i] = x;"),
            "M01 : SET H432 = H420\nCOPY H433 = H432 , 1\nCOPY H434 = H432 , 2\nCOPY H436 = H432 , 2\nSET H422 = 0\nEND\n");
  EXPECT_EQ(made("for (i = 3; i < 4; i++) a[i] = 5;"), "M01 : SET H426 = 5\nSET H422 = 4\nEND\n");
  for (const char* loop : {"for (i = 0; i < 9; i++) a[i] = 5;", "for (i = 0; i < 8; i++) a[i] = i;", "for (i = 0; i < 8; i++) a[i] = a[3];", "for (i = 0; i < 8; i++) a[i] += 5;"})
    EXPECT_EQ(made(loop).find("COPY"), std::string::npos) << loop;
  // Somebody else may write an element that is copied on, or what it is filled with.
  const std::string head = "#include <constb.h>\nlong i, x, a[8];\n";
  for (const std::string& text :
       {head + "f() { while (1) a[3] = 7; }\nmain() { _SetTask2(T2_START, f); for (i = 0; i < 8; i++) a[i] = 5; }",
        head + "f() { while (1) x++; }\nmain() { _SetTask2(T2_START, f); for (i = 0; i < 8; i++) a[i] = x; }",
        std::string("#include <constb.h>\ninitial long a[8];\nlong i;\nmain() { for (i = 0; i < 8; i++) a[i] = 5; }")})
    EXPECT_EQ(join(commands(compile_as(text, false))).find("COPY"), std::string::npos) << text;
  const std::string reads = head + "f() { while (1) x = a[3]; }\nmain() { _SetTask2(T2_START, f); for (i = 0; i < 8; i++) a[i] = 5; }";
  EXPECT_NE(join(commands(compile_as(reads, false))).find("COPY"), std::string::npos) << "it only reads";
}

std::string states(int count, int step = 1) {
  std::string cases;
  for (int n = 0; n < count; ++n) cases += "case " + std::to_string(n * step) + ": o = " + std::to_string(n + 100) + "; break;\n";
  return "long x, o;\nmain() {\nswitch (x) {\n" + cases + "default: o = 1;\n}\n}\n";
}

// What a program of x and o does with a selector in x.
struct Way {
  int32_t result = 0;
  uint64_t commands = 0;
};
Way way(const Compilation& c, int32_t selector) {
  const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view("mdxb"));
  const vm::VerifiedImage image =
      vm::verify(c.image->code, {unit.variables, unit.program_words, unit.tasks, unit.call_depth}, {}).image.value();
  vm::Machine machine(image, {});
  machine.start();
  machine.variables()[420] = selector;
  const vm::RunResult result = machine.run(1, 1000);
  return {machine.variables()[421], result.commands};
}

TEST(Switches, FiftyStatesTakeEightCommands) {
  for (const int step : {1, 7}) {
    const Compilation halves = compile_as(states(50, step), false), in_order = compile_as(states(50, step), true);
    ASSERT_TRUE(halves.image && in_order.image);
    uint64_t most = 0, most_in_order = 0;
    for (int32_t value = -5; value < 50 * step + 5; ++value) {
      const Way one = way(halves, value), other = way(in_order, value);
      const bool is_case = value >= 0 && value < 50 * step && value % step == 0;
      EXPECT_EQ(one.result, is_case ? value / step + 100 : 1) << value;
      EXPECT_EQ(other.result, one.result) << value;
      most = std::max(most, one.commands);
      most_in_order = std::max(most_in_order, other.commands);
    }
    // With SET o and END; the default is a jump more.
    EXPECT_LE(most, 9U + 2) << step;
    EXPECT_GE(most_in_order, 52U) << step;
  }
}

// The table of docs/guide/language.md: executed commands, END apart and for the switches what the case itself does.
TEST(Savings, CommandsOfThePage) {
  const auto executed = [](const std::string& text, bool as_written) { return way(compile_as(text, as_written), 0).commands - 1; };
  const auto slowest = [](int count, bool as_written) {
    const Compilation c = compile_as(states(count), as_written);
    uint64_t most = 0;
    for (int32_t value = 0; value < count; ++value) most = std::max(most, way(c, value).commands);
    return most - 2;  // SET o, END
  };
  EXPECT_EQ(slowest(50, true), 51U);
  EXPECT_EQ(slowest(50, false), 8U);
  EXPECT_EQ(slowest(8, true), 9U);
  EXPECT_EQ(slowest(8, false), 5U);
  const std::string head = "typedef struct { long a; long b; long c; } T;\nlong x, o, i, s;\nT t[4];\nlong a[8], b[8];\nset() { i = 1; }\nmain() {\n";
  EXPECT_EQ(executed(head + "if (x & 4) o |= 2; else o &= ~2;\n}", true), 4U);
  EXPECT_EQ(executed(head + "if (x & 4) o |= 2; else o &= ~2;\n}", false), 1U);
  EXPECT_EQ(executed(head + "for (i = 0; i < 8; i++) a[i] = b[i];\n}", true), 65U);
  EXPECT_EQ(executed(head + "for (i = 0; i < 8; i++) a[i] = b[i];\n}", false), 2U);
  EXPECT_EQ(executed(head + "t[i].c = t[i].b * 2;\n}", true), 9U);
  EXPECT_EQ(executed(head + "t[i].c = t[i].b * 2;\n}", false), 7U);
  EXPECT_EQ(executed(head + "s = t[i].a + t[i].b + t[i].c;\n}", true), 15U);
  EXPECT_EQ(executed(head + "s = t[i].a + t[i].b + t[i].c;\n}", false), 11U);

  // Loops. `by hand`: the assembler that keeps the numbers of the elements in variables of their own, and counts i on.
  struct Loop {
    const char* statements;
    uint64_t written, by_hand, made;
  };
  const Loop loops[] = {
      // SET, SET, SET; SETI, ADD, ADD, ADD, JMP
      {"s = 0; for (i = 0; i < 8; i++) s += a[i];", 2 + 8 * 6, 3 + 8 * 5, 3 + 8 * 5},
      // SET, SET, SET; SETI, JMP, ADD, ADD, JMP. None is larger than the first.
      {"s = a[0]; for (i = 1; i < 8; i++) if (a[i] > s) s = a[i];", 2 + 7 * 6, 3 + 7 * 5, 3 + 7 * 5},
      // Four times SET; SETI, MUL, SETI, ADD, three times ADD, JMP. By hand what is stored needs not be loaded again.
      {"s = 0; for (i = 0; i < 4; i++) { t[i].c = t[i].b * 2; s += t[i].c; }", 2 + 4 * 16, 4 + 4 * 8, 4 + 4 * 9},
      // SET, SET; SETI, JMP, ADD, ADD, JMP
      {"for (i = 0; i < 8; i++) if (a[i] == 7) break;", 1 + 8 * 6, 2 + 8 * 5, 2 + 8 * 5},
      // SET, SET, JMP; JMP, SETI, JMP, ADD, ADD, and JMP at the end
      {"for (i = 0; i < 8 && a[i] != 7; i++) ;", 2 + 8 * 6 + 1, 3 + 8 * 5 + 1, 3 + 8 * 5 + 1},
      // SET, SET, SET; SETI, MUL, DIV, SETI, three times ADD, JMP
      {"for (i = 0; i < 8; i++) a[i] = b[i] * 10 / 3;", 1 + 8 * 10, 3 + 8 * 8, 3 + 8 * 8},
      // Four times SET, the last one of what is stored; SETI, SETI, three times ADD, JMP
      {"for (i = 0; i < 4; i++) { t[i].a = 0; t[i].b = 0; }", 1 + 4 * 12, 4 + 4 * 6, 4 + 4 * 6},
      // A table that is sorted already: 7 turns around 28 ones, and 35 comparisons with 7 - i. SET, SET; SET, SET, SET, JMP, ADD, ADD, JMP; JMP;
      // SETI, SETI, JMP, ADD, ADD, ADD
      {"for (i = 0; i < 7; i++) for (o = 0; o < 7 - i; o++) if (a[o] > a[o + 1]) { s = a[o]; a[o] = a[o + 1]; a[o + 1] = s; }",
       1 + 7 * 4 + 35 * 3 + 28 * 8, 2 + 7 * 7 + 35 + 28 * 6, 2 + 7 * 7 + 35 + 28 * 6},
      // Clearing and moving on need no loop: SET, COPY, COPY, COPY, SET; COPY, SET
      {"for (i = 0; i < 8; i++) a[i] = 0;", 1 + 8 * 6, 5, 5},
      {"for (i = 7; i > 0; i--) a[i] = a[i - 1];", 1 + 7 * 8, 2, 2},
  };
  for (const Loop& loop : loops) {
    EXPECT_EQ(executed(head + loop.statements + "\n}", true), loop.written) << loop.statements;
    EXPECT_EQ(executed(head + loop.statements + "\n}", false), loop.made) << loop.statements;
    EXPECT_LE(loop.made * 100, loop.by_hand * 115) << loop.statements;
  }
}

// No turn, and one turn, cost no more than what is written where the counter begins with a constant; where it does not, up to the start of
// what is kept.
TEST(HeldNumbers, FewTurns) {
  const std::string head = "typedef struct { long a; long b; long c; } T;\nlong x, o, i, s, n;\nT t[4];\nlong a[8];\nset() { i = 1; }\nmain() {\n";
  const auto executed = [&](const std::string& text, bool as_written) { return way(compile_as(head + text + "\n}", as_written), 0).commands - 1; };
  for (const char* loop : {"n = 0; for (i = 0; i < n; i++) s += a[i];", "n = 1; for (i = 0; i < n; i++) s += a[i];", "n = 1; for (i = 0; i < n; i++) s += t[i].b;",
                           "n = 0; i = 0; while (i < n) { s += t[i].b; i++; }", "for (i = 0; i < 1; i++) { s += a[i]; s += a[i + 1]; }"})
    EXPECT_LE(executed(loop, false), executed(loop, true)) << loop;
  const char* one = "n = 1; i = 0; while (i < n) { s += a[i]; i++; }";
  EXPECT_EQ(executed(one, false), executed(one, true) + 1) << "SET and ADD before the loop, ADD in it, for SET and ADD";
  const char* none = "n = 0; for (i = 0; i < n && a[i]; i++) ;";
  EXPECT_EQ(executed(none, false), executed(none, true) + 1) << "SET before the condition";
}

// The commands of a main with this statement, and with -O0.
TEST(HeldNumbers, OnlyWhereNobodySeesIt) {
  const std::string head = "#include <constb.h>\ntypedef struct { long a; long b; long c; } T;\nlong i, j, n, s, p;\nT t[4];\nlong a[8], b[8];\n";
  const auto same = [&](const std::string& text, bool atomic = false) {
    CompileOptions options;
    options.unit = stdlib::find_unit(std::string_view("mdxb"));
    options.atomic = atomic;
    const Compilation fewer = compile("test.IPC", "", head + text, options);
    options.as_written = true;
    return commands(fewer) == commands(compile("test.IPC", "", head + text, options));
  };
  const std::string loop = "for (i = 0; i < n; i++) s += t[i].b;";
  EXPECT_FALSE(same("main() { n = 3; " + loop + " }"));
  EXPECT_FALSE(same("f() { while (1) p = i; }\nmain() { _SetTask2(T2_START, f); " + loop + " }")) << "it only looks at i, which counts on";
  EXPECT_TRUE(same("f() { while (1) i++; }\nmain() { _SetTask2(T2_START, f); " + loop + " }"));
  EXPECT_TRUE(same("f() { i = 1; }\nmain() { _SetInterrupt(SI_TIMER0, f); " + loop + " }"));
  EXPECT_TRUE(same("f() { while (1) *p = 1; }\nmain() { _SetTask2(T2_START, f); " + loop + " }")) << "a pointer may lead anywhere";
  EXPECT_TRUE(same("f() { " + loop + " }\nmain() { _SetTask2(T2_START, f); while (1) f(); }")) << "two tasks count at once";
  EXPECT_TRUE(same("main() { H420 = 1; " + loop + " }")) << "a bus may write what has a number";
  EXPECT_TRUE(same("f() { n++; }\nmain() { for (i = 0; i < 4; i++) { s += t[i].b; f(); } }")) << "a call";
  for (const char* statements :
       {"for (i = 0; i < 4; i++) { s += t[i].b; _Wait(1); }",                      // somebody may write i meanwhile, in the debugger or on the page
        "while (1) { s += t[i].b; i++; }", "while (s < 9) s += t[i].b;",            // it does not count
        "for (i = 0; i < n; i++) { s += t[i].b; i = s; }",                          // i goes elsewhere
        "for (i = 0; i < n; i++) { s += t[i].b; a[n] = 1; }",                       // an element beyond the array may be i
        "for (i = 0; i < n; i++) a[i] = s;", "for (i = 0; i < n; i++) *p = t[i].b;",
        "for (i = 0; i < 4; i++) { s += t[i].b; a[i - 17] = 1; }",                  // it is one: a is H437
        "for (i = 0; i < 4; i++) if (s) p += a[i];",                                // not in each turn
        "for (i = 0; i < 4; i++) { if (s) continue; p += a[i]; }",
        "for (i = 0; i <= 2147483647; i += 2) { a[i & 7] = s; s = 0; b[i] = 1; }",  // it wraps
        "switch (n & 3) { case 1: for (i = 0; i < 4; i++) { case 2: s += t[i].b; } }"}) // another way in
    EXPECT_TRUE(same(std::string("main() { n = 1; ") + statements + " }")) << statements;
  for (const char* statements : {"for (i = 0; i < 4; i++) { a[i] = s; p += t[i].b; }", "for (i = 0; i < n; i++) { a[n & 7] = s; p += t[i].b; }",
                                 "for (i = 0; i < 4; i++) for (j = i; j < 4; j++) t[j].a = t[i].b;", "for (i = 0; i < 4; i++) { if (s) break; p += t[i].b; }",
                                 "for (i = 0; i < n; i++) { if (s) i++; p += t[i].b; p -= t[i].b * 3; }", "do { s += t[i].b; i += 2; } while (i < n);",
                                 "for (i = 0; i < n; i++) { if (t[i].a) continue; p += i; }", "for (i = 9; i; i--, j++) if (t[i].a > t[j].a && i > j) s = 1;"})
    EXPECT_FALSE(same(std::string("main() { n = 1; ") + statements + " }")) << statements;
}

// A loop stays as it is where there are not temporaries enough: three are kept here, and one is worked with.
TEST(HeldNumbers, NeedRoom) {
  const std::string text = "typedef struct { long a; long b; long c; } T;\nlong i, s;\nT t[4];\nmain() { for (i = 0; i < 4; i++) { s += t[i].b; t[i].c = t[i].a; } }";
  const auto count = [&](const std::string& range) { return commands(compile_as(range + text, false)).size(); };
  const size_t all = count(""), written = commands(compile_as(text, true)).size();
  EXPECT_LT(all, written);
  EXPECT_EQ(count("#pragma var 400 403\n"), all);
  EXPECT_EQ(count("#pragma var 400 402\n"), commands(compile_as("#pragma var 400 401\n" + text, false)).size());
  EXPECT_TRUE(compile_as("#pragma var 400 401\n" + text, false).image);
}

TEST(Switches, EndsOfTheNumbers) {
  const std::string text = "long x, o;\nmain() {\nswitch (x) {\ncase 2147483647: o = 1; break;\ncase -2147483648: o = 2; break;\n"
                           "case 0: o = 3; break;\ncase -2147483647: o = 4; break;\ncase 2147483646: o = 5; break;\ncase -1: o = 6;\n}\n}\n";
  const Compilation c = compile_as(text, false);
  const std::vector<std::pair<int32_t, int32_t>> expected = {{INT32_MAX, 1}, {INT32_MIN, 2}, {0, 3}, {-INT32_MAX, 4}, {INT32_MAX - 1, 5}, {-1, 6}, {1, 0}, {-2, 0}};
  for (const auto& [value, result] : expected) EXPECT_EQ(way(c, value).result, result) << value;
}

// A copy only where somebody else may write the selector.
TEST(Switches, TheSelectorIsCopiedWhereItMayChange) {
  const std::string body = "switch (x) { case 1: o = 1; break; case 2: o = 2; }";
  EXPECT_EQ(made(body).find("SET H400"), std::string::npos) << made(body);
  const std::string head = "#include <constb.h>\nlong x, o, p;\nset() { x = 1; }\n";
  const auto copies = [&](const std::string& text) {
    return join(commands(compile_as(head + text, false))).find(" = H420\n") != std::string::npos;
  };
  EXPECT_FALSE(copies("f() { while (1) p++; }\nmain() { _SetTask2(T2_START, f); " + body + " }"));
  EXPECT_FALSE(copies("f() { while (1) if (x > 3) p++; }\nmain() { _SetTask2(T2_START, f); " + body + " }")) << "it only reads";
  EXPECT_TRUE(copies("f() { while (1) x++; }\nmain() { _SetTask2(T2_START, f); " + body + " }"));
  EXPECT_TRUE(copies("f() { x = 1; }\nmain() { _SetInterrupt(SI_TIMER0, f); " + body + " }"));
  EXPECT_TRUE(copies("f() { while (1) *p = 1; }\nmain() { _SetTask2(T2_START, f); " + body + " }")) << "a pointer may lead anywhere";
  EXPECT_TRUE(copies("main() { H420 = 1; " + body + " }")) << "a bus may write what has a number";
  EXPECT_FALSE(copies("main() { " + body + " }"));
  // Somebody outside writes what the program does not, and what is kept.
  EXPECT_NE(join(commands(compile_as("long x, o;\nmain() { " + body + " }", false))).find(" = H420\n"), std::string::npos);
  EXPECT_NE(join(commands(compile_as("initial long x;\nlong o;\nmain() { x = 1; " + body + " }", false))).find(" = H0\n"), std::string::npos);
  const std::string system = join(commands(compile_as("#include <constb.h>\nlong o;\nmain() { switch (H483) { case 1: o = 1; break; case 2: o = 2; } }", false)));
  EXPECT_NE(system.find(" = H483\n"), std::string::npos) << system;
}

// t[i].c = t[i].b * 2: SET i, MUL 3, ADD b; SETI, MUL; ADD 1; SETI, where each use took SET, MUL and ADD.
TEST(Indexes, AreComputedOnceInAStatement) {
  const std::string head = "typedef struct { long a; long b; long c; } T;\nlong i, s;\nT t[4];\nlong v[8];\nset() { i = 1; }\nmain() { ";
  const auto count = [&](const std::string& statement, bool as_written) { return commands(compile_as(head + statement + " }", as_written)).size() - 1; };
  EXPECT_EQ(count("t[i].c = t[i].b * 2;", true), 9U);
  EXPECT_EQ(count("t[i].c = t[i].b * 2;", false), 7U);
  EXPECT_EQ(count("v[i] = v[i] + 1;", true), 7U);
  EXPECT_EQ(count("v[i] = v[i] + 1;", false), 5U);
  EXPECT_EQ(count("s = t[i].a + t[i].b + t[i].c;", true), 15U);
  EXPECT_EQ(count("s = t[i].a + t[i].b + t[i].c;", false), 11U);
  // *p needs no number computed: SET, ADD, SETI for the other one, then SETI and SUB.
  EXPECT_EQ(count("s = *(i + 2) - *i;", false), count("s = *(i + 2) - *i;", true));
  // Not where the index changes on the way, or a way may be left out.
  for (const char* statement : {"s = v[i++] + v[i];", "s = v[i] && v[i];", "s = s ? v[i] : v[i];", "i = t[i].a + t[i].b;", "s = v[s] = v[i];"})
    EXPECT_EQ(count(statement, false), count(statement, true)) << statement;
}

TEST(Indexes, NotWhereSomebodyElseWritesThem) {
  const std::string text = "#include <constb.h>\ntypedef struct { long a; long b; } T;\nlong i;\nT t[4];\nf() { while (1) i++; }\n"
                           "main() { _SetTask2(T2_START, f); t[i].a = t[i].b; }";
  EXPECT_EQ(commands(compile_as(text, false)), commands(compile_as(text, true)));
}

}  // namespace
}  // namespace ipos::compiler::test

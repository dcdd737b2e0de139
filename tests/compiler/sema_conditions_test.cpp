// Conditions that constants decide, brackets that are missing, statements that are never reached: for each of these
// warnings all forms that have it and their neighbours that do not.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

using Codes = std::vector<std::string>;

struct Compare {
  const char* sign;
  bool (*holds)(int64_t, int64_t);
};
constexpr Compare kCompares[] = {
    {"<", [](int64_t a, int64_t b) { return a < b; }},   {"<=", [](int64_t a, int64_t b) { return a <= b; }},
    {">", [](int64_t a, int64_t b) { return a > b; }},   {">=", [](int64_t a, int64_t b) { return a >= b; }},
    {"==", [](int64_t a, int64_t b) { return a == b; }}, {"!=", [](int64_t a, int64_t b) { return a != b; }}};

// What a comparison of any of `values` with a number can give.
std::string decided(const std::vector<int64_t>& values, const Compare& compare, int64_t with, bool swapped) {
  const auto holds = [&](int64_t value) {
    return swapped ? compare.holds(with, value) : compare.holds(value, with);
  };
  if (std::all_of(values.begin(), values.end(), holds)) return "always";
  return std::none_of(values.begin(), values.end(), holds) ? "never" : "";
}

// One condition in each line.
struct Conditions {
  std::vector<std::pair<std::string, std::string>> rows;  // and what is said of it
  void add(const std::string& condition, const std::string& outcome) {
    rows.emplace_back(condition, outcome.empty() ? "" : "this condition is " + outcome + " true");
  }
  void check() const {
    std::string source = "main() {\n";
    for (const auto& row : rows) source += "if (" + row.first + ") H9 = 1;\n";
    std::vector<std::string> found(rows.size());
    const Compilation c = compile_text(source + "}", "mdxb");  // it has room for all
    for (const Diagnostic& one : c.diagnostics.all())
      found.at(c.sources->position(one.span.begin).line - 2) += one.text;
    for (size_t n = 0; n < rows.size(); ++n) EXPECT_EQ(found[n], rows[n].second) << rows[n].first;
  }
};

TEST(Decided, ByAMaskAsAllItsValuesSay) {
  Conditions conditions;
  for (const int64_t mask : {0, 1, 2, 5, 6, 7, 8}) {
    std::vector<int64_t> values;
    for (int64_t x = 0; x < 16; ++x) values.push_back(x & mask);
    for (const Compare& compare : kCompares)
      for (int64_t with = -2; with <= 10; ++with) {
        // A mask of 0 is a mistake of its own; equality is asked for bits beside the mask only.
        if (mask == 0 && with == 0 && compare.sign[1] == '=') continue;
        const std::string number = std::to_string(with);
        const std::string bits = std::to_string(mask);
        conditions.add("(H0 & " + bits + ") " + compare.sign + " " + number,
                       decided(values, compare, with, false));
        conditions.add("(" + bits + " & H0) " + compare.sign + " " + number,
                       decided(values, compare, with, false));
        conditions.add(number + " " + compare.sign + " (H0 & " + bits + ")",
                       decided(values, compare, with, true));
      }
  }
  conditions.check();
}

TEST(Decided, ByWhatIsZeroOrOne) {
  Conditions conditions;
  for (const char* truth : {"(H0 < H1)", "(H0 <= H1)", "(H0 > 3)", "(H0 >= 3)", "(H0 == H1)", "(H0 != 3)",
                            "(!H0)", "(H0 && H1)", "(H0 || H1)"})
    for (const Compare& compare : kCompares)
      for (int64_t with = -1; with <= 2; ++with) {
        conditions.add(truth + (" " + std::string(compare.sign) + " " + std::to_string(with)),
                       decided({0, 1}, compare, with, false));
        conditions.add(std::to_string(with) + " " + compare.sign + " " + truth,
                       decided({0, 1}, compare, with, true));
      }
  conditions.check();
}

TEST(Decided, ByANegativeMaskForEqualityOnly) {
  Conditions conditions;
  for (int64_t with = -9; with <= 9; ++with) {
    const std::string number = std::to_string(with);
    conditions.add("(H0 & -4) == " + number, (with & 3) != 0 ? "never" : "");
    conditions.add("(H0 & -4) != " + number, (with & 3) != 0 ? "always" : "");
    for (const char* sign : {"<", "<=", ">", ">="})
      conditions.add("(H0 & -4) " + std::string(sign) + " " + number, "");
  }
  conditions.check();
}

TEST(Decided, NotByOtherOperators) {
  Conditions conditions;
  for (const char* other :
       {"(H0 + 6)", "(H0 | 6)", "(H0 ^ 6)", "(H0 << 6)", "(-H0)", "(~H0)", "H0", "(H0 & H1)"})
    for (const Compare& compare : kCompares)
      conditions.add(other + (" " + std::string(compare.sign) + " 1"), "");
  conditions.check();
}

TEST(Decided, ThroughTheLogicalOperators) {
  Conditions conditions;
  const std::pair<const char*, const char*> rows[] = {
      {"1", "always"},
      {"0", "never"},
      {"5 - 5", "never"},
      {"H1 && 0", "never"},
      {"H1 && 1", ""},
      {"H1 || 1", "always"},
      {"H1 || 0", ""},
      {"0 && H1", "never"},
      {"1 || H1", "always"},
      {"1 && H1", ""},
      {"0 || H1", ""},
      {"!(H1 && 0)", "always"},
      {"!!(H1 && 0)", "never"},
      {"-(H1 && 0)", ""},
      {"~(H1 && 0)", ""},
      {"H1 & 0", "never"},
      {"0 & H1", "never"},
      {"H1 & 1", ""},
      {"H1 | 1", "always"},
      {"2 | H1", "always"},
      {"H1 | 0", ""},
      {"0 | H1", ""},
      {"H1 ^ 1", ""},
      {"H1 * 0", ""},
      {"H1 && (H0 & 6) == 1", "never"},
      {"(H0 & 6) == 1 && H1", "never"},
      {"H1 || (H0 & 6) == 1", ""},
      {"H1 || (H0 & 6) != 1", "always"},
      {"(H0 & 6) != 1 && H1", ""},
      {"!((H0 & 6) == 1)", "always"},
  };
  for (const auto& [condition, outcome] : rows) conditions.add(condition, outcome);
  conditions.check();
}

TEST(Decided, InEveryStatementWithACondition) {
  const std::pair<const char*, Codes> rows[] = {
      {"while (0) H1 = 1;", {"W0253"}},
      {"while (1) H1 = 1;", {}},
      {"while (5) H1 = 1;", {}},
      {"while (H0 | 1) H1 = 1;", {"W0253"}},
      {"while (H0 & 0) H1 = 1;", {"W0253"}},
      {"do H1 = 1; while (0);", {}},
      {"do H1 = 1; while (1);", {}},
      {"do H1 = 1; while (H0 & 0);", {"W0253"}},
      {"do H1 = 1; while (H0 | 1);", {"W0253"}},
      {"for (; 0;) H1 = 1;", {"W0253"}},
      {"for (; 1;) H1 = 1;", {}},
      {"for (;;) H1 = 1;", {}},
      {"for (; H0 | 1;) H1 = 1;", {"W0253"}},
      {"H0 = 0 ? H1 : H2;", {"W0253"}},
      {"H0 = H3 ? H1 : H2;", {}},
      {"1 ? H0++ : H1++;", {"W0253"}},
      {"H3 ? H0++ : H1++;", {}},
      {"H0 = (H1 & 0);", {}},
      {"\n#define ON 1\nif (ON) H1 = 1;", {}},
      {"\n#define OFF 0\nif (H1 && OFF) H1 = 1;", {}},
      {"\n#define OFF 0\nif (H1 & OFF) H1 = 1;", {}},
      {"\n#define ONE 1\nif ((H0 & 6) == ONE) H1 = 1;", {"W0253"}},
      {"\n#define WORD H0\nif (WORD & 0) H1 = 1;", {"W0253"}},
  };
  for (const auto& [statement, expected] : rows)
    EXPECT_EQ(codes("main() { " + std::string(statement) + " }"), expected) << statement;
}

TEST(Habits, BitsBindLessThanComparisons) {
  for (const char* bits : {"&", "^", "|"})
    for (const char* compare : {"<", "<=", ">", ">=", "==", "!="}) {
      const std::string b = " " + std::string(bits) + " ";
      const std::string c = " " + std::string(compare) + " ";
      const auto said = [](const std::string& value) { return codes("main() { H9 = " + value + "; }"); };
      EXPECT_EQ(said("H0" + b + "H1" + c + "H2"), Codes{"W0250"}) << b << c;
      EXPECT_EQ(said("H0" + c + "H1" + b + "H2"), Codes{"W0250"}) << b << c;
      EXPECT_EQ(said("H0" + b + "(H1" + c + "H2)"), Codes{}) << b << c;
      EXPECT_EQ(said("(H0" + c + "H1)" + b + "H2"), Codes{}) << b << c;
      EXPECT_EQ(said("(H0" + b + "H1)" + c + "H2"), Codes{}) << b << c;
      EXPECT_EQ(said("H0" + c + "H1" + b + "H2" + c + "H3"), Codes{}) << b << c;
      EXPECT_EQ(said("!H0" + b + "H1"), Codes{"W0250"}) << b;
      EXPECT_EQ(said("(!H0)" + b + "H1"), Codes{}) << b;
      EXPECT_EQ(said("!H0" + c + "H1"), Codes{"W0250"}) << c;
      EXPECT_EQ(said("!H0" + c + "!H1"), Codes{}) << c;
      EXPECT_EQ(said("!H0" + b + "!H1"), Codes{}) << b;
      EXPECT_EQ(said("-H0" + c + "H1"), Codes{}) << c;
      EXPECT_EQ(said("~H0" + b + "H1"), Codes{}) << b;
      for (const char* second : {"<", "<=", ">", ">=", "==", "!="}) {
        const std::string d = " " + std::string(second) + " ";
        const std::string chain = "H0" + c + "H1" + d + "H2";
        // Equality binds less: then the right one stands inside, and nothing is compared with 0 or 1 by mistake.
        const bool inner_right = (c == " == " || c == " != ") && d != " == " && d != " != ";
        EXPECT_EQ(said(chain), inner_right ? Codes{} : Codes{"W0251"}) << chain;
        EXPECT_EQ(said("(H0" + c + "H1)" + d + "H2"), Codes{}) << chain;
      }
    }
}

TEST(Habits, WhatIsZeroOrOneByItsForm) {
  for (const char* truth : {"0", "1", "!H2", "(H2 < H3)", "(H2 && H3)", "(H2 || H3)", "(H2 & 1)",
                            "((H2 >> 3) & 1)", "(!H2 & !H3)", "(H2 == 1 | H3 == 1)"})
    EXPECT_EQ(codes("main() { H9 = H0 == H1 & " + std::string(truth) + "; }"), Codes{}) << truth;
  for (const char* value : {"2", "-1", "H2", "~H2", "(H2 + H3)", "(H2 & 2)", "(H2 | 1)", "(H2 ^ 1)",
                            "(1 & H2)", "((H2 >> 3) & 2)", "(H2 ? 1 : 0)"}) {
    const Codes found = codes("main() { H9 = H0 == H1 & " + std::string(value) + "; }");
    EXPECT_EQ(std::count(found.begin(), found.end(), "W0250"), 1) << value;
  }
}

TEST(Habits, ShiftsBindLessThanSums) {
  for (const char* shift : {"<<", ">>"}) {
    const std::string s = " " + std::string(shift) + " ";
    for (const char* sum : {"+", "-"}) {
      const std::string p = " " + std::string(sum) + " ";
      EXPECT_EQ(codes("main() { H9 = H0" + s + "H1" + p + "H2; }"), Codes{"W0250"}) << s << p;
      EXPECT_EQ(codes("main() { H9 = H0" + p + "H1" + s + "H2; }"), Codes{"W0250"}) << s << p;
      EXPECT_EQ(codes("main() { H9 = H0" + s + "(H1" + p + "H2); }"), Codes{}) << s << p;
      EXPECT_EQ(codes("main() { H9 = (H0" + s + "H1)" + p + "H2; }"), Codes{}) << s << p;
    }
    for (const char* product : {"*", "/", "%"})
      EXPECT_EQ(codes("main() { H9 = H0" + s + "H1 " + product + " H2; }"), Codes{}) << s << product;
    EXPECT_EQ(codes("main() { H9 = !H0" + s + "H1; }"), Codes{}) << s;
  }
  for (const char* other : {"+", "-", "*", "/", "%", "&&", "||"})
    EXPECT_EQ(codes("main() { H9 = !H0 " + std::string(other) + " H1; }"), Codes{}) << other;
}

TEST(Habits, SignsBehindAssign) {
  const std::string head = "#define FIVE 5\n#define LESS -\nmain() { ";
  for (const char* meant : {"H0 =+ 5;", "H0 =- H1;", "H0 =! H1;", "H0 =* H1;", "H0 =-  5;"})
    EXPECT_EQ(codes(head + meant + " }"), Codes{"W0252"}) << meant;
  for (const char* good :
       {"H0 =+5;", "H0 =-H1;", "H0 =!H1;", "H0 =*H1;", "H0 = + 5;", "H0 = - H1;", "H0 =~ H1;", "H0 =(- H1);",
        "H0 +=- H1;", "H0 =-FIVE;", "H0 =- FIVE;", "H0 =LESS H1;", "H0 =5;", "H0 =++H1;", "H0 =H1 - 5;"})
    EXPECT_EQ(codes(head + good + " }"), Codes{}) << good;
}

TEST(Habits, EmptyLoopsInFrontOfABlock) {
  const std::pair<const char*, Codes> rows[] = {
      {"while (H0); { H1 = 1; }", {"W0254"}},
      {"H2 = 1; for (; H0;); { H1 = 1; }", {"W0254"}},
      {"{ H2 = 1; while (H0); { H1 = 1; } }", {"W0254"}},
      {"while (H0); { H1 = 1; } while (H2); { H3 = 1; }", {"W0254", "W0254"}},
      {"while (H0); H1 = 1;", {}},
      {"while (H0);", {}},
      {"while (H0); H1 = 1; { H2 = 1; }", {}},
      {"while (H0) { } { H1 = 1; }", {}},
      {"do ; while (H0); { H1 = 1; }", {}},
      {"H0 = 1; { H1 = 1; }", {}},
      {"if (H0) H2 = 1; { H1 = 1; }", {}},
  };
  for (const auto& [text, expected] : rows)
    EXPECT_EQ(codes("main() { " + std::string(text) + " }"), expected) << text;
}

TEST(Statements, ThatAreNeverReached) {
  const Codes never = {"W0203"};
  const std::pair<const char*, Codes> rows[] = {
      {"return; H0 = 1; H1 = 2;", never},
      {"return; ;", {}},
      {"{ return; } H0 = 1;", never},
      {"while (1); H0 = 1;", never},
      {"while (H1); H0 = 1;", {}},
      {"while (1) { break; } H0 = 1;", {}},
      {"while (1) { if (H1) break; } H0 = 1;", {}},
      {"while (1) { switch (H1) { default: break; } } H0 = 1;", never},
      {"while (1) { while (H1) break; } H0 = 1;", never},
      {"do H1++; while (1); H0 = 1;", never},
      {"do H1++; while (H1); H0 = 1;", {}},
      {"do { if (H1) break; } while (1); H0 = 1;", {}},
      {"for (;;) H1++; H0 = 1;", never},
      {"for (; 1;) H1++; H0 = 1;", never},
      {"for (; H1;) H1++; H0 = 1;", {}},
      {"for (;;) if (H1) break; H0 = 1;", {}},
      {"if (H1) return; H0 = 1;", {}},
      {"if (H1) return; else return; H0 = 1;", never},
      {"if (H1) return; else H2 = 1; H0 = 1;", {}},
      {"if (H1) H2 = 1; else return; H0 = 1;", {}},
      {"switch (H1) { case 1: return; default: return; } H0 = 1;", never},
      {"switch (H1) { case 1: return; case 2: return; } H0 = 1;", {}},
      {"switch (H1) { case 1: break; default: return; } H0 = 1;", {}},
      {"switch (H1) { case 1: return; default: H2 = 1; } H0 = 1;", {}},
      {"switch (H1) { H2 = 1; H3 = 1; case 1: ; }", never},
      {"switch (H1) { case 1: return; H2 = 1; H3 = 1; case 2: return; H4 = 1; }", {"W0203", "W0203"}},
      {"switch (H1) { case 1: return; break; }", {}},
      {"switch (H1) { case 1: return; while (H2) { case 2: H3 = 1; } H4 = 1; }", {}},
      {"switch (H1) while (H2) H3++; H0 = 1;", {}},
      {"while (H1) { continue; H0 = 1; }", never},
      {"while (H1) { break; H0 = 1; }", never},
      {"while (H1) { if (H2) continue; H0 = 1; }", {}},
      {"break; H0 = 1;", {"E0224"}},
      {"continue; H0 = 1;", {"E0224"}},
      {"switch (H1) { default: continue; H0 = 1; }", {"E0224"}},
      {"while (H1) switch (H2) { default: continue; }", {}},
  };
  for (const auto& [text, expected] : rows)
    EXPECT_EQ(codes("main() { " + std::string(text) + " }"), expected) << text;
}

TEST(Statements, EmptyBranches) {
  const std::pair<const char*, Codes> rows[] = {
      {"if (H0); H1 = 2;", {"W0205"}},
      {"if (H0); else H1 = 2;", {}},
      {"if (H0) { } H1 = 2;", {}},
      {"if (H0) H1 = 2; else;", {}},
      {"if (H0 = 1) H1 = 2;", {"W0204"}},
      {"if (H0 += 1) H1 = 2;", {}},
      {"if ((H0 = H2)) H1 = 2;", {}},
      {"do H1++; while (H0 = H2);", {"W0204"}},
      {"for (; H0 = H2;) H1++;", {"W0204"}},
      {"H1 = (H0 = H2) ? 1 : 2;", {}},
      {"switch (H0 = H2) { case 1: H1 = 2; }", {}},
      {"H0 == 1;", {"W0216"}},
      {"H0;", {"W0216"}},
      {"-H0, H1++;", {"W0216"}},
      {"H0++, H1;", {"W0216"}},
      {"-H0++;", {}},
      {"H1 + H0++;", {}},
      {"*(H0++);", {}},
      {"H0 ? H1++ : H2;", {"W0216"}},
      {"for (H0; H1; H2++) ;", {"W0216"}},
      {"for (H0++; H1; H2) ;", {"W0216"}},
  };
  for (const auto& [text, expected] : rows)
    EXPECT_EQ(codes("main() { " + std::string(text) + " }"), expected) << text;
}

TEST(Statements, CasesThatFallThrough) {
  CompileOptions options;
  ASSERT_TRUE(options.warnings.apply("fall-through"));
  const std::pair<const char*, size_t> rows[] = {
      {"case 1: H1 = 1; case 2: H2 = 1;", 1},
      {"case 1: H1 = 1; default: H2 = 1; case 2: H3 = 1;", 2},
      {"case 1: case 2: default: H2 = 1;", 0},
      {"case 1: H1 = 1; break; case 2: H2 = 1;", 0},
      {"case 1: return; case 2: H2 = 1;", 0},
      {"case 1: if (H1) return; case 2: H2 = 1;", 1},
      {"case 1: H1 = 1; // falls through\ncase 2: H2 = 1;", 0},
      {"case 1: H1 = 1; /* FALLTHROUGH */ case 2: H2 = 1;", 0},
      {"case 1: H1 = 1; /* goes on */ case 2: H2 = 1;", 1},
      {"/* falls through */ case 1: H1 = 1; case 2: H2 = 1;", 1},
      {"case 1: H1 = 1; case 2: /* falls through */ H2 = 1;", 1},
      {"case 1: H1 = 1; /* falls through */ NEXT H2 = 1;", 1},
  };
  for (const auto& [labels, expected] : rows) {
    const std::string source = "#define NEXT case 2:\nmain() { switch (H0) { " + std::string(labels) + " } }";
    const Compilation c = compile("t.IPC", "", source, options);
    EXPECT_EQ(c.diagnostics.all().size(), expected) << source;
    for (const Diagnostic& one : c.diagnostics.all()) EXPECT_EQ(one.diag, Diag::FallThrough);
  }
}

}  // namespace
}  // namespace ipos::compiler::test

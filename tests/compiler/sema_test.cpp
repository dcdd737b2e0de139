// Every message of the back end: its code, its place, and that nothing else is said.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "compiler/sema/map.hpp"
#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

// The message is expected at the '@' of the source, which is taken out before compiling.
struct Mistake {
  const char* code;
  std::string source;
  const char* contains = "";
  const char* unit = "md60a";
};

std::string repeated(const char* text, int count) {
  std::string out;
  for (int n = 0; n < count; ++n) out += text;
  return out;
}

std::string slow_objects(int count) {
  std::string out = "SCTRCYCL t[" + std::to_string(count) + "]; main() {";
  for (int n = 0; n < count; ++n) {
    const std::string object = "t[" + std::to_string(n) + "]";
    out += object + ".CycleTime = 100; " + object + ".ObjectNo = " + std::to_string(1024 + n) + ";";
    out += std::string(n + 1 == count ? "@" : "") + "_SBusCommDef(1, " + object + ");";
  }
  return "#pragma globals 300 399\n" + out + "}";
}

std::vector<Mistake> mistakes() {
  return {
      {"E0201", "long speed;\nmain() { @sped = 1; speed = 2; }", "sped"},
      {"E0201", "main() { H0 = @TargetPos; }", "TargetPos"},
      {"E0202", "main() { @_MoviLin(H0); }", "_MoviLin"},
      {"E0202", "main() { _SetTask2(1, @tsk); }", "tsk"},
      {"E0203", "SCREC r; main() { r.@Lenn = 1; r.Len = 1; }", "Lenn"},
      {"E0204", "long a, @a; main() { a = 1; }"},
      {"E0204", "f() { } @f() { } main() { f(); }"},
      {"E0204", "typedef struct { long x; long @x; } S; S s; main() { s.x = 1; }"},
      {"E0205", "long @H12; main() { }", "H12"},
      {"E0205", "long @_Wait; main() { }", "_Wait"},
      {"E0206", "main() { @late = 1; } long late;"},
      {"E0208", "f() { } main() { H0 = @f(); }"},
      {"E0209", "main() { @5 = 1; }"},
      {"E0209", "main() { @(H0 + 1)++; }"},
      {"E0210", "long a; main() { a.@x = 1; a = 1; }"},
      {"E0211", "long a; main() { @a[1] = 1; a = 1; }"},
      {"E0212", "SCREC r; main() { H0 = @r; r.Len = 1; }"},
      {"E0212", "long v[2]; main() { H0 = @v; v[0] = 1; }"},
      {"E0213", "f() { } main() { H0 = @f; f(); }"},
      {"E0214", "long a; main() { @a(); a = 1; }"},
      {"E0215", "main() { @_Wait(); }"},
      {"E0215", "f() { } main() { f(@1); f(); }"},
      {"E0216", "main() { _SBusCommDef(@9, H0); }", "SCD_TRCYCL, SCD_TRACYCL, SCD_REC"},
      {"E0216", "main() { _Go0(@H1); }"},
      {"E0217", "main() { _BitSet(@5, 1); }"},
      {"E0217", "long v[3], i; main() { i = 1; _Copy(@v[i], i, 1); }"},
      {"E0218", "main() { _SetTask2(1, @H0); }"},
      {"E0219", "main() { _BitSet(H0, @32); }", "0 to 31"},
      {"E0219", "main() { _Copy(H0, H510, @3); }", "1 to 2"},
      {"E0220", "long n; main() { switch (n) { case @n: ; } }"},
      {"E0220", "long v[@H0]; main() { }"},
      {"E0220", "main() { _BitSet(H0, @H1); }"},
      {"E0221", "main() { switch (H0) { case 1: ; @case 1: ; } }"},
      {"E0222", "main() { switch (H0) { default: ; @default: ; } }"},
      {"E0223", "main() { @case 1: ; }"},
      {"E0223", "main() { @default: ; }"},
      {"E0224", "main() { @break; }", "loop or switch"},
      {"E0224", "main() { switch (H0) { default: @continue; } }"},
      {"E0225", "main() { @H512 = 1; }", "H0 to H511"},
      {"E0225", "main() { @*-1 = 1; }"},
      {"E0225", "main() { H0 = @*1024; }", "H0 to H1023", "mdxb"},
      {"E0225", "#declare A @H511 + 1\nmain() { }"},
      {"E0225", "main() { _SBusCommDef(1, @H507); }"},
      {"E0226", "long v[@0]; main() { }"},
      {"E0227", "long v[3]; main() { v[@3] = 1; v[0] = 1; }", "0 to 2"},
      {"E0228", "@#pragma globals 452 420\nmain() { }"},
      {"E0228", "@#pragma globals 430 460\nmain() { }", "H453 to H560"},
      {"E0228", "@#pragma initials 0 H512\nmain() { }"},
      {"E0229", "long a[30], @b[4]; main() { a[0] = 1; b[0] = 1; }", "'#pragma globals 366 399'"},
      {"E0229", "initial long a[120], @b[9]; main() { a[0] = 1; b[0] = 1; }", "no 129 free variables"},
      {"E0231", "#pragma var 400 400\n@main() { H0 = H1 - (H2 - (H3 - H4 * H0)) * H5; }", "'#pragma var"},
      {"E0232", "main() { @H400 = 1; H0 = H1 * H2 + H0; }", "H400"},
      {"E0234", "@main() {" + repeated(" H0 = 1;", 1100) + "}", "2048"},
      {"E0235", "t() { H0++; } main() { @_SetTask(1, t); }", "task 3"},
      {"E0235", "VARINT v; t() { H0++; } main() { v.Control = 1; @_SetVarInterrupt(v, t); }",
       "variable interrupts"},
      {"E0237", "long v[@1 / 0]; main() { }"},
      {"E0238", "SCREC r; MLDATA d; main() { @r = d; r.Len = d.PO1; }"},
      {"E0239", "typedef struct { } @S; main() { }"},
      {"W0201", "long a, @b; main() { a = 1; }", "b"},
      {"W0202", "@f() { } main() { }"},
      {"W0203", "main() { return; @H0 = 1; }"},
      {"W0203", "main() { while (1) ; @H0 = 1; }"},
      {"W0203", "main() { switch (H0) { @H1 = 1; case 1: ; } }"},
      {"W0204", "main() { if (@H0 = 1) H1 = 2; }"},
      {"W0204", "main() { while (@H0 = H1) H2++; }"},
      {"W0205", "main() { if (H0)@; H1 = 2; }"},
      {"W0206", "main() { H0 = H1 / @0; }"},
      {"W0206", "main() { H0 %= @0; }"},
      {"W0207", "main() { @H473 = 1; }", "StatusWord"},
      {"W0207", "main() { @H473++; }"},
      {"W0208", "@#pragma var 400 430\nmain() { }"},
      {"W0209", "f() { @g(); } g() { f(); } main() { f(); }", "f -> g -> f"},
      {"W0210", "SCTRCYCL t; main() { @t.CycleTime = 15; _SBusCommDef(1, t); }", "15"},
      {"W0210", "SCTRCYCL t; main() { @t.CycleTime = 5; _SBusCommDef(1, t); }", "5", "mc07"},
      {"W0211", "SCTRCYCL t; main() { @t.ObjectNo = 2048; _SBusCommDef(1, t); }", "2048"},
      {"W0211", "SCREC r; main() { @r.ObjectNo = 515; _SBusCommDef(3, r); }", "address 0"},
      {"W0211",
       "SCREC r, s; main() { r.ObjectNo = 1025; @s.ObjectNo = 1025; _SBusCommDef(3, r); _SBusCommDef(3, s); "
       "}",
       "another object"},
      {"W0212", slow_objects(11), "10 transmit"},
      {"W0213", "SCREC r; main() { _SBusCommDef(1, @r); }", "SCTRCYCL"},
      {"W0214", "long a; main() { a = 1; @H420 = 2; }", "'a'"},
      {"W0215", "@#pragma initials 0 130\nmain() { }", "H130"},
      {"W0216", "main() { @H0 == 1; }"},
      {"W0217", "main() { H0 = H1 << @33; }", "shift by 1"},
      {"W0250", "main() { if (H0 @& 6 == H1) H2 = 1; }", "'&' binds less than '=='"},
      {"W0250", "main() { H2 = H0 == H1 @| H3; }", "(a == b) | c"},
      {"W0250", "main() { H2 = H0 @<< H1 + 1; }", "a << (b + c)"},
      {"W0250", "main() { if (@!H0 == H1) H2 = 1; }", "(!a) == b"},
      {"W0250", "main() { if (@!H0 & 8) H2 = 1; }", "(!a) & b"},
      {"W0251", "main() { if (H0 < H1 @< H2) H2 = 1; }", "&&"},
      {"W0251", "main() { H3 = H0 == H1 @== H2; }", "&&"},
      {"W0252", "main() { H0 @=+ 5; }", "is '+=' meant?"},
      {"W0252", "main() { H0 @=- H1; }", "is '-=' meant?"},
      {"W0252", "main() { H0 @=! H1; }", "is '!=' meant?"},
      {"W0252", "main() { H0 @=* 5; }", "is '*=' meant?"},
      {"W0253", "main() { if (@0) H0 = 1; }", "never"},
      {"W0253", "main() { if (@H1 == 1 || 2) H0 = 1; }", "always"},
      {"W0253", "main() { while (@H1 & 0) H0 = 1; }", "never"},
      {"W0253", "main() { if (@(H0 & 6) == 1) H1 = 1; }", "never"},
      {"W0253", "main() { if (@(H0 & 6) < 7) H1 = 1; }", "always"},
      {"W0253", "main() { do H0++; while (@(H0 > 1) != 2); }", "always"},
      {"W0253", "main() { H0 = @1 ? H1 : H2; }", "always"},
      {"W0254", "main() { while (H0)@; { H1 = 1; } }", "while"},
      {"W0254", "main() { for (H0 = 0; H0 < 3; H0++)@; { H1 = 1; } }", "for"},
      {"W0255", "#include <const.h>\nmain() { _AxisStop(@GO_WAIT); }", "AS_HCTRL"},
      {"W0255", "#include <const.h>\n#define MODE AS_RSTOP\nmain() { _GoAbs(@MODE, 4096); }", "GO_NOWAIT"},
      {"W0255", "#include <const.h>\nMOVLNK m; main() { m.BusType = @ML_FT_1; _MoviLink(m); }", "ML_BT_S0"},
      {"W0256", "SCREC r; long d; main() { d = 1; r.DPointer = @d; _SBusCommDef(3, r); }", "numof( d )"},
      {"W0257", "long @a; main() { H0 = a; }", "is read"},
      {"W0257", "long @v[3]; main() { H0 = v[H1]; }", "is read"},
      {"W0257", "SSPOSRAMP @r; main() { _SetSys(9, r); }", "given to '_SetSys'"},
      {"W0258", "long n; main() { _SetTask2(1, t); @n = n * 2 + 1; } t() { n = 5; }", "'t'"},
      {"W0259", "SCREC r; long d; main() { d = 1; r.DPointer = @423; _SBusCommDef(3, r); }", "numof( d )"},
      {"W0218", "#pragma var 300 310\n@#pragma var 311 320\nmain() { }"},
  };
}

class LocatedMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(LocatedMistakes, HaveOneMessageAtTheirPlace) {
  std::string source = GetParam().source;
  const size_t place = source.find('@');
  ASSERT_NE(std::string::npos, place);
  source.erase(place, 1);
  const auto line =
      static_cast<uint32_t>(1 + std::count(source.begin(), source.begin() + static_cast<long>(place), '\n'));
  const size_t line_start = place == 0 ? std::string::npos : source.rfind('\n', place - 1);
  const auto column = static_cast<uint32_t>(line_start == std::string::npos ? place + 1 : place - line_start);

  const Compilation c = compile_text(source, GetParam().unit);
  const std::string text = render_text(c.diagnostics.all(), *c.sources, false);
  ASSERT_EQ(1U, c.diagnostics.all().size()) << source << "\n" << text;
  const Diagnostic& found = c.diagnostics.all()[0];
  EXPECT_EQ(GetParam().code, info(found.diag).code) << text;
  const Position at = c.sources->position(found.span.begin);
  EXPECT_EQ(line, at.line) << text;
  EXPECT_EQ(column, at.column) << text;
  EXPECT_NE(std::string::npos, found.text.find(GetParam().contains)) << text;
  EXPECT_EQ(c.image.has_value(), GetParam().code[0] == 'W');
}

INSTANTIATE_TEST_SUITE_P(All, LocatedMistakes, testing::ValuesIn(mistakes()));

// The identifiers of MOVILINK: 1053 1610 p. 38; MOVITRAC 07 chapter 4.1 without PO-sync; MDX60B/61B p. 40
// with the second parameter channel. 0 is the sync telegram, from 1024 on they are free.
TEST(Mistakes, IdentifiersOfMovilinkByUnitType) {
  const std::vector<int> common = {3, 4, 6, 515, 516, 518};
  for (const auto& [unit, more] : {std::pair<const char*, std::vector<int>>{"md60a", {5}},
                                   {"compact", {5}},
                                   {"mc07", {}},
                                   {"mdxb", {5, 517, 519}}}) {
    std::set<int> expected = {0};
    for (int address = 0; address < 64; ++address) {
      for (const int function : common) expected.insert(8 * address + function);
      for (const int function : more) expected.insert(8 * address + function);
    }
    std::set<int> found;
    for (int first = 0; first < 2048; first += 64) {
      std::string source = "SCREC r; main() {\n";
      for (int id = first; id < first + 64; ++id) source += "r.ObjectNo = " + std::to_string(id) + ";\n";
      const Compilation c = compile_text(source + "_SBusCommDef(3, r); }", unit);
      for (const Diagnostic& d : c.diagnostics.all()) {
        ASSERT_EQ(info(d.diag).code, "W0211") << d.text;
        const int id = first + static_cast<int>(c.sources->position(d.span.begin).line) - 2;
        found.insert(id);
        if (id > 0) {
          EXPECT_NE(d.text.find("address " + std::to_string(id / 8 % 64)), std::string::npos) << d.text;
        }
      }
    }
    EXPECT_EQ(found, expected) << unit;
  }
}

// Those with a test of their own, below, in seen_steps_test.cpp and in machine_mistakes_test.cpp.
TEST(Mistakes, EveryRowOfTheTableIsTested) {
  std::set<std::string_view> tested{"E0207", "E0230", "E0233", "E0236", "W0240", "W0241", "W0260", "W0261", "N0219"};
  for (const Mistake& mistake : mistakes()) tested.insert(mistake.code);
  for (const DiagInfo& row : diagnostic_table())
    EXPECT_TRUE(row.code.substr(1, 2) != "02" || tested.contains(row.code) || (row.code >= "W0262" && row.code <= "W0299") || row.code == "W0242")
        << row.code << " " << row.name;
}

// A note: no option makes an error of it, and the program is good.
TEST(Mistakes, AVariableHidesAValueOfTheUnit) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view("mdxb"));
  options.is_unit_value = [](const stdlib::UnitType& unit, std::string_view name) {
    return unit.name == "mdxb" && name == "speed";
  };
  for (const char* option : {"all", "error", "no-all"}) {
    ASSERT_TRUE(options.warnings.apply(option));
    const Compilation c = compiler::compile("P.IPC", "P.IPC", "long speed, other; main() { speed = other; other = 1; }", options);
    ASSERT_EQ(1U, c.diagnostics.all().size()) << option;
    EXPECT_EQ(Diag::HidesUnitValue, c.diagnostics.all()[0].diag);
    EXPECT_EQ(compiler::Severity::Note, c.diagnostics.all()[0].severity);
    EXPECT_TRUE(c.image) << option;
  }
}

TEST(Mistakes, NoMain) {
  const Compilation c = compile_text("f() { }");
  ASSERT_EQ(1U, c.diagnostics.all().size());
  EXPECT_EQ(Diag::NoMain, c.diagnostics.all()[0].diag);
}

TEST(Mistakes, VariablesOfTwoRangesMeet) {
  EXPECT_EQ((std::vector<std::string>{"W0208", "E0230"}),
            codes("#pragma initials 100 127\n#pragma globals 120 140\n"
                  "initial long a[28]; long b; main() { a[0] = b; }"));
}

TEST(Mistakes, VariablesOfTwoRangesNameEachOther) {
  const Compilation c = compile_text(
      "#pragma initials 100 127\n#pragma globals 120 140\n"
      "initial long a[28]; long b, c[3]; main() { a[0] = b; b = c[1]; c[0] = 1; }");
  std::vector<std::string> texts;
  for (const Diagnostic& one : c.diagnostics.all()) {
    texts.push_back(one.text);
    for (const Note& note : one.notes) texts.push_back("  " + note.text);
  }
  // 21 numbers in a row, the highest below the system variables.
  EXPECT_EQ(
      texts,
      (std::vector<std::string>{
          "range H100 to H127 of initials overlaps range H120 to H140 of globals",
          "'b' and 'a' both get H120; '#pragma globals 432 452' makes room", "  'a' is declared here",
          "'c' and 'a' both get H121; '#pragma globals 432 452' makes room", "  'a' is declared here"}));
}

TEST(Mistakes, RecursionThatLosesATemporary) {
  EXPECT_EQ((std::vector<std::string>{"W0209", "E0233"}),
            codes("long a, b; f() { a = a * b + (f(), b); } main() { b = 2; f(); }"));
}

TEST(Mistakes, UnitWithoutPrograms) {
  const Compilation c = compile_text("main() { }", "mc31");
  ASSERT_EQ(1U, c.diagnostics.all().size());
  EXPECT_EQ(Diag::NoProgram, c.diagnostics.all()[0].diag);
}

TEST(Mistakes, AllIndependentOnesInOneRun) {
  // x is reported once.
  EXPECT_EQ((std::vector<std::string>{"E0201", "E0227", "E0201", "E0224", "E0202"}),
            codes("long v[2];\nmain() {\n  x = 1;\n  v[2] = 1;\n  y = x;\n  break;\n  v[0] = 5 + f();\n}\n"));
}

std::string first_note(const std::string& source) {
  const Compilation c = compile_text(source);
  if (c.diagnostics.all().empty() || c.diagnostics.all()[0].notes.empty()) return "";
  return c.diagnostics.all()[0].notes[0].text;
}

TEST(Suggestions, ForMisspeltNames) {
  EXPECT_EQ("did you mean 'speed'?", first_note("long speed; main() { sped = 1; }"));
  EXPECT_EQ("did you mean 'ObjectNo'?", first_note("SCREC r; main() { r.ObjectNr = 1; }"));
  EXPECT_EQ("did you mean '_MoviLink'?", first_note("main() { _MovLink(H0); }"));
  EXPECT_EQ("did you mean 'helper'?", first_note("helper() { } main() { Helper(); }"));
  EXPECT_EQ("", first_note("long speed; main() { xyz = 1; }"));
  EXPECT_EQ("did you mean '_GoAbs'?", first_note("main() { _GoAbsolute(1, 2); }"));
  EXPECT_EQ("did you mean 'TargetPos'?", first_note("main() { H0 = TargetPosition; }"));
  EXPECT_EQ("did you mean 'H5'?", first_note("main() { h5 = 1; }"));
  EXPECT_EQ("did you mean 'numof'?", first_note("main() { H0 = nunof(1); }"));
  EXPECT_EQ("did you mean 'break'?", first_note("main() { while (H0) Break; }"));
  EXPECT_EQ("did you mean 'ML_FT_PAR3'?", first_note("main() { H0 = ML_FT_PR3; }"));
  EXPECT_EQ("did you mean 'main' here?", first_note("Main() { H0 = 1; }"));
  EXPECT_NE(std::string::npos, first_note("main() { H0 = DI03; }").find("#include <io.h>"));
  EXPECT_EQ("MLDATA has WritePar, ReadPar, PO1, PO2, PO3, PI1, PI2, PI3",
            first_note("MLDATA d; main() { d.zzzzzz = 1; }"));
  EXPECT_EQ("did you mean '#define'?", first_note("#defin A 1\nmain() { }"));
  EXPECT_EQ("did you mean 'const.h'?", first_note("#include <const>\nmain() { }"));
  const Compilation goabs = compile_text("main() { _GoAbs(1); }");
  ASSERT_EQ(2U, goabs.diagnostics.all().at(0).notes.size());
  EXPECT_EQ("the keyword is one of GO_NOWAIT, GO_WAIT", goabs.diagnostics.all()[0].notes[1].text);
}

TEST(Suggestions, TellAnIncludeWithOtherCapitals) {
  CompileOptions options;
  options.read_file = [](const std::string&) { return std::nullopt; };
  options.list_files = [](const std::string& folder) {
    return folder == "lib/" ? std::vector<std::string>{"Own.h"} : std::vector<std::string>{};
  };
  const Compilation c = compile("t.IPC", "t.IPC", "#include \"lib/own.h\"\nmain() { }", options);
  ASSERT_EQ(1U, c.diagnostics.all().size());
  EXPECT_EQ("did you mean 'lib/Own.h'?", c.diagnostics.all()[0].notes.at(0).text);
}

TEST(Suggestions, NameTheBraceByItsIndentation) {
  const Compilation c =
      compile_text("main()\n{\n  while (H0) {\n    H1 = 1;\n  H2 = 2;\n}\nf()\n{\n  H3 = 1;\n}\n");
  ASSERT_FALSE(c.diagnostics.all().empty());
  ASSERT_FALSE(c.diagnostics.all()[0].notes.empty());
  EXPECT_EQ(3U, c.sources->position(c.diagnostics.all()[0].notes[0].span.begin).line);
}

std::string first_text(const std::string& source) {
  const Compilation c = compile_text(source);
  return c.diagnostics.all().empty() ? "" : c.diagnostics.all()[0].text;
}

TEST(Messages, SayWhatWasMeant) {
  EXPECT_EQ("'_SBusCommOn' is a function; '_SBusCommOn()' calls it", first_text("main() { _SBusCommOn; }"));
  EXPECT_EQ("'main' is a function; numof( ... ) takes variables", first_text("main() { H0 = numof(main); }"));
  EXPECT_NE(std::string::npos,
            first_text("main() { H5000000000 = 1; }").find("variable H5000000000 does not exist"));
  EXPECT_NE(std::string::npos,
            first_text("SCREC m; MLDATA d; main() { m.DPointer = d; }").find("numof( d )"));
  EXPECT_NE(std::string::npos, first_text("SCREC p[2], q; main() { p[H0] = q; }")
                                   .find("with a constant index it is copied as a whole"));
  EXPECT_NE(std::string::npos,
            first_text("main() { H400 = 1; H0 = H1 * H2 + H0; }").find("is used here by number"));
  EXPECT_LT(first_text("long x[" + std::string(100'000, 'n') + "];\nmain() { }").size(), 2000U);
}

TEST(Messages, OfRangesWithoutRoomHaveNoConsequences) {
  const Compilation c =
      compile_text("long a[40]; long b[40]; SCREC s; main() { a[0] = 1; b[0] = 2; s.Format = 1; }", "mdxb");
  ASSERT_EQ(1U, c.diagnostics.all().size()) << render_text(c.diagnostics.all(), *c.sources, false);
  EXPECT_EQ(Diag::RangeOverflow, c.diagnostics.all()[0].diag);
  std::string many;
  for (int n = 0; n < 140; ++n) many += "long v" + std::to_string(n) + "[500];";
  EXPECT_NE(std::string::npos, first_text(many + "main() { }").find("need at least 65535 numbers"));
  EXPECT_NE(std::string::npos, first_note("main() { H0 = GO_WAIT; }").find("#include <const.h>"));
  EXPECT_NE(std::string::npos, first_note("main() { H0 = TargetPos; }").find("H492"));
}

TEST(Correct, NoMessageFor) {
  const char* const sources[] = {
      "main() { while (!H483); }",
      "main() { if ((H0 = H1)) H2++; }",
      "main() { switch (H0) { case 1: return; break; default: H1 = 1; } }",
      "initial long a; main() { a++; }",
      "#pragma list\n#pragma globals H130 140\nlong a; main() { a = numof(a); }",
      "long v[3]; main() { _Copy(v, H0, 3); }",
      "typedef struct { long a[2]; SCREC r; } S; S s[2]; main() { s[1].r.Len = s[H0].a[1]; }",
      "main() { f(); } f() { H0++; }",
      "SCREC r; main() { r.Len = 8; r.Format = 8; _SBusCommDef(3, r); }",
      "SCREC r; main() { r.ObjectNo = 0x1000000 | 1025; _SBusCommDef(3, r); }",
      "main() { for (H0 = 0, H1 = 5; H0 < H1; H0++, H1--) ; }",
      "main() { H0 ? f() : g(); } f() { H1++; } g() { H2++; }",
      "main() { switch (H0) { while (H1) { case 1: H1--; } } }",
      // What the warnings about habits leave alone.
      "main() { if (H0 == 1 & H1 == 2 | !H2) H3 = 1; }",
      "#include <iob.h>\nmain() { if (DI01 & DI02 == 0 & !DI03) H3 = 1; }",
      "main() { if ((H0 & 6) == 4) H3 = 1; if ((H0 & 6) > 3) H3 = 2; if ((H0 < H1) == (H1 < H2)) H3 = 3; }",
      "main() { H0=-5; H0 =-5; H0 = +5; H0 =~H1; H0 = !H1; H0 =*H1; }",
      "#define WITH 0\nmain() { if (WITH) H0 = 1; if (WITH && H1) H0 = 2; while (1) { H2++; } }",
      "main() { do { H0++; } while (0); for (;;) { H1++; } }",
      "main() { while (H0); H1 = 1; for (H0 = 0; H0 < 5; H0++) ; }",
      "#include <const.h>\n#define MODE GO_WAIT\nmain() { _GoAbs(MODE, 1); _GoRel(GO_NOWAIT, H0); "
      "_AxisStop(3); }",
      "#include <const.h>\nMOVLNK m; MLDATA d; main() { m.BusType = 5; m.Service = 1; m.Format = ML_CFT_PAR1; m.DPointer = numof(d); "
      "_MoviLink(m); "
      "H0 = d.ReadPar; }",
      "SCREC r; long p, d; main() { p = numof(d); r.DPointer = p; d = 1; _SBusCommDef(3, r); }",
      "SCREC r; long a, b; main() { r.DPointer = numof(a); _SBusCommDef(3, r); H0 = b; }",
      "initial long set; main() { H1 = set; }",
      "long n; main() { _SetTask2(1, t); n = n + 1; n += H0 * 2; } t() { n = 5; }",
      "long n; main() { n = n * 2 + 1; n = n % 8 + 3; }",
  };
  for (const char* source : sources) {
    const Compilation c = compile_text(source, "mdxb");
    EXPECT_EQ("", render_text(c.diagnostics.all(), *c.sources, false)) << source;
  }
}

TEST(Correct, AnIncludedFileMayHaveMoreThanIsUsed) {
  CompileOptions options;
  options.read_file = [](const std::string&) {
    return std::optional<std::string>("used() { H0++; } spare() { H1++; }");
  };
  EXPECT_TRUE(
      compile("t.IPC", "t.IPC", "#include \"lib.h\"\nmain() { used(); }", options).diagnostics.all().empty());
}

TEST(Warnings, AreSwitchedByTheirFlags) {
  CompileOptions options;
  EXPECT_TRUE(options.warnings.apply("no-unused-variable"));
  EXPECT_TRUE(compile("t.IPC", "", "long a; main() { }", options).diagnostics.all().empty());
  CompileOptions strict;
  EXPECT_TRUE(strict.warnings.apply("error=unused-variable"));
  EXPECT_FALSE(compile("t.IPC", "", "long a; main() { }", strict).image);
}

std::vector<std::string> codes_with(const char* flag, const std::string& source) {
  CompileOptions options;
  EXPECT_TRUE(options.warnings.apply(flag));
  std::vector<std::string> out;
  const Compilation c = compile("t.IPC", "", source, options);
  for (const Diagnostic& one : c.diagnostics.all()) out.emplace_back(info(one.diag).code);
  return out;
}

TEST(Warnings, OfFallingThroughAreAskedFor) {
  const std::string source =
      "main() { switch (H0) { case 1: case 2: H1 = 1; /*COMMENT*/ case 3: H2 = 1; break; default: ; } }";
  EXPECT_EQ(std::vector<std::string>{}, codes(source));
  EXPECT_EQ(std::vector<std::string>{"W0260"}, codes_with("fall-through", source));
  EXPECT_EQ(std::vector<std::string>{"W0260"}, codes_with("all", source));
  std::string meant = source;
  meant.replace(meant.find("COMMENT"), 7, "Falls through");
  EXPECT_EQ(std::vector<std::string>{}, codes_with("fall-through", meant));
}

TEST(Warnings, OfSeveralWritersAreAskedFor) {
  const std::string source = "long n; main() { _SetTask2(1, t); set(); } t() { n = 5; } set() { n = 1; }";
  EXPECT_EQ(std::vector<std::string>{}, codes(source));
  EXPECT_EQ(std::vector<std::string>{"W0261"}, codes_with("several-writers", source));
  EXPECT_EQ(std::vector<std::string>{},
            codes_with("several-writers",
                       "long n; main() { _SetTask2(1, t); set(); } t() { H0 = n; } set() { n = 1; }"));
}

TEST(Allocation, FollowsTheWatchWindow) {
  // 1053 1610 p. 57, figure 36: H420..H432.
  const Compilation c = compile_text(
      "SCTRCYCL TrCycl; long lTrDataLow; long lTrDataHigh; SCREC Rec; long lReDataLow; long lReDataHigh;"
      "initial long kept; main() { lTrDataLow = lTrDataHigh; lReDataLow = lReDataHigh; kept = 1;"
      "_SBusCommDef(1, TrCycl); _SBusCommDef(3, Rec); }");
  ASSERT_TRUE(c.image);
  std::vector<std::string> names;
  for (const vm::Symbol& symbol : c.image->symbols)
    names.push_back(std::to_string(symbol.variable) + " " + symbol.name);
  EXPECT_EQ(
      (std::vector<std::string>{"0 kept", "420 TrCycl.ObjectNo", "421 TrCycl.CycleTime", "422 TrCycl.Offset",
                                "423 TrCycl.Format", "424 TrCycl.DPointer", "425 TrCycl.Result",
                                "426 lTrDataLow", "427 lTrDataHigh", "428 Rec.ObjectNo", "429 Rec.Format",
                                "430 Rec.DPointer", "431 lReDataLow", "432 lReDataHigh"}),
      names);
}

TEST(Allocation, MapNamesReadersAndWriters) {
  const Compilation c = compile_text("long a, p; f() { a = 1; } main() { f(); H5 = a; p = numof(a); }");
  ASSERT_EQ(3U, c.map.size());
  EXPECT_EQ("H5", c.map[0].name);
  EXPECT_EQ("raw", c.map[0].range);
  EXPECT_EQ((std::vector<std::string>{"main"}), c.map[0].writers);
  EXPECT_EQ("a", c.map[1].name);
  EXPECT_EQ(420U, c.map[1].number);
  EXPECT_EQ("globals", c.map[1].range);
  EXPECT_EQ((std::vector<std::string>{"main"}), c.map[1].readers);
  EXPECT_EQ((std::vector<std::string>{"f"}), c.map[1].writers);
  EXPECT_EQ((std::vector<std::string>{"main"}), c.map[1].takers);
  EXPECT_NE(std::string::npos, map_text(c.map).find("H420"));
}

TEST(Allocation, AdviceForGlobalsWorks) {
  const std::string text = "long a[30], b[4]; main() { a[0] = 1; b[0] = 1; }";
  const std::string message = compile_text(text).diagnostics.all().at(0).text;
  const size_t begin = message.find('\'') + 1;
  EXPECT_TRUE(compile_text(message.substr(begin, message.find('\'', begin) - begin) + "\n" + text).image)
      << message;
}

}  // namespace
}  // namespace ipos::compiler::test

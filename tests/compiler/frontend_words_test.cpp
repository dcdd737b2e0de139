// Words and signs of other languages are read as what was meant, names that only look like them are left alone; and
// the limits of nesting and of errors, to the last one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>

#include "compiler/preprocess/word_filter.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

// Read as `right` is, with these codes said on the way.
void expect_read_as(const std::string& wrong, const std::string& right,
                    const std::vector<std::string>& codes) {
  FrontendRun meant(right);
  meant.parse();
  FrontendRun run(wrong);
  std::vector<std::string> found;
  for (const std::string& message : run.parse().messages()) found.push_back(message.substr(0, 5));
  EXPECT_EQ(found, codes) << wrong;
  EXPECT_EQ(shape_of_program(run), shape_of_program(meant)) << wrong;
}

void expect_statement_read_as(const std::string& wrong, const std::string& right,
                              const std::vector<std::string>& codes) {
  expect_read_as("main() { " + wrong + " }", "main() { " + right + " }", codes);
}

// What was added is always found, in capitals, too; a word of another length or beginning is told from it.
TEST(FrontendWords, FilterKnowsItsWords) {
  compiler::WordFilter none;
  compiler::WordFilter words;
  const std::vector<std::string> all = {"a", "switch", "Z9_", "_Wait", std::string(31, 'n'), std::string(32, 'n'), std::string(40, 'n')};
  for (const std::string& word : all) words.add(word);
  for (std::string word : all) {
    EXPECT_FALSE(none.may_have(word)) << word;
    EXPECT_TRUE(words.may_have(word)) << word;
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::toupper(c); });
    EXPECT_TRUE(words.may_have(word)) << word;
  }
  EXPECT_FALSE(words.may_have("switches"));
  EXPECT_FALSE(words.may_have("twitch"));
  EXPECT_FALSE(words.may_have(""));
}

// A macro of every length is replaced, and one that is undefined again is not.
TEST(FrontendWords, MacrosOfEveryLength) {
  for (size_t length = 1; length <= 32; ++length) {
    const std::string name(length, 'm');
    expect_read_as("#define " + name + " 5\nlong x; main() { x = " + name + "; }", "long x; main() { x = 5; }", {});
    expect_read_as("#define " + name + " 5\n#undef " + name + "\nlong " + name + "; main() { " + name + " = 5; }",
                   "long " + name + "; main() { " + name + " = 5; }", {});
  }
}

TEST(FrontendWords, OperatorsOfPlcs) {
  const std::vector<std::string> one = {"E0181"};
  for (const auto& [word, sign] : {std::pair<const char*, const char*>{"AND", "&&"},
                                   {"or", "||"},
                                   {"Xor", "^"},
                                   {"MOD", "%"},
                                   {"div", "/"}}) {
    const std::string w = " " + std::string(word) + " ";
    const std::string s = " " + std::string(sign) + " ";
    for (const char* left : {"a", "5", "(a)", "v[1]", "f.x"})
      for (const char* right : {"b", "7", "(b)", "numof(b)", "!b", "-b", "~b", "numof(v)"})
        expect_statement_read_as("x = " + std::string(left) + w + right + ";",
                                 "x = " + std::string(left) + s + right + ";", one);
    // A name like the word stands where no operator can.
    for (const std::string& name :
         {"x = " + std::string(word) + " + 1;", std::string(word) + " = 1;", "x = " + std::string(word) + ";",
          "x." + std::string(word) + " = 1;", std::string(word) + "();", "x = 1 + " + std::string(word) + ";",
          "x = a * " + std::string(word) + " - b;"})
      expect_statement_read_as(name, name, {});
  }
  expect_statement_read_as("x = NOT y;", "x = !y;", one);
  expect_statement_read_as("if (Not y) z;", "if (!y) z;", one);
  expect_statement_read_as("if (NOT (y)) z;", "if (!(y)) z;", one);
  expect_statement_read_as("if (NOT numof(y)) z;", "if (!numof(y)) z;", one);
  expect_statement_read_as("x = not;", "x = not;", {});
  expect_statement_read_as("x = not + 1;", "x = not + 1;", {});
  expect_statement_read_as("not();", "not();", {});
  expect_statement_read_as("x := 5;", "x = 5;", one);
  expect_statement_read_as("if (x <> 5) y;", "if (x != 5) y;", one);
  expect_statement_read_as("x = a ? b : c;", "x = a ? b : c;", {});
  expect_statement_read_as("x = a AND b OR NOT c;", "x = a && b || !c;", {"E0181", "E0181", "E0181"});
}

// Forms of several words: what is told, and what the rest is read as. Nothing else is said of the program.
struct Form {
  const char* wrong;
  const char* right;
  std::string told;
};

TEST(FrontendForms, AreReadAsWhatWasMeant) {
  const Form forms[] = {
      {"const long MAX = 5; main() { H0 = MAX; }", "main() { H0 = 5; }", "'const' belongs to another language; write '#define MAX 5'"},
      {"static const int A = 0x10, B = -2; main() { H0 = A + B; }", "main() { H0 = 0x10 + -2; }",
       "'const' belongs to another language; write '#define A 0x10' and '#define B -2'"},
      {"enum { IDLE, RUN }; main() { switch (H0) { case IDLE: break; case RUN: H1 = RUN; } }",
       "main() { switch (H0) { case 0: break; case 1: H1 = 1; } }",
       "'enum' belongs to another language; write '#define IDLE 0' and '#define RUN 1'"},
      {"enum State { IDLE = 3, RUN, STOP = -1, } s; enum State t; main() { t = RUN; s = STOP; }",
       "long s; long t; main() { t = 4; s = -1; }",
       "'enum' belongs to another language; write '#define IDLE 3' and '#define RUN 4' and so on"},
      {"typedef enum { OFF, ON } SWITCH; SWITCH a; main() { a = ON; }", "long a; main() { a = 1; }",
       "'enum' belongs to another language; write '#define OFF 0' and '#define ON 1'"},
      {"long a; main() { a = 1; (* x * y; *) }", "long a; main() { a = 1; }",
       "'(*' belongs to another language; comments are '/* ... */' or '// ...'"},
      {"main() { switch (H0) { case 1 ... 3: H1 = 1; } }", "main() { switch (H0) { case 1: H1 = 1; } }",
       "'...' belongs to another language; each value has a case of its own: write 'case 1: ... case 3:'"},
      {"main() { _Wait(5s); }", "main() { _Wait(5000); }", "'5s' belongs to another language; times are numbers of milliseconds: write 5000"},
      {"a : DINT := 5; main() { a = 1; }", "long a; main() { a = 1; }", "'a : DINT' belongs to another language; write 'long a;'"},
      {"FUNCTION_BLOCK FB1\nmain() { H0 = 1; }", "main() { H0 = 1; }", "'FUNCTION_BLOCK' belongs to another language; write 'FB1() { ... }'"},
      {"main() { H0 = 16#FF; }", "main() { H0 = 255; }", "'16#FF' belongs to another language; write 0xFF"},
      {"main() { H0 = 16#1A_00; }", "main() { H0 = 6656; }", "'16#1A_00' belongs to another language; write 0x1A_00"},
      {"main() { H0 = 2#1010; }", "main() { H0 = 10; }", "'2#1010' belongs to another language; write 0b1010"},
      {"main() { H0 = 8#17; }", "main() { H0 = 15; }", "'8#17' belongs to another language; write 15"},
      {"main() { H0 = T#1s; }", "main() { H0 = 1000; }", "'T#1s' belongs to another language; times are numbers of milliseconds: write 1000"},
      {"main() { H0 = time#1m30s; }", "main() { H0 = 90000; }",
       "'time#1m30s' belongs to another language; times are numbers of milliseconds: write 90000"},
      {"main() { H0 = T#250ms; }", "main() { H0 = 250; }", "'T#250ms' belongs to another language; times are numbers of milliseconds: write 250"},
      {"long a; main() { a.3 = 1; }", "long a; main() { a = 1; }", "'a.3' belongs to another language; write '_BitSet(a, 3)'"},
      {"long v[4]; main() { v[2].31 = 0; }", "long v[4]; main() { v[2] = 0; }",
       "'v[2].31' belongs to another language; write '_BitClear(v[2], 31)'"},
      {"long v[4], w[4]; main() { v[w[1]].3 = 1; }", "long v[4], w[4]; main() { v[w[1]] = 1; }",
       "'v[w[1]].3' belongs to another language; write '_BitSet(v[w[1]], 3)'"},
      {"typedef struct { long x; } S; S s[2]; main() { s[1].x.3 = 1; }", "typedef struct { long x; } S; S s[2]; main() { s[1].x = 1; }",
       "'s[1].x.3' belongs to another language; write '_BitSet(s[1].x, 3)'"},
      {"main() { if (H483.2) H1 = 2; }", "main() { if (H483) H1 = 2; }", "'H483.2' belongs to another language; bit 2 of it is 'H483 & 0x4'"},
      {"main() { _BitSet(H481.1); }", "main() { _BitSet(H481, 1); }", "'H481.1' belongs to another language; write '_BitSet(H481, 1)'"},
      {"VAR a, b : INT; c : ARRAY [0..3] OF DINT := 5; END_VAR main() { a = b; }", "long a, b; long c; main() { a = b; }",
       "'VAR' belongs to another language; variables are declared outside of functions: 'long a;'"},
      {"var_global retain n : int end_var; main() { n = 1; }", "long n; main() { n = 1; }",
       "'var_global' belongs to another language; variables are declared outside of functions: 'long n;'"},
  };
  for (const Form& form : forms) {
    FrontendRun meant(form.right), run(form.wrong);
    meant.parse();
    run.parse();
    ASSERT_EQ(run.diagnostics.all().size(), 1U) << form.wrong;
    EXPECT_EQ(run.diagnostics.all()[0].text, form.told) << form.wrong;
    EXPECT_EQ(shape_of_program(run), shape_of_program(meant)) << form.wrong;
  }
}

// Names and signs that only look like such a form stay what they are.
TEST(FrontendForms, LeaveProgramsAlone) {
  for (const char* program :
       {"long VAR; main() { VAR = 1; }", "long T; main() { T = 1; H0 = T; }", "main() { VAR(); } VAR() { }",
        "long a; typedef struct { long x; } S; S s; main() { s.x = a; }", "long a, b; main() { a = b ** 2; }"})
    expect_read_as(program, program, {});
  // What is not whole is told as before.
  expect_read_as("main() { H0 = .5; }", "main() { H0 = 0; }", {"E0108"});
  expect_read_as("main() { H0 = 1.5; }", "main() { H0 = 0; }", {"E0108"});
}

TEST(FrontendForms, MisspeltCase) {
  expect_statement_read_as("switch (x) { csae 1: y; break; caes LIMIT: z; }", "switch (x) { case 1: y; break; case LIMIT: z; }",
                           {"E0180", "E0180"});
}

// The ';' behind the brackets of an `if` is shown where its `else` has none.
TEST(FrontendForms, ElseBehindAnEmptyIf) {
  FrontendRun run("main() {\n  if (H0 > 1); H1 = 1;\n  else H1 = 2;\n}");
  run.parse();
  ASSERT_EQ(run.diagnostics.all().size(), 1U);
  const compiler::Diagnostic& error = run.diagnostics.all()[0];
  ASSERT_EQ(error.notes.size(), 1U);
  const compiler::Position at = run.map.position(error.notes[0].span.begin);
  EXPECT_EQ(std::pair(at.line, at.column), std::pair(2U, 14U));
  FrontendRun other("main() {\n  if (H0) { H1 = 1; }\n  H2 = f(H1);\n  else H1 = 2;\n}");
  other.parse();
  EXPECT_TRUE(other.diagnostics.all()[0].notes.empty());
}

TEST(FrontendWords, BlocksOfPlcs) {
  const std::vector<std::string> one = {"E0181"};
  const std::vector<std::string> two = {"E0181", "E0181"};
  for (const char* statement : {"y = 1;", "{ y = 1; }", "while (y) z;", "for (;;) z;", "break;", "5;"})
    expect_statement_read_as("if (x) THEN " + std::string(statement), "if (x) " + std::string(statement),
                             one);
  expect_statement_read_as("if (x) then();", "if (x) then();", {});
  expect_statement_read_as("then = 1;", "then = 1;", {});
  expect_statement_read_as("while (x) BEGIN y = 1; END", "while (x) { y = 1; }", two);
  expect_statement_read_as("while (x) BEGIN y = 1; END;", "while (x) { y = 1; }", two);
  expect_statement_read_as("while (x) begin y = 1; z = 2; end z = 3;", "while (x) { y = 1; z = 2; } z = 3;",
                           two);
  expect_statement_read_as("if (x) y; else BEGIN y = 1; END", "if (x) y; else { y = 1; }", two);
  expect_statement_read_as("do BEGIN y = 1; END while (x);", "do { y = 1; } while (x);", two);
  expect_statement_read_as("while (x) BEGIN while (y) BEGIN z; END; END; z = 1;",
                           "while (x) { while (y) { z; } } z = 1;", {"E0181", "E0181", "E0181", "E0181"});
  expect_statement_read_as("begin = 1; end = 2;", "begin = 1; end = 2;", {});
  expect_statement_read_as("end(); begin();", "end(); begin();", {});
  expect_statement_read_as("while (x) BEGIN y = end; END", "while (x) { y = end; }", two);
  for (const char* end : {"END_IF", "end_while", "End_For", "END_CASE", "endif"}) {
    expect_statement_read_as("while (x) y = 1; " + std::string(end) + "; z = 1;", "while (x) y = 1; z = 1;",
                             one);
    expect_statement_read_as(std::string(end) + " = 1;", std::string(end) + " = 1;", {});
    expect_statement_read_as("x = " + std::string(end) + ";", "x = " + std::string(end) + ";", {});
    expect_statement_read_as(std::string(end) + "();", std::string(end) + "();", {});
  }
}

TEST(FrontendWords, KeywordsInOtherLetters) {
  const std::vector<std::string> one = {"E0180"};
  for (const auto& [wrong, right] :
       {std::pair<const char*, const char*>{"IF (x) y;", "if (x) y;"},
        {"WHILE (x) y;", "while (x) y;"},
        {"For (x;;) y;", "for (x;;) y;"},
        {"SWITCH (x) { case 1: y; }", "switch (x) { case 1: y; }"},
        {"if (x) y; ELSE z;", "if (x) y; else z;"},
        {"if (x) { } Else { z; }", "if (x) { } else { z; }"},
        {"DO y; while (x);", "do y; while (x);"},
        {"if (x) Do { y; } while (x);", "if (x) do { y; } while (x);"},
        {"switch (x) { CASE 1: y; }", "switch (x) { case 1: y; }"},
        {"switch (x) { Case n: y; }", "switch (x) { case n: y; }"},
        {"switch (x) { case 1: CASE 2: y; }", "switch (x) { case 1: case 2: y; }"},
        {"switch (x) { DEFAULT: y; }", "switch (x) { default: y; }"},
        {"x = NUMOF(y);", "x = numof(y);"},
        {"if (x) WHILE (y) z;", "if (x) while (y) z;"}})
    expect_statement_read_as(wrong, right, one);
  for (const char* name : {"If = 1;", "While();", "For++;", "x = Else;", "Else();", "Do = 1;", "x = Case;",
                           "Default = 1;", "x.If = 1;", "Numof();", "Numof = 1;", "x = If + 1;", "Long = 1;",
                           "Switch(x);", "x = y ? Default : z;", "While(x) + 1;"})
    expect_statement_read_as(name, name, {});
  expect_read_as(
      "Long a;\nINITIAL long b;\nInitial SCREC c;\nTYPEDEF struct { LONG d; } T;\ntypedef STRUCT { long e; } "
      "U;",
      "long a;\ninitial long b;\ninitial SCREC c;\ntypedef struct { long d; } T;\ntypedef struct { long e; } "
      "U;",
      {"E0180", "E0180", "E0180", "E0180", "E0180", "E0180"});
  expect_read_as("typedef struct { long a; } Long;\nLong b;\nmain() { }",
                 "typedef struct { long a; } Long;\nLong b;\nmain() { }", {});
  expect_read_as("#declare While H5\n#declare If While\nmain() { While = If; }",
                 "#declare While H5\n#declare If While\nmain() { While = If; }", {});
}

// The two signs of `:=` and `<>` belong together only where nothing is between them; and outside of a function no word is
// a keyword of a statement.
TEST(FrontendWords, OnlyWhatIsWrittenTogetherIsOneSign) {
  const auto codes_of = [](const std::string& source) {
    std::string codes;
    for (const std::string& message : messages_of(source)) codes += message.substr(0, 5) + " ";
    return codes;
  };
  for (const char* statement : {"x : = 5;", "x :\n= 5;", "x :/* */= 5;", "x :\\\n= 5;", "if (x < > 5) y;",
                                "if (x <\n> 5) y;", "if (x </* */> 5) y;"})
    EXPECT_EQ(codes_of("main() { " + std::string(statement) + " }").find("E0181"), std::string::npos)
        << statement;
  for (const char* statement :
       {"x := 5;", "x\n:= 5;", "x :=\n5;", "if (x <> 5) y;", "if (x\n<> 5) y;", "if (x <>\n5) y;"})
    EXPECT_EQ(codes_of("main() { " + std::string(statement) + " }"), "E0181 ") << statement;
  for (const char* outside : {"IF (x) y;", "WHILE (x) y;", "FOR (x;;) y;", "SWITCH (x) { }", "ELSE x;",
                              "DO x;", "CASE 1: x;", "DEFAULT: x;", "whlie (x) y;"}) {
    EXPECT_EQ(codes_of(outside).find("E0180"), std::string::npos) << outside;
    EXPECT_EQ(codes_of("main() { }\n" + std::string(outside)).find("E0180"), std::string::npos) << outside;
    EXPECT_EQ(codes_of("main() { while (x) BEGIN y; END }\n" + std::string(outside)).find("E0180"),
              std::string::npos)
        << outside;
  }
  expect_statement_read_as("while (x) BEGIN IF (y) z; END WHILE (x) y;",
                           "while (x) { if (y) z; } while (x) y;", {"E0181", "E0180", "E0181", "E0180"});
}

// `initial` stands in front of long, or of the name of a type and that of a variable, wherever that is.
TEST(FrontendWords, InitialInOtherLetters) {
  const std::vector<std::string> one = {"E0180"};
  for (const char* before : {"", "long a; ", "SCREC r; ", "main() { } ", "long a, b[2]; ", ";"})
    for (const char* behind : {"long c;", "SCREC c;", "SCREC c, d;", "long c[3];"})
      for (const char* word : {"Initial", "INITIAL", "initiaL"})
        expect_read_as(std::string(before) + word + " " + behind, std::string(before) + "initial " + behind,
                       one);
  for (const char* before : {"", "long a; ", "SCREC r; ", "long a, b; "})
    for (const char* name : {"Initial b;", "Initial() { }", "long Initial;"})
      for (const std::string& message : messages_of(before + std::string(name)))
        EXPECT_NE(message.substr(0, 5), "E0180") << before << name;
}

TEST(FrontendWords, MisspeltHeadsOfStatements) {
  const std::vector<std::string> one = {"E0180"};
  for (const auto& [wrong, right] : {std::pair<const char*, const char*>{"whlie (x) y;", "while (x) y;"},
                                     {"fro (x;;) y;", "for (x;;) y;"},
                                     {"swtich (x) { case 1: y; }", "switch (x) { case 1: y; }"},
                                     {"wihle ((x) && (y)) { z; }", "while ((x) && (y)) { z; }"},
                                     {"forr (x;;) 5;", "for (x;;) 5;"},
                                     {"whil (x) if (y) z;", "while (x) if (y) z;"}})
    expect_statement_read_as(wrong, right, one);
  for (const char* call : {"whlie(x);", "whlie();", "fro(x) + 1;", "x = whlie;", "whlie = 1;"})
    expect_statement_read_as(call, call, {});
  // 500 tokens of a head are looked at, its brackets among them.
  const auto head = [](int sums) {
    std::string out = "main() { whlie (x";
    for (int n = 0; n < sums; ++n) out += " + x";
    return messages_of(out + ") y; }");
  };
  EXPECT_EQ(head(248).front(), "E0180 1:10");
  EXPECT_NE(head(249).front().substr(0, 5), "E0180");
}

std::string times(const std::string& text, int count) {
  std::string all;
  for (int n = 0; n < count; ++n) all += text;
  return all;
}

// 256 nodes within each other are the deepest tree.
TEST(FrontendDepthLimit, IsTheSameForEveryConstruct) {
  struct Construct {
    const char* before;
    const char* repeated;
    const char* inside;
    const char* closing;
    const char* after;
  };
  const Construct constructs[] = {{"x = ", "- ", "1", "", ";"},        {"x = ", "!", "1", "", ";"},
                                  {"x = 1", " + 1", "", "", ";"},      {"", "x = ", "1", "", ";"},
                                  {"x = ", "1 ? 2 : ", "3", "", ";"},  {"x", ".m", "", "", ";"},
                                  {"x", "[1]", "", "", ";"},           {"", "x[", "1", "]", ";"},
                                  {"1", ", 1", "", "", ";"},           {"", "if (x) ", ";", "", ""},
                                  {"", "if (x) ; else ", ";", "", ""}, {"", "while (x) ", ";", "", ""},
                                  {"", "do ", ";", " while (x);", ""}, {"", "for (;;) ", ";", "", ""},
                                  {"", "switch (x) ", "y;", "", ""},   {"x = ", "*", "y", "", ";"},
                                  {"x = ", "(", "1", ")", ";"}};
  for (const Construct& one : constructs) {
    const auto said = [&](int count) {
      return messages_of("main() { " + std::string(one.before) + times(one.repeated, count) + one.inside +
                         times(one.closing, count) + one.after + " }");
    };
    // A statement is in the block of its function, an expression may have all 256 for itself.
    EXPECT_EQ(said(254), Messages{}) << one.repeated;
    const Messages found = said(256);
    ASSERT_EQ(found.size(), 1U) << one.repeated;
    EXPECT_EQ(found[0].substr(0, 5), "E0176") << one.repeated;
  }
}

// Levels outside and inside of any construct count together.
TEST(FrontendDepthLimit, CountsThroughEveryConstruct) {
  const auto filled = [](std::string form, const std::string& inside) {
    return form.replace(form.find('%'), 1, inside);
  };
  for (const char* form :
       {"f(%)",   "f(a, %)", "f(%, a)", "v[%]",     "(a ? % : b)", "(a ? b : %)", "(% ? a : b)",
        "(%, a)", "(a, %)",  "(a = %)", "(a += %)", "(v[%] = a)",  "(% + a)",     "(a + %)",
        "*%",     "(%).m",   "(%)[1]",  "++*%",     "(*%)++",      "!%",          "numof(*%)"}) {
    const auto said = [&](int outside, int inside) {
      return messages_of("main() { x = " + times("- ", outside) + filled(form, times("- ", inside) + "y") +
                         "; }");
    };
    EXPECT_EQ(said(100, 100), Messages{}) << form;
    const Messages found = said(150, 150);
    ASSERT_EQ(found.size(), 1U) << form;
    EXPECT_EQ(found[0].substr(0, 5), "E0176") << form;
  }
  for (const char* form : {"{ % }", "{ a; % }", "{ % a; }", "if (c) %", "if (c) % else ;", "if (c) ; else %",
                           "while (c) %", "do % while (c);", "for (;;) %", "switch (c) %"}) {
    const auto said = [&](int outside, int inside) {
      return messages_of("main() { " + times("while (x) ", outside) +
                         filled(form, times("while (x) ", inside) + ";") + " }");
    };
    EXPECT_EQ(said(100, 100), Messages{}) << form;
    const Messages found = said(150, 150);
    ASSERT_EQ(found.size(), 1U) << form;
    EXPECT_EQ(found[0].substr(0, 5), "E0176") << form;
  }
}

TEST(FrontendErrorLimits, StopAfterAHundred) {
  for (int count = 98; count <= 103; ++count) {
    const Messages found = messages_of("main() {\n" + times("x = ;\n", count) + "}");
    ASSERT_EQ(found.size(), count < 100 ? static_cast<size_t>(count) : 101U) << count;
    EXPECT_EQ(found.back().substr(0, 5), count >= 100 ? "E0177" : "E0150") << count;
  }
}

TEST(FrontendErrorLimits, NameStrayBytes) {
  const auto said = [](const std::string& text) {
    FrontendRun run("main() { " + text + " x = 1; }");
    run.parse();
    std::string out;
    for (const auto& one : run.diagnostics.all()) out += one.text + "\n";
    return out;
  };
  EXPECT_EQ(said("@"), "'@' has no meaning here\n");
  EXPECT_EQ(said("\x01"), "the byte 0x01 has no meaning here\n");
  EXPECT_EQ(said("\x1F"), "the byte 0x1F has no meaning here\n");
  EXPECT_EQ(said("\x7F"), "the byte 0x7F has no meaning here\n");
  EXPECT_EQ(said("\x1A"), "the byte 0x1A has no meaning here\n");
  EXPECT_EQ(said("`"), "'`' has no meaning here\n");
  EXPECT_EQ(said("$$$"), "'$' has no meaning here\n") << "a run is one mistake";
  EXPECT_EQ(said("$ $"), "'$' has no meaning here\n'$' has no meaning here\n");
  EXPECT_EQ(said("$\n$"), "'$' has no meaning here\n'$' has no meaning here\n");
}

}  // namespace
}  // namespace ipos::tests

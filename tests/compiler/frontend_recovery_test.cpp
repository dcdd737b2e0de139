// Where the parser goes on behind a syntax error: what stands behind the mistake is read as if the mistake had not been
// made, and no second message follows from it. And which '{' is blamed when a '}' is missing.
#include <gtest/gtest.h>

#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

struct RecoveryRow {
  const char* wrong;
  const char* read;  // what is left of it
  std::vector<std::string> codes = {"E0150"};
};

void expect_recovery(const RecoveryRow& row, const std::string& head, const std::string& tail) {
  const std::string source = head + row.wrong + tail;
  FrontendRun left(head + row.read + tail);
  left.parse();
  FrontendRun run(source);
  std::vector<std::string> found;
  for (const std::string& message : run.parse().messages()) found.push_back(message.substr(0, 5));
  EXPECT_EQ(found, row.codes) << source;
  EXPECT_EQ(shape_of_program(run), shape_of_program(left)) << source;
}

TEST(FrontendRecovery, GoesOnBehindAStatement) {
  const RecoveryRow rows[] = {
      {"x = ; y;", "y;"},
      {"x = 1\n y;", "y;"},
      {"x = (1; y;", "y;"},
      {"x = a[1; y;", "y;"},
      {"f(; y;", "y;"},
      {"f(a, ; y;", "y;"},
      {"x = (a[(1; y;", "y;"},
      {"x = 1 + ) y; z;", "z;"},
      {"x = = ; y;", "y;"},
      {"x = a ? b; y;", "y;"},
      {"x = a ? ; y;", "y;"},
      {") x; y;", "y;"},
      {"] ] ]; y;", "y;"},
      {"x = 1 2; y;", "y;"},
      {"x.; y;", "y;"},
      {"goto ; y;", "y;"},
      {"break x; y;", "y;"},
      {"numof x; y;", "y;"},
      {"{ x = 1 } y;", "{ } y;"},
      {"{ x = } y;", "{ } y;"},
      {"{ x = (1 } y;", "{ } y;"},
      {"while (a) { x = ; } y;", "while (a) { } y;"},
      {"while (a) { x = ; z; } y;", "while (a) { z; } y;"},
      {"f(x) { y; } z;", "{ y; } z;"},
      {"f() { y; } z;", "{ y; } z;", {"E0163"}},
      {"x = 1 { y; }\n z;", "z;"},
      {"x = { y; w; }; z;", "z;"},
      {"switch (a) { case : x; y; }", "switch (a) { y; }"},
      {"switch (a) { case 1 x; y; }", "switch (a) { y; }"},
      {"switch (a) { default 1; y; }", "switch (a) { y; }"},
      {"\n#pragma globals 1\n y;", "y;", {"E0178"}},
      {"\n#pragma var ( 1\n y;", "y;", {"E0178"}},
      {"\n#pragma globals 1\n x = ; y;", "y;", {"E0178", "E0150"}},
      {"\n#declare X\n y;", "y;", {"E0179"}},
      {"\n#declare X ; ; (\n y;", "y;", {"E0179"}},
      {"x = 1 +\n#pragma list\n y;", "\n#pragma list\n y;"},
      {"x = (1 +\n#declare X H1\n y;", "\n#declare X H1\n y;"},
  };
  for (const RecoveryRow& row : rows) expect_recovery(row, "main() { ", " }");
}

TEST(FrontendRecovery, GoesOnAtTheWordOfTheNextStatement) {
  for (const char* next : {"if (y) z;", "for (;;) z;", "while (y) z;", "do z; while (y);",
                           "switch (y) { case 1: z; }", "break;", "continue;", "return;"}) {
    expect_recovery({("x = 1 " + std::string(next)).c_str(), next}, "main() { ", " }");
    expect_recovery({("x = (1 " + std::string(next)).c_str(), next}, "main() { ", " }");
    expect_recovery({("x = 1 2 " + std::string(next)).c_str(), next}, "main() { ", " }");
  }
  const RecoveryRow rows[] = {
      {"if (a) x = 1 else y; z;", "if (a) ; else y; z;"},
      {"switch (a) { case 1: x = 1 case 2: y; }", "switch (a) { case 1: case 2: y; }"},
      {"switch (a) { case 1: x = 1 default: y; }", "switch (a) { case 1: default: y; }"},
      {"x = 1 goto e; y;", "y;", {"E0150", "E0161"}},
      {"x = 1 2 goto e; y;", "y;", {"E0150", "E0161"}},
      {"x = 1\nlong a; y;", "\nlong a; y;", {"E0150", "E0154"}},
      {"x = 1 2\nlong a; y;", "\nlong a; y;", {"E0150", "E0154"}},
      {"x = 1 2\ninitial long a; y;", "\ninitial long a; y;", {"E0150", "E0154"}},
      {"x = 1 long a; y;", "y;"},
      {"x = 1 2 long a; y;", "y;"},
      {"x = 1 2 initial long a; y;", "y;"},
  };
  for (const RecoveryRow& row : rows) expect_recovery(row, "main() { ", " }");
}

// A name at a line start behind an operand: the ';' is missing between them.
TEST(FrontendRecovery, GoesOnAtALineBehindAnOperand) {
  const RecoveryRow rows[] = {
      {"5 5\n y; z;", "y; z;"},        {"5 5 5\n y; z;", "y; z;"},    {"5 a\n y; z;", "y; z;"},
      {"5 (a)\n y; z;", "y; z;"},      {"5 a[1]\n y; z;", "y; z;"},   {"5 a++\n y; z;", "y; z;"},
      {"5 a--\n y; z;", "y; z;"},      {"5 a)\n y; z;", "y; z;"},     {"5 a +\n y; z;", "z;"},
      {"5 (a,\n y); z;", "z;"},        {"5 (a\n y); z;", "z;"},       {"5 5 y; z;", "z;"},
      {"5 5\n 6; z;", "z;"},           {"5 (a) ((b)\n y); z;", "z;"}, {"5 a =\n y; z;", "z;"},
      {"5 5 { w; }\n y; z;", "y; z;"}, {"5 5 { w; } y; z;", "z;"},
  };
  for (const RecoveryRow& row : rows) expect_recovery(row, "main() { ", " }");
}

// The parser may ask for a token again behind an error.
TEST(FrontendRecovery, TellsOnceWhatIsWrongInAToken) {
  const std::pair<const char*, std::string> rows[] = {
      {"0h->e}", "E0106"},       {"    0bed15", "E0106"}, {".2", "E0108"},
      {" 99999999999.", "E0108"}, {"99999999999;", "E0107"}, {"'a' + }", "E0110"},
      {"\"a\" + }", "E0109"},    {"a\xE4 + }", "E0105"},    {"  'x", "E0102"},
  };
  for (const auto& [source, code] : rows) {
    FrontendRun run(source);
    std::vector<std::string> told;
    for (const std::string& message : run.parse().messages())
      if (message.starts_with(code)) told.push_back(message);
    EXPECT_EQ(told.size(), 1U) << source;
  }
}

TEST(FrontendRecovery, GoesOnBehindAHead) {
  const RecoveryRow rows[] = {
      {"if (x { y; } z;", "if (0) { y; } z;"},
      {"if (x y; z;", "if (0) ; z;"},
      {"{ if (x } z;", "{ if (0) ; } z;"},
      {"{ y; while (x } z;", "{ y; while (0) ; } z;"},
      {"{ for (;x } z;", "{ for (;;) ; } z;"},
      {"{ switch } z;", "{ switch (0) ; } z;"},
      {"{ if (x) } z;", "{ if (x) ; } z;"},
      {"{ do } z;", "{ } z;"},
      {"{ if (x) y; else } z;", "{ if (x) y; } z;"},
      {"if (x y) z; w;", "if (0) z; w;"},
      {"if x) y; z;", "if (0) y; z;"},
      {"if ) y; z;", "if (0) y; z;"},
      {"if x { y; } z;", "if (0) { y; } z;"},
      {"if x y; z;", "if (0) ; z;"},
      {"if () y; else z;", "if (0) y; else z;"},
      {"if (x if (y) z; w;", "if (0) if (y) z; w;"},
      {"if (x while (y) z; w;", "if (0) while (y) z; w;"},
      {"if (x return; w;", "if (0) return; w;"},
      {"while (x y) z; w;", "while (0) z; w;"},
      {"while (f(x) y; z;", "while (0) ; z;"},
      {"while (f(x y)) z; w;", "while (0) z; w;"},
      {"while ((x y)) z; w;", "while (0) z; w;"},
      {"while (a[(x y)) z; w;", "while (0) z; w;"},
      {"while x (y) z; w;", "while (0) z; w;"},
      {"while x; z;", "while (0) ; z;"},
      {"switch (x { case 1: y; } z;", "switch (0) { case 1: y; } z;"},
      {"switch x { case 1: y; } z;", "switch (0) { case 1: y; } z;"},
      {"do x; y; z;", "z;"},
      {"do x; while (a) y; z;", "z;"},
      {"do x; while (a)\n y; z;", "y; z;"},
      {"do x; while (a) if (b) y; z;", "if (b) y; z;"},
      {"do x; while (a b); y;", "do x; while (0); y;"},
      {"for (a; b) y; z;", "for (;;) y; z;"},
      {"for (a) y; z;", "for (;;) y; z;"},
      {"for () y; z;", "for (;;) y; z;"},
      {"for (a; b; c d) y; z;", "for (;;) y; z;"},
      {"for (a b; c; d) y; z;", "for (;;) y; z;"},
      {"for (a; f(b c); d) y; z;", "for (;;) y; z;"},
      {"for (a, b; c; d { y; } z;", "for (;;) { y; } z;"},
      {"for (a b; c; d { y; } z;", "for (;;) { y; } z;"},
      {"for a; b; c) y; z;", "for (;;) y; z;"},
      {"for (a b; c; d if (y) z; w;", "for (;;) if (y) z; w;"},
      {"if (a) while (b c) d; e;", "if (a) while (0) d; e;"},
      {"if (a) if (b) for (c) d; else e; f;", "if (a) if (b) for (;;) d; else e; f;"},
  };
  for (const RecoveryRow& row : rows) expect_recovery(row, "main() { ", " }");
}

TEST(FrontendRecovery, GoesOnAtADeclaration) {
  const RecoveryRow rows[] = {
      {"long a b;", ""},
      {"long a b, d;", ""},
      {"long 5;", ""},
      {"long a\n", ""},
      {"long a = ;", ""},
      {"long a = 1 2;", ""},
      {"long a = { 1, };", ""},
      {"long a = { { 1 }, };", ""},
      {"long a[;", ""},
      {"long a[2 3];", ""},
      {"= 5;", ""},
      {"= 5", ""},
      {"5;", "", {"E0151"}},
      {"x = 1;", "", {"E0151"}},
      {"x = 1; y = 2; z();", "", {"E0151"}},
      {"while (1) { x = 1; }", "", {"E0151"}},
      {"while (1) { { x = 1; } }", "", {"E0151"}},
      {"if (f(1)) { x = 1; } else { y; }", "", {"E0151"}},
      {"f(1);", "", {"E0151"}},
      {"}", "", {"E0153"}},
      {"} }", "", {"E0153"}},
      {"Foo a;", "", {"E0169"}},
      {"typedef long T;", "", {"E0171"}},
      {"typedef SCREC T;", "", {"E0171"}},
      {"typedef union { long a; } U;", "", {"E0171"}},
      {"struct B { long b; };", "", {"E0170"}},
      {"typedef struct { long a; } ;", ""},
      {"typedef struct { long a } T;", "typedef struct { } T;"},
      {"typedef struct { long a; 5; long b; } T;", "typedef struct { long a; long b; } T;"},
      {"typedef struct { long a b; long c; } T;", "typedef struct { long c; } T;"},
      {"foo { x; }", ""},
      {"foo { x = ; }", "", {"E0150", "E0150"}},
      {"foo( { x = ; }", "", {"E0150", "E0150"}},
      {"foo(a { x = ; }", "", {"E0150", "E0150"}},
      {"foo(a, (b) { x = ; }", "", {"E0150", "E0150"}},
      {"foo(void) { x = ; }", "", {"E0158", "E0150"}},
      {"foo(long a, SCREC b) { x = ; }", "", {"E0158", "E0150"}},
      {"foo bar() { x = ; }", "", {"E0169", "E0150"}},
      {"foo() x = ; }", "", {"E0150", "E0150"}},
      {"foo() if (a) { x = ; } y; }", "", {"E0150", "E0150"}},
      {"foo() x = (1); y = ; }", "", {"E0150", "E0150"}},
      {"foo() x[(1)] = 2; y = ; }", "", {"E0150", "E0150"}},
      {"foo() if (a) x; y = ; }", "", {"E0150", "E0150"}},
      {"long while (1) x;\nfoo bar() { y = ; }", "", {"E0150", "E0169", "E0150"}},
      {"#pragma globals 1\n", "", {"E0178"}},
      {"#pragma globals ) x; {\n", "", {"E0178"}},
      {"#declare X\n", "", {"E0179"}},
      {"#declare X ( long c;\n", "", {"E0179"}},
      {"long a =\n#pragma list\n", "#pragma list\n"},
      {"while (1) {\n#pragma list\n}\n", "", {"E0151"}},
  };
  // Whatever may come next is recognized.
  for (const char* next :
       {"long c;", "initial long c;", "typedef struct { long c; } C;", "\nmain() { }", "\nSCREC c;"})
    for (const RecoveryRow& row : rows) {
      expect_recovery(row, "", std::string(" ") + next);
      expect_recovery(row, "long before;\n", std::string(" ") + next);
      expect_recovery(row, "before() { }\n", std::string(" ") + next);
    }
  // Words of C that begin a declaration, and a name behind a ';'.
  for (const char* type :
       {"int", "void", "char", "short", "unsigned", "signed", "float", "double", "enum", "union"})
    expect_recovery({"= 5 ", "", {"E0150", "E0155"}}, "", std::string(type) + " c;");
  for (const char* word : {"const", "static", "extern", "volatile"})
    expect_recovery({"= 5 ", "", {"E0150", "E0156"}}, "", std::string(word) + " long c;");
  expect_recovery({"= 5; ", "", {"E0150"}}, "", "SCREC c;");
  expect_recovery({"= 5; ", "", {"E0150"}}, "", "main() { }");
  expect_recovery({"= 5 main() { x = ; }", "", {"E0150", "E0150"}}, "", " long c;");
}

// The line of the '{' in the note, and its words.
std::string blamed_brace(const std::string& source) {
  FrontendRun run(source);
  run.parse();
  if (run.diagnostics.all().size() != 1 || run.diagnostics.all()[0].notes.size() != 1)
    return std::to_string(run.diagnostics.all().size()) + " messages";
  const compiler::Note& note = run.diagnostics.all()[0].notes[0];
  const compiler::Position begin = run.map.position(note.span.begin);
  const compiler::Position end = run.map.position(note.span.end);
  return std::to_string(begin.line) + ":" + std::to_string(begin.column) + "-" + std::to_string(end.column) +
         " " + note.text;
}

TEST(FrontendMissingBrace, IsThatOfTheBlockWhoseLinesHaveEnded) {
  const std::string indented = " by the indentation this '{' is the one that is not closed";
  const std::string open = " to match this '{'";
  const std::pair<const char*, std::string> rows[] = {
      // A '}' further left than the head belongs to a block around it; one as deep is its own.
      {"main() {\n if (a) {\n  x;\n}\n", "2:9-10" + indented},
      {"main() {\n if (a) {\n  x;\n }\n", "1:8-9" + open},
      {"main() {\n if (a) {\n  x;\n  }\n", "1:8-9" + open},
      // Any other line as far left as the head has left the block.
      {"main() {\n if (a) {\n  x;\n y;\n}\n", "2:9-10" + indented},
      {"main() {\n if (a) {\n  x;\ny;\n}\n", "2:9-10" + indented},
      {"main() {\n if (a) {\n  x;\n  y;\n }\n", "1:8-9" + open},
      {"main() {\n  if (a) {\n   while (b) {\n    x;\n   y;\n   }\n}\n", "3:14-15" + indented},
      // Labels and an opening brace stand where they like; the end of the file says nothing.
      {"main() {\n switch (a) {\n case 1:\n  x;\n default:\n  y;\n", "2:13-14" + open},
      {"main() {\n switch (a) {\ncase 1:\n  x;\ndefault:\n  y;\n", "2:13-14" + open},
      {"main()\n{\n if (a)\n {\n  x;\n }\n", "2:1-2" + open},
      {"main()\n{\n if (a)\n {\n  x;\n  }\n  if (b)\n  {\n", "8:3-4" + open},
      {"main() {\n x;\n", "1:8-9" + open},
      {"main() { if (a) { x;\n", "1:17-18" + open},
      {"main() { if (a) { x; }\n", "1:8-9" + open},
      {"main() {\n if (a) { x; }\n if (b) { y;\n z;\n}\n", "3:9-10" + indented},
  };
  for (const auto& [source, expected] : rows) EXPECT_EQ(blamed_brace(source), expected) << source;
  // A function inside of a function.
  EXPECT_EQ(blamed_brace("main() {\n x;\nfoo() {\n y;\n}\n"), "1:8-9" + indented);
  EXPECT_EQ(blamed_brace("main() { foo() { y; } x; }"), "1:8-9 this '{' is still open");
  EXPECT_EQ(blamed_brace("main() { if (a) { foo() { y; } } x; }"), "1:17-18 this '{' is still open");
}

TEST(FrontendMissingBrace, ExcusesDeclarationsAtTheLineStart) {
  EXPECT_EQ(messages_of("main() {\n if (a) {\n x;\n}\nlong y;\nfoo() { }"), Messages{"E0163 6:1"});
  EXPECT_EQ(messages_of("main() {\n if (a) {\n x;\n}\n long y;\nfoo() { }"),
            (Messages{"E0154 5:2", "E0163 6:1"}));
  EXPECT_EQ(messages_of("main() {\nlong y;\n}"), Messages{"E0154 2:1"});
  EXPECT_EQ(messages_of("main() {\nlong y;\n} }"), (Messages{"E0154 2:1", "E0153 3:3"}));
  EXPECT_EQ(messages_of("long y; }\nmain() {\nlong z;\n"), (Messages{"E0153 1:9", "E0154 3:1", "E0150 3:8"}));
}

// A brace that is missing is told once, until all are closed again.
TEST(FrontendMissingBrace, IsToldOnce) {
  EXPECT_EQ(messages_of("main() {\n x;\nfoo() {\n y;\n}\nbar() {\n z;\n}\n"), Messages{"E0163 3:1"});
  EXPECT_EQ(messages_of("main() {\n f() { }\n}\nmain2() {\n g() { }\n}\n"),
            (Messages{"E0163 2:2", "E0163 5:2"}));
}

TEST(FrontendRecovery, MistakesOfMembersAreTold) {
  EXPECT_EQ(
      messages_of(
          "typedef struct { int a; long b = 5; long *c; long d[2][3]; const long e; const int f; long SCREC; "
          "unsigned long int g, *h; } T;\nT t;"),
      (Messages{"E0155 1:18", "E0164 1:32", "E0165 1:42", "E0166 1:55", "E0156 1:60", "E0155 1:80",
                "E0156 1:74", "E0167 1:92", "E0155 1:99", "E0165 1:120"}));
}

TEST(FrontendRecovery, DepthIsToldOnceInAFile) {
  std::string sum = "x = 1";
  for (int n = 0; n < 300; ++n) sum += " + 1";
  const Messages found = messages_of("main() { " + sum + "; " + sum + "; y = ; }");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], "E0176 1:14") << "the sum";
  EXPECT_EQ(found[1].substr(0, 5), "E0150");
}

}  // namespace
}  // namespace ipos::tests

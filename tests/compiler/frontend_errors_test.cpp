// Every message of the front end at its place, and recovery: each mistake once, nothing that follows from it.
#include <gtest/gtest.h>

#include <set>

#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

struct Case {
  const char* what;
  std::string source;
  Messages expected;
};

void PrintTo(const Case& one, std::ostream* out) { *out << one.what; }

// Body of a function in line 1; column 10 is its first.
std::string body(const std::string& text) { return "main() { " + text + " }"; }

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"open comment", "x; /* a", {"E0101 1:4", "E0151 1:1"}},
      {"open text", body("x = \"abc;\n y = 2;"), {"E0102 1:14"}},
      {"open character", body("x = 'a;\n y = 2;"), {"E0102 1:14"}},
      {"keywords in capitals",
       "Long x;\nMain() { While (x) x = 1; If (x == 2) { x = 3; } Else x = 4; Switch (x) { Case 1: ; "
       "Default: ; } }",
       {"E0180 1:1", "E0180 2:10", "E0180 2:27", "E0180 2:50", "E0180 2:62", "E0180 2:75", "E0180 2:85"}},
      {"keyword misspelt",
       body("whlie (x > 2) x = 1; fro (x = 0; x < 2; x++) y = 2;"),
       {"E0180 1:10", "E0180 1:31"}},
      {"names like keywords",
       "long Long, If, mod, end, then, begin, not, and;\nmain() { Long = If + mod * end - then; begin = "
       "(not & and) + end; mod = -1; Else(); } Else() { }",
       {}},
      {"operators of PLC",
       body("x := 5; if (x <> 1 AND NOT y OR (x MOD 2 = 1)) y = x div 2;"),
       {"E0181 1:12", "E0181 1:24", "E0181 1:29", "E0181 1:33", "E0181 1:39", "E0181 1:45", "E0181 1:63"}},
      {"condition of PLC",
       body("IF x <> 1 THEN y = 1;"),
       {"E0180 1:10", "E0181 1:15", "E0181 1:20", "E0150 1:13"}},
      {"blocks of PLC",
       body("if (x == 1) THEN BEGIN y = 1; END; while (y) x = 1; END_IF;"),
       {"E0181 1:22", "E0181 1:27", "E0181 1:40", "E0181 1:62"}},
      {"utf-16", std::string("\xFF\xFEm\0a\0", 6), {"E0103 1:1"}},
      {"characters", body("@@ x = 1 $ ; `;"), {"E0104 1:10", "E0104 1:19", "E0104 1:23"}},
      {"hash", body("x = # 1;"), {"E0104 1:14"}},
      {"letter", body("Dr\xC3\xBC = 1; \xE4 = 2;"), {"E0105 1:10", "E0105 1:20"}},
      {"letter in macro", "#define \xE4 1", {"E0105 1:9"}},
      {"number", body("x = 12ab + 0b2;"), {"E0106 1:14", "E0106 1:21"}},
      {"large", body("x = 2147483648 - 2147483648 - 2147483649;"), {"E0107 1:14", "E0107 1:40"}},
      {"fraction", body("x = 1.5;"), {"E0108 1:14"}},
      {"text", body("x = \"a\" \"b\";"), {"E0109 1:14"}},
      {"character", body("x = 'a';"), {"E0110 1:14"}},
      {"long name", "long " + std::string(33, 'n') + ";", {"W0101 1:6"}},
      {"continued comment", "// C:\\\n", {"W0102 1:6"}},
      {"comment in comment", "/* a /* b */", {"W0103 1:6"}},

      {"directive", "#foo x\n# 12", {"E0120 1:1", "E0120 2:1"}},
      {"no name", "#define\n#undef 5\n#ifdef\n#endif", {"E0121 1:1", "E0121 2:8", "E0121 3:1"}},
      {"macro parameters", "#define F(x) x\nlong F;", {"E0122 1:9"}},
      {"include form", "#include\n#include foo\n#include <>", {"E0123 1:1", "E0123 2:10", "E0123 3:10"}},
      {"include missing", "#include <no> x\n", {"W0123 1:15", "E0124 1:10"}},
      {"include cycle", "#include \"t.IPC\"", {"E0125 t.IPC:1:10"}},
      {"if open", "#if 1\n#ifdef A\n", {"E0128 1:1", "E0128 2:1"}},
      {"no if", "#else\n #elif 1\n#endif", {"E0129 1:1", "E0129 2:2", "E0129 3:1"}},
      {"behind else", "#if 1\n#else\n#elif 1\n#else\n#endif", {"E0130 3:1", "E0130 4:1"}},
      {"condition",
       "#if\n#endif\n#if 1 +\n#endif\n#if (1\n#endif\n#if 1 2\n#endif",
       {"E0131 1:1", "E0131 3:8", "E0131 5:7", "E0131 7:7"}},
      {"condition values",
       "#if 1 / 0\n#endif\n#if 12ab\n#endif\n#if 1 ? 2\n#endif\n#if \"a\"\n#endif\n#if defined 5\n#endif",
       {"E0131 1:7", "E0131 3:5", "E0131 5:10", "E0131 7:5", "E0131 9:5"}},
      {"user error", "#error it's\n", {"E0132 1:1"}},
      {"macro defined", "#define defined 1", {"E0133 1:9"}},
      {"other text", "#define A 1\n#define A 2", {"W0121 2:9"}},
      {"pragma", "#pragma foo 1\n#pragma", {"W0122 1:9", "W0122 2:1"}},
      {"extra",
       "#define A\n#undef A b\n#ifdef A b\n#else b\n#endif b",
       {"W0123 2:10", "W0123 3:10", "W0123 4:7", "W0123 5:8"}},
      {"undefined", "#if A == 0\n#endif", {"W0124 1:5"}},

      {"semicolon at line end", body("x = 1\n y = 2;"), {"E0150 1:15"}},
      {"semicolon before brace", "main() {\n x = 1\n}", {"E0150 2:7"}},
      {"semicolon before word", body("x = 1 if (a) b; else c;"), {"E0150 1:15"}},
      {"semicolon behind declaration", "long a\nlong b;", {"E0150 1:7"}},
      {"semicolon behind typedef", "typedef struct { long a; } T\nT t;", {"E0150 1:29"}},
      {"closing bracket", body("x = (1 + 2; y = a[1; z = ;"), {"E0150 1:20", "E0150 1:29", "E0150 1:35"}},
      {"bracket of if", body("if (a { x = ; } else { y = ; }"), {"E0150 1:16", "E0150 1:22", "E0150 1:37"}},
      {"opening bracket",
       body("if a) { x = ; } while b { y = ; }"),
       {"E0150 1:13", "E0150 1:22", "E0150 1:32", "E0150 1:40"}},
      {"expression",
       body("x = ; y = * ; if () z; f(a,); + ;"),
       {"E0150 1:14", "E0150 1:22", "E0150 1:28", "E0150 1:37", "E0150 1:42"}},
      {"two operands", body("x = 1 2; f(a b); y = 3;"), {"E0150 1:15", "E0150 1:23"}},
      {"for",
       body("for (i = 0; i < 3 i++) x = ; for (a) y; z = ;"),
       {"E0150 1:27", "E0150 1:37", "E0150 1:45", "E0150 1:54"}},
      {"case",
       body("switch (x) { case 1 y; case: z; default w; }"),
       {"E0150 1:30", "E0150 1:37", "E0150 1:50"}},
      {"do", body("do x; while (a) y = 1; do { } (x); z = ;"), {"E0150 1:25", "E0150 1:40", "E0150 1:49"}},
      {"conditional", body("x = a ? b; y = ;"), {"E0150 1:19", "E0150 1:25"}},
      {"function brackets",
       "main( { x = ; }\nfoo { y = ; }",
       {"E0150 1:7", "E0150 1:13", "E0150 2:5", "E0150 2:11"}},
      {"opening brace",
       "main()\n if (a) { x = ; }\n y = ;\n}\nlong b = ;",
       {"E0150 1:7", "E0150 2:15", "E0150 3:6", "E0150 5:10"}},
      {"opening brace of else",
       "main() { if (a) { x; } else y; } while (b) { } z = 1; }\nf() { x = ; }",
       {"E0151 1:34", "E0150 2:11"}},
      {"name", "long 5; long a b; long c;", {"E0150 1:6", "E0150 1:16"}},
      {"member",
       "typedef struct { long a long b; 5; } T; T t; long x = ;",
       {"E0150 1:25", "E0150 1:33", "E0150 1:55"}},
      {"end of file", "main() {\n if (a) {\n x = 1;\n", {"E0150 3:8"}},
      {"outside",
       "x = 1; y = 2;\nmain() { z = ; }\nwhile (1) { x = 1; }\nfoo(1);\nlong a;",
       {"E0151 1:1", "E0150 2:14", "E0151 3:1"}},
      {"else", body("else x = 1; y = ;"), {"E0152 1:10", "E0150 1:26"}},
      {"brace", "main() { } }\nx = 1;\n}\nfoo() { y = ; }", {"E0153 1:12", "E0150 4:13"}},
      {"local",
       body("long i = 0, *j; int k; for (long m = 0; m < 1; m++) x = m; SCREC r;"),
       {"E0154 1:10", "E0154 1:26", "E0154 1:38", "E0154 1:69"}},
      {"types",
       "int a; unsigned long b; long long c; char d; void e;",
       {"E0155 1:1", "E0155 1:8", "E0155 1:25", "E0155 1:38", "E0155 1:46"}},
      {"qualifiers", "const long a; static SCREC b;", {"E0156 1:1", "E0156 1:15"}},
      {"result", "void main() { }\nlong f() { x = ; }", {"E0157 1:1", "E0150 2:16", "E0157 2:1"}},
      {"parameters",
       "main(void) { x = ; }\nf(long a, long b) { }\nint g(a) { }",
       {"E0158 1:6", "E0150 1:18", "E0158 2:3", "E0158 3:7"}},
      {"prototype", "foo();\nvoid bar();", {"E0159 1:1", "E0159 2:1"}},
      {"return value", body("return x + 1;"), {"E0160 1:17"}},
      {"goto", body("goto end; end: x = 1;"), {"E0161 1:10", "E0162 1:20"}},
      {"nested", "main() { if (a) {\n}\nfoo() { x = ; }\nlong y;\nbar() { }", {"E0163 3:1", "E0150 3:13"}},
      {"value", "long a = 5, b = { 1, 2 };", {"E0164 1:8", "E0164 1:15"}},
      {"value with a mistake inside",
       "long b = { 1, = };\nlong c = { 2 3 }, d;\nlong e = { ; };\nlong f = ;\nmain() { x = ; }",
       {"E0150 1:15", "E0150 2:14", "E0150 3:12", "E0150 4:10", "E0150 5:14"}},
      {"value in brackets",
       "long a[2] = { b[ }, c = { (1 }; long d = ;\nmain() { x = ; }",
       {"E0150 1:18", "E0150 1:42", "E0150 2:14"}},
      {"pointer", "long *p;", {"E0165 1:6"}},
      {"dimensions", "long a[2][3];", {"E0166 1:10"}},
      {"declared type", "long SCREC;", {"E0167 1:6"}},
      {"type as value", body("x = SCREC; f(long);"), {"E0168 1:14", "E0168 1:23"}},
      {"unknown types in one line",
       "Foo a; Bar b; long c;\nmain() { Foo d; Bar e; c = ; }",
       {"E0169 1:1", "E0169 1:8", "E0169 2:10", "E0169 2:17", "E0150 2:28"}},
      {"unknown type", "Foo a;\nmain() { Bar b; x = ; }", {"E0169 1:1", "E0169 2:10", "E0150 2:21"}},
      {"struct", "struct A a; struct B { long b; }; long c = ;", {"E0170 1:1", "E0170 1:13", "E0150 1:44"}},
      {"typedef",
       "typedef long LONG; typedef union { long a; } U; long c = ;",
       {"E0171 1:9", "E0171 1:28", "E0150 1:58"}},
      {"address", body("x = &y;"), {"E0172 1:14"}},
      {"arrow", body("p->x = 1;"), {"E0173 1:11"}},
      {"sizeof",
       body("x = sizeof(a) + sizeof(long) + sizeof a;"),
       {"E0174 1:14", "E0174 1:26", "E0174 1:41"}},
      {"cast", body("x = (long)y + (SCREC)z;"), {"E0175 1:14", "E0175 1:24"}},
      {"depth", body("x = " + std::string(300, '(') + "1" + std::string(300, ')') + ";"), {"E0176 1:269"}},
      {"pragma form",
       "#pragma globals 1\n#pragma list 1 2\n#pragma var\n#pragma globals 1 2 3\nlong x = ;",
       {"E0178 1:18", "E0178 2:1", "E0178 3:1", "E0178 4:21", "E0150 5:10"}},
      {"declare form",
       "#declare X\n#declare X 5\n#declare X H5 - 3\nlong x = ;",
       {"E0179 1:11", "E0179 2:12", "E0179 3:15", "E0150 4:10"}},
      {"names on two lines", body("stop\n x = 1;"), {"E0150 1:14"}},
      {"braces as a value", body("x = {1, 2}; y = ;"), {"E0150 1:14", "E0150 1:26"}},
  };
  return all;
}

class FrontendErrors : public testing::TestWithParam<Case> {};

TEST_P(FrontendErrors, ExactlyTheseMessages) {
  FrontendRun run(GetParam().source, {{"t.IPC", GetParam().source}});
  EXPECT_EQ(run.parse().messages(), GetParam().expected) << GetParam().source;
}

INSTANTIATE_TEST_SUITE_P(Table, FrontendErrors, testing::ValuesIn(cases()));

TEST(FrontendErrorTable, EveryRowOfThisAreaHasACase) {
  // Cases of their own: include depth, limits of size and number (other files and below).
  std::set<std::string> seen{"E0126", "E0127", "E0177"};
  for (const Case& one : cases())
    for (const std::string& message : one.expected) seen.insert(message.substr(0, 5));
  for (const compiler::DiagInfo& row : compiler::diagnostic_table()) {
    const bool ours = row.code.substr(1, 2) == "01";
    EXPECT_TRUE(!ours || seen.contains(std::string(row.code))) << row.code << " " << row.name;
  }
}

TEST(FrontendErrorTable, CodesAreUniqueAndMatchTheirSeverity) {
  std::set<std::string_view> codes;
  for (const compiler::DiagInfo& row : compiler::diagnostic_table()) {
    EXPECT_TRUE(codes.insert(row.code).second) << row.code;
    EXPECT_EQ(row.code.size(), 5U);
    EXPECT_EQ(row.code[0] == 'W', row.severity == compiler::Severity::Warning) << row.code;
    EXPECT_EQ(row.code[0] == 'N', row.severity == compiler::Severity::Note) << row.code;
    EXPECT_EQ(row.flag.empty(), row.severity != compiler::Severity::Warning) << row.code;
  }
}

TEST(FrontendErrorTexts, SayWhatWasFoundAndExpected) {
  const std::vector<std::pair<std::string, std::string>> texts = {
      {body("x = 1\n}"), "expected ';' before '}'"},
      {body("x = (1;"), "expected ')' before ';'"},
      {body("x = a[1;"), "expected ']' before ';'"},
      {"long x[2] = {1 2};", "expected '}' before '2'"},
      {"long x[2] = {1;", "expected '}' before ';'"},
      {body("x = ;"), "expected an expression before ';'"},
      {body(")"), "expected a statement before ')'"},
      {body("case 1;"), "expected ':' before ';'"},
      {body("do x; y;"), "expected 'while' before 'y'"},
      {"foo {", "expected '(' before '{'"},
      {"foo() x;", "expected '{' before 'x'"},
      {"long 5;", "expected a name before '5'"},
      {"long a b;", "expected ';' or ',' before 'b'"},
      {"=", "expected a declaration or a function before '='"},
      {"typedef struct { 5 } T;", "expected a type or '}' before '5'"},
      {"typedef struct [", "expected '{' before '['"},
      {"main() {", "expected '}' before the end of the file"},
      {"main() { x = 1 +\n#pragma list\n", "expected an expression before '#pragma'"},
      {"void f(long a) { }",
       "functions have no parameters; write 'f() { ... }' and pass values in global variables"},
      {"unsigned int x;", "'unsigned int' is not a type; the only simple type is long"},
      {"#pragma var 1", "write '#pragma var LOW HIGH'"},
  };
  for (const auto& [source, text] : texts) {
    FrontendRun run(source);
    run.parse();
    ASSERT_FALSE(run.diagnostics.all().empty()) << source;
    EXPECT_EQ(run.diagnostics.all()[0].text, text) << source;
  }
}

TEST(FrontendErrorTexts, MissingBraceNamesItsPartner) {
  FrontendRun run("main() {\n while (1) {\n");
  run.parse();
  ASSERT_EQ(run.diagnostics.all().size(), 1U);
  ASSERT_EQ(run.diagnostics.all()[0].notes.size(), 1U);
  EXPECT_EQ(run.map.position(run.diagnostics.all()[0].notes[0].span.begin).line, 2U);
}

TEST(FrontendErrorTexts, NestedFunctionNamesTheOpenBrace) {
  FrontendRun run("main() {\n if (a) {\n  x = 1;\n}\nfoo() { }");
  run.parse();
  ASSERT_EQ(run.messages(), Messages{"E0163 5:1"});
  ASSERT_EQ(run.diagnostics.all()[0].notes.size(), 1U);
  // The '}' in line 4 stands as deep as main: it is the one of the `if` that is missing.
  EXPECT_EQ(run.map.position(run.diagnostics.all()[0].notes[0].span.begin).line, 2U);
}

TEST(FrontendRecovery, KeepsWhatIsRight) {
  FrontendRun run("long a;\nmain() { x = ; y = 2; }\nfoo() { z = 3; }\nlong b;");
  run.parse();
  EXPECT_EQ(run.program.declarations.size(), 4U);
  EXPECT_NE(run.tree().find("2:16 assign ="), std::string::npos);
}

TEST(FrontendRecovery, StopsAfterAHundredErrors) {
  std::string source = "main() {\n";
  for (int i = 0; i < 500; ++i) source += "x = ;\n";
  const Messages found = messages_of(source + "}");
  ASSERT_EQ(found.size(), 101U);
  EXPECT_EQ(found.back().substr(0, 5), "E0177");
}

}  // namespace
}  // namespace ipos::tests

// What each message of the front end says and which words of the source it underlines, one row for every code and for
// every way that leads to it. The words are those of the mistake: the page of the code in docs/reference/diagnostics.
#include <gtest/gtest.h>

#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

// "E0104 [@@] '@' has no meaning here" for each message.
std::vector<std::string> underlined(const std::string& source) {
  FrontendRun run(source, {{"a.h", ""}, {"t.IPC", source}});
  run.parse();
  std::vector<std::string> out;
  for (const compiler::Diagnostic& one : run.diagnostics.all()) {
    const auto* file = run.map.file_of(one.span.begin);
    const std::string words = file == nullptr ? "?"
                                              : file->text.substr(one.span.begin.value - file->base,
                                                                  one.span.end.value - one.span.begin.value);
    out.push_back(std::string(compiler::info(one.diag).code) + " [" + words + "] " + one.text);
  }
  return out;
}

struct UnderlinedRow {
  std::string source;
  std::vector<std::string> expected;
};

void expect_underlined(const std::vector<UnderlinedRow>& rows) {
  for (const UnderlinedRow& row : rows) EXPECT_EQ(underlined(row.source), row.expected) << row.source;
}

std::string in_function(const std::string& text) { return "main() { " + text + " }"; }

TEST(FrontendUnderlines, CharactersAndWords) {
  const std::string name33(33, 'n');
  const std::string texts = "there are no texts in this language, every value is a 32-bit number";
  expect_underlined({
      {"long a; /* a", {"E0101 [/*] this comment is not closed before the end of the file"}},
      {in_function("x = \"abc;\n"), {"E0102 [\"abc;] the quote is not closed before the end of the line"}},
      {in_function("x = 'a;\n"), {"E0102 ['a;] the quote is not closed before the end of the line"}},
      {in_function("x = 1; @@"), {"E0104 [@@] '@' has no meaning here"}},
      {in_function("x = # 1;"), {"E0104 [#] '#' has no meaning here"}},
      {in_function("Dr\xC3\xBC = 1;"),
       {"E0105 [Dr\xC3\xBC] 'Dr\xC3\xBC' is not a name: names are made of A to Z, a to z, 0 to 9 and _"}},
      {in_function("x = 12ab;"),
       {"E0106 [12ab] '12ab' is not a number: write decimal 123, hexadecimal 0x7B or binary 0b1111011"}},
      {in_function("x = 2147483648;"), {"E0107 [2147483648] '2147483648' does not fit into 32 bits"}},
      {in_function("x = 1.5;"),
       {"E0108 [1.5] '1.5' has a fraction, but there are whole numbers only; scale the value"}},
      {in_function("x = \"a\" \"b\";"), {"E0109 [\"a\"] " + texts}},
      {in_function("x = \"a\" + \"b\";"), {"E0109 [\"a\"] " + texts, "E0109 [\"b\"] " + texts}},
      {in_function("x = 'a';"),
       {"E0110 ['a'] there are no character constants; write the character's code as a number"}},
      {"long " + name33 + ";",
       {"W0101 [" + name33 + "] '" + name33 + "' is longer than 32 characters; only '" + name33.substr(1) +
        "' counts"}},
      {"// C:\\\n", {"W0102 [\\] a '\\' does not continue a // comment on the next line"}},
      {"// C:\\\r\n", {"W0102 [\\] a '\\' does not continue a // comment on the next line"}},
      {"/* a /* b */", {"W0103 [/*] '/*' inside a comment; comments do not nest"}},
  });
}

TEST(FrontendUnderlines, Directives) {
  const std::string include = "#include needs <FILE> or \"FILE\"";
  const std::string condition = "#if needs a constant expression: ";
  const std::string pragma = " is ignored; known are var, globals, initials and list";
  expect_underlined({
      {"#foo x", {"E0120 [#foo] unknown directive '#foo'"}},
      {" # foo x", {"E0120 [# foo] unknown directive '#foo'"}},
      {"#define", {"E0121 [#define] #define needs a name"}},
      {"#undef 5 6", {"E0121 [5] #undef needs a name"}},
      {"#define \xE4 1",
       {"E0105 [\xE4] '\xE4' is not a name: names are made of A to Z, a to z, 0 to 9 and _"}},
      {"#define Fun (x) x\n#define Fun2(x) x",
       {"E0122 [Fun2(] macro 'Fun2' cannot have parameters; for a text in brackets leave a blank before "
        "'('"}},
      {"# include", {"E0123 [# include] " + include}},
      {"#include foo", {"E0123 [foo] " + include}},
      {"#include <>", {"E0123 [<>] " + include}},
      {"#include \"\"", {"E0123 [\"\"] " + include}},
      {"#include <no>", {"E0124 [<no>] cannot find 'no'"}},
      {"#include \"t.IPC\"", {"E0125 [\"t.IPC\"] 't.IPC' includes itself"}},
      {"#if 1 + 1", {"E0128 [#if] #if without #endif"}},
      {"# else x", {"E0129 [# else] #else without #if"}},
      {"#if 1\n#else\n#elif 1\n#endif", {"E0130 [#elif] #elif behind #else"}},
      {"#if\n#endif", {"E0131 [#if] " + condition + "a number or a name is missing"}},
      {"#if 1 +\n#endif", {"E0131 [] " + condition + "a number or a name is missing"}},
      {"#if 1 23\n#endif", {"E0131 [23] " + condition + "an operator or the end of the line is missing"}},
      {"#if (1 23\n#endif", {"E0131 [23] " + condition + "')' is missing"}},
      {"#if 10 / 0 + 1\n#endif", {"E0131 [/] " + condition + "division by zero"}},
      {"#if 10 + 7 % (3 - 3)\n#endif", {"E0131 [%] " + condition + "division by zero"}},
      {"#if 12ab\n#endif", {"E0131 [12ab] " + condition + "'12ab' is not a whole number"}},
      {"#if 1 + defined 5\n#endif", {"E0131 [defined] " + condition + "write defined NAME or defined(NAME)"}},
      {"#if 1 defined(Abc)\n#endif",
       {"E0131 [defined(Abc)] " + condition + "an operator or the end of the line is missing"}},
      {"#if 1 defined Abc + 1\n#endif",
       {"E0131 [defined Abc] " + condition + "an operator or the end of the line is missing"}},
      {"#error it's so", {"E0132 [#error it's so] #error it's so"}},
      {"#error", {"E0132 [#error] #error "}},
      {"#define defined 1", {"E0133 [defined] 'defined' cannot be the name of a macro"}},
      {"#define Abc 1\n#define Abc 2", {"W0121 [Abc] macro 'Abc' gets another text"}},
      {"#pragma foo 1", {"W0122 [foo] unknown pragma 'foo'" + pragma}},
      {"# pragma", {"W0122 [# pragma] unknown pragma ''" + pragma}},
      {"#include <a.h> b c", {"W0123 [b c] text behind #include is ignored"}},
      {"#define A\n#ifdef A b c\n#endif", {"W0123 [b c] text behind #ifdef is ignored"}},
      {"#if 1\n#else b c\n#endif d e",
       {"W0123 [b c] text behind #else is ignored", "W0123 [d e] text behind #endif is ignored"}},
      {"#if Abc == 0\n#endif", {"W0124 [Abc] 'Abc' is not defined and counts as 0"}},
  });
}

TEST(FrontendUnderlines, Declarations) {
  const std::string outside = "statements stand in functions only";
  const std::string no_type = " is not a type; the only simple type is long";
  const std::string parameters = "() { ... }' and pass values in global variables";
  const std::string structure = "write 'typedef struct { ... } ";
  const std::string type = "typedef takes the form 'typedef struct { long a; } NAME;' only";
  expect_underlined({
      {"foo(1);", {"E0151 [foo] " + outside}},
      {"abc = 1;", {"E0151 [abc] " + outside}},
      {"while (1) ;", {"E0151 [while] " + outside}},
      {"}", {"E0153 [}] '}' without '{'"}},
      {"int a;", {"E0155 [int] 'int'" + no_type}},
      {"unsigned long b;", {"E0155 [unsigned long] 'unsigned long'" + no_type}},
      {"long int b;", {"E0155 [long int] 'long int'" + no_type}},
      {"unsigned long int b;", {"E0155 [unsigned long int] 'unsigned long int'" + no_type}},
      {"const long a;", {"E0156 [const] 'const' does not exist in this language; leave it out"}},
      {"void main() { }", {"E0157 [void] functions have no result; write 'main() { ... }'"}},
      {"unsigned int f() { }", {"E0157 [unsigned int] functions have no result; write 'f() { ... }'"}},
      {"f(long a, long b) { }",
       {"E0158 [long a, long b] functions have no parameters; write 'f" + parameters}},
      {"fun(1) { }", {"E0158 [1] functions have no parameters; write 'fun" + parameters}},
      {"fun(a(1), (2)) { }", {"E0158 [a(1), (2)] functions have no parameters; write 'fun" + parameters}},
      {"fun(SCREC a);", {"E0158 [SCREC a] functions have no parameters; write 'fun" + parameters}},
      {"long a; fun(void);", {"E0158 [void] functions have no parameters; write 'fun" + parameters}},
      {"foo();",
       {"E0159 [foo();] 'foo' needs no declaration; functions may be called before they are defined"}},
      {"void bar();",
       {"E0159 [void bar();] 'bar' needs no declaration; functions may be called before they are defined"}},
      {"long a, bc = 5;", {"E0164 [=] a declaration gives no value; assign 'bc' in main()"}},
      {"long bc = { 1, 2 };", {"E0164 [=] a declaration gives no value; assign 'bc' in main()"}},
      {"long *p;", {"E0165 [*] a pointer is a plain number; declare 'long p'"}},
      {"long ab[2][3];", {"E0166 [[] 'ab' may have one dimension only"}},
      {"long SCREC;", {"E0167 [SCREC] 'SCREC' is the name of a structure type and cannot be declared again"}},
      {"Foo a;", {"E0169 [Foo] unknown type 'Foo'"}},
      {"struct Ab a;", {"E0170 [struct Ab] " + structure + "Ab;' once and then 'Ab' as the type"}},
      {"struct Ab { long b; };", {"E0170 [struct Ab] " + structure + "Ab;' once and then 'Ab' as the type"}},
      {"typedef long LONG;", {"E0171 [long] " + type}},
      {"typedef Foo LONG;", {"E0171 [Foo] " + type}},
      {"#pragma globals 1\n", {"E0178 [] write '#pragma globals LOW HIGH'"}},
      {"#pragma initials\n", {"E0178 [#pragma initials] write '#pragma initials LOW HIGH'"}},
      {"#pragma var 1 2 3\n", {"E0178 [3] write '#pragma var LOW HIGH'"}},
      {"#pragma list 1 2\n", {"E0178 [#pragma list 1 2] write '#pragma list'"}},
      {"#pragma list 1\n", {"E0178 [] write '#pragma list'"}},
      {"#declare X 5\n", {"E0179 [5] write '#declare NAME BASE' or '#declare NAME BASE + NUMBER'"}},
      {"#declare X\n", {"E0179 [] write '#declare NAME BASE' or '#declare NAME BASE + NUMBER'"}},
      {"Long abc;", {"E0180 [Long] 'Long' is no word of the language; did you mean 'long'?"}},
  });
}

TEST(FrontendUnderlines, Statements) {
  const std::string other = " belongs to another language; ";
  const std::string no_word = " is no word of the language; did you mean ";
  const std::string no_size =
      "there is no 'sizeof'; numof( ... ) gives the number of a variable, members take one variable each";
  const std::string no_cast = "there are no type conversions, every value is a long";
  expect_underlined({
      {in_function("else x = 1;"), {"E0152 [else] 'else' without 'if'"}},
      {in_function("long ab = 0, j;"),
       {"E0154 [long ab = 0, j;] all variables are global; declare 'ab' outside of the function"}},
      {in_function("return x + 1;"),
       {"E0160 [x + 1] functions have no result; put the value into a global variable"}},
      {in_function("goto end;"),
       {"E0161 [goto end;] there is no 'goto'; use a loop with 'break' or 'continue'"}},
      {in_function("end: x = 1;"), {"E0162 [end:] label 'end' has no use, there is no 'goto'"}},
      {in_function("foo() { x; }"),
       {"E0163 [foo] function 'foo' begins inside another function; is a '}' missing before it?"}},
      {in_function("x = SCREC;"), {"E0168 [SCREC] 'SCREC' is a type, not a variable"}},
      {in_function("f(unsigned);"), {"E0168 [unsigned] 'unsigned' is a type, not a variable"}},
      {in_function("Bar b;"), {"E0169 [Bar] unknown type 'Bar'"}},
      {in_function("x = &yz;"),
       {"E0172 [&] there is no '&' for addresses; numof( ... ) gives the number of a variable"}},
      {in_function("p->x = 1;"), {"E0173 [->] there is no '->'; members are reached with '.'"}},
      {in_function("x = sizeof(a) + 1;"), {"E0174 [sizeof] " + no_size}},
      {in_function("x = sizeof(long) + 1;"), {"E0174 [sizeof] " + no_size}},
      {in_function("x = sizeof a;"), {"E0174 [sizeof] " + no_size}},
      {in_function("x = (long)y;"), {"E0175 [(long)] " + no_cast}},
      {in_function("x = (const SCREC) y;"), {"E0175 [(const SCREC)] " + no_cast}},
      {in_function("While (x) ;"), {}},
      {in_function("While (x) y;"), {"E0180 [While] 'While'" + no_word + "'while'?"}},
      {in_function("fro (x;;) y;"), {"E0180 [fro] 'fro'" + no_word + "'for'?"}},
      {in_function("x = y AND z;"), {"E0181 [AND] 'AND'" + other + "write '&&', or '&' for bits"}},
      {in_function("x = y or z;"), {"E0181 [or] 'or'" + other + "write '||', or '|' for bits"}},
      {in_function("x = y Xor z;"), {"E0181 [Xor] 'Xor'" + other + "write '^'"}},
      {in_function("x = y mod z;"), {"E0181 [mod] 'mod'" + other + "write '%'"}},
      {in_function("x = y DIV z;"), {"E0181 [DIV] 'DIV'" + other + "write '/'"}},
      {in_function("x = not z;"), {"E0181 [not] 'not'" + other + "write '!', or '~' for bits"}},
      {in_function("x := z;"), {"E0181 [:=] ':='" + other + "'=' assigns"}},
      {in_function("if (x <> z) y;"), {"E0181 [<>] '<>'" + other + "'!=' compares"}},
      {in_function("if (x) then y;"), {"E0181 [then] 'then'" + other + "leave it out"}},
      {in_function("while (x) begin y; end;"),
       {"E0181 [begin] 'begin'" + other + "a block begins with '{'",
        "E0181 [end] 'end'" + other + "a block ends with '}'"}},
      {in_function("while (x) y; End_While;"),
       {"E0181 [End_While;] 'End_While'" + other + "a block ends with '}'"}},
  });
}

// Behind the word before where that is the place to write something, else the word that is wrong.
TEST(FrontendUnderlines, ExpectedWords) {
  const std::pair<const char*, const char*> inside[] = {
      {"x = ;", "[;] expected an expression before ';'"},
      {"x = 1 if (a) b;", "[] expected ';' before 'if'"},
      {"x = 1 )", "[] expected ';' before ')'"},
      {"x = (1;", "[;] expected ')' before ';'"},
      {"x = (1\n;", "[] expected ')' before ';'"},
      {"x = a[1 2];", "[2] expected ']' before '2'"},
      {"x = a ? b;", "[;] expected ':' before ';'"},
      {"f(a b);", "[b] expected ')' before 'b'"},
      {"f(a, );", "[)] expected an expression before ')'"},
      {"x.;", "[;] expected a name before ';'"},
      {"goto 5;", "[5] expected a name before '5'"},
      {"break 5;", "[] expected ';' before '5'"},
      {"continue 5;", "[] expected ';' before '5'"},
      {"return );", "[)] expected an expression before ')'"},
      {"default 5;", "[5] expected ':' before '5'"},
      {"case 5 6:", "[6] expected ':' before '6'"},
      {"case :", "[:] expected an expression before ':'"},
      {"do x; y;", "[y] expected 'while' before 'y'"},
      {"do x; while y;", "[y] expected '(' before 'y'"},
      {"do x; while (y) z;", "[] expected ';' before 'z'"},
      {"while 5;", "[5] expected '(' before '5'"},
      {"switch { }", "[{] expected '(' before '{'"},
      {"if (a b) c;", "[b] expected ')' before 'b'"},
      {"for (a b; c; d) e;", "[] expected ';' before 'b'"},
      {"for (a; b c; d) e;", "[] expected ';' before 'c'"},
      {"for (a; b; c d) e;", "[d] expected ')' before 'd'"},
      {"numof 5;", "[5] expected '(' before '5'"},
      {"x = const;", "[const] expected an expression before 'const'"},
      {"x = static;", "[static] expected an expression before 'static'"},
      {"];", "[]] expected a statement before ']'"},
      {"x = 1 +\n#declare A H1\n", "[#declare] expected an expression before '#declare'"},
  };
  for (const auto& [source, expected] : inside) {
    const std::vector<std::string> found = underlined(in_function(source));
    ASSERT_FALSE(found.empty()) << source;
    EXPECT_EQ(found[0], "E0150 " + std::string(expected)) << source;
  }
  const std::pair<const char*, const char*> outside[] = {
      {"long a b;", "[b] expected ';' or ',' before 'b'"},
      {"long a\nlong b;", "[] expected ';' or ',' before 'long'"},
      {"long a, ;", "[;] expected a name before ';'"},
      {"long a[5;", "[;] expected ']' before ';'"},
      {"long a[];", "[]] expected an expression before ']'"},
      {"long a = 5 6;", "[] expected ';' before '6'"},
      {"long a = ;", "[;] expected an expression before ';'"},
      {"initial 5;", "[5] expected a type before '5'"},
      {"const 5;", "[5] expected a type before '5'"},
      {"struct 5;", "[5] expected a name before '5'"},
      {"typedef struct T x;", "[x] expected '{' before 'x'"},
      {"typedef struct { long a; 5 } T;", "[5] expected a type or '}' before '5'"},
      {"typedef struct { long a } T;", "[}] expected ';' or ',' before '}'"},
      {"typedef struct { long a; } 5;", "[5] expected a name before '5'"},
      {"typedef struct { long a; } T t;", "[] expected ';' before 't'"},
      {"foo {", "[{] expected '(' before '{'"},
      {"foo", "[] expected '(' before the end of the file"},
      {"foo() x;", "[x] expected '{' before 'x'"},
      {"foo(1; long c;", "[1] expected ')' before '1'"},
      {"foo(1 {", "[1] expected ')' before '1'"},
      {"foo(1", "[1] expected ')' before '1'"},
      {"foo(", "[] expected ')' before the end of the file"},
      {"main() {", "[] expected '}' before the end of the file"},
      {"main() { x = 1", "[] expected ';' before the end of the file"},
      {"= 1;", "[=] expected a declaration or a function before '='"},
  };
  for (const auto& [source, expected] : outside) {
    const std::vector<std::string> found = underlined(source);
    ASSERT_FALSE(found.empty()) << source;
    EXPECT_EQ(found[0], "E0150 " + std::string(expected)) << source;
  }
}

// What a statement begins with is told from what nothing begins with.
TEST(FrontendUnderlines, StatementsOutsideOfFunctions) {
  for (const std::string word : {"if", "else", "for", "while", "do", "switch", "case", "default", "break",
                                 "continue", "return", "goto", "{", "(", "*", "++", "--", "5"})
    EXPECT_EQ(underlined(word),
              std::vector<std::string>{"E0151 [" + word + "] statements stand in functions only"})
        << word;
  for (const std::string word :
       {")", "[", "]", ",", ":", "?", ".", "->", "+", "-", "/", "!", "~", "=", "==", "&", "numof"})
    EXPECT_EQ(underlined(word),
              std::vector<std::string>{"E0150 [" + word + "] expected a declaration or a function before '" +
                                       word + "'"})
        << word;
}

// The words of C that name types, and no others.
TEST(FrontendUnderlines, TypesAsValues) {
  for (const std::string word : {"long", "int", "void", "char", "short", "unsigned", "signed", "float",
                                 "double", "enum", "union", "SCREC"}) {
    EXPECT_EQ(underlined(in_function("f(1, " + word + ");")),
              std::vector<std::string>{"E0168 [" + word + "] '" + word + "' is a type, not a variable"});
    EXPECT_EQ(underlined("fun(" + word + ");").at(0).substr(0, 5), "E0158") << word;
  }
  for (const std::string word : {"const", "static", "extern", "volatile"})
    EXPECT_EQ(underlined(in_function("f(1, " + word + ");")),
              std::vector<std::string>{"E0150 [" + word + "] expected an expression before '" + word + "'"});
}

}  // namespace
}  // namespace ipos::tests

// Layouts by hand of every construct: the bodies of statements, blanks around operators, blank lines, comments,
// preprocessor lines, line ends and limits. format_test.cpp has whole programs.
#include <gtest/gtest.h>

#include "compiler/format/format.hpp"
#include "compiler/format/pieces.hpp"
#include "tests/format/formatted.hpp"

namespace ipos::tests {
namespace {

// Statements of a main, as the formatter lays them out; `wanted` without the main and its indentation.
void expect_statements(const std::string& statements, const std::string& wanted) {
  std::string expected = "main()\n{\n";
  for (size_t at = 0; at < wanted.size();) {
    const size_t end = std::min(wanted.find('\n', at), wanted.size());
    const std::string line = wanted.substr(at, end - at);
    expected += line.empty() || line[0] == '#' ? line + "\n" : "    " + line + "\n";
    at = end + 1;
  }
  expected += "}\n";
  const std::string found = formatted("main(){" + statements + "}");
  EXPECT_EQ(found, expected) << statements;
  EXPECT_EQ(formatted(found), found) << "a second time";
}

TEST(Layout, BodiesOfEveryStatement) {
  expect_statements("\nwhile(a)\nfor(;;)\nif(b)\nc=1;\nelse\nd=1;\ne=1;",
                    "while (a)\n    for (;;)\n        if (b)\n            c = 1;\n        else\n            "
                    "d = 1;\ne = 1;");
  expect_statements("do{a=1;}while(b);c=1;", "do\n{\n    a = 1;\n}\nwhile (b);\nc = 1;");
  expect_statements("do\na=1;\nwhile(b);c=1;", "do\n    a = 1;\nwhile (b);\nc = 1;");
  expect_statements("do\nwhile(a)\nb=1;\nwhile(c);d=1;",
                    "do\n    while (a)\n        b = 1;\nwhile (c);\nd = 1;");
  expect_statements("do do a=1; while(b); while(c);d=1;", "do do a = 1;\nwhile (b);\nwhile (c);\nd = 1;");
  expect_statements("if(a){b=1;}else{c=1;}d=1;", "if (a)\n{\n    b = 1;\n}\nelse\n{\n    c = 1;\n}\nd = 1;");
  expect_statements("if(a){b=1;}else if(c){d=1;}else e=1;f();",
                    "if (a)\n{\n    b = 1;\n}\nelse if (c)\n{\n    d = 1;\n}\nelse e = 1;\nf();");
  expect_statements("if(a)\nif(b)\nc=1;\nelse\nd=1;\nelse\ne=1;f();",
                    "if (a)\n    if (b)\n        c = 1;\n    else\n        d = 1;\nelse\n    e = 1;\nf();");
  expect_statements("if(a)\n{\nif(b)c=1;\n}\nelse\nd=1;",
                    "if (a)\n{\n    if (b) c = 1;\n}\nelse\n    d = 1;");
  expect_statements("if(a)while(b)c=1;else d=1;e=1;", "if (a) while (b) c = 1;\nelse d = 1;\ne = 1;");
  expect_statements("for(i=0;i<3;i++)a=1;b=1;", "for (i = 0; i < 3; i++) a = 1;\nb = 1;");
  expect_statements("for(i=f(1);g(h(2));)\na=1;b=1;", "for (i = f(1); g(h(2));)\n    a = 1;\nb = 1;");
  expect_statements("for(;;){a=1;}b=1;", "for (;;)\n{\n    a = 1;\n}\nb = 1;");
  expect_statements("while((a)&&f(b))c=1;d=1;", "while ((a) && f(b)) c = 1;\nd = 1;");
  expect_statements("while(a);b=1;", "while (a);\nb = 1;");
  expect_statements("while(a)\n;b=1;", "while (a)\n    ;\nb = 1;");
  expect_statements("while(a)(b)=1;c=1;", "while (a) (b) = 1;\nc = 1;");
  expect_statements("{a=1;{b=1;}}c=1;", "{\n    a = 1;\n    {\n        b = 1;\n    }\n}\nc = 1;");
  expect_statements("switch(a){case 1:b=1;break;case-1:case 2:c=1;default:d=1;}e=1;",
                    "switch (a)\n{\n    case 1:\n        b = 1;\n        break;\n    case -1:\n    case 2:\n "
                    "       c = 1;\n"
                    "    default:\n        d = 1;\n}\ne = 1;");
  expect_statements(
      "switch(a){case b?1:2:c=1;case d?e?1:2:3:f();}",
      "switch (a)\n{\n    case b ? 1 : 2:\n        c = 1;\n    case d ? e ? 1 : 2 : 3:\n        f();\n}");
  expect_statements("switch(a){case 1:if(b)\nc=1;default:while(d){e=1;}}",
                    "switch (a)\n{\n    case 1:\n        if (b)\n            c = 1;\n    default:\n        "
                    "while (d)\n        {\n"
                    "            e = 1;\n        }\n}");
  expect_statements("switch(a){case 1:switch(b){case 2:c=1;}d=1;}",
                    "switch (a)\n{\n    case 1:\n        switch (b)\n        {\n            case 2:\n        "
                    "        c = 1;\n        }\n"
                    "        d = 1;\n}");
  expect_statements("while(a){case 1:b=1;}", "while (a)\n{\n    case 1:\n        b = 1;\n}");
}

TEST(Layout, BlanksOfOperators) {
  const std::pair<const char*, const char*> rows[] = {{"a=b*-c", "a = b * -c"},
                                                      {"a=(b)-c", "a = (b) - c"},
                                                      {"a=b[1]-c", "a = b[1] - c"},
                                                      {"a=b++-c", "a = b++ - c"},
                                                      {"a=b---c", "a = b-- - c"},
                                                      {"a=-(-b)", "a = -(-b)"},
                                                      {"a=!(b)", "a = !(b)"},
                                                      {"a=~-b", "a = ~-b"},
                                                      {"a=**p", "a = **p"},
                                                      {"a=&b", "a = &b"},
                                                      {"a=b& &c", "a = b & &c"},
                                                      {"a=b+ ++c", "a = b + ++c"},
                                                      {"a=b++ + ++c", "a = b++ + ++c"},
                                                      {"a=b- --c", "a = b - --c"},
                                                      {"f(-a,-b)", "f(-a, -b)"},
                                                      {"f ( a , b )", "f(a, b)"},
                                                      {"a=b [ 1 ] [ 2 ]", "a = b[1][2]"},
                                                      {"a . b=c->d", "a.b = c->d"},
                                                      {"a=b?-c:-d", "a = b ? -c : -d"},
                                                      {"a=b?c:d?e:f", "a = b ? c : d ? e : f"},
                                                      {"-a", "-a"},
                                                      {"*p=1", "*p = 1"},
                                                      {"++a", "++a"},
                                                      {"a ++", "a++"},
                                                      {"a=1- -1", "a = 1 - -1"},
                                                      {"a=1-1", "a = 1 - 1"},
                                                      {"a=b<<1>>c", "a = b << 1 >> c"},
                                                      {"a<<=1", "a <<= 1"},
                                                      {"a=b<=c!=d", "a = b <= c != d"},
                                                      {"a=b&&!c||d", "a = b && !c || d"},
                                                      {"a=b%c^d|e", "a = b % c ^ d | e"},
                                                      {"a=1,b=2", "a = 1, b = 2"},
                                                      {"a=numof (b)", "a = numof(b)"},
                                                      {"a=sizeof (b)", "a = sizeof(b)"},
                                                      {"(a)=1", "(a) = 1"},
                                                      {"a=(b,c)", "a = (b, c)"},
                                                      {"a=f(b)(c)", "a = f(b)(c)"},
                                                      {"a=b[1](c)", "a = b[1](c)"},
                                                      {"a=-1", "a = -1"},
                                                      {"a=b-1", "a = b - 1"},
                                                      {"a=b*(c)", "a = b * (c)"},
                                                      {"a= - - b", "a = - -b"},
                                                      {"a= + + b", "a = + +b"},
                                                      {"a= - + b", "a = -+b"},
                                                      {"a=b/ *c", "a = b / *c"},
                                                      {"a=1 .b", "a = 1 .b"},
                                                      {"a=.5", "a = .5"},
                                                      {"a=b . c", "a = b.c"},
                                                      {"a=b- - -c", "a = b - - -c"},
                                                      {"a=b< <c", "a = b < < c"},
                                                      {"a=b> =c", "a = b > = c"},
                                                      {"a=1 x", "a = 1 x"},
                                                      {"a=\"x\"-b", "a = \"x\" - b"},
                                                      {"a='x'-b", "a = 'x' - b"},
                                                      {"return", "return"},
                                                      {"goto a", "goto a"},
                                                      {"a=b?(c):(d)", "a = b ? (c) : (d)"}};
  for (const auto& [given, wanted] : rows)
    expect_statements(std::string(given) + ";", std::string(wanted) + ";");
  expect_statements("if(!a)b=1;", "if (!a) b = 1;");
  expect_statements("if(-a)b=1;", "if (-a) b = 1;");
  expect_statements("if(a)-b;", "if (a) -b;");
  expect_statements("if(a)*p=1;else*q=1;", "if (a) *p = 1;\nelse *q = 1;");
  expect_statements("do++a;while(b);", "do ++a;\nwhile (b);");
  expect_statements("a=1;-b;", "a = 1;\n-b;");
  expect_statements("a=1;;", "a = 1;\n;");
}

TEST(Layout, LinesThatGoOn) {
  expect_statements("a=1+\n2\n+3;", "a = 1 +\n    2\n    + 3;");
  expect_statements("_Copy(a,\nb,\n1);", "_Copy(a,\n    b,\n    1);");
  expect_statements("if(a&&\nb)\nc=1;", "if (a &&\n    b)\n    c = 1;");
  expect_statements("while(a){b=c+\nd;}", "while (a)\n{\n    b = c +\n        d;\n}");
  expect_statements("SET_DO01\nn=1;", "SET_DO01\nn = 1;");
  expect_statements("f()\nn=1;", "f()\nn = 1;");
  expect_statements("a=5\nn=1;", "a = 5\nn = 1;");
  expect_statements("a[1]\nn=1;", "a[1]\n    n = 1;");
  expect_statements("f(a\nb);", "f(a\n    b);");
  expect_statements("a\n=1;", "a\n    = 1;");
  EXPECT_EQ(formatted("long a,\nb;"), "long a,\n    b;\n");
  EXPECT_EQ(formatted("typedef struct{long a;}A;typedef struct\n{\nlong b;\n}\nB;\nA c;"),
            "typedef struct\n{\n    long a;\n} A;\ntypedef struct\n{\n    long b;\n} B;\nA c;\n");
  EXPECT_EQ(formatted("typedef struct tag{long a;}A,B;"), "typedef struct tag\n{\n    long a;\n} A, B;\n");
}

TEST(Layout, BlankLines) {
  EXPECT_EQ(
      formatted(
          "\n\nlong a;\n\n\n\nlong b;\n\nmain()\n\n{\n\n  a=1;\n\n\n  b=2;\n  a=3;\n\n}\n\n\nf(){}\n\n\n"),
      "long a;\n\nlong b;\n\nmain()\n{\n    a = 1;\n\n    b = 2;\n    a = 3;\n}\n\nf()\n{\n}\n");
  expect_statements("\n\nif(a)\n\nb=1;\n\nelse\n\nc=1;\n\nd=1+\n\n2;",
                    "if (a)\n    b = 1;\nelse\n    c = 1;\n\nd = 1 +\n    2;");
  expect_statements("\na=1;\n\n// b\n\nc=1;", "a = 1;\n\n// b\n\nc = 1;");
  expect_statements("\n\n// b\nc=1;", "// b\nc = 1;");
  expect_statements("a=1;\n\n#if A\n\nb=1;\n\n#endif\nc=1;", "a = 1;\n\n#if A\n\nb = 1;\n\n#endif\nc = 1;");
}

TEST(Layout, CommentsBehindCodeStandInOneColumn) {
  expect_statements("a=1;// one\nbcd=22;// two\n\ne=1;// three\n",
                    "a = 1;     // one\nbcd = 22;  // two\n\ne = 1;  // three");
  expect_statements("a=1;// one\nbcd=22;\ne=1;// three\n", "a = 1;  // one\nbcd = 22;\ne = 1;  // three");
  expect_statements("if(a)// one\nbcd=22;// two\n", "if (a)  // one\n    bcd = 22;  // two");
  expect_statements("if(a){// one\nbcd=22;// two\n}// three\n",
                    "if (a)\n{  // one\n    bcd = 22;  // two\n}  // three");
  expect_statements("a=1;/* one *//* two */// three\n", "a = 1;  /* one */ /* two */ // three");
  expect_statements("\xC3\xA4=1;// one\nbc=1;// two\n", "\xC3\xA4 = 1;   // one\nbc = 1;  // two");
  EXPECT_EQ(formatted("#define A 1 // one\nlong a;// two\n"), "#define A 1 // one\nlong a;  // two\n");
}

TEST(Layout, CommentsInsideAndAboveCode) {
  expect_statements("a/* x */=1;", "a /* x */ = 1;");
  expect_statements("f(/* x */a,b/* y */);", "f( /* x */ a, b /* y */ );");
  expect_statements("\n/* x */a=1;", "/* x */ a = 1;");
  expect_statements("\n/* x */ /* y */a=1;", "/* x */ /* y */ a = 1;");
  expect_statements("\n/* x */\na=1;", "/* x */\na = 1;");
  expect_statements("if(a)\n// x\nb=1;", "if (a)\n    // x\n    b = 1;");
  expect_statements("if(a)b=1;\n// x\nelse c=1;", "if (a) b = 1;\n// x\nelse c = 1;");
  expect_statements("a=1+// x\n2;", "a = 1 +  // x\n    2;");
  expect_statements("switch(a){\n// x\ncase 1:\n// y\nb=1;\n// z\n}",
                    "switch (a)\n{\n    // x\n    case 1:\n        // y\n        b = 1;\n        // z\n}");
  EXPECT_EQ(formatted("main()\n{\n\t/* x\n\t   y\n\n\tz */\na=1;}"),
            "main()\n{\n    /* x\n\t   y\n\n\tz */\n    a = 1;\n}\n")
      << "it stays where it is";
  EXPECT_EQ(formatted("main()\n{\n  /* x\n     y\n z */\na=1;}"),
            "main()\n{\n    /* x\n       y\n   z */\n    a = 1;\n}\n");
  EXPECT_EQ(formatted("\t/* x\n\t   y\n z */\nlong a;"), "/* x\n   y\nz */\nlong a;\n");
  EXPECT_EQ(formatted("long a; // x  \n// y \t\n/* z  \n  w */"), "long a;  // x\n// y\n/* z\n  w */\n");
  EXPECT_EQ(formatted("// only"), "// only\n");
  EXPECT_EQ(formatted("long a;//\nlong b;//"), "long a;  //\nlong b;  //\n");
  EXPECT_EQ(formatted("//\n/**/long a;"), "//\n/**/ long a;\n");
  EXPECT_EQ(formatted("long a;\n// x\n\n// y\n"), "long a;\n// x\n\n// y\n");
  EXPECT_EQ(formatted("long a = b / c; // d /* e\n"), "long a = b / c;  // d /* e\n");
  EXPECT_EQ(formatted("long a; /* // */ long b; /**/ long c; /***/"),
            "long a;  /* // */\nlong b;  /**/\nlong c;  /***/\n");
}

TEST(Layout, PreprocessorLines) {
  expect_statements("\na=1+\n#if A\n2\n#else\n3\n#endif\n;\nb=1;",
                    "a = 1 +\n#if A\n    2\n#else\n    3\n#endif\n    ;\nb = 1;");
  expect_statements(
      "\n#ifdef A\nif(a){\n#elif B\nwhile(b){\n#else\nfor(;;){\n#endif\nc=1;\n}\nd=1;",
      "#ifdef A\nif (a)\n{\n#elif B\nwhile (b)\n{\n#else\nfor (;;)\n{\n#endif\n    c = 1;\n}\nd = 1;");
  expect_statements("\n#ifndef A\n#if B\nif(a){\n#else\n#endif\n{\n#else\n{\n#endif\nc=1;\n}",
                    "#ifndef A\n#if B\nif (a)\n{\n#else\n#endif\n{\n#else\n{\n#endif\n    c = 1;\n}");
  expect_statements("\na=\n#if A\n-1\n#elif B\n-2\n#else\n-3\n#endif\n;",
                    "a =\n#if A\n    -1\n#elif B\n    -2\n#else\n    -3\n#endif\n    ;");
  EXPECT_EQ(formatted("typedef struct{long a;}\n#if A\nB\n#else\nC\n#endif\n;"),
            "typedef struct\n{\n    long a;\n}\n#if A\n    B\n#else\n    C\n#endif\n    ;\n");
  EXPECT_EQ(formatted("  #  include   <a//b.h>  // c  \nlong a;"),
            "  #  include   <a//b.h>  // c\nlong a;\n");
  EXPECT_EQ(formatted("#define A {\\\n  b\nlong  a;"), "#define A {\\\n  b\nlong a;\n");
  EXPECT_EQ(formatted("#define A /* b\n  c */ d\nlong  a;"), "#define A /* b\n  c */ d\nlong a;\n");
  EXPECT_EQ(formatted("/* b */ #define A\nlong  a;"), "/* b */\n#define A\nlong a;\n");
  EXPECT_EQ(formatted("#else\n#elif 1\n#endif\nlong  a;"), "#else\n#elif 1\n#endif\nlong a;\n");
  EXPECT_EQ(formatted("#\n#endif\nlong  a;"), "#\n#endif\nlong a;\n");
  EXPECT_EQ(formatted("#if A\n#endif"), "#if A\n#endif\n");
}

TEST(Layout, LineEndsFollowTheFirst) {
  EXPECT_EQ(formatted("long a;\r\nlong b;\n"), "long a;\r\nlong b;\r\n");
  EXPECT_EQ(formatted("long a;\nlong b;\r\n"), "long a;\nlong b;\n");
  EXPECT_EQ(formatted("\r\nlong a;"), "long a;\r\n");
  EXPECT_EQ(compiler::format_source(std::string_view("\r\nlong a;").substr(1)).value(), "long a;\n");
  EXPECT_EQ(formatted("long a;"), "long a;\n");
  EXPECT_EQ(formatted("long a;\r"), "long a;\n");
  EXPECT_EQ(formatted("long\ra;"), "long a;\n");
  EXPECT_EQ(formatted("\xEF\xBB\xBF/* x */long a;"), "\xEF\xBB\xBF/* x */\nlong a;\n");
  EXPECT_EQ(formatted("\xEF\xBB\xBF// x\nlong a;"), "\xEF\xBB\xBF// x\nlong a;\n");
}

TEST(Layout, BracesTooMany) {
  EXPECT_EQ(formatted("}\nlong  a;"), "}\nlong a;\n");
  EXPECT_EQ(formatted("long  a;}long  b;"), "long a;\n}\nlong b;\n");
  EXPECT_EQ(formatted("main(){if(a)}long  b;"), "main()\n{\n    if (a)\n}\nlong b;\n");
  EXPECT_EQ(formatted("main(){a=(1;}b;"), "main()\n{\n    a = (1;\n}\nb;\n");
  EXPECT_EQ(formatted("a);b;"), "a);\nb;\n");
}

TEST(Layout, NestsTwoHundredFiftySixDeep) {
  const std::string deep = "line 1: statements or conditions are nested too deep";
  EXPECT_NE(formatted("a" + std::string(256, '{')), deep);
  EXPECT_EQ(formatted("a" + std::string(257, '{')), deep);
  std::string conditions;
  for (int n = 0; n < 256; ++n) conditions += "#if A\n";
  EXPECT_EQ(formatted(conditions), conditions);
  EXPECT_EQ(formatted(conditions + "#if A\n"), "line 257: statements or conditions are nested too deep");
}

TEST(ForeignWords, OfCAreFound) {
  for (const char* word : {"::", "...", ".*", "->*", "<=>", "<:", ":>", "<%", "%>", "%:", "\"a\"", "'a'",
                           "\"a", "@", "1.5", ".5", "$"}) {
    const auto found = compiler::foreign_word("long a;\nmain() { a " + std::string(word) + " b; }");
    ASSERT_TRUE(found) << word;
    EXPECT_EQ(found->line, 2U) << word;
    EXPECT_NE(found->text.find("is no word of an IPOS program"), std::string::npos) << found->text;
  }
  EXPECT_EQ(compiler::foreign_word("a\n= 1.5;")->text, "'1.5' is no word of an IPOS program");
  EXPECT_EQ(compiler::foreign_word("long a;\n#if 1\n@\n#endif\n")->line, 3U);
  for (const char* left_out : {"#if 0\n @ $ \xA7\n#endif\nlong a;\n", "#ifdef NOBODY\n a @ b\n#else\nlong a;\n#endif\n",
                               "#ifndef H\n#define H\nlong a;\n#if 2 > 3\n`\n#endif\n#endif\n"})
    EXPECT_FALSE(compiler::foreign_word(left_out)) << left_out;
  EXPECT_EQ(compiler::foreign_word("/* open")->text, "this comment is not closed before the end of the file");
  for (const char* good :
       {"a : : b", ". . .", "a . * b", "a -> * b", "a <= > b", "a < : b", "a % : b", "// ::", "/* \"a\" */",
        "#define A \"::\"", "#include \"a.h\"", "a = b ? c : d; e->f; *g; h[1] <<= 0x1F;", ""})
    EXPECT_FALSE(compiler::foreign_word(good)) << good;
}

// What keeps the formatter from writing another program: each of what makes a piece counts by itself.
TEST(Pieces, DifferInKindTokenOrText) {
  using compiler::Piece;
  using compiler::TokenKind;
  const Piece end{Piece::Kind::End, TokenKind::End, "", 0, 9, 0};
  const Piece word{Piece::Kind::Token, TokenKind::Name, "a", 0, 3, 0};
  const auto with = [&](Piece piece) { return std::vector<Piece>{piece, end}; };
  EXPECT_EQ(compiler::difference(with(word), with(word)), 0U);
  EXPECT_EQ(compiler::difference(with(word), with({word.kind, word.token, "a", 2, 4, 1})), 0U) << "only its place";
  EXPECT_EQ(compiler::difference(with(word), with({Piece::Kind::Directive, word.token, "a", 0, 3, 0})), 3U);
  EXPECT_EQ(compiler::difference(with(word), with({word.kind, TokenKind::Number, "a", 0, 3, 0})), 3U);
  EXPECT_EQ(compiler::difference(with(word), with({word.kind, word.token, "b", 0, 3, 0})), 3U);
  EXPECT_EQ(compiler::difference(with(word), {end}), 3U) << "one less";
  EXPECT_EQ(compiler::difference({word}, with(word)), 3U) << "one more, told at the last line there is";
}

}  // namespace
}  // namespace ipos::tests

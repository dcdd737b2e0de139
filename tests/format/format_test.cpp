// The formatter: layouts by hand, and for all programs of the project that a second run changes nothing and
// that the formatted program is the same program.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "compiler/compile.hpp"
#include "tests/format/formatted.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
using compiler::format_source;

TEST(Format, BracesStandAloneAndStatementsHaveLinesOfTheirOwn) {
  EXPECT_EQ(formatted("main(){H0=1;H1 = 2 ;while(1){}}"), R"(main()
{
    H0 = 1;
    H1 = 2;
    while (1)
    {
    }
}
)");
}

TEST(Format, BodiesKeepTheirLine) {
  EXPECT_EQ(formatted("main(){ if(a)b=1; else if (c)\nd=1; else\ne=1; for(;;)f(); do g(); while(h); }"),
            R"(main()
{
    if (a) b = 1;
    else if (c)
        d = 1;
    else
        e = 1;
    for (;;) f();
    do g();
    while (h);
}
)");
}

TEST(Format, ElseBelongsToTheNearestIf) {
  EXPECT_EQ(formatted("main(){\nif(a)\nif(b)\nc=1;\nelse\nc=2;\nd=3;}"), R"(main()
{
    if (a)
        if (b)
            c = 1;
        else
            c = 2;
    d = 3;
}
)");
}

TEST(Format, Switch) {
  EXPECT_EQ(formatted("main(){switch(a){case 1:b=1;break;case A?2:3:{b=2;}default:b=3;}}"), R"(main()
{
    switch (a)
    {
        case 1:
            b = 1;
            break;
        case A ? 2 : 3:
            {
                b = 2;
            }
        default:
            b = 3;
    }
}
)");
}

TEST(Format, Operators) {
  EXPECT_EQ(
      formatted("main(){a=-b- -c+ +d*~e;*p++ =!f;g[ 1 ]=h . i;j=k?l:-m;n=(o&p)<<numof ( q );--r;s=t- --u;\n"
                "_Wait( 10 );v=w/ *x;y = z -\n1;}"),
      R"(main()
{
    a = -b - -c + +d * ~e;
    *p++ = !f;
    g[1] = h.i;
    j = k ? l : -m;
    n = (o & p) << numof(q);
    --r;
    s = t - --u;
    _Wait(10);
    v = w / *x;
    y = z -
        1;
}
)");
}

TEST(Format, WordsNeverJoin) {
  EXPECT_EQ(formatted("main(){a=+ +b;c=- -d;e=- --f;g=1 .h;}"), R"(main()
{
    a = + +b;
    c = - -d;
    e = - --f;
    g = 1 .h;
}
)");
}

TEST(Format, Comments) {
  EXPECT_EQ(
      formatted(
          "// head\n\n\n\nlong a;//one\nlong bcd;   /* two */ // three\n\nmain() // four\n{ /* five */\n"
          "  /* six\n     seven */\n\n  a /* eight */ = 1; /* nine */ bcd = 2;\n  // ten\n}\n"),
      R"(// head

long a;    //one
long bcd;  /* two */ // three

main()  // four
{  /* five */
    /* six
       seven */

    a /* eight */ = 1;  /* nine */
    bcd = 2;
    // ten
}
)");
}

TEST(Format, PreprocessorLinesStay) {
  const std::string text = R"(#include  <const.h>
  #define  A   1   // one
#define B  2 + \
     3
main()
{
#ifdef A
    if (a) {
#else
    if (b) {
#endif
        c = 1;
    }
}
#pragma globals  200 299
)";
  EXPECT_EQ(formatted(text), R"(#include  <const.h>
  #define  A   1   // one
#define B  2 + \
     3
main()
{
#ifdef A
    if (a)
    {
#else
    if (b)
    {
#endif
        c = 1;
    }
}
#pragma globals  200 299
)");
}

TEST(Format, DeclarationsAndMacroStatements) {
  EXPECT_EQ(
      formatted(
          "typedef struct{long a;long b[ 2 ];}Axis;Axis x,y;initial long n;;\nmain(){SET_DO01\nn=1;};\n"),
      R"(typedef struct
{
    long a;
    long b[2];
} Axis;
Axis x, y;
initial long n;
;
main()
{
    SET_DO01
    n = 1;
};
)");
}

TEST(Format, LineEndsAndMarksStay) {
  EXPECT_EQ(formatted("\xEF\xBB\xBFlong a;\r\n\tlong b;   \r\n"), "\xEF\xBB\xBFlong a;\r\nlong b;\r\n");
  EXPECT_EQ(formatted(""), "");
  EXPECT_EQ(formatted("long \xE4; // \xE4\n\x1A"), "long \xE4;  // \xE4\n");
}

TEST(Format, RefusesWhatCannotBeCut) {
  EXPECT_EQ(formatted("main()\n/* open"), "line 2: this comment is not closed before the end of the file");
  EXPECT_EQ(formatted("a;\nb # c"), "line 2: a '#' inside of a line");
  EXPECT_EQ(formatted("\xFF\xFE"), "line 1: the text is UTF-16");
  EXPECT_EQ(formatted(std::string(100'000, '{')), "line 1: statements or conditions are nested too deep");
  EXPECT_FALSE(formatted("}}}}))){;;(((if else while case do").empty());
}

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> programs() {
  std::vector<std::string> names;
  for (const char* folder : {"examples", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(IPOS_SOURCE_DIR) / folder))
      if (entry.path().extension() == ".IPC")
        names.push_back(fs::relative(entry.path(), IPOS_SOURCE_DIR).string());
  std::sort(names.begin(), names.end());
  return names;
}

// Codes and arguments of the messages; their places move.
std::vector<std::string> messages(const compiler::Compilation& compiled) {
  std::vector<std::string> out;
  for (const compiler::Diagnostic& one : compiled.diagnostics.all())
    out.push_back(std::string(compiler::info(one.diag).code) + " " + one.text);
  return out;
}

// Everything but the lines; their commands stay.
void expect_same_image(const vm::Image& a, const vm::Image& b) {
  EXPECT_EQ(a.unit, b.unit);
  EXPECT_EQ(a.code, b.code);
  EXPECT_EQ(a.symbols, b.symbols);
  EXPECT_EQ(a.functions, b.functions);
  EXPECT_EQ(a.files, b.files);
}

class FormatProgram : public ::testing::TestWithParam<std::string> {};

TEST_P(FormatProgram, StaysTheSameProgramAndTheSecondRunChangesNothing) {
  const std::string path = (fs::path(IPOS_SOURCE_DIR) / GetParam()).string();
  const std::string before = read_text(path).value();
  compiler::CompileOptions options;
  options.read_file = read_text;
  const compiler::Compilation first = compiler::compile(path, path, before, options);
  const auto after = format_source(before);
  if (!after) {  // only what no compiler takes may be refused
    EXPECT_FALSE(first.image) << after.error().line << ": " << after.error().text;
    return;
  }
  EXPECT_EQ(formatted(*after), *after);
  const compiler::Compilation second = compiler::compile(path, path, *after, options);
  ASSERT_EQ(first.image.has_value(), second.image.has_value());
  if (!first.image) return;
  expect_same_image(*first.image, *second.image);
  EXPECT_EQ(messages(first), messages(second));
}

INSTANTIATE_TEST_SUITE_P(All, FormatProgram, ::testing::ValuesIn(programs()), [](const auto& row) {
  std::string name = row.param;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
});

}  // namespace
}  // namespace ipos::tests

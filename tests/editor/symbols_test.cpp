// The index of a program: which name means which symbol, where it is declared, and which variable a use stands for.
#include "compiler/symbols/index.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "stdlib/unit_types.hpp"

namespace ipos::tests {
namespace {

using compiler::IndexedSymbol;
using compiler::Occurrence;
using compiler::SymbolKind;

const std::string kHeader = "#ifndef OWN\n#define OWN\ninitial long shared;\n#define STEP 7\n#endif\n";
const std::string kSource =
    "#include \"own.h\"\n#include \"lib/../own.h\"\n"
    "#define N 5\n#define WIDE (N + lSpeed)\n#define EMPTY\n#define GO left[0].target\n"
    "typedef struct { long target; long steps[2]; } Axis;\n"
    "long lSpeed, v[3];\ninitial long kept;\nAxis left[2];\nMOVLNK Ml;\nSCTRCYCL tx;\n"
    "#declare ALIAS H10 + 2\n#declare SAME left\n"
    "main()\n{\n"
    "  left[1].steps[1] = N; left[H1].target = WIDE; left[2].target = 1; (left[1]).target = 2;\n"
    "  left[lSpeed].steps[0] = GO; left->target = 3; left.target = 4; v[1] = kept; v[N] = H007;\n"
    "  Ml.Index = 8318; Ml.Index = 65535; Ml.Index = 65536; Ml.Service = 8319; Ml.Index == 8320; Ml.Index = "
    "-8321;\n"
    "  tx.Cycletime = 10; tx.Len = STEP; ALIAS = shared; SAME[1].target = 5; nobody.target = 6;\n"
    "  _Wait(5); _Movilink(Ml); helper(); EMPTY; left[0x1].target = 8; left[1].nothing = 9;\n"
    "}\n"
    "helper() { }\n";

compiler::ProgramIndex index_of(const std::string& source) {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view("md60a"));
  return compiler::compile_indexed("B.IPC", "/p/B.IPC", source, options).index;
}

class Index : public testing::Test {
 protected:
  Index() {
    compiler::CompileOptions options;
    options.read_file = [](const std::string& path) {
      return path.ends_with("own.h") ? std::optional(kHeader) : std::nullopt;
    };
    options.unit = stdlib::find_unit(std::string_view("md60a"));
    index_ = compiler::compile_indexed("A.IPC", "/p/A.IPC", kSource, options).index;
  }

  // '@' stands in front of the name that is asked for.
  const Occurrence* find(std::string text, const std::string& source,
                         const compiler::SourceFile& file) const {
    const size_t mark = text.find('@');
    text.erase(mark, 1);
    const size_t at = source.find(text);
    EXPECT_NE(at, std::string::npos) << text;
    EXPECT_EQ(source.find(text, at + 1), std::string::npos) << text;
    const Occurrence* found = index_.at(file, static_cast<uint32_t>(at + mark));
    if (found != nullptr && found->place.begin != at + mark) return nullptr;
    return found;
  }
  // "container.name", the number of the variable, and whether it is the definition.
  std::string means(const std::string& text) const {
    const Occurrence* found = find(text, kSource, *index_.main);
    if (found == nullptr) return "nothing";
    const IndexedSymbol& symbol = index_.symbols.at(found->symbol);
    return (symbol.container.empty() ? "" : symbol.container + ".") + symbol.name +
           (found->number ? " " + std::to_string(*found->number) : "") +
           (found->definition ? " defined" : "");
  }
  std::string text_of(const compiler::Place& place) const {
    return place.file->text.substr(place.begin, place.end - place.begin);
  }

  compiler::ProgramIndex index_;
};

TEST_F(Index, TellsWhatEveryNameMeans) {
  const std::pair<const char*, const char*> rows[] = {
      {"#define @N 5", "N defined"},
      {"#define WIDE (@N", "N"},
      {"(N + @lSpeed)", "lSpeed 420"},
      {"{ long @target; long", "Axis.target 0 defined"},
      {"long @steps[2]", "Axis.steps 1 defined"},
      {"} @Axis;", "Axis defined"},
      {"\n@Axis left", "Axis"},
      {"long @lSpeed, v", "lSpeed 420 defined"},
      {"lSpeed, @v[3]", "v 421 defined"},
      {"initial long @kept", "kept 1 defined"},
      {"@MOVLNK Ml", "MOVLNK"},
      {"#declare @ALIAS H10", "ALIAS 12 defined"},
      {"ALIAS @H10", "H10 10"},
      {"SAME @left", "left 424"},
      {"\n@main()", "main defined"},
      {"\n@helper() { }", "helper defined"},
      {"@helper(); EMPTY", "helper"},
      {"@EMPTY; left", "EMPTY"},
      // left[1] begins 3 variables behind left; its steps one more.
      {"  @left[1].steps", "left 424"},
      {"left[1].@steps[1]", "Axis.steps 428"},
      {"steps[1] = @N", "N"},
      {"left[@H1]", "H1 1"},
      {"left[H1].@target", "Axis.target"},
      {"left[2].@target", "Axis.target"},
      {"(left[1]).@target", "Axis.target 427"},
      {"left[@lSpeed].steps", "lSpeed 420"},
      {"left[lSpeed].@steps", "Axis.steps"},
      {"= @GO;", "GO"},
      {"left[0].@target\n", "Axis.target 424"},
      {"left->@target", "nothing"},
      {"left.@target = 4", "nothing"},
      {"@v[1] = kept", "v 421"},
      {"= @kept;", "kept 1"},
      {"= @H007", "H7 7"},
      {"Ml.@Index = 8318", "MOVLNK.Index 434"},
      {"= @8318", "8318 8318"},
      {"= @65535", "65535 65535"},
      {"= @65536", "nothing"},
      {"= @8319", "nothing"},
      {"== @8320", "nothing"},
      {"-@8321", "nothing"},
      {"tx.@Cycletime", "SCTRCYCL.Cycletime 438"},
      {"tx.@Len", "SCTRCYCL.Len 440"},
      {"= @STEP", "STEP"},
      {"@ALIAS = shared", "ALIAS 12"},
      {"= @shared", "shared 0"},
      {"SAME[1].@target", "Axis.target 427"},
      {"@nobody", "nothing"},
      {"nobody.@target", "nothing"},
      {"@_Wait", "_Wait"},
      {"@_Movilink", "_MoviLink"},
      {"left[0x1].@target", "Axis.target 427"},
      {"left[1].@nothing", "nothing"},
  };
  for (const auto& [text, meaning] : rows) EXPECT_EQ(means(text), meaning) << text;
}

// The name behind '@' in `text`: the member of Axis it means.
std::string member_meant(const std::string& text) {
  std::string source =
      "typedef struct { long target; long steps[2]; } Axis;\nAxis left[2], one, target; MOVLNK Ml; long "
      "n;\n" +
      text;
  const size_t mark = source.find('@');
  source.erase(mark, 1);
  const compiler::ProgramIndex index = index_of(source);
  const Occurrence* found = index.at(*index.main, static_cast<uint32_t>(mark));
  if (found == nullptr) return "nothing";
  return index.symbols[found->symbol].name + (found->number ? " " + std::to_string(*found->number) : "");
}

TEST(IndexOfAnyText, FollowsTheObjectsInFrontOfADot) {
  // left is H420 to H425, one H426 to H428, target, which is called like a member, H429 to H431.
  const std::pair<const char*, const char*> rows[] = {
      {"main() { left[n + 1].@target = 1; }", "target"},
      {"main() { left[1].@target = 1; }", "target 423"},
      {"main() { left[-1].@target = 1; }", "target"},
      {"main() { left[n = 1].@target = 1; }", "target"},
      {"main() { left[n * (n - 1)].@target = 1; }", "target"},
      {"main() { left[left[1].target].@target = 1; }", "target"},
      {"main() { left[left[1].@target].target = 1; }", "target 423"},
      {"main() { (one).@target = 1; }", "target 426"},
      {"main() { ((one)).@steps[0] = 1; }", "steps 427"},
      {"main() { f(n, one).@target = 1; }", "target 426"},
      {"main() { one[0].@target = 1; }", "nothing"},
      {"main() { left[0][1].@target = 1; }", "nothing"},
      {"main() { one->@target = 1; }", "target 426"},
      {"main() { one + .@target = 1; }", "nothing"},
      {"main() { n.@target = 1; }", "nothing"},
      {"main() { one.steps.@target = 1; }", "nothing"},
      {"main() { one.target.@steps[0] = 1; }", "nothing"},
      {"main() { target.@steps[0] = 1; }", "steps 430"},
      {"main() { one.steps[1].@target = 1; }", "nothing"},
      {"main() { left[1].@ta = 1; }", "nothing"},
      // Text that is not finished: a ';' or a '{' ends what is open in front of it.
      {"main() { left[ ; 1].@target = 1; }", "nothing"},
      {"main() { left[ { 1].@target = 1; }", "nothing"},
      {"main() { left[ ( 1].@target = 1; }", "target"},
      {"main() { left 1].@target = 1; }", "nothing"},
      {"main() { left[1].target = 1; one.@", "nothing"},
      {"main() { Ml.Index = @8318; }", "8318 8318"},
      {"main() { Ml.Index = 1 + @8318; }", "nothing"},
      {"main() { Ml.Index += @8318; }", "nothing"},
      {"main() { one.target = @8318; }", "nothing"},
      {"main() { Ml.Index; n = @8318; }", "nothing"},
      {"main() { Ml.Index; = @8318; }", "nothing"},
  };
  for (const auto& [text, meant] : rows) EXPECT_EQ(member_meant(text), meant) << text;
}

// In a macro that nobody uses: a variable is what it is everywhere, a member could be of any object.
TEST(IndexOfAnyText, NamesInTheBodyOfAMacro) {
  EXPECT_EQ(member_meant("#define M @target\nmain() { }"), "target 429");
  EXPECT_EQ(member_meant("#define M (1 + @target)\nmain() { }"), "target 429");
  EXPECT_EQ(member_meant("#define M one.@target\nmain() { }"), "nothing");
  EXPECT_EQ(member_meant("#define M one->@target\nmain() { }"), "nothing");
  EXPECT_EQ(member_meant("#define N 5\n#define M one.@N\nmain() { }"), "nothing");
  EXPECT_EQ(member_meant("#define N 5\n#define M (@N)\nmain() { }"), "N");
}

// An editor asks while the size is typed: the index declares what the check has given up.
TEST(IndexOfAnyText, UnknownNamesInDeclarations) {
  for (const std::string text : {"long v[LAST + 1], w;\nmain() { w = 1; }", "#pragma globals LAST 5\nlong w;\nmain() { w = 1; }",
                                 "#declare LAST NOBODY + 1\nlong w;\nmain() { w = 1; }"}) {
    const compiler::ProgramIndex index = index_of(text);
    EXPECT_NE(index.find("w"), nullptr) << text;
  }
}

// A declaration that reaches around its name is the extent of it; one that a macro has brought elsewhere is not.
TEST(IndexOfAnyText, TheExtentOfADeclarationHasItsNameInIt) {
  const std::string source =
      "#define NAME first\n#define DECLARATION long second\n#define WHOLE long third;\n"
      "long NAME;\nDECLARATION;\nWHOLE\nlong fourth, fifth[2];\n"
      "seventh() { fourth = 1; }\n";
  const compiler::ProgramIndex index = index_of(source);
  const auto extent = [&](const char* name) {
    const IndexedSymbol* found = index.find(name, "");
    if (found == nullptr || !found->definition) return std::string("none");
    EXPECT_EQ(source.substr(found->definition->begin, found->definition->end - found->definition->begin),
              name);
    return source.substr(found->extent.begin, found->extent.end - found->extent.begin);
  };
  EXPECT_EQ(extent("first"), "first");
  EXPECT_EQ(extent("third"), "long third;");
  EXPECT_EQ(extent("fourth"), "long fourth, fifth[2];");
  EXPECT_EQ(extent("fifth"), "long fourth, fifth[2];");
  EXPECT_EQ(extent("seventh"), "seventh() { fourth = 1; }");
}

TEST_F(Index, KnowsTheNumberOfAParameter) {
  const Occurrence* found = find("= @8318", kSource, *index_.main);
  ASSERT_NE(found, nullptr);
  EXPECT_EQ(index_.symbols[found->symbol].kind, SymbolKind::Parameter);
  EXPECT_EQ(index_.symbols[found->symbol].number, 8318U);
}

TEST_F(Index, FindsTheOccurrenceAnOffsetTouches) {
  const auto first = static_cast<uint32_t>(kSource.find("kept"));
  const auto is_kept = [&](uint32_t offset) {
    const Occurrence* found = index_.at(*index_.main, offset);
    return found != nullptr && index_.symbols[found->symbol].name == "kept";
  };
  EXPECT_FALSE(is_kept(first - 1));
  for (uint32_t n = 0; n <= 4; ++n) EXPECT_TRUE(is_kept(first + n)) << n;
  EXPECT_FALSE(is_kept(first + 5));
  for (size_t n = 1; n < index_.occurrences.size(); ++n) {
    const compiler::Place& before = index_.occurrences[n - 1].place;
    const compiler::Place& here = index_.occurrences[n].place;
    EXPECT_TRUE(before.file != here.file || before.end <= here.begin) << "in order, no two at one place";
  }
}

TEST_F(Index, KnowsEverySymbol) {
  const auto told = [&](const char* name, const char* container = "") {
    const IndexedSymbol* found = index_.find(name, container);
    if (found == nullptr) return std::string("none");
    std::string out =
        found->definition ? text_of(*found->definition) + " in <" + text_of(found->extent) + ">" : "built in";
    out += " type <" + found->type + ">";
    if (!found->structure.empty()) out += " of " + found->structure;
    if (found->number) out += " from " + std::to_string(*found->number);
    out += " x " + std::to_string(found->count);
    return out + (found->array ? " array" : "") + (found->initial ? " initial" : "");
  };
  EXPECT_EQ(told("N"), "N in <N 5> type <5> x 1");
  EXPECT_EQ(told("WIDE"), "WIDE in <WIDE (N + lSpeed)> type <(N + lSpeed)> x 1");
  EXPECT_EQ(told("EMPTY"), "EMPTY in <EMPTY> type <> x 1");
  EXPECT_EQ(told("Axis"), "Axis in <typedef struct { long target; long steps[2]; } Axis;> type <> x 3");
  EXPECT_EQ(told("target", "Axis"), "target in <target> type <long> from 0 x 1");
  EXPECT_EQ(told("steps", "Axis"), "steps in <steps> type <long[2]> from 1 x 2 array");
  EXPECT_EQ(told("v"), "v in <long lSpeed, v[3];> type <long[3]> from 421 x 3 array");
  EXPECT_EQ(told("kept"), "kept in <initial long kept;> type <long> from 1 x 1 initial");
  EXPECT_EQ(told("left"), "left in <Axis left[2];> type <Axis[2]> of Axis from 424 x 6 array");
  EXPECT_EQ(told("Ml"), "Ml in <MOVLNK Ml;> type <MOVLNK> of MOVLNK from 430 x 7");
  EXPECT_EQ(told("ALIAS").substr(0, 9), "ALIAS in ");
  EXPECT_EQ(told("helper"), "helper in <helper() { }> type <> x 1");
  EXPECT_EQ(told("MOVLNK"), "built in type <> x 7");
  EXPECT_EQ(told("Index", "MOVLNK"), "built in type <long> from 4 x 1");
  EXPECT_EQ(told("Cycletime", "SCTRCYCL"), "built in type <long> from 1 x 1");
  EXPECT_EQ(told("H7"), "built in type <long> from 7 x 1");
  EXPECT_EQ(told("_Wait"), "built in type <value> x 1");
  EXPECT_EQ(told("target"), "none") << "a member has its container";
  EXPECT_EQ(told("8318"), "none") << "parameters are no names";
  EXPECT_EQ(told("nobody"), "none");
  const std::pair<const char*, SymbolKind> kinds[] = {{"N", SymbolKind::Macro},
                                                      {"v", SymbolKind::Variable},
                                                      {"ALIAS", SymbolKind::Alias},
                                                      {"main", SymbolKind::Function},
                                                      {"Axis", SymbolKind::Structure},
                                                      {"H7", SymbolKind::RawVariable},
                                                      {"_Wait", SymbolKind::SystemFunction}};
  for (const auto& [name, kind] : kinds) EXPECT_EQ(index_.find(name)->kind, kind) << name;
  EXPECT_EQ(index_.find("target", "Axis")->kind, SymbolKind::Member);
  EXPECT_EQ(std::count_if(index_.symbols.begin(), index_.symbols.end(),
                          [](const IndexedSymbol& one) { return one.kind == SymbolKind::Parameter; }),
            2);
}

TEST_F(Index, TakesAFileThatIsIncludedTwiceAsOne) {
  EXPECT_EQ(index_.file("/p/A.IPC"), index_.main);
  EXPECT_EQ(index_.file("nowhere"), nullptr);
  const compiler::SourceFile* header = index_.file("/p/own.h");
  ASSERT_NE(header, nullptr);
  ASSERT_EQ(index_.includes.size(), 2U);
  EXPECT_EQ(text_of(index_.includes[0].header), "\"own.h\"");
  EXPECT_EQ(index_.includes[0].file, header);
  EXPECT_EQ(text_of(index_.includes[1].header), "\"lib/../own.h\"");
  const Occurrence* shared = find("long @shared", kHeader, *header);
  ASSERT_NE(shared, nullptr);
  EXPECT_TRUE(shared->definition);
  EXPECT_EQ(index_.symbols[shared->symbol].definition->file, header);
  const Occurrence* guard = find("#ifndef @OWN", kHeader, *index_.includes[1].file);
  EXPECT_NE(guard, nullptr);
}

}  // namespace
}  // namespace ipos::tests

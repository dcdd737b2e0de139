// The blocks compile without a warning, alone and all together, and cost what their page says; its programs are right.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>

#include "compiler/analysis/timing.hpp"
#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "stdlib/headers.hpp"
#include "stdlib/unit_types.hpp"
#include "tests/docs/page.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

const char* const kPage = "docs/reference/blocks.md";

// "#define RAMP_STEP StepRamp": the names that the header gives to its structure and functions.
std::map<std::string, std::string> names_of(std::string_view header) {
  static const std::regex define("#ifndef (\\w+)\n#define (\\w+) (\\w+)\n#endif\n");
  std::map<std::string, std::string> names;
  const std::string text(header);
  for (std::sregex_iterator match(text.begin(), text.end(), define), end; match != end; ++match) {
    EXPECT_EQ((*match)[1], (*match)[2]);
    names[(*match)[1]] = (*match)[3];
  }
  return names;
}

std::string calls_of(const std::map<std::string, std::string>& names) {
  std::string calls;
  for (const auto& [macro, name] : names)
    if (!macro.ends_with("_BLOCK")) calls += name + "();\n";
  return calls;
}

compiler::Compilation compiled(const std::string& text) {
  compiler::CompileOptions options;
  EXPECT_TRUE(options.warnings.apply("all"));
  compiler::Compilation made = compiler::compile("MAIN.IPC", "", text, options);
  EXPECT_EQ(compiler::render_text(made.diagnostics.all(), *made.sources, false), "") << text;
  return made;
}

// "| `blocks/ramp.h` | `RAMP_STEP` | 7 | 12 | 4 |" as its cells behind the function.
std::map<std::string, std::string> rows_of_page() {
  static const std::regex row("\\| `(blocks/\\w+\\.h)` \\| `(\\w+)` \\| (.*) \\|");
  std::istringstream lines(read_text(project(kPage)));
  std::map<std::string, std::string> rows;
  std::smatch match;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_match(line, match, row)) rows[match[1].str() + " " + match[2].str()] = match[3];
  return rows;
}

TEST(Blocks, CostWhatTheirPageSays) {
  std::map<std::string, std::string> real;
  for (const stdlib::EmbeddedFile& file : stdlib::blocks::embedded_files()) {
    const auto names = names_of(file.text);
    const compiler::Compilation made = compiled(fmt::format("#include <{}>\nmain()\n{{\n{}}}\n", file.name, calls_of(names)));
    ASSERT_TRUE(made.image) << file.name;
    const vm::Image& image = *made.image;
    size_t variables = 0;
    for (const vm::Symbol& symbol : image.symbols) variables += symbol.count;
    for (const compiler::FunctionTiming& row : compiler::function_timings(image, 512, {1, 1, 1}))
      for (const auto& [macro, name] : names) {
        if (row.name != name) continue;
        size_t n = 0;
        while (image.functions[n].name != name) ++n;
        const size_t end = n + 1 < image.functions.size() ? image.functions[n + 1].address : image.code.size();
        real[std::string(file.name) + " " + macro] =
            fmt::format("{} | {} | {}", row.commands ? std::to_string(*row.commands) : "-", end - image.functions[n].address, variables);
      }
  }
  EXPECT_EQ(rows_of_page(), real);
}

// Each with two instances, in one program of a drive.
TEST(Blocks, AllInOneProgram) {
  std::string text = "#pragma globals 200 399\n", body;
  for (const stdlib::EmbeddedFile& file : stdlib::blocks::embedded_files()) {
    const auto names = names_of(file.text);
    for (const auto& [macro, name] : names) text += fmt::format("#define {} My{}\n", macro, name);
    text += fmt::format("#include <{}>\n#include <{}>\n", file.name, file.name);
    body += calls_of(names);
    for (const auto& [macro, name] : names)
      if (!macro.ends_with("_BLOCK")) body += "My" + name + "();\n";
  }
  EXPECT_TRUE(compiled(text + "main()\n{\n" + body + "}\n").image);
}

// Its comment tells of each member, and how names are given.
TEST(Blocks, HeadersTellTheirMembers) {
  for (const stdlib::EmbeddedFile& file : stdlib::blocks::embedded_files()) {
    const std::string text(file.text);
    EXPECT_TRUE(text.starts_with(fmt::format("// {}: ", file.name))) << file.name;
    const std::string comment = text.substr(0, text.find("\n#"));
    EXPECT_NE(comment.find(kPage), std::string::npos) << file.name;
    const size_t begin = text.find("typedef struct {") + 16;
    std::istringstream members(text.substr(begin, text.find('}', begin) - begin));
    for (std::string type, name; members >> type >> name;) {
      name.pop_back();
      EXPECT_TRUE(std::regex_search(comment, std::regex("\n//   ([a-z, ]+, )?" + name + "(, [a-z, ]+)? +(in|out|own)\\b")))
          << file.name << ": " << name;
    }
  }
}

TEST(Blocks, ProgramsOfThePageAreRight) {
  std::set<std::string> used;
  for (const Block& block : blocks_of(read_text(project(kPage)))) {
    ASSERT_EQ(block.language, "ipc");
    EXPECT_EQ(compile_block(block).messages, "") << block.text;
    for (const stdlib::EmbeddedFile& file : stdlib::blocks::embedded_files())
      if (block.text.find(fmt::format("<{}>", file.name)) != std::string::npos) used.insert(std::string(file.name));
  }
  EXPECT_GE(used.size(), 9U);
}

// As an editor of Windows spells them, and one that is not there.
TEST(Blocks, AreFoundInEverySpelling) {
  EXPECT_TRUE(compiled("#include \"Blocks\\RAMP.H\"\nmain() { StepRamp(); }").image);
  compiler::Compilation wrong = compiler::compile("MAIN.IPC", "", "#include <blocks/rampe.h>\nmain() { }");
  ASSERT_TRUE(wrong.diagnostics.has_errors());
  EXPECT_NE(compiler::render_text(wrong.diagnostics.all(), *wrong.sources, false).find("blocks/ramp.h"), std::string::npos);
}

}  // namespace
}  // namespace ipos::tests

// Pages are read line by line; blocks are compiled by the libraries, not by the program.
#include "tests/docs/page.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <sstream>

#include "compiler/asm/assembler.hpp"
#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"

namespace ipos::tests {
namespace {

constexpr int kLastLevel = 100;

std::string utf16(const std::string& text) {
  std::string out = "\xFF\xFE";
  for (const char c : text) out += {c, '\0'};
  return out;
}

std::optional<std::string> level_file(std::string_view path) {
  if (!path.starts_with("level") || !path.ends_with(".h")) return std::nullopt;
  int level = 0;
  std::from_chars(path.data() + 5, path.data() + path.size() - 2, level);
  if (level < 1 || level > kLastLevel) return std::nullopt;
  return level == kLastLevel ? "" : "#include \"level" + std::to_string(level + 1) + ".h\"\n";
}

Compiled result_of(const compiler::Diagnostics& diagnostics, const compiler::SourceMap& sources) {
  Compiled out;
  for (const compiler::Diagnostic& one : diagnostics.all())
    out.codes.emplace_back(compiler::info(one.diag).code);
  out.messages = compiler::render_text(diagnostics.all(), sources, false);
  out.good = !diagnostics.has_errors();
  return out;
}

Compiled assemble_block(const Block& block) {
  compiler::SourceMap sources;
  compiler::Diagnostics diagnostics;
  const bool made =
      compiler::assemble(sources.add("MAIN.ipa", "MAIN.ipa", block.text), diagnostics).has_value();
  Compiled out = result_of(diagnostics, sources);
  EXPECT_EQ(made, out.good);
  return out;
}

}  // namespace

std::vector<Block> blocks_of(const std::string& page) {
  constexpr std::string_view kOptions = "<!-- ipos: ";
  std::vector<Block> blocks;
  std::string heading, options;
  bool inside = false;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) {
      if (!inside) blocks.push_back({line.substr(3), heading, options, ""});
      options.clear();
      inside = !inside;
    } else if (inside) {
      blocks.back().text += line + "\n";
    } else if (line.starts_with(kOptions) && line.ends_with(" -->")) {
      options = line.substr(kOptions.size(), line.size() - kOptions.size() - 4);
    } else if (!line.empty()) {
      heading = line;
    }
  }
  return blocks;
}

Compiled compile_block(const Block& block) {
  if (block.language == "ipa") return assemble_block(block);
  EXPECT_EQ(block.language, "ipc");
  std::string text = block.text;
  compiler::CompileOptions options;
  if (block.options.starts_with("--unit ")) {
    options.unit = stdlib::find_unit(std::string_view(block.options).substr(7));
    EXPECT_NE(options.unit, nullptr) << block.options;
  } else if (block.options.starts_with("-W")) {
    EXPECT_TRUE(options.warnings.apply(std::string_view(block.options).substr(2))) << block.options;
  } else if (block.options == "beside the unit's speed") {
    options.is_unit_value = [](const stdlib::UnitType&, std::string_view name) { return name == "speed"; };
  } else if (block.options == "encode as UTF-16") {
    text = utf16(text);
  } else {
    EXPECT_EQ(block.options, "");
  }
  options.read_file = [&text](const std::string& path) {
    return path == "MAIN.IPC" ? std::optional(text) : level_file(path);
  };
  const compiler::Compilation compiled = compiler::compile("MAIN.IPC", "MAIN.IPC", text, options);
  Compiled out = result_of(compiled.diagnostics, *compiled.sources);
  EXPECT_EQ(compiled.image.has_value(), out.good);
  return out;
}

}  // namespace ipos::tests

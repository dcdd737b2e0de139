// Runs the front end on texts kept in memory, for the frontend_* tests.
#pragma once

#include <map>
#include <regex>
#include <string>
#include <vector>

#include "compiler/ast/print.hpp"
#include "compiler/parse/parse.hpp"

namespace ipos::tests {

struct FrontendRun {
  using Files = std::map<std::string, std::string>;

  explicit FrontendRun(std::string source, Files others = {}, compiler::PreprocessOptions with = {},
                       compiler::WarningOptions warnings = {})
      : files(std::move(others)), options(std::move(with)), diagnostics(warnings) {
    if (!options.read_file) {
      options.read_file = [this](const std::string& path) -> std::optional<std::string> {
        const auto found = files.find(path);
        return found == files.end() ? std::nullopt : std::optional(found->second);
      };
    }
    main = &map.add("t.IPC", "t.IPC", std::move(source));
  }

  FrontendRun& parse() {
    program = compiler::parse_program(map, *main, options, diagnostics);
    return *this;
  }
  std::string tokens() {
    return compiler::print_tokens(map, *main, compiler::preprocess(map, *main, options, diagnostics));
  }
  // Texts of the tokens with blanks between them.
  std::string words() {
    std::string all;
    for (const compiler::Token& token : compiler::preprocess(map, *main, options, diagnostics).tokens)
      if (!token.text.empty()) all += (all.empty() ? "" : " ") + std::string(token.text);
    return all;
  }
  std::string tree() const { return compiler::ast::print(program, map); }
  // "E0150 1:15" each, with the file in front of the line when it is not the main file.
  std::vector<std::string> messages() const {
    std::vector<std::string> all;
    for (const compiler::Diagnostic& one : diagnostics.all()) {
      const compiler::Position at = map.position(one.span.begin);
      std::string place = std::to_string(at.line) + ":" + std::to_string(at.column);
      if (at.file != main) place = (at.file == nullptr ? "?" : at.file->name) + ":" + place;
      all.push_back(std::string(compiler::info(one.diag).code) + " " + place);
    }
    return all;
  }

  Files files;
  compiler::PreprocessOptions options;
  compiler::SourceMap map;
  compiler::Diagnostics diagnostics;
  const compiler::SourceFile* main = nullptr;
  compiler::ast::Program program;
};

using Messages = std::vector<std::string>;

// The tree without its places.
inline std::string shape_of_program(const FrontendRun& run) {
  static const std::regex kPlace("\\d+:\\d+ ");
  return std::regex_replace(run.tree(), kPlace, "");
}

inline Messages messages_of(const std::string& source) { return FrontendRun(source).parse().messages(); }

}  // namespace ipos::tests

// Results as GitHub shows them beside the lines of a change: workflow commands on standard output.
#include <fmt/format.h>

#include <filesystem>

#include "tools/cli/xml_text.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

// Both escape what would end the command; a property also what would end the property.
std::string escaped(std::string_view text, bool property) {
  std::string out;
  for (const char c : utf8(text)) {
    const bool special = c == '%' || c == '\r' || c == '\n' || (property && (c == ':' || c == ','));
    out += special ? fmt::format("%{:02X}", c) : std::string(1, c);
  }
  return out;
}

}  // namespace

std::string github_annotation(std::string_view weight, const std::string& root, const std::string& file,
                              runtime::FilePlace place, const std::string& title, const std::string& text) {
  namespace fs = std::filesystem;
  const std::string path =
      root.empty() ? file : fs::absolute(file).lexically_normal().lexically_relative(root).generic_string();
  return fmt::format("::{} file={},line={},col={},title={}::{}\n", weight, escaped(path, true), place.line,
                     place.column, escaped(title, true), escaped(text, false));
}

std::string github_annotations(const TestResult& result, const std::string& root) {
  std::string text;
  if (result.outcome == Outcome::Malformed)
    text += github_annotation("error", root, result.file, result.place, result.name, result.messages);
  for (const Finding& finding : result.findings)
    text +=
        github_annotation("error", root, finding.file, finding.place, result.name,
                   finding.note.empty() ? finding.text : fmt::format("{}\n({})", finding.text, finding.note));
  return text;
}

}  // namespace ipos::tools::testing

// Units are listed by the table alone: product code has no list of their names as text, and each list on a page is one that
// the table gives.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "stdlib/unit_names.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;

const fs::path kRoot = IPOS_SOURCE_DIR;

std::string name_pattern() {
  std::string pattern;
  for (const stdlib::UnitType& unit : stdlib::unit_types())
    pattern += (pattern.empty() ? "\\b(?:" : "|") + std::string(unit.name);
  return pattern + ")\\b";
}

// Names with nothing but quotes, commas, "and" and "or" between them.
std::regex list_of(const std::string& least) {
  const std::string name = name_pattern();
  return std::regex(name + "(?:[\"'`]?(?:,? ?(?:or|and)|,)? ?[\"'`]?" + name + "){" + least + "}");
}

// Lists in the text files below `folder`, with their places; what the build made is left out.
template <typename Action>
void for_each_list(const fs::path& folder, const std::set<std::string>& endings, const std::regex& list, Action action) {
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const fs::path relative = fs::relative(entry.path(), kRoot);
    if (!entry.is_regular_file() || !endings.contains(entry.path().extension().string())) continue;
    if (relative.string().find("node_modules") != std::string::npos) continue;
    std::ifstream in(entry.path());
    std::string line;
    for (int number = 1; std::getline(in, line); ++number)
      for (std::sregex_iterator match(line.begin(), line.end(), list), end; match != end; ++match)
        action(relative, number, match->str());
  }
}

TEST(UnitLists, ProductCodeHasNone) {
  const std::set<std::string> endings = {".cpp", ".hpp", ".h", ".def", ".y", ".py", ".ts", ".tsx", ".js", ".mjs", ".html"};
  for (const char* folder : {"compiler", "embed", "python", "runtime", "stdlib", "tools", "vm", "web/src"})
    for_each_list(folder, endings, list_of("1"), [](const fs::path& file, int line, const std::string& list) {
      ADD_FAILURE() << file.string() << ":" << line << ": \"" << list << "\": ask stdlib/unit_names.hpp";
    });
}

// What is made of the table and checked against it elsewhere.
const std::set<std::string> kMade = {"docs/inside/drive.md", "docs/reference/limits.md"};

TEST(UnitLists, PagesListThoseOfTheTable) {
  const std::regex between("[\"'`]?(?:,? ?(?:or|and)|,)? [\"'`]?");
  std::set<std::string> known = {stdlib::unit_names(), stdlib::program_unit_names()};
  for_each_list("docs", {".md"}, list_of("2,"), [&](const fs::path& file, int line, const std::string& list) {
    if (kMade.contains(file.string())) return;
    const std::string plain = std::regex_replace(list, between, ", ");
    EXPECT_TRUE(known.contains(plain)) << file.string() << ":" << line << ": " << plain;
  });
}

// The table of units in docs/reference/stdlib.md.
TEST(UnitLists, ThePageHasTheRowsOfTheTable) {
  constexpr const char* kFamilies[] = {
#define FAMILY(name, ...) #name,
#include "stdlib/unit_families.def"
  };
  std::ifstream in(kRoot / "docs/reference/stdlib.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    std::string objects;
    for (const stdlib::ObjectClass& one : unit.objects)
      objects += (objects.empty() ? "" : ", ") + std::to_string(one.objects) + " of " + stdlib::cycle_text(one);
    std::ostringstream row;
    row << "| " << unit.name << " | " << kFamilies[static_cast<size_t>(unit.family)] << " | " << unit.lists << " | "
        << unit.variables << " | " << int{unit.tasks} << " | " << objects << " |\n";
    EXPECT_NE(page.find(row.str()), std::string::npos) << row.str();
  }
}

// The editor's settings are JSON and cannot ask: "", then the units that run programs.
TEST(UnitLists, TheEditorOffersThoseWithPrograms) {
  std::ifstream in(kRoot / "tools/vscode/package.json");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::string choices = "\"enum\": [\"\"";
  std::istringstream names(stdlib::program_unit_names());
  for (std::string name; std::getline(names >> std::ws, name, ',');) choices += ", \"" + name + "\"";
  EXPECT_NE(text.find(choices + "]"), std::string::npos) << choices;
}

}  // namespace
}  // namespace ipos::tests

// Searches folders.
#include "tools/test_file/read_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "runtime/plant_file/toml_kind.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools::testing {
namespace {

namespace fs = std::filesystem;

// Looked for in the text, so that a plant with mistakes is a test, too, and other people's TOML is none.
bool is_plant_with_expectations(const std::string& path, const std::string& text) {
  const auto has_line = [&text](const std::string& line) {
    return text.starts_with(line) || text.find("\n" + line) != std::string::npos;
  };
  return path.ends_with(".toml") && !runtime::named_test(path) && has_line("[[station]]") && has_line("[[expect]]");
}

// A plant whose own expectations a test looks at needs no run of its own.
void leave_out_plants(std::vector<TestCase>& tests) {
  std::set<std::string> looked_at;
  for (const TestCase& test : tests)
    if (test.plant_expects) looked_at.insert(fs::path(test.plant_path).lexically_normal().generic_string());
  std::erase_if(tests, [&](const TestCase& test) { return looked_at.contains(test.file); });
}

std::vector<TestCase> tests_of(const std::string& path, const std::string& text) {
  if (!is_source(path)) return read_test_file(path, text);
  std::vector<TestCase> tests;
  tests.push_back(read_program_test(path, text));
  return tests;
}

}  // namespace

std::vector<TestCase> read_tests(const std::string& path) {
  if (!is_folder(path)) {
    if (!is_source(path) && !path.ends_with(".toml") && fs::exists(fs::symlink_status(path)))
      throw Failure(kUsage, fmt::format("{}: a test is a folder, a .toml file or an .IPC source", path));
    return tests_of(path, read_file(path));
  }
  std::vector<std::string> files;
  for (const std::string& file : files_below(path))
    if (file.ends_with(".toml") || is_source(file))
      files.push_back(fs::path(file).lexically_normal().generic_string());
  std::vector<TestCase> tests;
  for (const std::string& file : files) {
    const std::string text = read_file(file);
    if (!runtime::named_test(file) && !is_plant_with_expectations(file, text) &&
        !(is_source(file) && expects_something(text)))
      continue;
    for (TestCase& test : tests_of(file, text)) tests.push_back(std::move(test));
  }
  leave_out_plants(tests);
  return tests;
}

}  // namespace ipos::tools::testing

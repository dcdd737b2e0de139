// Which files there are is found anew each time: the plant file may name others by now.
#include "tools/serve/plant_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "runtime/plant_file/plant_file.hpp"
#include "stdlib/plain_text.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/examples/examples.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/sources.hpp"
#include "tools/lsp_base/positions.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/debugged_test.hpp"
#include "tools/testing/reports.hpp"
#include "tools/testing/run_test.hpp"

namespace ipos::tools::serve {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostText = 1024 * 1024;  // of a file that is written (ours)
constexpr std::string_view kSession = ".ipos";

std::string name_of(const std::string& path) { return fs::path(path).filename().string(); }

fs::path whole(const std::string& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  const fs::path real = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : real;
}

bool is_below(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

// The language server has no other names for documents than those.
std::string uri_of_file(const std::string& path) {
  std::error_code error;
  return lsp::uri_of(fs::absolute(path, error).lexically_normal().generic_string());
}

}  // namespace

PlantFiles::PlantFiles(std::string path, CompileFlags compile, std::string read_only,
                       std::optional<sessions::OfTest> test)
    : path_(std::move(path)), compile_(std::move(compile)), read_only_(std::move(read_only)), test_(std::move(test)) {}

std::vector<std::string> PlantFiles::programs() const {
  if (!is_plant(path_)) return {path_};
  std::vector<std::string> all;
  const auto plant = try_read_file(path_);
  if (!plant) return all;
  for (const runtime::StationConfig& station : runtime::read_plant_file(*plant).plant.stations) {
    if (station.program.empty()) continue;
    const std::string program = beside(path_, station.program);
    if (std::find(all.begin(), all.end(), program) == all.end()) all.push_back(program);
  }
  return all;
}

// In the folder of the plant or of a program, or below it.
bool PlantFiles::is_near(const std::string& file, const std::vector<std::string>& programs) const {
  const fs::path at = whole(file);
  const auto has = [&at](const std::string& other) { return is_below(at, whole(other).parent_path()); };
  return has(path_) || std::any_of(programs.begin(), programs.end(), has);
}

std::vector<Files::Entry> PlantFiles::list() {
  std::vector<Entry> all;
  const auto add = [&](const std::string& name, Kind kind, std::string read_only) {
    const auto is_it = [&](const Entry& one) { return one.name == name; };
    if (std::any_of(all.begin(), all.end(), is_it)) return;
    all.push_back({name, kind, uri_of_file(name), read_only_.empty() ? std::move(read_only) : read_only_});
    read_.insert(name);
  };
  if (test_) add(test_->file, Kind::Test, "");
  if (is_plant(path_)) add(path_, Kind::Plant, "");
  const std::vector<std::string> programs = this->programs();
  for (const std::string& program : programs) {
    if (!is_source(program)) continue;  // an image has no text
    add(program, Kind::Program, "");
    try {
      for (const std::string& file : included_files(program, compile_))
        add(file, Kind::Include,
            is_near(file, programs) ? "" : "it lies outside of the folders of the plant and its programs");
    } catch (const Failure&) {  // it is not there by now
    }
  }
  std::vector<std::string> names{name_of(path_)};
  for (const std::string& program : programs) names.push_back(name_of(program));
  const fs::path folder = fs::path(path_).parent_path();
  std::vector<std::string> beside_it = list_files(folder.string());
  std::sort(beside_it.begin(), beside_it.end());
  for (const std::string& file : beside_it) {
    const std::string path = (folder / file).generic_string();
    if (file.ends_with(kSession)) add(path, Kind::Session, "");
    if (!runtime::named_test(file)) continue;
    const auto text = try_read_file(path);
    // By its text, so that a test with a mistake is still one of them.
    const auto tells_of = [&](const std::string& name) { return text->find(name) != std::string::npos; };
    if (text && std::any_of(names.begin(), names.end(), tells_of)) add(path, Kind::Test, "");
  }
  return all;
}

std::optional<std::string> PlantFiles::compiled(const std::string& file) {
  read_.insert(file);
  return source_text(file);
}

std::optional<std::string> PlantFiles::text(const std::string& file) {
  const auto is_it = [&](const Entry& one) { return one.name == file; };
  if (!read_.contains(file)) {
    const std::vector<Entry> all = list();
    if (std::none_of(all.begin(), all.end(), is_it)) return std::nullopt;
  }
  return try_read_file(file);
}

// A name in the folder of the plant, with or without that folder.
std::string PlantFiles::place_of_new(const std::string& file) const {
  const fs::path name = fs::path(file).filename();
  const fs::path place = fs::path(path_).parent_path() / name;
  const bool is_here = fs::path(file) == name || fs::path(file).lexically_normal() == place.lexically_normal();
  const std::string text = name.string();
  if (!is_here || text.starts_with('.') || !stdlib::is_plain(text) || text.find('\\') != std::string::npos ||
      !(runtime::named_test(text) || text.ends_with(kSession)))
    throw Mistake(fmt::format("'{}' is none of the plant's files; new ones are tests (NAME.test.toml) and sessions "
                              "(NAME.ipos) in the folder of the plant",
                              file));
  return place.generic_string();
}

std::string PlantFiles::write(const std::string& file, const std::string& text) {
  if (!read_only_.empty()) throw Mistake(read_only_);
  if (text.size() > kMostText) throw Mistake(fmt::format("{}: more than 1 MB is not written", file));
  const std::vector<Entry> all = list();
  const auto known = std::find_if(all.begin(), all.end(), [&](const Entry& one) { return one.name == file; });
  if (known != all.end() && !known->read_only.empty()) throw Mistake(fmt::format("{}: {}", file, known->read_only));
  const std::string place = known != all.end() ? file : place_of_new(file);
  rewrite_file(place, text);
  return place;
}

debug::Debuggee debuggee_of(const sessions::OfTest& test, const CompileFlags& compile) {
  return testing::debugged_test(testing::chosen_test(test.file, test.test_case), compile,
                                {.speed = test.speed, .seed = test.seed});
}

Build PlantFiles::build() {
  Build build;
  BuildRecord record;
  CompileFlags flags = compile_;
  flags.record = &record;
  try {
    if (kind_of_file(path_) != runtime::TomlKind::Test) {  // a plant that stands in a test is read with it
      PlantInput input = read_plant_input(path_, flags);
      tell_objects(*make_plant(input, runtime::FileUse::Look, {}, execution_of(), &record), &record);  // and what its units refuse
      for (const runtime::StationConfig& station : input.file.stations) build.stations.push_back(station.name);
      build.programs = input.programs;
      build.make.emplace([input = std::move(input)] { return make_plant(input, runtime::FileUse::Look); });
    }
    if (test_) build.make = debuggee_of(*test_, compile_);
  } catch (const Failure& failure) {
    build.make.reset();
    if (*failure.what() != '\0')
      record.tell({"error", "", 0, 0, failure.what()});
    else if (record.messages.empty())
      record.tell({"error", test_ ? test_->file : "", 0, 0, "the test cannot run; ipos test tells why"});
  }
  for (const auto& [file, text] : record.texts) read_.insert(file);
  build.texts = std::move(record.texts);
  build.messages = std::move(record.messages);
  return build;
}

std::string PlantFiles::test(const std::vector<std::string>& files) {
  testing::Programs programs(compile_);
  std::vector<testing::TestResult> results;
  try {
    for (const std::string& file : files)
      for (const testing::TestCase& test : testing::read_tests(file))
        results.push_back(testing::run_test(test, programs, {}));
  } catch (const Failure& failure) {
    throw Mistake(failure.what());
  }
  return testing::json_report(results);
}

Texts PlantFiles::templates() {
  Texts programs;
  for (const auto& [name, text] : template_files())
    if (is_source(name)) programs[name] = text;
  programs["an empty program"] = kEmptyProgram;
  return programs;
}

}  // namespace ipos::tools::serve

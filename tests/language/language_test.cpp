// Every *.IPC in this folder is a test: compiled, run as a plant of one station, compared with its comments.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/signals/variables.hpp"
#include "tests/language/expectations.hpp"

namespace ipos::tests {
namespace {

namespace fs = std::filesystem;
using runtime::Time;

constexpr Time kLimit = 10 * runtime::kSecond;  // a program that takes longer does not end

std::vector<std::string> programs() {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(IPOS_LANGUAGE_DIR))
    if (entry.path().extension() == ".IPC")
      names.push_back(fs::relative(entry.path(), IPOS_LANGUAGE_DIR).generic_string());
  std::sort(names.begin(), names.end());
  return names;
}

std::optional<std::string> read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

class Language : public ::testing::TestWithParam<std::string> {};

TEST_P(Language, DoesWhatItsCommentsSay) {
  const std::string path = (fs::path(IPOS_LANGUAGE_DIR) / GetParam()).string();
  const std::string text = read_text(path).value_or("");
  const Expectations expected = read_expectations(text);
  for (const std::string& mistake : expected.mistakes) ADD_FAILURE() << "not understood: " << mistake;
  ASSERT_FALSE(expected.empty()) << "the program expects nothing";

  compiler::CompileOptions options;
  options.read_file = read_text;
  if (!expected.unit.empty()) {
    options.unit = stdlib::find_unit(expected.unit);
    ASSERT_NE(options.unit, nullptr) << expected.unit;
  }
  compiler::Compilation compiled = compiler::compile(GetParam(), path, text, options);
  std::vector<ExpectedDiagnostic> found;
  for (const compiler::Diagnostic& diagnostic : compiled.diagnostics.all()) {
    // Line 0 is a message about the program as a whole; its comment stands in line 1.
    const uint32_t line = compiled.sources->position(diagnostic.span.begin).line;
    found.push_back({std::max(line, 1U), std::string(compiler::info(diagnostic.diag).code)});
  }
  const auto by_line = [](const ExpectedDiagnostic& a, const ExpectedDiagnostic& b) {
    return std::pair(a.line, a.code) < std::pair(b.line, b.code);
  };
  std::sort(found.begin(), found.end(), by_line);
  std::vector<ExpectedDiagnostic> wanted = expected.diagnostics;
  std::sort(wanted.begin(), wanted.end(), by_line);
  EXPECT_EQ(found, wanted) << compiler::render_text(compiled.diagnostics.all(), *compiled.sources, false);
  if (!compiled.image) {
    EXPECT_TRUE(expected.values.empty() && !expected.fault)
        << "the program does not compile, but values are expected";
    return;
  }

  runtime::PlantFile plant_file;
  runtime::StationConfig config;
  config.name = "test";
  config.unit = compiled.unit;
  config.program = GetParam();
  plant_file.stations.push_back(config);
  std::vector<std::optional<vm::Image>> images;
  images.emplace_back(std::move(*compiled.image));
  std::vector<runtime::PlantError> errors;
  const uint32_t speed = expected.speed;
  runtime::Plant plant(std::move(plant_file), std::move(images), vm::Rates{{speed, speed, speed}}, errors);
  for (const runtime::PlantError& error : errors) ADD_FAILURE() << error.text;
  ASSERT_TRUE(errors.empty());

  const runtime::Station& station = *plant.stations()[0];
  const auto check = [&](const ExpectedValue& value) {
    const auto number = signals::find_variable(station, value.variable);
    ASSERT_TRUE(number) << "line " << value.line << ": no variable " << value.variable;
    EXPECT_EQ(station.variable(*number), value.value) << "line " << value.line << ": " << value.variable;
  };
  std::vector<ExpectedValue> values = expected.values;
  std::stable_sort(values.begin(), values.end(), [](const ExpectedValue& a, const ExpectedValue& b) {
    return a.at.value_or(kLimit) < b.at.value_or(kLimit);
  });
  bool at_end = expected.fault.has_value();
  for (const ExpectedValue& value : values) {
    if (value.at) {
      plant.run_until(*value.at);
      check(value);
    } else {
      at_end = true;
    }
  }
  if (!at_end) return;
  plant.run_until(kLimit, [&](Time) { return !plant.programs_over(); });
  ASSERT_TRUE(plant.programs_over()) << "the program does not end";
  for (const ExpectedValue& value : values)
    if (!value.at) check(value);
  const vm::Fault& fault = station.machine()->fault();
  EXPECT_EQ(fault.number, expected.fault ? expected.fault->number : 0)
      << (fault.reason == nullptr ? "" : fault.reason);
  if (expected.fault && fault.number != 0) {
    const std::string place = station.source_place(fault.address);
    EXPECT_TRUE(place.find(fmt::format(".IPC:{}:", expected.fault->line)) != std::string::npos) << place;
  }
}

std::string test_name(const ::testing::TestParamInfo<std::string>& info) {
  std::string name = info.param.substr(0, info.param.size() - 4);
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Programs, Language, ::testing::ValuesIn(programs()), test_name);

}  // namespace
}  // namespace ipos::tests

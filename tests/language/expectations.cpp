// Reads expectation comments with one regular expression each.
#include "tests/language/expectations.hpp"

#include <regex>
#include <sstream>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kStart = "// expect";

int32_t number(const std::string& text) { return static_cast<int32_t>(std::stoll(text, nullptr, 0)); }

}  // namespace

Expectations read_expectations(std::string_view source) {
  static const std::regex kValue(R"(// expect (\w+(?:\.\w+|\[\d+\])*) == (-?\w+)(?: at (\S+))?\s*)");
  static const std::regex kDiagnostic(R"(// expect (?:error|warning) ([EW]\d{4})\s*)");
  static const std::regex kFault(R"(// expect fault (\d+)\s*)");
  static const std::regex kUnit(R"(^\s*// unit (\w+)\s*$)");
  static const std::regex kSpeed(R"(^\s*// speed (\d+)\s*$)");

  Expectations found;
  std::istringstream lines{std::string(source)};
  std::string text;
  for (uint32_t line = 1; std::getline(lines, text); ++line) {
    std::smatch match;
    if (std::regex_search(text, match, kUnit)) found.unit = match[1];
    if (std::regex_search(text, match, kSpeed)) found.speed = static_cast<uint32_t>(std::stoul(match[1]));
    // A line may hold several expectations, each with its own //; one ends where the next comment begins.
    for (size_t at = text.find(kStart); at != std::string::npos; at = text.find(kStart, at + 1)) {
      const std::string one = text.substr(at, text.find("//", at + 2) - at);
      if (std::regex_match(one, match, kValue)) {
        ExpectedValue value{line, match[1], number(match[2]), std::nullopt};
        if (match[3].matched) value.at = runtime::parse_duration(match[3].str());
        if (value.at == -1) found.mistakes.push_back(one);
        found.values.push_back(std::move(value));
      } else if (std::regex_match(one, match, kDiagnostic)) {
        found.diagnostics.push_back({line, match[1]});
      } else if (std::regex_match(one, match, kFault)) {
        found.fault = ExpectedFault{line, std::stoi(match[1])};
      } else {
        found.mistakes.push_back(one);
      }
    }
  }
  return found;
}

}  // namespace ipos::tests

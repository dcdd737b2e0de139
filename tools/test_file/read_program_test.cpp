// Tests in the comments of a program:
//
//   // expect NAME == VALUE [at TIME | within TIME]     also != < <= > >=; without a time when the program
//   has ended
//   // expect fault N                     the command of this line ends the program with this fault
//   // expect error E0203, // expect warning W0201       this line has this message
//   // unit mdxb, // speed 20             of the unit; commands per ms of every task
//
// A line may hold several; each ends where the next comment begins.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <regex>

#include "compiler/diag/places.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/plant_file/state_names.hpp"
#include "stdlib/unit_types.hpp"
#include "tools/cli/text_lines.hpp"
#include "tools/test_file/read_tests.hpp"

namespace ipos::tools::testing {
namespace {

constexpr std::string_view kStart = "// expect";
constexpr uint8_t kFaultOfNone = 0;

// As written in C: decimal, 0x.., negative, 32 bits.
std::optional<int64_t> parse_value(std::string text) {
  const bool negative = text.starts_with('-');
  if (negative) text.erase(0, 1);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.erase(0, 2);
  int64_t value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value, hex ? 16 : 10);
  if (status != std::errc() || end != text.data() + text.size() || value > UINT32_MAX) return std::nullopt;
  return static_cast<int32_t>(static_cast<uint32_t>(negative ? -value : value));
}

Condition condition_of(const std::string& comparison, int64_t value) {
  Condition condition;
  condition.negated = comparison == "!=";
  if (comparison == "==" || comparison == "!=") condition.ranges.emplace_back(value, value);
  if (comparison == "<") condition.ranges.emplace_back(INT64_MIN, value - 1);
  if (comparison == "<=") condition.ranges.emplace_back(INT64_MIN, value);
  if (comparison == ">") condition.ranges.emplace_back(value + 1, INT64_MAX);
  if (comparison == ">=") condition.ranges.emplace_back(value, INT64_MAX);
  return condition;
}

class CommentReader {
 public:
  CommentReader(TestCase& test, std::string station) : test_(test), station_(std::move(station)) {}

  // One comment from "// expect" on; nothing, or why it is none.
  std::optional<std::string> read(FilePlace place, const std::string& text) {
    static const std::regex kValue(
        R"(// expect (\w+(?:\.\w+|\[\d+\])*) (==|!=|<=|>=|<|>) (-?\w+)(?: (at|within) (\S+))?\s*)");
    static const std::regex kDiagnostic(R"(// expect (?:error|warning) ([EW]\d{4})\s*)");
    static const std::regex kFault(R"(// expect fault (\d{1,3})\s*)");
    std::smatch match;
    if (std::regex_match(text, match, kDiagnostic)) {
      test_.diagnostics.push_back({place.line, match[1]});
      return std::nullopt;
    }
    if (std::regex_match(text, match, kFault)) {
      add_state(place, "program_fault", std::stoi(match[1]));
      add_state(place, "program_fault_line", static_cast<int64_t>(place.line));
      faults_ = true;
      return std::nullopt;
    }
    if (!std::regex_match(text, match, kValue))
      return "not understood; write for example // expect H5 == 7 at 100ms";
    const auto value = parse_value(match[3]);
    if (!value) return fmt::format("'{}' is no number of 32 bits", match[3].str());
    Expect expect;
    expect.subject.signal = signal_named(match[1]);
    expect.condition = condition_of(match[2], *value);
    Item item;
    item.place = place;
    item.at_end = !match[4].matched;
    if (match[4].matched) {
      const Time time = runtime::parse_duration(match[5].str());
      if (time < 0) return fmt::format("'{}' is no time; write for example 500ms or 1.5s", match[5].str());
      item.at = match[4] == "at" ? time : 0;
      if (match[4] == "within") {
        expect.kind = Expect::Kind::Within;
        expect.during = time;
      }
    }
    item.what = std::move(expect);
    test_.items.push_back(std::move(item));
    return std::nullopt;
  }

  // A program that is to end must end without a fault, unless one is expected.
  void finish() {
    const bool ends =
        std::any_of(test_.items.begin(), test_.items.end(), [](const Item& i) { return i.at_end; });
    if (ends && !faults_) add_state({1, 1}, "program_fault", kFaultOfNone);
    std::stable_sort(test_.items.begin(), test_.items.end(), [](const Item& a, const Item& b) {
      return std::pair(a.at_end, a.at.value_or(0)) < std::pair(b.at_end, b.at.value_or(0));
    });
  }

 private:
  runtime::Signal signal_named(const std::string& name) const {
    if (const int line = runtime::parse_input(name); line >= 0)
      return {station_, runtime::SignalKind::Input, name, static_cast<uint8_t>(line)};
    if (const int bit = runtime::parse_output(name); bit >= 0)
      return {station_, runtime::SignalKind::Output, name, static_cast<uint8_t>(bit)};
    return {station_, runtime::SignalKind::Variable, name, 0};
  }

  void add_state(FilePlace place, const char* state, int64_t value) {
    Expect expect;
    expect.subject.signal = {station_, runtime::SignalKind::State, state,
                             static_cast<uint8_t>(runtime::find_state(state))};
    expect.condition.ranges.emplace_back(value, value);
    Item item;
    item.place = place;
    item.at_end = true;
    item.what = std::move(expect);
    test_.items.push_back(std::move(item));
  }

  TestCase& test_;
  std::string station_;
  bool faults_ = false;
};

}  // namespace

bool expects_something(const std::string& text) { return text.find(kStart) != std::string::npos; }

TestCase read_program_test(const std::string& path, const std::string& text) {
  static const std::regex kUnit(R"(^\s*// unit (\w+)\s*$)");
  static const std::regex kSpeed(R"(^\s*// speed (\d{1,7})\s*$)");
  const std::filesystem::path file(path);
  TestCase test;
  test.name = file.lexically_normal().generic_string();
  test.file = path;
  test.place = {1, 1};
  test.plant_path = path;
  test.is_program = true;
  runtime::StationConfig station;
  station.name = compiler::printable(file.stem().string());
  station.program = file.filename().string();
  station.program_place = {1, 1};
  CommentReader comments(test, station.name);
  std::vector<std::string> lines = text_lines(text);
  for (uint32_t number = 1; number <= lines.size(); ++number) {
    const std::string& line = lines[number - 1];
    std::smatch match;
    if (std::regex_search(line, match, kSpeed)) test.speed = static_cast<uint32_t>(std::stoul(match[1]));
    if (std::regex_search(line, match, kUnit)) {
      station.unit = stdlib::find_unit(match[1].str());
      if (station.unit == nullptr)
        test.errors.push_back({{number, 1}, fmt::format("'{}' is no unit", match[1].str())});
    }
    for (size_t at = line.find(kStart); at != std::string::npos; at = line.find(kStart, at + 1)) {
      const std::string one = line.substr(at, line.find("//", at + 2) - at);
      const FilePlace place{number, static_cast<uint32_t>(at + 1)};
      if (const auto wrong = comments.read(place, one)) test.errors.push_back({place, *wrong});
    }
  }
  comments.finish();
  test.lines = std::make_shared<const std::vector<std::string>>(std::move(lines));
  test.plant.stations.push_back(std::move(station));
  return test;
}

}  // namespace ipos::tools::testing

// Endings by option.
#include "tools/cli/output_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>

#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools {
namespace {

constexpr std::string_view kPlot[] = {".svg", ".html", ".htm"};
constexpr std::string_view kTrace[] = {".csv", ".vcd", ".jsonl", ".ipos-trace"};
constexpr std::string_view kExport[] = {".csv", ".vcd", ".jsonl", ".svg", ".html", ".htm"};
constexpr std::string_view kLog[] = {".log", ".txt", ".candump", ".pcapng", ".asc", ".trc"};
constexpr std::string_view kSerialLog[] = {".log", ".slog", ".txt"};
constexpr std::string_view kCoverage[] = {".info", ".xml", ".txt"};
constexpr std::string_view kJunit[] = {".xml"};
constexpr std::string_view kTap[] = {".tap", ".txt"};
constexpr std::string_view kJson[] = {".json"};
constexpr std::string_view kHtml[] = {".html", ".htm"};
constexpr std::string_view kCsv[] = {".csv"};

constexpr OutputForms kForms[] = {
    {"--plot", kPlot, true},         {"--trace", kTrace, false}, {"--log", kLog, true},
    {"--serial-log", kSerialLog, true}, {"--coverage", kCoverage, false}, {"--junit", kJunit, true},
    {"--tap", kTap, true},           {"--json", kJson, true},    {"--html", kHtml, true},
    {"scope -o", kCsv, true},        {"trace export -o", kExport, false},
};

}  // namespace

std::span<const OutputForms> output_forms() { return kForms; }

std::string output_ending(std::string_view option, const std::string& path) {
  if (path.empty() || is_standard_output(path)) return {};
  const auto* const forms =
      std::find_if(std::begin(kForms), std::end(kForms), [&](const OutputForms& row) { return row.option == option; });
  std::string ending = std::filesystem::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const auto& known = forms->endings;
  if (std::find(known.begin(), known.end(), ending) != known.end() || (ending.empty() && forms->plain)) return ending;
  std::string list;
  for (size_t n = 0; n < known.size(); ++n)
    list += fmt::format("{}{}", n == 0 ? "" : n + 1 == known.size() ? " or " : ", ", known[n]);
  throw Failure(kUsage, fmt::format("{} {}: the name must end in {}, or be -", option, path, list));
}

}  // namespace ipos::tools

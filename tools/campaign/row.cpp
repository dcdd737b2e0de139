// Lines of results.
#include "tools/campaign/row.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/cli/json_text.hpp"

namespace ipos::tools::campaign {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kBegin = R"({"case":")";

std::string quoted(const std::string& text) { return json_text(Json(text)); }

}  // namespace

// Shortest digits that give the same number again.
std::string number_text(double number) {
  if (number == 0) return "0";
  return std::abs(number) < 1e15 && number == std::floor(number) ? fmt::format("{:.0f}", number) : fmt::format("{}", number);
}

RowWriter::RowWriter(const Outline& outline) : outline_(outline) {
  for (const FactorOutline& factor : outline.factors) {
    factors_.emplace_back();
    for (const Level& level : factor.levels) factors_.back().push_back(quoted(factor.name) + ":" + level.json);
  }
  for (const MeasureOutline& measure : outline.measures) measures_.push_back(quoted(measure.name) + ":");
}

void RowWriter::append(std::string& out, uint64_t id, const Levels& levels,
                       const std::vector<std::optional<double>>& measures, const std::vector<std::string>& failed,
                       const std::string& hash, std::optional<double> ms) const {
  out += kBegin;
  out += hex(id);
  out += R"(","factors":{)";
  for (size_t n = 0; n < levels.size(); ++n) {
    if (n != 0) out += ',';
    out += factors_[n][levels[n]];
  }
  out += R"(},"measures":{)";
  for (size_t n = 0; n < measures.size(); ++n) {
    if (n != 0) out += ',';
    out += measures_[n];
    out += measures[n] ? number_text(*measures[n]) : "null";
  }
  out += R"(},"failed":[)";
  for (size_t n = 0; n < failed.size(); ++n) {
    if (n != 0) out += ',';
    out += quoted(failed[n]);
  }
  out += fmt::format(R"(],"hash":"{}")", hash);
  if (ms) out += fmt::format(R"(,"ms":{:.3f})", *ms);
  out += "}\n";
}

std::optional<Row> read_row(const Outline& outline, std::string_view line) {
  try {
    const Json json = Json::parse(line);
    Row row;
    row.id = number_of_hex(json.at("case").get<std::string>()).value();
    const Json& measures = json.at("measures");
    if (!measures.empty())
      for (const MeasureOutline& measure : outline.measures) {
        const Json& value = measures.at(measure.name);
        row.measures.push_back(value.is_null() ? std::nullopt : std::optional(value.get<double>()));
      }
    row.failed = json.at("failed");
    row.hash = json.at("hash");
    return row;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::optional<RowHead> read_row_head(std::string_view line) {
  if (!line.starts_with(kBegin) || !line.ends_with('}')) return std::nullopt;
  const auto id = number_of_hex(line.substr(kBegin.size(), 16));
  if (!id) return std::nullopt;
  return RowHead{*id, line.rfind(R"("failed":[],"hash":")") != std::string_view::npos};
}

}  // namespace ipos::tools::campaign

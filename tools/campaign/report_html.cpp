// The page is page/campaign.html; its data are JSON in place of @DATA@.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "stdlib/embedded.hpp"
#include "tools/campaign/reports.hpp"
#include "tools/campaign/shrink.hpp"
#include "tools/campaign/summary.hpp"
#include "tools/cli/json_text.hpp"

namespace ipos::tools::campaign {
namespace page {
std::span<const stdlib::EmbeddedFile> embedded_files();
}

namespace {

using Page = nlohmann::ordered_json;

Page optional(const std::optional<double>& number) { return number ? Page(*number) : Page(nullptr); }

Page factors_of(const Outline& outline, const Summary& summary) {
  Page factors = Page::array();
  for (size_t n = 0; n < outline.factors.size(); ++n) {
    Page bins = Page::array();
    for (const Bin& bin : summary.factors[n]) {
      Page measures = Page::array();
      for (const Spread& spread : bin.measures)
        measures.push_back(spread.count == 0 ? Page(nullptr) : Page{spread.least, spread.sum / static_cast<double>(spread.count), spread.most});
      bins.push_back({{"text", bin.text}, {"cases", bin.cases}, {"failed", bin.failed}, {"measures", std::move(measures)}});
    }
    Page levels = Page::array();
    for (const Level& level : outline.factors[n].levels)
      if (outline.factors[n].levels.size() <= Summary::kCases) levels.push_back(level.text);
    factors.push_back({{"name", outline.factors[n].name}, {"levels", std::move(levels)}, {"count", outline.factors[n].levels.size()}, {"bins", std::move(bins)}});
  }
  return factors;
}

Page measures_of(const Outline& outline, const Summary& summary) {
  Page measures = Page::array();
  for (size_t n = 0; n < outline.measures.size(); ++n) {
    const MeasureOutline& measure = outline.measures[n];
    const Histogram& spread = summary.measures[n];
    measures.push_back({{"name", measure.name}, {"unit", measure.unit}, {"at_least", optional(measure.at_least)}, {"at_most", optional(measure.at_most)},
                        {"least", spread.least}, {"most", spread.most}, {"good", spread.good}, {"failed", spread.failed}});
  }
  return measures;
}

Page cases_of(const Results& results, const Summary& summary) {
  Page cases = Page::array();
  for (const uint64_t rank : summary.shown) {
    Page measures = Page::array();
    for (const auto& value : results.rows[rank].measures) measures.push_back(optional(value));
    cases.push_back({hex(results.rows[rank].id), results.levels[rank], std::move(measures), results.rows[rank].failed});
  }
  return cases;
}

Page groups_of(const Results& results) {
  Groups groups;
  for (uint64_t rank = 0; rank < results.rows.size(); ++rank) groups.add(rank, results.rows[rank].failed);
  Page all = Page::array();
  for (const auto& [check, group] : groups.all()) all.push_back({{"text", group.text}, {"cases", group.cases}, {"first", hex(results.rows[group.first].id)}});
  return all;
}

// Sums of each source, and what no case has reached: lines, and the ways of conditions, which the states of a switch are, too.
Page coverage_of(const coverage::Coverage& coverage) {
  Page files = Page::array();
  for (const auto& [name, file] : coverage.files) {
    const coverage::Figures sums = coverage::figures(file);
    Page lines = Page::array();
    for (const auto& [line, count] : file.lines)
      if (count == 0) lines.push_back(line);
    Page ways = Page::array();
    for (const auto& [key, condition] : file.conditions)
      for (size_t way = 0; way < condition.ways.size(); ++way)
        if (condition.ways[way].count == 0) ways.push_back({key.at.line, key.at.column, condition.ways[way].to.line});
    files.push_back({{"name", name}, {"lines", {sums.lines.covered, sums.lines.all}}, {"branches", {sums.branches.covered, sums.branches.all}},
                     {"functions", {sums.functions.covered, sums.functions.all}}, {"unreached", std::move(lines)}, {"ways", std::move(ways)}});
  }
  return files;
}

}  // namespace

std::string html_report(const Results& results, const coverage::Coverage* coverage) {
  const Summary summary(results);
  Page data;
  data["campaign"] = results.outline.campaign;
  data["cases"] = std::count(results.there.begin(), results.there.end(), true);
  data["planned"] = results.rows.size();
  data["failed"] = std::count_if(results.rows.begin(), results.rows.end(), [](const Row& row) { return !row.failed.empty(); });
  data["complaints"] = results.complaints;
  data["factors"] = factors_of(results.outline, summary);
  data["measures"] = measures_of(results.outline, summary);
  data["maps"] = Page::array();
  for (const Map& map : summary.maps)
    data["maps"].push_back({{"across", map.across}, {"down", map.down}, {"cases", map.cases}, {"failed", map.failed}});
  data["groups"] = groups_of(results);
  data["shown"] = cases_of(results, summary);
  if (coverage != nullptr) data["coverage"] = coverage_of(*coverage);
  std::string text = json_text(data);
  // Nothing in the data ends the script that holds them.
  for (size_t at = text.find("</"); at != std::string::npos; at = text.find("</", at)) text.replace(at, 2, "<\\/");
  constexpr std::string_view kPlace = "@DATA@";
  std::string whole(page::embedded_files().front().text);
  return whole.replace(whole.find(kPlace), kPlace.size(), text);
}

}  // namespace ipos::tools::campaign

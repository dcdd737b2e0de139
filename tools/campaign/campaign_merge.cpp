// ipos campaign merge: the results of all shards as one table or report.
#include <fmt/format.h>

#include <algorithm>

#include "compiler/diag/places.hpp"
#include "tools/campaign/campaign_verbs.hpp"
#include "tools/campaign/case_coverage.hpp"
#include "tools/campaign/reports.hpp"
#include "tools/campaign/shrink.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"

namespace ipos::tools::campaign {
namespace {

struct MergeFlags {
  std::vector<std::string> folders;
  std::string csv;
  std::string jsonl;
  std::string junit;
  std::string html;
};

int merge(const MergeFlags& flags) {
  const std::initializer_list<std::string> reports{flags.csv, flags.jsonl, flags.junit, flags.html};
  const auto taking = std::count_if(reports.begin(), reports.end(), is_standard_output);
  if (taking > 1) throw Failure(kUsage, "only one report can go to standard output");
  for (const std::string& path : reports) check_output(path);
  const Results results = read_results(flags.folders);
  for (const std::string& complaint : results.complaints) fmt::print(stderr, "ipos: {}\n", compiler::printable(complaint));
  if (!flags.csv.empty()) replace_file(flags.csv, csv_report(results));
  if (!flags.jsonl.empty()) replace_file(flags.jsonl, jsonl_report(results));
  if (!flags.junit.empty()) replace_file(flags.junit, junit_report(results));
  if (!flags.html.empty()) {
    const auto coverage = read_coverage(flags.folders, results.outline);
    replace_file(flags.html, html_report(results, coverage ? &*coverage : nullptr));
  }
  Groups groups;
  uint64_t failed = 0;
  for (uint64_t rank = 0; rank < results.rows.size(); ++rank) {
    groups.add(rank, results.rows[rank].failed);
    failed += results.rows[rank].failed.empty() ? 0U : 1U;
  }
  std::FILE* const out = taking != 0 ? stderr : stdout;
  const auto there = static_cast<uint64_t>(std::count(results.there.begin(), results.there.end(), true));
  fmt::print(out, "{} case{}: {} good, {} failed\n", there, there == 1 ? "" : "s", there - failed, failed);
  for (const auto& [check, group] : groups.all())
    fmt::print(out, "{} case{}: {} (case {})\n", group.cases, group.cases == 1 ? "" : "s", compiler::printable(group.text), hex(results.rows[group.first].id));
  if (!results.complaints.empty()) return kBadInput;
  return failed == 0 ? kGood : kFindings;
}

}  // namespace

void add_merge(cli::Verb& parent) {
  auto flags = std::make_shared<MergeFlags>();
  cli::Verb& verb = parent.verb("merge", "put the results of all shards together");
  verb.option("DIR", flags->folders, "folders of results of one campaign").required();
  verb.option("--csv", flags->csv, "write a table: a column a factor, then a column a measure; - is standard output");
  verb.option("--jsonl", flags->jsonl, "write the rows as JSON, a line a case, in the order of the plan; - is standard output");
  verb.option("--junit", flags->junit, "write a report as JUnit XML; - is standard output");
  verb.option("--html", flags->html, "write a report as one HTML page; - is standard output");
  verb.footer("Example:\n  ipos campaign merge results --csv results.csv --html results.html");
  verb.runs([flags] { return merge(*flags); });
}

}  // namespace ipos::tools::campaign

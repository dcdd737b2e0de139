// Forms by file name.
#include "tools/coverage/coverage_reports.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "tools/cli/failure.hpp"
#include "tools/cli/output_forms.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/coverage/write.hpp"

namespace ipos::tools {
namespace {

using CoverageWriter = void (*)(std::ostream&, const coverage::Coverage&);

CoverageWriter coverage_writer(const std::string& path) {
  const std::string ending = output_ending("--coverage", path);
  return ending == ".info" ? coverage::write_lcov : ending == ".xml" ? coverage::write_cobertura : coverage::write_text;
}

}  // namespace

CoverageReports::CoverageReports(const std::vector<std::string>& paths, bool output_taken) {
  for (const std::string& path : paths) {
    if (is_standard_output(path) && output_taken)
      throw Failure(kUsage, "--coverage -: standard output has another report; write it to a file");
    reports_.push_back({path, coverage_writer(path)});
  }
}

void CoverageReports::check() const {
  for (const Report& report : reports_) check_output(report.path);
}

void CoverageReports::write(const coverage::Coverage& coverage) const {
  if (!wanted()) return;
  const coverage::Coverage named = coverage.named_from(std::filesystem::current_path().string());
  for (const Report& report : reports_) {
    std::ostringstream text;
    report.write(text, named);
    if (is_standard_output(report.path)) fmt::print("\n");
    replace_file(report.path, text.str());
  }
}

void add_coverage_option(cli::Verb& verb, std::vector<std::string>& paths) {
  verb.option("--coverage", paths,
              "write which source lines and branches were executed: .info (lcov), .xml (Cobertura), .txt, "
              "or - for text to the terminal; may be given several times")
      .one_each();
}

}  // namespace ipos::tools

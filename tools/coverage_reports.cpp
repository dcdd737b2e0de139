// Forms by file name.
#include "tools/coverage_reports.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <sstream>

#include "tools/coverage/write.hpp"
#include "tools/failure.hpp"
#include "tools/files.hpp"

namespace ipos::tools {
namespace {

using CoverageWriter = void (*)(std::ostream&, const coverage::Coverage&);

CoverageWriter coverage_writer(const std::string& path) {
  const std::string ending = std::filesystem::path(path).extension().string();
  if (path == "-" || ending == ".txt") return coverage::write_text;
  if (ending == ".info") return coverage::write_lcov;
  if (ending == ".xml") return coverage::write_cobertura;
  throw Failure(kUsage,
                fmt::format("--coverage {}: the name must end in .info, .xml or .txt, or be -", path));
}

}  // namespace

CoverageReports::CoverageReports(const std::vector<std::string>& paths, bool output_taken) {
  for (const std::string& path : paths) {
    if (path == "-" && output_taken)
      throw Failure(kUsage, "--coverage -: standard output has another report; write it to a file");
    reports_.push_back({path, coverage_writer(path), {}});
  }
}

void CoverageReports::open() {
  for (Report& report : reports_)
    if (report.path != "-") report.file = open_output(report.path);
}

void CoverageReports::write(const coverage::Coverage& coverage) {
  for (Report& report : reports_) {
    if (report.path == "-") {
      std::ostringstream text;
      report.write(text, coverage);
      fmt::print("\n{}", text.str());
    } else {
      report.write(report.file, coverage);
      close_output(report.file, report.path);
    }
  }
}

void add_coverage_option(cli::Verb& verb, std::vector<std::string>& paths) {
  verb.option("--coverage", paths,
              "write which source lines and branches were executed: .info (lcov), .xml (Cobertura), .txt, "
              "or - for text to the terminal; may be given several times")
      .one_each();
}

}  // namespace ipos::tools

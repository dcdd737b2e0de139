// What --coverage of a verb writes: lcov, Cobertura or text, by the ending of each file's name.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/cli/verb.hpp"
#include "tools/coverage/coverage.hpp"

namespace ipos::tools {

class CoverageReports {
 public:
  // Fails for names whose ending says no form. "-" is text to standard output, unless that is taken.
  CoverageReports(const std::vector<std::string>& paths, bool output_taken);

  bool wanted() const { return !reports_.empty(); }
  // Before a long run, so that it does not end without its result.
  void check() const;
  void write(const coverage::Coverage& coverage) const;

 private:
  struct Report {
    std::string path;
    void (*write)(std::ostream&, const coverage::Coverage&);
  };
  std::vector<Report> reports_;
};

void add_coverage_option(cli::Verb& verb, std::vector<std::string>& paths);

}  // namespace ipos::tools

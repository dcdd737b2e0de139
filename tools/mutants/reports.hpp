// What came of planted mistakes, told for people, GitHub, JUnit, JSON and as a page of the sources. Every text is valid UTF-8.
#pragma once

#include <string>
#include <vector>

#include "tools/mutants/mutant.hpp"

namespace ipos::tools::mutants {

// A line, with its place as compilers write it.
std::string line_of(const Mutant& mutant);
// The survivors, a line each, and the score in the last line.
std::string text_report(const std::vector<Mutant>& mutants);
// "score 87 % (26 of 30 noticed)"
std::string score_line(const Score& score);
// A warning for each survivor. `root` is the folder of the repository; empty: the current one.
std::string github_report(const std::vector<Mutant>& mutants, const std::string& root);
// A suite for each source, a case for each mistake; a survivor is a failure.
std::string junit_report(const std::vector<Mutant>& mutants);
std::string json_report(const std::vector<Mutant>& mutants);
// The sources, with what survived below its line.
std::string html_report(const std::vector<Mutant>& mutants);

}  // namespace ipos::tools::mutants

// What the forms of the report share.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

std::string_view word_of(Outcome outcome);  // "ok", "FAILED", "ERROR", "not run"
size_t count(const std::vector<TestResult>& results, Outcome outcome);
std::string text_of_finding(const Finding& finding);
// `weight`: "error" or "warning"; `root` as of github_annotations().
std::string github_annotation(std::string_view weight, const std::string& root, const std::string& file,
                              runtime::FilePlace place, const std::string& title, const std::string& text);
// What an HTML report begins with, up to its <body>.
std::string html_head(std::string_view more_style = {});

}  // namespace ipos::tools::testing

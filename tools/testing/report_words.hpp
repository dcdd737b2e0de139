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

}  // namespace ipos::tools::testing

// Finding and reading tests: *.test.toml and plants with [[expect]], and programs with `// expect` comments.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

// The tests of a file or folder, in the order of their names. A folder is searched for *.test.toml, for programs
// that expect something, and for plants with [[expect]] that no test of the folder looks at itself. A malformed file
// is one test with errors. A path that is not there is a Failure.
std::vector<TestCase> read_tests(const std::string& path);

// The forms of one file; `text` is what stands in it.
std::vector<TestCase> read_test_file(const std::string& path, const std::string& text);
TestCase read_program_test(const std::string& path, const std::string& text);

// Whether a program's text has comments that expect something.
bool expects_something(const std::string& text);

}  // namespace ipos::tools::testing

// A test says which rows of tests/conformance/*.tsv it proves: PROVES("EX-21", "SCOM-04"); as its first line.
// The ids go into the test's XML report; tests/conformance counts them if the test passed.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

namespace ipos::tests {

// Value of the report property that marks its name as a conformance id.
inline constexpr const char* kProves = "proves";

inline void proves(std::initializer_list<const char*> ids) {
  for (const char* id : ids) ::testing::Test::RecordProperty(id, kProves);
}

}  // namespace ipos::tests

#define PROVES(...) ::ipos::tests::proves({__VA_ARGS__})

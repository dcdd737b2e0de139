// Whether a test goes where users go: through a plant file, a verb, the page, the C library or Python. What opens or starts
// one of them says so (`goes_through`), so no list of such tests has to be kept. tests/conformance counts a claim of a test that
// says nothing as proved by classes only.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

namespace ipos::tests {

// Names of the report properties.
inline constexpr const char* kGoesThrough = "goes_through";
inline constexpr const char* kByClasses = "proves by classes";  // value of an id, as kProves

inline constexpr const char* kPlantFile = "plant file";
inline constexpr const char* kVerb = "verb";
inline constexpr const char* kLibrary = "C library";

inline void goes_through(const char* way) {
  if (::testing::UnitTest::GetInstance()->current_test_info() != nullptr)
    ::testing::Test::RecordProperty(kGoesThrough, way);
}

inline void proves_by_classes(std::initializer_list<const char*> ids) {
  for (const char* id : ids) ::testing::Test::RecordProperty(id, kByClasses);
}

}  // namespace ipos::tests

// For a claim of a test that opens a plant and then takes a step that no user can take: a class called behind its back.
#define PROVES_BY_CLASSES(...) ::ipos::tests::proves_by_classes({__VA_ARGS__})

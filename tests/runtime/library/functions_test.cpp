// The tests of this program call every function that libipos_plant shows, and see every status.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "tests/runtime/library/functions.hpp"

namespace ipos::tests {
namespace {

TEST(LibraryFunctions, AreThoseOfTheLibrary) {
  std::ifstream file(IPOS_PLANT_SYMBOLS);  // tests/embedding/abi.sh compares it with the library
  std::set<std::string> shown;
  for (std::string library, name; file >> library >> name;)
    if (library == "ipos_plant") shown.insert(name);
  EXPECT_EQ(shown, std::set<std::string>(std::begin(kFunctions), std::end(kFunctions)));
}

// Behind all tests, when none was left out.
class Covered final : public ::testing::Environment {
 public:
  void TearDown() override {
    const ::testing::UnitTest& tests = *::testing::UnitTest::GetInstance();
    if (tests.test_to_run_count() != tests.total_test_count()) return;
    for (size_t n = 0; n < std::size(kFunctions); ++n)
      EXPECT_TRUE(functions_called[n]) << "no test calls " << kFunctions[n];
#define ROW(name, number, text) EXPECT_TRUE(statuses_seen[number]) << "no test sees " #name;
    IPOS_PLANT_STATUSES(ROW)
#undef ROW
  }
};

const ::testing::Environment* const kCovered = ::testing::AddGlobalTestEnvironment(new Covered);

}  // namespace
}  // namespace ipos::tests

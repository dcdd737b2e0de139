// Entry of every test program. Removes the report of an earlier run first, so that a program that crashes
// leaves none and the conformance counter notices.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const std::string output = GTEST_FLAG_GET(output);
  if (output.rfind("xml:", 0) == 0) std::remove(output.c_str() + 4);
  const int result = RUN_ALL_TESTS();
  const ::testing::UnitTest& tests = *::testing::UnitTest::GetInstance();
  // CTest's code for a test that was not made: nothing ran, everything was skipped.
  constexpr int kSkipped = 77;
  return result == 0 && tests.successful_test_count() == 0 && tests.skipped_test_count() > 0 ? kSkipped
                                                                                             : result;
}

// Entry of every test program. Removes the report of an earlier run first, so that a program that crashes
// leaves none and the conformance counter notices.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const std::string output = GTEST_FLAG_GET(output);
  if (output.rfind("xml:", 0) == 0) std::remove(output.c_str() + 4);
  return RUN_ALL_TESTS();
}

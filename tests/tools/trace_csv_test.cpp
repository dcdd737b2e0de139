// CSV text of hand-made recordings.
#include "tools/trace_csv.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace ipos::tools {
namespace {

std::string csv(const Recording& recording) {
  std::ostringstream out;
  write_csv(out, recording);
  return out.str();
}

TEST(TraceCsv, HeaderAndRows) {
  Recording recording;
  recording.signals = {{"u.speed", "rpm", 0.001, 3, false}, {"u.H5", "", 1, 0, false}};
  recording.times = {1'000'000, 2'000'000};
  recording.samples = {{-1, 2'147'483'647}, {-2'147'483'648, 0}};
  EXPECT_EQ(csv(recording), "time_ms,u.speed [rpm],u.H5\n1,-0.001,-2147483648\n2,2147483.647,0\n");
}

TEST(TraceCsv, AwkwardNamesAreQuoted) {
  Recording recording;
  recording.signals = {{"a,\"b\".x", "", 1, 0, false}};
  EXPECT_EQ(csv(recording), "time_ms,\"a,\"\"b\"\".x\"\n");
}

TEST(TraceCsv, UnsignedParametersStayPositive) {
  Recording recording;
  recording.signals = {{"u.P221", "", 1, 0, false}};
  recording.times = {1'000'000};
  recording.samples = {{3'999'999'999}};
  EXPECT_EQ(csv(recording), "time_ms,u.P221\n1,3999999999\n");
}

}  // namespace
}  // namespace ipos::tools

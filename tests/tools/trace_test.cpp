// The forms of hand-made recordings, and of a run.
#include "tools/recording/trace.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>

#include "tests/tools/command.hpp"
#include "tests/tools/hand_made.hpp"

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

TEST(TraceCsv, FramesOfTheMillisecond) {
  EXPECT_EQ(csv(hand_made()),
            "time_ms,u.speed [rpm],v 1.a.b,u.status,u.P221,v 1.P094,sbus1.frames,line1.frames\n"
            "1,-0.001,-2147483648,258,3999999999,0,40A#8006,\n"
            "2,-0.001,2147483647,258,3999999999,4294967295,1FFFFFFF#R,02 01 05\n"
            "3,1500.000,-1,32774,0,0,,\n");
}

TEST(TraceJsonl, OneObjectAChange) {
  std::ostringstream out;
  write_jsonl(out, hand_made());
  EXPECT_EQ(
      out.str(),
      "{\"signal\":\"u.speed\",\"unit\":\"rpm\"}\n"
      "{\"signal\":\"v 1.a.b\",\"unit\":\"\"}\n"
      "{\"signal\":\"u.status\",\"unit\":\"\"}\n"
      "{\"signal\":\"u.P221\",\"unit\":\"\"}\n"
      "{\"signal\":\"v 1.P094\",\"unit\":\"\"}\n"
      "{\"time_ms\":0.123456,\"frame\":\"sbus1\",\"id\":1034,\"extended\":false,\"remote\":false,\"data\":"
      "\"8006\"}\n"
      "{\"time_ms\":1,\"signal\":\"u.speed\",\"value\":-0.001}\n"
      "{\"time_ms\":1,\"signal\":\"v 1.a.b\",\"value\":-2147483648}\n"
      "{\"time_ms\":1,\"signal\":\"u.status\",\"value\":258}\n"
      "{\"time_ms\":1,\"signal\":\"u.P221\",\"value\":3999999999}\n"
      "{\"time_ms\":1,\"signal\":\"v 1.P094\",\"value\":0}\n"
      "{\"time_ms\":2,\"frame\":\"line1\",\"data\":\"020105\",\"text\":\"request to 1\"}\n"
      "{\"time_ms\":2,\"frame\":\"sbus1\",\"id\":536870911,\"extended\":true,\"remote\":true,\"data\":\"\"}\n"
      "{\"time_ms\":2,\"event\":\"u: \\\"F28\\\"\",\"fault\":true}\n"
      "{\"time_ms\":2,\"signal\":\"v 1.a.b\",\"value\":2147483647}\n"
      "{\"time_ms\":2,\"signal\":\"v 1.P094\",\"value\":4294967295}\n"
      "{\"time_ms\":3,\"signal\":\"u.speed\",\"value\":1500.000}\n"
      "{\"time_ms\":3,\"signal\":\"v 1.a.b\",\"value\":-1}\n"
      "{\"time_ms\":3,\"signal\":\"u.status\",\"value\":32774}\n"
      "{\"time_ms\":3,\"signal\":\"u.P221\",\"value\":0}\n"
      "{\"time_ms\":3,\"signal\":\"v 1.P094\",\"value\":0}\n"
      "{\"time_ms\":3.000001,\"frame\":\"sbus1\",\"id\":1,\"extended\":false,\"remote\":false,\"data\":\"\"}"
      "\n");
}

// The values a reader of the standard's grammar finds in the dump.
std::string read_back(const tests::TemporaryFolder& folder, const std::string& file) {
  const std::string out = (folder.path() / "read.txt").string();
  const std::string command = "python3 '" + tests::project("tests/tools/read_vcd.py").string() + "' '" +
                              file + "' >'" + out + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << tests::read_text(out);
  return tests::read_text(out);
}

TEST(TraceVcd, AnIndependentReaderFindsTheValues) {
  const tests::TemporaryFolder folder;
  std::ostringstream out;
  write_vcd(out, hand_made());
  EXPECT_EQ(read_back(folder, folder.write("a.vcd", out.str())),
            "0 u.status x\n"
            "0 u.P221 x\n"
            "0 \\v_1.\\a.b x\n"
            "0 \\v_1.P094 x\n"
            "0 sbus1.id x\n"
            "0 sbus1.length x\n"
            "0 sbus1.data x\n"
            "0 line1.length x\n"
            "0 line1.data x\n"
            "123456 sbus1.id 1034\n"
            "123456 sbus1.length 2\n"
            "123456 sbus1.data 32774\n"
            "123456 sbus1.frame event\n"
            "1000000 u.speed -0.001\n"
            "1000000 \\v_1.\\a.b -2147483648\n"
            "1000000 u.status 258\n"
            "1000000 u.P221 3999999999\n"
            "1000000 \\v_1.P094 0\n"
            "2000000 line1.length 3\n"
            "2000000 line1.data 131333\n"
            "2000000 line1.frame event\n"
            "2000000 sbus1.id 536870911\n"
            "2000000 sbus1.length 0\n"
            "2000000 sbus1.data 0\n"
            "2000000 sbus1.frame event\n"
            "2000000 \\v_1.\\a.b 2147483647\n"
            "2000000 \\v_1.P094 4294967295\n"
            "3000000 u.speed 1500.0\n"
            "3000000 \\v_1.\\a.b -1\n"
            "3000000 u.status 32774\n"
            "3000000 u.P221 0\n"
            "3000000 \\v_1.P094 0\n"
            "3000001 sbus1.id 1\n"
            "3000001 sbus1.length 0\n"
            "3000001 sbus1.data 0\n"
            "3000001 sbus1.frame event\n");
}

TEST(TraceVcd, NothingRecordedIsADump) {
  const tests::TemporaryFolder folder;
  std::ostringstream out;
  write_vcd(out, {});
  EXPECT_EQ(read_back(folder, folder.write("a.vcd", out.str())), "");
}

// Names of stations are arbitrary, and 200 variables need codes of two characters.
TEST(TraceVcd, ManyVariablesOfOddNames) {
  Recording recording;
  recording.times = {1'000'000};
  for (int n = 0; n < 200; ++n) {
    recording.signals.push_back({"größe #1.H" + std::to_string(n), "", 1, 0, false, "größe #1"});
    recording.samples.push_back({n});
  }
  const tests::TemporaryFolder folder;
  std::ostringstream out;
  write_vcd(out, recording);
  const std::string read = read_back(folder, folder.write("a.vcd", out.str()));
  for (int n = 0; n < 200; ++n)
    EXPECT_NE(read.find("1000000 \\gr____e_#1.H" + std::to_string(n) + " " + std::to_string(n) + "\n"),
              std::string::npos)
        << read;
}

// A real run: what the dump says of the bus is what candump's log says.
TEST(TraceVerb, FramesAreThoseOfTheLog) {
  const tests::TemporaryFolder folder;
  const std::string plant = tests::project("examples/scom/scom.toml").string();
  const std::string path = folder.path().string() + "/";
  for (const char* form : {"a.vcd", "a.jsonl", "a.csv"}) {
    const tests::CommandResult run =
        tests::run_ipos({"run", plant, "--for", "2s", "--log", path + "can.log", "--trace", path + form,
                         "--signals", "sbus.frames,unit1.speed,unit1.status"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  const auto count = [](const std::string& text, const std::string& part) {
    size_t found = 0;
    for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
  };
  const size_t frames = count(tests::read_text(path + "can.log"), "\n");
  EXPECT_GT(frames, 10U);
  EXPECT_EQ(count(read_back(folder, path + "a.vcd"), "sbus.frame event\n"), frames);
  EXPECT_EQ(count(tests::read_text(path + "a.jsonl"), "\"frame\":\"sbus\""), frames);
  EXPECT_EQ(count(tests::read_text(path + "a.csv"), "#"), frames);
  const tests::CommandResult wrong = tests::run_ipos({"run", plant, "--trace", path + "a.txt"});
  EXPECT_EQ(wrong.exit_code, 64);
  EXPECT_NE(wrong.err.find("the name must end in .csv, .vcd, .jsonl or .ipos-trace"), std::string::npos) << wrong.err;
  const tests::CommandResult unknown =
      tests::run_ipos({"run", plant, "--trace", path + "a.csv", "--signals", "sbus9.frames"});
  EXPECT_EQ(unknown.exit_code, 64);
  EXPECT_NE(unknown.err.find("sbus.frames"), std::string::npos) << unknown.err;
}

TEST(TraceVerb, TelegramsAreThoseOfTheSerialLog) {
  const tests::TemporaryFolder folder;
  const std::string plant = tests::project("examples/movilink-rs485/rs485.toml").string();
  const std::string log = (folder.path() / "line.log").string(), trace = (folder.path() / "a.jsonl").string();
  const tests::CommandResult run = tests::run_ipos(
      {"run", plant, "--for", "1s", "--serial-log", log, "--trace", trace, "--signals", "line1.frames"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  // The log: begin and end in seconds, line, bytes | meaning.
  std::istringstream lines(tests::read_text(log));
  std::string expected;
  for (std::string line; std::getline(lines, line);) {
    const size_t bar = line.find(" | ");
    std::istringstream words(line.substr(0, bar));
    std::string word, data;
    double end = 0;
    words >> word >> end >> word;
    while (words >> word) data += word;
    expected += "\"data\":\"" + data + "\",\"text\":\"" + line.substr(bar + 3) + "\"}\n";
  }
  EXPECT_GT(expected.size(), 100U);
  std::istringstream objects(tests::read_text(trace));
  std::string seen;
  for (std::string line; std::getline(objects, line);) seen += line.substr(line.find("\"data\"")) + "\n";
  EXPECT_EQ(seen, expected);
}

}  // namespace
}  // namespace ipos::tools

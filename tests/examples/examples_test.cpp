// The examples against the manual (1053 1610 p. 47 to 61): watch windows, frames and their times.
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/harness/proves.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

struct LoggedFrame {
  double ms;  // since the start of the run
  std::string text;
};

struct ExampleRun {
  CommandResult result;
  nlohmann::json report;
  std::vector<LoggedFrame> frames;

  // Value of H<number> of a station.
  int64_t h(size_t station, int number) const {
    for (const auto& row : report["stations"][station]["variables"])
      if (row["index"] == number) return row["value"];
    ADD_FAILURE() << "no H" << number;
    return 0;
  }
  std::string name(size_t station, int number) const {
    for (const auto& row : report["stations"][station]["variables"])
      if (row["index"] == number) return row["name"];
    return "";
  }
  std::vector<LoggedFrame> with_id(const std::string& id) const {
    std::vector<LoggedFrame> found;
    for (const LoggedFrame& frame : frames)
      if (frame.text.starts_with(id + "#")) found.push_back(frame);
    return found;
  }
};

std::vector<LoggedFrame> read_log(const std::string& text) {
  std::vector<LoggedFrame> frames;
  std::istringstream in(text);
  std::string stamp, bus, frame;
  while (in >> stamp >> bus >> frame) {
    const double seconds = std::stod(stamp.substr(1)) - 946684800.0;
    frames.push_back({seconds * 1000.0, frame});
  }
  return frames;
}

ExampleRun run_example(const std::string& plant, const std::string& duration = "1s") {
  const TemporaryFolder folder;
  const std::string log = (folder.path() / "can.log").string();
  ExampleRun run;
  run.result = run_ipos(
      {"run", project("examples/" + plant).string(), "--for", duration, "--format", "json", "--log", log});
  EXPECT_EQ(run.result.exit_code, 0) << run.result.err;
  run.report = nlohmann::json::parse(run.result.out);
  run.frames = read_log(read_text(log));
  return run;
}

// The 13 values of a SCOM watch window, H420..H432.
void expect_window(const ExampleRun& run, size_t station, const std::vector<int64_t>& values) {
  ASSERT_EQ(values.size(), 13U);
  for (size_t n = 0; n < values.size(); ++n)
    EXPECT_EQ(run.h(station, 420 + static_cast<int>(n)), static_cast<int32_t>(values[n])) << "H" << 420 + n;
}

TEST(Scom, WatchWindowsInMotorolaFormat) {
  PROVES("EX-20", "EX-21", "EX-22", "EX-26", "SCOM-04", "SCOM-05");
  const ExampleRun run = run_example("scom/scom.toml");
  expect_window(run, 0,
                {1024, 100, 0, 0x8, 426, 99, 0x11223344, 0x55667788, 1025, 0x8, 431, 0x44332211, 0x88776655});
  expect_window(run, 1,
                {1025, 120, 0, 0x8, 426, 99, 0x44332211, 0x88776655, 1024, 0x8, 431, 0x11223344, 0x55667788});
  const std::vector<std::string> names{
      "TrCycl.ObjectNo", "TrCycl.CycleTime", "TrCycl.Offset", "TrCycl.Format", "TrCycl.DPointer",
      "TrCycl.Result",   "lTrDataLow",       "lTrDataHigh",   "Rec.ObjectNo",  "Rec.Format",
      "Rec.DPointer",    "lReDataLow",       "lReDataHigh"};
  for (size_t n = 0; n < names.size(); ++n) EXPECT_EQ(run.name(0, 420 + static_cast<int>(n)), names[n]);
}

TEST(Scom, FramesAndTheirTimes) {
  PROVES("EX-29", "VAR-09");
  const ExampleRun run = run_example("scom/scom.toml");
  const auto first = run.with_id("400");
  const auto second = run.with_id("401");
  ASSERT_GE(first.size(), 9U);
  ASSERT_GE(second.size(), 8U);
  for (const LoggedFrame& frame : first) EXPECT_EQ(frame.text, "400#5566778811223344");
  for (const LoggedFrame& frame : second) EXPECT_EQ(frame.text, "401#8877665544332211");
  for (size_t n = 1; n < first.size(); ++n) EXPECT_NEAR(first[n].ms - first[n - 1].ms, 100, 1);
  for (size_t n = 1; n < second.size(); ++n) EXPECT_NEAR(second[n].ms - second[n - 1].ms, 120, 1);
  EXPECT_EQ(run.frames.size(), first.size() + second.size()) << "nothing else is on the bus";
  // About 130 bits every 100 and 120 ms of 500 kbit/s.
  const double load = run.report["buses"][0]["load_percent"];
  EXPECT_NEAR(load, (130.0 / 0.100 + 130.0 / 0.120) / 5000.0, 0.05);
}

// The listing of figure 36 has sizeof, that of figure 37 numof; the misread digits are those of the watch
// windows.
TEST(Scom, SizeofLeadsToNumof) {
  PROVES("EX-25");
  const TemporaryFolder folder;
  std::string source = read_text(project("examples/scom/SCOM1.IPC"));
  const size_t place = source.find("numof(lTrDataLow)");
  ASSERT_NE(place, std::string::npos);
  source.replace(place, 5, "sizeof");
  folder.write("SCOM1.IPC", source);
  const CommandResult refused = run_ipos({"build", "SCOM1.IPC"}, folder.path());
  EXPECT_EQ(refused.exit_code, 65);
  EXPECT_NE(refused.err.find("SCOM1.IPC:20:23: error"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("numof( ... ) gives the number of a variable"), std::string::npos)
      << refused.err;
  const ExampleRun run = run_example("scom/scom.toml");
  EXPECT_EQ(run.h(0, 424), 426) << "numof of lTrDataLow";
  EXPECT_EQ(run.h(0, 427), 0x55667788);
  EXPECT_EQ(run.h(0, 432), static_cast<int32_t>(0x88776655));
  EXPECT_EQ(run.h(1, 427), static_cast<int32_t>(0x88776655));
  EXPECT_EQ(run.h(1, 432), 0x55667788);
}

TEST(Scom, WatchWindowsInIntelFormat) {
  PROVES("EX-23", "EX-24", "EX-30", "VAR-10", "VAR-11");
  const ExampleRun run = run_example("scom-intel/scom-intel.toml");
  expect_window(
      run, 0,
      {1024, 100, 0, 0x108, 426, 99, 0x11223344, 0x55667788, 1025, 0x108, 431, 0x44332211, 0x88776655});
  expect_window(
      run, 1,
      {1025, 100, 0, 0x108, 426, 99, 0x44332211, 0x88776655, 1024, 0x108, 431, 0x11223344, 0x55667788});
  for (const LoggedFrame& frame : run.with_id("400")) EXPECT_EQ(frame.text, "400#4433221188776655");
  for (const LoggedFrame& frame : run.with_id("401")) EXPECT_EQ(frame.text, "401#1122334455667788");
  EXPECT_FALSE(run.with_id("400").empty());
  EXPECT_FALSE(run.with_id("401").empty());
}

// A MOTOROLA sender and an INTEL receiver: the bytes arrive reversed.
TEST(Scom, MixedFormats) {
  PROVES("EX-31");
  const TemporaryFolder folder;
  std::string plant = read_text(project("examples/scom/scom.toml"));
  plant = plant.substr(0, plant.find("[[expect]]"));
  plant.replace(plant.find("SCOM2.IPC"), 9, "RECEIVE.IPC");
  folder.write("plant.toml", plant);
  folder.write("SCOM1.IPC", read_text(project("examples/scom/SCOM1.IPC")));
  folder.write("RECEIVE.IPC", read_text(project("examples/scom-intel/SCOM2_Intel.IPC")));
  const CommandResult result =
      run_ipos({"run", "plant.toml", "--for", "1s", "--format", "json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  ExampleRun run;
  run.report = nlohmann::json::parse(result.out);
  EXPECT_EQ(run.h(1, 431), static_cast<int32_t>(0x88776655));
  EXPECT_EQ(run.h(1, 432), 0x44332211);
}

TEST(Movilink, WatchWindow) {
  PROVES("EX-12", "EX-13", "MOVLNK-02", "MOVLNK-08");
  const ExampleRun run = run_example("movilink/movilink.toml");
  const std::vector<int32_t> values{5, 1, 4, 1, 8318, 427, 0, 0, 0, 6, 5000, 0, 514, 0, 0};
  for (size_t n = 0; n < values.size(); ++n)
    EXPECT_EQ(run.h(0, 420 + static_cast<int>(n)), values[n]) << "H" << 420 + n;
  EXPECT_EQ(run.name(0, 427), "Mld.WritePar");
  EXPECT_EQ(run.name(0, 434), "Mld.PI3");
}

// Seven variables from H420 on, in the order of the manual, and both names: _MoviLink in C, MOVLNK in assembler and in what
// the disassembler shows.
TEST(Movilink, NamesAndOffsets) {
  PROVES("MOVLNK-01");
  const ExampleRun run = run_example("movilink/movilink.toml");
  const char* kElements[] = {"BusType", "Address", "Format", "Service", "Index", "DPointer", "Result"};
  for (int n = 0; n < 7; ++n) EXPECT_EQ(run.name(0, 420 + n), std::string("Ml.") + kElements[n]);
  const TemporaryFolder folder;
  const std::string source = project("examples/movilink/Movilink.IPC").string();
  ASSERT_EQ(run_ipos({"build", source, "-o", "c.ipx"}, folder.path()).exit_code, 0);
  const CommandResult listing = run_ipos({"disasm", "c.ipx"}, folder.path());
  EXPECT_NE(listing.out.find("MOVLNK"), std::string::npos) << listing.out << listing.err;
}

TEST(Movilink, FramesOfOneCall) {
  PROVES("EX-15", "MOVLNK-11", "SBUS-07", "SBUS-17", "PD-01", "PD-02");
  const ExampleRun run = run_example("movilink/movilink.toml");
  ASSERT_GE(run.frames.size(), 8U);
  // Request 523, response 524, PO 11, PI 12, again and again.
  const std::vector<std::string> call{"20B#3100207E00000000", "20C#3100207E00000000", "00B#000613880000",
                                      "00C#020200000000"};
  for (size_t n = 0; n < run.frames.size(); ++n) EXPECT_EQ(run.frames[n].text, call[n % 4]) << n;
}

// MOVITRAC 07 chapter 5.1, with the slave at the speed that is ordered.
TEST(Movilink, SampleOfMovitrac07) {
  PROVES("M07-SW-11", "M07-SCOM-08");
  const ExampleRun run = run_example("movilink-m07/movilink-m07.toml");
  const std::vector<int32_t> call{5, 1, 4, 1, 8318, 20, 0};
  for (size_t n = 0; n < call.size(); ++n)
    EXPECT_EQ(run.h(0, 420 + static_cast<int>(n)), call[n]) << "H" << 420 + n;
  // H21 = 1000000, H25 = 0407h with 7 as its low byte, H26 = 5000, H27 = 0.
  EXPECT_EQ(run.result.exit_code, 0);
  EXPECT_NE(run.result.err.find("6 of 6 expectations met"), std::string::npos) << run.result.err;
  const std::vector<std::string> ids{"20B#", "20C#", "00B#", "00C#"};
  ASSERT_GE(run.frames.size(), 400U);
  for (size_t n = 0; n < run.frames.size(); ++n)
    ASSERT_TRUE(run.frames[n].text.starts_with(ids[n % 4])) << n << " " << run.frames[n].text;
}

TEST(AllExamples, MeetTheirExpectations) {
  size_t plants = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(project("examples"))) {
    if (entry.path().extension() != ".toml" || !entry.path().stem().extension().empty()) continue;  // of a test or a campaign
    ++plants;
    const CommandResult result = run_ipos({"run", entry.path().string(), "--for", "10s"});
    EXPECT_EQ(result.exit_code, 0) << entry.path() << "\n" << result.err;
    EXPECT_NE(result.err.find(" expectations met"), std::string::npos) << entry.path() << " expects nothing";
  }
  EXPECT_GE(plants, 17U);
}

}  // namespace
}  // namespace ipos::tests

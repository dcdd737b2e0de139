// What the lines of a plant bring into a log: every kind of line, its times, and what stands in it when the run ends.
#include <gtest/gtest.h>

#include <sstream>

#include "runtime/plant/plant.hpp"
#include "tests/tools/taken_log.hpp"
#include "tools/logs/log_writer.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::tools;  // NOLINT: everything here is about logs
using runtime::kMillisecond;

constexpr const char* kStation = "[[station]]\nname = \"a\"\nunit = \"mdxb\"\n";
constexpr const char* kCan = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 500000\n";
constexpr const char* kSerial = "[[bus]]\nname = \"wire\"\nkind = \"rs485\"\nbaud = 9600\n";
constexpr const char* kDp = "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n";

class Logged {
 public:
  Logged(const std::string& text, const char* name) : writer_(make_log_writer(name, out_)) {
    std::vector<runtime::PlantError> errors;
    plant.emplace(runtime::read_plant_file(text).plant, std::vector<std::optional<vm::Image>>(1), std::nullopt, errors);
    EXPECT_TRUE(errors.empty());
    for (const auto& bus : plant->buses()) bus->attach_hand();
    log.emplace(*plant, *writer_);
  }
  void send(const char* bus, const char* text, Time until) {
    plant->run_until(until - 1);
    EXPECT_EQ(plant->find_bus(bus)->send(text), std::nullopt) << text;
  }
  Taken taken_to(Time end) {
    plant->run_until(end);
    log->finish();
    return taken(out_.str());
  }
  std::string written() const { return out_.str(); }

  std::optional<runtime::Plant> plant;
  std::optional<PlantLog> log;

 private:
  std::ostringstream out_;
  std::unique_ptr<LogWriter> writer_;
};

// 4D3h with 8 bytes at 500 kbit/s: 111 bits and what is stuffed, so more than 222 us and less than 270 us (ISO 11898-1).
TEST(PlantLog, AFrameHasTheTimeOfItsEnd) {
  Logged run(std::string(kCan) + kStation + "sbus = \"sbus\"\n", "a.log");
  run.send("sbus", "4D3#3100207E00000000", 10 * kMillisecond);
  const Taken got = run.taken_to(20 * kMillisecond);
  ASSERT_EQ(got.can.size(), 1U);
  EXPECT_GT(got.can[0].time, 10 * kMillisecond + 220'000);
  EXPECT_LT(got.can[0].time, 10 * kMillisecond + 270'000);
}

// The first attempt is disturbed, the second one gets through: readers of error frames count one.
TEST(PlantLog, AnErrorFrameIsInIt) {
  const std::string fault = "[[fault]]\nbus = \"sbus\"\nkind = \"corrupt\"\nframe = 1\n";
  for (const char* name : {"a.log", "a.asc", "a.trc", "a.pcapng"}) {
    Logged run(kCan + (kStation + std::string("sbus = \"sbus\"\n")) + fault, name);
    run.send("sbus", "4D3#3100207E00000000", 10 * kMillisecond);
    const Taken got = run.taken_to(20 * kMillisecond);
    EXPECT_TRUE(got.wrong.empty()) << name;
    EXPECT_EQ(got.can.size(), 1U) << name;
    EXPECT_EQ(got.left_out.of(LeftOut::ErrorFrame), 1U) << name;
  }
}

// As version 2.1 of the form prints it: no identifier, five bytes. At 10 ms nobody is there who could acknowledge the second frame:
// its sender meets a recessive acknowledge slot (19h of the SJA1000) again and again.
TEST(PlantLog, ErrorFramesOfATraceOfPeak) {
  const auto rows = [](const std::string& station, const std::string& fault, Time end) {
    Logged run(kCan + (kStation + station) + fault, "a.trc");
    run.send("sbus", "4D3#3100207E00000000", 10 * kMillisecond);
    run.taken_to(end);
    return run.written();
  };
  const std::string disturbed =
      rows("sbus = \"sbus\"\n", "[[fault]]\nbus = \"sbus\"\nkind = \"corrupt\"\nframe = 1\n", 20 * kMillisecond);
  EXPECT_NE(disturbed.find(" ER  1        - Rx -  5    08 00 00 00 00\n      2 "), std::string::npos) << disturbed;
  EXPECT_NE(rows("", "", 11 * kMillisecond).find(" ER  1        - Rx -  5    08 00 19 00 00\n"), std::string::npos);
}

// 1Dh would be an answer; this request to address 1 stops in the middle of its words: what has come is told as void.
TEST(PlantLog, ATelegramThatDoesNotEndIsTold) {
  Logged run(std::string(kSerial) + kStation, "a.pcapng");
  run.send("wire", "02 01 05 00 06", 10 * kMillisecond);
  const Taken got = run.taken_to(12 * kMillisecond);  // 5 characters of 11 bits are 5.7 ms: one is complete
  EXPECT_TRUE(got.wrong.empty());
  ASSERT_EQ(got.serial.size(), 1U);
  EXPECT_EQ(got.serial[0].reception.bytes.size, 1);
  EXPECT_FALSE(got.serial[0].reception.telegram);
}

TEST(PlantLog, FramesOfProfibusAreInIt) {
  Logged run(std::string(kDp) + kStation, "a.pcapng");
  run.send("dp", "10 09 20 49 fcs 16", 10 * kMillisecond);
  const Taken got = run.taken_to(20 * kMillisecond);
  ASSERT_EQ(got.dp.size(), 1U);
  EXPECT_EQ(got.dp[0].line, "dp");
  EXPECT_EQ(got.dp[0].reception.octets.size(), 6U);
}

TEST(PlantLog, AFormOfCanIsEmptyWithoutALineOfCan) {
  const auto empty = [](const std::string& text, const char* name) { return Logged(text, name).log->stays_empty(); };
  const std::string station = kStation;
  for (const char* name : {"a.log", "a.asc", "a.trc"}) {
    EXPECT_TRUE(empty(kSerial + station, name)) << name;
    EXPECT_TRUE(empty(kSerial + (kDp + station), name)) << name;
    EXPECT_FALSE(empty(kSerial + (kCan + station), name)) << name;
    EXPECT_FALSE(empty(station, name)) << "there is no line at all";
  }
  for (const char* bus : {kSerial, kDp, kCan}) EXPECT_FALSE(empty(bus + station, "a.pcapng"));
}

}  // namespace
}  // namespace ipos::tests

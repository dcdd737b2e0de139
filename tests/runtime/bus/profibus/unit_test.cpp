// The parameter channel, the process data words and the watchdog time of a MOVITRAC 31, through its slave.
#include "runtime/bus/profibus/dp_unit.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cstdio>
#include <tuple>

#include "tests/runtime/bus/profibus/mc31_rig.hpp"

namespace ipos::tests {
namespace {

TEST(Bcd, DigitsAndNothingElse) {
  PROVES("DP-PAR-15");
  EXPECT_EQ(from_bcd(0x00000950), 950);
  EXPECT_EQ(to_bcd(950), 0x950U);
  EXPECT_EQ(from_bcd(0x99999999), 99'999'999);
  EXPECT_EQ(to_bcd(100'000'000), std::nullopt);
  EXPECT_EQ(to_bcd(-1), std::nullopt);
  for (unsigned digit = 0; digit < 8; ++digit)
    for (uint32_t nibble = 10; nibble < 16; ++nibble) EXPECT_EQ(from_bcd(nibble << 4 * digit), std::nullopt);
  // The coding of each parameter stands in the table: P120 in BCD, a position as it is.
  Mc31Bench bench;
  bench.drive.values[25] = 950;
  bench.drive.values[200] = 100'000;
  EXPECT_EQ(bench.service("71 00 04 01 00 00 00 00"), "71 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.service("31 00 04 B0 00 00 00 00"), "31 00 04 B0 00 01 86 A0");
}

RC_GTEST_PROP(BcdProperty, DecimalTextIsTheSameDigits, ()) {
  const int32_t value = *rc::gen::inRange(0, 100'000'000);
  char text[16];
  std::snprintf(text, sizeof text, "%d", value);
  RC_ASSERT(to_bcd(value) == static_cast<uint32_t>(std::stoul(text, nullptr, 16)));
  RC_ASSERT(from_bcd(*to_bcd(value)) == value);
}

TEST(ParameterChannel, LayoutAndManagementByte) {
  PROVES("DP-PAR-01", "DP-PAR-02", "DP-PAR-14");
  const auto request = runtime::parameter_request(runtime::Service::Read, 1025, 0, 0);
  EXPECT_EQ(text_of(runtime::encode(request)), "31 00 04 01 00 00 00 00");
  const auto write = runtime::decode_parameter({0x72, 0, 4, 1, 0, 0, 9, 0x50});
  EXPECT_EQ(write.service_code(), 2);
  EXPECT_EQ(write.data_length(), 4);
  EXPECT_TRUE(write.synchronous());  // the handshake bit
  EXPECT_FALSE(write.failed());
  EXPECT_EQ(write.index, 1025);
  EXPECT_EQ(write.data, 0x950U);
  for (int length = 0; length < 4; ++length)
    EXPECT_EQ(runtime::decode_parameter({static_cast<uint8_t>(length << 4)}).data_length(), length + 1);
  // P120 has the index 25; over the fieldbus 1025 reaches it, 25 nothing.
  Mc31Bench bench;
  EXPECT_EQ(bench.service("71 00 04 01 00 00 00 00"), "71 00 04 01 00 00 01 00");
  EXPECT_EQ(bench.drive.served.back().index, 25);
  EXPECT_EQ(bench.service("31 00 00 19 00 00 00 00"), "B1 00 00 19 08 00 00 10");
  EXPECT_EQ(mc31_table().find("120")->index, 25);
}

TEST(ParameterChannel, OnlyReadAndWrite) {
  PROVES("DP-PAR-03", "DP-PAR-10");
  for (int service = 0; service < 16; ++service) {
    if (service == 1 || service == 2) continue;
    Mc31Bench bench;
    const Octets code{static_cast<uint8_t>(0x70 | service)}, refused{static_cast<uint8_t>(0xF0 | service)};
    EXPECT_EQ(bench.service(text_of(code) + " 00 04 01 00 00 09 50"),
              text_of(refused) + " 00 04 01 05 05 00 00");
    EXPECT_TRUE(bench.drive.served.empty());
  }
  Mc31Bench bench;
  EXPECT_EQ(bench.service("45 00 04 01 00 00 00 00"), "C5 00 04 01 05 05 00 00");
}

TEST(ParameterChannel, RunsWhenTheHandshakeChanges) {
  PROVES("DP-PAR-04");
  Mc31Bench bench;
  for (int cycle = 0; cycle < 1000; ++cycle) bench.channel("72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.drive.writes(), 1);
  for (int cycle = 0; cycle < 1000; ++cycle) bench.channel("32 00 04 01 00 00 08 50");
  EXPECT_EQ(bench.drive.writes(), 2);
  EXPECT_EQ(bench.drive.values[25], 850);
}

TEST(ParameterChannel, OldHandshakeUntilItIsDone) {
  PROVES("DP-PAR-05");
  Mc31Bench bench;
  std::string answers;
  for (int cycle = 0; cycle < 12; ++cycle)
    answers += bench.channel("72 00 04 01 00 00 09 50").substr(0, 2) + " ";
  // 10 ms at a cycle of 1 ms.
  EXPECT_EQ(answers, "32 32 32 32 32 32 32 32 32 32 72 72 ");
}

TEST(ParameterChannel, MirrorsWhileItIsPrepared) {
  PROVES("DP-PAR-06");
  Mc31Bench bench;
  EXPECT_EQ(bench.channel("32 00 04 01 00 00 09 50"), "32 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.channel("32 00 04 02 12 34 56 78"), "32 00 04 02 12 34 56 78");
  EXPECT_EQ(bench.channel("B2 00 04 02 12 34 56 78"), "32 00 04 02 12 34 56 78");  // bit 7 is the unit's
  EXPECT_TRUE(bench.drive.served.empty());
}

TEST(ParameterChannel, ReadIgnoresLengthAndData) {
  PROVES("DP-PAR-07", "DP-PAR-12");
  Mc31Bench bench;
  EXPECT_EQ(bench.service("00 00 04 01 00 00 00 00"), "00 00 04 01 00 00 00 00");
  EXPECT_EQ(bench.service("41 00 04 01 DE AD BE EF"), "41 00 04 01 00 00 01 00");
  EXPECT_EQ(bench.service("01 00 04 01 00 00 00 00"), "01 00 04 01 00 00 01 00");
  EXPECT_EQ(bench.service("42 00 04 01 00 00 09 50"), "C2 00 04 01 06 08 00 00");
}

TEST(ParameterChannel, TwoWrites) {
  PROVES("DP-PAR-08");
  Mc31Bench bench;
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 50"), "72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.drive.values[25], 950);
  EXPECT_EQ(bench.service("32 00 04 01 00 00 10 00"), "32 00 04 01 00 00 10 00");
  EXPECT_EQ(bench.drive.values[25], 1000);
  EXPECT_EQ(bench.drive.writes(), 2);
}

TEST(ParameterChannel, Refusals) {
  PROVES("DP-PAR-09", "DP-PAR-11", "DP-PAR-16");
  Mc31Bench bench;
  EXPECT_EQ(bench.service("72 00 03 FA 00 00 00 05"), "F2 00 03 FA 08 00 00 12");  // P073 is read only
  EXPECT_EQ(bench.service("32 00 03 FA 00 00 00 05"), "B2 00 03 FA 08 00 00 12");
  EXPECT_EQ(bench.service("72 00 04 01 99 99 99 99"), "F2 00 04 01 08 00 00 15");
  EXPECT_EQ(bench.service("22 00 04 01 00 00 09 50"), "A2 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.service("42 00 04 01 00 00 09 50"), "C2 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.service("12 00 04 01 00 00 09 50"), "92 00 04 01 06 08 00 00");
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 5A"), "F2 00 04 01 08 00 00 1D");
  EXPECT_EQ(bench.service("32 00 FF FF 00 00 00 00"), "B2 00 FF FF 08 00 00 10");
  bench.drive.locked = true;
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 50"), "F2 00 04 01 08 00 00 13");
  EXPECT_EQ(bench.drive.values[25], 100);
}

TEST(ParameterChannel, TheLinkToTheInverter) {
  PROVES("DP-PAR-13");
  Mc31Bench bench;
  bench.parameters.cut_link(true);
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 50"), "F2 00 04 01 06 02 00 00");
  EXPECT_EQ(bench.service("31 00 04 01 00 00 00 00"), "B1 00 04 01 06 02 00 00");  // for as long as it lasts
  bench.parameters.cut_link(false);
  EXPECT_EQ(bench.service("72 00 04 01 00 00 09 50"), "72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.drive.values[25], 950);
}

TEST(DpUnit, ProcessDataBesideTheChannel) {
  PROVES("DP-CFG-08", "DP-PAR-17");
  Mc31Bench bench;
  bench.drive.status = {0x0407, 0x05DC, 0x0123};
  for (int cycle = 0; cycle < 20; ++cycle) {
    const auto speed = static_cast<uint8_t>(cycle);
    const std::string words = "00 06 00 " + text_of(Octets{speed}) + " 03 E8";
    bench.now += kMillisecond;
    const std::string answer = bench.ask(std::nullopt, "72 00 04 01 00 00 09 50 " + words);
    EXPECT_EQ(answer.substr(24), "04 07 05 DC 01 23");
    EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{6, speed, 1000}));
  }
  EXPECT_EQ(bench.drive.values[25], 950);
  EXPECT_EQ(bench.unit.accessed(), kMillisecond);
}

TEST(DpUnit, WordsOfEachConfiguration) {
  const std::tuple<std::string, std::string, std::vector<uint16_t>> kRows[] = {
      {"F0", "00 06", {6}},
      {"F1", "00 06 05 DC", {6, 1500}},
      {"F2", "00 06 05 DC 03 E8", {6, 1500, 1000}},
      {"F3 F0", "00 00 00 00 00 00 00 00 00 06", {6}}};
  for (const auto& [cfg, outputs, words] : kRows) {
    Mc31Bench bench(cfg);
    bench.drive.status = {0x1122, 0x3344, 0x5566};
    const std::string inputs = bench.ask(std::nullopt, outputs);
    EXPECT_EQ(bench.drive.output, words) << cfg;
    EXPECT_EQ(inputs.substr(inputs.size() - 3 * words.size() * 2 + 1),
              std::string("11 22 33 44 55 66").substr(0, 6 * words.size() - 1));
  }
}

TEST(DpUnit, LeavingDataExchangeStopsTheDrive) {
  Mc31Bench bench("F1");
  bench.ask(std::nullopt, "00 06 05 DC");
  bench.ask(61, "40 00 00 00 31 00 00");
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{0, 0}));
  EXPECT_FALSE(bench.drive.expired_at.has_value());
}

TEST(DpUnit, WatchdogTimeInP571) {
  PROVES("DP-WD-01", "DP-WD-02", "DP-WD-03", "DP-WD-07");
  const auto p571 = [](Mc31Bench& bench) { return bench.drive.values[index_of("571")]; };
  const std::pair<std::string, int32_t> kFactors[] = {{"88 14 01", 20},    {"88 01 14", 20},
                                                      {"80 14 01", 65000}, {"88 FF FF", 64999},
                                                      {"88 01 01", 1},     {"88 FE FF", 64770}};
  for (const auto& [factors, hundredths] : kFactors) {
    Mc31Bench bench("F0", prm(factors));
    EXPECT_EQ(p571(bench), hundredths) << factors;
    EXPECT_EQ(text_of(encode(bench.slave.diagnosis(0))).substr(3, 2), factors[1] == '8' ? "0C" : "04");
  }
  EXPECT_EQ(stdlib::parameter_text(*mc31_table().find("571"), 20), "0.20 s");
  EXPECT_EQ(stdlib::parameter_text(*mc31_table().find("571"), 65000), "650.00 s");
  // By hand it can be written, but the next start of the master overwrites it.
  Mc31Bench bench;
  const Octets index{static_cast<uint8_t>((1000 + index_of("571")) >> 8),
                     static_cast<uint8_t>(1000 + index_of("571"))};
  bench.service("72 00 " + text_of(index) + " 00 00 05 00");
  EXPECT_EQ(p571(bench), 500);
  bench.start("F3 F2", prm("88 14 01"));
  EXPECT_EQ(p571(bench), 20);
}

TEST(DpUnit, WatchdogReachesTheDrive) {
  Mc31Bench bench;
  bench.channel("00 00 00 00 00 00 00 00", "00 06 05 DC 00 00");
  bench.slave.expire(bench.slave.watchdog_deadline());
  EXPECT_EQ(bench.drive.expired_at, bench.now + 200 * kMillisecond);
  EXPECT_EQ(bench.drive.output, (std::vector<uint16_t>{6, 1500, 0}));  // what to do is P572
}

TEST(Mc31List, WhatTheManualNames) {
  for (const char* number : {"073", "120", "571", "572", "600", "601", "802", "841"})
    EXPECT_NE(mc31_table().find(number), nullptr) << number;
  EXPECT_EQ(stdlib::parameter_text(*mc31_table().find("841"), 0), "STANDARD");
  EXPECT_EQ(stdlib::parameter_text(*mc31_table().find("841"), 1), "FIELDBUS");
  EXPECT_EQ(stdlib::parameter_text(*mc31_table().find("120"), 950), "9.50 s");
  EXPECT_EQ(stdlib::parameter_text(*mc31_table().find("600"), 0), "NO FUNCTION");
  EXPECT_EQ(mc31_table().find("841")->default_value, 0);
}

struct TenWords final : runtime::ParameterServer, FieldbusDrive {
  tl::expected<int32_t, ReturnCode> serve(Time, const runtime::ParameterRequest&) override { return 0; }
  void take_output(Time, runtime::OutputChannel, std::span<const uint16_t> words) override {
    output.assign(words.begin(), words.end());
  }
  runtime::ProcessWords input(Time) override { return {0x0101, 0x0202, 0x0303}; }
  FurtherWords further_input(Time) override {
    return {0x0404, 0x0505, 0x0606, 0x0707, 0x0808, 0x0909, 0x0A0A};
  }
  void synchronize(Time) override {}
  void set_fieldbus_timeout(Time, int32_t) override {}
  void fieldbus_timeout_expired(Time) override {}
  void set_fieldbus_address(Time, uint8_t) override {}
  std::vector<uint16_t> output;
};

// Each word stands in its place, high octet first, whatever the configuration carries.
TEST(ProcessData, WordsOfEveryConfigurationOfMovidrive) {
  TenWords drive;
  DpUnit unit(drive, drive);
  size_t longest = 0;
  for (const Configuration& configuration : configurations(ConfigurationSet::Movidrive)) {
    unit.configured(0, configuration);
    const size_t channel = configuration.parameter_channel ? 8 : 0;
    const size_t words = (configuration.octets - channel) / 2;
    longest = std::max(longest, words);
    Octets inputs(configuration.octets), outputs(configuration.octets);
    unit.read_inputs(0, inputs);
    std::vector<uint16_t> expected;
    for (size_t n = 0; n < words; ++n) {
      EXPECT_EQ(inputs[channel + 2 * n], n + 1) << configuration.name;
      EXPECT_EQ(inputs[channel + 2 * n + 1], n + 1) << configuration.name;
      outputs[channel + 2 * n] = static_cast<uint8_t>(0x10 + n);
      outputs[channel + 2 * n + 1] = static_cast<uint8_t>(n);
      expected.push_back(static_cast<uint16_t>(0x1000 + 0x101 * n));
    }
    unit.take_outputs(0, outputs);
    EXPECT_EQ(drive.output, expected) << configuration.name;
    unit.exchange_ended(0);
    EXPECT_EQ(drive.output, std::vector<uint16_t>(words, 0)) << configuration.name;
  }
  EXPECT_EQ(longest, 10U);
}

}  // namespace
}  // namespace ipos::tests

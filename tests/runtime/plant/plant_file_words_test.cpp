// The words of a plant file: times, names of terminals, analog values, octets.
#include <gtest/gtest.h>

#include "runtime/plant_file/bytes_text.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/plant_file/state_names.hpp"

namespace ipos::runtime {
namespace {

TEST(PlantWords, TimesAreNumberAndUnit) {
  constexpr int64_t kUs = 1'000, kMs = 1'000 * kUs, kS = 1'000 * kMs, kMin = 60 * kS, kH = 60 * kMin;
  const struct {
    const char* text;
    int64_t ns;
  } rows[] = {
      {"0us", 0},
      {"1us", kUs},
      {"20us", 20 * kUs},
      {"1ms", kMs},
      {"500ms", 500 * kMs},
      {"1s", kS},
      {"1.5s", 1500 * kMs},
      {"2min", 2 * kMin},
      {"1h", kH},
      {"0.25h", 15 * kMin},
      {"1e3ms", kS},
      // To the nearest nanosecond.
      {"0.0015us", 2},
      {"0.0014us", 1},
      {"0.0004us", 0},
      // A number up to 1e9, and a time up to 9e18 ns.
      {"1000000000us", 1'000'000'000 * kUs},
      {"1000000001us", -1},
      {"1000000000s", 1'000'000'000 * kS},
      {"2500000h", 2'500'000 * kH},
      {"2500001h", -1},
      {"150000000min", 150'000'000 * kMin},
      {"150000001min", -1},
      {"", -1},
      {"s", -1},
      {"1", -1},
      {"1 s", -1},
      {"1s ", -1},
      {"x1s", -1},
      {"1xs", -1},
      {"-1s", -1},
      {"+1s", -1},
      {"1d", -1},
      {"nans", -1},
      {"infs", -1},
      {"1S", -1},
  };
  for (const auto& row : rows) EXPECT_EQ(parse_duration(row.text), row.ns) << row.text;
}

// DI00..DI07 are bits 0..7, DI10..DI17 bits 8..15; DB00, DO01..DO05 are bits 0..5, DO10..DO17 bits 8..15.
TEST(PlantWords, TerminalsHaveTheirBits) {
  for (int tens = 0; tens < 10; ++tens)
    for (int ones = 0; ones < 10; ++ones) {
      const std::string digits = std::to_string(tens) + std::to_string(ones);
      const bool there = tens <= 1 && ones <= 7;
      EXPECT_EQ(parse_input("DI" + digits), there ? 8 * tens + ones : -1) << digits;
      const bool output = there && (tens == 1 || (ones >= 1 && ones <= 5));
      EXPECT_EQ(parse_output("DO" + digits), output ? 8 * tens + ones : -1) << digits;
    }
  EXPECT_EQ(parse_output("DB00"), 0);
  for (const char* wrong :
       {"", "DI", "DI0", "DI000", "DO01", "di00", "DI0:", "DI/0", "DI:0", "DI0/", "XDI00"})
    EXPECT_EQ(parse_input(wrong), -1) << wrong;
  for (const char* wrong : {"", "DO", "DB01", "DB", "DI01", "DO1", "DO011"})
    EXPECT_EQ(parse_output(wrong), -1) << wrong;
}

// The lines behind the 16 binary ones: AI1 with a voltage and a current, AI2 the same, frequency, potentiometer.
TEST(PlantWords, AnalogValuesHaveTheirLineAndRange) {
  const struct {
    const char* name;
    const char* text;
    int line;  // -1: no value
    int32_t value;
  } rows[] = {
      {"AI1", "5 V", 16, 5'000},
      {"AI1", "-10 V", 16, -10'000},
      {"AI1", "10V", 16, 10'000},
      {"AI1", "0.0006   V", 16, 1},
      {"AI1", "0.0004 V", 16, 0},
      {"AI1", "10.001 V", -1, 0},
      {"AI1", "-10.001 V", -1, 0},
      {"AI1", "12 mA", 17, 12'000},
      {"AI1", "20 mA", 17, 20'000},
      {"AI1", "0 mA", 17, 0},
      {"AI1", "20.001 mA", -1, 0},
      {"AI1", "-0.001 mA", -1, 0},
      {"AI2", "-2.5 V", 18, -2'500},
      {"AI2", "10 V", 18, 10'000},
      {"AI2", "10.1 V", -1, 0},
      {"AI2", "-10.1 V", -1, 0},
      {"AI2", "4 mA", 19, 4'000},
      {"AI2", "20.1 mA", -1, 0},
      {"AI2", "-1 mA", -1, 0},
      {"frequency", "65 kHz", 20, 65'000},
      {"frequency", "0 kHz", 20, 0},
      {"frequency", "65.001 kHz", -1, 0},
      {"frequency", "-1 kHz", -1, 0},
      {"potentiometer", "100 %", 21, 1'000},
      {"potentiometer", "0 %", 21, 0},
      {"potentiometer", "12.5 %", 21, 125},
      {"potentiometer", "100.1 %", -1, 0},
      {"potentiometer", "-1 %", -1, 0},
      {"AI1", "V", -1, 0},
      {"AI1", "", -1, 0},
      {"AI1", "5", -1, 0},
      {"AI1", "5 mV", -1, 0},
      {"AI1", "5 %", -1, 0},
      {"AI1", "x V", -1, 0},
      {"AI1", "5x V", -1, 0},
      {"AI1", " 5 V", -1, 0},
      {"AI1", "nan V", -1, 0},
      {"AI3", "5 V", -1, 0},
      {"frequency_input", "5 kHz", -1, 0},
  };
  for (const auto& row : rows) {
    const auto setting = parse_analog(row.name, row.text);
    EXPECT_EQ(setting ? setting->line : -1, row.line) << row.name << ' ' << row.text;
    EXPECT_EQ(setting ? setting->value : 0, row.value) << row.name << ' ' << row.text;
  }
  EXPECT_EQ(parse_analog_input("AI1"), 16);
  EXPECT_EQ(parse_analog_input("AI2"), 18);
  EXPECT_EQ(parse_analog_input("frequency"), 20);
  EXPECT_EQ(parse_analog_input("potentiometer"), 21);
  EXPECT_EQ(parse_analog_input("AI1_current"), -1);
}

TEST(PlantWords, ATerminalHasOneLineOrTwo) {
  const auto terminal = [](size_t line) { return line < 16 ? line : line < 18 ? 16 : line < 20 ? 18 : line; };
  for (size_t a = 0; a < kInputLines; ++a)
    for (size_t b = 0; b < kInputLines; ++b)
      EXPECT_EQ(same_terminal(a, b), terminal(a) == terminal(b)) << a << ' ' << b;
}

TEST(PlantWords, StatesAreFoundByTheirRow) {
  EXPECT_EQ(find_state("fault"), 0);
  EXPECT_EQ(find_state("status"), 1);
  EXPECT_EQ(find_state("program_fault_line"), 10) << "the last one";
  EXPECT_EQ(find_state("faults"), -1);
  EXPECT_EQ(find_state(""), -1);
  EXPECT_TRUE(state_names().starts_with("fault, status, "));
  for (const char* state : {"fault", "program_fault", "program_fault_line"}) EXPECT_TRUE(tells_fault(state));
  for (const char* state : {"status", "enabled", "running"}) EXPECT_FALSE(tells_fault(state));
}

TEST(PlantWords, OctetsAreTwoDigitsEach) {
  using Octets = std::vector<uint8_t>;
  EXPECT_EQ(parse_bytes("02 ff 0A"), (Octets{0x02, 0xFF, 0x0A}));
  EXPECT_EQ(parse_bytes("  72   00 "), (Octets{0x72, 0x00}));
  for (const char* wrong : {"", "  ", "2", "002", "0x", "x0", "02,03", "-1", "02 3", "02 sum"})
    EXPECT_FALSE(parse_bytes(wrong)) << wrong;
  const CheckWord sum{"sum",
                      [](std::span<const uint8_t> bytes) {
                        int all = 0;
                        for (const uint8_t byte : bytes) all += byte;
                        return static_cast<uint8_t>(all);
                      },
                      1};
  EXPECT_EQ(parse_bytes("01 02 sum 16", sum), (Octets{1, 2, 3, 0x16}));
  EXPECT_EQ(parse_bytes("01 02", sum), (Octets{1, 2})) << "a check need not be asked for";
  for (const char* wrong : {"01 sum", "01 sum 16 16", "01 sum sum", "sum"})
    EXPECT_FALSE(parse_bytes(wrong, sum)) << wrong;
}

}  // namespace
}  // namespace ipos::runtime

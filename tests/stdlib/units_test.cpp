// Quantities, units, conversion factors, and parameter values as text.
#include "stdlib/units.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "stdlib/parameters.hpp"
#include "stdlib/return_codes.hpp"
#include "tests/harness/proves.hpp"
#include "tests/stdlib/printed_quantities.hpp"

namespace ipos::stdlib {
namespace {

const ParameterTable& md60a() { return parameter_table(*find_unit("md60a")); }

TEST(Units, ConversionFactors) {
  PROVES("PAR-23", "M07-PAR-20");
  const struct {
    int index;
    double a, b;
  } printed[] = {{66, 1.667e-5, 0},    {67, 1.667e-2, 0}, {68, 16.67, 0},    {70, 60, 0},
                 {71, 2.778e-7, 0},    {72, 2.778e-4, 0}, {73, 0.2778, 0},   {74, 3600, 0},
                 {75, 3.6e6, 0},       {76, 3.6e9, 0},    {77, 86400, 0},    {78, 2.909e-4, 0},
                 {79, 4.848e-6, 0},    {80, 1.745e-2, 0}, {81, 1.571e-2, 0}, {100, 1, 273.15},
                 {101, 0.5556, 255.37}};
  for (const auto& row : printed) {
    const auto conversion = find_conversion(row.index);
    ASSERT_TRUE(conversion) << row.index;
    EXPECT_NEAR(conversion->a / row.a, 1, 1e-3) << row.index;
    EXPECT_DOUBLE_EQ(conversion->b, row.b) << row.index;
  }
  double power = 1e-9;
  for (int n = -9; n <= 9; ++n, power *= 10) EXPECT_NEAR(find_conversion(n)->a / power, 1, 1e-9) << n;
  for (const int index : {69, 65, 82, 99, 102, 127, -65}) EXPECT_FALSE(find_conversion(index)) << index;
}

TEST(Units, PhysicalValues) {
  PROVES("PAR-22", "EX-08", "M07-PAR-21");
  const auto physical = [](double value, int conversion) {
    return value * find_conversion(conversion)->a + find_conversion(conversion)->b;
  };
  EXPECT_DOUBLE_EQ(physical(1500, -3), 1.5);
  EXPECT_DOUBLE_EQ(physical(25, 100), 298.15);
  EXPECT_DOUBLE_EQ(physical(1500000, 66), 25);
  EXPECT_EQ(md60a().find("P302")->default_value, 1500000);
  EXPECT_EQ(parameter_text(*md60a().find("P302"), 1500000), "1500.000 rpm");
  EXPECT_EQ(parameter_text(*md60a().find("P130"), 1500), "1.500 s");
}

TEST(Units, QuantitiesAndUnits) {
  PROVES("PAR-24");
  const auto& printed = tests::kPrintedQuantities;
  for (size_t i = 0; i < std::size(printed); ++i)
    EXPECT_EQ(quantity_name(static_cast<uint8_t>(i)), printed[i]);
  EXPECT_EQ(quantity_name(29), "");
  EXPECT_EQ(quantity_name(kNoQuantity), "");
  // Every line of the table, and nothing else. (12, 81) stands in the Danish edition only.
  const struct {
    int quantity, conversion;
    const char* abbreviation;
  } units[] = {{1, 0, "m"},
               {1, -3, "mm"},
               {1, 3, "km"},
               {1, -6, "µm"},
               {2, 0, "m²"},
               {2, -6, "mm²"},
               {2, 6, "km²"},
               {3, 0, "m³"},
               {3, -3, "l"},
               {4, 0, "s"},
               {4, 70, "min"},
               {4, 74, "h"},
               {4, 77, "d"},
               {4, -3, "ms"},
               {4, -6, "µs"},
               {5, 0, "N"},
               {5, 3, "kN"},
               {5, 6, "MN"},
               {6, 0, "Pa"},
               {6, 3, "kPa"},
               {6, 2, "mbar"},
               {6, 5, "bar"},
               {7, 0, "kg"},
               {7, -3, "g"},
               {7, -6, "mg"},
               {7, 3, "t"},
               {8, 0, "J"},
               {8, 3, "kJ"},
               {8, 6, "MJ"},
               {8, 74, "Wh"},
               {8, 75, "kWh"},
               {8, 76, "MWh"},
               {9, 0, "W"},
               {9, 3, "kW"},
               {9, 6, "MW"},
               {9, -3, "mW"},
               {10, 0, "VA"},
               {10, 3, "kVA"},
               {10, 6, "MVA"},
               {10, -3, "mVA"},
               {11, 0, "rps"},
               {11, 67, "rpm"},
               {11, 72, "rph"},
               {12, 0, "rad"},
               {12, 79, "″"},
               {12, 78, "′"},
               {12, 80, "°"},
               {12, 81, "g"},
               {13, 0, "m/s"},
               {13, -3, "mm/s"},
               {13, 66, "mm/min"},
               {13, 67, "m/min"},
               {13, 68, "km/min"},
               {13, 71, "mm/h"},
               {13, 72, "m/h"},
               {13, 73, "km/h"},
               {14, 0, "m³/s"},
               {14, 67, "m³/min"},
               {14, 72, "m³/h"},
               {14, -3, "l/s"},
               {14, 66, "l/min"},
               {14, 71, "l/h"},
               {15, 0, "kg/s"},
               {15, -3, "g/s"},
               {15, 3, "t/s"},
               {15, 66, "g/min"},
               {15, 67, "kg/min"},
               {15, 68, "t/min"},
               {15, 71, "g/h"},
               {15, 72, "kg/h"},
               {15, 73, "t/h"},
               {16, 0, "Nm"},
               {16, 3, "kNm"},
               {16, 6, "MNm"},
               {17, 0, "K"},
               {17, 100, "°C"},
               {17, 101, "°F"},
               {18, 0, "K"},
               {19, 0, "J/(K × kg)"},
               {19, 3, "kJ/(K × kg)"},
               {19, 6, "MJ/(K × kg)"},
               {20, 0, "J/kg"},
               {20, 3, "kJ/kg"},
               {20, 6, "MJ/kg"},
               {21, 0, "V"},
               {21, 3, "kV"},
               {21, -3, "mV"},
               {21, -6, "µV"},
               {22, 0, "A"},
               {22, -3, "mA"},
               {22, 3, "kA"},
               {22, -6, "µA"},
               {23, 0, "Ω"},
               {23, -3, "mΩ"},
               {23, 3, "kΩ"},
               {23, 6, "MΩ"},
               {24, 0, "%"},
               {25, 0, "%"},
               {26, -3, "g/kg"},
               {27, 0, "%"},
               {28, 0, "Hz"},
               {28, 3, "kHz"},
               {28, 6, "MHz"},
               {28, 9, "GHz"}};
  std::map<std::pair<int, int>, std::string> expected;
  for (const auto& row : units) expected[{row.quantity, row.conversion}] = row.abbreviation;
  EXPECT_EQ(expected.size(), 104U);
  for (int quantity = 0; quantity < 256; ++quantity)
    for (int conversion = -128; conversion < 128; ++conversion) {
      const auto row = expected.find({quantity, conversion});
      EXPECT_EQ(unit_abbreviation(static_cast<uint8_t>(quantity), conversion),
                row == expected.end() ? "" : row->second)
          << quantity << ", " << conversion;
    }
  EXPECT_EQ(find_unit_conversion(11, "rpm"), 67);
  EXPECT_FALSE(find_unit_conversion(11, "m"));
}

TEST(ParameterText, ReadsAsPeopleDo) {
  const struct {
    const char* number;
    int32_t value;
    const char* text;
  } rows[] = {{"P000", 1000000, "1000.000 rpm"},
              {"P000", -750, "-0.750 rpm"},
              {"P014", 25, "25 °C"},
              {"P015", 120, "2.000 h"},   // minutes
              {"P017", 36, "1.000 kWh"},  // 1E5 Ws each
              {"P111", -500, "-500 mV"},
              {"P115", 5000, "5.000 ms"},  // microseconds
              {"P303", 150000, "150.000 %In"},
              {"P816", 2, "500 kBaud"},
              {"P870", 9, "CTRL. WORD 1"},
              {"P097", 0x0202, "0x0202"},
              {"P817", 128000, "128"},
              {"P092", -1, "4294967.295"},  // unsigned
              {"P600", 26, "26"}};          // a code the list does not have
  for (const auto& row : rows) {
    const Parameter* parameter = md60a().find(row.number);
    ASSERT_NE(parameter, nullptr) << row.number;
    EXPECT_EQ(parameter_text(*parameter, row.value), row.text) << row.number;
  }
}

TEST(ParameterText, IsReadBack) {
  const struct {
    const char* number;
    const char* text;
    int32_t value;
  } rows[] = {{"P130", "2.5 s", 2500},
              {"P130", "2.5", 2500},
              {"P302", "1400 rpm", 1400000},
              {"P816", "500 kBaud", 2},
              {"P816", "500", 2},
              {"P816", "1", 1},
              {"P870", "SPEED [%]", 11},
              {"P870", "8", 8},
              {"P115", "0.01 ms", 10},
              {"P221", "3999999999", static_cast<int32_t>(3999999999U)},
              {"P094", "0x0006", 6},
              {"P160", "-150.2", -150200}};
  for (const auto& row : rows) {
    const auto value = parse_parameter_text(*md60a().find(row.number), row.text);
    ASSERT_TRUE(value) << row.number << " = " << row.text << ": " << value.error();
    EXPECT_EQ(*value, row.value) << row.number << " = " << row.text;
  }
  for (const char* text : {"", "fast", "2.5 kg", "1e9999", "0.0001 s", "99999999999", "0xZZ", "--1"})
    EXPECT_FALSE(parse_parameter_text(*md60a().find("P130"), text)) << text;
  EXPECT_EQ(parse_parameter_text(*md60a().find("P130"), "x").error(),
            "expected a number with up to 3 decimals in s");
  EXPECT_EQ(parse_parameter_text(*md60a().find("P152"), "maybe").error(), "expected 0 = OFF or 1 = ON");
}

TEST(ParameterText, FirmwareNumbersAndAsciiTexts) {
  PROVES("PAR-37", "M07-PAR-24");
  for (const char* unit : {"md60a", "mc07"}) {
    const Parameter& firmware = *parameter_table(*find_unit(unit)).find("P076");
    EXPECT_EQ(parameter_text(firmware, 822609711), "822 609 7.11");
    EXPECT_EQ(parameter_text(firmware, 1822609011), "822 609 X.11");
    EXPECT_EQ(parameter_text(firmware, 823947913), "823 947 9.13");
    EXPECT_EQ(parse_parameter_text(firmware, "822 609 7.11"), 822609711);
    EXPECT_EQ(parse_parameter_text(firmware, "822 609 X.11"), 1822609011);
    EXPECT_EQ(parameter_text(firmware, 0), "0");
    for (const char* text : {"822 609 Y.11", "X", "822 609 X.1", "firmware"})
      EXPECT_FALSE(parse_parameter_text(firmware, text)) << text;
  }
  // P852: two indices of four characters, the first one in the low byte.
  const Parameter& first = *md60a().find(uint16_t{8772});
  EXPECT_EQ(parameter_text(first, 1768763185), "1/mi");
  EXPECT_EQ(parameter_text(*md60a().find(uint16_t{8773}), 110), "n");
  EXPECT_EQ(parse_parameter_text(first, "1/mi"), 1768763185);
  EXPECT_EQ(parse_parameter_text(first, "km"), 'k' + 256 * 'm');
  EXPECT_EQ(parse_parameter_text(first, ""), 0);
  EXPECT_EQ(parameter_text(first, 7), "0x0007") << "no character";
  EXPECT_EQ(parse_parameter_text(first, "0x0007"), 7);
  EXPECT_FALSE(parse_parameter_text(first, "1/min"));
}

TEST(ParameterText, TakesOtherUnitsOfTheQuantity) {
  const struct {
    const char* number;
    const char* text;
    int32_t value;
  } rows[] = {{"P130", "2500 ms", 2500},   {"P130", "2500ms", 2500},  {"P130", "0.5 min", 30000},
              {"P302", "25 rps", 1500000}, {"P115", "0.005 s", 5000}, {"P303", "120 %", 120000},
              {"P111", "0.1 V", 100},      {"P816", "500 kbaud", 2},  {"P803", "on", 1},
              {"P870", "speed", 1},        {"P015", "90 min", 90},    {"P205", "-20%", -20000}};
  for (const auto& row : rows) {
    const auto value = parse_parameter_text(*md60a().find(row.number), row.text);
    ASSERT_TRUE(value) << row.number << " = " << row.text << ": " << value.error();
    EXPECT_EQ(*value, row.value) << row.number << " = " << row.text;
  }
  for (const auto& [number, text] : {std::pair{"P130", "2.5 rps"},
                                     {"P130", "2.5 kBaud"},
                                     {"P816", "500 s"},
                                     {"P014", "300 K"},
                                     {"P813", "5 s"}})
    EXPECT_FALSE(parse_parameter_text(*md60a().find(number), text)) << number << " = " << text;
}

TEST(ParameterText, RefusalsNameValueUnitAndRange) {
  namespace codes = return_codes;
  const struct {
    uint8_t service;
    uint16_t index;
    int32_t value;
    ReturnCode code;
    const char* text;
  } rows[] = {
      {2, 8600, 64, codes::kTooLarge, "P813 SBus address := 64: parameter value too large (0..63)"},
      {2, 8470, -10, codes::kTooSmall,
       "P130 Ramp t11 UP CW := -0.010 s: parameter value too small (0.000 s..2000.000 s)"},
      {2, 8470, 1005, codes::kIncorrectValue,
       "P130 Ramp t11 UP CW := 1.005 s: incorrect parameter value (1.000 s..10.000 s in steps of 0.100 s)"},
      {2, 8505, 0, codes::kIncorrectValue,
       "P224 Slave counter := 0 Inc: incorrect parameter value (-99999999 Inc..-10 Inc or 10 Inc..99999999 "
       "Inc)"},
      {3, 8603, 4, codes::kTooLarge,
       "P816 SBus baud rate := 4: parameter value too large (0 = 125, 1 = 250, 2 = 500 or 3 = 1000)"},
      {2, 8470, 2500, codes::kParameterLock,
       "P130 Ramp t11 UP CW := 2.500 s: parameter lock is active (P803 = ON)"},
      {1, 8392, 0, codes::kCommunication,
       "index 8392 Operational status, t-1: hardware error: no communication"},
      {1, 9500, 0, codes::kInvalidIndex, "index 9500: invalid parameter index"},
      {2, 11020, 5, codes::kFactorySetting, "H20 := 5: factory setting is active"},
      {2, 16003, 5, codes::kProtected, "program word 3 := 5: parameter has access protection"},
      {2, 20003, 5, codes::kNotSaved, "curve point 3 := 5: parameter was not saved in EEPROM"},
      {1, 9500, 0, {8, 0, 0x99}, "index 9500: return code 08 00 00 99"}};
  for (const auto& row : rows)
    EXPECT_EQ(explain_refusal(md60a(), row.service, row.index, row.value, row.code), row.text);
}

// Every legal limit and default survives the way to text and back.
TEST(ParameterText, RoundTripsEveryLimit) {
  for (const char* unit : {"md60a", "mc07", "mdxb"})
    for (const Parameter* p : parameter_table(*find_unit(unit)).by_index())
      for (const int64_t number : {p->minimum(), p->maximum(), p->default_value}) {
        if (p->conversion == 70 || p->conversion == 5) continue;  // hours and kWh: shown rounded
        const auto bits = static_cast<int32_t>(static_cast<uint32_t>(number));
        const auto back = parse_parameter_text(*p, parameter_text(*p, bits));
        ASSERT_TRUE(back) << p->index << " " << parameter_text(*p, bits);
        EXPECT_EQ(*back, bits) << p->index << " " << parameter_text(*p, bits);
      }
}

TEST(ReturnCodes, TablesAreComplete) {
  PROVES("PAR-18", "PAR-19", "M07-PAR-10");
  const struct {
    uint16_t additional;
    const char* word;  // a word of the meaning
  } printed[] = {{0x00, "no error"},   {0x10, "index"},     {0x11, "not implemented"},
                 {0x12, "read"},       {0x13, "lock"},      {0x14, "factory"},
                 {0x15, "too large"},  {0x16, "too small"}, {0x17, "option"},
                 {0x18, "system"},     {0x19, "X13"},       {0x1A, "diagnostic"},
                 {0x1B, "protection"}, {0x1C, "inhibit"},   {0x1D, "incorrect"},
                 {0x1E, "activated"},  {0x1F, "EEPROM"},    {0x20, "output stage"}};
  for (const auto& row : printed)
    EXPECT_NE(return_code_meaning({8, 0, row.additional}).find(row.word), std::string_view::npos)
        << row.additional;
  EXPECT_EQ(return_code_meaning({8, 0, 0x99}), "");
  const char* classes[] = {"virtual field", "application", "definition",  "resource",
                           "service",       "access",      "object list", "other"};
  for (uint8_t i = 0; i < 8; ++i)
    EXPECT_NE(return_class_meaning(static_cast<uint8_t>(i + 1)).find(classes[i]), std::string_view::npos)
        << i + 1;
  EXPECT_EQ(return_class_meaning(0), "");
  EXPECT_EQ(return_class_meaning(9), "");
  EXPECT_EQ(return_codes::kInvalidIndex.packed(), 0x08000010U);
}

}  // namespace
}  // namespace ipos::stdlib

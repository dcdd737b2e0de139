// Telegrams of MOVILINK in words: areas of indices, services, attributes, every bit and every scale of the process data
// words, and telegrams that are no good.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/movilink/describe_serial.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/telegram_words.hpp"
#include "runtime/bus/movilink/unit_words.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

TelegramNames one_unit(const char* type = "md60a") {
  TelegramNames names;
  UnitNames unit;
  unit.name = "u";
  unit.unit = stdlib::find_unit(type);
  unit.settings.address = 1;
  unit.settings.group = 2;
  unit.settings.sync_id = 7;
  unit.output = {9, 1, 5};
  unit.input = {6, 1, 2};
  unit.variables = {{3, "lThree"}, {4, "lFour"}};
  names.units.push_back(unit);
  return names;
}

std::string request_of(const UnitNames* unit, int index) {
  return parameter_words(unit, parameter_request(Service::Read, static_cast<uint16_t>(index), 0, 0), true);
}

// 1053 1610 p. 67: H0 is index 11000, the first program word 16000; a MOVIDRIVE MDX60B/61B has more variables.
TEST(MovilinkWords, AreasOfIndices) {
  const TelegramNames a = one_unit("md60a"), b = one_unit("mdxb"), m07 = one_unit("mc07");
  const UnitNames *unit = &a.units[0], *drive_b = &b.units[0], *inverter = &m07.units[0];
  EXPECT_EQ(request_of(unit, 10'999), "read 10999 unknown index");
  EXPECT_EQ(request_of(unit, 11'000), "read 11000 H0");
  EXPECT_EQ(request_of(unit, 11'003), "read 11003 lThree");
  EXPECT_EQ(request_of(unit, 11'004), "read 11004 lFour");
  EXPECT_EQ(request_of(unit, 11'511), "read 11511 H511");
  EXPECT_EQ(request_of(unit, 11'512), "read 11512 unknown index");
  EXPECT_EQ(request_of(drive_b, 12'023), "read 12023 H1023");
  EXPECT_EQ(request_of(drive_b, 12'024), "read 12024 unknown index");
  EXPECT_EQ(request_of(unit, 15'999), "read 15999 unknown index");
  EXPECT_EQ(request_of(unit, 16'000), "read 16000 program word 0");
  EXPECT_EQ(request_of(unit, 18'047), "read 18047 program word 2047");
  EXPECT_EQ(request_of(unit, 18'048), "read 18048 unknown index");
  EXPECT_EQ(request_of(inverter, 17'023), "read 17023 program word 1023");
  EXPECT_EQ(request_of(inverter, 17'024), "read 17024 unknown index");
  // Without a unit, or with one of which nothing is known, those of MOVIDRIVE MD_60A.
  UnitNames nameless;
  nameless.variables = {{3, "lThree"}};
  EXPECT_EQ(request_of(nullptr, 11'511), "read 11511 H511");
  EXPECT_EQ(request_of(nullptr, 11'512), "read 11512 unknown index");
  EXPECT_EQ(request_of(&nameless, 11'003), "read 11003 lThree");
  EXPECT_EQ(request_of(&nameless, 8318), "read 8318 Speed");
  EXPECT_EQ(request_of(inverter, 8814), "read 8814 Internal setpoint n11 PI-controller");
}

TEST(MovilinkWords, ValuesStandWhereATelegramHasOne) {
  const TelegramNames names = one_unit();
  const auto words = [&](const ParameterTelegram& telegram, bool request) {
    return parameter_words(&names.units[0], telegram, request);
  };
  const ParameterTelegram write = parameter_request(Service::Write, 11'003, 5, -2);
  EXPECT_EQ(words(write, true), "write 11003 lThree, subindex 5 = -2");
  EXPECT_EQ(words(parameter_response(write, -2), false), "write 11003 lThree, subindex 5 = -2");
  for (uint32_t code = 0; code <= 8; ++code) {
    const Service service = *service_from_code(code);
    ParameterTelegram telegram = parameter_request(service, 16'001, 0, 9);
    telegram.data = 0x00030009;
    const std::string begin = std::string(service_text(service)) + " 16001 program word 1";
    // Only a write brings a value along.
    EXPECT_EQ(words(telegram, true), begin + (is_write(service) ? " = 196617" : "")) << code;
    const std::string value =
        service == Service::None        ? ""
        : service == Service::ReadScale ? " = quantity 0 dimensionless, conversion 9"
        : service == Service::ReadAttribute
            ? " = next index 3, attributes 0009h (writable, stored by the factory setting)"
            : " = 196617";
    EXPECT_EQ(words(telegram, false), begin + value) << code;
  }
  ParameterTelegram unknown = parameter_request(Service::Read, 8318, 0, 0);
  unknown.management = 0x39;
  EXPECT_EQ(words(unknown, true), "service 9 8318 Speed");
  EXPECT_EQ(words(unknown, false), "service 9 8318 Speed") << "its data mean nothing";
  unknown.management = 0xB9;
  unknown.data = return_codes::kWrongManagement.packed();
  EXPECT_EQ(words(unknown, false),
            "service 9 8318 Speed refused: " + describe(return_codes::kWrongManagement));
  EXPECT_EQ(words(unknown, true), "service 9 8318 Speed") << "a request refuses nothing";
  // A length that is not that of four bytes is wrong in a write only.
  for (const unsigned length : {1U, 2U, 3U, 4U})
    for (const auto& [service, request] :
         {std::pair{2U, true}, {3U, true}, {1U, true}, {9U, true}, {2U, false}}) {
      ParameterTelegram telegram = parameter_request(Service::Write, 11'003, 0, 1);
      telegram.management = static_cast<uint8_t>((length - 1) << 4 | service);
      const bool told = length != 4 && request && (service == 2 || service == 3);
      const std::string text = words(telegram, request);
      EXPECT_EQ(text.ends_with(", length " + std::to_string(length) + " in place of 4 bytes"), told) << text;
      EXPECT_EQ(text.find("length") != std::string::npos, told) << text;
    }
}

// stdlib/access_attributes.def; what lies above these bits has no name.
TEST(MovilinkWords, EveryAttribute) {
  const char* const kNames[] = {"writable",
                                "stored",
                                "set by the factory setting",
                                "stored by the factory setting",
                                "restored at power-on",
                                "needs no inhibit",
                                "needs a password"};
  const auto words = [](uint32_t data) {
    return parameter_words(
        nullptr,
        parameter_response(parameter_request(Service::ReadAttribute, 1, 0, 0), static_cast<int32_t>(data)),
        false);
  };
  const std::string begin = "read attribute 1 unknown index = ";
  for (unsigned bit = 0; bit < 16; ++bit) {
    char text[64];
    std::snprintf(text, sizeof text, "last index, attributes %04Xh", 1U << bit);
    EXPECT_EQ(words(1U << bit), begin + text + (bit < 7 ? " (" + std::string(kNames[bit]) + ")" : ""));
  }
  EXPECT_EQ(words(0xFFFF0000), begin + "next index 65535, attributes 0000h");
  EXPECT_EQ(words(0x00010003), begin + "next index 1, attributes 0003h (writable, stored)");
}

struct BitName {
  unsigned bit;
  const char* mdx;
  const char* m07;
};
// MOVITRAC 07 chapters 6.2 to 6.5; those that MOVITRAC 07 keeps reserved as MOVIDRIVE has them.
const BitName kControl1[] = {{3, "hold control", nullptr},
                             {4, "ramp set 2", nullptr},
                             {5, "parameter set 2", nullptr},
                             {6, "reset", "reset"},
                             {7, nullptr, nullptr},
                             {8, "motor potentiometer CCW", "motor potentiometer CCW"},
                             {9, "motor potentiometer up", "motor potentiometer up"},
                             {10, "motor potentiometer down", "motor potentiometer down"},
                             {11, "fixed setpoint bit 0", "fixed setpoint bit 0"},
                             {12, "fixed setpoint bit 1", "fixed setpoint bit 1"},
                             {13, "other set of fixed setpoints", "other set of fixed setpoints"},
                             {14, nullptr, nullptr},
                             {15, nullptr, nullptr}};

TEST(UnitWords, EveryBitOfTheControlWords) {
  const stdlib::UnitType& mdx = *stdlib::find_unit("mdxb");
  const stdlib::UnitType& m07 = *stdlib::find_unit("mc07");
  const auto named = [](const char* name, unsigned bit) {
    return "rapid stop, " + (name != nullptr ? std::string(name) : "reserved bit " + std::to_string(bit));
  };
  for (const BitName& row : kControl1) {
    const auto word = static_cast<uint16_t>(1U << row.bit);
    EXPECT_EQ(control_word_text(mdx, 1, word), named(row.mdx, row.bit));
    EXPECT_EQ(control_word_text(m07, 1, word), named(row.m07, row.bit));
    if (row.bit < 8) {
      EXPECT_EQ(control_word_text(mdx, 2, word), named(row.mdx, row.bit));
      EXPECT_EQ(control_word_text(m07, 2, word), named(row.m07, row.bit));
    }
  }
  for (unsigned bit = 8; bit < 16; ++bit) {
    const auto word = static_cast<uint16_t>(1U << bit);
    EXPECT_EQ(control_word_text(mdx, 2, word), "rapid stop, DI1" + std::to_string(bit - 8));
    EXPECT_EQ(control_word_text(m07, 2, word), "rapid stop, data bit " + std::to_string(bit));
  }
  // Bits 2..0: the most restrictive one counts.
  const char* const kCommands[] = {"rapid stop", "controller inhibit", "stop",   "controller inhibit",
                                   "rapid stop", "controller inhibit", "enable", "controller inhibit"};
  for (uint16_t word = 0; word < 8; ++word) EXPECT_EQ(control_word_text(mdx, 1, word), kCommands[word]);
}

TEST(UnitWords, EveryBitOfTheStatusWords) {
  const stdlib::UnitType& mdx = *stdlib::find_unit("md60a");
  const stdlib::UnitType& m07 = *stdlib::find_unit("mc07");
  // Word 3 has no high byte that is explained.
  const std::pair<unsigned, std::string> rows[] = {
      {0, "not ready, output stage on"}, {1, "ready"},
      {2, "not ready, PO data on"},      {3, "not ready, ramp set 2"},
      {4, "not ready, parameter set 2"}, {5, "fault"},
      {6, "not ready, CW limit switch"}, {7, "not ready, CCW limit switch"}};
  for (const auto& [bit, text] : rows) {
    const auto word = static_cast<uint16_t>(1U << bit);
    EXPECT_EQ(status_word_text(mdx, 3, word), text);
    EXPECT_EQ(status_word_text(m07, 3, word), bit == 3 || bit == 4 || bit >= 6 ? "not ready" : text);
  }
  for (unsigned bit = 8; bit < 16; ++bit) {
    const auto word = static_cast<uint16_t>(1U << bit);
    EXPECT_EQ(status_word_text(mdx, 3, word), "not ready");
    EXPECT_EQ(status_word_text(mdx, 2, word), "not ready, DO1" + std::to_string(bit - 8));
    EXPECT_EQ(status_word_text(mdx, 2, static_cast<uint16_t>(word | 0x20)),
              "fault, DO1" + std::to_string(bit - 8));
  }
  EXPECT_EQ(status_word_text(mdx, 2, 0x0022), "warning");
}

TEST(UnitWords, StatesAndFaults) {
  const stdlib::UnitType& mdx = *stdlib::find_unit("md60a");
  const stdlib::UnitType& m07 = *stdlib::find_unit("mc07");
  const char* const kStates[] = {
      "not ready",     "controller inhibit", "no enable",    "standstill current", "enable",
      "speed control", "torque control",     "hold control", "factory setting",    "limit switch"};
  for (uint16_t code = 0; code < 10; ++code) {
    const std::string number = "ready; state " + std::to_string(code) + " ";
    const auto word = static_cast<uint16_t>(code << 8 | 2);
    EXPECT_EQ(status_word_text(mdx, 1, word), number + kStates[code]);
    // 5 is the factory setting of MOVITRAC 07 (chapter 6.5).
    EXPECT_EQ(status_word_text(m07, 1, word), number + kStates[code == 5 ? 8 : code]);
  }
  EXPECT_EQ(status_word_text(mdx, 1, 0x1002), "ready; state 16 waiting for data");
  EXPECT_EQ(status_word_text(mdx, 1, 0x0A02), "ready; state 10");
  EXPECT_EQ(status_word_text(mdx, 1, 0x2B20), "fault; F43 RS-485 timeout");
  EXPECT_EQ(status_word_text(mdx, 1, 0x2B22), "warning; F43 RS-485 timeout");
  EXPECT_EQ(status_word_text(mdx, 1, 0x0020), "fault") << "without a number";
  EXPECT_EQ(status_word_text(mdx, 1, 0xFF20), "fault; F255");
}

TEST(UnitWords, WhichAssignmentsAreWordsOfBits) {
  const stdlib::UnitType& mdx = *stdlib::find_unit("md60a");
  for (int code = 0; code < 256; ++code)
    for (const bool input : {false, true}) {
      const auto number = static_cast<uint8_t>(code);
      const bool bits = input ? code == 6 || code == 7 || code == 11 : code == 9 || code == 10;
      EXPECT_EQ(!unit_word_text(mdx, input, number, 0).empty(), bits) << code;
      EXPECT_EQ(!unit_word_bits(mdx, input, number).empty(), bits) << code;
    }
  EXPECT_EQ(unit_word_text(mdx, false, 10, 0x0106), "enable, DI10");
  EXPECT_EQ(unit_word_text(mdx, true, 6, 0x0402), "ready; state 4 enable");
  EXPECT_EQ(unit_word_text(mdx, true, 7, 0x0402), "ready, DO12");
  EXPECT_EQ(unit_word_text(mdx, true, 11, 0x0402), "ready");
  for (int code = 0; code < 256; ++code)
    EXPECT_EQ(!unit_state_texts(static_cast<uint8_t>(code)).empty(), code == 6) << code;
}

// Scales of MOVITRAC 07 chapter 6.1: a digit is 0.2 rpm, 0.1 % or 1 ms, and 4000h is 100 %.
struct ScaleRow {
  bool input;
  int code;
  bool is_signed;
  double digit;
  int decimals;
  const char* unit;
};
const ScaleRow kScaleRows[] = {
    {false, 1, true, 0.2, 1, " rpm"},
    {false, 2, true, 0.1, 1, " % In"},
    {false, 5, true, 0.2, 1, " rpm"},
    {false, 6, true, 0.1, 1, " % In"},
    {false, 8, false, 1, 0, " ms"},
    {false, 11, true, 100.0 / 16384, 2, " %"},
    {false, 13, true, 100.0 / 16384, 2, " %"},
    {true, 1, true, 0.2, 1, " rpm"},
    {true, 2, true, 0.1, 1, " % In"},
    {true, 3, true, 0.1, 1, " % In"},
    {true, 8, true, 100.0 / 16384, 2, " %"},
    {true, 10, true, 100.0 / 16384, 2, " %"},
};

const ScaleRow* scale_of(bool input, int code) {
  for (const ScaleRow& row : kScaleRows)
    if (row.input == input && row.code == code) return &row;
  return nullptr;
}

TEST(ProcessWords, EveryCodeHasItsScale) {
  for (int code = 0; code < 256; ++code)
    for (const bool input : {false, true}) {
      const ScaleRow* row = scale_of(input, code);
      const bool bits = input ? code == 6 || code == 7 || code == 11 : code == 9 || code == 10;
      for (uint32_t word = 0; word < 0x10000; word += row == nullptr ? 0xFFF : 97) {
        char expected[64];
        const int32_t number = static_cast<int16_t>(word);
        const double value = row != nullptr && !row->is_signed ? static_cast<double>(word) : number;
        if (bits)
          std::snprintf(expected, sizeof expected, "%04Xh", word);
        else if (row == nullptr)
          std::snprintf(expected, sizeof expected, "%d", static_cast<int16_t>(word));
        else {  // halves away from zero
          const double tens = std::pow(10, row->decimals);
          const double rounded = std::floor(std::abs(value * row->digit) * tens + 0.5 + 1e-9) / tens;
          std::snprintf(expected, sizeof expected, "%s%.*f%s", value < 0 ? "-" : "", row->decimals, rounded,
                        row->unit);
        }
        ASSERT_EQ(process_word_text(input, static_cast<uint8_t>(code), static_cast<uint16_t>(word)), expected)
            << input << ' ' << code;
      }
    }
}

TEST(ProcessWords, NamesAreThoseOfTheUnit) {
  const stdlib::UnitType& md60a = *stdlib::find_unit("md60a");
  EXPECT_EQ(process_word_name(md60a, false, 9), "CTRL. WORD 1");
  EXPECT_EQ(process_word_name(md60a, true, 9), "IPOS-PI DATA");
  EXPECT_EQ(process_word_name(md60a, true, 200), "");
  // One without a list has the words of MOVIDRIVE, as far as they are assigned.
  EXPECT_EQ(process_word_name(*stdlib::find_unit("mc31"), true, 1), "SPEED");
  EXPECT_EQ(process_word_name(*stdlib::find_unit("mc31"), true, 0), "");
  // A unit that has no such assignment, and one without a type, whose names are those of MOVIDRIVE.
  TelegramNames names = one_unit();
  UnitNames& unit = names.units[0];
  unit.output = {200, 0, 1};
  const ProcessWords words{1, 2, 3};
  EXPECT_EQ(process_words_text(&unit, "PO", false, words), "PO 0001h, 0002h, SPEED 0.6 rpm");
  EXPECT_EQ(process_words_text(nullptr, "PO", false, words), "PO 0001h, 0002h, 0003h");
  EXPECT_EQ(process_words_text(&unit, "PI", true, std::span(words).first(2)),
            "PI STATUS WORD1 0001h (not ready, output stage on; state 0 not ready), SPEED 0.4 rpm");
  unit.unit = nullptr;
  EXPECT_EQ(process_words_text(&unit, "PI", true, std::span(words).subspan(1)),
            "PI STATUS WORD1 0002h (ready; state 0 not ready), SPEED 0.6 rpm");
}

Frame remote(uint32_t id, bool extended = false) { return {id, 3, {}, extended, true}; }

TEST(Describe, FramesThatAreNoTelegrams) {
  const TelegramNames names = one_unit();
  const auto text = [&](const Frame& frame) {
    const Description description = describe(names, frame);
    EXPECT_FALSE(description.known);
    return description.text;
  };
  EXPECT_EQ(text(remote(11)), "00B remote frame");
  EXPECT_EQ(text(remote(11, true)), "0000000B remote frame");
  EXPECT_EQ(text({11, 2, {1, 0xAB}, true, false}), "0000000B 01 AB");
  EXPECT_EQ(text({2000, 0, {}, false, false}), "7D0 no data");
  EXPECT_EQ(text({2000, 1, {0x0C}, false, false}), "7D0 0C");
}

TEST(Describe, PartnersAndTheListsThatExplainATelegram) {
  TelegramNames names = one_unit();
  names.units.push_back(names.units[0]);
  names.units[1].name = "v";
  names.units[1].settings.address = 5;
  names.units[1].settings.group = 9;
  names.units[1].output = {1, 0, 0};
  const auto text = [&](const Frame& frame) { return describe(names, frame).text; };
  const ProcessWords words{5, 0, 0};
  EXPECT_EQ(text(process_frame(8 * 5 + 3, words)), "02B PO SPEED 1.0 rpm, 0000h, 0000h -> v");
  EXPECT_EQ(text(process_frame(8 * 5 + 5, words)), "02D PO-sync SPEED 1.0 rpm, 0000h, 0000h -> v");
  EXPECT_EQ(text(process_frame(8 * 9 + 6, words)), "04E PO SPEED 1.0 rpm, 0000h, 0000h -> group 9");
  EXPECT_EQ(text(process_frame(8 * 8 + 6, words)), "046 PO 0005h, 0000h, 0000h -> group 8");
  EXPECT_EQ(text(process_frame(8 * 9 + 3, words)), "04B PO 0005h, 0000h, 0000h -> address 9");
  EXPECT_EQ(text({12, 3, {1, 2, 3}, false, false}), "00C 3 bytes in place of 6: 01 02 03 <- u");
  EXPECT_EQ(text({11, 8, {1, 2}, false, false}), "00B 8 bytes in place of 6: 01 02 00 00 00 00 00 00 -> u");
  EXPECT_EQ(text({523, 0, {}, false, false}), "20B 0 bytes in place of 8: no data -> u");
  // The handshake bit means a synchronous answer, in both directions.
  EXPECT_EQ(text({524, 8, {0x71, 0, 0x2A, 0xFB, 0, 0, 0, 9}, false, false}),
            "20C read 11003 lThree = 9, after sync <- u");
  EXPECT_EQ(text({525, 8, {0x71, 0, 0x2A, 0xFB}, false, false}),
            "20D read 11003 lThree, answer after sync -> u");
  EXPECT_EQ(text({527, 8, {0x31, 0, 0x2A, 0xFB, 0, 0, 0, 9}, false, false}),
            "20F read 11003 lThree = 9 <- u");
}

TEST(Describe, SyncTelegramsOfSynchronousUnits) {
  TelegramNames names = one_unit();
  EXPECT_EQ(describe(names, Frame{7, 0, {}, false, false}).text, "007 sync telegram");
  EXPECT_TRUE(describe(names, Frame{7, 0, {}, false, false}).known);
  names.units[0].settings.synchronous = false;
  EXPECT_EQ(describe(names, Frame{7, 0, {}, false, false}).text, "007 no data");
  EXPECT_FALSE(describe(names, Frame{7, 0, {}, false, false}).known);
}

TelegramNames objects() {
  TelegramNames names = one_unit();
  constexpr auto kIntel = VariableLayout::Intel;
  names.objects.push_back({1024, "taker", false, {4, kIntel}, {"lTaken", "lNext"}, 0});
  names.objects.push_back({1024, "u", true, {4, kIntel}, {"lSent", "lNext"}, 0});
  names.objects.push_back({1024, "second", true, {4, kIntel}, {"lSecond", "lNext"}, 0});
  names.objects.push_back({1025, "taker", false, {5, kIntel}, {"lLow", "lHigh"}, 0});
  names.objects.push_back({1025, "other", false, {5, kIntel}, {"lOther", "lHigh"}, 0});
  names.objects.push_back({1026, "u", true, {0, kIntel}, {"", ""}, 0});
  names.objects.push_back({524, "u", true, {1, kIntel}, {"lMine", ""}, 0});
  return names;
}

// The sender's names are shown, and those of the first one of a kind.
TEST(Describe, VariableTelegramsBySenderAndLength) {
  const TelegramNames names = objects();
  const auto text = [&](const Frame& frame) {
    const Description description = describe(names, frame);
    EXPECT_TRUE(description.known);
    return description.text;
  };
  EXPECT_EQ(text({1024, 4, {0xFE, 0xFF, 0xFF, 0xFF}, false, false}), "400 lSent = -2 (FFFFFFFEh) <- u");
  EXPECT_EQ(text({1025, 5, {1, 0, 0, 0, 2}, false, false}),
            "401 lLow = 1 (00000001h), lHigh = 2 (00000002h) -> taker");
  EXPECT_EQ(text({1026, 0, {}, false, false}), "402 object without data <- u");
  EXPECT_EQ(text({1026, 1, {9}, false, false}), "402 object of u with 1 bytes in place of 0: 09");
  EXPECT_EQ(text({524, 1, {9}, false, false}), "20C lMine = 9 (00000009h) <- u") << "before the profile";
  EXPECT_EQ(names.object(1027), nullptr);
}

TEST(Describe, WhichFramesConcernSomebody) {
  const TelegramNames names = objects();
  for (uint32_t id = 0; id < 2048; ++id) {
    // 8 a + 3, 4, 5 and 515, 516, 517, 519 of address 1, 8 g + 6 and 518 of group 2, and the objects.
    const std::set<uint32_t> mine = {11, 12, 13, 22, 523, 524, 525, 527, 534, 1024, 1025, 1026};
    EXPECT_EQ(concerns(names, {id, 8, {}, false, false}), mine.contains(id)) << id;
    EXPECT_FALSE(concerns(names, {id, 8, {}, true, false}));
    EXPECT_FALSE(concerns(names, {id, 8, {}, false, true}));
  }
}

TEST(DescribeSerial, GroupsAreExplainedByAnyMember) {
  TelegramNames names = one_unit();
  names.units[0].settings.group = 101;
  names.units.push_back(names.units[0]);
  names.units[1].settings.address = 254;  // no address of a unit, but a request to 254 may mean it
  names.units[1].settings.group = 102;
  names.units[1].output = {1, 0, 0};
  const auto text = [&](uint8_t address, bool response = false) {
    return describe(names, SerialTelegram{response, address, *telegram_format(1), {}, {5, 0, 0}});
  };
  EXPECT_EQ(text(102), "1PD cyclic, PO SPEED 1.0 rpm -> group 102");
  EXPECT_EQ(text(103), "1PD cyclic, PO 0005h -> group 103");
  EXPECT_EQ(text(1), "1PD cyclic, PO CTRL. WORD 1 0005h (controller inhibit) -> u");
  EXPECT_EQ(text(2, true), "1PD cyclic, PI 0005h <- address 2");
  EXPECT_EQ(text(100), "1PD cyclic, PO 0005h -> address 100");
}

}  // namespace
}  // namespace ipos::tests

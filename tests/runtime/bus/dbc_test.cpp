// The whole text of a DBC file for a small bus, the places of all bits of control and status words, and names. What is
// expected follows from the rules of the format: a big-endian signal is named by its highest bit, 8 * byte + bit, and a
// range is that of its bits times its factor.
#include "runtime/bus/dbc/dbc.hpp"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "runtime/bus/movilink/dbc_signals.hpp"
#include "runtime/bus/movilink/process_data.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT

const std::string kMc31Channel[] = {
    R"( SG_ P073_Fieldbus_address m18 : 39|32@0- (1,0) [-2147483648|2147483647] "" )",
    R"( SG_ P120_T11_ramp_UP m25 : 39|32@0- (0.01,0) [-21474836.48|21474836.47] "s" )",
    R"( SG_ P571_Fieldbus_timeout m116 : 39|32@0- (0.01,0) [-21474836.48|21474836.47] "s" )",
    R"( SG_ P572_Timeout_response m117 : 39|32@0- (1,0) [-2147483648|2147483647] "" )",
    R"( SG_ P600_Terminal_42 m120 : 39|32@0- (1,0) [-2147483648|2147483647] "" )",
    R"( SG_ P601_Terminal_43 m121 : 39|32@0- (1,0) [-2147483648|2147483647] "" )",
    R"( SG_ P802_Save_EEPROM m164 : 39|32@0- (1,0) [-2147483648|2147483647] "" )",
    R"( SG_ P841_Control_mode m175 : 39|32@0- (1,0) [-2147483648|2147483647] "" )",
    R"( SG_ I200_Position m200 : 39|32@0- (1,0) [-2147483648|2147483647] "" )"};

// The management byte, subindex and index (1053 1610 p. 29), and what a MOVITRAC 31 has.
std::string channel(const std::string& receivers, bool mc31) {
  std::string text;
  for (const char* signal :
       {R"( SG_ Service : 3|4@0+ (1,0) [0|15] "" )", R"( SG_ Length : 5|2@0+ (1,0) [0|3] "" )",
        R"( SG_ Handshake : 6|1@0+ (1,0) [0|1] "" )", R"( SG_ Failed : 7|1@0+ (1,0) [0|1] "" )",
        R"( SG_ Subindex : 15|8@0+ (1,0) [0|255] "" )", R"( SG_ Index M : 23|16@0+ (1,0) [0|65535] "" )"})
    text += signal + receivers + "\n";
  if (mc31)
    for (const std::string& signal : kMc31Channel) text += signal + receivers + "\n";
  return text + "\n";
}

std::string three_words(const std::string& word, const std::string& receivers) {
  const std::string rest = "|16@0- (1,0) [-32768|32767] \"\" " + receivers + "\n";
  return " SG_ " + word + "1 : 7" + rest + " SG_ " + word + "2 : 23" + rest + " SG_ " + word + "3 : 39" +
         rest + "\n";
}

std::string services(uint32_t id) {
  return "VAL_ " + std::to_string(id) +
         R"( Service 0 "no service" 1 "read" 2 "write" 3 "write volatile" 4 "read minimum" )"
         R"(5 "read maximum" 6 "read default" 7 "read scale" 8 "read attribute" ;)"
         "\n";
}

// stdlib/parameters/mc31.tsv
std::string mc31_texts(uint32_t id) {
  const std::string begin = "VAL_ " + std::to_string(id) + " ";
  const std::string terminal = R"( 0 "NO FUNCTION" 1 "ENABLE/STOP" 2 "CCW/STOP" 3 "FAULT RESET" ;)"
                               "\n";
  return begin +
         R"(P572_Timeout_response 0 "NO RESPONSE" 1 "DISPLAY FAULT" 2 "IMM. STOP/FAULT" 3 "EMERG. STOP/FAULT" )"
         R"(4 "RAPID STOP/FAULT" 5 "IMM. STOP/WARNG" 6 "EMERG. STOP/WARNG" 7 "RAPID STOP/WARNG" ;)"
         "\n" +
         begin + "P600_Terminal_42" + terminal + begin + "P601_Terminal_43" + terminal + begin +
         "P802_Save_EEPROM 0 \"OFF\" 1 \"ON\" ;\n" + begin +
         "P841_Control_mode 0 \"STANDARD\" 1 \"FIELDBUS\" ;\n";
}

ObjectNames object(uint32_t id, const std::string& station, bool sent, VariableFormat format,
                   std::array<std::string, 2> variables, int32_t cycle = 0) {
  return {id, station, sent, format, std::move(variables), cycle};
}

TelegramNames small_bus() {
  TelegramNames names;
  UnitNames unit;
  unit.name = "m 1";
  unit.unit = stdlib::find_unit("mc31");
  unit.settings.address = 5;
  unit.settings.group = 2;
  unit.settings.synchronous = false;
  names.units.push_back(unit);
  unit = {};
  unit.name = "b";  // nothing is known about what it is
  unit.settings.address = 6;
  unit.settings.group = 2;
  unit.settings.second_channel = true;
  names.units.push_back(unit);
  constexpr auto kMotorola = VariableLayout::Motorola;
  constexpr auto kIntel = VariableLayout::Intel;
  names.objects = {
      object(1026, "b", false, {0, kMotorola}, {"Z", "Z"}),
      object(1024, "b", false, {4, kMotorola}, {"lTaken", "lNext"}),
      object(1024, "m 1", true, {8, kMotorola}, {"lLow", "lHigh"}),
      object(1025, "b", true, {3, kIntel}, {"lShort", "lNext"}, 1),
      object(1025, "m 1", true, {4, kMotorola}, {"lSecond", "lNext"}, 7),
      object(100, "b", true, {7, kIntel}, {"lWide", "lWide"}, 65535),
      object(1026, "m 1", false, {1, kMotorola}, {"Z", "Z"}),
  };
  return names;
}

TEST(Dbc, TextOfASmallBus) {
  const std::string none = "Vector__XXX";
  const std::string all =
      "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: b m_1\n\n"
      "BO_ 22 GPO_group_2: 6 Vector__XXX\n" +
      three_words("PO", "b,m_1") + "BO_ 43 PO_m_1: 6 Vector__XXX\n" + three_words("PO", "m_1") +
      "BO_ 44 PI_m_1: 6 m_1\n" + three_words("PI", none) + "BO_ 51 PO_b: 6 Vector__XXX\n" +
      three_words("PO", "b") + "BO_ 52 PI_b: 6 b\n" + three_words("PI", none) +
      "BO_ 53 PO_sync_b: 6 Vector__XXX\n" + three_words("PO", "b") +
      "BO_ 100 Object_100: 7 b\n"
      " SG_ lWide : 0|32@1- (1,0) [-2147483648|2147483647] \"\" Vector__XXX\n"
      " SG_ DPointer_1 : 32|24@1+ (1,0) [0|16777215] \"\" Vector__XXX\n\n"
      "BO_ 534 Grequest_group_2: 8 Vector__XXX\n" +
      channel("b,m_1", true) + "BO_ 555 request_m_1: 8 Vector__XXX\n" + channel("m_1", true) +
      "BO_ 556 response_m_1: 8 m_1\n" + channel(none, true) + "BO_ 563 request_b: 8 Vector__XXX\n" +
      channel("b", false) + "BO_ 564 response_b: 8 b\n" + channel(none, false) +
      "BO_ 565 request_2_b: 8 Vector__XXX\n" + channel("b", false) + "BO_ 567 response_2_b: 8 b\n" +
      channel(none, false) +
      // Sent by one and taken by the other: what the sender calls it.
      "BO_ 1024 Object_1024: 8 m_1\n"
      " SG_ lLow : 39|32@0- (1,0) [-2147483648|2147483647] \"\" b\n"
      " SG_ lHigh : 7|32@0- (1,0) [-2147483648|2147483647] \"\" b\n\n"
      "BO_ 1025 Object_1025: 3 b\n"
      " SG_ lShort : 0|24@1+ (1,0) [0|16777215] \"\" Vector__XXX\n\n"
      "BO_ 1026 Object_1026: 0 Vector__XXX\n\n"
      "CM_ BO_ 22 \"group process output data (GPO), identifier 016h (22)\";\n"
      "CM_ BO_ 43 \"process output data (PO), identifier 02Bh (43)\";\n"
      "CM_ BO_ 44 \"process input data (PI), identifier 02Ch (44)\";\n"
      "CM_ BO_ 51 \"process output data (PO), identifier 033h (51)\";\n"
      "CM_ BO_ 52 \"process input data (PI), identifier 034h (52)\";\n"
      "CM_ BO_ 53 \"synchronizable process output data (PO-sync), identifier 035h (53)\";\n"
      "CM_ BO_ 100 \"variable telegram, identifier 064h (100)\";\n"
      "CM_ BO_ 534 \"group parameter request, identifier 216h (534)\";\n"
      "CM_ BO_ 555 \"parameter request, identifier 22Bh (555)\";\n"
      "CM_ BO_ 556 \"parameter response, identifier 22Ch (556)\";\n"
      "CM_ BO_ 563 \"parameter request, identifier 233h (563)\";\n"
      "CM_ BO_ 564 \"parameter response, identifier 234h (564)\";\n"
      "CM_ BO_ 565 \"parameter request, channel 2, identifier 235h (565)\";\n"
      "CM_ BO_ 567 \"parameter response, channel 2, identifier 237h (567)\";\n"
      "CM_ BO_ 1024 \"variable telegram, identifier 400h (1024)\";\n"
      "CM_ BO_ 1025 \"variable telegram, identifier 401h (1025)\";\n"
      "CM_ BO_ 1026 \"variable telegram, identifier 402h (1026)\";\n"
      "BA_DEF_ BO_ \"GenMsgCycleTime\" INT 0 65535;\n"
      "BA_DEF_DEF_ \"GenMsgCycleTime\" 0;\n"
      "BA_ \"GenMsgCycleTime\" BO_ 100 65535;\n"
      "BA_ \"GenMsgCycleTime\" BO_ 1025 1;\n" +
      services(534) + mc31_texts(534) + services(555) + mc31_texts(555) + services(556) + mc31_texts(556) +
      services(563) + services(564) + services(565) + services(567);
  EXPECT_EQ(dbc_text({small_bus(), {}}), all);
}

// PDOs low byte first and by their mapping, EMCY by page 53 of 11264926, the rest by CiA 301.
TEST(Dbc, MessagesOfACanopenNode) {
  canopen::ObjectDictionary dictionary(5);
  // TPDO2 has PI5 behind two bytes for somebody else, on 299h; RPDO1 is off.
  dictionary.set({0x1A01, 0}, 2);
  dictionary.set({0x1A01, 1}, 0x0006'0010);
  dictionary.set({0x1A01, 2}, 0x2001'0510);
  dictionary.set({0x1801, 1}, 0x299);
  dictionary.set({0x1400, 1}, 0x8000'0205);
  dictionary.set({0x1014, 0}, 0x8000'0085);
  const canopen::NodeName saw{5,         "saw 1",   stdlib::find_unit("mdxb"),
                              {9, 1, 0}, {0, 1, 0}, std::make_shared<canopen::ObjectDictionary>(dictionary)};
  const canopen::NodeName plain{6, "feed", stdlib::find_unit("mdxb"), {0, 1, 0}, {0, 0, 0}, nullptr};
  const std::string text = dbc_text({{}, {saw, plain}});
  const auto has = [&](const std::string& line) {
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  };
  has("BU_: feed saw_1\n");
  has("BO_ 0 NMT: 2 Vector__XXX\n SG_ Command : 0|8@1+ (1,0) [0|255] \"\" feed,saw_1\n SG_ Node : 8|8@1+ ");
  has("BO_ 128 SYNC: 0 Vector__XXX\n\n");
  has("BO_ 389 TPDO1_saw_1: 6 saw_1\n SG_ PI1_NO_FUNCTION : 0|16@1- (1,0) [-32768|32767] \"\" Vector__XXX\n"
      " SG_ PI2_SPEED : 16|16@1- (0.2,0) [-6553.6|6553.4] \"rpm\" Vector__XXX\n SG_ PI3_NO_FUNCTION : 32|16@1- ");
  has("BO_ 665 TPDO2_saw_1: 4 saw_1\n SG_ PI5_NO_FUNCTION : 16|16@1- ");
  EXPECT_EQ(text.find("RPDO1_saw_1"), std::string::npos) << "it is off";
  EXPECT_EQ(text.find("EMCY_saw_1"), std::string::npos) << "it is off";
  has("BO_ 518 RPDO1_feed: 6 Vector__XXX\n SG_ PO1_NO_FUNCTION : 0|16@1- (1,0) [-32768|32767] \"\" feed\n");
  has("BO_ 134 EMCY_feed: 8 feed\n SG_ Error_code : 0|16@1+ (1,0) [0|65535] \"\" Vector__XXX\n"
      " SG_ Error_register : 16|8@1+ (1,0) [0|255] \"\" Vector__XXX\n"
      " SG_ Status_word_1 : 32|16@1+ (1,0) [0|65535] \"\" Vector__XXX\n");
  has("BO_ 1413 SDO_response_saw_1: 8 saw_1\n SG_ Command : 0|8@1+ (1,0) [0|255] \"\" Vector__XXX\n"
      " SG_ Index : 8|16@1+ (1,0) [0|65535] \"\" Vector__XXX\n"
      " SG_ Subindex : 24|8@1+ (1,0) [0|255] \"\" Vector__XXX\n"
      " SG_ Data : 32|32@1+ (1,0) [0|4294967295] \"\" Vector__XXX\n");
  has("BO_ 1541 SDO_request_saw_1: 8 Vector__XXX\n");
  has("BO_ 1797 Life_saw_1: 1 saw_1\n SG_ State : 0|7@1+ (1,0) [0|127] \"\" Vector__XXX\n"
      " SG_ Toggle : 7|1@1+ (1,0) [0|1] \"\" Vector__XXX\n");
  has("VAL_ 1797 State 0 \"boot-up\" 4 \"stopped\" 5 \"operational\" 127 \"pre-operational\" ;\n");
  has("CM_ BO_ 1797 \"guarding or heartbeat, identifier 705h (1797)\";\n");
}

// What is cut or replaced may be equal then; a second name of one kind gets a number.
TEST(Dbc, NoNameIsThereTwice) {
  TelegramNames names;
  const std::string longest = "the_left_conveyor_behind_the_saw_in_hall_";
  uint8_t address = 0;
  for (const std::string& name : {std::string("band 1"), std::string("band-1"), std::string("band_1"),
                                  longest + "1", longest + "2", longest + "3"}) {
    UnitNames unit;
    unit.name = name;
    unit.unit = stdlib::find_unit("mdxb");
    unit.settings.address = address++;
    names.units.push_back(unit);
  }
  const std::string text =
      dbc_text({names, {{9, longest + "4", stdlib::find_unit("mdxb"), {}, {}, nullptr}}});
  EXPECT_NE(text.find("BU_: band_1 band_1_2 band_1_3 the_left_conveyor_behind_the_s_2 "), std::string::npos)
      << text.substr(0, 400);
  std::map<std::string, int> messages, nodes;
  std::istringstream lines(text);
  std::set<std::string> signals;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first, id, name;
    words >> first;
    if (first == "BU_:")
      while (words >> name) ++nodes[name];
    if (first == "BO_") {
      words >> id >> name;
      name.pop_back();  // the colon
      ++messages[name];
      signals.clear();
    }
    if (first == "SG_") {
      words >> name;
      EXPECT_TRUE(signals.insert(name).second) << name;
    }
    EXPECT_LE(name.size(), dbc::kLongestName) << name;
  }
  EXPECT_EQ(nodes.size(), 7U);
  for (const auto& [name, count] : nodes) EXPECT_EQ(count, 1) << name;
  EXPECT_GT(messages.size(), 6U * 4);
  for (const auto& [name, count] : messages) EXPECT_EQ(count, 1) << name;
}

TEST(Dbc, NamesHaveLettersDigitsAndSingleUnderscores) {
  const std::pair<const char*, const char*> rows[] = {
      {"", "_"},
      {"...", "_"},
      {"unit1", "unit1"},
      {"unit 1", "unit_1"},
      {" a--b_c ", "a_b_c"},
      {"9a", "_9a"},
      {"a[1].b", "a_1_b"},
      {"Stra\xC3\x9F"
       "e",
       "Stra_e"},
      {"abcdefghijklmnopqrstuvwxyzABCDEF", "abcdefghijklmnopqrstuvwxyzABCDEF"},
      {"abcdefghijklmnopqrstuvwxyzABCDEFG", "abcdefghijklmnopqrstuvwxyzABCDEF"},
      {"0bcdefghijklmnopqrstuvwxyzABCDEF", "_0bcdefghijklmnopqrstuvwxyzABCDE"}};
  for (const auto& [text, name] : rows) EXPECT_EQ(dbc::identifier(text), name) << text;
}

UnitNames unit_of(const char* type, WordAssignment words) {
  UnitNames unit;
  unit.unit = stdlib::find_unit(type);
  unit.output = unit.input = words;
  return unit;
}

// "0 controller inhibit" with the bit where it lies in the frame.
std::map<std::string, uint32_t> bits_of(const std::vector<dbc::Signal>& signals) {
  std::map<std::string, uint32_t> bits;
  for (const dbc::Signal& signal : signals)
    if (signal.bits == 1) bits[signal.name] = signal.start;
  return bits;
}

struct WordRow {
  const char* type;
  bool input;
  uint8_t code;
  std::map<unsigned, std::string> bits;
};
const WordRow kWordRows[] = {
    {"md60a",
     false,
     9,
     {{0, "controller_inhibit"},
      {1, "no_rapid_stop"},
      {2, "no_stop"},
      {3, "hold_control"},
      {4, "ramp_set_2"},
      {5, "parameter_set_2"},
      {6, "reset"},
      {8, "motor_potentiometer_CCW"},
      {9, "motor_potentiometer_up"},
      {10, "motor_potentiometer_down"},
      {11, "fixed_setpoint_bit_0"},
      {12, "fixed_setpoint_bit_1"},
      {13, "other_set_of_fixed_setpoints"}}},
    {"mc07",
     false,
     9,
     {{0, "controller_inhibit"},
      {1, "no_rapid_stop"},
      {2, "no_stop"},
      {6, "reset"},
      {8, "motor_potentiometer_CCW"},
      {9, "motor_potentiometer_up"},
      {10, "motor_potentiometer_down"},
      {11, "fixed_setpoint_bit_0"},
      {12, "fixed_setpoint_bit_1"},
      {13, "other_set_of_fixed_setpoints"}}},
    {"mdxb",
     false,
     10,
     {{0, "controller_inhibit"},
      {1, "no_rapid_stop"},
      {2, "no_stop"},
      {3, "hold_control"},
      {4, "ramp_set_2"},
      {5, "parameter_set_2"},
      {6, "reset"},
      {8, "DI10"},
      {9, "DI11"},
      {10, "DI12"},
      {11, "DI13"},
      {12, "DI14"},
      {13, "DI15"},
      {14, "DI16"},
      {15, "DI17"}}},
    {"mc07",
     false,
     10,
     {{0, "controller_inhibit"},
      {1, "no_rapid_stop"},
      {2, "no_stop"},
      {6, "reset"},
      {8, "data_bit_8"},
      {9, "data_bit_9"},
      {10, "data_bit_10"},
      {11, "data_bit_11"},
      {12, "data_bit_12"},
      {13, "data_bit_13"},
      {14, "data_bit_14"},
      {15, "data_bit_15"}}},
    {"md60a",
     true,
     6,
     {{0, "output_stage_on"},
      {1, "ready"},
      {2, "PO_data_on"},
      {3, "ramp_set_2"},
      {4, "parameter_set_2"},
      {5, "fault_or_warning"},
      {6, "CW_limit_switch"},
      {7, "CCW_limit_switch"}}},
    {"mc07", true, 7, {{0, "output_stage_on"}, {1, "ready"}, {2, "PO_data_on"}, {5, "fault_or_warning"}}},
    {"mc07", true, 11, {{0, "output_stage_on"}, {1, "ready"}, {2, "PO_data_on"}, {5, "fault_or_warning"}}},
};

// MOVITRAC 07 chapters 6.2 to 6.5. Where a bit lies is looked up in the telegram that carries it alone.
TEST(Dbc, EveryBitOfControlAndStatusWords) {
  for (const WordRow& row : kWordRows) {
    const UnitNames unit = unit_of(row.type, {row.code, row.code, row.code});
    std::map<std::string, uint32_t> expected;
    for (size_t n = 0; n < 3; ++n)
      for (const auto& [bit, name] : row.bits) {
        ProcessWords words{};
        words[n] = static_cast<uint16_t>(1U << bit);
        const Frame frame = process_frame(11, words);
        uint32_t place = 0;
        while ((frame.data[place / 8] >> (place % 8) & 1) == 0) ++place;
        expected[std::string(row.input ? "PI" : "PO") + std::to_string(n + 1) + "_" + name] = place;
      }
    EXPECT_EQ(bits_of(dbc::process_signals(unit, row.input)), expected) << row.type << ' ' << int{row.code};
  }
}

TEST(Dbc, LevelsAndStatesHaveNames) {
  using Values = std::vector<std::pair<int32_t, std::string>>;
  const auto values = [](const UnitNames& unit, bool input) {
    std::map<std::string, Values> all;
    for (const dbc::Signal& signal : dbc::process_signals(unit, input))
      if (!signal.values.empty()) all[signal.name] = signal.values;
    return all;
  };
  EXPECT_EQ(values(unit_of("md60a", {0, 10, 0}), false),
            (std::map<std::string, Values>{{"PO2_no_rapid_stop", {{0, "rapid stop"}, {1, "enable"}}},
                                           {"PO2_no_stop", {{0, "stop"}, {1, "enable"}}}}));
  const Values ready = {{0, "not ready"}, {1, "ready"}};
  // The high byte of status word 1; that of the others has no list.
  EXPECT_EQ(values(unit_of("md60a", {7, 11, 6}), true),
            (std::map<std::string, Values>{{"PI1_ready", ready},
                                           {"PI2_ready", ready},
                                           {"PI3_ready", ready},
                                           {"PI3_state",
                                            {{0, "not ready"},
                                             {1, "controller inhibit"},
                                             {2, "no enable"},
                                             {3, "standstill current"},
                                             {4, "enable"},
                                             {5, "speed control"},
                                             {6, "torque control"},
                                             {7, "hold control"},
                                             {8, "factory setting"},
                                             {9, "limit switch"},
                                             {16, "waiting for data"}}}}));
  std::map<std::string, std::pair<uint32_t, uint32_t>> states;
  for (const dbc::Signal& signal : dbc::process_signals(unit_of("md60a", {6, 7, 11}), true))
    if (signal.bits != 1) states[signal.name] = {signal.start, signal.bits};
  EXPECT_EQ(states, (std::map<std::string, std::pair<uint32_t, uint32_t>>{
                        {"PI1_state", {7, 8}}, {"PI2_state", {23, 8}}, {"PI3_state", {39, 8}}}));
}

// Scales of MOVITRAC 07 chapter 6.1; a code without one is a plain number with sign.
TEST(Dbc, ScalesAndSignsOfProcessWords) {
  const auto row = [](const UnitNames& unit, bool input, size_t n) {
    const dbc::Signal signal = dbc::process_signals(unit, input).at(n);
    return std::make_tuple(signal.name, signal.start, signal.bits, signal.is_signed, signal.factor,
                           signal.unit);
  };
  using Row = std::tuple<std::string, uint32_t, uint32_t, bool, double, std::string>;
  const UnitNames output = unit_of("md60a", {1, 8, 11});
  EXPECT_EQ(row(output, false, 0), (Row{"PO1_SPEED", 7, 16, true, 0.2, "rpm"}));
  EXPECT_EQ(row(output, false, 1), (Row{"PO2_RAMP", 23, 16, false, 1, "ms"}));
  EXPECT_EQ(row(output, false, 2), (Row{"PO3_SPEED", 39, 16, true, 100.0 / 16384, "%"}));
  const UnitNames input = unit_of("md60a", {2, 0, 4});
  EXPECT_EQ(row(input, true, 0), (Row{"PI1_OUTP_CURRENT", 7, 16, true, 0.1, "% In"}));
  EXPECT_EQ(row(input, true, 1), (Row{"PI2_NO_FUNCTION", 23, 16, true, 1, ""}));
  UnitNames unknown = unit_of("md60a", {9, 6, 1});
  unknown.unit = nullptr;  // its words have no names, and a word of bits is a plain number without sign
  EXPECT_EQ(row(unknown, false, 0), (Row{"PO1", 7, 16, false, 1, ""}));
  EXPECT_EQ(row(unknown, true, 1), (Row{"PI2", 23, 16, false, 1, ""}));
  EXPECT_EQ(row(unknown, true, 2), (Row{"PI3", 39, 16, true, 0.2, "rpm"}));
}

// Two rows of MOVIDRIVE share the number and the name P852, so the second one is called by its index; what may be above
// 2^31 has no sign (P221), and a bit field has no unit (P094).
TEST(Dbc, SignalsOfParameters) {
  const std::vector<dbc::Signal> signals = dbc::parameter_signals(unit_of("md60a", {}));
  const auto find = [&](uint16_t index) {
    for (const dbc::Signal& signal : signals)
      if (signal.multiplexed == index) return signal;
    ADD_FAILURE() << index;
    return dbc::Signal{};
  };
  EXPECT_EQ(find(8772).name, "P852_User_dimension");
  EXPECT_EQ(find(8773).name, "I8773");
  EXPECT_EQ(find(8371).name, "I8371_Input_terminals_1_6_t_0");
  EXPECT_EQ(find(8502).is_signed, false);
  EXPECT_EQ(find(8318).is_signed, true);
  EXPECT_EQ(find(8318).unit, "rpm");
  EXPECT_EQ(find(8318).factor, 0.001);
  EXPECT_EQ(find(8455).unit, "");
  for (size_t n = 0; n < signals.size(); ++n) {
    EXPECT_EQ(signals[n].multiplexor, n == 5) << signals[n].name;
    EXPECT_EQ(signals[n].multiplexed.has_value(), n > 5) << signals[n].name;
    if (n > 5) {
      EXPECT_EQ(std::make_pair(signals[n].start, signals[n].bits), std::make_pair(39U, 32U));
    }
  }
}

}  // namespace
}  // namespace ipos::tests

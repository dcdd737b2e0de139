// Signals of every kind: their names, what they are, reading, writing and holding them, and the limits of each.
#include <algorithm>
#include <set>

#include "runtime/library/include/ipos_plant.h"
#include "stdlib/parameters.hpp"
#include "tests/runtime/library/opened_plant.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kOneDrive = R"([[station]]
name = "a"
unit = "mdxb"
program = "P.IPC"
[station.parameters]
P100 = 10
P101 = 3
[station.inputs]
DI03 = 1
)";
constexpr const char* kCounts =
    "typedef struct { long a; long b[2]; } S;\nlong n; S T;\nmain() { n = -7; T.b[1] = 5; while (1) ; }\n";

class LibraryPlaces : public ::testing::Test {
 protected:
  void SetUp() override { plant_.run(20); }
  OpenedPlant plant_{kOneDrive, kCounts};
};

TEST_F(LibraryPlaces, NamesOfEveryKind) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(plant_.names(IPOS_PLANT_VARIABLE), (Names{"n", "T.a", "T.b[0]", "T.b[1]"}));
  EXPECT_EQ(plant_.names(IPOS_PLANT_VARIABLE, "T"), (Names{"T.a", "T.b[0]", "T.b[1]"}));
  EXPECT_EQ(plant_.names(IPOS_PLANT_VARIABLE, "x"), Names{});
  Names inputs;
  for (int n = 0; n < 16; ++n) inputs.push_back("DI" + std::to_string(n / 8) + std::to_string(n % 8));
  EXPECT_EQ(plant_.names(IPOS_PLANT_INPUT), inputs);
  EXPECT_EQ(plant_.names(IPOS_PLANT_OUTPUT), (Names{"DB00", "DO01", "DO02", "DO03", "DO04", "DO05", "DO10",
                                                    "DO11", "DO12", "DO13", "DO14", "DO15", "DO16", "DO17"}));
  EXPECT_EQ(plant_.names(IPOS_PLANT_ANALOG), (Names{"AI1", "AI2", "frequency", "potentiometer"}));
  EXPECT_EQ(plant_.names(IPOS_PLANT_WORD), (Names{"PO1", "PO2", "PO3", "PI1", "PI2", "PI3"}));
  EXPECT_EQ(plant_.names(IPOS_PLANT_STATE),
            (Names{"fault", "status", "enabled", "ready", "speed", "setpoint", "position", "powered",
                   "running", "program_fault", "program_fault_line", "mains"}));
  EXPECT_EQ(plant_.names(IPOS_PLANT_SHAFT), (Names{"shaft_speed", "load_torque"}));
  // Each once, and every number and every index that the table has is reached.
  const stdlib::ParameterTable& table = stdlib::parameter_table(*stdlib::find_unit("mdxb"));
  const Names parameters = plant_.names(IPOS_PLANT_PARAMETER);
  const std::set<std::string> once(parameters.begin(), parameters.end());
  EXPECT_EQ(once.size(), parameters.size());
  std::set<uint16_t> reached;
  for (const std::string& name : parameters) {
    const stdlib::Parameter* row = table.find(std::string_view(name));
    if (name[0] != 'P') row = table.find(static_cast<uint16_t>(std::stoi(name)));
    ASSERT_NE(row, nullptr) << name;
    reached.insert(row->index);
  }
  for (const stdlib::Parameter& row : table.rows()) {
    EXPECT_TRUE(row.index == 0 || reached.count(row.index) != 0) << row.index;
    EXPECT_TRUE(row.index == 0 || row.number.empty() || once.count("P" + std::string(row.number)) != 0) << row.number;
  }
  EXPECT_EQ(plant_.names(IPOS_PLANT_VARIABLE, ""), Names{}) << "no whole has no name";
  EXPECT_GT(plant_.names(IPOS_PLANT_SIGNAL).size(), 50U);
  const Names signals = plant_.names(IPOS_PLANT_SIGNAL);
  EXPECT_EQ(signals[0], "n") << "the program's own names come first";
  EXPECT_NE(std::find(signals.begin(), signals.end(), "speed"), signals.end());
  const char* name = nullptr;
  for (const ipos_plant_kind kind : {IPOS_PLANT_ANY + 0, -1, 10})
    EXPECT_EQ(ipos_plant_name_at(plant_.plant, 0, kind, nullptr, 0, &name), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_name_at(plant_.plant, 1, IPOS_PLANT_INPUT, nullptr, 0, &name), IPOS_PLANT_NO_STATION);
}

// The first kind of the header that has the name.
TEST_F(LibraryPlaces, AreFoundByKindOrByName) {
  const struct {
    const char* name;
    ipos_plant_kind kind;
    uint32_t number;
    uint32_t flags;
  } rows[] = {{"n", IPOS_PLANT_VARIABLE, 0, IPOS_PLANT_WRITABLE},
              {"H511", IPOS_PLANT_VARIABLE, 511, IPOS_PLANT_WRITABLE},
              {"P130", IPOS_PLANT_PARAMETER, 8470, IPOS_PLANT_WRITABLE},
              {"8470", IPOS_PLANT_PARAMETER, 8470, IPOS_PLANT_WRITABLE},
              {"P076", IPOS_PLANT_PARAMETER, 8300, 0},
              {"DI17", IPOS_PLANT_INPUT, 15, IPOS_PLANT_WRITABLE},
              {"DO17", IPOS_PLANT_OUTPUT, 15, 0},
              {"AI1", IPOS_PLANT_ANALOG, 16, IPOS_PLANT_WRITABLE},
              {"AI2", IPOS_PLANT_ANALOG, 18, IPOS_PLANT_WRITABLE},
              {"frequency", IPOS_PLANT_ANALOG, 20, IPOS_PLANT_WRITABLE},
              {"speed", IPOS_PLANT_STATE, 4, 0},
              {"PO3", IPOS_PLANT_WORD, 2, IPOS_PLANT_WRITABLE},
              {"PI1", IPOS_PLANT_WORD, 3, 0},
              {"load_torque", IPOS_PLANT_SHAFT, 0x10000, IPOS_PLANT_WRITABLE},
              {"shaft_speed", IPOS_PLANT_SHAFT, 0x10001, 0},
              {"torque", IPOS_PLANT_SIGNAL, 0, 0},
              {"task1.line", IPOS_PLANT_SIGNAL, 0, 0}};
  for (const auto& row : rows)
    for (const ipos_plant_kind asked : {IPOS_PLANT_ANY + 0, row.kind}) {
      const uint32_t signal = plant_.find(row.name, asked);
      const ipos_plant_signal_info info = plant_.info(signal);
      EXPECT_EQ(std::tuple(info.kind, info.flags, info.station), std::tuple(row.kind, row.flags, 0U))
          << row.name;
      if (std::string(row.name) != "n") {
        EXPECT_EQ(info.number, row.number) << row.name;
      }
      EXPECT_STREQ(info.name, row.name);
      EXPECT_EQ(plant_.find(row.name, asked), signal) << "the same number again";
    }
}

TEST_F(LibraryPlaces, WhatIsMissingIsToldWithWhatThereIs) {
  uint32_t signal = 0;
  const auto told = [&](ipos_plant_kind kind, const char* name) {
    EXPECT_EQ(ipos_plant_find(plant_.plant, 0, kind, name, &signal), IPOS_PLANT_NO_SIGNAL) << name;
    return plant_.message();
  };
  const std::string kStates =
      "states fault, status, enabled, ready, speed, setpoint, position, powered, running, program_fault, "
      "program_fault_line, mains; terminals, words and parameters";
  EXPECT_EQ(
      told(IPOS_PLANT_VARIABLE, "x"),
      "station 'a' has no variable 'x'; it has n, T.a, T.b[0], T.b[1], H0..H1023 and the system variables");
  EXPECT_EQ(
      told(IPOS_PLANT_ANY, "x"),
      "station 'a' has no signal 'x'; it has n, T.a, T.b[0], T.b[1], H0..H1023 and the system variables; " + kStates);
  EXPECT_TRUE(told(IPOS_PLANT_ANY, "sped").starts_with("station 'a' has no signal 'sped' (did you mean 'speed'?); it has n"));
  EXPECT_EQ(told(IPOS_PLANT_ANALOG, "AI3"),
            "station 'a' has no analog input 'AI3'; it has AI1, AI2, frequency, potentiometer");
  EXPECT_EQ(told(IPOS_PLANT_WORD, "PO4"),
            "station 'a' has no process word 'PO4'; it has PO1, PO2, PO3, PI1, PI2, PI3");
  EXPECT_TRUE(told(IPOS_PLANT_PARAMETER, "P999").starts_with("station 'a' has no parameter 'P999' (did you mean 'P"));
  EXPECT_TRUE(told(IPOS_PLANT_PARAMETER, "P999").ends_with(" more"));
  const size_t parameters = plant_.names(IPOS_PLANT_PARAMETER).size();
  EXPECT_TRUE(
      told(IPOS_PLANT_PARAMETER, "speed").ends_with(" and " + std::to_string(parameters - 24) + " more"));
  EXPECT_TRUE(
      told(IPOS_PLANT_OUTPUT, "DO06").starts_with("station 'a' has no output 'DO06'; it has DB00, DO01"));
  for (const auto& [kind, name] :
       {std::pair(IPOS_PLANT_INPUT, "DO01"), std::pair(IPOS_PLANT_STATE, "torque"),
        std::pair(IPOS_PLANT_SIGNAL, "x"), std::pair(IPOS_PLANT_VARIABLE, "H1024")})
    told(kind, name);
  const OpenedPlant plain("[[station]]\nname = \"a\"\nunit = \"mc31\"\n");
  EXPECT_EQ(ipos_plant_find(plain.plant, 0, IPOS_PLANT_ANY, "x", &signal), IPOS_PLANT_NO_SIGNAL);
  EXPECT_EQ(plain.message(), "station 'a' has no signal 'x'; it has no variables: its unit has no IPOS; " + kStates);
}

TEST_F(LibraryPlaces, AreReadAsNumberAndAsText) {
  const auto is = [&](const char* name, int64_t value, const char* text) {
    const uint32_t signal = plant_.find(name);
    EXPECT_EQ(plant_.value(signal), value) << name;
    EXPECT_EQ(plant_.text(signal), text) << name;
  };
  is("n", -7, "-7");
  is("T.b[1]", 5, "5");
  is("DI03", 1, "1");
  is("DI04", 0, "0");
  is("running", 1, "1");
  is("speed", 0, "0.000 rpm");
  is("position", 0, "0 inc");
  is("torque", 0, "0.000 %Mn");
  is("AI1", 0, "0.000 V");
  is("potentiometer", 0, "0.0 %");
  is("PO1", 0, "0");
}

TEST_F(LibraryPlaces, UnitsFactorsAndDecimals) {
  const auto is = [&](const char* name, const char* unit, double factor, int decimals) {
    const ipos_plant_signal_info info = plant_.info(plant_.find(name));
    EXPECT_STREQ(info.unit, unit) << name;
    EXPECT_DOUBLE_EQ(info.factor, factor) << name;
    EXPECT_EQ(info.decimals, decimals) << name;
  };
  is("n", "", 1, 0);
  is("P130", "s", 0.001, 3);
  is("P100", "", 1, 0);  // it has words for its values
  is("speed", "rpm", 0.001, 3);
  is("setpoint", "rpm", 0.001, 3);
  is("position", "inc", 1, 0);
  is("fault", "", 1, 0);
  is("torque", "%Mn", 0.001, 3);
  is("AI1", "V", 0.001, 3);
  is("frequency", "kHz", 0.001, 3);
  is("potentiometer", "%", 0.1, 1);
}

TEST_F(LibraryPlaces, AnAnalogInputIsAVoltageOrACurrent) {
  const uint32_t signal = plant_.find("AI1");
  const auto write = [&](const char* text) { return ipos_plant_write_text(plant_.plant, signal, text); };
  for (const char* text : {"5.000 V", "12.000 mA", "-3.500 V", "20.000 mA", "0.000 V"}) {
    EXPECT_EQ(write(text), IPOS_PLANT_OK) << plant_.message();
    EXPECT_EQ(plant_.text(signal), text);
    EXPECT_EQ(plant_.value(plant_.find("AI2")), 0) << "the other one";
  }
  EXPECT_EQ(write("4 mA"), IPOS_PLANT_OK);
  EXPECT_STREQ(plant_.info(signal).unit, "mA");
  EXPECT_EQ(write("11 V"), IPOS_PLANT_BAD_VALUE);
  EXPECT_TRUE(plant_.message().starts_with("'11 V' is nothing for AI1; write a text such as \"5 V\""));
  EXPECT_EQ(ipos_plant_write_text(plant_.plant, plant_.find("potentiometer"), "12.5 %"), IPOS_PLANT_OK);
  EXPECT_EQ(plant_.text(plant_.find("potentiometer")), "12.5 %");
  EXPECT_EQ(ipos_plant_write_text(plant_.plant, plant_.find("frequency"), "65 kHz"), IPOS_PLANT_OK);
  EXPECT_EQ(plant_.text(plant_.find("frequency")), "65.000 kHz");
  EXPECT_EQ(plant_.text(plant_.find("potentiometer")), "12.5 %") << "a terminal of its own";
}

TEST_F(LibraryPlaces, LimitsOfEachKind) {
  const struct {
    const char* name;
    int64_t least, most;
    const char* what;
  } rows[] = {{"DI00", 0, 1, "an input"},
              {"PO2", -32'768, 65'535, "a process word"},
              {"n", INT32_MIN, INT32_MAX, "a variable"},
              {"AI1", INT32_MIN, INT32_MAX, "an analog input"},
              {"P130", INT32_MIN, UINT32_MAX, "a parameter"}};
  for (const auto& row : rows) {
    const uint32_t signal = plant_.find(row.name);
    for (const int64_t value : {row.least - 1, row.most + 1}) {
      EXPECT_EQ(ipos_plant_write(plant_.plant, signal, value), IPOS_PLANT_BAD_VALUE) << row.name;
      EXPECT_EQ(plant_.message(), std::string(row.name) + ": " + std::to_string(value) +
                                      " is out of range for " + row.what + ": " + std::to_string(row.least) +
                                      ".." + std::to_string(row.most));
    }
    for (const int64_t value : {row.least, row.most})
      EXPECT_NE(ipos_plant_write(plant_.plant, signal, value), IPOS_PLANT_BAD_VALUE) << row.name;
  }
  for (const char* name : {"DO01", "PI1", "speed", "torque"})
    for (const auto& act : {ipos_plant_write, ipos_plant_force}) {
      EXPECT_EQ(act(plant_.plant, plant_.find(name), 0), IPOS_PLANT_READ_ONLY) << name;
      EXPECT_EQ(plant_.message(), std::string(name) + " can only be read");
      EXPECT_EQ(ipos_plant_write_text(plant_.plant, plant_.find(name), "0"), IPOS_PLANT_READ_ONLY);
    }
}

TEST_F(LibraryPlaces, NumbersAsText) {
  const uint32_t signal = plant_.find("H100");
  const auto write = [&](const char* text) { return ipos_plant_write_text(plant_.plant, signal, text); };
  for (const auto& [text, value] :
       {std::pair("17", 17), std::pair("-5", -5), std::pair("0x10", 16), std::pair("0XfF", 255)}) {
    EXPECT_EQ(write(text), IPOS_PLANT_OK) << plant_.message();
    EXPECT_EQ(plant_.value(signal), value) << text;
  }
  for (const char* wrong : {"", "0x", "x", "1x", "1.5", " 1", "0x1g"}) {
    EXPECT_EQ(write(wrong), IPOS_PLANT_BAD_VALUE) << wrong;
    EXPECT_EQ(plant_.message(), "'" + std::string(wrong) + "' is no number");
  }
  const uint32_t ramp = plant_.find("P130");
  EXPECT_EQ(ipos_plant_write_text(plant_.plant, ramp, "2.5 s"), IPOS_PLANT_OK);
  EXPECT_EQ(plant_.value(ramp), 2'500);
  EXPECT_EQ(ipos_plant_write_text(plant_.plant, ramp, "2.5 rpm"), IPOS_PLANT_BAD_VALUE);
  EXPECT_TRUE(plant_.message().starts_with("P130 Ramp t11 UP CW: ")) << plant_.message();
}

TEST_F(LibraryPlaces, AreHeldUntilTheyAreReleased) {
  for (const auto& [name, held, other] : {std::tuple("DI05", 1, 0), std::tuple("n", 9, 4),
                                          std::tuple("P130", 3'000, 2'000), std::tuple("PO2", 700, 300)}) {
    const uint32_t signal = plant_.find(name);
    int64_t now = 0;
    const auto run_on = [&] {
      ipos_plant_time(plant_.plant, &now);
      plant_.run(now / 1'000'000 + 5);
    };
    EXPECT_EQ(ipos_plant_write(plant_.plant, signal, other), IPOS_PLANT_OK) << name;
    EXPECT_EQ(plant_.value(signal), other) << name;
    EXPECT_EQ(ipos_plant_force(plant_.plant, signal, held), IPOS_PLANT_OK) << name;
    EXPECT_EQ(ipos_plant_write(plant_.plant, signal, other), IPOS_PLANT_OK) << name;
    run_on();
    EXPECT_EQ(plant_.value(signal), held) << name;
    EXPECT_EQ(ipos_plant_release(plant_.plant, signal), IPOS_PLANT_OK) << name;
    EXPECT_EQ(ipos_plant_write(plant_.plant, signal, other), IPOS_PLANT_OK) << name;
    run_on();
    EXPECT_EQ(plant_.value(signal), other) << name;
  }
  const uint32_t analog = plant_.find("AI2");
  EXPECT_EQ(ipos_plant_force_text(plant_.plant, analog, "7 V"), IPOS_PLANT_OK);
  EXPECT_EQ(plant_.text(analog), "7.000 V");
  EXPECT_EQ(ipos_plant_release(plant_.plant, analog), IPOS_PLANT_OK);
  EXPECT_EQ(plant_.text(analog), "0.000 V");
}

TEST_F(LibraryPlaces, ReadsManyOrNone) {
  const uint32_t signals[] = {plant_.find("n"), plant_.find("DI03"), plant_.find("n")};
  int64_t values[] = {1, 1, 1};
  EXPECT_EQ(ipos_plant_read_many(plant_.plant, signals, 3, values), IPOS_PLANT_OK);
  EXPECT_EQ(std::vector(values, values + 3), (std::vector<int64_t>{-7, 1, -7}));
  const uint32_t wrong[] = {signals[0], 99};
  values[0] = 1;
  EXPECT_EQ(ipos_plant_read_many(plant_.plant, wrong, 2, values), IPOS_PLANT_NO_SIGNAL);
  EXPECT_EQ(plant_.message(), "no signal has number 99");
  EXPECT_EQ(values[0], 1) << "nothing is read";
  EXPECT_EQ(ipos_plant_read_many(plant_.plant, nullptr, 0, nullptr), IPOS_PLANT_OK);
  EXPECT_EQ(ipos_plant_read_many(plant_.plant, nullptr, 1, values), IPOS_PLANT_INVALID_ARGUMENT);
  EXPECT_EQ(ipos_plant_read_many(plant_.plant, signals, 1, nullptr), IPOS_PLANT_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace ipos::tests

// A plant from its file to its end: who stands where, what does not fit, expectations at their time, power, faults that
// nobody has foreseen, and the hash over what it shows.
#include "tests/runtime/plant/plain_plant.hpp"

#include <fmt/format.h>

#include "runtime/plant/trace_hash.hpp"
#include "runtime/signals/find.hpp"

namespace ipos::runtime {
namespace {

using tests::PlainPlant;

const std::string kCanLine = "[[bus]]\nname = 'b'\nkind = 'can'\n";

std::string plain_unit(const std::string& name, const std::string& keys = "",
                       const std::string& type = "mdxb") {
  return "[[station]]\nname = '" + name + "'\nunit = '" + type + "'\n" + keys;
}

TEST(PlantRun, AsksOnceAMillisecondWhetherToGoOn) {
  const PlainPlant plant(
      plain_unit("u",
                 "[[expect]]\nstation = 'u'\nat = '6ms'\nstate = 'powered'\nequals = 1\n"
                 "[[expect]]\nstation = 'u'\nat = '6001us'\nstate = 'powered'\nequals = 1\n"));
  std::vector<Time> asked;
  const auto until = [&](Time last) {
    return [&asked, last](Time now) {
      asked.push_back(now);
      return now < last;
    };
  };
  EXPECT_TRUE(plant->run_until(3'500 * kMicrosecond, until(kSecond)));
  EXPECT_EQ(asked, (std::vector<Time>{1'000'000, 2'000'000, 3'000'000, 3'500'000}));
  asked.clear();
  EXPECT_TRUE(plant->run_until(3'500 * kMicrosecond, until(kSecond)));
  EXPECT_TRUE(asked.empty()) << "that time is over";
  EXPECT_FALSE(plant->run_until(kSecond, until(6 * kMillisecond)));
  EXPECT_EQ(asked, (std::vector<Time>{4'000'000, 5'000'000, 6'000'000}));
  EXPECT_EQ(plant->now(), 6 * kMillisecond);
  EXPECT_EQ(plant->results().size(), 1U) << "with what was due at this time";
}

TEST(PlantRun, ExpectationsAreCheckedBehindAllOfTheirTime) {
  const std::string expect = "[[expect]]\nstation = 'u'\nparameter = 'P160'\n";
  const PlainPlant plant(
      plain_unit("u", expect + "at = '20ms'\nequals = 6000\n" + expect + "at = '10ms'\nequals = 5000\n" +
                          expect + "at = '9999us'\nequals = 5000\n" + expect + "at = '0ms'\nequals = 1\n" +
                          "[[stimulus]]\nstation = 'u'\nat = '10ms'\nparameter = 'P160'\nset = 5000\n"
                          "[[stimulus]]\nstation = 'u'\nat = '20ms'\nparameter = 'P160'\nset = 6000\n"));
  plant->run_until(20 * kMillisecond - 1);
  ASSERT_EQ(plant->results().size(), 3U);
  plant->run_until(20 * kMillisecond);
  ASSERT_EQ(plant->results().size(), 4U);
  const auto is = [&](size_t n, Time at, bool met) {
    EXPECT_EQ(plant->results()[n].expectation->at, at);
    EXPECT_EQ(plant->results()[n].met, met) << n;
  };
  is(0, 0, false);
  is(1, 9'999 * kMicrosecond, false);
  is(2, 10 * kMillisecond, true);
  is(3, 20 * kMillisecond, true);
  EXPECT_EQ(plant->results()[3].actual, 6'000);
}

// docs/guide/plant-file.md: a fault that an [[expect]] has looked for and found is foreseen.
TEST(PlantRun, FaultsThatNobodyHasForeseen) {
  const std::string expect = "[[expect]]\nstation = 'u'\nat = '20ms'\nstate = ";
  const auto unforeseen = [](const std::string& expected, uint8_t later = 0) {
    const PlainPlant plant(plain_unit("u") + plain_unit("v") + expected +
                           "[[stimulus]]\nstation = 'u'\nat = '30ms'\nparameter = 'P840'\nset = 1\n");
    EXPECT_FALSE(plant->has_fault());
    EXPECT_TRUE(plant->unforeseen_faults().empty());
    plant->run_until(10 * kMillisecond);
    plant.station(0).drive().state().raise_fault(47);
    plant->run_until(25 * kMillisecond);
    EXPECT_TRUE(plant->has_fault());
    if (later != 0) {
      plant->run_until(400 * kMillisecond);
      EXPECT_FALSE(plant->has_fault()) << "P840 has reset it";
      plant.station(0).drive().state().raise_fault(later);
      plant->run_until(410 * kMillisecond);
    }
    const auto found = plant->unforeseen_faults();
    EXPECT_TRUE(found.empty() || found[0] == &plant.station(0));
    return !found.empty();
  };
  EXPECT_TRUE(unforeseen(""));
  EXPECT_FALSE(unforeseen(expect + "'fault'\nequals = 47\n"));
  EXPECT_TRUE(unforeseen(expect + "'fault'\nequals = 46\n"));
  EXPECT_TRUE(unforeseen(expect + "'enabled'\nequals = 0\n"));
  EXPECT_TRUE(unforeseen(expect + "'powered'\nequals = 1\n"));
  EXPECT_TRUE(unforeseen("[[expect]]\nstation = 'v'\nat = '20ms'\nstate = 'fault'\nequals = 0\n"));
  EXPECT_TRUE(unforeseen("[[expect]]\nstation = 'u'\nat = '5ms'\nstate = 'fault'\nequals = 0\n"));
  EXPECT_FALSE(unforeseen(expect + "'fault'\nequals = 47\n", 47));
  EXPECT_TRUE(unforeseen(expect + "'fault'\nequals = 47\n", 26)) << "another one";
}

TEST(PlantRun, PowerIsToldEachTime) {
  const PlainPlant plant(plain_unit("u") + plain_unit("v"));
  plant->run_until(10 * kMillisecond);
  plant->set_power("u", true);
  EXPECT_TRUE(plant.told("u", "the power").empty()) << "it is on";
  plant->set_power("u", false);
  plant->set_power("u", false);
  EXPECT_FALSE(plant.station(0).powered());
  EXPECT_TRUE(plant.station(1).powered());
  plant->set_power("u", true);
  plant->set_power("u", false);
  EXPECT_EQ(plant.told("u", "the power"),
            (std::vector<std::string>{"the power is switched off", "the power is switched on",
                                      "the power is switched off"}));
  EXPECT_TRUE(plant.told("v", "the power").empty());
}

// Stations and controls are on the cable in the order of the file.
TEST(PlantRun, TheCableHasTheOrderOfTheFile) {
  const std::string control = "[[control]]\nsbus = 'b'\nname = ";
  const PlainPlant plant(control + "'a'\n" + control + "'b'\nkind = 'canopen'\n" +
                         plain_unit("c", "sbus = 'b'\n") + control + "'d'\n" +
                         plain_unit("e", "sbus = 'b'\n") + control + "'f'\n" + kCanLine);
  const CanLine& line = plant->all<CanBus>().at(0)->line();
  std::string order;
  for (NodeId node = 0; node < line.node_count(); ++node) order += line.node_name(node);
  EXPECT_EQ(order, "abcdef");
}

TEST(PlantRun, WhatIsNotThereIsNotFound) {
  const PlainPlant plant(kCanLine + plain_unit("u", "keypad = true\n") +
                         plain_unit("v", "keypad = true\ns13 = true\n"));
  EXPECT_EQ(plant->find_bus("c"), nullptr);
  EXPECT_EQ(plant->find_bus("b"), plant->buses().at(0).get());
  EXPECT_EQ(plant->find_gateway("u"), nullptr);
  // A keypad hangs on a line of its own at the rate of its socket.
  EXPECT_EQ(plant->buses().size(), 3U);
  EXPECT_EQ(plant->find_bus("u.keypad")->baud(), 57'600U);
  EXPECT_EQ(plant->find_bus("v.keypad")->baud(), 9'600U);
  std::string why;
  EXPECT_FALSE(signals::find_signal(*plant, {"u", SignalKind::Variable, "x", 0}, why));
  EXPECT_EQ(why, "station 'u' has no variable 'x'");
  EXPECT_FALSE(signals::find_signal(*plant, {"u", SignalKind::Parameter, "P999", 0}, why));
  EXPECT_EQ(why, "station 'u' has no parameter 'P999'");
  EXPECT_FALSE(signals::find_signal(*plant, {"u", SignalKind::Any, "x", 0}, why));
  EXPECT_TRUE(why.starts_with("station 'u' has no signal 'x'; it has speed")) << why;
  EXPECT_FALSE(signals::find_signal(*plant, {"w", SignalKind::State, "fault", 0}, why));
  EXPECT_EQ(why, "");
  EXPECT_TRUE(signals::find_signal(*plant, {"v", SignalKind::Parameter, "P130", 0}, why));
}

TEST(PlantRun, TheStationsHaveWhatTheFileSays) {
  const PlainPlant plant(plain_unit(
      "u",
      "[station.parameters]\nP130 = 3000\nP131 = '4 s'\n[station.inputs]\nDI01 = 1\nDI17 = 1\nDI02 = 0\n"
      "[station.analog]\nAI1 = '5 V'\nAI2 = '12 mA'\nfrequency = '1 kHz'\npotentiometer = '10 %'\n"));
  EXPECT_EQ(plant.parameter("130"), 3'000);
  EXPECT_EQ(plant.parameter("131"), 4'000);
  const UnitInputs& inputs = std::as_const(plant.station()).inputs();
  EXPECT_EQ(inputs.levels(), 0x8002);
  EXPECT_EQ(inputs.analog(), (AnalogInputs{{5'000, 0}, {0, 12'000}, 1'000, 100}));
}

TEST(PlantRun, WhatAUnitRefusesIsAnError) {
  const PlainPlant wrong(
      plain_unit("u", "nvram = '/'\n[station.parameters]\nP130 = 3000\nP999 = 1\nP160 = 600001\n") +
      "[[expect]]\nstation = 'u'\nat = '1ms'\nvariable = 'x'\nequals = 1\n");
  ASSERT_EQ(wrong.errors.size(), 4U);
  EXPECT_TRUE(wrong.errors[0].text.starts_with("station 'u': / cannot be used: "));
  EXPECT_TRUE(wrong.errors[1].text.starts_with("station 'u': ")) << wrong.errors[1].text;
  const auto line = [&](size_t n) { return wrong.errors[n].place.line; };
  EXPECT_EQ(std::tuple(line(0), line(1), line(2), line(3)), std::tuple(4U, 7U, 8U, 9U));
  EXPECT_EQ(wrong.errors[3].text, "station 'u' has no variable 'x'");
}

std::string gateway_text(const std::string& keys, const std::string& stations) {
  return kCanLine + "[[bus]]\nname = 'c'\nkind = 'can'\n[[bus]]\nname = 'p'\nkind = 'profibus'\n" + stations +
         "[[station]]\nname = 'g'\nunit = 'gateway'\nprofibus = 'p'\nprofibus_address = 5\nsbus = 'b'\n" +
         keys;
}

std::string addressed(const std::string& name, int address, const std::string& keys = "sbus = 'b'\n") {
  return plain_unit(name, keys + "[station.parameters]\nP881 = " + std::to_string(address) + "\n");
}

// All that speak MOVILINK on its line, in the order of their addresses, each once; or those that the file names.
TEST(PlantRun, AGatewayServesTheDrivesOfItsLine) {
  const auto drives = [](const std::string& keys, const std::string& stations) {
    const PlainPlant plant(gateway_text(keys, stations));
    EXPECT_TRUE(plant.errors.empty());
    std::vector<int> found;
    for (const ControlTarget& target : plant->all<Gateway>().at(0)->settings().targets) {
      found.push_back(target.address);
      EXPECT_EQ(std::tuple(target.group, target.every), std::tuple(false, 10 * kMillisecond));
    }
    EXPECT_EQ(plant->find_gateway("g")->drive_count(), found.size());
    return found;
  };
  const std::string some = addressed("u", 5) + addressed("v", 2) + addressed("w", 2) +
                           addressed("x", 9, "sbus = 'c'\n") +
                           plain_unit("y", "sbus = 'b'\n[station.parameters]\nP881 = 7\nP880 = 1\n") +
                           plain_unit("z", "sbus2 = 'b'\n[station.parameters]\nP891 = 3\nP881 = 8\n");
  EXPECT_EQ(drives("", some), (std::vector<int>{2, 3, 5}));
  EXPECT_EQ(drives("drives = [9, 1]\n", some), (std::vector<int>{1, 9}));
  std::string eight;
  for (int n = 0; n < 8; ++n) eight += addressed("u" + std::to_string(n), n);
  EXPECT_EQ(drives("", eight).size(), 8U);
  for (const auto& [stations, count] :
       {std::pair(eight + addressed("v", 20), 9), std::pair(plain_unit("u"), 0)}) {
    const PlainPlant plant(gateway_text("", stations));
    ASSERT_EQ(plant.errors.size(), 1U);
    EXPECT_EQ(plant.errors[0].text, "gateway 'g' has " + std::to_string(count) +
                                        " drives on 'b', and it takes 1 to 8: name them with drives = [...]");
  }
}

TEST(PlantRun, SignalsOfAGateway) {
  const PlainPlant plant(gateway_text("", addressed("u", 5)));
  std::string why;
  for (const auto& [name, value] :
       {std::pair("powered", 1), std::pair("exchange", 0), std::pair("drive5.lost", 0)}) {
    const auto port = signals::find_signal(*plant, {"g", SignalKind::Any, name, 0}, why);
    ASSERT_TRUE(port) << why;
    EXPECT_EQ(port->read(), value) << name;
    EXPECT_EQ(port->station, "g");
  }
  EXPECT_FALSE(signals::find_signal(*plant, {"g", SignalKind::Any, "x", 0}, why));
  EXPECT_TRUE(why.starts_with("gateway 'g' has no signal 'x'; it has powered, exchange")) << why;
}

// As docs/guide/recording.md shows them: number, unit and digits, and which are bits or bit fields.
TEST(PlantRun, SignalsOfAStationAreShownWithUnitAndDigits) {
  const PlainPlant plant(plain_unit("u"));
  const struct {
    const char* name;
    signals::Group group;
    const char* unit;
    double factor;
    int decimals;
    size_t bits;
  } rows[] = {{"setpoint", signals::Group::Drive, "rpm", 0.001, 3, 0},
              {"shaft_speed", signals::Group::Drive, "rpm", 0.001, 3, 0},
              {"shaft_angle", signals::Group::Drive, "rad", 1e-6, 6, 0},
              {"load_torque", signals::Group::Drive, "Nm", 1e-4, 4, 0},
              {"torque", signals::Group::Drive, "%Mn", 0.001, 3, 0},
              {"status", signals::Group::Drive, "", 1, 0, 16},
              {"fault", signals::Group::Drive, "", 1, 0, 0},
              {"enabled", signals::Group::State, "", 1, 0, 1},
              {"program_fault", signals::Group::State, "", 1, 0, 0},
              {"DI00", signals::Group::Input, "", 1, 0, 1},
              {"DI17", signals::Group::Input, "", 1, 0, 1},
              {"DB00", signals::Group::Output, "", 1, 0, 1},
              {"DO05", signals::Group::Output, "", 1, 0, 1},
              {"DO17", signals::Group::Output, "", 1, 0, 1},
              {"AI1", signals::Group::Analog, "V", 0.001, 3, 0},
              {"AI2_current", signals::Group::Analog, "mA", 0.001, 3, 0},
              {"potentiometer", signals::Group::Analog, "%", 0.1, 1, 0},
              {"PO1", signals::Group::ProcessData, "", 1, 0, 16},
              {"PI3", signals::Group::ProcessData, "", 1, 0, 16},
              {"P130", signals::Group::Parameter, "s", 0.001, 3, 0}};
  for (const auto& row : rows) {
    const auto found = signals::find_station_signals(plant.station(), row.name);
    ASSERT_EQ(found.size(), 1U) << row.name;
    const signals::Signal& signal = found[0];
    EXPECT_EQ(std::tuple(signal.name, signal.station), std::tuple("u." + std::string(row.name), "u"));
    EXPECT_EQ(std::tuple(signal.group, signal.unit, signal.decimals, signal.bits),
              std::tuple(row.group, row.unit, row.decimals, row.bits))
        << row.name;
    EXPECT_DOUBLE_EQ(signal.factor, row.factor) << row.name;
    EXPECT_EQ(signal.is_status, std::string(row.name) == "status");
  }
  for (const char* own : {"position_setpoint", "H0", "ActPos_Mot"})
    EXPECT_EQ(signals::find_station_signals(plant.station(), own).size(), 1U) << own << " is of the unit";
  for (const char* none : {"task1.line", "lCount", "H1024", "DO06", "DI08", "PO4"})
    EXPECT_TRUE(signals::find_station_signals(plant.station(), none).empty())
        << none << " is of a program or not there";
}

// CiA 301: a number is given once on a line.
TEST(PlantRun, TwoNodesWithOneNumberAreTold) {
  const auto node = [](const std::string& name, const std::string& bus, int number) {
    return plain_unit(name, "sbus = '" + bus +
                                "'\n[station.parameters]\nP880 = 1\nP886 = " + std::to_string(number) + "\n");
  };
  const std::string second = "[[bus]]\nname = 'c'\nkind = 'can'\n";
  const PlainPlant good(kCanLine + second + node("u", "b", 5) + node("v", "b", 6) + node("w", "c", 5));
  EXPECT_TRUE(good.told("", "CANopen address").empty());
  const PlainPlant twice(kCanLine + second + node("u", "b", 5) + node("w", "c", 5) + node("v", "b", 5) +
                         plain_unit("x", "sbus2 = 'b'\n[station.parameters]\nP890 = 1\nP896 = 5\n"));
  const auto told = twice.told("", "have CANopen address 5");
  ASSERT_EQ(told.size(), 3U);
  EXPECT_TRUE(told[0].starts_with("b: u and v both"));
  EXPECT_TRUE(told[1].starts_with("b: u and x both"));
  EXPECT_TRUE(told[2].starts_with("b: v and x both"));
}

TEST(PlantRun, AFieldbusThatIsNotThereIsTold) {
  const auto told = [](const std::string& parameters, const std::string& type = "mdxb") {
    const PlainPlant plant(plain_unit("u", "[station.parameters]\n" + parameters, type));
    std::string text;
    for (const std::string& entry : plant.told("u", "is FIELDBUS, but the station is on no PROFIBUS"))
      text += entry.substr(0, 5);
    return text;
  };
  EXPECT_EQ(told("P100 = 3\n"), "P100 ");
  EXPECT_EQ(told("P101 = 2\n"), "P101 ");
  EXPECT_EQ(told("P100 = 3\nP101 = 2\n", "md60a"), "P100 P101 ");
  EXPECT_EQ(told("P100 = 2\nP101 = 3\n"), "");
  EXPECT_EQ(told("P100 = 10\n", "mc07"), "");
  const PlainPlant with(
      "[[bus]]\nname = 'p'\nkind = 'profibus'\n" +
      plain_unit("u",
                 "option = 'dfp'\nprofibus = 'p'\nprofibus_address = 5\n[station.parameters]\nP100 = 3\n"));
  EXPECT_TRUE(with.told("u", "is FIELDBUS").empty());
}

// Two runs are equal where everything is that a drive decided and a line carried, at its time.
TEST(PlantRun, TheHashTellsRunsApart) {
  const auto hash = [](const std::string& more, const std::function<void(Plant&)>& act = {}) {
    const PlainPlant plant(
        kCanLine +
        plain_unit("u",
                   "sbus = 'b'\n[station.parameters]\nP130 = 0\n[station.inputs]\nDI00 = 1\nDI01 = 1\n") +
        plain_unit("v") + more);
    TraceHash trace(*plant);
    plant->find_bus("b")->attach_hand();
    plant->run_until(20 * kMillisecond, [&](Time now) { return trace.sample(now), true; });
    if (act) act(*plant);
    plant->run_until(500 * kMillisecond, [&](Time now) { return trace.sample(now), true; });
    EXPECT_EQ(trace.text().size(), 16U);
    EXPECT_EQ(trace.text(), fmt::format("{:016x}", trace.value()));
    return trace.value();
  };
  const std::string pulse = "[[stimulus]]\nstation = 'u'\ninput = 'DI03'\npulse = 1\nfor = '20ms'\nat = ";
  const std::vector<uint64_t> all = {
      hash(""),
      hash(pulse + "'50ms'\n"),
      hash(pulse + "'51ms'\n"),
      hash("[[stimulus]]\nstation = 'u'\ninput = 'DI17'\nat = '50ms'\nset = 1\n"),
      hash("[[stimulus]]\nstation = 'v'\ninput = 'DI17'\nat = '50ms'\nset = 1\n"),
      hash("", [](Plant& plant) { plant.set_power("u", false); }),
      hash("", [](Plant& plant) { plant.stations()[0]->drive().state().raise_fault(47); }),
      hash("", [](Plant& plant) { plant.stations()[1]->drive().state().raise_fault(47); }),
      hash("", [](Plant& plant) { plant.stations()[0]->drive().state().raise_fault(26); }),
      hash("", [](Plant& plant) { plant.find_bus("b")->send("7FF#01"); }),
      hash("", [](Plant& plant) { plant.find_bus("b")->send("7FF#02"); }),
      hash("", [](Plant& plant) { plant.find_bus("b")->send("7FE#02"); }),
  };
  for (size_t a = 0; a < all.size(); ++a)
    for (size_t b = 0; b < a; ++b) EXPECT_NE(all[a], all[b]) << a << ' ' << b;
  EXPECT_EQ(hash(""), all[0]);
  EXPECT_EQ(hash(pulse + "'50ms'\n"), all[1]);
}

}  // namespace
}  // namespace ipos::runtime

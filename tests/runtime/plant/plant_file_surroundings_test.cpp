// [[stimulus]], [[wire]], [[switch]] and [[expect]] of the plant file: what they say arrives, and each mistake is told
// once, at its place.
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;

const std::string kDrivenUnit = "[[station]]\nname = 'u'\nunit = 'mdxb'\n";
const std::string kStimulusHead = "[[stimulus]]\nstation = 'u'\nat = '1ms'\n";
const std::string kExpectHead = "[[expect]]\nstation = 'u'\nat = '1ms'\n";

Stimulus first_stimulus(const std::string& text) {
  return read_plant(kDrivenUnit + kStimulusHead + text).stimuli.at(0);
}
Expectation first_expectation(const std::string& text) {
  return read_plant(kDrivenUnit + kExpectHead + text).expectations.at(0);
}

TEST(PlantFileSurroundings, StimuliOfEverySignal) {
  using Kind = SignalKind;
  const struct {
    const char* text;
    Kind kind;
    const char* name;
    int line;
    int32_t value;
  } rows[] = {
      {"variable = 'x'\nset = -5\n", Kind::Variable, "x", 0, -5},
      {"variable = 'H5'\nset = 0xFFFFFFFF\n", Kind::Variable, "H5", 0, -1},
      {"parameter = 'P130'\nset = 2500\n", Kind::Parameter, "P130", 0, 2'500},
      {"parameter = 'P130'\nset = '2.5 s'\n", Kind::Parameter, "P130", 0, 2'500},
      {"input = 'DI00'\nset = 1\n", Kind::Input, "DI00", 0, 1},
      {"input = 'DI17'\nset = 0\n", Kind::Input, "DI17", 15, 0},
      {"input = 'DI03'\nset = true\n", Kind::Input, "DI03", 3, 1},
      {"input = 'DI03'\nset = false\n", Kind::Input, "DI03", 3, 0},
      {"analog = 'AI1'\nset = '5 V'\n", Kind::Input, "AI1", 16, 5'000},
      {"analog = 'AI1'\nset = '5 mA'\n", Kind::Input, "AI1", 17, 5'000},
      {"analog = 'AI2'\nset = '-1 V'\n", Kind::Input, "AI2", 18, -1'000},
      {"analog = 'frequency'\nset = '5 kHz'\n", Kind::Input, "frequency", 20, 5'000},
      {"analog = 'potentiometer'\nset = '5 %'\n", Kind::Input, "potentiometer", 21, 50},
      {"switch = 'mains'\nset = 0\n", Kind::Switch, "mains", 0, 0},
      {"mains = 'off'\n", Kind::Switch, "mains", 0, 0},
      {"mains = 'on'\n", Kind::Switch, "mains", 0, 1},
  };
  for (const auto& row : rows) {
    const Stimulus found = first_stimulus(row.text);
    EXPECT_EQ(std::tuple(found.signal.station, found.signal.kind, found.signal.name, found.signal.line,
                         found.value),
              std::tuple("u", row.kind, row.name, row.line, row.value))
        << row.text;
  }
}

TEST(PlantFileSurroundings, ActionsAndTimesOfStimuli) {
  using Action = Stimulus::Action;
  const Stimulus once = first_stimulus("variable = 'x'\nset = 7\n");
  EXPECT_EQ(
      std::tuple(once.action, once.value, once.at, once.length, once.every, once.times, once.place.line),
      std::tuple(Action::Set, 7, kMillisecond, 0, 0, 0, 4U));
  const Stimulus pulse = first_stimulus("variable = 'x'\npulse = 7\nfor = '1ms'\nevery = '1ms'\ntimes = 1\n");
  EXPECT_EQ(std::tuple(pulse.action, pulse.value, pulse.length, pulse.every, pulse.times),
            std::tuple(Action::Pulse, 7, kMillisecond, kMillisecond, 1));
  const Stimulus force = first_stimulus("variable = 'x'\nforce = 7\nevery = '3ms'\ntimes = 2147483647\n");
  EXPECT_EQ(std::tuple(force.action, force.value, force.length, force.every, force.times),
            std::tuple(Action::Force, 7, 0, 3 * kMillisecond, INT32_MAX));
  EXPECT_EQ(first_stimulus("variable = 'x'\nforce = 7\nfor = '2ms'\n").length, 2 * kMillisecond);
  EXPECT_EQ(first_stimulus("variable = 'x'\nforce = 7\nfor = '2ms'\n").times, 0);
  EXPECT_EQ(first_stimulus("analog = 'AI2'\nrelease = true\n").action, Action::Release);
  EXPECT_EQ(first_stimulus("analog = 'AI2'\nrelease = true\n").signal.line, 18);
}

TEST(PlantFileSurroundings, MistakesOfStimuli) {
  expect_mistakes(kDrivenUnit + kStimulusHead,
                  {
                      {"variable = 'x'\nset = 1\n^state = 'fault'\n", "unknown key 'state' in [[stimulus]]"},
                      {"variable = 'x'\nset = ^'1'\n", "set must be a whole number"},
                      {"variable = 'x'\npulse = ^1.5\nfor = '1ms'\n", "pulse must be a whole number"},
                      {"variable = ^5\nset = 1\n", "variable must be a text in quotes"},
                      {"mains = ^0\n", "mains must be a text in quotes"},
                      {"mains = ^'up'\n", "unknown mains 'up'; known are off, on"},
                      {"mains = 'off'\nset = ^1\n", "a [[stimulus]] has either mains or set"},
                      {"mains = ^'off'\nswitch = 's13'\n", "a [[stimulus]] has either switch or mains"},
                      {"parameter = 'P130'\nset = ^'1 rpm'\n", "P130"},
                      {"parameter = 'P130'\nset = ^true\n", "P130 must be a whole number"},
                      {"input = ^'DI18'\nset = 1\n", "'DI18' is no input"},
                      {"input = 'DI00'\nset = ^2\n", "DI00 is 0 or 1"},
                      {"input = 'DI00'\nset = ^-1\n", "DI00 is 0 or 1"},
                      {"input = 'DI00'\nset = ^'1'\n", "set must be a whole number"},
                      {"analog = ^'DI00'\nset = 1\n", "'DI00' is no analog"},
                      {"analog = 'AI1'\nset = ^5\n", "AI1 needs a text such as"},
                      {"analog = 'potentiometer'\nforce = ^'101 %'\n", "potentiometer needs a text such as"},
                      {"input = 'DI00'\nvariable = 'x'\nparameter = ^'P130'\nset = 1\n",
                       "a [[stimulus]] has either variable or parameter"},
                  });
}

TEST(PlantFileSurroundings, MistakesOfActionsAndTimes) {
  const std::string begin = kDrivenUnit + kStimulusHead + "variable = 'x'\n";
  expect_mistakes(begin, {
                             {"set = 1\nforce = ^1\n", "a [[stimulus]] has either set or force"},
                             {"force = 1\nrelease = ^true\n", "a [[stimulus]] has either force or release"},
                             {"release = ^false\n", "write release = true"},
                             {"set = 1\nfor = ^'1ms'\n", "only force and pulse have a length (for)"},
                             {"release = true\nfor = ^'1ms'\n", "only force and pulse have a length (for)"},
                             {"force = 1\nfor = ^'999us'\n", "the length (for) is less than a millisecond"},
                             {"pulse = 1\nfor = ^'0ms'\n", "the length (for) is less than a millisecond"},
                             {"set = 1\nevery = ^'999us'\n", "every is less than a millisecond"},
                             {"set = 1\ntimes = ^2\n", "times needs every"},
                             {"set = 1\nevery = '1ms'\ntimes = ^0\n", "times is 1 or more"},
                             {"set = 1\nevery = '1ms'\ntimes = ^-1\n", "times is 1 or more"},
                             {"set = 1\nevery = '1ms'\ntimes = ^'2'\n", "times must be a whole number"},
                         });
  expect_mistakes(
      kDrivenUnit,
      {{"^" + kStimulusHead + "variable = 'x'\n", "a [[stimulus]] needs set, force, pulse or release"},
       {"^" + kStimulusHead + "variable = 'x'\npulse = 1\n", "a pulse needs for"},
       {"^" + kStimulusHead + "set = 1\n", "a [[stimulus]] needs one of variable, parameter, input, analog"},
       {kStimulusHead + "signal = 'load_torque'\nset = ^true\n", "set of a signal is a number, or a text with its unit"},
       {"^[[stimulus]]\nat = '1ms'\nvariable = 'x'\nset = 1\n", "a [[stimulus]] needs station"},
       {"^[[stimulus]]\nstation = 'u'\nvariable = 'x'\nset = 1\n", "a [[stimulus]] needs at"},
       {"[[stimulus]]\nstation = ^'v'\nat = '1ms'\nvariable = 'x'\nset = 1\n", "there is no station 'v'"}});
}

TEST(PlantFileSurroundings, WiresAndSwitches) {
  const PlantFile plant = read_plant(R"([[station]]
name = 'a.b'
unit = 'mdxb'
[[station]]
name = 'u'
unit = 'mdxb'
[[wire]]
from = 'a.b.DO17'
to = 'u.DI17'
invert = true
[[wire]]
from = 'u.DB00'
to = 'a.b.DI00'
[[switch]]
station = 'u'
input = 'DI10'
from = -100000
[[switch]]
station = 'u'
input = 'DI11'
to = 250000
active = 'low'
[[switch]]
station = 'u'
input = 'DI12'
from = 5
to = 5
active = 'high'
)");
  ASSERT_EQ(plant.wires.size(), 2U);
  const Wire& wire = plant.wires[0];
  EXPECT_EQ(std::tuple(wire.from.station, wire.from.name, wire.from.kind, wire.from.line),
            std::tuple("a.b", "DO17", SignalKind::Output, 15));
  EXPECT_EQ(
      std::tuple(wire.to.station, wire.to.name, wire.to.kind, wire.to.line, wire.invert, wire.place.line),
      std::tuple("u", "DI17", SignalKind::Input, 15, true, 7U));
  EXPECT_EQ(std::tuple(plant.wires[1].from.station, plant.wires[1].from.line, plant.wires[1].invert),
            std::tuple("u", 0, false));
  ASSERT_EQ(plant.switches.size(), 3U);
  const auto is = [&](size_t n, int line, int32_t from, int32_t to, bool high) {
    const PositionSwitch& found = plant.switches[n];
    EXPECT_EQ(std::tuple(found.input.station, found.input.line, found.from, found.to, found.active_high),
              std::tuple("u", line, from, to, high));
  };
  is(0, 8, -100'000, INT32_MAX, true);
  is(1, 9, INT32_MIN, 250'000, false);
  is(2, 10, 5, 5, true);
  EXPECT_EQ(plant.switches[1].place.line, 18U);
}

TEST(PlantFileSurroundings, MistakesOfWiresAndSwitches) {
  const std::string wire = "[[wire]]\nfrom = 'u.DO01'\nto = 'u.DI00'\n";
  const std::string cam = "[[switch]]\nstation = 'u'\ninput = 'DI00'\n";
  expect_mistakes(kDrivenUnit,
                  {
                      {wire + "^station = 'u'\n", "unknown key 'station' in [[wire]]"},
                      {wire + "invert = ^1\n", "invert is true or false"},
                      {"^[[wire]]\nto = 'u.DI00'\n", "a [[wire]] needs from"},
                      {"^[[wire]]\nfrom = 'u.DO01'\n", "a [[wire]] needs to"},
                      {"[[wire]]\nfrom = ^'DO01'\nto = 'u.DI00'\n",
                       "'DO01' is no output of a station; write for example \"unit1.DO01\""},
                      {"[[wire]]\nfrom = ^'.DO01'\nto = 'u.DI00'\n", "'.DO01' is no output of a station"},
                      {"[[wire]]\nfrom = ^'u.DO06'\nto = 'u.DI00'\n", "'u.DO06' is no output of a station"},
                      {"[[wire]]\nfrom = 'u.DO01'\nto = ^'u.DO01'\n",
                       "'u.DO01' is no input of a station; write for example \"unit1.DI03\""},
                      {"[[wire]]\nfrom = 'u.DO01'\nto = ^'v.DI00'\n", "there is no station 'v'"},
                      {wire + "^" + wire, "DI00 of u has a wire or switch already"},
                      {wire + "^" + cam + "from = 1\n", "DI00 of u has a wire or switch already"},
                      {cam + "from = 1\n^" + cam + "from = 1\n", "DI00 of u has a wire or switch already"},
                      {wire + "^" + kStimulusHead + "input = 'DI00'\nset = 1\n",
                       "DI00 of u hangs on a wire or switch: force it"},
                      {"^" + cam, "a [[switch]] needs from, to or both, in increments"},
                      {cam + "from = 2\nto = ^1\n", "to is below from"},
                      {cam + "from = ^'2'\n", "from must be a whole number"},
                      {cam + "to = ^2.5\n", "to must be a whole number"},
                      {cam + "from = 1\nactive = ^'on'\n", "active is \"high\" or \"low\""},
                      {cam + "from = 1\n^invert = true\n", "unknown key 'invert' in [[switch]]"},
                      {"^[[switch]]\nstation = 'u'\nfrom = 1\n", "a [[switch]] needs one of input"},
                      {"[[switch]]\nstation = 'u'\ninput = ^'AI1'\nfrom = 1\n", "'AI1' is no input"},
                      {"^[[switch]]\ninput = 'DI00'\nfrom = 1\n", "a [[switch]] needs station"},
                  });
  // What is driven can be forced; other inputs, other stations and other signals are free.
  const std::string other = "[[station]]\nname = 'v'\nunit = 'mdxb'\n";
  read_plant(kDrivenUnit + other + wire +
             "[[wire]]\nfrom = 'u.DO01'\nto = 'v.DI00'\n[[wire]]\nfrom = 'u.DO01'\nto = 'u.DI01'\n" +
             kStimulusHead + "input = 'DI00'\nforce = 1\n" + kStimulusHead +
             "input = 'DI00'\nrelease = true\n" + kStimulusHead + "input = 'DI02'\nset = 1\n" +
             kStimulusHead + "variable = 'H0'\nset = 1\n");
}

TEST(PlantFileSurroundings, Expectations) {
  using Kind = SignalKind;
  const struct {
    const char* text;
    Kind kind;
    const char* name;
    int line;
    int32_t equals;
  } rows[] = {
      {"variable = 'x'\nequals = 0x44332211\n", Kind::Variable, "x", 0, 0x44332211},
      {"parameter = 'P884'\nequals = '500 kBaud'\n", Kind::Parameter, "P884", 0, 2},
      {"parameter = 'P884'\nequals = 3\n", Kind::Parameter, "P884", 0, 3},
      {"input = 'DI17'\nequals = 1\n", Kind::Input, "DI17", 15, 1},
      {"output = 'DO17'\nequals = 1\n", Kind::Output, "DO17", 15, 1},
      {"output = 'DB00'\nequals = -1\n", Kind::Output, "DB00", 0, -1},
      {"state = 'fault'\nequals = 8\n", Kind::State, "fault", 0, 8},
      {"state = 'program_fault'\nequals = 8\n", Kind::State, "program_fault", 9, 8},
      {"signal = 'u.x'\nequals = 8\n", Kind::Any, "u.x", 0, 8},
  };
  for (const auto& row : rows) {
    const Expectation found = first_expectation(row.text);
    EXPECT_EQ(std::tuple(found.signal.station, found.signal.kind, found.signal.name, found.signal.line,
                         found.equals),
              std::tuple("u", row.kind, row.name, row.line, row.equals))
        << row.text;
    EXPECT_EQ(std::pair(found.at, found.place.line), std::pair(kMillisecond, 4U));
  }
}

TEST(PlantFileSurroundings, MistakesOfExpectations) {
  expect_mistakes(
      kDrivenUnit + kExpectHead,
      {
          {"variable = 'x'\nequals = ^'1'\n", "equals must be a whole number"},
          {"parameter = 'P130'\nequals = ^'1 rpm'\n", "P130"},
          {"input = ^'DI18'\nequals = 1\n", "'DI18' is no input"},
          {"output = ^'DO06'\nequals = 1\n", "'DO06' is no output"},
          {"state = ^'fine'\nequals = 1\n", "'fine' is no state; known are fault, status, enabled"},
          {"variable = 'x'\nequals = 1\n^analog = 'AI1'\n", "unknown key 'analog' in [[expect]]"},
          {"variable = 'x'\nstate = ^'fault'\nequals = 1\n", "an [[expect]] has either variable or state"},
          {"variable = ^''\nequals = 1\n", "variable must not be empty"},
      });
  expect_mistakes(
      kDrivenUnit,
      {{"^" + kExpectHead + "variable = 'x'\n", "an [[expect]] needs equals"},
       {"^" + kExpectHead + "equals = 1\n", "an [[expect]] needs one of variable, parameter, input, output"},
       {"^[[expect]]\nat = '1ms'\nvariable = 'x'\nequals = 1\n", "an [[expect]] needs station"},
       {"^[[expect]]\nstation = 'u'\nvariable = 'x'\nequals = 1\n", "an [[expect]] needs at"},
       {"[[expect]]\nstation = ^'v'\nat = '1ms'\nvariable = 'x'\nequals = 1\n", "there is no station 'v'"}});
}

}  // namespace
}  // namespace ipos::runtime

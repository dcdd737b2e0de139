// Functions of the drive by the parameter list of 1053 1610 (chapter 7.2): terminals, analog inputs, parameters and words of a user, speeds
// and outputs that a user sees.
#include "tests/harness/proves.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kBareRotor = "[station.load]\ninertia = 0\nfriction = 0\n";

class Mdx {
 public:
  // No times of premagnetizing and brake, no least speed, no filter of AI1 unless the test has one.
  explicit Mdx(const std::string& parameters, const std::string& load = kBareRotor,
               const std::string& inputs = kEnabled, const std::string& program = "")
      : talk(can_bus() + serial_bus() +
                 unit_on(std::string("sbus = \"sbus\"\nrs485 = \"line\"\n") +
                             (program.empty() ? "" : "program = \"P.IPC\"\n"),
                         "u", "md60a",
                         "P813 = 1\nP810 = 1\nP301 = 0\nP323 = 0\nP731 = 0\nP732 = 0\n" +
                             std::string(parameters.find("P115") == std::string::npos ? "P115 = 0\n" : "") +
                             parameters,
                         inputs + load),
             program) {
    talk.pass(5 * kMs);
  }
  void text(const char* name, const std::string& to) const {
    uint32_t signal = UINT32_MAX;
    EXPECT_EQ(ipos_plant_find(talk.plant(), 0, IPOS_PLANT_ANY, name, &signal), IPOS_PLANT_OK)
        << talk.opened().message();
    EXPECT_EQ(ipos_plant_write_text(talk.plant(), signal, to.c_str()), IPOS_PLANT_OK)
        << talk.opened().message();
  }
  void volts(const char* input, double volt) const { text(input, std::to_string(volt) + " V"); }
  // The shaft of a plant that has it driven from outside.
  void turn(double rpm) const { text("shaft_speed", std::to_string(rpm) + " rpm"); }
  double rpm() const { return static_cast<double>(talk.value("u", "P000")) / 1000; }
  double settled() const {
    talk.pass(4000 * kMs);
    return rpm();
  }
  bool output(const char* name) const { return talk.value("u", name) != 0; }
  int fault() const { return static_cast<int>(talk.value("u", "fault")); }
  int status() const { return static_cast<int>(talk.value("u", "PI1")); }
  // Words of a master every 10 ms for a time.
  void words(int po1, int po2, int64_t ms = 10) {
    for (int64_t passed = 0; passed < ms; passed += 10)
      talk.ask("11 # " + word_text(po1) + " " + word_text(po2) + " 00 00", 10 * kMs);
  }
  template <typename Holds>
  int ms_until(Holds holds, int limit = 3000) const {
    int ms = 0;
    for (; ms <= limit && !holds(); ++ms) talk.pass(kMs);
    return ms;
  }
  // How long an output takes to change after a step; -1: it does not within two seconds.
  template <typename Step>
  int ms_of_change(const char* name, Step step) const {
    talk.pass(2000 * kMs);
    const bool before = output(name);
    step();
    const int ms = ms_until([&] { return output(name) != before; }, 2000);
    return ms > 2000 ? -1 : ms;
  }
  Talk talk;
};

constexpr const char* kDriven = "[station.load]\ndriven = true\n";

TEST(DriveRows, SpeedReference) {
  PROVES("DRV-01");
  for (const int delay : {0, 500})
    for (const int when : {0, 1}) {
      const Mdx drive("P621 = 9\nP400 = 1000000\nP401 = 100000\nP402 = " + std::to_string(delay) +
                          "\nP403 = " + std::to_string(when) + "\n",
                      kDriven);
      const auto change = [&](double rpm) { return drive.ms_of_change("DO02", [&] { drive.turn(rpm); }); };
      const bool above = when == 1;
      EXPECT_EQ(drive.output("DO02"), !above);
      EXPECT_EQ(change(999.8), -1) << "not above";
      EXPECT_NEAR(change(1000.4), delay, 4) << "above";
      EXPECT_EQ(drive.output("DO02"), above);
      EXPECT_EQ(change(900.4), -1) << "inside the hysteresis";
      EXPECT_NEAR(change(899.6), delay, 4) << "below it";
      EXPECT_EQ(change(-950), -1);
      EXPECT_NEAR(change(-1000.4), delay, 4) << "counter-clockwise";
    }
}

TEST(DriveRows, SpeedWindow) {
  PROVES("DRV-02");
  for (const int when : {0, 1}) {
    const Mdx drive(
        "P621 = 10\nP410 = 1000000\nP411 = 200000\nP412 = 300\nP413 = " + std::to_string(when) + "\n",
        kDriven);
    const auto change = [&](double rpm) { return drive.ms_of_change("DO02", [&] { drive.turn(rpm); }); };
    const bool inside = when == 0;
    EXPECT_EQ(drive.output("DO02"), !inside);
    EXPECT_EQ(change(899.4), -1) << "below";
    EXPECT_NEAR(change(900.6), 300, 4) << "lower edge";
    EXPECT_EQ(drive.output("DO02"), inside);
    EXPECT_EQ(change(1099.4), -1);
    EXPECT_NEAR(change(1100.6), 300, 4) << "above";
    EXPECT_NEAR(change(-1000), 300, 4) << "counter-clockwise";
  }
}

TEST(DriveRows, SetpointReached) {
  PROVES("DRV-03");
  for (const int when : {0, 1}) {
    const Mdx drive("P621 = 11\nP420 = 50000\nP421 = 200\nP422 = " + std::to_string(when) +
                        "\nP100 = 0\nP302 = 3000000\nP112 = 0\nP500 = 0\nP130 = 0\nP131 = 0\n",
                    kDriven);
    drive.volts("AI1", 10.0 / 3);  // of 3000 rpm
    const auto change = [&](double rpm) { return drive.ms_of_change("DO02", [&] { drive.turn(rpm); }); };
    const bool reached = when == 1;
    drive.talk.pass(2000 * kMs);
    EXPECT_EQ(drive.output("DO02"), !reached) << "it stands";
    EXPECT_NEAR(change(951), 200, 4) << "within";
    EXPECT_EQ(drive.output("DO02"), reached);
    EXPECT_EQ(change(1049), -1);
    EXPECT_NEAR(change(-1000), 200, 4) << "the other direction is no match";
  }
}

TEST(DriveRows, CurrentReference) {
  PROVES("DRV-04");
  // The ideal motor of 1.5 kW has some 10 Nm: rated torque makes 100 % of current, none leaves the 60 % that magnetize.
  for (const int when : {0, 1}) {
    const Mdx drive("P621 = 12\nP430 = 80000\nP431 = 5000\nP432 = 400\nP433 = " + std::to_string(when) +
                        "\nP100 = 0\nP500 = 0\n",
                    "[station.load]\ninertia = 0\nfriction = 0\n");
    drive.volts("AI1", 5);
    drive.talk.pass(3000 * kMs);
    const auto current = [&] { return static_cast<double>(drive.talk.value("u", "P004")) / 1000; };
    const auto change = [&](double newton_metres) {
      return drive.ms_of_change("DO02",
                                [&] { drive.text("load_torque", std::to_string(newton_metres) + " Nm"); });
    };
    const bool above = when == 1;
    EXPECT_EQ(drive.output("DO02"), !above);
    EXPECT_NEAR(change(9), 400, 6);
    EXPECT_GT(current(), 80);
    EXPECT_EQ(drive.output("DO02"), above);
    EXPECT_NEAR(change(1), 400, 6);
    EXPECT_LT(current(), 75);
    EXPECT_EQ(drive.output("DO02"), !above);
  }
}

// P620, P621, P630 to P637: each code follows what it names, those with a slash the other way round.
TEST(DriveRows, CodesOfTheOutputs) {
  PROVES("DRV-06");
  const auto levels = [](const Mdx& drive, int count) {
    std::string text;
    for (int n = 0; n < count; ++n) text += drive.output(("DO1" + std::to_string(n)).c_str()) ? '1' : '0';
    return text;
  };
  // /ERROR, READY, OUTP. STAGE ON, ROT. FIELD ON, BRAKE RELEASED, BRAKE APPLIED, MOTOR STANDSTILL, PARAMETER SET.
  Mdx states(
      "P100 = 0\nP604 = 7\nP630 = 1\nP631 = 2\nP632 = 3\nP633 = 4\nP634 = 5\nP635 = 6\nP636 = 7\nP637 = 8\n",
      kBareRotor, "[station.inputs]\nDI01 = 1\n");
  EXPECT_EQ(levels(states, 8), "11000110") << "inhibited";
  states.talk.set("u", "DI05", 1);
  states.talk.pass(100 * kMs);
  EXPECT_EQ(levels(states, 8), "11000111") << "the second parameter set";
  states.talk.set("u", "DI05", 0);
  states.talk.set("u", "DI00", 1);
  states.talk.set("u", "DI03", 1);
  states.volts("AI1", 5);
  states.talk.pass(3000 * kMs);
  EXPECT_EQ(levels(states, 8), "11111000") << "it turns";
  EXPECT_EQ(ipos_plant_drive_fault(states.talk.plant(), 0, 1), IPOS_PLANT_OK);
  states.talk.pass(3000 * kMs);
  EXPECT_EQ(levels(states, 8).substr(0, 6), "000001") << "error";
  // No function, and those of a DRS card whose master is not there, at their quiet level.
  const Mdx quiet("P630 = 0\nP631 = 16\nP632 = 17\nP633 = 18\n");
  EXPECT_EQ(levels(quiet, 4), "0110");
  // Motor utilization of each parameter set.
  for (const bool second : {false, true}) {
    const Mdx hot("P604 = 7\nP100 = 0\nP500 = 0\nP502 = 0\nP311 = 0\nP630 = 14\nP631 = 15\n",
                  "[station.load]\ninertia = 0\nfriction = 0\ntorque = 120\n",
                  std::string(kEnabled) + (second ? "DI05 = 1\n" : ""));
    hot.volts("AI1", 5);
    hot.talk.pass(1000 * kMs);
    EXPECT_EQ(levels(hot, 2), "11");
    for (int minutes = 0; minutes < 600 && hot.talk.value("u", second ? "P007" : "P006") < 105'000;
         minutes += 5)
      hot.talk.pass(300'000 * kMs);
    EXPECT_GE(hot.talk.value("u", second ? "P007" : "P006"), 105'000);
    EXPECT_EQ(hot.fault(), 0);
    EXPECT_EQ(levels(hot, 2), second ? "10" : "01");
  }
  // IPOS IN POSITION, IPOS REFERENCE, IPOS OUTPUT, /IPOS ERROR. Reference travel type 5 makes the place where it stands the reference.
  const Mdx ipos("P700 = 13\nP100 = 0\nP903 = 5\nP630 = 19\nP631 = 20\nP632 = 21\nP633 = 22\n", kBareRotor,
                 kEnabled,
                 "#include <const.h>\nlong lOrder, lGone, lZero;\nmain() { while (1) {\n if (lOrder == 1) { "
                 "_Go0(GO0_C_W_ZP); lOrder = 0; }\n"
                 " if (lOrder == 2) { _GoAbs(GO_NOWAIT, 40960); lOrder = 0; }\n if (lOrder == 3) { "
                 "OptOutpIPOS = 4; lOrder = 0; }\n"
                 " if (lOrder == 4) { lGone = lGone / lZero; } } }\n");
  ipos.talk.pass(100 * kMs);
  EXPECT_EQ(levels(ipos, 4).substr(1), "001") << "not referenced";
  const auto order = [&](int number, int ms) {
    ipos.talk.set("u", "lOrder", number);
    ipos.talk.pass(ms * kMs);
  };
  order(1, 1000);
  EXPECT_EQ(levels(ipos, 4).substr(1), "101") << "referenced";
  order(2, 50);
  EXPECT_EQ(levels(ipos, 4).substr(0, 2), "01") << "on its way";
  order(0, 20'000);
  EXPECT_EQ(levels(ipos, 4), "1101") << "there";
  order(3, 50);
  EXPECT_EQ(levels(ipos, 4), "1111") << "the program has set DO12";
  order(4, 100);
  EXPECT_EQ(levels(ipos, 4)[3], '0') << "F10";
}

TEST(DriveRows, ModesOfAi1) {
  PROVES("DRV-11");
  const auto at = [](int mode, const std::string& signal) {
    const Mdx drive("P100 = 0\nP302 = 2000000\nP112 = " + std::to_string(mode) +
                    "\nP113 = 2000\nP114 = 400000\n");
    drive.text("AI1", signal);
    return drive.settled();
  };
  EXPECT_NEAR(at(0, "5 V"), 1500, 0.3) << "10 V are 3000 rpm";
  EXPECT_NEAR(at(1, "5 V"), 1000, 0.3) << "10 V are P302";
  EXPECT_NEAR(at(2, "2 V"), 0, 0.3) << "begins at P113";
  EXPECT_NEAR(at(2, "6 V"), 1000, 0.3);
  EXPECT_NEAR(at(3, "0 V"), 400, 0.3) << "begins at P114";
  EXPECT_NEAR(at(3, "5 V"), 1200, 0.3);
  EXPECT_NEAR(at(4, "2 V"), 400, 0.3);
  EXPECT_NEAR(at(4, "6 V"), 1200, 0.3);
  EXPECT_NEAR(at(5, "15 mA"), 1500, 0.3) << "0 to 20 mA";
  EXPECT_NEAR(at(6, "8 mA"), 500, 0.3) << "4 to 20 mA";
  // Offset, then scaling.
  for (const auto& [scaling, rpm] : {std::pair{1000, 300}, {500, 150}}) {
    const Mdx drive("P100 = 0\nP111 = 100\nP110 = " + std::to_string(scaling) + "\n");
    drive.volts("AI1", 1.9);
    EXPECT_NEAR(drive.settled(), rpm, 0.3) << scaling;
  }
  // Filter of first order: 63.2 % of the step after its time. Without ramp the drive has followed a few ms later.
  const Mdx filtered("P100 = 0\nP130 = 0\nP115 = 50000\n");
  filtered.volts("AI1", 1);
  EXPECT_NEAR(filtered.settled(), 150, 0.3);
  filtered.volts("AI1", 10);
  const int ms = filtered.ms_until([&] { return filtered.rpm() >= 150 + 0.632 * 1350; });
  EXPECT_NEAR(ms, 50, 20);
}

TEST(DriveRows, SecondAnalogInput) {
  PROVES("DRV-12");
  for (const auto& [p120, ai2, rpm] : {std::tuple{0, 1.0, 300}, {1, 1.0, 450}, {1, -4.0, -300}}) {
    const Mdx drive("P100 = 0\nP120 = " + std::to_string(p120) + "\n");
    drive.volts("AI1", 2);
    drive.volts("AI2", ai2);
    EXPECT_NEAR(drive.settled(), rpm, 0.3) << p120;
  }
  // P120 = 2: 0..10 V are 0..P303. 72.1 % of current make 50 % torque: 1500 rpm of the bare rotor in 100 ms.
  const Mdx limited("P100 = 0\nP130 = 0\nP303 = 144000\nP120 = 2\n");
  limited.volts("AI2", 5.007);
  limited.talk.pass(500 * kMs);
  limited.volts("AI1", 10);
  EXPECT_NEAR(limited.ms_until([&] { return limited.rpm() >= 1499.8; }), 100, 5);
}

TEST(DriveRows, StopFunctionOfBothSets) {
  PROVES("DRV-13");
  for (const bool second : {false, true}) {
    const std::string of_set =
        second ? "P723 = 1\nP724 = 100000\nP725 = 50000\n" : "P720 = 1\nP721 = 100000\nP722 = 50000\n";
    Mdx drive("P604 = 7\nP311 = 0\nP100 = 10\n" + of_set, kBareRotor,
              std::string(kEnabled) + (second ? "DI05 = 1\n" : ""));
    for (const auto& [rpm, runs] :
         {std::pair{160, true}, {101, true}, {99, false}, {149, false}, {-151, true}}) {
      drive.words(0, static_cast<uint16_t>(rpm * 5), 1500);
      EXPECT_EQ(drive.rpm() != 0, runs) << second << ' ' << rpm;
    }
  }
}

TEST(DriveRows, SkipWindow) {
  PROVES("DRV-14");
  Mdx drive("P100 = 10\nP101 = 3\nP740 = 600000\nP741 = 200000\n");
  for (const auto& [sent, want] : {std::pair{499, 499},
                                   {500, 500},
                                   {501, 500},
                                   {599, 500},
                                   {600, 700},
                                   {699, 700},
                                   {700, 700},
                                   {701, 701},
                                   {-550, -500},
                                   {-650, -700}}) {
    drive.words(6, static_cast<uint16_t>(sent * 5), 2000);
    EXPECT_NEAR(drive.rpm(), want, 0.3) << sent;
  }
}

TEST(DriveRows, ChangeOfDirection) {
  PROVES("DRV-15");
  Mdx drive("P100 = 10\nP101 = 3\nP350 = 1\n");
  drive.words(6, 5000, 2000);
  EXPECT_NEAR(drive.rpm(), 1000, 0.3) << "shown as it was ordered";
  uint32_t shaft = UINT32_MAX;
  ASSERT_EQ(ipos_plant_find(drive.talk.plant(), 0, IPOS_PLANT_SIGNAL, "shaft_speed", &shaft), IPOS_PLANT_OK);
  EXPECT_NEAR(std::stod(drive.talk.opened().text(shaft)), -1000, 1) << "the shaft turns the other way";
  // P350 over SBus: under controller inhibit only.
  EXPECT_EQ(drive.talk.ask("523 # 33 00 21 59 00 00 00 00"), Texts{"524 # B3 00 21 59 08 00 00 1C"});
}

TEST(DriveRows, SpeedMonitoring) {
  PROVES("DRV-16");
  for (const bool dragged : {false, true})
    for (int mode = 0; mode <= 3; ++mode) {
      const Mdx drive("P100 = 0\nP130 = 100\nP501 = 200\nP500 = " + std::to_string(mode) + "\n",
                      std::string("[station.load]\ninertia = 0\n") +
                          (dragged ? "friction = 0\ntorque = 200\n" : "friction = 200\n"));
      drive.volts("AI1", 10);
      const int ms = drive.ms_until([&] { return drive.fault() == 8; }, 500);
      const bool trips = mode == 3 || mode == (dragged ? 2 : 1);
      EXPECT_EQ(ms <= 500, trips) << mode << dragged;
      if (trips) {
        EXPECT_NEAR(ms, 201, 10) << mode << dragged;
      }
    }
}

// Stop times from 1000 rpm: P137 and P136 are for 3000 rpm.
constexpr int kEmergencyMs = 300, kRapidMs = 600;

TEST(DriveRows, EightResponses) {
  PROVES("DRV-17");
  struct Cause {
    const char* name;
    int number;
    const char* parameter;
  };
  for (const Cause& cause :
       {Cause{"external fault", 26, "P830"}, {"RS-485 timeout", 43, "P833"}, {"SBus timeout", 47, "P836"}})
    for (int response = 0; response <= 7; ++response) {
      SCOPED_TRACE(std::string(cause.name) + ", response " + std::to_string(response));
      const bool external = cause.number == 26, serial = cause.number == 43;
      Mdx drive(
          std::string(serial ? "P100 = 2\nP101 = 1\nP812 = 200\n" : "P100 = 10\nP101 = 3\nP815 = 100\n") +
              "P603 = 11\nP604 = 12\nP136 = " + std::to_string(kRapidMs) + "\nP137 = " +
              std::to_string(kEmergencyMs) + "\n" + cause.parameter + " = " + std::to_string(response) + "\n",
          kBareRotor, std::string(kEnabled) + "DI04 = 1\n");
      const auto control = [&](int64_t ms) {
        if (!serial) return drive.words(6, 5000, ms);
        for (int64_t passed = 0; passed < ms; passed += 90)
          drive.talk.serial_ask("02 01 05 00 06 13 88 00 00");
      };
      control(2500);
      ASSERT_NEAR(drive.rpm(), 1000, 0.3);
      if (external) drive.talk.set("u", "DI04", 0);
      const bool shown = response != 0;
      int ms = 0;
      for (; ms < 300 && drive.fault() == 0; ++ms) {
        if (external && ms % 10 == 0)
          drive.words(6, 5000);
        else
          drive.talk.pass(kMs);
      }
      EXPECT_EQ(drive.fault(), shown ? cause.number : 0);
      const bool error = response >= 2 && response <= 4;
      EXPECT_EQ((drive.status() & 0x20) != 0, shown);
      EXPECT_EQ((drive.status() & 0x02) != 0, !error) << "ready";
      EXPECT_EQ(drive.status() >> 8, shown ? cause.number : 4);
      const bool immediate = response == 2 || response == 5, emergency = response == 3 || response == 6,
                 rapid = response == 4 || response == 7;
      if (immediate) {
        drive.talk.pass(2 * kMs);
        EXPECT_EQ(drive.status() & 1, 0) << "the output stage is off";
      }
      if (emergency || rapid) {
        const int want = (emergency ? kEmergencyMs : kRapidMs) / 3;
        int stop = 0;
        for (; stop <= 1000 && drive.rpm() != 0; stop += 10) {
          if (external)
            drive.words(6, 5000);
          else
            drive.talk.pass(10 * kMs);
        }
        EXPECT_NEAR(stop, want, 14);
      }
      if (!immediate && !emergency && !rapid) {
        EXPECT_NEAR(drive.rpm(), 1000, 0.3) << "it goes on";
      }
      // The cause goes: a warning ends by itself, an error by a reset.
      if (external) drive.talk.set("u", "DI04", 1);
      control(2500);
      EXPECT_EQ(drive.fault(), error || response == 1 ? cause.number : 0);
      EXPECT_NEAR(drive.rpm(), error ? 0 : 1000, 0.3);
      drive.talk.set("u", "DI05", 1);
      control(2500);
      EXPECT_EQ(drive.fault(), 0);
      EXPECT_NEAR(drive.rpm(), 1000, 0.3);
    }
}

TEST(DriveRows, AutoReset) {
  PROVES("DRV-18");
  const Mdx drive("P841 = 1\nP842 = 2000\n"), off("P842 = 2000\n");
  for (int n = 0; n < 3; ++n) {
    EXPECT_EQ(ipos_plant_drive_fault(drive.talk.plant(), 0, 1), IPOS_PLANT_OK);
    drive.talk.pass(kMs);
    EXPECT_EQ(drive.fault(), 1);
    EXPECT_NEAR(drive.ms_until([&] { return drive.fault() == 0; }), 2000, 3) << n;
    drive.talk.pass(1000 * kMs);
  }
  EXPECT_EQ(ipos_plant_drive_fault(off.talk.plant(), 0, 1), IPOS_PLANT_OK);
  off.talk.pass(60'000 * kMs);
  EXPECT_EQ(off.fault(), 1);
}

TEST(DriveRows, MotorProtection) {
  PROVES("DRV-19");
  for (int response = 0; response <= 7; ++response) {
    const Mdx drive("P100 = 0\nP500 = 0\nP832 = " + std::to_string(response) + "\n",
                    "[station.load]\ninertia = 0\nfriction = 0\ntorque = 120\n");
    drive.volts("AI1", 5);
    for (int minutes = 0; minutes < 600 && drive.talk.value("u", "P006") < 105'000; minutes += 5)
      drive.talk.pass(300'000 * kMs);
    ASSERT_GE(drive.talk.value("u", "P006"), 105'000) << "120 % of load heat the motor beyond its measure";
    EXPECT_EQ(drive.fault(), 0) << "P340 = OFF";
    drive.talk.set("u", "P340", 1);
    drive.talk.pass(2 * kMs);
    EXPECT_EQ(drive.fault(), response == 0 ? 0 : 84) << response;
    drive.talk.pass(1500 * kMs);
    EXPECT_EQ(drive.rpm() == 0, response >= 2) << response;
  }
}

}  // namespace
}  // namespace ipos::tests

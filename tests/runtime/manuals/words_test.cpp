// Process data words and status words of the manuals (MOVITRAC 07 chapters 6.1 to 6.4, 1053 1610 chapters 4.3 and 5): words sent over SBus
// or RS-485, what the drive does, and the words that come back.
#include "tests/harness/proves.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

// A drive that a bus controls, with its terminals closed. MOVITRAC 07 has no DI00.
class Bussed {
 public:
  explicit Bussed(const char* unit, const std::string& parameters = "", const std::string& more = kEnabled,
                  const char* most = "3000000")
      : talk(can_bus() +
             on_sbus("u", unit,
                     "P813 = 1\nP100 = 10\nP101 = 3\nP302 = " + std::string(most) + "\n" + parameters,
                     more)) {
    talk.pass(5 * kMs);
  }
  // Sends the words and gives the three that come back.
  std::vector<int> ask(int po1, int po2 = 0, int po3 = 0) {
    const Texts answers =
        talk.ask("11 # " + word_text(po1) + " " + word_text(po2) + " " + word_text(po3), 10 * kMs);
    EXPECT_EQ(answers.size(), 1U);
    if (answers.empty()) return {0, 0, 0};
    const Bytes bytes = bytes_of(answers[0].substr(5));
    return {bytes[0] << 8 | bytes[1], bytes[2] << 8 | bytes[3], bytes[4] << 8 | bytes[5]};
  }
  // The same again and again until the speed is reached.
  std::vector<int> settle(int po1, int po2 = 0, int po3 = 0) {
    for (int n = 0; n < 900; ++n) ask(po1, po2, po3);
    return ask(po1, po2, po3);
  }
  int64_t speed() const { return talk.value("u", "P000"); }  // 1/1000 rpm
  std::string text(const char* signal) const {
    uint32_t found = UINT32_MAX;
    EXPECT_EQ(ipos_plant_find(talk.plant(), 0, IPOS_PLANT_SIGNAL, signal, &found), IPOS_PLANT_OK)
        << talk.opened().message();
    return talk.opened().text(found);
  }
  Talk talk;
};

TEST(WordRows, SpeedsHave02RpmADigit) {
  PROVES("M07-PD-01", "M07-PD-02", "M07-PD-03", "PD-06");
  for (const char* unit : {"mc07", "md60a"}) {
    Bussed drive(unit, "P303 = 150000\n");
    for (const auto& [word, rpm1000] : {std::pair{5000, 1'000'000},
                                        {0x07D0, 400'000},
                                        {0xF15A, -750'000},
                                        {5011, 1'002'200},
                                        {15'000, 3'000'000}}) {
      const std::vector<int> pi = drive.settle(6, word);
      EXPECT_EQ(drive.speed(), rpm1000) << unit << ' ' << word;
      EXPECT_EQ(pi[1], word) << unit;
    }
    // The ends of the range, as who watches reads them.
    for (const auto& [word, text] :
         {std::pair{0x8000, "-6553.6 rpm"}, {0x7FFF, "6553.4 rpm"}, {1, "0.2 rpm"}, {0xFFFF, "-0.2 rpm"}}) {
      drive.ask(0, word);
      EXPECT_EQ(drive.text("PO2_value"), text) << unit;
    }
  }
  // A maximum speed is such a word, too: P872 = 5.
  Bussed limited("md60a", "P872 = 5\n");
  limited.settle(6, 5000, 15'000);
  EXPECT_EQ(limited.speed(), 1'000'000);
  limited.settle(6, 5000, 2500);
  EXPECT_EQ(limited.speed(), 500'000);
  // A shaft that is faster than a word can say: the word ends there and does not wrap.
  Bussed turned("mc07", "", "[station.load]\ndriven = true\n");
  for (const auto& [rpm, word] : {std::pair{7000.0, 0x7FFF}, {-7000.0, 0x8000}, {1000.0, 5000}}) {
    uint32_t shaft = UINT32_MAX;
    ASSERT_EQ(ipos_plant_find(turned.talk.plant(), 0, IPOS_PLANT_SHAFT, "shaft_speed", &shaft),
              IPOS_PLANT_OK);
    ASSERT_EQ(ipos_plant_write_text(turned.talk.plant(), shaft, (std::to_string(rpm) + " rpm").c_str()),
              IPOS_PLANT_OK)
        << turned.talk.opened().message();
    for (int n = 0; n < 50; ++n) turned.ask(0);
    EXPECT_EQ(turned.ask(0)[1], word) << rpm;
  }
}

TEST(WordRows, RelativeSpeeds) {
  PROVES("M07-PD-05", "M07-PD-06", "M07-PD-07");
  Bussed drive("mc07", "P871 = 11\nP874 = 8\n", kEnabled, "1500000");
  for (const auto& [word, rpm1000] :
       {std::pair{0x1000, 375'000}, {0xD000, -1'125'000}, {0x4000, 1'500'000}}) {
    const std::vector<int> pi = drive.settle(6, word);
    EXPECT_EQ(drive.speed(), rpm1000) << word;
    EXPECT_EQ(pi[1], word) << word;
  }
  const auto percent = [&](int word) {
    drive.ask(0, word);
    return std::stod(drive.text("PO2_value"));
  };
  EXPECT_DOUBLE_EQ(percent(0x1000), 25);
  EXPECT_DOUBLE_EQ(percent(0xD000), -75);
  EXPECT_DOUBLE_EQ(percent(0x4000), 100);
  EXPECT_DOUBLE_EQ(percent(0x8000), -200);
  EXPECT_NEAR(percent(0x7FFF), 199.9939, 0.006);
  EXPECT_NEAR(percent(1), 0.0061, 0.005);
}

TEST(WordRows, ControlWordEnables) {
  PROVES("PD-08");
  Bussed drive("md60a");
  for (const auto& [control, enabled] : {std::pair{0x0006, true}, {0x0000, false}, {0x0006, true}}) {
    for (int n = 0; n < 30; ++n) drive.ask(control);
    EXPECT_EQ((drive.ask(control)[0] & 1) != 0, enabled) << control;
    EXPECT_EQ(drive.ask(control)[0] >> 8, enabled ? 4 : 2) << control;
  }
}

TEST(WordRows, NoFunction) {
  PROVES("M07-PD-17");
  for (const char* unit : {"mc07", "md60a"}) {
    Bussed drive(unit, "P872 = 0\nP875 = 0\n");
    const std::vector<int> before = drive.settle(6, 5000);
    for (const int word : {0x0001, 0x0040, 0xFFFF}) {
      const std::vector<int> pi = drive.settle(6, 5000, word);
      EXPECT_EQ(pi, before) << unit << ' ' << word;
      EXPECT_EQ(drive.speed(), 1'000'000);
      EXPECT_EQ(pi[2], 0);
    }
  }
}

void raise(const Bussed& drive, uint8_t fault) {
  EXPECT_EQ(ipos_plant_drive_fault(drive.talk.plant(), 0, fault), IPOS_PLANT_OK);
  drive.talk.pass(5 * kMs);  // the output stage is off by then
}
void reset(const Bussed& drive) { EXPECT_EQ(ipos_plant_reset_fault(drive.talk.plant(), 0), IPOS_PLANT_OK); }

TEST(WordRows, FaultAndResetByBit6) {
  PROVES("M07-CW-05", "M07-SW-08");
  Bussed drive("mc07");
  drive.ask(0x46);  // bit 6 is 1 from before the fault
  raise(drive, 1);
  // Overcurrent: high octet 01, not ready, fault, PO data on.
  EXPECT_EQ(drive.ask(0x46)[0], 0x0124);
  EXPECT_EQ(drive.ask(0x46)[0], 0x0124);
  EXPECT_EQ(drive.ask(0x06)[0], 0x0124);
  drive.ask(0x46);
  EXPECT_EQ(drive.ask(0x46)[0] >> 8, 4) << "cleared once, and the state is back";
  raise(drive, 1);
  EXPECT_EQ(drive.ask(0x46)[0], 0x0124) << "the level does nothing more";
  EXPECT_EQ(drive.ask(0x46)[0], 0x0124);
  reset(drive);
  EXPECT_EQ(drive.ask(0x46)[0] & 0x22, 0x02);
}

TEST(WordRows, ReadyBit) {
  PROVES("M07-SW-02");
  for (const char* unit : {"mc07", "md60a"}) {
    Bussed drive(unit, "", "");
    EXPECT_NE(drive.ask(6)[0] & 2, 0) << unit;
    raise(drive, 1);
    EXPECT_EQ(drive.ask(6)[0] & 2, 0) << unit;
    reset(drive);
    EXPECT_NE(drive.ask(6)[0] & 2, 0) << unit;
    // P802 := 1, over SBus.
    EXPECT_EQ(drive.talk.ask("523 # 33 00 21 92 00 00 00 01"), Texts{"524 # 33 00 21 92 00 00 00 01"});
    EXPECT_EQ(drive.ask(6)[0] & ~4, unit == std::string("mc07") ? 0x0500 : 0x0800)
        << "state: factory setting; bit 2 is of the PO data";
    drive.talk.pass(5000 * kMs);
    EXPECT_NE(drive.talk.value("u", "P010") & 2, 0) << unit;
  }
}

TEST(WordRows, PoDataEnabledBit) {
  PROVES("M07-SW-03");
  for (const int p876 : {0, 1})
    for (const auto& [p100, p101] : {std::pair{1, 0}, {10, 0}, {1, 3}, {2, 1}, {10, 3}}) {
      Talk talk(can_bus() + on_sbus("u", "mc07",
                                    "P813 = 1\nP876 = " + std::to_string(p876) + "\nP100 = " +
                                        std::to_string(p100) + "\nP101 = " + std::to_string(p101) + "\n"));
      talk.pass(5 * kMs);
      const Texts answer = talk.ask("11 # 00 06 00 00 00 00");
      ASSERT_EQ(answer.size(), 1U);
      const int low = bytes_of(answer[0].substr(5))[1];
      EXPECT_EQ((low & 4) != 0, p876 == 1 && (p100 != 1 || p101 != 0)) << p876 << ' ' << p100 << ' ' << p101;
    }
}

// In all states that can be made here: inhibited, stopped, running, at a fault, at its factory setting.
TEST(WordRows, ReservedBitsAndIndex8310) {
  PROVES("M07-SW-05", "M07-SW-12", "PAR-28");
  for (const char* unit : {"mc07", "md60a"})
    for (const char* more : {"", kEnabled}) {
      Bussed drive(unit, "", more);
      const auto look = [&](int control, const std::string& what) {
        drive.ask(control, 1000);
        drive.talk.pass(100 * kMs);
        const int pi = drive.ask(control, 1000)[0];
        if (unit == std::string("mc07")) {
          EXPECT_EQ(pi & 0b1101'1000, 0) << what;
        }
        const Texts read = drive.talk.ask("523 # 31 00 20 76 00 00 00 00");  // 8310
        ASSERT_EQ(read.size(), 1U) << what;
        EXPECT_EQ(read[0].substr(read[0].size() - 5), word_text(pi)) << unit << ' ' << what;
      };
      for (const int control : {0x0000, 0x0001, 0x0006, 0xFFFF}) {
        look(control, "control word " + std::to_string(control));
        raise(drive, 47);
        look(control, "fault");
        reset(drive);
      }
      drive.talk.ask("523 # 33 00 21 92 00 00 00 01");
      look(0, "factory setting");
    }
}

// Terminal side and bus side of the enable: no enable without ENABLE, with CW = CCW, or with bit 2 = 0; rapid stop by bit 1 = 0;
// inhibit by DI05 and by bit 0. The bits of the bus count where P101 names it.
TEST(WordRows, TerminalsAndBusTogether) {
  PROVES("M07-CW-25");
  for (const int p101 : {0, 3}) {
    Talk talk(can_bus() +
              on_sbus("u", "mc07",
                      "P813 = 1\nP604 = 32\nP136 = 0\nP131 = 0\nP323 = 0\nP736 = 0\nP301 = 0\nP101 = " +
                          std::to_string(p101) + "\n"));
    talk.pass(5 * kMs);
    for (int row = 0; row < 1 << 7; ++row) {
      const auto is = [&](int bit) { return (row >> bit & 1) != 0; };
      const bool enable = is(0), cw = is(1), ccw = is(2), no_inhibit = is(3);
      const int control = row >> 4;
      talk.set("u", "DI03", enable);
      talk.set("u", "DI01", cw);
      talk.set("u", "DI02", ccw);
      talk.set("u", "DI05", no_inhibit);
      talk.ask("11 # " + word_text(control) + " 00 00 00 00", 10 * kMs);
      const Texts answer = talk.ask("11 # " + word_text(control) + " 00 00 00 00", 10 * kMs);
      ASSERT_EQ(answer.size(), 1U);
      const Bytes pi = bytes_of(answer[0].substr(5));
      const bool bus = p101 != 0;
      const bool inhibit = !no_inhibit || (bus && (control & 1) != 0);
      const bool enabled = !inhibit && enable && cw != ccw && (!bus || (control & 6) == 6);
      ASSERT_EQ(int{pi[0]}, inhibit ? 1 : enabled ? 4 : 2) << p101 << " row " << row;
      ASSERT_EQ((pi[1] & 1) != 0, enabled) << p101 << " row " << row;
    }
  }
}

}  // namespace
}  // namespace ipos::tests

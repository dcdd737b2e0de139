// The program example of the manual's chapter 6, run by a small STEP 5 interpreter beside a plant with a MOVITRAC 31: as it
// was meant, and with each misprint as it stands. The process image is that of the plant's DP master.
#include <algorithm>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"
#include "tests/runtime/bus/profibus/step5.hpp"

namespace ipos::tests {
namespace {

using profibus::Octets;
using runtime::kMillisecond;
using runtime::kSecond;

const std::string kPlant =
    "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n[[station]]\nname = \"inv\"\nunit = \"mc31\"\n"
    "option = \"ffp31\"\nprofibus = \"dp\"\nprofibus_address = 8\n[station.parameters]\nP120 = \"9.5 s\"\nP841 = \"FIELDBUS\"\n"
    "P600 = 0\nP601 = 0\n[station.inputs]\nDI00 = 1\n[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\n"
    "address = 8\ncfg = \"F3 F0\"\n";

// What the misprints change.
struct Print {
  std::string set_read = "S M 1.0";          // printed: U M 1.0
  std::string set_write = "S M 1.2";         // printed: U E 1.2
  std::string data_low = "T PW 190";         // printed: T PW 188
  std::string load_high = "L PW 188";        // not printed
  std::string always = "O M 0.0\nON M 0.0";  // before S =BUSY; not printed
};

std::string main_block(const Print& print) {
  return "U E 4.0\nUN M 1.0\n" + print.set_read + R"(
U M 1.0
SPB FB 101 READ=M_1.0 BUSY=M_1.1
U M 1.1
BEB
U E 4.1
UN M 1.2
)" + print.set_write +
         R"(
U M 1.2
SPB FB 102 WRITE=M_1.2 BUSY=M_1.3
BE
)";
}

std::string function_block(const Print& print, const std::string& name, const std::string& management,
                           const std::string& data) {
  return "UN =" + name + "\nBEB\nL PW 184\nT MW 184\nU =BUSY\nSPB =CHEK\nL KH " + management +
         "\nT MW 194\nL KF +1025\nT PW 186\n" + data + R"(
UN M 184.6
S M 194.6
U M 184.6
R M 194.6
SEND: L MW 194
T PW 184
)" + print.always +
         R"(
S =BUSY
CHEK: U M 184.6
UN M 194.6
O(
UN M 184.6
U M 194.6
)
BEB
L PW 186
T MW 186
)" + print.load_high +
         R"(
T MW 188
L PW 190
T MW 190
RB =BUSY
RB =)" + name +
         "\nBE\n";
}

// The PLC, its I/O from 184 on, and the unit with channel and one word.
struct Plc {
  explicit Plc(const Print& print = {}) {
    program.load("OB 1", main_block(print));
    program.load("FB 101", function_block(print, "READ", "3100", ""));
    program.load("FB 102",
                 function_block(print, "WRITE", "3200", "L KH 0000\nT PW 188\nL KH 0950\n" + print.data_low));
    unit.run(kSecond);
  }

  // A cycle of the PLC and some of the bus.
  void cycle() {
    program.run("OB 1");
    Octets octets;
    for (int n = 184; n < 194; ++n) octets.push_back(program.areas["PQ"][n]);
    const bool before = unit.value("120") == 950;
    unit.master().slave(0).set_outputs(octets);
    unit.run_on(5 * kMillisecond);
    written = written || (!before && unit.value("120") == 950);
    const Octets& inputs = unit.master().slave(0).inputs();
    for (int n = 184; n < 194; ++n) program.areas["PI"][n] = inputs[static_cast<size_t>(n - 184)];
    const std::string out = text_of(std::span(octets).first(8));
    if (sent.empty() || sent.back() != out) sent.push_back(out);
    answered = text_of(std::span(inputs).first(8));
    reading += program.bit("M", 1, 1);
  }
  // Presses a button until its request is noticed, then lets the service end.
  void press(int button, int request) {
    program.set_bit("I", 4, button, true);
    for (int n = 0; n < 60; ++n) {
      cycle();
      if (program.bit("M", 1, request)) program.set_bit("I", 4, button, false);
    }
  }
  void read() { press(0, 0); }
  void write() { press(1, 2); }

  // How often the handshake bit went out changed.
  int toggles() const {
    int count = 0;
    int before = 0;
    for (const std::string& octets : sent) {
      const int bit = std::stoi(octets.substr(0, 2), nullptr, 16) >> 6 & 1;
      count += bit != before;
      before = bit;
    }
    return count;
  }

  // P120 as another value than the program writes.
  void set_ramp(int32_t value) {
    unit.station().drive().set_parameter("P120", value);
    written = false;
  }

  DpPlant unit{kPlant};
  bool written = false;  // P120 has become 9.50 s
  Step5 program;
  std::vector<std::string> sent;
  std::string answered;
  int reading = 0;
};

TEST(ProgramExample, ChannelAt184AndWordAt192) {
  PROVES("DP-EX-01");
  Plc plc;
  plc.program.set_word("PQ", 192, 0x0006);
  for (int n = 0; n < 20; ++n) plc.cycle();
  EXPECT_TRUE(plc.unit.station().drive().state().verdict().reason == runtime::Block::None) << "6 is enable";
  EXPECT_EQ(plc.program.word("PI", 192), 0x0407) << "enabled, fieldbus mode active";
  plc.read();
  EXPECT_EQ(plc.program.word("PI", 186), 0x0401);
}

TEST(ProgramExample, ReadAndWriteOnce) {
  PROVES("DP-EX-02", "DP-EX-08", "DP-EX-09");
  Plc plc;
  plc.set_ramp(100);
  plc.program.set_bit("I", 4, 0, true);
  plc.program.set_bit("I", 4, 1, true);
  bool both = false;
  int written_while_reading = 0;
  for (int n = 0; n < 100; ++n) {
    plc.cycle();
    const bool reads = plc.program.bit("M", 1, 1);
    both = both || (reads && plc.program.bit("M", 1, 3));
    written_while_reading += reads && plc.written;
    if (plc.program.bit("M", 1, 0)) plc.program.set_bit("I", 4, 0, false);
    if (plc.program.bit("M", 1, 2)) plc.program.set_bit("I", 4, 1, false);
  }
  EXPECT_FALSE(both);
  EXPECT_EQ(written_while_reading, 0);
  EXPECT_EQ(plc.toggles(), 2) << "one service a request";
  EXPECT_TRUE(plc.written) << "the write after the read";
  for (int number = 0; number < 4; ++number) EXPECT_FALSE(plc.program.bit("M", 1, number)) << number;
}

TEST(ProgramExample, TheOctetsOfReads) {
  PROVES("DP-EX-03", "DP-EX-04", "DP-EX-06");
  Plc plc;
  plc.read();
  EXPECT_EQ(plc.sent.back().substr(0, 11), "71 00 04 01");
  EXPECT_EQ(plc.answered, "71 00 04 01 00 00 09 50");
  EXPECT_EQ(plc.program.word("M", 186), 0x0401);
  EXPECT_EQ(plc.program.word("M", 188), 0x0000);
  EXPECT_EQ(plc.program.word("M", 190), 0x0950);
  EXPECT_EQ(plc.program.word("M", 194), 0x7100);
  plc.read();
  EXPECT_EQ(plc.sent.back().substr(0, 11), "31 00 04 01");
  EXPECT_EQ(plc.answered, "31 00 04 01 00 00 09 50");
  plc.read();
  EXPECT_EQ(plc.sent.back().substr(0, 2), "71");
  EXPECT_EQ(plc.toggles(), 3);
}

TEST(ProgramExample, TheOctetsOfWrites) {
  PROVES("DP-EX-05");
  Plc plc;
  plc.set_ramp(1);
  plc.write();
  EXPECT_EQ(plc.sent.back(), "72 00 04 01 00 00 09 50");
  EXPECT_EQ(plc.unit.value("120"), 950);
  plc.write();
  EXPECT_EQ(plc.sent.back(), "32 00 04 01 00 00 09 50");
  EXPECT_EQ(plc.toggles(), 2);
}

TEST(ProgramExample, AnErrorInTheMarkers) {
  PROVES("DP-EX-07");
  // Of the codes of the inverter one that this parameter has: 99999.99 s is too large, 15h.
  Plc plc;
  Print print;
  plc.program.load("FB 102", function_block(print, "WRITE", "3200", "L KH 9999\nT PW 188\nL KH 9999\n" + print.data_low));
  plc.write();
  EXPECT_TRUE(plc.program.bit("M", 184, 7));
  EXPECT_EQ(plc.program.word("M", 188), 0x0800);
  EXPECT_EQ(plc.program.word("M", 190), 0x0015);
}

TEST(ProgramExample, MisprintOfTheStart) {
  PROVES("DP-EX-10");
  Print literal;
  literal.set_read = "U M 1.0";
  literal.set_write = "U E 1.2";
  Plc plc(literal);
  plc.program.set_bit("I", 4, 0, true);
  plc.program.set_bit("I", 4, 1, true);
  for (int n = 0; n < 100; ++n) plc.cycle();
  EXPECT_EQ(plc.toggles(), 0);
  Plc corrected;
  corrected.read();
  corrected.write();
  EXPECT_EQ(corrected.toggles(), 2);
}

TEST(ProgramExample, MisprintOfTheDataLow) {
  PROVES("DP-EX-11");
  Print literal;
  literal.data_low = "T PW 188";
  Plc plc(literal);
  plc.program.set_word("PQ", 190, 0x1234);  // left over from before
  plc.write();
  EXPECT_EQ(plc.sent.back(), "72 00 04 01 09 50 12 34");
  Plc corrected;
  corrected.write();
  EXPECT_EQ(corrected.sent.back(), "72 00 04 01 00 00 09 50");
}

TEST(ProgramExample, MisprintOfTheDataHigh) {
  PROVES("DP-EX-12");
  Print literal;
  literal.load_high = "";
  Plc plc(literal);
  plc.read();
  EXPECT_EQ(plc.program.word("M", 188), 0x0401);
  Plc corrected;
  corrected.read();
  EXPECT_EQ(corrected.program.word("M", 188), 0x0000);
}

TEST(ProgramExample, SlipOfBusy) {
  PROVES("DP-EX-13");
  Print literal;
  literal.always = "";
  Plc twice(literal), once;
  twice.read();  // received handshake 0
  once.read();
  EXPECT_EQ(twice.toggles(), 2);
  EXPECT_EQ(once.toggles(), 1);
  // Received handshake 1: bring both there by one corrected read, then read by each print.
  for (const Print& print : {literal, Print{}}) {
    Plc plc;
    plc.read();
    plc.program.load("FB 101", function_block(print, "READ", "3100", ""));
    const int before = plc.toggles();
    plc.read();
    EXPECT_EQ(plc.toggles() - before, 1);
  }
}

// While the two handshake bits differ the block ends at CHEK, and what is behind it runs when they are equal: two reads with the unit
// show all four pairs.
TEST(ProgramExample, TruthTableOfChek) {
  PROVES("DP-EX-14");
  Plc plc;
  std::set<std::tuple<bool, bool, bool>> seen;  // received, sent, and whether the block went on
  for (int reads = 0; reads < 2; ++reads) {
    plc.program.set_bit("I", 4, 0, true);
    for (bool done = false; !done && plc.unit.plant->now() < 5 * kSecond;) {
      plc.cycle();
      plc.program.set_bit("I", 4, 0, false);
      done = !plc.program.bit("M", 1, 0);  // the request is cleared at the end of the block
      seen.emplace(plc.program.bit("M", 184, 6), plc.program.bit("M", 194, 6), done);
    }
  }
  EXPECT_EQ(seen, (std::set<std::tuple<bool, bool, bool>>{{false, true, false}, {true, true, true}, {true, false, false}, {false, false, true}}));
}

// The listing of 3.6 has English operands, that of chapter 6 German ones: each in both tongues does the same with the unit.
TEST(ProgramExample, EnglishAndGermanOperands) {
  PROVES("DP-EX-15");
  for (const auto& [in, out] : {std::pair("IW", "OW"), {"EW", "AW"}, {"IW", "QW"}}) {
    std::string listing;
    for (const char* at : {"50", "52", "54"}) listing += std::string("L ") + in + ' ' + at + "\nT MW " + at + '\n';
    for (const auto& [value, at] : {std::pair("KH 0006", "50"), {"KF +1500", "52"}, {"KH 0000", "54"}})
      listing += std::string("L ") + value + "\nT " + out + ' ' + at + '\n';
    Step5 program;
    program.load("OB 1", listing + "BE\n");
    DpPlant unit(dp_line() + mc31_station() + dp_master(""));
    for (int cycle = 0; cycle < 300; ++cycle) {
      unit.run_on(10 * kMillisecond);
      for (size_t word = 0; word < 3; ++word) program.set_word("PI", 50 + 2 * static_cast<int>(word), unit.input(word));
      program.run("OB 1");
      Octets octets;
      for (int n = 50; n < 56; ++n) octets.push_back(program.areas["PQ"][n]);
      unit.master().slave(0).set_outputs(octets);
    }
    EXPECT_EQ(unit.speed(), 300'000) << in;
    EXPECT_EQ(program.word("M", 52), 0x05DC) << in;
  }
  const auto english = [](std::string text) {
    for (const auto& [german, word] : {std::pair("UN ", "AN "), {"U ", "A "}, {"SPB ", "JC "}, {"BEB", "BEC"}, {" E ", " I "}}) {
      const std::string from = german;
      for (size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += std::string(word).size())
        if (from[0] == ' ' || at == 0 || text[at - 1] == '\n' || text[at - 1] == ' ') text.replace(at, from.size(), word);
    }
    return text;
  };
  Plc german, translated;
  translated.program.load("OB 1", english(main_block({})));
  translated.program.load("FB 101", english(function_block({}, "READ", "3100", "")));
  for (Plc* plc : {&german, &translated}) {
    plc->read();
    plc->read();
    EXPECT_EQ(plc->answered, "31 00 04 01 00 00 09 50");
    EXPECT_EQ(plc->program.word("M", 190), 0x0950);
  }
  EXPECT_EQ(german.sent, translated.sent);
  Step5 program;
  EXPECT_THROW(program.load("OB 4", "XYZ M 1.0"), std::runtime_error);
}

}  // namespace
}  // namespace ipos::tests

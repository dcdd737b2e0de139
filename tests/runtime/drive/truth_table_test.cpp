// Every combination of terminals, control word, P101, P100 and control word of the program against tables
// written from figure 19 of the MOVITRAC 07 manual and, for MOVIDRIVE, MDX60B/61B p. 29 and the unit profile.
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Command;
using runtime::InputFunction;

enum class Told { Inhibit, Emergency, Rapid, Stop, Hold, Enable };

Told told(const Drive& drive) {
  switch (drive.verdict().command) {
    case Command::Inhibit: return Told::Inhibit;
    case Command::EmergencyStop: return Told::Emergency;
    case Command::RapidStop: return Told::Rapid;
    case Command::Stop: return Told::Stop;
    case Command::HoldControl: return Told::Hold;
    case Command::Enable: return Told::Enable;
  }
  return Told::Inhibit;
}

bool bit(unsigned value, unsigned n) { return (value >> n & 1) != 0; }

// Sends `control` over the bus of P101 and its opposite over the others.
void send(Drive& drive, int32_t p101, uint16_t control) {
  constexpr std::pair<PoSource, int32_t> kBuses[] = {
      {PoSource::Rs485, 1}, {PoSource::Fieldbus, 2}, {PoSource::Sbus, 3}};
  for (const auto& [source, code] : kBuses) {
    const uint16_t opposite = static_cast<uint16_t>(~control & 0x000F);
    const uint16_t words[] = {code == p101 ? control : opposite, 1000, 0};
    drive.take_po(source, words);
  }
}

// Figure 19. Inputs of the rows: terminals enable, CW, CCW, inhibit (bits 0..3), bus bits 0..2, bits 1, 11,
// 30 of H484 (bits 0..2).
Told figure_19(unsigned terminals, bool bus, unsigned control, unsigned program) {
  const bool enable = bit(terminals, 0), cw = bit(terminals, 1), ccw = bit(terminals, 2);
  const bool inhibit = !bit(terminals, 3) || (bus && bit(control, 0)) || bit(program, 2);
  const bool rapid = bus && !bit(control, 1);
  const bool no_enable = !enable || cw == ccw || (bus && !bit(control, 2)) || bit(program, 0);
  const bool error = bit(program, 1);  // F26, P830 = rapid stop
  if (inhibit) return Told::Inhibit;
  if (rapid || error) return Told::Rapid;
  return no_enable ? Told::Stop : Told::Enable;
}

TEST(TruthTable, Movitrac07) {
  PROVES("M07-CW-25");
  int combinations = 0;
  for (const int32_t p101 : {0, 1, 3})
    for (const int32_t p100 : {1, 2, 10}) {
      DriveRig rig("mc07");
      rig.set("P100", p100);
      rig.set("P101", p101);
      rig.set("P604", 32);  // DI05 CONTROL.INHIBIT
      for (unsigned row = 0; row < 1U << 10; ++row) {
        const unsigned terminals = row & 15, control = row >> 4 & 7, program = row >> 7;
        rig.program_word(0);
        rig.drive.set_inputs(0);
        rig.run_ms(1);
        rig.drive.reset_fault();
        rig.input("DI03", bit(terminals, 0));
        rig.input("DI01", bit(terminals, 1));
        rig.input("DI02", bit(terminals, 2));
        rig.input("DI05", bit(terminals, 3));
        rig.program_word((bit(program, 0) ? 1U << 1 : 0) | (bit(program, 1) ? 1U << 11 : 0) |
                                        (bit(program, 2) ? 1U << 30 : 0));
        send(rig.drive, p101, static_cast<uint16_t>(control));
        rig.run_ms(1);
        const Told want = figure_19(terminals, p101 != 0, control, program);
        ASSERT_EQ(told(rig.drive), want) << p101 << " " << p100 << " row " << row;
        const int state = want == Told::Inhibit ? 1 : want == Told::Enable ? 4 : 2;
        ASSERT_EQ(rig.state(), bit(program, 1) ? 26 : state) << p101 << " " << p100 << " row " << row;
        ASSERT_EQ(rig.stage(), want == Told::Enable) << p101 << " " << p100 << " row " << row;
        ++combinations;
      }
    }
  std::printf("%d combinations\n", combinations);
  EXPECT_EQ(combinations, 9 * 1024);
}

// MOVIDRIVE: ENABLE/RAPID STOP = 0 is a rapid stop; /HOLD CONTROL and bit 3 hold; with a bus setpoint CW and
// CCW may both be set, as its sign decides; the external fault of the program is an emergency stop (P830).
Told movidrive(unsigned terminals, bool bus, bool bus_setpoint, unsigned control, unsigned program) {
  const bool inhibit = bit(terminals, 0), enable = bit(terminals, 1), cw = bit(terminals, 2);
  const bool ccw = bit(terminals, 3), hold = !bit(terminals, 4);
  if (!inhibit || (bus && bit(control, 0)) || bit(program, 2)) return Told::Inhibit;
  if (bit(program, 1)) return Told::Emergency;
  if (!enable || (bus && !bit(control, 1))) return Told::Rapid;
  const bool direction = bus_setpoint ? cw || ccw : cw != ccw;
  if (!direction || (bus && !bit(control, 2)) || bit(program, 0)) return Told::Stop;
  return hold || (bus && bit(control, 3)) ? Told::Hold : Told::Enable;
}

TEST(TruthTable, Movidrive) {
  int combinations = 0;
  for (const int32_t p101 : {0, 1, 2, 3})
    for (const int32_t p100 : {0, 1, 2, 3, 10}) {
      DriveRig rig("md60a");
      rig.set("P100", p100);
      rig.set("P101", p101);
      rig.set("P604", 13);  // DI05 /HOLD CONTROL
      for (unsigned row = 0; row < 1U << 12; ++row) {
        const unsigned terminals = row & 31, control = row >> 5 & 15, program = row >> 9;
        rig.program_word(0);
        rig.drive.set_inputs(0);
        rig.run_ms(1);
        rig.drive.reset_fault();
        rig.input("DI00", bit(terminals, 0));
        rig.input("DI03", bit(terminals, 1));
        rig.input("DI01", bit(terminals, 2));
        rig.input("DI02", bit(terminals, 3));
        rig.input("DI05", bit(terminals, 4));
        rig.program_word((bit(program, 0) ? 1U << 1 : 0) | (bit(program, 1) ? 1U << 11 : 0) |
                                        (bit(program, 2) ? 1U << 30 : 0));
        send(rig.drive, p101, static_cast<uint16_t>(control));
        rig.run_ms(1);
        const Told want = movidrive(terminals, p101 != 0, p100 >= 2, control, program);
        ASSERT_EQ(told(rig.drive), want) << p101 << " " << p100 << " row " << row;
        const int state = want == Told::Inhibit ? 1 : want == Told::Enable ? 4 : want == Told::Hold ? 7 : 2;
        ASSERT_EQ(rig.state(), bit(program, 1) ? 26 : state) << p101 << " " << p100 << " row " << row;
        ASSERT_EQ(rig.stage(), want == Told::Enable || want == Told::Hold) << p101 << p100 << " row " << row;
        ++combinations;
      }
    }
  std::printf("%d combinations\n", combinations);
  EXPECT_EQ(combinations, 20 * 4096);
}

// A travel has its direction itself, so it needs no input with one; but an input that has one, CW or CCW, and is 0,
// stops it (ours). Functions of three inputs: none, CW or CCW; all levels.
TEST(TruthTable, PositioningAndTheDirectionInputs) {
  for (unsigned functions = 0; functions < 27; ++functions)
    for (unsigned levels = 0; levels < 8; ++levels) {
      std::array<uint8_t, 16> table{};
      bool any = false, set = false;
      unsigned rest = functions;
      for (size_t n = 0; n < 3; ++n, rest /= 3) {
        constexpr InputFunction kFunctions[] = {InputFunction::None, InputFunction::Cw, InputFunction::Ccw};
        table[n + 1] = static_cast<uint8_t>(kFunctions[rest % 3]);
        any |= rest % 3 != 0;
        set |= rest % 3 != 0 && bit(levels, static_cast<unsigned>(n));
      }
      runtime::ControlInputs in;
      in.terminals = runtime::Terminals(static_cast<uint16_t>(levels << 1), table);
      in.positioning = true;
      in.cw = in.terminals.on(InputFunction::Cw);
      in.ccw = in.terminals.on(InputFunction::Ccw);
      const runtime::Verdict verdict = runtime::decide_locally(in);
      EXPECT_EQ(verdict.command, set || !any ? Command::Enable : Command::Stop) << functions << " " << levels;
      in.positioning = false;
      EXPECT_EQ(runtime::decide_locally(in).command, in.cw != in.ccw ? Command::Enable : Command::Stop)
          << functions << " " << levels;
    }
}

// Three-wire control (P101 = 4, ours): a pulse starts, ENABLE/STOP = 0 ends, the other direction takes over.
TEST(TruthTable, ThreeWireControl) {
  DriveRig rig("mc07");
  rig.set("P101", 4);
  rig.ai1(2000);
  rig.input("DI03", true);
  const auto pulse = [&](const char* name) {
    rig.input(name, true);
    rig.run_ms(5);
    rig.input(name, false);
    rig.settle();
  };
  rig.run_ms(10);
  EXPECT_EQ(rig.rpm(), 0);
  pulse("DI01");
  EXPECT_EQ(rig.rpm(), 300);
  pulse("DI02");
  EXPECT_EQ(rig.rpm(), -300);
  rig.input("DI03", false);
  rig.ms_until_standing();
  EXPECT_EQ(rig.rpm(), 0);
  rig.input("DI03", true);
  rig.run_ms(1000);
  EXPECT_EQ(rig.rpm(), 0) << "a new pulse is needed";
  pulse("DI01");
  EXPECT_EQ(rig.rpm(), 300);
  // The bus is not heard.
  rig.drive.take_po(PoSource::Sbus, Words{0x0001, 0, 0});
  rig.run_ms(10);
  EXPECT_EQ(rig.rpm(), 300);
}

}  // namespace
}  // namespace ipos::tests

// `ipos run --why`: the drive gets into every row of blocks.def and setpoint_notes.def, and each text names
// what a person at the machine can look at.
#include <map>

#include "stdlib/unit_text.hpp"
#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

const Block kBlocks[] = {
#define BLOCK(name, text) Block::name,
#include "runtime/drive/blocks.def"
};
const SetpointNote kNotes[] = {
#define SETPOINT_NOTE(name, text) SetpointNote::name,
#include "runtime/drive/setpoint_notes.def"
};

// Runs at 600 rpm by bus; each case spoils one thing.
constexpr int kStartUpMs = 50;

DriveOptions slow_start() {
  DriveOptions options;
  options.start_up_ms = kStartUpMs;
  return options;
}

struct Running : DriveRig {
  explicit Running(std::string_view name) : DriveRig(name, slow_start()) {
    bus_control();
    run_ms(kStartUpMs);
    po({0x0006, 3000, 0});
    settle();
    EXPECT_EQ(drive.verdict().reason, Block::None);
    EXPECT_EQ(drive.setpoint().note, SetpointNote::None);
  }
};

using Spoil = void (*)(DriveRig&);

TEST(Why, EveryBlockOccurs) {
  struct Case {
    Block block;
    const char* unit;
    Spoil spoil;
  };
  const Case cases[] = {
      {Block::None, "md60a", [](DriveRig&) {}},
      {Block::FactorySetting, "md60a",
       [](DriveRig& rig) {
         rig.input("DI00", false);
         rig.run_ms(1000);
         EXPECT_EQ(rig.write("P802", 1), 0);
         rig.input("DI00", true);
       }},
      {Block::Fault, "md60a", [](DriveRig& rig) { rig.drive.raise_fault(1); }},
      {Block::Warning, "md60a",
       [](DriveRig& rig) {
         rig.set("P830", 7);
         rig.set("P604", 11);
       }},
      {Block::TerminalInhibit, "md60a", [](DriveRig& rig) { rig.input("DI00", false); }},
      {Block::BusInhibit, "md60a",
       [](DriveRig& rig) {
         rig.po({0x0007, 3000, 0});
       }},
      {Block::IposInhibit, "md60a", [](DriveRig& rig) { rig.program_word(1U << 30); }},
      {Block::Waiting, "md60a",
       [](DriveRig& rig) {
         rig.silence();
         rig.drive.power_cycle();
         rig.set("P815", 100);
         rig.run_ms(kStartUpMs);
       }},
      {Block::StartUp, "md60a", [](DriveRig& rig) { rig.drive.power_cycle(); }},
      {Block::NoControlWord, "mc07",
       [](DriveRig& rig) {
         rig.silence();
         rig.drive.power_cycle();
         rig.run_ms(kStartUpMs);
       }},
      {Block::PoDisabled, "md60a", [](DriveRig& rig) { rig.set("P876", 0); }},
      {Block::RapidStopTerminal, "md60a", [](DriveRig& rig) { rig.input("DI03", false); }},
      {Block::EnableTerminal, "mc07", [](DriveRig& rig) { rig.input("DI03", false); }},
      {Block::BusRapidStop, "md60a",
       [](DriveRig& rig) {
         rig.po({0x0004, 3000, 0});
       }},
      {Block::NoDirection, "md60a", [](DriveRig& rig) { rig.input("DI01", false); }},
      {Block::BothDirections, "mc07", [](DriveRig& rig) { rig.input("DI02", true); }},
      {Block::BusStop, "md60a",
       [](DriveRig& rig) {
         rig.po({0x0002, 3000, 0});
       }},
      {Block::IposNoEnable, "md60a", [](DriveRig& rig) { rig.program_word(1U << 1); }},
      {Block::AxisStop, "md60a", [](DriveRig& rig) { rig.positioning.halt = runtime::Command::RapidStop; }},
      {Block::HoldTerminal, "md60a", [](DriveRig& rig) { rig.set("P604", 13); }},
      {Block::BusHold, "md60a",
       [](DriveRig& rig) {
         rig.po({0x000E, 3000, 0});
       }},
      {Block::MasterInhibit, "md60a",
       [](DriveRig& rig) {
         rig.set("P100", 8);
         rig.po({0x0007, 3000, 0});
       }},
      {Block::MasterRapidStop, "md60a",
       [](DriveRig& rig) {
         rig.set("P100", 8);
         rig.set("P101", 0);
         rig.po({0x0004, 3000, 0});
       }},
      {Block::MasterStop, "md60a",
       [](DriveRig& rig) {
         rig.set("P100", 8);
         rig.set("P101", 0);
         rig.po({0x0002, 3000, 0});
       }},
      {Block::MasterHold, "md60a",
       [](DriveRig& rig) {
         rig.set("P100", 8);
         rig.po({0x000E, 3000, 0});
       }},
      {Block::StopFunction, "md60a",
       [](DriveRig& rig) {
         rig.set("P720", 1);
         rig.po({0x0006, 100, 0});
       }},
      {Block::NoMains, "md60a",
       [](DriveRig& rig) {
         rig.drive.set_mains(false);
         rig.run_ms(400);
       }},
      {Block::MainsOff, "md60a", [](DriveRig& rig) { rig.set("P604", 21); }},
      {Block::SlaveStands, "md60a", [](DriveRig& rig) { rig.positioning.halt = runtime::Command::Stop; }},
      {Block::LimitCw, "md60a", [](DriveRig& rig) { rig.set("P604", 14); }},
      {Block::LimitCcw, "md60a",
       [](DriveRig& rig) {
         rig.set("P604", 15);
         rig.po({0x0006, static_cast<uint16_t>(-3000), 0});
       }},
  };
  std::map<Block, int> seen;
  for (const Case& one : cases) {
    Running rig(one.unit);
    one.spoil(rig);
    rig.run_ms(20);
    EXPECT_EQ(rig.drive.verdict().reason, one.block) << runtime::block_text(one.block, unit(one.unit));
    const bool runs = rig.drive.verdict().command == runtime::Command::Enable;
    EXPECT_EQ(runs, one.block == Block::None);
    ++seen[rig.drive.verdict().reason];
  }
  for (const Block block : kBlocks) EXPECT_EQ(seen[block], 1) << static_cast<int>(block);
}

TEST(Why, EveryNoteOccurs) {
  const std::pair<SetpointNote, Spoil> cases[] = {
      {SetpointNote::None, [](DriveRig&) {}},
      {SetpointNote::NoBusWord, [](DriveRig& rig) { rig.set("P871", 0); }},
      {SetpointNote::PoDisabled, [](DriveRig& rig) { rig.set("P876", 0); }},
      {SetpointNote::NoBusData, [](DriveRig& rig) { rig.set("P100", 2); }},
      {SetpointNote::BusWordIgnored, [](DriveRig& rig) { rig.set("P100", 1); }},
      {SetpointNote::FixedIgnored, [](DriveRig& rig) { rig.input("DI04", true); }},
      {SetpointNote::NoCurrentWord, [](DriveRig& rig) { rig.set("P700", 12); }},
      {SetpointNote::Maximum,
       [](DriveRig& rig) {
         rig.po({0x0006, 10'000, 0});
       }},
      {SetpointNote::Minimum, [](DriveRig& rig) { rig.set("P301", 700'000); }},
      {SetpointNote::Skipped,
       [](DriveRig& rig) {
         rig.set("P740", 600'000);
         rig.set("P741", 100'000);
       }},
  };
  std::map<SetpointNote, int> seen;
  for (const auto& [note, spoil] : cases) {
    Running rig("md60a");
    spoil(rig);
    rig.run_ms(20);
    EXPECT_EQ(rig.drive.setpoint().note, note) << static_cast<int>(note);
    ++seen[rig.drive.setpoint().note];
  }
  for (const SetpointNote note : kNotes) EXPECT_EQ(seen[note], 1) << static_cast<int>(note);
}

// A parameter number, or the variable or command of the program.
bool names_its_place(std::string_view text) {
  for (size_t at = 0; at + 1 < text.size(); ++at)
    if (text[at] == 'P' && text[at + 1] >= '0' && text[at + 1] <= '9') return true;
  return text.find("H484") != std::string_view::npos || text.find("_AxisStop") != std::string_view::npos;
}

TEST(Why, TextsNameParameters) {
  for (const Block block : kBlocks)
    if (block != Block::None) {
      const std::string text = runtime::block_text(block, unit("md60a"));
      EXPECT_TRUE(names_its_place(text)) << text;
    }
  for (const SetpointNote note : kNotes)
    if (note != SetpointNote::None) {
      const std::string text = runtime::setpoint_note_text(note, unit("md60a"));
      EXPECT_TRUE(names_its_place(text)) << text;
    }
}

// What a unit can come into, it tells with parameters that its own list has.
void expect_own_parameters(const stdlib::UnitType& unit, const std::string& text) {
  for (const std::string& parameter : stdlib::named_parameters(text))
    EXPECT_TRUE(stdlib::has_named(unit, parameter)) << unit.name << " has no " << parameter << ": " << text;
  EXPECT_EQ(text.find_first_of("{|}"), std::string::npos) << text;
}

// Of master/slave operation, IPOS and torque control MOVITRAC has nothing, and MOVITRAC 31 knows no setpoint but that of
// its bus or its terminals.
bool can_come(const stdlib::UnitType& unit, Block block) {
  using stdlib::Family;
  const bool movidrive = unit.family == Family::MovidriveA || unit.family == Family::MovidriveB;
  switch (block) {
    case Block::MasterInhibit:
    case Block::MasterRapidStop:
    case Block::MasterStop:
    case Block::MainsOff:
    case Block::MasterHold: return movidrive;
    case Block::PoDisabled:
    case Block::StopFunction: return unit.family != Family::Movitrac31;
    default: return true;
  }
}

TEST(Why, EveryUnitNamesParametersThatItHas) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    for (const Block block : kBlocks)
      if (can_come(unit, block)) expect_own_parameters(unit, runtime::block_text(block, unit));
    for (const stdlib::FaultRow& row : stdlib::fault_table())
      expect_own_parameters(unit, stdlib::meaning_on(unit, row));
    if (unit.family == stdlib::Family::Movitrac31) continue;
    for (const SetpointNote note : kNotes) {
      const bool torque = note == SetpointNote::NoCurrentWord;
      if (!torque || unit.lists.starts_with("md60a.tsv"))
        expect_own_parameters(unit, runtime::setpoint_note_text(note, unit));
    }
  }
}

}  // namespace
}  // namespace ipos::tests

// SCOM, SCOMON and SCOMST to the objects of both SBuses (1053 1610 p. 53 to 56; IPOSplus p. 232), and where in the source
// a command stands.
#include <gtest/gtest.h>

#include "runtime/commands/source_places.hpp"
#include "tests/runtime/scom/objects_rig.hpp"
#include "tests/runtime/unit/program_rig.hpp"

namespace ipos::runtime {
namespace {

using tests::ProgramRig;

// The program of the rig is executed by a machine of its own, whose unit is on SBus 1, SBus 2, both or none.
struct BusRig : ProgramRig {
  BusRig(const std::string& text, bool on_first, bool on_second)
      : ProgramRig(text),
        first(unit, 500'000, outbox, 100, 1),
        second(unit, 500'000, outbox, 200, 2),
        with_buses{clock,
                   milliseconds,
                   drive,
                   parameters,
                   timers,
                   server.memory(),
                   movilink,
                   {on_first ? &first : nullptr, on_second ? &second : nullptr}},
        bus_commands(with_buses, journal, "unit1", &image),
        program(machine.program(), bus_commands.host()) {
    program.start();
  }
  int32_t& v(size_t n) { return program.variables()[n]; }
  // SCTRCYCL at H100, every 10 ms, 4 bytes from H110.
  int fault_of(int32_t object) {
    const int32_t elements[] = {object, 10, 0, 4, 110};
    std::copy(std::begin(elements), std::end(elements), &v(100));
    program.run(1, 100);
    return program.fault().number;
  }
  Outbox outbox;
  VariableObjects first, second;
  ProgramServices with_buses;
  SystemCommands bus_commands;
  vm::Machine program;
};

constexpr int32_t kOnSecond = 1 << 24;  // bit 24 of the object number

TEST(ObjectCommands, GoToTheBusOfTheirNumber) {
  for (const bool on_first : {false, true})
    for (const bool on_second : {false, true})
      for (const int32_t number : {1100, 1100 | kOnSecond}) {
        BusRig rig("SCOM TRANSMIT CYCLIC , H100\nEND\n", on_first, on_second);
        const bool to_second = number != 1100 && on_second;
        EXPECT_EQ(rig.fault_of(number), to_second || on_first ? 0 : 10) << on_first << on_second << number;
        EXPECT_EQ(rig.second.definitions().size(), to_second ? 1U : 0U);
        EXPECT_EQ(rig.first.definitions().size(), !to_second && on_first ? 1U : 0U);
        // Where SBus 2 is not connected its object is refused with a reason.
        const bool refused = number != 1100 && !on_second && on_first;
        EXPECT_EQ(rig.told().find("SBus 2") != std::string::npos, refused) << rig.told();
      }
  BusRig negative("SCOM TRANSMIT CYCLIC , H100\nEND\n", true, true);
  EXPECT_EQ(negative.fault_of(-1), 0);
  EXPECT_EQ(negative.second.definitions().size(), 0U) << "no bit 24 of a negative number counts";
  BusRig pointer("SET H104 = 5000\nSCOM TRANSMIT CYCLIC , H100\nEND\n", true, false);
  EXPECT_EQ(pointer.fault_of(1100), 10) << "DPointer leads to no variable";
}

TEST(ObjectCommands, StartAndStopAllBuses) {
  for (const bool on_first : {false, true})
    for (const bool on_second : {false, true})
      for (const char* start : {"SCOMON\n", "SCOMST START , H0\n"}) {
        BusRig rig(start + std::string("M01 : JMP H1 == 0 , M01\nSCOMST STOP , H0\nEND\n"), on_first,
                   on_second);
        rig.v(0) = 7;
        rig.clock.run_until(12 * kMillisecond);
        rig.program.run(1, 20);
        const bool any = on_first || on_second;
        EXPECT_EQ(rig.program.fault().number, any ? 0 : 10);
        EXPECT_EQ(rig.first.started(), on_first);
        EXPECT_EQ(rig.second.started(), on_second);
        EXPECT_EQ(rig.v(0), any && start[4] == 'S' ? 1 : 7) << "the variable takes the state";
        rig.v(1) = 1;
        rig.program.run(1, 20);
        EXPECT_FALSE(rig.first.started() || rig.second.started());
        EXPECT_EQ(rig.v(0), any ? 0 : 7);
      }
}

// Offsets count from the millisecond of SCOMON.
TEST(ObjectCommands, TimesCountFromTheStart) {
  BusRig rig("SCOM TRANSMIT CYCLIC , H100\nSCOMON\nEND\n", true, false);
  rig.clock.run_until(12 * kMillisecond + 999'999);
  EXPECT_EQ(rig.fault_of(1100), 0);
  for (int64_t tick = 12; tick <= 22; ++tick) rig.first.tick(tick, rig.program.variables());
  EXPECT_EQ(rig.outbox.sent.size(), 2U) << "at 12 and 22 ms";
}

TEST(SourcePlaces, EachLineHoldsUpToTheNext) {
  vm::Image image;
  image.files = {"A.IPC", "B.IPC"};
  image.lines = {{4, 0, 10, 3}, {6, 1, 20, 5}, {7, 0, 11, 1}};
  struct Row {
    uint32_t address;
    const char* place;
    uint32_t line;
  };
  for (const Row& row :
       {Row{0, "", 0}, Row{3, "", 0}, Row{4, "A.IPC:10:3", 10}, Row{5, "A.IPC:10:3", 10},
        Row{6, "B.IPC:20:5", 20}, Row{7, "A.IPC:11:1", 11}, Row{UINT32_MAX, "A.IPC:11:1", 11}}) {
    EXPECT_EQ(source_place(image, row.address), row.place) << row.address;
    EXPECT_EQ(source_line(image, row.address), row.line) << row.address;
  }
  EXPECT_EQ(source_place({}, 0), "");
  EXPECT_EQ(source_line({}, 5), 0U);
}

}  // namespace
}  // namespace ipos::runtime

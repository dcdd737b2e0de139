// The system variables of positioning (IPOSplus p. 34 to 36; 8 IPOSplus p. 24 to 29): which one shows what, which one is a
// parameter, and what a value that the program writes does in the next millisecond.
#include "runtime/services/positioning_service.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <tuple>

#include "tests/runtime/positioning/rig.hpp"

namespace ipos::tests {
namespace {

struct ParameterVariable {
  size_t variable;
  const char* number;
  int32_t value, other;
};
// H493 POSITION WINDOW, H494 LAG WINDOW, H496 and H497 the software limit switches, H498 the reference offset.
constexpr ParameterVariable kParameterVariables[] = {{493, "922", 77, 99},
                                                     {494, "923", 4'444, 6'000},
                                                     {496, "920", 70'000, 80'000},
                                                     {497, "921", -70'000, -80'000},
                                                     {498, "900", 1'111, -2'222}};

TEST(PositioningVariables, FiveAreParameters) {
  for (const ParameterVariable& row : kParameterVariables) {
    SCOPED_TRACE(row.number);
    Rig rig;
    const uint16_t index = rig.parameters.table().find(row.number)->index;
    EXPECT_EQ(rig.h[row.variable], rig.parameters.value(index));
    const auto before = rig.h;
    const int32_t kept = rig.parameters.value(index);
    rig.h[row.variable] = row.value;
    rig.run(1);
    EXPECT_EQ(rig.parameters.value(index), row.value) << "written by the program";
    for (const ParameterVariable& other : kParameterVariables) {
      EXPECT_EQ(rig.h[other.variable], other.variable == row.variable ? row.value : before[other.variable]);
    }
    rig.set(row.number, row.other);
    rig.run(1);
    EXPECT_EQ(rig.h[row.variable], row.other) << "written over a bus";
    // Both at once: the parameter is the newer one.
    rig.set(row.number, kept);
    rig.h[row.variable] = row.value;
    rig.run(1);
    EXPECT_EQ(rig.h[row.variable], kept);
    EXPECT_EQ(rig.parameters.value(index), kept);
  }
}

// H511 is the motor, H510 the external encoder, H509 the absolute one; H491 is the setpoint of the source P941, H495 the
// lag, H492 the target.
TEST(PositioningVariables, EveryEncoderHasItsOwn) {
  for (const int32_t source : {0, 1, 2}) {
    Rig rig({{"941", source},
             {"942", 4},
             {"943", 1},
             {"954", 500},
             {"951", source == 2 ? 0 : 1},
             {"913", 600'000},
             {"914", 600'000}});
    rig.go(source == 2 ? 2'000 : -1'000);
    for (int n = 0; n < 3000; ++n) {
      rig.tick();
      const int32_t motor = rig.h[511];
      const auto quarter = static_cast<int32_t>(std::floor(motor / 4.0));
      ASSERT_EQ(motor, rig.drive.position());
      ASSERT_EQ(rig.h[510], quarter);
      ASSERT_EQ(rig.h[509], source == 2 ? 500 + quarter : 500 - quarter) << "P951 inverts it";
      const int32_t actual = rig.h[511 - static_cast<size_t>(source)];
      ASSERT_EQ(rig.h[495], rig.h[491] - actual);
      ASSERT_EQ(rig.h[473] >> 20 & 1, source == 2 ? 1 : 0) << "an absolute encoder is always referenced";
      ASSERT_EQ(rig.h[473] >> 19 & 1, std::abs(rig.h[492] - actual) <= rig.h[493] ? 1 : 0);
    }
    EXPECT_EQ(rig.h[511 - static_cast<size_t>(source)], rig.h[492]);
    EXPECT_NE(rig.h[511], 0);
  }
}

// The other bits of H473 are the program's.
TEST(PositioningVariables, OnlyTwoBitsOfTheStatusWordAreWritten) {
  for (const uint32_t word : {0U, 0xFFFF'FFFFU, 0x5A5A'5A5AU}) {
    Rig rig;
    rig.h[473] = static_cast<int32_t>(word);
    rig.run(1);
    constexpr uint32_t kBits = 3U << 19;
    EXPECT_EQ(static_cast<uint32_t>(rig.h[473]), (word & ~kBits) | 1U << 19);
  }
}

TEST(PositioningVariables, OfTheModuloFunction) {
  Rig rig({{"960", 2}, {"961", 10}, {"962", 1}, {"963", 4096}, {"911", 300}, {"912", 300}});
  rig.h[454] = 0x4000;
  rig.run(1);
  EXPECT_EQ(rig.h[492], 10'240) << "a quarter of 40960 increments";
  rig.run_to_target();
  EXPECT_EQ(rig.h[455], 0x4000);
  EXPECT_EQ(rig.h[454], 0x4000);
  EXPECT_EQ(rig.h[456], 0);
  rig.h[453] = 2;  // high resolution: increments
  rig.run(1);
  EXPECT_EQ(rig.h[455], 10'240);
  rig.h[453] = 0;
  rig.h[456] = 41;
  rig.run(1);
  EXPECT_EQ(rig.h[456], 41);
  rig.h[454] = 0;
  rig.run(1);
  rig.run_to_target();
  EXPECT_EQ(rig.h[456], 42);
  EXPECT_EQ(rig.h[455], 0);
  Rig off;
  off.h[455] = 9;
  off.run(1);
  EXPECT_EQ(off.h[455], 0);
}

// H499 is the position that a bus sends (PO assignments 3 and 4), kept while none comes.
TEST(PositioningVariables, ThePositionOfTheBus) {
  Rig rig({{"100", 10}, {"870", 3}, {"871", 4}, {"872", 9}});  // POSITION LO, POSITION HI, CONTROL WORD 1
  rig.run(2);
  EXPECT_EQ(rig.h[499], 0);
  const runtime::DriveWords words{0x1234, 0x8765, 6};
  rig.drive.take_po(runtime::PoSource::Sbus, words);
  rig.run(1);
  EXPECT_EQ(static_cast<uint32_t>(rig.h[499]), 0x8765'1234U);
  const int32_t sent = rig.h[499];
  rig.set("870", 0);
  rig.run(5);
  EXPECT_EQ(rig.h[499], sent);
}

// A travel takes up what changes in the millisecond of the change, however long it went on with its plan.
TEST(PositioningVariables, WhatIsWrittenActsInTheNextMillisecond) {
  const auto moving = [] {
    auto rig = std::make_unique<Rig>();
    rig->go(400'000);
    rig->run(1500);
    return rig;
  };
  auto target = moving();
  target->h[492] = target->h[511] - 1'000;
  target->run(1);
  const int32_t before = target->drive.axis().speed;
  target->run(1);
  EXPECT_LT(target->drive.axis().speed, before);
  auto lag = moving();
  lag->h[494] = 1;
  lag->drive.set_position(lag->drive.position() - 50);
  lag->run(2);
  EXPECT_EQ(lag->drive.fault(), 42);
  auto input = moving();
  input->drive.set_inputs(kEnabled & ~(1 << 3));
  input->run(2);
  EXPECT_EQ(input->h[491], input->h[511]) << "without enable the setpoint is where the axis is";
  auto command = moving();
  command->positioner().halt(runtime::Halt::HoldControl);
  command->run(2);
  EXPECT_EQ(command->drive.verdict().command, runtime::Command::HoldControl);
  auto parameter = moving();
  parameter->set("913", 600'000);
  parameter->run(2);
  EXPECT_LT(parameter->drive.axis().speed, 1'500'000);
}

// P930: 0 to 10 V at AI1 are 0 to 150 % of the travel speeds; what is beyond counts as the end.
TEST(PositioningVariables, TheOverrideIsAtAi1) {
  constexpr int32_t kTravel = 600'000;  // 600 rpm
  for (const auto& [on, millivolt, permille] : {std::tuple{1, 0, 0},
                                                {1, -1, 0},
                                                {1, -10'000, 0},
                                                {1, 1'000, 150},
                                                {1, 4'000, 600},
                                                {1, 6'670, 1'000},
                                                {1, 9'999, 1'499},
                                                {1, 10'000, 1'500},
                                                {1, 10'001, 1'500},
                                                {1, 20'000, 1'500},
                                                {0, 10'000, 1'000},
                                                {0, 0, 1'000}}) {
    Rig rig({{"930", on}, {"913", kTravel}, {"914", kTravel}, {"911", 200}, {"912", 200}});
    rig.drive.set_analog({{millivolt, 0}, {5'000, 0}, 0, 0});
    rig.go(2'000'000);
    rig.run(1'000);
    const int32_t before = rig.h[491];
    rig.run(500);
    // 600 rpm of 4096 increments for half a second are 20480.
    EXPECT_NEAR(rig.h[491] - before, 20'480 * permille / 1'000, 2) << on << ' ' << millivolt;
  }
}

// What is reported says where the command stands that ordered it; a variable that was written has no such place.
TEST(PositioningReports, NameThePlaceOfTheCommand) {
  for (const bool by_command : {false, true}) {
    runtime::ParameterStore parameters(*stdlib::find_unit("md60a"));
    runtime::Drive drive(parameters);
    runtime::Journal journal;
    const runtime::OwnMilliseconds milliseconds;
    runtime::PositioningService service(milliseconds, drive, parameters, journal, "u",
                                        [](uint32_t address) { return "P.IPC:" + std::to_string(address); });
    std::array<int32_t, 512> h{};
    // Of a mode without positioning: F77 has no response, but is told.
    const auto tick = [&](runtime::Time now) {
      drive.tick(service.order(now, h, 0));
      service.observe();
      service.show(now, h);
    };
    tick(0);
    if (by_command) {
      service.take_targets(h);
      service.ordered_at(runtime::PositioningCause::Target, 17);
      service.change_positioner().write_target(5'000);
      service.show_targets(h);
    } else {
      h[492] = 5'000;
    }
    tick(runtime::kMillisecond);
    ASSERT_EQ(journal.entries().size(), 1U);
    const auto& entry = journal.entries()[0];
    EXPECT_EQ(entry.text.rfind("F77: ", 0), 0U) << entry.text;
    EXPECT_EQ(entry.text.find(", ordered at P.IPC:17)") != std::string::npos, by_command) << entry.text;
    EXPECT_EQ(entry.text.find("ordered") != std::string::npos, by_command) << entry.text;
    EXPECT_EQ(entry.station, "u");
    EXPECT_EQ(entry.time, runtime::kMillisecond);
  }
}

}  // namespace
}  // namespace ipos::tests

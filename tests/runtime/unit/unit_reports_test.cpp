// What a unit tells the journal by itself: its faults with their names, once each, and what its memory says.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <memory>

#include "runtime/unit/unit.hpp"
#include "stdlib/faults.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::runtime {
namespace {

struct ReportRig {
  ReportRig() { unit.power_on(); }
  void tick() {
    clock.run_until(clock.now() + kMillisecond);
    unit.tick(clock.now());
  }
  // The entries that begin with this.
  std::vector<JournalEntry> told(const std::string& begin) const {
    std::vector<JournalEntry> found;
    for (const JournalEntry& entry : journal.entries())
      if (entry.text.starts_with(begin)) found.push_back(entry);
    return found;
  }

  EventQueue clock;
  Journal journal;
  Unit unit{clock,        {"u", *stdlib::find_unit(std::string_view("mdxb")), {}, {}},
            std::nullopt, journal,
            std::nullopt, {}};
};

TEST(UnitReports, NameEveryFaultOnce) {
  size_t faults = 0;
  for (int number = 1; number <= 255; ++number) {
    const stdlib::FaultRow* row = stdlib::find_fault(static_cast<uint8_t>(number));
    if (row == nullptr) continue;
    ReportRig rig;
    rig.tick();
    EXPECT_TRUE(rig.told("F").empty()) << number;
    rig.unit.drive().raise_fault(static_cast<uint8_t>(number));
    const bool shown = rig.unit.drive().fault() == number;
    faults += shown ? 1 : 0;
    for (int n = 0; n < 3; ++n) rig.tick();
    const auto told = rig.told("F");
    ASSERT_EQ(told.size(), shown ? 1U : 0U) << number;
    if (!shown) continue;
    EXPECT_EQ(told[0].text, fmt::format("F{:02} {}: {}", number, row->name,
                                         stdlib::meaning_on(rig.unit.server().unit(), *row)));
    EXPECT_EQ(told[0].station, "u");
    EXPECT_EQ(told[0].time, 2 * kMillisecond);
    EXPECT_EQ(told[0].weight, rig.unit.drive().error() ? Weight::Fault : Weight::Warning) << number;
  }
  EXPECT_GT(faults, 20U);
}

// A fault that is only displayed (SETFR) is a warning.
TEST(UnitReports, AFaultThatIsOnlyDisplayedIsAWarning) {
  ReportRig rig;
  ASSERT_TRUE(rig.unit.drive().set_fault_response(78, FaultResponse::Display));
  rig.tick();
  rig.unit.drive().raise_fault(78);
  rig.tick();
  ASSERT_EQ(rig.told("F78").size(), 1U);
  EXPECT_EQ(rig.told("F78")[0].weight, Weight::Warning);
}

class UnwritableMedium final : public NvMedium {
 public:
  tl::expected<size_t, std::string> read(uint64_t, std::span<uint8_t>) override { return size_t{0}; }
  std::optional<std::string> write(uint64_t, std::span<const uint8_t>) override { return "it is broken"; }
  std::optional<std::string> sync() override { return "it is broken"; }
};

TEST(UnitReports, WhatTheMemorySays) {
  ReportRig rig;
  rig.unit.server().memory().open(std::make_unique<UnwritableMedium>(), "u.nv");
  ParameterStore& parameters = rig.unit.server().parameters();
  EXPECT_FALSE(parameters.execute(ParameterService::Write, parameters.table().find("130")->index, 3'000));
  EXPECT_TRUE(rig.told("u.nv").empty()) << "in the next millisecond";
  for (int n = 0; n < 3; ++n) rig.tick();
  const auto told = rig.told("u.nv: not stored: ");
  ASSERT_EQ(told.size(), 1U);
  EXPECT_NE(told[0].text.find("it is broken"), std::string::npos) << told[0].text;
  EXPECT_EQ(told[0].weight, Weight::Warning);
  EXPECT_EQ(told[0].time, kMillisecond);
  EXPECT_EQ(told[0].station, "u");
}

}  // namespace
}  // namespace ipos::runtime

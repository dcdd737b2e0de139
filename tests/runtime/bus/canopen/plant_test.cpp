// A MOVIDRIVE B with P880 = 1 in a plant: a model master brings it up and drives it, and what goes wrong on the line
// stops it.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>

#include "runtime/bus/canopen/master.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;
using runtime::canopen::Master;
using runtime::canopen::MasterSettings;
using runtime::canopen::NodePlan;

constexpr uint16_t kSpeed = 8318;

std::string station(const std::string& name, int address, const std::string& more = "") {
  return "[[station]]\nname = \"" + name +
         "\"\nunit = \"mdxb\"\nsbus = \"can\"\n[station.parameters]\nP880 = 1\nP886 = " +
         std::to_string(address) + "\nP100 = 10\nP101 = 3\n" + more +
         "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
}

struct PlantOfNodes {
  PlantOfNodes(const std::string& stations, MasterSettings settings) {
    goes_through(kPlantFile);
    auto file =
        runtime::read_plant_file("[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n" + stations);
    for (const auto& error : file.errors) ADD_FAILURE() << error.place.line << ": " << error.text;
    std::vector<runtime::PlantError> errors;
    std::vector<std::optional<vm::Image>> programs(file.plant.stations.size());
    plant =
        std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors);
    for (const auto& error : errors) ADD_FAILURE() << error.text;
    runtime::CanLine& line = plant->all<runtime::CanBus>()[0]->line();
    master = std::make_unique<Master>(plant->queue(), 1000, std::move(settings));
    port = std::make_unique<runtime::LinePort>(line, line.attach("master", line.baud(), *master));
    master->start(0, *port);
  }
  void run(runtime::Time span) { plant->run_until(plant->queue().now() + span); }
  int32_t speed(size_t n) const { return plant->stations()[n]->read(kSpeed); }
  bool says(const std::string& text) const {
    for (const auto& entry : plant->journal().entries())
      if (entry.text.find(text) != std::string::npos) return true;
    return false;
  }

  std::unique_ptr<runtime::Plant> plant;
  std::unique_ptr<Master> master;
  std::unique_ptr<runtime::LinePort> port;
};

NodePlan plan(uint8_t node) {
  NodePlan plan;
  plan.node = node;
  plan.output = {6, 5000, 500};  // enabled, 1000 rpm
  return plan;
}

TEST(CanopenPlant, AMasterDrivesTwoUnits) {
  MasterSettings settings;
  settings.sync_cycle = 5 * kMillisecond;
  settings.nodes = {plan(5), plan(6)};
  settings.nodes[1].writes = {{{8470, 0}, 1000, 4}};  // P130
  PlantOfNodes rig(station("a", 5) + station("b", 6), settings);
  rig.run(5 * kSecond);
  for (size_t n = 0; n < 2; ++n) {
    EXPECT_EQ(rig.master->report(n).phase, Master::Phase::Running);
    EXPECT_EQ(rig.speed(n), 1'000'000) << n;
    EXPECT_EQ(rig.master->report(n).input[1], 5000) << n;
    EXPECT_EQ(rig.master->report(n).input[0], rig.plant->stations()[n]->status_word_1());
  }
  EXPECT_EQ(rig.plant->stations()[1]->read(8470), 1000);
  // Pre-operational: no process data, no fault, a stop; operational again: it goes on.
  rig.master->command(runtime::canopen::NmtCommand::EnterPreOperational, 5);
  rig.run(3 * kSecond);
  EXPECT_EQ(rig.speed(0), 0);
  EXPECT_EQ(rig.plant->stations()[0]->fault(), 0);
  EXPECT_EQ(rig.speed(1), 1'000'000);
  rig.master->command(runtime::canopen::NmtCommand::Start, 5);
  rig.run(3 * kSecond);
  EXPECT_EQ(rig.speed(0), 1'000'000);
}

TEST(CanopenPlant, WhoIsNotGuardedStops) {
  PROVES("MDB-TOC-12", "MDB-TOC-13");
  MasterSettings settings;
  settings.sync_cycle = 5 * kMillisecond;
  settings.nodes = {plan(5)};
  settings.nodes[0].guard_time = 50;
  settings.nodes[0].life_factor = 3;
  PlantOfNodes rig(station("a", 5), settings);
  rig.run(5 * kSecond);
  EXPECT_EQ(rig.speed(0), 1'000'000);
  EXPECT_EQ(rig.plant->stations()[0]->fault(), 0);
  // The master falls silent: SBus timeout with the response of P836.
  rig.plant->all<runtime::CanBus>()[0]->line().set_connected(rig.port->node(), false);
  rig.run(2 * kSecond);
  EXPECT_EQ(rig.plant->stations()[0]->fault(), 47);
  EXPECT_EQ(rig.speed(0), 0);
  EXPECT_TRUE(rig.says("guarding or heartbeat of the master stayed away on SBus 1"));
  // It is back, and hears of both causes.
  rig.plant->all<runtime::CanBus>()[0]->line().set_connected(rig.port->node(), true);
  rig.run(kSecond);
  std::set<unsigned> codes;
  for (const auto& event : rig.master->report(0).emergencies) codes.insert(event.code);
  EXPECT_EQ(codes, (std::set<unsigned>{0x0000, 0x8130, 0xFF00}));  // guarding is gone, the fault is not
  EXPECT_EQ(rig.master->report(0).phase, Master::Phase::Running);
  EXPECT_EQ(rig.plant->stations()[0]->fault(), 47);
}

// "only 24 V backup (no mains)" is one of the three causes of EMCY (page 53 of 11264926); told once, and once when it is gone.
TEST(CanopenPlant, MissingMainsAreTold) {
  MasterSettings settings;
  settings.sync_cycle = 5 * kMillisecond;
  settings.nodes = {plan(5)};
  PlantOfNodes rig(station("a", 5, "P730 = 0\n"), settings);
  rig.run(2 * kSecond);
  runtime::Station& station = *rig.plant->stations()[0];
  EXPECT_EQ(station.set_switch(runtime::StationSwitch::Mains, 0), std::nullopt);
  rig.run(4 * kSecond);
  ASSERT_EQ(rig.master->report(0).emergencies.size(), 1U);
  EXPECT_EQ(rig.master->report(0).emergencies[0].code, 0x3100);
  EXPECT_EQ(rig.speed(0), 0) << "it has run out";
  EXPECT_EQ(rig.master->report(0).phase, Master::Phase::Running) << "the node lives on";
  EXPECT_TRUE(rig.says("not enabled: no mains"));
  EXPECT_EQ(station.set_switch(runtime::StationSwitch::Mains, 1), std::nullopt);
  rig.run(2 * kSecond);
  ASSERT_EQ(rig.master->report(0).emergencies.size(), 2U);
  EXPECT_EQ(rig.master->report(0).emergencies[1].code, 0);
  EXPECT_EQ(rig.speed(0), 1'000'000);
}

// The master hears an abort, the user a reason.
TEST(CanopenPlant, RefusedParametersAreExplained) {
  MasterSettings settings;
  settings.nodes = {plan(5)};
  settings.nodes[0].writes = {{{8470, 0}, 3'000'000, 4}};
  PlantOfNodes rig(station("a", 5), settings);
  rig.run(kSecond);
  EXPECT_EQ(rig.master->report(0).phase, Master::Phase::Refused);
  EXPECT_EQ(rig.master->report(0).abort, 0x0609'0031U);
  EXPECT_TRUE(rig.says("refused P130 Ramp t11 UP CW := 3000.000 s: parameter value too large"));
}

TEST(CanopenPlant, PowerOffAndOn) {
  MasterSettings settings;
  settings.sync_cycle = 5 * kMillisecond;
  settings.nodes = {plan(5)};
  PlantOfNodes rig(station("a", 5), settings);
  rig.run(kSecond);
  const uint32_t boots = rig.master->report(0).boot_ups;
  rig.plant->stations()[0]->power_off();
  rig.run(kSecond);
  rig.plant->stations()[0]->power_on();
  rig.run(5 * kSecond);
  EXPECT_EQ(rig.master->report(0).boot_ups, boots + 1);
  EXPECT_EQ(rig.speed(0), 1'000'000);
}

}  // namespace
}  // namespace ipos::tests

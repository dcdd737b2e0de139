// Actions on a plant: what is set, forced and released, words of the bus that counts, faults and orders.
#include "runtime/plant/actions.hpp"

#include "runtime/signals/find.hpp"
#include "tests/runtime/plant/plain_plant.hpp"

namespace ipos::runtime {
namespace {

using tests::PlainPlant;

const std::string kHandled = "[[station]]\nname = 'u'\nunit = 'mdxb'\n";

signals::Signal signal_of(const PlainPlant& plant, const std::string& name) {
  return signals::find_signals(*plant, "u." + name).value().front();
}

void run_on(const PlainPlant& plant, int64_t ms) { plant->run_until(plant->now() + ms * kMillisecond); }

TEST(ActionsOnAPlant, SetForceAndReleaseAnInput) {
  const PlainPlant plant(
      kHandled +
      "[[wire]]\nfrom = 'u.DO05'\nto = 'u.DI04'\n[[wire]]\nfrom = 'u.DO05'\nto = 'u.DI05'\ninvert = true\n");
  PlantActions actions(*plant, "a test");
  run_on(plant, 5);
  const auto level = [&](int line) { return std::as_const(plant.station()).inputs().levels() >> line & 1; };
  const signals::Signal free = signal_of(plant, "DI03");
  EXPECT_EQ(actions.set(free, 1), std::nullopt);
  EXPECT_EQ(level(3), 1);
  EXPECT_EQ(actions.force(free, 0), std::nullopt);
  EXPECT_EQ(level(3), 0);
  EXPECT_EQ(actions.set(free, 1), std::nullopt);
  run_on(plant, 5);
  EXPECT_EQ(level(3), 0) << "it is forced";
  actions.release(free);
  EXPECT_EQ(level(3), 1);
  const signals::Signal driven = signal_of(plant, "DI05");
  EXPECT_EQ(level(5), 1) << "the wire inverts";
  EXPECT_EQ(actions.set(driven, 0), "DI05 of u hangs on a wire or switch: force it, do not set it");
  EXPECT_EQ(actions.force(driven, 0), std::nullopt);
  run_on(plant, 5);
  EXPECT_EQ(level(5), 0);
  actions.release(driven);
  EXPECT_EQ(level(5), 1);
}

TEST(ActionsOnAPlant, SetForceAndReleaseAParameter) {
  const PlainPlant plant(kHandled);
  PlantActions actions(*plant, "a test");
  run_on(plant, 5);
  const signals::Signal ramp = signal_of(plant, "P130");
  EXPECT_EQ(actions.set(ramp, 3'000), std::nullopt);
  EXPECT_EQ(plant.parameter("130"), 3'000);
  const signals::Signal speed = signal_of(plant, "P160");
  const Refusal refused = actions.set(speed, 600'001);
  ASSERT_TRUE(refused) << "no step of P160";
  EXPECT_EQ(actions.force(speed, 600'001), refused);
  EXPECT_EQ(actions.force(ramp, 5'000), std::nullopt);
  EXPECT_EQ(plant.parameter("130"), 5'000);
  EXPECT_EQ(actions.set(ramp, 3'000), std::nullopt);
  run_on(plant, 2);
  EXPECT_EQ(plant.parameter("130"), 5'000) << "written again";
  actions.release(ramp);
  EXPECT_EQ(actions.set(ramp, 3'000), std::nullopt);
  run_on(plant, 5);
  EXPECT_EQ(plant.parameter("130"), 3'000);
}

// A word comes as over the bus that P101 names, or P100, or else the SBus. P871 is SPEED, 0.2 rpm a digit.
TEST(ActionsOnAPlant, WordsComeOverTheBusThatCounts) {
  for (const auto& [control, setpoint] : {std::pair(1, 2), std::pair(2, 3), std::pair(3, 10), std::pair(0, 2),
                                          std::pair(0, 3), std::pair(0, 10)}) {
    const PlainPlant plant(kHandled + "[station.parameters]\nP100 = " + std::to_string(setpoint) +
                           "\nP101 = " + std::to_string(control) +
                           "\nP130 = 0\nP876 = 1\n[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n");
    EXPECT_TRUE(plant.errors.empty());
    PlantActions actions(*plant, "a test");
    Station& station = plant.station();
    const auto word = [&](int n) { return signal_of(plant, "PO" + std::to_string(n + 1)); };
    run_on(plant, 100);
    actions.force(word(0), 6);
    actions.force(word(1), 1'500);
    run_on(plant, 2'000);
    EXPECT_EQ(station.drive().state().speed(), 300'000) << control << ' ' << setpoint;
    EXPECT_EQ(station.fault(), 0);
    EXPECT_EQ(station.drive().state().po()[1], 1'500);
    actions.set(word(1), 1'000);
    EXPECT_EQ(station.drive().state().po()[1], 1'000);
    run_on(plant, 2);
    EXPECT_EQ(station.drive().state().po()[1], 1'500) << "it is forced";
    actions.release(word(1));
    actions.set(word(1), 500);
    run_on(plant, 5);
    EXPECT_EQ(station.drive().state().po()[1], 500);
    EXPECT_EQ(station.drive().state().po()[0], 6) << "the other is held still";
  }
}

TEST(ActionsOnAPlant, OrdersToAStation) {
  const PlainPlant plant(kHandled);
  Station& station = plant.station();
  EXPECT_EQ(PlantActions::order(station, ProgramOrder::Stop), std::nullopt);
  plant->set_power("u", false);
  for (const ProgramOrder order : {ProgramOrder::Start, ProgramOrder::Restart})
    EXPECT_EQ(PlantActions::order(station, order), "the station is off");
}

// Its times count from a moment.
TEST(ActionsOnAPlant, PlantAFault) {
  const PlainPlant plant("[[bus]]\nname = 'b'\nkind = 'can'\n" + kHandled + "sbus = 'b'\n");
  PlantActions actions(*plant, "a test");
  FaultConfig fault;
  fault.bus = "b";
  fault.station = "v";
  EXPECT_EQ(actions.plant_fault(fault, 0), "station 'v' is not on bus 'b'");
  fault.station = "";
  fault.fault.kind = FaultKind::Stuck;
  fault.fault.until = 5 * kMillisecond;
  EXPECT_EQ(actions.plant_fault(fault, 10 * kMillisecond), std::nullopt);
  run_on(plant, 9);
  EXPECT_TRUE(plant.told("", "is held dominant").empty());
  run_on(plant, 10);
  EXPECT_FALSE(plant.told("", "is held dominant").empty());
}

}  // namespace
}  // namespace ipos::runtime

// Binary outputs P620.. and the reference signals P400..P442 with hysteresis, delay and sense (1053 1610 p.
// 76, 79), and images and error memory of MOVITRAC 07 (its manual, chapter 10.3).
#include "runtime/drive/outputs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "stdlib/unsimulated.hpp"

#include "tests/runtime/drive/drive_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::OutputFunction;
using runtime::OutputInputs;
namespace output_flags = runtime::output_flags;
using runtime::Outputs;

// One output with the function, fed with values of the test.
struct Bench {
  explicit Bench(OutputFunction function) { settings.outputs[1] = static_cast<uint8_t>(function); }
  bool run(int ms = 1) {
    for (int i = 0; i < ms; ++i) outputs.tick(settings, in);
    return (outputs.levels() & 2) != 0;
  }
  runtime::ParameterStore store{unit("md60a")};
  runtime::Settings settings = runtime::SettingsReader(store).read(store);
  Outputs outputs;
  OutputInputs in;
};

// Settles for a second, steps to `value`, and counts the milliseconds until the output changes; 0: it does
// not within two seconds.
int ms_until_change(Bench& bench, const std::function<void()>& step) {
  bench.run(2000);
  const bool before = bench.run();
  step();
  for (int ms = 1; ms <= 2000; ++ms)
    if (bench.run() != before) return ms;
  return 0;
}

// The change shows when it has lasted for the delay: in the tick of the change with no delay.
void expect_signal(Bench& bench, int delay, bool want, const std::function<void()>& step, const char* what) {
  const int ms = ms_until_change(bench, step);
  EXPECT_EQ(ms, delay + 1) << what;
  EXPECT_EQ(bench.run(), want) << what;
}
void expect_no_change(Bench& bench, const std::function<void()>& step, const char* what) {
  EXPECT_EQ(ms_until_change(bench, step), 0) << what;
}

// go_on() is a tick with other values where nothing but time passes; random walks across all limits.
TEST(ReferenceSignals, GoOnAsTicksDo) {
  std::mt19937 random(1);
  const auto pick = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  int gone_on = 0;
  for (int run = 0; run < 200; ++run) {
    Bench kept(OutputFunction::SpeedReference), ticked(OutputFunction::SpeedReference);
    runtime::Settings& s = kept.settings;
    for (uint8_t f = 9; f <= 13; ++f) s.outputs[f - 1] = f;  // all reference signals
    for (int32_t* delay :
         {&s.speed_delay, &s.window_delay, &s.compare_delay, &s.current_delay, &s.limit_delay})
      *delay = pick(0, 2) * pick(0, 40);
    s.speed_reference = pick(0, 60);
    s.speed_hysteresis = pick(0, 20);
    s.window_center = pick(0, 60);
    s.window_width = pick(0, 40);
    s.compare_hysteresis = pick(0, 30);
    s.current_reference = pick(0, 60);
    s.current_hysteresis = pick(0, 20);
    s.limit_hysteresis = pick(0, 20);
    ticked.settings = s;
    const int step = pick(0, 4);
    for (int ms = 0; ms < 1000; ++ms) {
      OutputInputs& in = kept.in;
      in.speed = std::clamp(in.speed + pick(-step, step), -80, 80);
      in.current = std::clamp(in.current + pick(-step, step), -80, 80);
      if (pick(0, 99) == 0) in.setpoint = pick(-60, 60);
      if (pick(0, 99) == 0) in.current_limit = pick(0, 60);
      if (pick(0, 99) == 0) in.flags ^= output_flags::kFault;
      if (pick(0, 19) == 0) in.limited = !in.limited;
      if (pick(0, 99) == 0) in.ipos_outputs = static_cast<uint16_t>(pick(0, 0xFFFF));
      ticked.in = in;
      if (ms != 0 && kept.outputs.go_on(in))
        ++gone_on;
      else
        kept.run();
      ticked.run();
      ASSERT_EQ(kept.outputs.levels(), ticked.outputs.levels()) << "run " << run << " after " << ms << " ms";
    }
  }
  EXPECT_GT(gone_on, 100'000);
}

TEST(ReferenceSignals, Speed) {
  PROVES("DRV-01");
  for (const int32_t delay : {0, 500})
    for (const int32_t when : {0, 1}) {
      Bench bench(OutputFunction::SpeedReference);
      bench.settings.speed_reference = 1'000'000;
      bench.settings.speed_hysteresis = 100'000;
      bench.settings.speed_delay = delay;
      bench.settings.speed_when = when;
      const bool above = when == 1;
      const auto to = [&](int32_t speed) { return [&bench, speed] { bench.in.speed = speed; }; };
      EXPECT_EQ(bench.run(2000), !above);
      expect_no_change(bench, to(1'000'000), "not above the reference");
      expect_signal(bench, delay, above, to(1'000'200), "above");
      expect_no_change(bench, to(900'200), "inside the hysteresis");
      expect_signal(bench, delay, !above, to(900'000), "below it");
      expect_no_change(bench, to(-950'000), "the amount counts");
      expect_signal(bench, delay, above, to(-1'000'200), "CCW");
    }
}

TEST(ReferenceSignals, ShortChangesDoNotShow) {
  Bench bench(OutputFunction::SpeedReference);
  bench.settings.speed_delay = 100;
  bench.settings.speed_when = 1;
  bench.run(500);
  for (int n = 0; n < 20; ++n) {
    bench.in.speed = 2'000'000;
    EXPECT_FALSE(bench.run(99));
    bench.in.speed = 0;
    EXPECT_FALSE(bench.run(50));
  }
}

TEST(ReferenceSignals, SpeedWindow) {
  PROVES("DRV-02");
  for (const int32_t when : {0, 1}) {
    Bench bench(OutputFunction::SpeedWindow);
    bench.settings.window_center = 1'000'000;
    bench.settings.window_width = 200'000;
    bench.settings.window_delay = 300;
    bench.settings.window_when = when;
    const bool inside = when == 0;
    const auto to = [&](int32_t speed) { return [&bench, speed] { bench.in.speed = speed; }; };
    EXPECT_EQ(bench.run(2000), !inside);
    expect_no_change(bench, to(899'800), "below");
    expect_signal(bench, 300, inside, to(900'000), "lower edge");
    expect_no_change(bench, to(1'100'000), "upper edge");
    expect_signal(bench, 300, !inside, to(1'100'200), "above");
    expect_signal(bench, 300, inside, to(-1'000'000), "CCW");
  }
}

TEST(ReferenceSignals, SetpointReached) {
  PROVES("DRV-03");
  for (const int32_t when : {0, 1}) {
    Bench bench(OutputFunction::SetpointReached);
    bench.settings.compare_hysteresis = 50'000;
    bench.settings.compare_delay = 200;
    bench.settings.compare_when = when;
    const bool reached = when == 1;
    bench.in.setpoint = 1'000'000;
    EXPECT_EQ(bench.run(2000), !reached);
    expect_signal(
        bench, 200, reached, [&] { bench.in.speed = 950'000; }, "within");
    expect_no_change(
        bench, [&] { bench.in.speed = 1'050'000; }, "within above");
    expect_signal(
        bench, 200, !reached, [&] { bench.in.speed = -1'000'000; }, "the sign counts");
  }
}

#ifndef IPOS_DRIVE_IN_A_PLANT  // there the program orders a travel
// A travel has the speed that positioning orders as its setpoint, in both directions.
TEST(ReferenceSignals, SetpointReachedWhilePositioning) {
  DriveRig rig("md60a");
  rig.set("P700", 13);
  rig.set("P421", 0);
  rig.set("P621", 11);
  rig.enable_terminals();
  rig.positioning.controls = true;
  for (const int32_t speed : {500'000, -500'000, 30'000}) {
    rig.positioning.speed = speed;
    rig.run_ms(100);
    ASSERT_EQ(rig.drive.axis().speed, speed);
    EXPECT_TRUE(rig.output("DO02")) << speed;
  }
}
#endif

TEST(ReferenceSignals, Current) {
  PROVES("DRV-04");
  for (const int32_t when : {0, 1}) {
    Bench bench(OutputFunction::CurrentReference);
    bench.settings.current_reference = 100'000;
    bench.settings.current_hysteresis = 5'000;
    bench.settings.current_delay = 400;
    bench.settings.current_when = when;
    const bool above = when == 1;
    const auto to = [&](int32_t current) { return [&bench, current] { bench.in.current = current; }; };
    EXPECT_EQ(bench.run(2000), !above);
    expect_no_change(bench, to(100'000), "at the reference");
    expect_signal(bench, 400, above, to(100'100), "above");
    expect_no_change(bench, to(95'100), "inside the hysteresis");
    expect_signal(bench, 400, !above, to(95'000), "below");
  }
}

TEST(ReferenceSignals, CurrentLimit) {
  for (const int32_t when : {0, 1}) {
    Bench bench(OutputFunction::CurrentLimit);
    bench.in.current_limit = 150'000;
    bench.settings.limit_hysteresis = 10'000;
    bench.settings.limit_delay = 100;
    bench.settings.limit_when = when;
    const bool limited = when == 0;
    const auto to = [&](int32_t current) { return [&bench, current] { bench.in.current = current; }; };
    EXPECT_EQ(bench.run(2000), !limited);
    expect_no_change(bench, to(149'900), "below the limit");
    expect_signal(bench, 100, limited, to(150'000), "at the limit");
    expect_no_change(bench, to(140'000), "inside the hysteresis");
    expect_signal(bench, 100, !limited, to(139'900), "below");
  }
}

// The current that shows may be a little less than the limit, however it was rounded.
TEST(ReferenceSignals, CurrentLimitOfTheAxis) {
  for (const int32_t when : {0, 1}) {
    Bench bench(OutputFunction::CurrentLimit);
    bench.in.current_limit = 150'000;
    bench.settings.limit_hysteresis = 10'000;
    bench.settings.limit_delay = 100;
    bench.settings.limit_when = when;
    const bool limited = when == 0;
    const auto to = [&](int32_t current, bool gives_all) {
      return [&bench, current, gives_all] { bench.in.current = current, bench.in.limited = gives_all; };
    };
    EXPECT_EQ(bench.run(2000), !limited);
    expect_signal(bench, 100, limited, to(149'998, true), "at the limit");
    expect_no_change(bench, to(149'998, false), "inside the hysteresis");
    expect_signal(bench, 100, !limited, to(139'900, false), "below");
  }
}

// A hysteresis that is wider than its reference ends at 0: no signal stays when everything is at rest.
TEST(ReferenceSignals, FallAtRestWhateverTheirHysteresis) {
  using F = OutputFunction;
  for (const F function : {F::SpeedReference, F::CurrentReference, F::CurrentLimit})
    for (const int32_t reference : {1, 50, 99, 100, 101, 5'000})
      for (const int32_t hysteresis : {0, 1, 50, 99, 100, 101, 5'000}) {
        Bench bench(function);
        runtime::Settings& s = bench.settings;
        s.speed_reference = s.current_reference = bench.in.current_limit = reference;
        s.speed_hysteresis = s.current_hysteresis = s.limit_hysteresis = hysteresis;
        s.speed_delay = s.current_delay = s.limit_delay = 0;
        s.speed_when = s.current_when = 1;
        s.limit_when = 0;
        bench.in.speed = bench.in.current = reference + 1;
        EXPECT_TRUE(bench.run()) << reference << ", " << hysteresis;
        bench.in.speed = bench.in.current = 0;
        EXPECT_FALSE(bench.run()) << static_cast<int>(function) << ": " << reference << ", " << hysteresis;
      }
}

// Imax of a drive with a heavy load, at every current limit. The active current is what the magnetizing one, 60 % of
// IN, leaves of the limit; rated torque needs 80 % and turns the bare rotor from 0 to 1500 rpm in 50 ms. A load of 19
// rotors makes that 20 times as long. The drive is at its limit until it has its speed; then it needs no torque.
struct ImaxRun {
  int32_t limit;       // P303, %
  int32_t hysteresis;  // P440, %
  int32_t delay;       // P441, ms
  int32_t when;        // P442
  bool ccw;
};
double ms_to_1500_rpm(int32_t limit) {
  const double torque = std::sqrt(double(limit) * limit - 60.0 * 60.0) / 80;
  return 50 * 20 / torque;
}
void expect_imax(const ImaxRun& run) {
  MachineData machine = light_machine();
  machine.inertia = 1'900;
  DriveRig rig("md60a", {}, machine);
  rig.bus_control();
  for (const char* ramp : {"P130", "P131", "P132", "P133"}) rig.set(ramp, 0);
  rig.set("P303", run.limit * 1'000);
  rig.set("P440", run.hysteresis * 1'000);
  rig.set("P441", run.delay);
  rig.set("P442", run.when);
  rig.set("P500", 0);
  rig.set("P621", 13);
  const auto imax = [&] { return rig.output("DO02") == (run.when == 0); };
  const auto word = [&](int rpm) { return static_cast<uint16_t>(static_cast<int16_t>((run.ccw ? -rpm : rpm) * 5)); };
  if (run.limit > 60) {  // the magnetizing current alone is below the limit
    rig.run_ms(run.delay + 5);
    EXPECT_FALSE(imax()) << "at rest";
  }
  rig.po({6, word(1'500), 0});
  EXPECT_NEAR(rig.ms_until(imax, 1'000), run.delay, 3);
  // Motor: until it has 1500 rpm. The signal of a narrow limit is still within its hysteresis then.
  const bool falls = run.limit > 60 && 60 < run.limit - run.hysteresis;
  const double way = run.limit > 60 ? ms_to_1500_rpm(run.limit) : 0;
  if (run.limit == 60) {
    rig.run_ms(2'000);
    EXPECT_EQ(rig.rpm(), 0) << "all current magnetizes";
    EXPECT_TRUE(imax());
    return;
  }
  if (!falls) {
    rig.run_ms(static_cast<int>(way) + 2'000);
    EXPECT_TRUE(imax());
    return;
  }
  EXPECT_NEAR(rig.ms_until([&] { return !imax(); }), way, 5 + way / 200);
  EXPECT_NEAR(std::abs(rig.rpm()), 1'500, 0.01);
  rig.run_ms(500);
  // Generator and motor: down to 0 and up again.
  rig.po({6, word(-1'500), 0});
  EXPECT_NEAR(rig.ms_until(imax, 1'000), run.delay, 3);
  EXPECT_NEAR(rig.ms_until([&] { return !imax(); }), 2 * way, 5 + way / 100);
  rig.run_ms(500);
  EXPECT_FALSE(imax());
}

TEST(Imax, AtEveryLimit) {
  PROVES("DRV-05");
  for (int32_t limit = 60; limit <= 150; ++limit)
    for (const int32_t when : {0, 1}) {
      SCOPED_TRACE(testing::Message() << "P303 " << limit << " %, P442 " << when);
      expect_imax({limit, 5, limit % 2 == 0 ? 0 : 100, when, limit % 3 == 0});
    }
}

TEST(Imax, HysteresisAndDelay) {
  for (const int32_t limit : {70, 109, 111, 150})
    for (const int32_t hysteresis : {5, 50})
      for (const int32_t delay : {0, 100, 1'000}) {
        // What is over before the delay does not show: then there is nothing to expect.
        if (delay >= ms_to_1500_rpm(limit)) continue;
        SCOPED_TRACE(testing::Message() << limit << " %, " << hysteresis << " %, " << delay << " ms");
        expect_imax({limit, hysteresis, delay, 0, false});
      }
}

// In torque control the current setpoint alone may be beyond the limit; nothing lags then.
TEST(Imax, OfATorqueSetpointBeyondTheLimit) {
  for (const int32_t limit : {70, 80, 100, 145}) {
    DriveRig rig("md60a");
    rig.bus_control();
    rig.set("P700", 12);
    rig.set("P871", 2);
    rig.set("P302", 5'000'000);
    rig.set("P303", limit * 1'000);
    rig.set("P441", 0);
    rig.set("P442", 0);
    rig.set("P621", 13);
    const double most = std::sqrt(double(limit) * limit - 60.0 * 60.0);  // active current, %
    rig.po({6, static_cast<uint16_t>(most * 10 - 20), 0});
    rig.run_ms(5);
    EXPECT_FALSE(rig.output("DO02")) << limit << ": 2 % below";
    rig.po({6, static_cast<uint16_t>(most * 10 + 20), 0});
    rig.run_ms(5);
    EXPECT_TRUE(rig.output("DO02")) << limit << ": 2 % beyond";
  }
}

TEST(OutputFunctions, EachFollowsItsState) {
  PROVES("DRV-06");
  struct Row {
    OutputFunction function;
    std::function<void(OutputInputs&)> act;
    bool before, after;
  };
  using F = OutputFunction;
  const Row rows[] = {
      {F::None, [](OutputInputs&) {}, false, false},
      {F::NoFault, [](OutputInputs& in) { in.flags = output_flags::kFault; }, true, false},
      {F::Ready, [](OutputInputs& in) { in.flags = output_flags::kReady; }, false, true},
      {F::OutputStageOn, [](OutputInputs& in) { in.flags = output_flags::kOutputStage; }, false, true},
      {F::RotatingField, [](OutputInputs& in) { in.flags = output_flags::kOutputStage; }, false, true},
      {F::BrakeReleased, [](OutputInputs& in) { in.flags = output_flags::kBrakeReleased; }, false, true},
      {F::BrakeApplied, [](OutputInputs& in) { in.flags = output_flags::kBrakeReleased; }, true, false},
      {F::Standstill, [](OutputInputs& in) { in.flags = output_flags::kStandstill; }, false, true},
      {F::ParameterSet, [](OutputInputs& in) { in.flags = output_flags::kSecondSet; }, false, true},
      {F::NoMotorUtilization1, [](OutputInputs& in) { in.flags = output_flags::kMotor1Overloaded; }, true,
       false},
      {F::NoMotorUtilization2, [](OutputInputs& in) { in.flags = output_flags::kMotor2Overloaded; }, true,
       false},
      {F::NoDrsPrewarning, [](OutputInputs&) {}, true, true},
      {F::NoDrsLagError, [](OutputInputs&) {}, true, true},
      {F::DrsInPosition, [](OutputInputs&) {}, false, false},
      {F::IposInPosition, [](OutputInputs& in) { in.flags = output_flags::kInPosition; }, false, true},
      {F::IposReferenced, [](OutputInputs& in) { in.flags = output_flags::kReferenced; }, false, true},
      {F::IposOutput, [](OutputInputs& in) { in.ipos_outputs = 2; }, false, true},
      {F::NoIposFault, [](OutputInputs& in) { in.flags = output_flags::kIposFault; }, true, false},
  };
  for (const Row& row : rows) {
    Bench bench(row.function);
    EXPECT_EQ(bench.run(), row.before) << static_cast<int>(row.function);
    row.act(bench.in);
    EXPECT_EQ(bench.run(), row.after) << static_cast<int>(row.function);
  }
}

// P001 = P000 x P850 / P851 (1053 1610 p. 68, 81), P022 = P303 x AI2 / 10 V (p. 68), to the last digit.
TEST(DisplayValues, UserDisplayAndExternalLimit) {
  PROVES("DRV-07");
  DriveRig rig("md60a");
  rig.bus_control();
  rig.set("P302", 5'000'000);
  const auto ai2 = [&](int32_t millivolt) {
    auto analog = rig.drive.analog();
    analog.ai2 = {millivolt, 0};
    rig.drive.set_analog(analog);
  };
  for (const int rpm : {1'000, -1'000, 4'000, 7})
    for (const auto& [numerator, denominator] : {std::pair(1, 1), {2, 1}, {1, 3}, {65'535, 1}, {1, 65'535}}) {
      rig.set("P850", numerator);
      rig.set("P851", denominator);
      rig.po({6, static_cast<uint16_t>(static_cast<int16_t>(rpm * 5)), 0});
      rig.settle();
      rig.run_ms(10);
      const int64_t exact = int64_t{rpm} * 1'000 * numerator / denominator;
      EXPECT_EQ(rig.value("P001"), std::clamp<int64_t>(exact, INT32_MIN, INT32_MAX)) << rpm << " x " << numerator;
    }
  for (const int32_t limit : {150, 100, 60})
    for (const int32_t millivolt : {0, 1, 5'000, 10'000, 12'000, -3}) {
      rig.set("P303", limit * 1'000);
      ai2(millivolt);
      rig.run_ms(1);
      EXPECT_EQ(rig.value("P022"), limit * std::clamp(millivolt, 0, 10'000) / 10) << limit << ", " << millivolt;
    }
}

// A display value that reads the same whatever the drive goes through says nothing: `ipos explain` tells it then.
TEST(DisplayValues, ThatSayNothingAreTold) {
  for (const char* name : {"md60a", "compact", "mc07", "mdxb"}) {
    MachineData machine;
    machine.inertia = 5'000;  // so that braking shows in the DC link
    DriveRig rig(name, {}, machine);
    for (const char* monitoring : {"P500", "P502"})
      if (rig.parameters.table().find(monitoring) != nullptr) rig.set(monitoring, 0);
    if (rig.parameters.table().find("P875") != nullptr) rig.set("P875", 6);
    std::map<uint16_t, std::set<int32_t>> seen;
    const auto look = [&] {
      for (const stdlib::Parameter* p : rig.parameters.table().by_index())
        if (!p->writable) seen[p->index].insert(rig.parameters.value(p->index));
    };
    look();
    rig.bus_control();
    constexpr uint16_t kAllButCcw = 0xFFFB;
    rig.drive.set_inputs(kAllButCcw);
    runtime::AnalogInputs analog;
    analog.ai1 = {5'000, 10'000};
    analog.ai2 = {5'000, 10'000};
    rig.drive.set_analog(analog);
    rig.po({6, 5'000, 17});
    rig.run_ms(500'000);
    look();
    rig.po({6, static_cast<uint16_t>(-5'000), 17});
    rig.run_ms(200);
    look();
    const auto has = [&](const char* number) { return rig.parameters.table().find(number) != nullptr; };
    if (has("P630")) rig.set("P630", 3);  // DO10: the output stage is on
    rig.po({1, 0, 0});
    rig.run_ms(10'000);
    if (has("P313")) rig.set("P604", 7);  // DI05: the other parameter set
    rig.po({6, 5'000, 17});
    rig.run_ms(60'000);
    look();
    for (int fault = 0; fault < 6; ++fault) {  // the error memory has five entries
      rig.drive.raise_fault(static_cast<uint8_t>(fault % 2 == 0 ? 1 : 7));
      rig.run_ms(100);
      look();
      rig.drive.reset_fault();
      rig.po({6, 5'000, 17});
      rig.run_ms(60'000);
    }
    look();
    for (const stdlib::Parameter* p : rig.parameters.table().by_index()) {
      if (p->writable || p->number.empty()) continue;
      const bool told = !stdlib::unshown(unit(name), *p).empty();
      // Without the option DIO there are no such outputs.
      if (p->number == "068" && name == std::string_view("compact")) continue;
      const bool set_by_card = p->index == 8362 || (p->index >= 8452 && p->index <= 8454);  // P072, P091..P093
      const bool constant = p->index == 8300 || p->index == 8361;                            // P076, P071
      const bool says = seen[p->index].size() > 1 || set_by_card || constant;
      EXPECT_EQ(told, !says) << name << ": P" << p->number << " " << p->name;
    }
  }
}

TEST(OutputFunctions, OfADriveAtWork) {
  DriveRig rig("md60a");
  rig.bus_control();
  rig.set("P731", 50);
  rig.set("P732", 80);
  // DO10..DO17: output stage, brake released, brake applied, standstill, setpoint reached, IPOS output, set.
  constexpr int kFunctions[] = {3, 5, 6, 7, 11, 21, 22, 8};
  const char* const kNumbers[] = {"P630", "P631", "P632", "P633", "P634", "P635", "P636", "P637"};
  for (int n = 0; n < 8; ++n) rig.set(kNumbers[n], kFunctions[n]);
  rig.set("P421", 0);
  rig.po({0, 0, 0});
  rig.run_ms(10);
  EXPECT_FALSE(rig.output("DO10"));
  EXPECT_FALSE(rig.output("DO11"));
  EXPECT_TRUE(rig.output("DO12"));
  EXPECT_TRUE(rig.output("DO13"));
  EXPECT_TRUE(rig.output("DO01")) << "P620 = READY";
  rig.po({0x0006, 5000, 0});
  rig.run_ms(20);
  EXPECT_TRUE(rig.output("DO10"));
  EXPECT_TRUE(rig.output("DO11")) << "the brake opens";
  EXPECT_TRUE(rig.output("DB00"));
  EXPECT_TRUE(rig.output("DO13")) << "and the motor holds meanwhile";
  EXPECT_FALSE(rig.output("DO14")) << "1000 rpm are ordered";
  rig.settle();
  rig.run_ms(700);
  EXPECT_FALSE(rig.output("DO13"));
  EXPECT_TRUE(rig.output("DO14"));
  EXPECT_EQ(rig.drive.status_word_2() >> 8, rig.value("P068")) << "virtual outputs of status word 2";
  EXPECT_EQ(rig.drive.outputs() >> 8, 0b0101'0011);
  rig.drive.set_ipos_outputs(1U << 13);
  rig.run_ms(1);
  EXPECT_TRUE(rig.output("DO15"));
  rig.drive.raise_fault(10);
  rig.run_ms(1);
  EXPECT_FALSE(rig.output("DO16")) << "/IPOS ERROR";
  EXPECT_FALSE(rig.output("DO02")) << "P621 = /ERROR";
  EXPECT_FALSE(rig.output("DO01"));
}

TEST(OutputFunctions, SpeedReferenceOfMovitrac07) {
  PROVES("M07-PAR-30");
  const DriveRig fresh("mc07");
  EXPECT_EQ(fresh.value("P400"), 1'500'000);
  EXPECT_EQ(fresh.value("P401"), 100'000);
  EXPECT_EQ(fresh.value("P402"), 1000);
  for (const int32_t when : {0, 1}) {
    DriveRig rig("mc07");
    rig.bus_control();
    rig.set("P403", when);
    rig.set("P620", 9);
    rig.set("P400", 500'000);
    rig.set("P130", 1500);  // 1 rpm a millisecond
    rig.set("P131", 1500);
    const bool above = when == 1;
    rig.po({0x0006, 5000, 0});
    rig.run_ms(1400);
    EXPECT_EQ(rig.output("DO01"), !above) << "500 rpm are passed after 0.5 s, the delay is 1 s";
    rig.run_ms(200);
    EXPECT_EQ(rig.output("DO01"), above);
    rig.po({0x0006, 2250, 0});  // 450 rpm: inside the hysteresis
    rig.run_ms(3000);
    EXPECT_EQ(rig.output("DO01"), above);
    rig.po({0x0006, 1500, 0});  // 300 rpm, 400 passed after 50 ms
    rig.run_ms(1000);
    EXPECT_EQ(rig.output("DO01"), above);
    rig.run_ms(100);
    EXPECT_EQ(rig.output("DO01"), !above);
  }
}

TEST(M07Parameters, InputAndOutputImages) {
  PROVES("M07-PAR-25");
  DriveRig rig("mc07");
  rig.set("P621", 0);
  rig.drive.set_inputs(0);
  for (int n = 1; n <= 5; ++n) {
    rig.drive.set_inputs(static_cast<uint16_t>(1U << n));
    EXPECT_EQ(rig.parameters.value(8334), 1 << n);
  }
  rig.drive.set_inputs(1);
  EXPECT_EQ(rig.parameters.value(8334), 0) << "bit 0 is unused";
  rig.run_ms(1);
  EXPECT_EQ(rig.parameters.value(8349), 2) << "DO01 = /FAULT";
  rig.set("P620", 0);
  rig.set("P621", 2);
  rig.run_ms(1);
  EXPECT_EQ(rig.parameters.value(8349), 4);
}

TEST(M07Parameters, FaultMemoryKeepsTheInstant) {
  PROVES("M07-PAR-26");
  MachineData machine = light_machine();
  machine.load_torque = 50'000;
  DriveRig rig("mc07", {}, machine);
  rig.bus_control();
  rig.po({0x0006, 2000, 0});
  rig.settle();
  rig.run_ms(20'000);
  const auto now = rig.drive.axis();
  const int32_t inputs = rig.value("P036"), outputs = rig.value("P053");
  EXPECT_EQ(now.speed, 400'000);
  EXPECT_GT(now.utilization, 0);
  rig.drive.raise_fault(1);
  rig.silence();
  rig.input("DI01", false);
  rig.run_ms(5000);
  const auto at = [&](uint16_t index) { return rig.parameters.value(index); };
  EXPECT_EQ(at(8366), 1);
  EXPECT_EQ(at(8371), inputs);
  EXPECT_EQ(at(8381), outputs);
  EXPECT_EQ(at(8391) & 0xFFFF, 0x0125) << "status word 1 of the instant: F01, not ready, stage still on";
  EXPECT_EQ(at(8396), now.heat_sink);
  EXPECT_EQ(at(8401), 400'000);
  EXPECT_EQ(at(8406), now.output_current);
  EXPECT_EQ(at(8411), now.active_current);
  EXPECT_EQ(at(8416), now.utilization);
  EXPECT_EQ(at(8421), now.dc_link);
  rig.drive.reset_fault();
  EXPECT_EQ(at(8401), 400'000);
  EXPECT_EQ(rig.write("P804", 1), 0);
  for (const int index : {8366, 8371, 8381, 8391, 8396, 8401, 8406, 8411, 8416, 8421})
    EXPECT_EQ(at(static_cast<uint16_t>(index)), 0) << index;
}

TEST(M07Parameters, MonitoringModesAndBrakeTime) {
  PROVES("M07-PAR-32");
  DriveRig rig("mc07");
  const runtime::ParameterStore fresh(unit("mc07"));
  EXPECT_EQ(fresh.value(8557), 3);
  EXPECT_EQ(fresh.value(8558), 1000);
  EXPECT_EQ(fresh.value(8574), 0);
  EXPECT_EQ(fresh.value(8576), 0);
  EXPECT_EQ(fresh.value(8828), 100) << "0.1 s";
  const auto accepted = [&](const char* number, std::initializer_list<int> good, int last) {
    for (int code = -1; code <= last + 1; ++code)
      EXPECT_EQ(rig.write(number, code) == 0, std::find(good.begin(), good.end(), code) != good.end())
          << number << " = " << code;
  };
  accepted("P500", {0, 3}, 3);
  accepted("P700", {0, 2, 3, 4, 21, 22}, 22);
  EXPECT_EQ(rig.write("P736", 2000), 0);
  EXPECT_EQ(rig.write("P736", 2001), 0x15);
  // P710: direct current at standstill without enable.
  rig.bus_control();
  rig.set("P736", 0);
  rig.po({0x0000, 0, 0});
  rig.run_ms(10);
  EXPECT_EQ(rig.state(), 2);
  rig.set("P710", 20'000);
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 3);
  EXPECT_TRUE(rig.stage());
  EXPECT_EQ(rig.drive.axis().output_current, 20'000);
  rig.po({0x0001, 0, 0});
  rig.run_ms(1);
  EXPECT_EQ(rig.state(), 1) << "the inhibit ends it";
  EXPECT_FALSE(rig.stage());
  // P500 and P501: blocked by friction.
  for (const int32_t mode : {0, 3}) {
    MachineData machine = light_machine();
    machine.friction = 300'000;
    DriveRig blocked("mc07", {}, machine);
    blocked.enable_terminals();
    blocked.ai1(10'000);
    blocked.set("P500", mode);
    blocked.set("P501", 300);
    blocked.run_ms(200);
    EXPECT_EQ(blocked.drive.fault(), 0);
    blocked.run_ms(200);
    EXPECT_EQ(blocked.drive.fault(), mode == 3 ? 8 : 0);
  }
}

// P009 is P004 of the rated current P071, in whole mA towards 0, to the last digit.
TEST(M07Parameters, EveryCurrentInAmperes) {
  int above_rated = 0;
  for (int32_t load = 0; load < 160'000; load += 500) {
    MachineData machine = light_machine();
    machine.load_torque = load;
    DriveRig rig("mc07", {}, machine);
    rig.enable_terminals();
    rig.run_ms(5);
    const int64_t current = rig.value("P004");
    EXPECT_EQ(rig.value("P009"), current * rig.value("P071") / 100'000) << current;
    above_rated += current > 100'000;
  }
  EXPECT_GT(above_rated, 100);
}

TEST(M07Parameters, CurrentInAmperes) {
  DriveRig rig("mc07");
  rig.bus_control();
  rig.po({0x0006, 0, 0});
  rig.run_ms(10);
  EXPECT_EQ(rig.value("P004"), 60'000);
  EXPECT_EQ(rig.value("P009"), rig.value("P071") * 60 / 100);
}

}  // namespace
}  // namespace ipos::tests

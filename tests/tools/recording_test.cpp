// Signals found by name and sampled on a plant without programs; the units are moved by hand.
#include "tools/recording/recording.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::kMillisecond;

class RecorderTest : public ::testing::Test {
 protected:
  void plant(const std::string& text) {
    runtime::PlantFileResult file = runtime::read_plant_file(text);
    ASSERT_TRUE(file.errors.empty()) << file.errors.front().text;
    std::vector<std::optional<vm::Image>> programs(file.plant.stations.size());
    std::vector<runtime::PlantError> errors;
    plant_ =
        std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors);
    ASSERT_TRUE(errors.empty()) << errors.front().text;
  }
  void run(Recorder& recorder, int ms) {
    plant_->run_until(plant_->now() + ms * kMillisecond, [&](runtime::Time now) {
      recorder.sample(now);
      return true;
    });
  }
  runtime::Station& station(size_t n) { return *plant_->stations()[n]; }
  static std::string unit(const std::string& name, const std::string& type) {
    return "[[station]]\nname = \"" + name + "\"\nunit = \"" + type + "\"\n";
  }
  std::unique_ptr<runtime::Plant> plant_;
};

TEST_F(RecorderTest, UnitsAndDecimalsAreThoseOfTheParameters) {
  plant(unit("u", "md60a") + "[station.parameters]\nP130 = 3000\n");
  Recorder recorder(*plant_,
                    {"u.speed", "u.current", "u.dc_link", "u.P130", "u.P094", "8600", "u.temperature"});
  const auto& signals = recorder.recording().signals;
  ASSERT_EQ(signals.size(), 7U);
  const char* units[] = {"rpm", "%In", "V", "s", "", "", "°C"};
  for (size_t n = 0; n < signals.size(); ++n) EXPECT_EQ(signals[n].unit, units[n]) << signals[n].name;
  EXPECT_EQ(signals[0].text(1'500'001), "1500.001");
  EXPECT_EQ(signals[0].text(-200), "-0.200");
  EXPECT_EQ(signals[5].name, "u.8600");
  run(recorder, 1);
  EXPECT_EQ(signals[3].text(recorder.recording().samples[3][0]), "3.000");
}

TEST_F(RecorderTest, SamplesAreThoseOfTheirMillisecond) {
  plant(unit("u", "md60a") +
        "[station.parameters]\nP115 = 0\nP130 = 2000\nP323 = 0\n[station.analog]\nAI1 = \"10 V\"\n");
  Recorder recorder(*plant_, {"u.P094", "u.setpoint"});
  run(recorder, 3);
  for (const size_t line : {0U, 1U, 3U}) station(0).inputs().line(line).set = 1;  // DI00, CW, ENABLE
  station(0).drive().state().take_po(runtime::PoSource::Sbus, std::vector<uint16_t>{0x8006, 0xFFFF, 7});
  run(recorder, 2);
  EXPECT_EQ(recorder.recording().times,
            (std::vector<runtime::Time>{kMillisecond, 2 * kMillisecond, 3 * kMillisecond, 4 * kMillisecond,
                                        5 * kMillisecond}));
  EXPECT_EQ(recorder.recording().samples[0], (std::vector<int64_t>{0, 0, 0, 0x8006, 0x8006}));
  // 3000 rpm in 2 s are 1.5 rpm a millisecond.
  EXPECT_EQ(recorder.recording().samples[1], (std::vector<int64_t>{0, 0, 0, 1500, 3000}));
  EXPECT_EQ(recorder.recording().signals[1].text(-200), "-0.200");
}

TEST_F(RecorderTest, PartsOfAMillisecondGiveNoSample) {
  plant(unit("u", "md60a"));
  Recorder recorder(*plant_, {"u.speed"});
  plant_->run_until(2'500'000, [&](runtime::Time now) {
    recorder.sample(now);
    return true;
  });
  EXPECT_EQ(recorder.recording().times.size(), 2U);
}

TEST_F(RecorderTest, StateChangesAndFaultsAreEvents) {
  plant(unit("a", "md60a") + unit("b", "mc07"));
  Recorder recorder(*plant_, {"a.status", "b.speed"});
  run(recorder, 2);
  station(0).inputs().line(0).set = 1;  // DI00 ends the controller inhibit
  run(recorder, 2);
  station(0).drive().state().raise_fault(28);
  station(1).drive().state().raise_fault(47);  // its status is not recorded
  run(recorder, 1);
  station(0).drive().state().reset_fault();
  run(recorder, 1);
  const auto& events = recorder.recording().events;
  ASSERT_EQ(events.size(), 3U);
  EXPECT_EQ(events[0].text, "a: no enable");
  EXPECT_EQ(events[0].time, 3 * kMillisecond);
  EXPECT_EQ(events[1].text, "a: F28");
  EXPECT_TRUE(events[1].is_fault && !events[2].is_fault);
  EXPECT_EQ(events[2].text, "a: no enable");
  EXPECT_TRUE(recorder.recording().signals[0].is_status);
  EXPECT_EQ(recorder.recording().samples[0].front(), 0x0102);
}

TEST_F(RecorderTest, MotionValuesAndFault) {
  plant(unit("u", "md60a"));
  Recorder recorder(*plant_, {"u.shaft_speed", "u.torque", "u.fault", "u.status", "u.P094"});
  const auto& recording = recorder.recording();
  EXPECT_EQ(recording.signals[0].unit, "rpm");
  EXPECT_EQ(recording.signals[0].text(1'500'001), "1500.001");
  EXPECT_EQ(recording.signals[3].bits, 16);
  EXPECT_EQ(recording.signals[4].bits, 32);
  station(0).drive().state().raise_fault(28);
  run(recorder, 1);
  recorder.finish();
  EXPECT_EQ(recording.samples[0], (std::vector<int64_t>{0}));
  EXPECT_EQ(recording.samples[2], (std::vector<int64_t>{28}));
  EXPECT_NO_THROW(Recorder(*plant_, {"u.lag"})) << "a variable, which a unit has without a program, too";
}

TEST_F(RecorderTest, WithoutParameterListOnlyWhatThereIs) {
  plant(unit("old", "mc31"));
  Recorder recorder(*plant_, {});
  for (const Signal& signal : recorder.recording().signals) EXPECT_NE(signal.name, "old.speed");
  EXPECT_THROW(Recorder(*plant_, {"old.speed"}), Failure);
  run(recorder, 1);
}

TEST_F(RecorderTest, LongestStationNameCounts) {
  plant(unit("a", "md60a") + unit("a.b", "md60a"));
  Recorder recorder(*plant_, {"a.b.speed", "a.speed"});
  EXPECT_EQ(recorder.recording().signals[0].name, "a.b.speed");
  EXPECT_EQ(recorder.recording().signals[1].name, "a.speed");
}

}  // namespace
}  // namespace ipos::tools

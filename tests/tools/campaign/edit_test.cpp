// Values that are changed in the text of a plant file, and numbers that are measured of a signal.
#include <gtest/gtest.h>

#include "tools/campaign/measure.hpp"
#include "tools/campaign/toml_edit.hpp"

namespace {

using namespace ipos::tools::campaign;

constexpr const char* kPlant =
    "# ä plant\n[[bus]]\nname = \"sbus\"   # ü\nbaud = 500000 # bit/s\n[[station]]\nname = \"a\"\n[station.parameters]\nP130 = \"1 s\"  # ramp\n"
    "[[station]]\nname = \"b\"\ninputs = { DI00 = 1 }\n";

std::string edited(const std::string& path, const std::string& toml, const std::string& text = kPlant) {
  TomlEdit edit(text);
  const auto why = edit.set(path, toml);
  return why ? "refused: " + *why : edit.text();
}

std::string replaced(std::string text, const std::string& what, const std::string& by) { return text.replace(text.find(what), what.size(), by); }

TEST(TomlEdit, ReplacesAValueAndNothingElse) {
  EXPECT_EQ(edited("bus.sbus.baud", "125000"), replaced(kPlant, "500000", "125000"));
  EXPECT_EQ(edited("station.a.parameters.P130", "\"2.5 s\""), replaced(kPlant, "\"1 s\"", "\"2.5 s\""));
  EXPECT_EQ(edited("station.b.inputs.DI00", "0"), replaced(kPlant, "DI00 = 1", "DI00 = 0"));
}

TEST(TomlEdit, AddsAKeyBelowItsTable) {
  EXPECT_EQ(edited("station.a.parameters.P131", "3"), replaced(kPlant, "parameters]\n", "parameters]\nP131 = 3\n"));
  EXPECT_EQ(edited("station.b.load.torque", "\"5 Nm\""), replaced(kPlant, "name = \"b\"", "load.torque = \"5 Nm\"\nname = \"b\""));
  EXPECT_EQ(edited("station.b.inputs.DI01", "1"), replaced(kPlant, "{ DI00 = 1 }", "{ DI01 = 1, DI00 = 1 }"));
}

TEST(TomlEdit, CountsTablesWithoutAName) {
  const std::string text = "[[stimulus]]\nat = \"1s\"\n[[stimulus]]\nat = \"2s\"\n";
  EXPECT_EQ(edited("stimulus.1.at", "\"3s\"", text), replaced(text, "2s", "3s"));
  EXPECT_EQ(edited("stimulus.2.at", "\"3s\"", text), "refused: there is no stimulus '2'");
}

TEST(TomlEdit, SaysWhatIsNotThere) {
  EXPECT_EQ(edited("bus.other.baud", "1"), "refused: there is no bus 'other'");
  EXPECT_EQ(edited("wire.x.from", "1"), "refused: the plant has no 'wire'");
  EXPECT_EQ(edited("station.a", "1"), "refused: 'station.a' is a table; name a key of it");
  EXPECT_EQ(edited("station.a.name.x", "1"), "refused: 'name' is a value and has no keys");
}

TEST(TomlEdit, KnowsWhereLinesWere) {
  TomlEdit edit(kPlant);
  edit.set("station.a.parameters.P131", "3");  // line 8
  edit.set("bus.sbus.kind", "\"can\"");        // line 3
  EXPECT_EQ(edit.original_line(2), 2U);
  EXPECT_EQ(edit.original_line(3), 0U);
  EXPECT_EQ(edit.original_line(8), 7U);
  EXPECT_EQ(edit.original_line(9), 0U);
  EXPECT_EQ(edit.original_line(10), 8U);
}

// 0, 50, 120, 110, 100, 100 at 1 to 6 ms, in tenths.
std::optional<double> measured(Measure measure) {
  int64_t value = 0;
  ipos::signals::Signal signal;
  signal.factor = 0.1;
  signal.read = [&] { return value; };
  Meter meter(measure, signal);
  ipos::runtime::Time now = 0;
  for (const int64_t next : {0, 500, 1200, 1100, 1000, 1000}) {
    value = next;
    meter.sample(now += ipos::runtime::kMillisecond);
  }
  return meter.value();
}
std::optional<double> measured(Take take) {
  Measure measure;
  measure.take = take;
  return measured(measure);
}

TEST(CampaignMeasure, TakesWhatItsWordSays) {
  EXPECT_DOUBLE_EQ(measured(Take::Max).value(), 120);
  EXPECT_DOUBLE_EQ(measured(Take::Min).value(), 0);
  EXPECT_DOUBLE_EQ(measured(Take::Final).value(), 100);
  EXPECT_DOUBLE_EQ(measured(Take::Mean).value(), 80);
  EXPECT_DOUBLE_EQ(measured(Take::Overshoot).value(), 20);
  EXPECT_DOUBLE_EQ(measured(Take::Settling).value(), 5);
}

TEST(CampaignMeasure, SettlesInsideOfItsBand) {
  Measure measure;
  measure.take = Take::Settling;
  measure.band = 10;  // 110 is inside
  EXPECT_DOUBLE_EQ(measured(measure).value(), 4);
}

TEST(CampaignMeasure, FindsTheFirstMoment) {
  Measure measure;
  measure.take = Take::Time;
  measure.threshold = 115;
  EXPECT_DOUBLE_EQ(measured(measure).value(), 3);
  measure.threshold = 120;
  EXPECT_FALSE(measured(measure));
  measure.when = Measure::When::Equals;
  measure.threshold = 110;
  EXPECT_DOUBLE_EQ(measured(measure).value(), 4);
  measure.when = Measure::When::Below;
  measure.threshold = 1;
  EXPECT_DOUBLE_EQ(measured(measure).value(), 1);
}

}  // namespace

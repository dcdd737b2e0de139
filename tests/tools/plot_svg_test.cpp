// The plot as a document: it is XML, every panel and name is there, lines lie where the values are.
#include "tools/recording/plot_svg.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/recording/plot_html.hpp"

namespace ipos::tools {
namespace {

using runtime::kMillisecond;

class Picture {
 public:
  explicit Picture(const Recording& recording, const std::string& title = "t") {
    const std::string text = plot_svg(recording, title);
    EXPECT_EQ(document_.Parse(text.c_str()), tinyxml2::XML_SUCCESS) << document_.ErrorStr();
    for (auto* node = document_.RootElement()->FirstChildElement(); node; node = node->NextSiblingElement()) {
      const std::string name = node->Name();
      if (name == "text") texts.push_back(node->GetText() ? node->GetText() : "");
      if (name == "polyline") lines.push_back(points_of(node->Attribute("points")));
      if (name == "line" && node->Attribute("stroke-dasharray"))
        events.push_back(node->DoubleAttribute("x1"));
      if (name == "path") strips.push_back(node->Attribute("d"));
      for (const char* y : {"y", "y1", "y2"}) lowest = std::max(lowest, node->DoubleAttribute(y));
    }
    width = document_.RootElement()->DoubleAttribute("width");
    height = document_.RootElement()->DoubleAttribute("height");
  }
  bool shows(const std::string& text) const { return std::count(texts.begin(), texts.end(), text) == 1; }

  std::vector<std::string> texts;
  std::vector<std::vector<PlotPoint>> lines;
  std::vector<double> events;
  std::vector<std::string> strips;
  double width = 0, height = 0, lowest = 0;

 private:
  static std::vector<PlotPoint> points_of(const char* text) {
    std::vector<PlotPoint> points;
    std::istringstream in(text);
    char comma = 0;
    for (PlotPoint point{}; in >> point.x >> comma >> point.y;) points.push_back(point);
    return points;
  }
  tinyxml2::XMLDocument document_;
};

Recording ramp(int ms) {
  Recording recording;
  recording.signals = {{"u.speed", "rpm", 0.001, 3, false},
                       {"u.current", "%In", 0.001, 3, false},
                       {"u.setpoint", "rpm", 0.001, 3, false},
                       {"u.status", "", 1, 0, true}};
  recording.samples.resize(4);
  for (int t = 1; t <= ms; ++t) {
    recording.times.push_back(t * kMillisecond);
    const int64_t samples[] = {std::int64_t{t} * 1'500'000 / ms, 60'000, 1'500'000, 1026};
    for (size_t n = 0; n < 4; ++n) recording.samples[n].push_back(samples[n]);
  }
  return recording;
}

TEST(PlotSvg, OnePanelAUnitAndNamesAtTheLines) {
  const Picture picture(ramp(1'000), "scom.toml");
  for (const char* text : {"scom.toml", "rpm", "%In", "u.speed", "u.current", "u.setpoint", "ms"})
    EXPECT_TRUE(picture.shows(text)) << text;
  EXPECT_FALSE(picture.shows("u.status"));  // its changes are events
  EXPECT_EQ(picture.lines.size(), 3U);
  EXPECT_LE(picture.lowest, picture.height);
}

TEST(PlotSvg, LinesAreStraightWhereTheValuesAre) {
  const Picture picture(ramp(1'000));
  const auto& speed = picture.lines[0];
  const PlotPoint first = speed.front(), last = speed.back();
  EXPECT_GT(speed.size(), 100U);
  for (const PlotPoint& point : speed)
    ASSERT_NEAR(point.y, first.y + (last.y - first.y) * (point.x - first.x) / (last.x - first.x), 0.3);
  EXPECT_LT(last.y, first.y);  // up is up
  // The setpoint is constant and meets the speed at the end: two points are enough.
  EXPECT_EQ(picture.lines[1].size(), 2U);
  EXPECT_NEAR(picture.lines[1].back().y, last.y, 0.11);
}

TEST(PlotSvg, LongRunsAreThinnedButKeepTheirPeaks) {
  Recording recording;
  recording.signals = {{"u.x", "", 1, 0, false}};
  recording.samples.resize(1);
  for (int t = 1; t <= 600'000; ++t) {
    recording.times.push_back(t * kMillisecond);
    recording.samples[0].push_back(t == 314'159 ? 1'000 : t % 2);
  }
  const Picture picture(recording);
  const auto& line = picture.lines[0];
  EXPECT_LT(line.size(), 4U * 800);
  const auto peak = std::min_element(line.begin(), line.end(),
                                     [](const PlotPoint& a, const PlotPoint& b) { return a.y < b.y; });
  EXPECT_NEAR((peak->x - line.front().x) / (line.back().x - line.front().x), 314'159.0 / 600'000, 0.002);
  EXPECT_TRUE(picture.shows("s"));
  EXPECT_TRUE(picture.shows("value"));
}

TEST(PlotSvg, ThinnedKeepsFirstLeastGreatestLast) {
  const std::vector<double> xs{0, 0.2, 0.4, 0.6, 0.8, 1.2, 1.4}, ys{5, 9, 1, 7, 6, 3, 3};
  std::vector<double> seen;
  for (const PlotPoint& point : thinned(xs, ys, 1)) seen.push_back(point.y);
  EXPECT_EQ(seen, (std::vector<double>{5, 9, 1, 6, 3, 3}));
  EXPECT_TRUE(thinned({}, {}, 1).empty());
}

TEST(PlotSvg, EventsHaveLinesAndLabelsThatDoNotCollide) {
  Recording recording = ramp(1'000);
  for (int n = 0; n < 12; ++n)
    recording.events.push_back({(500 + 4 * n) * kMillisecond, "unit1: no enable", false});
  recording.events.push_back({999 * kMillisecond, "unit1: F47", true});
  const Picture picture(recording);
  EXPECT_EQ(picture.events.size(), 13U);
  EXPECT_TRUE(picture.shows("unit1: F47"));
  // Four rows; what finds no room is only a line.
  EXPECT_EQ(std::count(picture.texts.begin(), picture.texts.end(), "unit1: no enable"), 4);
}

TEST(PlotSvg, BusesHaveAStripWithAStrokeForEachFrame) {
  Recording recording = ramp(100);
  recording.tracks = {{"sbus1", true}, {"line1", false}};
  for (const int t : {10, 50, 90}) recording.frames.push_back({t * kMillisecond, 0, 1, false, false, {}, ""});
  recording.frames.push_back({50 * kMillisecond, 1, 0, false, false, {1}, ""});
  const Picture picture(recording);
  EXPECT_TRUE(picture.shows("sbus1.frames"));
  EXPECT_TRUE(picture.shows("line1.frames"));
  ASSERT_EQ(picture.strips.size(), 2U);
  EXPECT_EQ(std::count(picture.strips[0].begin(), picture.strips[0].end(), 'M'), 3);
  EXPECT_EQ(std::count(picture.strips[1].begin(), picture.strips[1].end(), 'M'), 1);
  EXPECT_LE(picture.lowest, picture.height);
}

TEST(PlotSvg, LongNamesHaveRoom) {
  Recording recording = ramp(100);
  EXPECT_EQ(Picture(recording).width, 1000);
  recording.signals[0].name = std::string(60, 'n');
  EXPECT_GE(Picture(recording).width, 830 + 60 * 6);  // names begin at 830, letters are 6 wide
}

TEST(PlotSvg, NamesAreEscaped) {
  Recording recording = ramp(10);
  recording.signals[0].name = "<u&1>.\"speed\"";
  recording.events.push_back({kMillisecond, "a<b", false});
  const Picture picture(recording, "R&D.toml");
  EXPECT_TRUE(picture.shows("<u&1>.\"speed\""));
  EXPECT_TRUE(picture.shows("a<b"));
  EXPECT_TRUE(picture.shows("R&D.toml"));
}

TEST(PlotSvg, TickLabelsAreAsExactAsTheirDistance) {
  Recording recording = ramp(2);
  recording.samples[1] = {20'000'000'000, 20'000'300'000};  // 1/1000
  const Picture large(recording);
  EXPECT_TRUE(large.shows("2.00001e+07") && large.shows("2.00002e+07"));
  recording.samples[1] = {-15, 15};
  const Picture small(recording);
  EXPECT_TRUE(small.shows("-0.010") && small.shows("0.010"));
}

TEST(PlotSvg, NothingRecorded) {
  EXPECT_TRUE(Picture(Recording{}).lines.empty());
  EXPECT_TRUE(Picture(ramp(0)).lines.empty());
  EXPECT_EQ(Picture(ramp(1)).lines.size(), 3U);
}

TEST(PlotSvg, ConstantAndExtremeValues) {
  for (const int64_t value :
       {int64_t{0}, int64_t{-1}, int64_t{INT32_MAX}, int64_t{UINT32_MAX}, int64_t{INT32_MIN}}) {
    Recording recording = ramp(3);
    recording.samples[1] = {value, value, value};
    for (const auto& line : Picture(recording).lines)
      for (const PlotPoint& point : line)
        ASSERT_TRUE(std::isfinite(point.x) && std::isfinite(point.y)) << value;
  }
}

// A number that is only 0 and 1 is one, too; one that never is 1 may be a fault that did not come.
TEST(PlotSvg, BinarySignalsHaveStrips) {
  Recording recording = ramp(10);
  recording.signals = {{"u.DI00", ""}, {"u.lState", ""}, {"u.fault", ""}, {"u.lCount", ""}};
  recording.signals[0].bits = 1;
  recording.samples = {{0, 0, 1, 1, 1, 0, 0, 0, 0, 0},
                       {0, 1, 0, 1, 0, 1, 0, 1, 0, 1},
                       std::vector<int64_t>(10, 0),
                       {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}};
  const Picture picture(recording);
  EXPECT_EQ(picture.lines.size(), 2U) << "fault and count";
  ASSERT_EQ(picture.strips.size(), 2U);
  // Low, up, down, and to the end: the level changes twice.
  EXPECT_EQ(std::count(picture.strips[0].begin(), picture.strips[0].end(), 'V'), 2);
  EXPECT_EQ(std::count(picture.strips[1].begin(), picture.strips[1].end(), 'V'), 9);
  for (const char* name : {"u.DI00", "u.lState", "u.fault", "u.lCount"})
    EXPECT_TRUE(picture.shows(name)) << name;
  EXPECT_LE(picture.lowest, picture.height);
}

TEST(PlotHtml, OneFileWithTheRecordingInIt) {
  Recording recording = ramp(4);
  recording.signals.push_back({"u.DI00", "", 1, 0, false, "u", 1});
  recording.samples.push_back({0, 1, 1, 0});
  recording.events.push_back({2 * kMillisecond, "u: F28 </script>", true});
  recording.tracks.push_back({"sbus"});
  recording.frames.push_back({kMillisecond + 500'000, 0, 5, false, false, {}, ""});
  const std::string page = plot_html(recording, "a & b");
  for (const char* part : {"http:", "https:", " src=", "@import", "@DATA@"})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  const std::string begin = "<script id=\"data\" type=\"application/json\">";
  const size_t at = page.find(begin) + begin.size();
  const auto data = nlohmann::json::parse(page.substr(at, page.find("</script>", at) - at));
  EXPECT_EQ(data["title"], "a & b");
  EXPECT_EQ(data["samples"], 4);
  EXPECT_EQ(data["begin"], 1);
  EXPECT_EQ(data["signals"].size(), 5U);
  EXPECT_EQ(data["signals"][0]["kind"], "curve");
  EXPECT_EQ(data["signals"][4]["kind"], "level");
  // A ramp to 1500 rpm in four steps, and a level that changes twice.
  EXPECT_EQ(data["signals"][0]["changes"], nlohmann::json({0, 375.0, 1, 750.0, 2, 1125.0, 3, 1500.0}));
  EXPECT_EQ(data["signals"][4]["changes"], nlohmann::json({0, 0, 1, 1, 3, 0}));
  EXPECT_TRUE(data["signals"][4]["binary"]);
  EXPECT_EQ(data["events"][0]["text"], "u: F28 </script>");
  EXPECT_EQ(data["tracks"][0]["times"], nlohmann::json({1.5}));
}

TEST(AxisTicks, RoundSteps) {
  EXPECT_EQ(axis_ticks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(axis_ticks(-1'590, 1'590, 6), (std::vector<double>{-1'500, -1'000, -500, 0, 500, 1'000, 1'500}));
  for (const double size : {1e-6, 0.03, 1.0, 47.0, 999.0, 4e9})
    for (const double least : {-0.7 * size, 0.0, 3 * size}) {
      const std::vector<double> ticks = axis_ticks(least, least + size, 6);
      EXPECT_GE(ticks.size(), 3U) << size;
      EXPECT_LE(ticks.size(), 11U) << size;
      EXPECT_GE(ticks.front(), least - 1e-9 * size);
      EXPECT_LE(ticks.back(), least + size * (1 + 1e-9));
    }
}

// Where a speed is its setpoint both are seen: the speed, drawn before it, is wider. Of every station, not only the first.
TEST(PlotSvg, ASpeedShowsAsTheEdgeOfItsSetpoint) {
  Recording recording;
  for (const char* station : {"a", "b", "c"})
    for (const char* own : {"speed", "setpoint"}) {
      Signal& signal = recording.signals.emplace_back();
      signal.name = fmt::format("{}.{}", station, own);
      signal.station = station;
      signal.unit = "rpm";
      recording.samples.push_back({0, 1000, 1000});
    }
  recording.times = {kMillisecond, 2 * kMillisecond, 3 * kMillisecond};
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(plot_svg(recording, "t").c_str()), tinyxml2::XML_SUCCESS);
  std::vector<double> widths;
  for (auto* node = document.RootElement()->FirstChildElement("polyline"); node; node = node->NextSiblingElement("polyline"))
    widths.push_back(node->DoubleAttribute("stroke-width"));
  EXPECT_EQ(widths, (std::vector<double>{3, 1.5, 3, 1.5, 3, 1.5}));
}

// Twenty stations, two curves each: every name has a place of its own within its panel.
TEST(PlotSvg, ManyNamesAllHaveRoom) {
  Recording recording;
  for (int n = 0; n < 40; ++n) {
    recording.signals.emplace_back();
    recording.signals.back().name = fmt::format("axis{:02}.speed", n);
    recording.signals.back().unit = "rpm";
    recording.samples.push_back({0, 1000, 1000});
  }
  recording.times = {kMillisecond, 2 * kMillisecond, 3 * kMillisecond};
  const std::string text = plot_svg(recording, "t");
  tinyxml2::XMLDocument document;
  ASSERT_EQ(document.Parse(text.c_str()), tinyxml2::XML_SUCCESS);
  std::vector<double> places;
  double title = 0, bottom = document.RootElement()->DoubleAttribute("height");
  for (auto* node = document.RootElement()->FirstChildElement("text"); node;
       node = node->NextSiblingElement("text")) {
    const std::string words = node->GetText();
    if (words == "rpm") title = node->DoubleAttribute("y");
    if (words.starts_with("axis")) places.push_back(node->DoubleAttribute("y"));
  }
  ASSERT_EQ(places.size(), 40U);
  std::sort(places.begin(), places.end());
  EXPECT_GT(places.front(), title) << "no name lies above the panel";
  EXPECT_LT(places.back(), bottom);
  for (size_t n = 1; n < places.size(); ++n) EXPECT_GE(places[n] - places[n - 1], 12) << "they overlap";
}

}  // namespace
}  // namespace ipos::tools

// Layout of the plot, from top to bottom: title, labels of the events, panels, strips of the buses, time
// axis.
#include "tools/recording/plot_svg.hpp"
#include "tools/cli/xml_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace ipos::tools {
namespace {

constexpr double kLeastWidth = 1000, kLeft = 72, kRight = 830;  // the lines' names stand right of kRight
constexpr double kTitleHeight = 30, kRowHeight = 15, kPanelHeight = 170, kPanelGap = 30, kAxisHeight = 48;
constexpr double kStripHeight = 22;
constexpr double kLetter = 6.3;  // mean width of a letter at this size
constexpr size_t kEventRows = 4;

// Okabe and Ito's colours: they differ for colour-blind readers, too.
constexpr std::string_view kColours[] = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                         "#E69F00", "#56B4E9", "#000000"};
constexpr std::string_view kFaultColour = "#C00000", kEventColour = "#808080";

// As many digits as the ticks differ in; seven places and more before the point are written with a power of
// ten.
std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  const auto places = [](double value) { return static_cast<int>(std::floor(std::log10(value) + 1e-9)); };
  const int step = ticks.size() > 1 ? places(ticks[1] - ticks[0]) : 0;
  double greatest = 1;
  for (const double tick : ticks) greatest = std::max(greatest, std::abs(tick));
  std::vector<std::string> labels;
  for (const double tick : ticks)
    labels.push_back(greatest >= 1e7 ? fmt::format("{:.{}g}", tick, places(greatest) - step + 1)
                                     : fmt::format("{:.{}f}", tick, std::max(0, -step)));
  return labels;
}

struct Scale {
  double least, most;  // values
  double from, to;     // pixels
  double operator()(double value) const { return from + (value - least) / (most - least) * (to - from); }
};

struct Panel {
  std::string unit;
  std::vector<size_t> signals;
  // The names of its lines have room beside it.
  double height() const { return std::max(kPanelHeight, kRowHeight * static_cast<double>(signals.size())); }
};

struct NameTag {
  double y;
  size_t colour;
  std::string text;
};

class Plot {
 public:
  Plot(const Recording& recording, const std::string& title) : recording_(recording), title_(title) {
    const double end = recording.times.empty() ? 1 : static_cast<double>(recording.times.back()) / 1e6;
    in_seconds_ = end > 2'000;
    time_ = {0, in_seconds_ ? end / 1e3 : end, kLeft, kRight};
    for (const runtime::Time time : recording.times) xs_.push_back(x_of(time));
    const auto make_room = [this](const std::string& name) {
      width_ = std::max(width_, kRight + 14 + kLetter * static_cast<double>(name.size()));
    };
    for (const Signal& signal : recording.signals) make_room(signal.name);
    for (const FrameTrack& track : recording.tracks) make_room(strip_name(track));
  }

  std::string draw() {
    split_into_panels();
    const std::string labels = event_labels();
    top_ = kTitleHeight + kRowHeight * static_cast<double>(rows_.size()) + 18;
    bottom_ = top_ - kPanelGap;
    for (const Panel& panel : panels_) bottom_ += panel.height() + kPanelGap;
    if (panels_.empty()) bottom_ = top_ + kPanelHeight;
    if (panels_.empty() && !strips_.empty()) bottom_ = top_;
    const double strips = bottom_ + kRowHeight;
    const size_t count = strips_.size() + recording_.tracks.size();
    if (count != 0) bottom_ = strips + kStripHeight * static_cast<double>(count);
    std::string body = labels;
    double y = top_;
    for (const Panel& panel : panels_) {
      body += draw_panel(panel, y);
      y += panel.height() + kPanelGap;
    }
    y = strips;
    for (const size_t n : strips_) {
      body += draw_levels(n, y);
      y += kStripHeight;
    }
    for (size_t n = 0; n < recording_.tracks.size(); ++n)
      body += draw_strip(n, y + kStripHeight * static_cast<double>(n));
    body += event_lines() + time_axis();
    const double height = bottom_ + kAxisHeight;
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
               "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\" font-size=\"12\">\n"
               "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
               "<text x=\"{2:.0f}\" y=\"20\" font-size=\"15\" fill=\"#222\">{3}</text>\n",
               width_, height, kLeft, xml_text(title_)) +
           body + "</svg>\n";
  }

 private:
  double x_of(runtime::Time time) const {
    return time_(static_cast<double>(time) / (in_seconds_ ? 1e9 : 1e6));
  }

  // In order of their first signals. A status is shown by its events.
  void split_into_panels() {
    for (size_t n = 0; n < recording_.signals.size(); ++n) {
      const Signal& signal = recording_.signals[n];
      if (signal.is_status) continue;
      if (is_binary(recording_, n)) {
        strips_.push_back(n);
        continue;
      }
      auto panel = std::find_if(panels_.begin(), panels_.end(),
                                [&](const Panel& candidate) { return candidate.unit == signal.unit; });
      if (panel == panels_.end()) panel = panels_.insert(panels_.end(), {signal.unit, {}});
      panel->signals.push_back(n);
    }
  }

  // A label goes into the first row where it has room; without room the line alone remains.
  std::string event_labels() {
    std::string out;
    for (const RecordedEvent& event : recording_.events) {
      const double width = kLetter * static_cast<double>(event.text.size());
      const double x = std::min(x_of(event.time), width_ - width - 4);
      auto row = std::find_if(rows_.begin(), rows_.end(), [&](double end) { return end + 10 < x; });
      if (row == rows_.end()) {
        if (rows_.size() == kEventRows) continue;
        row = rows_.insert(rows_.end(), 0);
      }
      *row = x + width;
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n", x,
                         kTitleHeight + kRowHeight * static_cast<double>(row - rows_.begin() + 1),
                         event.is_fault ? kFaultColour : kEventColour, xml_text(event.text));
    }
    return out;
  }

  std::string event_lines() const {
    std::string out;
    double before = -1;
    for (const RecordedEvent& event : recording_.events) {
      const double x = x_of(event.time);
      if (!event.is_fault && x - before < 1) continue;  // would not be told apart
      before = x;
      out += fmt::format(
          "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\" "
          "stroke-dasharray=\"3 3\"/>\n",
          x, top_ - 14, bottom_, event.is_fault ? kFaultColour : kEventColour);
    }
    return out;
  }

  Scale value_scale(const Panel& panel, double y) const {
    double least = 0, most = 0;
    bool any = false;
    for (const size_t n : panel.signals)
      for (const int64_t sample : recording_.samples[n]) {
        const double value = static_cast<double>(sample) * recording_.signals[n].factor;
        least = any ? std::min(least, value) : value;
        most = any ? std::max(most, value) : value;
        any = true;
      }
    // Zero belongs to the picture unless all values are far from it.
    if (least > 0 && least < 0.5 * most) least = 0;
    if (most < 0 && most > 0.5 * least) most = 0;
    if (most - least < 1e-9 * std::max(1.0, std::abs(most))) {
      least -= 1;
      most += 1;
    }
    const double margin = 0.06 * (most - least);
    return {least - margin, most + margin, y + panel.height(), y};
  }

  std::string draw_panel(const Panel& panel, double y) const {
    const Scale scale = value_scale(panel, y);
    std::string out = fmt::format(
        "<text x=\"{:.0f}\" y=\"{:.1f}\" fill=\"#222\" font-weight=\"bold\" "
        "text-anchor=\"end\">{}</text>\n",
        kLeft - 6, y - 8, xml_text(panel.unit.empty() ? "value" : panel.unit));
    const std::vector<double> ticks = axis_ticks(scale.least, scale.most, 6);
    const std::vector<std::string> labels = tick_labels(ticks);
    for (size_t n = 0; n < ticks.size(); ++n)
      out += fmt::format(
          "<line x1=\"{0:.0f}\" x2=\"{1:.0f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\" stroke=\"{3}\"/>\n"
          "<text x=\"{4:.0f}\" y=\"{5:.1f}\" fill=\"#444\" text-anchor=\"end\">{6}</text>\n",
          kLeft, kRight, scale(ticks[n]), ticks[n] == 0 ? "#909090" : "#e4e4e4", kLeft - 6,
          scale(ticks[n]) + 4, labels[n]);
    out += vertical_grid(y, panel.height());
    std::vector<NameTag> tags;
    for (size_t place = 0; place < panel.signals.size(); ++place) {
      const size_t n = panel.signals[place];
      const Signal& signal = recording_.signals[n];
      std::vector<double> ys;
      for (const int64_t sample : recording_.samples[n])
        ys.push_back(scale(static_cast<double>(sample) * signal.factor));
      const size_t colour = place % std::size(kColours);
      std::string points;
      for (const PlotPoint& point : thinned(xs_, ys, 1))
        points += fmt::format("{:.1f},{:.1f} ", point.x, point.y);
      if (points.empty()) continue;
      points.pop_back();
      // Of equal lines the first shows as the edge of the others, and a speed as that of its setpoint.
      const bool is_edge = place == 0 ? panel.signals.size() > 1 : has_setpoint_later(panel, place);
      out += fmt::format("<polyline fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" points=\"{}\"/>\n",
                         kColours[colour], is_edge ? 3 : 1.5, points);
      tags.push_back({ys.back(), colour, signal.name});
    }
    return out + name_tags(std::move(tags), y + panel.height());
  }

  bool has_setpoint_later(const Panel& panel, size_t place) const {
    const std::string& station = recording_.signals[panel.signals[place]].station;
    return !station.empty() && std::any_of(panel.signals.begin() + static_cast<std::ptrdiff_t>(place) + 1, panel.signals.end(), [&](size_t later) {
      const Signal& signal = recording_.signals[later];
      return signal.station == station && signal.own_name().ends_with("setpoint");
    });
  }

  // Of a binary signal: a line that is high while it is 1.
  std::string draw_levels(size_t n, double y) const {
    constexpr double kHigh = 2, kLow = 14;
    const std::vector<int64_t>& samples = recording_.samples[n];
    std::string path;
    for (size_t row = 0; row < samples.size(); ++row) {
      const bool on = samples[row] != 0;
      if (row != 0 && on == (samples[row - 1] != 0)) continue;
      const double level = y + (on ? kHigh : kLow);
      path += row == 0 ? fmt::format("M{:.1f} {:.1f}", xs_[row], level)
                       : fmt::format("H{:.1f}V{:.1f}", xs_[row], level);
    }
    if (!samples.empty()) path += fmt::format("H{:.1f}", xs_.back());
    return fmt::format(
        "<path d=\"{}\" stroke=\"{}\" stroke-width=\"1.5\" fill=\"none\"/>\n<text x=\"{:.0f}\" y=\"{:.1f}\" "
        "fill=\"#222\">{}</text>\n",
        path, kColours[n % std::size(kColours)], kRight + 7, y + 12, xml_text(recording_.signals[n].name));
  }

  static std::string strip_name(const FrameTrack& track) { return track.bus + ".frames"; }

  // A stroke for each frame; those that would fall together are one.
  std::string draw_strip(size_t track, double y) const {
    std::string strokes;
    double before = -1;
    for (const RecordedFrame& frame : recording_.frames) {
      if (frame.track != track) continue;
      const double x = std::min(x_of(frame.time), kRight);
      if (x - before < 0.5) continue;
      before = x;
      strokes += fmt::format("M{:.1f} {:.1f}v12", x, y + 2);
    }
    return fmt::format(
        "<path d=\"{}\" stroke=\"{}\" fill=\"none\"/>\n<text x=\"{:.0f}\" y=\"{:.1f}\" "
        "fill=\"#222\">{}</text>\n",
        strokes, kColours[track % std::size(kColours)], kRight + 7, y + 12,
        xml_text(strip_name(recording_.tracks[track])));
  }

  // Names keep their lines' order and a line's height of distance.
  static std::string name_tags(std::vector<NameTag> tags, double lowest) {
    std::stable_sort(tags.begin(), tags.end(), [](const NameTag& a, const NameTag& b) { return a.y < b.y; });
    for (size_t n = 1; n < tags.size(); ++n) tags[n].y = std::max(tags[n].y, tags[n - 1].y + kRowHeight);
    std::string out;
    for (auto tag = tags.rbegin(); tag != tags.rend(); ++tag) {
      tag->y = std::min(tag->y, lowest);
      lowest = tag->y - kRowHeight;
      out += fmt::format("<text x=\"{:.0f}\" y=\"{:.1f}\" fill=\"{}\">{}</text>\n", kRight + 7, tag->y + 4,
                         kColours[tag->colour], xml_text(tag->text));
    }
    return out;
  }

  std::string vertical_grid(double y, double height) const {
    std::string out;
    for (const double tick : axis_ticks(time_.least, time_.most, 9))
      out += fmt::format(
          "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"#f0f0f0\"/>\n",
          time_(tick), y, y + height);
    return out;
  }

  std::string time_axis() const {
    std::string out =
        fmt::format("<line x1=\"{:.0f}\" x2=\"{:.0f}\" y1=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"#444\"/>\n",
                    kLeft, kRight, bottom_, bottom_);
    const std::vector<double> ticks = axis_ticks(time_.least, time_.most, 9);
    const std::vector<std::string> labels = tick_labels(ticks);
    for (size_t n = 0; n < ticks.size(); ++n)
      out += fmt::format(
          "<line x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1:.1f}\" y2=\"{2:.1f}\" stroke=\"#444\"/>\n"
          "<text x=\"{0:.1f}\" y=\"{3:.1f}\" fill=\"#444\" text-anchor=\"middle\">{4}</text>\n",
          time_(ticks[n]), bottom_, bottom_ + 5, bottom_ + 19, labels[n]);
    return out + fmt::format("<text x=\"{:.0f}\" y=\"{:.1f}\" fill=\"#222\" font-weight=\"bold\">{}</text>\n",
                             kRight + 22, bottom_ + 19, in_seconds_ ? "s" : "ms");
  }

  const Recording& recording_;
  const std::string& title_;
  bool in_seconds_ = false;
  Scale time_{0, 1, kLeft, kRight};
  std::vector<double> xs_;
  std::vector<Panel> panels_;
  std::vector<size_t> strips_;  // binary signals
  std::vector<double> rows_;    // of event labels: where the last one of the row ends
  double top_ = 0, bottom_ = 0;
  double width_ = kLeastWidth;  // of the picture, so that the longest name has room
};

}  // namespace

std::vector<double> axis_ticks(double least, double most, int wanted) {
  const double rough = (most - least) / wanted;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double ratio = rough / power;
  const double step = power * (ratio < 1.5 ? 1 : ratio < 3.5 ? 2 : ratio < 7.5 ? 5 : 10);
  std::vector<double> ticks;
  for (double n = std::ceil(least / step - 1e-9); n * step <= most + 1e-9 * step; ++n)
    ticks.push_back(n == 0 ? 0 : n * step);  // never -0
  return ticks;
}

std::vector<PlotPoint> thinned(const std::vector<double>& xs, const std::vector<double>& ys, double column) {
  std::vector<PlotPoint> points;
  const auto add = [&points](PlotPoint point) {
    // The middle of three equal values adds nothing to a line.
    const size_t n = points.size();
    if (n >= 2 && points[n - 1].y == point.y && points[n - 2].y == point.y)
      points.back() = point;
    else
      points.push_back(point);
  };
  for (size_t first = 0; first < xs.size();) {
    size_t end = first, least = first, greatest = first;
    for (; end < xs.size() && xs[end] < xs[first] + column; ++end) {
      if (ys[end] < ys[least]) least = end;
      if (ys[end] > ys[greatest]) greatest = end;
    }
    const auto [left, right] = std::minmax(least, greatest);
    size_t last_added = xs.size();
    for (const size_t n : {first, left, right, end - 1})
      if (n != last_added) {
        add({xs[n], ys[n]});
        last_added = n;
      }
    first = end;
  }
  return points;
}

std::string plot_svg(const Recording& recording, const std::string& title) {
  return Plot(recording, title).draw();
}

}  // namespace ipos::tools

// A recording as a picture: one panel a unit of measure over a common time axis, names at the ends of the
// lines, state changes and faults as labelled vertical lines, the frames of a bus as strokes. Plain SVG 1.1.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/recording/recording.hpp"

namespace ipos::tools {

std::string plot_svg(const Recording& recording, const std::string& title);

// Round numbers from `least` to `most`: 1, 2 or 5 times a power of ten apart, about `wanted` of them.
std::vector<double> axis_ticks(double least, double most, int wanted);

struct PlotPoint {
  double x, y;
};
// The line through the samples in at most four points a column of the picture: first, least, greatest, last.
std::vector<PlotPoint> thinned(const std::vector<double>& xs, const std::vector<double>& ys, double column);

}  // namespace ipos::tools

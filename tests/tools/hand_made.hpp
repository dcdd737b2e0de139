// A recording by hand, for the tests of the forms of traces.
#pragma once

#include "tools/recording/recording.hpp"

namespace ipos::tools {

// Two stations, a bit field, numbers at the ends of their ranges, frames before, at and behind samples.
inline Recording hand_made() {
  Recording recording;
  recording.signals = {{"u.speed", "rpm", 0.001, 3, false, "u"},
                       {"v 1.a.b", "", 1, 0, false, "v 1"},
                       {"u.status", "", 1, 0, true, "u", 16},
                       {"u.P221", "", 1, 0, false, "u"},
                       {"v 1.P094", "", 1, 0, false, "v 1", 32}};
  recording.times = {1'000'000, 2'000'000, 3'000'000};
  recording.samples = {{-1, -1, 1'500'000},
                       {-2'147'483'648, 2'147'483'647, -1},
                       {0x102, 0x102, 0x8006},
                       {3'999'999'999, 3'999'999'999, 0},
                       {0, 0xFFFFFFFF, 0}};
  recording.events = {{2'000'000, "u: \"F28\"", true}};
  recording.tracks = {{"sbus1", true}, {"line1", false}};
  recording.frames = {{123'456, 0, 0x40A, false, false, {0x80, 0x06}, "40A#8006"},
                      {2'000'000, 1, 0, false, false, {2, 1, 5}, "request to 1"},
                      {2'000'000, 0, 0x1FFFFFFF, true, true, {}, "1FFFFFFF#R"},
                      {3'000'001, 0, 1, false, false, {}, "001#"}};
  return recording;
}

}  // namespace ipos::tools

// The words for what is left out.
#include "tools/logs/left_out.hpp"

#include <fmt/format.h>

#include <numeric>

namespace ipos::tools {
namespace {

struct Words {
  const char* one;
  const char* several;
};
// In the order of LeftOut.
constexpr std::array<Words, kLeftOutKinds> kWords{
    {{"error frame", "error frames"},
     {"FD frame", "FD frames"},
     {"transmit request", "transmit requests"},
     {"record of another kind", "records of other kinds"},
     {"packet of another link type", "packets of other link types"},
     {"packet cut by the capture", "packets cut by the capture"},
     {"packet without time", "packets without time"},
     {"telegram of another kind of bus", "telegrams of other kinds of bus"},
     {"line not understood", "lines not understood"}}};

}  // namespace

uint64_t LeftOutCounts::total() const { return std::accumulate(counts_.begin(), counts_.end(), uint64_t{0}); }

std::string LeftOutCounts::text() const {
  std::string text;
  for (size_t n = 0; n < kLeftOutKinds; ++n)
    if (counts_[n] != 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts_[n],
                          counts_[n] == 1 ? kWords[n].one : kWords[n].several);
  return text;
}

}  // namespace ipos::tools

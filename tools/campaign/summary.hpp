// Results summed up for a picture: how each factor acts on each measure, how measures are spread, where two factors together
// fail. Everything is counted over all cases; of the cases themselves a part is kept.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/campaign/results.hpp"

namespace ipos::tools::campaign {

// Cases of some levels of a factor.
struct Spread {
  uint64_t count = 0;
  double least = 0;
  double most = 0;
  double sum = 0;

  void add(double value);
};

struct Bin {
  std::string text;  // "0.5 s", or "1 to 20" of levels that stand together
  uint64_t cases = 0;
  uint64_t failed = 0;
  std::vector<Spread> measures;
};

struct Histogram {
  double least = 0;
  double most = 0;
  std::vector<uint64_t> good;  // of each of its bins
  std::vector<uint64_t> failed;
};

struct Map {
  size_t across;  // factors
  size_t down;
  std::vector<uint64_t> cases;  // a row of `down` after the other
  std::vector<uint64_t> failed;
};

class Summary {
 public:
  explicit Summary(const Results& results);

  static constexpr uint32_t kBins = 40;     // of a factor or a measure at most (ours)
  static constexpr size_t kMaps = 45;       // pairs of the first ten factors
  static constexpr size_t kCases = 5000;    // that are kept: what failed first, then good ones evenly

  uint32_t bin_of(size_t factor, uint32_t level) const {
    return static_cast<uint32_t>(uint64_t{level} * factors[factor].size() / levels_[factor]);
  }

  std::vector<std::vector<Bin>> factors;
  std::vector<Histogram> measures;
  std::vector<Map> maps;
  std::vector<uint64_t> shown;  // ranks

 private:
  void make_bins(const Outline& outline);
  void find_ends(const Results& results);
  void count(const Results& results);
  void choose(const Results& results);

  std::vector<uint64_t> levels_;  // of each factor
};

}  // namespace ipos::tools::campaign

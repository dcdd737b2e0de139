// One way through all cases for the ends of the measures, one to count.
#include "tools/campaign/summary.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::tools::campaign {

void Spread::add(double value) {
  least = count == 0 ? value : std::min(least, value);
  most = count == 0 ? value : std::max(most, value);
  sum += value;
  ++count;
}

Summary::Summary(const Results& results) {
  make_bins(results.outline);
  find_ends(results);
  for (size_t across = 0; across < factors.size(); ++across)
    for (size_t down = across + 1; down < factors.size() && maps.size() < kMaps; ++down) {
      const size_t cells = factors[across].size() * factors[down].size();
      maps.push_back({across, down, std::vector<uint64_t>(cells), std::vector<uint64_t>(cells)});
    }
  count(results);
  choose(results);
}

void Summary::make_bins(const Outline& outline) {
  for (const FactorOutline& factor : outline.factors) {
    levels_.push_back(factor.levels.size());
    std::vector<Bin>& bins = factors.emplace_back(std::min<size_t>(factor.levels.size(), kBins));
    for (Bin& bin : bins) bin.measures.resize(outline.measures.size());
    for (uint32_t level = 0; level < factor.levels.size(); ++level) {
      Bin& bin = bins[bin_of(factors.size() - 1, level)];
      const std::string first = bin.text.substr(0, bin.text.find(" to "));
      bin.text = bin.text.empty() ? factor.levels[level].text : fmt::format("{} to {}", first, factor.levels[level].text);
    }
  }
}

void Summary::find_ends(const Results& results) {
  std::vector<Spread> ends(results.outline.measures.size());
  for (const Row& row : results.rows)
    for (size_t n = 0; n < row.measures.size(); ++n)
      if (row.measures[n]) ends[n].add(*row.measures[n]);
  for (const Spread& end : ends) measures.push_back({end.least, end.most, std::vector<uint64_t>(kBins), std::vector<uint64_t>(kBins)});
}

void Summary::count(const Results& results) {
  for (size_t rank = 0; rank < results.rows.size(); ++rank) {
    if (!results.there[rank]) continue;
    const Row& row = results.rows[rank];
    const Levels& levels = results.levels[rank];
    const bool failed = !row.failed.empty();
    for (size_t factor = 0; factor < factors.size(); ++factor) {
      Bin& bin = factors[factor][bin_of(factor, levels[factor])];
      ++bin.cases;
      bin.failed += failed ? 1U : 0U;
      for (size_t n = 0; n < row.measures.size(); ++n)
        if (row.measures[n]) bin.measures[n].add(*row.measures[n]);
    }
    for (Map& map : maps) {
      const size_t cell = bin_of(map.down, levels[map.down]) * factors[map.across].size() + bin_of(map.across, levels[map.across]);
      ++map.cases[cell];
      map.failed[cell] += failed ? 1U : 0U;
    }
    for (size_t n = 0; n < row.measures.size(); ++n) {
      if (!row.measures[n]) continue;
      Histogram& measure = measures[n];
      const double way = measure.most - measure.least;
      const auto bin = way > 0 ? static_cast<size_t>((*row.measures[n] - measure.least) / way * kBins) : 0;
      ++(failed ? measure.failed : measure.good)[std::min<size_t>(bin, kBins - 1)];
    }
  }
}

void Summary::choose(const Results& results) {
  std::vector<uint64_t> good;
  for (uint64_t rank = 0; rank < results.rows.size(); ++rank) {
    if (!results.there[rank]) continue;
    if (results.rows[rank].failed.empty())
      good.push_back(rank);
    else if (shown.size() < kCases / 2)
      shown.push_back(rank);
  }
  const uint64_t room = std::min<uint64_t>(good.size(), kCases - shown.size());
  for (uint64_t n = 0; n < room; ++n) shown.push_back(good[good.size() * n / room]);
}

}  // namespace ipos::tools::campaign

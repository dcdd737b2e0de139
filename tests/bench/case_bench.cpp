// What a case of a campaign costs beside its simulated time: the time of many short cases of a plant, less that of the same
// virtual time in one plant that stands.
#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <string>

#include "tools/campaign/case_runner.hpp"

namespace ipos::tools::campaign {
namespace {

// Of this thread, so that other work on the machine counts only for what it does to the caches.
double cpu_seconds() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

template <typename Do>
double seconds_of(Do action) {
  const double begin = cpu_seconds();
  action();
  return cpu_seconds() - begin;
}

void measure(const std::string& file, int64_t duration, int cases) {
  Campaign campaign = read_campaign(file, {});
  const Levels middle = [&] {
    Levels levels;
    for (const FactorOutline& factor : campaign.outline.factors) levels.push_back(factor.middle());
    return levels;
  }();
  CaseRunner runner(campaign, {});
  const auto run = [&](int64_t each, int count) {
    campaign.duration = each;
    return seconds_of([&] {
      for (int n = 0; n < count; ++n) runner.run(middle);
    });
  };
  run(duration, 10);  // everything is read, compiled and made
  const double all = run(duration, cases);
  const double one = run(duration * cases, 1);
  fmt::print("{} cases of {} ms: {:.1f} us each; one of {} ms: {:.1f} us for {} ms; a case costs {:.1f} us\n", cases, duration / 1'000'000,
             all / cases * 1e6, duration * cases / 1'000'000, one / cases * 1e6, duration / 1'000'000, (all - one) / cases * 1e6);
}

}  // namespace
}  // namespace ipos::tools::campaign

// ipos_bench_case FILE.campaign.toml [MS [CASES]]     of a campaign of a plant
int main(int argc, char** argv) {
  if (argc < 2) return 64;
  const int64_t ms = argc > 2 ? std::atoi(argv[2]) : 500;
  ipos::tools::campaign::measure(argv[1], ms * 1'000'000, argc > 3 ? std::atoi(argv[3]) : 2000);
  return 0;
}

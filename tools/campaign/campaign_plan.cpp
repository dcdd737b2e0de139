// ipos campaign plan: how many cases there are, how long they take, in how many shards.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "tools/campaign/campaign_verbs.hpp"
#include "tools/campaign/workers.hpp"
#include "tools/cli/exit_codes.hpp"

namespace ipos::tools::campaign {
namespace {

constexpr uint64_t kTried = 20;  // cases that tell how long one takes

// What engines need for a task of theirs, measured: a hundred times that makes a shard (docs/guide/campaigns.md).
struct Engine {
  std::string_view name;
  double seconds;
};
constexpr Engine kEngines[] = {{"GNU parallel", 0.005}, {"Slurm", 1.5}};

// Seconds that a case takes here.
double seconds_a_case(const Campaign& campaign, const CompileFlags& compile, const Plan& plan) {
  CaseRunner runner(campaign, compile);
  const RowWriter writer(campaign.outline);
  WorkOrder order{campaign, writer, [&](uint64_t rank, Levels& levels) { return plan.levels(rank, levels), plan.case_at(rank); }, {}, 1};
  const uint64_t count = std::min(plan.size(), kTried);
  for (uint64_t n = 0; n < count; ++n) order.numbers.push_back(plan.size() * n / count);
  std::vector<double> times;
  run_cases(order, runner, {[&](std::string_view lines, uint64_t) {
                              for (size_t begin = 0; begin < lines.size();) {
                                const size_t end = lines.find('\n', begin);
                                times.push_back(nlohmann::json::parse(lines.substr(begin, end - begin))["ms"].get<double>() / 1e3);
                                begin = end + 1;
                              }
                            },
                            [&] { return std::count_if(times.begin(), times.end(), [](double one) { return one > 0.5; }) == 0; }});
  if (times.empty()) return 0;
  std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
  return times[times.size() / 2];
}

int plan(const CampaignFlags& flags) {
  const Campaign campaign = read_campaign(flags.file, flags.compile);
  const Plan cases(campaign.outline);
  for (const FactorOutline& factor : campaign.outline.factors)
    fmt::print("{}: {} value{}, {}{}\n", factor.name, factor.levels.size(), factor.levels.size() == 1 ? "" : "s",
               factor.levels.front().text, factor.levels.size() == 1 ? "" : " to " + factor.levels.back().text);
  for (const MeasureOutline& measure : campaign.outline.measures)
    fmt::print("measures {}{}\n", measure.name, measure.unit.empty() ? "" : " in " + measure.unit);
  if (campaign.later != 0)
    fmt::print("{} [[expect]] of the plant lie after the end of a case and are not looked at\n", campaign.later);
  if (cases.left_out() != 0) fmt::print("{} cases of the hypercube are others once more, and left out\n", cases.left_out());
  const double one = seconds_a_case(campaign, flags.compile, cases);
  const double all = one * static_cast<double>(cases.size());
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  fmt::print("a case takes {:.3f} ms here, all of them some {} on one core, {} on the {} of this machine\n", one * 1e3,
             duration_text(all), duration_text(all / cores), cores);
  for (const Engine& engine : kEngines) {
    const double most = std::floor(all / (100 * engine.seconds));
    fmt::print("{}: at most {} shards, so that it takes less than 1 % for itself\n", engine.name,
               static_cast<uint64_t>(std::clamp(most, 1.0, static_cast<double>(cases.size()))));
  }
  fmt::print("{} cases\n", cases.size());
  return kGood;
}

}  // namespace

void add_plan(cli::Verb& parent) {
  auto flags = std::make_shared<CampaignFlags>();
  cli::Verb& verb = parent.verb("plan", "count the cases and tell how long they take");
  add_campaign_options(verb, *flags);
  verb.footer("Example:\n  ipos campaign plan examples/campaign/line.campaign.toml");
  verb.runs([flags] { return plan(*flags); });
}

}  // namespace ipos::tools::campaign

// ipos campaign run: the cases of a shard that have no result yet, on several cores; or one case, with all that is to be said.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>
#include <unordered_map>

#include "compiler/diag/places.hpp"
#include "tools/campaign/campaign_verbs.hpp"
#include "tools/campaign/case_coverage.hpp"
#include "tools/campaign/results.hpp"
#include "tools/campaign/shard_file.hpp"
#include "tools/campaign/shrink.hpp"
#include "tools/campaign/workers.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::campaign {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kShrunk = 10;  // kinds of failure that are made small (ours)

struct RunFlags : CampaignFlags {
  unsigned jobs = 1;
  std::string shard = "1/1";
  std::string out;
  uint64_t stop_after = 0;
  bool coverage = false;
  std::string name;
  std::vector<std::string> factors;
  bool middle = false;
};

// On a terminal, over the same line again.
class Progress {
 public:
  explicit Progress(uint64_t total) : total_(total), show_(is_terminal(STDERR_FILENO)) {}
  ~Progress() {
    if (shown_) fmt::print(stderr, "\r\033[K");
  }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void add(uint64_t cases, uint64_t failed) {
    done_ += cases;
    failed_ += failed;
  }
  uint64_t done() const { return done_; }
  void show() {
    const auto now = Clock::now();
    if (!show_ || now - last_ < std::chrono::milliseconds(500)) return;
    last_ = now;
    shown_ = true;
    const double passed = std::chrono::duration<double>(now - begin_).count();
    const double left = done_ == 0 ? 0 : passed * static_cast<double>(total_ - done_) / static_cast<double>(done_);
    fmt::print(stderr, "\r\033[K{} of {} cases, {} failed, {} left", done_, total_, failed_, done_ == 0 ? "?" : duration_text(left));
    std::fflush(stderr);
  }

 private:
  uint64_t total_;
  uint64_t done_ = 0;
  uint64_t failed_ = 0;
  bool show_;
  bool shown_ = false;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point last_ = begin_;
};

void for_each_line(std::string_view text, const std::function<void(std::string_view)>& action) {
  for (size_t begin = 0, end = 0; (end = text.find('\n', begin)) != std::string_view::npos; begin = end + 1)
    action(text.substr(begin, end - begin));
}

// A shard of the campaign on its way.
class ShardRun {
 public:
  ShardRun(const RunFlags& flags, const Campaign& campaign)
      : flags_(flags), campaign_(campaign), shard_(shard_of(flags.shard)), file_(flags.out, shard_), plan_(campaign.outline), writer_(campaign.outline) {
    write_outline(flags.out, campaign.outline);
    if (file_.dropped() != 0)
      fmt::print(stderr, "ipos: {}: its last line was not whole, as its runner was stopped: the case is run again\n", shard_.file_name());
    find_what_is_left();
  }

  int run() {
    CaseRunner runner(campaign_, flags_.compile);
    CaseCoverage coverage;
    WorkListener listener{[this](std::string_view lines, uint64_t cases) { take(lines, cases); }, [this] { return go_on(); }};
    if (flags_.coverage) coverage.attach(runner, listener);
    Progress progress(left_.size());
    progress_ = &progress;
    run_cases({campaign_, writer_, case_of_plan(), left_, flags_.jobs}, runner, listener);
    progress_ = nullptr;
    file_.keep();
    if (flags_.coverage) coverage.write(flags_.out, shard_, campaign_.outline);
    const uint64_t done = progress.done();
    const bool stopped = done < left_.size();
    fmt::print("{} case{}: {} good, {} failed; {} of them were there already{}\n", there_ + done, there_ + done == 1 ? "" : "s",
               there_ + done - failed_, failed_, there_, stopped ? fmt::format(", {} are still to run", left_.size() - done) : "");
    if (!interrupted()) tell_failures(runner);
    if (interrupted()) return kInterrupted;
    return failed_ == 0 ? kGood : kFindings;
  }

 private:
  std::function<uint64_t(uint64_t, Levels&)> case_of_plan() const {
    return [this](uint64_t rank, Levels& levels) { return plan_.levels(rank, levels), plan_.case_at(rank); };
  }

  // What is in the folder, in whichever shard, is not run again.
  void find_what_is_left() {
    std::unordered_map<uint64_t, bool> known;
    for (const std::string& path : shard_files(flags_.out))
      for_each_line(read_results_file(path), [&](std::string_view line) {
        if (const auto head = read_row_head(line)) known[head->id] = head->good;
      });
    for (uint64_t rank = 0; rank < plan_.size(); ++rank) {
      if (!shard_.has(rank)) continue;
      const auto row = known.find(plan_.case_at(rank));
      if (row == known.end())
        left_.push_back(rank);
      else
        ++there_;
      if (row != known.end() && !row->second) there_failed_[row->first] = rank;
    }
    failed_ = there_failed_.size();
    if (there_failed_.empty()) return;
    for (const std::string& path : shard_files(flags_.out))
      for_each_line(read_results_file(path), [&](std::string_view line) {
        const auto head = read_row_head(line);
        const auto rank = head ? there_failed_.find(head->id) : there_failed_.end();
        if (rank == there_failed_.end()) return;
        if (const auto row = read_row(campaign_.outline, line)) groups_.add(rank->second, row->failed);
      });
  }

  void take(std::string_view lines, uint64_t cases) {
    file_.append(lines);
    uint64_t failed = 0;
    for_each_line(lines, [&](std::string_view line) {
      const auto head = read_row_head(line);
      if (!head || head->good) return;
      ++failed;
      if (const auto row = read_row(campaign_.outline, line)) groups_.add(rank_of(head->id), row->failed);
    });
    failed_ += failed;
    progress_->add(cases, failed);
  }

  // Only those that failed are looked for.
  uint64_t rank_of(uint64_t id) {
    if (ranks_.empty())
      for (const uint64_t rank : left_) ranks_[plan_.case_at(rank)] = rank;
    return ranks_.at(id);
  }

  bool go_on() {
    const auto now = Clock::now();
    if (now - kept_ >= std::chrono::seconds(1)) {
      kept_ = now;
      file_.keep();
    }
    progress_->show();
    return !interrupted() && (flags_.stop_after == 0 || failed_ < flags_.stop_after);
  }

  // What one case fails, run by a worker, as it may hang or die.
  std::vector<std::string> failures_of(CaseRunner& runner, const Levels& levels) const {
    std::vector<std::string> failed;
    const WorkOrder order{campaign_, writer_, [&](uint64_t, Levels& out) { return out = levels, campaign_.outline.case_of(levels); }, {0}, 1};
    run_cases(order, runner, {[&](std::string_view lines, uint64_t) {
                                if (const auto row = read_row(campaign_.outline, lines)) failed = row->failed;
                              },
                              [] { return !interrupted(); }});
    return failed;
  }

  void tell_failures(CaseRunner& runner) const {
    runner.use_watcher({});
    size_t told = 0;
    for (const auto& [check, group] : groups_.all()) {
      fmt::print("\n{} case{}: {}\n", group.cases, group.cases == 1 ? "" : "s", compiler::printable(group.text));
      if (++told > kShrunk) continue;
      Levels first;
      plan_.levels(group.first, first);
      const Levels small = shrunk(campaign_.outline, first, [&, of = std::string_view(check)](const Levels& levels) {
        const auto failed = failures_of(runner, levels);
        return !failed.empty() && check_of(failed.front()) == of;
      });
      std::string values;
      for (size_t n = 0; n < small.size(); ++n)
        if (const FactorOutline& factor = campaign_.outline.factors[n]; small[n] != factor.middle())
          values += fmt::format("{}{} = {}", values.empty() ? "" : ", ", factor.name, factor.levels[small[n]].text);
      if (values.empty())
        fmt::print("  it fails with the middle value of every factor\n");
      else
        fmt::print("  it fails so with {}, and every other factor at its middle value\n", values);
      fmt::print("  {}\n", command_of(flags_.file, campaign_.outline, small));
    }
  }

  const RunFlags& flags_;
  const Campaign& campaign_;
  Shard shard_;
  ShardFile file_;
  Plan plan_;
  RowWriter writer_;
  std::vector<uint64_t> left_;  // ranks
  uint64_t there_ = 0;
  std::unordered_map<uint64_t, uint64_t> there_failed_;  // rank of a case
  std::unordered_map<uint64_t, uint64_t> ranks_;
  uint64_t failed_ = 0;
  Groups groups_;
  Progress* progress_ = nullptr;
  Clock::time_point kept_ = Clock::now();
};

// NAME=VALUE of some factors; the others have their middle value.
Levels levels_of(const Outline& outline, const std::vector<std::string>& settings) {
  Levels levels;
  for (const FactorOutline& factor : outline.factors) levels.push_back(factor.middle());
  for (const std::string& setting : settings) {
    const auto factor = std::find_if(outline.factors.begin(), outline.factors.end(), [&](const FactorOutline& one) { return setting.starts_with(one.name + "="); });
    if (factor == outline.factors.end()) throw Failure(kUsage, fmt::format("--factor {}: write NAME=VALUE with a factor of the campaign", setting));
    const std::string value = setting.substr(factor->name.size() + 1);
    const auto level = std::find_if(factor->levels.begin(), factor->levels.end(), [&](const Level& one) { return one.text == value; });
    if (level == factor->levels.end()) throw Failure(kUsage, fmt::format("--factor {}: the campaign has no such value", setting));
    levels[static_cast<size_t>(factor - outline.factors.begin())] = static_cast<uint32_t>(level - factor->levels.begin());
  }
  return levels;
}

int run_one(const RunFlags& flags, const Campaign& campaign) {
  const Levels levels = flags.name.empty() ? levels_of(campaign.outline, flags.factors) : find_case(campaign.outline, flags.name);
  CaseRunner runner(campaign, flags.compile);
  runner.use_teller([](const testing::TestResult& result) { fmt::print("{}", testing::text_of(result, has_colours(STDOUT_FILENO))); });
  const Outcome outcome = runner.run(levels);
  for (size_t n = 0; n < levels.size(); ++n)
    fmt::print("{} = {}\n", campaign.outline.factors[n].name, campaign.outline.factors[n].levels[levels[n]].text);
  for (size_t n = 0; n < outcome.measures.size(); ++n) {
    const MeasureOutline& measure = campaign.outline.measures[n];
    fmt::print("{}: {}{}{}\n", measure.name, outcome.measures[n] ? number_text(*outcome.measures[n]) : "none",
               measure.unit.empty() ? "" : " ", measure.unit);
  }
  for (const std::string& failure : outcome.failed) fmt::print("failed: {}\n", compiler::printable(failure));
  if (outcome.failed.empty()) fmt::print("good\n");
  if (outcome.hash) fmt::print(stderr, "trace hash {}\n", hex(*outcome.hash));
  return outcome.failed.empty() ? kGood : kFindings;
}

int run(const RunFlags& flags) {
  const bool one = !flags.name.empty() || !flags.factors.empty() || flags.middle;
  if (one == !flags.out.empty())
    throw Failure(kUsage, "a campaign is run with --out DIR for its results, one case of it with --case, --factor or --middle");
  if (!one) {
    shard_of(flags.shard);  // before long work
    catch_interrupts();     // one case is simply ended
  }
  const Campaign campaign = read_campaign(flags.file, flags.compile);
  return one ? run_one(flags, campaign) : ShardRun(flags, campaign).run();
}

}  // namespace

void add_run(cli::Verb& parent) {
  auto flags = std::make_shared<RunFlags>();
  flags->jobs = std::max(1U, std::thread::hardware_concurrency());
  cli::Verb& verb = parent.verb("run", "run the cases that have no result yet");
  add_campaign_options(verb, *flags);
  verb.option("--out", flags->out, "folder of the results; the same command goes on where it was stopped");
  verb.option("--jobs,-j", flags->jobs, "cases at a time; default: the number of cores").between(1U, 1024U);
  verb.option("--shard", flags->shard, "K/N: only the K-th of N parts of the cases");
  verb.option("--stop-after", flags->stop_after, "begin no case any more when so many have failed");
  verb.flag("--coverage", flags->coverage, "count which lines of the programs the cases reach, for merge --html");
  verb.option("--case", flags->name, "run this case of the plan alone, and tell all that is to be said of it");
  verb.option("--factor", flags->factors, "NAME=VALUE: run one case alone with this value; other factors have their middle value")
      .one_each();
  verb.flag("--middle", flags->middle, "run the case alone in which every factor has its middle value");
  verb.footer("Example:\n  ipos campaign run examples/campaign/line.campaign.toml --out results --jobs 4");
  verb.runs([flags] { return run(*flags); });
}

}  // namespace ipos::tools::campaign

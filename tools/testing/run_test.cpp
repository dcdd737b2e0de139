// The script of a test against its plant.
//
// Time of the script and time of the plant: a step at T is planned while the plant stands right before T, so
// that it acts in the millisecond T; an expectation at T looks when everything of T has happened. A step
// after it then acts in the next millisecond.
#include "tools/testing/run_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <list>
#include <set>

#include "runtime/signals/states.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/testing/actor.hpp"
#include "tools/testing/check.hpp"
#include "tools/testing/plant_builder.hpp"
#include "tools/testing/probe.hpp"

namespace ipos::tools::testing {
namespace {

using runtime::kMillisecond;

class Run {
 public:
  Run(const TestCase& test, runtime::Plant& plant, const RunOptions& options, TestResult& result)
      : test_(test),
        plant_(plant),
        options_(options),
        result_(result),
        probe_(plant, [this](const std::string& bus, Time now, const std::string& text,
                             const std::string& meaning) { tell_event(bus, now, text, meaning); }),
        actor_(plant, test.items, options.seed,
               [this](const Item& item, std::string text) { stop(item, std::move(text)); }) {}

  // Finds what the items name; errors are of the test file.
  std::vector<runtime::PlantError> resolve() {
    std::vector<runtime::PlantError> errors;
    for (const Item& item : test_.items) {
      std::string why;
      if (const Expect* expect = expect_of(item); expect != nullptr && !expect->subject.is_event())
        readers_[&item] = probe_.follow(expect->subject, why);
      if (const runtime::Stimulus* stimulus = stimulus_of(item)) {
        Subject acted_on;  // shown where something is wrong
        acted_on.signal = stimulus->signal;
        probe_.follow(acted_on, why);
      }
      if (!why.empty()) errors.push_back({item.place, why});
    }
    return errors;
  }

  void go() {
    for (const Item& item : test_.items)
      if (item.in_plant) begin(item, std::get<Expect>(item.what), *item.at);
    for (const Item& item : test_.items) {
      if (item.in_plant) continue;
      if (stopped_ || interrupted()) break;
      if (!reach(item)) break;
      if (const auto* step = std::get_if<Step>(&item.what))
        carry_out(item, *step);
      else
        look(item, std::get<Expect>(item.what));
    }
    if (!stopped_) run_to(last_time());
    if (interrupted() && !stopped_ && !test_.items.empty()) stop(test_.items.back(), "interrupted");
    for (Open& open : open_) open.check.finish(plant_.now());
    settle();
    for (const Later& later : later_)
      result_.findings[later.finding].values.push_back(
          fmt::format("{} does not become {} until {}, the end of the test", later.expect->subject.text(),
                      later.expect->condition.text(), time_text(plant_.now())));
    find_faults();
    if (result_.checks == 0 && result_.findings.empty()) add_finding(nullptr, "the test expects nothing");
  }

 private:
  struct Open {
    const Item* item;
    Check check;
    const Reader* read;  // null for events
  };
  struct Later {  // a value that was wrong at its time
    size_t finding;
    const Expect* expect;
    const Reader* read;
    Time wanted;
  };

  static const Expect* expect_of(const Item& item) {
    if (const auto* expect = std::get_if<Expect>(&item.what)) return expect;
    const auto* await = std::get_if<AwaitStep>(&std::get<Step>(item.what));
    return await == nullptr ? nullptr : &await->frame;
  }

  static const runtime::Stimulus* stimulus_of(const Item& item) {
    const auto* step = std::get_if<Step>(&item.what);
    return step == nullptr ? nullptr : std::get_if<runtime::Stimulus>(step);
  }

  // The script gets to the time of an item. False: that cannot be.
  bool reach(const Item& item) {
    if (item.at_end) {
      if (!plant_.programs_over())
        plant_.run_until(std::max(cursor_, kProgramLimit),
                         [this](Time now) { return tick(now) && !plant_.programs_over(); });
      done_ = cursor_ = plant_.now();
      if (!plant_.programs_over() && !stopped_)
        stop(item, fmt::format("the program does not end within {}", time_text(kProgramLimit)));
      return !stopped_;
    }
    const Time at = item.at.value_or(cursor_ + item.after);
    if (at < cursor_) {
      stop(item, fmt::format("its time, {}, is over: the item above it ended at {}", time_text(at),
                             time_text(cursor_)));
      return false;
    }
    cursor_ = at;
    return true;
  }

  void carry_out(const Item& item, const Step& step) {
    if (std::holds_alternative<Wait>(step)) return;
    if (const auto* await = std::get_if<AwaitStep>(&step)) {
      if (!wait_for(item, await->frame)) stopped_ = true;
      return;
    }
    cursor_ = (cursor_ + kMillisecond - 1) / kMillisecond * kMillisecond;
    if (done_ >= cursor_) cursor_ = (done_ / kMillisecond + 1) * kMillisecond;
    run_to(cursor_ - 1);
    if (!stopped_) actor_.plan(item, step, cursor_);
  }

  void look(const Item& item, const Expect& expect) {
    if (expect.within) {
      wait_for(item, expect);
    } else if (expect.kind == Expect::Kind::Now) {
      run_to(cursor_);
      if (!stopped_) look_now(item, expect);
    } else {
      begin(item, expect, cursor_);
    }
  }

  void look_now(const Item& item, const Expect& expect) {
    ++result_.checks;
    const Reader& read = readers_[&item];
    const int64_t value = read();
    if (expect.condition.holds(value)) return;
    add_finding(&item, fmt::format("{} is {} at {}, expected {}", expect.subject.text(), value,
                                   time_text(cursor_), expect.condition.text()));
    later_.push_back({result_.findings.size() - 1, &expect, &read, cursor_});
  }

  Open& begin(const Item& item, const Expect& expect, Time start) {
    ++result_.checks;
    const auto reader = readers_.find(&item);
    open_.push_back({&item, Check(expect, start), reader == readers_.end() ? nullptr : &reader->second});
    if (done_ >= start && open_.back().read != nullptr)
      open_.back().check.sample(cursor_, (*open_.back().read)());
    return open_.back();
  }

  bool wait_for(const Item& item, const Expect& expect) {
    waiting_ = &item;
    const Time end = begin(item, expect, cursor_).check.end();
    if (watched(item) == Check::Verdict::Open) run_to(cursor_);
    if (watched(item) == Check::Verdict::Open) run_to(end);
    const bool met = watched(item) == Check::Verdict::Met;
    waiting_ = nullptr;
    cursor_ = std::max(cursor_, done_);
    settle();
    return met;
  }

  // Of the check that waits, which stays open until settle().
  Check::Verdict watched(const Item& item) const {
    for (const Open& open : open_)
      if (open.item == &item) return open.check.verdict();
    return Check::Verdict::Failed;
  }

  void run_to(Time end) {
    if (end <= done_ || stopped_) return;
    // The plant runs up to a time that lies ahead; what happens at its present time may still be to come.
    if (end == plant_.now()) {
      plant_.queue().run_until(end);
      tick(end);
    } else {
      plant_.run_until(end, [this](Time now) { return tick(now); });
    }
    done_ = plant_.now();
  }

  // Everything of this time has happened. False: the script goes on from here.
  bool tick(Time now) {
    if (!stopped_ && std::chrono::steady_clock::now() >= ends_) too_long();
    if ((now + 1) % kMillisecond == 0) return !stopped_;  // right before a step
    probe_.sample(now);
    if (options_.sample) options_.sample(now);
    for (Open& open : open_) {
      if (open.read != nullptr) open.check.sample(now, (*open.read)());
      if (now >= open.check.end()) open.check.finish(now);
    }
    std::erase_if(later_, [&](const Later& later) {
      const int64_t value = (*later.read)();
      if (!later.expect->condition.holds(value)) return false;
      result_.findings[later.finding].values.push_back(
          fmt::format("{} becomes {} at {}, {} later", later.expect->subject.text(), value, time_text(now),
                      time_text(now - later.wanted)));
      return true;
    });
    const bool over = waiting_ != nullptr && watched(*waiting_) != Check::Verdict::Open;
    settle();
    return !over && !stopped_ && !interrupted();
  }

  void tell_event(const std::string& bus, Time now, const std::string& text, const std::string& meaning) {
    for (Open& open : open_)
      if (open.read == nullptr && open.check.expect().subject.bus == bus)
        open.check.event(now, text, meaning);
  }

  // Failed checks become findings at once, while the plant still shows what there was.
  void settle() {
    for (auto open = open_.begin(); open != open_.end();) {
      if (open->check.verdict() == Check::Verdict::Open || open->item == waiting_) {
        ++open;
        continue;
      }
      if (open->check.verdict() == Check::Verdict::Failed) add_finding(open->item, open->check.problem());
      open = open_.erase(open);
    }
  }

  Time last_time() const {
    Time last = cursor_;
    for (const Open& open : open_)
      if (open.check.end() != runtime::kNever) last = std::max(last, open.check.end());
    return last;
  }

  void too_long() {
    stopped_ = true;
    add_finding(waiting_, fmt::format("time: the test takes more than {} s on the clock and is at {} of virtual time; "
                                      "--time-limit allows more",
                                      options_.limit_s, time_text(plant_.now())));
  }

  // What follows makes no sense any more.
  void stop(const Item& item, std::string text) {
    stopped_ = true;
    add_finding(&item, std::move(text));
  }

  void add_finding(const Item* item, std::string text) {
    Finding finding;
    finding.file = item != nullptr && item->in_plant ? test_.plant_path : test_.file;
    finding.place = item == nullptr ? test_.place : item->place;
    finding.time = plant_.now();
    finding.text = std::move(text);
    if (item != nullptr) {
      finding.note = item->note;
      if (!item->in_plant) finding.source = source_of(item->place);
      const Expect* expect = expect_of(*item);
      probe_.describe(expect == nullptr ? Subject{} : expect->subject, finding);
    }
    result_.findings.push_back(std::move(finding));
  }

  // The table that begins at a place, or the line of a comment.
  std::vector<std::string> source_of(FilePlace place) const {
    std::vector<std::string> source;
    for (size_t n = place.line; n >= 1 && n <= test_.lines->size(); ++n) {
      const std::string& line = (*test_.lines)[n - 1];
      if (n > place.line && (line.empty() || line.starts_with('[') || test_.is_program)) break;
      source.push_back(line);
    }
    return source;
  }

  // A fault that nothing in the test names is not what its author had in mind.
  void find_faults() {
    std::set<std::string> named;
    for (const Item& item : test_.items) {
      if (const Expect* expect = expect_of(item); expect != nullptr &&
                                                  expect->subject.kind == Subject::Kind::Signal &&
                                                  expect->subject.signal.kind == runtime::SignalKind::State &&
                                                  runtime::tells_fault(expect->subject.signal.name))
        named.insert(expect->subject.signal.station);
      if (const auto* step = std::get_if<Step>(&item.what))
        if (const auto* fault = std::get_if<DriveFaultStep>(step)) named.insert(fault->station);
    }
    for (const runtime::JournalEntry& entry : plant_.journal().entries()) {
      if (entry.weight != runtime::Weight::Fault || named.contains(entry.station)) continue;
      Finding finding;
      finding.file = test_.file;
      finding.place = test_.place;
      finding.time = entry.time;
      finding.text = fmt::format("{} has a fault at {} that the test does not expect: {}", entry.station,
                                 time_text(entry.time), entry.text);
      Subject station;
      station.signal.station = entry.station;
      probe_.describe(station, finding);
      result_.findings.push_back(std::move(finding));
      named.insert(entry.station);
    }
  }

  const TestCase& test_;
  runtime::Plant& plant_;
  const RunOptions& options_;
  TestResult& result_;
  Probe probe_;
  Actor actor_;
  std::map<const Item*, Reader> readers_;
  std::list<Open> open_;
  std::vector<Later> later_;
  Time cursor_ = 0;  // of the script
  Time done_ = -1;   // up to here, this time included, everything has happened
  const Item* waiting_ = nullptr;
  bool stopped_ = false;
  const std::chrono::steady_clock::time_point ends_ =
      std::chrono::steady_clock::now() + std::chrono::seconds(options_.limit_s);
};

void carry_out(const TestCase& test, Programs& programs, const RunOptions& options, TestResult& result) {
  result.messages = mistakes_text(test.errors_in.empty() ? test.file : test.errors_in, test.errors, false);
  if (!test.errors.empty()) {
    result.outcome = Outcome::Malformed;
    return;
  }
  BuiltPlant built = build_plant(test, programs, options);
  result.findings = std::move(built.findings);
  result.checks = built.checks;
  if (built.plant) {
    std::shared_ptr<void> collector;
    if (options.prepare) collector = options.prepare(*built.plant);
    Run run(test, *built.plant, options, result);
    const auto errors = run.resolve();
    if (errors.empty()) run.go();
    built.messages += mistakes_text(test.file, errors, false);
    result.time = built.plant->now();
    if (options.finish) options.finish();
  }
  result.messages = std::move(built.messages);
  if (!result.messages.empty())
    result.outcome = Outcome::Malformed;
  else if (!result.findings.empty())
    result.outcome = Outcome::Failed;
}

}  // namespace

TestResult run_test(const TestCase& test, Programs& programs, const RunOptions& options) {
  TestResult result;
  result.name = test.name;
  result.file = test.file;
  result.place = test.place;
  result.seed = options.seed;
  const auto begin = std::chrono::steady_clock::now();
  carry_out(test, programs, options, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace ipos::tools::testing

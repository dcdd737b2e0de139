// Stages of a script; each waits for its time, or for what it looks at.
#include "tools/testing/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "runtime/signals/find.hpp"
#include "runtime/signals/states.hpp"

namespace ipos::tools::testing {
namespace {

using runtime::kMillisecond;

const Expect* expect_of(const Item& item) {
  if (const auto* expect = std::get_if<Expect>(&item.what)) return expect;
  const auto* await = std::get_if<AwaitStep>(&std::get<Step>(item.what));
  return await == nullptr ? nullptr : &await->frame;
}

const runtime::Stimulus* stimulus_of(const Item& item) {
  const auto* step = std::get_if<Step>(&item.what);
  return step == nullptr ? nullptr : std::get_if<runtime::Stimulus>(step);
}

}  // namespace

Script::Script(const TestCase& test, runtime::Plant& plant, uint64_t seed, TestResult& result)
    : test_(test),
      plant_(plant),
      result_(result),
      probe_(plant, [this](const std::string& bus, Time now, const std::string& text,
                           const std::string& meaning) { tell_event(bus, now, text, meaning); }),
      actor_(plant, test, seed, [this](const Item& item, std::string text) { stop(item, std::move(text)); }) {}

std::vector<runtime::PlantError> Script::resolve() {
  std::vector<runtime::PlantError> errors;
  for (const Item& item : test_.items) {
    std::string why;
    if (const Expect* expect = expect_of(item); expect != nullptr && !expect->subject.is_event())
      readers_[&item] = probe_.follow(expect->subject, why);
    if (const runtime::Stimulus* stimulus = stimulus_of(item)) {
      Subject acted_on;  // shown where something is wrong
      acted_on.signal = stimulus->signal;
      probe_.follow(acted_on, why);
      runtime::Stimulus read = *stimulus;
      if (why.empty()) signals::find_target(plant_, read, why);
    }
    if (!why.empty()) errors.push_back({item.place, why});
  }
  return errors;
}

// --- how it goes on ---

void Script::begin() {
  for (const Item& item : test_.items)
    if (item.in_plant) watch(item, std::get<Expect>(item.what), *item.at);
  go_on();
}

void Script::go_on() {
  while (further()) {
  }
}

// To the next stage. False: the plant has to go on first, or the script is over.
bool Script::further() {
  if (over()) return false;
  if (stopped_ && stage_ != Stage::Wait) stage_ = Stage::Rest;
  const bool has_come = due_ <= done_;
  switch (stage_) {
    case Stage::Over: return false;
    case Stage::Next: return next_item();
    case Stage::Plan:
      if (!has_come) return false;
      if (test_.by_hand)
        actor_.act_by_hand(*item_, std::get<Step>(item_->what), cursor_);
      else
        actor_.plan(*item_, std::get<Step>(item_->what), cursor_);
      break;
    case Stage::Look:
      if (!has_come) return false;
      look_now(*item_, std::get<Expect>(item_->what));
      break;
    case Stage::Wait:
      if (still_waits()) return false;
      break;
    case Stage::AtEnd:
      if (!plant_.programs_over() && !has_come) return false;
      done_ = cursor_ = plant_.now();
      if (!plant_.programs_over())
        stop(*item_, fmt::format("the program does not end within {}", time_text(kProgramLimit)));
      else
        perform(*item_);
      return true;
    case Stage::Rest:
      if (!stopped_ && !has_come) return false;
      finish();
      return false;
  }
  stage_ = Stage::Next;
  return true;
}

bool Script::next_item() {
  while (next_ < test_.items.size() && test_.items[next_].in_plant) ++next_;
  if (next_ < test_.items.size()) {
    take(test_.items[next_++]);
  } else {
    stage_ = Stage::Rest;
    due_ = last_time();
  }
  return true;
}

// The script gets to the time of an item, if that can be.
void Script::take(const Item& item) {
  item_ = &item;
  if (item.at_end) {
    stage_ = Stage::AtEnd;
    due_ = std::max(cursor_, kProgramLimit);
    return;
  }
  const Time at = item.at.value_or(cursor_ + item.after);
  if (at < cursor_)
    return stop(item, fmt::format("its time, {}, is over: the item above it ended at {}", time_text(at),
                                  time_text(cursor_)));
  cursor_ = at;
  perform(item);
}

void Script::perform(const Item& item) {
  stage_ = Stage::Next;
  if (const auto* step = std::get_if<Step>(&item.what)) {
    if (std::holds_alternative<Wait>(*step)) return;
    if (const auto* await = std::get_if<AwaitStep>(step)) return wait_for(item, await->frame);
    cursor_ = (cursor_ + kMillisecond - 1) / kMillisecond * kMillisecond;
    stage_ = Stage::Plan;
    if (test_.by_hand) {
      due_ = cursor_ == 0 ? -1 : cursor_;  // before the first event
      return;
    }
    if (done_ >= cursor_) cursor_ = (done_ / kMillisecond + 1) * kMillisecond;
    due_ = cursor_ > kMillisecond ? cursor_ - kMillisecond : -1;  // in the first one nothing has happened yet
    return;
  }
  const auto& expect = std::get<Expect>(item.what);
  if (expect.within) return wait_for(item, expect);
  if (expect.kind == Expect::Kind::Now) {
    stage_ = Stage::Look;
    due_ = cursor_;
    return;
  }
  watch(item, expect, cursor_);
}

// --- expectations ---

void Script::look_now(const Item& item, const Expect& expect) {
  ++result_.checks;
  const Reader& read = readers_[&item];
  const int64_t value = read();
  if (expect.condition.holds(value)) return;
  add_finding(&item, fmt::format("{} is {} at {}, expected {}", expect.subject.text(), expect.subject.value_text(value),
                                 time_text(cursor_), expect.condition.text(expect.subject)));
  later_.push_back({result_.findings.size() - 1, &expect, &read, cursor_});
}

Script::Open& Script::watch(const Item& item, const Expect& expect, Time start) {
  ++result_.checks;
  const auto reader = readers_.find(&item);
  open_.push_back({&item, Check(expect, start), reader == readers_.end() ? nullptr : &reader->second});
  if (done_ >= start && open_.back().read != nullptr) open_.back().check.sample(cursor_, (*open_.back().read)());
  return open_.back();
}

void Script::wait_for(const Item& item, const Expect& expect) {
  waiting_ = &item;
  watch(item, expect, cursor_);
  stage_ = Stage::Wait;
  due_ = cursor_;  // it may be so from the beginning
}

// False: it is met or not.
bool Script::still_waits() {
  for (const Open& open : open_)
    if (open.item == item_ && open.check.verdict() == Check::Verdict::Open && !stopped_) {
      if (due_ <= done_ && due_ < open.check.end()) due_ = open.check.end();
      if (due_ > done_) return true;
    }
  const bool met = watched(*item_) == Check::Verdict::Met;
  waiting_ = nullptr;
  cursor_ = std::max(cursor_, done_);
  settle();
  // Without the frame that is waited for nothing after it makes sense.
  if (!met && std::holds_alternative<Step>(item_->what)) stopped_ = true;
  return false;
}

// Of the check that waits, which stays open until settle().
Check::Verdict Script::watched(const Item& item) const {
  for (const Open& open : open_)
    if (open.item == &item) return open.check.verdict();
  return Check::Verdict::Failed;
}

bool Script::passed(Time now) {
  done_ = std::max(done_, now);
  probe_.sample(now);
  for (Open& open : open_) {
    if (open.read != nullptr) open.check.sample(now, (*open.read)());
    if (now >= open.check.end()) open.check.finish(now);
  }
  std::erase_if(later_, [&](const Later& later) {
    const int64_t value = (*later.read)();
    if (!later.expect->condition.holds(value)) return false;
    result_.findings[later.finding].values.push_back(
        fmt::format("{} becomes {} at {}, {} later", later.expect->subject.text(), later.expect->subject.value_text(value), time_text(now),
                    time_text(now - later.wanted)));
    return true;
  });
  const bool waited = waiting_ != nullptr && watched(*waiting_) != Check::Verdict::Open;
  settle();
  return !waited && !stopped_ && !(stage_ == Stage::AtEnd && plant_.programs_over());
}

void Script::tell_event(const std::string& bus, Time now, const std::string& text, const std::string& meaning) {
  for (Open& open : open_)
    if (open.read == nullptr && open.check.expect().subject.bus == bus)
      open.check.event(now, text, meaning);
}

// Failed checks become findings at once, while the plant still shows what there was.
void Script::settle() {
  for (auto open = open_.begin(); open != open_.end();) {
    if (open->check.verdict() == Check::Verdict::Open || open->item == waiting_) {
      ++open;
      continue;
    }
    if (open->check.verdict() == Check::Verdict::Failed) add_finding(open->item, open->check.problem());
    open = open_.erase(open);
  }
}

Time Script::last_time() const {
  Time last = cursor_;
  for (const Open& open : open_)
    if (open.check.end() != runtime::kNever) last = std::max(last, open.check.end());
  return last;
}

// --- its end ---

void Script::give_up(std::string text, std::optional<FilePlace> in_plant) {
  if (over() || stopped_) return;
  stopped_ = true;
  add_finding(in_plant ? nullptr : waiting_, std::move(text));
  if (!in_plant) return;
  result_.findings.back().file = test_.plant_path;
  result_.findings.back().place = *in_plant;
}

void Script::finish() {
  stage_ = Stage::Over;
  for (Open& open : open_) open.check.finish(plant_.now());
  settle();
  for (const Later& later : later_)
    result_.findings[later.finding].values.push_back(
        fmt::format("{} does not become {} until {}, the end of the test", later.expect->subject.text(),
                    later.expect->condition.text(later.expect->subject), time_text(plant_.now())));
  find_faults();
  if (result_.checks == 0 && result_.findings.empty()) add_finding(nullptr, "the test expects nothing");
}

// What follows makes no sense any more.
void Script::stop(const Item& item, std::string text) {
  stopped_ = true;
  add_finding(&item, std::move(text));
}

void Script::add_finding(const Item* item, std::string text) {
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
std::vector<std::string> Script::source_of(FilePlace place) const {
  std::vector<std::string> source;
  for (size_t n = place.line; n >= 1 && n <= test_.lines->size(); ++n) {
    const std::string& line = (*test_.lines)[n - 1];
    if (n > place.line && (line.empty() || line.starts_with('[') || test_.is_program)) break;
    source.push_back(line);
  }
  return source;
}

// A fault that nothing in the test names is not what its author had in mind.
void Script::find_faults() {
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

}  // namespace ipos::tools::testing

// Running forward, and the search for the last stop in what was.
#include "tools/debugger/debugger.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vm/exec/saved_state.hpp"

namespace ipos::tools::debug {
namespace {

using runtime::Station;
using runtime::Time;

// So far apart are snapshots: what is replayed for a step back takes some milliseconds.
constexpr uint64_t kSnapshotCommands = 20'000;
constexpr Time kSnapshotTime = 250 * runtime::kMillisecond;
constexpr uint64_t kAtOnce = 1'000'000;
constexpr const char* kBeginning = "this is the beginning of the run";

// An action that the debugger itself carries out.
constexpr const char* kJump = "jump";
bool is_jump(const Json& action) { return action.is_object() && action.value("act", "") == kJump; }

bool is_far(const Position& from, const Position& to) {
  return to.commands - from.commands >= kSnapshotCommands || to.time - from.time >= kSnapshotTime;
}

}  // namespace

Debugger::Debugger(Debuggee what, FrontEnd& front_end, std::unique_ptr<Snapshots> snapshots, Time limit)
    : what_(std::move(what)), front_end_(front_end), limit_(limit), plant_(nullptr, Release{}), snapshots_(std::move(snapshots)) {
  build();
}

Debugger::Debugger(runtime::Plant& running, FrontEnd& front_end)
    : what_(MakePlant()), front_end_(front_end), limit_(runtime::kNever), plant_(&running, Release{false}) {
  for (const auto& station : plant_->stations()) {
    machines_.push_back(nullptr);
    codes_.emplace_back();
    if (station->image() != nullptr) codes_.back().emplace(*station->image());
  }
  look();
}

// A program may have been loaded meanwhile, through the indices of the program memory or by a download.
void Debugger::look() {
  position_ = {0, plant_->now(), Phase::Between};
  for (uint32_t station = 0; station < plant_->stations().size(); ++station) {
    const vm::Image* image = plant_->stations()[station]->image();
    if (const CodeMap* known = code(station); known == nullptr ? image != nullptr : !known->is_of(image)) program_changed(station);
    for (int context = 1; machine(station) != nullptr && context <= vm::kContexts; ++context)
      position_.commands += machine(station)->context(context).commands;
  }
}

void Debugger::refuse_to_act() const {
  if (only_looks()) throw ValueError("the run is only looked at: it goes on, and nothing stops it or writes into it");
}

void Debugger::build() {
  codes_.clear();
  machines_.clear();
  companion_.reset();
  plant_.reset();  // its files are closed before they are opened again
  plant_ = {what_.make().release(), Release{}};
  if (what_.accompany)
    companion_ = what_.accompany(*plant_, [this](const std::string& text) {
      if (goal_.kind == Goal::Kind::Forward || resumes_) front_end_.output(text);
    });
  for (const auto& station : plant_->stations()) {
    station->use_runner(*this);
    machines_.push_back(nullptr);
    codes_.emplace_back();
    if (station->image() != nullptr) codes_.back().emplace(*station->image());
  }
  position_ = last_ = last_snapshot_ = {};
  open_ = nullptr;
  next_change_ = 0;
  told_all_ended_ = false;
  told_failures_ = 0;
  if (snapshots_ && !plant_->machines().gives_states())
    plant_->tell(runtime::Weight::Warning, "", "time goes back by running again from 0 s: not every FMU can give its state");
  front_end_.built(*plant_);
}

void Debugger::prime() {
  watched_.clear();
  // What a signal is read from belongs to one plant and does not go with the session.
  for (Watchpoint& watchpoint : watchpoints_) {
    watchpoint.place = find_again(*plant_, watchpoint.place);
    watched_.push_back(read_value(watchpoint.place));
  }
}

Order Debugger::order_for(Motion motion, TaskRef task, bool backward) const {
  Order order{motion, backward, task, 0, 0, 0, 0};
  const vm::Machine* of_task = machine(task.station);
  if (of_task == nullptr || task.task == 0) return order;
  order.context = of_task->active_context(task.task);
  order.depth = of_task->context(order.context).depth;
  return order;
}

Stop Debugger::run(const Order& order) {
  refuse_to_act();
  goal_ = {};
  goal_.order = order;
  start_ = position_;
  if (!order.backward) drop_later();
  prime();
  if (snapshots_ && snapshots_->count() == 0 && position_ == Position{} && snapshot()) return go();
  if (order.backward) {
    goal_.kind = Goal::Kind::Search;
    goal_.end = position_;
    if (position_ == Position{}) return {Reason::Beginning, {}, {}, kBeginning};
    rewind(goal_.end, true);
  }
  return go();
}

Stop Debugger::visit(Time time) {
  refuse_to_act();
  const Stop there{Reason::Step, {}, {}, {}};
  // The beginning comes before what happens at 0 s.
  const bool back = time == 0 ? position_ > Position{} : position_.time > time;
  if (!back && position_.time == time && position_.phase == Phase::Between) return there;
  goal_ = {};
  goal_.kind = Goal::Kind::Visit;
  goal_.order.motion = Motion::ToTime;
  goal_.order.time = time;
  goal_.stop = there;
  start_ = position_;
  const Position* snapshot = snapshots_ ? snapshots_->before(time) : nullptr;
  if (snapshot != nullptr && (back || (*snapshot > position_ && is_far(position_, *snapshot))))
    snapshots_->go_on_from(*snapshot, save());
  if (back) build();
  prime();
  return go();
}

Stop Debugger::return_to(const Position& moment) {
  refuse_to_act();
  const Stop there{Reason::Step, {}, {}, {}};
  if (position_ >= moment) return there;
  goal_ = {};
  goal_.kind = Goal::Kind::Replay;
  goal_.end = start_ = moment;
  goal_.stop = there;
  const Position* snapshot = snapshots_ ? snapshots_->before(moment, false) : nullptr;
  if (snapshot != nullptr && *snapshot > position_ && is_far(position_, *snapshot)) snapshots_->go_on_from(*snapshot, save());
  prime();
  return go();
}

void Debugger::drop_later() {
  if (furthest_ <= position_) return;
  const size_t dropped = std::erase_if(changes_, [this](const Change& change) { return change.at > position_; });
  furthest_ = position_;
  if (snapshots_) snapshots_->drop_after(position_);
  front_end_.dropped(dropped);
}

void Debugger::run_again() {
  refuse_to_act();
  takes_snapshots_ = false;
  goal_ = {};
  goal_.kind = Goal::Kind::Replay;
  goal_.end = start_ = position_;
  build();
  prime();
  go();
}

// Without copies: one of them would go on with what its caller does next. A moment that this plant does not come to ends with
// its time.
Stop Debugger::resume(std::vector<Change> changes, const Position& moment) {
  refuse_to_act();
  changes_ = std::move(changes);
  furthest_ = {};
  goal_ = {};
  goal_.kind = Goal::Kind::Replay;
  goal_.end = start_ = moment;
  goal_.order.motion = Motion::ToTime;
  goal_.order.time = moment.time + (moment.phase == Phase::Between ? 0 : runtime::kMillisecond);
  goal_.stop = {Reason::Step, {}, {}, {}};
  const bool takes = std::exchange(takes_snapshots_, false);
  resumes_ = true;  // the user has not heard of it
  build();
  prime();
  const Stop stop = go();
  resumes_ = false;
  takes_snapshots_ = takes;
  return stop;
}

void Debugger::restart(std::optional<Debuggee> next) {
  refuse_to_act();
  if (snapshots_) snapshots_->clear();
  changes_.clear();
  furthest_ = {};
  if (!next) return build();
  std::swap(what_, *next);
  try {
    build();
  } catch (...) {
    std::swap(what_, *next);
    build();
    throw;
  }
}

void Debugger::program_changed(uint32_t station) {
  codes_[station].reset();
  if (const vm::Image* image = plant_->stations()[station]->image(); image != nullptr) codes_[station].emplace(*image);
}

// Until the order is carried out; perhaps in another process, which knows nothing of what stood above it
// here.
Stop Debugger::go() {
  for (;;) {
    while (!advance()) {
    }
    if (goal_.kind != Goal::Kind::Search) break;
    search_further();
  }
  goal_.kind = Goal::Kind::Forward;
  furthest_ = std::max(furthest_, position_);
  for (const int id : stop_.ids)
    std::erase_if(breakpoints_,
                  [id](const Breakpoint& breakpoint) { return breakpoint.id == id && breakpoint.temporary; });
  return stop_;
}

// One event, or the rest of a tick. True: stopped, or the end of a search.
bool Debugger::advance() {
  if (open_ != nullptr) {
    std::exchange(open_, nullptr)->resume_tick();
  } else {
    if (position_ == Position{} && arrived(Phase::Between)) return true;
    if (!plant_->queue().step()) return take({Reason::AllEnded, {}, {}, "nothing happens any more"});
  }
  if (open_ != nullptr) return true;
  const Time now = plant_->now();
  return now % runtime::kMillisecond == 0 && plant_->next_time() > now && between();
}

bool Debugger::between() {
  if (companion_) companion_->passed(plant_->now());
  front_end_.passed(plant_->now());
  const bool over = arrived(Phase::Between);
  const bool searching = goal_.kind == Goal::Kind::Search;
  if (over && !searching) return true;
  if (!over && snapshot_is_due() && front_end_.wants_snapshot() && snapshot()) return arrived(Phase::Between);
  if (searching)
    if (auto stop = data_changed(true)) candidate(last_, std::move(*stop));
  if (goal_.kind == Goal::Kind::Visit) return over || (!front_end_.keep_going() && take({Reason::Pause, {}, {}, ""}));
  if (goal_.kind != Goal::Kind::Forward) return over;
  if (auto stop = data_changed(false)) return take(std::move(*stop));
  if (auto stop = task_ended()) return take(std::move(*stop));
  if (goal_.order.motion == Motion::ToTime && plant_->now() >= goal_.order.time)
    return take({Reason::Step, {}, {}, ""});
  if (const auto& failures = plant_->machines().failures(); told_failures_ < failures.size())
    return take({Reason::Fault, {}, {}, failures[told_failures_++].text});
  if (plant_->now() >= limit_) return take({Reason::Limit, {}, {}, "the time to run is over"});
  if (!told_all_ended_ && plant_->programs_over()) {
    told_all_ended_ = true;
    return take({Reason::AllEnded, {}, {}, "all programs have ended"});
  }
  return !front_end_.keep_going() && take({Reason::Pause, {}, {}, ""});
}

bool Debugger::take(Stop stop) {
  stop_ = std::move(stop);
  return true;
}

// Notes the position and does again what the user did here. True: the goal is there.
bool Debugger::arrived(Phase phase) {
  if (phase != Phase::Behind) last_ = position_;
  position_.time = plant_->now();
  position_.phase = phase;
  for (; next_change_ < changes_.size() && changes_[next_change_].at <= position_; ++next_change_)
    if (const Change& change = changes_[next_change_]; change.at == position_) {
      if (change.action.is_null())
        write_value(find_again(*plant_, change.place), change.value);
      else if (is_jump(change.action))
        set_next(change.action["who"].get<TaskRef>(), change.action["address"].get<uint32_t>());
      else
        front_end_.perform(change.action);
    }
  const bool back_there =
      goal_.order.motion == Motion::ToTime && phase == Phase::Between && position_.time >= goal_.order.time;
  const bool replayed = goal_.kind == Goal::Kind::Replay && position_ >= goal_.end;
  if (replayed || (goal_.repeats() && back_there)) return take(goal_.stop);
  return goal_.kind == Goal::Kind::Search && position_ >= goal_.end;
}

// What is run again has nothing to look at before its end, or before the user did something.
uint64_t Debugger::commands_to_look_at() const {
  if (!goal_.repeats()) return 0;
  uint64_t next = goal_.kind == Goal::Kind::Replay ? goal_.end.commands : UINT64_MAX;
  if (next_change_ < changes_.size()) next = std::min(next, changes_[next_change_].at.commands);
  return next - std::min(next, position_.commands);
}

bool Debugger::run(Station& station, vm::Machine& machine, vm::TickSteps& steps) {
  const auto number = static_cast<uint32_t>(&station.config() - plant_->file().stations.data());
  const bool follows = goal_.repeats() && front_end_.follows_commands();
  machines_[number] = &machine;
  while (const int task = steps.task()) {
    if (const uint64_t away = commands_to_look_at(); away > 1) {
      if (follows) front_end_.executes(number, machine.context(machine.active_context(task)).pc);
      position_.commands += steps.step(machine, follows ? 1U : static_cast<uint32_t>(std::min(away - 1, kAtOnce)));
      continue;
    }
    open_ = &station;
    if (before_command({number, task}, machine)) return false;
    front_end_.executes(number, machine.context(machine.active_context(task)).pc);
    last_ = position_;
    const bool faulted = machine.fault().number != 0;
    position_.commands += steps.step(machine);
    if (behind_command({number, task}, machine, !faulted && machine.fault().number != 0)) return false;
    open_ = nullptr;
  }
  return true;
}

bool Debugger::before_command(TaskRef task, const vm::Machine& machine) {
  const bool over = arrived(Phase::Before);
  if (goal_.repeats() || (goal_.kind == Goal::Kind::Forward && position_ == start_)) return over;
  const bool backward = goal_.kind == Goal::Kind::Search;
  if (auto stop = data_changed(backward)) {
    if (!backward) return take(std::move(*stop));
    candidate(last_, std::move(*stop));
  }
  if (over) return true;
  auto stop = stop_at_breakpoint(task, machine, backward);
  if (!stop) stop = step_ends(task, machine);
  if (!stop) return false;
  if (!backward) return take(std::move(*stop));
  candidate(position_, std::move(*stop));
  return false;
}

bool Debugger::behind_command(TaskRef task, const vm::Machine& machine, bool faulted) {
  const bool over = arrived(Phase::Behind);
  if (goal_.repeats()) return over;
  const bool backward = goal_.kind == Goal::Kind::Search;
  auto stop = data_changed(backward);
  if (stop) stop->task = task;
  if (backward) {
    if (stop) candidate(last_, std::move(*stop));
    return over;
  }
  if (stop) return take(std::move(*stop));
  if (faulted)
    return take(
        {Reason::Fault, task, {}, fmt::format("F{:02}: {}", machine.fault().number, machine.fault().reason)});
  stop = task_ended();
  return stop && take(std::move(*stop));
}

// The last one found counts.
void Debugger::candidate(const Position& at, Stop stop) {
  if (at >= goal_.end || at < searched_from_) return;
  goal_.found = true;
  goal_.candidate = at;
  goal_.stop = std::move(stop);
}

// A stretch is searched: on to what was found there, or the stretch before it.
void Debugger::search_further() {
  if (!goal_.found && searched_from_ != Position{}) {
    goal_.end = searched_from_;
    return rewind(goal_.end, true);
  }
  if (!goal_.found) goal_.stop = {Reason::Beginning, {}, {}, kBeginning};
  goal_.end = goal_.candidate;  // if none was found the beginning
  goal_.kind = Goal::Kind::Replay;
  rewind(goal_.end, false);
}

// To the last snapshot at or before a position, or else to the beginning.
void Debugger::rewind(const Position& to, bool strictly) {
  if (const Position* snapshot = snapshots_ ? snapshots_->before(to, strictly) : nullptr)
    snapshots_->go_on_from(*snapshot, save());
  build();
  searched_from_ = {};
  prime();
}

// On the way again there may be one already.
bool Debugger::snapshot_is_due() const {
  if (!snapshots_ || !takes_snapshots_ || !is_far(last_snapshot_, position_)) return false;
  const Position* kept = snapshots_->before(position_, false);
  return kept == nullptr || is_far(*kept, position_);
}

// True in a process that goes on from here at a later time, with what it was given.
bool Debugger::snapshot() {
  if (!snapshots_ || !takes_snapshots_) return false;
  last_snapshot_ = position_;
  // A copy has the processes of machines in common with this one, so it puts their states back.
  const auto machines = plant_->machines().save();
  if (!machines) return false;
  const std::optional<std::string> bytes = snapshots_->take(position_);
  if (!bytes) return false;
  plant_->machines().restore(*machines);
  load(*bytes);
  return true;
}

std::string Debugger::save() {
  const Json state{{"goal", goal_},       {"breakpoints", breakpoints_}, {"watchpoints", watchpoints_},
                   {"changes", changes_}, {"last_id", last_id_},         {"front_end", front_end_.save()},
                   {"furthest", furthest_}};
  std::string bytes;
  Json::to_cbor(state, bytes);
  return bytes;
}

// What was done to the plant of this snapshot stands at the head of all changes, and is not done once more.
void Debugger::load(const std::string& bytes) {
  const Json state = Json::from_cbor(bytes);
  goal_ = state["goal"];
  breakpoints_ = state["breakpoints"].get<std::vector<Breakpoint>>();
  watchpoints_ = state["watchpoints"].get<std::vector<Watchpoint>>();
  changes_ = state["changes"].get<std::vector<Change>>();
  last_id_ = state["last_id"];
  furthest_ = state["furthest"];
  front_end_.load(state["front_end"]);
  searched_from_ = position_;
  prime();
}

void Debugger::write(const ValuePlace& place, int32_t value) {
  refuse_to_act();
  write_value(place, value);
  drop_later();
  changes_.push_back({position_, place, value, nullptr});
  next_change_ = changes_.size();
}

void Debugger::go_on_at(TaskRef task, uint32_t address) {
  refuse_to_act();
  set_next(task, address);
  drop_later();
  changes_.push_back({position_, {}, 0, {{"act", kJump}, {"who", task}, {"address", address}}});
  next_change_ = changes_.size();
}

void Debugger::set_next(TaskRef task, uint32_t address) {
  vm::Machine* const of_task = machines_[task.station];
  if (of_task == nullptr) throw ValueError("nothing of that program has been executed yet");
  const int context = of_task->active_context(task.task);
  switch (of_task->context(context).state) {
    case vm::TaskState::Stopped: throw ValueError(fmt::format("{} is stopped and goes on nowhere", task_name(task)));
    case vm::TaskState::Waiting: throw ValueError(fmt::format("{} waits inside a command, which must end first", task_name(task)));
    case vm::TaskState::Ready: break;
  }
  vm::SavedState::go_on_at(*of_task, context, address);
}

void Debugger::perform(const Json& action) {
  refuse_to_act();
  front_end_.perform(action);
  drop_later();
  changes_.push_back({position_, {}, 0, action});
  next_change_ = changes_.size();
}

}  // namespace ipos::tools::debug

// The loop of the plant, and the commands of the tab Time.
#include "tools/serve/host/plant_host.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/clock/lateness.hpp"
#include "runtime/plant/trace_hash.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::kMillisecond;
using runtime::Time;
using namespace std::chrono_literals;

constexpr auto kTellTime = 50ms;  // while it runs
constexpr auto kMeasured = 1s;    // of `rate`
constexpr auto kBetweenSnapshots = 50ms;  // so long is the way from one to a moment, as long as all are kept
constexpr int kSnapshotShare = 25;        // of the time, one part at most is for taking them (ours)
constexpr auto kTurnLasts = 2ms;        // then messages have theirs
constexpr WallClock::time_point kImmediately = WallClock::time_point::min();
constexpr auto kBehind =
    1ms;  // of a plant with real ports: what comes within a millisecond is there before it is run
constexpr auto kForgiven = std::chrono::nanoseconds(runtime::kForgiven);  // as `ipos run --realtime`
constexpr Time kTelegramLimit = 10 * runtime::kSecond;
constexpr int64_t kFarthest = 1'000'000'000'000'000;  // us

const char* reason_text(debug::Reason reason) {
  switch (reason) {
    case debug::Reason::Breakpoint: return "breakpoint";
    case debug::Reason::Fault: return "fault";
    case debug::Reason::TaskEnded: return "ended";
    default: return "step";
  }
}

}  // namespace

PlantHost::PlantHost(debug::Debuggee what, std::string title, std::string version, const Around& around)
    : clock_(around.clock),
      copies_(around.copies),
      ports_(around.ports),
      files_(around.files),
      language_(around.language),
      router_(around.outbox, around.clock),
      title_(std::move(title)),
      version_(std::move(version)),
      texts_(around.files) {
  add_action("load", [this](const Json& action) { load_program(Arguments(action)); });
  tabs_ = make_tabs(*this);
  debugger_.emplace(std::move(what), *this, copies_.snapshots(), runtime::kNever);
  elsewhere_ = false;
  router_.hello = [this] {
    return Json{{"protocol", 1},   {"version", version_}, {"mode", "plant"},
                {"title", title_}, {"writable", true},    {"live", ports_.joined()}};
  };
  add_time_commands();
  if (ports_.joined()) stay_in_step();
}

PlantHost::~PlantHost() { ports_.leave(); }  // while there is a plant

void PlantHost::restore(const Json& settings) {
  for (const auto& tab : tabs_) tab->restore(settings);
}

void PlantHost::resume(const sessions::Session& session) {
  try {
    debugger_->resume(session.actions, session.moment);
  } catch (const Mistake&) {
    throw;
  } catch (const std::exception& error) {  // an action that nobody knows, a name that is no more
    throw Mistake(fmt::format("what was done in the session cannot be done again: {}", error.what()));
  }
  if (runtime::state_digest(*plant_) != session.digest)
    throw Mistake("the plant comes to another state than in the session; it was saved by another version of ipos, or is damaged");
}

WallClock::time_point PlantHost::turn() {
  turn_began_ = now();
  if (!running_) paced_ = false;
  if (next_.kind != MotionKind::None || (running_ && is_due())) carry_out();
  publish(busy() && due() <= now());
  WallClock::time_point next = router_.next_due();
  if (running_) next = std::min(next, time_due_);
  if (busy()) next = std::min(next, due());
  return second_runs_ != 0 ? kImmediately : next;
}

void PlantHost::take(const Message& message) {
  router_.take(message);
  if (message.kind != MessageKind::Opened) return;
  Client& client = router_.clients().at(message.client);
  router_.send(client, time_event());
  if (ports_.joined()) router_.send(client, ports_event());
}

// --- how time passes ---

void PlantHost::add_time_commands() {
  router_.add_command("run", [this](const Router::Call& call) {
    set_speed(call.arguments.number("speed", 0, 1000, speed_));
    stopped_ = nullptr;
    running_ = true;
    return reply_and_tell(call);
  });
  router_.add_command("pause", [this](const Router::Call& call) {
    running_ = false;
    if (debugger_) cost_.begin(*debugger_);
    halted_ = true;
    return reply_and_tell(call);
  });
  router_.add_command("speed", [this](const Router::Call& call) {
    set_speed(call.arguments.number("speed", 0, 1000));
    return reply_and_tell(call);
  });
  router_.add_command("step", [this](const Router::Call& call) {
    Motion motion;
    motion.kind = MotionKind::Order;
    motion.order.motion = debug::Motion::ToTime;
    const Time border = plant_->now() / kMillisecond * kMillisecond;
    if (call.arguments.flag("telegram", false)) {
      motion.order.time = border + kTelegramLimit;
      motion.telegram = true;
    } else {
      motion.order.time = border + call.arguments.whole("ms", 1, 3'600'000, 1) * kMillisecond;
    }
    return begin(call, std::move(motion));
  });
  router_.add_command("back", [this](const Router::Call& call) {
    const int64_t to = call.arguments.has("us")
                           ? call.arguments.whole("us", 0, kFarthest)
                           : us() - call.arguments.whole("ms", 1, kFarthest / 1000) * 1000;
    if (to > us()) throw Mistake("that time is still to come");
    return go_to(call, std::max<int64_t>(to, 0));
  });
  router_.add_command("go", [this](const Router::Call& call) {
    const int64_t to = call.arguments.whole("us", 0, kFarthest);
    if (to > furthest_us()) throw Mistake("that time is still to come");
    // A slider that is dragged waits for nothing: what it ordered before is given up where it is.
    if (next_.kind == MotionKind::Go || next_.kind == MotionKind::Order) {
      router_.reply(next_.client, next_.id, {{"us", us()}, {"replaced", true}});
      next_ = {};
    }
    return go_to(call, to);
  });
  router_.add_command("restart", [this](const Router::Call& call) {
    Motion motion;
    motion.kind = MotionKind::Restart;
    return begin(call, std::move(motion));
  });
}

// The event comes after the reply: a client that asks, and then waits for it, does not wait in vain.
Json PlantHost::reply_and_tell(const Router::Call& call) {
  router_.reply(call.client.number, call.id, Json::object());
  tell_time();
  return nullptr;
}

// With real ports time is that of the world outside, from the beginning on.
void PlantHost::stay_in_step() {
  running_ = true;
  const auto refuse = [](const Router::Call&) -> Json {
    throw Mistake(
        "this plant has real ports: it runs in step with the clock, and can neither stand nor go back");
  };
  for (const char* name : {"pause", "step", "speed", "back", "go", "restart", "break.set", "program.step"})
    router_.add_command(name, refuse);
  router_.add_command("run", [refuse](const Router::Call& call) {
    return call.arguments.number("speed", 0, 1000, 1) == 1 ? Json::object() : refuse(call);
  });
}

// One motion at a time; who orders another one meanwhile waits for the next one's end.
Json PlantHost::begin(const Router::Call& call, Motion motion) {
  if (next_.kind != MotionKind::None || now_.kind > MotionKind::Run)
    throw Mistake("the plant is still on its way; wait for the reply to the step before");
  motion.client = call.client.number;
  motion.id = call.id;
  next_ = std::move(motion);
  running_ = false;
  stopped_ = nullptr;
  return nullptr;
}

Json PlantHost::go_to(const Router::Call& call, int64_t us) {
  Motion motion;
  motion.kind = MotionKind::Go;
  motion.time = us * runtime::kMicrosecond / kMillisecond * kMillisecond;
  return begin(call, std::move(motion));
}

int64_t PlantHost::furthest_us() const {
  return std::max(us(), debugger_ ? debugger_->furthest().time / runtime::kMicrosecond : 0);
}

void PlantHost::order(const Router::Call& call, const debug::Order& order) {
  Motion motion;
  motion.kind = MotionKind::Order;
  motion.order = order;
  begin(call, std::move(motion));
}

void PlantHost::stop(const std::string& reason, const std::string& text) {
  if (ports_.joined() || now_.kind == MotionKind::Go) return;
  running_ = false;
  halted_ = true;
  stopped_ = {{"reason", reason}, {"text", text}};
}

// After the debugger's motions this may be another process: only members are used.
void PlantHost::carry_out() {
  now_ = std::exchange(next_, {});
  if (now_.under_way && halted_) return finish({debug::Reason::Pause, {}, {}, {}});
  if (!now_.under_way) halted_ = telegram_seen_ = false;
  const bool goes_on = std::exchange(paced_, now_.kind == MotionKind::None);
  switch (now_.kind) {
    case MotionKind::None:
      now_.kind = MotionKind::Run;
      if (!goes_on) set_speed(speed_);
      now_.order = {};
      return finish(debugger_->run(now_.order));
    case MotionKind::Go: return finish(debugger_->visit(now_.time));
    case MotionKind::Restart: return restart();
    default: return finish(debugger_->run(now_.order));
  }
}

void PlantHost::finish(const debug::Stop& stop) {
  Motion done = std::exchange(now_, {});
  if (std::exchange(turn_over_, false) && stop.reason == debug::Reason::Pause && !halted_) {
    if (done.kind != MotionKind::Run) go_on(std::move(done));
    return;
  }
  const bool stands_there = stop.reason == debug::Reason::Breakpoint ||
                            (done.kind == MotionKind::Order && stop.reason != debug::Reason::Pause &&
                             done.order.motion != debug::Motion::ToTime);
  // A program that ends or has a fault is no reason for the others to stand.
  if (done.kind == MotionKind::Order && done.order.motion == debug::Motion::ToTime && !stands_there &&
      !halted_ && stop.reason != debug::Reason::Pause && stop.reason != debug::Reason::Step) {
    return go_on(std::move(done));
  }
  if (stands_there) {
    running_ = false;
    stopped_ = {{"reason", reason_text(stop.reason)}, {"text", stop.text}};
    cost_.stopped(*debugger_);
    if (const uint64_t commands = cost_.commands(); commands != 0)
      stopped_["cost"] = {{"us", cost_.time() / runtime::kMicrosecond}, {"commands", commands}};
    if (stop.task.task != 0) {
      const auto frames = debugger_->frames(stop.task);
      stopped_["station"] = plant_->stations()[stop.task.station]->config().name;
      stopped_["task"] = stop.task.task;
      if (!frames.empty()) {
        stopped_["file"] = frames.front().place.file;
        stopped_["line"] = frames.front().place.line;
      }
      if (stop.reason == debug::Reason::Breakpoint && !frames.empty())
        mark("breakpoint", fmt::format("{}:{}", frames.front().place.file, frames.front().place.line), stopped_["station"],
             frames.front().function);
    }
  }
  if (!stands_there && (!running_ || done.kind == MotionKind::Go)) cost_.begin(*debugger_);
  if (std::exchange(elsewhere_, false) || done.kind == MotionKind::Go) new_generation();
  if (done.kind != MotionKind::Run) router_.reply(done.client, done.id, {{"us", us()}});
  if (!running_ || done.kind != MotionKind::Run) tell_time();
}

// With the next turn, where it has come to now.
void PlantHost::go_on(Motion motion) {
  next_ = std::move(motion);
  next_.under_way = true;
}

void PlantHost::new_generation() {
  ++generation_;
  router_.refresh();
}

void PlantHost::set_speed(double speed) {
  speed_ = speed;
  paced_from_ = measured_from_ = now();
  paced_at_ = measured_at_ = plant_->now();
}

Json PlantHost::time_event() const {
  return {{"event", "time"},
          {"us", us()},
          {"running", running_},
          {"speed", speed_},
          {"rate", running_ ? rate_ : 0.0},
          {"generation", generation_},
          {"furthest_us", furthest_us()},
          {"over", plant_->programs_over()},
          {"stopped", stopped_}};
}

void PlantHost::tell_time() {
  router_.send_all(time_event());
  // This is not told again, so it goes to those who are behind, too.
  if (std::exchange(ports_changed_, false))
    for (auto& [number, client] : router_.clients()) router_.send(client, ports_event());
  time_due_ = now() + kTellTime;
}

// --- between two milliseconds ---

bool PlantHost::keep_going() {
  if (ports_.joined()) ports_.flush();
  const auto clock = now();
  if (std::exchange(takes_snapshot_, false)) snapshot_took_ = clock - last_snapshot_;
  if (clock - measured_from_ >= kMeasured) {
    rate_ = static_cast<double>(plant_->now() - measured_at_) /
            static_cast<double>(std::chrono::nanoseconds(clock - measured_from_).count());
    measured_from_ = clock;
    measured_at_ = plant_->now();
  }
  publish(true);
  if (now_.telegram && telegram_seen_) halted_ = true;
  if (halted_) return false;
  turn_over_ = clock - turn_began_ >= kTurnLasts || (now_.kind == MotionKind::Run && !is_due());
  return !turn_over_;
}

// A port that goes away is told to the journal, the page and the terminal that started the server.
void PlantHost::look_at_ports() {
  for (const std::string& note : ports_.take_notes()) fmt::print(stderr, "ipos: warning: {}\n", note);
  for (const Ports::Change& change : ports_.take_changes(plant_->now())) {
    ports_changed_ = true;
    if (change.text.empty()) continue;
    plant_->tell(change.there ? runtime::Weight::Why : runtime::Weight::Warning, "", change.text);
    fmt::print(stderr, "ipos: {}{}\n", change.there ? "" : "warning: ", change.text);
  }
}

Json PlantHost::ports_event() const { return {{"event", "ports"}, {"us", us()}, {"ports", ports_.states()}}; }

// As long as it runs at a pace its milliseconds wait until the clock has come as far as the plant.
WallClock::time_point PlantHost::due() const {
  if (next_.kind != MotionKind::None || !paced_ || speed_ == 0) return kImmediately;
  const auto ahead = std::chrono::nanoseconds(
      static_cast<int64_t>(static_cast<double>(plant_->now() - paced_at_) / speed_));
  return paced_from_ + ahead + (ports_.joined() ? kBehind : 0ms);
}

bool PlantHost::is_due() {
  const auto clock = now();
  const auto at = due();
  if (at > clock) return false;
  if (at != kImmediately && clock - at > kForgiven) paced_from_ += clock - at;
  if (paced_ && ports_.joined()) {
    ports_.collect(paced_from_, paced_at_);
    look_at_ports();
  }
  return true;
}

// A host without clients that does what this one has done. Nobody hears it.
class PlantHost::ByTurns final : public SecondRun, private Outbox {
 public:
  explicit ByTurns(PlantHost& first)
      : first_(first),
        second_(first.debugger_->debuggee(), first.title_, first.version_, {*this, first.clock_, copies_, ports_, first.files_, first.language_}),
        end_(first.plant_->now()) {
    ++first_.second_runs_;
    second_.debugger_->will_do_as(*first.debugger_);
    for (size_t n = 0; n < first.tabs_.size(); ++n) second_.tabs_[n]->runs_again(*first.tabs_[n]);
    second_.next_.kind = MotionKind::Order;
    second_.next_.order.motion = debug::Motion::ToTime;
    second_.next_.order.time = end_;
  }
  ~ByTurns() override { --first_.second_runs_; }

  std::optional<bool> result() override {
    try {
      if (second_.busy()) second_.turn();
    } catch (const std::exception&) {
      return false;  // the same mistake was told by the first run
    }
    return second_.busy() ? std::nullopt : std::optional(second_.plant_->now() >= end_);
  }

 private:
  bool send(MessageKind, uint16_t, std::string_view) override { return true; }

  PlantHost& first_;
  Copies copies_;
  Ports ports_;
  PlantHost second_;
  Time end_;
};

std::unique_ptr<SecondRun> PlantHost::run_again() {
  if (ports_.joined()) return nullptr;
  auto copy = copies_.beside([this] {
    router_.clients().clear();
    for (const auto& tab : tabs_) tab->runs_again(*tab);
    debugger_->run_again();
  });
  if (copy) return copy;
  return std::make_unique<ByTurns>(*this);
}

// On the way to another moment there is nothing to look at but how far it has come.
void PlantHost::publish(bool busy) {
  const bool goes = now_.kind == MotionKind::Go || next_.kind == MotionKind::Go;
  const auto clock = now();
  if ((running_ || goes) && clock >= time_due_) tell_time();
  if (goes) return;
  for (const auto& tab : tabs_) tab->tend();
  router_.publish(clock, busy);
}

// --- the debugger's front end ---

Json PlantHost::save() {
  Json tabs = Json::array();
  for (const auto& tab : tabs_) tabs.push_back(tab->save());
  return {{"router", router_.save()}, {"tabs", std::move(tabs)},   {"running", running_},
          {"speed", speed_},      {"generation", generation_}, {"now", now_},
          {"next", next_},        {"cost", cost_.save()},
          {"offered", offered_ ? Json(*offered_) : Json(nullptr)}};
}

void PlantHost::load(const Json& state) {
  running_ = state["running"];
  speed_ = state["speed"];
  generation_ = state["generation"];
  now_ = state["now"];
  next_ = state["next"];
  cost_.load(state["cost"]);
  stopped_ = nullptr;
  build_.reset();
  offered_.reset();
  if (!state["offered"].is_null()) offered_ = state["offered"].get<std::string>();
  router_.load(state["router"]);
  for (size_t n = 0; n < tabs_.size(); ++n) tabs_[n]->load(state["tabs"][n]);
  paced_ = false;
  elsewhere_ = true;
  time_due_ = now() + kTellTime;
  last_snapshot_ = now();
  takes_snapshot_ = false;
}

void PlantHost::output(const std::string& text) {
  router_.send_all({{"event", "output"}, {"text", text}});
  if (!files_.test_beside()) return;
  const std::string line = text.substr(0, text.find('\n'));
  const size_t place = line.find(": ");  // of the test; the mark has its words only
  mark("check", place == std::string::npos ? line : line.substr(place + 2), "", text);
}

void PlantHost::built(runtime::Plant& plant) {
  plant_ = &plant;
  texts_.begin_again();
  elsewhere_ = true;
  source_ = plant.next_source();
  plant.queue().schedule(kMillisecond, source_, *this, 0);
  acted_.clear();
  ports_.join(plant, title_);
  for (const auto& tab : tabs_) tab->built(plant);
}

void PlantHost::on_event(Time now, uint32_t, uint64_t) {
  plant_->queue().schedule(now + kMillisecond, source_, *this, 0);
}

void PlantHost::passed(Time now) {
  acted_.clear();
  for (const auto& tab : tabs_) tab->passed(now);
}

void PlantHost::executes(uint32_t station, uint32_t address) {
  for (const auto& tab : tabs_) tab->executes(station, address);
}

void PlantHost::act(const std::string& name, Json details) {
  must_be_there();
  details["act"] = name;
  debugger_->perform(details);
  for (const auto& tab : tabs_) tab->acted(details);
}

void PlantHost::write(const debug::ValuePlace& place, int32_t value) {
  must_be_there();
  debugger_->write(place, value);
  const Json action{{"act", "set"}, {"station", plant_->stations()[place.station]->config().name}, {"name", place.name}};
  for (const auto& tab : tabs_) tab->acted(action);
}

// Nobody means the moments that lie on the way to another one.
void PlantHost::must_be_there() const {
  if (next_.kind == MotionKind::Go) throw Mistake("the plant is on its way to another moment");
}

std::vector<std::string> PlantHost::actions() const {
  std::vector<std::string> names;
  for (const auto& [name, action] : actions_) names.push_back(name);
  return names;
}

void PlantHost::perform(const Json& action) {
  actions_.at(action["act"].get<std::string>())(action);
  if (const auto station = action.find("station"); station != action.end() && station->is_string())
    acted_.insert(station->get<std::string>());
}

bool PlantHost::wants_snapshot() {
  const auto clock = now();
  if (clock - last_snapshot_ < std::max<WallClock::duration>(kBetweenSnapshots, kSnapshotShare * snapshot_took_)) return false;
  last_snapshot_ = clock;
  takes_snapshot_ = true;
  return true;
}

bool PlantHost::follows_commands() {
  return std::any_of(tabs_.begin(), tabs_.end(), [](const auto& tab) { return tab->follows_commands(); });
}

void PlantHost::dropped(size_t changes) {
  for (const auto& tab : tabs_) tab->dropped(changes);
}

uint32_t PlantHost::station_number(const std::string& name) const {
  std::string known;
  for (uint32_t n = 0; n < plant_->stations().size(); ++n) {
    const std::string& station = plant_->stations()[n]->config().name;
    if (station == name) return n;
    known += (known.empty() ? "" : ", ") + station;
  }
  throw Mistake(fmt::format("there is no station '{}', only {}", name, known));
}

}  // namespace ipos::tools::serve

// The host of a plant: runs it at the pace that is asked for, takes commands between two milliseconds and sends what is
// news. Who calls it gives it messages and turns of some milliseconds, and tells it the time. It is a front end of the
// debugger, so going back in time, breakpoints and steps are the debugger's. What is kept here is of the moment; a copy that
// goes on from a snapshot is given the rest by save() and load().
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/debugger/cost.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/serve/host/copies.hpp"
#include "tools/serve/host/outside.hpp"
#include "tools/serve/host/router.hpp"
#include "tools/serve/host/running_texts.hpp"
#include "tools/sessions/session.hpp"

namespace ipos::tools::serve {

// One tab of the page: its commands, its topic and what it gathers while the plant runs.
class Tab {
 public:
  virtual ~Tab() = default;
  virtual void built(runtime::Plant& /*plant*/) {}
  virtual void restarted() {}  // by the user; it will be built next
  virtual void loaded(uint32_t /*station*/) {}  // another program: its names and lines are others
  virtual void restore(const Json& /*settings*/) {}  // settings of an earlier start
  virtual void passed(runtime::Time /*now*/) {}
  virtual void executes(uint32_t /*station*/, uint32_t /*address*/) {}
  virtual void tend() {}        // now and then, between two milliseconds
  // PlantHost::run_again(): this tab is of the host that runs again, for one that goes on; in a copy of the process that is
  // itself.
  virtual void runs_again(Tab& /*first*/) {}
  virtual void acted(const Json& /*action*/) {}  // of a person, just now
  virtual void dropped(size_t /*changes*/) {}  // what came later, with so many actions, does not come any more
  virtual bool follows_commands() { return false; }  // wants executes() also on the way to another moment
  virtual Json save() { return nullptr; }
  virtual void load(const Json& /*state*/) {}
};

class PlantHost final : public debug::FrontEnd, private runtime::EventTarget {
 public:
  // Where it runs. What is left out is not there.
  struct Around {
    Outbox& outbox;
    const Clock& clock;
    Copies& copies;
    Ports& ports;
    Files& files;
    Language& language;
  };
  PlantHost(debug::Debuggee what, std::string title, std::string version, const Around& around);
  ~PlantHost() override;

  // What was set on the page at an earlier start; before the first turn.
  void restore(const Json& settings);
  // The moment of a session, from 0 s on; before the first turn. A Mistake: this plant does not come to it.
  void resume(const sessions::Session& session);
  void take(const Message& message);
  // Some milliseconds of the plant, if there is something to run, and what is news. Returns when the next turn is due; a message
  // may come before.
  WallClock::time_point turn();
  // The plant runs or is on its way.
  bool busy() const { return running_ || next_.kind != MotionKind::None; }

  // --- for the tabs ---
  Router& router() { return router_; }
  runtime::Plant& plant() const { return *plant_; }
  debug::Debugger& debugger() { return *debugger_; }
  uint32_t station_number(const std::string& name) const;  // a Mistake that names those there are
  runtime::Station& station(const std::string& name) { return *plant_->stations()[station_number(name)]; }
  const std::string& title() const { return title_; }  // the name of its file
  int64_t us() const { return plant_->now() / runtime::kMicrosecond; }
  int64_t furthest_us() const;  // the latest moment that one can go to
  // What is done to the plant goes this way: it is done again when its moment comes again.
  using Action = std::function<void(const Json&)>;
  void add_action(const std::string& name, Action action) { actions_[name] = std::move(action); }
  void act(const std::string& name, Json details);
  // The same for a variable of a program.
  void write(const debug::ValuePlace& place, int32_t value);
  // A tab that marks what happens on the timeline.
  std::function<void(const char* kind, const std::string& what, const std::string& station, const std::string& text)> mark;
  std::vector<std::string> actions() const;
  // A line that goes on outside.
  bool has_port(const std::string& bus) const { return ports_.joined(bus); }
  Copies& copies() { return copies_; }
  Files& files() { return files_; }
  Language& language() { return language_; }
  const RunningTexts& texts() const { return texts_; }
  // A plant that was built anew waits for a restart, and its programs for being loaded.
  void offer(Build build);
  bool offers() const { return offered_.has_value(); }
  // What was offered; a Mistake when nothing was, or when it can no longer be had.
  const Build& offered();
  // Something was done to this station that it sees with the next millisecond only; at 0 s that is all there is.
  bool sees_later(const std::string& station) const { return us() == 0 || acted_.contains(station); }
  // The plant stands before the next millisecond, unless it has real ports.
  void stop(const std::string& reason, const std::string& text);
  void telegram_seen() { telegram_seen_ = true; }
  // What runs again from the beginning up to now, for what was not gathered the first time: a copy of this process, and
  // where there are none a second host, which has its turn with each turn of this one.
  // Nothing: the world outside does not come again.
  std::unique_ptr<SecondRun> run_again();
  // A step of the program; the reply comes when it stands.
  void order(const Router::Call& call, const debug::Order& order);

 private:
  class ByTurns;  // a second run
  enum class MotionKind : uint8_t { None, Run, Order, Go, Restart };
  struct Motion {
    MotionKind kind = MotionKind::None;
    debug::Order order;
    runtime::Time time = 0;
    bool telegram = false;   // it ends with one
    bool under_way = false;  // it goes on in the next turn
    uint16_t client = 0;
    Json id = nullptr;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Motion, kind, order, time, telegram, under_way, client, id)
  };

  void add_time_commands();
  void stay_in_step();
  void look_at_ports();
  void must_be_there() const;
  Json begin(const Router::Call& call, Motion motion);
  Json go_to(const Router::Call& call, int64_t us);
  void carry_out();
  void go_on(Motion motion);
  void finish(const debug::Stop& stop);
  void new_generation();
  void restart();
  void load_program(const Arguments& a);
  void set_speed(double speed);
  Json reply_and_tell(const Router::Call& call);
  void tell_time();
  WallClock::time_point now() const { return clock_.now(); }
  WallClock::time_point due() const;  // the next millisecond
  bool is_due();                      // the same, and what has come from outside is on the lines
  void publish(bool busy);
  Json time_event() const;
  Json ports_event() const;

  // of debug::FrontEnd
  Json save() override;
  void load(const Json& state) override;
  bool keep_going() override;
  void output(const std::string& text) override;
  void built(runtime::Plant& plant) override;
  void passed(runtime::Time now) override;
  void executes(uint32_t station, uint32_t address) override;
  void perform(const Json& action) override;
  bool wants_snapshot() override;
  bool follows_commands() override;
  void dropped(size_t changes) override;
  void on_event(runtime::Time now, uint32_t kind, uint64_t argument) override;

  const Clock& clock_;
  Copies& copies_;
  Ports& ports_;
  Files& files_;
  Language& language_;
  Router router_;
  std::string title_;
  std::string version_;
  std::map<std::string, Action> actions_;
  std::set<std::string> acted_;  // stations, since the last millisecond
  RunningTexts texts_;
  std::optional<std::string> offered_;  // its version
  std::optional<Build> build_;          // that one, where this process has it
  std::vector<std::unique_ptr<Tab>> tabs_;
  runtime::Plant* plant_ = nullptr;
  uint32_t source_ = 0;  // of the event that comes every millisecond, even with all units off
  bool ports_changed_ = false;  // since the clients were told
  std::optional<debug::Debugger> debugger_;

  bool running_ = false;
  double speed_ = 1;            // 0: as fast as it goes
  bool halted_ = false;         // somebody wants it to stand before the next millisecond
  bool telegram_seen_ = false;  // since the motion began
  Json stopped_ = nullptr;
  debug::Cost cost_;  // since the plant stood before
  uint32_t generation_ = 1;
  bool elsewhere_ = false;  // another moment, which those before do not lead to
  Motion now_;   // under way
  Motion next_;  // ordered
  WallClock::time_point turn_began_{};
  bool turn_over_ = false;  // the motion goes on in the next one
  // Where the pace counts from.
  bool paced_ = false;  // it does
  WallClock::time_point paced_from_{};
  runtime::Time paced_at_ = 0;
  // What was reached.
  WallClock::time_point measured_from_{};
  runtime::Time measured_at_ = 0;
  double rate_ = 0;
  WallClock::time_point time_due_{};
  WallClock::time_point last_snapshot_{};
  int second_runs_ = 0;  // by turns
  bool takes_snapshot_ = false;
  WallClock::duration snapshot_took_{};
};

}  // namespace ipos::tools::serve

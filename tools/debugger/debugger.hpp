// The debugger: runs a plant command by command until there is something to stop for, and back again. Time
// stands still for the whole plant while it is stopped. Going back is going on from a snapshot, or from the
// beginning, to an earlier position; the plant does the same again. Until it runs on from there, what came later is kept.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "runtime/plant/plant.hpp"
#include "tools/debugger/code_map.hpp"
#include "tools/debugger/session.hpp"
#include "tools/debugger/snapshots.hpp"

namespace ipos::tools::debug {

// The plant as at power-on, each time.
using MakePlant = std::function<std::unique_ptr<runtime::Plant>()>;

// What goes with a plant and acts on it while it is debugged, as the script of a test does. Rebuilt with the plant.
class Companion {
 public:
  virtual ~Companion() = default;
  virtual void passed(runtime::Time now) = 0;  // everything of this millisecond has happened
};
// `tell` is for the user, who hears nothing twice while a stretch is run again.
using Accompany =
    std::function<std::unique_ptr<Companion>(runtime::Plant&, std::function<void(const std::string&)> tell)>;

// What is debugged.
struct Debuggee {
  Debuggee(MakePlant made, Accompany with = {}) : make(std::move(made)), accompany(std::move(with)) {}
  MakePlant make;
  Accompany accompany;  // may be empty
};

// A front end that talks to the user. Its state goes with the session when another process goes on.
class FrontEnd {
 public:
  virtual ~FrontEnd() = default;
  virtual Json save() = 0;
  virtual void load(const Json& state) = 0;
  virtual bool keep_going() = 0;                     // asked once a virtual millisecond; false: stop
  virtual void output(const std::string& text) = 0;  // of a logpoint

  // For front ends with state of their own. The plant was rebuilt; and a millisecond of it has passed, whatever it
  // is run for.
  virtual void built(runtime::Plant& /*plant*/) {}
  virtual void passed(runtime::Time /*now*/) {}
  virtual void executes(uint32_t /*station*/, uint32_t /*address*/) {}  // the command there is next
  // What Debugger::perform() was given, now and whenever its moment comes again.
  virtual void perform(const Json& /*action*/) {}
  virtual bool wants_snapshot() { return true; }  // one is due
  // Wants executes() also for what is run again.
  virtual bool follows_commands() { return false; }
  // What came later than now, with so many changes of the user, does not come any more.
  virtual void dropped(size_t /*changes*/) {}
};

struct Frame {
  int context = 0;
  uint32_t address = 0;
  std::string function;  // or the name of the interrupt
  SourcePlace place;
};

class Debugger final : private runtime::CommandRunner {
 public:
  // With snapshots steps back are fast, but run() may go on in another process. `limit` ends the run.
  Debugger(Debuggee what, FrontEnd& front_end, std::unique_ptr<Snapshots> snapshots, runtime::Time limit);
  // Looks at a plant that somebody else runs, between two of its milliseconds: it shows, and refuses (ValueError) whatever
  // would run, stop or change it. look() notes the moment.
  Debugger(runtime::Plant& running, FrontEnd& front_end);
  bool only_looks() const { return !what_.make; }
  void look();

  // Carries out an order. Fill the frame of a step with order_for().
  Stop run(const Order& order);
  Order order_for(Motion motion, TaskRef task, bool backward = false) const;
  // To the end of the millisecond of that time, back or on within what was reached; the plant stands there. What the user
  // did later is kept. Where the front end does not keep going it ends with Pause on the way, and the next visit goes on.
  Stop visit(runtime::Time time);
  // On to a moment from which a search has gone back; what the user did stays.
  Stop return_to(const Position& moment);
  // The latest moment of this run. Who runs on from an earlier one, or changes something there, drops what came later.
  const Position& furthest() const { return furthest_; }
  // From the beginning up to here, without copies: for a copy of the process that gathers what was not gathered before.
  void run_again();
  // The plant is as at power-on: what was done to the other one is done to this at the same moments.
  void will_do_as(const Debugger& other) { changes_ = other.changes_; }
  const Debuggee& debuggee() const { return what_; }
  // From the beginning, as if the user had done this, up to that moment.
  Stop resume(std::vector<Change> changes, const Position& moment);
  // The plant as at power-on. What the user has done is forgotten, breakpoints stay. With a plant that was built anew that
  // one begins; when it cannot be made the old one does, and the reason is thrown on.
  void restart(std::optional<Debuggee> next = {});
  // A station has another program by now: its lines are looked at anew.
  void program_changed(uint32_t station);

  const Position& position() const { return position_; }
  runtime::Plant& plant() { return *plant_; }
  const runtime::Plant& plant() const { return *plant_; }
  const CodeMap* code(uint32_t station) const { return codes_[station] ? &*codes_[station] : nullptr; }

  // All tasks of all stations that are not stopped, then those that are if `all`.
  std::vector<TaskRef> tasks(bool all = false) const;
  std::string task_name(TaskRef task) const;
  std::string task_state(TaskRef task) const;     // "ready", "waits 20 ms"
  std::vector<Frame> frames(TaskRef task) const;  // the innermost first
  const vm::Machine* machine(uint32_t station) const { return plant_->stations()[station]->machine(); }

  // As the user may change them at any stop.
  std::vector<Breakpoint>& breakpoints() { return breakpoints_; }
  std::vector<Watchpoint>& watchpoints() { return watchpoints_; }
  int next_id() { return ++last_id_; }

  // Written now, and again whenever this moment comes again; what was written later is gone. Throws
  // ValueError.
  void write(const ValuePlace& place, int32_t value);
  // The same for what only the front end knows how to do. What it throws is thrown on, and nothing was done.
  void perform(const Json& action);
  // The task executes that command next, in place of the one it stands at; done again as what is written. Throws ValueError
  // where the task does not run or waits inside a command.
  void go_on_at(TaskRef task, uint32_t address);
  // What was done so far, in the order of time, and what is done again when time comes there.
  const std::vector<Change>& changes() const { return changes_; }

  // "{speed} rpm" with the values of what is in braces.
  std::string with_values(uint32_t station, const std::string& text) const;

  const Snapshots* snapshots() const { return snapshots_.get(); }

 private:
  bool run(runtime::Station& station, vm::Machine& machine, vm::TickSteps& steps) override;
  void build();
  Stop go();
  bool advance();
  bool between();  // two milliseconds
  bool arrived(Phase phase);
  bool before_command(TaskRef task, const vm::Machine& machine);
  bool behind_command(TaskRef task, const vm::Machine& machine, bool faulted);
  std::optional<Stop> stop_at_breakpoint(TaskRef task, const vm::Machine& machine, bool backward);
  std::optional<Stop> step_ends(TaskRef task, const vm::Machine& machine) const;
  std::optional<Stop> task_ended() const;
  std::optional<Stop> data_changed(bool backward);
  bool holds(Breakpoint& breakpoint, bool backward);
  void set_next(TaskRef task, uint32_t address);
  bool take(Stop stop);
  void candidate(const Position& at, Stop stop);
  void rewind(const Position& to, bool strictly);
  void search_further();
  uint64_t commands_to_look_at() const;
  void drop_later();
  bool snapshot_is_due() const;
  bool snapshot();
  void prime();
  std::string save();
  void load(const std::string& bytes);

  Debuggee what_;
  FrontEnd& front_end_;
  runtime::Time limit_;
  struct Release {  // of the plant, where it is not another one's
    bool owned = true;
    void operator()(runtime::Plant* plant) const {
      if (owned) delete plant;
    }
  };
  void refuse_to_act() const;
  std::unique_ptr<runtime::Plant, Release> plant_;
  std::unique_ptr<Companion> companion_;  // of this plant
  std::vector<std::optional<CodeMap>> codes_;
  std::vector<vm::Machine*> machines_;  // of the stations, once they have executed commands
  std::unique_ptr<Snapshots> snapshots_;  // none: it runs again from the beginning
  bool resumes_ = false;
  bool takes_snapshots_ = true;
  size_t told_failures_ = 0;  // of machines

  std::vector<Breakpoint> breakpoints_;
  std::vector<Watchpoint> watchpoints_;
  std::vector<Change> changes_;
  int last_id_ = 0;

  Position position_;
  Position furthest_;
  Position last_;                     // where it was before
  runtime::Station* open_ = nullptr;  // in the middle of its tick
  Goal goal_;
  Position start_;          // where the goal was set
  Position searched_from_;  // Search
  Stop stop_;
  size_t next_change_ = 0;
  std::vector<int32_t> watched_;  // last values, as watchpoints_
  bool told_all_ended_ = false;
  Position last_snapshot_;
};

// Whether a point stops at so many hits: "N" is from that one on, "% N" each Nth, else a comparison. Throws ValueError.
bool hits_hold(const runtime::Plant& plant, uint32_t station, const std::string& condition, uint64_t hits);

}  // namespace ipos::tools::debug

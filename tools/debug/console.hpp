// The debugger on a terminal or a script, in gdb's words. execute() takes a line and what it answers goes to
// `print`; reading lines is the caller's.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/debug/frame_points.hpp"
#include "tools/debugger/debugger.hpp"

namespace ipos::tools::debug {

class Console final : public FrontEnd {
 public:
  using Print = std::function<void(const std::string&)>;
  explicit Console(Print print) : print_(std::move(print)) {}
  // Before anything else; a debugger needs its front end, too.
  void attach(Debugger& debugger);

  // What another process must know of the input; and whether to go on.
  std::function<Json()> save_input = [] { return Json(); };
  std::function<void(const Json&)> load_input = [](const Json&) {};
  std::function<bool()> not_interrupted = [] { return true; };

  // False: the session is over.
  bool execute(const std::string& line);
  // Words a line that ends so can go on with.
  std::vector<std::string> complete(std::string_view line) const;

  Json save() override;
  void load(const Json& state) override;
  bool keep_going() override { return !frames_.has_seen() && not_interrupted(); }
  void built(runtime::Plant& plant) override { frames_.built(plant); }
  void output(const std::string& text) override { print_(text); }

 private:
  struct Command;
  static const std::vector<Command>& commands();
  static const Command* find(std::string_view word);

  void go(Motion motion, bool backward, const std::string& count);
  void run(const Order& order);
  void carry_on(Stop stop);
  void show_stop(const Stop& stop);
  void show_place();
  void show_journal();

  void breakpoint(const std::string& arguments, bool temporary);
  void logpoint(const std::string& arguments);
  void watch(const std::string& arguments);
  void catch_frame(const std::string& arguments);
  void who(const std::string& arguments);
  bool answer_who(const Stop& stop);
  std::string change_text(const Stop& stop) const;
  void display(const std::string& arguments);
  void undisplay(const std::string& arguments);
  void show_displays();
  void condition(const std::string& arguments);
  void hits(const std::string& arguments);
  void remove(const std::string& arguments);
  void enable(const std::string& arguments, bool on);
  void until(const std::string& arguments);
  void backtrace();
  void list(const std::string& arguments);
  void print(const std::string& arguments);
  void examine(const std::string& arguments);
  void set(const std::string& arguments);
  void disassemble(const std::string& arguments);
  void info(const std::string& arguments);
  void info_tasks();
  void info_sbus();
  void info_breakpoints();
  void info_io();
  void info_snapshots();
  void info_cost();
  void select_task(const std::string& arguments);
  void help();

  struct Location {
    uint32_t station;
    uint32_t address;
  };
  Location locate(std::string text) const;
  std::string describe(uint32_t station, uint32_t address) const;
  std::string source_line(const std::string& file, uint32_t line);
  uint32_t station_named(std::string_view name) const;  // throws ValueError
  TaskRef task_with_frames() const;

  // Commands that each task has executed at a stop.
  struct Spent {
    runtime::Time time = 0;
    std::vector<std::pair<TaskRef, uint64_t>> tasks;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Spent, time, tasks)
  };
  Spent spent() const;

  Debugger* debugger_ = nullptr;
  Print print_;
  TaskRef current_;
  bool over_ = false;
  std::string last_line_;  // an empty line repeats it
  Motion motion_ = Motion::Continue;
  int more_ = 0;         // steps of that kind to go
  uint32_t listed_ = 0;  // line after the last one listed
  size_t told_ = 0;      // entries of the journal
  std::map<std::string, std::vector<std::string>> sources_;
  FramePoints frames_;
  std::vector<std::pair<int, std::string>> displays_;  // number; arguments of print
  int last_display_ = 0;
  Spent spent_[2];       // at the stop before, and at this one
  Json asks_ = nullptr;  // `who` is looking back: what it found, and what it will put back
};

}  // namespace ipos::tools::debug

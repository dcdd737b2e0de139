// The debugger on a terminal or a script, in gdb's words. execute() takes a line and what it answers goes to
// `print`; reading lines is the caller's.
#pragma once

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/debug/frame_points.hpp"
#include "tools/debugger/cost.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/debugger/last_writer.hpp"

namespace ipos::tools::debug {

class Console final : public FrontEnd {
 public:
  using Print = std::function<void(const std::string&)>;
  explicit Console(Print print) : print_(std::move(print)) {}
  // Before anything else; a debugger needs its front end, too.
  void attach(Debugger& debugger);

  // The same, of a debugger that only looks at a run of that file: what its user is told first.
  void begin_to_look(const std::string& file);

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

  void carry_out(const std::string& text);
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
  void display(const std::string& arguments);
  void undisplay(const std::string& arguments);
  void show_displays();
  int last_point() const;
  int point_number(std::string_view word) const;  // "$": the last one; throws ValueError
  void commands_of(const std::string& arguments);
  void collect(const std::string& line);
  void note_commands(const Stop& stop);
  void save_points(const std::string& arguments);
  void source(const std::string& arguments);
  std::string place_words(uint32_t station, uint32_t address) const;
  std::string value_words(const ValuePlace& place) const;
  void condition(const std::string& arguments);
  void hits(const std::string& arguments);
  void remove(const std::string& arguments);
  void enable(const std::string& arguments, bool on);
  void until(const std::string& arguments);
  void jump_to(const std::string& arguments);
  void backtrace();
  void list(const std::string& arguments);
  void print(const std::string& arguments);
  void print_whole(const Whole& whole, const std::string& text, bool hex);
  void examine(const std::string& arguments);
  void set(const std::string& arguments);
  void disassemble(const std::string& arguments);
  void info(const std::string& arguments);
  void info_tasks();
  void info_sbus();
  void info_breakpoints();
  void info_io();
  void info_snapshots();
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
  Cost cost_;
  LastWriter who_;
  std::map<int, std::vector<std::string>> commands_;  // of the points; what is done at their stops
  int collecting_ = 0;                                // the point whose words are being told
  std::deque<std::string> at_stop_, sourced_;         // still to do: of the last stop, and of a file
};

}  // namespace ipos::tools::debug

// The debug adapter: messages in, messages out. Knows nothing of streams, so tests talk to it directly.
// Tasks are threads; time stands still for the whole plant when one of them stops.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/debug/frame_points.hpp"
#include "tools/debugger/cost.hpp"
#include "tools/debugger/debugger.hpp"
#include "tools/debugger/last_writer.hpp"

namespace ipos::tools::debug {

inline constexpr int kFramesOfTask = 64;  // frame = thread x this + number

// What the editor wants to debug.
struct DapLaunch {
  std::string file;
  std::string unit;
  std::string test_case;  // of a test that has several
};

// The run that it wants to look at; none: the only one.
struct DapAttach {
  std::optional<int64_t> process;
};

class DapServer final : public FrontEnd {
 public:
  using Make = std::function<Debuggee(const DapLaunch&)>;  // may throw
  using Send = std::function<void(const Json&)>;
  DapServer(Make make, Send send, std::unique_ptr<Snapshots> snapshots)
      : make_(std::move(make)), send_(std::move(send)), snapshots_(std::move(snapshots)) {}

  // Looks at a run that somebody else goes on with, for an editor that attaches to it.
  DapServer(runtime::Plant& running, std::string file, Send send) : send_(std::move(send)), looks_at_(std::move(file)) {
    debugger_.emplace(running, *this);
  }
  // What the editor sees of a run that goes on is asked for once more.
  void show_again();

  // Finds the run that an editor wants to attach to; a Failure where there is none. What came from the editor is for that
  // run from then on (attached()).
  std::function<void(const DapAttach&)> attach_to = [](const DapAttach&) { throw ValueError("this adapter attaches to nothing"); };
  bool attached() const { return attached_; }
  const std::deque<Json>& for_the_run() const { return queue_; }  // the two requests of its begin first

  // Asked for messages while the plant runs; and what another process must know of the input.
  std::function<void()> poll = [] {};
  std::function<Json()> save_input = [] { return Json::object(); };
  std::function<void(const Json&)> load_input = [](const Json&) {};

  // Takes the body of a message; handle_next() answers it. Pauses and the end act while the plant runs.
  void receive(std::string_view body);
  // False when there was nothing to do.
  bool handle_next();
  // Nothing more will come. What has come is answered, but a plant runs no further.
  void close() { closed_ = true; }
  bool ended() const { return ended_; }

  Json save() override;
  void load(const Json& state) override;
  bool keep_going() override;
  void output(const std::string& text) override;
  void built(runtime::Plant& plant) override { frames_.built(plant); }

 private:
  using Handler = Json (DapServer::*)(const Json& arguments);
  bool only_looks() const { return debugger_ && debugger_->only_looks(); }
  Json look_instead(const std::string& command, const Json& arguments);
  void tell_looks(const std::string& command);
  struct Request;
  static const std::vector<Request>& requests();

  Json initialize(const Json& arguments);
  Json launch(const Json& arguments);
  Json attach(const Json& arguments);
  Json configured(const Json& arguments);
  Json set_breakpoints(const Json& arguments);
  Json set_instruction_breakpoints(const Json& arguments);
  Json data_breakpoint_info(const Json& arguments);
  Json who(const Json& arguments);
  Json set_data_breakpoints(const Json& arguments);
  Json set_exception_breakpoints(const Json& arguments);
  Json set_function_breakpoints(const Json& arguments);
  Json completions(const Json& arguments);
  Json restart(const Json& arguments);
  Json threads(const Json& arguments);
  Json stack_trace(const Json& arguments);
  Json source(const Json& arguments);
  Json scopes(const Json& arguments);
  Json variables(const Json& arguments);
  Json set_variable(const Json& arguments);
  Json set_expression(const Json& arguments);
  Json evaluate_text(const Json& arguments);
  Json disassemble(const Json& arguments);
  Json breakpoint_locations(const Json& arguments);
  Json exception_info(const Json& arguments);
  Json read_memory(const Json& arguments);
  Json goto_targets(const Json& arguments);
  Json go_to(const Json& arguments);
  Json loaded_sources(const Json& arguments);
  Json resume(const Json& arguments);
  Json next(const Json& arguments);
  Json step_in(const Json& arguments);
  Json step_out(const Json& arguments);
  Json step_back(const Json& arguments);
  Json reverse_continue(const Json& arguments);
  Json pause(const Json& arguments);
  Json terminate(const Json& arguments);
  Json disconnect(const Json& arguments);

  void answer(const Json& message);
  void go();
  bool stop_is_asked() const;
  void carry_on(Stop stop);
  void report(const Stop& stop);
  void tell_stop(const std::string& reason, const std::string& text, const std::vector<int>& ids, TaskRef task);
  std::optional<Json> console_word(const std::string& text, const Json& arguments);
  void tell_journal();
  void event(const std::string& name, Json body);
  void order(Motion line, Motion instruction, bool backward, const Json& arguments);
  Debugger& debugger();
  TaskRef task_of(const Json& arguments, const char* key) const;
  Json breakpoint_json(const Breakpoint& breakpoint) const;
  std::optional<ValuePlace> place_of_data(const std::string& id);
  ValuePlace place_asked_for(const Json& arguments);

  // As the editor counts (initialize), and as ipos does: from 1.
  uint32_t line_of_client(const Json& line) const;
  int64_t line_for_client(uint32_t line) const { return int64_t{line} - (lines_from_1_ ? 0 : 1); }
  int64_t column_for_client(uint32_t column) const { return int64_t{column} - (columns_from_1_ ? 0 : 1); }
  std::string path_for_client(const std::string& path) const;
  Json source_for_client(const std::string& file) const;

  // A command by number; below 0 and after the program stands what fills up a view of commands.
  struct CommandPlace {
    uint32_t station;
    int64_t address;
  };
  static std::string command_reference(uint32_t station, int64_t address);
  // Nothing when it is no reference to a station with a program.
  std::optional<CommandPlace> command_of_reference(const std::string& text, int64_t offset);
  uint32_t reference(uint32_t station, int scope, uint32_t first = 0, uint32_t count = 0,
                     std::string name = {});
  Json value_json(const ValuePlace& place, bool hex) const;
  Json scope_values(uint32_t station, int scope, bool hex) const;
  Json named_values(uint32_t station, const std::string& prefix, bool hex);
  Json whole_json(const Whole& whole, bool hex);
  Json set_value(const ValuePlace& place, uint32_t station, const Json& arguments);
  uint32_t station_of_frame(const Json& arguments);

  Make make_;
  Send send_;
  std::unique_ptr<Snapshots> snapshots_;  // of the debugger that is to come
  std::optional<Debugger> debugger_;
  std::deque<Json> queue_;
  int64_t seq_ = 0;
  bool stop_on_entry_ = true;
  std::string looks_at_;       // the file of the run
  bool shows_ = false;         // the editor sees it as stopped
  bool refreshes_ = false;     // and is able to ask again
  bool attached_ = false;
  Json initialize_ = nullptr;  // the request
  std::chrono::steady_clock::time_point began_;  // of the run that is under way
  bool closed_ = false;
  bool ended_ = false;
  bool lines_from_1_ = true, columns_from_1_ = true, uris_ = false;  // of the editor
  size_t told_ = 0;                                          // entries of the journal
  std::optional<Order> order_;                               // given, not yet carried out
  std::map<int, std::pair<std::string, uint32_t>> sources_;  // of source breakpoints: file, line asked for
  std::vector<int> function_points_;                         // breakpoints by the name of a function
  std::vector<int> fault_points_;                            // watchpoints on the faults of drives
  FramePoints frames_;
  Cost cost_;
  LastWriter who_;
  Json later_ = nullptr;      // the response to what LastWriter is asked
  std::optional<TaskRef> later_stop_;  // behind the response: it was set to another statement
  std::map<int64_t, std::pair<uint32_t, uint32_t>> targets_;  // of jumps, until the next stop: station, address
  std::string fault_;  // that stopped the plant, in words; empty: another reason did

  // What the editor may ask for by number until the next stop.
  struct Reference {
    uint32_t station;
    int scope;
    uint32_t first, count;
    std::string name;
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Reference, station, scope, first, count, name)
  };
  std::vector<Reference> references_;
};

}  // namespace ipos::tools::debug

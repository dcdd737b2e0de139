// The words, running, and what is said at a stop.
#include "tools/debug/console.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "tools/cli/failure.hpp"

namespace ipos::tools::debug {

struct Console::Command {
  std::string_view name, alias, arguments, meaning;
  void (*run)(Console&, const std::string&);
  bool looks = false;  // works at a run that is only looked at, too
};

const std::vector<Console::Command>& Console::commands() {
  using C = Console;
  using S = std::string;
  static const std::vector<Command> kCommands = {
      {"break", "b", "LINE|FILE:LINE|FUNCTION|*ADDRESS [if EXPR]", "stop there; UNIT@... at another station",
       [](C& c, const S& a) { c.breakpoint(a, false); }},
      {"tbreak", "tb", "as break", "stop there once", [](C& c, const S& a) { c.breakpoint(a, true); }},
      {"dprintf", "", "PLACE,TEXT", "print TEXT there, {EXPR} with values, and go on",
       [](C& c, const S& a) { c.logpoint(a); }},
      {"watch", "", "VALUE [if EXPR]", "stop behind changes of a variable, parameter, input or output",
       [](C& c, const S& a) { c.watch(a); }},
      {"who", "", "VALUE", "who changed it last, where and when", [](C& c, const S& a) { c.who(a); }},
      {"catch", "", "FRAME", "stop behind the millisecond in which such a frame or telegram came: 40A#80*, sbus1 40A#*",
       [](C& c, const S& a) { c.catch_frame(a); }},
      {"commands", "", "[N]", "words that are carried out at each stop of a breakpoint, line by line until 'end'",
       [](C& c, const S& a) { c.commands_of(a); }},
      {"condition", "", "N [EXPR]", "change the condition of a breakpoint; $ for N: the last one",
       [](C& c, const S& a) { c.condition(a); }},
      {"hits", "", "N [COUNT|>= N|% N]", "stop only at such hits", [](C& c, const S& a) { c.hits(a); }},
      {"delete", "d", "[N...]", "remove breakpoints, all or some", [](C& c, const S& a) { c.remove(a); }},
      {"enable", "", "[N...]", "", [](C& c, const S& a) { c.enable(a, true); }},
      {"disable", "", "[N...]", "", [](C& c, const S& a) { c.enable(a, false); }},
      {"continue", "c", "", "run on", [](C& c, const S& a) { c.go(Motion::Continue, false, a); }},
      {"step", "s", "[N]", "to the next line, into functions",
       [](C& c, const S& a) { c.go(Motion::Into, false, a); }},
      {"next", "n", "[N]", "to the next line, over functions",
       [](C& c, const S& a) { c.go(Motion::Over, false, a); }},
      {"stepi", "si", "[N]", "one command of the task",
       [](C& c, const S& a) { c.go(Motion::Instruction, false, a); }},
      {"nexti", "ni", "[N]", "one command, over calls",
       [](C& c, const S& a) { c.go(Motion::InstructionOver, false, a); }},
      {"finish", "", "", "to the end of the function", [](C& c, const S& a) { c.go(Motion::Out, false, a); }},
      {"until", "u", "LINE|PLACE|TIME", "to a place, or a time such as 1.5s",
       [](C& c, const S& a) { c.until(a); }},
      {"jump", "j", "LINE|PLACE", "set the next statement of the task, in its function; nothing in between is done",
       [](C& c, const S& a) { c.jump_to(a); }},
      {"reverse-continue", "rc", "", "back to the last stop",
       [](C& c, const S& a) { c.go(Motion::Continue, true, a); }},
      {"reverse-step", "rs", "[N]", "back to the line before, into functions",
       [](C& c, const S& a) { c.go(Motion::Into, true, a); }},
      {"reverse-next", "rn", "[N]", "back to the line before, over functions",
       [](C& c, const S& a) { c.go(Motion::Over, true, a); }},
      {"reverse-stepi", "rsi", "[N]", "one command back",
       [](C& c, const S& a) { c.go(Motion::Instruction, true, a); }},
      {"reverse-finish", "", "", "back to the call of the function",
       [](C& c, const S& a) { c.go(Motion::Out, true, a); }},
      {"backtrace", "bt", "", "the calls", [](C& c, const S&) { c.backtrace(); }, true},
      {"list", "l", "[LINE]", "source lines", [](C& c, const S& a) { c.list(a); }, true},
      {"print", "p", "[/x] EXPR", "a value, a structure, an array", [](C& c, const S& a) { c.print(a); }, true},
      {"display", "", "[[/x] EXPR]", "print it at each stop; without an expression: now", [](C& c, const S& a) { c.display(a); }, true},
      {"undisplay", "", "[N...]", "", [](C& c, const S& a) { c.undisplay(a); }, true},
      {"x", "", "[/N[i|x|d]] VARIABLE|ADDRESS", "variables in a row, or commands",
       [](C& c, const S& a) { c.examine(a); }, true},
      {"set", "", "VALUE = EXPR", "write a variable, parameter or input", [](C& c, const S& a) { c.set(a); }},
      {"disassemble", "disas", "[FUNCTION|ADDRESS]", "the commands around",
       [](C& c, const S& a) { c.disassemble(a); }, true},
      {"info", "i", "tasks|sbus|breakpoints|io|cost|snapshots", "", [](C& c, const S& a) { c.info(a); }, true},
      {"save", "", "FILE", "write the breakpoints, their words and the displays as words", [](C& c, const S& a) { c.save_points(a); }},
      {"source", "", "FILE", "carry out the words of a file", [](C& c, const S& a) { c.source(a); }},
      {"task", "", "[UNIT] N", "look at another task", [](C& c, const S& a) { c.select_task(a); }, true},
      {"help", "h", "", "", [](C& c, const S&) { c.help(); }, true},
      {"quit", "q", "", "", [](C& c, const S&) { c.over_ = true; }, true},
  };
  return kCommands;
}

// By name, alias, or the beginning of only one name.
const Console::Command* Console::find(std::string_view word) {
  for (const Command& command : commands())
    if (command.name == word || (!command.alias.empty() && command.alias == word)) return &command;
  const Command* found = nullptr;
  for (const Command& command : commands()) {
    if (!command.name.starts_with(word)) continue;
    if (found != nullptr) throw ValueError(fmt::format("'{}' is {} or {}", word, found->name, command.name));
    found = &command;
  }
  return found;
}

void Console::attach(Debugger& debugger) {
  debugger_ = &debugger;
  const std::vector<TaskRef> tasks = debugger.tasks();
  if (!tasks.empty()) current_ = tasks.front();
  cost_.begin(debugger);
}

void Console::begin_to_look(const std::string& file) {
  print_(fmt::format("looks at the run of {}, which goes on; help lists the words\n", file));
  show_place();
}

bool Console::execute(const std::string& line) {
  const size_t begin = line.find_first_not_of(" \t\r");
  std::string text = begin == std::string::npos ? std::string() : line.substr(begin, line.find_last_not_of(" \t\r") + 1 - begin);
  if (collecting_ == 0 && !text.starts_with('#')) {
    if (text.empty()) text = last_line_;
    last_line_ = text;
  }
  carry_out(text);
  // Another process may have gone on meanwhile: only members are used.
  for (bool more = true; more && !over_;) {
    std::deque<std::string>& lines = at_stop_.empty() ? sourced_ : at_stop_;
    more = !lines.empty();
    if (!more) break;
    const std::string next = std::move(lines.front());
    lines.pop_front();
    carry_out(next);
    if (not_interrupted()) continue;
    at_stop_.clear();
    sourced_.clear();
  }
  return !over_;
}

void Console::carry_out(const std::string& text) {
  if (collecting_ != 0) return collect(text);
  if (text.empty() || text.starts_with('#')) return;
  const size_t end = std::min(text.find_first_of(" \t/"), text.size());
  const std::string word = text.substr(0, end);
  std::string arguments = text.substr(end);
  arguments.erase(0, arguments.find_first_not_of(" \t"));
  try {
    const Command* command = find(word);
    if (command == nullptr) throw ValueError(fmt::format("'{}' is no command; see help", word));
    if (debugger_->only_looks() && !command->looks)
      throw ValueError(fmt::format("the run is only looked at: '{}' would run, stop or change it", command->name));
    command->run(*this, arguments);
  } catch (const ValueError& error) {
    print_(fmt::format("{}\n", error.what()));
  } catch (const Failure& failure) {  // of files
    print_(fmt::format("{}\n", failure.what()));
  }
}

void Console::go(Motion motion, bool backward, const std::string& count) {
  int times = 1;
  if (!count.empty() &&
      (std::from_chars(count.data(), count.data() + count.size(), times).ec != std::errc() || times < 1))
    throw ValueError(fmt::format("'{}' is no count", count));
  if (motion != Motion::Continue && current_.task == 0) throw ValueError("no task runs");
  if (motion == Motion::Out && !backward && debugger_->order_for(motion, current_).depth == 0 &&
      debugger_->order_for(motion, current_).context <= vm::kTasks)
    throw ValueError("finish leaves a function that was called; main() is none");
  if (backward && times != 1) throw ValueError("one step back at a time");
  more_ = times - 1;
  run(debugger_->order_for(motion, current_, backward));
}

void Console::run(const Order& order) {
  motion_ = order.motion;
  frames_.listen(!order.backward);
  carry_on(debugger_->run(order));
}

// After Debugger::run and return_to another process may go on, behind the call of one of them that it was copied in, and knows
// nothing of locals: only members are used.
void Console::carry_on(Stop stop) {
  for (;;) {
    if (who_.asks()) {
      if (const auto answer = who_.answer(*debugger_, stop)) return print_(*answer + "\n");
      stop = debugger_->return_to(who_.from());
    } else if (more_ > 0 && stop.reason == Reason::Step) {
      --more_;
      frames_.listen(true);
      stop = debugger_->run(debugger_->order_for(motion_, current_));
    } else {
      more_ = 0;
      return show_stop(stop);
    }
  }
}

void Console::show_journal() {
  const auto& entries = debugger_->plant().journal().entries();
  for (; told_ < entries.size(); ++told_)
    if (entries[told_].weight != runtime::Weight::Why)
      print_(fmt::format("{:.3f} ms {}: {}\n", static_cast<double>(entries[told_].time) / 1e6,
                         entries[told_].station.empty() ? "plant" : entries[told_].station,
                         entries[told_].text));
}

void Console::show_stop(const Stop& stop) {
  cost_.stopped(*debugger_);
  note_commands(stop);
  show_journal();
  if (stop.task.task != 0 && stop.task != current_) {
    current_ = stop.task;
    print_(fmt::format("[now {}]\n", debugger_->task_name(current_)));
  }
  listed_ = 0;
  std::string ids;
  for (const int id : stop.ids) ids += fmt::format("{}{}", ids.empty() ? "" : ", ", id);
  switch (stop.reason) {
    case Reason::Breakpoint: print_(fmt::format("Breakpoint {}\n", ids)); break;
    case Reason::Data: print_(fmt::format("Watchpoint {}: {}\n", ids, stop.text)); break;
    case Reason::Pause:
      print_(frames_.has_seen() ? fmt::format("Breakpoint {}: {}\n", frames_.id(), frames_.text()) : "Interrupted\n");
      break;
    case Reason::Entry:
    case Reason::Step: break;
    case Reason::Fault:
    case Reason::TaskEnded:
    case Reason::AllEnded:
    case Reason::Limit:
    case Reason::Beginning: print_(stop.text + "\n"); break;
  }
  show_place();
  show_displays();
}

TaskRef Console::task_with_frames() const {
  if (current_.task == 0) throw ValueError("the plant has no program");
  return current_;
}

void Console::show_place() {
  const Position& at = debugger_->position();
  std::string when = fmt::format("{:.3f} ms", static_cast<double>(at.time) / 1e6);
  if (!debugger_->only_looks()) when += fmt::format(", {} commands", at.commands);
  if (current_.task == 0) return print_(fmt::format("at {}\n", when));
  const std::vector<Frame> frames = debugger_->frames(current_);
  if (frames.empty())
    return print_(fmt::format("{} is stopped at {}\n", debugger_->task_name(current_), when));
  const Frame& frame = frames.front();
  print_(fmt::format("{}, {} at {} ({})\n", debugger_->task_name(current_),
                     frame.function.empty() ? fmt::format("word {}", frame.address) : frame.function,
                     frame.place.line == 0 ? fmt::format("word {}", frame.address) : frame.place.text(),
                     when));
  const bool line = debugger_->code(current_.station)->starts_line(frame.address);
  const std::string source = source_line(frame.place.file, frame.place.line);
  if (frame.place.line != 0 && !source.empty()) print_(fmt::format("{}\t{}\n", frame.place.line, source));
  if (!line || source.empty())
    print_(fmt::format("=> {}\t{}\n", frame.address, debugger_->code(current_.station)->text(frame.address)));
}

std::vector<std::string> Console::complete(std::string_view line) const {
  std::vector<std::string> words;
  const size_t begin = line.find_last_of(" \t(=,") + 1;
  const std::string_view part = line.substr(begin);
  const auto offer = [&](std::string_view word) {
    if (word.starts_with(part) && std::find(words.begin(), words.end(), word) == words.end())
      words.emplace_back(word);
  };
  if (begin == 0) {
    for (const Command& command : commands()) offer(command.name);
    return words;
  }
  for (const char* word : {"tasks", "sbus", "breakpoints", "io", "cost", "snapshots"})
    if (line.starts_with("i")) offer(word);
  for (const auto& station : debugger_->plant().stations()) {
    if (station->image() == nullptr) continue;
    for (const vm::Symbol& symbol : station->image()->symbols) offer(symbol.name);
    for (const vm::FunctionEntry& function : station->image()->functions) offer(function.name);
  }
  return words;
}

Json Console::save() {
  return {{"task", current_},          {"last", last_line_},     {"told", told_},           {"input", save_input()},
          {"frames", frames_.save()}, {"displays", displays_}, {"display", last_display_},
          {"who", who_.save()},        {"cost", cost_.save()}, {"commands", commands_}, {"sourced", sourced_}};
}

void Console::load(const Json& state) {
  current_ = state["task"].get<TaskRef>();
  last_line_ = state["last"].get<std::string>();
  more_ = 0;
  told_ = state["told"];
  frames_.load(state["frames"]);
  displays_ = state["displays"].get<std::vector<std::pair<int, std::string>>>();
  last_display_ = state["display"];
  who_.load(state["who"]);
  cost_.load(state["cost"]);
  commands_ = state["commands"].get<std::map<int, std::vector<std::string>>>();
  collecting_ = 0;
  at_stop_.clear();
  sourced_ = state["sourced"].get<std::deque<std::string>>();
  load_input(state["input"]);
}

void Console::help() {
  for (const Command& command : commands())
    if (command.looks || !debugger_->only_looks())
      print_(fmt::format("{:<24}{:<44} {}\n",
                       fmt::format("{}{}{}", command.name, command.alias.empty() ? "" : ", ", command.alias),
                       command.arguments, command.meaning));
}

}  // namespace ipos::tools::debug

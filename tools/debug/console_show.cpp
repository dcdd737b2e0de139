// What the console shows of a plant that stands still.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "tools/cli/text_lines.hpp"
#include "tools/debug/console.hpp"
#include "tools/input/sources.hpp"

namespace ipos::tools::debug {
std::string Console::source_line(const std::string& file, uint32_t line) {
  auto [entry, is_new] = sources_.try_emplace(file);
  if (is_new) entry->second = text_lines(source_text(file).value_or(""));
  return line == 0 || line > entry->second.size() ? std::string() : entry->second[line - 1];
}

void Console::backtrace() {
  const std::vector<Frame> frames = debugger_->frames(task_with_frames());
  if (frames.empty()) print_("the task is stopped\n");
  for (size_t n = 0; n < frames.size(); ++n)
    print_(fmt::format("#{} {} at {}, word {}\n", n, frames[n].function.empty() ? "?" : frames[n].function,
                       frames[n].place.line == 0 ? "?" : frames[n].place.text(), frames[n].address));
}

void Console::list(const std::string& arguments) {
  const std::vector<Frame> frames = debugger_->frames(task_with_frames());
  SourcePlace place = frames.empty() ? debugger_->code(current_.station)->place(0) : frames.front().place;
  constexpr uint32_t kLines = 10;
  uint32_t from = listed_ != 0 ? listed_ : place.line > kLines / 2 ? place.line - kLines / 2 : 1;
  if (!arguments.empty()) {
    uint32_t line = 0;
    if (std::from_chars(arguments.data(), arguments.data() + arguments.size(), line).ec == std::errc() &&
        line != 0) {
      from = line > kLines / 2 ? line - kLines / 2 : 1;
    } else {
      const Location at = locate(arguments);
      const SourcePlace there = debugger_->code(at.station)->place(at.address);
      place.file = there.file;
      from = there.line > kLines / 2 ? there.line - kLines / 2 : 1;
    }
  }
  source_line(place.file, 1);
  const size_t count = sources_[place.file].size();
  if (count == 0) throw ValueError(fmt::format("the source {} is not at hand", place.file));
  if (source_has_changed(place.file))
    print_(fmt::format("{} has changed since it was compiled; this is the text that runs\n", place.file));
  listed_ = from;
  for (; listed_ < from + kLines && listed_ <= count; ++listed_)
    print_(fmt::format("{}{}\t{}\n", listed_ == place.line ? ">" : " ", listed_,
                       source_line(place.file, listed_)));
}

void Console::print(const std::string& arguments) {
  const bool hex = arguments.starts_with("/x");
  std::string text = arguments.substr(arguments.starts_with('/') ? std::min<size_t>(2, arguments.size()) : 0);
  text.erase(0, text.find_first_not_of(' '));
  const runtime::Plant& plant = debugger_->plant();
  if (const auto whole = find_whole(plant, current_.station, text)) return print_whole(*whole, text, hex);
  if (!hex)
    if (const auto place = find_value(plant, current_.station, text))
      return print_(fmt::format("{} = {}\n", text, value_text(*place)));
  print_(fmt::format("{} = {}\n", text, number_text(evaluate(plant, current_.station, text), hex)));
}

// A structure is shown member by member, an array element by element; the station stands in front where it was named.
void Console::print_whole(const Whole& whole, const std::string& text, bool hex) {
  const runtime::Station& station = *debugger_->plant().stations()[whole.station];
  const std::string prefix = text.substr(0, text.size() - whole.name.size());
  for (size_t n = 0; n < whole.variables.size();) {
    const std::string& symbol = whole.variables[n].symbol;
    const size_t first = n;
    std::string values;
    for (; n < whole.variables.size() && whole.variables[n].symbol == symbol; ++n)
      values += (n == first ? "" : ", ") + number_text(station.variable(whole.variables[n].number), hex);
    print_(fmt::format("{}{} = {}\n", prefix, symbol, n == first + 1 ? values : "{" + values + "}"));
  }
}

// What cannot be shown where the plant stands, say a name of another station, is told and stays.
void Console::show_displays() {
  for (const auto& [number, text] : displays_) {
    print_(fmt::format("{}: ", number));
    try {
      print(text);
    } catch (const ValueError& error) {
      print_(fmt::format("{}\n", error.what()));
    }
  }
}

void Console::display(const std::string& arguments) {
  if (arguments.empty()) return show_displays();
  print(arguments);
  displays_.emplace_back(++last_display_, arguments);
}

void Console::undisplay(const std::string& arguments) {
  if (arguments.empty()) return displays_.clear();
  std::istringstream in(arguments);
  for (std::string word; in >> word;)
    if (std::erase_if(displays_, [&word](const auto& one) { return std::to_string(one.first) == word; }) == 0)
      throw ValueError(fmt::format("there is no display {}", word));
}

// "x/8 H420", "x/4i 12".
void Console::examine(const std::string& arguments) {
  uint32_t count = 1;
  std::string what = arguments;
  char form = 'd';
  if (what.starts_with('/')) {
    const size_t end = std::min(what.find(' '), what.size());
    const auto [rest, status] = std::from_chars(what.data() + 1, what.data() + end, count);
    if (rest != what.data() + end) form = *rest;
    what.erase(0, end);
    what.erase(0, what.find_first_not_of(' '));
  }
  count = std::min(count, 1024U);
  if (form == 'i') {
    const CodeMap* code = debugger_->code(current_.station);
    if (code == nullptr) throw ValueError("the station has no program");
    size_t item = code->item_at(static_cast<uint32_t>(evaluate(debugger_->plant(), current_.station, what)));
    for (; count != 0 && item < code->items().size(); --count, ++item)
      print_(
          fmt::format("{:>6}  {}\n", code->items()[item].address, code->text(code->items()[item].address)));
    return;
  }
  uint32_t in = current_.station, number = 0;
  if (const auto whole = find_whole(debugger_->plant(), current_.station, what)) {
    in = whole->station;
    number = whole->variables.front().number;
  } else {
    const ValuePlace place = evaluate_place(debugger_->plant(), current_.station, what, true);
    if (!place.signal->is_variable()) throw ValueError("x shows variables; see print");
    in = place.station;
    number = place.signal->number;
  }
  const auto& station = *debugger_->plant().stations()[in];
  for (; count != 0 && number < station.config().unit->variables; --count, ++number)
    print_(fmt::format("H{:<5} {}\n", number, number_text(station.variable(number), form == 'x')));
}

void Console::set(const std::string& arguments) {
  const size_t at = arguments.find('=');
  if (at == std::string::npos) throw ValueError("set needs VALUE = EXPR");
  const ValuePlace place = evaluate_place(
      debugger_->plant(), current_.station,
      arguments.substr(arguments.starts_with("var ") ? 4 : 0, arguments.starts_with("var ") ? at - 4 : at));
  debugger_->write(place,
                   evaluate_for(debugger_->plant(), current_.station, place, arguments.substr(at + 1)));
}

void Console::disassemble(const std::string& arguments) {
  const CodeMap* code = debugger_->code(task_with_frames().station);
  const std::vector<Frame> frames = debugger_->frames(current_);
  const uint32_t pc = frames.empty() ? 0 : frames.front().address;
  uint32_t around = pc;
  if (const auto function = code->function_address(arguments))
    around = *function;
  else if (!arguments.empty())
    around = static_cast<uint32_t>(evaluate(debugger_->plant(), current_.station, arguments));
  const std::string_view function = code->function(around);
  uint32_t line = 0;
  for (const compiler::CodeItem& item : code->items()) {
    if (code->function(item.address) != function) continue;
    const SourcePlace place = code->place(item.address);
    if (place.line != line) print_(fmt::format("{}\t{}\n", place.line, source_line(place.file, place.line)));
    line = place.line;
    print_(fmt::format("{} {:>5}  {}\n", item.address == pc ? "=>" : "  ", item.address,
                       code->text(item.address)));
  }
}

void Console::info(const std::string& arguments) {
  const auto is = [&](std::string_view word) { return !arguments.empty() && word.starts_with(arguments); };
  if (is("tasks") || is("threads")) return info_tasks();
  if (is("breakpoints")) return info_breakpoints();
  if (is("sbus") && arguments != "s") return info_sbus();
  if (is("snapshots") && arguments != "s") return info_snapshots();
  if (is("io")) return info_io();
  if (is("cost") && debugger_->only_looks()) throw ValueError("a cost is that from one stop to the next, and the run is only looked at");
  if (is("cost")) return print_(cost_.text(*debugger_));
  throw ValueError("info knows tasks, breakpoints, sbus, io, cost and snapshots");
}

void Console::info_tasks() {
  for (const TaskRef task : debugger_->tasks(true)) {
    const std::vector<Frame> frames = debugger_->frames(task);
    print_(fmt::format("{} {:<20} {:<24} {}\n", task == current_ ? "*" : " ", debugger_->task_name(task),
                       debugger_->task_state(task),
                       frames.empty() ? "" : frames.front().function + " " + frames.front().place.text()));
  }
}

void Console::info_sbus() {
  static constexpr const char* kKinds[] = {"?", "cyclic", "acyclic", "receive"};
  for (const auto& station : debugger_->plant().stations())
    for (const int number : {1, 2}) {
      const runtime::SbusPort* port = station->sbus(number);
      if (port == nullptr) continue;
      print_(fmt::format("{} SBus {} on {}: {}\n", station->config().name, number, port->line().name(),
                         port->objects().started() ? "objects run" : "objects stand"));
      for (const runtime::ObjectDefinition& object : port->objects().definitions())
        print_(fmt::format(
            "  {:<8} object {:<11} data H{}{}{}\n", kKinds[static_cast<size_t>(object.kind)],
            runtime::object_words(object.object), object.data,
            object.cycle == 0 ? "" : fmt::format(", every {} ms from {} ms", object.cycle, object.offset),
            object.accepted ? "" : ": refused, " + object.why));
    }
}

void Console::info_io() {
  const auto words = [](const runtime::DriveWords& w) {
    return fmt::format("{:04X} {:04X} {:04X}", w[0], w[1], w[2]);
  };
  for (const auto& station : debugger_->plant().stations()) {
    const runtime::Drive& drive = station->drive().state();
    print_(fmt::format("{}: inputs {:016b}, outputs {:016b}, PO {}, PI {}, status {:04X}\n",
                       station->config().name, station->inputs().levels(), drive.outputs(), words(drive.po()),
                       words(drive.pi()), drive.status_word_1()));
  }
}

void Console::info_snapshots() {
  const Snapshots* snapshots = debugger_->snapshots();
  const Snapshots::Memory memory = snapshots == nullptr ? Snapshots::Memory{} : snapshots->memory();
  print_(fmt::format("{} snapshots, {:.1f} MiB together, of it {:.1f} MiB not shared\n",
                     snapshots == nullptr ? 0 : snapshots->count(), static_cast<double>(memory.shared_out) / 1024,
                     static_cast<double>(memory.own) / 1024));
}

void Console::select_task(const std::string& arguments) {
  if (!arguments.empty()) {
    const size_t space = arguments.rfind(' ');
    TaskRef task = current_;
    if (space != std::string::npos) task.station = station_named(arguments.substr(0, space));
    const std::string number = arguments.substr(space == std::string::npos ? 0 : space + 1);
    if (number.size() != 1 || number[0] < '1' || number[0] > '3' || debugger_->code(task.station) == nullptr)
      throw ValueError("task needs 1, 2 or 3 of a station with a program");
    task.task = number[0] - '0';
    current_ = task;
  }
  show_place();
}

}  // namespace ipos::tools::debug

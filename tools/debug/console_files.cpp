// Words of the console that are kept: at a breakpoint, and in files.
#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/text_lines.hpp"
#include "tools/debug/console.hpp"

namespace ipos::tools::debug {

// Without a number of the last one that was made.
void Console::commands_of(const std::string& arguments) {
  collecting_ = point_number(arguments.empty() ? "$" : std::string_view(arguments));
  commands_[collecting_].clear();
  print_(fmt::format("words for each stop of {}, line by line until 'end'\n", collecting_));
}

void Console::collect(const std::string& line) {
  std::vector<std::string>& words = commands_[collecting_];
  if (line != "end") return words.push_back(line);
  if (words.empty()) commands_.erase(collecting_);
  collecting_ = 0;
}

// What was left of the stop before belongs to it.
void Console::note_commands(const Stop& stop) {
  at_stop_.clear();
  std::vector<int> ids = stop.ids;
  if (stop.reason == Reason::Pause && frames_.has_seen()) ids.push_back(frames_.id());
  for (const int id : ids)
    if (const auto found = commands_.find(id); found != commands_.end())
      at_stop_.insert(at_stop_.end(), found->second.begin(), found->second.end());
}

// As locate() finds it again, also in a program that was changed meanwhile: by a name or a line where that tells it.
std::string Console::place_words(uint32_t station, uint32_t address) const {
  const CodeMap& code = *debugger_->code(station);
  const std::string unit = debugger_->plant().stations()[station]->config().name + "@";
  const std::string function(code.function(address));
  if (!function.empty() && code.function_address(function) == address) return unit + function;
  const SourcePlace place = code.place(address);
  if (place.line != 0 && code.address_of(place.file, place.line) == address) return fmt::format("{}{}:{}", unit, place.file, place.line);
  return fmt::format("{}*{}", unit, address);
}

// With its station, where that is a name.
std::string Console::value_words(const ValuePlace& place) const {
  if (debugger_->plant().stations().size() == 1) return place.name;
  const std::string whole = debugger_->plant().stations()[place.station]->config().name + "." + place.name;
  return find_value(debugger_->plant(), place.station, whole) ? whole : place.name;
}

void Console::save_points(const std::string& arguments) {
  if (arguments.empty()) throw ValueError("save needs the name of a file");
  std::string text = "# Words of ipos debug: source FILE carries them out.\n";
  const auto rest = [&](const auto& point) {
    if (!point.hit_condition.empty()) text += fmt::format("hits $ {}\n", point.hit_condition);
    if (!point.enabled) text += "disable $\n";
    const auto found = commands_.find(point.id);
    if (found == commands_.end()) return;
    text += "commands\n";
    for (const std::string& line : found->second) text += line + "\n";
    text += "end\n";
  };
  const auto condition = [](const std::string& of) { return of.empty() ? of : " if " + of; };
  for (const Breakpoint& point : debugger_->breakpoints()) {
    const std::string place = place_words(point.station, point.address);
    if (point.log.empty())
      text += fmt::format("{} {}{}\n", point.temporary ? "tbreak" : "break", place, condition(point.condition));
    else
      text += fmt::format("dprintf {},{}\n", place, point.log);
    if (!point.log.empty() && !point.condition.empty()) text += fmt::format("condition $ {}\n", point.condition);
    rest(point);
  }
  for (const Watchpoint& point : debugger_->watchpoints()) {
    text += fmt::format("watch {}{}\n", value_words(point.place), condition(point.condition));
    rest(point);
  }
  for (const FramePoint& point : frames_.all()) {
    text += fmt::format("catch {}{}\n", point.pattern, condition(point.condition));
    rest(point);
  }
  for (const auto& [number, shown] : displays_) text += fmt::format("display {}\n", shown);
  replace_file(arguments, text);
}

void Console::source(const std::string& arguments) {
  if (arguments.empty()) throw ValueError("source needs the name of a file");
  if (!sourced_.empty()) throw ValueError("the words of a file ask for no other file");
  for (std::string& line : text_lines(read_file(arguments))) {
    line.erase(0, line.find_first_not_of(" \t"));
    line.erase(line.find_last_not_of(" \t\r") + 1);
    if (!line.empty()) sourced_.push_back(std::move(line));
  }
}

}  // namespace ipos::tools::debug

// Places, breakpoints and watchpoints of the console.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "tools/debug/console.hpp"

namespace ipos::tools::debug {
namespace {

std::optional<uint32_t> number_of(std::string_view text) {
  uint32_t value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// "PLACE if EXPR" in two.
std::pair<std::string, std::string> split_condition(const std::string& text) {
  const size_t at = text.find(" if ");
  if (at == std::string::npos) return {text, ""};
  return {text.substr(0, at), text.substr(at + 4)};
}

}  // namespace

uint32_t Console::station_named(std::string_view name) const {
  const auto& stations = debugger_->plant().stations();
  for (uint32_t n = 0; n < stations.size(); ++n)
    if (stations[n]->config().name == name) return n;
  throw ValueError(fmt::format("there is no station '{}'", name));
}

// A file or function of one station only is found in any of them, the current one first.
Console::Location Console::locate(std::string text) const {
  std::vector<uint32_t> candidates{current_.station};
  if (const size_t at = text.find('@'); at != std::string::npos) {
    candidates = {station_named(text.substr(0, at))};
    text.erase(0, at + 1);
  } else {
    for (uint32_t n = 0; n < debugger_->plant().stations().size(); ++n)
      if (n != current_.station) candidates.push_back(n);
  }
  const size_t colon = text.rfind(':');
  for (const uint32_t station : candidates) {
    const CodeMap* code = debugger_->code(station);
    if (code == nullptr) continue;
    if (text.starts_with('*')) {
      const auto address = number_of(text.substr(1));
      if (!address || !code->is_command(*address))
        throw ValueError(fmt::format("no command begins at '{}'", text));
      return {station, *address};
    }
    std::optional<uint32_t> address;
    if (colon != std::string::npos) {
      if (const auto line = number_of(text.substr(colon + 1)))
        address = code->address_of(text.substr(0, colon), *line);
    } else if (const auto line = number_of(text)) {
      const std::vector<Frame> frames = debugger_->frames({station, std::max(1, current_.task)});
      const std::string file = frames.empty() ? code->place(0).file : frames.front().place.file;
      address = code->address_of(file.empty() ? code->place(0).file : file, *line);
    } else {
      address = code->function_address(text);
    }
    if (address) return {station, *address};
  }
  throw ValueError(fmt::format("no command belongs to '{}'", text));
}

std::string Console::describe(uint32_t station, uint32_t address) const {
  const CodeMap& code = *debugger_->code(station);
  return fmt::format("{}, {} {}, word {}", debugger_->plant().stations()[station]->config().name,
                     code.function(address), code.place(address).text(), address);
}

void Console::breakpoint(const std::string& arguments, bool temporary) {
  const auto [where, condition] = split_condition(arguments);
  if (where.empty()) throw ValueError("break needs a place");
  const Location at = locate(where);
  Breakpoint made{debugger_->next_id(), at.station, at.address, condition, "", "", temporary, true, 0};
  if (!condition.empty()) evaluate(debugger_->plant(), at.station, condition);
  print_(fmt::format("Breakpoint {}: {}\n", made.id, describe(at.station, at.address)));
  debugger_->breakpoints().push_back(std::move(made));
}

void Console::logpoint(const std::string& arguments) {
  const size_t comma = arguments.find(',');
  if (comma == std::string::npos) throw ValueError("dprintf needs PLACE,TEXT");
  const Location at = locate(arguments.substr(0, comma));
  debugger_->breakpoints().push_back(
      {debugger_->next_id(), at.station, at.address, "", "", arguments.substr(comma + 1), false, true, 0});
  print_(
      fmt::format("Logpoint {}: {}\n", debugger_->breakpoints().back().id, describe(at.station, at.address)));
}

void Console::watch(const std::string& arguments) {
  const auto [what, condition] = split_condition(arguments);
  const ValuePlace place = evaluate_place(debugger_->plant(), current_.station, what);
  if (!condition.empty()) evaluate(debugger_->plant(), place.station, condition);
  debugger_->watchpoints().push_back({debugger_->next_id(), place.station, place, condition, true, 0});
  print_(fmt::format("Watchpoint {}: {} = {}\n", debugger_->watchpoints().back().id, place.name,
                     value_text(place)));
}

void Console::catch_frame(const std::string& arguments) {
  if (!FramePoints::is_frame(debugger_->plant(), arguments))
    throw ValueError(fmt::format("'{}' is no frame such as 40A#80*, sbus1 40A#* or 02 01 *", arguments));
  frames_.add(debugger_->next_id(), arguments);
  print_(fmt::format("Breakpoint {}: frame {}\n", frames_.all().back().first, arguments));
}

// Goes back to the last change as `rc` does with a watchpoint, and returns (answer_who).
void Console::who(const std::string& arguments) {
  const ValuePlace place = evaluate_place(debugger_->plant(), current_.station, arguments);
  asks_ = {{"name", place.name},
           {"value", value_text(place)},
           {"from", debugger_->position()},
           {"breakpoints", debugger_->breakpoints()},
           {"watchpoints", debugger_->watchpoints()}};
  debugger_->breakpoints().clear();
  debugger_->watchpoints() = {{0, place.station, place, "", true, 0}};
  more_ = 0;
  run(debugger_->order_for(Motion::Continue, current_, true));
}

// Behind the way back, and behind the way forth. True: it was the latter.
bool Console::answer_who(const Stop& stop) {
  if (!asks_.contains("found")) {
    asks_["found"] = stop.reason == Reason::Data ? change_text(stop)
                                                 : fmt::format("nobody has changed {} = {} so far\n", asks_["name"].get<std::string>(),
                                                               asks_["value"].get<std::string>());
    return false;
  }
  debugger_->breakpoints() = asks_["breakpoints"].get<std::vector<Breakpoint>>();
  debugger_->watchpoints() = asks_["watchpoints"].get<std::vector<Watchpoint>>();
  print_(asks_["found"].get<std::string>());
  asks_ = nullptr;
  return true;
}

// At the stop in front of it.
std::string Console::change_text(const Stop& stop) const {
  const Position& at = debugger_->position();
  std::string by = "no command: a telegram, the unit, a stimulus or 'set'";
  if (stop.task.task != 0) {
    by = debugger_->task_name(stop.task);
    const std::vector<Frame> frames = debugger_->frames(stop.task);
    if (!frames.empty())
      by += fmt::format(", {} at {}", frames.front().function,
                        frames.front().place.line == 0 ? fmt::format("word {}", frames.front().address) : frames.front().place.text());
  }
  return fmt::format("{} by {} ({:.3f} ms, {} commands)\n", stop.text, by, static_cast<double>(at.time) / 1e6, at.commands);
}

void Console::condition(const std::string& arguments) {
  std::istringstream in(arguments);
  int id = 0;
  in >> id >> std::ws;
  std::string text;
  std::getline(in, text);
  const auto change = [&](auto& points) {
    for (auto& point : points)
      if (point.id == id) return point.condition = text, true;
    return false;
  };
  if (!change(debugger_->breakpoints()) && !change(debugger_->watchpoints()))
    throw ValueError(fmt::format("there is no breakpoint {}", id));
}

void Console::hits(const std::string& arguments) {
  std::istringstream in(arguments);
  int id = 0;
  in >> id >> std::ws;
  std::string text;
  std::getline(in, text);
  const auto change = [&](auto& points) {
    for (auto& point : points)
      if (point.id == id) return point.hit_condition = text, true;
    return false;
  };
  if (!change(debugger_->breakpoints()) && !change(debugger_->watchpoints()))
    throw ValueError(fmt::format("there is no breakpoint {}", id));
}

void Console::remove(const std::string& arguments) {
  if (arguments.empty()) {
    debugger_->breakpoints().clear();
    debugger_->watchpoints().clear();
    frames_.clear();
    return;
  }
  std::istringstream in(arguments);
  for (int id = 0; in >> id;) {
    const auto same = [id](const auto& point) { return point.id == id; };
    if (std::erase_if(debugger_->breakpoints(), same) + std::erase_if(debugger_->watchpoints(), same) == 0 && !frames_.remove(id))
      throw ValueError(fmt::format("there is no breakpoint {}", id));
  }
}

void Console::enable(const std::string& arguments, bool on) {
  std::istringstream in(arguments);
  std::vector<int> ids;
  for (std::string word; in >> word;) {
    const auto id = number_of(word);
    const auto same = [&id](const auto& point) { return id && point.id == static_cast<int>(*id); };
    const auto& breakpoints = debugger_->breakpoints();
    const auto& watchpoints = debugger_->watchpoints();
    if (std::none_of(breakpoints.begin(), breakpoints.end(), same) &&
        std::none_of(watchpoints.begin(), watchpoints.end(), same))
      throw ValueError(fmt::format("there is no breakpoint {}", word));
    ids.push_back(static_cast<int>(*id));
  }
  const auto change = [&](auto& points) {
    for (auto& point : points)
      if (ids.empty() || std::find(ids.begin(), ids.end(), point.id) != ids.end()) point.enabled = on;
  };
  change(debugger_->breakpoints());
  change(debugger_->watchpoints());
}

// A time is one that ends in a unit; all else is a place.
void Console::until(const std::string& arguments) {
  const runtime::Time time = runtime::parse_duration(arguments);
  Order order = debugger_->order_for(time >= 0 ? Motion::ToTime : Motion::ToAddress, current_);
  if (time >= 0) {
    if (time <= debugger_->plant().now())
      throw ValueError(fmt::format("it is {:.3f} ms already; see reverse-continue",
                                   static_cast<double>(debugger_->plant().now()) / 1e6));
    order.time = time;
  } else {
    const Location at = locate(arguments);
    if (at.station != current_.station) throw ValueError("that is in another station: see task");
    order.address = at.address;
  }
  run(order);
}

void Console::info_breakpoints() {
  for (const Breakpoint& point : debugger_->breakpoints())
    print_(fmt::format("{:<3} {}{}{}{}, {} hits{}\n", point.id, describe(point.station, point.address),
                       point.condition.empty() ? "" : " if " + point.condition,
                       point.hit_condition.empty() ? "" : " at hits " + point.hit_condition,
                       point.log.empty() ? "" : " prints " + point.log, point.hits,
                       point.enabled ? "" : ", disabled"));
  for (const Watchpoint& point : debugger_->watchpoints())
    print_(fmt::format("{:<3} watch {}{}{}, {} hits{}\n", point.id, point.place.name,
                       point.condition.empty() ? "" : " if " + point.condition,
                       point.hit_condition.empty() ? "" : " at hits " + point.hit_condition, point.hits,
                       point.enabled ? "" : ", disabled"));
  for (const auto& [id, pattern] : frames_.all()) print_(fmt::format("{:<3} frame {}\n", id, pattern));
}

}  // namespace ipos::tools::debug

// Places, breakpoints and watchpoints of the console.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "tools/debug/console.hpp"
#include "tools/debug/jump.hpp"

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
  const auto [pattern, condition] = split_condition(arguments);
  if (!FramePoints::is_frame(debugger_->plant(), pattern))
    throw ValueError(fmt::format("'{}' is no frame such as 40A#80*, sbus1 40A#* or 02 01 *", pattern));
  if (!condition.empty()) evaluate(debugger_->plant(), 0, condition);
  frames_.add({debugger_->next_id(), pattern, condition});
  print_(fmt::format("Breakpoint {}: frame {}\n", frames_.all().back().id, pattern));
}

void Console::who(const std::string& arguments) {
  const ValuePlace place = evaluate_place(debugger_->plant(), current_.station, arguments);
  more_ = 0;
  run(who_.ask(*debugger_, current_, place));
}

int Console::last_point() const {
  int last = 0;
  for (const Breakpoint& point : debugger_->breakpoints()) last = std::max(last, point.id);
  for (const Watchpoint& point : debugger_->watchpoints()) last = std::max(last, point.id);
  for (const FramePoint& point : frames_.all()) last = std::max(last, point.id);
  return last;
}

int Console::point_number(std::string_view word) const {
  const int last = last_point();
  const auto number = word == "$" ? std::optional(static_cast<uint32_t>(last)) : number_of(word);
  const auto same = [&number](const auto& point) { return number && point.id == static_cast<int>(*number); };
  const auto has = [&same](const auto& points) { return std::any_of(points.begin(), points.end(), same); };
  if (!has(debugger_->breakpoints()) && !has(debugger_->watchpoints()) && !has(frames_.all()))
    throw ValueError(fmt::format("there is no breakpoint {}", word));
  return static_cast<int>(*number);
}

namespace {

// "N TEXT" in two.
std::pair<std::string, std::string> split_number(const std::string& arguments) {
  std::istringstream in(arguments);
  std::string word, text;
  in >> word >> std::ws;
  std::getline(in, text);
  return {word, text};
}

template <class Points>
auto* point_of(Points& points, int id) {
  const auto found = std::find_if(points.begin(), points.end(), [id](const auto& point) { return point.id == id; });
  return found == points.end() ? nullptr : &*found;
}

}  // namespace

void Console::condition(const std::string& arguments) {
  const auto [word, text] = split_number(arguments);
  const int id = point_number(word);
  if (Breakpoint* point = point_of(debugger_->breakpoints(), id)) point->condition = text;
  if (Watchpoint* point = point_of(debugger_->watchpoints(), id)) point->condition = text;
  if (FramePoint* point = point_of(frames_.all(), id)) point->condition = text;
}

void Console::hits(const std::string& arguments) {
  const auto [word, text] = split_number(arguments);
  const int id = point_number(word);
  if (Breakpoint* point = point_of(debugger_->breakpoints(), id)) point->hit_condition = text;
  if (Watchpoint* point = point_of(debugger_->watchpoints(), id)) point->hit_condition = text;
  if (FramePoint* point = point_of(frames_.all(), id)) point->hit_condition = text;
}

void Console::remove(const std::string& arguments) {
  if (arguments.empty()) {
    debugger_->breakpoints().clear();
    debugger_->watchpoints().clear();
    frames_.clear();
    commands_.clear();
    return;
  }
  std::istringstream in(arguments);
  for (int id = 0; in >> id;) {
    const auto same = [id](const auto& point) { return point.id == id; };
    if (std::erase_if(debugger_->breakpoints(), same) + std::erase_if(debugger_->watchpoints(), same) == 0 && !frames_.remove(id))
      throw ValueError(fmt::format("there is no breakpoint {}", id));
    commands_.erase(id);
  }
}

void Console::enable(const std::string& arguments, bool on) {
  std::istringstream in(arguments);
  std::vector<int> ids;
  for (std::string word; in >> word;) ids.push_back(point_number(word));
  const auto change = [&](auto& points) {
    for (auto& point : points)
      if (ids.empty() || std::find(ids.begin(), ids.end(), point.id) != ids.end()) point.enabled = on;
  };
  change(debugger_->breakpoints());
  change(debugger_->watchpoints());
  change(frames_.all());
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

// A line is a statement of the function in which the task stands, also where the function is there several times.
void Console::jump_to(const std::string& arguments) {
  Location at = locate(arguments);
  if (at.station != current_.station) throw ValueError("that is in another station: see task");
  const CodeMap& code = *debugger_->code(at.station);
  const std::vector<Frame> frames = debugger_->frames(task_with_frames());
  const SourcePlace place = code.place(at.address);
  if (place.line != 0 && !frames.empty() && !arguments.starts_with('*'))
    for (const uint32_t address : statements_at(*debugger_, at.station, place.file, place.line))
      if (code.function(address) == code.function(frames.front().address)) at.address = address;
  jump(*debugger_, current_, at.address);
  listed_ = 0;
  show_place();
}

void Console::info_breakpoints() {
  const auto line = [this](const auto& point, const std::string& what, const std::string& log) {
    print_(fmt::format("{:<3} {}{}{}{}, {} hits{}\n", point.id, what, point.condition.empty() ? "" : " if " + point.condition,
                       point.hit_condition.empty() ? "" : " at hits " + point.hit_condition, log, point.hits,
                       point.enabled ? "" : ", disabled"));
    if (const auto found = commands_.find(point.id); found != commands_.end())
      for (const std::string& text : found->second) print_(fmt::format("      {}\n", text));
  };
  for (const Breakpoint& point : debugger_->breakpoints())
    line(point, describe(point.station, point.address), point.log.empty() ? "" : " prints " + point.log);
  for (const Watchpoint& point : debugger_->watchpoints()) line(point, "watch " + point.place.name, "");
  for (const FramePoint& point : frames_.all()) line(point, "frame " + point.pattern, "");
}

}  // namespace ipos::tools::debug

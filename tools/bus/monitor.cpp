// The lines of the monitor and its totals.
#include "tools/bus/monitor.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "compiler/diag/places.hpp"
#include "runtime/bus/movilink/describe_serial.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr size_t kNamedUnknown = 10;  // identifiers named at the end (ours)
constexpr size_t kUnknown = 10'000;   // and counted (ours): noise may make them all up

// "(0946684800.000102)", the form of candump logs.
std::string stamp(Time time) {
  const std::string line = runtime::candump_line(time, "-", {});
  return line.substr(0, line.find(' '));
}

}  // namespace

void Monitor::take(const runtime::LogEntry& entry) {
  ++seen_;
  // A node is known by what was said before, so its words go on behind what is not shown.
  const runtime::Description description = can_.words.describe(entry.bus, entry.frame);
  if (!can_.filter.passes(entry.frame) || full()) return;
  ++shown_;
  if (!description.known && unknown_.size() < kUnknown)
    unknown_.emplace(entry.frame.extended, entry.frame.id);
  show(entry.time, entry.bus, description.text);
}

void Monitor::take(Time time, const std::string& line, const runtime::Reception& reception) {
  if (const auto text = words(reception)) show(time, line, *text);
}

void Monitor::take(const runtime::SerialEntry& entry) {
  const auto text = words(entry.reception);
  if (!text) return;
  if (entry.time) return show(*entry.time, entry.line, *text);
  begin_line();
  fmt::print("{}\n", *text);
}

std::optional<std::string> Monitor::words(const runtime::Reception& reception) {
  ++seen_;
  if (!reception.telegram) ++void_;
  // What was no telegram concerns everybody.
  if ((reception.telegram && !serial_.filter.passes(*reception.telegram)) || full()) return std::nullopt;
  ++shown_;
  return runtime::describe(serial_.names, reception);
}

void Monitor::lost(Time time, const std::string& line, uint64_t count, const char* what) {
  lost_ += count;
  if (losing_ != nullptr) {
    lost_more_ += count;
    return;
  }
  show(time, line, fmt::format("--- {} {} lost", count, what));
  losing_ = what;
}

void Monitor::bus_error(Time time, const std::string& line, const std::string& text) {
  ++errors_;
  if (text == last_error_) {
    ++repeated_;
    return;
  }
  show(time, line, "--- bus error: " + text);
  last_error_ = text;
}

void Monitor::note(const std::string& text) const { fmt::print(stderr, "ipos: warning: {}\n", text); }

void Monitor::show(Time time, const std::string& line, const std::string& text) {
  begin_line();
  fmt::print("{} {} {}\n", stamp(time), compiler::printable(line), text);
}

void Monitor::begin_line() {
  end_repetition();
  last_error_.clear();
}

void Monitor::end_repetition() {
  if (repeated_ != 0) fmt::print("--- the same error {} more times\n", repeated_);
  repeated_ = 0;
  if (lost_more_ != 0) fmt::print("--- {} more {} lost\n", lost_more_, losing_);
  lost_more_ = 0;
  losing_ = nullptr;
}

void Monitor::flush() { std::fflush(stdout); }

void Monitor::finish() {
  end_repetition();
  flush();
  std::string text = fmt::format("ipos: {} telegrams, {} shown", seen_, shown_);
  const auto add = [&text](uint64_t count, const char* what) {
    if (count != 0) text += fmt::format(", {} {}", count, what);
  };
  add(void_, "void");
  add(lost_, "lost");
  add(errors_, "bus errors");
  fmt::print(stderr, "{}\n", text);
  if (unknown_.empty()) return;
  std::string list;
  size_t n = 0;
  for (const auto& [extended, id] : unknown_) {
    if (n++ == kNamedUnknown) break;
    list += fmt::format("{}{}{}", list.empty() ? "" : ", ", id, extended ? " (29 bits)" : "");
  }
  fmt::print(stderr, "ipos: nothing is known about {}{} identifiers: {}{}\n",
             unknown_.size() < kUnknown ? "" : "at least ", unknown_.size(), list,
             unknown_.size() > kNamedUnknown ? ", ..." : "");
}

}  // namespace ipos::tools

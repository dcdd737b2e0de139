// The lines of the monitor and its totals.
#include "tools/bus/monitor.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "compiler/diag/places.hpp"
#include "runtime/bus/can/identifier_text.hpp"

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
  // A node is known by what was said before, so its words go on after what is not shown.
  const runtime::Description description = words_.describe(entry.bus, entry.frame);
  if (!filters_.can.passes(entry.frame) || full()) return;
  ++shown_;
  if (!description.known && unknown_.size() < kUnknown)
    unknown_.emplace(entry.frame.extended, entry.frame.id);
  if (!screen_) return show(entry.time, entry.bus, description.text);
  const runtime::Frame& frame = entry.frame;
  const std::string id = runtime::id_text(frame.id, frame.extended);
  // The words begin with the identifier, which the row has already.
  screen_->table().put(entry.time, entry.bus, frame.id, id,
                       std::span(frame.data).first(frame.remote ? 0 : frame.length),
                       description.text.substr(id.size() + 1));
}

void Monitor::take(Time time, const std::string& line, const runtime::Reception& reception) {
  if (const auto text = words(reception)) show(time, line, reception, *text);
}

void Monitor::take(const runtime::SerialEntry& entry) {
  const auto text = words(entry.reception);
  if (!text) return;
  if (entry.time || screen_) return show(entry.time.value_or(0), entry.line, entry.reception, *text);
  begin_line();
  fmt::print("{}\n", *text);
}

void Monitor::take(const runtime::ProfibusEntry& entry) {
  take(entry.reception.start, entry.line, entry.reception);
}

void Monitor::take(Time time, const std::string& line, const profibus::Reception& reception) {
  ++seen_;
  if (full()) return;
  ++shown_;
  const auto& frame = reception.frame;
  if (!frame) ++void_;
  const std::string text = words_.describe(line, reception);
  if (!screen_) return show(time, line, text);
  // A row for each pair of stations.
  const uint32_t pair = frame ? uint32_t{frame->source} << 8 | frame->destination : UINT32_MAX;
  screen_->table().put(time, line, pair,
                       frame ? fmt::format("{} -> {}", frame->source, frame->destination) : "void",
                       reception.octets, text);
}

void Monitor::show(Time time, const std::string& line, const runtime::Reception& reception,
                   const std::string& text) {
  if (!screen_) return show(time, line, text);
  // A row for the requests to each address, and one for its answers.
  std::string id = "void";
  uint32_t number = UINT32_MAX;
  if (const auto& telegram = reception.telegram) {
    id = fmt::format("{} {}", telegram->response ? "<-" : "->", telegram->address);
    number = telegram->address;
  }
  screen_->table().put(time, line, number, id, reception.bytes.span(), text);
}

std::optional<std::string> Monitor::words(const runtime::Reception& reception) {
  ++seen_;
  if (!reception.telegram) ++void_;
  // What was no telegram concerns everybody.
  if ((reception.telegram && !filters_.serial.passes(*reception.telegram)) || full()) return std::nullopt;
  ++shown_;
  return words_.describe(reception);
}

void Monitor::lost(Time time, const std::string& line, uint64_t count, const char* what) {
  lost_ += count;
  if (screen_) return screen_->table().tell(fmt::format("{}: {} {} lost", line, lost_, what));
  if (losing_ != nullptr) {
    lost_more_ += count;
    return;
  }
  show(time, line, fmt::format("--- {} {} lost", count, what));
  losing_ = what;
}

void Monitor::bus_error(Time time, const std::string& line, const std::string& text) {
  ++errors_;
  if (screen_) return screen_->table().tell(fmt::format("{}: bus error {}: {}", line, errors_, text));
  if (text == last_error_) {
    ++repeated_;
    return;
  }
  show(time, line, "--- bus error: " + text);
  last_error_ = text;
}

void Monitor::note(const std::string& text) const {
  if (screen_) return screen_->table().tell(text);
  fmt::print(stderr, "ipos: warning: {}\n", text);
}

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

void Monitor::flush() {
  if (screen_) screen_->look();
  std::fflush(stdout);
}

void Monitor::finish() {
  end_repetition();
  if (screen_) screen_->finish();
  std::fflush(stdout);
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
    list += fmt::format("{}{}", list.empty() ? "" : ", ", runtime::id_words(id, extended));
  }
  fmt::print(stderr, "ipos: nothing is known about {}{} identifiers: {}{}\n",
             unknown_.size() < kUnknown ? "" : "at least ", unknown_.size(), list,
             unknown_.size() > kNamedUnknown ? ", ..." : "");
}

}  // namespace ipos::tools

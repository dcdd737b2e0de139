// Counts and messages.
#include "tools/logs/log_findings.hpp"

#include <fmt/format.h>

#include "compiler/diag/places.hpp"

namespace ipos::tools {

LogReader LogFindings::watch(LogReader reader) {
  const auto knowing = [this](auto take) {
    return [this, take = std::move(take)](const auto& entry, LogPlace place) {
      understand();
      take(entry, place);
    };
  };
  return {knowing(std::move(reader.can)),
          knowing(std::move(reader.serial)),
          knowing(std::move(reader.dp)),
          [this](LogPlace place, const std::string& message) { wrong(place, message); },
          [this](LeftOut what) { leave_out(what); },
          [this](LogPlace place, const std::string& message) {
            print(fmt::format("{}: warning: {}", place_text(path_, place), message));
          }};
}

void LogFindings::wrong(LogPlace place, const std::string& message) {
  ++mistakes_;
  binary_ = place.line == 0;
  if (!binary_) left_out_.add(LeftOut::Line);
  const size_t equal = ++told_[message];
  if (equal > kMostEqual + 1) return;
  const std::string line =
      equal > kMostEqual
          ? fmt::format("{}: note: more mistakes of this kind are only counted", compiler::printable(path_))
          : fmt::format("{}: error: {}", place_text(path_, place), message);
  if (understood_)
    print(line);
  else
    waiting_.push_back(line);
}

void LogFindings::leave_out(LeftOut what) {
  left_out_.add(what);
  // A capture of Ethernet alone is no log of a bus.
  if (what != LeftOut::OtherPacket) understand();
}

void LogFindings::note(const std::string& text) {
  print(fmt::format("{}: note: {}", compiler::printable(path_), text));
}

bool LogFindings::finish() {
  if (understood_ || binary_) {
    print_waiting();
  } else if (mistakes_ != 0) {
    print(waiting_.front() +
          (mistakes_ == 1
               ? ""
               : fmt::format("; none of {} lines is understood: this is no log in a form that ipos reads",
                             mistakes_)));
    return false;
  } else if (left_out_.total() != 0) {
    print(fmt::format("{}: error: no bus is in this capture: {}", compiler::printable(path_),
                      left_out_.text()));
    return false;
  }
  if (left_out_.total() != 0) note(left_out_.text() + " left out");
  return mistakes_ == 0;
}

void LogFindings::understand() {
  understood_ = true;
  print_waiting();
}

void LogFindings::print_waiting() {
  for (const std::string& line : waiting_) print(line);
  waiting_.clear();
}

void LogFindings::print(const std::string& line) const { fmt::print(stderr, "{}\n", line); }

}  // namespace ipos::tools

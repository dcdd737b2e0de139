// What a user has to be told about a run: refused objects, silent stations, faults. The parts of a station
// write here; the command line prints it.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

enum class Weight : uint8_t {
  Why,      // explains what a user may wonder about: shown with --why
  Warning,  // something does not work as the program or the plant seems to want it
  Fault,    // a drive fault
};

struct JournalEntry {
  Time time;
  Weight weight;
  std::string station;  // empty: the plant
  std::string text;
};

class Journal {
 public:
  // Called before a note, so that stations that are behind add their earlier notes first.
  void ask_first(std::function<void()> latecomers) { latecomers_ = std::move(latecomers); }

  // A text that the station has already said is not repeated: a cyclic cause gives one entry.
  void note(Time time, Weight weight, std::string_view station, std::string text) {
    if (has(station, text)) return;
    tell(time, weight, station, std::move(text));
  }
  // What happens once each time it is told, as a hand that switches.
  void tell(Time time, Weight weight, std::string_view station, std::string text) {
    if (latecomers_) latecomers_();
    entries_.push_back({time, weight, std::string(station), std::move(text)});
  }
  // From the journal of a part of the plant. What no station says is said by the plant, once.
  void take(JournalEntry entry) {
    if (entry.station.empty() && has(entry.station, entry.text)) return;
    entries_.push_back(std::move(entry));
  }
  const std::vector<JournalEntry>& entries() const { return entries_; }

 private:
  bool has(std::string_view station, std::string_view text) const {
    for (const JournalEntry& entry : entries_)
      if (entry.station == station && entry.text == text) return true;
    return false;
  }

  std::function<void()> latecomers_;
  std::vector<JournalEntry> entries_;
};

}  // namespace ipos::runtime

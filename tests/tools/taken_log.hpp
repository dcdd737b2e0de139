// A log as its reader gives it, for tests: frames, telegrams, mistakes, what was left out. And numbers as binary logs have them.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/logs/log_forms.hpp"

namespace ipos::tests {

using runtime::Frame;
using runtime::LogEntry;
using runtime::Time;

// Seconds of 1970 and nanoseconds as logs have them here.
inline Time unix_time(int64_t seconds, Time part = 0) {
  return seconds * runtime::kSecond + part - runtime::kCandumpEpoch;
}

struct Taken {
  std::vector<LogEntry> can;
  std::vector<runtime::SerialEntry> serial;
  std::vector<runtime::ProfibusEntry> dp;
  std::vector<std::pair<tools::LogPlace, std::string>> wrong;
  tools::LeftOutCounts left_out;
  std::vector<std::string> notes;
};

inline Taken taken(std::string_view log) {
  Taken all;
  tools::read_log(
      log, {[&](const LogEntry& entry, tools::LogPlace) { all.can.push_back(entry); },
            [&](const runtime::SerialEntry& entry, tools::LogPlace) { all.serial.push_back(entry); },
            [&](const runtime::ProfibusEntry& entry, tools::LogPlace) { all.dp.push_back(entry); },
            [&](tools::LogPlace place, const std::string& text) { all.wrong.emplace_back(place, text); },
            [&](tools::LeftOut what) { all.left_out.add(what); },
            [&](tools::LogPlace, const std::string& text) { all.notes.push_back(text); }});
  return all;
}

// "x:2:7: identifier too large", the first mistake of a log.
inline std::string first_mistake(std::string_view log) {
  const Taken got = taken(log);
  return got.wrong.empty() ? "nothing"
                           : tools::place_text("x", got.wrong[0].first) + ": " + got.wrong[0].second;
}

// Little endian, or big endian.
inline std::string number(uint64_t value, size_t bytes, bool big_endian = false) {
  std::string out;
  for (size_t n = 0; n < bytes; ++n)
    out += static_cast<char>(value >> 8 * (big_endian ? bytes - 1 - n : n) & 0xFF);
  return out;
}

inline std::string blf_object(uint32_t type, const std::string& rest) {
  return "LOBJ" + number(16, 2) + number(1, 2) + number(16 + rest.size(), 4) + number(type, 4) + rest;
}

}  // namespace ipos::tests

// Months by their first letters, the clock by its colons.
#include "tools/logs/asc_date.hpp"

#include <algorithm>
#include <array>
#include <chrono>

#include "runtime/bus/log/candump.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

struct Month {
  std::string_view begin;
  unsigned number;
};
// Their umlauts are letters without here: Mar is March and März, Jan is Jänner, too.
constexpr std::array<Month, 17> kMonths{{{"jan", 1},
                                         {"feb", 2},
                                         {"mar", 3},
                                         {"mrz", 3},
                                         {"mae", 3},
                                         {"apr", 4},
                                         {"may", 5},
                                         {"mai", 5},
                                         {"jun", 6},
                                         {"jul", 7},
                                         {"aug", 8},
                                         {"sep", 9},
                                         {"oct", 10},
                                         {"okt", 10},
                                         {"nov", 11},
                                         {"dec", 12},
                                         {"dez", 12}}};

// In small letters; an umlaut of a in Latin-1 or UTF-8 becomes a.
std::string plain(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte == 0xC3) continue;  // the first byte of a letter in UTF-8
    const bool umlaut = byte == 0xA4 || byte == 0x84 || byte == 0xE4 || byte == 0xC4;
    out += umlaut ? 'a' : c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  return out;
}

std::optional<unsigned> month_of(std::string_view name) {
  const std::string text = plain(name);
  const auto* found = std::find_if(kMonths.begin(), kMonths.end(),
                                   [&](const Month& month) { return text.starts_with(month.begin); });
  return found == kMonths.end() ? std::nullopt : std::optional(found->number);
}

// The text up to a colon, which is taken off, too.
std::optional<int> part_of(std::string_view& clock) {
  const size_t colon = clock.find(':');
  if (colon == std::string_view::npos || colon > 2) return std::nullopt;
  const auto part = whole<int>(clock.substr(0, colon));
  clock.remove_prefix(colon + 1);
  return part;
}

}  // namespace

std::optional<Time> asc_date(Fields fields) {
  fields.next();  // day of the week
  const auto month = month_of(fields.next());
  const auto day = whole<unsigned>(fields.next());
  std::string_view clock = fields.next();
  auto hour = part_of(clock);
  const auto minute = part_of(clock);
  const auto second = decimal_time(clock, 9);
  const std::string half = plain(fields.peek());
  const bool halves = half == "am" || half == "pm";
  if (halves) fields.next();
  const auto year = whole<int>(fields.next());
  if (!month || !day || !hour || !minute || !second || !year) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year}, std::chrono::month{*month},
                                         std::chrono::day{*day}};
  if (*hour < 0 || *hour > 23 || *minute < 0 || *minute > 59 || *second >= 61 * runtime::kSecond ||
      !date.ok() || *year < 1970 || *year > 2150)
    return std::nullopt;
  if (halves) hour = *hour % 12 + (half == "pm" ? 12 : 0);  // 12 am is midnight, 12 pm is noon
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((int64_t{days} * 24 + *hour) * 60 + *minute) * 60 * runtime::kSecond + *second -
         runtime::kCandumpEpoch;
}

}  // namespace ipos::tools

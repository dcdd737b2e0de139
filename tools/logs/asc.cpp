// Vector's text form: "date ...", "base hex  timestamps absolute", then " 0.000100 1  605  Rx  d 8 40 00 ..".
// Lines of other events are passed over, and so is what follows the data (SavvyCAN#422). Times count from the
// date; a date that cannot be read counts as virtual time 0. No time zone is written in it: UTC is taken (ours).
#include <fmt/format.h>

#include <array>
#include <chrono>

#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr std::array<std::string_view, 12> kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                   "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};

// "Sat Jan 01 03:06:13.191 pm 2000", with or without am, pm and the fraction.
std::optional<Time> date_of(Fields fields) {
  fields.next();  // day of the week
  const std::string_view name = fields.next();
  unsigned month = 1;
  while (month <= 12 && kMonths[month - 1] != name) ++month;
  const auto day = whole<unsigned>(fields.next());
  const std::string_view clock = fields.next();
  const std::string_view half = fields.peek() == "am" || fields.peek() == "pm" ? fields.next() : "";
  const auto year = whole<int>(fields.next());
  if (month > 12 || !day || !year || clock.size() < 8 || clock[2] != ':' || clock[5] != ':')
    return std::nullopt;
  auto hour = whole<int>(clock.substr(0, 2));
  const auto minute = whole<int>(clock.substr(3, 2));
  const auto second = decimal_time(clock.substr(6), 9);
  const std::chrono::year_month_day date{std::chrono::year{*year}, std::chrono::month{month},
                                         std::chrono::day{*day}};
  if (!hour || !minute || !second || *hour < 0 || *hour > 23 || *minute < 0 || *minute > 59 || !date.ok() ||
      *year < 1970 || *year > 2150)
    return std::nullopt;
  if (!half.empty()) hour = *hour % 12 + (half == "pm" ? 12 : 0);
  const auto days = std::chrono::sys_days(date).time_since_epoch().count();
  return ((int64_t{days} * 24 + *hour) * 60 + *minute) * 60 * runtime::kSecond + *second -
         runtime::kCandumpEpoch;
}

class AscReader {
 public:
  explicit AscReader(const LogReader& reader) : reader_(reader) {}

  void take(std::string_view row, size_t line) {
    Fields fields(row);
    const std::string_view first = fields.next();
    if (first == "date") {
      if (const auto date = date_of(fields)) date_ = *date;
    } else if (first == "base") {
      base_ = fields.next() == "dec" ? 10 : 16;
      fields.next();
      relative_ = fields.next() == "relative";
    } else if (first[0] >= '0' && first[0] <= '9') {
      if (const auto done = event(Fields(row), line); !done)
        reader_.wrong({line, done.error().column}, done.error().message);
    }
  }

 private:
  tl::expected<void, FieldError> event(Fields fields, size_t line) {
    const auto time = decimal_time(fields.next(), 9);
    if (!time) return fields.wrong("time in seconds expected");
    if (relative_ && *time > kLongestLog - last_) return fields.wrong("a time later than this project knows");
    last_ = relative_ ? last_ + *time : *time;
    const auto channel = whole<unsigned>(fields.next());
    if (!channel) return {};  // another kind of event
    std::string_view id = fields.next();
    const bool extended = id.ends_with('x') || id.ends_with('X');
    if (extended) id.remove_suffix(1);
    if (id.empty()) return fields.wrong("identifier expected");
    if (id.find_first_not_of("0123456789abcdefABCDEF") != std::string_view::npos) return {};  // "ErrorFrame"
    runtime::Frame frame;
    frame.extended = extended;
    const auto number = whole<uint32_t>(id, base_);
    frame.id = number.value_or(UINT32_MAX);
    if (!number || !is_valid(frame)) return fields.wrong("identifier too large");
    if (const std::string_view way = fields.next(); way != "Rx" && way != "Tx" && way != "TxRq")
      return fields.wrong("Rx or Tx expected");
    const std::string_view kind = fields.next();
    frame.remote = kind == "r" || kind == "R";
    if (!frame.remote && kind != "d" && kind != "D") return fields.wrong("d or r expected");
    const std::string_view size = fields.next();
    const auto length = whole<uint8_t>(size, 16);
    if (!length && !(frame.remote && (size.empty() || size == "Length")))
      return fields.wrong("length expected");
    frame.length = length.value_or(0);
    if (frame.length > 8) return fields.wrong("more than 8 data bytes");
    if (!frame.remote)
      if (auto error = read_bytes(fields, base_, frame)) return tl::unexpected(std::move(*error));
    reader_.can({date_ + last_, fmt::format("can{}", *channel), frame}, {line, 1});
    return {};
  }

  const LogReader& reader_;
  Time date_ = 0;
  Time last_ = 0;
  int base_ = 16;
  bool relative_ = false;
};

}  // namespace

void read_asc(std::string_view text, const LogReader& reader) {
  AscReader asc(reader);
  for_each_line(text, [&](std::string_view row, size_t line) { asc.take(row, line); });
}

}  // namespace ipos::tools

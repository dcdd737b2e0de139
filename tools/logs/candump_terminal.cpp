// What candump prints on a terminal, which people save and send: "  can0  203   [8]  31 00 20 7E", with a time of -ta, -tz
// or -tA in front, and with -x a direction after the name. Without times every frame has second 0 of 1970, "no time".
#include <chrono>

#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr size_t kDecimals = 9;

// "2024-03-21" of -tA; UTC is taken (ours).
std::optional<Time> day_of(std::string_view text) {
  if (text.size() != 10 || text[4] != '-' || text[7] != '-') return std::nullopt;
  const auto year = whole<int>(text.substr(0, 4));
  const auto month = whole<unsigned>(text.substr(5, 2)), day = whole<unsigned>(text.substr(8));
  if (!year || !month || !day) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year{*year}, std::chrono::month{*month},
                                         std::chrono::day{*day}};
  if (!date.ok() || *year < 1970 || *year > 2150) return std::nullopt;
  return Time{std::chrono::sys_days(date).time_since_epoch().count()} * 86'400 * runtime::kSecond;
}

// "05:46:40.000000"
std::optional<Time> clock_of(std::string_view text) {
  if (text.size() < 8 || text[2] != ':' || text[5] != ':') return std::nullopt;
  const auto hour = whole<unsigned>(text.substr(0, 2)), minute = whole<unsigned>(text.substr(3, 2));
  const auto second = decimal_time(text.substr(6), kDecimals);
  if (!hour || !minute || !second || *hour > 23 || *minute > 59) return std::nullopt;
  return Time{*hour * 3600 + *minute * 60} * runtime::kSecond + *second;
}

// The brackets of a length: "[8]" of a classic frame, "{D}" with -8, "[08]" of CAN FD.
bool is_length(std::string_view text) {
  return (text.size() == 3 && (text[0] == '[' || text[0] == '{')) || (text.size() == 4 && text[0] == '[');
}

}  // namespace

bool read_terminal_line(std::string_view row, size_t line, const LogReader& reader) {
  Fields fields(row);
  std::string_view word = fields.next();
  std::optional<Time> time = 0;
  if (word.starts_with('(')) {
    word.remove_prefix(1);
    if (word.ends_with(')')) {
      time = decimal_time(word.substr(0, word.size() - 1), kDecimals);
    } else {
      const auto day = day_of(word);
      std::string_view rest = fields.next();
      if (!rest.ends_with(')')) return false;
      rest.remove_suffix(1);
      const auto clock = clock_of(rest);
      time = day && clock ? std::optional(*day + *clock) : std::nullopt;
    }
    word = fields.next();
  }
  const std::string bus(word);
  word = fields.next();
  if (word == "RX" || word == "TX") {
    fields.next();  // B: bit rate switch, E: error state
    fields.next();
    word = fields.next();
  }
  const std::string_view length = fields.next();
  if ((word.size() != 3 && word.size() != 8) || !is_length(length)) return false;
  const auto fail = [&](const FieldError& error) { reader.wrong({line, error.column}, error.message); };
  const auto size = whole<uint8_t>(length.substr(1, length.size() - 2), length[0] == '{' ? 16 : 10);
  if (!size) return false;
  const auto id = whole<uint32_t>(word, 16);
  if (length.size() == 4) return reader.left_out(LeftOut::FdFrame), true;
  runtime::Frame frame;
  frame.extended = word.size() == 8;
  if (frame.extended && id && *id >> 29U == 1) return reader.left_out(LeftOut::ErrorFrame), true;
  frame.id = id.value_or(UINT32_MAX);
  if (!is_valid(frame)) return fail({1, "identifier of 3 or 8 hexadecimal digits expected"}), true;
  if (!time) return fail({1, "time in seconds expected"}), true;
  frame.length = classic_length(*size);
  frame.remote = fields.peek() == "remote";
  if (!frame.remote)
    if (const auto error = read_bytes(fields, 16, frame)) return fail(*error), true;
  reader.can({*time - runtime::kCandumpEpoch, bus, frame}, {line, 1});
  return true;
}

}  // namespace ipos::tools

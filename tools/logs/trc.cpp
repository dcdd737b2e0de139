// PEAK's trace files, versions 1.0 to 2.1. Times are milliseconds from the start of the trace, which is days since 30
// December 1899; a trace without one begins at virtual time 0. Version 2 names its columns: N number, O time, T
// type, B bus, I identifier, d direction, R reserved, L or l length, D data.
#include <fmt/format.h>

#include <cmath>

#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr double kDaysTo1970 = 25'569;
constexpr Time kDay = 86'400 * runtime::kSecond;

std::optional<double> decimal(std::string_view text) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// What the versions before 2 have in place of ;$COLUMNS.
std::string_view columns_of(std::string_view version) {
  if (version == "1.1") return "N,O,d,I,l,D";
  if (version == "1.2") return "N,O,B,d,I,l,D";
  if (version == "1.3") return "N,O,B,d,I,R,l,D";
  return "N,O,I,l,D";
}

// Types of version 2 that are no classic frames: FD with bit rate switch, error state or both; ER error frame; ST, EC, EV status,
// counters and events.
LeftOut what_of(std::string_view type) {
  if (type == "FD" || type == "FB" || type == "FE" || type == "BI") return LeftOut::FdFrame;
  return type == "ER" ? LeftOut::ErrorFrame : LeftOut::Record;
}

class TrcReader {
 public:
  explicit TrcReader(const LogReader& reader) : reader_(reader) {}

  void take(std::string_view row, size_t line) {
    const auto done = row.starts_with(';') ? head(row) : event(Fields(row), line);
    if (!done) reader_.wrong({line, done.error().column}, done.error().message);
  }

 private:
  tl::expected<void, FieldError> head(std::string_view row) {
    const size_t equals = row.find('=');
    if (!row.starts_with(";$") || equals == std::string_view::npos) return {};
    std::string_view value = row.substr(equals + 1);
    value = value.substr(0, value.find_last_not_of(" \t\r") + 1);
    const auto wrong = [&](const char* message) { return tl::unexpected(FieldError{equals + 2, message}); };
    const std::string_view key = row.substr(2, equals - 2);
    if (key == "FILEVERSION") {
      columns_ = columns_of(value);
    } else if (key == "STARTTIME") {
      const auto days = decimal(value);
      if (!days || !(*days >= kDaysTo1970 && *days < 100'000))
        return wrong("days since 30 December 1899 expected");
      // Milliseconds are what the digits of a day are good for.
      begin_ = static_cast<Time>(std::llround((*days - kDaysTo1970) * 86'400'000)) * runtime::kMillisecond -
               runtime::kCandumpEpoch;
    } else if (key == "COLUMNS") {
      if (value.find_first_not_of("NOTBIdRLlD,S") != std::string_view::npos || value.empty())
        return wrong("columns expected, for example N,O,T,I,d,l,D");
      columns_ = value;
    }
    return {};
  }

  tl::expected<void, FieldError> event(Fields fields, size_t line) {
    runtime::Frame frame;
    std::optional<Time> time;
    std::string_view bus = "1", type = "DT";
    bool has_id = false, has_length = false;
    for (const char column : columns_) {
      if (column == ',') continue;
      if (column == 'D') break;
      const std::string_view field = fields.next();
      if (field.empty()) return fields.wrong("the line ends too early");
      if (column == 'O') {
        time = decimal_time(field, 6);
        if (!time) return fields.wrong("time in milliseconds expected");
      } else if (column == 'T') {
        type = field;
        if (type != "DT" && type != "RR") return leave_out(what_of(type));
      } else if (column == 'B') {
        if (!whole<unsigned>(field)) return fields.wrong("number of the bus expected");
        bus = field;
      } else if (column == 'd') {
        if (field == "Warng" || field == "Error")  // version 1
          return leave_out(field == "Error" ? LeftOut::ErrorFrame : LeftOut::Record);
        if (field != "Rx" && field != "Tx") return fields.wrong("Rx or Tx expected");
      } else if (column == 'I') {
        const auto id = whole<uint32_t>(field, 16);
        frame.extended = field.size() > 4;  // some tools leave zeros out
        frame.id = id.value_or(UINT32_MAX);
        // Version 1 writes what went wrong in place of the identifier.
        if (field == "FFFFFFFF") return leave_out(LeftOut::Record);
        if (!id || !is_valid(frame)) return fields.wrong("identifier of up to 8 hexadecimal digits expected");
        has_id = true;
      } else if (column == 'l' || column == 'L') {
        const auto length = whole<uint8_t>(field);
        if (!length || *length > kLargestDlc)
          return fields.wrong("length of 0 to 8, or a DLC up to 15, expected");
        frame.length = classic_length(*length);
        has_length = true;
      }
    }
    if (!time || !has_id || !has_length)
      return fields.wrong("the columns have no time, identifier or length");
    frame.remote = type == "RR" || fields.peek() == "RTR";
    if (!frame.remote)
      if (auto error = read_bytes(fields, 16, frame)) return tl::unexpected(std::move(*error));
    reader_.can({begin_ + *time, fmt::format("can{}", bus), frame}, {line, 1});
    return {};
  }

  tl::expected<void, FieldError> leave_out(LeftOut what) {
    reader_.left_out(what);
    return {};
  }

  const LogReader& reader_;
  std::string columns_{columns_of("1.0")};
  Time begin_ = 0;
};

}  // namespace

void read_trc(std::string_view text, const LogReader& reader) {
  TrcReader trc(reader);
  for_each_line(text, [&](std::string_view row, size_t line) { trc.take(row, line); });
}

}  // namespace ipos::tools

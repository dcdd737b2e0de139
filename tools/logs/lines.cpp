// Logs whose lines tell by themselves of which kind they are: candump's, those of --serial-log, bare telegrams. What candump
// writes beside classic frames, and comments of its users, are left out as can-utils and python-can do.
#include <fmt/format.h>

#include <charconv>

#include "runtime/bus/log/profibus_log.hpp"
#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

constexpr uint32_t kErrorFlag = 1U << 29;  // of SocketCAN, in an identifier of eight digits

// Of a line of candump's log that is no classic frame: "(1.0) can0 20000008#..", "(1.0) can0 123##1..".
std::optional<LeftOut> left_out_of(std::string_view row) {
  Fields fields(row);
  fields.next();
  fields.next();
  const std::string_view frame = fields.next();
  const size_t mark = frame.find('#');
  if (mark == std::string_view::npos) return std::nullopt;
  const auto id = whole<uint32_t>(frame.substr(0, mark), 16);
  if (!id || (mark != 3 && mark != 8)) return std::nullopt;
  if (mark == 8 && *id >> 29U == kErrorFlag >> 29U) return LeftOut::ErrorFrame;
  if (frame.substr(mark).starts_with("##")) return LeftOut::FdFrame;
  return std::nullopt;
}

// Of candump, and what people write between its lines; canplayer passes over them, too. In the terminal form the words of
// an error frame stand in lines of their own, after a tabulator.
bool is_comment(std::string_view row) {
  const std::string_view first = Fields(row).next();
  return first.starts_with('#') || first.starts_with("//") ||
         (row.starts_with('\t') && first.find_first_of("-{") != std::string_view::npos);
}

}  // namespace

void read_log_line(std::string_view row, size_t line, const LogReader& reader) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (row.starts_with(kByteOrderMark)) row.remove_prefix(kByteOrderMark.size());
  if (Fields(row).next().empty() || is_comment(row)) return;
  const auto take = [&](const auto& entry, const auto& to) {
    if (entry)
      to(*entry, LogPlace{line, 1});
    else
      reader.wrong({line, entry.error().column}, entry.error().message);
  };
  if (read_terminal_line(row, line, reader)) return;
  if (const auto frame = runtime::parse_profibus_line(row))
    reader.dp(*frame, {line, 1});
  else if (runtime::is_serial_line(row))
    take(runtime::parse_serial_line(row, line), reader.serial);
  else if (const auto what = left_out_of(row))
    reader.left_out(*what);
  else
    take(runtime::parse_candump_line(row, line), reader.can);
}

}  // namespace ipos::tools

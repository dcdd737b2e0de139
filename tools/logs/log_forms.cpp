// Forms by their first bytes; logs whose lines tell by themselves.
#include "tools/logs/log_forms.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "runtime/bus/log/profibus_log.hpp"

namespace ipos::tools {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

struct Beginning {
  std::string_view text;
  LogForm form;
};
constexpr std::array<Beginning, 5> kBeginnings{{{"LOGG", LogForm::Blf},
                                                {"\n\r\r\n", LogForm::Pcapng},
                                                {";", LogForm::Trc},
                                                {"date ", LogForm::Asc},
                                                {"base ", LogForm::Asc}}};

}  // namespace

std::string place_text(const std::string& path, LogPlace place) {
  return place.line == 0 ? fmt::format("{}: byte {}", path, place.column)
                         : fmt::format("{}:{}:{}", path, place.line, place.column);
}

LogForm log_form(std::string_view begin) {
  for (const Beginning& row : kBeginnings)
    if (begin.starts_with(row.text)) return row.form;
  // Texts may begin with empty lines.
  const size_t first = begin.find_first_not_of(kBlanks);
  return first == std::string_view::npos || first == 0 ? LogForm::Lines : log_form(begin.substr(first));
}

void read_log_line(std::string_view row, size_t line, const LogReader& reader) {
  if (row.find_first_not_of(kBlanks) == std::string_view::npos) return;
  const auto take = [&](const auto& entry, const auto& to) {
    if (entry)
      to(*entry, LogPlace{line, 1});
    else
      reader.wrong({line, entry.error().column}, entry.error().message);
  };
  if (const auto frame = runtime::parse_profibus_line(row))
    reader.dp(*frame, {line, 1});
  else if (runtime::is_serial_line(row))
    take(runtime::parse_serial_line(row, line), reader.serial);
  else
    take(runtime::parse_candump_line(row, line), reader.can);
}

void for_each_line(std::string_view text, const std::function<void(std::string_view, size_t)>& take) {
  for (size_t line = 1; !text.empty(); ++line) {
    const size_t end = text.find('\n');
    const std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (row.find_first_not_of(kBlanks) != std::string_view::npos) take(row, line);
  }
}

void read_log(std::string_view bytes, const LogReader& reader) {
  switch (log_form(bytes)) {
    case LogForm::Pcapng: return read_pcapng(bytes, reader);
    case LogForm::Asc: return read_asc(bytes, reader);
    case LogForm::Trc: return read_trc(bytes, reader);
    case LogForm::Blf: return read_blf(bytes, reader);
    case LogForm::Lines: break;
  }
  for_each_line(bytes, [&](std::string_view row, size_t line) { read_log_line(row, line, reader); });
}

}  // namespace ipos::tools

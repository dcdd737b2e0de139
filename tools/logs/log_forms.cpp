// Forms by their first bytes, and who reads them.
#include "tools/logs/log_forms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "compiler/diag/places.hpp"

namespace ipos::tools {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

struct Beginning {
  std::string_view text;
  LogForm form;
};
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::array<Beginning, 10> kBeginnings{{{"LOGG", LogForm::Blf},
                                                 {"\n\r\r\n", LogForm::Pcapng},
                                                 {"\xD4\xC3\xB2\xA1", LogForm::Pcap},
                                                 {"\xA1\xB2\xC3\xD4", LogForm::Pcap},
                                                 {"\x4D\x3C\xB2\xA1", LogForm::Pcap},
                                                 {"\xA1\xB2\x3C\x4D", LogForm::Pcap},
                                                 {"\x1F\x8B", LogForm::Packed},
                                                 {";", LogForm::Trc},
                                                 {"date ", LogForm::Asc},
                                                 {"base ", LogForm::Asc}}};

std::optional<LogForm> form_of(std::string_view begin) {
  for (const Beginning& row : kBeginnings)
    if (begin.starts_with(row.text)) return row.form;
  return std::nullopt;
}

std::string_view without_mark(std::string_view text) {
  return text.starts_with(kByteOrderMark) ? text.substr(kByteOrderMark.size()) : text;
}

std::string_view text_of(std::string_view begin) {
  begin = without_mark(begin);
  return begin.substr(std::min(begin.find_first_not_of(kBlanks), begin.size()));
}

}  // namespace

std::string place_text(const std::string& path, LogPlace place) {
  const std::string name = compiler::printable(path);
  return place.line == 0 ? fmt::format("{}: byte {}", name, place.column)
                         : fmt::format("{}:{}:{}", name, place.line, place.column);
}

LogForm log_form(std::string_view begin) {
  if (const auto form = form_of(begin)) return *form;
  // Texts may begin with the mark of an editor and with empty lines.
  begin = text_of(begin.substr(0, kToKnowTheForm));
  if (const auto form = form_of(begin)) return *form;
  return other_file(begin) ? LogForm::Other : LogForm::Lines;
}

void for_each_line(std::string_view text, const std::function<void(std::string_view, size_t)>& take) {
  text = without_mark(text);
  for (size_t line = 1; !text.empty(); ++line) {
    const size_t end = text.find('\n');
    const std::string_view row = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
    if (row.find_first_not_of(kBlanks) != std::string_view::npos) take(row, line);
  }
}

namespace {

void read_packed(std::string_view packed, const LogReader& reader) {
  const auto log = unpacked_log(packed);
  if (!log) return reader.wrong({0, 0}, log.error());
  if (log_form(log->bytes) == LogForm::Packed)
    return reader.wrong({0, 0}, "a log packed with gzip within another one");
  read_log(log->bytes, reader);
  if (!log->whole) reader.wrong({0, packed.size()}, "packed with gzip, and cut off: the rest of the log is missing");
}

}  // namespace

void read_log(std::string_view bytes, const LogReader& reader) {
  switch (log_form(bytes)) {
    case LogForm::Pcapng: return read_pcapng(bytes, reader);
    case LogForm::Asc: return read_asc(bytes, reader);
    case LogForm::Trc: return read_trc(bytes, reader);
    case LogForm::Blf: return read_blf(bytes, reader);
    case LogForm::Pcap: return read_pcap(bytes, reader);
    case LogForm::Packed: return read_packed(bytes, reader);
    case LogForm::Other:
      return reader.wrong(
          {0, 0}, "no log that ipos reads, but " + *other_file(text_of(bytes.substr(0, kToKnowTheForm))));
    case LogForm::Lines: break;
  }
  for_each_line(bytes, [&](std::string_view row, size_t line) { read_log_line(row, line, reader); });
}

}  // namespace ipos::tools

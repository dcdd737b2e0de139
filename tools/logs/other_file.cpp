// Files that are taken for logs of a bus and are none, or of a form that is not read: named, so that the user knows what to
// do. Known by their first bytes.
#include <algorithm>
#include <array>

#include "tools/logs/fields.hpp"
#include "tools/logs/log_forms.hpp"

namespace ipos::tools {
namespace {

struct Known {
  std::string_view begin;
  const char* what;
};
constexpr const char* kUtf16 = "text in UTF-16; save it as UTF-8";
constexpr std::array<Known, 20> kKnown{
    {{"\xFF\xFE", kUtf16},
     {"\xFE\xFF", kUtf16},
     {"MDF     ", "a measurement in MDF (MF4); export it as ASC or BLF"},
     {"UnFinMF ", "a measurement in MDF (MF4) that was not closed; export it as ASC or BLF"},
     {"***BUSMASTER", "a log of BUSMASTER; export it as ASC"},
     {"Microchip Technology", "a log of Microchip's CAN analyzer; convert it to ASC or candump"},
     {"SQLite format 3", "a database of python-can; convert it with can.LogReader to ASC or BLF"},
     {"\xA1\xB2\xCD\x34", "a capture in a changed form of pcap; save it as pcapng"},
     {"\x34\xCD\xB2\xA1", "a capture in a changed form of pcap; save it as pcapng"},
     {"PK\x03\x04", "a ZIP archive; unpack it"},
     {"BZh", "packed with bzip2; unpack it"},
     {"\xFD"
      "7zXZ",
      "packed with xz; unpack it"},
     {"\x28\xB5\x2F\xFD", "packed with zstd; unpack it"},
     {"7z\xBC\xAF", "a 7-Zip archive; unpack it"},
     {"\x7F"
      "ELF",
      "a program"},
     {"\x89PNG", "a picture"},
     {"\xFF\xD8\xFF", "a picture"},
     {"%PDF", "a PDF document"},
     {"<", "a document in XML or HTML"},
     {"{", "text in JSON"}}};

// CRTD: "1320745424.000 R11 ...", also with the number of a bus before the type.
bool is_crtd(std::string_view row) {
  Fields fields(row);
  if (!decimal_time(fields.next(), 9)) return false;
  std::string_view type = fields.next();
  if (!type.empty() && type[0] >= '0' && type[0] <= '9') type.remove_prefix(1);
  constexpr std::array<std::string_view, 9> kTypes{"CXX", "CEV", "CER", "CST", "CMT",
                                                   "R11", "R29", "T11", "T29"};
  return std::find(kTypes.begin(), kTypes.end(), type) != kTypes.end();
}

}  // namespace

std::optional<std::string> other_file(std::string_view begin) {
  for (const Known& known : kKnown)
    if (begin.starts_with(known.begin)) return known.what;
  // Without a mark: every second byte of a text is 0 then.
  if (begin.size() >= 4 && (begin[0] == '\0') != (begin[1] == '\0') &&
      (begin[0] == '\0') == (begin[2] == '\0') && (begin[1] == '\0') == (begin[3] == '\0'))
    return kUtf16;
  if (begin.find('\0') != std::string_view::npos) return "binary data";
  const std::string_view row = begin.substr(0, begin.find_first_of("\r\n"));
  // Sentences of a serial log have commas, too, with blanks after them.
  constexpr std::ptrdiff_t kLeastCommas = 3;
  const bool is_table =
      row.find(", ") == std::string_view::npos && row.find_first_of("([|") == std::string_view::npos;
  for (const char separator : {',', ';'})
    if (is_table && std::count(row.begin(), row.end(), separator) >= kLeastCommas)
      return "a table (csv of python-can, GVRET or another tool); convert it to ASC or candump";
  if (is_crtd(row)) return "a log in CRTD; convert it to ASC or candump";
  return std::nullopt;
}

}  // namespace ipos::tools

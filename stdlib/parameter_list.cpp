// The reader of parameter lists. It is constexpr: for the lists of the program the C++ compiler carries it out, and
// what is left of them are arrays. A fault in a list is a fault of the project: its row is marked, the table names it
// in problems(), and a test holds that empty.
#include "stdlib/parameter_list.hpp"

#include <array>
#include <limits>
#include <optional>

#include "stdlib/units.hpp"

namespace ipos::stdlib {
namespace {

enum Column {
  kNumber,
  kName,
  kIndex,
  kRole,
  kDisplay,
  kQuantity,
  kConversion,
  kAccess,
  kDefault,
  kRange,
  kTexts,
  kOption,
  kNotes,
  kColumns
};

// How much room a text needs at most.
struct Sizes {
  size_t rows = 0, ranges = 0, texts = 0;
};

constexpr Sizes most_of(std::string_view text) {
  Sizes most{1, 0, 0};
  for (const char c : text) {
    most.rows += c == '\n';
    most.ranges += c == '/';
    most.texts += c == '=';
  }
  return most;
}

// Where the character is, or the end: a plain loop, because each call of std::string_view's costs the compiler a step
// for each character.
constexpr size_t place_of(char wanted, std::string_view text) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const char* at = begin;
  while (at != end && *at != wanted) ++at;
  return static_cast<size_t>(at - begin);
}

// Cuts the text up to the separator off `rest`.
constexpr std::string_view cut(std::string_view& rest, char separator) {
  const size_t at = place_of(separator, rest);
  const std::string_view part(rest.data(), at);
  rest =
      at == rest.size() ? std::string_view{} : std::string_view(rest.data() + at + 1, rest.size() - at - 1);
  return part;
}

// A whole decimal number in the range of the type. std::from_chars is not constexpr.
template <typename Integer>
constexpr std::optional<Integer> number(std::string_view text) {
  const bool negative = text.starts_with('-');
  if (negative) text.remove_prefix(1);
  if (text.empty() || text.size() > 18) return std::nullopt;  // 18 digits fit 64 bits
  int64_t value = 0;
  for (const char digit : text) {
    if (digit < '0' || digit > '9') return std::nullopt;
    value = 10 * value + (digit - '0');
  }
  if (negative) value = -value;
  if (value < std::numeric_limits<Integer>::min() || value > std::numeric_limits<Integer>::max())
    return std::nullopt;
  return static_cast<Integer>(value);
}

constexpr bool read_access(std::string_view text, ParameterRules& rules) {
  while (!text.empty()) {
    const std::string_view word = cut(text, '/');
    if (word == "RW")
      rules.writable = true;
    else if (word == "R")
      rules.needs_inhibit = true;
    else if (word == "S")
      rules.writable_locked = true;
    else if (word == "N")
      rules.nonvolatile = true;
    else if (word == "E")
      rules.needs_output_stage_off = true;
    else if (word == "B")
      rules.bcd = true;
    else if (word != "RO")
      return false;
  }
  return true;
}

constexpr bool read_option(std::string_view text, ParameterRules& rules) {
  if (text == "DRS")
    rules.option = OptionCard::Drs;
  else if (text == "DIO")
    rules.option = OptionCard::Dio;
  else if (text == "AIO")
    rules.option = OptionCard::Aio;
  return text.empty() || rules.option != OptionCard::None;
}

// Reads one list into room that most_of() has measured.
class ListReader {
 public:
  constexpr ListReader(std::string_view text, std::span<ListedRow> rows, std::span<ValueRange> ranges,
                       std::span<ListedText> texts)
      : text_(text), rows_(rows), ranges_(ranges), texts_(texts) {}

  // How much of the room is used.
  constexpr Sizes read() {
    std::string_view rest = text_;
    bool heading = true;
    for (uint16_t line_number = 1; !rest.empty(); ++line_number) {
      const std::string_view line = cut(rest, '\n');
      if (line.empty() || line[0] == '#') continue;
      if (!heading) {
        ListedRow& row = rows_[used_.rows++];
        row.line = piece(line);
        row.line_number = line_number;
        row.good = read_row(line, row);
      }
      heading = false;
    }
    return used_;
  }

 private:
  constexpr Piece piece(std::string_view part) const {
    return {static_cast<uint32_t>(part.data() - text_.data()), static_cast<uint32_t>(part.size())};
  }

  constexpr bool read_row(std::string_view line, ListedRow& row) {
    std::string_view cells[kColumns];
    for (size_t n = 0; n < kColumns; ++n) {
      const size_t end = place_of('\t', line);
      if ((end == line.size()) != (n == kNotes)) return false;
      cells[n] = {line.data(), end};
      if (n != kNotes) line = {line.data() + end + 1, line.size() - end - 1};
    }

    row.number = piece(cells[kNumber]);
    row.name = piece(cells[kName]);
    row.display = piece(cells[kDisplay]);
    row.notes = piece(cells[kNotes]);
    row.view = cells[kRole] == "view";
    const auto index =
        cells[kIndex].empty() ? std::optional<uint16_t>(uint16_t{0}) : number<uint16_t>(cells[kIndex]);
    if (cells[kName].empty() || !index || (!row.view && !cells[kRole].empty())) return false;
    row.index = *index;
    if (!read_texts(cells[kTexts], row)) return false;
    if (row.view || row.index == 0) return true;

    const auto quantity =
        cells[kQuantity].empty() ? std::optional<uint8_t>(kNoQuantity) : number<uint8_t>(cells[kQuantity]);
    const auto conversion = number<int8_t>(cells[kConversion]);
    const auto default_value = number<int64_t>(cells[kDefault]);
    if (!quantity || !conversion || !default_value) return false;
    row.quantity = *quantity;
    row.conversion = *conversion;
    row.default_value = *default_value;
    return read_access(cells[kAccess], row.rules) && read_ranges(cells[kRange], row) &&
           read_option(cells[kOption], row.rules);
  }

  // "0..1000/10;1000..10000/100"
  constexpr bool read_ranges(std::string_view text, ListedRow& row) {
    row.first_range = static_cast<uint16_t>(used_.ranges);
    while (!text.empty()) {
      std::string_view range = cut(text, ';');
      const auto minimum = number<int64_t>(cut(range, '.'));
      if (!range.starts_with('.')) return false;
      range.remove_prefix(1);
      const auto maximum = number<int64_t>(cut(range, '/'));
      const auto step = number<int64_t>(range);
      if (!minimum || !maximum || !step || *step <= 0 || *minimum > *maximum) return false;
      ranges_[used_.ranges++] = {*minimum, *maximum, *step};
      ++row.ranges;
    }
    return true;
  }

  // "0=OFF|1=ON", "16*=IPOS input", "2@15/16=ON EXCEPT FSP", or "=P600" for the list of that row.
  constexpr bool read_texts(std::string_view text, ListedRow& row) {
    if (text.starts_with("=P")) return share_texts(text.substr(2), row);
    row.first_text = static_cast<uint16_t>(used_.texts);
    while (!text.empty()) {
      std::string_view entry = cut(text, '|');
      std::string_view code = cut(entry, '=');
      ListedText one;
      if (const size_t at = place_of('@', code); at != code.size()) {
        std::string_view versions = code.substr(at + 1);
        const auto standard = number<uint8_t>(cut(versions, '/'));
        const auto logodrive = number<uint8_t>(versions);
        if (!standard || !logodrive) return false;
        one.from_standard = *standard;
        one.from_logodrive = *logodrive;
        code = code.substr(0, at);
      }
      one.logodrive_only = code.ends_with('*');
      if (one.logodrive_only) code.remove_suffix(1);
      const auto value = number<int32_t>(code);
      if (!value || entry.empty()) return false;
      if (row.texts != 0 && texts_[used_.texts - 1].value >= *value) return false;
      one.value = *value;
      one.text = piece(entry);
      texts_[used_.texts++] = one;
      ++row.texts;
    }
    return true;
  }

  // A row of another list is looked for when the lists are put together.
  constexpr bool share_texts(std::string_view number, ListedRow& row) {
    for (const ListedRow& other : rows_.first(used_.rows - 1)) {
      if (!other.good || other.number.of(text_) != number) continue;
      row.first_text = other.first_text;
      row.texts = other.texts;
      return other.texts != 0;
    }
    row.texts_of = piece(number);
    return true;
  }

  std::string_view text_;
  std::span<ListedRow> rows_;
  std::span<ValueRange> ranges_;
  std::span<ListedText> texts_;
  Sizes used_;
};

struct NamedText {
  std::string_view name;
  std::string_view text;
};
constexpr NamedText kFiles[] = {
#include "parameter_lists.inc"  // generated, see CMakeLists.txt
};

// What the compiler makes of one of the files.
template <size_t file>
struct Built {
  static constexpr Sizes kMost = most_of(kFiles[file].text);

  std::array<ListedRow, kMost.rows> rows{};
  std::array<ValueRange, kMost.ranges> ranges{};
  std::array<ListedText, kMost.texts> texts{};
  Sizes used;

  constexpr Built() : used(ListReader(kFiles[file].text, rows, ranges, texts).read()) {}
  constexpr ParameterList list() const {
    return {kFiles[file].name, kFiles[file].text, std::span(rows).first(used.rows),
            std::span(ranges).first(used.ranges), std::span(texts).first(used.texts)};
  }
};

template <size_t file>
constexpr Built<file> kBuilt;

template <size_t... files>
std::span<const ParameterList> lists_of(std::index_sequence<files...>) {
  static constexpr ParameterList lists[] = {kBuilt<files>.list()...};
  return lists;
}

}  // namespace

std::span<const ParameterList> built_lists() {
  return lists_of(std::make_index_sequence<std::size(kFiles)>());
}

ReadList::ReadList(std::string_view name, std::string_view text) : name_(name), text_(text) {
  const Sizes most = most_of(text);
  rows_.resize(most.rows);
  ranges_.resize(most.ranges);
  texts_.resize(most.texts);
  const Sizes used = ListReader(text, rows_, ranges_, texts_).read();
  rows_.resize(used.rows);
  ranges_.resize(used.ranges);
  texts_.resize(used.texts);
}

}  // namespace ipos::stdlib

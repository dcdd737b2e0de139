// Reads the parameter lists that are compiled into the program. A fault in a list is a fault of the project:
// it goes into problems(), which a test holds empty, and the row is left out.
#include "stdlib/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <type_traits>
#include <utility>

#include "stdlib/units.hpp"

namespace ipos::stdlib {

namespace parameter_lists {
std::span<const EmbeddedFile> embedded_files();  // generated, see CMakeLists.txt
}

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

// Cuts the text up to the separator, a character or several, off `rest`.
template <typename Separator>
std::string_view cut(std::string_view& rest, Separator separator) {
  size_t size = 1;
  if constexpr (!std::is_same_v<Separator, char>) size = std::string_view(separator).size();
  const size_t at = rest.find(separator);
  const std::string_view part = rest.substr(0, at);
  rest = at == std::string_view::npos ? std::string_view{} : rest.substr(at + size);
  return part;
}

template <typename Integer>
std::optional<Integer> number(std::string_view text) {
  Integer value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// "813", not "81" or "17.1".
std::optional<size_t> three_digits(std::string_view text) {
  if (text.size() != 3) return std::nullopt;
  size_t value = 0;
  for (const char digit : text) {
    if (digit < '0' || digit > '9') return std::nullopt;
    value = 10 * value + static_cast<size_t>(digit - '0');
  }
  return value;
}

bool read_access(std::string_view text, Parameter& p) {
  while (!text.empty()) {
    const std::string_view word = cut(text, '/');
    if (word == "RW")
      p.writable = true;
    else if (word == "R")
      p.needs_inhibit = true;
    else if (word == "S")
      p.writable_locked = true;
    else if (word == "N")
      p.nonvolatile = true;
    else if (word == "E")
      p.needs_output_stage_off = true;
    else if (word == "B")
      p.bcd = true;
    else if (word != "RO")
      return false;
  }
  return true;
}

// "0..1000/10;1000..10000/100"
bool read_ranges(std::string_view text, Parameter& p) {
  while (!text.empty()) {
    std::string_view range = cut(text, ';');
    const auto minimum = number<int64_t>(cut(range, ".."));
    const auto maximum = number<int64_t>(cut(range, '/'));
    const auto step = number<int64_t>(range);
    if (!minimum || !maximum || !step || *step <= 0 || *minimum > *maximum) return false;
    p.ranges.push_back({*minimum, *maximum, *step});
  }
  return true;
}

// "0=OFF|1=ON", "16*=IPOS input", "2@15/16=ON EXCEPT FSP", or "=P600" for the list of that row.
bool read_texts(std::string_view text, const std::vector<Parameter>& before, Parameter& p) {
  if (text.starts_with("=P")) {
    text.remove_prefix(2);
    for (const Parameter& other : before)
      if (other.number == text) return p.texts = other.texts, !other.texts.empty();
    return false;
  }
  while (!text.empty()) {
    std::string_view entry = cut(text, '|');
    std::string_view code = cut(entry, '=');
    ValueText row{};
    if (const size_t at = code.find('@'); at != std::string_view::npos) {
      std::string_view versions = code.substr(at + 1);
      const auto standard = number<uint8_t>(cut(versions, '/'));
      const auto logodrive = number<uint8_t>(versions);
      if (!standard || !logodrive) return false;
      row.from_standard = *standard;
      row.from_logodrive = *logodrive;
      code = code.substr(0, at);
    }
    row.logodrive_only = code.ends_with('*');
    if (row.logodrive_only) code.remove_suffix(1);
    const auto value = number<int32_t>(code);
    if (!value || entry.empty()) return false;
    if (!p.texts.empty() && p.texts.back().value >= *value) return false;
    row.value = *value;
    row.text = entry;
    p.texts.push_back(row);
  }
  return true;
}

bool read_option(std::string_view text, Parameter& p) {
  if (text == "DRS")
    p.option = OptionCard::Drs;
  else if (text == "DIO")
    p.option = OptionCard::Dio;
  else if (text == "AIO")
    p.option = OptionCard::Aio;
  return text.empty() || p.option != OptionCard::None;
}

bool read_row(std::string_view line, const std::vector<Parameter>& before, Parameter& p) {
  std::string_view cells[kColumns];
  if (std::count(line.begin(), line.end(), '\t') != kColumns - 1) return false;
  for (std::string_view& cell : cells) cell = cut(line, '\t');

  p.number = cells[kNumber];
  p.name = cells[kName];
  p.display = cells[kDisplay];
  p.notes = cells[kNotes];
  p.view = cells[kRole] == "view";
  const auto index = cells[kIndex].empty() ? std::optional<uint16_t>(0) : number<uint16_t>(cells[kIndex]);
  if (p.name.empty() || !index || (!p.view && !cells[kRole].empty())) return false;
  p.index = *index;
  if (!read_texts(cells[kTexts], before, p)) return false;
  if (p.view || p.index == 0) return true;

  const auto quantity =
      cells[kQuantity].empty() ? std::optional<uint8_t>(kNoQuantity) : number<uint8_t>(cells[kQuantity]);
  const auto conversion = number<int8_t>(cells[kConversion]);
  const auto default_value = number<int64_t>(cells[kDefault]);
  if (!quantity || !conversion || !default_value) return false;
  p.quantity = *quantity;
  p.conversion = *conversion;
  p.default_value = *default_value;
  return read_access(cells[kAccess], p) && read_ranges(cells[kRange], p) && read_option(cells[kOption], p);
}

// A view with the rules of the row that leads its index.
Parameter view_of(const Parameter& lead, const Parameter& view) {
  Parameter row = lead;
  row.number = view.number;
  row.name = view.name;
  row.view = true;
  row.notes = view.notes;
  if (!view.display.empty()) row.display = view.display;
  if (!view.texts.empty()) row.texts = view.texts;
  return row;
}

// Takes the place of the row with the same number, else its place in the order of the numbers.
void replace_or_insert(std::vector<Parameter>& rows, Parameter row) {
  auto at = std::find_if(rows.begin(), rows.end(), [&row](const Parameter& old) {
    return !old.number.empty() && old.number >= row.number;
  });
  if (at != rows.end() && at->number == row.number)
    *at = std::move(row);
  else
    rows.insert(at, std::move(row));
}

// The rows that lead an index, in rising order.
std::vector<const Parameter*> leading_rows(const std::vector<Parameter>& rows) {
  std::vector<const Parameter*> leads;
  leads.reserve(rows.size());
  for (const Parameter& row : rows)
    if (!row.view && row.index != 0) leads.push_back(&row);
  std::sort(leads.begin(), leads.end(),
            [](const Parameter* a, const Parameter* b) { return a->index < b->index; });
  return leads;
}

const Parameter* find_index(const std::vector<const Parameter*>& leads, uint16_t index) {
  const auto at = std::lower_bound(leads.begin(), leads.end(), index,
                                   [](const Parameter* p, uint16_t wanted) { return p->index < wanted; });
  return at != leads.end() && (*at)->index == index ? *at : nullptr;
}

}  // namespace

int64_t Parameter::minimum() const {
  if (!ranges.empty()) return ranges.front().minimum;
  return texts.empty() ? INT32_MIN : texts.front().value;
}

int64_t Parameter::maximum() const {
  if (!ranges.empty()) return ranges.back().maximum;
  return texts.empty() ? INT32_MAX : texts.back().value;
}

ParameterTable::ParameterTable(std::span<const EmbeddedFile* const> lists, bool option_cards) {
  std::vector<Parameter> rows;
  for (const EmbeddedFile* list : lists) {
    const bool replaces = list != lists.front();
    std::string_view rest = list->text;
    bool header = true;
    for (int line_number = 1; !rest.empty(); ++line_number) {
      const std::string_view line = cut(rest, '\n');
      if (line.empty() || line[0] == '#' || std::exchange(header, false)) continue;
      Parameter row;
      if (!read_row(line, rows, row))
        problems_.push_back(std::string(list->name) + ":" + std::to_string(line_number) + ": " +
                            std::string(line));
      else if (replaces)
        replace_or_insert(rows, std::move(row));
      else
        rows.push_back(std::move(row));
    }
  }
  std::set<uint16_t> of_cards;  // indices that go with the cards
  if (!option_cards)
    std::erase_if(rows, [&](const Parameter& p) {
      return p.option != OptionCard::None && (of_cards.insert(p.index), true);
    });

  const std::vector<const Parameter*> leads = leading_rows(rows);
  for (Parameter& row : rows) {
    if (!row.view) continue;
    const Parameter* lead = find_index(leads, row.index);
    if (lead != nullptr)
      row = view_of(*lead, row);
    else if (!of_cards.contains(row.index))
      problems_.push_back("no row leads the index of " + std::string(row.name));
    if (lead == nullptr) row.index = 0;
  }
  std::erase_if(rows, [](const Parameter& row) { return row.view && row.index == 0; });
  rows_ = std::move(rows);
  by_index_ = leading_rows(rows_);
  for (size_t i = 1; i < by_index_.size(); ++i)
    if (by_index_[i - 1]->index == by_index_[i]->index)
      problems_.push_back("two rows lead index " + std::to_string(by_index_[i]->index));
  for (const Parameter& row : rows_)
    if (!row.number.empty()) by_number_.push_back(&row);
  std::stable_sort(by_number_.begin(), by_number_.end(),
                   [](const Parameter* a, const Parameter* b) { return a->number < b->number; });
  by_digits_.resize(1000);
  for (const Parameter& row : rows_)
    if (const auto digits = three_digits(row.number); digits && by_digits_[*digits] == nullptr) by_digits_[*digits] = &row;
}

const Parameter* ParameterTable::find(uint16_t index) const { return find_index(by_index_, index); }

const Parameter* ParameterTable::find(std::string_view text) const {
  if (text.starts_with('P') || text.starts_with('p'))
    text.remove_prefix(1);
  else if (const auto index = text.size() > 3 ? number<uint16_t>(text) : std::nullopt; index && *index > 999)
    return find(*index);
  if (const auto digits = three_digits(text)) return by_digits_[*digits];
  const auto at =
      std::lower_bound(by_number_.begin(), by_number_.end(), text,
                       [](const Parameter* p, std::string_view wanted) { return p->number < wanted; });
  return at != by_number_.end() && (*at)->number == text ? *at : nullptr;
}

namespace {

ParameterTable read_lists(const UnitType& unit) {
  std::vector<const EmbeddedFile*> lists;
  for (std::string_view names = unit.lists; !names.empty();) {
    const std::string_view name = cut(names, ' ');
    for (const EmbeddedFile& file : parameter_lists::embedded_files())
      if (file.name == name) lists.push_back(&file);
  }
  return {lists, unit.has(Trait::OptionCards)};
}

}  // namespace

// Each table is read when the first who needs it asks.
const ParameterTable& parameter_table(const UnitType& unit) {
  switch (unit.code) {
#define UNIT(code, ...)                                   \
  case code: {                                            \
    static const ParameterTable table = read_lists(unit); \
    return table;                                         \
  }
#include "stdlib/unit_types.def"
    default: break;
  }
  static const ParameterTable none({}, true);
  return none;
}

}  // namespace ipos::stdlib

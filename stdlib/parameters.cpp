// The table of a unit, made of the lists that it has (parameter_list.hpp). A fault in a list is a fault of the project:
// it goes into problems(), which a test holds empty, and the row is left out.
#include "stdlib/parameters.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <utility>

#include "stdlib/parameter_list.hpp"

namespace ipos::stdlib {
namespace {

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

std::optional<uint16_t> index_of(std::string_view text) {
  uint16_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return index;
}

// Of a row of the list, but for texts that are those of another row.
Parameter made_of(const ParameterList& list, const ListedRow& row, std::span<const ValueRange> ranges,
                  std::span<const ValueText> texts) {
  Parameter p;
  static_cast<ParameterRules&>(p) = row.rules;
  p.number = row.number.of(list.text);
  p.name = row.name.of(list.text);
  p.index = row.index;
  p.view = row.view;
  p.default_value = row.default_value;
  p.ranges = ranges.subspan(row.first_range, row.ranges);
  p.texts = texts.subspan(row.first_text, row.texts);
  p.quantity = row.quantity;
  p.conversion = row.conversion;
  p.display = row.display.of(list.text);
  p.notes = row.notes.of(list.text);
  return p;
}

// The texts of the row of that number, which stands before.
std::span<const ValueText> texts_of(std::string_view number, const std::vector<Parameter>& before) {
  const auto other =
      std::find_if(before.begin(), before.end(), [number](const Parameter& p) { return p.number == number; });
  return other == before.end() ? std::span<const ValueText>() : other->texts;
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
void replace_or_insert(std::vector<Parameter>& rows, const Parameter& row) {
  auto at = std::find_if(rows.begin(), rows.end(), [&row](const Parameter& old) {
    return !old.number.empty() && old.number >= row.number;
  });
  if (at != rows.end() && at->number == row.number)
    *at = row;
  else
    rows.insert(at, row);
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

void ParameterTable::take(const ParameterList& list, bool replaces) {
  std::vector<ValueText>& texts = texts_.emplace_back();
  texts.reserve(list.texts.size());
  for (const ListedText& one : list.texts)
    texts.push_back(
        {one.value, one.text.of(list.text), one.logodrive_only, one.from_standard, one.from_logodrive});
  const std::vector<ValueRange>& ranges = ranges_.emplace_back(list.ranges.begin(), list.ranges.end());
  rows_.reserve(rows_.size() + list.rows.size());
  for (const ListedRow& listed : list.rows) {
    Parameter row = made_of(list, listed, ranges, texts);
    bool good = listed.good;
    if (good && listed.texts_of.size != 0) {
      row.texts = texts_of(listed.texts_of.of(list.text), rows_);
      good = !row.texts.empty();
    }
    if (!good)
      problems_.push_back(std::string(list.name) + ":" + std::to_string(listed.line_number) + ": " +
                          std::string(listed.line.of(list.text)));
    else if (replaces)
      replace_or_insert(rows_, row);
    else
      rows_.push_back(row);
  }
}

ParameterTable::ParameterTable(std::span<const ParameterList> lists, bool option_cards) {
  for (const ParameterList& list : lists) take(list, &list != &lists.front());
  std::set<uint16_t> of_cards;  // indices that go with the cards
  if (!option_cards)
    std::erase_if(rows_, [&](const Parameter& p) {
      return p.option != OptionCard::None && (of_cards.insert(p.index), true);
    });

  const std::vector<const Parameter*> leads = leading_rows(rows_);
  for (Parameter& row : rows_) {
    if (!row.view) continue;
    const Parameter* lead = find_index(leads, row.index);
    if (lead != nullptr)
      row = view_of(*lead, row);
    else if (!of_cards.contains(row.index))
      problems_.push_back("no row leads the index of " + std::string(row.name));
    if (lead == nullptr) row.index = 0;
  }
  std::erase_if(rows_, [](const Parameter& row) { return row.view && row.index == 0; });
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
    if (const auto digits = three_digits(row.number); digits && by_digits_[*digits] == nullptr)
      by_digits_[*digits] = &row;
}

const Parameter* ParameterTable::find(uint16_t index) const { return find_index(by_index_, index); }

const Parameter* ParameterTable::find(std::string_view text) const {
  if (text.starts_with('P') || text.starts_with('p'))
    text.remove_prefix(1);
  else if (const auto index = text.size() > 3 ? index_of(text) : std::nullopt; index && *index > 999)
    return find(*index);
  if (const auto digits = three_digits(text)) return by_digits_[*digits];
  const auto at =
      std::lower_bound(by_number_.begin(), by_number_.end(), text,
                       [](const Parameter* p, std::string_view wanted) { return p->number < wanted; });
  return at != by_number_.end() && (*at)->number == text ? *at : nullptr;
}

namespace {

ParameterTable table_of(const UnitType& unit) {
  std::vector<ParameterList> lists;
  for (std::string_view names = unit.lists; !names.empty();) {
    const size_t end = std::min(names.find(' '), names.size());
    for (const ParameterList& list : built_lists())
      if (list.name == names.substr(0, end)) lists.push_back(list);
    names.remove_prefix(std::min(end + 1, names.size()));
  }
  return {lists, unit.has(Trait::OptionCards)};
}

}  // namespace

// Each table is made when the first who needs it asks.
const ParameterTable& parameter_table(const UnitType& unit) {
  switch (unit.code) {
#define UNIT(code, ...)                                 \
  case code: {                                          \
    static const ParameterTable table = table_of(unit); \
    return table;                                       \
  }
#include "stdlib/unit_types.def"
    default: break;
  }
  static const ParameterTable none({}, true);
  return none;
}

}  // namespace ipos::stdlib

// Words to terms, and terms to telegrams.
#include "tools/serve/host/trace_filter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {
namespace {

using Field = TraceFilter::Field;

constexpr size_t kLongest = 1'000;  // characters (ours)

struct FieldRow {
  Field field;
  std::string_view word;
  std::string_view what;
};
constexpr FieldRow kFields[] = {
#define TRACE_FIELD(name, word, what) {Field::name, word, what},
#include "tools/serve/host/trace_fields.def"
};

struct KindRow {
  std::string_view word;
  bool (*is)(const FilteredTelegram&);
};
constexpr KindRow kKinds[] = {{"error", [](const FilteredTelegram& one) { return one.is_error(); }},
                              {"remote", [](const FilteredTelegram& one) { return one.is_remote(); }},
                              {"extended", [](const FilteredTelegram& one) { return one.is_extended(); }},
                              {"ours", [](const FilteredTelegram& one) { return one.is_ours(); }},
                              {"foreign", [](const FilteredTelegram& one) { return !one.is_ours(); }}};

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  for (char& c : small)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return small;
}

bool contains(const std::string& text, const std::string& part) {
  return in_small_letters(text).find(part) != std::string::npos;
}

std::vector<std::string> parts_of(const std::string& text, char mark) {
  std::vector<std::string> parts;
  for (size_t begin = 0;;) {
    const size_t end = text.find(mark, begin);
    parts.push_back(text.substr(begin, end - begin));
    if (end == std::string::npos) return parts;
    begin = end + 1;
  }
}

std::optional<uint32_t> number_of(std::string_view text, int base) {
  if (base == 16 && (text.starts_with("0x") || text.starts_with("0X"))) text.remove_prefix(2);
  if (base == 16 && (text.ends_with('h') || text.ends_with('H'))) text.remove_suffix(1);
  uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return error == std::errc() && end == text.data() + text.size() && !text.empty() ? std::optional(number) : std::nullopt;
}

// Blanks part words, but not between quotes. A quote that is not closed goes on to the end: somebody is typing.
std::vector<std::string> words_in(std::string_view text, std::vector<bool>& quoted) {
  std::vector<std::string> words;
  std::string word;
  bool within = false, had = false;
  const auto end_word = [&] {
    if (!word.empty() || had) {
      words.push_back(std::move(word));
      quoted.push_back(had);
    }
    word.clear();
    had = false;
  };
  for (const char c : text) {
    if (c == '"') {
      within = !within;
      had = true;
    } else if (c == ' ' && !within) {
      end_word();
    } else {
      word += c;
    }
  }
  end_word();
  return words;
}

}  // namespace

TraceFilter::TraceFilter(std::string_view text) {
  if (text.size() > kLongest) throw Mistake(fmt::format("a filter has at most {} characters", kLongest));
  std::vector<bool> quoted;
  const std::vector<std::string> words = words_in(text, quoted);
  for (size_t n = 0; n < words.size(); ++n) {
    std::string word = words[n];
    Term term;
    term.wanted = !word.starts_with('-') || word.size() == 1;
    if (!term.wanted) word.erase(0, 1);
    const size_t colon = word.find(':');
    const std::string key = in_small_letters(word.substr(0, colon));
    const auto row = std::find_if(std::begin(kFields), std::end(kFields), [&](const FieldRow& one) { return one.word == key; });
    const bool named = colon != std::string::npos && row != std::end(kFields);
    // "SDO 1800h:2" is a text of the meanings, and who puts a word into quotes means the word.
    if (named) term.field = row->field;
    if (named && colon + 1 == word.size()) continue;  // its value is still to come
    if (named && term.field != Field::Anywhere)
      add(std::move(term), word.substr(colon + 1));
    else if (const std::string wanted = named ? word.substr(colon + 1) : word; !wanted.empty() && (quoted[n] || wanted != "-")) {
      term.texts = {in_small_letters(wanted)};
      needs_words_ = true;
      terms_.push_back(std::move(term));
    }
  }
  std::stable_partition(terms_.begin(), terms_.end(), [](const Term& term) { return term.field != Field::Anywhere; });
}

void TraceFilter::add(Term term, const std::string& values) {
  for (const std::string& value : parts_of(values, ',')) {
    if (value.empty()) continue;
    if (term.field == Field::Id || term.field == Field::Address || term.field == Field::Length) {
      const int base = term.field == Field::Id ? 16 : 10;
      const size_t dash = value.find('-');
      const auto least = number_of(value.substr(0, dash), base);
      const auto most = dash == std::string::npos ? least : number_of(value.substr(dash + 1), base);
      if (!least || !most)
        throw Mistake(fmt::format("'{}' is no {}number and no range of them", value, base == 16 ? "hexadecimal " : ""));
      term.ranges.push_back({*least, *most});
      continue;
    }
    if (term.field == Field::Is &&
        std::none_of(std::begin(kKinds), std::end(kKinds), [&](const KindRow& kind) { return kind.word == in_small_letters(value); }))
      throw Mistake(fmt::format("'{}' is none of error, remote, extended, ours, foreign", value));
    if (term.field == Field::Data && value.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
      throw Mistake(fmt::format("'{}' are no bytes in hexadecimal", value));
    term.texts.push_back(in_small_letters(value));
  }
  if (!term.texts.empty() || !term.ranges.empty()) terms_.push_back(std::move(term));
}

bool TraceFilter::takes(const FilteredTelegram& telegram) const {
  return std::all_of(terms_.begin(), terms_.end(),
                     [&](const Term& term) { return fits(term, telegram) == term.wanted; });
}

bool TraceFilter::fits(const Term& term, const FilteredTelegram& telegram) {
  const auto in_range = [&](uint32_t number) {
    return std::any_of(term.ranges.begin(), term.ranges.end(),
                       [number](Range range) { return number >= range.least && number <= range.most; });
  };
  const auto any = [&](auto found) { return std::any_of(term.texts.begin(), term.texts.end(), found); };
  switch (term.field) {
    case Field::Id: return telegram.id() && in_range(*telegram.id());
    case Field::Address: {
      const auto addresses = telegram.addresses();
      return std::any_of(addresses.begin(), addresses.end(), in_range);
    }
    case Field::Length: return in_range(static_cast<uint32_t>(telegram.length()));
    case Field::Line: return any([&](const std::string& text) { return in_small_letters(telegram.line()) == text; });
    case Field::Sender: return any([&](const std::string& text) { return in_small_letters(telegram.sender()) == text; });
    case Field::Data: {
      // From one byte on, not from the middle of it.
      const std::string data = in_small_letters(telegram.data());
      return any([&](const std::string& text) {
        for (size_t at = data.find(text); at != std::string::npos; at = data.find(text, at + 1))
          if (at % 2 == 0) return true;
        return false;
      });
    }
    case Field::Is:
      return any([&](const std::string& text) {
        return std::any_of(std::begin(kKinds), std::end(kKinds),
                           [&](const KindRow& kind) { return kind.word == text && kind.is(telegram); });
      });
    case Field::Anywhere: break;
  }
  return any([&](const std::string& text) {
    return contains(telegram.line(), text) || contains(telegram.identity(), text) || contains(telegram.data(), text) ||
           contains(telegram.sender(), text) || contains(telegram.words(), text);
  });
}

}  // namespace ipos::tools::serve

// What a drive shows and the tools print without a row of their own: units, the seven-segment display, control and status
// words, terminals, texts of settings, constants by where they are used, words of the language.
#include <fmt/format.h>

#include <map>
#include <optional>
#include <set>

#include "runtime/bus/movilink/unit_words.hpp"
#include "stdlib/header_names.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/spelling.hpp"
#include "stdlib/unit_types.hpp"
#include "tools/explain/entries.hpp"

namespace ipos::tools::explain {
namespace {

using stdlib::UnitType;

// The code of a process data word in P870 to P876 (MOVITRAC 07 chapter 6.1). It is asked of the parameter, whose texts have
// "STATUS WORD1", so that no number stands here.
struct Word {
  std::string_view name;     // as P870 and P873 have it
  std::string_view setting;  // a parameter that may hold it
  bool input;
};
constexpr Word kWords[] = {{"control word 1", "P870", false},
                           {"control word 2", "P870", false},
                           {"status word 1", "P873", true},
                           {"status word 2", "P873", true}};

std::optional<uint8_t> code_of(const UnitType& unit, const Word& word) {
  std::string text(word.name);
  text.erase(text.rfind(' '), 1);
  for (const stdlib::ValueText& value : stdlib::parameter_table(unit).find(word.setting)->texts)
    if (stdlib::equal_but_for_case(value.text, text)) return static_cast<uint8_t>(value.value);
  return std::nullopt;
}

std::string word_text(const Word& word) {
  const UnitType& unit = stdlib::unit_with(stdlib::Trait::NewVariables);
  std::string text = fmt::format("{}: process data {} the unit, a choice of {} on {}\n", word.name,
                                 word.input ? "from" : "to", word.setting, unit.title);
  if (!word.input) text += "  bits 0 to 2: 6 enables, 2 is a stop, 4 a rapid stop, 1 inhibits the controller\n";
  const std::optional<uint8_t> code = code_of(unit, word);
  if (!code) return text;
  for (const runtime::WordBit& bit : runtime::unit_word_bits(unit, word.input, *code))
    text += fmt::format("  bit {}: {}\n", bit.bit, bit.text);
  for (const auto& [state, meaning] : runtime::unit_state_texts(*code))
    text += fmt::format("  high byte {}: {}\n", state, meaning);
  return text;
}

std::string unit_text(const UnitType& unit) {
  std::string text = fmt::format("{}: {}\n", unit.name, unit.title);
  if (unit.runs_programs())
    text += fmt::format("  programs of {} words, {} tasks, variables H0 to H{}\n", unit.program_words, unit.tasks,
                        unit.variables - 1);
  else
    text += "  runs no programs\n";
  return text + fmt::format("  {} parameters: ipos param list --unit {}\n", stdlib::parameter_table(unit).rows().size(),
                            unit.name);
}

void add_display(Entries& entries) {
  const auto add = [&](std::string shown, const std::string& meaning) {
    entries.push_back({{"display " + shown},
                       meaning,
                       [shown, meaning] { return fmt::format("display {}: {}\n", shown, meaning); }});
  };
  const UnitType& unit = stdlib::unit_with(stdlib::Trait::NewVariables);
  for (const Word& word : kWords)
    if (const std::optional<uint8_t> code = code_of(unit, word))
      for (const auto& [state, meaning] : runtime::unit_state_texts(*code))
        if (state < 10) add(fmt::format("{}", state), meaning);
  add("t", "waiting for data: an enabled drive does not move until the first process data (1053 1610 p. 27)");
  add("F", "a fault: its number follows; ipos explain F lists them");
}

// Which parameters have this choice, by unit family the same one once.
void add_setting_texts(Entries& entries) {
  std::map<std::string, std::set<std::string>> having;
  for (const UnitType& unit : stdlib::unit_types())
    for (const stdlib::Parameter& row : stdlib::parameter_table(unit).rows())
      for (const stdlib::ValueText& value : row.texts)
        having[std::string(value.text)].insert(row.number.empty() ? fmt::format("{}", row.index)
                                                                  : fmt::format("P{}", row.number));
  for (const auto& [text, parameters] : having) {
    const std::string where = fmt::format("{}", fmt::join(parameters, ", "));
    entries.push_back({{text}, "a choice of " + where, [text = text, where] {
                         return fmt::format("{}: a choice of {}\n  ipos explain {} lists all its choices\n", text, where,
                                            where.substr(0, where.find(',')));
                       }});
  }
}

void add_words_of_the_language(Entries& entries) {
  constexpr std::pair<std::string_view, std::string_view> kWordsOfTheLanguage[] = {
      {"numof", "numof(NAME) is the number of a variable, for fields that hold one: Src = numof(lSend); also &NAME"},
      {"initial", "initial long NAME: a variable that is kept over power-off, in H0 to H127"},
  };
  for (const auto& [name, text] : kWordsOfTheLanguage)
    entries.push_back(
        {{std::string(name)}, std::string(text), [name = name, text = text] {
           return fmt::format("{}: word of the language\n  {}\n  more: docs/guide/language.md\n", name, text);
         }});
}

}  // namespace

std::string status_word(const std::string& printed) {
  if (printed.size() != 5) return {};
  const auto word = static_cast<uint16_t>(std::stoul(printed.substr(0, 4), nullptr, 16));
  const UnitType& unit = stdlib::unit_with(stdlib::Trait::NewVariables);
  return fmt::format("{} as a word of process data of {}\n  status word 1: {}\n  control word 1: {}\n", printed, unit.title,
                     runtime::status_word_text(unit, 1, word), runtime::control_word_text(unit, 1, word));
}

void add_shown(Entries& entries) {
  for (const UnitType& unit : stdlib::unit_types())
    entries.push_back({{std::string(unit.name), std::string(unit.title)},
                       std::string(unit.title),
                       [&unit] { return unit_text(unit); }});
  for (const Word& word : kWords)
    entries.push_back({{std::string(word.name)},
                       fmt::format("process data {} the unit", word.input ? "from" : "to"),
                       [&word] { return word_text(word); }});
  add_display(entries);
  add_setting_texts(entries);
  add_words_of_the_language(entries);
}

}  // namespace ipos::tools::explain

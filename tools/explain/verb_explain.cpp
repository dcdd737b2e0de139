// ipos explain: what a name means that the tools print, or which names a word belongs to.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "stdlib/language_tables.hpp"
#include "stdlib/spelling.hpp"
#include "stdlib/unit_names.hpp"
#include "stdlib/unit_types.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/explain/entries.hpp"

namespace ipos::tools {
namespace explain {

Entries all_entries() {
  Entries entries;
  add_messages(entries);
  add_language(entries);
  add_drive(entries);
  add_fieldbus(entries);
  add_shown(entries);
  return entries;
}

namespace {

std::string small(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

// What has this name, in any case of letters: MOVLNK is a structure and a command.
std::string texts_of(const Entries& entries, const std::string& name) {
  const stdlib::SystemFunction* function = stdlib::find_system_function(name);  // in other spellings, too
  const std::string_view wanted = function == nullptr ? std::string_view(name) : function->name;
  std::string text;
  for (const Entry& entry : entries)
    if (std::any_of(entry.names.begin(), entry.names.end(),
                    [&](const std::string& one) { return stdlib::equal_but_for_case(one, wanted); }))
      text += fmt::format("{}{}", text.empty() ? "" : "\n", entry.text());
  return text;
}

// Whether a word of the text begins so. Both are in small letters.
bool has_word(const std::string& text, const std::string& beginning) {
  for (size_t at = text.find(beginning); at != std::string::npos; at = text.find(beginning, at + 1))
    if (at == 0 || !std::isalnum(static_cast<unsigned char>(text[at - 1]))) return true;
  return false;
}

// The entries that have all the words, a line each.
std::string search(const Entries& entries, const std::vector<std::string>& words) {
  constexpr size_t kShortest = 3;
  const auto is_word = [](const std::string& word) {
    return word.size() >= kShortest &&
           std::any_of(word.begin(), word.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
  };
  if (std::none_of(words.begin(), words.end(), is_word)) return {};
  std::string lines;
  for (const Entry& entry : entries) {
    const std::string text = small(fmt::format("{} {}", fmt::join(entry.names, " "), entry.title));
    if (std::all_of(words.begin(), words.end(),
                    [&](const std::string& word) { return has_word(text, small(word)); }))
      lines += fmt::format("{:<12} {}\n", entry.names.front(), entry.title);
  }
  return lines;
}

// One number may be a return code of the parameter channel, an abort of SDO, an object and its parameter.
std::string numbers_text(const Entries& entries, const std::vector<std::string>& words) {
  const std::string printed = printed_number(words);
  const bool long_one = printed.size() == 9;  // with its h
  std::string text = return_code(words.size() == 1 ? words[0] : "");
  if (text.empty() && long_one) text = return_code("0x" + printed.substr(0, 8));
  const auto append = [&text](const std::string& more) {
    if (!more.empty()) text += (text.empty() ? "" : "\n") + more;
  };
  if (printed.empty()) return text;
  append(texts_of(entries, printed));
  append(parameter_of_object(printed));
  if (text.empty()) append(status_word(printed));
  return text;
}

std::string explain(const std::vector<std::string>& words) {
  if (words.size() == 1) {
    if (small(words[0]) == "f") return list_faults();
    if (std::string text = parameter_of_index(words[0]); !text.empty()) return text;
  }
  const Entries entries = all_entries();
  if (std::string text = numbers_text(entries, words); !text.empty()) return text;
  if (std::string text = texts_of(entries, fmt::format("{}", fmt::join(words, " "))); !text.empty()) return text;
  if (words.size() == 1)
    if (const stdlib::UnitType* unit = stdlib::find_unit_or_plate(words[0])) return texts_of(entries, std::string(unit->name));
  if (std::string lines = search(entries, words); !lines.empty()) return lines;
  const std::string typed = fmt::format("{}", fmt::join(words, " "));
  std::vector<std::string_view> names;
  for (const Entry& entry : entries) names.insert(names.end(), entry.names.begin(), entry.names.end());
  const std::string_view meant = stdlib::nearest(typed, names);
  throw Failure(kBadInput, fmt::format("there is no code or word '{}'{}; 'ipos help explain' says what can be asked", typed,
                                       meant.empty() ? "" : fmt::format(", did you mean '{}'?", meant)));
}

}  // namespace
}  // namespace explain

void add_explain(cli::Verb& app) {
  auto words = std::make_shared<std::vector<std::string>>();
  cli::Verb& verb =
      app.verb("explain", "what a code, a parameter, a function or a variable means; search by words");
  verb.option("NAME", *words,
              "for example E0203, V03, B21, F10, P130, 8470, 8/0/10, 0x08000010, H511, _MoviLink, MLDATA; F lists all faults; "
              "display t, status word 1, 0503h, mdxb, IPOS INPUT; 1017h, 06020000h, FF00h, EMCY of CANopen, Set_Prm, SAP 61, Prm_Fault of PROFIBUS; other words "
              "are searched for")
      .required()
      .offers([](const auto&) {
        std::vector<std::string> names;
        for (const explain::Entry& entry : explain::all_entries()) names.push_back(entry.names.front());
        return names;
      });
  verb.footer("Example:\n  ipos explain E0203\n  ipos explain ramp down");
  verb.runs([words] {
    fmt::print("{}", explain::explain(*words));
    return kGood;
  });
}

}  // namespace ipos::tools

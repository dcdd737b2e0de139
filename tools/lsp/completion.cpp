// Completion and signature help. The text around the cursor is broken while somebody types, so both read
// words backwards from the cursor and ask the index only for what the words mean. Inside a call what fits the argument comes
// first.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "stdlib/headers.hpp"
#include "stdlib/language_tables.hpp"
#include "tools/lsp/features.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::IndexedSymbol;
using compiler::SymbolKind;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view take_word_back(std::string_view& text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  size_t begin = text.size();
  while (begin > 0 && is_word(text[begin - 1])) --begin;
  const std::string_view word = text.substr(begin);
  text = text.substr(0, begin);
  return word;
}

// Drops `[...]` at the end; true when there was one.
bool drop_index(std::string_view& text) {
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  if (!text.ends_with(']')) return false;
  int depth = 0;
  while (!text.empty()) {
    depth += text.back() == ']' ? 1 : text.back() == '[' ? -1 : 0;
    text.remove_suffix(1);
    if (depth == 0) return true;
  }
  return false;
}

// Structure of the object that `text` ends with: `a.b[2]`. Empty when it has none.
std::string structure_before(const Program& program, std::string_view text) {
  struct Part {
    std::string name;
    bool indexed;
  };
  std::vector<Part> parts;  // last first
  while (parts.size() < 16) {
    const bool indexed = drop_index(text);
    const std::string_view word = take_word_back(text);
    if (word.empty()) return {};
    parts.push_back({std::string(word), indexed});
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    if (!text.ends_with('.')) break;
    text.remove_suffix(1);
  }
  std::string structure;
  for (auto part = parts.rbegin(); part != parts.rend(); ++part) {
    const IndexedSymbol* symbol = program.index.find(part->name, structure);
    if (symbol == nullptr || symbol->structure.empty() || symbol->array != part->indexed) return {};
    structure = symbol->structure;
  }
  return structure;
}

// Member by member: there are hundreds with each key, and a list in braces would be made twice.
Json item(std::string label, ItemKind kind, std::string detail, std::string text = {}) {
  Json one = Json::object();
  one["label"] = std::move(label);
  one["kind"] = static_cast<int>(kind);
  if (!detail.empty()) one["detail"] = std::move(detail);
  if (!text.empty()) {
    Json& documentation = one["documentation"];
    documentation["kind"] = "markdown";
    documentation["value"] = std::move(text);
  }
  return one;
}

Json symbol_item(const Program& program, const IndexedSymbol& symbol) {
  std::string text = describe(program, symbol, std::nullopt);
  const std::string number = symbol.number ? " H" + std::to_string(*symbol.number) : "";
  switch (symbol.kind) {
    case SymbolKind::Macro: return item(symbol.name, kConstant, symbol.type, std::move(text));
    case SymbolKind::Function: return item(symbol.name, kFunction, "function", std::move(text));
    case SymbolKind::Structure: return item(symbol.name, kStruct, "structure", std::move(text));
    case SymbolKind::Member: return item(symbol.name, kField, symbol.type, std::move(text));
    default: return item(symbol.name, kVariable, symbol.type + number, std::move(text));
  }
}

// A macro that only keeps a header from being read twice.
bool is_guard(const IndexedSymbol& symbol) {
  return symbol.kind == SymbolKind::Macro && symbol.type.empty() && symbol.name.ends_with("_H");
}

Json names(const Program& program) {
  Json items = Json::array();
  for (const IndexedSymbol& symbol : program.index.symbols)
    if (symbol.container.empty() && symbol.kind != SymbolKind::SystemFunction &&
        symbol.kind != SymbolKind::Parameter && !is_guard(symbol))
      items.push_back(symbol_item(program, symbol));
  for (const stdlib::SystemFunction& row : stdlib::system_functions())
    items.push_back(item(std::string(row.name), kFunction, std::string(row.arguments),
                         describe_system_function(row.name)));
#define KEYWORD(kind, spelling) items.push_back(item(spelling, kKeyword, ""));
#define FOREIGN_TYPE(kind, spelling)
#define FOREIGN_QUALIFIER(kind, spelling)
#include "compiler/preprocess/tokens.def"
  // Words of C that only have a message.
  std::erase_if(items.get_ref<Json::array_t&>(), [](const Json& one) {
    return one["kind"] == static_cast<int>(kKeyword) && (one["label"] == "goto" || one["label"] == "sizeof");
  });
  return items;
}

Json labels(std::initializer_list<const char*> words) {
  Json items = Json::array();
  for (const char* word : words) items.push_back(item(word, kKeyword, ""));
  return items;
}

// The line up to the cursor, joined lines left aside.
std::string_view line_before(std::string_view text) { return text.substr(text.rfind('\n') + 1); }

bool in_comment(std::string_view text) {
  const size_t open = text.rfind("/*");
  if (open != std::string_view::npos && text.find("*/", open + 2) == std::string_view::npos) return true;
  return line_before(text).find("//") != std::string_view::npos;
}

struct OpenCall {
  std::string_view name;
  size_t argument = 0;
};

// The call whose brackets the text ends inside of.
std::optional<OpenCall> open_call(std::string_view text) {
  OpenCall call;
  int depth = 0;
  while (!text.empty()) {
    const char c = text.back();
    text.remove_suffix(1);
    if (c == ';' || c == '{' || c == '}') return std::nullopt;
    if (c == ')' || c == ']') ++depth;
    if (c == '[' && depth-- == 0) return std::nullopt;
    if (c == ',' && depth == 0) ++call.argument;
    if (c != '(' || depth-- != 0) continue;
    call.name = take_word_back(text);
    return call.name.empty() ? std::nullopt : std::optional(call);
  }
  return std::nullopt;
}

// Of a system function, as they stand in its row: "keyword", "value", "variable", "function".
std::vector<std::string_view> argument_kinds(const stdlib::SystemFunction& row) {
  std::vector<std::string_view> kinds;
  for (std::string_view rest = row.arguments; !rest.empty();) {
    kinds.push_back(rest.substr(0, rest.find(' ')));
    rest.remove_prefix(std::min(kinds.back().size() + 1, rest.size()));
  }
  return kinds;
}

// The constants that its argument may be, where that is a keyword.
std::vector<std::string> constants_of(const stdlib::SystemFunction& function, size_t argument) {
  std::vector<std::string> constants;
  const auto rows = vm::opcode_table();
  const auto command = std::find_if(rows.begin(), rows.end(), [&](const vm::OpcodeInfo& row) { return row.mnemonic() == function.mnemonic; });
  if (command == rows.end() || argument >= command->operands.size() || command->operands[argument].keyword_set.empty()) return constants;
  for (const vm::KeywordInfo& row : vm::keyword_table())
    if (row.set == command->operands[argument].keyword_set) constants.emplace_back(row.constant);
  return constants;
}

// Whether a proposal is what the argument of that kind takes.
bool fits(const Json& proposal, std::string_view kind, const std::vector<std::string>& constants) {
  const std::string label = proposal["label"];
  if (kind == "keyword") return std::find(constants.begin(), constants.end(), label) != constants.end();
  if (kind == "function") return proposal["kind"] == static_cast<int>(kFunction) && !label.starts_with('_');
  return kind == "variable" && proposal["kind"] == static_cast<int>(kVariable);
}

// In front, and sorted there by who sorts by sortText or by label. A constant is proposed though its header is not included.
Json fitting_first(Json items, std::string_view text) {
  const auto call = open_call(text);
  const stdlib::SystemFunction* row = call ? stdlib::find_system_function(call->name) : nullptr;
  const auto kinds = row != nullptr ? argument_kinds(*row) : std::vector<std::string_view>{};
  if (!call || call->argument >= kinds.size()) return items;
  const std::string_view kind = kinds[call->argument];
  const std::vector<std::string> constants = constants_of(*row, call->argument);
  auto& all = items.get_ref<Json::array_t&>();
  for (const std::string& constant : constants)
    if (std::none_of(all.begin(), all.end(), [&](const Json& one) { return one["label"] == constant; }))
      all.push_back(item(constant, kConstant, "const.h"));
  const auto rest = std::stable_partition(all.begin(), all.end(), [&](const Json& one) { return fits(one, kind, constants); });
  // Constants as the manual has them.
  const auto place = [&](const Json& one) { return std::find(constants.begin(), constants.end(), one["label"].get<std::string>()); };
  std::stable_sort(all.begin(), rest, [&](const Json& a, const Json& b) { return place(a) < place(b); });
  for (auto one = all.begin(); one != all.end(); ++one)
    (*one)["sortText"] = (one < rest ? "0" : "1") + (*one)["label"].get<std::string>();
  return items;
}

}  // namespace

Json completion(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  if (cursor.file == nullptr) return nullptr;
  std::string_view before = std::string_view(cursor.file->text).substr(0, cursor.offset);
  const std::string_view line = line_before(before);
  if (in_comment(before)) return Json::array();
  const size_t first = line.find_first_not_of(" \t");
  if (first != std::string_view::npos && line[first] == '#') {
    const std::string_view directive = line.substr(first + 1);
    if (directive.find("include") != std::string_view::npos) {
      Json items = Json::array();
      for (const stdlib::EmbeddedFile& header : stdlib::built_in_files())
        items.push_back(item(std::string(header.name), kFile, "built in"));
      return items;
    }
    if (directive.find("pragma") != std::string_view::npos)
      return labels({"globals", "initials", "var", "list"});
    if (directive.find_first_not_of("abcdefghijklmnopqrstuvwxyz \t") == std::string_view::npos &&
        directive.find_first_of(" \t", std::min(directive.find_first_not_of(" \t"), directive.size())) ==
            std::string_view::npos)
      return labels({"include", "define", "undef", "ifdef", "ifndef", "if", "elif", "else", "endif",
                     "declare", "pragma", "error"});
    return names(cursor.program);
  }
  while (!before.empty() && is_word(before.back())) before.remove_suffix(1);
  while (before.ends_with(' ') || before.ends_with('\t')) before.remove_suffix(1);
  if (before.ends_with('.')) {
    before.remove_suffix(1);
    const std::string structure = structure_before(cursor.program, before);
    Json items = Json::array();
    for (const IndexedSymbol& symbol : cursor.program.index.symbols)
      if (symbol.kind == SymbolKind::Member && symbol.container == structure && !structure.empty())
        items.push_back(symbol_item(cursor.program, symbol));
    return items;
  }
  return fitting_first(names(cursor.program), before);
}

Json signature_help(Workspace& workspace, const Json& params) {
  const Cursor cursor = cursor_of(workspace, params);
  if (cursor.file == nullptr) return nullptr;
  const auto call = open_call(std::string_view(cursor.file->text).substr(0, cursor.offset));
  if (!call) return nullptr;
  const stdlib::SystemFunction* row = stdlib::find_system_function(call->name);
  if (row == nullptr) return nullptr;
  std::string label = std::string(row->name) + "(";
  Json parameters = Json::array();
  for (const std::string_view kind : argument_kinds(*row)) {
    const std::vector<std::string> constants = constants_of(*row, parameters.size());
    if (!parameters.empty()) label += ", ";
    Json parameter{{"label", {label.size(), label.size() + kind.size()}}};
    if (!constants.empty()) parameter["documentation"] = fmt::format("{}", fmt::join(constants, ", "));
    parameters.push_back(std::move(parameter));
    label += kind;
  }
  label += ")";
  return {{"signatures",
           {{{"label", label},
             {"documentation", std::string(row->meaning)},
             {"parameters", std::move(parameters)}}}},
          {"activeSignature", 0},
          {"activeParameter", call->argument}};
}

}  // namespace ipos::tools::lsp

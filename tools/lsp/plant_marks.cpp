// Folds, colours and lenses of plants and tests.
#include <algorithm>

#include "runtime/plant_file/toml_kind.hpp"
#include "tools/lsp/marks.hpp"
#include "tools/lsp/plant_document.hpp"
#include "tools/lsp/toml_lines.hpp"

namespace ipos::tools::lsp {
namespace {

Json of_row(const Workspace& workspace, std::string_view text, std::string_view piece) {
  const uint32_t begin = offset_in(text, piece);
  return range_of(text, begin, begin + static_cast<uint32_t>(piece.size()), workspace.encoding);
}

bool is_parameter(std::string_view key) {
  return key.size() > 1 && key[0] == 'P' && key.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

Json run_lens(const Json& range, const char* title, const char* command, Json arguments) {
  return {{"range", range},
          {"command", {{"title", title}, {"command", command}, {"arguments", std::move(arguments)}}}};
}

}  // namespace

// A table with what belongs to it: [[station]] with its [station.parameters].
Json plant_folding_ranges(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const auto text = workspace.text(document_path(params));
  if (!text) return out;
  const auto lines = lines_of(*text);
  const auto tables = tables_of(lines);
  const auto add = [&](size_t first, size_t end) {
    while (end > first + 1 && trimmed(lines[end - 1]).empty()) --end;
    if (end > first + 1) out.push_back({{"startLine", first}, {"endLine", end - 1}});
  };
  for (size_t n = 1; n < tables.size(); ++n) {
    size_t end = tables[n].end;
    const std::string prefix = std::string(tables[n].name) + ".";
    for (size_t m = n + 1; m < tables.size() && tables[m].name.starts_with(prefix); ++m) end = tables[m].end;
    add(tables[n].first, end);
  }
  return out;
}

Json plant_semantic_tokens(Workspace& workspace, const Json& params) {
  TokenRow row;
  const auto text = workspace.text(document_path(params));
  if (!text) return row.json();
  for (const std::string_view line : lines_of(*text)) {
    if (const std::string_view table = table_of(line); !table.empty())
      row.add(of_row(workspace, *text, table), TokenType::Namespace);
    else if (const std::string_view key = key_of(line.substr(0, line.find('#'))); !key.empty())
      row.add(of_row(workspace, *text, key), is_parameter(key) ? TokenType::Number : TokenType::Property,
              is_parameter(key) ? uint32_t{kDefaultLibrary} : 0U);
  }
  return row.json();
}

// Above the first row, and of a test with cases above each of them.
Json plant_code_lenses(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const std::string path = document_path(params);
  const auto text = workspace.text(path);
  if (!text) return out;
  const Json uri = uri_of(path);
  const Json top = range_of(*text, 0, 0, workspace.encoding);
  const bool test = runtime::named_test(path);
  const auto lines = lines_of(*text);
  bool expects = test;
  for (const TomlTable& table : tables_of(lines)) {
    expects = expects || table.name == "expect";
    if (!test || table.name != "case") continue;
    for (size_t n = table.first; n < table.end; ++n)
      if (key_of(lines[n]) == "name")
        out.push_back(run_lens(of_row(workspace, *text, lines[table.first]), "Test", "ipos.test",
                               {uri, std::string(value_of(lines[n]))}));
  }
  if (!test) {
    out.push_back(run_lens(top, "Run", "ipos.run", {uri}));
    out.push_back(run_lens(top, "Debug", "ipos.debug", {uri}));
  }
  if (expects) out.push_back(run_lens(top, "Test", "ipos.test", {uri}));
  return out;
}

}  // namespace ipos::tools::lsp

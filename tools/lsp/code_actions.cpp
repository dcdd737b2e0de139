// Mends as edits: those that are certain (mends.hpp), and "did you mean": the message names what is meant, and what stands
// there instead is the misspelt word.
#include <fmt/format.h>

#include <algorithm>

#include "stdlib/spelling.hpp"
#include "tools/lsp/marks.hpp"
#include "tools/lsp/mends.hpp"
#include "tools/lsp/plant_document.hpp"

namespace ipos::tools::lsp {
namespace {

// The text between the first two quotes after `label`; empty without.
std::string quoted_behind(std::string_view text, std::string_view label) {
  const size_t at = text.find(label);
  if (at == std::string_view::npos) return {};
  const size_t begin = text.find('\'', at);
  if (begin == std::string_view::npos) return {};
  const size_t end = text.find('\'', begin + 1);
  return end == std::string_view::npos ? std::string() : std::string(text.substr(begin + 1, end - begin - 1));
}

// What the message offers, also in its notes.
std::string offered(const Json& diagnostic) {
  constexpr std::string_view kOffer = "did you mean ";
  std::string meant = quoted_behind(diagnostic["message"].get_ref<const std::string&>(), kOffer);
  if (diagnostic.contains("relatedInformation"))
    for (const Json& note : diagnostic["relatedInformation"])
      if (meant.empty()) meant = quoted_behind(note["message"].get_ref<const std::string&>(), kOffer);
  return meant;
}

bool overlap(const Json& a, const Json& b) {
  const auto before = [](const Json& x, const Json& y) {
    return x["line"] != y["line"] ? x["line"] < y["line"] : x["character"] < y["character"];
  };
  return !before(a["end"], b["start"]) && !before(b["end"], a["start"]);
}

// The misspelt word: what the message quotes first, as far as it stands there; else what is most like the offer.
Json misspelt(std::string_view text, const Json& diagnostic, const std::string& meant, Encoding encoding) {
  const uint32_t begin = offset_of(text, diagnostic["range"]["start"], encoding);
  const uint32_t end = offset_of(text, diagnostic["range"]["end"], encoding);
  const std::string_view there = text.substr(begin, end - begin);
  const std::string named = quoted_behind(diagnostic["message"].get_ref<const std::string&>(), "");
  if (const size_t at = there.find(named); !named.empty() && named != meant && at != std::string_view::npos) {
    const auto first = begin + static_cast<uint32_t>(at);
    return range_of(text, first, first + static_cast<uint32_t>(named.size()), encoding);
  }
  const bool word = std::all_of(there.begin(), there.end(), [](char c) { return is_word(c) || c == '#'; });
  return word && !there.empty() ? diagnostic["range"] : Json(nullptr);
}

Json quick_fix(const Json& diagnostic, const std::string& uri, const Json& range, const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  return {{"title", text.empty() ? "Leave it out" : fmt::format("Write '{}'{}", line, line == text ? "" : " ...")},
          {"kind", "quickfix"},
          {"diagnostics", {diagnostic}},
          {"isPreferred", true},
          {"edit", {{"changes", {{uri, {{{"range", range}, {"newText", text}}}}}}}}};
}

// "known are a, b, c": the list, and of these the one that is most like the word.
std::string nearest_known(std::string_view message, std::string_view word) {
  constexpr std::string_view kKnown = "known are ";
  const size_t at = message.find(kKnown);
  if (at == std::string_view::npos) return {};
  std::string_view list = message.substr(at + kKnown.size());
  std::vector<std::string_view> known;
  while (!list.empty()) {
    const size_t comma = std::min(list.find(", "), list.size());
    known.push_back(list.substr(0, comma));
    list.remove_prefix(std::min(comma + 2, list.size()));
  }
  return std::string(stdlib::nearest(word, known));
}

}  // namespace

Json code_actions(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const std::string path = document_path(params);
  const auto text = workspace.text(path);
  if (!text || !params.contains("range")) return out;
  const auto all = diagnostics_of(workspace, workspace.program(path));
  const auto own = all.find(path);
  if (own == all.end()) return out;
  for (const Json& diagnostic : own->second) {
    if (!overlap(diagnostic["range"], params["range"])) continue;
    if (const auto mend = mend_of(*text, diagnostic, workspace.encoding))
      out.push_back(quick_fix(diagnostic, uri_of(path), range_of(*text, mend->begin, mend->end, workspace.encoding), mend->text));
    const std::string meant = offered(diagnostic);
    if (meant.empty()) continue;
    const Json range = misspelt(*text, diagnostic, meant, workspace.encoding);
    if (!range.is_null()) out.push_back(quick_fix(diagnostic, uri_of(path), range, meant));
  }
  return out;
}

// The readers say what is known in the place; the nearest of that is meant.
Json plant_code_actions(Workspace& workspace, const Json& params) {
  Json out = Json::array();
  const std::string path = document_path(params);
  const auto text = workspace.text(path);
  if (!text || !params.contains("range")) return out;
  for (const Json& diagnostic : plant_diagnostics(workspace, path)) {
    if (!overlap(diagnostic["range"], params["range"])) continue;
    const std::string& message = diagnostic["message"].get_ref<const std::string&>();
    const std::string word = quoted_behind(message, "");
    const std::string meant = word.empty() ? "" : nearest_known(message, word);
    if (meant.empty()) continue;
    const Json range = misspelt(*text, diagnostic, meant, workspace.encoding);
    if (!range.is_null()) out.push_back(quick_fix(diagnostic, uri_of(path), range, meant));
  }
  return out;
}

}  // namespace ipos::tools::lsp

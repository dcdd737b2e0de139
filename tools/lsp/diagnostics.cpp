// Messages of the compiler for the editor, and formatting, which has a message, too.
#include <algorithm>
#include <map>

#include "compiler/diag/once.hpp"
#include "compiler/diag/places.hpp"
#include "compiler/format/format.hpp"
#include "tools/lsp/features.hpp"
#include "tools/lsp/toml_lines.hpp"

namespace ipos::tools::lsp {
namespace {

using compiler::Diagnostic;
using compiler::Severity;

// Places of one program, which may be thousands. Lines of the compiler end with LF; the editor takes a CR alone for the
// end of a line, too, and after the first of those the text is counted again for each place.
class Ranges {
 public:
  explicit Ranges(Encoding encoding) : encoding_(encoding) {}

  Json of(const compiler::Range& place) {
    if (place.begin.file == nullptr) return range_of("", 0, 0, encoding_);
    const compiler::SourceFile& file = *place.begin.file;
    const auto offset = [&](const compiler::Position& at) {
      return file.line_starts[at.line - 1] + at.column - 1;
    };
    if (first_lone_cr(file) < offset(place.end))
      return range_of(file.text, offset(place.begin), offset(place.end), encoding_);
    return {{"start", position(file, place.begin)}, {"end", position(file, place.end)}};
  }

 private:
  Json position(const compiler::SourceFile& file, const compiler::Position& at) const {
    const std::string_view line = compiler::SourceMap::line_text(file, at.line);
    const auto column = std::min<size_t>(at.column - 1, line.size());
    Json json = position_of(line, static_cast<uint32_t>(column), encoding_);
    json["line"] = at.line - 1;
    return json;
  }
  size_t first_lone_cr(const compiler::SourceFile& file) {
    const auto [known, fresh] = lone_.try_emplace(&file, std::string::npos);
    size_t& at = known->second;
    if (!fresh) return at;
    at = file.text.find('\r');
    while (at != std::string::npos && file.text.compare(at, 2, "\r\n") == 0) at = file.text.find('\r', at + 2);
    return at;
  }

  Encoding encoding_;
  std::map<const compiler::SourceFile*, size_t> lone_;
};

std::string clean(const compiler::SourceFile& file) {
  return file.path.empty() ? file.name : tidy(file.path);
}

int severity_number(Severity severity) {
  return severity == Severity::Error ? 1 : severity == Severity::Warning ? 2 : 3;  // 3: information
}

Json message(const Diagnostic& diagnostic, const Program& program, Ranges& ranges) {
  const compiler::SourceMap& map = *program.compiled.sources;
  const compiler::DiagInfo& row = compiler::info(diagnostic.diag);
  Json out{{"range", ranges.of(compiler::range_of(diagnostic.span, map))},
           {"severity", severity_number(diagnostic.severity)},
           {"code", row.code},
           {"source", "ipos"}};
  std::string text = diagnostic.text;
  for (const compiler::Note& note : compiler::all_notes(diagnostic, map)) {
    const compiler::Range place = compiler::range_of(note.span, map);
    if (place.begin.file == nullptr)
      text += "\n" + note.text;
    else
      out["relatedInformation"].push_back(
          {{"location",
            {{"uri", uri_of(clean(*place.begin.file))}, {"range", ranges.of(place)}}},
           {"message", compiler::printable(note.text)}});
  }
  // Notes of several lines stay several lines.
  std::string shown;
  for (size_t begin = 0; begin <= text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    shown +=
        (begin == 0 ? "" : "\n") + compiler::printable(std::string_view(text).substr(begin, end - begin));
    begin = end + 1;
  }
  out["message"] = shown;
  if (row.flag.starts_with("unused")) out["tags"] = {1};  // shown faded
  return out;
}

constexpr size_t kMostUses = 20;  // of a macro that a message lists
constexpr int kHint = 4;          // a mark in the text, no row in a list of problems

Json related(const compiler::Range& place, Ranges& ranges, const std::string& text) {
  return {{"location", {{"uri", uri_of(clean(*place.begin.file))}, {"range", ranges.of(place)}}}, {"message", text}};
}

// What is mended in one place is one message. Of a macro it stands at the first use and leads to the others, which are marked;
// what came again in the same place (a header that is included twice) is not there at all.
void add_uses(const compiler::Repeats& same, const Program& program, Ranges& ranges, Json& first, std::vector<Json>& marks) {
  const compiler::SourceMap& map = *program.compiled.sources;
  const auto& all = program.compiled.diagnostics.all();
  const auto range = [&](size_t n) { return compiler::range_of(all[n].span, map); };
  const compiler::Range here = range(same.first);
  for (size_t n = 0; n < same.elsewhere.size(); ++n) {
    const compiler::Range use = range(same.elsewhere[n]);
    if (use.begin.file == nullptr) continue;
    if (n < kMostUses) first["relatedInformation"].push_back(related(use, ranges, "the same in this use of the macro"));
    Json mark = message(all[same.elsewhere[n]], program, ranges);
    mark["severity"] = kHint;
    mark["relatedInformation"] = Json::array();
    if (here.begin.file != nullptr)
      mark["relatedInformation"].push_back(related(here, ranges, "told here for all uses of the macro"));
    marks.push_back(std::move(mark));
  }
}

}  // namespace

std::map<std::string, Json> diagnostics_of(const Workspace& workspace, const Program& program) {
  std::map<std::string, Json> out{{program.path, Json::array()}};
  for (const std::string& file : program.files) out.emplace(file, Json::array());
  const bool header = !is_program(program.path);
  Ranges ranges(workspace.encoding);
  const auto& diagnostics = program.compiled.diagnostics.all();
  for (const compiler::Repeats& same : compiler::repeats_of(diagnostics, *program.compiled.sources)) {
    const Diagnostic& diagnostic = diagnostics[same.first];
    // A header on its own has no main() and uses nothing of what it declares.
    if (header && (diagnostic.severity != Severity::Error || diagnostic.diag == compiler::Diag::NoMain))
      continue;
    const auto path_of_message = [&](size_t n) {
      const compiler::Position at = program.compiled.sources->position(diagnostics[n].span.begin);
      return at.file == nullptr || at.file->path.empty() ? program.path : clean(*at.file);
    };
    Json first = message(diagnostic, program, ranges);
    std::vector<Json> marks;
    add_uses(same, program, ranges, first, marks);
    out[path_of_message(same.first)].push_back(std::move(first));
    for (size_t n = 0; n < marks.size(); ++n) out[path_of_message(same.elsewhere[n])].push_back(std::move(marks[n]));
  }
  return out;
}

Json diagnostics_of(const Workspace& workspace, const std::string& path, const std::vector<Survivor>& survivors) {
  Json out = Json::array();
  const auto text = survivors.empty() ? std::nullopt : workspace.text(path);
  if (!text) return out;
  const auto lines = lines_of(*text);
  for (const Survivor& one : survivors) {
    if (one.line == 0 || one.line > lines.size() || one.column == 0) continue;
    const std::string_view row = lines[one.line - 1];
    const size_t begin = std::min<size_t>(one.column - 1, row.size());
    size_t end = begin;
    while (end < row.size() && is_word(row[end])) ++end;
    if (end == begin && end < row.size()) ++end;
    const auto start = static_cast<uint32_t>(row.data() - text->data());
    out.push_back({{"range", range_of(*text, start + static_cast<uint32_t>(begin), start + static_cast<uint32_t>(end), workspace.encoding)},
                   {"severity", 3},
                   {"code", "mutate"},
                   {"source", "ipos test"},
                   {"message", compiler::printable((one.reached ? "no test notices: " : "no test reaches: ") + one.text)}});
  }
  return out;
}

Json formatting(Workspace& workspace, const Json& params) {
  const std::string path = document_path(params);
  const auto before = workspace.text(path);
  if (!before) throw RequestError(ErrorCode::InvalidParams, path + " cannot be read");
  const auto after = compiler::format_source(*before);
  if (!after)
    throw RequestError(ErrorCode::RequestFailed, "line " + std::to_string(after.error().line) +
                                                     ": not formatted: " + after.error().text);
  Json edits = Json::array();
  if (*after == *before) return edits;
  // One edit of the lines that differ, so that the cursor elsewhere stays where it is.
  size_t head = 0;
  const size_t shorter = std::min(before->size(), after->size());
  while (head < shorter && (*before)[head] == (*after)[head]) ++head;
  head = head == 0 ? 0 : before->rfind('\n', head - 1) + 1;
  size_t tail = 0;
  while (tail < shorter - head && (*before)[before->size() - 1 - tail] == (*after)[after->size() - 1 - tail])
    ++tail;
  // Not within a line, nor within a character, nor within CR LF.
  const auto is_end = [&](size_t left) {
    const auto begins = [left](const std::string& text) {
      return text[text.size() - left] == '\r' ||
             (text[text.size() - left] == '\n' && (left == text.size() || text[text.size() - left - 1] != '\r'));
    };
    return begins(*before) && begins(*after);
  };
  while (tail > 0 && !is_end(tail)) --tail;
  edits.push_back({{"range", range_of(*before, static_cast<uint32_t>(head),
                                      static_cast<uint32_t>(before->size() - tail), workspace.encoding)},
                   {"newText", after->substr(head, after->size() - tail - head)}});
  return edits;
}

}  // namespace ipos::tools::lsp

// Assembler: reads line by line, matches operands against the templates of vm/isa/opcodes.def, then fills in
// the labels.
#include "compiler/asm/assembler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>

#include "compiler/asm/reader.hpp"
#include "compiler/asm/text_forms.hpp"
#include "stdlib/unit_names.hpp"
#include "stdlib/unit_names.hpp"

namespace ipos::compiler {
namespace {

using vm::OperandKind;

// A place in the code: @number, or the label of that number, not yet known.
struct Target {
  bool label = false;
  uint64_t number = 0;
  Span span;
};

// What a line of operands gave when matched against one template.
struct Match {
  bool ok = false;
  size_t at = 0;         // furthest place reached
  std::string expected;  // there
  std::string range;     // set when a number there was beyond what the command can hold
  vm::Instruction command;
  std::optional<Target> target;
};


bool same_word(std::string_view a, std::string_view b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

// The whole word of a template around a place, or the sign there.
std::string_view word_at(std::string_view form, size_t at) {
  const auto letter = [&](size_t n) {
    return n < form.size() && lower(form[n]) >= 'a' && lower(form[n]) <= 'z';
  };
  if (!letter(at)) return form.substr(at, 1);
  size_t begin = at;
  size_t end = at;
  while (begin > 0 && letter(begin - 1)) --begin;
  while (letter(end)) ++end;
  return form.substr(begin, end - begin);
}

const char* kind_text(OperandKind kind) {
  switch (kind) {
    case OperandKind::Variable: return "a variable";
    case OperandKind::Constant: return "a constant";
    case OperandKind::Bit: return "a bit number";
    case OperandKind::Count: return "a count";
    case OperandKind::Label: return "a label";
    default: return "a keyword";
  }
}

std::string keyword_list(std::string_view set) {
  std::string out;
  for (const vm::KeywordInfo& row : vm::keyword_table())
    if (row.set == set) out += (out.empty() ? "" : ", ") + std::string(row.text);
  return out;
}

class Assembler {
 public:
  Assembler(const SourceFile& source, Diagnostics& diagnostics) : file_(source), diagnostics_(diagnostics) {}

  std::optional<vm::Image> run() {
    image_.unit = stdlib::usual_unit().code;
    const std::string_view text = file_.text;
    for (size_t begin = 0; begin < text.size();) {
      const size_t end = std::min(text.find('\n', begin), text.size());
      LineReader line(without_comment(text.substr(begin, end - begin)), begin);
      read_line(line);
      begin = end + 1;
    }
    resolve();
    if (!failed_) check_tables();
    if (failed_) return std::nullopt;
    return std::move(image_);
  }

 private:
  struct Reference {
    Target target;
    bool function = false;  // a row of Image::functions, else a code word
    size_t place = 0;
  };

  static std::string_view without_comment(std::string_view line) {
    bool quotes = false;
    for (size_t at = 0; at < line.size(); ++at) {
      if (line[at] == '\\' && quotes)
        ++at;
      else if (line[at] == '"')
        quotes = !quotes;
      else if (line[at] == ';' && !quotes)
        return line.substr(0, at);
    }
    return line;
  }

  Span span(size_t begin, size_t end) const {
    const auto place = [&](size_t at) { return Location{file_.base + static_cast<uint32_t>(at)}; };
    return {place(begin), place(std::max(end, begin + 1))};
  }

  void error(Diag diag, Span at, std::vector<std::string> args) {
    diagnostics_.report(diag, at, std::move(args));
    failed_ = true;
  }

  void read_line(LineReader& line) {
    while (true) {
      if (line.done()) return;
      const size_t begin = line.at();
      const auto label = read_label(line);
      if (!label || !line.text(":")) {
        line.go(begin);
        break;
      }
      const auto address = static_cast<uint32_t>(image_.code.size());
      if (!labels_.emplace(label->number, address).second)
        error(Diag::AsmLabelTwice, label->span, {fmt::format("M{:02}", label->number)});
    }
    if (line.text(".")) return directive(line);
    command(line);
  }

  std::optional<Target> read_label(LineReader& line) {
    const size_t begin = line.at();
    line.skip_space();
    const size_t file_begin = line.file_offset();
    if (!line.text("m")) return std::nullopt;
    const auto number = line.decimal();
    if (!number) return line.go(begin), std::nullopt;
    return Target{true, *number, span(file_begin, line.file_offset())};
  }

  std::optional<Target> read_target(LineReader& line) {
    const size_t begin = line.at();
    line.skip_space();
    const size_t file_begin = line.file_offset();
    if (!line.text("@")) return read_label(line);
    const auto number = line.decimal();
    if (!number || *number > UINT32_MAX) return line.go(begin), std::nullopt;
    return Target{false, *number, span(file_begin, line.file_offset())};
  }

  void command(LineReader& line) {
    line.skip_space();
    const size_t begin = line.file_offset();
    const std::string_view mnemonic = line.word();
    const Span name_span = span(begin, line.file_offset());
    if (same_word(mnemonic, "REM")) return;
    if (same_word(mnemonic, "WORD")) return word(line);

    const size_t operands = line.at();
    Match best;
    bool known = false;
    for (const vm::OpcodeInfo& row : vm::opcode_table()) {
      if (!same_word(mnemonic, row.mnemonic())) continue;
      line.go(operands);
      Match match = match_form(row, line);
      if (match.ok) return emit(match);
      if (!known || match.at > best.at || (match.at == best.at && !match.range.empty()))
        best = std::move(match);
      else if (match.at == best.at && best.expected.find(match.expected) == std::string::npos)
        best.expected += " or " + match.expected;
      known = true;
    }
    if (!known) {
      const std::string text =
          mnemonic.empty() ? std::string(line.rest().substr(0, 1)) : std::string(mnemonic);
      return error(Diag::AsmUnknownCommand, name_span, {text});
    }
    line.go(best.at);
    line.skip_space();
    const Span at = span(line.file_offset(), line.file_offset() + 1);
    if (!best.range.empty()) return error(Diag::AsmNumberRange, at, {best.range});
    error(Diag::AsmOperand, at, {std::string(mnemonic), best.expected});
  }

  Match match_form(const vm::OpcodeInfo& row, LineReader& line) {
    Match match;
    match.command.opcode = row.opcode;
    const std::string_view form = row.text;
    size_t operand = 0;
    int small = 0;
    for (size_t at = std::min(form.find(' '), form.size()); at < form.size(); ++at) {
      if (form[at] == ' ') continue;
      match.at = line.at();
      if (form[at] != '{') {
        if (line.text(form.substr(at, 1))) continue;
        match.expected = fmt::format("`{}`", word_at(form, at));
        return match;
      }
      at = form.find('}', at);
      const vm::OperandInfo& info = row.operands[operand];
      const int32_t most = small < 2 ? 0xFFF : 0xFFFF;  // see vm/isa/isa.hpp, coding
      if (info.kind != OperandKind::Constant && info.kind != OperandKind::Label) ++small;
      if (!read_operand(line, info, most, match, operand++)) return match;
    }
    match.at = line.at();
    match.ok = line.done();
    match.expected = "the end of the line";
    return match;
  }

  bool read_operand(LineReader& line, const vm::OperandInfo& info, int32_t most, Match& match, size_t n) {
    int64_t value = 0;
    int64_t least = 0;
    int64_t highest = most;
    match.expected = kind_text(info.kind);
    switch (info.kind) {
      case OperandKind::Label: {
        match.target = read_target(line);
        return match.target.has_value();
      }
      case OperandKind::Constant: {
        const auto number = line.constant();
        if (!number) return false;
        value = *number;
        least = INT32_MIN;
        highest = UINT32_MAX;
        break;
      }
      case OperandKind::Keyword: {
        if (const vm::KeywordInfo* keyword = read_keyword(line, info.keyword_set)) {
          value = keyword->value;
          break;
        }
        match.expected = keyword_list(info.keyword_set);
        [[fallthrough]];
      }
      default: {
        const auto number = info.kind == OperandKind::Variable ? line.variable() : line.decimal();
        if (!number) return false;
        value = static_cast<int64_t>(std::min<uint64_t>(*number, INT32_MAX));
      }
    }
    if (value < least || value > highest) {
      match.range = info.kind == OperandKind::Constant
                        ? "-2147483648 to 2147483647, in hexadecimal or binary up to 0xFFFFFFFF"
                        : fmt::format("{} to {}", least, highest);
      return false;
    }
    match.command.operands[n] = static_cast<int32_t>(static_cast<uint32_t>(value));
    return true;
  }

  // The longest keyword that fits: "ENABLE 1" begins "ENABLE 1 RISING".
  static const vm::KeywordInfo* read_keyword(LineReader& line, std::string_view set) {
    const size_t begin = line.at();
    const vm::KeywordInfo* best = nullptr;
    size_t end = begin;
    for (const vm::KeywordInfo& row : vm::keyword_table()) {
      if (row.set != set) continue;
      line.go(begin);
      if (line.whole(row.text) && line.at() > end) {
        best = &row;
        end = line.at();
      }
    }
    line.go(end);
    return best;
  }

  void emit(const Match& match) {
    std::array<uint32_t, vm::kMaxWords> words{};
    const uint32_t count = vm::encode(match.command, words);
    const vm::OpcodeInfo& row = vm::info(match.command.opcode);
    if (match.target) {
      // Constants and labels stand at the end of a command, in order; the label is the last of them.
      references_.push_back({*match.target, false, image_.code.size() + static_cast<size_t>(row.words) - 1});
    }
    image_.code.insert(image_.code.end(), words.begin(), words.begin() + count);
  }

  void word(LineReader& line) {
    const size_t begin = line.file_offset();
    const auto value = line.constant();
    if (!value || *value < INT32_MIN || *value > UINT32_MAX || !line.done())
      return error(Diag::AsmOperand, span(begin, line.file_offset()), {"WORD", "a constant of 32 bits"});
    image_.code.push_back(static_cast<uint32_t>(*value));
  }

  void directive(LineReader& line) {
    const size_t begin = line.file_offset() - 1;
    const std::string name(line.word());
    const Span name_span = span(begin, line.file_offset());
    const char* form = nullptr;
    bool ok = false;
    if (name == "unit") {
      form = "unit TYPE, once";
      ok = unit(line);
    } else if (name == "file") {
      form = "file NAME";
      const auto file = line.name();
      ok = file && line.done();
      if (ok) image_.files.push_back(*file);
    } else if (name == "symbol") {
      form = "symbol Hn NAME [COUNT]";
      ok = symbol(line);
      if (ok) symbol_spans_.push_back(name_span);
    } else if (name == "function") {
      form = "function NAME LABEL";
      const auto function = line.name();
      const auto target = function ? read_target(line) : std::nullopt;
      ok = target && line.done();
      if (ok) {
        references_.push_back({*target, true, image_.functions.size()});
        image_.functions.push_back({*function, 0});
        function_spans_.push_back(name_span);
      }
    } else if (name == "line") {
      form = "line [@ADDRESS] FILE LINE COLUMN";
      ok = line_entry(line);
      if (ok) line_spans_.push_back(name_span);
    } else {
      return error(Diag::AsmUnknownDirective, name_span, {name});
    }
    if (!ok) error(Diag::AsmDirective, name_span, {form});
  }

  bool unit(LineReader& line) {
    line.skip_space();
    const size_t begin = line.file_offset();
    const auto name = line.name();
    if (!name || !line.done() || unit_set_) return false;
    unit_set_ = true;
    LineReader digits(*name, 0);
    const auto code = digits.decimal();
    if (code && digits.done() && *code <= 0xFF) {
      image_.unit = static_cast<uint8_t>(*code);
    } else if (const stdlib::UnitType* row = stdlib::find_unit(std::string_view(*name))) {
      image_.unit = row->code;
    } else {
      error(Diag::AsmUnknownUnit, span(begin, begin + name->size()), {*name, stdlib::unit_names()});
    }
    return true;
  }

  bool symbol(LineReader& line) {
    const auto variable = line.variable();
    if (!variable || *variable > 0xFFFF) return false;
    const auto name = line.name();
    if (!name) return false;
    uint64_t count = 1;
    if (!line.done()) {
      const auto number = line.decimal();
      if (!number || *number == 0 || *number > 0xFFFF || !line.done()) return false;
      count = *number;
    }
    image_.symbols.push_back({*name, static_cast<uint16_t>(*variable), static_cast<uint16_t>(count)});
    return true;
  }

  bool line_entry(LineReader& line) {
    uint64_t address = image_.code.size();
    if (line.text("@")) {
      const auto number = line.decimal();
      if (!number) return false;
      address = *number;
    }
    const auto file = line.decimal();
    const auto row = line.decimal();
    const auto column = line.decimal();
    if (!file || !row || !column || !line.done()) return false;
    if (address > UINT32_MAX || *file > 0xFFFF || *row > UINT32_MAX || *column > 0xFFFF) return false;
    image_.lines.push_back({static_cast<uint32_t>(address), static_cast<uint16_t>(*file),
                            static_cast<uint32_t>(*row), static_cast<uint16_t>(*column)});
    return true;
  }

  void resolve() {
    for (const Reference& reference : references_) {
      auto address = static_cast<uint32_t>(reference.target.number);
      if (reference.target.label) {
        const auto found = labels_.find(reference.target.number);
        if (found == labels_.end()) {
          error(Diag::AsmNoLabel, reference.target.span, {fmt::format("M{:02}", reference.target.number)});
          continue;
        }
        address = found->second;
      }
      if (reference.function)
        image_.functions[reference.place].address = address;
      else
        image_.code[reference.place] = address;
    }
  }

  // What the image's reader will demand of its tables (docs/reference/isa.md).
  void check_tables() {
    const stdlib::UnitType* unit = stdlib::find_unit(image_.unit);
    for (size_t n = 0; n < image_.symbols.size() && unit != nullptr && unit->tasks != 0; ++n)
      if (image_.symbols[n].variable + image_.symbols[n].count > unit->variables)
        error(Diag::AsmNumberRange, symbol_spans_[n],
              {fmt::format("of variables that the unit has, up to H{}", unit->variables - 1)});
    for (size_t n = 0; n < image_.functions.size(); ++n)
      if (image_.functions[n].address >= image_.code.size())
        error(Diag::AsmNumberRange, function_spans_[n], {"the address of a code word"});
    for (size_t n = 0; n < image_.lines.size(); ++n) {
      const vm::LineEntry& entry = image_.lines[n];
      if (entry.file >= image_.files.size())
        error(Diag::AsmNumberRange, line_spans_[n], {"that of a .file directive, counted from 0"});
      else if (entry.address >= image_.code.size() || (n > 0 && entry.address < image_.lines[n - 1].address))
        error(Diag::AsmNumberRange, line_spans_[n],
              {"the address of a code word, not before that of the last .line"});
    }
  }

  const SourceFile& file_;
  Diagnostics& diagnostics_;
  vm::Image image_;
  std::vector<Span> symbol_spans_;
  std::vector<Span> function_spans_;
  std::vector<Span> line_spans_;
  std::map<uint64_t, uint32_t> labels_;
  std::vector<Reference> references_;
  bool unit_set_ = false;
  bool failed_ = false;
};

}  // namespace

std::optional<vm::Image> assemble(const SourceFile& source, Diagnostics& diagnostics) {
  return Assembler(source, diagnostics).run();
}

}  // namespace ipos::compiler

// Disassembler and listing. Whatever an image holds is written down, in its order, so that nothing is lost.
#include "compiler/asm/disassembler.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "compiler/asm/text_forms.hpp"
#include "stdlib/system_variables.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::compiler {
namespace {

// Numbers M01.. of the addresses that are jumped to, in rising order of address. An address in the middle of
// a command has no label; it is written @address.
class Labels {
 public:
  Labels(const vm::Image& image, const std::vector<CodeItem>& items) {
    std::vector<uint32_t> starts;
    for (const CodeItem& item : items) starts.push_back(item.address);
    starts.push_back(static_cast<uint32_t>(image.code.size()));
    const auto use = [&](uint32_t address) {
      if (std::binary_search(starts.begin(), starts.end(), address)) addresses_.push_back(address);
    };
    for (const vm::FunctionEntry& function : image.functions) use(function.address);
    for (const CodeItem& item : items)
      if (item.command)
        if (const auto label = label_operand(*item.command)) use(*label);
    std::sort(addresses_.begin(), addresses_.end());
    addresses_.erase(std::unique(addresses_.begin(), addresses_.end()), addresses_.end());
  }

  bool at(uint32_t address) const {
    return std::binary_search(addresses_.begin(), addresses_.end(), address);
  }

  std::string text(uint32_t address) const {
    if (!at(address)) return fmt::format("@{}", address);
    const auto found = std::lower_bound(addresses_.begin(), addresses_.end(), address);
    return fmt::format("M{:02}", found - addresses_.begin() + 1);
  }

 private:
  std::vector<uint32_t> addresses_;
};

std::string item_text(const vm::Image& image, const CodeItem& item, const Labels& labels,
                      VariableNames names) {
  if (!item.command) return fmt::format("WORD 0x{:08X}", image.code[item.address]);
  const auto label = label_operand(*item.command);
  return command_text(*item.command, label ? labels.text(*label) : std::string(), names);
}

std::string line_directive(const vm::LineEntry& entry, bool here) {
  if (here) return fmt::format(".line {} {} {}\n", entry.file, entry.line, entry.column);
  return fmt::format(".line @{} {} {} {}\n", entry.address, entry.file, entry.line, entry.column);
}

std::string header(const vm::Image& image, const Labels& labels) {
  std::string out;
  const stdlib::UnitType* unit = stdlib::find_unit(image.unit);
  out += unit != nullptr ? fmt::format(".unit {}\n", unit->name) : fmt::format(".unit {}\n", image.unit);
  for (const std::string& file : image.files) out += fmt::format(".file {}\n", in_quotes(file));
  for (const vm::Symbol& symbol : image.symbols) {
    out += fmt::format(".symbol H{} {}", symbol.variable, in_quotes(symbol.name));
    if (symbol.count != 1) out += fmt::format(" {}", symbol.count);
    out += '\n';
  }
  for (const vm::FunctionEntry& function : image.functions)
    out += fmt::format(".function {} {}\n", in_quotes(function.name), labels.text(function.address));
  return out;
}

std::string variable_text(int32_t number, VariableNames names) {
  if (names != VariableNames::Numbers && number <= 0xFFFF) {
    if (const auto* row = stdlib::find_system_variable(static_cast<uint16_t>(number)))
      return std::string(names == VariableNames::Assembler ? row->assembler_name : row->compiler_name);
  }
  return fmt::format("H{}", number);
}

}  // namespace

std::vector<CodeItem> code_items(std::span<const uint32_t> code) {
  std::vector<CodeItem> items;
  for (uint32_t address = 0; address < code.size();) {
    const vm::Decoded decoded = vm::decode(code, address);
    CodeItem item{address, 1, std::nullopt};
    if (decoded.status == vm::DecodeStatus::Ok) {
      item.words = decoded.words;
      item.command = decoded.instruction;
    }
    items.push_back(item);
    address += item.words;
  }
  return items;
}

std::string command_text(const vm::Instruction& command, std::string_view label, VariableNames names) {
  const vm::OpcodeInfo& row = vm::info(command.opcode);
  std::string out;
  size_t operand = 0;
  for (size_t at = 0; at < row.text.size(); ++at) {
    if (row.text[at] != '{') {
      out += row.text[at];
      continue;
    }
    at = row.text.find('}', at);
    const vm::OperandInfo& info = row.operands[operand];
    const int32_t value = command.operands[operand++];
    if (info.kind == vm::OperandKind::Variable) {
      out += variable_text(value, names);
    } else if (info.kind == vm::OperandKind::Label) {
      out += label;
    } else if (info.kind == vm::OperandKind::Keyword) {
      const vm::KeywordInfo* keyword = vm::find_keyword(info.keyword_set, value);
      out += keyword != nullptr ? std::string(keyword->text) : fmt::format("{}", value);
    } else {
      out += fmt::format("{}", value);
    }
  }
  return out;
}

std::string disassemble(const vm::Image& image, VariableNames names) {
  const std::vector<CodeItem> items = code_items(image.code);
  const Labels labels(image, items);
  std::string out = header(image, labels);

  // Line entries stand in front of the command they belong to. Where the table is not in order of address,
  // or points between commands, the entry names its address.
  const bool in_order =
      std::is_sorted(image.lines.begin(), image.lines.end(),
                     [](const vm::LineEntry& a, const vm::LineEntry& b) { return a.address < b.address; });
  auto entry = image.lines.begin();
  if (!in_order)
    for (; entry != image.lines.end(); ++entry) out += line_directive(*entry, false);
  for (const CodeItem& item : items) {
    for (; entry != image.lines.end() && entry->address < item.address + item.words; ++entry)
      out += line_directive(*entry, entry->address == item.address);
    const std::string label = labels.at(item.address) ? labels.text(item.address) + " : " : "";
    out += fmt::format("{:6}{}\n", label, item_text(image, item, labels, names));
  }
  for (; entry != image.lines.end(); ++entry) out += line_directive(*entry, false);
  const auto end = static_cast<uint32_t>(image.code.size());
  if (labels.at(end)) out += labels.text(end) + " :\n";
  return out;
}

std::string listing(const vm::Image& image, const SourceLines& source, VariableNames names) {
  const std::vector<CodeItem> items = code_items(image.code);
  const Labels labels(image, items);
  std::string out;
  auto entry = image.lines.begin();
  size_t file = SIZE_MAX;
  uint32_t line = 0;
  for (const CodeItem& item : items) {
    for (const vm::FunctionEntry& function : image.functions)
      if (function.address == item.address) out += fmt::format("\n{}:\n", function.name);
    for (; entry != image.lines.end() && entry->address < item.address + item.words; ++entry) {
      if (entry->file == file && entry->line == line) continue;
      file = entry->file;
      line = entry->line;
      const auto text = source ? source(file, line) : std::nullopt;
      const std::string_view name = file < image.files.size() ? std::string_view(image.files[file]) : "?";
      out += fmt::format("; {}:{}: {}\n", name, line, text.value_or(""));
    }
    std::string words;
    for (uint32_t n = 0; n < item.words; ++n) words += fmt::format("{:08X} ", image.code[item.address + n]);
    out += fmt::format("{:5}  {:36}  {:6}{}\n", item.address, words,
                       labels.at(item.address) ? labels.text(item.address) + " : " : "",
                       item_text(image, item, labels, names));
  }
  return out;
}

}  // namespace ipos::compiler

// The line table of an image cut into runs of one line each: where a run begins, a step stops.
#include "tools/debugger/code_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "vm/isa/coding.hpp"

namespace ipos::tools::debug {
namespace {

namespace fs = std::filesystem;

// Editors send whole paths, people type names: either matches the path the compiler was given.
bool same_file(std::string_view known, std::string_view asked) {
  if (known == asked) return true;
  if (!fs::path(asked).has_parent_path()) return fs::path(known).filename() == asked;
  std::error_code error;
  // Editors on Windows write drives in small letters, and names there have no case.
  if (fs::equivalent(fs::path(known), fs::path(asked), error)) return true;
  const auto whole = [&error](std::string_view path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return whole(known) == whole(asked);
}

}  // namespace

std::string SourcePlace::text() const {
  return line == 0 ? std::string() : fmt::format("{}:{}", fs::path(file).filename().string(), line);
}

CodeMap::CodeMap(const vm::Image& image)
    : image_(image),
      items_(compiler::code_items(image.code)),
      starts_(image.code.size(), image.lines.empty()) {
  const vm::LineEntry* last = nullptr;
  for (const vm::LineEntry& entry : image.lines) {
    if ((last == nullptr || last->line != entry.line || last->file != entry.file) &&
        entry.address < starts_.size())
      starts_[entry.address] = true;
    last = &entry;
  }
  for (const vm::FunctionEntry& entry : image.functions)
    if (entry.address < starts_.size()) starts_[entry.address] = true;
}

bool CodeMap::starts_line(uint32_t address) const { return address < starts_.size() && starts_[address]; }

bool CodeMap::is_command(uint32_t address) const {
  const auto found = std::lower_bound(items_.begin(), items_.end(), address,
                                      [](const auto& item, uint32_t at) { return item.address < at; });
  return found != items_.end() && found->address == address && found->command;
}

SourcePlace CodeMap::place(uint32_t address) const {
  const auto next =
      std::upper_bound(image_.lines.begin(), image_.lines.end(), address,
                       [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
  if (next == image_.lines.begin()) return {};
  const vm::LineEntry& entry = *(next - 1);
  return {image_.files[entry.file], entry.line, entry.column};
}

std::string_view CodeMap::function(uint32_t address) const {
  const auto next =
      std::upper_bound(image_.functions.begin(), image_.functions.end(), address,
                       [](uint32_t at, const vm::FunctionEntry& entry) { return at < entry.address; });
  return next == image_.functions.begin() ? std::string_view() : std::string_view((next - 1)->name);
}

std::optional<uint32_t> CodeMap::function_address(std::string_view name) const {
  for (const vm::FunctionEntry& entry : image_.functions)
    if (entry.name == name) return entry.address;
  return std::nullopt;
}

bool CodeMap::has_file(std::string_view file) const {
  return std::any_of(image_.files.begin(), image_.files.end(),
                     [&](const std::string& known) { return same_file(known, file); });
}

std::optional<uint32_t> CodeMap::address_of(std::string_view file, uint32_t line) const {
  const vm::LineEntry* best = nullptr;
  for (const vm::LineEntry& entry : image_.lines) {
    if (entry.line < line || !starts_line(entry.address) || (best != nullptr && best->line <= entry.line) ||
        !same_file(image_.files[entry.file], file))
      continue;
    best = &entry;
  }
  return best == nullptr ? std::nullopt : std::optional(best->address);
}

size_t CodeMap::item_at(uint32_t address) const {
  const auto next =
      std::upper_bound(items_.begin(), items_.end(), address,
                       [](uint32_t at, const compiler::CodeItem& item) { return at < item.address; });
  return next == items_.begin() ? 0 : static_cast<size_t>(next - items_.begin()) - 1;
}

std::string CodeMap::text(uint32_t address) const {
  if (items_.empty()) return {};
  const compiler::CodeItem& item = items_[item_at(address)];
  if (!item.command) return fmt::format("WORD {:08X}h", image_.code[item.address]);
  const vm::Coding& row = vm::coding(item.command->opcode);
  std::string label;
  for (uint8_t n = 0; n < row.operand_count; ++n)
    if (row.kinds[n] == vm::OperandKind::Label) label = fmt::format("{}", item.command->operands[n]);
  return compiler::command_text(*item.command, label, compiler::VariableNames::Compiler);
}

}  // namespace ipos::tools::debug

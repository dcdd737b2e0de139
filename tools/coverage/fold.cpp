// What the compiler has multiplied is put together again: a function with a copy for each task and interrupt
// that calls it, and the condition of a loop, which is tested before the loop and at its end.
#include "tools/coverage/fold.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <tuple>
#include <vector>

#include "compiler/asm/disassembler.hpp"
#include "compiler/asm/text_forms.hpp"
#include "stdlib/headers.hpp"

namespace ipos::tools::coverage {
namespace {

using compiler::CodeItem;
using vm::Flow;
using vm::Opcode;

// One copy of a function of the source. Copies have the same commands at the same offsets, except the
// temporaries in them; `first` is where the first one begins.
struct Copy {
  std::string_view name;
  uint32_t begin = 0;
  uint32_t first = 0;
};

class Fold {
 public:
  Fold(const vm::Image& image, std::span<const CommandCount> counts) : image_(image), counts_(counts) {
    for (const vm::FunctionEntry& entry : image.functions) {
      Copy copy{std::string_view(entry.name).substr(0, entry.name.find('@')), entry.address, entry.address};
      const auto same = std::find_if(copies_.begin(), copies_.end(),
                                     [&](const Copy& other) { return other.name == copy.name; });
      if (same != copies_.end()) copy.first = same->begin;
      copies_.push_back(copy);
    }
  }

  Coverage run() {
    for (const CodeItem& item : compiler::code_items(image_.code)) {
      const vm::LineEntry* entry = entry_of(item.address);
      if (!item.command || entry == nullptr) continue;
      add_line(item, *entry);
      if (is_condition(item)) add_condition(item, *entry);
    }
    for (const auto& [key, times] : lines_)
      out_.files[file(std::get<1>(key))].lines[std::get<2>(key)] += times;
    add_functions();
    // Blocks are no code of the program: they have tests of their own, and no file that a report could show.
    std::erase_if(out_.files, [](const auto& entry) { return stdlib::find_built_in_file(entry.first) != nullptr; });
    return std::move(out_);
  }

 private:
  // File, line and column; the operands of the first copy and what is compared, either way round.
  using Site = std::tuple<uint16_t, Place, Opcode, std::array<int32_t, vm::kMaxOperands>>;
  struct Known {
    Opcode opcode;  // as it was met first
    ConditionKey key;
  };

  const std::string& file(uint16_t number) const { return image_.files[number]; }

  const vm::LineEntry* entry_of(uint32_t address) const {
    const auto next =
        std::upper_bound(image_.lines.begin(), image_.lines.end(), address,
                         [](uint32_t at, const vm::LineEntry& entry) { return at < entry.address; });
    return next == image_.lines.begin() ? nullptr : &*(next - 1);
  }

  // Where a way leads, after jumps alone.
  Place place(uint32_t address) const {
    constexpr int kLongestChain = 64;  // a ring of jumps has no end
    for (int n = 0; n < kLongestChain && address < image_.code.size(); ++n) {
      const vm::Decoded command = vm::decode(image_.code, address);
      if (command.status != vm::DecodeStatus::Ok || command.instruction.opcode != Opcode::Jmp) break;
      address = *compiler::label_operand(command.instruction);
    }
    const vm::LineEntry* entry = entry_of(address);
    return entry == nullptr ? Place{} : Place{entry->line, entry->column};
  }

  // Number of the copy an address lies in; as many as there are: in none.
  size_t copy_of(uint32_t address) const {
    const auto next = std::upper_bound(copies_.begin(), copies_.end(), address,
                                       [](uint32_t at, const Copy& copy) { return at < copy.begin; });
    return next == copies_.begin() ? copies_.size() : static_cast<size_t>(next - copies_.begin()) - 1;
  }

  // A line was executed as often as that of its commands that was executed most; copies of it add up.
  void add_line(const CodeItem& item, const vm::LineEntry& entry) {
    uint64_t& times = lines_[{copy_of(item.address), entry.file, entry.line}];
    times = std::max(times, counts_[item.address].executed);
  }

  static bool is_condition(const CodeItem& item) {
    const vm::Instruction& command = *item.command;
    const Flow flow = vm::coding(command.opcode).flow;
    if (flow != Flow::Branch && flow != Flow::SystemCall) return false;
    constexpr int32_t kAlways = 0;  // SC_UC, a call like any other
    if (command.opcode == Opcode::SystemCall && command.operands[0] == kAlways) return false;
    return compiler::label_operand(command) != item.address + item.words;
  }

  // The same command in the first copy of its function.
  vm::Instruction first_of(const CodeItem& item) const {
    const size_t number = copy_of(item.address);
    if (number == copies_.size()) return *item.command;
    const Copy& copy = copies_[number];
    const vm::Decoded first = vm::decode(image_.code, item.address - copy.begin + copy.first);
    return first.status == vm::DecodeStatus::Ok && first.instruction.opcode == item.command->opcode
               ? first.instruction
               : *item.command;
  }

  void add_condition(const CodeItem& item, const vm::LineEntry& entry) {
    const Opcode opcode = item.command->opcode;
    const Place at{entry.line, entry.column};
    vm::Instruction first = first_of(item);
    first.operands[static_cast<size_t>(compiler::label_position(opcode))] = 0;
    auto [known, is_new] = sites_.try_emplace(
        Site{entry.file, at, std::min(opcode, vm::inverse(opcode)), first.operands}, Known{opcode, {}});
    auto& conditions = out_.files[file(entry.file)].conditions;
    if (is_new) {
      ConditionKey& key = known->second.key;
      key.at = at;
      while (conditions.contains(key)) ++key.number;
      conditions[key].ways = {
          {{place(item.address + item.words), 0}, {place(*compiler::label_operand(*item.command)), 0}}};
    }
    Condition& condition = conditions[known->second.key];
    const size_t on = opcode == known->second.opcode ? 0 : 1;
    const CommandCount& count = counts_[item.address];
    condition.ways[on].count += count.passed;
    condition.ways[1 - on].count += count.executed - count.passed;
  }

  void add_functions() {
    for (const Copy& copy : copies_) {
      const vm::LineEntry* entry = entry_of(copy.first);
      if (entry == nullptr || copy.begin >= counts_.size()) continue;
      Function& function = out_.files[file(entry->file)].functions[std::string(copy.name)];
      function.line = entry->line;
      function.count += counts_[copy.begin].entered;
    }
  }

  const vm::Image& image_;
  std::span<const CommandCount> counts_;
  std::vector<Copy> copies_;
  std::map<std::tuple<size_t, uint16_t, uint32_t>, uint64_t> lines_;  // by copy, file and line
  std::map<Site, Known> sites_;
  Coverage out_;
};

}  // namespace

Coverage fold(const vm::Image& image, std::span<const CommandCount> counts) {
  return Fold(image, counts).run();
}

}  // namespace ipos::tools::coverage

// Addresses, temporaries, line table: from the functions' commands to an image.
#include "compiler/codegen/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "compiler/codegen/roots.hpp"
#include "compiler/diag/places.hpp"
#include "stdlib/plain_text.hpp"

namespace ipos::compiler {
namespace {

class CodeLayout {
 public:
  CodeLayout(const checked::Program& program, const std::vector<FunctionCode>& functions,
         const stdlib::UnitType& unit, const SourceMap& sources, Diagnostics& diagnostics)
      : program_(program),
        functions_(functions),
        unit_(unit),
        sources_(sources),
        diagnostics_(diagnostics),
        instances_(functions, program.main) {}

  std::optional<GeneratedProgram> run() {
    for (const Command* command : instances_.lost_temporaries())
      diagnostics_.report(Diag::RecursionTemporary, command->span,
                          {program_.functions[command->reference->function].name});
    if (diagnostics_.has_errors()) return std::nullopt;
    check_temporaries();
    if (diagnostics_.has_errors()) return std::nullopt;
    give_addresses();
    out_.image.unit = unit_.code;
    out_.image.symbols = program_.symbols;
    for (size_t n = 0; n < instances_.all().size(); ++n) emit(n);
    describe_temporaries();
    return std::move(out_);
  }

 private:
  const NumberRange& range() const { return program_.ranges.temporaries; }

  void check_temporaries() {
    const uint32_t count = instances_.temporaries();
    const auto advice = [&] {
      return range_advice(RangeKind::Temporaries, count, program_.ranges, program_.named, unit_);
    };
    const Span main = program_.functions[program_.main].span;
    if (count > range().size()) {
      diagnostics_.report(Diag::TemporaryOverflow, main,
                          {fmt::format("{}", count), fmt::format("{}", range().low),
                           fmt::format("{}", range().high), fmt::format("{}", range().size()), advice()});
      return;
    }
    for (uint32_t n = range().low; n < range().low + count; ++n) {
      if (!program_.named.test(n)) continue;
      const auto raw = program_.raw_names.find(n);
      std::string use = "here by number";
      if (raw == program_.raw_names.end())
        for (const checked::MapEntry& row : program_.map)
          if (n >= row.number && n < row.number + row.count) use = fmt::format("by '{}'", row.name);
      diagnostics_.report(Diag::TemporaryTaken, raw == program_.raw_names.end() ? main : raw->second,
                          {fmt::format("{}", n), use, advice()});
      return;
    }
  }

  void give_addresses() {
    uint32_t address = 0;
    for (const Instance& instance : instances_.all()) {
      starts_.push_back(address);
      for (const Command& command : functions_[instance.function].commands)
        address += static_cast<uint32_t>(vm::info(command.instruction.opcode).words);
    }
    if (address <= unit_.program_words) return;
    Diagnostic& message = diagnostics_.report(
        Diag::ProgramTooLong, program_.functions[program_.main].span,
        {fmt::format("{}", address), std::string(unit_.name), fmt::format("{}", unit_.program_words)});
    for (Note& note : copies(address)) message.notes.push_back(std::move(note));
  }

  // The functions that stand more than once and take most words.
  std::vector<Note> copies(uint32_t end) const {
    struct Copies {
      uint32_t words = 0;
      size_t count = 0;
      std::string roots;
    };
    std::map<size_t, Copies> all;
    for (size_t n = 0; n < starts_.size(); ++n) {
      const Instance& instance = instances_.all()[n];
      Copies& function = all[instance.function];
      function.words += (n + 1 < starts_.size() ? starts_[n + 1] : end) - starts_[n];
      ++function.count;
      if (instance.root == Instances::kShared) continue;
      const std::string& root = program_.functions[instances_.roots()[instance.root].function].name;
      function.roots += (function.roots.empty() ? "" : ", ") + root;
    }
    std::erase_if(all, [](const auto& row) { return row.second.count < 2; });
    std::vector<std::pair<size_t, Copies>> rows(all.begin(), all.end());
    std::stable_sort(rows.begin(), rows.end(),
                     [](const auto& a, const auto& b) { return a.second.words > b.second.words; });
    constexpr size_t kShown = 5;
    if (rows.size() > kShown) rows.resize(kShown);
    std::vector<Note> notes;
    for (const auto& [function, row] : rows)
      notes.push_back({program_.functions[function].span,
                       fmt::format("'{}' stands {} times ({}): {} words", program_.functions[function].name,
                                   row.count, row.roots, row.words)});
    return notes;
  }

  void emit(size_t number) {
    const Instance& instance = instances_.all()[number];
    const FunctionCode& function = functions_[instance.function];
    vm::Image& image = out_.image;
    image.functions.push_back({instance_name(number), starts_[number]});

    std::vector<uint32_t> addresses;
    addresses.reserve(function.commands.size());
    uint32_t next = starts_[number];
    for (const Command& command : function.commands) {
      addresses.push_back(next);
      next += static_cast<uint32_t>(vm::info(command.instruction.opcode).words);
    }
    for (size_t n = 0; n < function.commands.size(); ++n) {
      const Command& command = function.commands[n];
      vm::Instruction instruction = command.instruction;
      const vm::OpcodeInfo& row = vm::info(instruction.opcode);
      for (size_t k = 0; k < static_cast<size_t>(row.operand_count); ++k) {
        int32_t& operand = instruction.operands[k];
        if (row.operands[k].kind == vm::OperandKind::Variable && is_temporary(operand))
          operand =
              static_cast<int32_t>(range().low + instances_.roots()[instance.root].first + instance.first) +
              operand - kTemporary;
        if (row.operands[k].kind != vm::OperandKind::Label) continue;
        if (command.label >= 0)
          operand = static_cast<int32_t>(addresses[function.labels[static_cast<size_t>(command.label)]]);
        else if (command.reference)
          operand = static_cast<int32_t>(starts_[instances_.target(instance, *command.reference)]);
      }
      add_line(addresses[n], command.span);
      std::array<uint32_t, vm::kMaxWords> words{};
      const uint32_t count = vm::encode(instruction, words);
      for (uint32_t k = 0; k < count; ++k) image.code.push_back(words[k]);
    }
  }

  // The first instance has the name of the function, further ones name their root, too.
  std::string instance_name(size_t number) {
    const Instance& instance = instances_.all()[number];
    const std::string& name = program_.functions[instance.function].name;
    const size_t earlier = named_[instance.function]++;
    if (earlier == 0) return name;
    std::string copy = name + "@" + program_.functions[instances_.roots()[instance.root].function].name;
    // One function may be several roots, say of two interrupts.
    for (const vm::FunctionEntry& entry : out_.image.functions)
      if (entry.name == copy) return fmt::format("{}@{}", copy, earlier + 1);
    return copy;
  }

  // The commands of a statement mostly stand in one line.
  Position position(Location at) {
    const SourceFile* file = place_.file;
    if (file != nullptr && !at.in_macro() && at.value >= file->base) {
      const uint32_t offset = at.value - file->base;
      const std::vector<uint32_t>& starts = file->line_starts;
      const uint32_t begin = starts[place_.line - 1];
      if (place_.line < starts.size() && offset >= begin && offset < starts[place_.line])
        return {file, place_.line, offset - begin + 1};
    }
    return place_ = sources_.position(at);
  }

  void add_line(uint32_t address, Span span) {
    const Position at = position(span.begin);
    if (at.file == nullptr) return;
    vm::Image& image = out_.image;
    auto file = std::find(files_.begin(), files_.end(), at.file);
    if (file == files_.end()) {
      // An image with other names would be refused; a program opened under such a name has none.
      image.files.push_back(stdlib::is_plain(at.file->name) ? at.file->name : printable(at.file->name));
      file = files_.insert(files_.end(), at.file);
    }
    const vm::LineEntry entry{address, static_cast<uint16_t>(file - files_.begin()), at.line,
                              static_cast<uint16_t>(std::min<uint32_t>(at.column, 0xFFFF))};
    if (!image.lines.empty()) {
      const vm::LineEntry& last = image.lines.back();
      const bool new_function = std::binary_search(starts_.begin(), starts_.end(), address);
      if (!new_function && last.file == entry.file && last.line == entry.line && last.column == entry.column)
        return;
    }
    image.lines.push_back(entry);
  }

  void describe_temporaries() {
    for (const Root& root : instances_.roots()) {
      if (root.count == 0) continue;
      const std::string& name = program_.functions[root.function].name;
      out_.temporaries.push_back({"(" + name + ")",
                                  "long",
                                  range().low + root.first,
                                  root.count,
                                  "temporaries",
                                  {name},
                                  {name},
                                  {}});
    }
  }

  const checked::Program& program_;
  const std::vector<FunctionCode>& functions_;
  const stdlib::UnitType& unit_;
  const SourceMap& sources_;
  Diagnostics& diagnostics_;
  Instances instances_;
  std::vector<uint32_t> starts_;    // address of each instance
  std::map<size_t, size_t> named_;  // instances of a function that have a name
  std::vector<const SourceFile*> files_;
  Position place_;  // the last one that was not in the line of that before
  GeneratedProgram out_;
};

}  // namespace

std::optional<GeneratedProgram> lay_out(const checked::Program& program,
                                        const std::vector<FunctionCode>& functions,
                                        const stdlib::UnitType& unit, const SourceMap& sources,
                                        Diagnostics& diagnostics) {
  return CodeLayout(program, functions, unit, sources, diagnostics).run();
}

}  // namespace ipos::compiler

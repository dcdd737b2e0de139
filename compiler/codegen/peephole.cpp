// Rules, applied until none fits any more:
//   T  jump to a JMP             -> jump to where that one leads
//   R  JMP to RET or END         -> RET or END
//   I  branch over a JMP         -> the inverse branch to the target of the JMP
//   N  jump to the next command  -> nothing (comparing changes nothing)
//   S  branch in front of a JMP to the same place -> nothing
//   U  command nobody reaches    -> nothing
#include "compiler/codegen/peephole.hpp"

#include <algorithm>

namespace ipos::compiler {
namespace {

using vm::Flow;
using vm::Opcode;

bool is_branch(const Command& command) { return vm::info(command.instruction.opcode).flow == Flow::Branch; }
bool is_jump(const Command& command) { return command.instruction.opcode == Opcode::Jmp; }

class Optimizer {
 public:
  explicit Optimizer(FunctionCode& code) : code_(code) {}

  // R comes last: it hides a JMP from rule I.
  void run() {
    do {
      do {
        changed_ = false;
        gone_.assign(code_.commands.size(), 0);
        thread_jumps();
        straighten();
        drop_unreached();
        compact();
      } while (changed_);
      end_at_once();
    } while (changed_);
  }

 private:
  size_t target(const Command& command) const { return code_.labels[static_cast<size_t>(command.label)]; }

  void thread_jumps() {
    for (Command& command : code_.commands) {
      if (command.label < 0) continue;
      // A ring of jumps has no end, and no program has long chains.
      int label = command.label;
      for (int step = 0; step < 64; ++step) {
        const Command& next = code_.commands[code_.labels[static_cast<size_t>(label)]];
        if (!is_jump(next) ||
            code_.labels[static_cast<size_t>(next.label)] == code_.labels[static_cast<size_t>(label)])
          break;
        label = next.label;
      }
      if (code_.labels[static_cast<size_t>(label)] != target(command) && !in_ring(label)) {
        command.label = label;
        changed_ = true;
      }
    }
  }

  void end_at_once() {
    for (Command& command : code_.commands) {
      if (!is_jump(command)) continue;
      const Opcode end = code_.commands[target(command)].instruction.opcode;
      if (end != Opcode::Ret && end != Opcode::End) continue;
      command.instruction.opcode = end;
      command.label = -1;
      changed_ = true;
    }
  }

  // Whether the label stands at a JMP: then the chain was a ring, which stays as it is.
  bool in_ring(int label) const {
    const Command& command = code_.commands[code_.labels[static_cast<size_t>(label)]];
    return is_jump(command) && target(command) != code_.labels[static_cast<size_t>(label)];
  }

  void straighten() {
    std::vector<char> is_target(code_.commands.size() + 1);
    for (const Command& command : code_.commands)
      if (command.label >= 0) is_target[target(command)] = 1;
    for (size_t n = 0; n < code_.commands.size(); ++n) {
      Command& command = code_.commands[n];
      if (command.label < 0 || gone_[n] != 0) continue;
      if (n + 2 < code_.commands.size() && is_branch(command) && target(command) == n + 2 &&
          is_jump(code_.commands[n + 1]) && is_target[n + 1] == 0) {
        command.instruction.opcode = vm::inverse(command.instruction.opcode);
        command.label = code_.commands[n + 1].label;
        gone_[n + 1] = 1;
      }
      const bool same_way = is_branch(command) && n + 1 < code_.commands.size() && gone_[n + 1] == 0 &&
                            is_jump(code_.commands[n + 1]) &&
                            target(code_.commands[n + 1]) == target(command);
      if (target(command) == n + 1 || same_way) gone_[n] = 1;
    }
  }

  void drop_unreached() {
    std::vector<char> reached(code_.commands.size());
    std::vector<size_t> open{0};
    while (!open.empty()) {
      const size_t at = open.back();
      open.pop_back();
      if (at >= code_.commands.size() || reached[at] != 0) continue;
      reached[at] = 1;
      const Command& command = code_.commands[at];
      const Flow flow = vm::info(command.instruction.opcode).flow;
      if (command.label >= 0 && gone_[at] == 0) open.push_back(target(command));
      if (gone_[at] != 0 || (flow != Flow::Jump && flow != Flow::Return && flow != Flow::End))
        open.push_back(at + 1);
    }
    for (size_t n = 0; n < reached.size(); ++n)
      if (reached[n] == 0) gone_[n] = 1;
  }

  void compact() {
    if (std::find(gone_.begin(), gone_.end(), 1) == gone_.end()) return;
    changed_ = true;
    std::vector<size_t> moved(code_.commands.size() + 1);
    size_t kept = 0;
    for (size_t n = 0; n < code_.commands.size(); ++n) {
      moved[n] = kept;
      if (gone_[n] != 0) continue;
      if (kept != n) code_.commands[kept] = std::move(code_.commands[n]);
      ++kept;
    }
    moved[code_.commands.size()] = kept;
    code_.commands.resize(kept);
    for (size_t& label : code_.labels) label = moved[label];
  }

  FunctionCode& code_;
  std::vector<char> gone_;
  bool changed_ = false;
};

}  // namespace

void optimize(FunctionCode& code) { Optimizer(code).run(); }

}  // namespace ipos::compiler

// Generates the commands of one function. Evaluation is left to right; where the order cannot be seen, the
// cheaper one is taken.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "compiler/codegen/code.hpp"
#include "compiler/codegen/linear.hpp"
#include "compiler/codegen/loops.hpp"
#include "compiler/sema/checked.hpp"

namespace ipos::compiler {

class FunctionGenerator {
 public:
  // `ends_task`: return is END instead of RET (main, unless something calls it).
  FunctionGenerator(const checked::Program& program, size_t function, bool ends_task, GenerateOptions options)
      : program_(program), function_(function), ends_task_(ends_task), options_(options) {}

  FunctionCode generate();

 private:
  // A constant, a variable or a temporary that holds a value.
  struct Operand {
    bool constant = false;
    int32_t value = 0;  // or the number of the variable
  };

  // Temporaries taken since the hold began are free again when it ends.
  class Hold {
   public:
    explicit Hold(uint32_t& top) : top_(top), mark_(top) {}
    ~Hold() { top_ = mark_; }
    Hold(const Hold&) = delete;
    Hold& operator=(const Hold&) = delete;

   private:
    uint32_t& top_;
    uint32_t mark_;
  };

  // generator.cpp: statements and the pieces all parts use
  void statement(const checked::Stmt& stmt);
  void emit_stmt(const checked::ExprStmt& node, Span span);
  void emit_stmt(const checked::Block& node, Span span);
  void emit_stmt(const checked::If& node, Span span);
  void emit_stmt(const checked::While& node, Span span);
  void emit_stmt(const checked::DoWhile& node, Span span);
  void emit_stmt(const checked::For& node, Span span);
  void emit_stmt(const checked::Switch& node, Span span);
  void emit_stmt(const checked::CaseLabel& node, Span span);
  void emit_stmt(const checked::Break& node, Span span);
  void emit_stmt(const checked::Continue& node, Span span);
  void emit_stmt(const checked::Return& node, Span span);
  void loop(const LoopParts& parts, bool first_test_known);
  int new_label();
  void place(int label);
  Command& emit(vm::Opcode opcode, Span span, std::initializer_list<int32_t> operands = {});
  void jump(int label, Span span);
  int32_t temporary();

  // values.cpp: expressions that give a value
  Operand value(const checked::Expr& expr);
  int32_t variable(const checked::Expr& expr);  // the value in a variable, a constant is loaded into one
  void into(const checked::Expr& expr, int32_t target);
  void arithmetic(const checked::Binary& node, int32_t target, Span span);
  void truth_into(const checked::Expr& expr, int32_t target);
  void conditional_into(const checked::Conditional& node, int32_t target, Span span);
  void load_into(const checked::Place& place, int32_t target, Span span);
  void operate(checked::BinaryOp op, int32_t target, Operand right, Span span);
  void set(int32_t target, Operand source, Span span);
  int32_t address(const checked::Place& place, Span span);
  Operand guarded(Operand operand, const checked::Expr& later, Span span);

  // effects.cpp: assignments, steps, calls
  void effect(const checked::Expr& expr);
  Operand assign(const checked::Assign& node, Span span);
  Operand assign_indirect(const checked::Assign& node, Span span);
  Operand step(const checked::Step& node, Span span, bool value_used);
  void system_call(const checked::SystemCall& node, const checked::Expr& expr);
  void conditional_effect(const checked::Conditional& node, Span span);

  // conditions.cpp
  void branch(const checked::Expr& expr, int label, bool when);
  void branch_binary(const checked::Binary& node, int label, bool when, Span span);
  void compare(const checked::Binary& node, int label, bool when, Span span);
  void test(const checked::Expr& expr, int label, bool when);

  // switches.cpp
  struct Case {
    int32_t number = 0;
    int label = 0;
  };
  Operand selector_of(const checked::Switch& node);
  void compare_in_order(std::span<const Case> cases, int32_t selector, int otherwise, Span at, Span span);
  void in_halves(std::vector<Case> cases, int32_t selector, int otherwise, Span at);
  void bisect(std::span<const Case> cases, int32_t selector, int otherwise, Span at, int64_t least, int64_t most);

  // bit_moves.cpp, copy_loops.cpp: whether the statement was one that a single command does
  bool bit_move(const checked::If& node, Span span);
  bool bit_move(const checked::Assign& node, Span span);
  bool copy_loop(const checked::For& node);
  bool fill(const checked::Expr& with, int32_t counter, int32_t target, int32_t count);

  // indexes.cpp: the number of an element, computed once for its uses in a statement
  struct Pointer {
    checked::ExprPtr offset = nullptr;
    int32_t variable = 0;          // a temporary: number + offset
    std::optional<int32_t> number;  // none: not computed yet
  };
  void find_pointers(const checked::Expr& expr);
  Pointer* pointer_to(const checked::Place& place);
  int32_t moved_to(Pointer& pointer, int32_t number, Span span);

  // held_numbers.cpp: numbers of elements, and products, that grow with the counter of a loop and are kept in temporaries while it runs
  struct Held {
    Linear number;
    int32_t variable = 0;  // a temporary that has this value
  };
  void hold_numbers(const LoopParts& loop);
  bool may_hold(const LoopScan& scan, const Linear& number) const;
  size_t commands_of(const LoopScan::Use& use);
  void start_held(const Linear& number, const LoopParts& loop);
  void move_held(const checked::Expr& expr);
  template <typename Node>  // an expression or a place
  const Held* held(const Node& node) const;
  void number_into(const checked::Place& place, int32_t target, Span span);

  // steps.cpp: where an expression of several commands is computed
  struct Assignment {
    Span span;
    bool reads_target = false;
  };
  bool shows_steps(int32_t target);
  // Whether nobody else writes it between two commands, and whether nobody else looks at it.
  bool stays(int32_t variable) const;
  bool is_own(int32_t variable) const;

  const checked::Program& program_;
  size_t function_;
  bool ends_task_;
  GenerateOptions options_;
  bool early_ = false;     // before main has started anything
  Assignment assignment_;  // the innermost
  FunctionCode code_;
  uint32_t top_ = 0;  // temporaries in use
  std::vector<int> breaks_;
  std::vector<int> continues_;
  std::vector<std::vector<int>> switches_;  // labels of the cases
  std::vector<Pointer> pointers_;           // of the statement
  std::vector<Held> held_;                  // of the loops around
  std::vector<Counter> counters_;           // of the loops around that keep it in bounds
};

// Whether evaluating `expr` may read or write a variable; indirect access and calls may do either to any.
struct Uses {
  bool read = false;
  bool write = false;
};
Uses uses(const checked::Expr& expr, int32_t variable);

// for (i = 0; i < 10; ...) is true at first.
bool true_after(const checked::ExprPtr& init, const checked::ExprPtr& condition);

// A variable whose every value the unit acts on at once: it never shows an intermediate result.
bool acts_at_once(int32_t variable);

// The constant or the directly named variable an expression is, if it is no more than that.
const int32_t* as_constant(const checked::Expr& expr);
const int32_t* as_variable(const checked::Expr& expr);
inline bool is_simple(const checked::Expr& expr) { return as_constant(expr) || as_variable(expr); }

}  // namespace ipos::compiler

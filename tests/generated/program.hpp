// The tree of a generated program. It is the generator's own, not the compiler's: names are resolved to
// variable numbers when the tree is made, after LANGUAGE rules (globals one after the other from the start of
// their range), so the oracles know nothing of the compiler. Nodes are plain values and can be copied and
// cut.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace ipos::tests {

enum class Op : uint8_t {
#define OPERATOR(name, text, precedence) name,
#include "tests/generated/operators.def"
};

struct OperatorRow {
  Op op;
  const char* text;
  int precedence;
};
const OperatorRow& row(Op op);

enum class ExprKind : uint8_t {
  Nothing,      // a missing part of a for head
  Number,       // value, written as text
  Variable,     // variable `value`, written as text
  Element,      // array from variable `value` on, named text; parts: index
  Deref,        // parts: number
  Numof,        // value, of the object text
  Unary,        // op; parts: operand
  Step,         // ++ or --: delta in value, prefix; parts: target
  Binary,       // op; parts: left, right
  Conditional,  // parts: condition, then, otherwise
  Comma,        // parts: left, right
  Assign,       // compound with op; parts: target, value
  Call,         // function `value`; for its effect only
  Macro,        // named text; parts: its body
  CopyBlock,    // numbers: target, source, count; written as text; for its effect only
  Bits,         // op; numbers: target, bit, source, source bit; written as text; for its effect only
};

struct Expr {
  ExprKind kind = ExprKind::Nothing;
  Op op = Op::Add;
  bool prefix = false;
  bool compound = false;
  bool parentheses = false;  // more than the precedences need
  bool compact = false;      // no spaces around the operator
  int32_t value = 0;
  std::array<int32_t, 4> numbers{};
  std::string text;
  std::vector<Expr> parts;
  uint32_t line = 0;  // set when the source is printed; of the outermost expression
};

enum class StmtKind : uint8_t {
  Empty,
  Effect,   // exprs: expression
  Block,    // body
  If,       // exprs: condition; body: then and perhaps otherwise
  While,    // exprs: condition; body: one
  DoWhile,  // exprs: condition; body: one
  For,      // exprs: init, condition, step; body: one
  Switch,   // exprs: value; body: labels and statements
  Case,     // exprs: value, which is exprs[0] and as a number in `value`
  Default,
  Break,
  Continue,
  Return,
};

struct Stmt {
  StmtKind kind = StmtKind::Empty;
  int32_t value = 0;
  std::vector<Expr> exprs;
  std::vector<Stmt> body;
};

struct Function {
  std::string name;
  std::vector<std::string> before;  // lines in front of it: comments, conditions that are false
  Stmt body;                        // a Block
};

struct Program {
  uint64_t seed = 0;
  const char* unit = "md60a";
  int32_t variables = 512;
  int32_t first_temporary = 400;  // the compiler's own variables are not compared
  int32_t last_temporary = 419;
  std::vector<std::string> head;  // lines in front of the functions
  std::vector<Function> functions;
  size_t main = 0;  // index of main()
};

// What a program did. After a fault, a variable that the interrupted expression assigns to by name may hold
// an intermediate result: commands have two addresses, the target is the accumulator.
struct Outcome {
  bool ended = false;  // by itself or by a fault
  int fault = 0;
  uint32_t line = 0;  // of the fault
  std::vector<int32_t> variables;
  std::vector<bool> open;  // oracle only: may differ after the fault; empty: none
};

}  // namespace ipos::tests

// The checked tree: what the program means. Names have become variable numbers, constants are folded, every
// statement stands where it may; code generation finds nothing here that it would have to refuse, except
// size.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compiler/ast/ast.hpp"
#include "compiler/sema/ranges.hpp"
#include "vm/image/image.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::compiler {
class Observers;
}

namespace ipos::compiler::checked {

struct Expr;
struct Stmt;
using ExprPtr = Expr*;  // in the arena of the Program
using StmtPtr = Stmt*;
using ast::BinaryOp;

// The variable of a fixed number; or, with an offset, the one whose number is found at run time: number +
// offset.
struct Place {
  int32_t number = 0;
  ExprPtr offset = nullptr;
};

enum class UnaryOp : uint8_t { Minus, BitNot, Not };

// clang-format off
struct Constant { int32_t value; };
struct Load { Place place; };
struct Unary { UnaryOp op; ExprPtr operand = nullptr; };
// `within`: variables that a computed place may be, when they are known.
struct Step { Place place; int32_t delta; bool prefix; std::optional<NumberRange> within{}; };          // ++ and --
// Comparisons, && and || give 0 or 1. `op_span` is empty where the source has no such operator: a computed index times the size.
struct Binary { BinaryOp op; ExprPtr left = nullptr; ExprPtr right = nullptr; Span op_span{}; };
struct Conditional { ExprPtr condition = nullptr; ExprPtr then = nullptr; ExprPtr otherwise = nullptr; };
struct Assign { std::optional<BinaryOp> op; Place target; ExprPtr value = nullptr; Span op_span{}; std::optional<NumberRange> within{}; };
struct Comma { ExprPtr left = nullptr; ExprPtr right = nullptr; };

// Without a value: on their own, in a comma expression, or as a branch of ?: on its own.
struct CopyBlock { uint16_t target; uint16_t source; uint16_t count; };
struct Call { size_t function; };
struct FunctionRef { size_t function; };
using Argument = std::variant<int32_t, ExprPtr, FunctionRef>;      // in the order of the command's operands
struct SystemCall { vm::Opcode opcode; std::span<const Argument> arguments; std::span<const Span> places; };  // of each argument

struct Expr {
  Span span;
  std::variant<Constant, Load, Unary, Step, Binary, Conditional, Assign, Comma, CopyBlock, Call, SystemCall> node;
};

struct ExprStmt { ExprPtr expr = nullptr; };
struct Block { std::span<const StmtPtr> body; };
struct If { ExprPtr condition = nullptr; StmtPtr then = nullptr; StmtPtr otherwise = nullptr; };             // otherwise may be null
struct While { ExprPtr condition = nullptr; StmtPtr body = nullptr; };
struct DoWhile { StmtPtr body = nullptr; ExprPtr condition = nullptr; };
struct For { ExprPtr init = nullptr; ExprPtr condition = nullptr; ExprPtr step = nullptr; StmtPtr body = nullptr; };   // expressions may be null
struct Switch {
  ExprPtr value = nullptr;
  StmtPtr body = nullptr;
  std::span<const std::pair<int32_t, size_t>> cases;  // value and label, in source order
  std::optional<size_t> otherwise;                // label of default
  size_t labels = 0;
};
struct CaseLabel { size_t label; };                                            // of the switch around it
struct Break {};
struct Continue {};
struct Return {};
// clang-format on

struct Stmt {
  Span span;
  std::variant<ExprStmt, Block, If, While, DoWhile, For, Switch, CaseLabel, Break, Continue, Return> node;
};

struct Function {
  std::string name;
  Span span;  // of the name
  StmtPtr body = nullptr;
};

// A row of the allocation map: who reads and writes a variable, and where its number is taken for indirect
// access or for a system function.
struct MapEntry {
  std::string name;
  std::string type;
  uint32_t number = 0;
  uint32_t count = 1;
  std::string range;  // globals, initials, temporaries, alias, system or raw
  std::vector<std::string> readers;
  std::vector<std::string> writers;
  std::vector<std::string> takers;
};

struct Program {
  std::vector<Function> functions;  // in source order
  Arena arena;                      // of statements and expressions
  size_t main = 0;
  std::vector<vm::Symbol> symbols;
  std::vector<MapEntry> map;  // in rising order of number
  Ranges ranges;
  std::map<uint32_t, Span> raw_names;  // first use of H5 and the like
  std::shared_ptr<const Observers> observers;  // who sees which variable
  std::bitset<kMaxNumbers> named;              // numbers that variables, aliases and raw names stand for
};

}  // namespace ipos::compiler::checked

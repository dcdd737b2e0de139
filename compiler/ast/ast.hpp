// The syntax tree: what the source says, before any name has a meaning. Every node keeps its span.
#pragma once

#include <map>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "compiler/ast/arena.hpp"
#include "compiler/source/source.hpp"

namespace ipos::compiler::ast {

// Longest way down an expression, and down statements to an expression (ours): recursion over a tree is safe.
constexpr uint16_t kMaxDepth = 256;

struct Expr;
struct Stmt;
using ExprPtr = Expr*;  // in the arena of the Program
using StmtPtr = Stmt*;

// A name as written, with its place. The text is part of the source, or a word of the language.
struct Ident {
  std::string_view text;
  Span span;
};

enum class UnaryOp : uint8_t { Plus, Minus, Not, BitNot };
enum class StepOp : uint8_t { PreIncrement, PreDecrement, PostIncrement, PostDecrement };
enum class BinaryOp : uint8_t {
  Mul,
  Div,
  Mod,
  Add,
  Sub,
  Shl,
  Shr,
  Lt,
  Le,
  Gt,
  Ge,
  Eq,
  Ne,
  And,
  Xor,
  Or,
  LogicalAnd,
  LogicalOr
};

struct Number {
  int32_t value;
  bool hex = false;
};
struct Name {
  std::string_view text;
};  // variable, Hn, alias, or a function as an argument
struct Member {
  ExprPtr base = nullptr;
  Ident member;
};  // base.member
struct Index {
  ExprPtr base = nullptr;
  ExprPtr index = nullptr;
};  // base[index]
struct Deref {
  ExprPtr number = nullptr;
};  // *number
struct Numof {
  ExprPtr object = nullptr;
};  // numof( object )
struct Unary {
  UnaryOp op;
  ExprPtr operand = nullptr;
};
struct Step {
  StepOp op;
  ExprPtr operand = nullptr;
};
struct Binary {
  BinaryOp op;
  ExprPtr left = nullptr;
  ExprPtr right = nullptr;
  Span op_span;
};
struct Conditional {
  ExprPtr condition = nullptr;
  ExprPtr then = nullptr;
  ExprPtr otherwise = nullptr;
};
struct Assign {
  std::optional<BinaryOp> op;
  ExprPtr target = nullptr;
  ExprPtr value = nullptr;
  Span op_span;
};  // op: compound
struct Comma {
  ExprPtr left = nullptr;
  ExprPtr right = nullptr;
};
struct Call {
  Ident function;
  std::span<const ExprPtr> arguments;
};

struct Expr {
  Span span;
  std::variant<Number, Name, Member, Index, Deref, Numof, Unary, Step, Binary, Conditional, Assign, Comma,
               Call>
      node;
  bool parenthesized = false;  // `if ((a = b))` asks for no warning
  uint16_t depth = 1;          // nodes from here to the deepest leaf; the parser keeps it below kMaxDepth
};

struct Empty {};  // ;
struct ExprStmt {
  ExprPtr expr = nullptr;
};
struct Block {
  std::span<const StmtPtr> body;
};
struct If {
  ExprPtr condition = nullptr;
  StmtPtr then = nullptr;
  StmtPtr otherwise = nullptr;
};  // otherwise may be null
struct While {
  ExprPtr condition = nullptr;
  StmtPtr body = nullptr;
};
struct DoWhile {
  StmtPtr body = nullptr;
  ExprPtr condition = nullptr;
};
struct For {
  ExprPtr init = nullptr;
  ExprPtr condition = nullptr;
  ExprPtr step = nullptr;
  StmtPtr body = nullptr;
};  // each expression may be null
struct Switch {
  ExprPtr value = nullptr;
  StmtPtr body = nullptr;
};
struct Case {
  ExprPtr value = nullptr;
};  // a label on its own; the statements after it follow in the block
struct Default {};
struct Break {};
struct Continue {};
struct Return {};

struct Stmt {
  Span span;
  std::variant<Empty, ExprStmt, Block, If, While, DoWhile, For, Switch, Case, Default, Break, Continue,
               Return>
      node;
  uint16_t depth = 1;  // statements within each other
};

struct Declarator {
  Ident name;
  ExprPtr count = nullptr;  // null: not an array
};

// `initial long a, b[4];` or `SCTRCYCL TrCycl;`
struct VariableDecl {
  Span span;
  bool initial = false;
  Ident type;  // "long" or a structure
  std::vector<Declarator> declarators;
};

// typedef struct { long a; long b; } NAME;
struct StructDecl {
  Span span;
  Ident name;
  std::vector<VariableDecl> members;
};

struct FunctionDecl {
  Span span;
  Ident name;
  StmtPtr body = nullptr;  // a Block
};

// #declare NAME BASE [+ K]
struct AliasDecl {
  Span span;
  Ident name;
  ExprPtr base = nullptr;  // a name, or name + constant expression
};

// #pragma globals|initials|var LO HI, #pragma list
struct PragmaDecl {
  Span span;
  Ident kind;
  std::optional<std::pair<ExprPtr, ExprPtr>> range;  // bounds: number or Hn
};

using Decl = std::variant<VariableDecl, StructDecl, FunctionDecl, AliasDecl, PragmaDecl>;

// Refers to the text of its SourceMap.
struct Program {
  std::vector<Decl> declarations;  // in source order
  Arena arena;                     // of statements and expressions
  struct LeftOut {
    Span name;
    Span condition;
  };
  std::map<std::string_view, LeftOut> left_out;  // names that are declared only where a condition leaves them out
};

}  // namespace ipos::compiler::ast

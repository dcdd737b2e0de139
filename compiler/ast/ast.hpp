// The syntax tree: what the source says, before any name has a meaning. Every node keeps its span.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "compiler/source/source.hpp"

namespace ipos::compiler::ast {

// Longest way down an expression, and down statements to an expression (ours): recursion over a tree is safe.
constexpr uint16_t kMaxDepth = 256;

struct Expr;
struct Stmt;
using ExprPtr = std::unique_ptr<Expr>;
using StmtPtr = std::unique_ptr<Stmt>;

// A name as written, with its place.
struct Ident {
  std::string text;
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
  std::string text;
};  // variable, Hn, alias, or a function as an argument
struct Member {
  ExprPtr base;
  Ident member;
};  // base.member
struct Index {
  ExprPtr base;
  ExprPtr index;
};  // base[index]
struct Deref {
  ExprPtr number;
};  // *number
struct Numof {
  ExprPtr object;
};  // numof( object )
struct Unary {
  UnaryOp op;
  ExprPtr operand;
};
struct Step {
  StepOp op;
  ExprPtr operand;
};
struct Binary {
  BinaryOp op;
  ExprPtr left;
  ExprPtr right;
  Span op_span;
};
struct Conditional {
  ExprPtr condition;
  ExprPtr then;
  ExprPtr otherwise;
};
struct Assign {
  std::optional<BinaryOp> op;
  ExprPtr target;
  ExprPtr value;
  Span op_span;
};  // op: compound
struct Comma {
  ExprPtr left;
  ExprPtr right;
};
struct Call {
  Ident function;
  std::vector<ExprPtr> arguments;
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
  ExprPtr expr;
};
struct Block {
  std::vector<StmtPtr> body;
};
struct If {
  ExprPtr condition;
  StmtPtr then;
  StmtPtr otherwise;
};  // otherwise may be null
struct While {
  ExprPtr condition;
  StmtPtr body;
};
struct DoWhile {
  StmtPtr body;
  ExprPtr condition;
};
struct For {
  ExprPtr init;
  ExprPtr condition;
  ExprPtr step;
  StmtPtr body;
};  // each expression may be null
struct Switch {
  ExprPtr value;
  StmtPtr body;
};
struct Case {
  ExprPtr value;
};  // a label on its own; the statements behind it follow in the block
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
  ExprPtr count;  // null: not an array
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
  StmtPtr body;  // a Block
};

// #declare NAME BASE [+ K]
struct AliasDecl {
  Span span;
  Ident name;
  ExprPtr base;  // a name, or name + constant expression
};

// #pragma globals|initials|var LO HI, #pragma list
struct PragmaDecl {
  Span span;
  Ident kind;
  std::optional<std::pair<ExprPtr, ExprPtr>> range;  // bounds: number or Hn
};

using Decl = std::variant<VariableDecl, StructDecl, FunctionDecl, AliasDecl, PragmaDecl>;

struct Program {
  std::vector<Decl> declarations;  // in source order
};

}  // namespace ipos::compiler::ast

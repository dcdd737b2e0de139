// The tree of right programs: declarations, statements, and the precedence of every operator.
#include <gtest/gtest.h>

#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

namespace ast = compiler::ast;

// An expression with all its brackets, to see how it was grouped.
std::string shape(const ast::Expr& expr);
std::string shape(const ast::ExprPtr& expr) { return shape(*expr); }

struct Shape {
  std::string operator()(const ast::Number& n) const { return std::to_string(n.value); }
  std::string operator()(const ast::Name& n) const { return std::string(n.text); }
  std::string operator()(const ast::Member& n) const {
    return shape(n.base) + "." + std::string(n.member.text);
  }
  std::string operator()(const ast::Index& n) const { return shape(n.base) + "[" + shape(n.index) + "]"; }
  std::string operator()(const ast::Deref& n) const { return "(*" + shape(n.number) + ")"; }
  std::string operator()(const ast::Numof& n) const { return "numof(" + shape(n.object) + ")"; }
  std::string operator()(const ast::Unary& n) const {
    return "(" + std::string(ast::spelling(n.op)) + shape(n.operand) + ")";
  }
  std::string operator()(const ast::Step& n) const {
    const bool up = n.op == ast::StepOp::PreIncrement || n.op == ast::StepOp::PostIncrement;
    const bool before = n.op == ast::StepOp::PreIncrement || n.op == ast::StepOp::PreDecrement;
    const std::string sign = up ? "++" : "--";
    return before ? "(" + sign + shape(n.operand) + ")" : "(" + shape(n.operand) + sign + ")";
  }
  std::string operator()(const ast::Binary& n) const {
    return "(" + shape(n.left) + std::string(ast::spelling(n.op)) + shape(n.right) + ")";
  }
  std::string operator()(const ast::Conditional& n) const {
    return "(" + shape(n.condition) + "?" + shape(n.then) + ":" + shape(n.otherwise) + ")";
  }
  std::string operator()(const ast::Assign& n) const {
    return "(" + shape(n.target) + (n.op ? std::string(ast::spelling(*n.op)) : "") + "=" + shape(n.value) +
           ")";
  }
  std::string operator()(const ast::Comma& n) const {
    return "(" + shape(n.left) + "," + shape(n.right) + ")";
  }
  std::string operator()(const ast::Call& n) const {
    std::string all;
    for (const ast::ExprPtr& argument : n.arguments) all += (all.empty() ? "" : ";") + shape(argument);
    return std::string(n.function.text) + "(" + all + ")";
  }
};

std::string shape(const ast::Expr& expr) { return std::visit(Shape{}, expr.node); }

std::string shape_of(const std::string& expression) {
  FrontendRun run("main() { " + expression + "; }");
  run.parse();
  if (!run.messages().empty()) return run.messages()[0];
  const auto& function = std::get<ast::FunctionDecl>(run.program.declarations.at(0));
  const auto& body = std::get<ast::Block>(function.body->node).body;
  return shape(std::get<ast::ExprStmt>(body.front()->node).expr);
}

// The binary operators from the loosest to the tightest class, IPOSplus p. 195 and the C standard.
const std::vector<std::vector<std::string>> kClasses = {
    {"||"},       {"&&"},     {"|"},          {"^"}, {"&"}, {"==", "!="}, {"<", "<=", ">", ">="},
    {"<<", ">>"}, {"+", "-"}, {"*", "/", "%"}};
const std::vector<std::string> kAssignments = {
    "=", "*=", "/=", "%=", "+=", "-=", "<<=", ">>=", "&=", "^=", "|="};

TEST(FrontendPrecedence, EveryPairOfBinaryOperators) {
  for (size_t loose = 0; loose < kClasses.size(); ++loose) {
    for (const std::string& a : kClasses[loose]) {
      for (size_t tight = loose; tight < kClasses.size(); ++tight) {
        for (const std::string& b : kClasses[tight]) {
          if (loose == tight) {  // left to right
            EXPECT_EQ(shape_of("x" + a + "y" + b + "z"), "((x" + a + "y)" + b + "z)");
          } else {
            EXPECT_EQ(shape_of("x" + a + "y" + b + "z"), "(x" + a + "(y" + b + "z))");
            EXPECT_EQ(shape_of("x" + b + "y" + a + "z"), "((x" + b + "y)" + a + "z)");
          }
        }
      }
    }
  }
}

TEST(FrontendPrecedence, AssignmentsGroupRightToLeftAndBindLoosest) {
  for (const std::string& a : kAssignments) {
    for (const std::string& b : kAssignments)
      EXPECT_EQ(shape_of("x" + a + "y" + b + "z"), "(x" + a + "(y" + b + "z))");
    EXPECT_EQ(shape_of("x" + a + "y||z"), "(x" + a + "(y||z))");
    EXPECT_EQ(shape_of("x" + a + "y?z:w"), "(x" + a + "(y?z:w))");
    EXPECT_EQ(shape_of("x" + a + "1,y"), "((x" + a + "1),y)");
  }
}

TEST(FrontendPrecedence, Conditional) {
  EXPECT_EQ(shape_of("a?b:c?d:e"), "(a?b:(c?d:e))");
  EXPECT_EQ(shape_of("a?b?c:d:e"), "(a?(b?c:d):e)");
  EXPECT_EQ(shape_of("a||b?c,d:e"), "((a||b)?(c,d):e)");
  EXPECT_EQ(shape_of("a?b=1:c"), "(a?(b=1):c)");
}

TEST(FrontendPrecedence, UnaryBindsTighterThanBinaryAndLooserThanPostfix) {
  for (const char* op : {"+", "-", "!", "~"}) {
    const std::string sign(op);
    EXPECT_EQ(shape_of(sign + "a*b"), "((" + sign + "a)*b)");
    EXPECT_EQ(shape_of(sign + "a.b"), "(" + sign + "a.b)");
    EXPECT_EQ(shape_of(sign + "a[1]"), "(" + sign + "a[1])");
    EXPECT_EQ(shape_of(sign + "a++"), "(" + sign + "(a++))");
  }
  EXPECT_EQ(shape_of("*p++"), "(*(p++))");
  EXPECT_EQ(shape_of("++*p"), "(++(*p))");
  EXPECT_EQ(shape_of("**p*q"), "((*(*p))*q)");
  EXPECT_EQ(shape_of("- - -a"), "(-(-(-a)))");
  EXPECT_EQ(shape_of("!~-+a"), "(!(~(-(+a))))");
  EXPECT_EQ(shape_of("a- --b"), "(a-(--b))");
  EXPECT_EQ(shape_of("a---b"), "((a--)-b)");
}

TEST(FrontendPrecedence, ExamplesOfTheManual) {
  // IPOSplus p. 195.
  EXPECT_EQ(shape_of("H1=3*7+2*4"), "(H1=((3*7)+(2*4)))");
  EXPECT_EQ(shape_of("H1=3*(7+2)*4"), "(H1=((3*(7+2))*4))");
}

TEST(FrontendPrecedence, OperandsOfEveryKind) {
  EXPECT_EQ(shape_of("a.b.c[i+1].d"), "a.b.c[(i+1)].d");
  EXPECT_EQ(shape_of("f()"), "f()");
  EXPECT_EQ(shape_of("f(a,b=1,(c,d))"), "f(a;(b=1);(c,d))");
  EXPECT_EQ(shape_of("numof(a.b)+1"), "(numof(a.b)+1)");
  EXPECT_EQ(shape_of("x=-2147483648"), "(x=(--2147483648))");  // the number wraps onto itself
}

TEST(FrontendSyntax, ParenthesesAreRemembered) {
  FrontendRun run("main() { (a = b); a = b; }");
  run.parse();
  const auto& body =
      std::get<ast::Block>(std::get<ast::FunctionDecl>(run.program.declarations[0]).body->node).body;
  EXPECT_TRUE(std::get<ast::ExprStmt>(body[0]->node).expr->parenthesized);
  EXPECT_FALSE(std::get<ast::ExprStmt>(body[1]->node).expr->parenthesized);
}

TEST(FrontendSyntax, Declarations) {
  FrontendRun run(
      "long a, b[4];\ninitial long c;\nSCREC r;\n"
      "typedef struct { long x; long y, z[2]; SCREC in; } PAIR;\nPAIR p, q[2];;\nmain() {}\n");
  EXPECT_EQ(run.parse().messages(), Messages{});
  EXPECT_EQ(run.tree(),
            "1:1 long\n  1:6 variable a\n  1:9 variable b\n    1:11 number 4\n"
            "2:1 initial long\n  2:14 variable c\n"
            "3:1 SCREC\n  3:7 variable r\n"
            "4:1 structure PAIR\n"
            "  4:18 long\n    4:23 variable x\n"
            "  4:26 long\n    4:31 variable y\n    4:34 variable z\n      4:36 number 2\n"
            "  4:40 SCREC\n    4:46 variable in\n"
            "5:1 PAIR\n  5:6 variable p\n  5:9 variable q\n    5:11 number 2\n"
            "6:1 function main\n  6:8 block\n");
}

TEST(FrontendSyntax, StructureTagIsTakenAndMembersMayBeNamedLikeTypes) {
  FrontendRun run("typedef struct PAIR { long SCREC0; long x; } PAIR;\nPAIR p;\nmain() { p.SCREC = 1; }");
  EXPECT_EQ(run.parse().messages(), Messages{});
}

TEST(FrontendSyntax, Statements) {
  FrontendRun run(
      "main() {\n"
      "  ;\n"
      "  if (a) b; else if (c) { d; }\n"
      "  while (a) b;\n"
      "  do b; while (a);\n"
      "  for (;;) break;\n"
      "  for (i = 0; i < 3; i++) continue;\n"
      "  switch (a) { case 1: case 2 + 1: b; default: return; }\n"
      "}\n");
  EXPECT_EQ(run.parse().messages(), Messages{});
  EXPECT_EQ(
      run.tree(),
      "1:1 function main\n  1:8 block\n    2:3 empty\n"
      "    3:3 if\n      3:7 name a\n      3:10 expression\n        3:10 name b\n"
      "      3:18 if\n        3:22 name c\n        3:25 block\n          3:27 expression\n            3:27 "
      "name d\n"
      "    4:3 while\n      4:10 name a\n      4:13 expression\n        4:13 name b\n"
      "    5:3 do while\n      5:6 expression\n        5:6 name b\n      5:16 name a\n"
      "    6:3 for\n      6:3 none\n      6:3 none\n      6:3 none\n      6:12 break\n"
      "    7:3 for\n      7:8 assign =\n        7:8 name i\n        7:12 number 0\n"
      "      7:15 binary <\n        7:15 name i\n        7:19 number 3\n"
      "      7:22 step ++ behind\n        7:22 name i\n      7:27 continue\n"
      "    8:3 switch\n      8:11 name a\n      8:14 block\n        8:16 case\n          8:21 number 1\n"
      "        8:24 case\n          8:29 binary +\n            8:29 number 2\n            8:33 number 1\n"
      "        8:36 expression\n          8:36 name b\n        8:39 default\n        8:48 return\n");
}

TEST(FrontendSyntax, ElseBelongsToTheNearestIf) {
  FrontendRun run("main() { if (a) if (b) c; else d; }");
  run.parse();
  const auto& body =
      std::get<ast::Block>(std::get<ast::FunctionDecl>(run.program.declarations[0]).body->node).body;
  const auto& outer = std::get<ast::If>(body[0]->node);
  EXPECT_EQ(outer.otherwise, nullptr);
  EXPECT_NE(std::get<ast::If>(outer.then->node).otherwise, nullptr);
}

TEST(FrontendSyntax, SpansReachFromFirstToLastByte) {
  FrontendRun run("#define X y + 1\nmain() { a = b * (c + 2); d = X; }");
  run.parse();
  const auto& body =
      std::get<ast::Block>(std::get<ast::FunctionDecl>(run.program.declarations[0]).body->node).body;
  const ast::Expr& first = *std::get<ast::ExprStmt>(body[0]->node).expr;
  EXPECT_EQ(run.map.position(first.span.begin).column, 10U);
  EXPECT_EQ(run.map.position(first.span.end).column, 25U);
  const ast::Expr& second = *std::get<ast::ExprStmt>(body[1]->node).expr;
  EXPECT_EQ(run.map.position(second.span.begin).column, 27U);
  EXPECT_EQ(run.map.position(second.span.end).column, 32U);  // behind the name of the macro
}

}  // namespace
}  // namespace ipos::tests

// #if against the compiler's own constants: every operator with values at all edges, every pair of operators without
// brackets; and what the directives say word for word.
#include <gtest/gtest.h>

#include "compiler/diag/render.hpp"
#include "compiler/preprocess/number.hpp"
#include "compiler/sema/fold.hpp"
#include "tests/compiler/frontend_run.hpp"

namespace ipos::tests {
namespace {

namespace ast = compiler::ast;

constexpr int32_t kValues[] = {INT32_MIN, INT32_MIN + 1, -33,      -32, -31, -2, -1, 0, 1, 2, 7, 31, 32,
                               33,        INT32_MAX - 1, INT32_MAX};

const std::pair<const char*, ast::BinaryOp> kOperators[] = {
    {"*", ast::BinaryOp::Mul},  {"/", ast::BinaryOp::Div},         {"%", ast::BinaryOp::Mod},
    {"+", ast::BinaryOp::Add},  {"-", ast::BinaryOp::Sub},         {"<<", ast::BinaryOp::Shl},
    {">>", ast::BinaryOp::Shr}, {"<", ast::BinaryOp::Lt},          {"<=", ast::BinaryOp::Le},
    {">", ast::BinaryOp::Gt},   {">=", ast::BinaryOp::Ge},         {"==", ast::BinaryOp::Eq},
    {"!=", ast::BinaryOp::Ne},  {"&", ast::BinaryOp::And},         {"^", ast::BinaryOp::Xor},
    {"|", ast::BinaryOp::Or},   {"&&", ast::BinaryOp::LogicalAnd}, {"||", ast::BinaryOp::LogicalOr}};

// The value of an expression of the parser's tree, by the constants of the compiler (folding_test.cpp has them against
// the machine).
int32_t value_of(const ast::Expr& expr) {
  if (const auto* number = std::get_if<ast::Number>(&expr.node)) return number->value;
  if (const auto* unary = std::get_if<ast::Unary>(&expr.node)) {
    const int32_t value = value_of(*unary->operand);
    switch (unary->op) {
      case ast::UnaryOp::Plus: return value;
      case ast::UnaryOp::Minus: return *compiler::fold(ast::BinaryOp::Sub, 0, value);
      case ast::UnaryOp::Not: return value == 0 ? 1 : 0;
      case ast::UnaryOp::BitNot: return -1 - value;
    }
  }
  if (const auto* choice = std::get_if<ast::Conditional>(&expr.node))
    return value_of(*choice->condition) != 0 ? value_of(*choice->then) : value_of(*choice->otherwise);
  const auto& binary = std::get<ast::Binary>(expr.node);
  return compiler::fold(binary.op, value_of(*binary.left), value_of(*binary.right)).value_or(0);
}

// Each expression must equal what the compiler makes of it.
void expect_equal_conditions(const std::vector<std::string>& expressions) {
  std::string program = "main() {\n";
  for (const std::string& expression : expressions) program += expression + ";\n";
  FrontendRun parsed(program + "}");
  ASSERT_EQ(parsed.parse().messages(), Messages{});
  const auto& function = std::get<ast::FunctionDecl>(parsed.program.declarations.at(0));
  const auto& body = std::get<ast::Block>(function.body->node).body;
  ASSERT_EQ(body.size(), expressions.size());
  std::string conditions;
  std::string expected;
  for (size_t n = 0; n < expressions.size(); ++n) {
    const int32_t value = value_of(*std::get<ast::ExprStmt>(body[n]->node).expr);
    const std::string number = value == INT32_MIN ? "-2147483648" : std::to_string(value);
    conditions += "#if (" + expressions[n] + ") == " + number + "\nright\n#else\nwrong_" + std::to_string(n) +
                  "\n#endif\n";
    conditions += "#if " + expressions[n] + "\ntrue\n#else\nfalse\n#endif\n";
    expected += (n == 0 ? "right " : " right ") + std::string(value != 0 ? "true" : "false");
  }
  FrontendRun run(conditions);
  EXPECT_EQ(run.words(), expected);
  EXPECT_EQ(run.messages(), Messages{});
}

TEST(FrontendConditions, EveryOperatorIsThatOfTheCompiler) {
  for (const auto& [sign, op] : kOperators) {
    std::vector<std::string> expressions;
    for (const int32_t left : kValues)
      for (const int32_t right : kValues)
        if (compiler::fold(op, left, right))
          expressions.push_back(std::to_string(left) + " " + sign + " " + std::to_string(right));
    expect_equal_conditions(expressions);
  }
  std::vector<std::string> unary;
  for (const char* sign : {"- ", "+ ", "~", "!", "- - ", "!!", "~-", "-~", "!-"})
    for (const int32_t value : kValues) unary.push_back(sign + ("(" + std::to_string(value) + ")"));
  expect_equal_conditions(unary);
}

TEST(FrontendConditions, EveryPairOfOperatorsBindsAsInTheCompiler) {
  std::vector<std::string> expressions;
  for (const auto& first : kOperators)
    for (const auto& second : kOperators)
      for (const char* values : {"2 3 5", "7 2 4", "5 1 1", "1 5 2", "6 3 3", "-9 2 3", "8 4 9"}) {
        const std::string text(values);
        const size_t gap = text.find(' ');
        const size_t last = text.rfind(' ');
        expressions.push_back(text.substr(0, gap + 1) + first.first + text.substr(gap, last - gap) + " " +
                              second.first + text.substr(last));
      }
  for (const auto& row : kOperators) {
    expressions.push_back("-7 " + std::string(row.first) + " -2");
    expressions.push_back("!5 " + std::string(row.first) + " ~2");
    expressions.push_back("1 " + std::string(row.first) + " 2 ? 4 " + row.first + " 1 : 5 " + row.first +
                          " 3");
    expressions.push_back("0 " + std::string(row.first) + " 2 ? 4 : 0 ? 5 : 6 " + row.first + " 3");
  }
  // A divisor or operand that is not evaluated makes no difference; one of 0 that is, is refused.
  std::erase_if(expressions, [](const std::string& text) {
    FrontendRun run("#if " + text + "\n#endif");
    run.words();
    return run.diagnostics.has_errors();
  });
  EXPECT_GT(expressions.size(), 2200U);
  expect_equal_conditions(expressions);
}

TEST(FrontendConditions, WhatIsNotEvaluatedMayDivideByZero) {
  for (const char* good : {"0 && 1 / 0", "1 || 1 / 0", "0 && (1 / 0)", "0 && -(1 % 0)", "1 ? 5 : 1 / 0",
                           "0 ? 1 / 0 : 5", "0 && (1 || 1 / 0)", "0 && (0 || 1 / 0)", "1 || (1 && 1 / 0)",
                           "0 ? (1 ? 1 / 0 : 1) : 5", "0 && 1 / 0 && 1 / 0", "1 || 0 || 1 / 0",
                           "0 && UNKNOWN", "1 || UNKNOWN + 1", "0 && (UNKNOWN ? UNKNOWN : -UNKNOWN)"}) {
    FrontendRun run("#if " + std::string(good) + "\n#endif");
    EXPECT_EQ(run.words(), "");
    EXPECT_EQ(run.messages(), Messages{}) << good;
  }
  const std::pair<const char*, Messages> bad[] = {{"1 && 1 / 0", {"E0131 1:12"}},
                                                  {"0 || 1 % 0", {"E0131 1:12"}},
                                                  {"1 ? 1 / 0 : 5", {"E0131 1:11"}},
                                                  {"0 ? 5 : 1 / 0", {"E0131 1:15"}},
                                                  {"1 / 0", {"E0131 1:7"}},
                                                  {"1 / (2 - 2)", {"E0131 1:7"}},
                                                  {"(0 && 1 / 0) || 1 / 0", {"E0131 1:23"}},
                                                  {"1 && UNKNOWN", {"W0124 1:10"}},
                                                  {"0 || UNKNOWN", {"W0124 1:10"}},
                                                  {"UNKNOWN ? 1 : OTHER", {"W0124 1:5", "W0124 1:19"}},
                                                  {"UNKNOWN && OTHER", {"W0124 1:5"}}};
  for (const auto& [text, expected] : bad) {
    FrontendRun run("#if " + std::string(text) + "\n#endif");
    run.words();
    EXPECT_EQ(run.messages(), expected) << text;
  }
}

TEST(FrontendConditions, NestAsDeepAsTwoHundredFiftySix) {
  const auto said = [](const std::string& condition) {
    return messages_of("#if " + condition + "\n#endif\nlong a;");
  };
  const auto repeated = [](const std::string& text, int count) {
    std::string out;
    for (int n = 0; n < count; ++n) out += text;
    return out;
  };
  // Each bracket and sign is a level, the number in it one more.
  EXPECT_EQ(said(repeated("(", 255) + "1" + repeated(")", 255)), Messages{});
  EXPECT_EQ(said(repeated("(", 256) + "1" + repeated(")", 256)), Messages{"E0131 1:261"});
  EXPECT_EQ(said(repeated("!", 255) + "1"), Messages{});
  EXPECT_EQ(said(repeated("!", 256) + "1"), Messages{"E0131 1:261"});
  EXPECT_EQ(said("1" + repeated(" ? 1 : 1", 255)), Messages{});
  EXPECT_EQ(said(repeated("0 ? 1 : ", 255) + "1"), Messages{});
  EXPECT_EQ(said(repeated("0 ? 1 : ", 256) + "1"), Messages{"E0131 1:2049"})
      << "the value behind the last '?'";
  EXPECT_EQ(said(repeated("0 ? 1 : ", 257) + "1"), Messages{"E0131 1:2049"});
  EXPECT_EQ(said("1" + repeated(" ? 1", 256) + repeated(" : 1", 256)), Messages{"E0131 1:1029"});
  EXPECT_EQ(said("1" + repeated(" ? 1", 255) + repeated(" : 1", 255)), Messages{});
  EXPECT_EQ(said("(" + repeated("!", 253) + "0 ? 1 : 2) + " + repeated("!", 254) + "(1)"), Messages{});
  EXPECT_EQ(said("1" + repeated(" && (1)", 300)), Messages{}) << "brackets beside each other are not nested";
  EXPECT_EQ(said("(1" + repeated(" ? 1 : 1)", 1) + repeated(" && (1 ? 1 : 1)", 300)), Messages{});
}

// The first message: its text, and "TEXT" of each note behind it.
std::string told(const std::string& source, compiler::PreprocessOptions options = {},
                 const FrontendRun::Files& files = {}) {
  FrontendRun run(source, files, std::move(options));
  run.words();
  std::string out;
  for (const compiler::Diagnostic& one : run.diagnostics.all()) {
    out += one.text + "\n";
    for (const compiler::Note& note : one.notes)
      out += "  " +
             (note.span.begin.valid() ? std::to_string(run.map.position(note.span.begin).line) + ": " : "") +
             note.text + "\n";
  }
  return out;
}

TEST(FrontendConditions, TellWhatIsWrong) {
  const std::pair<const char*, const char*> rows[] = {
      {"#if\n#endif", "#if needs a constant expression: a number or a name is missing\n"},
      {"#if 1 +\n#endif", "#if needs a constant expression: a number or a name is missing\n"},
      {"#if (1\n#endif", "#if needs a constant expression: ')' is missing\n"},
      {"#if 1 ? 2\n#endif", "#if needs a constant expression: ':' is missing\n"},
      {"#if 1 2\n#endif", "#if needs a constant expression: an operator or the end of the line is missing\n"},
      {"#if 1 / 0\n#endif", "#if needs a constant expression: division by zero\n"},
      {"#if 2147483648\n#endif", "#if needs a constant expression: '2147483648' does not fit into 32 bits\n"},
      {"#if 5 - 2147483649\n#endif",
       "#if needs a constant expression: '2147483649' does not fit into 32 bits\n"},
      {"#if 1.5\n#endif", "#if needs a constant expression: '1.5' is not a whole number\n"},
      {"#if 12ab\n#endif", "#if needs a constant expression: '12ab' is not a whole number\n"},
      {"#if 0\n#elif )\n#endif", "#elif needs a constant expression: a number or a name is missing\n"},
      {"#if defined\n#endif", "#if needs a constant expression: write defined NAME or defined(NAME)\n"},
      {"#if defined(A\n#endif", "#if needs a constant expression: write defined NAME or defined(NAME)\n"},
      {"#if defined()\n#endif", "#if needs a constant expression: write defined NAME or defined(NAME)\n"},
      {"#if defined 5\n#endif", "#if needs a constant expression: write defined NAME or defined(NAME)\n"},
      {"#if defined(A +\n#endif", "#if needs a constant expression: write defined NAME or defined(NAME)\n"},
      {"#if A\n#endif", "'A' is not defined and counts as 0\n"},
      {"#else", "#else without #if\n"},
      {"#elif 1", "#elif without #if\n"},
      {"#endif", "#endif without #if\n"},
      {"\n#if 1\n#else\n#else\n#endif", "#else behind #else\n  2: the condition begins here\n"},
      {"#ifndef A\n#else\n#elif 1\n#endif", "#elif behind #else\n  1: the condition begins here\n"},
      {"#ifdef A", "#ifdef without #endif\n"},
      {"#ifdef\n#endif", "#ifdef needs a name\n"},
      {"#ifndef 5\n#endif", "#ifndef needs a name\n"},
      {"#undef", "#undef needs a name\n"},
      {"#define", "#define needs a name\n"},
      {"#define defined", "'defined' cannot be the name of a macro\n"},
      {"#undef defined", "'defined' cannot be the name of a macro\n"},
      {"#ifdef defined\n#endif", "'defined' cannot be the name of a macro\n"},
      {"#ifdef A B C\n#endif", "text behind #ifdef is ignored\n"},
      {"#ifndef A B\n#endif", "text behind #ifndef is ignored\n"},
      {"#if 1\n#else B\n#endif", "text behind #else is ignored\n"},
      {"#if 1\n#endif B", "text behind #endif is ignored\n"},
      {"#if 0\n#if 1\n#else B\n#endif B\n#endif", ""},
      {"#undef A B", "text behind #undef is ignored\n"},
      {"#define F(x) x",
       "macro 'F' cannot have parameters; for a text in brackets leave a blank before '('\n"},
      {"\n#define A 1\n#define A 2", "macro 'A' gets another text\n  2: the former text is here\n"},
      {"#define A 1\n#define A 1 2", "macro 'A' gets another text\n  1: the former text is here\n"},
      {"#define A 1 2\n#define A 1", "macro 'A' gets another text\n  1: the former text is here\n"},
      {"#define A\n#define A 1", "macro 'A' gets another text\n  1: the former text is here\n"},
      {"#define A 1\n#undef A\n#define A 2", ""},
      {"#define A 1\n#undef A\n#undef A", ""},
      {"#defne A 1", "unknown directive '#defne'\n  did you mean '#define'?\n"},
      {"#endiff", "unknown directive '#endiff'\n  did you mean '#endif'?\n"},
      {"#elsif 1", "unknown directive '#elsif'\n  did you mean '#elif'?\n"},
      {"#inclde <a.h>", "unknown directive '#inclde'\n  did you mean '#include'?\n"},
      {"#qqqqqqqq", "unknown directive '#qqqqqqqq'\n"},
      {"#error  two  words ", "#error two  words\n"},
      {"#error", "#error \n"},
      {"#pragma foo 1", "unknown pragma 'foo' is ignored; known are var, globals, initials and list\n"},
      {"#pragma", "unknown pragma '' is ignored; known are var, globals, initials and list\n"},
      {"#include", "#include needs <FILE> or \"FILE\"\n"},
      {"#include foo", "#include needs <FILE> or \"FILE\"\n"},
      {"#include <>", "#include needs <FILE> or \"FILE\"\n"},
  };
  for (const auto& [source, expected] : rows) EXPECT_EQ(told(source), expected) << source;
}

TEST(FrontendConditions, BranchesAreTakenOnce) {
  // All combinations of three conditions and an #else.
  for (int bits = 0; bits < 16; ++bits) {
    std::string source;
    std::string expected;
    for (int n = 0; n < 3; ++n) {
      const bool holds = (bits >> n & 1) != 0;
      source += (n == 0 ? "#if " : "#elif ") + std::string(holds ? "1" : "0") + "\nb" + std::to_string(n) +
                "\n#if 1\nin\n#else\nout\n#endif\n";
      if (holds && expected.empty()) expected = "b" + std::to_string(n) + " in";
    }
    if ((bits & 8) != 0) {
      source += "#else\nother\n";
      if (expected.empty()) expected = "other";
    }
    FrontendRun run(source + "#endif");
    EXPECT_EQ(run.words(), expected) << source;
    EXPECT_EQ(run.messages(), Messages{});
    FrontendRun dead("#if 0\n" + source + "#endif\n#endif");
    EXPECT_EQ(dead.words(), "") << source;
  }
  FrontendRun behind("#if 0\n#else\none\n#else\ntwo\n#elif 1\nthree\n#endif\nfour");
  EXPECT_EQ(behind.words(), "one four");
}

TEST(FrontendConditions, ThatAreWrongAreNotTaken) {
  for (const char* wrong :
       {"#if", "#if 1 +", "#if 1 / 0", "#if (1", "#if 1 2", "#if 1 ? 2", "#if 12ab", "#if defined",
        "#if 1 || defined(", "#ifdef", "#ifdef 5", "#ifndef", "#ifndef 5", "#ifndef defined"}) {
    EXPECT_EQ(FrontendRun(wrong + std::string("\nyes\n#else\nno\n#endif")).words(), "no") << wrong;
    EXPECT_EQ(FrontendRun(wrong + std::string("\nyes\n#elif 1\nelse\n#endif")).words(), "else") << wrong;
  }
  for (const char* wrong : {"#elif", "#elif 1 +", "#elif 1 / 0", "#elif defined"})
    EXPECT_EQ(FrontendRun("#if 0\n" + std::string(wrong) + "\nyes\n#else\nno\n#endif").words(), "no")
        << wrong;
}

TEST(FrontendConditions, NamesAreAskedForBeforeTheyAreReplaced) {
  const std::string head = "#define A B\n#define ONE 1\n";
  const std::pair<const char*, const char*> rows[] = {{"#ifdef A", "yes"},
                                                      {"#ifdef B", ""},
                                                      {"#ifndef A", ""},
                                                      {"#ifndef B", "yes"},
                                                      {"#if defined A", "yes"},
                                                      {"#if defined(A)", "yes"},
                                                      {"#if defined B", ""},
                                                      {"#if defined(B)", ""},
                                                      {"#if defined(A) + 1 == 2", "yes"},
                                                      {"#if defined A + 1 == 2", "yes"},
                                                      {"#if ONE && defined ( A )", "yes"},
                                                      {"#if ONE", "yes"},
                                                      {"#if !ONE", ""},
                                                      {"#undef A\n#ifdef A", ""},
                                                      {"#undef A\n#if defined A", ""},
                                                      {"#undef B\n#ifdef A", "yes"}};
  for (const auto& [condition, expected] : rows)
    EXPECT_EQ(FrontendRun(head + condition + "\nyes\n#endif").words(), expected) << condition;
}

}  // namespace
}  // namespace ipos::tests

// Constants that the compiler folds against what the VM computes: every operator, values at all edges.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "compiler/sema/fold.hpp"
#include "tests/compiler/backend_test.hpp"
#include "vm/exec/machine.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::compiler::test {
namespace {

constexpr int32_t kEdges[] = {
    INT32_MIN, INT32_MIN + 1, -65536, -33,           -32,      -31, -2, -1, 0, 1, 2, 7, 31, 32, 33,
    64,        65535,         65536,  INT32_MAX - 1, INT32_MAX};

std::string constant(int32_t value) {
  return value == INT32_MIN ? "(-2147483647 - 1)" : "(" + std::to_string(value) + ")";
}

// Compiled, verified, and run to its end with H0 and H1 set.
class Executed {
 public:
  explicit Executed(const std::string& text) : compilation_(compile_text(text, "mdxb")) {
    if (!compilation_.image) return;
    const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view("mdxb"));
    const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
    machine_ = std::make_unique<vm::Machine>(vm::verify(compilation_.image->code, limits, {}).image.value(),
                                             vm::Host{});
  }
  bool is_compiled() const { return machine_ != nullptr; }
  const Compilation& compilation() const { return compilation_; }
  int32_t result(int32_t left, int32_t right) {
    machine_->variables()[0] = left;
    machine_->variables()[1] = right;
    machine_->start();
    machine_->run(1, 10'000);
    return machine_->variables()[2];
  }

 private:
  Compilation compilation_;
  std::unique_ptr<vm::Machine> machine_;
};

TEST(Folding, EveryBinaryOperatorIsWhatTheMachineComputes) {
  using enum ast::BinaryOp;
  const std::pair<const char*, ast::BinaryOp> operators[] = {
      {"*", Mul},  {"/", Div}, {"%", Mod}, {"+", Add}, {"-", Sub},         {"<<", Shl},
      {">>", Shr}, {"<", Lt},  {"<=", Le}, {">", Gt},  {">=", Ge},         {"==", Eq},
      {"!=", Ne},  {"&", And}, {"^", Xor}, {"|", Or},  {"&&", LogicalAnd}, {"||", LogicalOr}};
  for (const auto& [op, folds] : operators) {
    Executed computed("main() { H2 = H0 " + std::string(op) + " H1; }");
    ASSERT_TRUE(computed.is_compiled()) << op;
    std::string text = "main() {\n";
    std::vector<int32_t> want;
    for (const int32_t left : kEdges)
      for (const int32_t right : kEdges) {
        if (right == 0 && (*op == '/' || *op == '%')) continue;
        text +=
            "H" + std::to_string(want.size() + 10) + " = " + constant(left) + op + constant(right) + ";\n";
        want.push_back(computed.result(left, right));
        EXPECT_EQ(fold(folds, left, right), want.back()) << left << op << right;
      }
    const Compilation folded = compile_text(text + "}\n", "mdxb");
    ASSERT_TRUE(folded.image) << op << "\n" << commands(folded)[0];
    std::vector<std::string> lines;
    for (const std::string& line : commands(folded))
      if (const size_t set = line.find("SET H"); set != std::string::npos) lines.push_back(line.substr(set));
    ASSERT_EQ(lines.size(), want.size()) << op << ": each is one command";
    for (size_t n = 0; n < want.size(); ++n)
      EXPECT_EQ(lines[n], "SET H" + std::to_string(n + 10) + " = " + std::to_string(want[n]))
          << op << " " << n;
  }
}

TEST(Folding, EveryUnaryOperatorIsWhatTheMachineComputes) {
  for (const char* op : {"-", "~", "!"}) {
    Executed computed("main() { H2 = " + std::string(op) + "H0; }");
    ASSERT_TRUE(computed.is_compiled()) << op;
    for (const int32_t value : kEdges) {
      const Compilation folded =
          compile_text("main() { H2 = " + std::string(op) + constant(value) + "; }", "mdxb");
      EXPECT_EQ(commands(folded)[0].substr(commands(folded)[0].find("SET")),
                "SET H2 = " + std::to_string(computed.result(value, 0)))
          << op << value;
    }
  }
}

// Where one side is known the other may still be asked for; the value is what C says.
TEST(Folding, OneConstantSideOfALogicalOperatorOrOfAConditional) {
  for (const int32_t known : {INT32_MIN, -1, 0, 1, 2, INT32_MAX}) {
    const std::string c = constant(known);
    const bool yes = known != 0;
    struct Form {
      std::string expression;
      int32_t (*value)(bool, int32_t, int32_t);
    };
    for (const Form& form :
         {Form{c + " && H0", [](bool k, int32_t a, int32_t) { return static_cast<int32_t>(k && a != 0); }},
          Form{"H0 && " + c, [](bool k, int32_t a, int32_t) { return static_cast<int32_t>(k && a != 0); }},
          Form{c + " || H0", [](bool k, int32_t a, int32_t) { return static_cast<int32_t>(k || a != 0); }},
          Form{"H0 || " + c, [](bool k, int32_t a, int32_t) { return static_cast<int32_t>(k || a != 0); }},
          Form{c + " ? H0 : H1", [](bool k, int32_t a, int32_t b) { return k ? a : b; }},
          Form{"H0 ? H1 : " + c + " == 0",
               [](bool k, int32_t a, int32_t b) { return a != 0 ? b
                                                         : k    ? 0
                                                                : 1; }},
          Form{"!" + c + " + H0", [](bool k, int32_t a, int32_t) { return (k ? 0 : 1) + a; }}}) {
      Executed computed("main() { H2 = " + form.expression + "; }");
      ASSERT_TRUE(computed.is_compiled()) << form.expression;
      for (const int32_t a : {INT32_MIN, -1, 0, 1, 7})
        for (const int32_t b : {-5, 0, 9})
          EXPECT_EQ(computed.result(a, b), form.value(yes, a, b)) << form.expression << " " << a << " " << b;
    }
  }
}

// `+=` and the like with a constant behind them, against the operator alone.
TEST(Folding, AssignmentsWithAConstantAreTheirOperators) {
  for (const char* op : {"*", "/", "%", "+", "-", "<<", ">>", "&", "^", "|"}) {
    Executed computed("main() { H2 = H0 " + std::string(op) + " H1; }");
    for (const int32_t right : kEdges) {
      if (right == 0 && (*op == '/' || *op == '%')) continue;
      Executed assigned("main() { H2 = H0; H2 " + std::string(op) + "= " + constant(right) + "; }");
      ASSERT_TRUE(assigned.is_compiled()) << op << right;
      for (const int32_t left : kEdges)
        EXPECT_EQ(assigned.result(left, right), computed.result(left, right)) << left << op << right;
    }
  }
}

TEST(Folding, DivisionByAConstantZeroIsNotFolded) {
  for (const char* op : {"/", "%"}) {
    const Compilation c = compile_text("main() { H2 = 5 " + std::string(op) + " 0; }", "mdxb");
    EXPECT_FALSE(c.diagnostics.all().empty()) << op;
  }
}

}  // namespace
}  // namespace ipos::compiler::test

// Commands per operator: tables over all operators, with their forms for constants and variables on either side. The names
// are those of codegen_test.cpp: a b c d are H420..H423, v is H424..H427, p is H428; temporaries begin at H400.
#include <gtest/gtest.h>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

using Lines = std::vector<std::string>;

// Without M01, at which main begins.
void expect_sequence(const std::string& source, Lines wanted) {
  wanted[0] = "M01 : " + wanted[0];
  EXPECT_EQ(wanted, main_commands(source)) << source;
}

struct OperatorRow {
  std::string op;        // of the language
  std::string mnemonic;  // and what stands between the operands of the command
  std::string sign;
  bool commutes;
  std::string neutral;  // right operand that changes nothing, or none
};
// `>>` keeps the sign (IPOSplus p. 196).
const OperatorRow kOperators[] = {{"+", "ADD", "+", true, "0"},     {"-", "SUB", "-", false, "0"},
                                  {"*", "MUL", "*", true, "1"},     {"/", "DIV", "/", false, "1"},
                                  {"%", "MOD", "MOD", false, ""},   {"<<", "SHL", "<<", false, "0"},
                                  {">>", "ASHR", ">>", false, "0"}, {"&", "AND", "&", true, "-1"},
                                  {"^", "XOR", "XOR", true, "0"},   {"|", "OR", "|", true, "0"}};

TEST(Operators, HaveTheirCommands) {
  for (const OperatorRow& row : kOperators) {
    const auto command = [&](const std::string& target, const std::string& right) {
      return row.mnemonic + " " + target + " " + row.sign + " " + right;
    };
    const std::string& op = row.op;
    expect_sequence("a = b " + op + " c;", {"SET H420 = H421", command("H420", "H422"), "END"});
    expect_sequence("a = b " + op + " 5;", {"SET H420 = H421", command("H420", "5"), "END"});
    expect_sequence("a = 5 " + op + " b;", {"SET H420 = 5", command("H420", "H421"), "END"});
    expect_sequence("a " + op + "= 5;", {command("H420", "5"), "END"});
    expect_sequence("a " + op + "= b;", {command("H420", "H421"), "END"});
    expect_sequence("a = a " + op + " b;", {command("H420", "H421"), "END"});
    expect_sequence("a " + op + "= a;", {command("H420", "H420"), "END"});
    // Only what commutes takes the target from the right side.
    if (row.commutes) {
      expect_sequence("a = b " + op + " a;", {command("H420", "H421"), "END"});
      expect_sequence("a = 5 " + op + " a;", {command("H420", "5"), "END"});
      expect_sequence("a = 5 " + op + " ~b;", {"NOT H420 = NOT( H421 )", command("H420", "5"), "END"});
      expect_sequence("a = b " + op + " ~c;", {"NOT H420 = NOT( H422 )", command("H420", "H421"), "END"});
    } else if (op != "-") {
      expect_sequence("a = b " + op + " a;",
                      {"SET H400 = H421", command("H400", "H420"), "SET H420 = H400", "END"});
      expect_sequence("a = 5 " + op + " ~b;",
                      {"SET H420 = 5", "NOT H400 = NOT( H421 )", command("H420", "H400"), "END"});
    }
    // Each side is evaluated once, the left one first.
    expect_sequence("a = b++ " + op + " ++c;",
                    {"SET H420 = H421", "ADD H421 + 1", "ADD H422 + 1", command("H420", "H422"), "END"});
    // Division by 0 is left to the unit, whose fault it is.
    for (const std::string number : {"-1", "0", "1", "2"}) {
      // Counts of shifts are taken modulo 32.
      const std::string count = number == "-1" && (op == "<<" || op == ">>") ? "31" : number;
      const bool nothing = number == row.neutral;
      expect_sequence("a = b " + op + " (" + number + ");",
                      nothing ? Lines{"SET H420 = H421", "END"}
                              : Lines{"SET H420 = H421", command("H420", count), "END"});
      expect_sequence("a " + op + "= (" + number + ");",
                      nothing ? Lines{"END"} : Lines{command("H420", count), "END"});
      expect_sequence("*p " + op + "= (" + number + ");",
                      nothing
                          ? Lines{"SETI H400 = [H428]", "SETI [H428] = H400", "END"}
                          : Lines{"SETI H400 = [H428]", command("H400", count), "SETI [H428] = H400", "END"});
    }
  }
}

// What the right side may do to the target keeps the sum out of it; each kind of access in each direction.
TEST(Operators, TheTargetIsNoAccumulatorWhereTheRightSideUsesIt) {
  expect_sequence("a = b - (c + a);", {"SET H400 = H421", "SET H401 = H422", "ADD H401 + H420",
                                       "SUB H400 - H401", "SET H420 = H400", "END"});
  expect_sequence("a = b - a++;", {"SET H400 = H421", "SET H401 = H420", "ADD H420 + 1", "SUB H400 - H401",
                                   "SET H420 = H400", "END"});
  expect_sequence("a = b - (a = c);",
                  {"SET H400 = H421", "SET H420 = H422", "SUB H400 - H420", "SET H420 = H400", "END"});
  expect_sequence("a = b - (a += c);",
                  {"SET H400 = H421", "ADD H420 + H422", "SUB H400 - H420", "SET H420 = H400", "END"});
  expect_sequence("a = b - (d = c);", {"SET H420 = H421", "SET H423 = H422", "SUB H420 - H423", "END"});
  expect_sequence("a = b - (*p = c);",
                  {"SET H400 = H421", "SETI [H428] = H422", "SUB H400 - H422", "SET H420 = H400", "END"});
  expect_sequence("a = a - a++;", {"SET H400 = H420", "SET H401 = H420", "ADD H420 + 1", "SUB H400 - H401",
                                   "SET H420 = H400", "END"});
  expect_sequence("a = a - (b, c);", {"SUB H420 - H422", "END"});
}

// Minus, complement and steps.
TEST(Operators, OfOneOperand) {
  expect_sequence("a = -(b + c);", {"SET H420 = H421", "ADD H420 + H422", "MUL H420 * -1", "END"});
  expect_sequence("H492 = -H492;", {"MUL H492 * -1", "END"});
  expect_sequence("H492 = -a;", {"SET H400 = H420", "MUL H400 * -1", "SET H492 = H400", "END"});
  expect_sequence("a = ~a;", {"NOT H420 = NOT( H420 )", "END"});
  expect_sequence("a = ~(b + 1);", {"SET H400 = H421", "ADD H400 + 1", "NOT H420 = NOT( H400 )", "END"});
  expect_sequence("a = a++;", {"SET H400 = H420", "ADD H420 + 1", "SET H420 = H400", "END"});
  expect_sequence("a = ++a;", {"ADD H420 + 1", "END"});
  expect_sequence("a = b--;", {"SET H420 = H421", "SUB H421 - 1", "END"});
  expect_sequence("a = --b;", {"SUB H421 - 1", "SET H420 = H421", "END"});
  expect_sequence("a = b - a; H492 = a - H492;", {"MUL H420 * -1", "ADD H420 + H421", "SET H400 = H420",
                                                  "SUB H400 - H492", "SET H492 = H400", "END"});
  // The old value in front of the step, the new one in front of the store.
  expect_sequence("a = (*p)++;", {"SETI H400 = [H428]", "SET H401 = H400", "ADD H401 + 1",
                                  "SETI [H428] = H401", "SET H420 = H400", "END"});
  expect_sequence("a = ++*p;",
                  {"SETI H400 = [H428]", "ADD H400 + 1", "SETI [H428] = H400", "SET H420 = H400", "END"});
  expect_sequence("--*p;", {"SETI H400 = [H428]", "SUB H400 - 1", "SETI [H428] = H400", "END"});
  expect_sequence("v[b]--;", {"SET H400 = H421", "ADD H400 + 424", "SETI H401 = [H400]", "SUB H401 - 1",
                              "SETI [H400] = H401", "END"});
}

TEST(Operators, ValuesOfAssignmentsAndCommas) {
  expect_sequence("a = *p = 5;", {"SET H400 = 5", "SETI [H428] = H400", "SET H420 = 5", "END"});
  expect_sequence("a = *p = b;", {"SETI [H428] = H421", "SET H420 = H421", "END"});
  expect_sequence("a = *p += b;",
                  {"SETI H400 = [H428]", "ADD H400 + H421", "SETI [H428] = H400", "SET H420 = H400", "END"});
  expect_sequence("a = b += c;", {"ADD H421 + H422", "SET H420 = H421", "END"});
  expect_sequence("a = (b++, c * d);", {"ADD H421 + 1", "SET H420 = H422", "MUL H420 * H423", "END"});
  expect_sequence("a += (b++, c);", {"ADD H421 + 1", "ADD H420 + H422", "END"});
  expect_sequence("a++, b++;", {"ADD H420 + 1", "ADD H421 + 1", "END"});
  expect_sequence("a, b++, c;", {"ADD H421 + 1", "END"});
  expect_sequence("*(p + 1) = a;", {"SET H400 = H428", "ADD H400 + 1", "SETI [H400] = H420", "END"});
  expect_sequence("a = *(p + 1);", {"SET H400 = H428", "ADD H400 + 1", "SETI H420 = [H400]", "END"});
  expect_sequence("v[b] = 5;",
                  {"SET H400 = H421", "ADD H400 + 424", "SET H401 = 5", "SETI [H400] = H401", "END"});
  expect_sequence("b = ~(a = 5);", {"SET H420 = 5", "SET H400 = 5", "NOT H421 = NOT( H400 )", "END"});
}

// What has an effect somewhere inside is done also where nobody wants its value.
TEST(Operators, EffectsInsideOfWhatIsNotUsed) {
  expect_sequence("a + b++;",
                  {"SET H400 = H420", "SET H401 = H421", "ADD H421 + 1", "ADD H400 + H401", "END"});
  expect_sequence("-(a = b);", {"SET H420 = H421", "SET H400 = H420", "MUL H400 * -1", "END"});
  expect_sequence("a ? b++ : c++;",
                  {"JMP H420 == 0 , M02", "ADD H421 + 1", "END", "M02 : ADD H422 + 1", "END"});
  expect_sequence("a ? b : c++;", {"JMP H420 != 0 , M02", "ADD H422 + 1", "M02 : END"});
  expect_sequence("a ? b++ : c;", {"JMP H420 == 0 , M02", "ADD H421 + 1", "M02 : END"});
  expect_sequence("a++ && b;", {"SET H400 = H420", "ADD H420 + 1", "END"});
}

struct Comparison {
  std::string op, inverse, mirrored;  // true when op is false; with the operands exchanged
};
const Comparison kComparisons[] = {{"==", "!=", "=="}, {"!=", "==", "!="}, {"<", ">=", ">"},
                                   {"<=", ">", ">="},  {">", "<=", "<"},   {">=", "<", "<="}};

// What is jumped over is done when the condition holds, so the jump asks for the opposite.
TEST(Comparisons, AreOneCommand) {
  const auto inverse_of = [](const std::string& op) {
    for (const Comparison& row : kComparisons)
      if (row.op == op) return row.inverse;
    return std::string();
  };
  for (const Comparison& row : kComparisons) {
    const auto expect = [&](const std::string& condition, const std::string& left, const std::string& op,
                            const std::string& right) {
      expect_sequence(
          "if (" + condition + ") d = 1;",
          {"JMP " + left + " " + inverse_of(op) + " " + right + " , M02", "SET H423 = 1", "M02 : END"});
      expect_sequence("if (!(" + condition + ")) d = 1;",
                      {"JMP " + left + " " + op + " " + right + " , M02", "SET H423 = 1", "M02 : END"});
      expect_sequence("if ((" + condition + ") == 0) d = 1;",
                      {"JMP " + left + " " + op + " " + right + " , M02", "SET H423 = 1", "M02 : END"});
      expect_sequence(
          "if ((" + condition + ") != 0) d = 1;",
          {"JMP " + left + " " + inverse_of(op) + " " + right + " , M02", "SET H423 = 1", "M02 : END"});
      expect_sequence(
          "if ((" + condition + ") == 1) d = 1;",
          {"JMP " + left + " " + inverse_of(op) + " " + right + " , M02", "SET H423 = 1", "M02 : END"});
      expect_sequence("if ((" + condition + ") != 1) d = 1;",
                      {"JMP " + left + " " + op + " " + right + " , M02", "SET H423 = 1", "M02 : END"});
      expect_sequence("do d++; while (" + condition + ");",
                      {"ADD H423 + 1", "JMP " + left + " " + op + " " + right + " , M01", "END"});
      expect_sequence("_Wait(" + condition + ");",
                      {"SET H400 = 1", "JMP " + left + " " + op + " " + right + " , M02", "SET H400 = 0",
                       "M02 : WAIT H400", "END"});
    };
    expect("a " + row.op + " b", "H420", row.op, "H421");
    expect("a " + row.op + " 7", "H420", row.op, "7");
    expect("7 " + row.op + " a", "H420", row.mirrored, "7");
    // With two constants one of them is loaded.
    expect_sequence("if ((a = 1) " + row.op + " 2) d = 1;",
                    {"SET H420 = 1", "SET H400 = 1", "JMP H400 " + row.inverse + " 2 , M02", "SET H423 = 1",
                     "M02 : END"});
    expect_sequence("if (a++ " + row.op + " b) d = 1;",
                    {"SET H400 = H420", "ADD H420 + 1", "JMP H400 " + row.inverse + " H421 , M02",
                     "SET H423 = 1", "M02 : END"});
  }
}

// What else may be a condition.
TEST(Conditions, AreJumpsWhateverTheyAre) {
  expect_sequence("if (-a) b = 1;", {"JMP H420 == 0 , M02", "SET H421 = 1", "M02 : END"});
  expect_sequence("if (a++, b) c = 1;", {"ADD H420 + 1", "JMP H421 == 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if (a ? b : c) d = 1;", {"JMP H420 == 0 , M02", "JMP H421 == 0 , M04", "JMP M03",
                                            "M02 : JMP H422 == 0 , M04", "M03 : SET H423 = 1", "M04 : END"});
  expect_sequence("if ((a = 0)) b = 1;", {"SET H420 = 0", "END"});
  expect_sequence("if ((a = 5)) b = 1;", {"SET H420 = 5", "SET H421 = 1", "END"});
  expect_sequence("if (!(a = 0)) b = 1;", {"SET H420 = 0", "SET H421 = 1", "END"});
  expect_sequence("if (!(a = 5)) b = 1;", {"SET H420 = 5", "END"});
  expect_sequence("if ((a && b) == 1) c = 1;",
                  {"JMP H420 == 0 , M02", "JMP H421 == 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if ((a || b) != 1) c = 1;",
                  {"JMP H420 != 0 , M02", "JMP H421 != 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if (!a == 1) c = 1;", {"JMP H420 != 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if (~a == 1) c = 1;",
                  {"NOT H400 = NOT( H420 )", "JMP H400 != 1 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if ((a & 1) == 1) c = 1;",
                  {"SET H400 = H420", "AND H400 & 1", "JMP H400 == 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if ((a & b) == 0) c = 1;",
                  {"SET H400 = H420", "AND H400 & H421", "JMP H400 != 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if ((a - b) != 0) c = 1;",
                  {"SET H400 = H420", "SUB H400 - H421", "JMP H400 == 0 , M02", "SET H422 = 1", "M02 : END"});
  expect_sequence("if (a < (a = 3)) b = 1;",
                  {"SET H400 = H420", "SET H420 = 3", "JMP H400 >= 3 , M02", "SET H421 = 1", "M02 : END"});
}

// (x >> K) & 1 is the mask of that bit, whichever it is; counts are taken modulo 32 as by the command.
TEST(Conditions, OfASingleBitAreItsMask) {
  for (const int bit : {0, 1, 3, 15, 30, 31}) {
    const std::string mask = std::to_string(static_cast<int32_t>(1U << bit));
    const std::string shift = bit == 0 ? "32" : std::to_string(bit);  // a shift by 0 is none
    expect_sequence(
        "if ((a >> " + shift + ") & 1) b = 1;",
        {"SET H400 = H420", "AND H400 & " + mask, "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"});
    expect_sequence("while ((a >> " + shift + ") & 1);",
                    {"SET H400 = H420", "AND H400 & " + mask, "JMP H400 != 0 , M01", "END"});
  }
  expect_sequence("if ((a << 3) & 1) b = 1;", {"SET H400 = H420", "SHL H400 << 3", "AND H400 & 1",
                                               "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"});
  expect_sequence("if ((a >> 3) & 3) b = 1;", {"SET H400 = H420", "ASHR H400 >> 3", "AND H400 & 3",
                                               "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"});
  expect_sequence("if ((a >> 3) | 1) b = 1;", {"SET H400 = H420", "ASHR H400 >> 3", "OR H400 | 1",
                                               "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"});
}

// Loops: what is asked at their beginning, where continue and break lead, what nobody reaches.
TEST(Loops, AskOnceATurn) {
  expect_sequence("while (a) b++;",
                  {"JMP H420 == 0 , M03", "M02 : ADD H421 + 1", "JMP H420 != 0 , M02", "M03 : END"});
  expect_sequence("while (!(a < b)) c++;",
                  {"JMP H420 < H421 , M03", "M02 : ADD H422 + 1", "JMP H420 >= H421 , M02", "M03 : END"});
  expect_sequence("while (a < b + 1) c++;", {"JMP M03", "M02 : ADD H422 + 1", "M03 : SET H400 = H421",
                                             "ADD H400 + 1", "JMP H420 < H400 , M02", "END"});
  expect_sequence("while (-a) c++;", {"JMP M03", "M02 : ADD H422 + 1", "M03 : JMP H420 != 0 , M02", "END"});
  expect_sequence("while (5) a++;", {"ADD H420 + 1", "JMP M01"});
  expect_sequence("do a++; while (0);", {"ADD H420 + 1", "END"});
  expect_sequence("do a++; while (1);", {"ADD H420 + 1", "JMP M01"});
  expect_sequence("do { if (a) continue; b++; } while (c);",
                  {"JMP H420 != 0 , M02", "ADD H421 + 1", "M02 : JMP H422 != 0 , M01", "END"});
  expect_sequence("do { if (a) break; b++; } while (c);",
                  {"JMP H420 != 0 , M02", "ADD H421 + 1", "JMP H422 != 0 , M01", "M02 : END"});
  expect_sequence("for (;; a++) { if (b) continue; c++; }",
                  {"JMP H421 != 0 , M02", "ADD H422 + 1", "M02 : ADD H420 + 1", "JMP M01"});
  expect_sequence("for (a = 0; a & 1; a++) b++;",
                  {"SET H420 = 0", "JMP M03", "M02 : ADD H421 + 1", "ADD H420 + 1", "M03 : SET H400 = H420",
                   "AND H400 & 1", "JMP H400 != 0 , M02", "END"});
  expect_sequence("for (a += 0; a < 3; a++) b++;", {"JMP H420 >= 3 , M03", "M02 : ADD H421 + 1",
                                                    "ADD H420 + 1", "JMP H420 < 3 , M02", "M03 : END"});
  // The unit may change a system variable at once.
  expect_sequence("for (H492 = 0; H492 < 3; H492++) b++;",
                  {"SET H492 = 0", "JMP H492 >= 3 , M03", "M02 : ADD H421 + 1", "ADD H492 + 1",
                   "JMP H492 < 3 , M02", "M03 : END"});
  // Of nested ones the inner one.
  expect_sequence("while (a) { while (b) { if (c) break; if (d) continue; v[0]++; } v[1]++; }",
                  {"JMP H420 == 0 , M06", "M02 : JMP H421 == 0 , M05", "M03 : JMP H422 != 0 , M05",
                   "JMP H423 != 0 , M04", "ADD H424 + 1", "M04 : JMP H421 != 0 , M03", "M05 : ADD H425 + 1",
                   "JMP H420 != 0 , M02", "M06 : END"});
  // A way out is the END itself, and what nobody reaches is not there.
  expect_sequence(
      "while (1) { b++; if (a) { c = 1; break; } d++; }",
      {"ADD H421 + 1", "JMP H420 == 0 , M02", "SET H422 = 1", "END", "M02 : ADD H423 + 1", "JMP M01"});
  expect_sequence("a = 1; return; b = 2;", {"SET H420 = 1", "END"});
  expect_sequence("while (1) { } a = 1;", {"JMP M01"});
}

TEST(Switches, ChooseOnce) {
  // A value that is in a temporary already is not copied, nor is what is compared once only.
  expect_sequence("switch (a + b) { case 1: c = 1; break; case 2: c = 2; }",
                  {"SET H400 = H420", "ADD H400 + H421", "JMP H400 == 1 , M02", "JMP H400 == 2 , M03", "END",
                   "M02 : SET H422 = 1", "END", "M03 : SET H422 = 2", "END"});
  expect_sequence("switch (3) { case 1: b = 1; break; default: b = 2; }", {"SET H421 = 2", "END"});
  expect_sequence("switch (3) { case 1: b = 1; }", {"END"});
  // Continue is the loop's, break the switch's.
  expect_sequence("while (a) { switch (b) { case 1: continue; } c++; }",
                  {"JMP H420 == 0 , M04", "M02 : JMP H421 == 1 , M03", "ADD H422 + 1",
                   "M03 : JMP H420 != 0 , M02", "M04 : END"});
  expect_sequence("while (a) { switch (b) { case 1: break; default: c++; } d++; }",
                  {"JMP H420 == 0 , M04", "M02 : JMP H421 == 1 , M03", "ADD H422 + 1", "M03 : ADD H423 + 1",
                   "JMP H420 != 0 , M02", "M04 : END"});
}

}  // namespace
}  // namespace ipos::compiler::test

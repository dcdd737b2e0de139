// What ipos test --mutate plants: for each kind of mistake the whole list, made by hand, and tests that notice all of it;
// and what is not planted as nobody could see it.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <filesystem>

#include "tests/harness/contains.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

class Operators : public ::testing::Test {
 protected:
  // "5:11: < became <=" for each that is planted into A.IPC.
  std::string planted(const std::string& program) const {
    folder_.write("A.IPC", program);
    const CommandResult list = run_ipos({"test", "--mutate", "--list", "A.IPC"}, folder_.path());
    EXPECT_EQ(list.exit_code, 0) << list.out << list.err;
    std::string rows;
    for (size_t at = 0; at < list.out.size();) {
      const size_t end = list.out.find('\n', at);
      const std::string row = list.out.substr(at, end - at);
      EXPECT_TRUE(row.starts_with("A.IPC:")) << row;
      rows += row.substr(std::string("A.IPC:").size()) + "\n";
      at = end + 1;
    }
    return rows;
  }
  // The list, and that the comments of the program notice each of it.
  void expect_noticed(const std::string& program, const std::string& rows) const {
    EXPECT_EQ(planted(program), rows) << program;
    const auto count = std::count(rows.begin(), rows.end(), '\n');
    const CommandResult result = run_ipos({"test", "--mutate", "A.IPC"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << program << result.out << result.err;
    EXPECT_TRUE(contains(result.out, fmt::format("score 100 % ({0} of {0} noticed)\n", count))) << program << result.out;
  }
  TemporaryFolder folder_;
};

// a is 0, 1, 2, 3; b is the sum of those that the condition takes.
TEST_F(Operators, Comparisons) {
  struct Row {
    const char* op;
    const char* other;
    int sum;
  };
  for (const Row& row : {Row{"<", "<=", 1}, {"<=", "<", 3}, {">", ">=", 3}, {">=", ">", 5}, {"==", "!=", 2}, {"!=", "==", 4}}) {
    const auto n = std::string(row.op).size();
    expect_noticed(fmt::format("long a, b;\nmain()\n{{\n    for (a = 0; a < 4; a++)  // equivalent: given\n"
                               "        if (a {} 2) b = b + a;\n}}\n// expect b == {}\n",
                               row.op, row.sum),
                   fmt::format("5:15: {} became {}\n5:{}: 2 became 3\n5:{}: removed: b = b + a;\n5:{}: b and a swapped\n"
                               "5:{}: + became -\n",
                               row.op, row.other, 16 + n, 19 + n, 19 + n, 25 + n));
  }
}

// The order of the sides matters to half of them: only there swapped variables are a mistake.
TEST_F(Operators, ArithmeticAndSwappedVariables) {
  struct Row {
    const char* op;
    const char* other;
    int value;
    bool symmetric;
  };
  for (const Row& row : {Row{"+", "-", 73, true}, {"-", "+", 67, false}, {"*", "/", 210, true}, {"/", "*", 23, false},
                         {"%", "/", 1, false}, {"<<", ">>", 560, false}, {">>", "<<", 8, false}, {"&", "|", 2, true},
                         {"|", "&", 71, true}, {"^", "|", 69, true}}) {
    const std::string head = "long a, b, c;\nmain()\n{\n    a = 70; b = 3;  // equivalent: given\n";
    const std::string swapped = row.symmetric ? "" : "5:5: a and b swapped\n";
    expect_noticed(head + fmt::format("    c = a {} b;\n}}\n// expect c == {}\n", row.op, row.value),
                   fmt::format("5:5: removed: c = a {0} b;\n5:5: c and a swapped\n{2}5:11: {0} became {1}\n", row.op, row.other,
                               swapped));
    expect_noticed(head + fmt::format("    a {}= b;\n}}\n// expect a == {}\n", row.op, row.value),
                   fmt::format("5:5: removed: a {0}= b;\n5:5: a and b swapped\n5:7: {0}= became {1}=\n", row.op, row.other));
  }
}

// c is the sum over the two bits a and b for which the condition is true: 5, 6, 7 and 9 for 00, 01, 10 and 11.
TEST_F(Operators, Conditions) {
  const auto program = [](const std::string& condition, int sum) {
    return fmt::format("long a, b, c;\nmain()\n{{\n    for (a = 0; a < 2; a++)  // equivalent: given\n"
                       "        for (b = 0; b < 2; b++)  // equivalent: given\n            if ({})\n"
                       "                c = c + a * b + 2 * a + b + 5;  // equivalent: given\n}}\n// expect c == {}\n",
                       condition, sum);
  };
  expect_noticed(program("a && b", 9), "6:17: a became !a\n6:19: && became ||\n6:22: b became !b\n");
  expect_noticed(program("a || b", 22), "6:17: a became !a\n6:19: || became &&\n6:22: b became !b\n");
  expect_noticed(program("!a && b", 6),
                 "6:17: !a became a\n6:17: a and b swapped\n6:20: && became ||\n6:23: b became !b\n");
  // b - a is true where a - b is.
  expect_noticed(program("a - b", 13), "6:17: a - b became !(a - b)\n6:19: - became +\n");
}

TEST_F(Operators, SignsAndSteps) {
  const std::string head = "long a, b;\nmain()\n{\n    a = 70;  // equivalent: given\n";
  expect_noticed(head + "    b = -a;\n}\n// expect b == -70\n// expect a == 70\n",
                 "5:5: removed: b = -a;\n5:5: b and a swapped\n5:9: -a became a\n");
  expect_noticed(head + "    b = ~a;\n}\n// expect b == -71\n// expect a == 70\n",
                 "5:5: removed: b = ~a;\n5:5: b and a swapped\n5:9: ~a became a\n");
  expect_noticed(head + "    b = a * -3;\n}\n// expect b == -210\n// expect a == 70\n",
                 "5:5: removed: b = a * -3;\n5:5: b and a swapped\n5:11: * became /\n5:13: -3 became 3\n");
  // Both take the same value, whichever comes first.
  EXPECT_EQ(planted(head + "    a = b = 6;\n}\n// expect a == 6\n"), "5:5: removed: a = b = 6;\n5:13: 6 became 7\n");
  expect_noticed(head + "    a++;\n    --b;\n}\n// expect a == 71\n// expect b == -1\n",
                 "5:5: removed: a++;\n5:5: ++ became --\n6:5: removed: --b;\n6:5: -- became ++\n");
}

// A constant grows by a tenth, by 1 at least; 0 and 1 are exchanged; a divisor is never 0.
TEST_F(Operators, Constants) {
  const auto program = [](const std::string& value, int number) {
    return fmt::format("long a;\nmain()\n{{\n    a = {};\n}}\n// expect a == {}\n", value, number);
  };
  expect_noticed(program("3", 3), "4:5: removed: a = 3;\n4:9: 3 became 4\n");
  expect_noticed(program("500", 500), "4:5: removed: a = 500;\n4:9: 500 became 550\n");
  expect_noticed(program("0x100", 256), "4:5: removed: a = 0x100;\n4:9: 0x100 became 0x119\n");
  expect_noticed(program("1", 1), "4:5: removed: a = 1;\n4:9: 1 became 0\n");
  expect_noticed(program("-5", -5), "4:5: removed: a = -5;\n4:9: -5 became 5\n");
  expect_noticed(program("2147483647", 2147483647), "4:5: removed: a = 2147483647;\n4:9: 2147483647 became 1932735283\n");
  expect_noticed(program("3 * 4", 12), "4:5: removed: a = 3 * 4;\n4:9: 3 * 4 (12) became 13\n");
  expect_noticed("long a, b;\nmain()\n{\n    a = 7; b = 9;  // equivalent: given\n    b = a % 1;\n}\n// expect b == 0\n// expect a == 7\n",
                 "5:5: removed: b = a % 1;\n5:5: b and a swapped\n5:11: % became /\n5:13: 1 became 2\n");
}

TEST_F(Operators, Masks) {
  const std::string head = "long a, b;\nmain()\n{\n    a = 7;  // equivalent: given\n";
  expect_noticed(head + "    b = a & 4;\n}\n// expect b == 4\n// expect a == 7\n",
                 "5:5: removed: b = a & 4;\n5:5: b and a swapped\n5:11: & became |\n5:13: 4 became 8\n");
  expect_noticed(head + "    b = a & 0x6;\n}\n// expect b == 6\n// expect a == 7\n",
                 "5:5: removed: b = a & 0x6;\n5:5: b and a swapped\n5:11: & became |\n5:13: 0x6 became 0x4\n");
  expect_noticed(head + "    b |= 0x80000000;\n    _BitSet(b, 3);\n}\n// expect b == -2147483640\n",
                 "5:5: removed: b |= 0x80000000;\n5:7: |= became &=\n5:10: 0x80000000 became 0x40000000\n"
                 "6:5: removed: _BitSet(b, 3);\n6:16: bit 3 became bit 4\n");
}

TEST_F(Operators, Waits) {
  expect_noticed("long b;\nmain()\n{\n    _Wait(10);\n    b = 5;  // equivalent: given\n}\n// expect b == 0 at 8ms\n// expect b == 5 at 15ms\n",
                 "4:5: removed: _Wait(10);\n4:11: a wait of 10 ms became one of 20 ms\n");
  // A loop with nothing in it waits. Without its ! it does not; without the loop neither, but this has less code.
  expect_noticed("long a, b;\nmain()\n{\n    while (!a);\n    b = 5;  // equivalent: given\n}\n// expect b == 0 at 30ms\n",
                 "4:5: removed: while (!a);\n4:12: !a became a\n");
}

TEST_F(Operators, KeywordsOfSystemFunctions) {
  EXPECT_EQ(planted("#include <constb.h>\nmain()\n{\n    _GoAbs(GO_WAIT, 3000);\n    _AxisStop(AS_RSTOP);\n}\n// expect H5 == 0\n"),
            "4:5: removed: _GoAbs(GO_WAIT, 3000);\n4:12: GO_WAIT became GO_NOWAIT\n4:21: 3000 became 3300\n"
            "5:5: removed: _AxisStop(AS_RSTOP);\n5:15: AS_RSTOP became AS_HCTRL\n");
  // Every other word of the set works on another structure.
  EXPECT_EQ(planted("#include <constb.h>\nSSPOSRAMP r;\nmain()\n{\n    _SetSys(SS_POSRAMP, r);\n}\n// expect H5 == 0\n"),
            "5:5: removed: _SetSys(SS_POSRAMP, r);\n");
  EXPECT_EQ(planted("#include <constb.h>\nlong n;\nmain()\n{\n    _SetSys(SS_N11, n);\n}\n// expect H5 == 0\n"),
            "5:5: removed: _SetSys(SS_N11, n);\n5:13: SS_N11 became SS_N12\n");
}

TEST_F(Operators, StatementsCasesAndJumps) {
  expect_noticed(
      "long a, b, c;\n"
      "Once()\n"
      "{\n"
      "    if (c == 2) return;\n"
      "    c = c + 2;  // equivalent: given\n"
      "}\n"
      "main()\n"
      "{\n"
      "    for (a = 1; a < 6; a++)\n"
      "    {\n"
      "        if (a == 4) continue;\n"
      "        switch (a)\n"
      "        {\n"
      "            case 1:\n"
      "                b = b + 20;  // equivalent: given\n"
      "                break;\n"
      "            case 3:\n"
      "                b = b + 300;  // equivalent: given\n"
      "                break;\n"
      "            default:\n"
      "                b = b + 4000 + a;  // equivalent: given\n"
      "        }\n"
      "        Once();\n"
      "    }\n"
      "}\n"
      "// expect b == 8327\n// expect a == 6\n// expect c == 2\n",  // 20 for 1, 300 for 3, 4000 + a for 2 and 5
      "4:11: == became !=\n4:14: 2 became 3\n4:17: removed: return;\n"
      "9:10: removed: a = 1\n9:14: 1 became 0\n9:19: < became <=\n9:21: 6 became 7\n9:24: removed: a++\n9:24: ++ became --\n"
      "11:15: == became !=\n11:18: 4 became 5\n11:21: removed: continue;\n"
      "14:13: case 1 became case 2\n16:17: removed: break;\n17:13: case 3 became case 4\n19:17: removed: break;\n"
      "23:9: removed: Once();\n");
}

}  // namespace
}  // namespace ipos::tests

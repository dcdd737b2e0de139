// Commands per construct. Commands are time on the drive, so each sequence is fixed here; all were written by
// hand from the instruction set. a b c d are H420..H423, v is H424..H427, p is H428; temporaries begin at
// H400.
#include <gtest/gtest.h>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

using Lines = std::vector<std::string>;

struct Construct {
  const char* source;
  Lines expected;  // without the END of main
};

class Constructs : public testing::TestWithParam<Construct> {};

TEST_P(Constructs, GiveTheseCommands) {
  Lines expected = GetParam().expected;
  Lines found = main_commands(GetParam().source);
  EXPECT_EQ(expected, found) << GetParam().source;
}

// M01 is always main, as it is a function.
const Construct kAssignments[] = {
    {"", {"M01 : END"}},
    {"a = 5;", {"M01 : SET H420 = 5", "END"}},
    {"a = b;", {"M01 : SET H420 = H421", "END"}},
    {"a = a;", {"M01 : END"}},
    {"a = b = c;", {"M01 : SET H421 = H422", "SET H420 = H421", "END"}},
    {"a = b = 7;", {"M01 : SET H421 = 7", "SET H420 = 7", "END"}},
    {"a = b + c;", {"M01 : SET H420 = H421", "ADD H420 + H422", "END"}},
    {"a = b + 5;", {"M01 : SET H420 = H421", "ADD H420 + 5", "END"}},
    {"a = 5 + a;", {"M01 : ADD H420 + 5", "END"}},
    {"a = a + 1;", {"M01 : ADD H420 + 1", "END"}},
    {"a = b + a;", {"M01 : ADD H420 + H421", "END"}},
    {"a += b;", {"M01 : ADD H420 + H421", "END"}},
    {"a -= 3;", {"M01 : SUB H420 - 3", "END"}},
    {"a *= b; a /= b; a %= b;", {"M01 : MUL H420 * H421", "DIV H420 / H421", "MOD H420 MOD H421", "END"}},
    {"a &= 1; a |= 2; a ^= 4;", {"M01 : AND H420 & 1", "OR H420 | 2", "XOR H420 XOR 4", "END"}},
    {"a <<= 2; a >>= b;", {"M01 : SHL H420 << 2", "ASHR H420 >> H421", "END"}},
    {"a++; --b;", {"M01 : ADD H420 + 1", "SUB H421 - 1", "END"}},
    {"a = ~b;", {"M01 : NOT H420 = NOT( H421 )", "END"}},
    {"a = -a;", {"M01 : MUL H420 * -1", "END"}},
    {"a = -b;", {"M01 : SET H420 = H421", "MUL H420 * -1", "END"}},
    {"a = b - a;", {"M01 : MUL H420 * -1", "ADD H420 + H421", "END"}},
    {"a = 3 - a;", {"M01 : MUL H420 * -1", "ADD H420 + 3", "END"}},
    {"a = 0 - a;", {"M01 : MUL H420 * -1", "END"}},
    {"a = b + 0; c = d * 1;", {"M01 : SET H420 = H421", "SET H422 = H423", "END"}},
    {"a = 2 + 3 * 4;", {"M01 : SET H420 = 14", "END"}},
    {"a = b + c * d;", {"M01 : SET H420 = H422", "MUL H420 * H423", "ADD H420 + H421", "END"}},
    {"a = b - c * d;",
     {"M01 : SET H420 = H421", "SET H400 = H422", "MUL H400 * H423", "SUB H420 - H400", "END"}},
    {"a = (b + c) * (c + d);",
     {"M01 : SET H420 = H421", "ADD H420 + H422", "SET H400 = H422", "ADD H400 + H423", "MUL H420 * H400",
      "END"}},
    {"a = b * c + a;", {"M01 : SET H400 = H421", "MUL H400 * H422", "ADD H420 + H400", "END"}},
    // The target is used on the right: it cannot be the accumulator.
    {"a = b / a;", {"M01 : SET H400 = H421", "DIV H400 / H420", "SET H420 = H400", "END"}},
    {"a = a - b * c;", {"M01 : SET H400 = H421", "MUL H400 * H422", "SUB H420 - H400", "END"}},
    {"a = (b, c);", {"M01 : SET H420 = H422", "END"}},
    {"a = b++;", {"M01 : SET H420 = H421", "ADD H421 + 1", "END"}},
    {"a = ++b;", {"M01 : ADD H421 + 1", "SET H420 = H421", "END"}},
    // Left to right: the first a counts before it changes.
    {"b = a + a++;", {"M01 : SET H421 = H420", "SET H400 = H420", "ADD H420 + 1", "ADD H421 + H400", "END"}},
    {"b = a + (a = 5);", {"M01 : SET H421 = H420", "SET H420 = 5", "ADD H421 + 5", "END"}},
    {"a += (a = 3);", {"M01 : SET H400 = H420", "SET H420 = 3", "ADD H400 + 3", "SET H420 = H400", "END"}},
};
INSTANTIATE_TEST_SUITE_P(Assignments, Constructs, testing::ValuesIn(kAssignments));

const Construct kPlaces[] = {
    {"a = *p;", {"M01 : SETI H420 = [H428]", "END"}},
    {"*p = a;", {"M01 : SETI [H428] = H420", "END"}},
    {"*p = 5;", {"M01 : SET H400 = 5", "SETI [H428] = H400", "END"}},
    {"*5 = 1;", {"M01 : SET H5 = 1", "END"}},
    {"a = *numof(b);", {"M01 : SET H420 = H421", "END"}},
    {"a = numof(v);", {"M01 : SET H420 = 424", "END"}},
    {"*p = *p + 1;", {"M01 : SETI H400 = [H428]", "ADD H400 + 1", "SETI [H428] = H400", "END"}},
    {"*p += a;", {"M01 : SETI H400 = [H428]", "ADD H400 + H420", "SETI [H428] = H400", "END"}},
    // The old value counts even if the right side changes the place, so it is read first then.
    {"*p += a++;",
     {"M01 : SETI H400 = [H428]", "SET H401 = H420", "ADD H420 + 1", "ADD H400 + H401", "SETI [H428] = H400",
      "END"}},
    {"*p -= (a = 5);",
     {"M01 : SETI H400 = [H428]", "SET H420 = 5", "SUB H400 - 5", "SETI [H428] = H400", "END"}},
    {"*p += b * c;",
     {"M01 : SET H400 = H421", "MUL H400 * H422", "SETI H401 = [H428]", "ADD H401 + H400",
      "SETI [H428] = H401", "END"}},
    {"(*p)++;", {"M01 : SETI H400 = [H428]", "ADD H400 + 1", "SETI [H428] = H400", "END"}},
    // The store goes to the old p, the value is the new one.
    {"*p++ = p;", {"M01 : SET H400 = H428", "ADD H428 + 1", "SETI [H400] = H428", "END"}},
    {"*p = p++;", {"M01 : SET H400 = H428", "SET H401 = H428", "ADD H428 + 1", "SETI [H400] = H401", "END"}},
    {"v[2] = a;", {"M01 : SET H426 = H420", "END"}},
    {"a = v[b];", {"M01 : SET H400 = H421", "ADD H400 + 424", "SETI H420 = [H400]", "END"}},
    {"a = v[b + 1];", {"M01 : SET H400 = H421", "ADD H400 + 425", "SETI H420 = [H400]", "END"}},
    {"a = v[b * c];",
     {"M01 : SET H400 = H421", "MUL H400 * H422", "ADD H400 + 424", "SETI H420 = [H400]", "END"}},
    {"a = d - v[b * c];",
     {"M01 : SET H400 = H423", "SET H401 = H421", "MUL H401 * H422", "ADD H401 + 424", "SETI H401 = [H401]",
      "SUB H400 - H401", "SET H420 = H400", "END"}},
    {"v[b] = a;", {"M01 : SET H400 = H421", "ADD H400 + 424", "SETI [H400] = H420", "END"}},
    {"H5 = H007;", {"M01 : SET H5 = H7", "END"}},
    // *p may be a itself, so a cannot hold the sum while it is read.
    {"a = b + *p;", {"M01 : SETI H420 = [H428]", "ADD H420 + H421", "END"}},
    {"a = b - *p;",
     {"M01 : SET H400 = H421", "SETI H401 = [H428]", "SUB H400 - H401", "SET H420 = H400", "END"}},
    // The unit acts on each value of a system variable: it sees only the result.
    {"H492 = a * 4096;", {"M01 : SET H400 = H420", "MUL H400 * 4096", "SET H492 = H400", "END"}},
    {"H481 |= 4;", {"M01 : OR H481 | 4", "END"}},
    {"H492 = H492 + a * b;", {"M01 : SET H400 = H420", "MUL H400 * H421", "ADD H492 + H400", "END"}},
};
INSTANTIATE_TEST_SUITE_P(Places, Constructs, testing::ValuesIn(kPlaces));

const Construct kConditions[] = {
    {"if (a == 3) b = 1;", {"M01 : JMP H420 != 3 , M02", "SET H421 = 1", "M02 : END"}},
    {"if (3 < a) b = 1;", {"M01 : JMP H420 <= 3 , M02", "SET H421 = 1", "M02 : END"}},
    {"if (a >= b) c = 1;", {"M01 : JMP H420 < H421 , M02", "SET H422 = 1", "M02 : END"}},
    {"if (a) b = 1; else b = 2;",
     {"M01 : JMP H420 == 0 , M02", "SET H421 = 1", "END", "M02 : SET H421 = 2", "END"}},
    // The loop around nothing is where the branch leads, in every form of it.
    {"if (a) while (1); b = 2;", {"M01 : JMP H420 == 0 , M03", "M02 : JMP M02", "M03 : SET H421 = 2", "END"}},
    {"if (a) for (;;); b = 2;", {"M01 : JMP H420 == 0 , M03", "M02 : JMP M02", "M03 : SET H421 = 2", "END"}},
    {"if (a < b) do ; while (1); b = 2;",
     {"M01 : JMP H420 >= H421 , M03", "M02 : JMP M02", "M03 : SET H421 = 2", "END"}},
    {"if (!a) b = 1;", {"M01 : JMP H420 != 0 , M02", "SET H421 = 1", "M02 : END"}},
    {"if (1) a = 1;", {"M01 : SET H420 = 1", "END"}},
    {"if (0) a = 1; b = 2;", {"M01 : SET H421 = 2", "END"}},
    {"if (a && b) c = 1;", {"M01 : JMP H420 == 0 , M02", "JMP H421 == 0 , M02", "SET H422 = 1", "M02 : END"}},
    {"if (a || b) c = 1;",
     {"M01 : JMP H420 != 0 , M02", "JMP H421 == 0 , M03", "M02 : SET H422 = 1", "M03 : END"}},
    {"if (!(a < 3 && b)) c = 1;",
     {"M01 : JMP H420 >= 3 , M02", "JMP H421 != 0 , M03", "M02 : SET H422 = 1", "M03 : END"}},
    {"if (a & 4) b = 1;",
     {"M01 : SET H400 = H420", "AND H400 & 4", "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"}},
    // DI03 of io.h
    {"if ((H483 >> 3) & 1) b = 1;",
     {"M01 : SET H400 = H483", "AND H400 & 8", "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"}},
    {"if (((H483 >> 3) & 1) == 1) b = 1;",
     {"M01 : SET H400 = H483", "AND H400 & 8", "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"}},
    {"if (((H483 >> 3) & 1) != 1) b = 1;",
     {"M01 : SET H400 = H483", "AND H400 & 8", "JMP H400 != 0 , M02", "SET H421 = 1", "M02 : END"}},
    // Bits that are no inputs of io.h.
    {"if (a & 1) b = 1;",
     {"M01 : SET H400 = H420", "AND H400 & 1", "JMP H400 == 0 , M02", "SET H421 = 1", "M02 : END"}},
    {"if ((a + 3) & 1) b = 1;",
     {"M01 : SET H400 = H420", "ADD H400 + 3", "AND H400 & 1", "JMP H400 == 0 , M02", "SET H421 = 1",
      "M02 : END"}},
    {"if ((a >> b) & 1) c = 1;",
     {"M01 : SET H400 = H420", "ASHR H400 >> H421", "AND H400 & 1", "JMP H400 == 0 , M02", "SET H422 = 1",
      "M02 : END"}},
    // A comparison with 1 is the condition itself only where there is nothing but 0 and 1.
    {"if ((a < b) == 1) c = 1;", {"M01 : JMP H420 >= H421 , M02", "SET H422 = 1", "M02 : END"}},
    {"if ((a < b) != 1) c = 1;", {"M01 : JMP H420 < H421 , M02", "SET H422 = 1", "M02 : END"}},
    {"if ((a + b) == 1) c = 1;",
     {"M01 : SET H400 = H420", "ADD H400 + H421", "JMP H400 != 1 , M02", "SET H422 = 1", "M02 : END"}},
    {"if ((a & 3) != 1) c = 1;",
     {"M01 : SET H400 = H420", "AND H400 & 3", "JMP H400 == 1 , M02", "SET H422 = 1", "M02 : END"}},
    // Without an effect there is nothing to do (W0216).
    {"a + b * c;", {"M01 : END"}},
    {"a && b == c;", {"M01 : END"}},
    // For what they do alone.
    {"a && (b = 1);", {"M01 : JMP H420 == 0 , M02", "SET H421 = 1", "M02 : END"}},
    {"a || b++;", {"M01 : JMP H420 != 0 , M02", "ADD H421 + 1", "M02 : END"}},
    {"if ((a = b)) c = 1;", {"M01 : SET H420 = H421", "JMP H420 == 0 , M02", "SET H422 = 1", "M02 : END"}},
    {"if (a + b > c) d = 1;",
     {"M01 : SET H400 = H420", "ADD H400 + H421", "JMP H400 <= H422 , M02", "SET H423 = 1", "M02 : END"}},
    {"if (a == a++) b = 1;",
     {"M01 : SET H400 = H420", "SET H401 = H420", "ADD H420 + 1", "JMP H400 != H401 , M02", "SET H421 = 1",
      "M02 : END"}},
    {"a = b < c;", {"M01 : JMP H421 < H422 , M02", "SET H420 = 0", "END", "M02 : SET H420 = 1", "END"}},
    {"a = !b;", {"M01 : JMP H421 == 0 , M02", "SET H420 = 0", "END", "M02 : SET H420 = 1", "END"}},
    {"a = (b < c) + 1;",
     {"M01 : JMP H421 < H422 , M02", "SET H420 = 0", "JMP M03", "M02 : SET H420 = 1", "M03 : ADD H420 + 1",
      "END"}},
    {"a = 1 + (b == 2);",
     {"M01 : JMP H421 == 2 , M02", "SET H420 = 0", "JMP M03", "M02 : SET H420 = 1", "M03 : ADD H420 + 1",
      "END"}},
    {"a = b ? c : 5;", {"M01 : JMP H421 == 0 , M02", "SET H420 = H422", "END", "M02 : SET H420 = 5", "END"}},
    {"a = b > a ? b : a;", {"M01 : JMP H421 <= H420 , M02", "SET H420 = H421", "M02 : END"}},
};
INSTANTIATE_TEST_SUITE_P(Conditions, Constructs, testing::ValuesIn(kConditions));

const Construct kStatements[] = {
    {"while (1);", {"M01 : JMP M01"}},
    {"while (1) a++;", {"M01 : ADD H420 + 1", "JMP M01"}},
    {"while (a < 3) a++;",
     {"M01 : JMP H420 >= 3 , M03", "M02 : ADD H420 + 1", "JMP H420 < 3 , M02", "M03 : END"}},
    {"while (!H483);", {"M01 : JMP H483 != 0 , M03", "M02 : JMP H483 == 0 , M02", "M03 : END"}},
    {"while (0) a = 1;", {"M01 : END"}},
    {"while (a & b) c++;",
     {"M01 : JMP M03", "M02 : ADD H422 + 1", "M03 : SET H400 = H420", "AND H400 & H421",
      "JMP H400 != 0 , M02", "END"}},
    {"do a++; while (a < 3);", {"M01 : ADD H420 + 1", "JMP H420 < 3 , M01", "END"}},
    {"for (a = 0; a < 3; a++) b += a;",
     {"M01 : SET H420 = 0", "M02 : ADD H421 + H420", "ADD H420 + 1", "JMP H420 < 3 , M02", "END"}},
    {"for (a = b; a < 3; a++) c++;",
     {"M01 : SET H420 = H421", "JMP H420 >= 3 , M03", "M02 : ADD H422 + 1", "ADD H420 + 1",
      "JMP H420 < 3 , M02", "M03 : END"}},
    // Only what is true at first for certain is not asked then.
    {"for (; a < 3; a++) b++;",
     {"M01 : JMP H420 >= 3 , M03", "M02 : ADD H421 + 1", "ADD H420 + 1", "JMP H420 < 3 , M02", "M03 : END"}},
    {"for (a = 0; b < 3; a++) b++;",
     {"M01 : SET H420 = 0", "JMP H421 >= 3 , M03", "M02 : ADD H421 + 1", "ADD H420 + 1", "JMP H421 < 3 , M02",
      "M03 : END"}},
    {"for (a = 3; a < 3; a++) b++;",
     {"M01 : SET H420 = 3", "JMP H420 >= 3 , M03", "M02 : ADD H421 + 1", "ADD H420 + 1", "JMP H420 < 3 , M02",
      "M03 : END"}},
    {"for (a = 0; ; a++) b++;", {"M01 : SET H420 = 0", "M02 : ADD H421 + 1", "ADD H420 + 1", "JMP M02"}},
    {"for (;;) { if (a) break; b++; }",
     {"M01 : JMP H420 != 0 , M02", "ADD H421 + 1", "JMP M01", "M02 : END"}},
    {"while (1) { if (a) continue; b++; }", {"M01 : JMP H420 != 0 , M01", "ADD H421 + 1", "JMP M01"}},
    {"switch (a) { case 1: b = 1; break; case 2: b = 2; default: b = 3; }",
     {"M01 : SET H400 = H420", "JMP H400 == 1 , M02", "JMP H400 == 2 , M03", "JMP M04", "M02 : SET H421 = 1",
      "END", "M03 : SET H421 = 2", "M04 : SET H421 = 3", "END"}},
    {"switch (a) { case 1: b = 1; }", {"M01 : JMP H420 != 1 , M02", "SET H421 = 1", "M02 : END"}},
    {"switch (a) { case 1: b = 1; break; case 2: default: b = 2; }",
     {"M01 : SET H400 = H420", "JMP H400 != 1 , M02", "SET H421 = 1", "END", "M02 : SET H421 = 2", "END"}},
    {"switch (2) { case 1: b = 1; break; case 2: b = 2; }", {"M01 : SET H421 = 2", "END"}},
    {"if (a) return; b = 1;", {"M01 : JMP H420 == 0 , M02", "END", "M02 : SET H421 = 1", "END"}},
    {"return; ", {"M01 : END"}},
};
INSTANTIATE_TEST_SUITE_P(Statements, Constructs, testing::ValuesIn(kStatements));

const Construct kSystemCalls[] = {
    {"_Wait(100);", {"M01 : WAIT 100", "END"}},
    {"_Wait(a);", {"M01 : WAIT H420", "END"}},
    {"_Wait(a + 1);", {"M01 : SET H400 = H420", "ADD H400 + 1", "WAIT H400", "END"}},
    {"_GoAbs(1, a);", {"M01 : GOA WAIT H420", "END"}},
    {"_GoRel(0, -4096);", {"M01 : GOR NOWAIT -4096", "END"}},
    {"_Go0(2);", {"M01 : GO0 U,W,CAM", "END"}},
    {"_AxisStop(3);", {"M01 : ASTOP ENABLE", "END"}},
    {"_BitSet(a, 3);", {"M01 : BSET H420.3 = 1", "END"}},
    {"_BitClear(a, 31);", {"M01 : BCLR H420.31 = 0", "END"}},
    {"_BitMove(a, 1, b, 2);", {"M01 : BMOV H420.1 = H421.2", "END"}},
    {"_BitMoveNeg(a, 1, b, 2);", {"M01 : BMOVN H420.1 = NOT H421.2", "END"}},
    {"_Copy(v, a, 4);", {"M01 : COPY H424 = H420 , 4", "END"}},
    {"_GetSys(a, 1);", {"M01 : GETSYS H420 = ACT.SPEED", "END"}},
    {"_SetSys(9, a);", {"M01 : SETSYS POS.RAMP = H420", "END"}},
    {"_FaultReaction(28, 4);", {"M01 : SETFR 28 = RAPID STOP/FAULT", "END"}},
    {"_Memorize(1); _Reset(a); _TouchProbe(1);",
     {"M01 : MEM STORE ALL", "RESET H420", "TOUCHP ENABLE 1", "END"}},
    {"_WdOn(500); _WdOn(a); _WdOff(); _Nop();", {"M01 : WDON 500", "WDON H420", "WDOFF", "NOP", "END"}},
    {"_SBusCommOn(); _SBusCommState(1, a); _MovCommOn(); _MovCommDef(a);",
     {"M01 : SCOMON", "SCOMST START, H420", "MOVON", "MOVCOM H420", "END"}},
    {"_SBusCommDef(2, H10); _SBusComDef(3, H20); _MoviLink(H30); _Movilink(H30);",
     {"M01 : SCOM TRANSMIT ACYCLIC, H10", "SCOM RECEIVE, H20", "MOVLNK H30", "MOVLNK H30", "END"}},
    {"_SystemCall(1, main);", {"M01 : SYSCALL STANDSTILL , M01", "RET"}},
    {"_InputCall(1, 0x0C, main);", {"M01 : INPCALL HIGH 12 , M01", "RET"}},
};
INSTANTIATE_TEST_SUITE_P(SystemCalls, Constructs, testing::ValuesIn(kSystemCalls));

TEST(Functions, MainStandsFirstAndTheOthersInOrder) {
  EXPECT_EQ(
      (Lines{"M01 : CALL M03", "CALL M02", "END", "M02 : ADD H0 + 1", "RET", "M03 : ADD H1 + 1", "RET"}),
      commands(compile_text("f() { H0++; } g() { H1++; } main() { g(); f(); }")));
}

// What is called may change the target: the old value counts, so it is copied first.
TEST(Functions, ACallMayChangeWhatHasBeenRead) {
  EXPECT_EQ((Lines{"M01 : SET H400 = H420", "CALL M02", "ADD H400 + H421", "SET H420 = H400", "END",
                   "M02 : SET H420 = 7", "RET"}),
            commands(compile_text("long a, c; f() { a = 7; } main() { a += (f(), c); }")));
  EXPECT_EQ((Lines{"M01 : SET H400 = H420", "GETSYS H420 = ACT.SPEED", "ADD H400 + H421", "SET H420 = H400",
                   "END"}),
            commands(compile_text("long a, c; main() { a += (_GetSys(a, 1), c); }")));
}

TEST(Functions, UnusedOnesAreLeftOut) {
  EXPECT_EQ((Lines{"M01 : END"}), commands(compile_text("f() { H0++; } main() { }")));
}

TEST(Functions, TasksAndInterruptsAreLabels) {
  EXPECT_EQ((Lines{"M01 : TASK2 START , M02", "TASK START , M02", "SETINT TIMER0 , M03", "VARINT H420 , M03",
                   "END", "M02 : ADD H0 + 1", "RET", "M03 : ADD H1 + 1", "RET"}),
            commands(compile_text("VARINT i; t() { H0++; } r() { H1++; }"
                                  "main() { _SetTask2(1, t); _SetTask(1, t); _SetInterrupt(2, r);"
                                  "         _SetVarInterrupt(i, r); }",
                                  "mdxb")));
}

TEST(Functions, WhatIsOnlyStoppedHasAnAddress) {
  EXPECT_EQ((Lines{"M01 : TASK2 STOP , M02", "END", "M02 : ADD H0 + 1", "RET"}),
            commands(compile_text("t() { H0++; } main() { _SetTask2(0, t); }")));
  // Wherever it stands among the functions, and with others that stand nowhere yet.
  for (const char* text :
       {"main() { _SetTask2(0, t); } t() { H0++; }", "u() { } main() { _SetTask2(0, t); } t() { H0++; }",
        "main() { _SetTask2(0, t); } u() { } t() { H0++; }",
        "main() { _SetTask2(0, t); } t() { H0++; } u() { }"})
    EXPECT_EQ((Lines{"M01 : TASK2 STOP , M02", "END", "M02 : ADD H0 + 1", "RET"}),
              commands(compile_text(text)))
        << text;
  EXPECT_EQ((Lines{"M01 : TASK2 STOP , M02", "SETINT DISABLE , M03", "END", "M02 : ADD H0 + 1", "RET",
                   "M03 : ADD H1 + 1", "RET"}),
            commands(compile_text(
                "main() { _SetTask2(0, t); _SetInterrupt(0, r); } t() { H0++; } r() { H1++; }", "mdxb")));
}

TEST(Structures, MembersAreConsecutiveVariables) {
  EXPECT_EQ((Lines{"M01 : SET H423 = 5", "COPY H420 = H422 , 2", "SET H424 = 1", "END"}),
            commands(compile_text("typedef struct { long x; long y; } PAIR; PAIR p, q; long z;"
                                  "main() { q.y = 5; p = q; z = 1; }")));
}

TEST(Structures, ArraysOfThem) {
  // element i of r is at 420 + 3 i; its member Len is the second variable.
  EXPECT_EQ((Lines{"M01 : SET H424 = 8", "SET H400 = H429", "MUL H400 * 3", "ADD H400 + 421", "SET H401 = 8",
                   "SETI [H400] = H401", "END"}),
            commands(compile_text("SCREC r[3]; long i; main() { r[1].Len = 8; r[i].Format = 8; }")));
}

TEST(Image, HasSymbolsFunctionsAndLines) {
  const Compilation c = compile_text("long a;\nf() { a = 1; }\nmain()\n{\n  f();\n}\n");
  ASSERT_TRUE(c.image);
  EXPECT_EQ((std::vector<vm::Symbol>{{"a", 420, 1}}), c.image->symbols);
  // CALL is 2 words, END 1, SET 2, RET 1.
  EXPECT_EQ((std::vector<vm::FunctionEntry>{{"main", 0}, {"f", 3}}), c.image->functions);
  EXPECT_EQ((std::vector<std::string>{"test.IPC"}), c.image->files);
  EXPECT_EQ((std::vector<vm::LineEntry>{{0, 0, 5, 3}, {2, 0, 6, 1}, {3, 0, 2, 7}, {5, 0, 2, 14}}),
            c.image->lines);
}

TEST(Image, AliasesAreSymbolsOfTheUser) {
  const Compilation c = compile_text("long v[3];\n#declare Second v + 1\nmain() { Second = 2; v[0] = 1; }\n");
  ASSERT_TRUE(c.image);
  EXPECT_EQ((std::vector<vm::Symbol>{{"v", 420, 3}, {"Second", 421, 1}}), c.image->symbols);
}

TEST(Image, SameSourceSameBytes) {
  const std::string text =
      "#include <const.h>\nlong a; t() { a = a * 2 + H0 * 3; }\nmain() { _SetTask2(T2_START, t); t(); }";
  EXPECT_EQ(vm::write_image(*compile_text(text).image), vm::write_image(*compile_text(text).image));
}

TEST(Unit, HeadersOfTheBSeriesSelectIt) {
  EXPECT_EQ("mdxb", compile_text("#include <constb.h>\nmain() { }").unit->name);
  EXPECT_EQ("md60a", compile_text("#include <const.h>\nmain() { }").unit->name);
  EXPECT_EQ("md60a", compile_text("#include <constb.h>\nmain() { }", "md60a").unit->name);
}

}  // namespace
}  // namespace ipos::compiler::test

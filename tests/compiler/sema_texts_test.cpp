// What the messages of the back end say, word for word: the numbers and names in them, where they begin and end, and
// their notes. sema_test.cpp has the codes and what is right.
#include <gtest/gtest.h>

#include <set>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

// '@' begins and '$' ends the place of the message, '`' stands where a note points; they are no part of the program.
// A note with a place begins with '`'.
struct Told {
  std::string source;
  std::string text;
  std::vector<std::string> notes = {};
  const char* unit = "md60a";
};

const std::string kManyMembers =
    "m1, m2, m3, m4, m5, m6, m7, m8, m9, m10, m11, m12, m13, m14, m15, m16, m17, m18, m19, m20";

void PrintTo(const Told& told, std::ostream* out) { *out << told.source; }

std::vector<Told> told_names() {
  return {
      {"long `speed;\nmain() { @sped$ = 1; speed = 2; }", "unknown name 'sped'", {"`did you mean 'speed'?"}},
      {"main() { @helpr$(); helper(); } `helper() { }",
       "unknown function 'helpr'",
       {"`did you mean 'helper'?"}},
      {"main() { H0 = @TargetPos$; }",
       "unknown name 'TargetPos'",
       {"'TargetPos' is the system variable H492; '#include <const.h>' makes it known"}},
      {"main() { H0 = @GO_WAIT$; }",
       "unknown name 'GO_WAIT'",
       {"'GO_WAIT' is a constant of the standard headers; '#include <const.h>' makes it known"}},
      {"main() { H0 = @DI03$; }",
       "unknown name 'DI03'",
       {"'DI03' is an input or output of the standard headers; '#include <io.h>' makes it known"}},
      {"main() { @SET_DO01$; }",
       "unknown name 'SET_DO01'",
       {"'SET_DO01' is a statement of the standard headers; '#include <io.h>' makes it known"}},
      {"`#ifdef SIMULATON\nlong x, `lPos;\n#endif\nmain() { @lPos$ = 1; }",
       "unknown name 'lPos'",
       {"`'lPos' stands here, in a part that is left out", "`by this condition"}},
      {"`#if 0\n#define `LIMIT 5\n#endif\nmain() { H0 = @LIMIT$; }",
       "unknown name 'LIMIT'",
       {"`'LIMIT' stands here, in a part that is left out", "`by this condition"}},
      {"`#if 0\n`Halt() { H1 = 1; }\n#endif\nmain() { @Halt$(); }",
       "unknown function 'Halt'",
       {"`'Halt' stands here, in a part that is left out", "`by this condition"}},
      {"typedef struct { long `speed; long ramp; } `AXIS; AXIS a; main() { a.@sped$ = 1; a.ramp = a.speed; }",
       "AXIS has no member 'sped'",
       {"`did you mean 'speed'?", "`AXIS has speed, ramp"}},
      {"SCREC r; main() { r.@zzzzzz$ = 1; r.Len = 2; }",
       "SCREC has no member 'zzzzzz'",
       {"SCREC has ObjectNo, Format/Len, DPointer"}},
      {"typedef struct { long " + kManyMembers + "; } `S; S s; main() { s.@zzz$ = s.m1; }",
       "S has no member 'zzz'",
       {"`S has " + kManyMembers}},
      {"typedef struct { long " + kManyMembers + ", last; } `S; S s; main() { s.@zzz$ = s.m1; }",
       "S has no member 'zzz'",
       {"`S has " + kManyMembers + ", ..."}},
      {"long `a, @a$; main() { a = 1; }", "'a' is declared twice", {"`first declared here"}},
      {"long `a; @a$() { } main() { a = 1; }", "'a' is declared twice", {"`first declared here"}},
      {"typedef struct { long x; long @x$; } S; S s; main() { s.x = 1; }", "'x' is declared twice"},
      {"long @H12$; main() { }", "'H12' cannot be declared: it is a variable of the unit"},
      {"@_Wait$() { } main() { }", "'_Wait' cannot be declared: it is a system function"},
      {"main() { @late$ = 1; } long `late;", "'late' is used before its declaration", {"`declared here"}},
      {"main() { H0 = @H99999999999$; }",
       "variable H99999999999 does not exist, fault F10 at run time: md60a has H0 to H511"},
      {"main() { H0 = @*512$; }",
       "variable H512 does not exist, fault F10 at run time: md60a has H0 to H511"},
      {"main() { H0 = @*1024$; }",
       "variable H1024 does not exist, fault F10 at run time: mdxb has H0 to H1023",
       {},
       "mdxb"},
      {"#declare A @H511 + 1$\nmain() { }",
       "variable H512 does not exist, fault F10 at run time: md60a has H0 to H511"},
      {"#declare A @H0 + -1$\nmain() { }",
       "variable H-1 does not exist, fault F10 at run time: md60a has H0 to H511"},
  };
}

std::vector<Told> told_objects() {
  return {
      {"f() { } main() { H0 = @f()$; }", "'f' has no result to be used here"},
      {"main() { H0 = @_Wait(5)$; }", "'_Wait' has no result to be used here"},
      {"main() { @5$ = 1; }", "a constant cannot be changed; a variable is needed here"},
      {"main() { @(H0 + 1)$++; }",
       "the result of an expression cannot be changed; a variable is needed here"},
      {"#include <io.h>\nmain() { @DO01$ = 1; }",
       "the result of an expression cannot be changed; a variable is needed here",
       {"'SET_DO01' or 'CLEAR_DO01' changes it"}},
      {"main() { @numof(H1)$ = 1; }",
       "the result of an expression cannot be changed; a variable is needed here"},
      {"main() { H0 = numof(@(H1 + 5)$); }",
       "this expression is no variable and cannot be changed; a variable is needed here"},
      {"long a; main() { a.@x$ = 1; a = 1; }", "'a' is no structure and has no member 'x'"},
      {"SCREC v[2]; main() { v.@Len$ = 1; v[0].Len = 1; }", "'v' is no structure and has no member 'Len'"},
      {"SCREC r; main() { r.Len.@Len$ = 1; }", "'Len' is no structure and has no member 'Len'"},
      {"main() { H5.@x$ = 1; }", "H5 is no structure and has no member 'x'"},
      {"main() { (*5).@x$ = 1; }", "H5 is no structure and has no member 'x'"},
      {"main() { (*H5).@x$ = 1; }", "the variable behind the '*' is no structure and has no member 'x'"},
      {"long a; main() { @a$[1] = 1; a = 1; }", "'a' is no array and has no elements"},
      {"long v[2]; main() { @v[0]$[1] = 1; }", "'v' is no array and has no elements"},
      {"main() { @H3$[1] = 1; }", "H3 is no array and has no elements"},
      {"SCREC r; main() { H0 = @r$; r.Len = 1; }",
       "'r' has no single value; one of its members has, and numof( r ) is its number"},
      {"long v[2]; main() { H0 = @v$; v[0] = 1; }",
       "'v' has no single value; one of its elements has, and numof( v ) is its number"},
      {"typedef struct { long x[2]; SCREC r; } S; S s; main() { H0 = @s.x$; s.r.Len = 1; }",
       "'x' has no single value; one of its elements has"},
      {"typedef struct { long x[2]; SCREC r; } S; S s; main() { H0 = @s.r$; s.x[0] = 1; }",
       "'r' has no single value; one of its members has"},
      {"SCREC r; main() { @r++$; r.Len = 1; }", "'r' has no single value; ++ and -- need one"},
      {"SCREC r, q; main() { H0 = (@r$ = 1); r.Len = q.Len; }",
       "'r' has no single value; it can be assigned as a statement of its own only"},
      {"SCREC r; main() { @r$ = 5; r.Len = 1; }",
       "'r' has no single value; one of its members or elements has"},
      {"SCREC p[2], q; main() { p[0] = q; @p[H0]$ = q; q.Len = 1; }",
       "'p' has no single value; an element found by a computed index is copied member by member; with a "
       "constant "
       "index it is copied as a whole"},
      {"SCREC p[2], q; main() { p[0] = q; q = @p[H0]$; }",
       "'p' has no single value; an element found by a computed index is copied member by member; with a "
       "constant "
       "index it is copied as a whole"},
      {"SCREC r; MLDATA d; main() { @r = d$; r.Len = d.PO1; }",
       "'r' and 'd' differ in type or length; a whole is only copied to its like"},
      {"long a[2], b[3]; main() { @a = b$; b[0] = 1; }",
       "'a' and 'b' differ in type or length; a whole is only copied to its like"},
      {"main() { @_SBusCommOn$; }", "'_SBusCommOn' is a function; '_SBusCommOn()' calls it"},
      {"main() { H0 = @_Wait$; }", "'_Wait' is a function; '_Wait( ... )' calls it"},
      {"f() { } main() { H0 = @f$; f(); }", "'f' is a function; 'f()' calls it"},
      {"f() { } main() { H0 = numof(@f$); f(); }", "'f' is a function; numof( ... ) takes variables"},
      {"long a; main() { @a$(); a = 1; }", "'a' is no function and cannot be called"},
      {"main() { @H5$(); }", "'H5' is no function and cannot be called"},
      {"long `v[3]; main() { v[@3$] = 1; v[0] = 1; }",
       "index 3 is outside of 'v', which has elements 0 to 2",
       {"`declared here"}},
      {"SCREC `v[3]; main() { v[@-1$].Len = 1; v[0].Len = 1; }",
       "index -1 is outside of 'v', which has elements 0 to 2",
       {"`declared here"}},
      {"typedef struct { long x[4]; } S; S `s; main() { s.x[@4$] = 1; s.x[3] = 1; }",
       "index 4 is outside of 'x', which has elements 0 to 3",
       {"`declared here"}},
      {"long v[@0$]; main() { }", "an array has 1 to 512 elements, not 0"},
      {"long v[@-3$]; main() { }", "an array has 1 to 512 elements, not -3"},
      {"long v[@513$]; main() { }", "an array has 1 to 512 elements, not 513"},
      {"long v[@1025$]; main() { }", "an array has 1 to 1024 elements, not 1025", {}, "mdxb"},
  };
}

std::vector<Told> told_calls() {
  return {
      {"main() { @_Wait()$; }", "'_Wait' takes 1 argument, not 0", {"the form is _Wait( value )"}},
      {"main() { @_WdOff(1)$; }", "'_WdOff' takes no arguments, not 1", {"the form is _WdOff(  )"}},
      {"main() { @_BitSet(H0)$; }",
       "'_BitSet' takes 2 arguments, not 1",
       {"the form is _BitSet( variable, bit )"}},
      {"main() { @_GoAbs(1, 2, 3)$; }",
       "'_GoAbs' takes 2 arguments, not 3",
       {"the form is _GoAbs( keyword, value )", "the keyword is one of GO_NOWAIT, GO_WAIT"}},
      {"f() { } main() { f(@1$, 2); f(); }", "'f' takes no arguments, not 2"},
      {"main() { _SBusCommDef(@9$, H0); }",
       "argument 1 of '_SBusCommDef' must be one of SCD_TRCYCL, SCD_TRACYCL, SCD_REC"},
      {"main() { _SetSys(@H1$, H0); }", "argument 1 of '_SetSys' must be one of ~"},
      {"main() { _BitSet(@5$, 1); }", "argument 1 of '_BitSet' must be the name of a variable"},
      {"main() { _BitMove(H0, 1, @H1 + 1$, 2); }", "argument 3 of '_BitMove' must be the name of a variable"},
      {"long v[3]; main() { _Copy(H0, @v[H1]$, 1); v[0] = 1; }",
       "argument 2 of '_Copy' must be the name of a variable"},
      {"main() { _SetTask2(1, @H0$); }",
       "argument 2 of '_SetTask2' must be the name of a function of the program"},
      {"main() { _SetTask2(1, @5$); }",
       "argument 2 of '_SetTask2' must be the name of a function of the program"},
      {"long n; main() { n = 1; _SetTask2(1, @n$); }",
       "argument 2 of '_SetTask2' must be the name of a function of the program"},
      {"main() { _SetTask2(1, @tsk$); }", "unknown function 'tsk'"},
      {"main() { _BitSet(H0, @32$); }", "argument 2 of '_BitSet' must be 0 to 31, not 32"},
      {"main() { _BitClear(H0, @-1$); }", "argument 2 of '_BitClear' must be 0 to 31, not -1"},
      {"main() { _BitMoveNeg(H0, 31, H1, @33$); }", "argument 4 of '_BitMoveNeg' must be 0 to 31, not 33"},
      {"main() { _Copy(H0, H510, @3$); }", "argument 3 of '_Copy' must be 1 to 2, not 3"},
      {"main() { _Copy(H508, H0, @5$); }", "argument 3 of '_Copy' must be 1 to 4, not 5"},
      {"main() { _Copy(H0, H1, @0$); }", "argument 3 of '_Copy' must be 1 to 511, not 0"},
      {"main() { _BitSet(H0, @H1$); }", "argument 2 of '_BitSet' must be a constant"},
      {"main() { _Copy(H0, H5, @H1$); }", "argument 3 of '_Copy' must be a constant"},
      {"main() { _FaultReaction(@H1$, 0); }", "argument 1 of '_FaultReaction' must be a constant"},
      {"main() { _SBusCommDef(1, @H507$); }",
       "variable H512 does not exist, fault F10 at run time: md60a has H0 to H511"},
      {"main() { _SBusCommDef(3, @H510$); }",
       "variable H512 does not exist, fault F10 at run time: md60a has H0 to H511"},
      {"main() { _SBusCommDef(1, @H1019$); }",
       "variable H1024 does not exist, fault F10 at run time: mdxb has H0 to H1023",
       {},
       "mdxb"},
      {"t() { H0++; } main() { @_SetTask$(1, t); }", "'_SetTask' needs task 3, which md60a does not have",
       {"MOVIDRIVE MDX60B/61B has it: '--unit mdxb', or '#include <constb.h>'"}},
      {"t() { H0++; } main() { @_SetTask$(1, t); }",
       "'_SetTask' needs task 3, which mc07 does not have",
       {"MOVIDRIVE MDX60B/61B has it: '--unit mdxb', or '#include <constb.h>'"},
       "mc07"},
      {"VARINT v; t() { H0++; } main() { v.Control = 1; @_SetVarInterrupt$(v, t); }",
       "'_SetVarInterrupt' needs variable interrupts, which md60a does not have",
       {"MOVIDRIVE MDX60B/61B has it: '--unit mdxb', or '#include <constb.h>'"}},
  };
}

std::vector<Told> told_statements() {
  return {
      {"long n; main() { n = 1; switch (n) { case @n$: ; } }", "the value of a case must be a constant"},
      {"long v[@H0$]; main() { }", "the number of elements must be a constant"},
      {"#declare A H0 + @H1$\nmain() { }", "the offset of an alias must be a constant"},
      {"#pragma globals 420 @(H1 + 2)$\nmain() { }", "the bound of a range must be a constant"},
      {"main() { switch (H0) { `case 7: ; @case 3 + 4: ; } }",
       "'case 7' stands twice in this switch",
       {"`the first one is here"}},
      {"main() { switch (H0) { `default: ; @default: ; } }",
       "this switch has two 'default'",
       {"`the first one is here"}},
      {"main() { @case 1: ; H0 = 1; }", "'case' stands outside of a switch"},
      {"main() { @default: ; H0 = 1; }", "'default' stands outside of a switch"},
      {"main() { @break; }", "'break' stands outside of a loop or switch"},
      {"main() { switch (H0) { default: @continue; } }", "'continue' stands outside of a loop"},
      {"typedef struct { } @S$; main() { }", "structure 'S' has no members"},
      {"long @b$; main() { }", "variable 'b' is never used"},
      {"@f$() { } main() { }", "function 'f' is never called or started and is left out"},
      {"main() { H0 = H1 << @33$; }", "a shift by 33 counts as a shift by 1"},
      {"main() { H0 = H1 >> @-1$; }", "a shift by -1 counts as a shift by 31"},
      {"main() { H0 <<= @32$; }", "a shift by 32 counts as a shift by 0"},
      {"main() { H0 >>= @64 + 5$; }", "a shift by 69 counts as a shift by 5"},
      {"main() { H0 /= @0$; }", "division by zero stops the program with fault F10"},
      {"main() { H0 = H1 % @(2 - 2)$; }", "division by zero stops the program with fault F10"},
      {"main() { @H473$ = 1; }", "'StatusWord' (H473) belongs to the unit and is only to be read"},
      {"main() { if (H0 @&$ 6 == H1) H2 = 1; }",
       "'&' binds less than '==': a & b == c is a & (b == c); brackets say what is meant"},
      {"main() { H2 = H0 == H1 @|$ H3; }",
       "'|' binds less than '==': a == b | c is (a == b) | c; brackets say what is meant"},
      {"main() { H2 = H0 < H1 @^$ H3; }",
       "'^' binds less than '<': a < b ^ c is (a < b) ^ c; brackets say what is meant"},
      {"main() { H2 = H0 - H1 @>>$ H3; }",
       "'>>' binds less than '-': a - b >> c is (a - b) >> c; brackets say what is meant"},
      {"main() { H2 = H0 @<<$ H1 + 1; }",
       "'<<' binds less than '+': a << b + c is a << (b + c); brackets say what is meant"},
      {"main() { if (@!H0$ < H1) H2 = 1; }",
       "'<' binds less than '!': !a < b is (!a) < b; brackets say what is meant"},
      {"main() { if (H0 < H1 @<=$ H2) H2 = 1; }",
       "'<=' compares the 0 or 1 that '<' gives; join two comparisons with &&"},
      {"main() { H0 @=+$ 5; }", "'=+' is '=' and a '+' that belongs to what follows; is '+=' meant?"},
      {"main() { H0 @=!$ H1; }", "'=!' is '=' and a '!' that belongs to what follows; is '!=' meant?"},
      {"main() { while (H0)@;$ { H1 = 1; } }",
       "the ';' is the whole body of this 'while'; the block behind it is done once"},
      {"main() { for (H0 = 0; H0 < 3; H0++)@;$ { H1 = 1; } }",
       "the ';' is the whole body of this 'for'; the block behind it is done once"},
      {"#include <const.h>\nmain() { _AxisStop(@GO_WAIT$); }",
       "'GO_WAIT' is no constant for '_AxisStop'; its value 1 is AS_HCTRL there"},
      {"#include <const.h>\nMOVLNK m; main() { m.BusType = @ML_FT_1$; _MoviLink(m); }",
       "'ML_FT_1' is no constant for 'BusType'; its value ~ is ML_BT_~ there"},
  };
}

std::vector<Told> told_blocks() {
  return {
      {"SCREC r; main() { r.Len = 1; _SBusCommDef(1, @r$); }",
       "argument 2 of '_SBusCommDef' should be of type SCTRCYCL, but 'r' is SCREC"},
      {"SCTRCYCL t[2]; main() { t[0].Len = 1; _SBusCommDef(1, @t$); }",
       "argument 2 of '_SBusCommDef' should be of type SCTRCYCL, but 't' is SCTRCYCL[2]"},
      {"long v[6]; main() { v[0] = 1; _SBusCommDef(1, @v$); }",
       "argument 2 of '_SBusCommDef' should be of type SCTRCYCL, but 'v' is long[6]"},
      {"long m; main() { m = 1; _MoviLink(@m$); }",
       "argument 1 of '_MoviLink' should be of type MOVLNK, but 'm' is long"},
      {"long a; main() { _GetSys(@a$, 7); H0 = a; }",
       "argument 1 of '_GetSys' should be of type long[2], but 'a' is long"},
      {"long v[2]; main() { _GetSys(@v$, 0); H0 = v[0]; }",
       "argument 1 of '_GetSys' should be of type long, but 'v' is long[2]"},
      {"long v[13]; main() { _GetSys(@v$, 8); H0 = v[0]; }",
       "argument 1 of '_GetSys' should be of type GSCAM or GSCAM_EXT, but 'v' is long[13]"},
      {"long v[1]; main() { v[0] = 1; _SetSys(9, @v$); }",
       "argument 2 of '_SetSys' should be of type SSPOSRAMP, but 'v' is long[1]"},
      {"MLDATA d; main() { d.PO1 = 1; _SetSys(9, @d$); }",
       "argument 2 of '_SetSys' should be of type SSPOSRAMP, but 'd' is MLDATA"},
      {"typedef struct { long a; } S; S s; main() { s.a = 1; _SetSys(9, @s$); }",
       "argument 2 of '_SetSys' should be of type SSPOSRAMP, but 's' is S"},
      {"typedef struct { MOVLNK m; SCREC r; } S; S s; main() { s.m.Index = s.r.Len; _MoviLink(@s.r$); }",
       "argument 1 of '_MoviLink' should be of type MOVLNK, but 'r' is SCREC"},
  };
}

std::vector<Told> told_ranges() {
  const std::string system = "H453 to H560 are system variables";
  return {
      {"@#pragma globals 452 420$\nmain() { }",
       "range H452 to H420 is not possible: the first number is the larger one"},
      {"@#pragma globals 430 453$\nmain() { }", "range H430 to H453 is not possible: " + system},
      {"@#pragma globals 453 460$\nmain() { }", "range H453 to H460 is not possible: " + system},
      {"@#pragma globals 560 570$\nmain() { }", "range H560 to H570 is not possible: " + system, {}, "mdxb"},
      {"@#pragma globals 440 600$\nmain() { }", "range H440 to H600 is not possible: " + system, {}, "mdxb"},
      {"@#pragma initials 0 H512$\nmain() { }", "range H0 to H512 is not possible: md60a has H0 to H511"},
      {"@#pragma var (-1) 5$\nmain() { }", "range H-1 to H5 is not possible: md60a has H0 to H511"},
      {"@#pragma var 5 (-1)$\nmain() { }", "range H5 to H-1 is not possible: md60a has H0 to H511"},
      {"@#pragma globals 1000 1024$\nmain() { }",
       "range H1000 to H1024 is not possible: mdxb has H0 to H1023",
       {},
       "mdxb"},
      {"@#pragma initials 0 128$\nmain() { }",
       "H128 is lost at power-off; only H0 to H127 keep their values"},
      {"@#pragma var 400 430$\nmain() { }",
       "range H400 to H430 of var overlaps range H420 to H452 of globals"},
      {"@#pragma globals 127 140$\nmain() { }",
       "range H0 to H127 of initials overlaps range H127 to H140 of globals"},
      {"@#pragma globals 300 400$\nmain() { }",
       "range H400 to H419 of var overlaps range H300 to H400 of globals"},
      {"`#pragma var 300 310\n@#pragma var 311 320$\nmain() { }",
       "this #pragma var replaces an earlier one",
       {"`the earlier one"}},
      {"@#pragma globals 561 600$\nmain() { }",
       "H561 is also 'SyncControl'",
       {"the unit works with it; H565 and up are free"},
       "mdxb"},
      {"@#pragma var 564 600$\nmain() { }",
       "H564 is also 'SyncGearSlave'",
       {"the unit works with it; H565 and up are free"},
       "mdxb"},
      {"long `a; main() { a = 1; @H420$ = 2; }", "H420 is also 'a'", {"`'a' is declared here"}},
      {"long `v[3]; main() { v[0] = 1; @H422$ = 2; }", "H422 is also 'v'", {"`'v' is declared here"}},
      // The highest free numbers in a row: below the temporaries of H400, or where a pragma has moved them to.
      {"long a[30], @b$[4]; main() { a[0] = 1; b[0] = 1; }",
       "the global variables need 34 numbers, range H420 to H452 has 33; '#pragma globals 366 399' makes "
       "room"},
      {"#pragma var 200 205\nlong @a$[34], b, c; main() { a[0] = 1; b = c; c = 1; }",
       "the global variables need 36 numbers, range H420 to H452 has 33; '#pragma globals 417 452' makes "
       "room"},
      {"#pragma var 128 131\nlong @a$[300], b[21]; main() { a[0] = 1; b[0] = 1; }",
       "~'#pragma globals 132 452' makes room"},
      {"#pragma var 128 131\nlong @a$[300], b[22]; main() { a[0] = 1; b[0] = 1; }",
       "~there are no 322 free variables in a row"},
      {"#pragma var 128 131\nlong @a$[300], b[22]; main() { a[0] = 1; b[0] = 1; }",
       "~'#pragma globals 702 1023' makes room",
       {},
       "mdxb"},
      {"long @a$[300], b[159]; main() { a[0] = 1; b[0] = 1; }",
       "~'#pragma globals 565 1023' makes room",
       {},
       "mdxb"},
      {"long @a$[300], b[160]; main() { a[0] = 1; b[0] = 1; }",
       "~there are no 460 free variables in a row",
       {},
       "mdxb"},
      {"#pragma initials 0 9\ninitial long a[9], @b$[3]; main() { a[0] = 1; b[0] = 1; }",
       "the initial variables need 12 numbers, range H0 to H9 has 10; '#pragma initials 116 127' makes room"},
      {"#pragma initials 5 100\ninitial long @a$[128]; main() { a[0] = 1; }",
       "the initial variables need 128 numbers, range H5 to H100 has 96; '#pragma initials 0 127' makes "
       "room"},
      {"initial long a[120], @b$[9]; main() { a[0] = 1; b[0] = 1; }",
       "the initial variables need 129 numbers, range H0 to H127 has 128; there are no 129 free variables in "
       "a row"},
      // An alias keeps its numbers free.
      {"#declare KEPT H398\nlong a[30], @b$[4]; main() { a[0] = 1; b[0] = KEPT; }",
       "~'#pragma globals 364 397' makes room"},
  };
}

class ToldMistakes : public testing::TestWithParam<Told> {};

// A '~' in the expected text stands for anything.
bool fits(std::string_view text, std::string_view pattern) {
  const size_t any = pattern.find('~');
  if (any == std::string_view::npos) return text == pattern;
  if (!text.starts_with(pattern.substr(0, any))) return false;
  for (size_t at = any; at <= text.size(); ++at)
    if (fits(text.substr(at), pattern.substr(any + 1))) return true;
  return false;
}

TEST_P(ToldMistakes, AreToldInTheseWords) {
  std::string source;
  size_t begin = std::string::npos;
  size_t end = std::string::npos;
  std::set<size_t> marks;
  for (const char c : GetParam().source) {
    if (c == '@') begin = source.size();
    if (c == '$') end = source.size();
    if (c == '`') marks.insert(source.size());
    if (c != '@' && c != '$' && c != '`') source += c;
  }
  const Compilation c = compile_text(source, GetParam().unit);
  const std::string all = render_text(c.diagnostics.all(), *c.sources, false);
  ASSERT_FALSE(c.diagnostics.all().empty()) << source;
  const Diagnostic& found = c.diagnostics.all()[0];
  EXPECT_EQ(c.diagnostics.all().size(), 1U) << all;
  EXPECT_TRUE(fits(found.text, GetParam().text)) << found.text << "\n" << GetParam().text;
  const uint32_t base = c.sources->files()[0]->base;
  EXPECT_EQ(c.sources->use(found.span.begin).value - base, begin) << all;
  if (end != std::string::npos) {
    EXPECT_EQ(c.sources->use(found.span.end).value - base, end) << all;
  }
  std::vector<std::string> notes;
  std::set<size_t> places;
  for (const Note& note : found.notes) {
    notes.push_back((note.span.begin.valid() ? "`" : "") + note.text);
    if (note.span.begin.valid()) places.insert(note.span.begin.value - base);
  }
  EXPECT_EQ(notes, GetParam().notes) << all;
  EXPECT_EQ(places, marks) << all;
}

INSTANTIATE_TEST_SUITE_P(Names, ToldMistakes, testing::ValuesIn(told_names()));
INSTANTIATE_TEST_SUITE_P(Objects, ToldMistakes, testing::ValuesIn(told_objects()));
INSTANTIATE_TEST_SUITE_P(Calls, ToldMistakes, testing::ValuesIn(told_calls()));
INSTANTIATE_TEST_SUITE_P(Blocks, ToldMistakes, testing::ValuesIn(told_blocks()));
INSTANTIATE_TEST_SUITE_P(Statements, ToldMistakes, testing::ValuesIn(told_statements()));
INSTANTIATE_TEST_SUITE_P(Ranges, ToldMistakes, testing::ValuesIn(told_ranges()));

// A value of the unit is words, which an array or a structure of the program holds as well.
TEST(ToldBlocks, WhatFitsIsNotTold) {
  for (const char* good :
       {"long v[2]; main() { v[0] = 1; _SetSys(9, v); }", "long v[3]; main() { v[0] = 1; _SetSys(9, v); }",
        "typedef struct { long a; long b; } S; S s; main() { s.a = s.b = 1; _SetSys(9, s); }",
        "SSPOSRAMP r; main() { r.Up = r.Down = 1; _SetSys(9, r); }", "long a; main() { _GetSys(a, 0); H0 = a; }",
        "long v[2]; main() { _GetSys(v, 7); H0 = v[0]; }", "long v[14]; main() { _GetSys(v, 8); H0 = v[0]; }",
        "GSCAM_EXT e; main() { e.CamState = 1; _GetSys(e, 8); }", "main() { _SBusCommDef(1, H300); }",
        "#declare A H300\nmain() { _SBusCommDef(1, A); }",
        "long v[2]; main() { v[0] = 1; _SetSys(0, v[1]); v[1] = 2; }", "main() { _SBusCommDef(3, H509); }",
        "main() { _Copy(H0, H510, 2); _Copy(H0, H511, 1); }"})
    EXPECT_EQ(codes(good), std::vector<std::string>{}) << good;
}

}  // namespace
}  // namespace ipos::compiler::test

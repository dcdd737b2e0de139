// Typical mistakes of beginners, of people from C and from PLC languages, and of experts: a table of programs with one mistake each,
// the line of a message and what it must say so that it leads straight to the mend. Rows without words are the mistakes that
// pass in silence: they are listed so that the share is told of all, and are not asked.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

enum class People : uint8_t { Beginner, C, Plc, Expert };

struct TypicalMistake {
  const char* name;
  People people;
  uint32_t line;
  const char* words;  // nullptr: nothing is told
  const char* source;
  const char* unit = nullptr;
};

// Whether a message, or a note of it, stands at the line, and it or one of its notes has the words.
bool leads_to_the_mend(const TypicalMistake& row) {
  CompileOptions options;
  if (row.unit != nullptr) options.unit = stdlib::find_unit(std::string_view(row.unit));
  EXPECT_TRUE(options.warnings.apply("all"));
  const Compilation c = compile("t.IPC", "", row.source, options);
  for (const Diagnostic& one : c.diagnostics.all()) {
    bool here = c.sources->position(one.span.begin).line == row.line;
    bool said = one.text.find(row.words) != std::string::npos;
    for (const Note& note : one.notes) said = said || note.text.find(row.words) != std::string::npos;
    if (here && said) return true;
  }
  return false;
}

class TypicalMistakeOf : public testing::TestWithParam<TypicalMistake> {};
TEST_P(TypicalMistakeOf, LeadsToItsMend) { EXPECT_TRUE(leads_to_the_mend(GetParam())); }

bool is_told(const TypicalMistake& row) { return row.words != nullptr; }

template <size_t kCount>
std::vector<TypicalMistake> told(const TypicalMistake (&rows)[kCount]) {
  std::vector<TypicalMistake> all;
  std::copy_if(std::begin(rows), std::end(rows), std::back_inserter(all), is_told);
  return all;
}

// The classes of the mistakes of an independent list, drawn again.
const TypicalMistake kFirst[] = {
    {"Semicolon", People::Beginner, 4, "';'", R"(long a, b;
main() {
  b = 2;
  a = 1
  b = a;
  H1 = b;
})"},
    {"Brace", People::Beginner, 9, "'}'", R"(long a, b;
main() {
  while (1) {
    if (a > 5) {
      a = 0;
    a = a + 1;
  }
}
other() { b = 1; })"},
    {"Sped", People::Beginner, 4, "'speed'", R"(long speed;
main() {
  speed = 0;
  sped = 100;
  H1 = speed;
})"},
    {"Assignif", People::Beginner, 3, "==", R"(long a, b;
main() {
  if (a = 1) b = 2;
  H1 = b;
})"},
    {"Ifsemi", People::Beginner, 3, "';'", R"(long a, b;
main() {
  if (a > 1);
    b = 2;
  H1 = b;
})"},
    {"Ifsemielse", People::Beginner, 5, "leave it out", R"(long a, b;
main() {
  if (a > 1);
    b = 1;
  else b = 2;
  H1 = b;
})"},
    {"Local", People::Beginner, 2, "outside", R"(main() {
  long x;
  x = 1;
  H1 = x;
})"},
    {"Params", People::Beginner, 2, "variable", R"(long s;
add(long a, long b) { s = a + b; }
main() { add(1, 2); H1 = s; })"},
    {"Result", People::Beginner, 3, "global variable", R"(long s;
main() { s = five(); H1 = s; }
five() { return 5; })"},
    {"Waitcase", People::Beginner, 1, "'_Wait'", R"(main() { _wait(100); })"},
    {"Initvalue", People::Beginner, 1, "main", R"(long x = 5;
main() { H1 = x; })"},
    {"Include", People::Beginner, 4, "#include", R"(MOVLNK m; MLDATA d;
main() {
  m.Address = 1; m.DPointer = numof(d);
  m.BusType = ML_BT_SBUS;
  m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8318;
  _MoviLink(m);
  if (m.Result == 0) H1 = d.ReadPar;
})"},
    {"Csae", People::Beginner, 5, "'case'", R"(long a, b;
main() {
  a = H483;
  switch (a) {
    csae 1: b = 1; break;
    case 2: b = 2; break;
  }
  H1 = b;
})"},
    {"Ifnoparen", People::Beginner, 3, "(", R"(long a, b;
main() {
  if a > 5
    b = 1;
  H1 = b;
})"},
    {"Switchstate", People::Beginner, 5, "3", R"(long state;
main() {
  while (1) switch (state) {
    case 0: if (H483 & 1) state = 1; break;
    case 1: if (H483 & 2) state = 3; break;
    case 2: H1 = 5; state = 0; break;
  }
})"},
    {"Const", People::C, 1, "#define", R"(const long MAX = 5;
main() { H1 = MAX; })"},
    {"Enum", People::C, 1, "#define", R"(enum { IDLE, RUN };
long state;
main() { state = RUN; H1 = state; })"},
    {"Int", People::C, 1, "long", R"(int x;
main() { x = 5; H1 = x; })"},
    {"Printf", People::C, 3, "no texts", R"(long x;
main() { x = 5;
  printf("%d", x);
})"},
    {"Float", People::C, 2, "scale", R"(long x;
main() { x = x * 0.5; H1 = x; })"},
    {"Charlit", People::C, 2, "as a number", R"(long x;
main() { x = 'A'; H1 = x; })"},
    {"Addressof", People::C, 3, "numof", R"(long x, p;
main() { x = 5;
  p = &x; H1 = *p;
})"},
    {"Sizeof", People::C, 2, "number", R"(long x[4], n;
main() { n = sizeof(x); x[0] = n; H1 = x[0]; })"},
    {"Pointerdecl", People::C, 1, "long p", R"(long *p;
main() { p = 10; H1 = *p; })"},
    {"Goto", People::C, 4, "loop", R"(long x;
main() {
again: x++;
  goto again;
})"},
    {"Macroparam", People::C, 1, "parameter", R"(#define MAX(a, b) ((a) > (b) ? (a) : (b))
long x;
main() { x = MAX(x, 5); H1 = x; })"},
    {"Struct", People::C, 1, "typedef", R"(struct Axis { long pos; long speed; };
Axis a;
main() { a.pos = 5; H1 = a.pos; a.speed = 1; H2 = a.speed; })"},
    {"Arrow", People::C, 4, "'.'", R"(#include <const.h>
MOVLNK m; long p;
main() { p = numof(m);
  p->Address = 1; H1 = m.Address; })"},
    {"Beyond", People::C, 2, "3", R"(long a[4];
main() { a[4] = 1; H1 = a[0]; })"},
    {"Overflow", People::C, 2, "-2036334592", R"(long a;
main() { a = 100000 * 65536; H1 = a; })"},
    {"Selfassign", People::C, 3, "itself", R"(long a;
main() { a = H483;
  a = a; H1 = a; })"},
    {"Paren", People::C, 3, "brackets", R"(long a, b, c;
main() { a = H483; b = H482; c = H481;
  if (a == 1 | b == 2 & c > 3) b = 1; H1 = b; })"},
    {"Selfcompare", People::C, 3, "always", R"(long a, b;
main() { a = H483;
  if (a == a) b = 2; H1 = b; })"},
    {"Orne", People::C, 3, "&&", R"(long a, b;
main() { a = H483;
  if (a != 1 || a != 2) b = 3; H1 = b; })"},
    {"Andeq", People::C, 3, "||", R"(long a, b;
main() { a = H483;
  if (a == 1 && a == 2) b = 4; H1 = b; })"},
    {"Indent", People::C, 5, "braces", R"(long a, b, c;
main() { a = H483;
  if (a > 5)
    b = 1;
    c = 2;
  H1 = b + c; })"},
    {"Dangling", People::C, 5, "braces", R"(long a, b, c;
main() { a = H483; b = H482;
  if (a)
    if (b) c = 1;
  else
    c = 2;
  H1 = c; })"},
    {"Divfirst", People::C, 2, "0", R"(long a;
main() { a = H483; a = a * (10 / 4096); H1 = a; })"},
    {"Loopbeyond", People::C, 3, "element 3", R"(long a[4], i;
main() {
  for (i = 0; i <= 4; i++) a[i] = 0;
  H1 = a[0]; })"},
    {"Equalbranches", People::C, 3, "whatever the condition is", R"(long a, b;
main() { a = H483;
  if (a > 5) b = 1; else b = 1;
  H1 = b; })"},
    {"Void", People::C, 2, "f() {", R"(long x;
void f(void) { x = 1; H1 = x; }
main() { f(); })"},
    {"Stars", People::C, 2, "*", R"(long a;
main() { a = 5 ** 2; H1 = a; })"},
    {"Simulaton", People::C, 6, "by this condition", R"(#define SIMULATION 1
#ifdef SIMULATON
long test;
#endif
main() {
  test = 5; H1 = test;
})"},
    {"Octal", People::C, 2, nullptr, R"(long a;
main() { a = 030; H1 = a; })"},
    {"Assign", People::Plc, 2, "'='", R"(long a;
main() { a := 5; H1 = a; })"},
    {"Ifthen", People::Plc, 3, "'if'", R"(long a, b;
main() { a = H483;
  IF a > 5 THEN
    b = 1;
  END_IF
  H1 = b; })"},
    {"Var", People::Plc, 1, "long", R"(VAR
  a : INT;
END_VAR
main() { H1 = a; })"},
    {"Hex16", People::Plc, 2, "0xFF", R"(long a;
main() { a = 16#FF; H1 = a; })"},
    {"Time", People::Plc, 1, "1000", R"(main() { _Wait(T#1s); })"},
    {"Bit", People::Plc, 2, "_BitSet", R"(long a;
main() { a.3 = 1; H1 = a; })"},
    {"Do01", People::Plc, 2, "SET_DO01", R"(#include <iob.h>
main() { DO01 = 1; })"},
    {"Noteq", People::Plc, 2, "!=", R"(long a, b;
main() { a = H483; if (a <> 5) b = 1; H1 = b; })"},
    {"Comment", People::Plc, 1, "/*", R"((* counts parts *)
long a;
main() { a++; H1 = a; })"},
    {"Neighbour", People::Expert, 5, "2 variables", R"(#include <const.h>
SCREC r; long d, guard;
main() {
  guard = 77; r.ObjectNo = 1025; r.Format = 8;
  r.DPointer = numof(d);
  _SBusCommDef(SCD_REC, r); _SBusCommOn();
  while (1) { H1 = d; H2 = guard; } })"},
    {"Pdwords", People::Expert, 6, "variables", R"(#include <const.h>
MOVLNK m; long d; long limit;
main() {
  limit = 5; m.BusType = ML_BT_SBUS; m.Format = ML_FT_3; m.Address = 1;
  while (1) {
  m.DPointer = numof(d);
  _MoviLink(m);
  if (m.Result == 0) H1 = d < limit; } })"},
    {"Selfpointer", People::Expert, 4, "numof", R"(#include <const.h>
SCTRCYCL t;
main() { t.ObjectNo = 1025; t.CycleTime = 10; t.Format = 8;
  t.DPointer = numof(t);
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); })"},
    {"Pointerbeyond", People::Expert, 4, "511", R"(#include <const.h>
SCTRCYCL t;
main() { t.ObjectNo = 1025; t.CycleTime = 10; t.Format = 8;
  t.DPointer = 70000;
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); })"},
    {"Format18", People::Expert, 4, "0 to 8", R"(#include <const.h>
SCTRCYCL t; long d[2];
main() { t.ObjectNo = 1025; t.CycleTime = 10; t.DPointer = numof(d);
  t.Format = 0x18;
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; })"},
    {"Format9", People::Expert, 4, "0 to 8", R"(#include <const.h>
SCTRCYCL t; long d[2];
main() { t.ObjectNo = 1025; t.CycleTime = 10; t.DPointer = numof(d);
  t.Format = 9;
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; })"},
    {"Offset3", People::Expert, 4, "10", R"(#include <const.h>
SCTRCYCL t; long d[2];
main() { t.ObjectNo = 1025; t.CycleTime = 10; t.Format = 8; t.DPointer = numof(d);
  t.Offset = 3;
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; })"},
    {"Bustype7", People::Expert, 4, "5", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);
  m.BusType = 7;
  _MoviLink(m); if (m.Result == 0) H1 = d.ReadPar; })"},
    {"Format99", People::Expert, 4, "0 to 6", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);
  m.Format = 99;
  _MoviLink(m); if (m.Result == 0) H1 = d.ReadPar; })"},
    {"Service", People::Expert, 4, "Service", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Index = 8470; m.DPointer = numof(d);
  _MoviLink(m); if (m.Result == 0) H1 = d.ReadPar; })"},
    {"Address64", People::Expert, 4, "63", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Format = ML_FT_PAR; m.BusType = ML_BT_SBUS; m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);
  m.Address = 64;
  _MoviLink(m); if (m.Result == 0) H1 = d.ReadPar; })"},
    {"Index130", People::Expert, 4, "8470", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.DPointer = numof(d);
  m.Index = 130;
  _MoviLink(m); if (m.Result == 0) H1 = d.ReadPar; })"},
    {"Commonmissing", People::Expert, 4, "_SBusCommOn", R"(#include <const.h>
SCREC r; long a;
main() { r.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);
  _SBusCommDef(SCD_REC, r); while (1) H1 = a; })"},
    {"Twiceobject", People::Expert, 5, "1025", R"(#include <const.h>
SCREC r; long a, b;
main() { r.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);
  _SBusCommDef(SCD_REC, r); r.DPointer = numof(b);
  _SBusCommDef(SCD_REC, r);
  _SBusCommOn(); H1 = a; H2 = b; })"},
    {"Recafteron", People::Expert, 5, "behind _SBusCommOn", R"(#include <const.h>
SCREC r; long a;
main() { r.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);
  _SBusCommOn();
  _SBusCommDef(SCD_REC, r); while (1) H1 = a; })"},
    {"Priority", People::Expert, 5, "Priority", R"(#include <constb.h>
VARINT v; long x, n;
main() { _SetTask2(T2_START, Other);
  v.Control = 1; v.IntNum = 0; v.SrcVar = numof(x); v.CompareVar = 1; v.Mode = VI_EQ;
  _SetVarInterrupt(v, OnX); while (1) x = H483; }
OnX() { n = n + 1; H300 = n; }
Other() { while (1) _Wait(5); })"},
    {"Control", People::Expert, 4, "task", R"(#include <constb.h>
VARINT v; long x, n;
main() { v.Priority = 3; v.IntNum = 0; v.SrcVar = numof(x); v.CompareVar = 1; v.Mode = VI_EQ;
  v.Control = 1;
  _SetVarInterrupt(v, OnX); while (1) x = H483; }
OnX() { n = n + 1; H300 = n; })"},
    {"Timer0", People::Expert, 3, "T0_Reload", R"(#include <const.h>
main() {
  _SetInterrupt(SI_TIMER0, Tick); while (1) H1 = H483; }
Tick() { H300++; })"},
    {"Waitinirq", People::Expert, 4, "a task can do it", R"(#include <const.h>
main() {
  T0_Reload = 100; _SetInterrupt(SI_TIMER0, Tick); while (1) H1 = H483; }
Tick() { _Wait(1000); H300++; })"},
    {"Goabsinirq", People::Expert, 3, "NOWAIT", R"(#include <const.h>
main() { _SetInterrupt(SI_ERROR, OnError); while (1) H1 = H483; }
OnError() { _GoAbs(GO_WAIT, 0); })"},
    {"Movilinkinirq", People::Expert, 4, "a task can do it", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { _SetInterrupt(SI_ERROR, OnError); while (1) H1 = H483; }
OnError() { m.BusType = ML_BT_SBUS; m.Address = 1; m.Format = ML_FT_3; m.DPointer = numof(d); _MoviLink(m); H2 = m.Result; })"},
    {"Twotimers", People::Expert, 6, "Timer_1", R"(#include <constb.h>
long x, y;
main() {
  _SetTask2(T2_START, Second);
  while (1) { Timer_1 = 500; while (Timer_1 > 0) x = !x; } }
Second() { while (1) { Timer_1 = 100; while (Timer_1 > 0) y = !y; } })"},
    {"Bitnumber", People::Expert, 3, "1 << 19", R"(#include <const.h>
main() { while (1)
  if (StatusWord & 19) H1++; })"},
    {"Reserved", People::Expert, 1, "reserved", R"(main() { H470 = 5; })"},
    {"Halfspeed", People::Expert, 2, "CCW", R"(#include <const.h>
SSPOSSPEED s;
main() { s.CW = 1000;
  _SetSys(SS_POSSPEED, s);
  H1 = s.CW; })"},
    {"Resultunread", People::Expert, 4, "Result", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);
  _MoviLink(m); H1 = d.ReadPar; })"},
    {"Memorizeloop", People::Expert, 3, "loop", R"(#include <const.h>
initial long n;
main() { while (1) { n++; _Memorize(MEM_STDATA); _Wait(10); } })"},
    {"Wrloop", People::Expert, 5, "endless loop", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 253; m.BusType = ML_BT_S1; m.Format = ML_FT_PAR; m.Index = 8470; m.DPointer = numof(d);
  while (1) { d.WritePar = H483;
    m.Service = ML_S_WR; _MoviLink(m); H1 = m.Result; _Wait(10); } })"},
    {"Memorize128", People::Expert, 3, "H127", R"(#include <const.h>
long n;
main() { n = H483; _Memorize(MEM_STDATA); H300 = n; })"},
    {"Goabsmc07", People::Expert, 3, "does not position", R"(#include <const.h>
main() {
  _GoAbs(GO_WAIT, 4096); })", "mc07"},
    {"Movcomm", People::Expert, 2, "F10", R"(main() {
  _MovCommOn(); })"},
    {"Watchdog", People::Expert, 3, "100", R"(main() { while (1) {
  _WdOn(10); H1++;
  _Wait(100); } })"},
    {"Stateswitch", People::Expert, 5, "assign", R"(long state;
main() { while (1) switch (state) {
    case 0: if (H483 & 1) state = 1; break;
    case 1: H1 = 5; state = 0; break;
    case 5: H1 = 7; state = 0; break;
  } })"},
    {"Neverruns", People::Expert, 2, "never", R"(long i;
main() { for (i = 10; i < 5; i++) H1++; })"},
    {"Twowriters", People::Expert, 2, "of its own", R"(#include <constb.h>
long count;
main() { _SetTask2(T2_START, Second);
  while (1) { count = count + 1; H1 = count; } }
Second() { while (1) { count = count + 2; _Wait(5); } })"},
    {"Settask", People::Expert, 3, "mdxb", R"(#include <const.h>
main() {
  _SetTask(3, Second); while (1) H1 = H483; }
Second() { while (1) H2++; })", "md60a"},
    {"Varintmd60a", People::Expert, 4, "mdxb", R"(#include <const.h>
VARINT v; long x;
main() { v.Priority = 3; v.Control = 0; v.SrcVar = numof(x); v.CompareVar = 1; v.Mode = 4;
  _SetVarInterrupt(v, OnX); while (1) x = H483; }
OnX() { H300++; })", "md60a"},
    {"Cycletime", People::Expert, 3, "10", R"(#include <const.h>
SCTRCYCL t; long d[2];
main() { t.ObjectNo = 1025; t.CycleTime = 15; t.Format = 8; t.DPointer = numof(d);
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; })"},
    {"Objectno", People::Expert, 3, "2047", R"(#include <const.h>
SCREC r; long a;
main() { r.ObjectNo = 3000; r.Format = 4; r.DPointer = numof(a);
  _SBusCommDef(SCD_REC, r); _SBusCommOn(); while (1) H1 = a; })"},
    {"Wrongtype", People::Expert, 4, "MOVLNK", R"(#include <const.h>
MLDATA d;
main() { d.WritePar = 1;
  _MoviLink(d); H1 = d.ReadPar; })"},
    {"Readonly", People::Expert, 3, "only to be read", R"(#include <const.h>
main() {
  ActPos_Mot = 0; })"},
};

// Drawn afterwards, without a look at what the compiler tells.
const TypicalMistake kSecond[] = {
    {"Dieq", People::Beginner, 3, "==", R"(#include <iob.h>
main() {
  while (1) if (DI00 = 1) H1++; })"},
    {"Whlie", People::Beginner, 4, "'while'", R"(long a;
main() {
  a = 0;
  whlie (1) {
    a++;
    H1 = a;
  }
})"},
    {"Wait05", People::Beginner, 1, "500", R"(main() { _Wait(0.5); })"},
    {"Comma", People::Beginner, 1, "','", R"(long a b;
main() { a = 1; b = a; H1 = b; })"},
    {"Elseif", People::Beginner, 4, "else if", R"(long a, b;
main() { a = H483;
  if (a == 1) b = 1;
  elseif (a == 2) b = 2;
  H1 = b; })"},
    {"Extrabrace", People::Beginner, 7, "'}'", R"(long a;
main() {
  while (1) {
    a++;
    H1 = a;
  } }
}
other() { H2 = 1; })"},
    {"Eqplus", People::Beginner, 3, "+=", R"(long x;
main() { x = H483;
  x =+ 5; H1 = x; })"},
    {"Chain", People::Beginner, 3, "&&", R"(long a, b, c;
main() { a = H483; b = H482; c = H481;
  if (a > b > c) H1 = 1; })"},
    {"Definesemi", People::Beginner, 4, "';'", R"(#define SPEED 1000;
long x;
main() { x = H483;
  if (x > SPEED) H1 = 1; })"},
    {"Forcomma", People::Beginner, 3, "';'", R"(long i;
main() {
  for (i = 0, i < 10, i++) H1++; })"},
    {"Bitsetargs", People::Beginner, 1, "2 arguments", R"(main() { _BitSet(H481, 20, 1); })"},
    {"Casename", People::Beginner, 3, "'speed'", R"(long speed;
main() { speed = 0;
  Speed = 100; H1 = speed; })"},
    {"Ifthen", People::Beginner, 3, "'then'", R"(long a;
main() { a = H483;
  if (a == 1) then a = 2;
  H1 = a; })"},
    {"Umlaut", People::Beginner, 1, "A to Z", R"(long größe;
main() { größe = 5; H1 = größe; })"},
    {"Unsigned", People::C, 1, "long", R"(unsigned char x;
main() { x = 5; H1 = x; })"},
    {"Function", People::C, 2, "variable", R"(long y;
long twice(long x) { return x * 2; }
main() { y = twice(4); H1 = y; })"},
    {"Stdio", People::C, 1, "built-in headers", R"(#include <stdio.h>
main() { H1 = 5; })"},
    {"Caserange", People::C, 3, "each value has a case", R"(long b;
main() { switch (H483) {
    case 1 ... 3: b = 1; break;
    default: b = 0; }
  H1 = b; })"},
    {"Arrayinit", People::C, 1, "main", R"(long a[2] = {1, 2};
main() { H1 = a[0] + a[1]; })"},
    {"Twodim", People::C, 1, "one dimension", R"(long a[2][3];
main() { a[1][2] = 5; H1 = a[0][0]; })"},
    {"Nocolon", People::C, 3, "':'", R"(long x, y;
main() { y = H483;
  x = y == 1 ? 2; H1 = x; })"},
    {"Notequal", People::C, 3, "brackets", R"(long a;
main() { a = H483;
  if (!a == 5) H1 = 1; })"},
    {"Maskequal", People::C, 3, "brackets", R"(long a;
main() { a = H483;
  if (a & 4 == 4) H1 = 1; })"},
    {"Shift32", People::C, 2, "shift by 0", R"(long x;
main() { x = 1 << 32; H1 = x; })"},
    {"Memcpy", People::C, 3, "_Copy", R"(long a[4], b[4];
main() { b[0] = 1;
  memcpy(a, b, 4); H1 = a[0]; })"},
    {"Delay", People::C, 1, "_Wait", R"(main() { delay(100); })"},
    {"Structeq", People::C, 3, "member", R"(#include <const.h>
MLDATA a, b; main() { a.ReadPar = 1; b.ReadPar = 2;
  if (a == b) H1 = 1; })"},
    {"Toobig", People::C, 2, "32 bits", R"(long x;
main() { x = 3000000000; H1 = x; })"},
    {"Selfinc", People::C, 3, "'++' alone", R"(long i;
main() { i = H483;
  i = i++; H1 = i; })"},
    {"Callnoparen", People::C, 2, "reset()", R"(long x;
main() { reset; H1 = x; }
reset() { x = 0; })"},
    {"Functionblock", People::Plc, 1, "FB1() {", R"(FUNCTION_BLOCK FB1
main() { H1 = 5; })"},
    {"Whiledo", People::Plc, 3, "while", R"(long a;
main() {
  WHILE a < 5 DO
    a = a + 1;
  END_WHILE
  H1 = a; })"},
    {"And", People::Plc, 3, "&&", R"(long a, b;
main() { a = H483; b = H482;
  if (a > 1 AND b > 2) H1 = 1; })"},
    {"Dint", People::Plc, 1, "long a", R"(a : DINT;
main() { a = 5; H1 = a; })"},
    {"Int", People::Plc, 1, "long", R"(INT x;
main() { x = 5; H1 = x; })"},
    {"Caseof", People::Plc, 3, "switch (a)", R"(long a, b;
main() { a = H483;
  CASE a OF
    1: b = 1;
    2: b = 2;
  END_CASE
  H1 = b; })"},
    {"True", People::Plc, 2, "1 is true", R"(long a;
main() { a = TRUE; H1 = a; })"},
    {"Bin", People::Plc, 2, "0b1010", R"(long a;
main() { a = 2#1010; H1 = a; })"},
    {"Mw10", People::Plc, 1, "declare", R"(main() { MW10 = 5; })"},
    {"Mod", People::Plc, 2, "%", R"(long a;
main() { a = H483 MOD 2; H1 = a; })"},
    {"Wait5s", People::Plc, 1, "5000", R"(main() { _Wait(5s); })"},
    {"Not", People::Plc, 3, "!", R"(long a;
main() { a = H483;
  if (NOT a) H1 = 1; })"},
    {"E10", People::Plc, 1, "DI00", R"(main() { while (1) if (E1.0) H1++; })"},
    {"P130", People::Plc, 1, "8470", R"(main() { P130 = 500; })"},
    {"Ampersand", People::Expert, 4, "write 'm'", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);
  _MoviLink(&m); if (m.Result == 0) H1 = d.ReadPar; })"},
    {"Numofarg", People::Expert, 4, "name of a variable", R"(#include <const.h>
SCREC r; long a;
main() { r.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);
  _SBusCommDef(SCD_REC, numof(r)); _SBusCommOn(); while (1) H1 = a; })"},
    {"Callarg", People::Expert, 2, "name of a function", R"(#include <const.h>
main() { _SetInterrupt(SI_ERROR, OnError()); while (1) H1 = H483; }
OnError() { H300++; })"},
    {"Dpointervalue", People::Expert, 4, "numof", R"(#include <const.h>
SCREC r; long a;
main() { r.ObjectNo = 1025; r.Format = 4;
  r.DPointer = a;
  _SBusCommDef(SCD_REC, r); _SBusCommOn(); while (1) H1 = a; })"},
    {"Statusword", People::Expert, 2, "only to be read", R"(#include <const.h>
main() { StatusWord = 0; })"},
    {"Go0nine", People::Expert, 2, "GO0_RESET", R"(#include <const.h>
main() { _Go0(9); })"},
    {"Wdonce", People::Expert, 3, "again", R"(long a;
main() {
  _WdOn(100);
  while (1) { a = a + 1; H1 = a; _Wait(20); } })"},
    {"Pinofpd", People::Expert, 5, "process data", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);
  _MoviLink(m); if (m.Result == 0)
  H1 = d.PI1; })"},
    {"Wrnovalue", People::Expert, 4, "WritePar", R"(#include <const.h>
MOVLNK m; MLDATA d;
main() { m.Address = 1; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Service = ML_S_WR; m.Index = 8470; m.DPointer = numof(d);
  _MoviLink(m); H1 = m.Result; H2 = d.ReadPar; })"},
    {"Mask0", People::Expert, 5, "CompareVar", R"(#include <constb.h>
VARINT v; long x, n;
main() { _SetTask2(T2_START, Other);
  v.Priority = 3; v.Control = 1; v.IntNum = 0; v.SrcVar = numof(x); v.Mode = VI_RISING;
  _SetVarInterrupt(v, OnX); while (1) x = H483; }
OnX() { n = n + 1; H300 = n; }
Other() { while (1) _Wait(5); })"},
    {"Srcvarvalue", People::Expert, 5, "numof", R"(#include <constb.h>
VARINT v; long x, n;
main() { _SetTask2(T2_START, Other);
  v.Priority = 3; v.Control = 1; v.IntNum = 0; v.CompareVar = 1; v.Mode = VI_EQ;
  v.SrcVar = x;
  _SetVarInterrupt(v, OnX); while (1) x = H483; }
OnX() { n = n + 1; H300 = n; }
Other() { while (1) _Wait(5); })"},
    {"Bit32", People::Expert, 1, "31", R"(main() { _BitSet(H481, 32); })"},
    {"Beyondh511", People::Expert, 1, "H511", R"(main() { H512 = 5; })", "md60a"},
    {"Definloop", People::Expert, 5, "endless loop", R"(#include <const.h>
SCTRCYCL t; long a;
main() { t.ObjectNo = 1025; t.CycleTime = 10; t.Format = 4; t.DPointer = numof(a);
  while (1) { a = H483;
  _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); } })"},
    {"Sharedmovlnk", People::Expert, 2, "of its own", R"(#include <constb.h>
MOVLNK m; MLDATA d;
main() { m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Service = ML_S_RD; m.DPointer = numof(d);
  _SetTask2(T2_START, Second);
  while (1) {
    m.Address = 1; m.Index = 8318; _MoviLink(m); if (m.Result == 0) H1 = d.ReadPar; _Wait(10); } }
Second() { while (1) { m.Address = 2; m.Index = 8318; _MoviLink(m); if (m.Result == 0) H2 = d.ReadPar; _Wait(10); } })"},
    {"Exactpos", People::Expert, 3, "in position", R"(#include <const.h>
main() { _GoAbs(GO_NOWAIT, 40960); while (1)
  if (ActPos_Mot == 40960) H1 = 1; })"},
};

std::string name_of(const testing::TestParamInfo<TypicalMistake>& row) {
  static constexpr const char* kPeople[] = {"Beginner", "C", "Plc", "Expert"};
  return std::string(kPeople[static_cast<size_t>(row.param.people)]) + row.param.name;
}
INSTANTIATE_TEST_SUITE_P(First, TypicalMistakeOf, testing::ValuesIn(told(kFirst)), name_of);
INSTANTIATE_TEST_SUITE_P(Second, TypicalMistakeOf, testing::ValuesIn(told(kSecond)), name_of);

// The others are all asked above.
TEST(TypicalMistakes, NineOfTenAreTold) {
  EXPECT_GE(std::count_if(std::begin(kFirst), std::end(kFirst), is_told) * 10, std::ssize(kFirst) * 9);
  EXPECT_GE(std::count_if(std::begin(kSecond), std::end(kSecond), is_told) * 10, std::ssize(kSecond) * 9);
}

}  // namespace
}  // namespace ipos::compiler::test

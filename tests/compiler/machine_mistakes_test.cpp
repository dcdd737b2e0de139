// Mistakes that no C compiler can know: a table of programs, each with the messages it gets under -Wall, and beside it the
// same program without the mistake, which gets none. What is right in them: docs/reference/stdlib.md and its manuals.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

struct MachineMistake {
  const char* name;
  const char* source;  // lines from 1
  std::vector<std::string> told;  // "LINE CODE"
  const char* unit = nullptr;
};

std::vector<std::string> told_of_all(const std::string& source, const char* unit) {
  CompileOptions options;
  if (unit != nullptr) options.unit = stdlib::find_unit(std::string_view(unit));
  EXPECT_TRUE(options.warnings.apply("all"));
  const Compilation c = compile("t.IPC", "", source, options);
  std::vector<std::string> out;
  for (const Diagnostic& one : c.diagnostics.all())
    out.push_back(fmt::format("{} {}", c.sources->position(one.span.begin).line, info(one.diag).code));
  return out;
}


class MachineMistakeOf : public testing::TestWithParam<MachineMistake> {};
TEST_P(MachineMistakeOf, IsToldAtItsPlace) { EXPECT_EQ(told_of_all(GetParam().source, GetParam().unit), GetParam().told); }

// The rows of an independent list of mistakes that passed -Wall in silence.
const MachineMistake kMachineMistakes[] = {
    {"ReceivesIntoItsNeighbour",
     "#include <const.h>\nSCREC r; long d, guard;\nmain() {\nguard = 77; r.ObjectNo = 1025; r.Format = 8;\n"
     "r.DPointer = numof(d);\n_SBusCommDef(SCD_REC, r); _SBusCommOn();\nwhile (1) { H1 = d; H2 = guard; } }",
     {"5 W0270"}},
    // 1053 1610 p. 59 declares the two variables of a telegram one by one.
    {"ReceivesIntoTwoVariables",
     "#include <const.h>\nSCREC r; long low, high;\nmain() {\nr.ObjectNo = 1025; r.Format = 8;\nr.DPointer = numof(low);\n"
     "_SBusCommDef(SCD_REC, r); _SBusCommOn();\nwhile (1) { H1 = low; H2 = high; } }",
     {}},
    {"ReceivesFourBytes",
     "#include <const.h>\nSCREC r; long d, guard;\nmain() {\nguard = 77; r.ObjectNo = 1025; r.Format = 4;\n"
     "r.DPointer = numof(d);\n_SBusCommDef(SCD_REC, r); _SBusCommOn();\nwhile (1) { H1 = d; H2 = guard; } }",
     {}},
    {"ReceivesBeyondAnArray",
     "#include <const.h>\nSCREC r; long d[2]; long next;\nmain() {\nr.ObjectNo = 1025; r.Format = 0x108;\n"
     "r.DPointer = numof(d[1]);\n_SBusCommDef(SCD_REC, r); _SBusCommOn();\nwhile (1) { H1 = d[1]; next = 1; } }",
     {"5 W0270"}},
    {"ProcessDataOverANeighbour",
     "#include <const.h>\nMOVLNK m; long d; long limit;\nmain() {\nlimit = 5; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR3;\n"
     "m.Service = ML_S_RD; m.Index = 8318; m.Address = 1;\nm.DPointer = numof(d);\n_MoviLink(m);\n"
     "if (m.Result == 0) H1 = d < limit; }",
     {"6 W0270"}},
    {"ProcessDataIntoMldata",
     "#include <const.h>\nMOVLNK m; MLDATA d; long limit;\nmain() {\nlimit = 5; m.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR3;\n"
     "m.Service = ML_S_RD; m.Index = 8318; m.Address = 1;\nm.DPointer = numof(d);\n_MoviLink(m);\n"
     "if (m.Result == 0) H1 = d.PI1 < limit; }",
     {}},
    {"ObjectSendsItself",
     "#include <const.h>\nSCTRCYCL t;\nmain() {\nt.ObjectNo = 1025; t.CycleTime = 10; t.Format = 8;\nt.DPointer = numof(t);\n"
     "_SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); }",
     {"5 W0271"}},
    {"PointerBeyondTheUnit",
     "#include <const.h>\nSCTRCYCL t;\nmain() {\nt.ObjectNo = 1025; t.CycleTime = 10; t.Format = 8;\nt.DPointer = 511;\n"
     "_SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); }",
     {"5 W0272"}},
    {"PointerBeyondTheUnitInAFunction",
     "#include <const.h>\nSCTRCYCL t;\nmain() {\nt.ObjectNo = 1025; t.CycleTime = 10; t.Format = 8;\n"
     "Set(); _SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); }\nSet() { t.DPointer = 70000; }",
     {"6 W0272"}},
    {"FormatOfAnObject",
     "#include <const.h>\nSCTRCYCL t; long d[2];\nmain() {\nt.ObjectNo = 1025; t.CycleTime = 10; t.DPointer = numof(d);\n"
     "t.Format = 0x18;\n_SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; }",
     {"5 W0273"}},
    {"OffsetOfAnObject",
     "#include <const.h>\nSCTRCYCL t; long d[2];\nmain() {\nt.ObjectNo = 1025; t.CycleTime = 10; t.DPointer = numof(d);\n"
     "t.Format = 8; t.Offset = 3;\n_SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; }",
     {"5 W0273"}},
    // 1 to 9 ms have offsets in steps of 1 ms below the cycle time (1053 1610 p. 54).
    {"OffsetOfAFastObject",
     "#include <const.h>\nSCTRCYCL t; long d[2];\nmain() {\nt.ObjectNo = 1025; t.CycleTime = 5; t.DPointer = numof(d);\n"
     "t.Format = 8; t.Offset = 3;\n_SBusCommDef(SCD_TRCYCL, t); _SBusCommOn(); d[0] = 1; }",
     {}},
    {"SameObjectTwice",
     "#include <const.h>\nSCREC r; long a, b;\nmain() {\nr.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);\n"
     "_SBusCommDef(SCD_REC, r);\nr.DPointer = numof(b);\n_SBusCommDef(SCD_REC, r);\n_SBusCommOn(); H1 = a; H2 = b; }",
     {"7 W0274"}},
    {"SameObjectInTwoBranches",
     "#include <const.h>\nSCREC r; long a, b;\nmain() {\nr.ObjectNo = 1025; r.Format = 4;\nif (H483 & 1) {\n"
     "r.DPointer = numof(a); _SBusCommDef(SCD_REC, r); } else {\nr.DPointer = numof(b); _SBusCommDef(SCD_REC, r); }\n"
     "_SBusCommOn(); H1 = a; H2 = b; }",
     {}},
    {"ReceiveObjectTooLate",
     "#include <const.h>\nSCREC r; long a;\nmain() {\nr.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);\nStart();\n"
     "_SBusCommDef(SCD_REC, r); H1 = a; }\nStart() { _SBusCommOn(); }",
     {"6 W0275"}},
    {"NothingStartsTheObjects",
     "#include <const.h>\nSCREC r; long a;\nmain() {\nr.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);\n"
     "_SBusCommDef(SCD_REC, r); H1 = a; }",
     {"5 W0276"}},
    {"AcyclicObjectNeedsNoStart",
     "#include <const.h>\nSCTRACYCL t; long a;\nmain() {\nt.ObjectNo = 1025; t.Format = 4; t.DPointer = numof(a); a = 1;\n"
     "_SBusCommDef(SCD_TRACYCL, t); }",
     {}},
    {"ValuesOfMovilink",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = 7;\nm.Address = 1; m.Format = 99;\n"
     "m.Service = ML_S_RD; m.Index = 130;\nm.DPointer = numof(d); _MoviLink(m);\nif (m.Result == 0) H1 = d.ReadPar; }",
     {"4 W0277", "5 W0277", "6 W0277"}},
    {"AddressOnAnSbus",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR;\nm.Address = 64;\n"
     "m.Service = ML_S_RD; m.Index = 8470;\nm.DPointer = numof(d); _MoviLink(m);\nif (m.Result == 0) H1 = d.ReadPar; }",
     {"5 W0277"}},
    // RS-485 has addresses 0 to 99 (1053 1610 p. 20).
    {"AddressOnRs485",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = ML_BT_S1; m.Format = ML_FT_PAR;\nm.Address = 64;\n"
     "m.Service = ML_S_RD; m.Index = 8470;\nm.DPointer = numof(d); _MoviLink(m);\nif (m.Result == 0) H1 = d.ReadPar; }",
     {}},
    {"ServiceNeverSet",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Address = 4;\n"
     "m.Index = 8470; m.DPointer = numof(d);\n_MoviLink(m);\nif (m.Result == 0) H1 = d.ReadPar; }",
     {"6 W0277"}},
    // IPOSplus p. 309: the second SBus is that of MOVIDRIVE B.
    {"BusOfAnotherUnit",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = 8;\nm.Format = ML_FT_PAR; m.Address = 4;\n"
     "m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);\n_MoviLink(m);\nif (m.Result == 0) H1 = d.ReadPar; }",
     {"4 W0277"},
     "mc07"},
    {"PriorityNeverSet",
     "#include <constb.h>\nVARINT v; long x;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 1; v.SrcVar = numof(x);\n"
     "v.CompareVar = 1; v.Mode = VI_EQ;\n_SetVarInterrupt(v, OnX);\nwhile (1) x = H483; }\nOnX() { H300++; }\n"
     "Other() { while (1) _Wait(5); }",
     {"7 W0279"}},
    {"MaskWithoutABit",
     "#include <constb.h>\nVARINT v; long x;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 1; v.SrcVar = numof(x);\n"
     "v.Mode = VI_RISING; v.Priority = 3;\n_SetVarInterrupt(v, OnX);\nwhile (1) x = H483; }\nOnX() { H300++; }\n"
     "Other() { while (1) _Wait(5); }",
     {"7 W0279"}},
    {"TaskOfTheInterruptNeverRuns",
     "#include <constb.h>\nVARINT v; long x;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 2;\nv.SrcVar = numof(x);\n"
     "v.CompareVar = 1; v.Mode = VI_EQ; v.Priority = 3;\n_SetVarInterrupt(v, OnX);\nwhile (1) x = H483; }\n"
     "OnX() { H300++; }\nOther() { while (1) _Wait(5); }",
     {"5 W0279"}},
    {"PriorityAndModeOutOfRange",
     "#include <constb.h>\nVARINT v; long x;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 1; v.SrcVar = numof(x);\n"
     "v.CompareVar = 1;\nv.Mode = 10;\nv.Priority = 11;\n_SetVarInterrupt(v, OnX);\nwhile (1) x = H483; }\n"
     "OnX() { H300++; }\nOther() { while (1) _Wait(5); }",
     {"7 W0278", "8 W0278"}},
    {"TimerInterruptWithoutATime",
     "#include <const.h>\nlong n;\nmain() {\n_SetInterrupt(SI_TIMER0, Tick);\nwhile (1) H1 = n; }\nTick() { n = n + 1; }",
     {"4 W0280"}},
    {"TimerInterruptSetOnce",
     "#include <const.h>\nlong n;\nmain() {\n_SetInterrupt(SI_TIMER0, Tick); Timer_0 = 10;\nwhile (1) H1 = n; }\n"
     "Tick() { n = n + 1; }",
     {}},
    {"WaitInAnInterrupt",
     "#include <const.h>\nlong n;\nmain() {\nT0_Reload = 100; _SetInterrupt(SI_TIMER0, Tick);\nwhile (1) H1 = n; }\n"
     "Tick() { Pause(); n = n + 1; }\nPause() {\n_Wait(10); }",
     {"8 W0281"}},
    {"TravelInAnInterrupt",
     "#include <constb.h>\nlong n;\nmain() {\n_SetInterrupt(SI_ERROR, Home);\nwhile (1) H1 = n; }\n"
     "Home() {\n_Go0(GO0_C_NW_ZP);\n_GoAbs(GO_NOWAIT, 5);\n_GoAbs(GO_WAIT, 5);\n_Go0(GO0_C_W_ZP); n = n + 1; }",
     {"9 W0281", "10 W0281"}},
    {"ExchangeInAnInterrupt",
     "#include <const.h>\nMOVLNK m, own; MLDATA d;\nmain() {\n_SetInterrupt(SI_ERROR, Ask);\nwhile (1); }\nAsk() {\n"
     "m.BusType = ML_BT_SBUS; m.Address = 1; m.Format = ML_FT_3; m.DPointer = numof(d);\n_MoviLink(m); H1 = m.Result;\n"
     "own.Address = 253; own.Format = ML_FT_3; own.DPointer = numof(d);\n_MoviLink(own); H1 = d.PI1; }",
     {"8 W0281"}},
    {"WaitLongerThanTheWatchdog",
     "main() {\nwhile (1) {\n_WdOn(10); H1++;\n_Wait(100); } }",
     {"4 W0282"}},
    {"WatchdogStoppedBeforeTheWait",
     "main() {\nwhile (1) {\n_WdOn(10); H1++; _WdOff();\n_Wait(100); } }",
     {}},
    {"WatchdogThatAnotherTaskFeeds",
     "#include <const.h>\nmain() {\n_SetTask2(T2_START, Feed);\nwhile (1) {\n_WdOn(10); H1++;\n_Wait(100); } }\n"
     "Feed() { while (1) { _WdOn(10); _Wait(5); } }",
     {}},
    // 60 + 60 of 100 ms.
    {"WaitsTogetherLongerThanTheWatchdog",
     "main() {\nwhile (1) {\n_WdOn(100); H1++;\nPause(); H2++;\nPause(); } }\nPause() {\n_Wait(60); }",
     {"7 W0282"}},
    {"WaitsTogetherAsLongAsTheWatchdog",
     "main() {\nwhile (1) {\n_WdOn(100); H1++;\nPause(); H2++;\nPause(); } }\nPause() {\n_Wait(50); }",
     {}},
    {"WaitsThatAreComputed",
     "long time, pause;\nmain() {\ntime = 50; pause = time * 2;\nwhile (1) {\n_WdOn(time); H1++;\n_Wait(pause); } }",
     {"6 W0282"}},
    {"WaitBehindALoopOfWaits",
     "main() {\n_WdOn(100);\nwhile (!(H483 & 1)) _Wait(5);\n_Wait(200); _WdOff(); }",
     {"4 W0282"}},
    {"WatchdogThatNothingFeeds",
     "long a;\nmain() {\n_WdOn(100);\nfor (;;) { a = a + 1; H1 = a; _Wait(20); } }",
     {"3 W0295"}},
    {"WatchdogOfAFunctionThatNothingFeeds",
     "#include <const.h>\n#define FOREVER do {\n#define AGAIN } while (1)\nlong a;\nmain() {\nStart(); Work(); }\nStart() {\n"
     "if (H483 & 1) _WdOn(500); else\n_WdOn(200); }\nWork() { FOREVER a = a + 1; H1 = a; AGAIN; }",
     {"9 W0295"}},
    {"WatchdogOfATaskThatNothingFeeds",
     "#include <constb.h>\nmain() {\n_SetTask(T2_START, Third);\nwhile (1) H1++; }\nThird() {\n_WdOn(100);\nwhile (1) { H2++; } }",
     {"6 W0295"},
     "mdxb"},
    {"WatchdogAtTheEndOfTheProgram", "main() {\nH1++;\n_WdOn(100);\n_Wait(50); H2++; }", {"3 W0295"}},
    {"WatchdogThatAFunctionFeeds", "#include <const.h>\nmain() {\n_WdOn(100);\nwhile (1) { H1++; Feed(); } }\nFeed() { WdogTimer = 100; }", {}},
    {"WatchdogThatIsFedAtTimes",
     "main() {\n_WdOn(100);\nwhile (1) { H1++; if (H483 & 1) _WdOn(100); } }", {}},
    {"WatchdogThatARoutineFeeds",
     "#include <const.h>\nmain() {\nT0_Reload = 50; _SetInterrupt(SI_TIMER0, Tick); _WdOn(100);\nwhile (1) H1++; }\nTick() { _WdOn(100); }",
     {}},
    {"WatchdogOfALoopThatIsLeft",
     "main() {\n_WdOn(100);\nwhile (1) { H1++; if (H483 & 1) break; }\n_WdOff();\nwhile (1) H2++; }", {}},
    {"WatchdogOfAFunctionThatReturns",
     "main() {\nwhile (1) { _WdOn(100); Look(); } }\nLook() { while (1) { H1++; if (H483 & 1) return; } }", {}},
    {"WatchdogThatIsNeverReached", "main() {\nwhile (1) H1++;\n_WdOn(100);\nwhile (1) H2++; }", {"3 W0203"}},
    {"WatchdogWrittenButNotStarted", "#include <const.h>\nmain() {\nWdogTimer = 100;\nwhile (1) { H1++; _Wait(200); } }", {}},
    {"NoProcessData",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.Format = ML_FT_PAR; m.Service = ML_S_RD; m.BusType = ML_BT_SBUS; m.Address = 4; m.Index = 8470; m.DPointer = numof(d);\nAsk();\nShow(); }\n"
     "Ask() { _MoviLink(m); H1 = m.Result; }\nShow() {\nH3 = d.ReadPar; H2 = d.PI1; }",
     {"9 W0296"}},
    {"FewerProcessData",
     "#include <const.h>\nMOVLNK m; MLDATA d[2];\nmain() {\nm.Format = ML_FT_2; m.BusType = ML_BT_SBUS; m.Address = 4; m.Index = 8470; m.DPointer = numof(d);\n_MoviLink(m); H1 = m.Result;\n"
     "H2 = d[0].PI2;\nH3 = d[0].PI3;\nH4 = d[0].ReadPar; }",
     {"8 W0296", "7 W0296"}},
    {"ProcessDataOfAnotherExchange",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.Service = ML_S_RD; m.BusType = ML_BT_SBUS; m.Address = 4; m.Index = 8470; m.DPointer = numof(d);\nwhile (1) {\n"
     "if (H483 & 1) m.Format = ML_FT_PAR; else m.Format = ML_FT_1;\n_MoviLink(m); H1 = m.Result;\nH3 = d.ReadPar; H2 = d.PI1; } }",
     {}},
    {"ProcessDataOfAComputedFormat",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.Service = ML_S_RD; m.BusType = ML_BT_SBUS; m.Address = 4; m.Index = 8470; m.DPointer = numof(d);\nm.Format = H3;\n_MoviLink(m); H1 = m.Result; H2 = d.PI3; }",
     {}},
    {"WriteWithoutAValue",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.Format = ML_FT_PAR; m.Service = ML_S_WRV; m.BusType = ML_BT_SBUS; m.Address = 4; m.Index = 8470; m.DPointer = numof(d);\n_MoviLink(m); H1 = m.Result; }",
     {"5 W0297"}},
    {"WriteWithAValue",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.Format = ML_FT_PAR; m.Service = ML_S_WRV; m.BusType = ML_BT_SBUS; m.Address = 4; m.Index = 8470; m.DPointer = numof(d); d.WritePar = 0;\n_MoviLink(m); H1 = m.Result; }",
     {}},
    {"ObjectInAnEndlessLoop",
     "#include <const.h>\nSCREC r; long a;\nmain() {\nr.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(a);\nwhile (1) {\nH1 = a; Define(); _SBusCommOn(); } }\n"
     "Define() {\n_SBusCommDef(SCD_REC, r); }",
     {"8 W0274"}},
    {"TelegramInAnEndlessLoop",
     "#include <const.h>\nSCTRACYCL t; long a;\nmain() {\nt.ObjectNo = 1025; t.Format = 4; t.DPointer = numof(a);\n"
     "while (1) { a = H483; _SBusCommDef(SCD_TRACYCL, t); _Wait(10); } }",
     {}},
    {"ObjectsOfALoop",
     "#include <const.h>\nSCREC r; long a[3], i;\nmain() {\nr.Format = 4;\nfor (i = 0; i < 3; i++) {\nr.ObjectNo = 1025 + i; r.DPointer = numof(a[0]) + i;\n"
     "_SBusCommDef(SCD_REC, r); }\n_SBusCommOn(); while (1) H1 = a[0]; }",
     {}},
    {"ExactPosition", "#include <const.h>\n#define GOAL 40960\nmain() {\n_GoAbs(GO_NOWAIT, GOAL);\nif (ActPos_Mot == GOAL) H1 = 1; }", {"5 W0298"}},
    {"ExactPositionOfACopy",
     "#include <const.h>\nlong now, goal;\nmain() {\ngoal = 40960 + H483; _GoAbs(GO_NOWAIT, goal);\nwhile (1) { Look();\nif (goal == now) H1 = 1; } }\n"
     "Look() { now = ActPos_Ext - 100; }",
     {"6 W0298"}},
    {"ExactPositionEndsALoop", "#include <const.h>\nmain() {\n_GoAbs(GO_NOWAIT, 4096);\nwhile (ActPos_Mot != TargetPos && !(H483 & 1)) ; }", {"4 W0298"}},
    {"PositionThatStands",
     "#include <const.h>\nlong before;\nmain() {\nwhile (ActPos_Mot != before) { before = ActPos_Mot; _Wait(10); }\nif (ActPos_Mot == before) H1 = 1; }",
     {}},
    {"TurnsOfThePosition", "#include <const.h>\nmain() {\nif (ActPos_Mot / 4096 == 10 && ActPos_Mot >= 100) H1 = 1; }", {}},
    {"TimerThatNothingSets", "#include <const.h>\nmain() {\nwhile (1) {\nwhile (Timer_1 > 0) ;\nH1 = 2; } }", {"4 W0257"}},
    {"TimerThatAFunctionSets", "#include <const.h>\nmain() {\nwhile (1) {\nStart();\nwhile (Timer_1 > 0) ; } }\nStart() { Timer_1 = 100; }", {}},
    {"TimerThatReloads", "#include <const.h>\nmain() {\nT0_Reload = 10;\nwhile (1) H1 = Timer_0; }", {}},
    {"TimerThatIsNeverSoHigh",
     "#include <const.h>\n#define LATE 1000\nmain() {\nwhile (1) {\nif (H483 & 1) Timer_1 = 500; else Timer_1 = LATE;\nif (Timer_1 > LATE) H1 = 1;\n"
     "if (Timer_1 > 400) H2 = 1; } }",
     {"6 W0253"}},
    {"TimerThatStays0", "#include <const.h>\nmain() {\nTimer_1 = 0;\nwhile (1) if (Timer_1 > 1000) H1 = 1; }", {"4 W0253"}},
    {"TimerOfAVariable", "#include <const.h>\nlong t;\nmain() {\nt = H483; Timer_1 = t;\nwhile (1) if (Timer_1 > 1000) H1 = 1; }", {}},
    {"TimerInterruptWithAReloadOf0",
     "#include <const.h>\nlong n;\nmain() {\nT0_Reload = 0; _SetInterrupt(SI_TIMER0, Tick);\nwhile (1) H1 = n; }\nTick() { n = n + 1; }",
     {"4 W0280"}},
    {"NameOfABitForAMask", "#include <iob.h>\nmain() {\nwhile (1) { if (H483 & BIT_DI03) H1 = 1; if (H483 & (1 << BIT_DI03)) H2 = 1; } }", {"3 W0293"}},
    {"OwnNameOfAMask", "#include <const.h>\n#define BIT_START 8\nmain() {\nwhile (1) if (InputLevel & BIT_START) H1 = 1; }", {}},
    {"LoopBeyondAnArray",
     "#define SIZE 8\nlong a[SIZE], i, s;\nmain() {\nfor (i = 0; i <= SIZE; i++)\ns = s + a[i];\nfor (i = 0; i < SIZE; i++) a[i] = s; H1 = s; }",
     {"5 W0299"}},
    {"LoopBesideAnArray",
     "long g, a[4], i;\nmain() {\ng = 5;\nfor (i = 3; i >= 0; i--) {\nif (a[i] > a[i - 1]) H1 = g; } a[0] = H483; }",
     {"5 W0299"}},
    {"LoopBeyondStructures",
     "typedef struct { long from; long to; } Way;\nWay w[3]; long i, n;\nmain() {\nfor (i = 0; i < 4; i++) {\nw[i].to = i; } n = w[1].to; H1 = n; }",
     {"5 W0299"}},
    {"LoopsWithinTheirArrays",
     "long a[4], i, last;\nmain() {\nfor (i = 1; i < 4; i++) a[i] = a[i - 1];\nfor (i = 0; i <= 4; i++) { if (i < 4) a[i] = 1; last = i; }\n"
     "for (i = 0; i < 9; i++) { if (a[i] == 0) break; }\nfor (i = 3; i > 0; i--) a[i] = a[i - 1]; H1 = last; }",
     {}},
    {"CopyBeyondAnArray",
     "long from[4], to[4], guard;\nmain() {\nguard = 1; from[0] = H483;\n_Copy(to, from, 5);\nH1 = to[0]; H2 = guard; }",
     {"4 W0270"}},
    {"CopyOfVariablesInARow", "long a, b, c, to[3];\nmain() {\na = H483; b = 1; c = 2;\n_Copy(to, a, 3);\nH1 = to[0]; H2 = b; H3 = c; }", {}},
    {"EdgeThatIsNeverSeen",
     "#include <iob.h>\nlong now, before, n;\nmain() {\nwhile (1) {\nnow = DI02; before = now; H2 = 5;\nif (now && !before) n++;\nH1 = n; } }",
     {"6 W0253"}},
    {"ChangeThatIsNeverSeen",
     "long now, before, n;\nmain() {\nwhile (1) {\nnow = H483; before = now;\nif (n > 5 && now != before) n++;\nH1 = n; } }",
     {"5 W0253"}},
    {"EdgeThatIsSeen",
     "#include <iob.h>\nlong now, before, n;\nmain() {\nwhile (1) {\nnow = DI02; if (now && !before) n++;\nbefore = now; H1 = n; } }",
     {}},
    {"CopyThatChanges",
     "long now, before, n;\nmain() {\nwhile (1) {\nnow = H483; before = now; Next();\nif (now != before) n++;\nH1 = n; } }\nNext() { now = now + n; }",
     {}},
    {"SameConditionTwice",
     "#include <iob.h>\nlong a;\nmain() {\na = H483;\nif (a < 5 && DI00) H1 = 1;\nelse if (a > 9) H1 = 2;\nelse if (a < 5 && DI00) H1 = 3; }",
     {"7 W0253"}},
    {"EqualBranches", "long a;\nmain() {\na = H483;\nif (a) { H1 = 1; H2 = a; }\nelse { H1 = 1; H2 = a; } }", {"5 W0263"}},
    {"BranchesThatDiffer", "long a;\nmain() {\na = H483;\nif (a) { H1 = 1; H2 = a; } else { H1 = 1; H2 = 0; } }", {}},
    {"ProbeThatNothingEnables", "#include <const.h>\nmain() {\nwhile (1) {\nH1 = TpPos1_Mot; } }", {"4 W0269"}},
    {"ProbeThatIsEnabled", "#include <const.h>\nmain() {\n_TouchProbe(TP_EN1); while (1) {\nH1 = TpPos1_Mot; } }", {}},
    {"TaskStartedInEachTurn",
     "#include <const.h>\nlong n;\nmain() {\nwhile (1) {\n_SetTask2(T2_START, Other); H1 = H483; } }\nOther() { while (1) { n = n + 1; H2 = n; _Wait(50); } }",
     {"5 W0242"}},
    {"TaskStartedAgainOnRequest",
     "#include <const.h>\nlong n;\nmain() {\nwhile (1) {\n_SetTask2(T2_START, Other); while (!(H483 & 1)) ; } }\nOther() { while (1) { n = n + 1; H2 = n; _Wait(50); } }",
     {}},
    {"TaskThatEnds", "#include <const.h>\nlong n;\nmain() {\nwhile (1) {\n_SetTask2(T2_START, Other); _Wait(50); } }\nOther() { n = n + 1; H2 = n; }", {}},
    {"SentButNeverWritten",
     "#include <const.h>\nSCTRCYCL t; long send, state;\nmain() {\nt.ObjectNo = 1030; t.CycleTime = 10; t.Format = 4;\nt.DPointer = numof(send);\n"
     "_SBusCommDef(SCD_TRCYCL, t); _SBusCommOn();\nwhile (1) { state = H483; H1 = state; } }",
     {"5 W0257"}},
    {"SentAndWrittenByATelegram",
     "#include <const.h>\nSCTRCYCL t; SCREC r; long data;\nmain() {\nt.ObjectNo = 1030; t.CycleTime = 10; t.Format = 4; t.DPointer = numof(data);\n"
     "r.ObjectNo = 1031; r.Format = 4; r.DPointer = numof(data);\n_SBusCommDef(SCD_TRCYCL, t); _SBusCommDef(SCD_REC, r); _SBusCommOn(); while (1) ; }",
     {}},
    {"InterruptOfAVariableThatNothingWrites",
     "#include <constb.h>\nVARINT v; long x, y;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 1; v.CompareVar = 10; v.Mode = VI_GE; v.Priority = 3;\nv.SrcVar = numof(x);\n"
     "_SetVarInterrupt(v, OnX);\nwhile (1) { y = H483; H1 = y; } }\nOnX() { H300++; }\nOther() { while (1) _Wait(5); }",
     {"6 W0279"}},
    {"NumberOfAnotherInterrupt",
     "#include <constb.h>\nVARINT v, w; long x;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 1; v.CompareVar = 1; v.Mode = VI_GE; v.Priority = 3; v.SrcVar = numof(x); v.IntNum = 0;\n"
     "w = v; w.Control = 1; w.CompareVar = 1; w.Mode = VI_LE;\n_SetVarInterrupt(v, OnX);\n_SetVarInterrupt(w, OnX);\nwhile (1) x = H483; }\nOnX() { H300++; }\nOther() { while (1) _Wait(5); }",
     {}},
    {"NumberOfAnotherInterruptNeverSet",
     "#include <constb.h>\nVARINT v, w; long x;\nmain() {\n_SetTask2(T2_START, Other);\nv.Control = 1; v.CompareVar = 1; v.Mode = VI_GE; v.Priority = 3; v.SrcVar = numof(x);\n"
     "w.Control = 1; w.CompareVar = 1; w.Mode = VI_LE; w.Priority = 3; w.SrcVar = numof(x);\n_SetVarInterrupt(v, OnX);\n_SetVarInterrupt(w, OnX);\nwhile (1) x = H483; }\n"
     "OnX() { H300++; }\nOther() { while (1) _Wait(5); }",
     {"8 W0278"}},
    {"QuotientOfAMacro", "#define PAUSE 1/2\nmain() {\n_Wait(PAUSE); H1 = 1; }", {"3 W0267"}},
    {"QuotientOfTwoMacros", "#define STEP 1\n#define SCALE 2\nmain() {\nH1 = STEP / SCALE; }", {}},
    {"TravelOnAUnitWithoutPositioning",
     "#include <const.h>\nmain() {\n_Go0(GO0_C_W_ZP);\n_GoAbs(GO_WAIT, 100); }",
     {"3 W0283", "4 W0283"},
     "mc07"},
    {"CommandOfNoUnit", "#include <const.h>\nmain() {\n_MovCommOn(); }", {"3 W0283"}},
    {"TimerOfTwoTasks",
     "#include <const.h>\nlong a, b;\nmain() {\n_SetTask2(T2_START, Second);\nwhile (1) { Timer_1 = 500; while (Timer_1 > 0) a = a + 1; } }\n"
     "Second() {\nwhile (1) { Timer_1 = 100; while (Timer_1 > 0) b = b + 1; } }",
     {"7 W0284"}},
    {"TimerOfATaskAndItsInterrupt",
     "#include <const.h>\nlong a;\nmain() {\n_SetInterrupt(SI_TIMER0, Tick); Timer_0 = 10;\nwhile (1) H1 = a; }\n"
     "Tick() { Timer_0 = 20; a = a + 1; }",
     {}},
    {"ReservedNumber", "main() {\nH470 = 5;\nH474 = 5; H452 = 1; }", {"2 W0285"}},
    {"ReservedNumberOfTheNewUnit", "main() {\nH530 = 0;\nH531 = 0; H600 = 1; }", {"3 W0285"}, "mdxb"},
    {"NothingToKeep", "#include <const.h>\nlong n;\nmain() {\nn = n + 1; H128 = n;\n_Memorize(MEM_STDATA); }", {"5 W0286"}},
    {"SomethingToKeep", "#include <const.h>\nmain() {\nH127 = H127 + 1;\n_Memorize(MEM_STDATA); }", {}},
    {"MemoryInEachTurn",
     "#include <const.h>\nmain() {\nwhile (1) {\nH5 = H5 + 1; Keep(); } }\nKeep() {\n_Memorize(MEM_STDATA); }",
     {"6 W0287"}},
    {"MemoryWhenAsked",
     "#include <const.h>\nmain() {\nwhile (1) {\nH5 = H5 + 1; if (H483 & 1) _Memorize(MEM_STDATA); } }",
     {}},
    {"ParameterInEachTurn",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Address = 4;\n"
     "m.Service = ML_S_WR; m.Index = 8470; m.DPointer = numof(d); d.WritePar = 100;\nwhile (1) {\n_MoviLink(m);\nH1 = m.Result; } }",
     {"7 W0287"}},
    {"VolatileParameterInEachTurn",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Address = 4;\n"
     "m.Service = ML_S_WRV; m.Index = 8470; m.DPointer = numof(d); d.WritePar = 100;\nwhile (1) {\n_MoviLink(m);\nH1 = m.Result; } }",
     {}},
    {"ResultNobodyReads",
     "#include <const.h>\nMOVLNK m; MLDATA d;\nmain() {\nm.BusType = ML_BT_SBUS; m.Format = ML_FT_PAR; m.Address = 4;\n"
     "m.Service = ML_S_RD; m.Index = 8470; m.DPointer = numof(d);\n_MoviLink(m);\nH1 = d.ReadPar; }",
     {"6 W0288"}},
    {"LoopThatNeverRuns", "long i;\nmain() {\nfor (i = 10; i < 5; i++) H1++; }", {"3 W0289"}},
    {"LoopThatACircleOfFunctionsEnds",
     "long i, n;\neven() { i++; if (n) odd(); }\nodd() { n = n - 1; if (n > 0) even(); }\nmain() {\neven(); i = 0; n = 30;\n"
     "while (i < 5) odd(); }",
     {"2 W0209"}},
    {"LoopThatNeverEnds", "long i;\nmain() {\ni = 0;\nwhile (i < 5) H1++; }", {"4 W0290"}},
    {"LoopThatACallEnds", "long i;\nmain() {\ni = 0;\nwhile (i < 5) Next(); }\nNext() { i++; }", {}},
    {"LoopThatATaskEnds",
     "#include <const.h>\nlong go;\nmain() {\ngo = 0; _SetTask2(T2_START, Other);\nwhile (!go) H1++; }\nOther() { _Wait(5); go = 1; }",
     {"2 W0261"}},
    {"LoopThatATelegramEnds",
     "#include <const.h>\nSCREC r; long go;\nmain() {\ngo = 0; r.ObjectNo = 1025; r.Format = 4; r.DPointer = numof(go);\n"
     "_SBusCommDef(SCD_REC, r); _SBusCommOn();\nwhile (!go) H1++; }",
     {}},
    // The unit writes it when the telegram is on the line (1053 1610 p. 56).
    {"LoopThatTheResultOfATelegramEnds",
     "#include <const.h>\nSCTRACYCL t; long a;\nmain() {\na = H483; t.ObjectNo = 1025; t.Format = 4; t.DPointer = numof(a);\n_SBusCommDef(SCD_TRACYCL, t);\n"
     "while (t.Result == 1) ; }",
     {}},
    {"LoopWithAWayOut", "long i;\nmain() {\ni = 0;\nwhile (i < 5) { if (H483 & 1) break; } }", {}},
    {"StateNothingAssigns",
     "long s;\nmain() {\nwhile (1) switch (s) {\ncase 0: s = 1; break;\ncase 1: s = 0; break;\ncase 2: H1 = 1; break; } }",
     {"6 W0291"}},
    {"StateWithoutCase",
     "long s;\nmain() {\nwhile (1) switch (s) {\ncase 0: s = 1; break;\ncase 1: s = 2; break; } }",
     {"5 W0292"}},
    {"StateWithDefault",
     "long s;\nmain() {\nwhile (1) switch (s) {\ncase 0: s = 1; break;\ncase 1: s = 2; break;\ndefault: s = 0; } }",
     {}},
    {"BitNumberForAMask", "#include <const.h>\nmain() {\nif (StatusWord & 19) H1 = 1; }", {"3 W0293"}},
    {"MaskOfABit", "#include <const.h>\nmain() {\nif (StatusWord & 0x80000) H1 = 1; }", {}},
    {"HalfAStructure", "#include <const.h>\nSSPOSSPEED p;\nmain() {\np.CW = 100; _SetSys(SS_POSSPEED, p); }", {"2 W0294"}},
    {"TwoTasksWrite",
     "#include <const.h>\nlong a;\nmain() {\n_SetTask2(T2_START, Other);\na = 1; }\nOther() { a = 2; }",
     {"2 W0261"}},
};
INSTANTIATE_TEST_SUITE_P(Machine, MachineMistakeOf, testing::ValuesIn(kMachineMistakes),
                         [](const auto& row) { return std::string(row.param.name); });

// What gcc 12 or clang 14 tell with -Wall -Wextra.
const MachineMistake kSlips[] = {
    {"ConstantOverflow", "long a;\nmain() {\na = 100000 * 65536; H1 = a; }", {"3 W0262"}},
    {"HexadecimalBits", "long a;\nmain() {\na = 0x80000000 - 1; H1 = a; }", {}},
    {"SelfAssignment", "long a;\nmain() {\na = H1; a = a; }", {"3 W0264"}},
    {"EqualSides", "long a;\nmain() {\na = H1; if (a == a) H2 = 1; }", {"3 W0263"}},
    {"ElementsThatDiffer", "long a[2];\nmain() {\na[0] = H1; if (a[0] == a[1]) H2 = 1; }", {}},
    {"AlwaysTrue", "long a;\nmain() {\na = H1;\nif (a != 1 || a != 2) H2 = 1; }", {"4 W0253"}},
    {"NeverTrue", "long a;\nmain() {\na = H1;\nif (a == 1 && a == 2) H2 = 1; }", {"4 W0253"}},
    {"NeverInRange", "long a;\nmain() {\na = H1;\nif (a > 5 && H3 && a < 3) H2 = 1; }", {"4 W0253"}},
    {"InRange", "long a;\nmain() {\na = H1;\nif (a > 3 && a < 5 || a < -3) H2 = 1; }", {}},
    {"Indentation", "long a;\nmain() {\n  a = H1;\n  if (a > 5)\n    H2 = 1;\n    H3 = 2;\n}", {"6 W0266"}},
    {"IndentationOfElse", "long a;\nmain() {\n  a = H1;\n  if (a > 5)\n    H2 = 1;\n  else\n    H3 = 2;\n    H4 = 3;\n}", {"8 W0266"}},
    {"IndentationAsMeant", "long a;\nmain() {\n  a = H1;\n  if (a > 5)\n    H2 = 1;\n  H3 = 2;\n}", {}},
    {"DanglingElse", "long a, b;\nmain() {\n  a = H1; b = H2;\n  if (a)\n    if (b) H2 = 1;\n  else\n    H3 = 2;\n}", {"6 W0265"}},
    {"ElseOfTheInnerIf", "long a, b;\nmain() {\n  a = H1; b = H2;\n  if (a)\n    if (b) H2 = 1;\n    else H3 = 2;\n}", {}},
    {"OrBesideAnd", "long a, b, c;\nmain() {\na = H1; b = H2; c = H3;\nif (a == 1 | b == 2 & c > 3) H2 = 1; }", {"4 W0250"}},
    {"DivisionFirst", "long a;\nmain() {\na = H1 * (10 / 4096); H2 = a; }", {"3 W0267"}},
    {"Power", "long a;\nmain() {\na = 5 ** 2; H1 = a; }", {"3 W0268"}},
    {"PointerTimes", "long a, p;\nmain() {\np = 300; a = 5 * *p; H1 = a; }", {}},
};
INSTANTIATE_TEST_SUITE_P(Slips, MachineMistakeOf, testing::ValuesIn(kSlips),
                         [](const auto& row) { return std::string(row.param.name); });

TEST(MachineMistakes, EveryCodeIsInATable) {
  std::set<std::string> known;
  for (const MachineMistake& row : kMachineMistakes)
    for (const std::string& one : row.told) known.insert(one.substr(one.find(' ') + 1));
  for (const MachineMistake& row : kSlips)
    for (const std::string& one : row.told) known.insert(one.substr(one.find(' ') + 1));
  for (const DiagInfo& row : diagnostic_table()) {
    if (row.code >= "W0262" && row.code <= "W0299") {
      EXPECT_TRUE(known.contains(std::string(row.code))) << row.code;
    }
  }
}

}  // namespace
}  // namespace ipos::compiler::test

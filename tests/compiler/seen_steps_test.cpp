// Intermediate results in variables that somebody else sees: who counts as somebody, which statements have
// steps, and that --atomic leaves none.
#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>

#include "compiler/sema/ranges.hpp"
#include "stdlib/system_variables.hpp"
#include "tests/compiler/backend_test.hpp"
#include "vm/exec/machine.hpp"
#include "vm/sched/scheduler.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::compiler::test {
namespace {

Compilation compile_b(const std::string& text, bool atomic = false) {
  CompileOptions options;
  options.unit = stdlib::find_unit(std::string_view("mdxb"));
  options.atomic = atomic;
  options.warnings.apply("no-never-written");
  options.warnings.apply("no-timer-not-set");
  return compile("test.IPC", "", "#include <constb.h>\n" + text, options);
}

// The warnings of a program, "x: 'Reader' uses it"; other messages as they are.
std::string seen(const std::string& text) {
  std::string out;
  const Compilation compiled = compile_b(text);
  for (const Diagnostic& message : compiled.diagnostics.all()) {
    if (message.diag != Diag::SeenSteps) {
      out += message.text + "\n";
      continue;
    }
    const size_t who = message.text.find("moment, and ") + 12;
    out += message.text.substr(1, message.text.find('\'', 1) - 1) + ": " +
           message.text.substr(who, message.text.find(';') - who) + "\n";
    EXPECT_EQ(message.notes.size(), 1U);
    EXPECT_TRUE(message.notes[0].span.begin.valid());
  }
  return out;
}

// Commands that write a variable, by mnemonic.
std::vector<std::string> writes_of(const Compilation& c, const std::string& variable) {
  std::vector<std::string> out;
  for (std::string line : commands(c)) {
    if (const size_t label = line.find(" : "); label != std::string::npos) line = line.substr(label + 3);
    const size_t operand = line.find(' ');
    if (operand != std::string::npos &&
        line.compare(operand, variable.size() + 2, " " + variable + " ") == 0 && !line.starts_with("JMP"))
      out.push_back(line);
  }
  return out;
}

constexpr const char* kSteps = "x = (a + 1) % 8;";

// `main` with a task 2 that has some statements.
std::string beside(const std::string& statement, const std::string& task) {
  return "long x, a, b, v[3]; main() { b = x + a; _SetTask2(T2_START, T); while (1) { " + statement +
         " } }\n" + "T() { while (1) { a++; b++; v[b]++; " + task + " } }";
}

TEST(SeenSteps, ByAnotherRoot) {
  const std::string head = "long x, a; main() { ";
  EXPECT_EQ(seen(beside(kSteps, "if (x) a = 1;")), "x: 'T' uses it\n");
  EXPECT_EQ(seen(beside(kSteps, "x = 0;")), "x: 'T' uses it\n");
  EXPECT_EQ(seen(beside(kSteps, "")), "");
  EXPECT_EQ(seen(beside("x = (x + 1) % 8;", "x = 0;")).find("x: "), std::string::npos) << "W0258 says it";
  EXPECT_EQ(seen(head + "_SetInterrupt(SI_TIMER0, T); while (1) " + kSteps + " } T() { a = x; }"),
            "x: 'T' uses it\n");
  EXPECT_EQ(seen(head + "_SetTask2(T2_START, T); while (1) f(); } f() { " + kSteps +
                 " } T() { g(); } g() { a = x; }"),
            "x: 'g' uses it\n");
  EXPECT_EQ(
      seen(head + "_SetTask2(T2_START, T); while (1) f(); } f() { " + kSteps + " } T() { f(); a = 1; }"),
      "x: 'f' runs more than once at a time\n");
  EXPECT_EQ(seen(head + "while (1) f(); } f() { " + kSteps + " }"), "") << "nobody else";
  EXPECT_EQ(
      seen(head + "_SetTask2(T2_START, S); _SetTask2(T2_START, T); } S() { " + kSteps + " } T() { a = x; }"),
      "")
      << "functions of one task replace one another";
}

TEST(SeenSteps, NotBeforeAnythingIsStarted) {
  const std::string rest = "_SetTask2(T2_START, T); while (1) a++; } T() { while (1) { a = x; } }";
  EXPECT_EQ(seen(std::string("long x, a; main() { ") + kSteps + rest), "");
  EXPECT_EQ(seen(std::string("long x, a; main() { set(); ") + rest + " set() { " + kSteps + " }"), "");
  EXPECT_EQ(seen(std::string("long x, a; main() { start(); ") + kSteps +
                 "} start() { _SetTask2(T2_START, T); } T() { a = x; }"),
            "x: 'T' uses it\n");
}

TEST(SeenSteps, ByWhatTheUnitLooksAt) {
  const auto object = [](const std::string& pointer) {
    return "SCTRCYCL o; long x, y, z, a; main() { o.ObjectNo = 1100; o.CycleTime = 10; o.Len = 8; a = 0; " +
           pointer + " _SBusCommDef(SCD_TRCYCL, o); _SBusCommOn(); while (1) { " + kSteps +
           " y = a * 2; z = a * 3; } }";
  };
  EXPECT_EQ(seen(object("o.DPointer = numof(x);")), "x: the SBus sends it\ny: the SBus sends it\n");
  EXPECT_EQ(seen(object("o.DPointer = numof(y);")), "y: the SBus sends it\nz: the SBus sends it\n");
  EXPECT_EQ(
      seen("MOVLNK m; MLDATA d; long a; main() { m.DPointer = numof(d); while (1) { d.WritePar = a * 2 + 1;"
           " _MoviLink(m); } }"),
      "")
      << "read while the task waits";
  EXPECT_EQ(seen(std::string("VARINT i; long x, a; main() { i.SrcVar = numof(x); _SetVarInterrupt(i, f);"
                             " while (1) ") +
                 kSteps + " } f() { a = 0; }"),
            "x: a variable interrupt watches it\n");
}

TEST(SeenSteps, OnlyBehindWhatStartsSomething) {
  const std::string head =
      "#pragma globals 300 399\nSCTRCYCL o; SCREC r; GSCAM cam; GSCAM_EXT ext; VARINT i; long x, a, b; "
      "main() { b = r.Len + "
      "cam.BitValue + ext.CamState + o.Len + i.Mode; ";
  const std::string rest = " _SetTask2(T2_START, T); } T() { a = x; f(); } f() { b = 1; }";
  for (const char* other :
       {"_Wait(1);", "_BitSet(b, 1);", "_Copy(b, a, 1);", "_GetSys(b, GS_ACTCUR);", "_SetSys(SS_N11, b);",
        "_GoAbs(GO_NOWAIT, 5);", "_SBusCommDef(SCD_TRCYCL, o);", "_SBusCommDef(SCD_REC, r);",
        "_SetTask2(T2_STOP, f);", "_Memorize(MEM_NOP);", "b++;"})
    EXPECT_EQ(seen(head + other + kSteps + rest), "") << other;
  for (const char* start :
       {"_SBusCommOn();", "_GetSys(cam, GS_CAM);", "_GetSys(ext, GS_CAM);", "_SetInterrupt(SI_TIMER0, f);",
        "_SetVarInterrupt(i, f);", "if (b) _SetTask2(T2_START, T);", "H0 = (_SBusCommOn(), 1);",
        "while (a) { { _SBusCommOn(); } }"})
    EXPECT_NE(seen(head + start + kSteps + rest).find("x: 'T' uses it\n"), std::string::npos) << start;
  EXPECT_EQ(seen("long x, a; main() { set(); _SetTask2(T2_START, T); while (1) set(); } set() { " +
                 std::string(kSteps) + " } T() { a = x; }"),
            "x: 'T' uses it\n")
      << "called again later";
  EXPECT_NE(seen("long x, a; main() { " + std::string(kSteps) +
                 " _SetTask2(T2_START, T); if (a) main(); } T() { a = x; }")
                .find("x: 'T' uses it\n"),
            std::string::npos)
      << "main runs again";
}

TEST(SeenSteps, ByEveryKindOfRoot) {
  const std::string s = "} S() { " + std::string(kSteps) + " } T() { a = x; }";
  const auto both = [&](const char* first, const char* second) {
    return seen("VARINT i, k; long x, a; main() { i.IntNum = k.IntNum; " + std::string(first) + second + s);
  };
  const char* const starts[] = {"_SetTask2(T2_START, ", "_SetTask(T2_START, ", "_SetInterrupt(SI_TIMER0, ",
                                "_SetInterrupt(SI_ERROR, "};
  for (const char* one : starts)
    for (const char* other : starts) {
      const std::string first = one + std::string("S);");
      const std::string second = other + std::string("T);");
      EXPECT_EQ(both(first.c_str(), second.c_str()), one == other ? "" : "x: 'T' uses it\n") << one << other;
    }
  EXPECT_EQ(both("_SetVarInterrupt(i, S);", "_SetVarInterrupt(k, T);"), "x: 'T' uses it\n");
  EXPECT_EQ(both("_SetVarInterrupt(i, S);", "_SetVarInterrupt(i, T);"), "x: 'T' uses it\n")
      << "each routine may be of another";
  EXPECT_EQ(both("_SystemCall(1, S);", "_InputCall(1, 3, T);"), "") << "called, not started";
}

// More roots than are told apart: those beyond count as several, the ones before are still themselves.
TEST(SeenSteps, ByMoreRootsThanAreCounted) {
  const auto with = [](int writer, int reader) {
    std::string text = "VARINT i; long x, a, b; main() { ";
    for (int n = 1; n <= 70; ++n) text += "_SetVarInterrupt(i, f" + std::to_string(n) + ");";
    text += "}";
    for (int n = 1; n <= 70; ++n)
      text += " f" + std::to_string(n) + "() { " + (n == writer ? kSteps : "") +
              (n == reader ? "b = x;" : "") + " }";
    return seen(text);
  };
  EXPECT_EQ(with(1, 1), "");
  EXPECT_EQ(with(62, 62), "");
  EXPECT_EQ(with(70, 1), "x: 'f1' uses it\n");
  EXPECT_EQ(with(69, 70), "x: 'f70' uses it\n");
}

TEST(SeenSteps, ByMembersThatHoldNumbers) {
  const auto object = [](const std::string& declared, const std::string& set, const std::string& call) {
    return seen("long w, x, y, z, a; " + declared + " main() { f(); a = w + y + z; " + set + " " + call +
                " while (1) { " + kSteps + " y = a * 2; z = a * 3; } } f() { a = 0; }");
  };
  const std::string receive = "_SBusCommDef(SCD_REC, o); _SBusCommOn();";
  EXPECT_EQ(object("SCREC o;", "o.DPointer = numof(x);", receive),
            "x: the SBus receives it\ny: the SBus receives it\n");
  EXPECT_EQ(object("SCREC o;", "o.DPointer = numof(z);", receive), "z: the SBus receives it\n");
  EXPECT_EQ(object("SCREC o;", "o.DPointer = numof(w); o.DPointer = numof(y);", receive),
            "x: the SBus receives it\ny: the SBus receives it\nz: the SBus receives it\n")
      << "any of the numbers it gets";
  // A number that is computed, or never set: whatever has given its number to somebody.
  const std::string anywhere = ": the SBus receives it\n";
  EXPECT_EQ(object("SCREC o; long p;", "p = numof(y); o.DPointer = p + 1;", receive), "y" + anywhere);
  EXPECT_EQ(object("SCREC o; long p;", "p = numof(y); H0 = p;", receive), "y" + anywhere);
  EXPECT_EQ(object("SCREC o;", "o.DPointer = a + 1;", receive), "");
  // One variable of an interrupt, one of the destination of a cam controller, ten of its data.
  EXPECT_EQ(object("VARINT i;", "i.SrcVar = numof(y);", "_SetVarInterrupt(i, f);"),
            "y: a variable interrupt watches it\n");
  EXPECT_EQ(object("GSCAM_EXT c;", "c.CamDestination = numof(x);", "_GetSys(c, GS_CAM);"),
            "x: the cam controller writes it\n");
  for (int n = 1; n <= 8; ++n)
    EXPECT_EQ(object("GSCAM_EXT c;", "c.CamData" + std::to_string(n) + " = numof(y);", "_GetSys(c, GS_CAM);"),
              "y: the cam controller reads it\nz: the cam controller reads it\n")
        << n;
  EXPECT_EQ(object("GSCAM_EXT c;", "c.CamData1 = 412;", "_GetSys(c, GS_CAM);"),
            "x: the cam controller reads it\n");
  EXPECT_EQ(object("GSCAM_EXT c;", "c.CamData1 = 411;", "_GetSys(c, GS_CAM);"), "");
  EXPECT_EQ(object("GSCAM c;", "c.SourceVar = numof(x); c.DestVar = numof(y);", "_GetSys(c, GS_CAM);"), "")
      << "its form without tables";
}

TEST(SeenSteps, ByPointersAndByNumber) {
  const std::string pointer = "long x, p, a; main() { p = numof(x); _SetTask2(T2_START, T); while (1) ";
  EXPECT_EQ(seen(pointer + kSteps + " } T() { a = *p; }"), "x: 'T' uses variables by their numbers\n");
  EXPECT_EQ(seen(pointer + kSteps + " } T() { a = 1; }"), "");
  EXPECT_EQ(seen("main() { H10 = H11 * 2 + 1; }"), "") << "off until it is asked for";
  CompileOptions options;
  EXPECT_TRUE(options.warnings.apply("steps-by-number"));
  const Compilation c = compile("test.IPC", "", "main() { H10 = H11 * 2 + 1; }", options);
  ASSERT_EQ(c.diagnostics.all().size(), 1U);
  EXPECT_NE(c.diagnostics.all()[0].text.find("a bus may read it as parameter 11010"), std::string::npos);
  EXPECT_EQ(writes_of(compile_b("main() { H10 = H11 * 2 + 1; }", true), "H10").size(), 1U);
}

// The warning points at the assignment whose steps are seen, also behind another one within it.
TEST(SeenSteps, OfTheOuterAssignmentAreToldThere) {
  const auto columns = [](const std::string& statement) {
    const Compilation c = compile_b(beside(statement, "v[0] = x;"));
    std::vector<uint32_t> out;
    for (const Diagnostic& message : c.diagnostics.all())
      if (message.diag == Diag::SeenSteps && message.text.starts_with("'x'"))
        out.push_back(c.sources->position(message.span.begin).column);
    return out;
  };
  const std::vector<uint32_t> plain = columns("x = a + b;");
  ASSERT_EQ(plain.size(), 1U);
  EXPECT_EQ(columns("x = (b = a + v[1]) ? a + b : a - b;"), plain);
  EXPECT_EQ(columns("x = (b = a * v[1], a + b);"), plain);
}

// Each assignment is told, once, however often its variable takes part and whatever it stands beside.
TEST(SeenSteps, OfEachAssignmentAreToldOnce) {
  EXPECT_EQ(seen(beside("x = a + b; x = a - b;", "v[0] = x;")), "x: 'T' uses it\nx: 'T' uses it\n");
  EXPECT_EQ(seen(beside("x = a ? a + b : a - b;", "v[0] = x;")), "x: 'T' uses it\n");
  EXPECT_EQ(seen(beside("x = a * 2 + b * 3 - 5;", "v[0] = x;")), "x: 'T' uses it\n");
}

// Statements that need one command at their target, and those that take several.
TEST(SeenSteps, OnlyWhereThereAreSteps) {
  for (const char* one :
       {"x = 5;", "x = a;", "x++;", "x += a * 2;", "x = x + 1;", "x = x - a * b;", "x = ~a;", "x = -x;",
        "x = a < b;", "x = !a;", "x = a && b;", "x = v[a];", "x = a ? 1 : b;", "x = a * 1;", "x = a + 0;",
        "x <<= a + b;", "v[a] = a * b + 1;", "x = a++;", "_BitSet(x, 3);"})
    EXPECT_EQ(seen(beside(one, "b = x;")), "") << one;
  for (const char* several :
       {"x = a + b;", "x = -a;", "x = a - x;", "x = (x + 1) % 8;", "x = a * 100 / 4096 + 5000;",
        "x = a ? b : a * b;", "x = a ? a + b : 0;", "x = v[a] + 1;", "a = x = a * b;", "b = (x = a * b) + 1;",
        "if (x = a + b) x = 1;", "x = (a && b) + 1;"})
    EXPECT_NE(seen(beside(several, "v[0] = x;")).find("x: "), std::string::npos) << several;
}

TEST(Atomic, WritesOnceWhatOthersSee) {
  for (const char* statement : {"x = a + b;", "x = -a;", "x = a - x;", "x = (x + 1) % 8;",
                                "x = a * 100 / 4096 + 5000;", "x = v[a] + 1;", "x = (a && b) + 1;"}) {
    const std::string text = beside(statement, "v[0] = x;");
    const Compilation c = compile_b(text, true);
    EXPECT_TRUE(c.diagnostics.all().empty()) << statement;
    const auto writes = writes_of(c, "H420");
    ASSERT_EQ(writes.size(), 1U) << statement;
    EXPECT_TRUE(writes[0].starts_with("SET H420 = H4")) << writes[0];
    EXPECT_GT(writes_of(compile_b(text), "H420").size(), 1U) << statement;
  }
  const std::string alone = "long x, a; main() { x = (a + 1) % 8; }";
  EXPECT_EQ(commands(compile_b(alone, true)), commands(compile_b(alone)))
      << "costs nothing where nobody looks on";
}

// What a program may write of the unit: each row of the table that is not only read, and the numbers that the unit keeps
// without a row (IPOSplus p. 29, 39).
std::vector<uint32_t> written_system_variables() {
  std::vector<uint32_t> out{457, 472, 512, 556};
  for (const stdlib::SystemVariable& row : stdlib::system_variables())
    if (row.access == stdlib::VariableAccess::RW) out.push_back(row.number);
  return out;
}

// An expression with the name in place of each '%'; "%%" is the operator.
std::string with_name(std::string expression, const std::string& name) {
  for (size_t at = 0; (at = expression.find('%', at)) != std::string::npos;) {
    if (expression.compare(at, 2, "%%") == 0)
      expression.erase(at++, 1);
    else
      expression.replace(at, 1, name), at += name.size();
  }
  return expression;
}

constexpr const char* kAssigned[] = {"a + b",       "a - b",      "a - %",          "-%",
                                     "-a",          "b - % * a",  "(% + 1) %% 8",   "a * 2 + b - %",
                                     "a - (b - %)", "a * b - 12", "a ? a + b : -%", "(a && b) + 1",
                                     "a %% 8 + %",  "~(% + a)",   "v[a] - %",       "(a, b - %)"};

// The unit acts on system variables (outputs, setpoints, gears) or others read them there: whatever the expression, they
// get its value and nothing on the way, in one command.
TEST(SystemVariables, GetTheirValueAndNothingOnTheWay) {
  for (const uint32_t number : written_system_variables())
    for (const char* const assigned : kAssigned) {
      const std::string name = "H" + std::to_string(number), expression = with_name(assigned, name);
      const Compilation c =
          compile_b("long a, b, v[4]; main() { a = 1; b = 2; v[a] = 3; " + name + " = " + expression + "; }");
      ASSERT_TRUE(c.image) << expression;
      const auto writes = writes_of(c, name);
      EXPECT_EQ(writes.size(), expression.find('?') != std::string::npos ? 2U : 1U)
          << name << " = " << expression;
    }
  // Their neighbours are a program's own, which are computed where they are.
  for (const char* name : {"H452", "H565"}) {
    const Compilation c = compile_b("long a; main() { a = 1; " + std::string(name) + " = a * 2; }");
    EXPECT_EQ(writes_of(c, name), (std::vector<std::string>{"SET " + std::string(name) + " = H420",
                                                            "MUL " + std::string(name) + " * 2"}));
  }
}

// All values that a variable has behind the commands of a program, from the second turn of its loop on.
std::set<int32_t> values_of(const std::string& text, uint32_t number) {
  const Compilation c = compile_b(text);
  EXPECT_TRUE(c.image) << text;
  const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view("mdxb"));
  const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
  const vm::VerifiedImage image = vm::verify(c.image->code, limits, {}).image.value();
  auto machine = std::make_unique<vm::Machine>(image, vm::Host{});
  machine->start();
  std::set<int32_t> seen;
  for (int command = 0; command < 400; ++command) {
    machine->run(1, 1);
    if (command > 100) seen.insert(machine->variables()[number]);
  }
  return seen;
}

// The same of a run, command by command: what does not depend on the variable itself is its only value, in the variable of
// the table as in a program's own that a #pragma has put there.
TEST(SystemVariables, NobodySeesAThirdValue) {
  for (const auto& [expression, value] : {std::pair("lA - lB", 2),
                                          {"-lA", -20},
                                          {"lA * lB - 12", 348},
                                          {"(lA && lB) + 1", 2},
                                          {"lA ? lA + lB : lB", 38},
                                          {"lV[lC] - lB", -11},
                                          {"~(lA + lB)", -39},
                                          {"(lA << 2) / lB + lA % 7", 10}}) {
    const auto program = [&, assigned = std::string(expression)](const std::string& head,
                                                                 const std::string& name) {
      return head + "long lA, lB, lC, lV[4];\nmain() { lA = 20; lB = 18; lC = 3; lV[3] = 7; while (1) { " +
             name + " = " + assigned + "; } }";
    };
    for (const uint32_t number : written_system_variables())
      EXPECT_EQ(values_of(program("", "H" + std::to_string(number)), number), std::set<int32_t>{value})
          << "H" << number << " = " << expression;
    for (uint32_t number = kLastReservedVariable + 1; number <= stdlib::kLastSystemVariable; ++number)
      EXPECT_EQ(
          values_of(program("#pragma globals " + std::to_string(number) + " 600\nlong lGear;\n", "lGear"),
                    number),
          std::set<int32_t>{value})
          << "H" << number << " = " << expression;
  }
}

// 10 s of a program on a MOVIDRIVE B, without a host; `each_ms` sees the variables as a telegram would.
std::map<std::string, int32_t> run(const std::string& text, bool atomic,
                                   const std::function<void(std::span<int32_t>)>& each_ms = {}) {
  const Compilation c = compile_b(text, atomic);
  EXPECT_TRUE(c.image) << text;
  const stdlib::UnitType& unit = *stdlib::find_unit(std::string_view("mdxb"));
  const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
  const vm::VerifiedImage image = vm::verify(c.image->code, limits, {}).image.value();
  const vm::Host host{
      nullptr, [](void*, vm::Machine&, int, const vm::Instruction&) noexcept { return vm::HostReply{}; }};
  auto machine = std::make_unique<vm::Machine>(image, host);
  machine->start();
  for (int ms = 0; ms < 10'000; ++ms) {
    vm::run_tick(*machine, vm::Rates{{1, 2, 20}});
    if (each_ms) each_ms(machine->variables());
  }
  std::map<std::string, int32_t> out;
  for (const vm::Symbol& symbol : c.image->symbols) out[symbol.name] = machine->variables()[symbol.variable];
  return out;
}

TEST(Atomic, RingBufferOfTwoTasks) {
  const std::string ring =
      "long lWr, lRd, lBuf[8], lBad; main() { _SetTask2(T2_START, Reader);"
      " while (1) { lBuf[lWr] = lRd; lWr = (lWr + 1) % 8; } } Reader() { while (1) { if (lWr > 7) lBad++; } "
      "}";
  EXPECT_GT(run(ring, false)["lBad"], 100);
  EXPECT_EQ(run(ring, true)["lBad"], 0);
}

TEST(Atomic, ScaledPositionOfAMonitor) {
  const std::string torn =
      "long lPos, lRead, lBad; main() { _SetTask2(T2_START, Monitor); H10 = 40960;"
      " while (1) { lPos = H10 * 100 / 4096 + 5000; _Wait(1); } }"
      " Monitor() { while (1) { lRead = lPos; if (lRead != 6000 && lRead != 0) lBad++; } }";
  EXPECT_GT(run(torn, false)["lBad"], 1000);
  EXPECT_EQ(run(torn, true)["lBad"], 0);
}

// The setpoint of a cyclic object, read every 7 ms as its telegram does.
TEST(Atomic, SetpointInATelegram) {
  const std::string sent =
      "SCTRCYCL tx; long lSetp, lDummy; main() { tx.DPointer = numof(lSetp); lSetp = 6000; H10 = 40960;"
      " if (H10 == 0) { _SBusCommDef(SCD_TRCYCL, tx); _SBusCommOn(); }"
      " while (1) { lSetp = H10 * 100 / 4096 + 5000; } }";
  const auto wrong = [&](bool atomic) {
    int ms = 0;
    int bad = 0;
    run(sent, atomic, [&](std::span<int32_t> h) {
      if (++ms % 7 == 0) bad += h[426] != 6000;
    });
    return bad;
  };
  EXPECT_GT(wrong(false), 300);
  EXPECT_EQ(wrong(true), 0);
}

TEST(TooLong, NamesTheCopiesAndIsThereForListings) {
  std::string text =
      "long a, b, c, x; main() { _SetTask2(T2_START, Task2); _SetInterrupt(SI_ERROR, OnErr); while (1) "
      "Calc(); }"
      " Task2() { while (1) Calc(); } OnErr() { Calc(); } Calc() {";
  for (int n = 0; n < 60; ++n) text += " x = (a + 3) * (b - x) - (c + x) * (a - 3);";
  CompileOptions options;
  const Compilation c = compile("test.IPC", "", "#include <const.h>\n" + text + "}", options);
  EXPECT_FALSE(c.image);
  ASSERT_TRUE(c.too_long);
  EXPECT_GT(c.too_long->code.size(), 2048U);
  const Diagnostic* found = nullptr;
  for (const Diagnostic& message : c.diagnostics.all())
    if (message.diag == Diag::ProgramTooLong) found = &message;
  ASSERT_NE(found, nullptr);
  ASSERT_EQ(found->notes.size(), 1U);
  EXPECT_TRUE(found->notes[0].text.starts_with("'Calc' stands 3 times (main, Task2, OnErr): "))
      << found->notes[0].text;
  EXPECT_NE(disassemble(*c.too_long).find("Calc@Task2"), std::string::npos);
  EXPECT_FALSE(c.map.empty());
}

}  // namespace
}  // namespace ipos::compiler::test

// What the program does with its variables, functions and SBus objects as a whole: who calls, reads and writes, which
// objects a unit has room for, and the allocation map that tells it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "compiler/sema/map.hpp"
#include "tests/compiler/backend_test.hpp"

namespace ipos::compiler::test {
namespace {

using Codes = std::vector<std::string>;

// The texts of all messages, a line each; the notes behind theirs with two blanks.
std::string all_texts(const std::string& source, const char* unit = nullptr, const char* flag = "all") {
  CompileOptions options;
  if (unit != nullptr) options.unit = stdlib::find_unit(std::string_view(unit));
  EXPECT_TRUE(options.warnings.apply(flag));
  const Compilation c = compile("t.IPC", "", source, options);
  std::string out;
  for (const Diagnostic& one : c.diagnostics.all()) {
    out += one.text + "\n";
    for (const Note& note : one.notes) out += "  " + note.text + "\n";
  }
  return out;
}

// Cycle times: 1053 1610 p. 54 (1 to 9 ms, or tens up to 65530), MOVITRAC 07 p. 27 (tens only).
TEST(SbusObjects, CycleTimesOfEveryUnit) {
  for (const auto& [unit, fast] :
       {std::pair<const char*, bool>{"md60a", true}, {"mdxb", true}, {"mc07", false}}) {
    const std::vector<int> times = {-10, -1, 0,   1,     2,     8,     9,     10,    11,   15,
                                    19,  20, 100, 65520, 65529, 65530, 65531, 65535, 65540};
    std::string source = "SCTRCYCL t; main() {\n";
    std::vector<std::string> expected;
    for (size_t n = 0; n < times.size(); ++n) {
      const int time = times[n];
      source += "t.CycleTime = " + std::to_string(time) + ";\n";
      if ((fast && time >= 1 && time <= 9) || (time >= 10 && time <= 65530 && time % 10 == 0)) continue;
      expected.push_back(
          fmt::format("{} W0210 cycle time {} is refused by {} (Result -1): {}10 to 65530 ms in steps of 10",
                      n + 2, time, unit, fast ? "1 to 9 ms, or " : ""));
    }
    EXPECT_EQ(told_by_line(source + "_SBusCommDef(1, t); }", unit), expected);
  }
  // Nothing else has a cycle time in its second variable.
  EXPECT_EQ(codes("SCTRACYCL t; main() { t.Len = 0x105; _SBusCommDef(2, t); }"), Codes{});
  EXPECT_EQ(codes("SCREC t; main() { t.Len = 0x105; _SBusCommDef(3, t); }"), Codes{});
  EXPECT_EQ(codes("SCTRCYCL t; main() { t.Offset = 15; _SBusCommDef(1, t); }"), Codes{});
  EXPECT_EQ(codes("SCTRCYCL t; long before; main() { before = 15; t.CycleTime = 10; _SBusCommDef(1, t); }"),
            Codes{});
}

TEST(SbusObjects, IdentifiersOnTheBus) {
  const auto said = [](const std::string& value, const char* unit) {
    return all_texts("SCTRACYCL t; main() { t.ObjectNo = " + value + "; _SBusCommDef(2, t); }", unit);
  };
  const std::string none = " does not exist; identifiers are 0 to 2047\n";
  for (const char* unit : {"md60a", "mdxb"}) {
    EXPECT_EQ(said("-1", unit), "identifier -1" + none);
    EXPECT_EQ(said("2048", unit), "identifier 2048" + none);
    EXPECT_EQ(said("2047", unit), "");
    EXPECT_EQ(said("1024", unit), "");
    EXPECT_EQ(said("0", unit), "identifier 0 is the sync telegram of units with factory setting\n");
    // 1053 1610 p. 38: process output data of address 5 is 8 * 5 + 3.
    EXPECT_EQ(said("43", unit),
              "identifier 43 belongs to the MOVILINK telegrams of address 5; those above 1023 are free\n");
    // A parameter request of address 63 is 512 + 8 * 63 + 3.
    EXPECT_EQ(said("1019", unit),
              "identifier 1019 belongs to the MOVILINK telegrams of address 63; those above 1023 are free\n");
    EXPECT_EQ(said("1023", unit),
              std::string(unit) == "md60a"
                  ? ""
                  : "identifier 1023 belongs to the MOVILINK telegrams of address 63, second "
                    "channel; those above 1023 are free\n");
  }
  // IPOSplus p. 320: bit 24 chooses SBus 2 of a MOVIDRIVE B.
  EXPECT_EQ(said("0x1000000 | 1025", "mdxb"), "");
  EXPECT_EQ(said("0x1000000 | 1025", "md60a"), "identifier 16778241" + none);
  EXPECT_EQ(said("0x1000000 | 2048", "mdxb"), "identifier 16779264" + none);
  EXPECT_EQ(said("0x1000000", "mdxb"),
            "identifier 16777216 is the sync telegram of units with factory setting\n");
  EXPECT_EQ(said("-16777216", "mdxb"), "identifier -16777216" + none);
  EXPECT_EQ(said("0x2000000 | 1025", "mdxb"), "identifier 33555457" + none);
}

// `count` objects of a kind, each with an identifier of its own.
std::string many_objects(int count, const char* type, int kind, int cycle) {
  std::string out = "#pragma var 0 9\n#pragma initials 10 19\n#pragma globals 20 399\n" + std::string(type) +
                    " t[" + std::to_string(count) + "]; main() {\n";
  for (int n = 0; n < count; ++n) {
    out += fmt::format("t[{}].ObjectNo = {};", n, 1024 + n);
    if (kind == 1) out += fmt::format("t[{}].CycleTime = {};", n, cycle);
    out += fmt::format("_SBusCommDef({}, t[{}]);\n", kind, n);
  }
  return out + "}";
}

// Numbers of objects: 1053 1610 p. 54 and 55, MOVITRAC 07 p. 27, MDX60B/61B (docs/reference/units.md).
TEST(SbusObjects, OfWhichAUnitHasRoomForSoMany) {
  struct Room {
    const char* unit;
    int fast, slow, receive;
  };
  for (const Room& room : {Room{"md60a", 5, 10, 32}, Room{"mdxb", 15, 15, 32}, Room{"mc07", 0, 10, 32}}) {
    struct Kind {
      const char* type;
      int kind, cycle, most;
      const char* text;
    };
    for (const Kind& kind :
         {Kind{"SCTRCYCL", 1, 1, room.fast, "transmit (1 to 9 ms) objects, this is number {} (Result -2)"},
          Kind{"SCTRCYCL", 1, 9, room.fast, "transmit (1 to 9 ms) objects, this is number {} (Result -2)"},
          Kind{"SCTRCYCL", 1, 10, room.slow, "transmit (10 to 65530 ms in steps of 10) objects, this is number {} (Result -2)"},
          Kind{"SCREC", 3, 0, room.receive, "receive objects, this is number {}"}}) {
      if (kind.most == 0) continue;  // refused by its cycle time
      EXPECT_EQ(codes(many_objects(kind.most, kind.type, kind.kind, kind.cycle), room.unit), Codes{})
          << room.unit;
      EXPECT_EQ(told_by_line(many_objects(kind.most + 1, kind.type, kind.kind, kind.cycle), room.unit),
                Codes{fmt::format("{} W0212 {} has room for {} ", kind.most + 5, room.unit, kind.most) +
                      fmt::format(fmt::runtime(kind.text), kind.most + 1)});
    }
  }
}

TEST(SbusObjects, CountOnceAndOnlyWithAKnownCycle) {
  const std::string full = many_objects(10, "SCTRCYCL", 1, 20);
  const auto with = [&](const std::string& more) {
    return codes(full.substr(0, full.size() - 1) + more + "}");
  };
  EXPECT_EQ(with("_SBusCommDef(1, t[0]);"), Codes{"W0274"});
  EXPECT_EQ(with("t[0].CycleTime = 20; _SBusCommDef(1, t[0]);"), Codes{"W0274"});
  EXPECT_EQ(with("_SBusCommDef(2, H200);"), Codes{});
  EXPECT_EQ(with("H200 = 1060; H201 = 20; _SBusCommDef(1, H200);"), Codes{"W0212"});
  EXPECT_EQ(with("H200 = 1060; H201 = 20; if (H0) _SBusCommDef(1, H200);"), Codes{"W0212"});
  EXPECT_EQ(with("H200 = 1060; H201 = 20; H201 = 30; _SBusCommDef(1, H200);"), Codes{});
  EXPECT_EQ(with("H200 = 1060; H201 = 20; H201 = 20; _SBusCommDef(1, H200);"), Codes{"W0212"});
  EXPECT_EQ(with("H200 = 1060; H201 = H0; _SBusCommDef(1, H200);"), Codes{});
  EXPECT_EQ(with("H200 = 1060; H201 = 5; _SBusCommDef(1, H200);"), Codes{});
  EXPECT_EQ(with("} spare() { H200 = 1060; H201 = 20; _SBusCommDef(1, H200);"), Codes{"W0202"});
}

TEST(SbusObjects, WithTheSameIdentifier) {
  const auto said = [](const std::string& text) {
    return codes("SCREC r, s; SCTRACYCL t; main() { " + text +
                 " _SBusCommDef(3, r); _SBusCommDef(3, s); _SBusCommDef(2, t); }");
  };
  EXPECT_EQ(said("r.ObjectNo = 1025; s.ObjectNo = 1026; t.ObjectNo = 1027;"), Codes{});
  EXPECT_EQ(said("r.ObjectNo = 1025; s.ObjectNo = 1025; t.ObjectNo = 1027;"), Codes{"W0211"});
  EXPECT_EQ(said("r.ObjectNo = 1027; s.ObjectNo = 1025; t.ObjectNo = 1027;"), Codes{"W0211"});
  EXPECT_EQ(said("r.ObjectNo = 1025; s.ObjectNo = 1026; s.ObjectNo = 1025; t.ObjectNo = 1027;"), Codes{});
  EXPECT_EQ(said("r.ObjectNo = 1025; s.ObjectNo = H0; t.ObjectNo = 1025 + H1;"), Codes{});
  // Each of the two that follow.
  EXPECT_EQ(said("r.ObjectNo = 1025; s.ObjectNo = 1025; t.ObjectNo = 1025;"), (Codes{"W0211", "W0211"}));
}

TEST(Calls, InCirclesAreToldWithTheirWay) {
  const std::string limit = "; more than 32 nested calls are fault F32\n";
  EXPECT_EQ(all_texts("main() { f(); } f() { f(); }"), "'f' calls itself (f -> f)" + limit);
  EXPECT_EQ(all_texts("main() { f(); } f() { g(); } g() { h(); } h() { f(); }"),
            "'f' calls itself (f -> g -> h -> f)" + limit + "  'h' is called here\n  'f' is called here\n");
  EXPECT_EQ(all_texts("main() { f(); } f() { g(); h(); } g() { h(); } h() { f(); }"),
            "'f' calls itself (f -> h -> f)" + limit + "  'f' is called here\n" +
                "'g' calls itself (g -> h -> f -> g)" + limit +
                "  'f' is called here\n  'g' is called here\n")
      << "the shortest way, and each function once";
  EXPECT_EQ(
      all_texts("main() { f(); h(); } f() { g(); } g() { f(); } h() { h(); }"),
      "'f' calls itself (f -> g -> f)" + limit + "  'f' is called here\n'h' calls itself (h -> h)" + limit);
  EXPECT_EQ(all_texts("main() { main(); }"), "'main' calls itself (main -> main)" + limit);
  EXPECT_EQ(codes("main() { f(); g(); } f() { g(); g(); } g() { h(); } h() { H0++; }"), Codes{})
      << "no circle";
  EXPECT_EQ(codes("main() { f(); } f() { g(); H0++; } g() { _SetTask2(1, f); }"), Codes{})
      << "starting is no call";
  EXPECT_EQ(codes("main() { _SystemCall(1, f); } f() { _SystemCall(1, f); }"), Codes{"W0209"});
  EXPECT_EQ(codes("main() { _InputCall(1, 3, f); } f() { _InputCall(1, 3, f); }"), Codes{"W0209"});
}

TEST(Calls, OfWhichNoneReachesAFunction) {
  EXPECT_EQ(all_texts("main() { } f() { g(); } g() { }"),
            "function 'f' is never called or started and is left out\n"
            "function 'g' is never called or started and is left out\n");
  EXPECT_EQ(codes("main() { _SetTask2(1, f); } f() { g(); } g() { }"), Codes{});
  EXPECT_EQ(codes("main() { _SetTask2(0, f); } f() { }"), Codes{});
  EXPECT_EQ(codes("main() { _SetInterrupt(1, f); } f() { }"), Codes{});
  EXPECT_EQ(codes("VARINT v; main() { v.IntNum = 1; _SetVarInterrupt(v, f); } f() { }", "mdxb"), Codes{});
  EXPECT_EQ(codes("main() { _SystemCall(1, f); _InputCall(1, 3, g); } f() { } g() { }"), Codes{});
  EXPECT_EQ(codes("main() { if (H0) { while (H1) f(); } else g(); for (h(); H1; i()) ; switch (H2) { case 1: "
                  "j(); } do "
                  "k(); while (H3); H0 = (l(), 1); H4 ? m() : n(); }\n"
                  "f() {} g() {} h() {} i() {} j() {} k() {} l() {} m() {} n() {}"),
            Codes{});
}

TEST(Writers, OfOneVariable) {
  const auto said = [](const std::string& text) { return all_texts(text, nullptr, "several-writers"); };
  EXPECT_EQ(said("long n; main() { _SetTask2(1, t); n = 1; } t() { n = 2; }"),
            "'n' is written by 'main' and 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(
      said("long n; main() { _SetTask2(1, t); _SetInterrupt(1, u); n = 1; } t() { n = 2; } u() { n++; }"),
      "'n' is written by 'main', 't' and 'u'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("long n; main() { _SetTask2(1, t); f(); } t() { f(); } f() { n = 2; }"),
            "'n' is written by 'main' and 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("long n; main() { f(); n = 1; } f() { n = 2; }"), "");
  EXPECT_EQ(said("long n; main() { _SetTask2(1, t); H0 = n; } t() { n = 2; }"), "");
  EXPECT_EQ(said("long v[3]; main() { _SetTask2(1, t); v[0] = 1; v[1] = 1; } t() { v[2] = 2; }"), "");
  EXPECT_EQ(said("long v[3]; main() { _SetTask2(1, t); v[0] = 1; v[2] = 1; } t() { v[2] = 2; }"),
            "'v' is written by 'main' and 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("long v[3]; main() { _SetTask2(1, t); v[0] = 1; v[2] = 1; } t() { v[H0] = 2; }"),
            "'v' is written by 'main' and 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("long v[3], w; main() { _SetTask2(1, t); v[0] = 1; w = 1; } t() { w = 2; }"),
            "'w' is written by 'main' and 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("long w, v[3]; main() { _SetTask2(1, t); v[0] = 1; w = 1; } t() { w = 2; }"),
            "'w' is written by 'main' and 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("long n; main() { _SetTask2(1, t); _Wait(5); _SetTask2(1, u); } t() { n = 1; } u() { n = 2; }"), "")
      << "one task, one after the other";
  EXPECT_EQ(said("long n; main() { _SetTask2(1, t); _SetTask2(1, u); n = 3; } t() { n = 1; } u() { n = 2; }"),
            "'n' is written by 'main', 't' and 'u'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("#include <constb.h>\nlong n; main() { _SetTask2(1, t); _SetTask(1, t); } t() { n = 1; }"),
            "'n' is written by task 2 't' and task 3 't'\n"
            "  what one of them writes may be lost: give each a variable of its own, or let one of them write it\n");
  EXPECT_EQ(said("#include <constb.h>\nVARINT v; main() { v.Mode = 1; v.Priority = 1; _SetTask2(1, t); } t() { _SetVarInterrupt(v, u); } u() { }"), "")
      << "of what it takes orders from, a command writes the result alone";
  EXPECT_EQ(said("#declare N H300\nmain() { _SetTask2(1, t); N = 1; } t() { N = 2; }"), "")
      << "others know its number";
}

// W0258 alone; W0240 may be said beside it.
std::string lost_updates(const std::string& source) {
  std::string out;
  const Compilation c = compile_text(source);
  for (const Diagnostic& one : c.diagnostics.all())
    if (one.diag == Diag::LostUpdate) out += one.text + "\n";
  return out;
}

TEST(Writers, LoseUpdatesOfEachOther) {
  const std::string head = "long n, v[2]; main() { _SetTask2(1, t); v[0] = n; ";
  const std::string task = " } t() { n = 5; v[1] = 2; H5 = 1; }";
  const auto lost = [](const std::string& name) {
    return "'" + name +
           "' is read, computed and written back here in several commands; a value that 't' writes meanwhile "
           "is lost\n";
  };
  const auto said = [&](const std::string& text) { return lost_updates(head + text + task); };
  for (const char* update :
       {"n = n * 2 + 1;", "n = H0 + n;", "n = n + n;", "n = (n + 1) * 2;", "n = -n;", "n = ~n;",
        "n = H0 * (H1 - n);", "n = n > 3 ? n - 1 : 0;", "H3 = (n = n % 8 + 3);", "if (H1) n = n % 8 + 3;"})
    EXPECT_EQ(said(update), lost("n")) << update;
  for (const char* kept :
       {"n = n + 1;", "n = n - H0;", "n += H0 * 2;", "n++;", "n = H0 * 2 + 1;", "v[H0] = v[H0] * 2 + 1;",
        "H6 = H6 * 2 + 1;", "v[0] = v[0] * 2 + 1;", "n = v[0] * 2 + 1;"})
    EXPECT_EQ(said(kept), "") << kept;
  EXPECT_EQ(said("v[1] = v[1] * 2 + 1;"), lost("v"));
  EXPECT_EQ(said("H5 = H5 * 2 + 1;"), lost("H5"));
  EXPECT_EQ(lost_updates("long n; main() { _SetTask2(1, t); H0 = n; } t() { n = n * 2 + 1; }"), "");
  EXPECT_EQ(lost_updates("long n; main() { _SetTask2(1, t); f(); } t() { f(); } f() { n = n * 2 + 1; }"),
            "'n' is read, computed and written back here in several commands; a value that 'main' writes "
            "meanwhile is lost\n");
  EXPECT_EQ(codes("long n; main() { _SetTask2(1, t); n = 1; } t() { H0 = n; } u() { n = n * 2 + 1; }"),
            Codes{"W0202"});
}

TEST(Variables, ReadAndNeverWritten) {
  const std::pair<const char*, const char*> rows[] = {
      {"long a; main() { H0 = a; }", "'a' is read, but never written\n"},
      {"long v[3]; main() { H0 = v[1] + v[2]; }", "'v' is read, but never written\n"},
      {"long v[3]; main() { H0 = v[1]; v[2] = 1; }", ""},
      {"initial long a; main() { H200 = a; }", ""},
      {"#declare A H300\nmain() { H0 = A; }", ""},
      {"long a; main() { H0 = a; _Copy(a, H5, 1); }", ""},
      {"long a; main() { _BitSet(a, 1); }", ""},
      {"long a; main() { _BitMove(H0, 1, a, 2); }", "'a' is given to '_BitMove', but never written\n"},
      {"long a; main() { _BitMove(a, 1, H0, 2); }", ""},
      {"long a; main() { _BitMoveNeg(H0, 1, a, 2); }", "'a' is given to '_BitMoveNeg', but never written\n"},
      {"long a; main() { _BitMoveNeg(a, 1, H0, 2); }", ""},
      {"long a; main() { _Copy(H0, a, 1); }", "'a' is given to '_Copy', but never written\n"},
      {"long a; main() { _Copy(a, H0, 1); }", ""},
      {"SCREC r; main() { _SBusCommDef(3, r); }", "'r' is given to '_SBusCommDef', but never written\n"},
      {"SSPOSRAMP r; main() { _SetSys(9, r); }", "'r' is given to '_SetSys', but never written\n"},
      {"long r; main() { _GetSys(r, 1); H0 = r; }", ""},
      // What a function may write may be the first of several, up to eight; a function that reads tells nothing.
      {"long first, v[6], last; main() { _BitSet(first, 1); H0 = last + v[0]; }", ""},
      {"long first, v[7], last; main() { _BitSet(first, 1); H0 = last + v[0]; }",
       "'last' is read, but never written\n"},
      {"long first, last; main() { first = 1; _BitMove(H5, 1, first, 2); H0 = last; }",
       "'last' is read, but never written\n"},
      {"long first, last; main() { first = 1; _BitMoveNeg(first, 1, H5, 2); H0 = last; }", ""},
      {"long first, last; main() { first = 1; _Copy(first, H5, 1); H0 = last; }", ""},
      {"long first, last; main() { first = 1; _Copy(H5, first, 1); H0 = last; }",
       "'last' is read, but never written\n"},
      // Its number is taken: it and the eight variables from it on may be written by their numbers.
      {"long a, p; main() { p = numof(a); *p = 1; H0 = a; }", ""},
      {"long v[2], p; main() { p = numof(v[1]); *p = 1; H0 = v[1]; }", ""},
      {"SCREC r; long p; main() { p = numof(r.Len); *p = 1; H0 = r.Len; }", ""},
      {"long first, v[6], last, p; main() { p = numof(first); *(p + 7) = v[0]; H0 = last; }", ""},
      {"long first, v[7], last, p; main() { p = numof(first); *(p + 7) = v[0]; H0 = last; }",
       "'last' is read, but never written\n"},
      {"long last, p; main() { p = numof(H419); *p = 1; H0 = last; }", ""},
      {"long last, p; main() { p = numof(H413); *p = 1; H0 = last; }", ""},
      {"long last, p; main() { p = numof(H412); *p = 1; H0 = last; }", "'last' is read, but never written\n"},
  };
  for (const auto& [source, expected] : rows)
    EXPECT_EQ(all_texts(source, nullptr, "never-written"), expected) << source;
}

TEST(Variables, WhoseNumberIsForgotten) {
  const std::string text =
      "'DPointer' holds the number of a variable and gets the value of 'd'; numof( d ) is its number\n";
  const auto said = [](const std::string& statements) {
    return all_texts("SCREC r; long d, e, v[3]; main() { e = 1; d = e; v[0] = d; " + statements +
                     " _SBusCommDef(3, r); }");
  };
  EXPECT_EQ(said("r.DPointer = d;"), text);
  EXPECT_EQ(said("r.DPointer = (d);"), text);
  EXPECT_EQ(said("r.DPointer = numof(d);"), "");
  EXPECT_EQ(said("r.DPointer = d + 0 * e;"), "") << "computed";
  EXPECT_EQ(said("r.DPointer += d;"), "");
  EXPECT_EQ(said("r.Len = d;"), "");
  EXPECT_EQ(said("d = numof(e); r.DPointer = d;"), "");
  EXPECT_EQ(said("d = numof(e) + 1; r.DPointer = d;"), "");
  EXPECT_EQ(said("H0 = *d; r.DPointer = d;"), "");
  EXPECT_EQ(said("*(d + 1) = 5; r.DPointer = d;"), "");
  EXPECT_EQ(said("r.DPointer = d; H0 = *d;"), "") << "in any order";
  EXPECT_EQ(
      said("r.DPointer = v[1];"),
      "'DPointer' holds the number of a variable and gets the value of 'v'; numof( v ) is its number\n");
  for (const char* member :
       {"MOVLNK m; main() { m.DPointer", "SCTRCYCL m; main() { m.DPointer",
        "SCTRACYCL m; main() { m.DPointer", "VARINT m; main() { m.SrcVar", "GSCAM m; main() { m.SourceVar",
        "GSCAM m; main() { m.DestVar", "GSCAM_EXT m; main() { m.CamDestination"})
    EXPECT_EQ(codes("long d; " + std::string(member) + " = d; d = 1; }", "mdxb"), Codes{"W0256"}) << member;
}

TEST(Variables, WrittenAsANumber) {
  const auto said = [](const std::string& number) {
    return all_texts("SCREC r; long d, v[3], e; main() { d = 1; e = d; v[0] = e; r.DPointer = " + number +
                     "; }");
  };
  const auto is = [](const std::string& number, const std::string& name) {
    return "H" + number + " is '" + name + "'; numof( " + name + " ) says so\n  declared here\n";
  };
  EXPECT_EQ(said("419"), "");
  EXPECT_EQ(said("420"), is("420", "r"));
  EXPECT_EQ(said("422"), is("422", "r"));
  EXPECT_EQ(said("423"), is("423", "d"));
  EXPECT_EQ(said("424"), is("424", "v"));
  EXPECT_EQ(said("426"), is("426", "v"));
  EXPECT_EQ(said("427"), is("427", "e"));
  EXPECT_EQ(said("428"), "");
  EXPECT_EQ(said("-1"), "");
  EXPECT_EQ(said("420 + 3"), "") << "computed by the writer";
}

TEST(Variables, MayBePlacedAtRunTime) {
  EXPECT_EQ(codes("main() { *(H0 + 473) = 1; }"), Codes{}) << "which one it is, nobody knows";
  EXPECT_EQ(codes("long v[3]; main() { v[H0] = 1; v[H0 + 5] = 2; v[H1 - 5] = 3; }"), Codes{});
}

TEST(Names, ThatAreUnknownAreToldOnce) {
  EXPECT_EQ(codes("main() { x[1] = 2; }"), Codes{"E0201"});
  EXPECT_EQ(codes("long v[2]; main() { v[y] = 2; v[0] = v[y]; }"), Codes{"E0201"});
  EXPECT_EQ(codes("main() { x.y = 2; x.z = x.y; }"), Codes{"E0201"});
  EXPECT_EQ(codes("main() { x[y] = z; }"), (Codes{"E0201", "E0201", "E0201"}));
  EXPECT_EQ(codes("main() { *x = 2; numof(x); x++; -x; x ? y : z; f(x); f(); }"),
            (Codes{"E0201", "E0201", "E0201", "E0202"}));
  EXPECT_EQ(codes("main() { H0 = x ? 1 : 2; H0 = 1 ? x : y; H0 = (x, 1); H0 = (1, x); H0 = !x; }"),
            (Codes{"E0201", "W0253", "E0201", "W0216"}));
  EXPECT_EQ(codes("long v[x]; main() { v[0] = 1; }"), Codes{"E0201"});
  EXPECT_EQ(codes("#declare A x\nmain() { A = 1; }"), Codes{"E0201"});
  EXPECT_EQ(codes("main() { switch (x) { case y: ; } while (x) ; do ; while (z); for (a; b; c) ; }"),
            (Codes{"E0201", "E0201", "E0201", "E0201", "E0201", "E0201"}));
}

TEST(Allocation, MapAsText) {
  const Compilation good = compile_text(
      "#declare TARGET H300\ninitial long kept; SCREC r[2]; long v[3], p;\n"
      "main() { kept = 1; r[1].Len = TARGET; p = numof(v); f(); H473; H7 = v[0]; } f() { v[1] = H473; "
      "v[2]++; }",
      "mdxb");
  ASSERT_TRUE(good.image) << render_text(good.diagnostics.all(), *good.sources, false);
  const auto row = [](const char* number, const char* name, const char* type, const char* range,
                      const char* read, const char* written, const char* taken) {
    return fmt::format("{:12} {:24} {:14} {:12} {:20} {:20} {}\n", number, name, type, range, read, written,
                       taken);
  };
  EXPECT_EQ(map_text(good.map),
            row("number", "name", "type", "range", "read by", "written by", "number taken by") +
                row("H0", "kept", "long", "initials", "-", "main", "-") +
                row("H7", "H7", "long", "raw", "-", "main", "-") +
                row("H300", "TARGET", "long", "alias", "main", "-", "-") +
                row("H300", "H300", "long", "raw", "main", "-", "-") +
                row("H420..H425", "r", "SCREC[2]", "globals", "-", "main", "-") +
                row("H426..H428", "v", "long[3]", "globals", "main,f", "f", "main") +
                row("H429", "p", "long", "globals", "-", "main", "-") +
                row("H473", "StatusWord", "long", "system", "main,f", "-", "-"));
  std::vector<std::string> names;
  for (const vm::Symbol& symbol : good.image->symbols)
    names.push_back(fmt::format("{} {} {}", symbol.variable, symbol.name, symbol.count));
  EXPECT_EQ(names,
            (std::vector<std::string>{"0 kept 1", "300 TARGET 1", "420 r[0].ObjectNo 1", "421 r[0].Format 1",
                                      "422 r[0].DPointer 1", "423 r[1].ObjectNo 1", "424 r[1].Format 1",
                                      "425 r[1].DPointer 1", "426 v 3", "429 p 1"}));
}

TEST(Allocation, OfVariablesNobodyUses) {
  const auto said = [](const std::string& source) { return all_texts(source, nullptr, "unused-variable"); };
  EXPECT_EQ(said("long a; main() { }"), "variable 'a' is never used\n");
  EXPECT_EQ(said("initial long a; main() { }"), "variable 'a' is never used\n");
  EXPECT_EQ(said("#declare A H300\nmain() { }"), "");
  EXPECT_EQ(said("long v[3]; main() { v[2] = 1; }"), "");
  // A use reaches no further than what is used.
  const std::string b = "variable 'b' is never used\n";
  for (const char* exact :
       {"long v[3], b; main() { v[2] = 1; }", "long b, v[3]; main() { v[0] = 1; }",
        "SCREC r; long b; main() { r.DPointer = 5; }", "long b; SCREC r; main() { r.ObjectNo = 5; }",
        "SCREC r[2]; long b; main() { r[1].DPointer = 1; }", "SCREC q, r; long b; main() { q = r; r = q; }",
        "long a[2], c[2], b; main() { a = c; c = a; }", "long a, b; main() { a++; }",
        "long a, b; main() { H0 = a; a = H0; }",
        "typedef struct { long x[2]; long y; } S; S s; long b; main() { s.x[1] = 1; s.y = 1; }",
        "long a[2], b; main() { _Copy(a, H200, 2); }",
        "SCREC r; long b; main() { r.Len = 1; _SBusCommDef(3, r); }",
        "SCTRCYCL r; long b; main() { r.CycleTime = 10; _SBusCommDef(1, r); }"})
    EXPECT_EQ(said(exact), b) << exact;
  // The eight variables from one whose number is taken on may be used by their numbers.
  EXPECT_EQ(said("long a, v[6], b, p; main() { p = numof(a); }"), "");
  EXPECT_EQ(said("long a, v[7], b, p; main() { p = numof(a); H0 = p; }"), "variable 'b' is never used\n");
}

}  // namespace
}  // namespace ipos::compiler::test

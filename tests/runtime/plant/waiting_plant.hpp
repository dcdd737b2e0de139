// Random plants whose programs wait, look, count, send, receive and ask each other, with wires, switches, and stimuli at
// random times.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>

#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/quartz.hpp"

namespace ipos::tests {

inline constexpr const char* kWaitingHead = R"(
#include <constb.h>
#pragma globals 340 399
SCTRCYCL Tr; long d1; long d2;
SCTRACYCL Ta; long e1; long e2;
SCREC Re; long r1; long r2;
MOVLNK Ml; MLDATA Mld; MLDATA Mlx; long t[9];
long a; long b; long c; long n; long m;
Clock() { m = m + 1; }
Trouble() { b = b + 1; _Wait(5); H484 = 4096; _Wait(5); H484 = 0; }
)";

// Loop bodies; K and L are replaced by numbers.
inline constexpr int kWaitingOfMovidriveB = 2;  // the last ones
inline constexpr const char* kWaitingBodies[] = {
    "",
    "_Wait(K); n = n + 1;",
    "n = n + 1;",
    "d1 = d1 + 1; d2 = H511; H488 = L;",
    "n = n + 1; c = numof(a); *c = n; if (n == L * 50) { c = 481; *c = L; n = 0; }",
    "_GetSys(H481, GS_ACTSPEED); _Wait(K);",
    "n = n + 1; if (n > K) { _SetSys(SS_N11, H492); n = 0; }",
    "_GoRel(GO_NOWAIT, L); _Wait(L * 200); n = n + H473;",
    "if (H483 & L) n = n + 1;",
    "Mlx.WritePar = Mlx.WritePar + n; n = n + 1; Mld = Mlx;",
    "Mlx = Mld;",
    "_Copy(t[2], t[1], L); t[1] = n; if (t[0]) n = n + r1;",
    "t[c] = t[c] + L; c = c + 1; if (c == 9) { c = 0; _Wait(K); }",
    "c = numof(t[0]) + L; if (r1 & L) n = n + *c; *c = n;",
    "a = H483; a = a & 3; if (a == 3) b = b + 1;",
    "H488 = K; while (H488 > 0); n = n + 1; _Wait(L * 50);",
    "if (r1 > c) { c = r1; n = n + 1; }",
    "d1 = d1 + 1; _Wait(K);",
    "d1 = H483; d1 = d1 * 3; d2 = H511;",
    "_Wait(L * 100); _MoviLink(Ml); if (Ml.Result) n = n + 1;",
    "_Wait(K); n = n + 1; H481 = n & 255;",
    "H492 = H492 + L * 1000; _Wait(L * 300);",
    "_Wait(L * 200); _Memorize(MEM_STDATA);",
    "H490 = 200; if (r1 == 1) n = n + 1;",
    "if (H473 & 2) H484 = L; else H484 = 0; _Wait(K);",
    "_Wait(K); n = n + 1; if (n > L) return;",
    "_Wait(L * 300); a = 5 / (3 - c); c = c + 1;",
    "_SBusCommDef(SCD_TRACYCL, Ta); e1 = e1 + 1; _Wait(K * 3);",
    "_Wait(L * 400); _WdOn(K); _Wait(K / 2); _WdOff();",
    "_Wait(L * 50); _GoAbs(GO_WAIT, L * 3000); _Wait(L * 100); _GoAbs(GO_WAIT, 0);",
    "e1 = e1 + r1 * 3; e2 = (e2 ^ e1) / 7; if (e1 & L) e1 = e1 - e2;",
    "n = n + 1; d1 = d1 + 60000 / (L * 400 - n);",
    "a = H511; if (a > b) b = a; Clock();",
    "c = c + 1; if (c > K * 5) { _GoAbs(GO_NOWAIT, L * 700); c = 0; }",
    "while (H522 & 1) { H522 = 0; n = n + 1; }",
    "H540 = 1; H546 = L; _Wait(K); H540 = 0; _Wait(L * 100);",
};

class WaitingPlant {
 public:
  explicit WaitingPlant(uint64_t seed) : seed_(seed), random_(seed), card_(seed % 4 == 1), gateway_(seed % 4 == 2) {
    stations_ = pick(1, 4);
    serial_ = pick(0, 1) != 0;
    text_ =
        "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n[[bus]]\nname = \"line\"\nkind = "
        "\"rs485\"\n";
    for (int n = 0; n < stations_; ++n) station(n);
    if (card_ || gateway_) profibus();
    for (int n = pick(0, 2); n > 0; --n)
      text_ += fmt::format("[[wire]]\nfrom = \"u{}.DO0{}\"\nto = \"u{}.DI0{}\"\n", pick(0, stations_ - 1),
                           pick(1, 2), pick(0, stations_ - 1), wires_++ + 4);
    if (pick(0, 3) == 0) text_ += "[[switch]]\nstation = \"u0\"\ninput = \"DI02\"\nfrom = 1000\nto = 30000\n";
    for (int n = pick(0, 8); n > 0; --n) stimulus();
    if (pick(0, 3) == 0)
      text_ +=
          "[[fault]]\nbus = \"can\"\nkind = \"cut\"\nstation = \"u0\"\nfrom = \"700ms\"\nuntil = "
          "\"1500ms\"\n";
  }

  const std::string& text() const { return text_; }  // of the plant file
  const std::map<std::string, std::string>& sources() const { return sources_; }
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 private:
  std::string body(bool b) {
    const int bodies = static_cast<int>(std::size(kWaitingBodies)) - (b ? 0 : kWaitingOfMovidriveB);
    const char* const text = kWaitingBodies[static_cast<size_t>(pick(0, bodies - 1))];
    const int k = pick(1, 300), l = pick(1, 9);
    return numbered(text, k, l);
  }

  void station(int n) {
    static constexpr const char* kUnits[] = {"mdxb", "mdxb", "md60a", "mc07"};
    const std::string unit = kUnits[pick(0, 3)];
    const bool b = unit == "mdxb", m07 = unit == "mc07";
    const bool has_program = pick(0, 5) != 0;
    text_ += fmt::format("[[station]]\nname = \"u{0}\"\nunit = \"{1}\"\n{2}sbus = \"can\"\n{3}", n, unit,
                         has_program ? fmt::format("program = \"P{}.IPC\"\n", n) : "",
                         serial_ && (!m07 || pick(0, 1) == 0) ? "rs485 = \"line\"\n" : "");
    text_ += quartz(seed_, n);
    if (card_ && n == 0 && !m07) text_ += "option = \"dfp\"\nprofibus = \"dp\"\nprofibus_address = 9\n";
    text_ += fmt::format("[station.parameters]\nP{0} = {1}\nP810 = {1}\nP130 = 200\nP136 = 100\n",
                         b ? 881 : 813, n + 1);
    if (!m07 && pick(0, 2) == 0) text_ += "P841 = 1\n";
    const bool card = card_ && n == 0 && !m07;
    if (card)
      text_ += "P100 = 3\nP101 = 2\n";
    else if (pick(0, 2) == 0)
      text_ += "P100 = 10\nP101 = 3\n";
    if (b && pick(0, 1) == 0) text_ += "P700 = 13\nP903 = 5\n";
    if (b && pick(0, 1) == 0) text_ += fmt::format("P938 = {}\n", pick(0, 9));
    text_ += fmt::format("[station.inputs]\nDI0{} = 1\nDI0{} = 1\n", pick(m07 ? 1 : 0, m07 ? 2 : 1), 3);
    if (pick(0, 3) == 0) text_ += "[station.analog]\nAI1 = \"4 V\"\n";
    if (!has_program) return;
    std::string source = std::string(kWaitingHead) + "T2() { while (1) { " + body(b) + " } }\nT3() { while (1) { " +
                         body(b) + " } }\nmain() {\n";
    source += fmt::format(
        "Tr.ObjectNo = {0}; Tr.CycleTime = {1}; Tr.Offset = 0; Tr.Format = 8; Tr.DPointer = numof(d1);\n"
        "Re.ObjectNo = {2}; Re.Format = 8; Re.DPointer = {9};\n"
        "Ta.ObjectNo = {3}; Ta.Format = 4; Ta.DPointer = numof(e1);\n"
        "Ml.BusType = {4}; Ml.Address = {5}; Ml.Format = {6}; Ml.Service = ML_S_RD; Ml.Index = {7};\n"
        "Ml.DPointer = numof(Mld); Mld.PO1 = {8}; Mld.PO2 = 1000;\n",
        1100 + n, pick(1, 20) * 10, 1100 + (n + 1) % stations_, 1200 + n, pick(0, 1) == 0 ? 5 : 2,
        (n + 1) % stations_ + 1, pick(1, 5), pick(0, 1) == 0 ? 8318 : 11000 + pick(0, 500), pick(0, 7),
        pick(0, 5) == 0 ? fmt::format("{}", 480 + pick(0, 12)) : "numof(r1)");
    if (pick(0, 1) == 0) source += "_SBusCommDef(SCD_TRCYCL, Tr);\n";
    if (pick(0, 1) == 0) source += "_SBusCommDef(SCD_REC, Re);\n";
    if (pick(0, 2) != 0) source += "_SBusCommOn();\n";
    if (!m07 && pick(0, 3) == 0)
      source += fmt::format("H485 = {}; H489 = 10; _SetInterrupt(SI_TIMER0, Clock);\n",
                            pick(0, 1) * pick(50, 2000));
    if (!m07 && pick(0, 3) == 0) source += "_SetInterrupt(SI_ERROR, Trouble);\n";
    if (pick(0, 1) == 0) source += "_SetTask2(T2_START, T2);\n";
    if (b && pick(0, 1) == 0) source += "_SetTask(T2_START, T3);\n";
    source += "while (1) { " + body(b) + " }\n}\n";
    sources_[fmt::format("P{}.IPC", n)] = source;
  }

  // A master that begins, changes its words, falls silent and comes back; the card of u0, or a gateway to them all.
  void profibus() {
    text_ += "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n";
    std::string cfg = "F3 F2", words = "6, 2000, 0";
    if (gateway_) {
      text_ +=
          "[[station]]\nname = \"gw\"\nunit = \"gateway\"\nprofibus = \"dp\"\nprofibus_address = 9\n"
          "sbus = \"can\"\n";
      for (int n = 1; n < stations_; ++n) cfg += " F2", words += ", 6, 1000, 0";
    }
    text_ += fmt::format(
        "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 9\ncfg = \"{}\"\n"
        "watchdog = \"{}ms\"\npo = [{}]\n[[control.slave.change]]\nat = \"{}ms\"\n"
        "channel = \"72 0{} 20 70 00 00 00 09\"\n[[control.command]]\nat = \"{}ms\"\ncommand = \"stop\"\n"
        "[[control.command]]\nat = \"2500ms\"\ncommand = \"start\"\n",
        cfg, pick(2, 30) * 10, words, pick(100, 900), gateway_ ? 1 : 0, pick(1000, 2400));
  }

  void stimulus() {
    static constexpr const char* kWhat[] = {
        "input = \"DI01\"\npulse = 1\nfor = \"900ms\"\n",
        "input = \"DI01\"\nset = 1\n",
        "input = \"DI03\"\nset = 0\n",
        "input = \"DI02\"\npulse = 1\nfor = \"20ms\"\nevery = \"777ms\"\n",
        "parameter = \"P160\"\nset = 300000\n",
        "analog = \"AI1\"\nset = \"2 V\"\n",
        "parameter = \"P130\"\nset = 400\n"};
    text_ += fmt::format("[[stimulus]]\nstation = \"u{}\"\nat = \"{}us\"\n{}", pick(0, stations_ - 1),
                         pick(0, 3'000'000), kWhat[pick(0, static_cast<int>(std::size(kWhat)) - 1)]);
  }

  uint64_t seed_;
  std::mt19937_64 random_;
  bool card_, gateway_;  // on a PROFIBUS
  int stations_ = 0;
  bool serial_ = false;  // nobody is late who has a serial line
  int wires_ = 0;
  std::string text_;
  std::map<std::string, std::string> sources_;
};

}  // namespace ipos::tests

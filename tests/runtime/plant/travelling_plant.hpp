// Random plants whose axes travel: by setpoint and ramp, by positioning, led by a master on the bus; with every kind of motor,
// load and brake; under programs that wait for their way, look at it, turn it round in the middle, or have other work; with
// inputs, limit switches and setpoints that change while the axis is on its way.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>

#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/quartz.hpp"

namespace ipos::tests {

inline constexpr const char* kTravellingHead = R"(
#include <constb.h>
#pragma globals 340 399
SCTRCYCL Tr; long d1; long d2;
SCREC Re; long r1; long r2;
long a; long b; long c; long n; long m; long e; long t[4];
)";

// What a task that leads the axis does over and over; K and L are replaced by numbers.
inline constexpr const char* kTravels[] = {
    "d1 = d1 + 1; if (H473 & 0x80000) { if (H492 == 0) _GoAbs(GO_NOWAIT, K * 97); else _GoAbs(GO_NOWAIT, 0); }",
    "_GoAbs(GO_WAIT, K * 131); n = n + 1; _GoAbs(GO_WAIT, L * -700);",
    "_GoRel(GO_WAIT, K * 61); _Wait(K); if (n > L) { n = 0; _GoAbs(GO_WAIT, 0); } n = n + 1;",
    "c = c + 1; if (c > K * 4) { c = 0; _GoRel(GO_NOWAIT, L * 1777 - 8000); }",
    ("if (H511 > K * 50) _GoAbs(GO_NOWAIT, K * -50); if (H511 <= K * -50) _GoAbs(GO_NOWAIT, K * 51); "
     "if (H492 == 0) _GoAbs(GO_NOWAIT, K * 51);"),
    "H492 = K * 60; while (!(H473 & 0x80000)) n = n + 1; H492 = L * -900; while (!(H473 & 0x80000)) m = m + L;",
    "_GoAbs(GO_NOWAIT, K * 300); _Wait(K * 3); _AxisStop(AS_PSTOP); _Wait(L * 40); _GoAbs(GO_NOWAIT, 0); _Wait(K * 5);",
    "_GoAbs(GO_NOWAIT, K * 400); _Wait(K * 4); _AxisStop(AS_RSTOP); _Wait(L * 20); _AxisStop(AS_ENABLE); _Wait(K);",
    "if (e == 0) { e = 1; _GoAbs(GO_NOWAIT, K * 500); } a = H491 - H511; if (H495 > L * 10) b = b + 1;",
    "a = r1 & 0x3FFF; _GoAbs(GO_NOWAIT, a); _Wait(K);",
    "H484 = 0; _Wait(K * 3); H484 = 2; _Wait(L * 9);",
    "n = n + 1; if (n > K * 20) { n = 0; b = 1 / (r2 - r2); }",
};
// What the other tasks do.
inline constexpr const char* kBesides[] = {
    "n = n + 1;",
    "m = m * 3 + r1; if (m < 0) m = -m;",
    "if (H483 & L) c = c + 1; else c = c - 1;",
    "if (H482 & L) e = e + 1;",
    "if (H473 & 0x80000) b = b + 1;",
    "d2 = H511;",
    "d2 = (H509 + H510) / L;",
    "d2 = H492 - H491;",
    "d2 = H492;",
    "m = m + 1; _Wait(L);",
    "t[n & 3] = m; m = m + t[(n + 1) & 3]; n = n + 1;",
    "if (H488 == 0) { H488 = K; d2 = d2 + 1; }",
    "H481 = m >> 4; m = m + 1;",
    "_GetSys(a, GS_ACTCUR);",
    "if (m % 97 == 0) { a = K * 5000; _SetSys(SS_N11, a); } m = m + 1;",
};

class TravellingPlant {
 public:
  explicit TravellingPlant(uint64_t seed) : seed_(seed), random_(seed) {
    stations_ = pick(1, 3);
    slow_ = pick(0, 2) == 0;  // frames wait for the line
    text_ = fmt::format("seed = {}\n[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = {}\n", pick(0, 9), slow_ ? 125'000 : 500'000);
    const int led = pick(0, 3) == 0 ? pick(0, stations_ - 1) : -1;
    for (int n = 0; n < stations_; ++n) station(n, n == led);
    if (led >= 0) master(led);
    for (int n = pick(0, 5); n > 0; --n) stimulus();
    if (pick(0, 5) == 0)
      text_ += fmt::format("[[wire]]\nfrom = \"u{}.DO01\"\nto = \"u{}.DI02\"\n", pick(0, stations_ - 1),
                           pick(0, stations_ - 1));
  }

  const std::string& text() const { return text_; }  // of the plant file
  const std::map<std::string, std::string>& sources() const { return sources_; }
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 private:
  template <class Row, size_t count>
  const Row& one_of(const Row (&rows)[count]) {
    return rows[static_cast<size_t>(pick(0, static_cast<int>(count) - 1))];
  }
  std::string filled(const char* text) { return numbered(text, pick(1, 200), pick(1, 9)); }

  void station(int n, bool led) {
    const bool b = pick(0, 4) != 0, has_program = pick(0, 9) != 0, positions = has_program && !led && pick(0, 3) != 0;
    text_ += fmt::format("[[station]]\nname = \"u{0}\"\nunit = \"{1}\"\nsbus = \"can\"\n", n, b ? "mdxb" : "md60a");
    text_ += quartz(seed_, n);
    if (has_program) text_ += fmt::format("program = \"P{}.IPC\"\n", n);
    if (pick(0, 3) == 0) text_ += "control = \"real\"\n";
    if (pick(0, 7) == 0) text_ += "noise = \"0.3 %\"\n";
    text_ += fmt::format("[station.parameters]\n{} = {}\n{} = {}\n", b ? "P881" : "P813", n + 1, b ? "P884" : "P816", slow_ ? 0 : 2);
    if (led) text_ += fmt::format("P100 = 10\nP101 = 3\nP876 = 1\nP870 = {}\nP871 = 1\n", 9);
    if (led && pick(0, 2) != 0) text_ += fmt::format("{} = '{} ms'\n", b ? "P883" : "P815", pick(2, 15) * 10);  // may run out
    ramps();
    if (positions) positioning();
    outputs();
    text_ += "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
    const bool has_switch = pick(0, 5) == 0;
    text_ += fmt::format("DI04 = {}\n", pick(0, 1));
    if (!has_switch) text_ += fmt::format("DI05 = {}\n", pick(0, 4) == 0 ? 0 : 1);
    machine();
    if (has_program) program(n, b, positions);
    if (has_switch)
      text_ += fmt::format("[[switch]]\nstation = \"u{}\"\ninput = \"DI05\"\nfrom = {}\nactive = \"low\"\n", n, pick(1000, 20'000));
  }

  // In ms, as the parameters have steps.
  int ramp() { return pick(0, 1) == 0 ? pick(2, 99) * 10 : pick(10, 40) * 100; }

  void ramps() {
    text_ += fmt::format("P130 = {}\nP131 = {}\nP132 = {}\nP133 = {}\nP134 = {}\nP135 = {}\nP136 = {}\nP137 = {}\n",
                         ramp(), ramp(), ramp(), ramp(), ramp(), pick(0, 1) * pick(0, 3), pick(2, 90) * 10, pick(2, 90) * 10);
    text_ += fmt::format("P160 = {}\nP161 = {}\nP162 = {}\n", pick(-7, 7) * 200'200, pick(-7, 7) * 200'000,
                         pick(-7, 7) * 100'000);
    if (pick(0, 2) == 0) text_ += fmt::format("P303 = {}\n", pick(30, 140) * 1000);
    if (pick(0, 3) == 0) text_ += fmt::format("P500 = {}\nP501 = {}\n", pick(0, 3), pick(1, 90) * 10);
    if (pick(0, 3) == 0) text_ += fmt::format("P731 = {}\nP732 = {}\n", pick(0, 300), pick(0, 300));
    if (pick(0, 3) == 0) text_ += fmt::format("P603 = {}\n", pick(14, 15));  // a limit switch
    if (pick(0, 3) == 0) text_ += fmt::format("P604 = {}\n", pick(14, 20));
    if (pick(0, 1) == 0) text_ += "P841 = 1\n";
  }

  void positioning() {
    text_ += fmt::format("P700 = 13\nP911 = {}\nP912 = {}\nP913 = {}\nP914 = {}\nP916 = {}\n", pick(2, 149) * 10,
                         pick(2, 149) * 10, pick(1, 30) * 100'000, pick(1, 30) * 100'000, pick(0, 2));
    if (pick(0, 2) == 0) text_ += fmt::format("P910 = {}\nP915 = {}\n", pick(1, 4) * 500, pick(0, 4) * 25'000);
    if (pick(0, 2) == 0) text_ += fmt::format("P922 = {}\n", pick(0, 900));
    if (pick(0, 2) == 0) text_ += fmt::format("P923 = {}\n", pick(0, 3) * pick(10, 900));
    if (pick(0, 3) == 0) text_ += fmt::format("P920 = {}\nP921 = {}\nP903 = 5\n", pick(4, 30) * 500, pick(-20, 0) * 500);
    if (pick(0, 4) == 0) text_ += fmt::format("P942 = {}\nP943 = {}\n", pick(1, 9), pick(1, 9));
    if (pick(0, 6) == 0) text_ += fmt::format("P941 = {}\n", pick(0, 2));
    if (pick(0, 6) == 0) text_ += "P930 = 1\n";
  }

  void outputs() {
    if (pick(0, 3) == 0) {  // no output tells of a fault
      text_ += "P620 = 0\nP621 = 0\n";
      return;
    }
    if (pick(0, 1) == 0) text_ += fmt::format("P620 = {}\n", pick(1, 21));
    if (pick(0, 1) == 0) text_ += fmt::format("P621 = {}\n", pick(9, 13));
    if (pick(0, 2) == 0) text_ += fmt::format("P400 = {}\nP402 = {}\n", pick(1, 14) * 100'000, pick(0, 3) * 100);
  }

  void machine() {
    if (pick(0, 2) == 0) {
      static constexpr const char* kTypes[] = {"DT90L4", "DV100M4", "DT71D4"};
      text_ += fmt::format("[station.motor]\ntype = \"{}\"\n", one_of(kTypes));
      if (pick(0, 1) == 0) text_ += fmt::format("[station.brake]\nrelease = \"{}ms\"\napply = \"{}ms\"\n", pick(0, 90), pick(0, 90));
    }
    if (pick(0, 2) == 0) return;
    static constexpr const char* kTorques[] = {"constant", "speed", "position"};
    text_ += fmt::format("[station.load]\ninertia = {}\nfriction = {}\ntorque = {}\ntorque_by = \"{}\"\n", pick(0, 900), pick(0, 40),
                         pick(-3, 3) * 20, one_of(kTorques));
    if (pick(0, 2) == 0) text_ += "braking_resistor = false\n";
    if (pick(0, 2) == 0)
      text_ += fmt::format("[station.load.second]\ninertia = \"0.0{} kgm2\"\nstiffness = \"{} Nm/rad\"\n{}", pick(1, 9), pick(20, 400),
                           pick(0, 1) == 0 ? "backlash = \"1 deg\"\n" : "");
  }

  void program(int n, bool b, bool positions) {
    const auto body = [&] { return filled(one_of(kBesides)); };
    const std::string travel = positions ? filled(one_of(kTravels)) : body();
    std::string source = fmt::format("{}T2() {{ while (1) {{ {} }} }}\nT3() {{ while (1) {{ {} }} }}\nmain() {{\n", kTravellingHead,
                                     body(), body());
    const auto data = [&](const char* plain) {
      static constexpr int kSystem[] = {473, 491, 495, 509, 511};
      return pick(0, 4) == 0 ? std::to_string(kSystem[pick(0, 4)]) : std::string("numof(") + plain + ")";
    };
    source += fmt::format(
        "Tr.ObjectNo = {0}; Tr.CycleTime = {1}; Tr.Format = {2}; Tr.DPointer = {3};\n"
        "Re.ObjectNo = {4}; Re.Format = 8; Re.DPointer = {5};\n",
        1100 + n, pick(0, 1) == 0 ? pick(2, 9) : pick(1, 5) * 10, pick(0, 1) == 0 ? 4 : 8, data("d1"), 1100 + (n + 1) % stations_,
        pick(0, 9) == 0 ? "491" : "numof(r1)");
    if (pick(0, 3) != 0) source += "_SBusCommDef(SCD_TRCYCL, Tr);\n";
    if (pick(0, 3) != 0) source += "_SBusCommDef(SCD_REC, Re);\n";
    if (pick(0, 3) != 0) source += "_SBusCommOn();\n";
    if (pick(0, 1) == 0) source += "_SetTask2(T2_START, T2);\n";
    if (b && pick(0, 2) == 0) source += "_SetTask(T2_START, T3);\n";
    if (positions && pick(0, 6) == 0) source += "_Go0(GO0_C_W_ZP);\n";
    sources_[fmt::format("P{}.IPC", n)] = source + "while (1) { " + travel + " }\n}\n";
  }

  // Setpoints come while the axis is on its way to the last one.
  void master(int n) {
    text_ += fmt::format(
        "[[control]]\nname = \"plc\"\nsbus = \"can\"\n[[control.target]]\naddress = {}\npo = [6, {}]\nevery = \"{}ms\"\n", n + 1,
        pick(-7500, 7500), pick(5, 90));
  }

  void stimulus() {
    const int n = pick(0, stations_ - 1);
    text_ += fmt::format("[[stimulus]]\nstation = \"u{}\"\nat = \"{}us\"\n", n, pick(0, 3'000'000));
    static constexpr int kInputs[] = {0, 1, 3, 4};
    switch (pick(0, 4)) {
      case 0: text_ += fmt::format("input = \"DI0{}\"\nset = {}\n", kInputs[pick(0, 3)], pick(0, 1)); break;
      case 1: text_ += fmt::format("input = \"DI0{}\"\npulse = {}\nfor = \"{}ms\"\n", kInputs[pick(1, 3)], pick(0, 1), pick(1, 300)); break;
      case 2: text_ += fmt::format("parameter = \"P16{}\"\nset = {}\n", pick(0, 2), pick(-7, 7) * 200'000); break;
      case 3: text_ += fmt::format("parameter = \"P13{}\"\nset = {}\n", pick(0, 4), ramp()); break;
      default: text_ += fmt::format("mains = \"{}\"\n", pick(0, 1) == 0 ? "off" : "on");
    }
  }

  uint64_t seed_;
  std::mt19937_64 random_;
  int stations_ = 0;
  bool slow_ = false;
  std::string text_;
  std::map<std::string, std::string> sources_;
};

}  // namespace ipos::tests

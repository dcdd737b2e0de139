// Random plants whose stations turn their shafts and have busy programs, with telegrams, calls over SBus and RS-485, and
// MOVITRAC 31 on a PROFIBUS.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>

#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/quartz.hpp"

namespace ipos::tests {

inline constexpr const char* kBusyHead = R"(
#include <constb.h>
#pragma globals 340 399
SCTRCYCL Tr; long d1; long d2;
SCREC Re; long r1; long r2;
MOVLNK Ml; MLDATA Mld; MLDATA Mlx; long t[9];
long a; long b; long c; long n; long m; long e1; long e2;
Step() { m = m * 3 + r2; }
)";

// What tasks do over and over; K and L are replaced by numbers.
inline constexpr int kBusyCalm = 10;         // the first ones leave the unit alone
inline constexpr int kBusyOfMovidriveB = 1;  // the last one
inline constexpr const char* kBusyBodies[] = {
    "n = n + 1;",
    "d1 = d1 + 1; d2 = d2 ^ r1;",
    "c = c + 1; if (c > L) c = 0;",
    "e1 = e1 + r1 * 3; e2 = (e2 ^ e1) / 7; if (e1 & L) e1 = e1 - e2;",
    "Step();",
    "Mlx.WritePar = Mlx.WritePar + n; n = n + 1; Mlx.ReadPar = r1; Mld = Mlx;",
    "_Copy(t[2], t[1], L); t[1] = t[1] + n; n = n + r1;",
    "t[c] = t[c] + L; c = c + 1; if (c == 9) c = 0;",
    "c = numof(t[0]) + L; n = n + *c; *c = n;",
    "if (H483 & L) c = c + 1; else c = c - 1;",
    "b = b + 60000 / (L * 150 - c); c = c + 1;",
    "b = b + 1000 / (r1 - K);",
    "a = H511;",
    "a = H488; if (a == 0) n = n + r1;",
    "if (n % 50 == 0) H488 = K; n = n + 1;",
    "H481 = e2 >> 2; e2 = e2 + 1;",
    "c = c + 1; if (c == L * 300) { H484 = 4096; b = 1 / (c - L * 300); }",
    "c = c + 1; if (c > K * 9) { _GoRel(GO_NOWAIT, L * 700); c = 0; }",
    "_Wait(K); n = n + L;",
    "if (H522 & 1) { H522 = 0; n = n + r1; }",
};

class BusyPlant {
 public:
  explicit BusyPlant(uint64_t seed) : seed_(seed), random_(seed) {
    stations_ = pick(2, 5);
    static constexpr int kBauds[] = {125'000, 500'000, 1'000'000};
    text_ = fmt::format(
        "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = {}\n[[bus]]\nname = \"line\"\nkind = \"rs485\"\n",
        kBauds[baud_ = pick(0, 2)]);
    asks_ = pick(0, 2) == 0 ? pick(0, stations_ - 1) : -1;
    serial_ = pick(0, 1) != 0;
    for (int n = 0; n < stations_; ++n) station(n);
    if (pick(0, 3) == 0)
      text_ += fmt::format("[[wire]]\nfrom = \"u{}.DO01\"\nto = \"u{}.DI04\"\n", pick(0, stations_ - 1),
                           pick(0, stations_ - 1));
    if (pick(0, 3) == 0)
      text_ += fmt::format(
          "[[stimulus]]\nstation = \"u{}\"\nat = \"{}us\"\n{}", pick(0, stations_ - 1), pick(0, 5'000'000),
          pick(0, 1) == 0 ? "input = \"DI03\"\nset = 0\n" : "parameter = \"P160\"\nset = 300000\n");
    if (pick(0, 2) == 0) profibus();
  }

  const std::string& text() const { return text_; }  // of the plant file
  const std::map<std::string, std::string>& sources() const { return sources_; }
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 private:
  std::string body(bool b) {
    const int bodies = static_cast<int>(std::size(kBusyBodies)) - (b ? 0 : kBusyOfMovidriveB);
    const int calm = pick(0, 2) == 0 ? kBusyCalm : bodies;
    const char* const text = kBusyBodies[static_cast<size_t>(pick(0, calm - 1))];
    const int k = pick(1, 200), l = pick(1, 9);
    return numbered(text, k, l);
  }

  // MOVITRAC 31 on a line of their own, with a master that changes setpoints, syncs, and may stop.
  void profibus() {
    static constexpr int kRates[] = {93'750, 187'500, 500'000, 1'500'000};
    text_ += fmt::format("[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = {}\n", kRates[pick(0, 3)]);
    const int units = pick(1, 2);
    for (int n = 0; n < units; ++n)
      text_ += fmt::format(
          "[[station]]\nname = \"m{0}\"\nunit = \"mc31\"\noption = \"{1}\"\nprofibus = \"dp\"\n"
          "profibus_address = {2}\n[station.parameters]\nP841 = {3}\nP572 = {4}\nP600 = 0\nP601 = 0\n"
          "[station.inputs]\nDI00 = 1\n",
          n, pick(0, 1) == 0 ? "ffp31" : "size0", 8 + n, pick(0, 3) != 0 ? 1 : 0, pick(0, 7));
    text_ += fmt::format("[[control]]\nname = \"plc\"\nprofibus = \"dp\"\naddress = {}\ngap = {}\n",
                         pick(0, 7), pick(0, 10));
    for (int n = 0; n < units; ++n) {
      static constexpr const char* kCfg[] = {"F1", "F2", "F3 F1", "F3 F2"};
      text_ += fmt::format("[[control.slave]]\naddress = {}\ncfg = \"{}\"\npo = [6, {}]\n", 8 + n,
                           kCfg[pick(0, 3)], pick(-7500, 7500));
      if (pick(0, 2) != 0) text_ += fmt::format("watchdog = \"{}ms\"\n", 10 * pick(2, 200));
      for (int change = pick(0, 4); change > 0; --change)
        text_ += fmt::format("[[control.slave.change]]\nat = \"{}us\"\npo = [{}, {}]\n", pick(0, 5'000'000),
                             pick(0, 4) == 0 ? pick(0, 127) : 6, pick(-7500, 7500));
    }
    static constexpr const char* kCommands[] = {"sync",  "unsync", "freeze", "unfreeze",
                                                "clear", "stop",   "start"};
    for (int command = pick(0, 6); command > 0; --command)
      text_ += fmt::format("[[control.command]]\nat = \"{}us\"\ncommand = \"{}\"\n", pick(0, 5'000'000),
                           kCommands[pick(0, 6)]);
    static constexpr const char* kFaults[] = {"lost", "cut", "parity", "noise", "collision"};
    if (pick(0, 2) == 0)
      text_ += fmt::format("[[fault]]\nbus = \"dp\"\nkind = \"{}\"\nrate = {}\nseed = {}\n",
                           kFaults[pick(0, 4)], pick(1, 300), pick(1, 99));
  }

  void station(int n) {
    const bool asks = n == asks_, b = pick(0, 4) != 0;
    text_ += fmt::format(
        "[[station]]\nname = \"u{0}\"\nunit = \"{1}\"\nprogram = \"P{0}.IPC\"\nsbus = \"can\"\n{2}"
        "[station.parameters]\n{3} = {4}\n{5} = {6}\nP810 = {4}\nP130 = 200\nP160 = {7}\nP620 = 21\n",
        n, b ? "mdxb" : "md60a", (serial_ && (asks || pick(0, 1) == 0) ? "rs485 = \"line\"\n" : "") + quartz(seed_, n),
        b ? "P881" : "P813", n + 1, b ? "P884" : "P816", baud_ == 0 ? 0 : baud_ + 1, pick(-5, 5) * 200'200);
    if (pick(0, 1) == 0) text_ += "P841 = 1\n";
    if (pick(0, 3) == 0) text_ += "P700 = 13\n";
    if (b && pick(0, 3) == 0) text_ += fmt::format("P938 = {}\n", pick(0, 9));
    text_ += "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
    std::string source =
        fmt::format("{}T2() {{ while (1) {{ {} }} }}\nT3() {{ while (1) {{ {} }} }}\nmain() {{\n", kBusyHead,
                    body(b), body(b));
    const auto data = [&](const char* plain) {
      static constexpr int kSystem[] = {481, 484, 488, 491, 510, 530};
      return pick(0, 5) == 0 ? std::to_string(kSystem[pick(0, b ? 5 : 4)])
                             : std::string("numof(") + plain + ")";
    };
    source += fmt::format(
        "Tr.ObjectNo = {0}; Tr.CycleTime = {1}; Tr.Format = 8; Tr.DPointer = {2};\n"
        "Re.ObjectNo = {3}; Re.Format = 8; Re.DPointer = {4};\n"
        "_SBusCommDef(SCD_TRCYCL, Tr); _SBusCommDef(SCD_REC, Re); _SBusCommOn();\n",
        1100 + n, pick(0, 1) == 0 ? pick(2, 9) : pick(1, 5) * 10, data("d1"), 1100 + (n + 1) % stations_,
        data("r1"));
    if (pick(0, 1) == 0) source += "_SetTask2(T2_START, T2);\n";
    if (b && pick(0, 1) == 0) source += "_SetTask(T2_START, T3);\n";
    if (asks)
      source += fmt::format(
          "Ml.BusType = {}; Ml.Format = {}; Ml.Service = {}; Ml.Index = {}; Ml.DPointer = numof(Mld);\n"
          "Mld.PO1 = 6; Mld.PO2 = 1000; Mld.WritePar = {};\n"
          "while (1) {{ Ml.Address = Ml.Address % {} + 1; _MoviLink(Ml); e1 = e1 ^ Mld.PI2; _Wait({}); "
          "}}\n}}\n",
          serial_ && pick(0, 1) == 0 ? 2 : 5, pick(1, 5), pick(0, 2) == 0 ? "ML_S_WRV" : "ML_S_RD",
          pick(0, 1) == 0 ? 11'511 : 11'000 + pick(480, 531), pick(0, 100), stations_, pick(1, 300));
    else
      source += "while (1) { " + body(b) + " }\n}\n";
    sources_[fmt::format("P{}.IPC", n)] = source;
  }

  uint64_t seed_;
  std::mt19937_64 random_;
  int stations_ = 0;
  int baud_ = 0;
  int asks_ = -1;  // the others
  bool serial_ = false;
  std::string text_;
  std::map<std::string, std::string> sources_;
};

}  // namespace ipos::tests

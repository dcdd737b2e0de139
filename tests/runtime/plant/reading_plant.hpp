// Random plants whose programs read as people write it, on every kind of bus.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <random>
#include <string>

#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/reading_programs.hpp"

namespace ipos::tests {

class ReadingPlant {
 public:
  enum class Kind : uint8_t { Sbus, Serial, Card, Canopen, Gateway };
  static constexpr int kKinds = 5;

  explicit ReadingPlant(uint64_t seed)
      : random_(seed),
        kind_(static_cast<Kind>(seed % kKinds)),
        receives_(pick(0, 1) == 0),
        circles_(receives_ && pick(0, 2) != 0),
        moves_((receives_ && !circles_) || pick(0, circles_ ? 4 : 1) != 0),
        plain_(receives_ || pick(0, 1) != 0) {
    if (circles_ && pick(0, 3) != 0) kind_ = Kind::Sbus;
    stations_ = pick(2, 3);
    text_ = "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n";
    if (kind_ == Kind::Serial) text_ += "[[bus]]\nname = \"line\"\nkind = \"rs485\"\n";
    if (kind_ == Kind::Canopen) canopen();
    for (int n = 0; n < stations_; ++n) station(n);
    if (kind_ == Kind::Card || kind_ == Kind::Gateway) profibus();
    for (int n = circles_ ? 0 : pick(0, 4); n > 0; --n) stimulus();
  }

  const std::string& text() const { return text_; }  // of the plant file
  const std::map<std::string, std::string>& sources() const { return sources_; }
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }
  template <class Row, size_t count>
  const Row& one_of(const Row (&rows)[count]) {
    return rows[static_cast<size_t>(pick(0, static_cast<int>(count) - 1))];
  }

 private:
  std::string use() {
    const Reading& reading = circles_ && pick(0, 4) != 0 ? kTelegrams[0] : receives_ || pick(0, 5) == 0 ? one_of(kTelegrams) : one_of(kReadings);
    std::string text = circles_ ? one_of(kCircles) : one_of(kUses);
    replace_word(text, "SETOUT", "_BitSet(H481, 1);");
    replace_word(text, "CLEAROUT", "_BitClear(H481, 1);");
    replace_word(text, "F", reading.fetch);
    replace_word(text, "V", reading.value);
    return text;
  }

  std::string loop() {
    std::string text = plain_ ? kLoops[0] : one_of(kLoops);
    replace_word(text, "B", use());
    replace_word(text, "C", use());
    return numbered(text, pick(1, 40), pick(1, 7));
  }

  // Of the first station, whose values the others get.
  std::string source() {
    const char* const text = !moves_ ? one_of(kStanding) : receives_ ? one_of(kRhythms) : one_of(kMoving);
    return numbered(text, pick(1, 33), pick(1, 7));
  }

  void station(int n) {
    static constexpr const char* kUnits[] = {"mdxb", "mdxb", "md60a", "mc07"};
    std::string unit = one_of(kUnits);
    const bool card = kind_ == Kind::Card && n == 1, canopen = kind_ == Kind::Canopen && n == 1;
    if (canopen || (card && unit == "mc07")) unit = "mdxb";
    const bool b = unit == "mdxb", m07 = unit == "mc07";
    text_ += fmt::format(
        "[[station]]\nname = \"u{0}\"\nunit = \"{1}\"\nprogram = \"P{0}.IPC\"\nsbus = \"can\"\n", n, unit);
    if (kind_ == Kind::Serial) text_ += "rs485 = \"line\"\n";
    if (card) text_ += "option = \"dfp\"\nprofibus = \"dp\"\nprofibus_address = 9\n";
    text_ += fmt::format("[station.parameters]\nP{0} = {1}\nP810 = {1}\nP130 = 200\nP136 = 100\n",
                         b ? 881 : 813, n + 1);
    sources_[fmt::format("P{}.IPC", n)] = program(n, b, m07);
    if (canopen) text_ += "P880 = 1\nP886 = 5\n";
    if (card || canopen || (kind_ == Kind::Gateway && pick(0, 1) == 0))
      text_ += card ? "P100 = 3\nP101 = 2\n" : "P100 = 10\nP101 = 3\n";
    else if (!circles_ && pick(0, 2) == 0)
      text_ += fmt::format("P160 = {}\n", pick(-4, 4) * 200'200);
    if (b && pick(0, 2) == 0) text_ += "P700 = 13\nP903 = 5\n";
    if (b && pick(0, circles_ ? 3 : 1) == 0) text_ += fmt::format("P938 = {}\n", pick(0, 9));
    if (!m07 && pick(0, 3) == 0) text_ += "P841 = 1\n";
    if (circles_) return;  // its drive stands
    text_ += "[station.inputs]\n";
    if (pick(0, 1) == 0) text_ += fmt::format("DI00 = {}\nDI01 = 1\nDI03 = 1\n", m07 ? 0 : 1);
    if (pick(0, 1) == 0) text_ += "DI04 = 1\n";
  }

  std::string program(int n, bool b, bool m07) {
    const std::string body = n == 0 ? source() : loop();
    std::string text = std::string(kReadingHead);
    if (!circles_) text += "T2() { " + loop() + " }\nT3() { " + loop() + " }\n";
    text += "main() {\n";
    text += fmt::format(
        "Tr.ObjectNo = {0}; Tr.CycleTime = {1}; Tr.Offset = {2}; Tr.Format = 8; Tr.DPointer = numof(t1);\n"
        "Re.ObjectNo = {3}; Re.Format = {4}; Re.DPointer = numof(r1);\n"
        "Ta.ObjectNo = {5}; Ta.Format = 8; Ta.DPointer = numof(s1);\n"
        "Ml.BusType = {6}; Ml.Address = {7}; Ml.Format = {8}; Ml.Service = ML_S_RD; Ml.Index = {9};\n"
        "Ml.DPointer = numof(Md); Md.PO1 = {10}; Md.PO2 = 1000;\n",
        1100 + n, circles_ ? (pick(0, 2) == 0 ? pick(1, 30) : pick(8, 12)) : pick(0, 2) == 0 ? pick(1, 9) : pick(1, 5) * 10, pick(0, 1) * pick(0, 30),
        1100 + (n == 0 ? stations_ - 1 : 0), pick(0, 3) == 0 ? 4 : 8, 1200 + n, kind_ == Kind::Serial ? 2 : 5,
        (n + 1) % stations_ + 1, pick(1, 5), pick(0, 1) == 0 ? 8318 : 11'000 + pick(320, 350), pick(0, 7));
    // Many only send, many only receive.
    const bool forwards = circles_ && body.find("t1") != std::string::npos;
    if (forwards || (n == 0 ? receives_ || pick(0, 5) != 0 : !circles_ && pick(0, 2) == 0))
      text += "_SBusCommDef(SCD_TRCYCL, Tr);\n";
    if (n == 0 ? pick(0, 2) == 0 : receives_ || pick(0, 5) != 0) text += "_SBusCommDef(SCD_REC, Re);\n";
    if (receives_ || kind_ == Kind::Sbus || pick(0, 3) != 0) text += "_SBusCommOn();\n";
    if (!plain_ && !m07 && pick(0, 4) == 0)
      text +=
          fmt::format("H485 = {}; H489 = 10; _SetInterrupt(SI_TIMER0, Clock);\n", pick(0, 1) * pick(50, 900));
    if (!plain_ && b && pick(0, 2) == 0)
      text += fmt::format(
          "Vi.Control = {}; Vi.IntNum = {}; Vi.SrcVar = {}; Vi.CompareVar = {}; Vi.Mode = {}; Vi.Priority = "
          "{};\n"
          "_SetVarInterrupt(Vi, Event);\n",
          pick(1, 2), pick(0, 3),
          pick(0, 2) == 0   ? "483"
          : pick(0, 1) == 0 ? "numof(r1)"
                            : "numof(b)",
          pick(0, 9), pick(0, 9), pick(1, 10));
    if (!plain_ && pick(0, 2) == 0) text += "_SetTask2(T2_START, T2);\n";
    if (!plain_ && b && pick(0, 2) == 0) text += "_SetTask(T2_START, T3);\n";
    return text + body + "\n}\n";
  }

  std::string words() {
    return moves_ ? fmt::format("[[control.slave.change]]\nat = \"{}ms\"\npo = [6, {}, {}{}]\n",
                                pick(100, 3000), pick(-2000, 2000), pick(0, 9), further_words())
                  : std::string();
  }
  std::string further_words() const {
    std::string out;
    for (int n = 1; kind_ == Kind::Gateway && n < stations_; ++n) out += ", 6, 700, 1";
    return out;
  }

  void profibus() {
    text_ += "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 500000\n";
    std::string cfg = "F3 F2";
    if (kind_ == Kind::Gateway) {
      text_ +=
          "[[station]]\nname = \"gw\"\nunit = \"gateway\"\nprofibus = \"dp\"\nprofibus_address = 9\nsbus = "
          "\"can\"\n";
      for (int n = 1; n < stations_; ++n) cfg += " F2";
    }
    text_ += fmt::format(
        "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 9\ncfg = \"{}\"\n"
        "watchdog = \"{}ms\"\npo = [6, 1000, 0{}]\n",
        cfg, pick(2, 30) * 10, further_words());
    for (int n = pick(0, 5); n > 0; --n) text_ += words();
  }

  void canopen() {
    text_ += fmt::format(
        "[[control]]\nname = \"plc\"\nkind = \"canopen\"\nsbus = \"can\"\ncycle = "
        "\"{}ms\"\n[[control.target]]\n"
        "address = 5\npo = [6, {}]\n{}",
        pick(1, 5) * 10, pick(0, 5) * 1000,
        pick(0, 1) == 0 ? "guard = \"100ms\"\n" : "heartbeat = \"50ms\"\n");
  }

  void stimulus() {
    static constexpr const char* kWhat[] = {
        "input = \"DI04\"\npulse = 1\nfor = \"300ms\"\n",
        "input = \"DI01\"\nset = 1\n",
        "input = \"DI03\"\nset = 0\n",
        "input = \"DI05\"\npulse = 1\nfor = \"20ms\"\nevery = \"177ms\"\n",
        "variable = \"r1\"\nset = 77\n",
        "variable = \"n\"\nset = -5\n",
        "parameter = \"P130\"\nset = 400\n"};
    text_ += fmt::format("[[stimulus]]\nstation = \"u{}\"\nat = \"{}us\"\n{}", pick(0, stations_ - 1),
                         pick(0, 3'000'000), one_of(kWhat));
  }

  std::mt19937_64 random_;
  Kind kind_;
  bool receives_;  // the others do nothing but use the telegrams of the first station, as fast as they can
  bool circles_;   // and nothing else is done in the plant
  bool moves_;
  bool plain_;  // a loop in main, and nothing else
  int stations_ = 0;
  std::string text_;
  std::map<std::string, std::string> sources_;
};

}  // namespace ipos::tests

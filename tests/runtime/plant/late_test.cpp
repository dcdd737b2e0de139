// Late ticks: a plant whose stations execute them when they have something to tell is at every moment what
// one is that executes each in its turn, which is the expected value. Here most stations turn their shafts
// and have busy programs; sleep_test.cpp has those that wait.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/machine_code.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Plant;
using runtime::Station;
using runtime::Time;

constexpr const char* kHead = R"(
#include <constb.h>
#pragma globals 340 399
SCTRCYCL Tr; long d1; long d2;
SCREC Re; long r1; long r2;
MOVLNK Ml; MLDATA Mld; MLDATA Mlx; long t[9];
long a; long b; long c; long n; long m; long e1; long e2;
Step() { m = m * 3 + r2; }
)";

// What tasks do over and over; K and L are replaced by numbers.
constexpr int kCalm = 10;         // the first ones leave the unit alone
constexpr int kOfMovidriveB = 1;  // the last one
constexpr const char* kBodies[] = {
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

class LatePlant {
 public:
  explicit LatePlant(uint64_t seed) : random_(seed) {
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

  std::unique_ptr<Plant> make_in_turn() const { return make_plant(text_, sources_, std::nullopt, in_turn()); }
  // By any of the engines.
  std::unique_ptr<Plant> make() {
    runtime::Execution execution;
    execution.fast = pick(0, 5) != 0;
    if (pick(0, 1) == 0) execution.compiler = machine_code;
    return make_plant(text_, sources_, std::nullopt, execution);
  }
  const std::string& text() const { return text_; }
  int pick(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random_); }

 private:
  std::string body(bool b) {
    const int bodies = static_cast<int>(std::size(kBodies)) - (b ? 0 : kOfMovidriveB);
    const int calm = pick(0, 2) == 0 ? kCalm : bodies;
    const char* const text = kBodies[static_cast<size_t>(pick(0, calm - 1))];
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
        n, b ? "mdxb" : "md60a", serial_ && (asks || pick(0, 1) == 0) ? "rs485 = \"line\"\n" : "",
        b ? "P881" : "P813", n + 1, b ? "P884" : "P816", baud_ == 0 ? 0 : baud_ + 1, pick(-5, 5) * 200'200);
    if (pick(0, 1) == 0) text_ += "P841 = 1\n";
    if (pick(0, 3) == 0) text_ += "P700 = 13\n";
    if (b && pick(0, 3) == 0) text_ += fmt::format("P938 = {}\n", pick(0, 9));
    text_ += "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
    std::string source =
        fmt::format("{}T2() {{ while (1) {{ {} }} }}\nT3() {{ while (1) {{ {} }} }}\nmain() {{\n", kHead,
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

  std::mt19937_64 random_;
  int stations_ = 0;
  int baud_ = 0;
  int asks_ = -1;  // the others
  bool serial_ = false;
  std::string text_;
  std::map<std::string, std::string> sources_;
};

TEST(Late, RandomPlantsAreTheSameAsInTurn) {
  uint64_t late = 0, ahead = 0, looked = 0;
  for (uint64_t seed = 1; seed <= plant_count(120); ++seed) {
    LatePlant random(seed);
    auto all = random.make_in_turn(), some = random.make();
    ASSERT_TRUE(all && some) << random.text();
    Watched expected(std::move(all)), skipping(std::move(some));
    Time now = 0;
    while (now < 5 * runtime::kSecond) {
      now += random.pick(0, 3) == 0 ? random.pick(1, 5'000'000) : ms(random.pick(1, 400));
      expected.plant->run_until(now);
      skipping.plant->run_until(now);
      for (const auto& station : skipping.plant->stations()) {
        late += station->behind() ? 1 : 0;
        ahead += runs_ahead(*station) ? 1 : 0;
        ++looked;
      }
      if (random.pick(0, 2) == 0) continue;  // nobody looks
      ASSERT_NO_FATAL_FAILURE(
          expect_same(skipping, expected, fmt::format("seed {} at {}\n{}", seed, now, random.text())));
    }
  }
  EXPECT_GT(late * 5, looked) << "of " << looked << " looks at a station " << late << " found it late";
  EXPECT_GT(ahead * 20, looked) << "of " << looked << " looks at a station " << ahead
                                << " found it running ahead";
}

// Both are late when their programs fault; what is told of them stands in the order in which it happened.
TEST(Late, FaultsAreToldInTheirOrder) {
  const std::string units =
      "[[station]]\nname = \"second\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\n"
      "[[station]]\nname = \"first\"\nunit = \"mdxb\"\nprogram = \"B.IPC\"\n";
  const auto program = [](int turns) {
    return fmt::format("long n; long d; main() {{ while (1) {{ n = n + 1; d = 1 / ({} - n); }} }}", turns);
  };
  const auto plant = make_plant(units, {{"A.IPC", program(404)}, {"B.IPC", program(403)}});
  ASSERT_TRUE(plant);
  plant->run_until(ms(1500));
  for (const auto& station : plant->stations()) EXPECT_TRUE(station->behind());
  plant->run_until(ms(5000));
  std::vector<runtime::JournalEntry> entries;
  std::ranges::copy_if(plant->journal().entries(), std::back_inserter(entries),
                       [](const auto& entry) { return entry.text.starts_with("F10 in task 1"); });
  ASSERT_EQ(entries.size(), 2U);
  EXPECT_EQ(entries[0].station, "first");
  EXPECT_EQ(entries[1].station, "second");
  EXPECT_EQ(entries[1].time - entries[0].time, ms(6)) << "six commands a turn, one a millisecond";
  EXPECT_TRUE(plant->has_fault());
  for (const auto& station : plant->stations()) EXPECT_EQ(station->fault(), 10);
}

// Who looks finds all that has happened by then, whatever it looks at.
TEST(Late, WhoLooksSeesThePresent) {
  const auto plant = make_station("long n; main() { while (1) { n = n + 1; H481 = n >> 3; } }",
                                  "[station.parameters]\nP620 = 21\nP130 = 200\nP160 = 1000000\n"
                                  "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n");
  ASSERT_TRUE(plant);
  const runtime::Station& station = *plant->stations()[0];
  const auto late_at = [&](int64_t at) {
    plant->run_until(ms(at));
    return station.behind();
  };
  ASSERT_TRUE(late_at(2003));
  const uint64_t commands = station.machine()->task(1).commands;
  EXPECT_EQ(commands, 2004U) << "one a millisecond, from 0 ms on";
  ASSERT_TRUE(late_at(2010));
  const int32_t n = value(*plant, "n");
  EXPECT_EQ(station.read(11481), n >> 3);
  ASSERT_TRUE(late_at(2017));
  const int32_t position = station.shaft_position();
  EXPECT_EQ(position, station.drive().state().shaft_position());
  ASSERT_TRUE(late_at(2040));
  EXPECT_GT(station.shaft_position(), position);
  ASSERT_TRUE(late_at(2050));
  EXPECT_EQ(station.outputs() >> 1 & 1, station.variable(481) >> 1 & 1);
}

// The counting of minutes goes on as it does for who executes every tick.
TEST(Late, OperatingHoursAndEnergyAreExact) {
  const std::string source = "long n; main() { while (1) n = n + 1; }";
  const std::string unit =
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"P.IPC\"\n"
      "[station.parameters]\nP130 = 200\nP160 = 1000000\n[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n";
  const auto expected = make_plant(unit, {{"P.IPC", source}}, std::nullopt, in_turn());
  const auto plant = make_plant(unit, {{"P.IPC", source}});
  ASSERT_TRUE(expected && plant);
  const Station& station = *plant->stations()[0];
  const uint16_t hours = station.drive().parameters().table().find("015")->index;
  for (const int64_t at : {59'998, 60'000, 60'002, 119'999, 120'000, 130'000}) {
    expected->run_until(ms(at));
    plant->run_until(ms(at));
    EXPECT_TRUE(station.behind());
    ASSERT_EQ(picture(*plant), picture(*expected)) << at << " ms";
    EXPECT_EQ(station.read(hours), (at + 1) / 60'000);
  }
}

// A telegram to H530 requests an interrupt; where none is installed the next tick drops it.
TEST(Late, ARequestThatNobodyTakesIsDropped) {
  const auto plant = make_station("long n; main() { while (1) n = n + 1; }");
  ASSERT_TRUE(plant);
  plant->run_until(ms(1500));
  Station& station = *plant->stations()[0];
  ASSERT_TRUE(runs_ahead(station));
  ASSERT_TRUE(station.drive().parameters().execute(runtime::ParameterService::WriteVolatile, 11'530, 3));
  EXPECT_EQ(station.variable(530), 3);
  plant->run_until(ms(1520));
  EXPECT_EQ(station.variable(530), 0);
}

// It begins anew in the next tick, and so do its telegrams.
TEST(Late, AProgramMayOrderTheResetOfItsOwnFault) {
  const std::string text =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"U.IPC\"\nsbus = \"can\"\n"
      "[[station]]\nname = \"v\"\nunit = \"mdxb\"\nsbus = \"can\"\n[station.parameters]\nP881 = 2\n";
  int begun_anew = 0;
  for (int turns = 400; turns < 410;
       ++turns) {  // the fault is in the millisecond of the order, or in the next
    const std::map<std::string, std::string> sources = {
        {"U.IPC",
         fmt::format(
             "#include <constb.h>\nSCTRCYCL Tr; long d; long n; long z;\n"
             "T3() {{ while (1) {{ n = n + 1; H484 = 0; if (n > {}) {{ n = 0; H484 = 4096; n = 1 / z; "
             "}} }} }}\n"
             "main() {{ d = d + 1; Tr.ObjectNo = 1100; Tr.CycleTime = 20; Tr.Format = 4; Tr.DPointer "
             "= numof(d);\n"
             "_SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); _SetTask(T2_START, T3); while (1) ; }}",
             turns)}};
    Watched expected(make_plant(text, sources, std::nullopt, in_turn())), plant(make_plant(text, sources));
    for (int64_t n = 1; n <= 30; ++n) {
      expected.plant->run_until(ms(n * 50));
      plant.plant->run_until(ms(n * 50));
      ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected));
    }
    begun_anew += value(*plant.plant, "d") > 1 ? 1 : 0;
  }
  EXPECT_GT(begun_anew, 2);
  EXPECT_LT(begun_anew, 10);
}

// What waits for the bus when its program faults is not sent any more.
TEST(Late, AFaultTakesBackTheTelegramThatWaits) {
  std::string text = "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 125000\n";
  std::map<std::string, std::string> sources;
  constexpr int kStations = 7;  // a telegram takes a millisecond, all seven are due at once
  for (int n = 0; n < kStations; ++n)
    text += fmt::format(
        "[[station]]\nname = \"u{0}\"\nunit = \"mdxb\"\nprogram = \"P{0}.IPC\"\nsbus = \"can\"\n"
        "[station.parameters]\nP881 = {1}\nP884 = 0\n",
        n, n + 1);
  for (int turns = 200; turns < 220; ++turns) {
    for (int n = 0; n < kStations; ++n)
      sources[fmt::format("P{}.IPC", n)] = fmt::format(
          "#include <constb.h>\nSCTRCYCL Tr; long n; long d;\n"
          "main() {{ Tr.ObjectNo = {}; Tr.CycleTime = 20; Tr.Format = 8; Tr.DPointer = numof(n);\n"
          "_SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); while (1) {{ n = n + 1; d = 1 / ({} - n); }} }}",
          1100 + n, n + 1 < kStations ? 100'000 : turns);
    Watched expected(make_plant(text, sources, std::nullopt, in_turn())), plant(make_plant(text, sources));
    for (int64_t n = 1; n <= 25; ++n) {
      expected.plant->run_until(ms(n * 100));
      plant.plant->run_until(ms(n * 100));
    }
    EXPECT_EQ(plant.plant->stations()[kStations - 1]->fault(), 10);
    ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected, std::to_string(turns)));
  }
}

constexpr const char* kSenderAndReceiver =
    "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
    "[[station]]\nname = \"sends\"\nunit = \"mdxb\"\nprogram = \"S.IPC\"\nsbus = \"can\"\n"
    "[[station]]\nname = \"hears\"\nunit = \"mdxb\"\nprogram = \"R.IPC\"\nsbus = \"can\"\n"
    "[station.parameters]\nP881 = 2\n";
constexpr const char* kSender =
    "#include <constb.h>\nSCTRCYCL Tr; long d; main() { Tr.ObjectNo = 1100; Tr.CycleTime = 3;\n"
    "Tr.Format = 4; Tr.DPointer = numof(d); _SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); while (1) d++; }";

std::string receiver(const std::string& body, int format) {
  return fmt::format(
      "#include <constb.h>\nSCREC Re; long r; long r2; long n; long z; main() {{ Re.ObjectNo = 1100; "
      "Re.Format = {};\n"
      "Re.DPointer = numof(r); _SBusCommDef(SCD_REC, Re); _SBusCommOn(); while (1) {{ {} }} }}",
      format, body);
}

// A program that has faulted receives nothing any more, also while nobody has noticed.
TEST(Late, AFaultEndsReceiving) {
  for (int turns = 300; turns < 312; ++turns) {
    const std::map<std::string, std::string> sources = {
        {"S.IPC", kSender}, {"R.IPC", receiver(fmt::format("n = n + 1; z = 1 / ({} - n);", turns), 4)}};
    const auto expected = make_plant(kSenderAndReceiver, sources, std::nullopt, in_turn()),
               plant = make_plant(kSenderAndReceiver, sources);
    expected->run_until(ms(2500));
    plant->run_until(ms(1000));
    EXPECT_TRUE(plant->stations()[1]->behind());
    plant->run_until(ms(2500));
    EXPECT_EQ(plant->stations()[1]->fault(), 10);
    ASSERT_EQ(picture(*plant), picture(*expected)) << turns;
  }
}

TEST(Late, ATelegramOfAnotherLengthIsToldOf) {
  const std::map<std::string, std::string> sources = {{"S.IPC", kSender},
                                                      {"R.IPC", receiver("n = n + 1 + r;", 8)}};
  const auto plant = make_plant(kSenderAndReceiver, sources);
  ASSERT_TRUE(plant);
  plant->run_until(ms(1500));
  EXPECT_TRUE(plant->stations()[1]->behind());
  EXPECT_TRUE(told(*plant, "object 1100 came with 4 bytes, its receive object has 8"));
  EXPECT_EQ(value(*plant, "r", "hears"), 0);
}

// The words another unit gets over RS-485 are those of the moment.
TEST(Late, ProcessDataOverRs485AreOfNow) {
  const std::string text =
      "[[bus]]\nname = \"line\"\nkind = \"rs485\"\n"
      "[[station]]\nname = \"turns\"\nunit = \"mdxb\"\nprogram = \"T.IPC\"\nrs485 = \"line\"\n"
      "[station.parameters]\nP810 = 1\nP130 = 200\nP160 = 1000000\nP873 = 10\nP874 = 9\n"
      "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n"
      "[[station]]\nname = \"asks\"\nunit = \"mdxb\"\nprogram = \"A.IPC\"\nrs485 = \"line\"\n"
      "[station.parameters]\nP810 = 2\n";
  const std::map<std::string, std::string> sources = {
      {"T.IPC", "long n; main() { while (1) n = n + 1; }"},
      {"A.IPC",
       "#include <constb.h>\nMOVLNK Ml; MLDATA Mld; long sum; main() { Ml.BusType = 2; Ml.Address = 1;\n"
       "Ml.Format = 1; Ml.Service = ML_S_RD; Ml.Index = 8318; Ml.DPointer = numof(Mld);\n"
       "while (1) { _MoviLink(Ml); sum = sum * 3 + Mld.PI2 + Mld.PI3; _Wait(37); } }"}};
  Watched expected(make_plant(text, sources, std::nullopt, in_turn())), plant(make_plant(text, sources));
  for (int64_t n = 1; n <= 20; ++n) {
    expected.plant->run_until(ms(n * 150));
    plant.plant->run_until(ms(n * 150));
    EXPECT_FALSE(plant.plant->stations()[0]->behind()) << "who is on a serial line";
    ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected));
  }
}

}  // namespace
}  // namespace ipos::tests

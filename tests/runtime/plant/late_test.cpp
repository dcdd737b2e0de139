// Late ticks: a plant whose stations execute them when they have something to tell is at every moment what
// one is that executes each in its turn, which is the expected value. Here most stations turn their shafts
// and have busy programs; sleep_test.cpp has those that wait.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "tests/harness/proves.hpp"
#include "tests/runtime/plant/busy_plant.hpp"
#include "tests/runtime/plant/machine_code.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Plant;
using runtime::Station;
using runtime::Time;

// By any of the engines.
std::unique_ptr<Plant> make_lazy(BusyPlant& random) {
  runtime::Execution execution;
  execution.fast = random.pick(0, 5) != 0;
  if (random.pick(0, 1) == 0) execution.compiler = machine_code;
  return make_plant(random.text(), random.sources(), std::nullopt, execution);
}

TEST(Late, RandomPlantsAreTheSameAsInTurn) {
  uint64_t late = 0, ahead = 0, looked = 0;
  for (uint64_t seed = first_plant(); seed <= plant_count(120); ++seed) {
    BusyPlant random(seed);
    auto all = make_plant(random.text(), random.sources(), std::nullopt, in_turn()), some = make_lazy(random);
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

// Its ticks, and the telegrams that go out with them, stay between whole milliseconds, as those of a real unit do.
TEST(Late, AUnitMayBeSwitchedOnBetweenTwoMilliseconds) {
  const std::string text =
      "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 500000\n"
      "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"U.IPC\"\nsbus = \"can\"\n"
      "[[station]]\nname = \"v\"\nunit = \"mdxb\"\nsbus = \"can\"\n[station.parameters]\nP881 = 2\n";
  const std::map<std::string, std::string> sources = {
      {"U.IPC",
       "#include <constb.h>\nSCTRCYCL Tr; long n; main() { Tr.ObjectNo = 1100; Tr.CycleTime = 10; Tr.Format "
       "= 4;\n"
       "Tr.DPointer = numof(n); _SBusCommDef(SCD_TRCYCL, Tr); _SBusCommOn(); while (1) n = n + 1; }"}};
  Watched expected(make_plant(text, sources, std::nullopt, in_turn())), plant(make_plant(text, sources));
  for (const Watched* run : {&expected, &plant}) {
    run->plant->run_until(ms(1000));
    run->plant->stations()[0]->power_off();
    run->plant->run_until(ms(1000) + 300'000);
    run->plant->stations()[0]->power_on();
  }
  uint64_t late = 0;
  for (Time now = ms(1500); now < ms(2500); now += 1'700'000) {
    expected.plant->run_until(now);
    plant.plant->run_until(now);
    late += plant.plant->stations()[0]->behind() ? 1 : 0;
    const uint64_t ticks = static_cast<uint64_t>((now - ms(1000) - 300'000) / runtime::kMillisecond) + 1;
    ASSERT_EQ(plant.plant->stations()[0]->machine()->task(1).commands, ticks)
        << now << ": one command a tick";
    ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected, std::to_string(now)));
  }
  EXPECT_GT(late, 0U);
}

// A master that says the same again and again calls nobody to its turn. The answer has the values of its moment, and where a
// tick falls on that moment, those after the tick: at 125 kbaud many requests end 800 us after a millisecond, and the answer
// comes 200 us later. PI3 is the position of a shaft that turns, so an answer shows which millisecond it knows.
TEST(Late, AnswersToWordsThatBringNothingNewAreOfTheirMillisecond) {
  struct Starts final : runtime::CanObserver {
    void on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) override {
      if (record.frame.id == kAnswer) on_tick += record.start % runtime::kMillisecond == 0 ? 1 : 0;
    }
    void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
    const uint32_t kAnswer = 8 * 1 + 4;  // of address 1 to process output data
    int on_tick = 0;
  };
  int on_tick = 0, late = 0;
  for (int speed = 500; speed < 7500; speed += 211) {
    const std::string text = fmt::format(
        "[[bus]]\nname = \"can\"\nkind = \"can\"\nbaud = 125000\n"
        "[[station]]\nname = \"u\"\nunit = \"mdxb\"\nprogram = \"U.IPC\"\nsbus = \"can\"\n"
        "[station.parameters]\nP881 = 1\nP884 = 0\nP100 = 10\nP101 = 3\nP130 = 100\nP883 = '100 ms'\nP875 = 4\n"
        "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\n"
        "[[control]]\nname = \"plc\"\nsbus = \"can\"\n[[control.target]]\naddress = 1\npo = [6, {}]\nevery = \"{}ms\"\n",
        speed, 3 + speed % 7);
    const std::map<std::string, std::string> sources = {{"U.IPC", "long n; main() { while (1) n = n + 1; }"}};
    Watched expected(make_plant(text, sources, std::nullopt, in_turn())), plant(make_plant(text, sources));
    Starts starts;
    plant.plant->add_observer(starts);
    for (Time now = ms(100); now <= ms(1500); now += ms(100)) {
      plant.plant->run_until(now + 3'700'000);
      late += plant.plant->stations()[0]->behind() ? 1 : 0;
    }
    expected.plant->run_until(ms(1600));
    plant.plant->run_until(ms(1600));
    ASSERT_NO_FATAL_FAILURE(expect_same(plant, expected, text));
    on_tick += starts.on_tick;
  }
  EXPECT_GT(on_tick, 100);
  EXPECT_GT(late, 300) << "of 510";
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
  EXPECT_TRUE(told(*plant, "object 44Ch (1100) came with 4 bytes, its receive object has 8"));
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

// A line of RS-485 that the plant file describes as bad, and planted faults of it, in a plant. What a receiver at another rate or
// with interchanged wires makes of a telegram is calculated here by hand from its bits (8E1, 1053 1610 p. 26).
#include <algorithm>

#include "runtime/plant_file/serial_plan.hpp"
#include "tests/runtime/bus/rs485/serial_plant_rig.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

// PO1 of address 1 is asked for: 02 01 81 00 00 82.
const std::string kRequest = "02 01 81 00 00";
const std::string kUnit = station("a", "mdxb", "rs485 = \"l\"\n", "P810 = 1\n");

std::string fault(const std::string& kind, const std::string& more = "") {
  return "[[fault]]\nbus = \"l\"\nkind = \"" + kind + "\"\n" + more;
}

size_t times_told(const PlantRun& run, const std::string& words) {
  size_t count = 0;
  for (const JournalEntry& entry : run.plant->journal().entries()) count += entry.text.find(words) != std::string::npos;
  return count;
}

// Good ones to a request.
size_t answers(PlantRun& run) {
  run.ask(0, kRequest);
  const auto& heard = run.recorders[0]->heard;
  return static_cast<size_t>(std::count_if(heard.begin(), heard.end(), [](const Heard& each) {
    return each.reception.telegram && each.reception.telegram->response;
  }));
}

// What the unit has counted, as its journal says at the end.
std::string errors_of(PlantRun& run) {
  run.station(0).store_memory();
  const std::string begin = "RS-485 X13: errors so far: ";
  std::string last;
  for (const JournalEntry& entry : run.plant->journal().entries())
    if (const size_t at = entry.text.find(begin); at != std::string::npos) last = entry.text.substr(at + begin.size());
  return last;
}

std::string errors_after(const std::string& text, int requests) {
  PlantRun run(text);
  for (int n = 0; n < requests; ++n) EXPECT_TRUE(run.ask(0, kRequest).empty()) << text;
  return errors_of(run);
}

// 02h at 9600 baud, in ticks of 57.6 kbaud: start bit and d0 are 0 for 12 ticks. A receiver at 57.6 kbaud has read its eleven bits by
// then: data 00h, parity 0 as it must be, and a stop bit 0. What follows without a pause belongs to the same bad telegram.
TEST(DisturbedLine, AFastStationOnASlowLine) {
  PROVES("RS485-21");
  const std::string planted = bus("l") + kUnit + fault("baud", "station = \"a\"\n");
  EXPECT_EQ(errors_after(planted, 3), "character frame error 3");
}

// 02 01 81 00 00 82 at 57.6 kbaud, read at 9600 baud: a bit is six ticks, taken in its middle at tick 3 + 6 n.
//   character  02h 0-10: 00100000011   01h 11-21: 01000000011   81h 22-32: 01000000101
//              00h 33-43, 44-54: 00000000001   82h 55-65: 00100000101
// Tick 3 is 0, a start bit. 9: 1, 15: 0, 21: 1, 27, 33, 39, 45, 51: 0 are 05h with two ones; 57, the parity bit, is 1 and wrong; 63,
// the stop bit, is 1.
TEST(DisturbedLine, ASlowStationOnAFastLine) {
  EXPECT_EQ(errors_after(bus("l", "baud = 57600\n") + kUnit, 4), "parity error 4");
}

// 02h with A and B interchanged is 11011111100 after a rest of 0: the first fall is before d1. From there 111111 00 are the
// data 3Fh with six ones, behind them the start bit of 01h, turned into 1, is a wrong parity bit, and its d0, turned into 0, no stop bit.
TEST(DisturbedLine, InterchangedWires) {
  EXPECT_EQ(errors_after(bus("l") + kUnit + fault("swap", "station = \"a\"\n"), 2), "character frame error 2");
  PlantRun run(bus("l") + kUnit + fault("swap", "station = \"a\"\nfrom = \"1s\"\nuntil = \"2s\"\n"));
  EXPECT_EQ(run.ask(0, kRequest).size(), 1U);
  run.run(kSecond);
  EXPECT_TRUE(run.ask(0, kRequest).empty());
  run.run(kSecond);
  EXPECT_EQ(run.ask(0, kRequest).size(), 1U);
  EXPECT_EQ(times_told(run, "l: a has A and B interchanged"), 1U);
}

// A rate that is wrong for a while, on a switch that is as it was.
TEST(DisturbedLine, AnotherRateForAWhile) {
  PlantRun run(bus("l", "baud = 57600\n") + station("a", "mdxb", "rs485_xt = \"l\"\n", "P810 = 1\n") +
               fault("baud", "station = \"a\"\nfrom = \"1s\"\nuntil = \"2s\"\n"));
  EXPECT_EQ(run.ask(0, kRequest).size(), 1U);
  run.run(kSecond);
  EXPECT_TRUE(run.ask(0, kRequest).empty());
  EXPECT_EQ(std::as_const(run.station(0)).switch_value(StationSwitch::S13), 0);
  run.run(kSecond);
  EXPECT_EQ(run.ask(0, kRequest).size(), 1U);
  EXPECT_EQ(times_told(run, "l: a has another baud rate"), 1U);
}

// A sender at another rate extinguishes what others say at the same time. Two units answer one address; b is there at
// the wrong rate, and hears nothing, so it disturbs nobody: only what it sends would.
TEST(DisturbedLine, WhoUnderstandsNothingDisturbsNobody) {
  for (const std::string kind : {"baud", "swap"}) {
    PlantRun run(bus("l") + kUnit + station("b", "mdxb", "rs485 = \"l\"\n", "P810 = 1\n") + fault(kind, "station = \"b\"\n"));
    EXPECT_EQ(run.ask(0, kRequest).size(), 1U) << kind;
    EXPECT_FALSE(run.told("collides")) << kind;
  }
}

// A master of setpoints with interchanged wires: nobody understands it, and its telegrams fall into the requests of another one.
TEST(DisturbedLine, AMasterThatNobodyUnderstandsDisturbsOthers) {
  const std::string master = station("m", "mdxb", "rs485 = \"l\"\n", "P810 = 2\nP811 = 101\nP750 = 1\n");
  const auto answered = [&](const std::string& more) {
    PlantRun run(bus("l") + kUnit + master + more);
    size_t count = 0;
    for (int n = 0; n < 40; ++n) {
      run.recorders[0]->clear();
      run.hands[0]->send(telegram(kRequest));
      run.run((60 + n) * kMillisecond);
      for (const std::string& heard : run.recorders[0]->all()) count += heard.rfind("1D 01 81", 0) == 0;
    }
    return count;
  };
  EXPECT_EQ(answered(fault("lost", "station = \"m\"\n")), 40U) << "nobody hears it";
  for (const std::string kind : {"swap", "baud"}) EXPECT_LT(answered(fault(kind, "station = \"m\"\n")), 40U) << kind;
}

TEST(DisturbedLine, TooLong) {
  PROVES("RS485-24");
  PlantRun good(bus("l", "length = 200\n") + kUnit);
  EXPECT_EQ(good.ask(0, kRequest).size(), 1U);
  EXPECT_FALSE(good.told("m of cable") || good.told("are disturbed"));
  PlantRun one(bus("l", "length = 201\n") + kUnit);
  EXPECT_EQ(times_told(one, "l: 201 m of cable, a RS-485 line may have 200 m"), 1U);
  EXPECT_EQ(times_told(one, "l: the line is longer than 200 m: 5 of 1000 telegrams are disturbed"), 1U);
  PlantRun dead(bus("l", "length = 400\n") + kUnit);
  for (int n = 0; n < 10; ++n) dead.ask(0, kRequest);
  EXPECT_EQ(times_told(dead, "l: the line is longer than 200 m: 1000 of 1000 telegrams are disturbed"), 1U);
  EXPECT_EQ(times_told(dead, "sends a telegram that a fault of the line strikes: the line disturbs a frame: it is too long"), 1U)
      << "once, and the hand alone: nothing of it is answered";
}

// Half of the requests arrive, and half of their answers: a quarter. The limits are five times the root of n p (1 - p).
TEST(DisturbedLine, ResistorsBesideThoseOfTheUnits) {
  PlantRun run(bus("l", "terminated = true\n") + kUnit);
  EXPECT_EQ(times_told(run, "l: the units have terminating resistors; connect no others"), 1U);
  EXPECT_EQ(times_told(run, "l: there are terminating resistors beside those of the units: 500 of 1000 telegrams are disturbed"), 1U);
  constexpr int kRequests = 200;
  size_t good = 0;
  for (int n = 0; n < kRequests; ++n) good += answers(run);
  EXPECT_NEAR(static_cast<double>(good), kRequests / 4, 31);
}

// RS-232 has neither A and B nor resistors of the line.
TEST(DisturbedLine, KindsOfEachLine) {
  const auto words = [](const std::string& kind) {
    std::string text;
    const PlantRun run("[[bus]]\nname = \"l\"\nkind = \"" + kind + "\"\n" + kUnit);
    for (const FaultRule& rule : run.plant->find_bus("l")->fault_rules()) text += std::string(rule.word) + " ";
    return text;
  };
  EXPECT_EQ(words("rs485"), "lost cut parity noise collision swap terminator length baud ");
  EXPECT_EQ(words("rs232"), "lost cut parity noise collision length baud ");
}

// Each telegram of one station, of all, or the n-th.
TEST(DisturbedLine, WhichTelegramsAreStruck) {
  PlantRun second(bus("l") + kUnit + fault("lost", "frame = 2\n"));
  EXPECT_TRUE(second.ask(0, kRequest).empty()) << "the answer is the second telegram";
  EXPECT_EQ(second.ask(0, kRequest).size(), 1U);
  for (const std::string kind : {"lost", "cut", "parity", "noise", "collision", "terminator", "length"}) {
    PlantRun run(bus("l") + kUnit + fault(kind, "station = \"a\"\n"));
    for (int n = 0; n < 5; ++n) EXPECT_EQ(answers(run), 0U) << kind << " " << n;
    EXPECT_EQ(times_told(run, "l: a sends a telegram that a fault of the line strikes"), 1U) << kind;
    const FaultConfig planted = run.plant->file().faults.at(0);
    EXPECT_TRUE(run.plant->repair_fault(planted));
    EXPECT_FALSE(run.plant->repair_fault(planted));
    EXPECT_EQ(answers(run), 1U) << kind;
  }
  PlantRun nowhere(bus("l") + kUnit + station("c", "mdxb", "") + fault("swap", "station = \"c\"\n"));
  EXPECT_TRUE(nowhere.told("the fault planted on bus 'l' has no effect: the station is not on it"));
}

// Each kind once, and each is counted once: an octet of the example, a pause within it, a fault of the line. The setpoint of a master
// that falls silent is missed after 500 ms.
TEST(DisturbedLine, EightCounters) {
  PROVES("MDB-RS485-31");
  PlantRun run(bus("l") + station("a", "mdxb", "rs485 = \"l\"\n", "P810 = 1\nP811 = 101\nP100 = 9\n") + fault("parity", "frame = 1\n") +
               fault("baud", "station = \"a\"\nfrom = \"1s\"\nuntil = \"1.5s\"\n"));
  const std::string example = "02 01 05 00 06 3A 98 01 F4";
  EXPECT_TRUE(run.ask(0, example).empty());  // its parity bit
  run.plant->run_until(1100 * kMillisecond);
  EXPECT_TRUE(run.ask(0, example).empty());  // no stop bit at the other rate
  run.plant->run_until(2 * kSecond);
  const Bytes bytes = telegram(example);
  run.hands[0]->send({bytes.begin(), bytes.begin() + 5});
  run.run(wire_time(5, 9600) + 5 * kMillisecond);
  run.hands[0]->send({bytes.begin() + 5, bytes.end()});
  run.run(100 * kMillisecond);
  EXPECT_TRUE(run.ask(0, "02 02 05 00 06 3A 98 01 F4").empty());
  EXPECT_TRUE(run.ask(0, "02 01 07 00 06 3A 98 01 F4").empty());
  Bytes wrong = bytes;
  wrong.back() ^= 3;
  run.hands[0]->send(wrong);
  run.run(100 * kMillisecond);
  EXPECT_TRUE(run.ask(0, "02 65 05 00 06 07 D0 00 00").empty());
  run.run(kSecond);
  EXPECT_EQ(errors_of(run),
            "parity error 1, character frame error 1, character delay exceeded 1, address incorrect 1, PDU type incorrect 1, BCC "
            "incorrect 1, RS-485 timeout 1");
  // The eighth is of a master: nobody answers its MOVLNK of an acyclic format, which it sends twice.
  const auto master = make_plant(bus("l") + "[[station]]\nname = \"m\"\nunit = \"mdxb\"\nrs485 = \"l\"\nprogram = \"P.IPC\"\n",
                                 {{"P.IPC",
                                   "#include <constb.h>\nMOVLNK Ml; MLDATA Mld;\nmain() { Ml.BusType = 2; Ml.Address = 1; Ml.Format = 134;"
                                   " Ml.Service = 1; Ml.Index = 8318; Ml.DPointer = numof(Mld); _MoviLink(Ml); while (1) {} }\n"}});
  ASSERT_NE(master, nullptr);
  master->run_until(kSecond);
  EXPECT_TRUE(master->store_memories());
  EXPECT_TRUE(told(*master, "errors so far: response delay time elapsed 2"));
}

}  // namespace
}  // namespace ipos::tests

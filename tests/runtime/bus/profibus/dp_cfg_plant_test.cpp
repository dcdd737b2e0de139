// Configurations of a MOVITRAC 31 as a master meets them in a plant: identifiers, the six of the table, what is refused, the order of
// the start (MOVITRAC 31 PROFIBUS, 3.1 and chapter 7). Sums and texts are made here, from the bit fields that 3.1.1 prints.
#include <map>
#include <set>

#include "tests/runtime/bus/profibus/hand_rig.hpp"

namespace ipos::tests {
namespace {

// Nothing is preset at the unit: no parameter of the bus.
std::string bare_station(const std::string& keys = "") {
  return "[[station]]\nname = \"inv\"\nunit = \"mc31\"\noption = \"ffp31\"\nprofibus = \"dp\"\nprofibus_address = 8\n" + keys;
}
HandPlant fast() { return HandPlant(dp_line(1'500'000) + bare_station()); }

const std::string kCfgFault = "06 05 00 FF 31 00";  // Cfg_Fault, Station_Not_Ready; Prm_Req

std::string in_words(int identifier) {
  const int count = (identifier & 15) + 1;
  const char* ways[] = {"", "inputs", "outputs", "inputs and outputs"};
  return std::string(ways[identifier >> 4 & 3]) + " of " + std::to_string(count) + ((identifier & 0x40) != 0 ? " word" : " octet") +
         (count > 1 ? "s" : "") + ((identifier & 0x80) != 0 ? ", consistent as a whole" : "");
}

TEST(DpCfg, IdentifiersInWords) {
  PROVES("DP-CFG-01");
  EXPECT_EQ(in_words(0xF2), "inputs and outputs of 3 words, consistent as a whole");
  EXPECT_EQ(in_words(0x31), "inputs and outputs of 2 octets");
  HandPlant bench = fast();
  for (int identifier = 0; identifier < 256; ++identifier) {
    if ((identifier & 0x30) == 0) continue;  // the special format
    bench.ask(1, 62, text_of(Octets{static_cast<uint8_t>(identifier)}));
    EXPECT_TRUE(bench.meaning.ends_with(" (" + in_words(identifier) + ")")) << bench.meaning;
  }
}

// How many octets the unit exchanges in each direction after Chk_Cfg; 0: Cfg_Fault.
int octets_taken(HandPlant& bench, const std::string& cfg) {
  bench.start(cfg, prm_data(kNoWatchdog));
  const std::string outputs = bench.outputs();
  if (outputs != "RS") return static_cast<int>(bench.inputs().size() == outputs.size() ? hex(outputs).size() : 0);
  EXPECT_EQ(bench.diag(), kCfgFault) << cfg;
  return 0;
}

TEST(DpCfg, AllOfOneAndTwoIdentifiers) {
  PROVES("DP-CFG-02");
  HandPlant bench = fast();
  const auto octets_of = [](int identifier) { return ((identifier & 15) + 1) * ((identifier & 0x40) != 0 ? 2 : 1); };
  const std::set<int> printed{2, 4, 6, 10, 12, 14};
  std::set<int> met;
  const auto check = [&](const Octets& cfg) {
    int inputs = 0, outputs = 0;
    for (const uint8_t identifier : cfg) {
      if ((identifier & 0x10) != 0) inputs += octets_of(identifier);
      if ((identifier & 0x20) != 0) outputs += octets_of(identifier);
    }
    const int expected = inputs == outputs && printed.contains(inputs) ? inputs : 0;
    ASSERT_EQ(octets_taken(bench, text_of(cfg)), expected) << text_of(cfg);
    if (expected != 0) met.insert(expected);
  };
  const auto is_plain = [](int identifier) { return (identifier & 0x30) != 0; };
  for (int first = 0; first < 256; ++first) {
    if (!is_plain(first)) continue;
    check({static_cast<uint8_t>(first)});
    for (int second = 0; second < 256; ++second)
      if (is_plain(second)) check({static_cast<uint8_t>(first), static_cast<uint8_t>(second)});
  }
  EXPECT_EQ(met, printed) << "six, and no others";
  // The special format, with sums of the table and others: a length octet for each direction.
  for (const auto& [cfg, octets] : {std::pair("C0 01 01", 2), {"C0 C0 C0", 2}, {"C0 02 02", 0}, {"C0 C6 C6", 14}, {"C0 05 03", 0}})
    EXPECT_EQ(octets_taken(bench, cfg), octets) << cfg;
}

TEST(DpCfg, LengthsAndWhatTheyMean) {
  PROVES("DP-CFG-03", "DP-CFG-15");
  HandPlant bench(dp_line() + mc31_station());
  struct Printed {
    int octets, words;
    bool channel;
  };
  const Printed kTable[] = {{2, 1, false}, {4, 2, false}, {6, 3, false}, {10, 1, true}, {12, 2, true}, {14, 3, true}};
  std::set<int> accepted;
  for (int octets = 0; octets <= 16; ++octets) {  // octets in both directions
    const std::string cfg = octets == 0 ? "" : text_of(Octets{static_cast<uint8_t>(0x30 | (octets - 1))});
    if (octets_taken(bench, cfg) != 0) accepted.insert(octets);
  }
  EXPECT_EQ(accepted, (std::set<int>{2, 4, 6, 10, 12, 14}));
  for (const char* longer : {"F3 F3", "F3 F4", "F3 F3 F3 F2", "7F 7E"}) EXPECT_EQ(octets_taken(bench, longer), 0) << longer;
  EXPECT_EQ(*accepted.rbegin(), 14) << "the longest";
  for (const Printed& row : kTable) {
    bench.start(text_of(Octets{static_cast<uint8_t>(0x30 | (row.octets - 1))}));
    const std::string words = std::string("00 06 05 DC 00 00").substr(0, static_cast<size_t>(6 * row.words - 1));
    const std::string sent = (row.channel ? "71 00 04 01 00 00 00 00 " : "") + words;
    std::string answer;
    for (int n = 0; n < 60; ++n) answer = bench.exchange(sent);
    ASSERT_EQ(hex(answer).size(), 1U + static_cast<size_t>(row.octets)) << row.octets;
    if (row.channel) {
      EXPECT_EQ(answer.substr(3, 23), "71 00 04 01 00 00 01 00") << "1.00 s, P120";
    }
    EXPECT_EQ(bench.outputs(), sent);
    bench.run_on(2 * kSecond);
    EXPECT_EQ(bench.speed(), 0) << "the watchdog of 200 ms";
    bench.plant->set_power("inv", false);
    bench.run_on(kMillisecond);
    bench.plant->set_power("inv", true);
    bench.settle();
  }
}

TEST(DpCfg, OnlyTheTotalsDecide) {
  PROVES("DP-CFG-05");
  HandPlant bench(dp_line() + mc31_station());
  for (const char* cfg : {"B1", "70", "F0", "31", "30 30"}) {
    bench.start(cfg);
    EXPECT_EQ(hex(bench.exchange("00 06")).size(), 1U + 2) << cfg;
    EXPECT_EQ(bench.outputs(), "00 06");
    bench.run_on(50 * kMillisecond);
    EXPECT_TRUE(bench.station().drive().state().axis().output_stage) << "6 is enable: it is control word 1";
  }
  for (const char* cfg : {"F5", "F3 F1", "BB", "75"}) {
    bench.start(cfg);
    EXPECT_EQ(bench.service("41 00 04 01 00 00 00 00", "00 06 05 DC"), "41 00 04 01 00 00 01 00") << cfg;
    EXPECT_EQ(bench.outputs().substr(24), "00 06 05 DC");
    bench.service("00 00 04 01 00 00 00 00", "00 06 05 DC");
  }
}

TEST(DpCfg, RefusedOnes) {
  PROVES("DP-CFG-04", "DP-CFG-09", "DP-DIAG-10");
  HandPlant bench(dp_line() + mc31_station());
  // D2 and E1: six octets in, four out. F3: the channel alone.
  for (const char* cfg : {"D2 E1", "E2 D1", "F3", "30", "D0", "E0", ""}) {
    bench.start(cfg);
    EXPECT_EQ(bench.diag(), kCfgFault) << cfg;
    EXPECT_EQ(bench.exchange("00 06 05 DC"), "RS") << "no data exchange";
    EXPECT_TRUE(bench.told("refuses Chk_Cfg: not one of its configurations (Cfg_Fault)"));
    EXPECT_EQ(bench.speed(), 0);
    bench.start("F0");
    EXPECT_EQ(bench.diag(), "00 0C 00 01 31 00") << "the next one is good";
  }
}

TEST(DpCfg, SixConfigurationsExchange) {
  PROVES("DP-CFG-06", "DP-CFG-07");
  const std::map<std::string, size_t> kPrinted{{"F0", 2}, {"F1", 4}, {"F2", 6}, {"F3 F0", 10}, {"F3 F1", 12}, {"F3 F2", 14}};
  HandPlant bench(dp_line() + mc31_station());
  for (const auto& [cfg, octets] : kPrinted) {
    bench.start(cfg);
    Octets outputs(octets, 0);
    if (octets > 8) std::copy_n(hex("01 00 04 01").begin(), 4, outputs.begin());  // no service: the bit is as before
    EXPECT_EQ(hex(bench.exchange(text_of(outputs))).size(), 1 + octets) << cfg;
    EXPECT_EQ(bench.outputs(), text_of(outputs));
    if (octets > 8) {
      const std::string rest = text_of(std::span(outputs).subspan(8));
      EXPECT_EQ(bench.service("41 00 04 01 00 00 00 00", rest), "41 00 04 01 00 00 01 00") << "octets 1 to 8";
      bench.service("00 00 00 00 00 00 00 00", rest);
    }
    for (const size_t other : {octets - 1, octets + 1, octets + 2, size_t{1}, size_t{200}}) {
      EXPECT_EQ(bench.exchange(text_of(Octets(other, 0))), "RS") << cfg << ' ' << other;
      EXPECT_EQ(bench.diag(), kCfgFault);
      bench.start(cfg);
    }
  }
}

TEST(DpCfg, TheChannelComesFirst) {
  PROVES("DP-CFG-08");
  HandPlant bench(dp_line() + mc31_station());
  bench.start("F3 F2", prm_data(kNoWatchdog));
  bench.shown("dp.8.PI2");  // from now on it is looked at
  // P120 = 9.50 s; enable, 7500 digits of 0.2 rpm, ramp of 1 s for 50 Hz, which are 1500 rpm of the four-pole motor.
  const std::string sent = "72 00 04 01 00 00 09 50 00 06 1D 4C 03 E8";
  Time began = 0;
  for (int n = 0; n < 2000 && (began == 0 || bench.plant->now() < began + 500 * kMillisecond); ++n) {
    bench.exchange(sent);
    if (began == 0 && bench.speed() != 0) began = bench.plant->now();
  }
  EXPECT_NEAR(bench.speed(), 750'000, 6'000) << "PO3: half of the speed in half of the ramp";
  EXPECT_EQ(bench.value("120"), 950) << "octets 1 to 8 are the parameter channel";
  EXPECT_EQ(bench.outputs(), sent);
  bench.run_on(2 * kSecond);
  EXPECT_EQ(bench.speed(), 1'500'000) << "PO2";
  EXPECT_EQ(bench.exchange(sent).substr(3, 23), "72 00 04 01 00 00 09 50");
  EXPECT_EQ(bench.inputs().substr(24, 11), "04 07 1D 4C") << "octets 9 to 12";
  EXPECT_EQ(bench.shown("inv.PI2"), bench.shown("dp.8.PI2"));
}

TEST(DpCfg, NothingBeforeChkCfg) {
  PROVES("DP-CFG-10", "DP-CFG-12", "DP-DIAG-11", "DP-DIAG-18", "DP-DIAG-20");
  HandPlant bench(dp_line() + mc31_station());
  const std::string data = "00 06 05 DC 00 00";
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00") << "not ready, wants parameters, no master";
  EXPECT_EQ(bench.exchange(data), "RS");
  EXPECT_EQ(bench.ask(1, 62, "F2"), "E5") << "a wrong step: Chk_Cfg before Set_Prm";
  EXPECT_EQ(bench.diag(), "02 05 00 FF 31 00") << "Prm_Req stays";
  EXPECT_TRUE(bench.told("ignores Chk_Cfg: it is not parameterised"));
  EXPECT_EQ(bench.ask(2, 61, prm_data()), "E5");
  EXPECT_EQ(bench.diag(2), "02 0C 00 02 31 00") << "parameterised by master 2, not yet configured";
  EXPECT_EQ(bench.exchange(data, 2), "RS");
  EXPECT_EQ(bench.ask(2, 62, "F2"), "E5");
  EXPECT_EQ(bench.diag(2), "00 0C 00 02 31 00");
  EXPECT_EQ(hex(bench.exchange(data, 2)).size(), 1U + 6);
  EXPECT_TRUE(bench.told("enters data exchange (master 2)"));
  // Wrong steps in data exchange lead back to the beginning.
  EXPECT_EQ(bench.ask(2, 61, prm_data(kWatchdog, "31 01")), "E5");
  EXPECT_EQ(bench.diag(2), "42 05 00 FF 31 00");
  EXPECT_EQ(bench.exchange(data, 2), "RS");
  bench.start("F2", prm_data(), 2);
  EXPECT_EQ(bench.ask(2, 62, "F3"), "E5");
  EXPECT_EQ(bench.diag(2), kCfgFault);
}

// Neither a parameter nor what the unit was before has a say.
TEST(DpCfg, TheMasterAloneChooses) {
  PROVES("DP-CFG-11");
  HandPlant bench(dp_line() + bare_station());
  bench.start("F0");
  EXPECT_EQ(hex(bench.exchange("00 06")).size(), 1U + 2);
  bench.start("F3 F2");
  EXPECT_EQ(hex(bench.exchange("00 00 00 00 00 00 00 00 00 06 05 DC 00 00")).size(), 1U + 14);
  EXPECT_EQ(bench.ask(1, 61, "40 00 00 00 00 00 00"), "E5") << "another master may come";
  bench.start("F1", prm_data(), 2);
  EXPECT_EQ(bench.outputs(2), "00 00 00 00") << "begins anew";
  EXPECT_EQ(hex(bench.exchange("00 06 05 DC", 2)).size(), 1U + 4);
  bench.plant->set_power("inv", false);
  bench.run_on(100 * kMillisecond);
  bench.plant->set_power("inv", true);
  bench.settle();
  bench.start("F0");
  EXPECT_EQ(hex(bench.exchange("00 06")).size(), 1U + 2);
  // The same with the master of a plant file that is changed and run again.
  for (const auto& [cfg, octets] : {std::pair("F0", 2), {"F3 F2", 14}}) {
    DpPlant plant(dp_line() + bare_station() + "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\ncfg = \"" +
                  cfg + "\"\n");
    plant.run(2 * kSecond);
    EXPECT_TRUE(plant.master().slave(0).exchanging());
    EXPECT_EQ(plant.master().slave(0).inputs().size(), static_cast<size_t>(octets));
  }
}

}  // namespace
}  // namespace ipos::tests

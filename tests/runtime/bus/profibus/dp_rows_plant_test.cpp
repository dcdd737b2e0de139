// Rows of the DP part as a plant shows them: what the master notes of its slaves, diagnosis of warnings, wiring and cable, octets of
// a foreign master of FMS, switches. Expected values: MOVITRAC 31 PROFIBUS, MOVIDRIVE serial and MDX60B/61B manuals.
#include "runtime/bus/profibus/frame_text.hpp"
#include "runtime/station/dp_slaves.hpp"
#include "tests/runtime/bus/profibus/dp_plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;
namespace diag = profibus::diag;

const std::string kLine = dp_line();

// What the master keeps of a slave has bits of its own; the slave never sends them.
TEST(DpRows, OwnBitsOfTheMaster) {
  PROVES("DP-DIAG-05", "DP-DIAG-07", "DP-DIAG-12");
  DpPlant two(kLine + mc31_station() + dp_master("watchdog = \"1s\"\n") + dp_master("", "", "other", 2));
  two.run(3 * kSecond);
  const auto controls = two.plant->all<runtime::ProfibusControl>();
  const profibus::Diagnosis& foreign = *controls[1]->view(8);
  EXPECT_TRUE(foreign.has(diag::kMasterLock)) << "octet 4 is neither FFh nor its own address";
  EXPECT_EQ(foreign.master, 1);
  EXPECT_FALSE(controls[0]->view(8)->has(diag::kMasterLock));
  auto& slave = two.station().profibus()->card().station().slave();
  for (const auto bit : {diag::kMasterLock, diag::kInvalidResponse, diag::kNonExistent})
    EXPECT_FALSE(slave.diagnosis(two.plant->now()).has(bit));
  DpPlant corrupt(kLine + mc31_station() + dp_master("") + "[[fault]]\nbus = \"dp\"\nkind = \"parity\"\nstation = \"inv\"\nfrom = \"2s\"\nuntil = \"3s\"\n");
  corrupt.run(2 * kSecond + 500 * kMillisecond);
  EXPECT_TRUE(corrupt.master().slave(0).view().has(diag::kInvalidResponse));
  EXPECT_FALSE(corrupt.station().profibus()->card().station().slave().diagnosis(corrupt.plant->now()).has(diag::kInvalidResponse));
  DpPlant unplugged(kLine + mc31_station() + dp_master(""));
  unplugged.run(2 * kSecond);
  const auto before = unplugged.master().slave(0).view();
  unplugged.plant->set_power("inv", false);
  unplugged.run(3 * kSecond);
  const auto& after = unplugged.master().slave(0).view();
  EXPECT_TRUE(after.has(diag::kNonExistent));
  EXPECT_EQ(after.master, before.master);
  EXPECT_EQ(after.ident, before.ident);
  EXPECT_EQ(after.status[1], before.status[1]);
}

// A slave that its master takes out of the cycle: bit 7 of octet 2 in the master's view alone.
TEST(DpRows, ASlaveOutOfTheCycle) {
  PROVES("DP-DIAG-13");
  DpPlant bench(kLine + mc31_station() +
                dp_master("watchdog = \"300ms\"\n", "[[control.command]]\nat = \"2s\"\ncommand = \"deactivate\"\naddress = 8\n"
                                                "[[control.command]]\nat = \"3s\"\ncommand = \"activate\"\naddress = 8\n"));
  bench.run(2 * kSecond - kMillisecond);
  EXPECT_TRUE(bench.master().slave(0).exchanging());
  EXPECT_FALSE(bench.master().slave(0).view().has(diag::kDeactivated));
  bench.run_on(100 * kMillisecond);
  const auto exchanges = bench.master().slave(0).exchanges();
  auto& slave = bench.station().profibus()->card().station().slave();
  for (int n = 0; n < 8; ++n) {
    bench.run_on(100 * kMillisecond);
    EXPECT_TRUE(bench.master().slave(0).view().has(diag::kDeactivated));
    EXPECT_EQ(encode(bench.master().slave(0).view())[1] & 0x80, 0x80);
    EXPECT_FALSE(slave.diagnosis(bench.plant->now()).has(diag::kDeactivated));
    EXPECT_EQ(bench.master().slave(0).exchanges(), exchanges);
  }
  EXPECT_EQ(bench.station().fault(), 28) << "the watchdog of the slave has missed its master";
  bench.run_on(kSecond);
  EXPECT_TRUE(bench.master().slave(0).exchanging());
  EXPECT_FALSE(bench.master().slave(0).view().has(diag::kDeactivated));
}

// A fault and a warning are in the diagnosis, eight octets; without one there are six.
TEST(DpRows, DiagnosisOfAWarning) {
  PROVES("DP-DIAG-01");
  for (const auto& [response, is_error] : {std::pair("4", true), {"7", false}}) {
    DpPlant bench(kLine + mc31_station(std::string("P572 = ") + response + "\n") +
                  dp_master("watchdog = \"200ms\"\npo = [6, 1500]\n",
                         "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n[[control.command]]\nat = \"2600ms\"\ncommand = \"start\"\n"));
    bench.run(2 * kSecond);
    EXPECT_EQ(encode(bench.master().slave(0).view()).size(), 6U);
    auto& slave = bench.station().profibus()->card().station().slave();
    bench.run(2500 * kMillisecond);
    EXPECT_EQ(bench.station().error(), is_error);
    std::string most;
    for (int n = 0; n < 30; ++n) {
      bench.run_on(100 * kMillisecond);
      const std::string octets = text_of(encode(slave.diagnosis(bench.plant->now())));
      if (octets.size() > most.size()) most = octets;
    }
    EXPECT_EQ(most.size(), 3U * 8 - 1) << response;
    EXPECT_EQ(most.substr(most.size() - 5), "02 1C") << response;
  }
}

// Each statement of the cable in appendix A, as keys of the plant; what is wrong stands in the journal.
TEST(DpRows, CableOfTypeA) {
  PROVES("DP-ID-10");
  const auto told = [](const std::string& keys) {
    std::string line = kLine;
    DpPlant bench(line + keys + mc31_station("", "profibus_terminator = true\n") + dp_master(""));
    bench.run(10 * kMillisecond);
    std::string all;
    for (const auto& entry : bench.plant->journal().entries()) all += entry.text + "\n";
    return all;
  };
  const std::string good = told("impedance = 150\ncapacitance = 28\nloop_resistance = 105\ncore_diameter = 0.65\ncore_section = 0.35\n");
  for (const auto& [keys, word] : {std::pair("impedance = 170\n", "surge impedance"),
                                   {"impedance = 130\n", "surge impedance"},
                                   {"capacitance = 31\n", "capacitance"},
                                   {"loop_resistance = 111\n", "loop resistance"},
                                   {"core_diameter = 0.6\n", "core diameter"},
                                   {"core_section = 0.3\n", "core cross section"}}) {
    EXPECT_EQ(good.find(word), std::string::npos) << word;
    EXPECT_NE(told(keys).find(word), std::string::npos) << keys;
  }
}

// A line that is too long, or without its resistors, loses frames: the master repeats, or finds nobody (2.5; the limits of
// EN 50170). The share between good and dead is ours.
TEST(DpRows, ALineThatDisturbs) {
  const auto on = [](const std::string& keys, bool terminated) {
    std::string line = kLine;
    auto bench = std::make_unique<DpPlant>(
        line + keys + mc31_station("", "profibus_terminator = " + std::string(terminated ? "true" : "false") + "\n") + dp_master(""));
    bench->run(2 * kSecond);
    return bench;
  };
  const auto told = [](const DpPlant& bench, const std::string& text) {
    size_t count = 0;
    for (const auto& entry : bench.plant->journal().entries()) count += entry.text.find(text) != std::string::npos;
    return count;
  };
  const auto good = on("length = 400\n", true);
  const uint64_t exchanges = good->master().slave(0).exchanges();
  EXPECT_GT(exchanges, 100U);
  const uint64_t before = good->master().repetitions();  // until the slave is there
  good->run(4 * kSecond);
  EXPECT_EQ(good->master().repetitions(), before);
  EXPECT_EQ(told(*good, "are disturbed"), 0U);
  const auto dead = on("length = 800\n", true);
  EXPECT_EQ(told(*dead, "dp: the line is longer than 400 m: 1000 of 1000 frames are disturbed"), 1U);
  EXPECT_EQ(dead->master().slave(0).exchanges(), 0U);
  EXPECT_TRUE(dead->master().slave(0).view().has(diag::kNonExistent));
  const auto half = on("", false);
  EXPECT_EQ(told(*half, "dp: a terminating resistor is not where it must be: 500 of 1000 frames are disturbed"), 1U);
  EXPECT_GT(half->master().repetitions(), 100U);
  EXPECT_LT(half->master().slave(0).exchanges(), exchanges / 2);
  // The plant's seed chooses which ones, and nothing else does.
  const auto of_seed = [&](const std::string& seed) {
    auto bench = std::make_unique<DpPlant>(seed + kLine + mc31_station("", "profibus_terminator = false\n") + dp_master(""));
    bench->run(2 * kSecond);
    return std::pair(bench->master().repetitions(), bench->master().slave(0).exchanges());
  };
  EXPECT_EQ(of_seed(""), std::pair(half->master().repetitions(), half->master().slave(0).exchanges()));
  EXPECT_EQ(of_seed("seed = 0\n"), of_seed(""));
  EXPECT_NE(of_seed("seed = 7\n"), of_seed(""));
  EXPECT_EQ(of_seed("seed = 7\n"), of_seed("seed = 7\n"));
}

// A station that is set to another rate for a while: no communication with it, and it comes back.
TEST(DpRows, AnotherRateForAWhile) {
  DpPlant bench(kLine + mc31_station() + dp_master("watchdog = \"200ms\"\n") +
                "[[fault]]\nbus = \"dp\"\nkind = \"baud\"\nstation = \"inv\"\nfrom = \"1s\"\nuntil = \"2s\"\n");
  bench.run(kSecond - kMillisecond);
  EXPECT_FALSE(bench.master().slave(0).view().has(diag::kNonExistent));
  bench.run(1900 * kMillisecond);
  EXPECT_TRUE(bench.master().slave(0).view().has(diag::kNonExistent));
  bench.run(4 * kSecond);
  EXPECT_FALSE(bench.master().slave(0).view().has(diag::kNonExistent));
}

// --- octets of a foreign master of FMS, as a test sends them

struct Heard final : runtime::BusObserver {
  void on_message(const runtime::Bus&, const runtime::BusMessage& message) override { texts.push_back(message.meaning); }
  std::vector<std::string> texts;
};

std::string sd2(int control, const std::string& data) {
  const auto octets = hex(data);
  const auto length = static_cast<uint8_t>(octets.size() + 5);
  return profibus::hex_text(profibus::Octets{0x68, length, length, 0x68, 0x88, 0x83, static_cast<uint8_t>(control), 25, 40}) + " " + data + " fcs 16";
}

TEST(DpRows, ASecondRequestBeforeTheAnswer) {
  PROVES("FMS-CRL-12");
  DpPlant bench(kLine + mc31_station());
  Heard heard;
  runtime::Bus& bus = *bench.plant->find_bus("dp");
  bus.add_observer(heard);
  bus.attach_hand();
  for (int n = 0; n < 100; ++n) {  // the slave finds the rate
    EXPECT_EQ(bus.send("10 08 03 49 fcs 16"), std::nullopt);
    bench.run_on(5 * kMillisecond);
  }
  const auto send = [&](int control, const std::string& data) {
    EXPECT_EQ(bus.send(sd2(control, data)), std::nullopt);
    bench.run_on(3 * kMillisecond);
    return heard.texts.empty() ? "" : heard.texts.back();
  };
  const std::string initiate = "01 00 00 E9 02 00 00 12 00 00 21 00 32 00 00 41 00 51 F1 61 00 71 07 F1 76 08 80 33 00 00 00 00";
  EXPECT_NE(send(0x6C, initiate).find("Initiate response, sends 0 and 241 octets, receives 0 and 241, features 00 00 00 80 33 00"), std::string::npos)
      << heard.texts.back();
  EXPECT_EQ(send(0x5C, "00 91 01 A1 02 04 01"), "short acknowledgement");
  EXPECT_NE(send(0x7C, "00 91 02 A1 02 04 01").find("Abort: a second request before the answer"), std::string::npos) << heard.texts.back();
  EXPECT_NE(send(0x5C, "00 91 03 A1 02 04 01").find("Abort: the connection is not open"), std::string::npos);
}

// --- lamps as signals

TEST(DpRows, RatesOfTheLamps) {
  PROVES("DP-LED-09");
  const auto shown = [](DpPlant& bench, const std::string& name) { return bench.shown("inv." + name); };
  DpPlant young(kLine + mc31_station());
  young.run(100 * kMillisecond);
  EXPECT_EQ(shown(young, "RUN_rate"), "3.0 Hz");
  EXPECT_EQ(shown(young, "BUS_FAULT_rate"), "0.0 Hz");
  DpPlant strange(kLine + mc31_station("", "", "inv", 126));
  strange.run(2 * kSecond);
  EXPECT_EQ(shown(strange, "BUS_FAULT_rate"), "0.5 Hz");
  EXPECT_EQ(shown(strange, "RUN"), "1");
  DpPlant broken(kLine + mc31_station() + "[[fault]]\nbus = \"dp\"\nkind = \"card_flash\"\nstation = \"inv\"\nfrom = \"1s\"\n");
  broken.run(2 * kSecond);
  EXPECT_EQ(shown(broken, "RUN_rate"), "1.0 Hz");
  EXPECT_EQ(shown(broken, "fms_switch"), "0");
}

// Status word 1, bit 2, says that the fieldbus controls; terminal 41 stops the drive all the same.
TEST(DpRows, FieldbusModeAndTerminals) {
  PROVES("DP-SW-01", "DP-STOP-01");
  DpPlant bench(kLine + mc31_station() + dp_master("po = [6, 1500]\n") +
                "[[stimulus]]\nstation = \"inv\"\nat = \"6s\"\ninput = \"DI00\"\nset = 0\n");
  bench.run(5999 * kMillisecond);
  EXPECT_EQ(bench.speed(), 300'000);
  EXPECT_EQ(bench.input(0), 0x0407);
  bench.run(12 * kSecond);
  EXPECT_EQ(bench.speed(), 0);
  DpPlant standard(kLine + "[[station]]\nname = \"inv\"\nunit = \"mc31\"\noption = \"ffp31\"\nprofibus = \"dp\"\nprofibus_address = 8\n" + dp_master("po = [6, 1500]\n"));
  standard.run(2 * kSecond);
  EXPECT_EQ(standard.input(0) & 4, 0) << "P841 is STANDARD";
}

// --- the card of a MOVIDRIVE

// The link between card and unit: class 6, code 2; repeated when it is there again, the service runs.
TEST(DpRows, LinkOfAMovidriveCard) {
  PROVES("PAR-20");
  DpPlant bench(kLine +
                "[[station]]\nname = \"b\"\nunit = \"mdxb\"\noption = \"dfp\"\nprofibus = \"dp\"\nprofibus_address = 9\n"
                "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 9\ncfg = \"F3 F0\"\n"
                "[[fault]]\nbus = \"dp\"\nkind = \"link\"\nstation = \"b\"\nfrom = \"2s\"\nuntil = \"3s\"\n");
  bench.run(2100 * kMillisecond);
  // P130 (8470) = 2.5 s.
  const int32_t before = bench.value("130");
  EXPECT_EQ(bench.service("72 00 21 16", "00 00 09 C4 00 00").substr(12), "06 02 00 00");
  EXPECT_EQ(bench.value("130"), before);
  bench.run(3100 * kMillisecond);
  EXPECT_EQ(bench.service("32 00 21 16", "00 00 09 C4 00 00"), "32 00 21 16 00 00 09 C4");
  EXPECT_EQ(bench.value("130"), 2500);
}

}  // namespace
}  // namespace ipos::tests

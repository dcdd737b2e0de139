// A MOVITRAC 31 in a plant: the drive behind the card, with a model master on the line. The expected values come from
// the manual MOVITRAC 31 PROFIBUS, and from arithmetic on its words (0.2 rpm a digit, ms a digit of the ramp).
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "runtime/plant/plant.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"
#include "tests/runtime/bus/profibus/octets.hpp"
#include "tests/runtime/bus/profibus/step5.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;
using runtime::Time;

constexpr uint16_t kEnable = 6;
constexpr uint16_t kPoDataEnabled = 1 << 2;  // status word 1: fieldbus mode active
constexpr int kFieldbusTimeout = 28;

std::string unit(const std::string& parameters = "P841 = \"FIELDBUS\"\nP600 = 0\nP601 = 0\n",
                 bool cw = true) {
  return std::string("[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 187500\n") +
         "[[station]]\nname = \"inv\"\nunit = \"mc31\"\noption = \"ffp31\"\nprofibus = "
         "\"dp\"\nprofibus_address = 8\n" +
         "[station.parameters]\n" + parameters + "[station.inputs]\nDI00 = " + (cw ? "1" : "0") + "\n";
}
std::string control(const std::string& slave, const std::string& more = "") {
  return "[[control]]\nname = \"plc\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n" + slave + more;
}

struct Mc31Plant {
  explicit Mc31Plant(const std::string& text) {
    goes_through(kPlantFile);
    runtime::PlantFileResult file = runtime::read_plant_file(text);
    for (const auto& error : file.errors) ADD_FAILURE() << error.place.line << ": " << error.text;
    std::vector<runtime::PlantError> errors;
    std::vector<std::optional<vm::Image>> programs(file.plant.stations.size());
    plant =
        std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors);
    for (const auto& error : errors) ADD_FAILURE() << error.place.line << ": " << error.text;
  }
  void run(Time end) { plant->run_until(end); }
  runtime::Station& inverter() { return *plant->stations()[0]; }
  int32_t speed() { return inverter().drive().state().speed(); }  // 1/1000 rpm
  uint16_t status() { return inverter().status_word_1(); }
  int32_t value(const char* number) { return inverter().drive().value(number); }
  profibus::Master& master() { return plant->all<runtime::ProfibusControl>()[0]->master(); }
  uint16_t input(size_t word, size_t from = 0) {  // as the master has it
    const profibus::Octets& octets = master().slave(0).inputs();
    return static_cast<uint16_t>(octets[from + 2 * word] << 8 | octets[from + 2 * word + 1]);
  }
  std::unique_ptr<runtime::Plant> plant;
};

TEST(Mc31Plant, ControlWordSpeedAndRamp) {
  PROVES("DP-CFG-14");
  Mc31Plant one(unit() + control("cfg = \"F0\"\npo = [6]\n"));
  one.run(500 * kMillisecond);
  EXPECT_TRUE(one.inverter().drive().state().axis().output_stage) << "0006h enables";

  Mc31Plant two(unit() + control("cfg = \"F1\"\npo = [6, 1500]\n"));
  two.run(3 * kSecond);
  EXPECT_EQ(two.speed(), 300'000);
  EXPECT_EQ(two.input(1), 1500);

  // 1 s for 50 Hz are 1500 rpm of the four-pole motor: half of them in half a second.
  Mc31Plant three(unit() + control("cfg = \"F2\"\npo = [6, 7500, 1000]\n"));
  Time began = 0;
  while (three.speed() == 0 && three.plant->now() < kSecond) three.run(three.plant->now() + kMillisecond);
  began = three.plant->now();
  three.run(began + 500 * kMillisecond);
  EXPECT_NEAR(three.speed(), 750'000, 3'000);
}

TEST(Mc31Plant, OnlyControlModeFieldbusLetsThemAct) {
  PROVES("DP-CFG-16");
  Mc31Plant standard(unit("P600 = 0\nP601 = 0\n") + control("cfg = \"F1\"\npo = [6, 1500]\n"));
  standard.run(2 * kSecond);
  EXPECT_EQ(standard.speed(), 0);
  EXPECT_EQ(standard.status() & kPoDataEnabled, 0);
  EXPECT_EQ(standard.input(0) & kPoDataEnabled, 0);
  Mc31Plant fieldbus(unit() + control("cfg = \"F1\"\npo = [6, 1500]\n"));
  fieldbus.run(2 * kSecond);
  EXPECT_EQ(fieldbus.speed(), 300'000);
  EXPECT_EQ(fieldbus.input(0) & kPoDataEnabled, kPoDataEnabled);
}

TEST(Mc31Plant, TheTerminalsEnableToo) {
  PROVES("DP-CFG-17");
  Mc31Plant off(unit("P841 = 1\nP600 = 0\nP601 = 0\n", false) + control("cfg = \"F1\"\npo = [6, 1500]\n"));
  off.run(kSecond);
  EXPECT_EQ(off.speed(), 0);
  off.inverter().inputs().line(0).set = 1;
  off.run(3 * kSecond);
  EXPECT_EQ(off.speed(), 300'000);
}

TEST(Mc31Plant, ParametersNeedNoEnable) {
  PROVES("DP-CFG-18");
  // Write 9.50 s to P120, fieldbus index 1025.
  Mc31Plant bench(unit("P600 = 0\nP601 = 0\n", false) +
                  control("cfg = \"F3 F0\"\nchannel = \"72 00 04 01 00 00 09 50\"\n"));
  bench.run(500 * kMillisecond);
  EXPECT_EQ(bench.value("120"), 950);
  EXPECT_EQ(text_of(profibus::Octets(bench.master().slave(0).inputs().begin(),
                                     bench.master().slave(0).inputs().begin() + 8)),
            "72 00 04 01 00 00 09 50");
}

// The listing of 3.6, over and over, as a controller does it.
TEST(Mc31Plant, ExampleOfTheProcessData) {
  PROVES("DP-CFG-19");
  Step5 program;
  program.load(
      "OB 1",
      "L IW 50\nT MW 50\nL IW 52\nT MW 52\nL IW 54\nT MW 54\nL KH 0006\nT OW 50\nL KF +1500\nT OW 52\n"
      "L KH 0000\nT OW 54\nBE\n");
  Mc31Plant bench(unit() + control("cfg = \"F2\"\n"));
  for (int cycle = 0; cycle < 300; ++cycle) {
    bench.run(bench.plant->now() + 10 * kMillisecond);
    for (size_t word = 0; word < 3; ++word)
      program.set_word("PI", 50 + 2 * static_cast<int>(word), bench.input(word));
    program.run("OB 1");
    profibus::Octets outputs;
    for (int word = 50; word < 56; word += 2) {
      const uint16_t value = program.word("PQ", word);
      outputs.insert(outputs.end(), {static_cast<uint8_t>(value >> 8), static_cast<uint8_t>(value)});
    }
    bench.master().slave(0).set_outputs(outputs);
  }
  EXPECT_EQ(bench.speed(), 300'000);
  EXPECT_EQ(program.word("PI", 52), 0x05DC);
  EXPECT_EQ(program.word("M", 52), 0x05DC);
  EXPECT_NE(program.word("M", 50) & 1, 0) << "status word 1: the output stage is on";
}

TEST(Mc31Plant, CyclicWritingNeedsSaveEepromOff) {
  PROVES("DP-PAR-18");
  const auto writes = [](const std::string& save) {
    std::string changes;
    for (int n = 1; n <= 10; ++n)
      changes += "[[control.slave.change]]\nat = \"" + std::to_string(300 * n) + "ms\"\nchannel = \"" +
                 (n % 2 == 1 ? "72" : "32") + " 00 04 01 00 00 0" + std::to_string(n % 10) + " 50\"\n";
    Mc31Plant bench(unit("P802 = " + save + "\n") + control("cfg = \"F3 F0\"\n", changes));
    bench.run(3500 * kMillisecond);
    EXPECT_EQ(bench.value("120"), 50) << "the tenth, in hundredths of a second";
    return bench.inverter().drive().parameters().eeprom_writes(25);
  };
  EXPECT_EQ(writes("1"), 10U);
  EXPECT_EQ(writes("0"), 0U);
  // Who writes again and again is told before the memory is worn out.
  const auto told = [](const std::string& parameters, const std::string& request) {
    Mc31Plant bench(unit(parameters) + "[[control]]\nname = \"vis\"\nkind = \"fms\"\nprofibus = \"dp\"\n[[control.slave]]\naddress = 8\n" +
                    "[[control.slave.request]]\nat = \"1s\"\n" + request);
    bench.run(10 * kMillisecond);
    for (const auto& entry : bench.plant->journal().entries())
      if (entry.text.find("vis writes object ") != std::string::npos && entry.text.find("to the EEPROM of inv: set its P802") != std::string::npos)
        return true;
    return false;
  };
  const std::string block = "every = \"200ms\"\nwrite = 996\ndata = \"00 01 04 01 00 00 09 50\"\n";
  const std::string write = "write = 1025\ndata = \"00 00 09 50\"\n", again = "every = \"200ms\"\n" + write;
  EXPECT_TRUE(told("", again)) << "ON is the factory setting";
  EXPECT_TRUE(told("P802 = \"ON\"\n", again));
  EXPECT_TRUE(told("", block));
  EXPECT_FALSE(told("P802 = \"OFF\"\n", again));
  EXPECT_FALSE(told("", write)) << "once";
  EXPECT_FALSE(told("", "every = \"200ms\"\nread = 1025\n"));
  EXPECT_FALSE(told("", "every = \"200ms\"\nwrite = 990\ndata = \"00 06 05 DC 00 00\"\n")) << "process data";
}

// The master falls silent at 2 s; the watchdog is 200 ms.
struct Silenced : Mc31Plant {
  explicit Silenced(const std::string& response, const std::string& more = "")
      : Mc31Plant(unit("P841 = 1\nP600 = 0\nP601 = 0\nP572 = " + response + "\n") +
                  control("cfg = \"F1\"\npo = [6, 1500]\nwatchdog = \"200ms\"\n",
                          "[[control.command]]\nat = \"2s\"\ncommand = \"stop\"\n" + more)) {
    run(2 * kSecond);
    EXPECT_EQ(speed(), 300'000);
    EXPECT_EQ(value("571"), 20) << "0.20 s";
  }
};

TEST(Mc31Plant, TimeoutResponse) {
  PROVES("DP-WD-05");
  Silenced hold("0");
  hold.run(4 * kSecond);
  EXPECT_EQ(hold.speed(), 300'000);
  EXPECT_EQ(hold.inverter().fault(), 0);
  Silenced stop("4");
  stop.run(2190 * kMillisecond);
  EXPECT_EQ(stop.inverter().fault(), 0);
  stop.run(2210 * kMillisecond);
  EXPECT_EQ(stop.inverter().fault(), kFieldbusTimeout);
  stop.run(4 * kSecond);
  EXPECT_EQ(stop.speed(), 0);
  EXPECT_TRUE(stop.inverter().error());
}

TEST(Mc31Plant, TimeoutIsShownAndReset) {
  const std::string again = "[[control.command]]\nat = \"4s\"\ncommand = \"start\"\n";
  Silenced fault("4", again);
  fault.run(3 * kSecond);
  using profibus::Light;
  EXPECT_EQ(fault.inverter().profibus()->card().leds(fault.plant->now()).red, Light::On);
  EXPECT_EQ(fault.status() >> 8, kFieldbusTimeout);
  bool told = false;
  for (const auto& entry : fault.plant->journal().entries())
    told |=
        entry.weight == runtime::Weight::Fault && entry.text.find("fieldbus timeout") != std::string::npos;
  EXPECT_TRUE(told);
  fault.run(6 * kSecond);
  EXPECT_EQ(fault.inverter().fault(), kFieldbusTimeout) << "a fault needs a reset";
  fault.master().slave(0).set_outputs(hex("00 46 05 DC"));
  fault.run(8 * kSecond);
  EXPECT_EQ(fault.inverter().fault(), 0);
  EXPECT_EQ(fault.speed(), 300'000);

  Silenced warning("7", again);
  warning.run(3900 * kMillisecond);
  EXPECT_EQ(warning.speed(), 0);
  EXPECT_EQ(warning.inverter().fault(), kFieldbusTimeout);
  warning.run(6 * kSecond);
  EXPECT_EQ(warning.inverter().fault(), 0) << "a warning ends with its cause";
  EXPECT_EQ(warning.speed(), 300'000);
}

// Status word 1 at once, Slave_Diag with the next refresh, every 800 ms from power-on.
TEST(Mc31Plant, DiagnosisShowsTheFaultLater) {
  PROVES("DP-DIAG-04");
  Mc31Plant bench(unit() + control("cfg = \"F1\"\npo = [6, 1500]\n"));
  bench.run(1000 * kMillisecond);
  bench.inverter().drive().state().raise_fault(47);
  bench.run(1010 * kMillisecond);
  EXPECT_EQ(bench.input(0) >> 8, 47);
  EXPECT_FALSE(bench.master().slave(0).view().fault);
  bench.run(1590 * kMillisecond);
  EXPECT_FALSE(bench.master().slave(0).view().fault);
  bench.run(1610 * kMillisecond);
  EXPECT_EQ(bench.master().slave(0).view().fault, 47);
}

profibus::fms::Response ask(Mc31Plant& bench, profibus::fms::Service service, uint16_t index,
                          const profibus::Octets& data = {}) {
  profibus::fms::Server& fms = bench.inverter().profibus()->card().fms();
  const uint8_t cref = 7;
  if (!fms.is_open(cref))
    fms.initiate(bench.plant->now(), cref, 2,
                 master_entry(*profibus::fms::find_connection(cref), 8));
  auto response = fms.request(bench.plant->now(), cref, {service, index, data});
  for (int ms = 0; !response && ms < 1000; ++ms) {
    bench.run(bench.plant->now() + kMillisecond);
    response = fms.response(bench.plant->now(), cref);
  }
  return *response;
}

TEST(Mc31Plant, FmsControlsOrReadsWhatDpSends) {
  using profibus::fms::End;
  using profibus::fms::Service;
  Mc31Plant alone(unit());
  EXPECT_EQ(ask(alone, Service::Write, 990, hex("00 06 05 DC 00 00")).end, fms::End::Positive);
  alone.run(3 * kSecond);
  EXPECT_EQ(alone.speed(), 300'000);
  Mc31Plant mixed(unit() + control("cfg = \"F2\"\npo = [6, 1500, 0]\n"));
  mixed.run(kSecond);
  EXPECT_EQ(text_of(ask(mixed, Service::Read, 990).data), "00 06 05 DC 00 00");
}

// Off and on: the master finds it again.
TEST(Mc31Plant, PowerCycle) {
  Mc31Plant bench(unit() + control("cfg = \"F1\"\npo = [6, 1500]\nwatchdog = \"100ms\"\n"));
  bench.run(2 * kSecond);
  bench.inverter().power_off();
  bench.run(3 * kSecond);
  EXPECT_FALSE(bench.master().slave(0).exchanging());
  bench.inverter().power_on();
  bench.run(6 * kSecond);
  EXPECT_TRUE(bench.master().slave(0).exchanging());
  EXPECT_EQ(bench.speed(), 300'000);
  EXPECT_EQ(bench.value("073"), 8);
}

TEST(Mc31Plant, ErrorsOfTheFile) {
  const auto refuses = [](const std::string& text, const std::string& expected) {
    std::string told;
    for (const auto& error : runtime::read_plant_file(text).errors)
      told += std::to_string(error.place.line) + ":" + std::to_string(error.place.column) + " " + error.text +
              "\n";
    EXPECT_NE(told.find(expected), std::string::npos) << told;
  };
  const std::string bus = "[[bus]]\nname = \"dp\"\nkind = \"profibus\"\n";
  const auto station = [&](const std::string& keys, const std::string& type = "mc31") {
    return bus + "[[station]]\nname = \"inv\"\nunit = \"" + type + "\"\n" + keys;
  };
  refuses("[[bus]]\nname = \"dp\"\nkind = \"profibus\"\nbaud = 12000\n",
          "4:8 PROFIBUS has 9600, 19200, 93750, 187500, 500000 or 1500000 baud, not 12000");
  refuses(station("option = \"ffp32\"\n"), "7:10 'ffp32' is no option; known are ffp31, ffp31a, ffp31c, size0, dfp");
  refuses(station("option = \"ffp31\"\n", "mdxb"), "7:10 option 'ffp31' is for unit mc31, not for mdxb");
  refuses(station("profibus = \"dp\"\n"), "7:12 profibus needs option");
  refuses(station("option = \"ffp31\"\nprofibus = \"dp\"\n"), "8:12 profibus needs profibus_address");
  refuses(station("option = \"ffp31\"\nprofibus_address = 3\n"), "8:20 profibus_address needs profibus");
  refuses(station("option = \"ffp31\"\nprofibus = \"dp\"\nprofibus_address = 128\n"),
          "9:20 profibus_address is 0 to 127");
  refuses(station("sbus = \"dp\"\n"), "7:8 bus 'dp' is a PROFIBUS line, not an SBus");
  refuses(station(control("cfg = \"F1\"\npo = [1, 2, 3]\n")), "cfg has 2 process data words");
  refuses(station(control("cfg = \"F1 4\"\n")), "'F1 4' are no octets");
  refuses(station(control("cfg = \"40\"\n")), "cfg ends within an identifier");
  refuses(station(control("channel = \"72 00 04 01 00 00 09 50\"\n")), "which cfg must have");
  refuses(station(control("watchdog = \"15ms\"\n")), "a watchdog time is 10ms times two factors");
  refuses(station(control("", "[[control.command]]\nat = \"1s\"\ncommand = \"halt\"\n")),
          "'halt' is no command of a master");
}

}  // namespace
}  // namespace ipos::tests

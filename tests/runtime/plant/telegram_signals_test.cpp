// What telegrams carried last, as signals: identifiers and bytes are those of the manuals (PO 8 x address + 3, parameter
// request + 512; PDOs of the pre-defined connection set), values what the stations sent.
#include "runtime/signals/find.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::kMillisecond;
using runtime::kSecond;

struct Lines {
  explicit Lines(const std::string& text, const std::map<std::string, std::string>& programs = {})
      : plant(make_plant(text, programs)) {}

  int64_t value(const std::string& name) {
    auto found = signals::find_signals(*plant, name);
    EXPECT_TRUE(found && found->size() == 1) << name << (found ? "" : ": " + found.error());
    return found && !found->empty() ? found->front().read() : -1;
  }
  std::vector<std::string> names(const std::string& pattern) {
    std::vector<std::string> all;
    if (const auto found = signals::find_signals(*plant, pattern))
      for (const auto& signal : *found) all.push_back(signal.name);
    return all;
  }
  void run(runtime::Time span) { plant->run_until(plant->now() + span); }

  std::unique_ptr<runtime::Plant> plant;
};

const std::string kSbus = R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "pump"
unit = "mc07"
sbus = "sbus"
[station.parameters]
P813 = 2
P100 = 10
P101 = 3
[[station]]
name = "pump2"
unit = "mc07"
sbus = "sbus"
[station.parameters]
P813 = 5
[[control]]
name = "plc"
sbus = "sbus"
[[control.target]]
address = 2
po = [6, 5000, 0xFFFE]
every = "10ms"
)";

TEST(TelegramSignals, ProcessDataOfMovilink) {
  Lines line(kSbus);
  EXPECT_EQ(line.value("sbus.013.PO2"), 0) << "nothing has come";
  line.run(kSecond);
  EXPECT_EQ(line.value("sbus.013.PO1"), 6);
  EXPECT_EQ(line.value("sbus.013.PO2"), 5000);
  EXPECT_EQ(line.value("sbus.013.PO3"), 0xFFFE);
  EXPECT_EQ(line.value("sbus.013.PO1.2"), 1) << "a bit";
  EXPECT_EQ(line.value("sbus.014.PI1"), line.plant->stations()[0]->status_word_1());
  EXPECT_EQ(line.value("sbus.013.count"), line.value("sbus.014.count")) << "an answer each";
  EXPECT_EQ(line.value("sbus.013.B3"), 5000 & 0xFF) << "PO2 in bytes 2 and 3, the high one first";
  EXPECT_EQ(line.value("sbus.02B.count"), 0) << "nobody asks address 5";
}

// A line keeps its frames from the first look on.
TEST(TelegramSignals, BeginWithTheFirstLook) {
  Lines line(kSbus);
  const auto listed = signals::plant_signals(*line.plant);
  line.run(kSecond);
  EXPECT_EQ(line.value("sbus.013.count"), 0) << "a list is no look";
  line.run(100 * kMillisecond);
  EXPECT_EQ(line.value("sbus.013.count"), 10);
  const auto in_list = std::count_if(listed.begin(), listed.end(),
                                     [](const auto& signal) { return signal.name == "sbus.014.PI3"; });
  EXPECT_EQ(in_list, 1);
}

TEST(TelegramSignals, TheParameterChannel) {
  Lines line(kSbus);
  line.plant->find_bus("sbus")->attach_hand();
  line.run(kSecond);
  EXPECT_EQ(line.value("sbus.214.index"), 0);
  // Read 8807 = 2267h (P130) of address 2: 8 x 2 + 515 = 213h.
  EXPECT_EQ(line.plant->find_bus("sbus")->send("213#3100226700000000"), std::nullopt);
  line.run(100 * kMillisecond);
  EXPECT_EQ(line.value("sbus.213.index"), 8807);
  EXPECT_EQ(line.value("sbus.213.service"), 1);
  EXPECT_EQ(line.value("sbus.214.index"), 8807);
  EXPECT_EQ(line.value("sbus.214.value"), line.plant->stations()[0]->drive().value("130"));
  EXPECT_EQ(line.value("sbus.214.failed"), 0);
  EXPECT_EQ(line.plant->find_bus("sbus")->send("213#3100000100000000"), std::nullopt);
  line.run(100 * kMillisecond);
  EXPECT_EQ(line.value("sbus.214.failed"), 1);
  EXPECT_EQ(line.value("sbus.214.value"), 0x08000010) << "no such index";
}

TEST(TelegramSignals, Patterns) {
  Lines line(kSbus);
  EXPECT_EQ(line.names("sbus.013.PO?"),
            (std::vector<std::string>{"sbus.013.PO1", "sbus.013.PO2", "sbus.013.PO3"}));
  EXPECT_EQ(line.names("sbus.*.PI1"), (std::vector<std::string>{"sbus.014.PI1", "sbus.02C.PI1"}));
  EXPECT_EQ(line.names("sbus.013.PO1.*").size(), 16U);
  EXPECT_EQ(line.names("sbus.*"), (std::vector<std::string>{"sbus.load", "sbus.count"}))
      << "a telegram has a part for its identifier";
  EXPECT_EQ(line.names("*.PI1"), (std::vector<std::string>{"pump.PI1", "pump2.PI1"}));
  EXPECT_FALSE(signals::find_signals(*line.plant, "sbus.013.speed"));
  EXPECT_FALSE(signals::find_signals(*line.plant, "sbus.813.B0")) << "an identifier has 11 bits";
}

// In the byte order of the object, which the program has defined meanwhile.
TEST(TelegramSignals, VariableTelegrams) {
  Lines line(R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "u"
unit = "mdxb"
program = "P.IPC"
sbus = "sbus"
[[station]]
name = "other"
unit = "mdxb"
sbus = "sbus"
[station.parameters]
P881 = 7
)",
             {{"P.IPC", R"(
#include <const.h>
SCTRCYCL t; long a; long b;
main() {
  t.ObjectNo = 1024; t.CycleTime = 10; t.Offset = 0; t.Format = 0x108; t.DPointer = numof(a);
  a = 0x11223344; b = -5;
  _SBusCommDef(SCD_TRCYCL, t);
  _SBusCommOn();
  while (1) ;
}
)"}});
  EXPECT_EQ(line.value("sbus.400.value1"), 0) << "can be named before it is defined";
  line.run(kSecond);
  EXPECT_EQ(line.value("sbus.400.value1"), 0x11223344);
  EXPECT_EQ(line.value("sbus.400.value2"), -5);
  EXPECT_EQ(line.value("sbus.400.B0"), 0x44) << "INTEL: the lowest byte first";
  EXPECT_EQ(line.names("sbus.400.*"),
            (std::vector<std::string>{"sbus.400.count", "sbus.400.value1", "sbus.400.value2"}));
}

TEST(TelegramSignals, CanopenByTheMappingOfTheNode) {
  Lines line(R"(
[[bus]]
name = "can"
kind = "can"
baud = 500000
[[station]]
name = "u"
unit = "mdxb"
sbus = "can"
[station.parameters]
P880 = 1
P886 = 5
P100 = 10
P101 = 3
[[control]]
name = "plc"
kind = "canopen"
sbus = "can"
cycle = "5ms"
[[control.target]]
address = 5
po = [6, 1500]
[[control.target.pdo]]
number = 2
transmit = true
map = ["PI3", "PI1"]
)");
  EXPECT_EQ(line.value("can.285.PI1"), 0);
  EXPECT_EQ(line.value("can.000.command"), 0);
  EXPECT_EQ(line.value("can.585.index"), 0);
  line.run(2 * kSecond);
  EXPECT_EQ(line.value("can.205.PO1"), 6);
  EXPECT_EQ(line.value("can.205.PO2"), 1500);
  EXPECT_EQ(line.value("can.185.PI1"), line.plant->stations()[0]->status_word_1());
  EXPECT_EQ(line.value("can.285.PI1"), line.plant->stations()[0]->status_word_1())
      << "the second word of PDO 2";
  EXPECT_EQ(line.value("can.285.PI2"), 0) << "not in it";
  EXPECT_EQ(line.value("can.000.command"), 1) << "NMT start";
  EXPECT_EQ(line.value("can.000.node"), 5);
  EXPECT_GE(line.value("can.585.index"), 0x1000) << "the last object that the master wrote";
}

// Two requests go to address 1, PARAM + 3PD each (format 4, 1053 1610 p. 25), a second apart.
const std::string kSerial = R"(
[[bus]]
name = "line1"
kind = "rs485"
[[station]]
name = "u"
unit = "md60a"
program = "P.IPC"
rs485 = "line1"
[[station]]
name = "pump"
unit = "md60a"
rs485 = "line1"
[station.parameters]
P810 = 1
P811 = 105
)";
const std::string kAsks = R"(
#include <const.h>
MOVLNK m; MLDATA d;
main() {
  m.BusType = 2; m.Address = 1; m.Format = 4; m.Service = 1; m.Index = 8470; m.DPointer = numof(d);
  d.PO1 = 6; d.PO2 = 5000; d.PO3 = 0xFFFE;
  _MoviLink(m);
  m.Index = 1;
  _Wait(1000);
  _MoviLink(m);
  while (1) ;
}
)";

TEST(TelegramSignals, Rs485ByAddress) {
  Lines line(kSerial, {{"P.IPC", kAsks}});
  EXPECT_EQ(line.value("line1.1.PO1"), 0) << "nothing has come";
  line.run(kSecond);
  EXPECT_EQ(line.value("line1.1.PO1"), 6);
  EXPECT_EQ(line.value("line1.1.PO2"), 5000);
  EXPECT_EQ(line.value("line1.1.PO3"), 0xFFFE);
  EXPECT_EQ(line.value("line1.1.PO1.2"), 1) << "a bit";
  EXPECT_EQ(line.value("line1.1.PI1"), line.plant->stations()[1]->status_word_1());
  EXPECT_GT(line.value("line1.1.requests"), 0);
  EXPECT_EQ(line.value("line1.1.requests"), line.value("line1.1.answers")) << "an answer each";
  EXPECT_EQ(2 * line.value("line1.1.requests"), line.value("line1.count")) << "nobody else is asked";
  EXPECT_EQ(line.value("line1.1.request_index"), 8470);
  EXPECT_EQ(line.value("line1.1.request_service"), 1) << "read";
  EXPECT_EQ(line.value("line1.1.answer_index"), 8470);
  EXPECT_EQ(line.value("line1.1.answer_value"), line.plant->stations()[1]->drive().value("130"));
  EXPECT_EQ(line.value("line1.1.answer_failed"), 0);
  line.run(kSecond);
  EXPECT_EQ(line.value("line1.1.answer_failed"), 1);
  EXPECT_EQ(line.value("line1.1.answer_value"), 0x08000010) << "no such index";
  EXPECT_EQ(line.value("line1.2.requests"), 0) << "every address can be named";
}

TEST(TelegramSignals, NamesOfRs485) {
  Lines line(kSerial, {{"P.IPC", kAsks}});
  EXPECT_EQ(line.names("line1.*.PO1"),
            (std::vector<std::string>{"line1.0.PO1", "line1.1.PO1", "line1.105.PO1"}));
  EXPECT_EQ(line.names("line1.*.PI1"), (std::vector<std::string>{"line1.0.PI1", "line1.1.PI1"}))
      << "nobody answers to a group";
  EXPECT_EQ(line.names("line1.1.*").size(), 2 * (1 + 3 + 5U))
      << "count, words and parameter channel, both ways";
  for (const char* wrong : {"line1.256.PO1", "line1.-1.PO1", "line1.x.PO1", "line1.1.speed", "line1.1.value"})
    EXPECT_FALSE(signals::find_signals(*line.plant, wrong)) << wrong;
}

// The words stand behind the eight octets of the parameter channel where the configuration has one (MOVITRAC 31
// PROFIBUS, 3.1.1).
const std::string kProfibus = R"(
[[bus]]
name = "dp"
kind = "profibus"
baud = 500000
[[station]]
name = "belt"
unit = "mc31"
option = "ffp31"
profibus = "dp"
profibus_address = 8
[[station]]
name = "pump"
unit = "mc31"
option = "size0"
profibus = "dp"
profibus_address = 9
[[control]]
name = "plc"
profibus = "dp"
address = 1
[[control.slave]]
address = 8
cfg = "F3 F2"
watchdog = "200ms"
po = [6, 1500, 7]
[[control.slave.change]]
at = "3s"
channel = "71 00 04 01 00 00 00 00"
[[control.slave]]
address = 9
cfg = "F1"
po = [6, 2500]
[[control.command]]
at = "4s"
command = "stop"
)";

TEST(TelegramSignals, ProfibusByAddressAndConfiguration) {
  Lines line(kProfibus);
  EXPECT_EQ(line.value("dp.8.PO1"), 0) << "nothing has come";
  line.run(3 * kSecond);
  EXPECT_EQ(line.value("dp.8.PO1"), 6);
  EXPECT_EQ(line.value("dp.8.PO2"), 1500);
  EXPECT_EQ(line.value("dp.8.PO3"), 7);
  EXPECT_EQ(line.value("dp.9.PO2"), 2500);
  EXPECT_EQ(line.value("dp.9.PO3"), 0) << "two words";
  EXPECT_EQ(line.value("dp.8.PI1"), line.value("belt.PI1"));
  EXPECT_EQ(line.value("dp.9.PI1"), line.value("pump.PI1"));
  EXPECT_EQ(line.value("dp.8.ident"), 0x3100);
  EXPECT_EQ(line.value("dp.9.ident"), 0x3111);
  EXPECT_EQ(line.value("dp.8.master"), 1);
  EXPECT_EQ(line.value("dp.8.status2.3"), 1) << "WD_On";
  EXPECT_EQ(line.value("dp.8.request_service"), 0);
  line.run(kSecond / 2);
  // Read fieldbus index 1025 = 0401h, P120.
  EXPECT_EQ(line.value("dp.8.request_service"), 1);
  EXPECT_EQ(line.value("dp.8.request_index"), 1025);
  EXPECT_EQ(line.value("dp.8.answer_index"), 1025);
  EXPECT_EQ(line.value("dp.8.answer_failed"), 0);
  EXPECT_NE(line.value("dp.8.answer_value"), 0);
  // The watchdog ends the data exchange: what was said last stays, where it stood.
  line.run(2 * kSecond);
  EXPECT_EQ(line.value("dp.8.PO2"), 1500);
  EXPECT_EQ(line.value("dp.8.answer_index"), 1025);
}

TEST(TelegramSignals, NamesOfProfibus) {
  Lines line(kProfibus);
  EXPECT_EQ(line.names("dp.*.PO?"),
            (std::vector<std::string>{"dp.8.PO1", "dp.8.PO2", "dp.8.PO3", "dp.9.PO1", "dp.9.PO2"}));
  EXPECT_EQ(line.names("dp.*.answer_index"), (std::vector<std::string>{"dp.8.answer_index"}));
  EXPECT_EQ(line.names("dp.127.*"), (std::vector<std::string>{"dp.127.command", "dp.127.groups"}));
  EXPECT_EQ(line.value("dp.20.PO24"), 0) << "every address can be named, with the words of a gateway";
  for (const char* wrong : {"dp.128.PO1", "dp.8.PO25", "dp.8.speed"})
    EXPECT_FALSE(signals::find_signals(*line.plant, wrong)) << wrong;
}

}  // namespace
}  // namespace ipos::tests

// PROFIBUS in the plant file: the card of a station, the gateway, the master, the faults of the line.
#include "tests/runtime/plant/plant_file_texts.hpp"

#include "runtime/bus/profibus/card.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;

const std::string kDpBuses = "[[bus]]\nname = 'p'\nkind = 'profibus'\n[[bus]]\nname = 'b'\nkind = 'can'\n";
const std::string kDpPlant = kDpBuses + "[[station]]\nname = 'u'\nunit = 'mdxb'\n";
const std::string kDpMaster = kDpPlant + "[[control]]\nname = 'c'\nprofibus = 'p'\n";
const std::string kDpSlave = kDpMaster + "[[control.slave]]\naddress = 8\n";

ProfibusMasterConfig dp_master(const std::string& text) {
  return std::get<ProfibusMasterConfig>(read_plant(text).controls.at(0).kind);
}
profibus::SlavePlan dp_slave(const std::string& more) { return dp_master(kDpSlave + more).slaves.at(0); }

TEST(PlantFileProfibus, TheCardOfAStation) {
  const auto use = [](const std::string& unit, const std::string& option) {
    return read_plant(kDpBuses + "[[station]]\nname = 'u'\nunit = '" + unit + "'\noption = '" + option +
                      "'\nprofibus = 'p'\nprofibus_address = 127\n")
        .stations.at(0)
        .profibus;
  };
  for (const auto& [unit, option, kind] : {std::tuple("mc31", "ffp31", profibus::OptionKind::Ffp31),
                                           std::tuple("mc31", "size0", profibus::OptionKind::Size0),
                                           std::tuple("mdxb", "dfp", profibus::OptionKind::Dfp21),
                                           std::tuple("md60a", "dfp", profibus::OptionKind::Dfp11)}) {
    const ProfibusUse found = use(unit, option);
    ASSERT_NE(found.option, nullptr) << option;
    EXPECT_EQ(found.option->kind, kind) << option;
    EXPECT_EQ(std::tuple(found.bus.bus, found.address, found.bus.place.line, found.option_place.line),
              std::tuple("p", 127, 11U, 10U));
  }
  const ProfibusUse none = read_plant(kDpPlant).stations[0].profibus;
  EXPECT_EQ(none.option, nullptr);
  EXPECT_EQ(std::pair(none.bus.bus, none.address), std::pair(std::string(), uint8_t{126}));
  // A card may be fitted that hangs on no line.
  EXPECT_NE(read_plant(kDpPlant + "option = 'dfp'\n").stations[0].profibus.option, nullptr);
}

TEST(PlantFileProfibus, MistakesOfACard) {
  expect_mistakes(kDpPlant, {
                                {"option = ^'dp'\n", "'dp' is no option; known are ffp31, ffp31a, ffp31c, size0, dfp"},
                                {"option = ^'gateway'\n", "'gateway' is no option"},
                                {"option = ^'ffp31'\n", "option 'ffp31' is for unit mc31, not for mdxb"},
                                {"option = ^'dfp'\nsbus2 = 'b'\n",
                                 "option 'dfp' and SBus 2 (option DFC11B) need the same slot of u"},
                                {"option = 'dfp'\nprofibus = ^'b'\nprofibus_address = 5\n",
                                 "bus 'b' is an SBus, not a PROFIBUS line"},
                                {"option = 'dfp'\nprofibus = ^5\n", "profibus must be a text in quotes"},
                                {"option = 'dfp'\nprofibus = 'p'\nprofibus_address = ^128\n",
                                 "profibus_address is 0 to 127"},
                                {"profibus_address = ^5\n", "profibus_address needs profibus"},
                                {"profibus = ^'p'\nprofibus_address = 5\n", "profibus needs option"},
                                {"option = 'dfp'\nprofibus = ^'p'\n", "profibus needs profibus_address"},
                            });
  expect_mistakes(kDpBuses, {{"[[station]]\nname = 'u'\nunit = 'mc31'\noption = ^'dfp'\n",
                              "option 'dfp' is for unit mdxb and md60a, not for mc31"},
                             {"[[station]]\nname = 'u'\nunit = ^'x'\noption = ^'dp'\n", ""}});
}

const std::string kDpGateway = kDpPlant + "[[station]]\nname = 'g'\nunit = 'gateway'\n";

TEST(PlantFileProfibus, AGateway) {
  const ControlConfig config =
      read_plant(kDpGateway + "profibus = 'p'\nprofibus_address = 0\nsbus = 'b'\n").controls.at(0);
  EXPECT_EQ(std::tuple(config.name, config.sbus, config.place.line), std::tuple("g", "b", 10U));
  EXPECT_FALSE(config.terminator);
  const auto& gateway = std::get<GatewayConfig>(config.kind);
  EXPECT_EQ(gateway.profibus.option->kind, profibus::OptionKind::Gateway);
  EXPECT_EQ(std::pair(gateway.profibus.bus.bus, gateway.profibus.address),
            std::pair(std::string("p"), uint8_t{0}));
  EXPECT_TRUE(gateway.drives.empty());
  const ControlConfig full = read_plant(kDpGateway +
                                        "profibus = 'p'\nprofibus_address = 127\nsbus = 'b'\n"
                                        "terminator = true\ndrives = [63, 0, 5, 4, 3, 2, 1, 62]\n")
                                 .controls.at(0);
  EXPECT_EQ(std::get<GatewayConfig>(full.kind).profibus.address, 127);
  EXPECT_EQ(full.terminator, true);
  EXPECT_EQ(std::get<GatewayConfig>(full.kind).drives, (std::vector<uint8_t>{0, 1, 2, 3, 4, 5, 62, 63}));
}

TEST(PlantFileProfibus, MistakesOfAGateway) {
  const std::string uses = "profibus = 'p'\nprofibus_address = 5\nsbus = 'b'\n";
  expect_mistakes(
      kDpGateway,
      {
          {uses + "^program = 'P'\n", "unknown key 'program' in a [[station]] of unit gateway"},
          {uses + "drives = ^5\n", "drives is a list of SBus addresses"},
          {uses + "drives = [^-1, ^64, 1]\n", "an SBus address is 0 to 63"},
          {uses + "drives = [^'1', 1]\n", "an SBus address must be a whole number"},
          {uses + "drives = [1, 2, ^1]\n", "the address 1 stands twice"},
          {uses + "drives = ^[]\n", "a gateway has 1 to 8 drives"},
          {uses + "drives = ^[1, 2, 3, 4, 5, 6, 7, 8, 9]\n", "a gateway has 1 to 8 drives"},
          {"profibus = 'p'\nprofibus_address = ^128\nsbus = 'b'\n", "profibus_address is 0 to 127"},
      });
  const std::string begin = "^[[station]]\nname = 'g'\nunit = 'gateway'\n";
  expect_mistakes(kDpPlant,
                  {{begin + "profibus = 'p'\nsbus = 'b'\n", "needs profibus_address"},
                   {begin + "profibus_address = 5\nsbus = 'b'\n", "needs profibus = ..."},
                   {begin + "profibus = 'p'\nprofibus_address = 5\n", "needs sbus"},
                   {"^[[station]]\nname = 'u'\nunit = 'gateway'\n" + uses, "there are two of station 'u'"}});
}

// A gateway has signals and nothing else, so only these can be asked of it.
TEST(PlantFileProfibus, AGatewayHasOnlySignals) {
  const std::string begin = kDpGateway + "profibus = 'p'\nprofibus_address = 5\nsbus = 'b'\n";
  const std::string kIs =
      "'g' is a gateway: it has no program, drive, inputs or parameters of its own, only signals";
  expect_mistakes(begin, {{"[[stimulus]]\nstation = ^'g'\nat = '1ms'\ninput = 'DI00'\nset = 1\n", kIs},
                          {"[[switch]]\nstation = ^'g'\ninput = 'DI00'\nfrom = 1\n", kIs},
                          {"[[wire]]\nfrom = ^'g.DO01'\nto = 'u.DI00'\n", kIs},
                          {"[[expect]]\nstation = ^'g'\nat = '1ms'\nvariable = 'x'\nequals = 1\n", kIs}});
  EXPECT_EQ(read_plant(begin + "[[expect]]\nstation = 'g'\nat = '1ms'\nsignal = 'x'\nequals = 1\n")
                .expectations[0]
                .signal.kind,
            SignalKind::Any);
  const auto errors = read_plant_file(kDpBuses +
                                      "[[station]]\nname = 'g'\nunit = 'gateway'\nprofibus = 'p'\n"
                                      "profibus_address = 5\nsbus = 'b'\n")
                          .errors;
  ASSERT_EQ(errors.size(), 1U);
  EXPECT_NE(errors[0].text.find("a gateway alone does not run"), std::string::npos);
}

TEST(PlantFileProfibus, AMaster) {
  const ProfibusMasterConfig none = dp_master(kDpMaster);
  EXPECT_EQ(std::tuple(none.bus, none.settings.address, none.settings.gap_factor), std::tuple("p", 1, 10U));
  EXPECT_TRUE(none.slaves.empty() && none.outputs.empty() && none.orders.empty());
  const ProfibusMasterConfig full = dp_master(kDpMaster + "address = 125\ngap = 1000\n");
  EXPECT_EQ(std::pair(full.settings.address, full.settings.gap_factor), std::pair(uint8_t{125}, 1'000U));
  EXPECT_EQ(dp_master(kDpMaster + "address = 0\ngap = 0\n").settings.gap_factor, 0U);
}

TEST(PlantFileProfibus, ASlave) {
  const profibus::SlavePlan none = dp_slave("");
  EXPECT_EQ(std::tuple(none.address, none.inputs, none.outputs, none.cfg),
            std::tuple(8, 6, 6, profibus::Octets{0xF2}));
  const profibus::PrmData& prm = none.prm;
  EXPECT_TRUE(prm.lock && prm.sync && prm.freeze);
  EXPECT_FALSE(prm.unlock || prm.watchdog);
  EXPECT_EQ(std::tuple(prm.groups, prm.min_tsdr, prm.ident), std::tuple(0, 11, 0x3100));
  const profibus::SlavePlan full =
      dp_slave("ident = 65535\ncfg = 'F3 F2'\nsync = false\nfreeze = false\ngroups = 255\nmin_tsdr = 255\n");
  EXPECT_FALSE(full.prm.sync || full.prm.freeze);
  EXPECT_EQ(std::tuple(full.prm.groups, full.prm.min_tsdr, full.prm.ident), std::tuple(255, 255, 0xFFFF));
  EXPECT_EQ(std::tuple(full.inputs, full.outputs, full.cfg),
            std::tuple(14, 14, profibus::Octets{0xF3, 0xF2}));
  // Up to 244 octets each way: FF are 16 words, F9 ten; DF and EF are 16 words of one direction.
  EXPECT_EQ(dp_slave("cfg = 'FF FF FF FF FF FF FF F9'\n").outputs, 244);
  const profibus::SlavePlan both = dp_slave("cfg = 'DF E0'\n");
  EXPECT_EQ(std::pair(both.inputs, both.outputs), std::pair(uint8_t{32}, uint8_t{2}));
}

// 10 ms times two factors of 1 to 255.
TEST(PlantFileProfibus, AWatchdogIsTwoFactors) {
  for (const auto& [text, product] : {std::pair("10ms", 1), std::pair("200ms", 20), std::pair("2.55s", 255),
                                      std::pair("2.56s", 256), std::pair("650250ms", 255 * 255)}) {
    const profibus::PrmData prm = dp_slave("watchdog = '" + std::string(text) + "'\n").prm;
    EXPECT_TRUE(prm.watchdog);
    EXPECT_EQ(prm.watchdog_factor_1 * prm.watchdog_factor_2, product) << text;
  }
  EXPECT_FALSE(dp_slave("watchdog = '0ms'\n").prm.watchdog);
  for (const char* wrong : {"5ms", "15ms", "2570ms", "650260ms", "655360ms"})
    expect_mistakes(kDpSlave, {{"watchdog = ^'" + std::string(wrong) + "'\n",
                                "a watchdog time is 10ms times two factors"}});
}

// Where the file gives no ident number it is that of the station with this address on this line.
TEST(PlantFileProfibus, TheIdentNumberIsThatOfTheStation) {
  const std::string other =
      "[[bus]]\nname = 'q'\nkind = 'profibus'\n[[station]]\nname = 'v'\nunit = 'mc31'\noption = 'size0'\n";
  const std::string drive = "option = 'dfp'\nprofibus = 'p'\nprofibus_address = 8\n";
  const std::string control = "[[control]]\nname = 'c'\nprofibus = 'p'\n[[control.slave]]\naddress = ";
  const auto ident = [&](const std::string& text) { return dp_master(text).slaves.at(0).prm.ident; };
  EXPECT_EQ(ident(kDpPlant + drive + control + "8\n"), 0x6003);
  EXPECT_EQ(ident(kDpPlant + drive + control + "9\n"), 0x3100) << "another address";
  EXPECT_EQ(ident(kDpPlant + drive + other + "profibus = 'p'\nprofibus_address = 9\n" + control + "9\n"),
            0x3111);
  EXPECT_EQ(ident(kDpPlant + other + "profibus = 'q'\nprofibus_address = 8\n" + control + "8\n"), 0x3100)
      << "another line";
  const PlantFile plant =
      read_plant(kDpGateway + "profibus = 'p'\nprofibus_address = 10\nsbus = 'b'\n" + control + "10\n");
  EXPECT_EQ(std::get<ProfibusMasterConfig>(plant.controls.at(1).kind).slaves.at(0).prm.ident, 0x6002);
}

TEST(PlantFileProfibus, OutputsOfASlave) {
  const auto outputs = dp_master(kDpSlave + R"(cfg = 'F3 F2'
channel = '72 00 04 01 00 00 09 50'
po = [6, -32768, 65535]
[[control.slave.change]]
at = '1s'
po = [1500]
[[control.slave.change]]
at = '2s'
channel = '01 02 03 04 05 06 07 08'
[[control.slave]]
address = 9
po = []
)")
                           .outputs;
  ASSERT_EQ(outputs.size(), 5U);
  using profibus::Octets;
  const auto is = [&](size_t n, Time at, size_t of, size_t first, const Octets& octets) {
    EXPECT_EQ(std::tuple(outputs[n].at, outputs[n].slave, outputs[n].first, outputs[n].octets),
              std::tuple(at, of, first, octets));
  };
  is(0, 0, 0, 0, {0x72, 0, 4, 1, 0, 0, 9, 0x50});
  is(1, 0, 0, 8, {0, 6, 0x80, 0, 0xFF, 0xFF});
  is(2, kSecond, 0, 8, {5, 0xDC});
  is(3, 2 * kSecond, 0, 0, {1, 2, 3, 4, 5, 6, 7, 8});
  is(4, 0, 1, 0, {});
  const auto words = dp_master(kDpSlave + "po = [1, 2, 3]\n").outputs;
  EXPECT_EQ(std::pair(words.at(0).first, words.at(0).octets), std::pair(size_t{0}, Octets{0, 1, 0, 2, 0, 3}));
}

TEST(PlantFileProfibus, MistakesOfAMaster) {
  const std::string change = "[[control.slave.change]]\n";
  expect_mistakes(
      kDpSlave,
      {
          {"^station = 5\n", "unknown key 'station' in [[control.slave]]"},
          {"ident = ^65536\n", "ident is 0 to 65535"},
          {"groups = ^256\n", "groups is 0 to 255"},
          {"min_tsdr = ^256\n", "min_tsdr is 0 to 255"},
          {"sync = ^1\n", "sync is true or false"},
          {"freeze = ^1\n", "freeze is true or false"},
          {"cfg = ^'F'\n", "'F' are no octets; write for example \"F3 F2\""},
          {"po = ^5\n", "po is a list of numbers"},
          {"po = [^65536, ^-32769]\n", "a process data word has 16 bits"},
          {"po = [^'1']\n", "a process data word must be a whole number"},
          {"po = ^[1, 2, 3, 4]\n", "cfg has 3 process data words"},
          {"cfg = 'F3 F2'\npo = ^[1, 2, 3, 4]\n", "cfg has 3 process data words"},
          {"channel = ^'01 02 03 04 05 06 07 08'\n", "channel are the 8 octets of the parameter channel"},
          {"cfg = 'F3 F2'\nchannel = ^'01 02 03 04 05 06 07'\n", "channel are the 8 octets"},
          {"cfg = 'F3 F2'\nchannel = ^'01 02 03 04 05 06 07 08 09'\n", "channel are the 8 octets"},
          {"^" + change, "a [[control.slave.change]] needs at"},
          {change + "at = '1s'\n^cfg = 'F2'\n", "unknown key 'cfg' in [[control.slave.change]]"},
          {change + "at = '1s'\npo = ^[1, 2, 3, 4]\n", "cfg has 3 process data words"},
          {"[[control.command]]\nat = '1s'\ncommand = ^'go'\n",
           "'go' is no command of a master; known are operate"},
          {"^[[control.command]]\nat = '1s'\n", "a [[control.command]] needs command"},
          {"^[[control.command]]\ncommand = 'stop'\n", "a [[control.command]] needs at"},
          {"[[control.command]]\nat = '1s'\ncommand = 'stop'\ngroups = ^256\n", "groups is 0 to 255"},
          {"[[control.command]]\nat = '1s'\ncommand = 'stop'\naddress = ^8\n", "only activate and deactivate are of one slave"},
          {"^[[control.command]]\nat = '1s'\ncommand = 'activate'\n", "needs address"},
          {"[[control.command]]\nat = '1s'\ncommand = 'deactivate'\naddress = ^77\n", "the master has no slave 77"},
          {"[[control.command]]\nat = '1s'\ncommand = 'stop'\n^slave = 8\n", "unknown key 'slave'"},
      });
  const std::string begin = "^[[control.slave]]\naddress = 8\n";
  expect_mistakes(kDpMaster,
                  {
                      {"^[[control.slave]]\n", "a [[control.slave]] needs address"},
                      {"[[control.slave]]\naddress = ^126\n", "address is 0 to 125"},
                      {begin + "cfg = '40'\n", "cfg ends within an identifier"},
                      {begin + "cfg = 'FF FF FF FF FF FF FF FA'\n", "cfg asks for more than 244 octets"},
                      {begin + "cfg = 'DF DF DF DF DF DF DF DA'\n", "cfg asks for more than 244 octets"},
                      {begin + "cfg = 'EF EF EF EF EF EF EF EA'\n", "cfg asks for more than 244 octets"},
                      {"address = ^126\n", "address is 0 to 125"},
                      {"gap = ^1001\n", "gap is 0 to 1000"},
                      {"^kind = 'sbus'\n", "unknown key 'kind' in [[control]]"},
                  });
}

// The bits of Global_Control (MOVITRAC 31 PROFIBUS, 3.4.6 has them as octet 1).
TEST(PlantFileProfibus, CommandsOfAMaster) {
  using Kind = ProfibusOrder::Kind;
  for (const auto& [word, kind, bits] :
       {std::tuple("operate", Kind::Control, 0x00), std::tuple("clear", Kind::Control, 0x02),
        std::tuple("unfreeze", Kind::Control, 0x04), std::tuple("freeze", Kind::Control, 0x08),
        std::tuple("unsync", Kind::Control, 0x10), std::tuple("sync", Kind::Control, 0x20),
        std::tuple("start", Kind::Start, 0), std::tuple("stop", Kind::Stop, 0)}) {
    const ProfibusOrder order =
        dp_master(kDpMaster + "[[control.command]]\nat = '2s'\ncommand = '" + word + "'\ngroups = 255\n")
            .orders.at(0);
    EXPECT_EQ(std::tuple(order.at, order.kind, order.command.command, order.command.groups),
              std::tuple(2 * kSecond, kind, bits, 255))
        << word;
  }
}

}  // namespace
}  // namespace ipos::runtime

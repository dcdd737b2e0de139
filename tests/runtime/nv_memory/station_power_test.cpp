// A station that is switched off and on, its program memory seen over the bus, and the parameter channel of a
// whole unit.
#include <gtest/gtest.h>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/signals/find.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"
#include "tests/runtime/bus/rs485/serial_rig.hpp"
#include "tests/runtime/bus/sbus_rig.hpp"
#include "tests/runtime/nv_memory/fake_medium.hpp"
#include "tests/vm/code.hpp"

namespace ipos::runtime {
namespace {

using tests::code_of;
using tests::FakeMedium;
using tests::Hand;
using tests::I;
using tests::MediumState;
using vm::Opcode;
using Data = std::array<uint8_t, 8>;

constexpr std::string_view kLines = "[[bus]]\nname = 'sbus'\nkind = 'can'\n[[bus]]\nname = 'line1'\nkind = 'rs485'\n";

std::optional<vm::Image> image_of(const stdlib::UnitType& unit, std::vector<uint32_t> code) {
  if (code.empty()) return std::nullopt;
  vm::Image image;
  image.unit = unit.code;
  image.code = std::move(code);
  return image;
}

std::unique_ptr<Plant> plant_of(std::vector<uint32_t> code, const std::string& unit) {
  tests::goes_through(tests::kPlantFile);
  const std::string_view serial = unit == "compact" ? "rs485_xt = 'line1'\nuss21a = true\n" : "rs485 = 'line1'\n";
  PlantFileResult file = read_plant_file(std::string(kLines) + "[[station]]\nname = 'unit1'\nunit = '" + unit +
                                         "'\nsbus = 'sbus'\n" + std::string(serial) + "[station.parameters]\n8600 = 1\n");
  for (const PlantError& error : file.errors) ADD_FAILURE() << error.text;
  StationConfig& config = file.plant.stations.at(0);
  if (!code.empty()) config.program = "A.IPC";
  std::vector<std::optional<vm::Image>> programs{image_of(*config.unit, std::move(code))};
  std::vector<PlantError> errors;
  auto plant = std::make_unique<Plant>(std::move(file.plant), std::move(programs), std::nullopt, errors);
  for (const PlantError& error : errors) ADD_FAILURE() << error.text;
  return plant;
}

// The same by hand around a memory that lies in a test, for which a plant file has no name.
struct Alone {
  Alone(std::vector<uint32_t> code, std::string_view unit, std::shared_ptr<MediumState> state) {
    config.name = "unit1";
    config.unit = stdlib::find_unit(unit);
    config.program = "A.IPC";
    station.emplace(queue, 1, config, image_of(*config.unit, std::move(code)), StationLines{{&line, nullptr}, &serial, nullptr},
                    journal, std::nullopt);
    EXPECT_EQ(station->use_memory(std::make_unique<FakeMedium>(std::move(state)), "u.nv"), std::nullopt);
    EXPECT_EQ(station->set_parameter({"8600", 1, {}}), std::nullopt);
    station->power_on();
  }

  EventQueue queue;
  CanLine line{queue, 0, "sbus", 500'000};
  Rs485Line serial{queue, 2, "line1", 9600};
  Journal journal;
  StationConfig config;
  std::optional<Station> station;
};

// One unit at address 1 and a hand-driven master on a line.
class Rig {
 public:
  explicit Rig(std::vector<uint32_t> code = {}, const std::string& unit = "md60a",
               std::shared_ptr<MediumState> state = nullptr)
      : plant(state ? nullptr : plant_of(code, unit)),
        alone(state ? std::make_unique<Alone>(std::move(code), unit, std::move(state)) : nullptr),
        queue(plant ? plant->queue() : alone->queue),
        line(plant ? plant->all<CanBus>()[0]->line() : alone->line),
        serial(plant ? plant->all<SerialBus>()[0]->line() : alone->serial),
        master(line, "control"),
        journal(plant ? plant->journal() : alone->journal),
        station(plant ? &*plant->stations()[0] : &*alone->station) {
    run(5 * kMillisecond);
  }

  void run(Time span) {
    if (plant)
      plant->run_until(plant->now() + span);
    else
      queue.run_until(queue.now() + span);
  }
  std::vector<Frame> send(uint32_t id, const Data& data, uint8_t length = 8) {
    master.frames.clear();
    master.port.send({id, length, data, false, false}, 0);
    run(20 * kMillisecond);
    return master.frames;
  }
  // The bytes of the one answer to a parameter request; all 0 when there is none.
  Data ask(const Data& data) {
    const std::vector<Frame> answers = send(523, data);
    if (answers.size() != 1 || answers[0].id != 524) return {};
    return answers[0].data;
  }
  Data ask(Service service, uint16_t index, uint32_t value = 0) {
    return ask({static_cast<uint8_t>(0x30 | static_cast<int>(service)), 0, static_cast<uint8_t>(index >> 8),
                static_cast<uint8_t>(index), static_cast<uint8_t>(value >> 24),
                static_cast<uint8_t>(value >> 16), static_cast<uint8_t>(value >> 8),
                static_cast<uint8_t>(value)});
  }
  // Value of a good answer, else the return code with the top bit set.
  int64_t value(Service service, uint16_t index, uint32_t write = 0) {
    const Data data = ask(service, index, write);
    int64_t number = 0;
    for (size_t i = 4; i < 8; ++i) number = number << 8 | data[i];
    return (data[0] & 0x80) != 0 ? number | int64_t{1} << 40 : number;
  }
  static int64_t refused(uint32_t code) { return int64_t{code} | int64_t{1} << 40; }
  int32_t parameter(uint16_t index) { return station->drive().parameters().value(index); }
  bool told(const std::string& text) const {
    for (const JournalEntry& entry : journal.entries())
      if (entry.text.find(text) != std::string::npos) return true;
    return false;
  }
  void power_cycle() {
    station->power_off();
    run(100 * kMillisecond);
    station->power_on();
    run(5 * kMillisecond);
  }

  std::unique_ptr<Plant> plant;
  std::unique_ptr<Alone> alone;
  EventQueue& queue;
  CanLine& line;
  Rs485Line& serial;
  Hand master;
  tests::HandNode pc{serial, "pc"};
  tests::Recorder recorder;
  const Journal& journal;
  Station* station;
};

const std::vector<uint32_t> kEndless = code_of({I(Opcode::AddHK, 200, 1), I(Opcode::Jmp, 0)});

TEST(StationPower, OffIsSilentAndOnBeginsAnew) {
  Rig rig(kEndless);
  EXPECT_EQ(rig.value(Service::Write, 8470, 2500), 2500);
  EXPECT_EQ(rig.value(Service::WriteVolatile, 8471, 2500), 2500);
  EXPECT_GT(rig.station->variable(200), 0);
  rig.station->power_off();
  EXPECT_FALSE(rig.station->powered());
  EXPECT_TRUE(rig.station->program_over());
  EXPECT_EQ(rig.send(523, {0x31, 0, 0x21, 0x16, 0, 0, 0, 0}).size(), 0U);
  rig.master.port.withdraw(0);  // nobody acknowledges it
  rig.station->power_off();     // is off
  rig.run(kSecond);
  rig.station->power_on();
  rig.station->power_on();  // is on
  rig.run(2 * kMillisecond);
  EXPECT_LT(rig.station->variable(200), 5) << "variables start at 0";
  EXPECT_EQ(rig.value(Service::Read, 8470), 2500);
  EXPECT_EQ(rig.value(Service::Read, 8471), 2000);
}

// An answer under way when the power goes does not come after it is back.
TEST(StationPower, NothingUnderWaySurvives) {
  Rig rig;
  rig.master.port.send({523, 8, {0x31, 0, 0x21, 0x16, 0, 0, 0, 0}, false, false}, 0);
  rig.run(kMillisecond);  // received, the answer is due in 2 ms
  rig.station->power_off();
  rig.station->power_on();
  rig.run(20 * kMillisecond);
  EXPECT_TRUE(rig.master.frames.empty());
  EXPECT_EQ(rig.value(Service::Read, 8600), 1);
}

// The same on RS-485: acyclic read of P130 at address 0.
TEST(StationPower, TheSerialLineFallsSilentToo) {
  Rig rig;
  rig.serial.add_observer(rig.recorder);
  const auto ask = [&](Time before_off = 0) {
    rig.recorder.clear();
    rig.pc.send(tests::telegram("02 00 86 31 00 21 16 00 00 00 00"));
    rig.run(before_off);
    if (before_off != 0) rig.station->power_off();
    if (before_off != 0) rig.station->power_on();
    rig.run(100 * kMillisecond);
    std::vector<std::string> heard = rig.recorder.all();
    EXPECT_FALSE(heard.empty());
    heard.erase(heard.begin());  // the request
    return heard;
  };
  const std::vector<std::string> answer{tests::text_of(tests::telegram("1D 00 86 31 00 21 16 00 00 07 D0"))};
  const std::vector<std::string> nothing;
  EXPECT_EQ(ask(), answer);
  rig.station->power_off();
  EXPECT_EQ(ask(), nothing);
  rig.station->power_on();
  rig.run(50 * kMillisecond);
  EXPECT_EQ(ask(), answer);
  // 12 characters of 11 bits at 9600 baud take 13.75 ms; then the answer is due within 50 ms.
  EXPECT_EQ(ask(14 * kMillisecond), nothing);
  EXPECT_EQ(ask(), answer);
}

TEST(StationPower, FaultsEndWithThePowerButAreRemembered) {
  Rig rig(code_of({I(Opcode::DivHH, 0, 1), I(Opcode::End)}));
  EXPECT_EQ(rig.station->fault(), 10);
  EXPECT_EQ(rig.parameter(8366), 10);
  rig.station->power_off();
  rig.run(kSecond);
  EXPECT_EQ(rig.station->fault(), 10);
  rig.station->power_on();
  EXPECT_EQ(rig.station->fault(), 0) << "before the program runs";
  EXPECT_EQ(rig.parameter(8366), 10);
  rig.run(5 * kMillisecond);
  EXPECT_EQ(rig.station->fault(), 10) << "it does it again";
  EXPECT_EQ(rig.parameter(8367), 10);
}

TEST(StationMemory, IsTheSameForTheNextRun) {
  auto state = std::make_shared<MediumState>();
  const auto code =
      code_of({I(Opcode::SetHK, 5, 7), I(Opcode::Memorize, 4), I(Opcode::SetHK, 6, 8), I(Opcode::End)});
  {
    Rig rig(code, "md60a", state);
    rig.value(Service::Write, 8470, 2500);
    EXPECT_TRUE(rig.station->program_over());
    EXPECT_TRUE(rig.station->store_memory());
  }
  Rig rig(kEndless, "md60a", state);
  EXPECT_EQ(rig.value(Service::Read, 8470), 2500);
  EXPECT_EQ(rig.value(Service::Read, 11005), 7) << "MEM STORE DATA";
  EXPECT_EQ(rig.value(Service::Read, 11006), 0) << "a mere assignment is not stored";
}

TEST(StationMemory, MemThatCannotStoreIsF25) {
  auto state = std::make_shared<MediumState>();
  state->room = 0;
  Rig rig(code_of({I(Opcode::SetHK, 5, 7), I(Opcode::Memorize, 4), I(Opcode::End)}), "md60a", state);
  EXPECT_EQ(rig.station->fault(), 25);
  EXPECT_TRUE(rig.told("the non-volatile memory does not work"));
  EXPECT_TRUE(rig.told("u.nv: not stored: no space left"));
  EXPECT_FALSE(rig.station->store_memory());
}

// The program writes parameter 8470 of its own unit in a loop; two commands a round.
std::vector<uint32_t> writer(int32_t service) {
  return code_of({I(Opcode::SetHK, 420, 5), I(Opcode::SetHK, 421, 253), I(Opcode::SetHK, 422, 6),
                  I(Opcode::SetHK, 423, service), I(Opcode::SetHK, 424, 8470), I(Opcode::SetHK, 425, 427),
                  I(Opcode::SetHK, 427, 2500), I(Opcode::Movlnk, 420), I(Opcode::Jmp, 14)});
}

TEST(StationMemory, CyclicStoringIsCountedAndWarnedOf) {
  PROVES("PAR-03");
  Rig stores(writer(2));
  stores.run(100 * kMillisecond);
  const uint32_t writes = stores.station->drive().parameters().eeprom_writes(8470);
  EXPECT_GT(writes, 40U);
  EXPECT_EQ(stores.parameter(8470), 2500);
  EXPECT_TRUE(stores.told("P130 Ramp t11 UP CW was stored 10 times within 0.018 s"));
  EXPECT_TRUE(stores.told("write volatile"));
  Rig writes_volatile(writer(3));
  writes_volatile.run(100 * kMillisecond);
  EXPECT_EQ(writes_volatile.parameter(8470), 2500);
  EXPECT_EQ(writes_volatile.station->drive().parameters().eeprom_writes(8470), 0U);
  EXPECT_FALSE(writes_volatile.told("was stored"));
}

TEST(StationMemory, SbusReceptionIsVolatile) {
  // SCREC with object 1024, 4 bytes into H5, then SCOMON.
  Rig rig(code_of({I(Opcode::SetHK, 420, 1024), I(Opcode::SetHK, 421, 4), I(Opcode::SetHK, 422, 5),
                   I(Opcode::Scom, 3, 420), I(Opcode::ScomOn), I(Opcode::Jmp, 8)}));
  rig.run(20 * kMillisecond);
  rig.send(1024, {0, 0, 0, 9}, 4);
  EXPECT_EQ(rig.station->variable(5), 9);
  rig.power_cycle();
  EXPECT_EQ(rig.value(Service::Read, 11005), 0);
}

TEST(ParameterChannel, VariablesOfTheProgram) {
  PROVES("PAR-08");
  Rig rig(code_of({I(Opcode::SetHK, 20, 0x11223344), I(Opcode::End)}));
  EXPECT_EQ(rig.ask(Service::Read, 11020), (Data{0x31, 0, 0x2B, 0x0C, 0x11, 0x22, 0x33, 0x44}));
  EXPECT_EQ(rig.value(Service::Write, 11511, 5), 5);
  EXPECT_EQ(rig.value(Service::Write, 11300, 6), 6);
  EXPECT_EQ(rig.station->variable(300), 6);  // H511 is ActPos_Mot, the drive sets it every millisecond
  EXPECT_EQ(rig.value(Service::Write, 11512, 5), Rig::refused(0x08000010));
}

TEST(ParameterChannel, ProgramWordsAndCurvePoints) {
  PROVES("PAR-09");
  Rig rig(kEndless);
  for (size_t n = 0; n < kEndless.size(); ++n)
    EXPECT_EQ(rig.value(Service::Read, static_cast<uint16_t>(16000 + n)), int64_t{kEndless[n]}) << n;
  EXPECT_EQ(rig.value(Service::Read, 18047), 0);
  EXPECT_EQ(rig.value(Service::Read, 18048), Rig::refused(0x08000010));
  for (const uint16_t index : std::initializer_list<uint16_t>{20000, 20512}) {
    EXPECT_EQ(rig.value(Service::Write, index, index), index);
    EXPECT_EQ(rig.value(Service::Read, index), index);
  }
  EXPECT_EQ(rig.value(Service::Read, 20513), Rig::refused(0x08000010));
  rig.power_cycle();
  EXPECT_EQ(rig.value(Service::Read, 20512), 20512);
}

TEST(ParameterChannel, FactorySetting) {
  PROVES("PAR-17");
  Rig rig;
  EXPECT_EQ(rig.value(Service::Write, 8470, 2500), 2500);
  EXPECT_EQ(rig.value(Service::Write, 8594, 1), 1);
  // While it is being installed.
  EXPECT_EQ(rig.ask(Service::Write, 8470, 3000), (Data{0xB2, 0, 0x21, 0x16, 8, 0, 0, 0x14}));
  EXPECT_EQ(rig.ask(Service::Write, 8594, 1), (Data{0xB2, 0, 0x21, 0x92, 8, 0, 0, 0x1E}));
  EXPECT_EQ(rig.value(Service::Read, 8470), 2500);
  rig.run(10 * kSecond);
  // It has taken the address, too.
  EXPECT_EQ(rig.parameter(8470), 2000);
  EXPECT_EQ(rig.parameter(8600), 0);
  const std::vector<Frame> answer = rig.send(515, {0x32, 0, 0x21, 0x16, 0, 0, 0x0B, 0xB8});
  const std::vector<Frame> at_1 = rig.send(523, {0x31, 0, 0x21, 0x16, 0, 0, 0, 0});
  EXPECT_EQ(answer.size() + at_1.size(), 1U) << "at its old or its new address";
}

TEST(ParameterChannel, ReadScaleOfContradictoryUnits) {
  PROVES("PAR-38");
  Rig rig;
  for (const int index : {8524, 8529})  // P321, P331: boost [%] in volts
    EXPECT_EQ(rig.value(Service::ReadScale, static_cast<uint16_t>(index)), 0x15FD) << index;
  EXPECT_EQ(rig.value(Service::ReadScale, 8576), 0x16FD);  // P710: standstill current in amperes
}

// What the channel does with the code of an internal error. There is no option card whose link could fail, so
// no row is proved.
TEST(ParameterChannel, InternalCommunicationError) {
  Rig rig;
  rig.station->drive().parameters().inject(stdlib::return_codes::kCommunication);
  EXPECT_EQ(rig.ask(Service::Write, 8470, 2500), (Data{0xB2, 0, 0x21, 0x16, 6, 2, 0, 0}));
  EXPECT_EQ(rig.parameter(8470), 2000);
  rig.station->drive().parameters().inject(std::nullopt);
  EXPECT_EQ(rig.value(Service::Write, 8470, 2500), 2500);
  EXPECT_EQ(rig.parameter(8470), 2500);
}

TEST(ParameterChannel, SyncIdentifierIsCodedInThousandths) {
  PROVES("PAR-33");
  Rig rig;
  EXPECT_EQ(rig.value(Service::Write, 8604, 128'500), Rig::refused(0x0800001D));
  EXPECT_EQ(rig.value(Service::Write, 8604, 128'000), 128'000);
  rig.power_cycle();  // the bus port takes it at power-on (ours)
  // Bit 6: the answer waits for the sync telegram.
  EXPECT_TRUE(rig.send(523, {0x71, 0, 0x21, 0x16, 0, 0, 0, 0}).empty());
  EXPECT_TRUE(rig.send(127, {}, 0).empty());
  const std::vector<Frame> answers = rig.send(128, {}, 0);
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_EQ(answers[0].data, (Data{0x71, 0, 0x21, 0x16, 0, 0, 0x07, 0xD0}));
}

TEST(ParameterChannel, ProcessDataShown) {
  PROVES("PAR-36");
  Rig rig;
  const stdlib::Parameter& p090 = *rig.station->drive().parameters().table().find("P090");
  const char* printed[] = {"PARAM + 1PD", "1PD",         "PARAM + 2PD", "2PD",          "PARAM + 3PD",
                           "3PD",         "PARAM + 6PD", "6PD",         "PARAM + 10PD", "10PD"};
  for (int32_t code = 0; code < 10; ++code) EXPECT_EQ(stdlib::parameter_text(p090, code), printed[code]);
  EXPECT_EQ(rig.value(Service::ReadDefault, 8451), 4);
  EXPECT_EQ(rig.value(Service::Write, 8451, 4), Rig::refused(0x08000012));
  // The frame formats are another enumeration: 6 is the parameter channel alone.
  EXPECT_TRUE(telegram_format(6)->parameter);
  EXPECT_EQ(telegram_format(6)->words, 0);
  rig.send(11, {0x00, 0x06, 0x13, 0x88, 0x3A, 0x98}, 6);
  EXPECT_EQ(rig.value(Service::Read, 8455), 6);
  EXPECT_EQ(rig.value(Service::Read, 8456), 5000);
  EXPECT_EQ(rig.value(Service::Read, 8457), 15000);
  // P097..P099: what the next PI telegram carries.
  const std::vector<Frame> input = rig.send(11, {0x00, 0x06, 0x13, 0x88, 0x3A, 0x98}, 6);
  ASSERT_EQ(input.size(), 1U);
  for (size_t n = 0; n < 3; ++n)
    EXPECT_EQ(rig.value(Service::Read, static_cast<uint16_t>(8458 + n)),
              input[0].data[2 * n] << 8 | input[0].data[2 * n + 1]);
}

TEST(Movitrac07, ParameterTelegrams) {
  PROVES("M07-PAR-01", "M07-PAR-03", "M07-PAR-04", "M07-PAR-05", "M07-PAR-06", "M07-PAR-07", "M07-PAR-08",
         "M07-PAR-15");
  const auto request = [](Service service, uint16_t index, int32_t value = 0) {
    return encode(parameter_request(service, index, 0, value));
  };
  EXPECT_EQ(request(Service::Read, 8318), (Data{0x31, 0, 0x20, 0x7E, 0, 0, 0, 0}));
  EXPECT_EQ(request(Service::Write, 8318, 1), (Data{0x32, 0, 0x20, 0x7E, 0, 0, 0, 1}));
  EXPECT_EQ(request(Service::WriteVolatile, 8318, 1'000'000),
            (Data{0x33, 0, 0x20, 0x7E, 0, 0x0F, 0x42, 0x40}));
  Rig rig({}, "mc07");
  const Data maximum_speed{0x31, 0, 0x21, 0x45, 0x00, 0x16, 0xE3, 0x60};
  for (int n = 0; n < 2; ++n)
    EXPECT_EQ(rig.ask(request(Service::Read, 8517)), maximum_speed) << "no toggling";
  // Bit 6 must be 0: class 5, code 5, at once; nothing is carried out (chapter 4.2, special cases).
  for (const uint8_t service : std::array<uint8_t, 3>{0x72, 0x73, 0x71}) {
    const Data answer = rig.ask({service, 0, 0x21, 0x45, 0x00, 0x15, 0x5C, 0xC0});
    EXPECT_EQ(answer, (Data{static_cast<uint8_t>(service | 0x80), 0, 0x21, 0x45, 5, 5, 0, 0}));
    EXPECT_EQ(rig.ask(request(Service::Read, 8517)), maximum_speed);
  }
  // The same to the group P814 = 0 leaves a reason.
  EXPECT_TRUE(rig.send(518, {0x72, 0, 0x21, 0x45, 0x00, 0x15, 0x5C, 0xC0}).empty());
  EXPECT_EQ(rig.ask(request(Service::Read, 8517)), maximum_speed);
  EXPECT_TRUE(rig.told("SBus telegram 206h (518) had no effect: group write refused"));
  EXPECT_EQ(rig.ask(request(Service::Read, 8622)), (Data{0x31, 0, 0x21, 0xAE, 0, 0, 0, 1}));
  EXPECT_EQ(rig.ask(request(Service::Read, 9500)), (Data{0xB1, 0, 0x25, 0x1C, 8, 0, 0, 0x10}));
  EXPECT_EQ(rig.ask(request(Service::Write, 8318, 1)), (Data{0xB2, 0, 0x20, 0x7E, 8, 0, 0, 0x12}));
}

// 1B: the program memory is protected while the program runs.
TEST(Movitrac07, ProgramWordsOfARunningProgramAreProtected) {
  PROVES("M07-PAR-13");  // the other codes: Memory.AWriteThatCannotBeStoredIsRefused
  Rig rig(kEndless, "mc07");
  EXPECT_EQ(rig.ask(Service::Write, 16000, 5), (Data{0xB2, 0, 0x3E, 0x80, 8, 0, 0, 0x1B}));
  EXPECT_EQ(rig.value(Service::Read, 16000), int64_t{kEndless[0]});
}

// Byte 1 is reserved where there are no subindices: ignored, told once, and 0 in the answer (1053 1610 p.
// 30).
TEST(ParameterChannel, ReservedByte) {
  for (const char* unit : {"md60a", "compact", "mc07", "mdxb"}) {
    Rig rig({}, unit);
    const bool subindices = std::string_view(unit) == "mdxb";
    const uint8_t back = subindices ? 5 : 0;
    for (int n = 0; n < 2; ++n) {
      EXPECT_EQ(rig.ask({0x31, 5, 0x21, 0xAE, 0, 0, 0, 0}), (Data{0x31, back, 0x21, 0xAE, 0, 0, 0, 1}))
          << unit;
      EXPECT_EQ(rig.ask({0x30, 5, 0x21, 0xAE, 0, 0, 0, 9}), (Data{0x30, back, 0x21, 0xAE, 0, 0, 0, 9}))
          << unit;
      EXPECT_EQ(rig.ask({0x31, 5, 0x25, 0x1D, 0, 0, 0, 0})[1], back) << unit << ", refused";
    }
    EXPECT_EQ(rig.told("byte 1 of the parameter channel is reserved"), !subindices) << unit;
  }
}

TEST(Movitrac07, VariablesAndProgram) {
  PROVES("M07-PAR-17", "M07-PAR-18");
  Rig rig(kEndless, "mc07");
  EXPECT_EQ(rig.value(Service::Write, 11020, 5), 5);
  EXPECT_EQ(rig.station->variable(20), 5);
  EXPECT_EQ(rig.value(Service::Write, 11511, 6), 6);
  EXPECT_EQ(rig.value(Service::Read, 11512), Rig::refused(0x08000010));
  EXPECT_EQ(rig.value(Service::Read, 16000), int64_t{kEndless[0]});
  EXPECT_EQ(rig.value(Service::Read, 17023), 0);
  EXPECT_EQ(rig.value(Service::Read, 17024), Rig::refused(0x08000010));
}

// --- damaged memory

TEST(StationMemory, BothSlotsDamagedIsFault94) {
  auto state = std::make_shared<MediumState>();
  {
    Rig rig({}, "md60a", state);
    rig.value(Service::Write, 8470, 2500);
    rig.value(Service::Write, 8471, 2500);
  }
  state->bytes[20] ^= 1;
  state->bytes[kSlotStride + 20] ^= 1;
  {
    Rig rig({}, "md60a", state);
    EXPECT_EQ(rig.station->fault(), 94);
    EXPECT_TRUE(rig.station->error());
    EXPECT_EQ(rig.station->status_word_1() >> 8, 94);
    EXPECT_EQ(rig.station->drive().state().verdict().reason, Block::Fault);
    EXPECT_TRUE(rig.told("F94 EEPROM checksum: the stored parameters are damaged"));
    EXPECT_TRUE(
        rig.told("no state in it is whole: slot 0 at byte 0: wrong checksum; slot 1 at byte 131072: "
                 "wrong checksum: the unit starts with factory values"));
    EXPECT_EQ(rig.parameter(8366), 94) << "error memory t-0";
    EXPECT_EQ(rig.value(Service::Read, 8470), 2000);
    EXPECT_EQ(rig.value(Service::Write, 8617, 1), 1);  // P840
    EXPECT_EQ(rig.station->fault(), 0);
  }
  Rig rig({}, "md60a", state);
  EXPECT_EQ(rig.station->fault(), 0) << "factory values are stored again";
  EXPECT_EQ(rig.parameter(8366), 94);
  state->bytes[20] ^= 1;
  state->bytes[kSlotStride + 20] ^= 1;
  rig.station->power_off();  // stores nothing: nothing has changed
  rig.station->power_on();
  rig.run(5 * kMillisecond);
  EXPECT_EQ(rig.station->fault(), 94) << "found at a power-on within a run, too";
}

// --- program code

const auto kSeven = code_of({I(Opcode::SetHK, 200, 7), I(Opcode::End)});

void download(Rig& rig, const std::vector<uint32_t>& code, Service service, size_t clear = 8) {
  for (size_t n = 0; n < std::max(code.size(), clear); ++n)
    ASSERT_EQ(rig.value(service, static_cast<uint16_t>(16000 + n), n < code.size() ? code[n] : 0),
              n < code.size() ? int64_t{code[n]} : 0);
}

TEST(ProgramMemory, IsClosedWhileTheProgramRuns) {
  Rig rig(kEndless);
  EXPECT_EQ(rig.value(Service::Write, 16000, 2), Rig::refused(0x0800001B));
  EXPECT_EQ(rig.value(Service::WriteVolatile, 16005, 2), Rig::refused(0x0800001B));
  EXPECT_TRUE(rig.told("program word 0 := 2: parameter has access protection (a program is running)"));
  EXPECT_EQ(rig.value(Service::Read, 16000), int64_t{kEndless[0]});
  rig.station->stop_program();
  download(rig, kSeven, Service::WriteVolatile);
  EXPECT_NE(rig.station->variable(200), 7) << "not started yet";
  rig.value(Service::WriteVolatile, 11300, 99);
  EXPECT_EQ(rig.station->start_program(), std::nullopt);
  rig.run(5 * kMillisecond);
  EXPECT_EQ(rig.station->variable(200), 7);
  EXPECT_EQ(rig.station->variable(300), 99) << "variables keep their values";
  rig.power_cycle();
  EXPECT_EQ(rig.value(Service::Read, 16000), int64_t{kEndless[0]}) << "was written volatile";
}

// A fault stops the program, so its memory is open; the reset of the fault starts what is there by then.
TEST(ProgramMemory, WhatAResetStartsIsWhatItHolds) {
  const auto kFaulty = code_of({I(Opcode::DivHH, 200, 201), I(Opcode::End)});
  Rig rig(kFaulty);
  EXPECT_EQ(rig.station->fault(), 10);
  rig.value(Service::WriteVolatile, 11300, 99);
  download(rig, kSeven, Service::WriteVolatile);
  EXPECT_EQ(rig.value(Service::Write, 8617, 1), 1);  // P840
  rig.run(5 * kMillisecond);
  EXPECT_EQ(rig.station->fault(), 0);
  EXPECT_EQ(rig.station->variable(200), 7);
  EXPECT_EQ(rig.station->variable(300), 99) << "variables keep their values";
  EXPECT_TRUE(rig.told("the program starts anew after the reset of its fault"));
}

TEST(ProgramMemory, AResetStartsNothingThatBreaksARule) {
  Rig rig(code_of({I(Opcode::DivHH, 200, 201), I(Opcode::End)}));
  EXPECT_EQ(rig.station->fault(), 10);
  EXPECT_EQ(rig.value(Service::WriteVolatile, 16001, 0xEE), 0xEE);
  EXPECT_EQ(rig.value(Service::Write, 8617, 1), 1);  // P840
  rig.run(5 * kMillisecond);
  EXPECT_TRUE(rig.told("program not started: word 1: the code word is no command [V03]"));
  EXPECT_TRUE(rig.station->program_over());
}

TEST(ProgramMemory, IsVerifiedBeforeItStarts) {
  Rig rig(kEndless);
  rig.station->stop_program();
  const int32_t before = rig.station->variable(200);
  EXPECT_EQ(rig.value(Service::Write, 16003, 1), 1);
  EXPECT_EQ(rig.station->start_program(), "word 2: the label is not the start of a command [V10]")
      << "JMP into the constant of ADD";
  EXPECT_EQ(rig.value(Service::Write, 16000, 0xEE), 0xEE);
  EXPECT_EQ(rig.station->start_program(), "word 0: the code word is no command [V03]");
  rig.run(20 * kMillisecond);
  EXPECT_EQ(rig.station->variable(200), before) << "nothing runs";
  rig.power_cycle();
  EXPECT_TRUE(rig.told("program not started: word 0: the code word is no command [V03]"));
  EXPECT_TRUE(rig.station->program_over());
  // Who looks at the unit finds no program: zeros.
  EXPECT_EQ(rig.station->variable(200), 0);
  size_t tasks = 0;
  for (const signals::Signal& signal : signals::station_signals(*rig.station)) {
    const int64_t value = signal.read();
    if (signal.group != signals::Group::Task) continue;
    ++tasks;
    EXPECT_EQ(value, 0) << signal.name;
  }
  EXPECT_EQ(tasks, 4U) << "state and line of two tasks";
  download(rig, kSeven, Service::Write);
  EXPECT_EQ(rig.station->start_program(), std::nullopt);
  rig.run(5 * kMillisecond);
  EXPECT_EQ(rig.station->variable(200), 7);
}

TEST(ProgramMemory, AStoredChangeSurvivesUntilThePlantsProgramChanges) {
  auto state = std::make_shared<MediumState>();
  {
    Rig rig(kEndless, "md60a", state);
    rig.station->stop_program();
    download(rig, kSeven, Service::Write);
    rig.power_cycle();
    EXPECT_EQ(rig.station->variable(200), 7);
  }
  {
    Rig rig(kEndless, "md60a", state);
    EXPECT_EQ(rig.station->variable(200), 7);
    EXPECT_EQ(rig.station->source_place(0), "");
  }
  const auto other = code_of({I(Opcode::SetHK, 200, 8), I(Opcode::End)});
  Rig rig(other, "md60a", state);
  EXPECT_EQ(rig.station->variable(200), 8);
  EXPECT_TRUE(rig.told("the memory holds a change of another program; it is dropped"));
}

TEST(ProgramMemory, AnEmptyUnitTakesAProgram) {
  Rig rig;
  EXPECT_EQ(rig.station->start_program(), "word 0: the program has no command [V01]");
  download(rig, kSeven, Service::Write);
  EXPECT_EQ(rig.station->start_program(), std::nullopt);
  rig.run(5 * kMillisecond);
  EXPECT_EQ(rig.value(Service::Read, 11200), 7);
  rig.station->power_off();
  EXPECT_EQ(rig.station->start_program(), "the station is off");
}

// The last command ends in a word that is 0.
TEST(ProgramMemory, EndsWithTheWholeLastCommand) {
  const auto code = code_of({I(Opcode::AddHK, 200, 1), I(Opcode::Jmp, 0)});
  ASSERT_EQ(code.back(), 0U) << "JMP 0";
  Rig rig(code);
  EXPECT_GT(rig.station->variable(200), 0);
  EXPECT_EQ(rig.station->drive().memory().program().code(), code);
}

}  // namespace
}  // namespace ipos::runtime

// What a plant file says of buses and stations is what the plant has, and what it leaves out is the default of
// docs/guide/plant-file.md.
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::read_plant;

const std::string kPlainUnit = "[[station]]\nname = 'u'\nunit = 'mdxb'\n";

TEST(PlantFileValues, OfABus) {
  const PlantFile plant = read_plant(kPlainUnit + R"(
[[bus]]
name = 'c'
kind = 'can'
[[bus]]
name = 'full'
kind = 'can'
baud = 125000
port = 'vcan0'
length = 12.3456
impedance = 1000
capacitance = 1000
shielded = true
terminated = true
[[bus]]
name = 'r'
kind = 'rs485'
[[bus]]
name = 's'
kind = 'rs232'
length = 0.0006
[[bus]]
name = 'p'
kind = 'profibus'
length = 1e6
)");
  ASSERT_EQ(plant.buses.size(), 5U);
  const BusConfig& bus = plant.buses[0];
  EXPECT_EQ(std::tuple(bus.name, bus.kind, bus.baud, bus.port), std::tuple("c", BusKind::Can, 500'000U, ""));
  EXPECT_EQ(std::tuple(bus.length_mm, bus.impedance, bus.capacitance), std::tuple(0U, 0U, 0U));
  EXPECT_FALSE(bus.shielded || bus.terminated);
  EXPECT_EQ(bus.place.line, 5U);
  EXPECT_EQ(bus.port_place.line, 0U);
  const BusConfig& full = plant.buses[1];
  EXPECT_EQ(std::tuple(full.name, full.kind, full.baud, full.port),
            std::tuple("full", BusKind::Can, 125'000U, "vcan0"));
  EXPECT_EQ(std::tuple(full.length_mm, full.impedance, full.capacitance), std::tuple(12'346U, 1'000U, 1'000U))
      << "to the nearest millimetre";
  EXPECT_TRUE(full.shielded && full.terminated);
  EXPECT_EQ(std::pair(full.port_place.line, full.port_place.column), std::pair(12U, 8U));
  EXPECT_EQ(std::pair(plant.buses[2].kind, plant.buses[2].baud), std::pair(BusKind::Rs485, 9'600U));
  EXPECT_EQ(std::pair(plant.buses[3].kind, plant.buses[3].baud), std::pair(BusKind::Rs232, 9'600U));
  EXPECT_EQ(plant.buses[3].length_mm, 1U);
  EXPECT_EQ(std::pair(plant.buses[4].kind, plant.buses[4].baud), std::pair(BusKind::Profibus, 500'000U));
  EXPECT_EQ(plant.buses[4].length_mm, 1'000'000'000U);
}

TEST(PlantFileValues, EveryRateOfEveryKind) {
  for (const auto& [kind, rates] : std::initializer_list<std::pair<const char*, std::vector<uint32_t>>>{
           {"can", {125'000, 250'000, 500'000, 1'000'000}},
           {"rs485", {9'600, 57'600}},
           {"rs232", {9'600}},
           {"profibus", {9'600, 19'200, 93'750, 187'500, 500'000, 1'500'000}}})
    for (const uint32_t baud : rates)
      EXPECT_EQ(read_plant(kPlainUnit + "[[bus]]\nname = 'b'\nkind = '" + kind +
                           "'\nbaud = " + std::to_string(baud) + "\n")
                    .buses.at(0)
                    .baud,
                baud)
          << kind;
}

TEST(PlantFileValues, OfAStation) {
  const StationConfig station = read_plant(R"([[bus]]
name = 'a'
kind = 'can'
[[bus]]
name = 'b'
kind = 'can'
[[bus]]
name = 'r'
kind = 'rs485'
[[bus]]
name = 'x'
kind = 'rs485'
[[station]]
name = 'u'
unit = 'mdxb'
firmware = 10
start_up = '60s'
program = 'P.IPC'
sbus = 'a'
sbus2 = 'b'
rs485 = 'r'
rs485_xt = 'x'
s13 = true
nvram = 'u.nv'
device = 'MCH42A'
terminator = false
branch = true
hex = ['x', 'H5']
[station.parameters]
P813 = 1
8603 = 2
P130 = '2.5 s'
P100 = 'SBus'
[station.inputs]
DI00 = 1
DI03 = true
DI17 = 0
DI16 = false
[station.analog]
AI1 = '5 V'
AI2 = '12 mA'
frequency = '5 kHz'
potentiometer = '50 %'
[station.load]
inertia = 100000
friction = 0.0006
torque = -12.3456
brake = false
braking_resistor = false
)")
                                    .stations.at(0);
  EXPECT_EQ(station.unit->name, "mdxb");
  EXPECT_EQ(station.options.firmware, 10);
  EXPECT_EQ(station.options.start_up_ms, 60'000U);
  EXPECT_EQ(std::tuple(station.name, station.program, station.sbus, station.sbus2),
            std::tuple("u", "P.IPC", "a", "b"));
  EXPECT_EQ(std::tuple(station.serial.x13.bus, station.serial.xt.bus, station.nvram, station.device),
            std::tuple("r", "x", "u.nv", "MCH42A"));
  EXPECT_EQ(std::tuple(station.serial.s13, station.serial.keypad, station.serial.uss21a, station.branch),
            std::tuple(true, false, false, true));
  EXPECT_EQ(station.terminator, false);
  EXPECT_EQ(station.hex, (std::vector<std::string>{"x", "H5"}));
  EXPECT_EQ(std::tuple(station.place.line, station.program_place.line, station.nvram_place.line,
                       station.serial.s13_place.line, station.serial.xt.place.line),
            std::tuple(13U, 18U, 24U, 23U, 22U));
  // In the order in which they stand, whatever their names: it is the order in which they are written.
  const std::vector<std::pair<std::string, int32_t>> expected = {
      {"P813", 1}, {"8603", 2}, {"P130", 2'500}, {"P100", 10}};
  ASSERT_EQ(station.parameters.size(), expected.size());
  for (size_t n = 0; n < expected.size(); ++n)
    EXPECT_EQ(std::pair(station.parameters[n].parameter, station.parameters[n].value), expected[n]);
  EXPECT_EQ(station.parameters[1].place.line, 31U);
  uint32_t given = 0, high = 0;
  for (const InputSetting& input : station.inputs) {
    given |= 1U << input.input;
    high |= (input.level ? 1U : 0U) << input.input;
  }
  EXPECT_EQ(given, 0xC009U);
  EXPECT_EQ(high, 0x0009U);
  EXPECT_EQ(station.analog.ai1, (AnalogInputs::Signal{5'000, 0}));
  EXPECT_EQ(station.analog.ai2, (AnalogInputs::Signal{0, 12'000}));
  EXPECT_EQ(std::pair(station.analog.frequency, station.analog.potentiometer), std::pair(5'000, 500));
  const MachineData& machine = station.machine;
  EXPECT_EQ(std::tuple(machine.inertia, machine.friction, machine.load_torque),
            std::tuple(100'000, 1, -12'346));
  EXPECT_FALSE(machine.brake || machine.braking_resistor);
}

TEST(PlantFileValues, DefaultsOfAStation) {
  const StationConfig station = read_plant(kPlainUnit).stations.at(0);
  EXPECT_EQ(station.options.start_up_ms, 0U);
  EXPECT_EQ(std::tuple(station.program, station.sbus, station.sbus2, station.nvram, station.device),
            std::tuple("", "", "", "", ""));
  EXPECT_EQ(std::tuple(station.serial.x13.bus, station.serial.xt.bus), std::tuple("", ""));
  EXPECT_FALSE(station.serial.s13 || station.serial.keypad || station.serial.uss21a || station.branch);
  EXPECT_EQ(station.serial.s13_place.line, 0U);
  EXPECT_FALSE(station.terminator.has_value());
  EXPECT_EQ(station.analog, AnalogInputs());
  EXPECT_EQ(std::tuple(station.machine.inertia, station.machine.friction, station.machine.load_torque),
            std::tuple(400, 5'000, 0));
  EXPECT_TRUE(station.machine.brake && station.machine.braking_resistor);
  EXPECT_TRUE(station.parameters.empty() && station.inputs.empty() && station.hex.empty());
}

TEST(PlantFileValues, VariantsOfUnits) {
  const auto read = [](const std::string& more) {
    return read_plant("[[bus]]\nname = 'r'\nkind = 'rs485'\n[[station]]\nname = 'u'\n" + more).stations.at(0);
  };
  EXPECT_TRUE(read("unit = 'mc07'\n").options.logodrive);
  EXPECT_TRUE(read("unit = 'mc07'\nlogodrive = true\nprogram = 'P'\n").options.logodrive);
  EXPECT_FALSE(read("unit = 'mc07'\nlogodrive = false\n").options.logodrive);
  const auto cards = [&](const std::string& line) {
    const DriveOptions options = read("unit = 'md60a'\n" + line).options;
    return std::tuple(options.drs, options.dio, options.aio);
  };
  EXPECT_EQ(cards(""), std::tuple(true, true, true));
  EXPECT_EQ(cards("cards = []\n"), std::tuple(false, false, false));
  EXPECT_EQ(cards("cards = ['DIO']\n"), std::tuple(false, true, false));
  EXPECT_EQ(cards("cards = ['AIO', 'DRS']\n"), std::tuple(true, false, true));
  EXPECT_EQ(read("unit = 'mc07'\nfirmware = 99\nstart_up = '1500us'\n").options.firmware, 99);
  EXPECT_EQ(read("unit = 'mc07'\nstart_up = '1999us'\n").options.start_up_ms, 1U);
  EXPECT_TRUE(read("unit = 'md60a'\nkeypad = true\n").serial.keypad);
  const SerialConfig serial = read("unit = 'md60a'\nuss21a = true\nrs485_xt = 'r'\n").serial;
  EXPECT_TRUE(serial.uss21a);
  EXPECT_EQ(std::pair(serial.uss21a_place.line, serial.uss21a_place.column), std::pair(7U, 10U));
  EXPECT_EQ(read("unit = 'mdxb'\nterminator = true\n").terminator, true);
}

}  // namespace
}  // namespace ipos::runtime

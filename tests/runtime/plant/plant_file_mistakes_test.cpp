// Every mistake of the sections of buses and stations is told once, at its place, and with what would be right.
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;
using tests::without_marks;

const std::string kMistakenUnit = "[[station]]\nname = 'u'\nunit = 'mdxb'\n";

TEST(PlantFileMistakes, OfTheForms) {
  expect_mistakes(kMistakenUnit,
                  {
                      {"^colour = 1\n", "unknown key 'colour' in [[station]]; known are name, unit"},
                      {"^sbus3 = 1\n^rs486 = 1\n", "unknown key"},
                      {"program = ^5\n", "program must be a text in quotes"},
                      {"terminator = ^1\n", "terminator is true or false"},
                      {"branch = ^'true'\n", "branch is true or false"},
                      {"firmware = ^2.5\n", "firmware must be a whole number"},
                      {"start_up = ^'soon'\n", "'soon' is no time; write for example 500ms or 1.5s"},
                      {"start_up = ^'1'\n", "'1' is no time"},
                      {"start_up = ^10\n", "start_up must be a text in quotes"},
                      {"parameters = ^5\n", "write [station.parameters]"},
                      {"inputs = ^'DI00'\n", "write [station.inputs]"},
                      {"analog = ^[ ]\n", "write [station.analog]"},
                      {"load = ^5\n", "write [station.load]"},
                  });
  // Of the root: keys, and sections that are no list of tables.
  expect_mistakes("",
                  {{"^car = 1\n",
                    "unknown key 'car' in the plant; known are bus, station, control, fault, "
                    "stimulus, wire, switch, machine, seed, expect"},
                   {"bus = ^5\n", "write [[bus]], one for each"},
                   {"bus = [ ^5 ]\n", "write [[bus]], one for each"},
                   {"^[bus]\nname = 'b'\nkind = 'can'\n", "write [[bus]], one for each"},
                   {"stimulus = ^5\n", "write [[stimulus]], one for each"},
                   {"control = [ { name = 'c', sbus = 'b' }, ^5 ]\n[[bus]]\nname = 'b'\nkind = 'can'\n",
                    "write [[control]], one for each"},
                   {"name = ^sbus\n", "a value is a number, true, false, a list, or a text in quotes"}},
                  kMistakenUnit);
  expect_mistakes("", {{"^", "the plant has no [[station]]"}, {"^[[bus]]\nkind = 'can'\n", "needs name"}});
  // Nothing but the first mistake of a text that is no TOML.
  expect_mistakes("", {{"a = 1\na = ^2\n", "redefine"}, {"car = 1\nb = \"x^\n", ""}});
}

TEST(PlantFileMistakes, OfEncoders) {
  const std::string master = "[[station]]\nname = 'm'\nunit = 'mc07'\n";
  const auto begin = [&](const char* unit) { return master + "[[station]]\nname = 'u'\nunit = '" + unit + "'\n[station.encoders]\n"; };
  const PlantFile plant = read_plant(begin("md60a") + "X42 = 'm'\nX14 = 'm'\n");
  ASSERT_EQ(plant.stations.at(1).encoders.size(), 2U);
  EXPECT_EQ(plant.stations.at(1).encoders[0].socket, EncoderSocket::X14);
  EXPECT_EQ(plant.stations.at(1).encoders[1].shaft, "m");
  EXPECT_TRUE(plant.stations.at(1).options.master_encoder);
  EXPECT_FALSE(read_plant(begin("compact") + "X14 = 'm'\n").stations.at(1).options.master_encoder);
  expect_mistakes(begin("mdxb"), {{"^X15 = 'm'\n", "unknown key 'X15' in [station.encoders]; known are X14, X42"},
                                  {"X14 = ^1\n", "X14 must be a text in quotes"},
                                  {"X14 = ^''\n", "X14 must not be empty"},
                                  {"X42 = ^'u'\n", "X42 takes the shaft of another station"},
                                  {"X42 = ^'n'\n", "there is no station 'n'"}});
  expect_mistakes(begin("compact"), {{"X42 = ^'m'\n", "X42 is of md60a, mdxb; unit compact has no such socket"}});
  expect_mistakes(begin("mc07"), {{"X14 = ^'m'\n", "unit mc07 has no such socket"}});
}

TEST(PlantFileMistakes, NumbersHave32Bits) {
  const std::string begin =
      kMistakenUnit + "[[expect]]\nstation = 'u'\nat = '1ms'\nvariable = 'x'\nequals = ";
  expect_mistakes(begin, {{"^4294967296\n", "equals = 4294967296 does not fit into 32 bits"},
                          {"^-2147483649\n", "equals = -2147483649 does not fit into 32 bits"},
                          {"^1.0\n", "equals must be a whole number; decimals are for signal = \"...\""},
                          {"^true\n", "equals must be a whole number"}});
  for (const auto& [text, number] :
       {std::pair("0xFFFFFFFF", -1), std::pair("4294967295", -1), std::pair("-2147483648", INT32_MIN),
        std::pair("2147483647", INT32_MAX), std::pair("2147483648", INT32_MIN), std::pair("-1", -1)})
    EXPECT_EQ(read_plant(begin + text).expectations.at(0).equals, number) << text;
}

TEST(PlantFileMistakes, OfABus) {
  const std::string begin = kMistakenUnit + "[[bus]]\nname = 'b'\n";
  expect_mistakes(
      begin,
      {
          {"kind = ^'can2'\n", "'can2' is no kind of bus; known are can, rs485, rs232, profibus"},
          {"kind = 'can'\nbaud = ^9600\n", "the SBus has 125000, 250000, 500000 or 1000000 baud, not 9600"},
          {"kind = 'rs485'\nbaud = ^19200\n", "RS-485 has 9600 or 57600 baud, not 19200"},
          {"kind = 'rs232'\nbaud = ^57600\n", "RS-232 has 9600 baud, not 57600"},
          {"kind = 'profibus'\nbaud = ^12000000\n",
           "PROFIBUS has 9600, 19200, 93750, 187500, 500000 or 1500000 baud, not 12000000"},
          {"kind = 'can'\nbaud = ^'500000'\n", "baud must be a whole number"},
          {"kind = 'can'\nimpedance = ^1001\n", "impedance is 0 to 1000"},
          {"kind = 'can'\nimpedance = ^-1\n", "impedance is 0 to 1000"},
          {"kind = 'can'\ncapacitance = ^1001\n", "capacitance is 0 to 1000"},
          {"kind = 'can'\nshielded = ^0\n", "shielded is true or false"},
          {"kind = 'can'\nterminated = ^0\n", "terminated is true or false"},
          {"kind = 'can'\nlength = ^0\n", "length is the length of the line in metres"},
          {"kind = 'can'\nlength = ^-1\n", "length of the line"},
          {"kind = 'can'\nlength = ^1000001\n", "length of the line"},
          {"kind = 'can'\nlength = ^'5 m'\n", "length of the line"},
          {"kind = 'can'\nport = ^5\n", "port must be a text in quotes"},
          {"kind = 'can'\n^[[bus]]\nname = 'b'\nkind = 'can'\n", "there are two of bus 'b'"},
          {"kind = 'can'\nport = 'p'\n[[bus]]\nname = 'c'\nkind = 'can'\nport = ^'p'\n",
           "there are two of port 'p'"},
          {"kind = 'can'\n^wire = 1\n", "unknown key 'wire' in [[bus]]"},
      });
  expect_mistakes(kMistakenUnit, {{"^[[bus]]\nkind = 'can'\n", "a [[bus]] needs name = "},
                                  {"^[[bus]]\nname = 'b'\n", "a [[bus]] needs kind = "}});
}

TEST(PlantFileMistakes, OfAStation) {
  const std::string begin =
      "[[bus]]\nname = 'b'\nkind = 'can'\n[[bus]]\nname = 'c'\nkind = 'can'\n" + kMistakenUnit;
  expect_mistakes(begin, {
                             {"firmware = ^9\n", "firmware is a version of two digits, 10..99"},
                             {"firmware = ^100\n", "10..99"},
                             {"start_up = ^'60001ms'\n", "start_up is at most 60s"},
                             {"clock_ppm = ^10001\n", "clock_ppm is -10000..10000"},
                             {"clock_ppm = ^'100'\n", "clock_ppm must be"},
                             {"logodrive = ^true\n", "logodrive is of mc07; unit mdxb has no such variants"},
                             {"cards = ^'DRS'\n", "cards is a list of DRS, DIO and AIO"},
                             {"cards = [ 'DIO', ^'DRS11' ]\n", "cards is a list of DRS, DIO and AIO"},
                             {"cards = [ ^5 ]\n", "cards is a list of DRS, DIO and AIO"},
                             {"sbus = ^'a'\n", "there is no bus 'a'"},
                             {"sbus2 = ^'a'\n", "there is no bus 'a'"},
                             {"rs485 = ^'b'\n", "bus 'b' is an SBus, not a serial line"},
                             {"rs485_xt = ^'b'\n", "bus 'b' is an SBus, not a serial line"},
                             {"nvram = 'n'\n[[station]]\nname = 'v'\nunit = 'mdxb'\nnvram = ^'n'\n",
                              "two stations keep their memory in 'n'"},
                             {"^[[station]]\nname = 'u'\nunit = 'mdxb'\n", "there are two of station 'u'"},
                             {"hex = ^'x'\n", "hex must be a list of variable names"},
                             {"hex = [ 'x', ^5 ]\n", "hex must be"},
                             {"hex = [ ^'' ]\n", "hex must be a list of variable names"},
                             {"hex = [ 'x', ^'', 'y', ^true ]\n", "hex must be a list of variable names"},
                         });
  expect_mistakes(
      "", {{"^[[station]]\nname = 'u'\n", "a [[station]] needs unit"},
           {"^[[station]]\nunit = 'mdxb'\n", "a [[station]] needs name"},
           {"[[station]]\nname = 'u'\nunit = ^'mdx'\n",
            "'mdx' is no unit type; known are md60a, compact, mc07, mdxb, mc31, mc07b, gateway"},
           {"[[station]]\nname = 'u'\nunit = 'mc31'\nprogram = ^'P'\n", "unit type mc31 runs no program"},
           {"[[station]]\nname = 'u'\nunit = 'mc07'\nlogodrive = false\nprogram = ^'P'\n",
            "a standard MOVITRAC 07 (logodrive = false) is a slave only and runs no program"},
           {"[[station]]\nname = 'u'\nunit = 'md60a'\nlogodrive = ^false\n", "logodrive is of mc07"},
           {"[[station]]\nname = 'v'\nunit = 'md60a'\n[[station]]\nname = 'u'\nunit = 'md60a'\ncards = []\n[station.encoders]\nX42 = ^'v'\n",
            "X42 is of the card DRS, which cards does not name"},
           {"[[station]]\nname = 'u'\nunit = 'compact'\ncards = ^[]\n", "unit compact takes none of these option cards"},
           {"[[station]]\nname = 'u'\nunit = 'mc07'\ncards = ^[ 'DRS' ]\n", "unit mc07 takes none"}});
  for (const std::string unit : {"md60a", "compact", "mc07", "mc31"})
    expect_mistakes("[[bus]]\nname = 'b'\nkind = 'can'\n[[station]]\nname = 'u'\n",
                    {{"unit = '" + unit + "'\nsbus2 = ^'b'\n", "unit " + unit + " has no SBus 2"}});
}

TEST(PlantFileMistakes, OfValuesOfAStation) {
  expect_mistakes(
      kMistakenUnit,
      {
          {"[station.parameters]\nP130 = ^'2.5 rpm'\n", "P130 Ramp t11 UP CW = \"2.5 rpm\": "},
          {"[station.parameters]\nP130 = ^2.5\n",
           "P130 must be a text as it is shown, \"2.5\", or the whole number that is transferred, 2500"},
          {"[station.parameters]\nP751 = ^0.5\n",
           "P751 must be a text as it is shown, \"0.5\", or the whole number that is transferred, 500"},
          {"[station.parameters]\nP130 = ^2.55555\n",
           "P130 must be a text as it is shown, \"2.55555\", or the whole number that is transferred"},
          {"[station.parameters]\nP816 = ^1.0\n",
           "P816 must be a text as it is shown, \"1\", or the whole number that is transferred, 1"},
          {"[station.inputs]\n^DI08 = 1\n", "'DI08' is no input; inputs are DI00..DI07 and DI10..DI17"},
          {"[station.inputs]\n^DI08 = true\n", "'DI08' is no input"},
          {"[station.inputs]\nDI00 = ^2\n", "DI00 is 0 or 1"},
          {"[station.inputs]\nDI00 = ^-1\n", "DI00 is 0 or 1"},
          {"[station.inputs]\nDI00 = ^'1'\n", "DI00 must be a whole number"},
          {"[station.analog]\n^AI3 = '5 V'\n",
           "'AI3' is no analog input; known are AI1, AI2, frequency, potentiometer"},
          {"[station.analog]\nAI1 = ^'11 V'\n", "AI1 needs a text such as \"5 V\""},
          {"[station.analog]\nAI1 = ^5\n", "AI1 needs a text"},
          {"[station.load]\n^mass = 1\n", "unknown key 'mass' in [station.load]"},
          {"[station.load]\ninertia = ^100001\n", "inertia is 0 to 100000 %"},
          {"[station.load]\ninertia = ^-1\n", "inertia is 0 to 100000 %"},
          {"[station.load]\nfriction = ^1000.1\n", "friction is 0 to 1000 %"},
          {"[station.load]\nfriction = ^-0.1\n", "friction is 0 to 1000 %"},
          {"[station.load]\ntorque = ^1000.1\n", "torque is -1000 to 1000 %"},
          {"[station.load]\ntorque = ^-1000.1\n", "torque is -1000 to 1000 %"},
          {"[station.load]\ninertia = ^nan\n", "inertia is 0 to 100000 %"},
          {"[station.load]\ninertia = ^'400'\n", "inertia must be a number, in %"},
          {"[station.load]\ninertia = ^true\n", "inertia must be a number, in %"},
          {"[station.load]\nbrake = ^1\n", "brake is true or false"},
          {"[station.load]\nbraking_resistor = ^1\n", "braking_resistor is true or false"},
      });
  // A parameter that the unit has not is refused by the unit itself, not by the file.
  EXPECT_EQ(read_plant(kMistakenUnit + "[station.parameters]\nP999 = '5'\n").stations[0].parameters.size(),
            1U);
}

// For an editor: what may stand there instead.
TEST(PlantFileMistakes, SayWhatIsAllowed) {
  const struct {
    const char* text;
    std::vector<std::string> each;
    int64_t least, most;
    const char* unit;
  } rows[] = {
      {"firmware = 100\n", {}, 10, 99, ""},
      {"branch = 1\n", {"true", "false"}, 0, 0, ""},
      {"[station.inputs]\nDI00 = 2\n", {"0", "1", "true", "false"}, 0, 0, ""},
      {"[station.load]\ntorque = 1001\n", {}, -1000, 1000, "%"},
      {"profibus_address = 128\n", {}, 0, 127, ""},
      {"[[bus]]\nname = 'b'\nkind = 'rs485'\nbaud = 1\n", {"9600", "57600"}, 0, 0, ""},
      {"[[control]]\nname = 'c'\nkind = 'canopen'\nsbus = 'b'\n[[control.target]]\naddress = 128\n",
       {},
       1,
       127,
       ""},
  };
  for (const auto& row : rows) {
    const PlantFileResult result = read_plant_file(kMistakenUnit + row.text);
    const auto with = std::find_if(result.errors.begin(), result.errors.end(),
                                   [](const PlantError& error) { return error.allowed.has_value(); });
    ASSERT_NE(with, result.errors.end()) << row.text;
    EXPECT_EQ(with->allowed->each, row.each) << row.text;
    EXPECT_EQ(with->allowed->least, row.least) << row.text;
    EXPECT_EQ(with->allowed->most, row.most) << row.text;
    EXPECT_EQ(with->allowed->unit, row.unit) << row.text;
  }
}

// What refers to each other is checked at the end, and still everything is told in the order of the file.
TEST(PlantFileMistakes, AreToldInTheOrderOfTheFile) {
  expect_mistakes(
      "", {{"[[wire]]\nfrom = ^'w.DO01'\nto = ^'v.DI00'\n" + kMistakenUnit +
                "sbus = ^'a'\n[[expect]]\nstation = ^'x'\nat = '1ms'\nstate = 'fault'\nequals = 0\n",
            "there is no "},
           {kMistakenUnit + "sbus2 = ^'a'\n[station.inputs]\nDI00 = ^2\n", ""},
           {"bus = [{ name = 'b', kind = 'can', impedance = ^-1, baud = ^1, length = ^-1}]\n" + kMistakenUnit,
            ""}});
}

}  // namespace
}  // namespace ipos::runtime

// [[fault]] of the plant file: what it says of lines arrives, and which keys belong to which kind.
#include "tests/runtime/plant/plant_file_texts.hpp"

namespace ipos::runtime {
namespace {

using tests::expect_mistakes;
using tests::read_plant;

const std::string kFaultPlant =
    "[[bus]]\nname = 'b'\nkind = 'can'\n[[bus]]\nname = 'p'\nkind = 'profibus'\n"
    "[[station]]\nname = 'u'\nunit = 'mdxb'\n";
const std::string kFaultOf = "[[fault]]\nbus = 'b'\nkind = ";
const std::string kFaultOfProfibus = "[[fault]]\nbus = 'p'\nkind = ";

FaultConfig first_fault(const std::string& text) { return read_plant(kFaultPlant + text).faults.at(0); }

TEST(PlantFileFaults, OfAnSbus) {
  const FaultConfig none = first_fault(kFaultOf + "'drop'\n");
  EXPECT_EQ(std::tuple(none.bus, none.station, none.place.line), std::tuple("b", "", 10U));
  EXPECT_FALSE(none.fault.id || none.octets || none.fault.behind);
  EXPECT_EQ(std::tuple(none.fault.kind, none.fault.from, none.fault.until),
            std::tuple(FaultKind::Drop, 0, kNever));
  EXPECT_EQ(std::tuple(none.fault.frame, none.fault.per_mille, none.fault.seed, none.fault.lag),
            std::tuple(0U, 1'000U, 1U, 0));
  const LineFault full = first_fault(kFaultOf +
                                     "'delay'\nstation = 'u'\nid = 0x1FFFFFFF\nrate = 10\nseed = 2147483647\n"
                                     "from = '1ms'\nuntil = '2ms'\ndelay = '3ms'\n")
                             .fault;
  EXPECT_EQ(std::tuple(full.kind, full.id, full.frame, full.per_mille, full.seed),
            std::tuple(FaultKind::Delay, 0x1FFF'FFFFU, 0U, 10U, 2'147'483'647U));
  EXPECT_EQ(std::tuple(full.from, full.until, full.lag),
            std::tuple(kMillisecond, 2 * kMillisecond, 3 * kMillisecond));
  EXPECT_EQ(first_fault(kFaultOf + "'drop'\nstation = 'u'\n").station, "u");
  EXPECT_EQ(first_fault(kFaultOf + "'drop'\nframe = 2147483647\n").fault.frame, 2'147'483'647U);
  EXPECT_EQ(first_fault(kFaultOf + "'drop'\nrate = 0\nid = 0\n").fault.per_mille, 0U);
  EXPECT_EQ(first_fault(kFaultOf + "'drop'\nid = 0\n").fault.id, 0U);
  EXPECT_EQ(first_fault(kFaultOf + "'drop'\nframe = 1\nuntil = '1us'\n").fault.until, kMicrosecond);
  const FaultConfig behind = first_fault(kFaultOf + "'cut'\nbehind = 'u'\n");
  EXPECT_TRUE(behind.fault.behind);
  EXPECT_EQ(behind.station, "u");
  const FaultConfig own = first_fault(kFaultOf + "'cut'\nstation = 'u'\n");
  EXPECT_FALSE(own.fault.behind);
  EXPECT_EQ(own.station, "u");
}

// The table of docs/guide/plant-file.md: whether a kind takes a station, must have one, and chooses frames.
TEST(PlantFileFaults, KeysOfEachKind) {
  const struct {
    std::string word;
    bool may_have_station, needs_station, chooses_frames;
  } rows[] = {
      {"corrupt", true, false, true}, {"terminator", false, false, true}, {"duplicate", false, false, true},
      {"drop", true, false, true},    {"delay", true, false, true},       {"cut", true, true, false},
      {"swap", true, true, false},    {"short", false, false, false},     {"stuck", false, false, false},
      {"length", false, false, true}, {"baud", true, true, false}};
  for (const auto& row : rows) {
    const std::string rest = row.word == "delay" ? "delay = '1ms'\n" : row.word == "baud" ? "baud = 250000\n" : "";
    const std::string begin = "[[fault]]\nbus = 'b'\nkind = '" + row.word + "'\n" + rest;
    const std::string station = row.needs_station ? "station = 'u'\n" : "";
    if (row.may_have_station)
      EXPECT_EQ(first_fault(begin + "station = 'u'\n").station, "u") << row.word;
    else
      expect_mistakes(kFaultPlant, {{"^" + begin + "station = 'u'\n",
                                     "a fault '" + row.word + "' concerns the whole line"}});
    if (row.needs_station)
      expect_mistakes(kFaultPlant, {{"^" + begin, "a fault '" + row.word + "' needs station"}});
    else
      EXPECT_EQ(first_fault(begin).station, "") << row.word;
    for (const std::string key : {"id", "frame", "rate", "seed"}) {
      if (row.chooses_frames)
        first_fault(begin + station + key + " = 5\n");
      else
        expect_mistakes(kFaultPlant, {{begin + station + key + " = ^5\n",
                                       key + " does not belong to a fault '" + row.word + "'"}});
    }
    if (row.may_have_station && row.word != "cut")
      expect_mistakes(kFaultPlant, {{begin + "behind = ^'u'\n", "behind belongs to kind = \"cut\""}});
    if (row.word != "delay")
      expect_mistakes(kFaultPlant, {{"^" + begin + station + "delay = '1ms'\n",
                                     "delay = ... belongs to kind = \"delay\""}});
  }
}

TEST(PlantFileFaults, MistakesOfAnSbus) {
  const std::string drop = kFaultOf + "'drop'\n";
  expect_mistakes(
      kFaultPlant,
      {
          {kFaultOf + "^'lost'\n",
           "'lost' is no fault; known are drop, corrupt, delay, duplicate, terminator, cut, swap, short, "
           "stuck, length, baud"},
          {"^[[fault]]\nbus = 'b'\n", "a [[fault]] needs kind"},
          {"^[[fault]]\nkind = 'drop'\n", "a [[fault]] needs bus"},
          {"[[fault]]\nbus = ^'x'\nkind = 'drop'\n", "there is no bus 'x'"},
          {drop + "^at = '1ms'\n", "unknown key 'at' in [[fault]]"},
          {drop + "station = ^'v'\n", "there is no station 'v'"},
          {drop + "id = ^0x20000000\n", "id is 0 to 536870911"},
          {drop + "frame = ^0\n", "frames are counted from 1"},
          {drop + "frame = ^2147483648\n", "frame is 0 to 2147483647"},
          {drop + "frame = ^-1\n", "frame is 0 to 2147483647"},
          {drop + "frame = ^'1'\n", "frame must be a whole number"},
          {drop + "rate = ^1001\n", "rate is 0 to 1000"},
          {drop + "seed = ^2147483648\n", "seed is 0 to 2147483647"},
          {drop + "frame = 1\nrate = ^1\n", "a fault strikes the n-th frame, or a rate of them: not both"},
          {"^" + drop + "from = '1ms'\nuntil = '1ms'\n", "until must be after from"},
          {"^" + drop + "until = '0ms'\n", "until must be after from"},
          {drop + "from = ^'x'\nuntil = '1ms'\n", "'x' is no time"},
          {drop + "from = '1ms'\nuntil = ^'x'\n", "'x' is no time"},
          {"^" + kFaultOf + "'delay'\n", "delay = ... belongs to kind = \"delay\", and there it must be"},
          {kFaultOf + "'cut'\nstation = 'u'\nbehind = ^'u'\n",
           "a cut is behind a station, or of the connection of one"},
      });
}

TEST(PlantFileFaults, OfAProfibusLine) {
  const FaultConfig none = first_fault(kFaultOfProfibus + "'lost'\n");
  EXPECT_EQ(std::tuple(none.bus, none.station), std::tuple("p", ""));
  ASSERT_TRUE(none.octets);
  const OctetFault& lost = *none.octets;
  EXPECT_EQ(std::tuple(lost.kind, lost.from, lost.until),
            std::tuple(OctetFaultKind::Lost, 0, kNever));
  EXPECT_EQ(std::tuple(lost.frame, lost.per_mille, lost.seed), std::tuple(0U, 1'000U, 1U));
  const FaultConfig full = first_fault(
      kFaultOfProfibus + "'noise'\nstation = 'u'\nrate = 5\nseed = 7\nfrom = '1ms'\nuntil = '2ms'\n");
  EXPECT_EQ(full.station, "u");
  EXPECT_EQ(std::tuple(full.octets->kind, full.octets->per_mille, full.octets->seed,
                       full.octets->from, full.octets->until),
            std::tuple(OctetFaultKind::Noise, 5U, 7U, kMillisecond, 2 * kMillisecond));
  EXPECT_EQ(first_fault(kFaultOfProfibus + "'cut'\nframe = 3\n").octets->frame, 3U);
  for (const std::string word : {"lost", "cut", "parity", "noise", "collision", "terminator", "length"})
    EXPECT_EQ(
        octet_fault_type(first_fault(kFaultOfProfibus + "'" + word + "'\n").octets->kind).word,
        word);
}

TEST(PlantFileFaults, MistakesOfAProfibusLine) {
  const std::string lost = kFaultOfProfibus + "'lost'\n";
  expect_mistakes(
      kFaultPlant,
      {
          {kFaultOfProfibus + "^'drop'\n", "'drop' is no fault of a PROFIBUS line; known are lost, cut"},
          {"^[[fault]]\nbus = 'p'\n", "a [[fault]] needs kind"},
          {lost + "^id = 5\n", "unknown key 'id' in [[fault]] of a PROFIBUS line"},
          {lost + "station = ^'v'\n", "there is no station 'v'"},
          {lost + "frame = ^0\n", "a fault strikes the n-th frame, counted from 1, or a rate of them"},
          {lost + "frame = ^2147483648\n", "frame is 0 to 2147483647"},
          {lost + "frame = ^-1\n", "frame is 0 to 2147483647"},
          {lost + "frame = ^'1'\n", "frame must be a whole number"},
          {lost + "frame = ^1\nrate = 1\n", "a fault strikes the n-th frame"},
          {lost + "rate = ^1001\n", "rate is 0 to 1000"},
          {lost + "seed = ^2147483648\n", "seed is 0 to 2147483647"},
          {"^" + lost + "from = '1ms'\nuntil = '1ms'\n", "until must be after from"},
          {"^" + lost + "until = '0ms'\n", "until must be after from"},
          {lost + "from = ^'x'\nuntil = '0ms'\n", "'x' is no time"},
          {lost + "until = ^'x'\n", "'x' is no time"},
      });
  EXPECT_EQ(first_fault(lost + "frame = 1\nfrom = '1ms'\nuntil = '1001us'\n").octets->until,
            1'001 * kMicrosecond);
}

TEST(PlantFileFaults, OfASerialLine) {
  const std::string plant =
      "[[bus]]\nname = 'r'\nkind = 'rs485'\n[[bus]]\nname = 't'\nkind = 'rs232'\n[[station]]\nname = 'u'\nunit = 'mdxb'\n";
  const std::string of_r = "[[fault]]\nbus = 'r'\nkind = ", of_t = "[[fault]]\nbus = 't'\nkind = ";
  for (const std::string word : {"lost", "cut", "parity", "noise", "collision", "terminator", "length", "swap", "baud"}) {
    const bool lasts = word == "swap" || word == "baud";
    const FaultConfig read = read_plant(plant + of_r + "'" + word + "'\nstation = 'u'\n" + (lasts ? "" : "rate = 5\n")).faults.at(0);
    ASSERT_TRUE(read.octets) << word;
    EXPECT_EQ(octet_fault_type(read.octets->kind).word, word);
  }
  expect_mistakes(plant, {
                             {of_r + "^'link'\n", "'link' is no fault of an RS-485 line; known are lost, cut, parity, noise, collision, swap, "
                                                  "terminator, length, baud"},
                             {of_t + "^'swap'\n", "'swap' is no fault of an RS-232 line; known are lost, cut, parity, noise, collision, "
                                                  "length, baud"},
                             {"^" + of_r + "'swap'\n", "a fault 'swap' needs station"},
                             {of_r + "'baud'\nstation = 'u'\nrate = ^1\n", "rate does not belong to a fault 'baud'"},
                             {of_r + "'noise'\n^id = 5\n", "unknown key 'id' in [[fault]] of an RS-485 line"},
                         });
}

// The tables of a text for a plant that is there already: buses, stations and controls have their names.
TEST(PlantFileFaults, OfATextForAPlant) {
  const PlantFile plant = read_plant(kFaultPlant + "[[control]]\nname = 'c'\nsbus = 'b'\n");
  const PlantFileResult good = read_fault_tables(
      kFaultOf + "'drop'\nstation = 'c'\n" + kFaultOfProfibus + "'lost'\nstation = 'u'\n", plant);
  EXPECT_TRUE(good.errors.empty());
  ASSERT_EQ(good.plant.faults.size(), 2U);
  EXPECT_EQ(good.plant.faults[0].station, "c");
  EXPECT_TRUE(good.plant.faults[1].octets);
  EXPECT_TRUE(good.plant.buses.empty() && good.plant.stations.empty() && good.plant.controls.empty());
  for (const auto& [text, message] :
       {std::pair(kFaultOf + "'drop'\nstation = 'v'\n", "there is no station 'v'"),
        std::pair(std::string("[[fault]]\nbus = 'x'\nkind = 'drop'\n"), "there is no bus 'x'"),
        std::pair(std::string("[[bus]]\nname = 'd'\nkind = 'can'\n"),
                  "unknown key 'bus' in the text; known are fault"),
        std::pair(std::string("fault = 5\n"), "write [[fault]], one for each"),
        std::pair(std::string("fault = \n"), "")}) {
    const PlantFileResult wrong = read_fault_tables(text, plant);
    ASSERT_EQ(wrong.errors.size(), 1U) << text;
    EXPECT_NE(wrong.errors[0].text.find(message), std::string::npos) << wrong.errors[0].text;
  }
}

// Counted from a later time, with a seed of its own; a fault without end stays so.
TEST(PlantFileFaults, BeginLater) {
  FaultConfig ended = first_fault(kFaultOf + "'drop'\nfrom = '1ms'\nuntil = '2ms'\nseed = 3\n");
  ended.begin_at(5 * kMillisecond, 4);
  EXPECT_EQ(std::tuple(ended.fault.from, ended.fault.until, ended.fault.seed),
            std::tuple(6 * kMillisecond, 7 * kMillisecond, 7U));
  FaultConfig endless = first_fault(kFaultOfProfibus + "'lost'\n");
  endless.begin_at(5 * kMillisecond, 0);
  EXPECT_EQ(std::tuple(endless.octets->from, endless.octets->until, endless.octets->seed),
            std::tuple(5 * kMillisecond, kNever, 1U));
}

}  // namespace
}  // namespace ipos::runtime

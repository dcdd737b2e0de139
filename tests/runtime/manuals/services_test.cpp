// The parameter services of a unit that is asked over its buses (1053 1610 chapters 4.3, 6.2 and 7, MOVITRAC 07 chapters 4.2, 7.2 and
// 10): every parameter of the lists, every service, every limit, in every state. What comes is computed from the cells of the lists.
#include <algorithm>

#include "tests/harness/proves.hpp"
#include "tests/runtime/drive/service_rules.hpp"
#include "tests/runtime/manuals/talk.hpp"

namespace ipos::tests {
namespace {

struct Reply {
  uint32_t code = kOk;
  int32_t value = 0;
};

constexpr uint16_t kOrders[] = {8596, 8617};  // P804, P840: carried out, then 0 again

// One unit at both buses. It is asked over SBus, about its SBus over RS-485 at the address that every unit answers.
class Asked {
 public:
  explicit Asked(const std::string& unit, const std::string& parameters = "", const std::string& keys = "",
                 const std::string& more = "")
      : talk_(can_bus() + serial_bus() +
              unit_on("sbus = \"sbus\"\n" + serial_key(unit) + keys, "u", unit, parameters, more)) {
    talk_.pass(20 * kMs);
  }
  Reply ask(int service, uint16_t index, int64_t value = 0) {
    const std::string channel =
        word_text(0x30 | service).substr(3) + " 00 " + word_text(index) + " " + value_text(value);
    return is_of_sbus(index) ? over_serial(channel) : over_sbus(channel);
  }
  int32_t read(uint16_t index) { return ask(1, index).value; }
  void power_cycle() {
    talk_.power("u", false);
    talk_.pass(2 * kMs);
    talk_.power("u", true);
    talk_.pass(4 * kMs);
  }
  Talk& talk() { return talk_; }

  // P813 to P819 and what is beside them; on MOVIDRIVE B P88x, P89x, too.
  static bool is_of_sbus(uint16_t index) {
    for (const auto& [first, last] : {std::pair{8600, 8606}, {8732, 8732}, {8932, 8939}, {8987, 8992}})
      if (index >= first && index <= last) return true;
    return false;
  }

 private:
  static std::string serial_key(const std::string& unit) {
    return unit == "compact" ? "rs485_xt = \"line\"\nuss21a = true\n" : "rs485 = \"line\"\n";
  }
  static Reply reply_of(const std::string& channel) {
    const Bytes bytes = bytes_of(channel);
    uint32_t data = 0;
    for (size_t n = 4; n < 8; ++n) data = data << 8 | bytes[n];
    return (bytes[0] & 0x80) != 0 ? Reply{data, 0} : Reply{kOk, static_cast<int32_t>(data)};
  }
  Reply over_sbus(const std::string& channel) {
    talk_.send("515 # " + channel);
    for (const int64_t until = talk_.now() + 20 * kMs; talk_.now() < until;) {
      EXPECT_EQ(ipos_plant_run_to_frame(talk_.plant(), talk_.bus("sbus"), until), IPOS_PLANT_OK);
      for (const HeardFrame& frame : talk_.heard())
        if (frame.text.starts_with("516 # ")) return reply_of(frame.text.substr(6));
    }
    ADD_FAILURE() << "no answer to " << channel;
    return {0xFFFF'FFFF, 0};
  }
  Reply over_serial(const std::string& channel) {
    const Texts answers = talk_.serial_ask("02 FE 86 " + channel);
    if (answers.size() == 1 && answers[0].starts_with("1D FE 86 ")) return reply_of(answers[0].substr(9));
    ADD_FAILURE() << "no answer to " << channel;
    return {0xFFFF'FFFF, 0};
  }

  Talk talk_;
};

bool is_order(uint16_t index) {
  return std::find(std::begin(kOrders), std::end(kOrders), index) != std::end(kOrders);
}

// Reads with the services of the list, then writes; every accepted write is read back and looked at again after power-on.
TEST(ServiceRows, EveryParameterEveryServiceEveryLimit) {
  PROVES("PAR-01", "PAR-02", "PAR-04", "PAR-05", "PAR-11", "PAR-14", "PAR-21", "PAR-39", "MLK-02",
         "M07-PAR-02", "M07-PAR-09", "M07-PAR-11");
  for (const UnitLists& unit : kUnits) {
    const bool m07 = std::string(unit.unit) == "mc07";
    Asked asked(
        unit.unit);  // no terminal is closed: MOVIDRIVE is inhibited, MOVITRAC 07 has no output stage on
    for (const auto& [index, p] : listed(unit.files, unit.option_cards)) {
      const auto where = [&, index = index](int service, int64_t value) {
        return std::string(unit.unit) + " index " + std::to_string(index) + " service " +
               std::to_string(service) + " value " + std::to_string(value);
      };
      const bool setting = p.has("RW");
      for (int service = 0; service <= 15; ++service) {
        if (service == 2 || service == 3 || service == 8) continue;
        const Expected want = expected_of(p, m07, service, 0);
        const Reply got = asked.ask(service, index);
        ASSERT_EQ(got.code, want.code) << where(service, 0);
        // A display has what the drive shows at the moment.
        if (service != 1 || setting) {
          ASSERT_EQ(got.value, want.code == kOk ? bits(want.value) : 0) << where(service, 0);
        }
      }
      // The last accepted one that differs from the factory setting is looked at after power-on, too.
      int64_t last = p.default_value;
      for (const int64_t value : probes(p))
        if (p.legal(value) && value != p.default_value) last = value;
      for (const int service : {3, 2})
        for (const int64_t value : probes(p)) {
          const Expected want = expected_of(p, m07, service, value);
          const Reply got = asked.ask(service, index, value);
          ASSERT_EQ(got.code, want.code) << where(service, value);
          ASSERT_EQ(got.value, want.code == kOk ? bits(want.value) : 0) << where(service, value);
          if (!setting || is_order(index)) continue;
          const bool wrote = want.code == kOk;
          ASSERT_EQ(asked.read(index), bits(wrote ? value : p.default_value)) << where(service, value);
          if (value != last) {
            ASSERT_EQ(asked.ask(service, index, p.default_value).code, kOk) << where(service, value);
            continue;
          }
          if (!wrote) continue;
          asked.power_cycle();
          const bool kept = service == 2 && p.has("N");
          ASSERT_EQ(asked.read(index), bits(kept ? value : p.default_value))
              << where(service, value) << ", power-on";
          if (!kept) continue;
          ASSERT_EQ(asked.ask(2, index, p.default_value).code, kOk) << where(service, p.default_value);
          asked.power_cycle();
        }
    }
  }
}

// Writes of the default in each state that a drive can have: inhibited, not enabled, enabled; locked; at its factory setting.
TEST(ServiceRows, EveryParameterInEveryState) {
  PROVES("PAR-12", "PAR-13", "PAR-16", "PAR-17", "M07-PAR-12", "M07-PAR-19");
  for (const UnitLists& unit : kUnits) {
    const bool m07 = std::string(unit.unit) == "mc07";
    const auto list = listed(unit.files, unit.option_cards);
    struct Way {
      int state;  // 0 inhibited, 1 no enable, 2 enabled; MOVITRAC 07 has no terminal that inhibits it
      bool locked, factory, cards;
    };
    // The factory setting is begun under inhibit.
    for (const Way way : {Way{0, false, false, true},
                          {1, false, false, true},
                          {2, false, false, true},
                          {0, true, false, true},
                          {1, true, false, true},
                          {2, true, false, true},
                          {0, false, true, true},
                          {0, false, false, false},
                          {0, true, false, false},
                          {2, true, false, false}}) {
      const auto& [state, locked, factory, cards] = way;
      if ((!cards && (!unit.option_cards || m07)) || (state == 1 && m07)) continue;
      std::string inputs = "[station.inputs]\n";
      if (state != 0 && !m07) inputs += "DI00 = 1\n";
      if (state == 2) inputs += "DI01 = 1\nDI03 = 1\n";
      Asked asked(unit.unit, "", cards ? "" : "cards = []\n", inputs);
      asked.talk().pass(500 * kMs);
      if (locked) {
        ASSERT_EQ(asked.ask(3, 8595, 1).code, kOk);
      }
      if (factory) {
        ASSERT_EQ(asked.ask(3, 8594, 1).code, kOk);
      }
      for (const auto& [index, p] : list) {
        if (index == 8595 || index == 8594) continue;  // the lock and the order, which the test itself needs
        if (factory && Asked::is_of_sbus(index))
          continue;  // over the slow line the factory setting ends before
        uint32_t want = kOk;
        if (!p.has("RW"))
          want = refusal(0x12);
        else if (factory)
          want = refusal(0x14);
        else if (!cards && !p.cells.at("option").empty())
          want = refusal(0x17);
        else if (locked && !p.has("S"))
          want = refusal(0x13);
        else if (state != 0 && p.has("R"))
          want = refusal(0x1C);
        else if (state == 2 && p.has("E"))
          want = refusal(0x20);
        ASSERT_EQ(asked.ask(3, index, p.default_value).code, want)
            << unit.unit << " index " << index << " state " << state << " locked " << locked << " factory "
            << factory << " cards " << cards;
      }
    }
  }
}

TEST(ServiceRows, AttributesWalkTheList) {
  PROVES("PAR-06");
  for (const UnitLists& unit : kUnits) {
    Asked asked(unit.unit);
    if (std::string(unit.unit) == "mc07") continue;  // its manual has no next index to walk by
    int index = 8300;
    for (const auto& [listed_index, p] : listed(unit.files, unit.option_cards)) {
      ASSERT_EQ(index, listed_index) << unit.unit;
      const Reply reply = asked.ask(8, static_cast<uint16_t>(index));
      ASSERT_EQ(reply.code, kOk);
      EXPECT_EQ(reply.value & 1, p.has("RW") ? 1 : 0) << index;
      index = static_cast<int>(static_cast<uint32_t>(reply.value) >> 16);
    }
    EXPECT_EQ(index, 0) << "the last index has no next one";
  }
}

// Indices by area: a value, or 10h outside of the areas, or 11h in a gap of one.
TEST(ServiceRows, IndicesByArea) {
  PROVES("PAR-07", "PAR-15", "M07-PAR-16");
  for (const UnitLists& unit : kUnits) {
    const auto list = listed(unit.files, unit.option_cards);
    const IndexAreas areas = index_areas(unit);
    Asked asked(unit.unit);
    std::set<int> asked_for;
    for (int index = 8192; index <= 9600; ++index) asked_for.insert(index);
    for (int index = 0; index <= 0xFFFF; index += 97) asked_for.insert(index);
    for (const auto& all : {areas.windows, areas.parameters})
      for (const Area& area : all)
        for (const int edge : {area.first, area.first + area.count})
          for (int index = edge - 2; index <= edge + 1; ++index) asked_for.insert(index);
    for (const int edge : {8191, 8192, 24'575, 24'576, 0, 0xFFFF}) asked_for.insert(edge);
    for (const int index : asked_for) {
      const bool is_there = list.contains(static_cast<uint16_t>(index)) || IndexAreas::any(areas.windows, index);
      const uint32_t want = is_there ? kOk : refusal(IndexAreas::any(areas.parameters, index) ? 0x11 : 0x10);
      ASSERT_EQ(asked.ask(1, static_cast<uint16_t>(index)).code, want) << unit.unit << " index " << index;
    }
  }
}

// Displays that are kept keep their count over power-off, the others begin at 0.
TEST(ServiceRows, CountersSurviveDisplaysDoNot) {
  PROVES("PAR-10", "PAR-25");
  Asked asked("md60a", "P100 = 10\nP101 = 3\n", "", kEnabled);
  for (int n = 0; n < 400; ++n) asked.talk().ask("3 # 00 06 13 88 00 00", 10 * kMs);
  EXPECT_EQ(asked.read(8318), 1'000'000);
  asked.talk().run_to(7'200'000 * kMs);
  EXPECT_EQ(asked.read(8328), 120) << "two hours of mains, in minutes";
  asked.power_cycle();
  EXPECT_EQ(asked.read(8328), 120);
  EXPECT_EQ(asked.read(8318), 0);
  // Quantity 4, conversion 70: minutes; energy in 1E5 Ws, 36 of them a kWh.
  EXPECT_EQ(asked.ask(7, 8328).value, 4 * 256 + 70);
  EXPECT_EQ(asked.ask(7, 8330).value, 8 * 256 + 5);
  char text[40];
  EXPECT_EQ(ipos_plant_parameter_text("md60a", 8330, 36, text, sizeof text), IPOS_PLANT_OK);
  EXPECT_EQ(std::string(text).substr(0, 2), "1.") << text;
  EXPECT_NE(std::string(text).find("kWh"), std::string::npos) << text;
  EXPECT_EQ(ipos_plant_parameter_text("md60a", 8328, 90, text, sizeof text), IPOS_PLANT_OK);
  EXPECT_EQ(std::string(text).substr(0, 3), "1.5") << text;
}

TEST(ServiceRows, PrintedDefaultsAndLimits) {
  PROVES("PAR-30", "PAR-31", "PAR-32", "PAR-34", "PAR-35");
  Asked asked("md60a");
  for (const PrintedRow& row : kPrintedRows) {
    EXPECT_EQ(asked.read(row.index), row.default_value) << row.index;
    EXPECT_EQ(asked.ask(6, row.index).value, row.default_value) << row.index;
    EXPECT_EQ(asked.ask(4, row.index).value, row.minimum) << row.index;
    EXPECT_EQ(asked.ask(5, row.index).value, row.maximum) << row.index;
    EXPECT_EQ(asked.ask(2, row.index, row.maximum + 1).code, refusal(0x15)) << row.index;
  }
  EXPECT_EQ(asked.ask(2, 8602, 105).code, refusal(0x1D)) << "steps of 10 ms";
  EXPECT_EQ(asked.ask(2, 8602, 110).code, kOk);
  for (const auto& [index, last] : {std::pair{8609, 7}, {8304, 12}, {8307, 11}, {8461, 10}, {8462, 3}})
    for (int32_t code = 0; code <= last; ++code)
      EXPECT_EQ(asked.ask(2, static_cast<uint16_t>(index), code).code, kOk) << index;
}

TEST(ServiceRows, ViewsAndDoubtfulRows) {
  PROVES("PAR-27", "PAR-29", "PAR-26", "M07-PAR-27");
  Asked asked("md60a", "", "", "[station.inputs]\nDI02 = 1\n");
  for (const auto& [view, setting, count] :
       {std::tuple{31, 600, 5}, std::tuple{40, 610, 8}, std::tuple{51, 620, 2}, std::tuple{60, 630, 8}})
    for (int n = 0; n < count; ++n) {
      const auto index_of = [](const std::string& number) {
        uint16_t index = 0;
        EXPECT_EQ(ipos_plant_parameter_index("md60a", number.c_str(), &index), IPOS_PLANT_OK) << number;
        return index;
      };
      EXPECT_EQ(index_of("P0" + std::to_string(view + n)), index_of("P" + std::to_string(setting + n)));
    }
  EXPECT_EQ(asked.ask(2, 8335, 9).code, kOk);  // P600
  EXPECT_EQ(asked.talk().value("u", "P031"), 9);
  EXPECT_EQ(asked.ask(2, 8334, 1).code, refusal(0x12));
  EXPECT_EQ(asked.read(8334), 0b100);
  asked.talk().set("u", "DI00", 1);
  asked.talk().pass(5 * kMs);
  EXPECT_EQ(asked.read(8334), 0b101);
  EXPECT_EQ(asked.ask(6, 8891).value, 0);
  EXPECT_EQ(asked.ask(1, 8840).code, refusal(0x11));
  EXPECT_EQ(asked.ask(6, 8772).value, 0x696D'2F31) << "1/mi";
  Asked m07("mc07");
  EXPECT_EQ(m07.read(0x2267), 2000);
  for (const uint16_t older : std::initializer_list<uint16_t>{0x2116, 0x2117, 0x2126})
    EXPECT_EQ(m07.ask(1, older).code, refusal(0x10)) << older;
}

TEST(ServiceRows, FreshMovitrac07) {
  PROVES("M07-PD-15", "M07-PD-16", "M07-SETP-03", "M07-PAR-29", "M07-PAR-31", "M07-PAR-34", "M07-MON-02");
  const std::pair<uint16_t, int32_t> printed[] = {
      {8304, 9},       {8305, 1},      {8306, 0},       {8307, 6},      {8308, 1},      {8309, 2},
      {8489, 150000},  {8490, 750000}, {8491, 1500000}, {8492, 150000}, {8493, 750000}, {8494, 1500000},
      {8518, 150000},  {8523, 1},      {8524, 0},       {8525, 0},      {8526, 100},    {8527, 0},
      {8602, 0},       {8350, 1},      {8351, 5},       {0x2267, 2000}, {0x2268, 2000}, {0x2269, 20000},
      {8517, 1500000}, {8637, 0}};
  Asked asked("mc07");
  for (const auto& [index, value] : printed) EXPECT_EQ(asked.read(index), value) << index;
  // P931 and P932 are printed without an index.
  uint16_t index = 0;
  for (const char* number : {"P931", "P932"})
    EXPECT_EQ(ipos_plant_parameter_index("mc07", number, &index), IPOS_PLANT_NO_SIGNAL);
  EXPECT_EQ(asked.ask(1, 0).code, refusal(0x10));
}

TEST(ServiceRows, CodesOfMovitrac07) {
  PROVES("M07-PD-12", "M07-PD-13", "M07-PD-14", "M07-CW-27", "M07-SETP-01", "M07-PAR-28", "M07-PAR-33");
  const struct {
    uint16_t index;
    std::vector<int32_t> accepted, refused;
    int32_t fresh;
  } rows[] = {{8304, {0, 1, 5, 8, 9, 10, 11, 12, 13}, {2, 3, 4, 6, 7, 14}, 9},
              {8307, {0, 1, 2, 3, 6, 8, 9, 10}, {4, 5, 7, 11}, 6},
              {8462, {0, 1, 3, 4}, {2, 5}, 0},
              {8461, {1, 2, 4, 6, 7, 10, 11}, {0, 3, 5, 8, 9, 12}, 1},
              {8336, {0, 1, 2, 3, 4, 5, 6, 9, 10, 11, 12, 16, 20, 32}, {7, 26, 33}, 3},
              {8337, {}, {26}, 1},
              {8338, {}, {26}, 4},
              {8609, {2, 4}, {3}, 4},
              {8620, {0, 1, 2, 3}, {4}, 0},
              {8597, {0, 99}, {100}, 0},
              {8598, {100, 199}, {99, 200}, 100},
              {8599, {0, 650000}, {650010, 5}, 0}};
  Asked fresh("mc07"), inhibited("mc07");
  for (const auto& row : rows) {
    EXPECT_EQ(fresh.read(row.index), row.fresh) << row.index;
    for (const int32_t code : row.accepted)
      EXPECT_EQ(inhibited.ask(3, row.index, code).code, kOk) << row.index << ' ' << code;
    EXPECT_EQ(inhibited.ask(3, row.index, row.fresh).code, kOk);
    for (const int32_t code : row.refused) {
      const uint32_t refused = inhibited.ask(3, row.index, code).code;
      EXPECT_TRUE(refused == refusal(0x15) || refused == refusal(0x16) || refused == refusal(0x1D))
          << row.index << ' ' << code;
    }
  }
  EXPECT_EQ(fresh.read(8339), 5);
  EXPECT_EQ(inhibited.ask(3, 8339, 26).code, kOk);
  for (const int32_t code : {27, 33})
    EXPECT_EQ(inhibited.ask(3, 8339, code).code, refusal(code == 27 ? 0x1D : 0x15));
  EXPECT_EQ(fresh.talk().text("u", "P860"), "4 kHz");
  // Of LOGODrive only.
  Asked standard("mc07", "", "logodrive = false\n");
  for (const auto& [index, code] : {std::pair{8304, 10}, {8305, 12}, {8307, 9}}) {
    EXPECT_EQ(inhibited.ask(3, static_cast<uint16_t>(index), code).code, kOk) << index;
    EXPECT_EQ(standard.ask(3, static_cast<uint16_t>(index), code).code, refusal(0x1D)) << index;
  }
}

TEST(ServiceRows, DisplaysOfARunningMovitrac07) {
  PROVES("M07-PAR-20", "M07-PAR-22");
  Asked asked("mc07", "P100 = 10\nP101 = 3\n", "", kEnabled);
  for (int n = 0; n < 300; ++n) asked.talk().ask("3 # 00 06 13 88 00 00", 10 * kMs);
  for (const auto& [index, conversion] : {std::pair{8318, 66},
                                          {8319, -3},
                                          {8321, -3},
                                          {8322, -3},
                                          {8325, -3},
                                          {8326, -3},
                                          {8327, 0},
                                          {8331, -3}}) {
    const auto at = static_cast<uint16_t>(index);
    EXPECT_EQ(asked.ask(1, at).code, kOk) << index;
    EXPECT_EQ(asked.ask(2, at, 1).code, refusal(0x12)) << index;
    char text[40];
    EXPECT_EQ(ipos_plant_parameter_text("mc07", at, 60'000, text, sizeof text), IPOS_PLANT_OK);
    // 60000 digits are 60 of what conversion -3 names, 60 rpm of conversion 66, and 60000 of conversion 0.
    EXPECT_EQ(std::stod(text), conversion == 0 ? 60'000 : 60) << index << ": " << text;
  }
  EXPECT_EQ(asked.read(8318), 1'000'000);
  EXPECT_NEAR(asked.read(8319), 33'333, 500) << "four poles, and the slip";
}

TEST(ServiceRows, FreshMovidriveB) {
  PROVES("MDB-PAR-13");
  const Talk talk(can_bus() + on_sbus("u", "mdxb", ""));
  const std::pair<const char*, int> printed[] = {{"P870", 9}, {"P871", 1}, {"P872", 0}, {"P873", 6},
                                                 {"P874", 1}, {"P875", 0}, {"P876", 1}};
  for (const auto& [number, value] : printed) EXPECT_EQ(talk.value("u", number), value) << number;
}

// Values and codes as people read them, by the functions of the library about parameters and return codes, which need no plant.
std::string read_as(uint16_t index, int32_t value, const char* unit = "md60a") {
  goes_through(kLibrary);
  char text[60];
  EXPECT_EQ(ipos_plant_parameter_text(unit, index, value, text, sizeof text), IPOS_PLANT_OK);
  return text;
}

TEST(ServiceRows, ValuesAsPeopleReadThem) {
  PROVES("EX-08", "PAR-37", "M07-PAR-21", "M07-PAR-24");
  EXPECT_EQ(read_as(8470, 1500), "1.500 s");
  EXPECT_EQ(read_as(0x2267, 1500, "mc07"), "1.500 s");
  EXPECT_EQ(read_as(8517, 1'500'000, "mc07"), "1500.000 rpm") << "25 revolutions per second";
  for (const char* unit : {"md60a", "mc07"}) {
    EXPECT_EQ(read_as(8300, 822'609'711, unit), "822 609 7.11");
    EXPECT_EQ(read_as(8300, 1'822'609'011, unit), "822 609 X.11");
  }
  EXPECT_EQ(read_as(8772, 1'768'763'185), "1/mi");
}

// 1053 1610 p. 65-66: what each code is about.
TEST(ServiceRows, ReturnCodesInWords) {
  PROVES("PAR-18");
  const std::pair<uint32_t, const char*> printed[] = {{0x00, "no error"},
                                                      {0x10, "index"},
                                                      {0x11, "not implemented"},
                                                      {0x12, "read"},
                                                      {0x13, "lock"},
                                                      {0x14, "factory"},
                                                      {0x15, "too large"},
                                                      {0x16, "too small"},
                                                      {0x17, "option card"},
                                                      {0x18, "system"},
                                                      {0x19, "X13"},
                                                      {0x1A, "diagnostic interface"},
                                                      {0x1B, "protection"},
                                                      {0x1C, "inhibit"},
                                                      {0x1D, "incorrect"},
                                                      {0x1E, "factory setting"},
                                                      {0x1F, "not saved in EEPROM"},
                                                      {0x20, "output stage"}};
  goes_through(kLibrary);
  std::set<std::string> all;
  for (const auto& [code, about] : printed) {
    const std::string words = ipos_plant_return_code(refusal(code));
    EXPECT_NE(words.find(about), std::string::npos) << code << ": " << words;
    EXPECT_TRUE(all.insert(words).second) << words;
  }
  for (uint32_t code = 0; code < 256; ++code) {
    const bool is_printed = std::any_of(std::begin(printed), std::end(printed),
                                        [&](const auto& row) { return row.first == code; });
    EXPECT_EQ(*ipos_plant_return_code(refusal(code)) != 0, is_printed) << code;
  }
}

// The class of a refusal that some unit sends, as who listens to the line reads it.
TEST(ServiceRows, ErrorClassesInWords) {
  PROVES("PAR-19", "M07-PAR-10");
  const char* printed[] = {"",  // none
                           "virtual field",
                           "application",
                           "definition",
                           "resource",
                           "service",
                           "access",
                           "object list",
                           "other"};
  Talk talk(serial_bus() + on_line("u", "md60a", "P810 = 1\n"));
  for (int error_class = 0; error_class <= 9; ++error_class) {
    const std::string number = std::to_string(error_class);
    talk.serial_ask("1D 09 86 B1 00 20 7E 0" + number + " 09 00 77");
    ASSERT_EQ(talk.telegrams().size(), 1U);
    const std::string& words = talk.telegrams()[0].words;
    EXPECT_NE(words.find("class " + number + " code 9 additional 77h: "), std::string::npos) << words;
    const bool known = error_class >= 1 && error_class <= 8;
    EXPECT_NE(words.find(known ? printed[error_class] : "unknown"), std::string::npos) << words;
  }
}

}  // namespace
}  // namespace ipos::tests

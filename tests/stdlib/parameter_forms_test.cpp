// Parameters of lists made for the test: how every form of a row is read, shown, read back and refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "stdlib/parameter_list.hpp"
#include "stdlib/services.hpp"
#include "stdlib/units.hpp"
#include "stdlib/unsimulated.hpp"

namespace ipos::stdlib {
namespace {

// Lists of rows, "number name index role display quantity conversion access default range texts option notes" with
// '~' between the cells.
struct Lists {
  explicit Lists(std::initializer_list<std::vector<std::string>> all, bool cards = true) {
    for (const std::vector<std::string>& rows : all) {
      std::string text = "number\t...\n";
      for (std::string row : rows) {
        for (char& c : row)
          if (c == '~') c = '\t';
        text += row + "\n";
      }
      texts.push_back(std::make_unique<std::string>(std::move(text)));
      names.push_back(std::make_unique<std::string>("list" + std::string(read.size(), 'x')));
      read.push_back(std::make_unique<ReadList>(*names.back(), *texts.back()));
      lists.push_back(read.back()->list());
    }
    table = std::make_unique<ParameterTable>(lists, cards);
  }
  const Parameter& operator[](std::string_view number) const { return *table->find(number); }
  std::vector<std::string> problems() const { return {table->problems().begin(), table->problems().end()}; }

  std::vector<std::unique_ptr<std::string>> names, texts;  // the lists only look at them
  std::vector<std::unique_ptr<ReadList>> read;
  std::vector<ParameterList> lists;
  std::unique_ptr<ParameterTable> table;
};

// One parameter with this display, quantity and conversion, range and texts.
Lists one(const std::string& form, const std::string& range = "", const std::string& texts = "") {
  return Lists({{"100~Name~8300~~" + form + "~RW~0~" + range + "~" + texts + "~~"}});
}

TEST(ParameterForms, EveryCellOfARow) {
  const Lists lists(
      {{"100~First~8300~~s~4~-3~RW/R/S/N/E/B~-5~-10..10/2;20..30/5~~DRS~doubt",
        "~No number~8301~~~~0~RO~7~~~~", "102~Keypad~~~~~~~~~0=A|1=B~~", "103~View~8300~view~ms~~~~~~~~seen",
        "104~Card~8302~~~0~0~RW~0~~~DIO~", "105~Card~8303~~~0~0~RW~0~~~AIO~"}});
  EXPECT_EQ(lists.problems(), std::vector<std::string>{});
  const Parameter& first = lists["100"];
  EXPECT_EQ(first.name, "First");
  EXPECT_EQ(first.index, 8300);
  EXPECT_EQ(first.display, "s");
  EXPECT_EQ(first.quantity, 4);
  EXPECT_EQ(first.conversion, -3);
  EXPECT_TRUE(first.writable && first.needs_inhibit && first.writable_locked && first.nonvolatile &&
              first.needs_output_stage_off && first.bcd);
  EXPECT_EQ(first.default_value, -5);
  ASSERT_EQ(first.ranges.size(), 2U);
  EXPECT_EQ(first.ranges[0].minimum, -10);
  EXPECT_EQ(first.ranges[0].maximum, 10);
  EXPECT_EQ(first.ranges[0].step, 2);
  EXPECT_EQ(first.ranges[1].minimum, 20);
  EXPECT_EQ(first.minimum(), -10);
  EXPECT_EQ(first.maximum(), 30);
  EXPECT_EQ(first.option, OptionCard::Drs);
  EXPECT_EQ(first.notes, "doubt");
  EXPECT_FALSE(first.view);
  const Parameter& second = *lists.table->find(uint16_t{8301});
  EXPECT_EQ(second.number, "");
  EXPECT_EQ(second.quantity, kNoQuantity);
  EXPECT_FALSE(second.writable || second.needs_inhibit || second.writable_locked || second.nonvolatile ||
               second.needs_output_stage_off || second.bcd);
  EXPECT_EQ(second.minimum(), INT32_MIN);
  EXPECT_EQ(second.maximum(), INT32_MAX);
  EXPECT_EQ(second.option, OptionCard::None);
  EXPECT_EQ(lists["102"].index, 0);
  EXPECT_EQ(lists["102"].minimum(), 0);
  EXPECT_EQ(lists["102"].maximum(), 1);
  const Parameter& view = lists["103"];
  EXPECT_TRUE(view.view);
  EXPECT_EQ(view.name, "View");
  EXPECT_EQ(view.display, "ms");
  EXPECT_EQ(view.notes, "seen");
  EXPECT_EQ(view.default_value, -5);
  EXPECT_EQ(view.ranges.size(), 2U);
  EXPECT_EQ(lists["104"].option, OptionCard::Dio);
  EXPECT_EQ(lists["105"].option, OptionCard::Aio);
  EXPECT_EQ(lists.table->by_index().size(), 4U);
  EXPECT_EQ(lists.table->find(uint16_t{8300}), &first) << "the row that leads, not the view";
}

TEST(ParameterForms, TextsAndTheirVersions) {
  const Lists lists({{"100~A~8300~~~0~0~RW~0~~-1=minus|0=zero|16*=logo|17@15/16=later~~",
                      "101~B~8301~~~0~0~RW~0~~=P100~~", "102~C~8300~view~~~~~~~0=other~~"}});
  EXPECT_EQ(lists.problems(), std::vector<std::string>{});
  const auto& texts = lists["100"].texts;
  ASSERT_EQ(texts.size(), 4U);
  EXPECT_EQ(texts[0].value, -1);
  EXPECT_EQ(texts[0].text, "minus");
  EXPECT_FALSE(texts[1].logodrive_only);
  EXPECT_TRUE(texts[2].logodrive_only);
  EXPECT_EQ(texts[2].value, 16);
  EXPECT_EQ(texts[3].value, 17);
  EXPECT_EQ(texts[3].from_standard, 15);
  EXPECT_EQ(texts[3].from_logodrive, 16);
  EXPECT_EQ(texts[1].from_standard, 0);
  EXPECT_EQ(lists["101"].texts.size(), 4U);
  EXPECT_EQ(lists["101"].texts[3].text, "later");
  EXPECT_EQ(lists["102"].texts.size(), 1U);
  EXPECT_EQ(lists["100"].minimum(), -1);
  EXPECT_EQ(lists["100"].maximum(), 17);
}

TEST(ParameterForms, BadRowsAreNamed) {
  for (const char* bad : {"100~A~8300~~~0~0~RW~0~~1@15=A~~",  "100~A~8300~~~0~0~RW~0~~1@/16=A~~",
                          "100~A~8300~~~0~0~RW~0~~1@15/=A~~", "100~A~8300~~~0~0~RW~0~~1=~~",
                          "100~A~8300~~~0~0~RW~0~~=A~~",      "100~A~8300~~~0~0~RW~0~~1=A|1=B~~",
                          "100~A~8300~~~0~0~RW~0~~2=A|1=B~~", "100~A~8300~~~0~0~RW~0~~=P100~~",
                          "100~A~8300~~~0~0~RW~0~1..2~~~",    "100~A~8300~~~0~0~RW~0~1..2/-1~~~",
                          "100~A~8300~~~0~0~RW~0~2..1/1~~~",  "100~A~8300~~~0~0~RW~0~..2/1~~~",
                          "100~A~8300~~~256~0~RW~0~~~~",      "100~A~8300~~~0~128~RW~0~~~~",
                          "100~A~8300~~~0~~RW~0~~~~",         "100~A~8300~~~0~0~RW~~~~~",
                          "100~A~8300~~~0~0~RW/~0~~~X~",      "100~A~8300~~~0~0~RWX~0~~~~",
                          "100~A~65536~~~0~0~RW~0~~~~",       "100~A~x~~~0~0~RW~0~~~~",
                          "100~A~8300~~~0~0~RW~0~~~~~",       "100~A~8300~~~0~0~RW~0~~~"}) {
    const Lists lists({{"# a comment", "", bad, "101~Good~8301~~~0~0~RW~0~5..5/1~~~"}});
    std::string row = bad;
    for (char& c : row)
      if (c == '~') c = '\t';
    EXPECT_EQ(lists.problems(), std::vector<std::string>{"list:4: " + row});
    EXPECT_EQ(lists.table->rows().size(), 1U) << bad;
  }
  EXPECT_EQ(Lists({{"100~A~8300~~~0~0~RW~0~~~~", "101~B~8300~~~0~0~RW~0~~~~"}}).problems(),
            std::vector<std::string>{"two rows lead index 8300"});
  EXPECT_EQ(Lists({{"100~A~8300~view~~~~~~~~~"}}).problems(),
            std::vector<std::string>{"no row leads the index of A"});
}

TEST(ParameterForms, LaterListsReplaceAndInsert) {
  const std::vector<std::string> base = {"100~A~8300~~~0~0~RW~0~~~~", "~no number~8399~~~0~0~RW~0~~~~",
                                         "200~B~8301~~~0~0~RW~0~~~DRS~", "201~V~8301~view~~~~~~~~~"};
  const Lists lists(
      {base,
       {"200~B2~8311~~~0~0~RW~0~~~~", "150~New~8302~~~0~0~RW~0~~~~", "300~Last~8303~~~0~0~RW~0~~~~",
        "050~First~8304~~~0~0~RW~0~~~~", "201~V~8311~view~~~~~~~~~"}});
  EXPECT_EQ(lists.problems(), std::vector<std::string>{});
  std::vector<std::string> order;
  for (const Parameter& row : lists.table->rows())
    order.emplace_back(std::string(row.number) + std::string(row.name));
  EXPECT_EQ(order, (std::vector<std::string>{"050First", "100A", "no number", "150New", "200B2", "201V",
                                             "300Last"}));
  EXPECT_EQ(lists.table->find(uint16_t{8301}), nullptr);
  const Lists without({base}, false);
  EXPECT_EQ(without.problems(), std::vector<std::string>{}) << "the card's view goes with it";
  EXPECT_EQ(without.table->rows().size(), 2U);
}

TEST(ParameterForms, FindsNumbersAndIndices) {
  const Lists lists({{"999~A~999~~~0~0~RW~0~~~~", "100~B~1000~~~0~0~RW~0~~~~"}});
  EXPECT_EQ(lists.table->find("999")->name, "A") << "up to 999 it is a number";
  EXPECT_EQ(lists.table->find("1000")->name, "B") << "from 1000 on an index";
  EXPECT_EQ(lists.table->find("P100")->name, "B");
  EXPECT_EQ(lists.table->find("p100")->name, "B");
  EXPECT_EQ(lists.table->find("P1000"), nullptr);
  EXPECT_EQ(lists.table->find("100x"), nullptr);
}

std::string shown(const Lists& lists, int32_t value) { return parameter_text(lists["100"], value); }

TEST(ParameterForms, ShowDecimalsOfTheirConversion) {
  // 1E-3 s each: three decimals; ms: none; no unit: none.
  EXPECT_EQ(shown(one("s~4~-3"), 1), "0.001 s");
  EXPECT_EQ(shown(one("s~4~-3"), -1), "-0.001 s");
  EXPECT_EQ(shown(one("s~4~-3"), 999), "0.999 s");
  EXPECT_EQ(shown(one("s~4~-3"), 1000), "1.000 s");
  EXPECT_EQ(shown(one("s~4~-3"), -12345), "-12.345 s");
  EXPECT_EQ(shown(one("s~4~-3"), 0), "0.000 s");
  EXPECT_EQ(shown(one("s~4~-3"), INT32_MIN), "-2147483.648 s");
  EXPECT_EQ(shown(one("s~4~-3"), INT32_MAX), "2147483.647 s");
  EXPECT_EQ(shown(one("ms~4~-3"), 25), "25 ms");
  EXPECT_EQ(shown(one("s~4~-9"), 1), "0.000000001 s");
  EXPECT_EQ(shown(one("s~4~-1"), 15), "1.5 s");
  EXPECT_EQ(shown(one("h~4~70"), 90), "1.500 h") << "minutes as hours: three decimals";
  EXPECT_EQ(shown(one("s~4~70"), 2), "120.000 s");
  EXPECT_EQ(shown(one("~0~0"), 42), "42");
  // Thousandths that are always whole are shown whole.
  EXPECT_EQ(shown(one("~0~-3", "0..5000/1000"), 3000), "3");
  EXPECT_EQ(shown(one("~0~-3", "0..5000/500"), 3000), "3.000");
  EXPECT_EQ(shown(one("~0~-3", "500..5500/1000"), 2500), "2.500");
  EXPECT_EQ(shown(one("~0~-3", "0..5000/1000;5000..6000/500"), 3000), "3.000");
  EXPECT_EQ(shown(one("s~4~-3", "0..5000/1000"), 3000), "3.000 s");
  EXPECT_EQ(shown(one("~0~0", "0..4294967295/1"), -1), "4294967295") << "unsigned";
  EXPECT_EQ(shown(one("~0~0", "0..2147483647/1"), -1), "-1");
  EXPECT_EQ(shown(one("hex~0~0"), -1), "0xFFFFFFFF");
  EXPECT_EQ(shown(one("hex~0~0"), 0x1F), "0x001F");
  EXPECT_EQ(shown(one("kBaud~0~0", "", "0=125|2=500"), 2), "500 kBaud");
  EXPECT_EQ(shown(one("kBaud~0~0", "", "0=125|2=500"), 1), "1");
  EXPECT_EQ(display_scale(one("s~4~-3")["100"]).decimals, 3);
  EXPECT_DOUBLE_EQ(display_scale(one("h~4~70")["100"]).factor, 1.0 / 60);
}

TEST(ParameterForms, FirmwareAndCharacters) {
  const Lists firmware = one("firmware~0~0");
  EXPECT_EQ(shown(firmware, 123456789), "123 456 7.89");
  EXPECT_EQ(shown(firmware, 99999999), "99999999");
  EXPECT_EQ(shown(firmware, 100000000), "100 000 0.00");
  EXPECT_EQ(shown(firmware, -12345678), "-12345678");
  EXPECT_EQ(shown(firmware, -123456789), "-123456789");
  EXPECT_EQ(shown(firmware, 1234567089), "234 567 X.89");
  EXPECT_EQ(shown(firmware, 1234567189), "1234567189");
  EXPECT_EQ(shown(firmware, 2034567089), "2034567089");
  const auto read = [&](const char* text) {
    return parse_parameter_text(firmware["100"], text).value_or(-99);
  };
  EXPECT_EQ(read("123 456 7.89"), 123456789);
  EXPECT_EQ(read("123456X89"), 1123456089);
  EXPECT_EQ(read("-5"), -5);
  EXPECT_EQ(read("5"), 5);
  for (const char* bad :
       {"5-", "12345X789", "123456X8", "123456X890", "1234567X9", "123a", "", "99999999999", "/", ":"})
    EXPECT_EQ(read(bad), -99) << bad;
  EXPECT_EQ(parse_parameter_text(firmware["100"], "x").error(), "expected a number such as 822 609 7.11");

  const Lists ascii = one("ascii~0~0");
  EXPECT_EQ(shown(ascii, 0), "");
  EXPECT_EQ(shown(ascii, 'a' | 'b' << 8 | 'c' << 16 | 'd' << 24), "abcd");
  EXPECT_EQ(shown(ascii, 0x7E), "~");
  EXPECT_EQ(shown(ascii, 0x7F), "0x007F");
  EXPECT_EQ(shown(ascii, 0x1F), "0x001F");
  EXPECT_EQ(shown(ascii, ' ' | 'a' << 8), "0x6120") << "a blank in front would be lost";
  EXPECT_EQ(shown(ascii, 'a' | ' ' << 8), "0x2061");
  EXPECT_EQ(shown(ascii, 'a' | ' ' << 8 | 'b' << 16), "a b");
  EXPECT_EQ(shown(ascii, '0' | 'x' << 8), "0x7830") << "it would be read as a number";
  EXPECT_EQ(shown(ascii, 'a' << 8), "0x6100") << "nothing in front of a character";
  const auto characters = [&](const char* text) {
    return parse_parameter_text(ascii["100"], text).value_or(-99);
  };
  EXPECT_EQ(characters("abcd"), 'a' | 'b' << 8 | 'c' << 16 | 'd' << 24);
  EXPECT_EQ(characters("~ !"), '~' | ' ' << 8 | '!' << 16);
  EXPECT_EQ(characters("abcde"), -99);
  EXPECT_EQ(characters("a\x1F"), -99);
  EXPECT_EQ(characters("a\x7F"), -99);
  EXPECT_EQ(characters("0x80000000"), INT32_MIN);
  EXPECT_EQ(parse_parameter_text(ascii["100"], "abcde").error(),
            "expected up to four characters, or their code as 0x...");
}

TEST(ParameterForms, AreReadInTheirUnits) {
  const Lists seconds = one("s~4~-3");
  const auto read = [](const Lists& lists, const std::string& text) {
    const auto value = parse_parameter_text(lists["100"], text);
    return value ? std::to_string(*value) : value.error();
  };
  const std::string seconds_wanted = "expected a number with up to 3 decimals in s";
  const std::pair<const char*, std::string> rows[] = {{"1", "1000"},
                                                      {" 1 ", "1000"},
                                                      {"1s", "1000"},
                                                      {"1 s", "1000"},
                                                      {"1 S", seconds_wanted},
                                                      {"-1.5", "-1500"},
                                                      {"1.001", "1001"},
                                                      {"1.0005", seconds_wanted},
                                                      {"0.001", "1"},
                                                      {"1 ms", "1"},
                                                      {"1 min", "60000"},
                                                      {"2147483.647", "2147483647"},
                                                      {"2147483.648", seconds_wanted},
                                                      {"-2147483.648", "-2147483648"},
                                                      {"-2147483.649", seconds_wanted},
                                                      {"1 kg", seconds_wanted},
                                                      {"1 s s", seconds_wanted},
                                                      {"1 x", seconds_wanted},
                                                      {"", seconds_wanted},
                                                      {"s", seconds_wanted},
                                                      {"0x10", "16"},
                                                      {"0xFFFFFFFF", "-1"},
                                                      {"0x", seconds_wanted},
                                                      {"0x1 s", seconds_wanted},
                                                      {"0x100000000", seconds_wanted},
                                                      {"1e3", seconds_wanted},
                                                      {"nan", seconds_wanted},
                                                      {"1,5", seconds_wanted},
                                                      {"1.", "1000"}};
  for (const auto& [text, wanted] : rows) EXPECT_EQ(read(seconds, text), wanted) << text;
  EXPECT_EQ(read(one("~0~0"), "x"), "expected a number");
  EXPECT_EQ(read(one("~0~0"), "5"), "5");
  EXPECT_EQ(read(one("~0~0"), "5.5"), "expected a number");
  EXPECT_EQ(read(one("~0~0", "0..4294967295/1"), "4294967295"), "-1");
  EXPECT_EQ(read(one("~0~0", "0..4294967295/1"), "4294967296"), "expected a number");
  EXPECT_EQ(read(one("~0~0", "0..4294967295/1"), "-1"), "expected a number");
  const Lists temperature =
      one("\xC2\xB0"
          "C~17~100");
  EXPECT_EQ(read(temperature, "25"), "25");
  EXPECT_EQ(read(temperature, "25 K"),
            "expected a number in \xC2\xB0"
            "C")
      << "another zero";
  const Lists choice = one("kBaud~0~0", "", "0=125|1=250|2=OFF");
  EXPECT_EQ(read(choice, "250"), "1");
  EXPECT_EQ(read(choice, "250 kbaud"), "1");
  EXPECT_EQ(read(choice, "off"), "2");
  EXPECT_EQ(read(choice, "1"), "1") << "the code";
  EXPECT_EQ(read(choice, "7"), "7") << "a code that the list does not have";
  EXPECT_EQ(read(choice, "1 s"), "expected 0 = 125, 1 = 250 or 2 = OFF");
  EXPECT_EQ(read(choice, "off "), "2");
  EXPECT_EQ(read(choice, "of"), "expected 0 = 125, 1 = 250 or 2 = OFF");
  EXPECT_EQ(read(one("~0~0", "", "0=OFF"), "x"), "expected 0 = OFF");
}

TEST(ParameterForms, RangesInWords) {
  EXPECT_EQ(parameter_range(one("s~4~-3", "0..1000/10;1000..5000/100")["100"]), "0.000 s..5.000 s")
      << "steps differ only";
  EXPECT_EQ(parameter_range(one("s~4~-3", "0..1000/10;2000..5000/100")["100"]),
            "0.000 s..1.000 s or 2.000 s..5.000 s");
  EXPECT_EQ(parameter_range(one("~0~0", "0..1/1;1..2/1;5..6/1;6..7/1")["100"]), "0..2 or 5..7");
  EXPECT_EQ(parameter_range(one("~0~0", "", "0=A|1=B|2=C")["100"]), "0 = A, 1 = B or 2 = C");
  EXPECT_EQ(parameter_range(one("~0~0", "0..4294967295/1")["100"]), "0..4294967295");
}

TEST(ParameterForms, RefusalsOfEveryRange) {
  namespace codes = return_codes;
  const Lists lists = one("s~4~-3", "0..1000/10;2000..5000/100");
  const auto said = [&](int32_t value, ReturnCode code, uint8_t service = 2) {
    return explain_refusal(*lists.table, service, 8300, value, code);
  };
  EXPECT_EQ(said(5, codes::kIncorrectValue),
            "P100 Name := 0.005 s: incorrect parameter value (0.000 s..1.000 s in steps of 0.010 s)");
  EXPECT_EQ(said(1000, codes::kIncorrectValue),
            "P100 Name := 1.000 s: incorrect parameter value (0.000 s..1.000 s in steps of 0.010 s)");
  EXPECT_EQ(said(2001, codes::kIncorrectValue),
            "P100 Name := 2.001 s: incorrect parameter value (2.000 s..5.000 s in steps of 0.100 s)");
  EXPECT_EQ(said(1500, codes::kIncorrectValue),
            "P100 Name := 1.500 s: incorrect parameter value (0.000 s..1.000 s or 2.000 s..5.000 s)");
  EXPECT_EQ(said(6000, codes::kTooLarge),
            "P100 Name := 6.000 s: parameter value too large (0.000 s..5.000 s)");
  EXPECT_EQ(said(-1, codes::kTooSmall),
            "P100 Name := -0.001 s: parameter value too small (0.000 s..5.000 s)");
  EXPECT_EQ(said(5, codes::kTooSmall, 1), "P100 Name: parameter value too small (0.000 s..5.000 s)");
  EXPECT_EQ(said(5, codes::kReadOnly), "P100 Name := 0.005 s: read access only");
  EXPECT_EQ(said(5, {6, 7, 0xABCD}), "P100 Name := 0.005 s: return code 06 07 AB CD");
  EXPECT_EQ(explain_refusal(*one("~0~0").table, 3, 8300, 7, codes::kTooLarge),
            "P100 Name := 7: parameter value too large");
}

TEST(ParameterForms, NamesOfIndices) {
  const Lists lists({{"100~Name~8300~~~0~0~RW~0~~~~", "~Other~8301~~~0~0~RW~0~~~~"}});
  const std::pair<uint16_t, const char*> rows[] = {{8300, "P100 Name"},
                                                   {8301, "index 8301 Other"},
                                                   {8302, "index 8302"},
                                                   {10999, "index 10999"},
                                                   {11000, "H0"},
                                                   {12023, "H1023"},
                                                   {12024, "index 12024"},
                                                   {15999, "index 15999"},
                                                   {16000, "program word 0"},
                                                   {18047, "program word 2047"},
                                                   {18048, "index 18048"},
                                                   {19999, "index 19999"},
                                                   {20000, "curve point 0"},
                                                   {20512, "curve point 512"},
                                                   {20513, "index 20513"}};
  for (const auto& [index, name] : rows) EXPECT_EQ(index_name(*lists.table, index), name);
}

TEST(Units, ConversionsOfTenEndAtSixtyFour) {
  EXPECT_DOUBLE_EQ(find_conversion(64)->a, 1e64);
  EXPECT_DOUBLE_EQ(find_conversion(-64)->a, 1e-64);
  EXPECT_FALSE(find_conversion(65));
  EXPECT_FALSE(find_conversion(-65));
}

TEST(Unsimulated, RowsBelongToTheirUnitsAndValues) {
  const auto said = [](const char* unit, const char* number, int32_t value) {
    const UnitType& type = *find_unit(unit);
    const Parameter* parameter = parameter_table(type).find(number);
    std::string out;
    if (parameter == nullptr) return out;
    for (const Unsimulated& one : unsimulated(type, parameter->index))
      if (one.applies(value)) out += one.text(value) + "\n";
    return out;
  };
  EXPECT_NE(said("compact", "P100", 3).find("this unit has no fieldbus"), std::string::npos);
  EXPECT_EQ(said("compact", "P100", 2).find("this unit has no fieldbus"), std::string::npos);
  EXPECT_EQ(said("md60a", "P100", 3).find("this unit has no fieldbus"), std::string::npos);
  // P200 to P207 and P210: every value but the factory setting.
  const std::string ideal =
      "speed control is ideal, unless control = \"real\": its gains, filters and precontrols have no effect";
  const std::string without = "speed control has no sample time, no load precontrol of VFC and no hold controller";
  for (const auto& [number, why] : {std::pair{"P202", ideal}, std::pair{"P207", without}, std::pair{"P210", without}}) {
    const Parameter* parameter = parameter_table(*find_unit("md60a")).find(number);
    ASSERT_NE(parameter, nullptr) << number;
    const auto factory = static_cast<int32_t>(parameter->default_value);
    EXPECT_EQ(said("md60a", number, factory), "") << number;
    EXPECT_NE(said("md60a", number, factory + 1).find(": " + why + "\n"), std::string::npos) << number;
    EXPECT_TRUE(said("md60a", number, factory + 1)
                    .starts_with(std::string(number) + " " + std::string(parameter->name) + " is "));
  }
  EXPECT_EQ(said("md60a", "P130", 5), "");
  for (const UnitType& unit : unit_types()) {
    uint16_t last = 0;
    for (const Unsimulated& one : unsimulated(unit)) {
      EXPECT_GE(one.parameter->index, last);
      last = one.parameter->index;
      EXPECT_TRUE(one.parameter->writable) << one.parameter->number;
      EXPECT_TRUE(one.row->units == nullptr || one.row->units(unit));
      const auto found = unsimulated(unit, last);
      EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                              [&](const Unsimulated& other) { return other.row == one.row; }));
      for (const Unsimulated& other : found) EXPECT_EQ(other.parameter->index, last);
    }
  }
  EXPECT_TRUE(unsimulated(*find_unit("md60a"), 1).empty());
}

}  // namespace
}  // namespace ipos::stdlib

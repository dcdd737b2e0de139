// The parameter tables against their lists, and against figures the manuals print.
#include "stdlib/parameters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "stdlib/parameter_list.hpp"
#include "stdlib/units.hpp"
#include "tests/harness/proves.hpp"
#include "tests/stdlib/parameter_list.hpp"

namespace ipos::stdlib {
namespace {

const ParameterTable& table(const char* unit) { return parameter_table(*find_unit(unit)); }

struct UnitLists {
  const char* unit;
  std::vector<std::string> files;
  bool option_cards;
};
const UnitLists kUnits[] = {{"md60a", {"md60a.tsv"}, true},
                            {"compact", {"md60a.tsv"}, false},
                            {"mdxb", {"md60a.tsv", "mdxb.tsv"}, true},
                            {"mc07", {"mc07.tsv"}, true},
                            {"mc31", {"mc31.tsv"}, true},
                            {"mc07b", {"mc07.tsv", "mc07b.tsv"}, true}};

TEST(ParameterTable, ListsHaveNoFaults) {
  for (const UnitLists& row : kUnits)
    for (const std::string& problem : table(row.unit).problems())
      ADD_FAILURE() << row.unit << ": " << problem;
}

// Each leading row of the text is in the table with the same cells.
TEST(ParameterTable, HoldsTheLists) {
  for (const UnitLists& unit : kUnits) {
    const auto list = tests::listed(unit.files, unit.option_cards);
    ASSERT_EQ(table(unit.unit).by_index().size(), list.size()) << unit.unit;
    auto at = list.begin();
    for (const Parameter* p : table(unit.unit).by_index()) {
      const tests::ListedParameter& row = (at++)->second;
      ASSERT_EQ(p->index, row.index);
      EXPECT_EQ(p->number, row.cells.at("number"));
      EXPECT_EQ(p->name, row.cells.at("name"));
      EXPECT_EQ(p->display, row.cells.at("display"));
      EXPECT_EQ(p->default_value, row.default_value) << p->index;
      EXPECT_EQ(p->minimum(), row.minimum()) << p->index;
      EXPECT_EQ(p->maximum(), row.maximum()) << p->index;
      EXPECT_EQ(p->ranges.size(), row.ranges.size()) << p->index;
      EXPECT_EQ(p->texts.size(), row.codes.size()) << p->index;
      EXPECT_EQ(p->conversion, std::stoi(row.cells.at("conversion"))) << p->index;
      EXPECT_EQ(p->writable, row.has("RW")) << p->index;
      EXPECT_EQ(p->needs_inhibit, row.has("R")) << p->index;
      EXPECT_EQ(p->writable_locked, row.has("S")) << p->index;
      EXPECT_EQ(p->nonvolatile, row.has("N")) << p->index;
      EXPECT_TRUE(row.legal(row.default_value)) << p->index << " has a default it would refuse";
      EXPECT_EQ(table(unit.unit).find(p->index), p);
    }
  }
}

std::vector<tests::Cells> printed(const char* file) {
  return tests::read_list(std::string(IPOS_PRINTED_LISTS) + "/" + file);
}

// Each printed line against the table: unit indices, access, default, and the range where one is printed.
TEST(ParameterTable, HoldsThePrintedList) {
  PROVES("PAR-38");
  const ParameterTable& md60a = table("md60a");
  const auto lines = printed("md60a_printed.tsv");
  EXPECT_EQ(lines.size(), 393U);
  EXPECT_EQ(md60a.rows().size(), 393U);
  std::set<int> indices;
  size_t ranges = 0;
  for (const tests::Cells& line : lines) {
    const int index = std::stoi(line.at("index"));
    indices.insert(index);
    const Parameter* p = md60a.find(static_cast<uint16_t>(index));
    ASSERT_NE(p, nullptr) << index;
    EXPECT_FALSE(p->name.empty()) << index;
    const int size = line.at("size").empty() ? 0 : std::stoi(line.at("size"));
    EXPECT_EQ(p->quantity == kNoQuantity ? 0 : p->quantity, size) << index;
    EXPECT_EQ(p->conversion, std::stoi(line.at("conversion"))) << index;
    if (line.at("default") != "-") {
      EXPECT_EQ(p->default_value, std::stoll(line.at("default"))) << index;
    }
    if (index != 8334) {  // printed twice, once as writable: PAR-29
      const auto letters = tests::split(line.at("access"), '/');
      const auto has = [&](const char* letter) {
        return std::find(letters.begin(), letters.end(), letter) != letters.end();
      };
      EXPECT_EQ(p->writable, has("RW")) << index;
      EXPECT_EQ(p->needs_inhibit, has("R")) << index;
      EXPECT_EQ(p->writable_locked, has("S")) << index;
      EXPECT_EQ(p->nonvolatile, has("N")) << index;
    }
    if (line.at("minimum").empty()) continue;
    ++ranges;
    EXPECT_EQ(p->minimum(), std::stoll(line.at("minimum"))) << index;
    EXPECT_EQ(p->maximum(), std::stoll(line.at("maximum"))) << index;
    if (!p->texts.empty()) continue;  // codes, which step by 1
    ASSERT_EQ(p->ranges.size(), 1U) << index;
    EXPECT_EQ(p->ranges[0].step, std::stoll(line.at("step"))) << index;
  }
  EXPECT_EQ(indices.size(), 354U);
  EXPECT_EQ(ranges, 111U);
  ASSERT_EQ(md60a.by_index().size(), 354U);
  EXPECT_EQ(md60a.by_index().front()->index, 8300);
  EXPECT_EQ(md60a.by_index().back()->index, 8891);
  for (const Parameter* p : md60a.by_index()) EXPECT_FALSE(p->name.empty()) << p->index;
  EXPECT_EQ(md60a.find(uint16_t{8492})->name, "Internal setpoint n21");
  EXPECT_EQ(md60a.find(uint16_t{8493})->name, "Internal setpoint n22");
  EXPECT_EQ(md60a.find(uint16_t{8494})->name, "Internal setpoint n23");
  EXPECT_EQ(md60a.find(uint16_t{8524})->quantity, 21);
  EXPECT_EQ(md60a.find(uint16_t{8524})->conversion, -3);
  EXPECT_EQ(md60a.find(uint16_t{8576})->quantity, 22);
  EXPECT_EQ(md60a.find(uint16_t{8576})->conversion, -3);
  EXPECT_EQ(table("mc07").rows().size(), 126U);
}

// Decimal and hexadecimal index of every printed line. MOVITRAC 07 prints 8807 to 8809 beside the numbers of
// an older series.
TEST(ParameterTable, DecimalAndHexadecimalIndexAgree) {
  PROVES("PAR-26", "M07-PAR-27");
  std::set<std::pair<int, int>> differ;
  size_t pairs = 0;
  for (const tests::Cells& line : printed("md60a_printed.tsv")) {
    if (line.at("hex") == "-") continue;  // the second index of P852
    ++pairs;
    const int index = std::stoi(line.at("index"));
    const int hex = std::stoi(line.at("hex"), nullptr, 16);
    if (index != hex) differ.emplace(index, hex);
  }
  EXPECT_EQ(pairs, 392U);
  EXPECT_EQ(differ, (std::set<std::pair<int, int>>{{8891, 0x2288}}));
  ASSERT_NE(table("md60a").find(uint16_t{8891}), nullptr);
  EXPECT_EQ(table("md60a").find(uint16_t{8891})->default_value, 0);
  EXPECT_EQ(table("md60a").find(uint16_t{0x2288}), nullptr);

  std::set<std::pair<int, int>> of_m07;
  std::set<int> indices;
  pairs = 0;
  for (const tests::Cells& line : printed("mc07_printed.tsv")) {
    ++pairs;
    const int index = std::stoi(line.at("index"));
    const int hex = std::stoi(line.at("hex"), nullptr, 16);
    indices.insert(index);
    if (index != hex) of_m07.emplace(index, hex);
  }
  EXPECT_EQ(pairs, 121U + 3U);
  EXPECT_EQ(of_m07, (std::set<std::pair<int, int>>{{8807, 0x2116}, {8808, 0x2117}, {8809, 0x2126}}));
  for (const int index : indices)
    EXPECT_NE(table("mc07").find(static_cast<uint16_t>(index)), nullptr) << index;
  EXPECT_EQ(table("mc07").by_index().size(), indices.size());
  for (const auto& [index, value] : {std::pair{0x2267, 2000}, {0x2268, 2000}, {0x2269, 20000}}) {
    ASSERT_NE(table("mc07").find(static_cast<uint16_t>(index)), nullptr);
    EXPECT_EQ(table("mc07").find(static_cast<uint16_t>(index))->default_value, value);
  }
  for (const auto& [index, hex] : of_m07)
    EXPECT_EQ(table("mc07").find(static_cast<uint16_t>(hex)), nullptr) << hex;
}

// The letters of p. 67, and E, which is ours (not changeable while the output stage is on): every word of one
// or two letters is tried.
TEST(ParameterTable, AccessLetters) {
  PROVES("PAR-10");
  std::set<std::string> accepted;
  const auto try_word = [&](const std::string& word) {
    const std::string text =
        "number\tname\tindex\trole\tdisplay\tquantity\tconversion\taccess\tdefault\trange\ttexts\toption\tnot"
        "es\n"
        "1\tn\t8300\t\t\t0\t0\t" +
        word + "\t0\t\t\t\t\n";
    const ReadList read("test.tsv", text);
    const ParameterList list = read.list();
    if (ParameterTable({&list, 1}, true).problems().empty()) accepted.insert(word);
  };
  for (char first = 'A'; first <= 'z'; ++first) {
    if (first == '/') continue;
    try_word({first});
    for (char second = 'A'; second <= 'z'; ++second) try_word({first, second});
  }
  EXPECT_EQ(accepted, (std::set<std::string>{"RO", "RW", "R", "S", "N", "E", "B"}));
}

TEST(ParameterTable, FindsByNumberAndIndex) {
  const ParameterTable& md60a = table("md60a");
  EXPECT_EQ(md60a.find("P813")->index, 8600);
  EXPECT_EQ(md60a.find("p813")->index, 8600);
  EXPECT_EQ(md60a.find("813")->index, 8600);
  EXPECT_EQ(md60a.find("8600")->number, "813");
  EXPECT_EQ(md60a.find("P000")->index, 8318);
  for (const char* text : {"", "P", "P1000", "9999", "65536", "P81", "P8600", "-1", "P813 "})
    EXPECT_EQ(md60a.find(text), nullptr) << text;
}

TEST(ParameterTable, ViewsFollowTheLeadingRow) {
  const ParameterTable& md60a = table("md60a");
  const Parameter* display = md60a.find("P031");
  const Parameter* setting = md60a.find("P600");
  EXPECT_TRUE(display->view);
  EXPECT_FALSE(setting->view);
  EXPECT_EQ(display->index, setting->index);
  EXPECT_EQ(display->texts.size(), setting->texts.size());
  EXPECT_EQ(display->default_value, setting->default_value);
  EXPECT_EQ(md60a.find(uint16_t{8335}), setting);
  // Every index has exactly one leading row.
  for (const UnitLists& unit : kUnits) {
    std::multiset<uint16_t> leads;
    for (const Parameter& p : table(unit.unit).rows())
      if (!p.view && p.index != 0) leads.insert(p.index);
    for (const Parameter& p : table(unit.unit).rows())
      EXPECT_EQ(leads.count(p.index), p.index == 0 ? 0U : 1U) << unit.unit << " " << p.index;
  }
}

TEST(ParameterTable, ExampleNames) {
  EXPECT_EQ(table("md60a").find(uint16_t{8471})->name, "Ramp t11 DOWN CW");
  EXPECT_EQ(parameter_text(*table("md60a").find(uint16_t{8471}), 3000), "3.000 s");
  EXPECT_EQ(table("md60a").find("P131")->index, 8471);
}

TEST(ParameterTable, MdxbAddsAndReplaces) {
  PROVES("MDB-PAR-13");
  const ParameterTable& mdxb = table("mdxb");
  EXPECT_EQ(mdxb.find("P811")->minimum(), 100);
  EXPECT_EQ(mdxb.find("P811")->maximum(), 199);
  const int64_t printed[] = {9, 1, 0, 6, 1, 0, 1};  // P870..P876, MDX60B/61B p. 17
  for (int i = 0; i < 7; ++i)
    EXPECT_EQ(mdxb.find("P" + std::to_string(870 + i))->default_value, printed[i]) << 870 + i;
  for (const char* number :
       {"P880", "P881", "P882", "P883", "P884", "P885", "P886", "P887", "P888", "P889", "P890",
        "P891", "P892", "P893", "P894", "P895", "P896", "P899", "P837", "P938", "P939"})
    EXPECT_NE(mdxb.find(number), nullptr) << number;
  EXPECT_EQ(mdxb.find("P813")->index, mdxb.find("P881")->index);
  EXPECT_TRUE(mdxb.find("P813")->view);
  // Numbers rise through the merged list.
  std::string_view last;
  for (const Parameter& p : mdxb.rows()) {
    if (p.number.empty()) continue;
    EXPECT_LE(last, p.number);
    last = p.number;
  }
}

TEST(ParameterTable, BadListsAreReportedNotTrusted) {
  const char* header =
      "number\tname\tindex\trole\tdisplay\tquantity\tconversion\taccess\tdefault\trange\ttexts\t"
      "option\tnotes\n";
  for (const char* row :
       {"1\tname", "1\t\t8300\t\t\t0\t0\tRO\t0\t\t\t\t", "1\tn\t99999\t\t\t0\t0\tRO\t0\t\t\t\t",
        "1\tn\t8300\tlead\t\t0\t0\tRO\t0\t\t\t\t", "1\tn\t8300\t\t\t0\t0\tXX\t0\t\t\t\t",
        "1\tn\t8300\t\t\t0\t0\tRW\t0\t5..1/1\t\t\t", "1\tn\t8300\t\t\t0\t0\tRW\t0\t1.5/1\t\t\t", "1\tn\t8300\t\t\t0\t0\tRW\t0\t\t\t\t\t", "1\tn\t8300\t\t\t0\t300\tRW\t0\t\t\t\t",
        "1\tn\t8300\t\t\t0\t0\tRW\t12345678901234567890\t\t\t\t", "1\tn\t8300\t\t\t0\t0\tRW\t-\t\t\t\t", "1\tn\t8300\t\t\t0\t0\tRW\t0\t1..5/0\t\t\t",
        "1\tn\t8300\t\t\t0\t0\tRW\t0\t\t1=B|0=A\t\t", "1\tn\t8300\t\t\t0\t0\tRW\t0\t\t=P9\t\t",
        "1\tn\t8300\t\t\t0\t0\tRW\t\t\t\t\t", "1\tn\t8300\tview\t\t\t\t\t\t\t\t\t",
        "1\tn\t8300\t\t\t0\t0\tRW\t0\t\t\tXYZ\t"}) {
    const std::string text = std::string("# comment\n") + header + row + "\n";
    const ReadList read("test.tsv", text);
    const ParameterList list = read.list();
    const ParameterTable bad({&list, 1}, true);
    EXPECT_EQ(bad.problems().size(), 1U) << row;
    EXPECT_TRUE(bad.rows().empty()) << row;
  }
}

}  // namespace
}  // namespace ipos::stdlib

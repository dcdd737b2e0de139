// Looking up words: misspelt ones by their distance, names of the headers, system functions, structures, services,
// units and faults.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "stdlib/faults.hpp"
#include "stdlib/header_names.hpp"
#include "stdlib/language_tables.hpp"
#include "stdlib/services.hpp"
#include "stdlib/spelling.hpp"
#include "stdlib/unit_text.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::stdlib {
namespace {

const UnitType& unit_named(std::string_view name) { return *find_unit(name); }

TEST(UnitText, TakesTheFirstAlternativeThatTheUnitHas) {
  const std::string_view text = "within {P883|P815|its timeout}, {P840 = YES|}{P61x|P60x|nothing}.";
  EXPECT_EQ(unit_text(unit_named("mdxb"), text), "within P883, P840 = YESP61x.");
  EXPECT_EQ(unit_text(unit_named("md60a"), text), "within P815, P840 = YESP61x.");
  EXPECT_EQ(unit_text(unit_named("mc07"), text), "within P815, P840 = YESP60x.");
  EXPECT_EQ(unit_text(unit_named("mc31"), text), "within its timeout, P60x.");
  EXPECT_EQ(unit_text(unit_named("mc31"), "without braces P815"), "without braces P815");
  EXPECT_EQ(unit_text(unit_named("mc31"), "{P815}"), "") << "no alternative is left";
  EXPECT_EQ(unit_text(unit_named("mc31"), ""), "");
}

TEST(UnitText, KnowsNamesOfParameters) {
  EXPECT_EQ(named_parameters("P815, P60x/P61x; P830..P837 (P10), PO1, xP815, P8151, P1x0"),
            (std::vector<std::string>{"P815", "P60x", "P61x", "P830", "P837"}));
  EXPECT_TRUE(has_named(unit_named("mc31"), "P572"));
  EXPECT_FALSE(has_named(unit_named("mc31"), "P815"));
  EXPECT_TRUE(has_named(unit_named("mc31"), "P60x"));
  EXPECT_FALSE(has_named(unit_named("mc31"), "P61x"));
}

std::string closest(std::string_view name, std::vector<std::string_view> candidates) {
  return std::string(nearest(name, candidates));
}

// The fewest letters taken out, put in, changed or swapped with their neighbour, by trying all ways.
size_t steps_between(std::string_view a, std::string_view b) {
  if (a.empty() || b.empty()) return a.size() + b.size();
  size_t least = steps_between(a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1);
  least = std::min({least, steps_between(a.substr(1), b) + 1, steps_between(a, b.substr(1)) + 1});
  if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0])
    least = std::min(least, steps_between(a.substr(2), b.substr(2)) + 1);
  return least;
}

// All words of up to four letters from "ab": found when one step of three letters, or three of nine, is enough.
TEST(Spelling, CountsStepsAsTryingAllWaysDoes) {
  std::vector<std::string> words{""};
  for (size_t n = 0; n < words.size() && words[n].size() < 4; ++n)
    for (const char c : {'a', 'b'}) words.push_back(words[n] + c);
  for (const std::string& a : words)
    for (const std::string& b : words) {
      // With a tail in common the same number of steps is between them.
      const std::string name = a + "xyzuvwxyz";
      const std::string candidate = b + "xyzuvwxyz";
      const bool found = steps_between(a, b) <= std::min<size_t>(name.size() / 3, 3) &&
                         candidate.size() <= name.size() + 3 && name.size() <= candidate.size() + 3;
      EXPECT_EQ(closest(name, {candidate}) == candidate, found) << name << " " << candidate;
      EXPECT_EQ(closest("xyzuvwxyz" + a, {"xyzuvwxyz" + b}).empty(),
                !found && a.rfind(b, 0) != 0 && b.rfind(a, 0) != 0)
          << a << " " << b;
    }
}

TEST(Spelling, AllowsAStepForThreeLettersAndThreeAtMost) {
  EXPECT_EQ(closest("ab", {"ac"}), "");
  EXPECT_EQ(closest("abc", {"abd"}), "abd");
  EXPECT_EQ(closest("abc", {"add"}), "");
  EXPECT_EQ(closest("abcde", {"xycde"}), "");
  EXPECT_EQ(closest("abcdef", {"xycdef"}), "xycdef");
  EXPECT_EQ(closest("abcdefgh", {"xyzdefgh"}), "");
  EXPECT_EQ(closest("abcdefghi", {"xyzdefghi"}), "xyzdefghi");
  EXPECT_EQ(closest("abcdefghijkl", {"xyzwefghijkl"}), "");
  EXPECT_EQ(closest("abcdefghi", {"defghi"}), "defghi");
  EXPECT_EQ(closest("abcdefghij", {"efghij"}), "");
  EXPECT_EQ(closest("defghidefghi", {"abcdefghidefghi"}), "abcdefghidefghi");
  EXPECT_EQ(closest("bacd", {"abcd"}), "abcd") << "neighbours swapped are one step";
  EXPECT_EQ(closest("abdc", {"abcd"}), "abcd");
  EXPECT_EQ(closest("SPEED", {"speed"}), "speed") << "capitals make no step";
  EXPECT_EQ(closest("sPeEd", {"Z", "SpEeD"}), "SpEeD");
  EXPECT_EQ(closest("abcdef", {"abcxyz", "abcdex", "abcxef"}), "abcdex") << "the first of the nearest";
  EXPECT_EQ(closest("abcdef", {"abcdex", "abcdey"}), "abcdex");
  EXPECT_EQ(closest("", {"a"}), "");
  EXPECT_EQ(closest("a", {}), "");
}

TEST(Spelling, LeavesLongNamesAlone) {
  const std::string longest(64, 'x');
  EXPECT_EQ(closest(longest, {longest}), longest);
  EXPECT_EQ(closest(longest + "x", {longest + "x"}), "");
}

TEST(Spelling, TakesABeginningOfFourLetters) {
  EXPECT_EQ(closest("abcdefghijk", {"abc"}), "");
  EXPECT_EQ(closest("abcdefghijk", {"abcd"}), "abcd");
  EXPECT_EQ(closest("ABCDefghijk", {"abcd"}), "abcd");
  EXPECT_EQ(closest("abcdefghijk", {"abcde", "abcdef", "abcd"}), "abcdef") << "the longest it begins with";
  EXPECT_EQ(closest("abcd", {"abcdefghijkl", "abcdefghij"}), "abcdefghij")
      << "the shortest that begins with it";
  EXPECT_EQ(closest("abcd", {"abcdefghij", "abcdefghijkl"}), "abcdefghij");
  EXPECT_EQ(closest("abc", {"abcdefghij"}), "");
  EXPECT_EQ(closest("abcdefghijk", {"abcdefghijklmnopq", "abcd"}), "abcd");
  EXPECT_EQ(closest("abcdefghijk", {"abce"}), "");
}

TEST(Spelling, EqualButForCase) {
  EXPECT_TRUE(equal_but_for_case("AZaz09_", "azAZ09_"));
  EXPECT_TRUE(equal_but_for_case("", ""));
  for (const auto& [a, b] :
       {std::pair{"a", "ab"}, {"ab", "a"}, {"a", "b"}, {"@", "`"}, {"[", "{"}, {"", "a"}})
    EXPECT_FALSE(equal_but_for_case(a, b)) << a << b;
}

TEST(HeaderNames, AreTheDefinesWithAText) {
  std::map<std::string_view, size_t> headers;
  for (const HeaderName& row : header_names()) {
    ++headers[row.header];
    EXPECT_FALSE(row.name.empty());
    EXPECT_FALSE(row.text.empty());
    EXPECT_EQ(row.name.find_first_of(" \t\r\n"), std::string_view::npos) << row.name;
    EXPECT_FALSE(row.text.starts_with(' ') || row.text.ends_with(' ') || row.text.ends_with('\r') ||
                 row.text.find("//") != std::string_view::npos)
        << row.name << " <" << row.text << ">";
  }
  EXPECT_EQ(headers.size(), 4U);
  // const.h: MOVILINK's constants and the first and last lines; the inputs of both generations of units.
  EXPECT_EQ(find_header_name("GO_WAIT", false)->text, "1");
  EXPECT_EQ(find_header_name("TargetPos", false)->text, "H492");
  EXPECT_EQ(find_header_name("TargetPos", true)->header, "const.h") << "the only one";
  EXPECT_EQ(find_header_name("TargetPos", false)->header, "const.h");
  EXPECT_EQ(find_header_name("DI00", true)->header, "iob.h");
  EXPECT_EQ(find_header_name("DI00", false)->header, "io.h");
  EXPECT_EQ(find_header_name("nothing", false), nullptr);
}

TEST(LanguageTables, FunctionsByBothSpellings) {
  for (const SystemFunction& function : system_functions())
    EXPECT_EQ(find_system_function(function.name), &function);
  EXPECT_EQ(find_system_function("_Movilink")->name, "_MoviLink");
  EXPECT_EQ(find_system_function("_SBusComDef")->name, "_SBusCommDef");
  EXPECT_EQ(find_system_function("_movilink"), nullptr);
  EXPECT_EQ(find_system_function(""), nullptr);
}

TEST(LanguageTables, StructuresWithTheirSpellings) {
  // 1053 1610 p. 54: six variables, two of them with a second spelling.
  const Structure* cyclic = find_structure("SCTRCYCL");
  ASSERT_NE(cyclic, nullptr);
  using Names = std::vector<std::string_view>;
  EXPECT_EQ(cyclic->members, (std::vector<Names>{{"ObjectNo"},
                                                 {"CycleTime", "Cycletime"},
                                                 {"Offset"},
                                                 {"Format", "Len"},
                                                 {"DPointer"},
                                                 {"Result"}}));
  EXPECT_EQ(find_structure("SCREC")->members.size(), 3U);
  EXPECT_EQ(find_structure("nothing"), nullptr);
  for (const Structure& structure : structures()) EXPECT_EQ(find_structure(structure.name), &structure);
}

TEST(LanguageTables, WhatMembersHold) {
  ASSERT_NE(find_member_use("MOVLNK", "Format"), nullptr);
  EXPECT_EQ(find_member_use("MOVLNK", "Format")->constants(),
            (std::vector<std::string_view>{"ML_FT_", "ML_CFT_"}));
  EXPECT_FALSE(find_member_use("MOVLNK", "Format")->holds_number());
  EXPECT_TRUE(find_member_use("MOVLNK", "DPointer")->holds_number());
  EXPECT_TRUE(find_member_use("MOVLNK", "DPointer")->constants().empty());
  EXPECT_EQ(find_member_use("SCREC", "Format"), nullptr);
  EXPECT_EQ(find_member_use("MOVLNK", "Index"), nullptr);
  for (const MemberUse& use : member_uses()) {
    const Structure* structure = find_structure(use.structure);
    ASSERT_NE(structure, nullptr) << use.structure;
    EXPECT_TRUE(std::any_of(structure->members.begin(), structure->members.end(), [&](const auto& names) {
      return names.front() == use.member;
    })) << use.member;
  }
}

TEST(Services, ByTheirCodes) {
  // 1053 1610 p. 48 and 70: services 0 to 8 of the parameter channel.
  const char* texts[] = {"no service",   "read",         "write",      "write volatile", "read minimum",
                         "read maximum", "read default", "read scale", "read attribute"};
  for (uint32_t code = 0; code < 9; ++code) {
    ASSERT_TRUE(service_from_code(code)) << code;
    EXPECT_EQ(service_text(*service_from_code(code)), texts[code]);
    EXPECT_EQ(is_write(*service_from_code(code)), code == 2 || code == 3) << code;
  }
  EXPECT_FALSE(service_from_code(9));
  EXPECT_FALSE(service_from_code(256));
  EXPECT_EQ(service_text(static_cast<Service>(9)), "");
}

TEST(UnitTypes, ByNameAndCode) {
  std::set<uint8_t> codes;
  for (const UnitType& unit : unit_types()) {
    EXPECT_EQ(find_unit(unit.name), &unit);
    EXPECT_EQ(find_unit(unit.code), &unit);
    EXPECT_TRUE(codes.insert(unit.code).second);
  }
  EXPECT_EQ(find_unit("MD60A"), nullptr);
  EXPECT_EQ(find_unit(uint8_t{0}), nullptr);
  EXPECT_EQ(find_unit(uint8_t{255}), nullptr);
}

TEST(Faults, ByTheirNumbers) {
  for (const FaultRow& row : fault_table()) EXPECT_EQ(find_fault(row.number), &row);
  EXPECT_EQ(find_fault(255), nullptr);
  EXPECT_EQ(find_fault(47)->number, 47);
}

}  // namespace
}  // namespace ipos::stdlib

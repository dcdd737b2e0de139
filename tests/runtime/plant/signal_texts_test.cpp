// Signals by themselves: their numbers as text, their bits, names and patterns, fields of telegrams, names of
// variables, and the hash over what a plant shows.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "runtime/plant/trace_hash.hpp"
#include "runtime/signals/find.hpp"
#include "runtime/signals/telegram_lines.hpp"
#include "runtime/signals/variables.hpp"

namespace ipos::runtime {
namespace {

signals::Signal signal_with(double factor, int decimals) {
  signals::Signal signal;
  signal.name = "u.x";
  signal.station = "u";
  signal.factor = factor;
  signal.decimals = decimals;
  return signal;
}

TEST(SignalText, APowerOfTenSetsThePoint) {
  for (const auto& [decimals, sample, text] :
       {std::tuple(0, int64_t{0}, "0"), std::tuple(0, int64_t{7}, "7"), std::tuple(0, int64_t{-10}, "-10"),
        std::tuple(1, int64_t{5}, "0.5"), std::tuple(1, int64_t{-5}, "-0.5"),
        std::tuple(1, int64_t{100}, "10.0"), std::tuple(2, int64_t{-12345}, "-123.45"),
        std::tuple(3, int64_t{0}, "0.000"), std::tuple(3, int64_t{1}, "0.001"),
        std::tuple(3, int64_t{-1}, "-0.001"), std::tuple(3, int64_t{999}, "0.999"),
        std::tuple(3, int64_t{1000}, "1.000"), std::tuple(3, int64_t{4294967295}, "4294967.295"),
        std::tuple(6, int64_t{1}, "0.000001"), std::tuple(6, int64_t{-12345678}, "-12.345678")})
    EXPECT_EQ(signal_with(std::pow(10, -decimals), decimals).text(sample), text) << sample;
}

TEST(SignalText, OtherFactorsAreMultiplied) {
  EXPECT_EQ(signal_with(0.2, 1).text(-5), "-1.0");
  EXPECT_EQ(signal_with(1, 2).text(5), "5.00") << "the point is not where the factor sets it";
  EXPECT_EQ(signal_with(0.01, 1).text(-1234), "-12.3");
  EXPECT_EQ(signal_with(1e-7, 7).text(12), "0.0000012");
  EXPECT_EQ(signal_with(0.0625, 4).text(3), "0.1875");
  // Beyond 2 to the power of 40 as a double, with the same digits.
  EXPECT_EQ(signal_with(1, 0).text(int64_t{1} << 40), "1099511627776");
  EXPECT_EQ(signal_with(1, 0).text(-(int64_t{1} << 40)), "-1099511627776");
  EXPECT_EQ(signal_with(1, 0).text((int64_t{1} << 40) - 1), "1099511627775");
  std::string text = "x = ";
  signal_with(0.1, 1).append_text(text, 15);
  EXPECT_EQ(text, "x = 1.5");
}

TEST(SignalBits, OfFieldsAndVariables) {
  const auto count = [](signals::Group group, size_t bits) {
    signals::Signal signal = signal_with(1, 0);
    signal.group = group;
    signal.bits = bits;
    return signals::bit_count(signal);
  };
  EXPECT_EQ(count(signals::Group::Variable, 0), 32U);
  EXPECT_EQ(count(signals::Group::SystemVariable, 0), 32U);
  EXPECT_EQ(count(signals::Group::ProcessData, 16), 16U);
  EXPECT_EQ(count(signals::Group::Bus, 2), 2U);
  EXPECT_EQ(count(signals::Group::Input, 1), 0U) << "it is a bit itself";
  EXPECT_EQ(count(signals::Group::Drive, 0), 0U) << "a number";
  signals::Signal status = signal_with(1, 0);
  status.is_status = true;
  status.decided = [](const Drive&) -> int64_t { return 0; };
  status.read = [] { return int64_t{0b1010}; };
  for (size_t bit = 0; bit < 6; ++bit) {
    const signals::Signal one = signals::bit_of(status, bit);
    EXPECT_EQ(one.read(), bit == 1 || bit == 3 ? 1 : 0);
    EXPECT_EQ(std::tuple(one.name, one.bits, one.is_status, one.decided == nullptr),
              std::tuple(fmt::format("u.x.{}", bit), 1U, false, true));
    EXPECT_EQ(one.meaning, fmt::format("bit {} of u.x", bit));
  }
  status.read = [] { return int64_t{-1}; };
  EXPECT_EQ(signals::bit_of(status, 31).read(), 1);
}

std::vector<signals::Signal> some_signals() {
  std::vector<signals::Signal> all;
  for (const auto& [name, bits] : {std::pair("u.a", 4), std::pair("u.ab", 0), std::pair("u.b.c", 16)}) {
    all.push_back(signal_with(1, 0));
    all.back().name = name;
    all.back().group = signals::Group::Bus;
    all.back().bits = static_cast<size_t>(bits);
    all.back().read = [] { return int64_t{0}; };
  }
  return all;
}

TEST(SignalNames, AmongOthers) {
  const auto all = some_signals();
  const auto found = [&](std::string_view name) {
    const auto one = signals::find_among(all, name);
    return one ? one->name : "none";
  };
  for (const char* name : {"u.a", "u.ab", "u.b.c", "u.a.0", "u.a.3", "u.b.c.15"})
    EXPECT_EQ(found(name), name);
  for (const char* name :
       {"u.a.4", "u.a.-1", "u.a.x", "u.a.1x", "u.a.", "u.ab.0", "u.b", "u.b.c.16", "u", "", "a"})
    EXPECT_EQ(found(name), "none") << name;
  const auto matching = [&](std::string_view pattern) {
    std::vector<std::string> names;
    for (const signals::Signal& signal : signals::match_among(all, pattern)) names.push_back(signal.name);
    return names;
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(matching("u.a*"), (Names{"u.a", "u.ab"}));
  EXPECT_EQ(matching("u.a.?"), (Names{"u.a.0", "u.a.1", "u.a.2", "u.a.3"}));
  EXPECT_EQ(matching("u.b.c.1?"),
            (Names{"u.b.c.10", "u.b.c.11", "u.b.c.12", "u.b.c.13", "u.b.c.14", "u.b.c.15"}));
  EXPECT_EQ(matching("*.3"), (Names{"u.a.3", "u.b.c.3"}));
  EXPECT_EQ(matching("x*"), Names{});
  EXPECT_EQ(matching("?b"), Names{}) << "no dot at all";
  EXPECT_EQ(signals::names_of(all), "a, ab, b.c");
  EXPECT_EQ(signals::names_of({}), "");
}

TEST(SignalNames, PatternsHaveAStarOrAQuestionMark) {
  EXPECT_TRUE(signals::is_pattern("a*") && signals::is_pattern("?a"));
  EXPECT_FALSE(signals::is_pattern("a.b[1]") || signals::is_pattern(""));
  for (const auto& [pattern, text, fits] :
       {std::tuple("", "", true), std::tuple("a", "a", true), std::tuple("a", "b", false),
        std::tuple("a", "ab", false), std::tuple("ab", "a", false), std::tuple("**", "ab", true),
        std::tuple("a*", "a", true), std::tuple("a*", "ba", false), std::tuple("*a", "aba", true),
        std::tuple("*ab", "aab", true), std::tuple("*ab*ab", "abab", true),
        std::tuple("*ab*ab", "aba", false), std::tuple("a?c", "abc", true), std::tuple("a?c", "ac", false),
        std::tuple("*?", "", false), std::tuple("*?", "x", true), std::tuple("a*b?d", "axbxbcd", true),
        std::tuple("a*bcd", "abcbcdd", false)})
    EXPECT_EQ(signals::matches(pattern, text), fits) << pattern << " and " << text;
}

TEST(SignalNames, GroupsHaveWords) {
  const char* const words[] = {"drive",        "states", "inputs",    "outputs",          "analog inputs",
                               "process data", "tasks",  "variables", "system variables", "parameters",
                               "bus"};
  for (size_t n = 0; n < std::size(words); ++n) EXPECT_EQ(signals::group_text(static_cast<signals::Group>(n)), words[n]);
}

// Bytes behind the end count as 0.
TEST(TelegramFields, AreNumbersInBytes) {
  const std::vector<uint8_t> data = {0x81, 0x02, 0x03, 0xFF, 0xFE};
  const auto number = [&](uint8_t byte, uint8_t bytes, bool intel, bool is_signed = false,
                          uint32_t mask = 0xFFFFFFFF) {
    return signals::number_in(data, {signals::TelegramMessage::Bytes, "x", byte, bytes, intel, is_signed, mask, 0, ""});
  };
  EXPECT_EQ(number(0, 1, false), 0x81);
  EXPECT_EQ(number(1, 2, false), 0x0203);
  EXPECT_EQ(number(1, 2, true), 0x0302);
  EXPECT_EQ(number(0, 4, false), 0x810203FF);
  EXPECT_EQ(number(0, 4, false, true), int64_t{0x810203FF} - (int64_t{1} << 32));
  EXPECT_EQ(number(1, 4, true), 0xFEFF0302);
  EXPECT_EQ(number(4, 2, false), 0xFE00);
  EXPECT_EQ(number(4, 2, true), 0x00FE);
  EXPECT_EQ(number(5, 1, false), 0);
  EXPECT_EQ(number(0, 1, false, false, 0x0F), 1);
  EXPECT_EQ(number(0, 1, false, false, 0x80), 1) << "a bit of its own";
  EXPECT_EQ(number(1, 1, false, false, 0x80), 0);
}

TEST(VariableNames, OfElementsAndWholes) {
  const vm::Symbol symbols[] = {{"x", 5, 1}, {"a", 10, 3}, {"s.b", 20, 1}, {"s.c", 21, 2}, {"st", 30, 1}};
  const stdlib::UnitType& unit = *stdlib::find_unit("mdxb");
  const auto named = [&](std::string_view name) {
    std::string text;
    for (const signals::NamedVariable& variable : signals::named_variables(symbols, unit, name))
      text += fmt::format("{}={} ", variable.name, variable.number);
    return text;
  };
  EXPECT_EQ(named("x"), "x=5 ");
  EXPECT_EQ(named("x[0]"), "x[0]=5 ");
  EXPECT_EQ(named("a"), "a[0]=10 a[1]=11 a[2]=12 ");
  EXPECT_EQ(named("a[0]"), "a[0]=10 ");
  EXPECT_EQ(named("a[2]"), "a[2]=12 ");
  for (const char* wrong : {"a[3]", "a[-1]", "a[]", "a[1", "a1]", "a[1]]", "a[x]", "b", "", "s.", "sx"})
    EXPECT_EQ(named(wrong), "") << wrong;
  EXPECT_EQ(named("s"), "s.b=20 s.c[0]=21 s.c[1]=22 ") << "not st";
  EXPECT_EQ(named("s.c"), "s.c[0]=21 s.c[1]=22 ");
  EXPECT_EQ(named("H7"), "H7=7 ");
  EXPECT_EQ(named("H007"), "H7=7 ");
  EXPECT_EQ(named("H1023"), "H1023=1023 ") << "MOVIDRIVE B has 1024 variables";
  for (const char* wrong : {"H1024", "H", "H-1", "H1x", "h1"}) EXPECT_EQ(named(wrong), "") << wrong;
  EXPECT_EQ(named("ActPos_Mot"), "ActPos_Mot=511 ");
}

// FNV-1a with 64 bits; the vectors are those of its authors.
TEST(PlantHash, IsFnv) {
  const auto of = [](std::string_view text) {
    NumberHash hash;
    for (const char c : text) hash.add(static_cast<unsigned char>(c));
    return hash.value();
  };
  EXPECT_EQ(of(""), 0xCBF29CE484222325U);
  EXPECT_EQ(of("a"), 0xAF63DC4C8601EC8CU);
  EXPECT_EQ(of("foobar"), 0x85944171F73967E8U);
  NumberHash text, all;
  text.add_text("ab");
  all.add_all(2, 'a', 'b');
  EXPECT_EQ(text.value(), all.value()) << "the length stands in front";
}

TEST(PlantHash, EveryOneOfManyCounts) {
  for (size_t size = 1; size <= 20; ++size) {
    std::vector<int32_t> values(size);
    for (size_t n = 0; n < size; ++n) values[n] = static_cast<int32_t>(n) - 3;
    const auto hash = [&values] {
      NumberHash all;
      all.add_many(values);
      return all.value();
    };
    const uint64_t before = hash();
    for (int32_t& value : values) {
      value ^= 1 << 30;
      EXPECT_NE(hash(), before) << size;
      value ^= 1 << 30;
    }
    EXPECT_EQ(hash(), before);
    for (size_t n = 0; n + 1 < size; ++n) {
      std::swap(values[n], values[n + 1]);
      EXPECT_NE(hash(), before) << size << ": " << n << " and the next exchanged";
      std::swap(values[n], values[n + 1]);
    }
  }
}

}  // namespace
}  // namespace ipos::runtime

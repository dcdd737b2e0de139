// The parameters of terminals and process data as the control reads them: each belongs to its place and to no other.
#include "runtime/drive/settings.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/runtime/drive/fake_drive.hpp"

namespace ipos::runtime {
namespace {

struct Place {
  std::array<uint8_t, 16> Settings::*terminals;
  size_t bit;
};

// P600 to P604 are DI01 to DI05, P610 to P617 are DI10 to DI17, P620 and P621 are DO01 and DO02, P630 to P637 are DO10 to
// DO17 (1053 1610 p. 78, 79).
std::optional<Place> place_of(int number) {
  const auto in = [&](int first, int count) { return number >= first && number < first + count; };
  const auto at = [&](int first, int bit) { return static_cast<size_t>(number - first + bit); };
  if (in(600, 5)) return Place{&Settings::inputs, at(600, 1)};
  if (in(610, 8)) return Place{&Settings::inputs, at(610, 8)};
  if (in(620, 2)) return Place{&Settings::outputs, at(620, 1)};
  if (in(630, 8)) return Place{&Settings::outputs, at(630, 8)};
  return std::nullopt;
}

TEST(Settings, EveryTerminalHasItsOwnParameter) {
  for (const char* name : {"md60a", "compact", "mdxb", "mc07"}) {
    ParameterStore store(tests::unit(name));
    const SettingsReader reader(store);
    int terminals = 0;
    for (int number = 600; number < 640; ++number) {
      const stdlib::Parameter* row = store.table().find("P" + std::to_string(number));
      if (row == nullptr || !row->writable) continue;
      const Settings before = reader.read(store);
      const int32_t value = store.value(row->index) == 0 ? 1 : 0;
      ASSERT_TRUE(store.preset(row->index, value)) << number;
      Settings want = before;
      const auto place = place_of(number);
      ASSERT_TRUE(place) << "P" << number << " of " << name;
      (want.*place->terminals)[place->bit] = static_cast<uint8_t>(value);
      // DI01 of MOVITRAC 07 is CW/STOP whatever stands there (its manual, chapter 10.3).
      if (name == std::string_view("mc07")) want.inputs[1] = before.inputs[1];
      EXPECT_EQ(reader.read(store) == want, true) << "P" << number << " of " << name;
      ++terminals;
    }
    // The option card DIO is of MOVIDRIVE A and B.
    EXPECT_EQ(terminals >= 23, name[0] == 'm' && name[1] == 'd') << name;
    EXPECT_GE(terminals, 6) << name;
  }
}

// P870 to P872 describe PO1 to PO3, P873 to P875 PI1 to PI3 (1053 1610 p. 82).
TEST(Settings, EveryProcessWordHasItsOwnDescription) {
  for (const char* name : {"md60a", "compact", "mdxb", "mc07"}) {
    ParameterStore store(tests::unit(name));
    const SettingsReader reader(store);
    for (int number = 870; number < 876; ++number) {
      const Settings before = reader.read(store);
      const uint16_t index = store.table().find("P" + std::to_string(number))->index;
      const int32_t value = store.value(index) == 0 ? 1 : 0;
      ASSERT_TRUE(store.preset(index, value)) << number;
      Settings want = before;
      const auto word = static_cast<size_t>(number - 870);
      (word < 3 ? want.po : want.pi)[word % 3] = static_cast<uint8_t>(value);
      EXPECT_EQ(reader.read(store) == want, true) << "P" << number << " of " << name;
    }
  }
}

}  // namespace
}  // namespace ipos::runtime

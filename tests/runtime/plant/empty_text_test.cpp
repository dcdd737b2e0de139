// A text that is given and empty is a mistake, whatever takes it: it is not the same as none.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {
namespace {

struct Table {
  const char* text;  // with all that it needs, but for the key
  const char* key;
};

TEST(EmptyText, IsAMistakeInEveryTable) {
  constexpr Table kTables[] = {
      {"[[station]]\nunit = 'md60a'\n", "name"},
      {"[[station]]\nname = 'u'\n", "unit"},
      {"[[station]]\nname = 'u'\nunit = 'md60a'\n", "program"},
      {"[[station]]\nname = 'u'\nunit = 'md60a'\n", "sbus"},
      {"[[station]]\nname = 'u'\nunit = 'mdxb'\n", "sbus2"},
      {"[[station]]\nname = 'u'\nunit = 'md60a'\n", "rs485"},
      {"[[station]]\nname = 'u'\nunit = 'md60a'\n", "nvram"},
      {"[[station]]\nname = 'u'\nunit = 'md60a'\n", "device"},
      {"[[bus]]\nkind = 'can'\n", "name"},
      {"[[bus]]\nname = 'b'\n", "kind"},
      {"[[bus]]\nname = 'b'\nkind = 'can'\n", "port"},
      {"[[control]]\nsbus = 'b'\n", "name"},
      {"[[wire]]\nto = 'u.DI03'\n", "from"},
      {"[[wire]]\nfrom = 'u.DO01'\n", "to"},
      {"[[fault]]\nat = '1ms'\n", "kind"},
  };
  for (const Table& it : kTables) {
    const std::string text = std::string(it.text) + it.key + " = \"\"\n";
    const auto lines = static_cast<uint32_t>(std::count(text.begin(), text.end(), '\n'));
    const std::string expected = std::string(it.key) + " must not be empty";
    bool found = false;
    for (const PlantError& error : read_plant_file(text).errors)
      found |= error.text == expected && error.place.line == lines &&
               error.place.column == std::string(it.key).size() + 4;
    EXPECT_TRUE(found) << text;
  }
}

}  // namespace
}  // namespace ipos::runtime

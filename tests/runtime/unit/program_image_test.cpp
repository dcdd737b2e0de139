// What an image of a stranger may say of a unit: nothing beyond its memory, and no name that acts where it is shown.
#include "runtime/unit/program_image.hpp"

#include <gtest/gtest.h>

#include "stdlib/unit_types.hpp"

namespace ipos::runtime {
namespace {

vm::Image sample() {
  vm::Image image;
  image.unit = 1;
  image.code = {0x02, 0x02, 0x02};
  image.symbols = {{"H0", 0, 1}, {"TrCycl.ObjectNo", 420, 1}, {"buffer", 430, 10}};
  image.functions = {{"main", 0}, {"helper", 2}};
  image.files = {"A.IPC", "const.h"};
  image.lines = {{0, 0, 3, 5}, {2, 1, 70000, 1}};
  return image;
}

std::string refusal(const vm::Image& image) {
  const auto read = read_program_image(vm::write_image(image));
  return read ? "" : read.error();
}

TEST(ProgramImage, IsTakenAsItIs) {
  EXPECT_EQ(read_program_image(vm::write_image(sample())), sample());
  EXPECT_EQ(read_program_image(std::vector<uint8_t>{1, 2, 3}).error(), "refused at byte 0: the file is not an ipos image");
}

// Whoever shows a symbol reads all its variables.
TEST(ProgramImage, RowsBeyondTheUnitAreRefused) {
  for (const stdlib::UnitType& unit : stdlib::unit_types()) {
    if (unit.tasks == 0) continue;
    const auto refused = [&](uint32_t variable, uint32_t count) {
      vm::Image image = sample();
      image.unit = unit.code;
      image.symbols = {{"x", static_cast<uint16_t>(variable), static_cast<uint16_t>(count)}};
      const std::string why = refusal(image);
      EXPECT_TRUE(why.empty() || why.find("symbol 'x'") != std::string::npos) << why;
      return !why.empty();
    };
    const uint32_t all = unit.variables;
    EXPECT_FALSE(refused(0, all)) << unit.name;
    EXPECT_FALSE(refused(all - 1, 1)) << unit.name;
    EXPECT_TRUE(refused(0, all + 1)) << unit.name;
    EXPECT_TRUE(refused(all - 1, 2)) << unit.name;
    EXPECT_TRUE(refused(all, 1)) << unit.name;
    EXPECT_TRUE(refused(500, 3000)) << unit.name;
    EXPECT_TRUE(refused(65535, 65535)) << unit.name;  // no sum that goes round
  }
  vm::Image image = sample();
  const auto words = static_cast<uint32_t>(image.code.size());
  image.functions = {{"last", words - 1}};
  image.lines = {{words - 1, 1, UINT32_MAX, UINT16_MAX}};
  EXPECT_EQ(refusal(image), "");
  for (const uint32_t beyond : {words, words + 1, UINT32_MAX}) {
    vm::Image bad = image;
    bad.functions[0].address = beyond;
    EXPECT_NE(refusal(bad), "") << beyond;
    bad = image;
    bad.lines[0].address = beyond;
    EXPECT_NE(refusal(bad), "") << beyond;
  }
  image.lines[0].file = 2;
  EXPECT_NE(refusal(image), "");
}

TEST(ProgramImage, NamesWithControlCharactersAreRefused) {
  for (const char* part : {"\x1b[2J", "\n", "\r", "\t", "\a", "\x7f", "\x9b", "\xc2\x9b"})
    for (const int table : {0, 1, 2}) {
      vm::Image image = sample();
      std::string* names[] = {&image.symbols[0].name, &image.functions[1].name, &image.files[1]};
      *names[table] = std::string("a") + part + "b";
      EXPECT_EQ(refusal(image), "refused: a name has control characters") << table << " " << part;
    }
  vm::Image image = sample();
  image.symbols[0].name = "a\xe4" "b";  // Latin-1
  image.functions[0].name = "\xc3\xa4";
  EXPECT_EQ(refusal(image), "");
}

}  // namespace
}  // namespace ipos::runtime

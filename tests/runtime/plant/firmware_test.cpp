// Keys `firmware` and `start_up` of a station: what they refuse, and what the unit shows and accepts.
#include <gtest/gtest.h>

#include <tuple>

#include "runtime/plant/plant.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"

namespace ipos::runtime {
namespace {

std::vector<PlantError> errors_of(const std::string& keys) {
  PlantFileResult result = read_plant_file("[[station]]\nname = \"u\"\nunit = \"mc07\"\n" + keys);
  if (!result.errors.empty()) return result.errors;
  std::vector<PlantError> errors;
  const Plant plant(std::move(result.plant), {std::nullopt}, std::nullopt, errors);
  return errors;
}

TEST(Firmware, IsShownAndDecidesAboutCodes) {
  EXPECT_TRUE(errors_of("[station.parameters]\nP121 = 2\nP100 = 11\n").empty())
      << "the newest one by default";
  EXPECT_TRUE(errors_of("firmware = 12\n[station.parameters]\nP100 = 11\n").empty());
  const auto old = errors_of("firmware = 12\n[station.parameters]\nP121 = 2\n");
  ASSERT_EQ(old.size(), 1U);
  EXPECT_EQ(old[0].place.line, 6U);
  EXPECT_NE(old[0].text.find("P121"), std::string::npos) << old[0].text;

  PlantFileResult result = read_plant_file("[[station]]\nname = \"u\"\nunit = \"mc07\"\nfirmware = 13\n");
  std::vector<PlantError> errors;
  Plant plant(std::move(result.plant), {std::nullopt}, std::nullopt, errors);
  EXPECT_EQ(plant.stations()[0]->drive().value("076") % 100, 13);
}

TEST(Firmware, HasTwoDigits) {
  for (const char* value : {"9", "100", "-1", "1.15", "\"15\""}) {
    const auto errors = errors_of(std::string("firmware = ") + value + "\n");
    ASSERT_EQ(errors.size(), 1U) << value;
    EXPECT_EQ(errors[0].place.line, 4U);
    EXPECT_NE(errors[0].text.find("firmware"), std::string::npos) << errors[0].text;
  }
}

// Unit type, rated current and firmware are read only, and those of the owner's unit.
TEST(UnitData, AreTheOwnersAndReadOnly) {
  tests::goes_through(tests::kPlantFile);
  PROVES("M07-PAR-23");
  for (const auto& [keys, type, current, version] :
       {std::tuple("", 0, 4'000, 16),
        {"firmware = 15\n[station.unit_rating]\ncurrent = '3.2 A'\ntype_code = 37\n", 37, 3'200, 15}}) {
    PlantFileResult result = read_plant_file(std::string("[[station]]\nname = 'u'\nunit = 'mc07'\n") + keys);
    ASSERT_TRUE(result.errors.empty());
    std::vector<PlantError> errors;
    Plant plant(std::move(result.plant), {std::nullopt}, std::nullopt, errors);
    plant.run_until(10 * kMillisecond);
    UnitInterface& unit = plant.stations()[0]->drive();
    EXPECT_EQ(unit.value("070"), type);
    EXPECT_EQ(unit.value("071"), current);
    EXPECT_EQ(unit.value("076") % 100, version);
    EXPECT_GT(unit.value("076"), 800'000'000) << "a part number before it";
    for (const int index : {8'300, 8'301, 8'361}) {
      const auto reply = unit.parameters().execute(ParameterService::Write, static_cast<uint16_t>(index), 1);
      ASSERT_FALSE(reply.has_value()) << index;
      EXPECT_EQ(reply.error().additional, 0x12) << "read access only";
    }
  }
}

TEST(StartUp, TheUnitIsNotReadyMeanwhile) {
  PlantFileResult result =
      read_plant_file("[[station]]\nname = \"u\"\nunit = \"mc07\"\nstart_up = \"300ms\"\n");
  ASSERT_TRUE(result.errors.empty());
  std::vector<PlantError> errors;
  Plant plant(std::move(result.plant), {std::nullopt}, std::nullopt, errors);
  plant.run_until(298 * kMillisecond);
  EXPECT_EQ(plant.stations()[0]->status_word_1(), 0x0000);
  plant.run_until(301 * kMillisecond);
  EXPECT_EQ(plant.stations()[0]->status_word_1(), 0x0202);
  plant.stations()[0]->power_off();
  plant.stations()[0]->power_on();
  plant.run_until(400 * kMillisecond);
  EXPECT_EQ(plant.stations()[0]->status_word_1(), 0x0000) << "after every power-on";
  for (const char* value : {"300", "\"61s\"", "\"soon\""})
    EXPECT_EQ(errors_of(std::string("start_up = ") + value + "\n").size(), 1U) << value;
}

}  // namespace
}  // namespace ipos::runtime

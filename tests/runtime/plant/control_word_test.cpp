// Process data at the station: order of the bytes on the SBus, and the warning about reserved bits.
#include <gtest/gtest.h>

#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/plant/plant.hpp"
#include "tests/harness/proves.hpp"
#include "tests/harness/reach.hpp"

namespace ipos::runtime {
namespace {

TEST(StationProcessData, HighByteFirst) {
  PROVES("M07-PD-20");
  const Frame frame = process_frame(139, {0x0006, 0x07D0, 0x0000});
  constexpr std::array<uint8_t, 6> kWant = {0x00, 0x06, 0x07, 0xD0, 0x00, 0x00};
  ASSERT_EQ(frame.length, kWant.size());
  for (size_t n = 0; n < kWant.size(); ++n) EXPECT_EQ(frame.data[n], kWant[n]) << n;
  EXPECT_EQ(process_words(frame), (ProcessWords{0x0006, 0x07D0, 0x0000}));
}

// MOVITRAC 07 chapter 6.2: bits 3, 4, 5, 7, 14, 15 are to be sent as 0 (M07-CW-06).
TEST(StationProcessData, ReservedBitsAreNamed) {
  PROVES("M07-CW-06");
  for (const auto& [word, named] : {std::pair{0x0006, ""},
                                    {0x000E, "(0008h)"},
                                    {0x0016, "(0010h)"},
                                    {0x0026, "(0020h)"},
                                    {0x0086, "(0080h)"},
                                    {0xC006, "(C000h)"},
                                    {0x3F46, ""}}) {
    tests::goes_through(tests::kPlantFile);
    PlantFileResult file = read_plant_file(
        "[[station]]\nname = \"u\"\nunit = \"mc07\"\n[station.parameters]\nP100 = 10\nP101 = 3\n");
    std::vector<PlantError> errors;
    Plant plant(std::move(file.plant), {std::nullopt}, std::nullopt, errors);
    ASSERT_TRUE(errors.empty());
    const uint16_t words[] = {static_cast<uint16_t>(word), 0, 0};
    plant.stations()[0]->drive().take_output(0, OutputChannel::Single, words);
    plant.run_until(5 * kMillisecond);
    std::string warnings;
    for (const JournalEntry& entry : plant.journal().entries())
      if (entry.weight == Weight::Warning) warnings += entry.text;
    if (std::string_view(named).empty())
      EXPECT_EQ(warnings, "") << word;
    else
      EXPECT_NE(warnings.find(named), std::string::npos) << word << " " << warnings;
  }
}

}  // namespace
}  // namespace ipos::runtime

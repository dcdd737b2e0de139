// Damaged images: every bit of ten images flipped, and every truncation, as they are and with a checksum made
// right again. Each one is refused, or accepted and runs to its budget.
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "compiler/compile.hpp"
#include "tests/fuzz/programs.hpp"
#include "tests/generated/pcg.hpp"

namespace ipos::tests {
namespace {

constexpr const char* kSources[] = {"examples/scom/SCOM1.IPC",
                                    "examples/scom/SCOM2.IPC",
                                    "examples/scom-intel/SCOM1_Intel.IPC",
                                    "examples/movilink/Movilink.IPC",
                                    "tests/language/statements/switch.IPC",
                                    "tests/language/statements/loops.IPC",
                                    "tests/language/functions/calls.IPC",
                                    "tests/language/data/indirect.IPC",
                                    "tests/language/faults/depth.IPC",
                                    "tests/language/operators/compound.IPC"};

std::vector<uint8_t> image_of(const std::string& source) {
  std::ifstream in(std::string(IPOS_SOURCE_DIR) + "/" + source, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const compiler::Compilation made = compiler::compile(source, "", text);
  return made.image ? vm::write_image(*made.image) : std::vector<uint8_t>{};
}

std::vector<uint8_t> with_checksum(std::vector<uint8_t> bytes) {
  if (bytes.size() < 4) return bytes;
  bytes.resize(bytes.size() - 4);
  const uint32_t checksum = vm::crc32(bytes);
  for (uint32_t shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<uint8_t>(checksum >> shift));
  return bytes;
}

struct Sweep {
  uint64_t images = 0;
  uint64_t refused_by_reader = 0;
  uint64_t refused_by_verifier = 0;
  uint64_t executed = 0;

  void repaired(const std::vector<uint8_t>& damaged) {
    const vm::ImageResult read = vm::read_image(with_checksum(damaged));
    if (read.error == vm::ImageError::None && limits_of(read.image.unit)) return well_formed(read.image);
    ++images;
    ++refused_by_reader;
  }

  void well_formed(const vm::Image& image) {
    ++images;
    const auto limits = limits_of(image.unit);
    const vm::Verification verified = vm::verify(image.code, *limits, {});
    if (!verified.image) {
      ++refused_by_verifier;
      return;
    }
    run_program(*verified.image, images, 1000);  // ends the test program when the machine becomes unsound
    ++executed;
  }

  void as_they_are(const std::vector<uint8_t>& damaged) {
    ++images;
    ++refused_by_reader;
    // A CRC-32 finds every single flipped bit, and a cut file ends in other bytes.
    EXPECT_NE(vm::read_image(damaged).error, vm::ImageError::None);
  }
};

TEST(ImageSweep, EveryFlippedBitAndEveryTruncation) {
  Sweep flips, cuts, short_code;
  for (const char* source : kSources) {
    const std::vector<uint8_t> image = image_of(source);
    ASSERT_FALSE(image.empty()) << source << " does not compile";
    ASSERT_EQ(vm::read_image(image).error, vm::ImageError::None);
    for (size_t byte = 0; byte < image.size(); ++byte) {
      for (int bit = 0; bit < 8; ++bit) {
        std::vector<uint8_t> damaged = image;
        damaged[byte] = static_cast<uint8_t>(damaged[byte] ^ 1U << bit);
        flips.as_they_are(damaged);
        flips.repaired(damaged);
      }
      const std::vector<uint8_t> cut(image.begin(), image.begin() + static_cast<std::ptrdiff_t>(byte));
      cuts.as_they_are(cut);
      cuts.repaired(cut);
    }
    vm::Image cut{};
    const vm::Image whole = vm::read_image(image).image;
    cut.unit = whole.unit;
    for (const uint32_t word : whole.code) {
      short_code.well_formed(cut);
      cut.code.push_back(word);
    }
  }
  for (const auto& [name, sweep] : {std::pair("flipped bits", flips), std::pair("truncations", cuts),
                                    std::pair("cut code", short_code)}) {
    std::printf("%s: %llu images, %llu refused by the reader, %llu by the verifier, %llu executed\n", name,
                static_cast<unsigned long long>(sweep.images),
                static_cast<unsigned long long>(sweep.refused_by_reader),
                static_cast<unsigned long long>(sweep.refused_by_verifier),
                static_cast<unsigned long long>(sweep.executed));
    EXPECT_EQ(sweep.images, sweep.refused_by_reader + sweep.refused_by_verifier + sweep.executed);
  }
  EXPECT_GT(flips.executed, 10'000U) << "most flips in operands leave a valid program";
}

// Programs made of random choices: tasks, interrupts and system commands in any order, under a host that
// answers at random. No check of the machine's soundness (programs.cpp) may fail; interrupts have to come
// about.
TEST(RandomPrograms, CannotBreakTheMachine) {
  constexpr int kPrograms = 5'000;
  Pcg random(7);
  uint64_t commands = 0;
  for (int n = 0; n < kPrograms; ++n) {
    std::vector<uint8_t> choices(300);
    for (uint8_t& byte : choices) byte = static_cast<uint8_t>(random.next());
    Input input(choices.data(), choices.size());
    const std::vector<uint32_t> code = valid_code(input);
    const vm::Verification verified = vm::verify(code, *limits_of(4), {});
    ASSERT_TRUE(verified.image) << n;
    check_execution(*verified.image, static_cast<uint64_t>(n));
    commands += code.size();
  }
  std::printf("%d random programs, %llu words of code; routines begun: %llu\n", kPrograms,
              static_cast<unsigned long long>(commands), static_cast<unsigned long long>(routines_begun()));
  EXPECT_GT(routines_begun(), 10'000U);
}

}  // namespace
}  // namespace ipos::tests

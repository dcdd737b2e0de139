// Which telegrams of `bus.send` could enable a drive, over every address and identifier; expected by the tables of 1053 1610
// p. 18-25 (RS-485) and p. 37 (SBus), CiA 301 7.3.3 and EN 50170 volume 2.
#include "tools/serve/host/enabling_telegrams.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

namespace ipos::tools::serve {
namespace {

std::optional<EnablingTelegram> on_can(uint32_t id, const char* data, bool canopen) {
  return enabling_on_can(Arguments(Json{{"identifier", id}, {"data", data}}), canopen);
}

std::string text_of(const std::vector<uint8_t>& octets) {
  std::string text;
  for (const uint8_t octet : octets) text += fmt::format("{:02x}", octet);
  return text;
}

std::optional<EnablingTelegram> over_rs485(std::vector<uint8_t> octets) {
  octets.push_back(std::accumulate(octets.begin(), octets.end(), uint8_t{}, std::bit_xor<>()));
  return enabling_on_serial(Arguments(Json{{"data", text_of(octets)}}));
}

TEST(EnablingTelegrams, OfRs485GoToSingleUnitsOnly) {
  for (unsigned address = 0; address < 256; ++address) {
    const auto found = over_rs485({2, static_cast<uint8_t>(address), 5, 0, 6, 1, 1, 1, 1});
    ASSERT_TRUE(found) << address;
    EXPECT_EQ(found->address, address);
    EXPECT_EQ(found->unasked == nullptr, address < 100)
        << address;  // 100 to 199 groups, 253 local, 254, 255 all
    EXPECT_TRUE(over_rs485({2, static_cast<uint8_t>(address), 0x85, 0, 6, 1, 1, 1, 1})->unasked) << address;
    EXPECT_FALSE(over_rs485({2, static_cast<uint8_t>(address), 5, 0, 2, 1, 1, 1, 1})) << address;
    EXPECT_FALSE(over_rs485({0x1D, static_cast<uint8_t>(address), 5, 0, 6, 1, 1, 1, 1}))
        << address;  // an answer
  }
}

TEST(EnablingTelegrams, OfRs485HaveTheWordsOfTheirFormat) {
  for (unsigned word = 0; word < 65536; ++word)
    ASSERT_EQ(over_rs485({2, 1, 1, static_cast<uint8_t>(word >> 8), static_cast<uint8_t>(word)}).has_value(),
              (word & 7) == 6)
        << word;
  EXPECT_TRUE(over_rs485({2, 1, 3, 0, 0, 0, 6}));
  EXPECT_TRUE(over_rs485({2, 1, 5, 0, 0, 0, 0, 0, 6}));
  EXPECT_TRUE(
      over_rs485({2, 1, 4, 0x31, 0, 0x21, 0x16, 0, 0, 0, 0, 0, 6, 0, 0, 0, 0}));  // with a parameter channel
  EXPECT_FALSE(
      over_rs485({2, 1, 4, 0x31, 0, 0x21, 0x16, 0, 0, 0, 6, 0, 2, 0, 0, 0, 0}));  // the 6 is the parameter's
  EXPECT_FALSE(over_rs485({2, 1, 0x86, 0x31, 0, 0x21, 0x16, 0, 0, 0, 6}));
}

TEST(EnablingTelegrams, OnCanAreToldByTheirIdentifier) {
  for (const bool canopen : {false, true})
    for (uint32_t id = 0; id < 2048; ++id) {
      const bool po = id < 512 && (id % 8 == 3 || id % 8 == 5), group = id < 512 && id % 8 == 6;
      const auto big = on_can(id, "0006 0000 0000", canopen);
      ASSERT_EQ(big.has_value(), po || group) << id;  // the RPDO's bytes are the other way round: 0600h
      if (big) {
        EXPECT_EQ(big->address, id / 8 % 64);
        EXPECT_EQ(big->unasked == nullptr, po && !canopen) << id;
      }
      const bool rpdo = (id >= 0x200 && id < 0x280) || (id >= 0x300 && id < 0x380) ||
                        (id >= 0x400 && id < 0x480) || (id >= 0x500 && id < 0x580);
      const bool parameters = id >= 512 && id < 1024 && id % 8 >= 3;  // functions of the SBus with 512
      const auto little = on_can(id, "0600 0000 0000", canopen);
      ASSERT_EQ(little.has_value(), rpdo && (canopen || !parameters)) << id << ' ' << canopen;
      if (little) {
        EXPECT_EQ(little->address, id % 128);
        EXPECT_EQ(little->unasked == nullptr, canopen) << id;
      }
    }
  for (const char* other : {"extended", "remote"})
    EXPECT_FALSE(enabling_on_can(Arguments(Json{{"identifier", 11}, {"data", "0006"}, {other, true}}), false))
        << other;
}

std::vector<uint8_t> sd2(std::vector<uint8_t> body) {
  const auto length = static_cast<uint8_t>(body.size());
  const uint8_t check = std::accumulate(body.begin(), body.end(), uint8_t{});
  body.insert(body.begin(), {0x68, length, length, 0x68});
  body.push_back(check);
  body.push_back(0x16);
  return body;
}

TEST(EnablingTelegrams, OnProfibusAreOutputDataOfASlave) {
  const auto found = enabling_on_profibus(sd2({9, 1, 0x7D, 0, 6, 1, 1}));
  ASSERT_TRUE(found);
  EXPECT_EQ(found->address, 9);
  EXPECT_FALSE(found->unasked);
  EXPECT_TRUE(
      enabling_on_profibus(sd2({9, 1, 0x7D, 1, 2, 3, 4, 5, 0, 7, 0, 0, 6})));  // behind a parameter channel
  EXPECT_TRUE(enabling_on_profibus(sd2({127, 1, 0x46, 0, 6}))->unasked);
  EXPECT_FALSE(enabling_on_profibus(sd2({9, 1, 0x7D, 0, 2, 1, 1})));
  EXPECT_FALSE(enabling_on_profibus(sd2({9 | 0x80, 1 | 0x80, 0x7D, 61, 62, 0, 6})));  // Set_Prm
  EXPECT_FALSE(enabling_on_profibus(sd2({1, 9, 0x08, 0, 6})));                        // an answer
  EXPECT_FALSE(enabling_on_profibus({0x10, 9, 1, 0x49, 0x53, 0x16}));
}

}  // namespace
}  // namespace ipos::tools::serve

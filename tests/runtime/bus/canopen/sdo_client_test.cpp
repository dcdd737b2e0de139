// Client and server against each other: what is written in any length is read back, and any answers to a client.
#include "runtime/bus/canopen/sdo_client.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/runtime/bus/canopen/object_rig.hpp"

namespace ipos::tests {
namespace {

// Objects of any length, as another server may have them.
struct Memory final : ObjectServer {
  tl::expected<std::vector<uint8_t>, Abort> read(Time, Address) override { return data; }
  std::optional<Abort> refuses(Time, Address) override { return std::nullopt; }
  std::optional<Abort> write(Time, Address, std::span<const uint8_t>) override { return Abort::ReadOnly; }
  std::vector<uint8_t> data;
};

tl::expected<std::vector<uint8_t>, uint32_t> transfer(SdoClient& client, SdoServer& server,
                                                      SdoBytes request) {
  while (client.is_busy()) {
    const auto next = client.take(*server.take(0, request));
    if (next) request = *next;
  }
  return client.result();
}

TEST(CanopenSdoClient, ReadsAnyLength) {
  for (size_t length = 0; length <= 300; ++length) {
    Memory memory;
    for (size_t n = 0; n < length; ++n) memory.data.push_back(static_cast<uint8_t>(n * 7 + length));
    SdoServer server(memory);
    SdoClient client;
    const auto read = transfer(client, server, client.read({0x1008, 0}));
    ASSERT_TRUE(read.has_value());
    EXPECT_EQ(*read, memory.data) << length;
    EXPECT_FALSE(server.is_busy());
  }
}

TEST(CanopenSdoClient, WritesAndIsRefused) {
  ObjectRig rig;
  SdoClient client;
  const std::vector<uint8_t> value = {1, 2, 3, 4};
  EXPECT_TRUE(transfer(client, rig.server, client.write({8318, 0}, value)).has_value());
  EXPECT_EQ(rig.unit.parameters[8318], 0x0403'0201);
  const std::vector<uint8_t> word = {0x10, 0x27};
  EXPECT_TRUE(transfer(client, rig.server, client.write({0x1017, 0}, word)).has_value());
  EXPECT_EQ(rig.dictionary.value(0x1017), 10'000U);
  const auto refused = transfer(client, rig.server, client.write({0x1000, 0}, value));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error(), 0x0601'0002U);
  const std::vector<uint8_t> nine(9, 0x55);  // in segments
  EXPECT_EQ(transfer(client, rig.server, client.write({8318, 0}, nine)).error(), 0x0607'0010U);
}

TEST(CanopenSdoClient, SegmentsOfADownload) {
  SdoClient client;
  const std::vector<uint8_t> data = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  EXPECT_EQ(client.write({0x1010, 1}, data), (SdoBytes{0x21, 0x10, 0x10, 0x01, 9}));
  EXPECT_EQ(client.take({0x60, 0x10, 0x10, 0x01}), (SdoBytes{0x00, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(client.take({0x20}), (SdoBytes{0x1B, 8, 9}));
  EXPECT_EQ(client.take({0x30}), std::nullopt);
  EXPECT_TRUE(client.result().has_value());
}

TEST(CanopenSdoClient, AnyAnswers) {
  EXPECT_TRUE(rc::check("a client ends or goes on", [] {
    SdoClient client;
    const bool reads = *rc::gen::arbitrary<bool>();
    if (reads)
      client.read({0x1008, 0});
    else
      client.write({0x1008, 0}, std::vector<uint8_t>(*rc::gen::inRange<size_t>(0, 30), 1));
    for (int n = *rc::gen::inRange(1, 40); n > 0; --n) {
      SdoBytes answer{};
      for (uint8_t& byte : answer) byte = *rc::gen::arbitrary<uint8_t>();
      if (*rc::gen::inRange(0, 3) != 0) {
        static const std::vector<uint8_t> kAnswers = {0x41, 0x40, 0x43, 0x60, 0x20,
                                                      0x30, 0x00, 0x10, 0x01, 0x11};
        answer = {*rc::gen::elementOf(kAnswers), 0x08, 0x10, 0x00, answer[4], answer[5]};
      }
      const bool busy = client.is_busy();
      const auto request = client.take(answer);
      RC_ASSERT(busy || !request);
      if (request) RC_ASSERT(client.is_busy() == ((*request)[0] >> 5 != 4));
    }
  }));
}

// More octets than the server has said, or than 64 KiB where it has not: the transfer ends at once.
TEST(CanopenSdoClient, AnUploadThatDoesNotEnd) {
  constexpr uint32_t kLength = 0x0607'0010;
  SdoClient client;
  client.read({0x1008, 0});
  EXPECT_EQ(client.take({0x41, 0x08, 0x10, 0x00, 8}), (SdoBytes{0x60}));
  EXPECT_EQ(client.take({0x00, 1, 2, 3, 4, 5, 6, 7}), (SdoBytes{0x70}));
  EXPECT_EQ(client.take({0x1A, 8, 9}), (SdoBytes{0x80, 0x08, 0x10, 0x00, 0x10, 0x00, 0x07, 0x06}))
      << "nine of eight";
  EXPECT_FALSE(client.is_busy());
  EXPECT_EQ(client.result().error(), kLength);

  client.read({0x1008, 0});
  EXPECT_EQ(client.take({0x41, 0x08, 0x10, 0x00, 8}), (SdoBytes{0x60}));
  EXPECT_EQ(client.take({0x01, 1, 2, 3, 4, 5, 6, 7}),
            (SdoBytes{0x80, 0x08, 0x10, 0x00, 0x10, 0x00, 0x07, 0x06}))
      << "seven of eight, and the last";
  EXPECT_EQ(client.result().error(), kLength);

  client.read({0x1008, 0});
  EXPECT_EQ(client.take({0x40, 0x08, 0x10, 0x00}), (SdoBytes{0x60}));
  size_t octets = 0;
  for (uint8_t toggle = 0; client.is_busy() && octets < 70'000; toggle ^= 0x10) {
    client.take({toggle, 1, 2, 3, 4, 5, 6, 7});
    octets += 7;
  }
  EXPECT_EQ(octets, 65'541U) << "the first multiple of 7 above 65536";
  EXPECT_EQ(client.result().error(), kLength);
}

}  // namespace
}  // namespace ipos::tests

// SDO transfers byte by byte (CiA 301; the example of page 55 of 11264926), every abort, and any bytes at all.
#include "runtime/bus/canopen/sdo_server.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <string>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/object_rig.hpp"

namespace ipos::tests {
namespace {

constexpr SdoBytes abort_bytes(uint8_t low, uint8_t high, uint8_t sub, uint32_t code) {
  return {0x80,
          low,
          high,
          sub,
          static_cast<uint8_t>(code),
          static_cast<uint8_t>(code >> 8),
          static_cast<uint8_t>(code >> 16),
          static_cast<uint8_t>(code >> 24)};
}

TEST(CanopenSdo, ExampleOfTheManual) {
  PROVES("MDB-TOC-15");
  ObjectRig rig;
  EXPECT_EQ(rig.ask({0x40, 0x00, 0x18, 0x02}), (SdoBytes{0x4F, 0x00, 0x18, 0x02, 0x01}));
}

TEST(CanopenSdo, ExpeditedOfEachLength) {
  PROVES("MDB-TOC-15", "MDB-TOC-17");
  ObjectRig rig;
  rig.unit.parameters[0x206C] = 0;
  EXPECT_EQ(rig.ask({0x23, 0x6C, 0x20, 0x00, 0x78, 0x56, 0x34, 0x12}), (SdoBytes{0x60, 0x6C, 0x20, 0x00}));
  EXPECT_EQ(rig.unit.parameters[0x206C], 0x1234'5678);
  EXPECT_EQ(rig.ask({0x40, 0x6C, 0x20, 0x00}), (SdoBytes{0x43, 0x6C, 0x20, 0x00, 0x78, 0x56, 0x34, 0x12}));
  EXPECT_EQ(rig.ask({0x2B, 0x17, 0x10, 0x00, 0xE8, 0x03}), (SdoBytes{0x60, 0x17, 0x10, 0x00}));
  EXPECT_EQ(rig.ask({0x40, 0x17, 0x10, 0x00}), (SdoBytes{0x4B, 0x17, 0x10, 0x00, 0xE8, 0x03}));
  EXPECT_EQ(rig.ask({0x2F, 0x00, 0x14, 0x02, 0xFF}), (SdoBytes{0x60, 0x00, 0x14, 0x02}));
  EXPECT_EQ(rig.ask({0x40, 0x00, 0x14, 0x02}), (SdoBytes{0x4F, 0x00, 0x14, 0x02, 0xFF}));
  EXPECT_EQ(rig.ask({0x27, 0x17, 0x10, 0x00, 1, 2, 3}), abort_bytes(0x17, 0x10, 0, 0x0607'0010));  // 3 bytes
  // 22h: no length told; as long as the object.
  EXPECT_EQ(rig.ask({0x22, 0x17, 0x10, 0x00, 0x0A, 0x00, 0xFF, 0xFF}), (SdoBytes{0x60, 0x17, 0x10, 0x00}));
  EXPECT_EQ(rig.dictionary.value(0x1017), 10U);
  // 8318 = 1000.000 rpm.
  EXPECT_EQ(rig.ask({0x40, 0x7E, 0x20, 0x00}), (SdoBytes{0x43, 0x7E, 0x20, 0x00, 0x40, 0x42, 0x0F, 0x00}));
}

TEST(CanopenSdo, SegmentedUpload) {
  PROVES("MDB-TOC-16");
  ObjectRig rig;
  ASSERT_EQ(rig.ask({0x40, 0x08, 0x10, 0x00}), (SdoBytes{0x41, 0x08, 0x10, 0x00, 20}));  // 20 characters
  EXPECT_TRUE(rig.server.is_busy());
  EXPECT_EQ(rig.ask({0x60}), (SdoBytes{0x00, 'M', 'O', 'V', 'I', 'D', 'R', 'I'}));
  EXPECT_EQ(rig.ask({0x70}), (SdoBytes{0x10, 'V', 'E', ' ', 'M', 'D', 'X', '6'}));
  EXPECT_EQ(rig.ask({0x60}), (SdoBytes{0x03, '0', 'B', '/', '6', '1', 'B', 0}));  // 1 unused, the last
  EXPECT_FALSE(rig.server.is_busy());
}

TEST(CanopenSdo, SegmentedDownload) {
  PROVES("MDB-TOC-16");
  ObjectRig rig;
  ASSERT_EQ(rig.ask({0x21, 0x7E, 0x20, 0x00, 4}), (SdoBytes{0x60, 0x7E, 0x20, 0x00}));
  EXPECT_EQ(rig.ask({0x0A, 0x11, 0x22}), (SdoBytes{0x20}));  // 2 of 7, not the last
  EXPECT_EQ(rig.ask({0x1B, 0x33, 0x44}), (SdoBytes{0x30}));  // toggled, the last
  EXPECT_EQ(rig.unit.parameters[8318], 0x4433'2211);
  // Without a length told.
  ASSERT_EQ(rig.ask({0x20, 0x7E, 0x20, 0x00}), (SdoBytes{0x60, 0x7E, 0x20, 0x00}));
  EXPECT_EQ(rig.ask({0x07, 1, 2, 3, 4}), (SdoBytes{0x20}));
  EXPECT_EQ(rig.unit.parameters[8318], 0x0403'0201);
}

// Each transfer begins with toggle bit 0, whatever the one before ended with: here each has an odd number of segments.
TEST(CanopenSdo, EveryTransferTogglesAnew) {
  ObjectRig rig;
  for (int n = 0; n < 3; ++n) {
    ASSERT_EQ(rig.ask({0x21, 0x7E, 0x20, 0x00, 4}), (SdoBytes{0x60, 0x7E, 0x20, 0x00})) << n;
    EXPECT_EQ(rig.ask({0x07, 1, 2, 3, 4}), (SdoBytes{0x20})) << n;
    ASSERT_EQ(rig.ask({0x40, 0x08, 0x10, 0x00}), (SdoBytes{0x41, 0x08, 0x10, 0x00, 20})) << n;
    EXPECT_EQ(rig.ask({0x60}), (SdoBytes{0x00, 'M', 'O', 'V', 'I', 'D', 'R', 'I'})) << n;
    // The client begins anew in the middle.
  }
  EXPECT_EQ(rig.unit.parameters[8318], 0x0403'0201);
}

TEST(CanopenSdo, EveryAbort) {
  PROVES("MDB-TOC-16");
  ObjectRig rig;
  const auto expect = [&](const SdoBytes& request, uint32_t code) {
    const auto answer = rig.ask(request);
    ASSERT_TRUE(answer);
    EXPECT_EQ(*answer, abort_bytes(request[1], request[2], request[3], code)) << std::hex << code;
    EXPECT_FALSE(rig.server.is_busy());
  };
  expect({0x40, 0x02, 0x10, 0x00}, 0x0602'0000);              // no object
  expect({0x40, 0x18, 0x10, 0x05}, 0x0609'0011);              // no sub-index
  expect({0x23, 0x00, 0x10, 0x00, 1, 0, 0, 0}, 0x0601'0002);  // read only
  expect({0x21, 0x00, 0x10, 0x00, 4}, 0x0601'0002);           // also at the beginning of segments
  expect({0x2F, 0x17, 0x10, 0x00, 1}, 0x0607'0010);           // length
  expect({0x21, 0x17, 0x10, 0x00, 5}, 0x0607'0010);
  expect({0x2F, 0x00, 0x16, 0x00, 9}, 0x0601'0000);     // mapping of a PDO that is on
  expect({0x2F, 0x01, 0x16, 0x00, 9}, 0x0609'0031);     // too high
  expect({0x2F, 0x00, 0x18, 0x02, 250}, 0x0609'0030);   // a transmission type that is reserved
  expect({0x2B, 0x00, 0x20, 0x01, 1, 0}, 0x0800'0022);  // state
  expect({0xA0, 0x08, 0x10, 0x00, 0x7F}, 0x0504'0001);  // block upload
  expect({0xC0, 0x17, 0x10, 0x00}, 0x0504'0001);        // block download
  expect({0xE0, 0x17, 0x10, 0x00}, 0x0504'0001);        // no command
  rig.unit.refusal = return_codes::kTooLarge;
  expect({0x23, 0x7E, 0x20, 0x00, 1, 0, 0, 0}, 0x0609'0031);
  rig.unit.refusal = return_codes::kTooSmall;
  expect({0x23, 0x7E, 0x20, 0x00, 1, 0, 0, 0}, 0x0609'0032);
  rig.unit.refusal = return_codes::kReadOnly;
  expect({0x23, 0x7E, 0x20, 0x00, 1, 0, 0, 0}, 0x0601'0002);

  // Segments of no transfer.
  EXPECT_EQ(rig.ask({0x60}), abort_bytes(0, 0, 0, 0x0504'0001));
  EXPECT_EQ(rig.ask({0x00}), abort_bytes(0, 0, 0, 0x0504'0001));
  // Toggle bit, both ways.
  rig.ask({0x40, 0x08, 0x10, 0x00});
  EXPECT_EQ(rig.ask({0x70}), abort_bytes(0x08, 0x10, 0, 0x0503'0000));
  rig.ask({0x21, 0x17, 0x10, 0x00, 2});
  EXPECT_EQ(rig.ask({0x1B, 1, 0}), abort_bytes(0x17, 0x10, 0, 0x0503'0000));
  // More, and fewer, bytes than told.
  rig.ask({0x21, 0x17, 0x10, 0x00, 2});
  EXPECT_EQ(rig.ask({0x09, 1, 2, 3}), abort_bytes(0x17, 0x10, 0, 0x0607'0010));
  rig.ask({0x21, 0x17, 0x10, 0x00, 2});
  EXPECT_EQ(rig.ask({0x0D, 1}), abort_bytes(0x17, 0x10, 0, 0x0607'0010));
  // A transfer that is left.
  rig.ask({0x40, 0x08, 0x10, 0x00});
  EXPECT_EQ(rig.server.expire(), abort_bytes(0x08, 0x10, 0, 0x0504'0000));
  EXPECT_FALSE(rig.server.is_busy());
  rig.ask({0x40, 0x08, 0x10, 0x00});
  EXPECT_EQ(rig.ask({0x80, 0x08, 0x10, 0x00, 0, 0, 4, 5}), std::nullopt);  // the client's own abort
  EXPECT_FALSE(rig.server.is_busy());
}

// Whatever comes, there is at most one answer, it is a server's, and it belongs to the request.
void any_sequence() {
  ObjectRig rig;
  const auto count = *rc::gen::inRange(1, 60);
  for (int n = 0; n < count; ++n) {
    SdoBytes request{};
    for (uint8_t& byte : request) byte = *rc::gen::arbitrary<uint8_t>();
    if (*rc::gen::inRange(0, 4) != 0) {
      static const std::vector<uint8_t> kCommands = {0x40, 0x21, 0x20, 0x22, 0x23, 0x2B, 0x2F,
                                                     0x60, 0x70, 0x00, 0x10, 0x0B, 0x1B};
      static const std::vector<uint16_t> kIndices = {0x1008, 0x100A, 0x1017, 0x1400,
                                                     0x1600, 0x1A01, 0x2000, 8318};
      request[0] = *rc::gen::elementOf(kCommands);
      const uint16_t index = *rc::gen::elementOf(kIndices);
      request[1] = static_cast<uint8_t>(index);
      request[2] = static_cast<uint8_t>(index >> 8);
      request[3] = static_cast<uint8_t>(request[3] % 4);
    }
    const bool was_busy = rig.server.is_busy();
    const auto answer = rig.ask(request);
    const uint8_t specifier = request[0] >> 5;
    RC_ASSERT(answer.has_value() == (specifier != 4));
    if (!answer) {
      RC_ASSERT(!rig.server.is_busy());
      continue;
    }
    const uint8_t says = (*answer)[0] >> 5;
    if (says == 4) {
      RC_ASSERT(!rig.server.is_busy());
      RC_ASSERT(!abort_text(sdo::data_of(*answer)).empty());
    } else if (specifier == 0 || specifier == 3) {
      RC_ASSERT(was_busy);
      RC_ASSERT(says == (specifier == 0 ? 1 : 0));
      RC_ASSERT(((*answer)[0] & 0x10) == (request[0] & 0x10));
    } else {
      RC_ASSERT(says == (specifier == 1 ? 3 : 2));
      RC_ASSERT(sdo::address_of(*answer) == sdo::address_of(request));
    }
  }
}

TEST(CanopenSdo, AnySequence) { EXPECT_TRUE(rc::check("SDO server", any_sequence)); }

}  // namespace
}  // namespace ipos::tests

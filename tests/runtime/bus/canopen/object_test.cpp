// The object dictionary: identifiers of the connection set, defaults, and the rule of each entry.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/canopen/mapping.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/object_rig.hpp"

namespace ipos::tests {
namespace {

using Bytes = std::vector<uint8_t>;

TEST(CanopenConnections, IdentifiersOfNode5) {
  PROVES("MDB-TOC-05");
  EXPECT_EQ(identifier(Connection::Nmt, 5), 0x000U);
  EXPECT_EQ(identifier(Connection::Sync, 5), 0x080U);
  EXPECT_EQ(identifier(Connection::Emergency, 5), 0x085U);
  EXPECT_EQ(identifier(Connection::TransmitPdo1, 5), 0x185U);
  EXPECT_EQ(identifier(Connection::TransmitPdo2, 5), 0x285U);
  EXPECT_EQ(identifier(Connection::TransmitPdo3, 5), 0x385U);
  EXPECT_EQ(identifier(Connection::TransmitPdo4, 5), 0x485U);
  EXPECT_EQ(identifier(Connection::ReceivePdo1, 5), 0x205U);
  EXPECT_EQ(identifier(Connection::ReceivePdo2, 5), 0x305U);
  EXPECT_EQ(identifier(Connection::ReceivePdo3, 5), 0x405U);
  EXPECT_EQ(identifier(Connection::ReceivePdo4, 5), 0x505U);
  EXPECT_EQ(identifier(Connection::SdoResponse, 5), 0x585U);
  EXPECT_EQ(identifier(Connection::SdoRequest, 5), 0x605U);
  EXPECT_EQ(identifier(Connection::ErrorControl, 5), 0x705U);
}

TEST(CanopenConnections, EveryIdentifierHasOneMeaning) {
  std::set<uint32_t> known = {0x000, 0x080};
  for (const ConnectionRow& row : kConnections)
    for (uint8_t node = 1; row.addressed && node <= 127; ++node) {
      const uint32_t id = identifier(row.connection, node);
      EXPECT_TRUE(known.insert(id).second) << id;
      EXPECT_EQ(connection_of(id), (Addressed{row.connection, node}));
    }
  EXPECT_EQ(known.size(), 2U + 12 * 127);
  for (uint32_t id = 0; id < 0x800; ++id) EXPECT_EQ(connection_of(id).has_value(), known.contains(id)) << id;
}

TEST(CanopenObjects, MandatoryObjectsAndDefaults) {
  PROVES("MDB-TOC-19");
  ObjectRig rig;
  EXPECT_EQ(rig.read(0x1000), (Bytes{0, 0, 0, 0}));
  EXPECT_EQ(rig.read(0x1001), (Bytes{0}));
  EXPECT_EQ(rig.read(0x1018), (Bytes{4}));
  for (uint8_t sub = 1; sub <= 4; ++sub) EXPECT_EQ(rig.read(0x1018, sub).size(), 4U);
  EXPECT_EQ(rig.read(0x1005), (Bytes{0x80, 0, 0, 0}));
  EXPECT_EQ(rig.read(0x1014), (Bytes{0x85, 0, 0, 0}));
  EXPECT_EQ(rig.read(0x1200, 1), (Bytes{0x05, 6, 0, 0}));
  EXPECT_EQ(rig.read(0x1200, 2), (Bytes{0x85, 5, 0, 0}));
  EXPECT_EQ(rig.read(0x1400, 1), (Bytes{0x05, 2, 0, 0}));
  EXPECT_EQ(rig.read(0x1401, 1), (Bytes{0x05, 3, 0, 0x80}));
  EXPECT_EQ(rig.read(0x1803, 1), (Bytes{0x85, 4, 0, 0x80}));
  EXPECT_EQ(rig.read(0x1800, 2), (Bytes{1}));  // page 55
  for (uint8_t n = 1; n <= 3; ++n) {
    EXPECT_EQ(rig.read(0x1600, n), (Bytes{16, n, 0x00, 0x20}));
    EXPECT_EQ(rig.read(0x1A00, n), (Bytes{16, n, 0x01, 0x20}));
  }
  EXPECT_EQ(rig.read(0x1600, 4), (Bytes{0, 0, 0, 0}));
}

TEST(CanopenObjects, TextsOfTheUnit) {
  ObjectRig rig;
  const auto text = [&](uint16_t index) {
    const Bytes bytes = rig.read(index);
    return std::string(bytes.begin(), bytes.end());
  };
  EXPECT_EQ(text(0x1008), "MOVIDRIVE MDX60B/61B");
  EXPECT_EQ(text(0x1009), "mdxb");
  EXPECT_EQ(text(0x100A), "822 609 7.11");  // the example of the parameter list
}

// Every entry that there is answers a read; every other address of those objects has no such sub-index.
TEST(CanopenObjects, EveryAddress) {
  ObjectRig rig;
  size_t entries = 0;
  for (uint16_t index = 0x1000; index < 0x206C; ++index)
    for (uint16_t sub = 0; sub < 256; ++sub) {
      const auto at = static_cast<uint8_t>(sub);
      const bool there = rig.dictionary.find({index, at}) != nullptr;
      entries += there;
      // The list of errors is empty.
      const bool no_data = index == 0x1003 && sub != 0;
      const uint32_t expected = there                           ? no_data ? 0x0800'0024 : 0
                                : find_object(index) != nullptr ? 0x0609'0011
                                                                : 0x0602'0000;
      ASSERT_EQ(rig.refused_read(index, at), expected) << std::hex << index << ":" << sub;
      if (there) {
        ASSERT_FALSE(entry_name({index, at}).empty());
      }
    }
  // 1000h..1200h: 27 entries; PDO: 4 x (3 + 9 + 5 + 9); process data 2 x 11.
  EXPECT_EQ(entries, 27U + 104 + 22);
  EXPECT_EQ(rig.refused_read(0x0005, 0), 0x0602'0000U);
}

TEST(CanopenObjects, ParametersOfTheUnit) {
  PROVES("MDB-TOC-17");
  ObjectRig rig;
  EXPECT_EQ(rig.read(8318), (Bytes{0x40, 0x42, 0x0F, 0x00}));
  EXPECT_EQ(rig.refused_read(8318, 1), 0x0609'0011U);
  EXPECT_EQ(rig.refused_read(9999, 0), 0x0602'0000U);
  EXPECT_EQ(rig.refused_read(9999, 1), 0x0602'0000U);
  EXPECT_EQ(rig.write(8318, 0, 0xFFFF'FFFE, 4), 0U);
  EXPECT_EQ(rig.unit.parameters[8318], -2);
  EXPECT_EQ(rig.write(8318, 0, 1, 2), 0x0607'0010U);
  EXPECT_EQ(rig.write(8318, 1, 1, 4), 0x0609'0011U);
}

// The unit is asked for nothing below 2000h, whatever it has there (page 55 of 11264926: its own indices begin above).
TEST(CanopenObjects, ParametersBeginAt2000h) {
  ObjectRig rig;
  rig.unit.parameters[0x1FFF] = rig.unit.parameters[0x1002] = rig.unit.parameters[0x2002] = 5;
  for (const uint16_t index : {uint16_t{0x1FFF}, uint16_t{0x1002}, uint16_t{0x0000}, uint16_t{0x0FFF}}) {
    EXPECT_EQ(rig.refused_read(index, 0), 0x0602'0000U) << index;
    EXPECT_EQ(rig.write(index, 0, 7, 4), 0x0602'0000U) << index;
    EXPECT_EQ(rig.write(index, 1, 7, 4), 0x0602'0000U) << index;
    EXPECT_EQ(rig.write(0x1601, 1, uint32_t{index} << 16 | 16, 4), 0x0602'0000U);
  }
  EXPECT_EQ(rig.unit.requests, 0);
  EXPECT_EQ(rig.unit.parameters[0x1FFF], 5);
  EXPECT_EQ(rig.read(0x2002), (Bytes{5, 0, 0, 0}));
  EXPECT_EQ(rig.write(0x2002, 0, 7, 4), 0U);
  EXPECT_EQ(rig.unit.parameters[0x2002], 7);
  // A dummy is not there for SDO, and is no parameter.
  EXPECT_EQ(rig.write(0x0005, 0, 7, 1), 0x0602'0000U);
  EXPECT_EQ(rig.refused_read(0x0008, 0), 0x0602'0000U);
}

// At the edges of what CiA 301 keeps from being chosen for SYNC, EMCY and PDO.
TEST(CanopenObjects, RestrictedIdentifiers) {
  ObjectRig rig;
  const std::pair<uint32_t, uint32_t> kept[] = {{0x000, 0x07F}, {0x101, 0x180}, {0x581, 0x5FF},
                                                {0x601, 0x67F}, {0x6E0, 0x6FF}, {0x701, 0x7FF}};
  for (uint32_t id = 0; id < 0x800; ++id) {
    bool good = true;
    for (const auto& [first, last] : kept) good = good && (id < first || id > last);
    const uint32_t expected = good ? 0 : 0x0609'0030;
    EXPECT_EQ(rig.write(0x1005, 0, id, 4), expected) << id;
    EXPECT_EQ(rig.write(0x1014, 0, id, 4), expected) << id;
    // Of what is off, too; 0 is none there.
    const uint32_t off = 0x8000'0000 | id;
    const uint32_t expected_off = id == 0 ? 0 : expected;
    EXPECT_EQ(rig.write(0x1005, 0, off, 4), expected) << id << ": bit 31 says nothing of SYNC";
    EXPECT_EQ(rig.write(0x1014, 0, off, 4), expected_off) << id;
    for (const uint16_t pdo : std::initializer_list<uint16_t>{0x1400, 0x1403, 0x1800, 0x1801, 0x1803})
      EXPECT_EQ(rig.write(pdo, 1, off, 4), expected_off) << pdo << ' ' << id;
    EXPECT_EQ(rig.write(0x1200, 1, id, 4), 0x0601'0002U);
  }
  // Values of the life time at its edge: 10 ms (page 54), and without one of the two there is none.
  EXPECT_EQ(rig.write(0x100C, 0, 10, 2), 0U);
  EXPECT_EQ(rig.write(0x100D, 0, 1, 1), 0U);
  EXPECT_EQ(rig.write(0x100C, 0, 9, 2), 0x0609'0032U);
  EXPECT_EQ(rig.write(0x100C, 0, 0, 2), 0U);
  EXPECT_EQ(rig.write(0x1017, 0, 1, 2), 0U);
  EXPECT_EQ(rig.write(0x100C, 0, 9, 2), 0x0609'0032U) << "the shorter one of two reasons";
  EXPECT_EQ(rig.write(0x100C, 0, 10, 2), 0x0604'0043U);
  // The node whose heartbeat is awaited: 127 at most, and not itself.
  EXPECT_EQ(rig.write(0x1016, 1, 0x007F'0001, 4), 0U);
  EXPECT_EQ(rig.write(0x1016, 1, 0x0080'0001, 4), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1016, 1, 0x0004'FFFF, 4), 0U);
  EXPECT_EQ(rig.write(0x1016, 1, 0x0005'0000, 4), 0x0604'0043U);
  EXPECT_EQ(rig.write(0x1003, 0, 1, 1), 0x0609'0030U) << "only 0 clears the list";
  EXPECT_EQ(rig.write(0x1003, 0, 0, 1), 0U);
}

// The contract of this project; the manual prints no codes.
TEST(CanopenObjects, ReturnCodesAsAborts) {
  const std::pair<uint16_t, uint32_t> rows[] = {{0x10, 0x0602'0000}, {0x12, 0x0601'0002}, {0x13, 0x0800'0021},
                                                {0x1B, 0x0800'0021}, {0x1C, 0x0800'0022}, {0x20, 0x0800'0022},
                                                {0x15, 0x0609'0031}, {0x16, 0x0609'0032}, {0x1D, 0x0609'0030},
                                                {0x99, 0x0800'0000}};
  ObjectRig rig;
  for (const auto& [additional, abort] : rows) {
    rig.unit.refusal = {8, 0, additional};
    EXPECT_EQ(rig.write(8318, 0, 1, 4), abort) << additional;
    EXPECT_FALSE(abort_text(abort).empty());
  }
}

TEST(CanopenObjects, LengthAndAccess) {
  ObjectRig rig;
  for (const auto& entry : rig.dictionary.entries()) {
    if (entry.row->access == Access::Dummy) continue;
    const auto [index, sub] = entry.address;
    if (!is_writable(entry.row->access)) {
      EXPECT_EQ(rig.write(index, sub, 0, 4), 0x0601'0002U) << index;
      continue;
    }
    for (size_t length : {0U, 1U, 2U, 3U, 4U, 5U})
      if (length != bytes_of(entry.row->type)) {
        EXPECT_EQ(rig.write(index, sub, 0, length), 0x0607'0010U) << index;
      }
  }
  EXPECT_TRUE(rig.written.empty());
}

TEST(CanopenObjects, IdentifiersOfSyncAndEmergency) {
  ObjectRig rig;
  EXPECT_EQ(rig.write(0x1005, 0, 0x4000'0080, 4), 0x0609'0030U);  // it produces no SYNC
  EXPECT_EQ(rig.write(0x1005, 0, 0x2000'0080, 4), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1005, 0, 0x800, 4), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1005, 0, 0x601, 4), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1005, 0, 0x100, 4), 0U);
  EXPECT_EQ(rig.write(0x1014, 0, 0x2000'0085, 4), 0x0609'0030U);  // bit 29 must be 0 (page 53)
  EXPECT_EQ(rig.write(0x1014, 0, 0x8000'0085, 4), 0U);
  EXPECT_EQ(rig.write(0x1014, 0, 0x0000'0086, 4), 0U);
  rig.state = State::Operational;  // changed in pre-operational (page 53)
  EXPECT_EQ(rig.write(0x1014, 0, 0x0000'0085, 4), 0x0800'0022U);
}

TEST(CanopenObjects, GuardingOrHeartbeat) {
  ObjectRig rig;
  EXPECT_EQ(rig.write(0x100C, 0, 3, 2), 0U);
  EXPECT_EQ(rig.write(0x100D, 0, 3, 1), 0x0609'0032U);  // 9 ms: below 10 (page 54)
  EXPECT_EQ(rig.write(0x100D, 0, 4, 1), 0U);
  EXPECT_EQ(rig.write(0x100C, 0, 2, 2), 0x0609'0032U);
  EXPECT_EQ(rig.write(0x1017, 0, 100, 2), 0x0604'0043U);  // never both
  EXPECT_EQ(rig.write(0x1017, 0, 0, 2), 0U);
  EXPECT_EQ(rig.write(0x100D, 0, 0, 1), 0U);
  EXPECT_EQ(rig.write(0x1017, 0, 100, 2), 0U);
  EXPECT_EQ(rig.write(0x100D, 0, 10, 1), 0x0604'0043U);
  EXPECT_EQ(rig.read(0x1016), (Bytes{1}));  // exactly one other node
  EXPECT_EQ(rig.refused_read(0x1016, 2), 0x0609'0011U);
  EXPECT_EQ(rig.write(0x1016, 1, 0x0005'0064, 4), 0x0604'0043U);  // itself
  EXPECT_EQ(rig.write(0x1016, 1, 0x0080'0064, 4), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1016, 1, 0x0006'0064, 4), 0U);
}

TEST(CanopenObjects, RemappingInItsOrder) {
  PROVES("MDB-TOC-09");
  ObjectRig rig;
  // As long as the PDO is on, nothing of its mapping changes.
  EXPECT_EQ(rig.write(0x1A00, 0, 0, 1), 0x0601'0000U);
  EXPECT_EQ(rig.write(0x1A00, 1, 0x2001'0410, 4), 0x0601'0000U);
  EXPECT_EQ(rig.write(0x1800, 1, 0x0000'0186, 4), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1800, 3, 100, 2), 0x0609'0030U);
  EXPECT_EQ(rig.write(0x1800, 1, 0x8000'0185, 4), 0U);
  EXPECT_EQ(rig.write(0x1800, 2, 254, 1), 0U);
  EXPECT_EQ(rig.write(0x1800, 3, 100, 2), 0U);
  EXPECT_EQ(rig.write(0x1A00, 1, 0x2001'0410, 4), 0x0601'0000U);  // the count is not 0 yet
  EXPECT_EQ(rig.write(0x1A00, 0, 0, 1), 0U);
  EXPECT_EQ(rig.write(0x1800, 1, 0x0000'0185, 4), 0x0609'0030U);  // it would carry nothing
  EXPECT_EQ(rig.write(0x1A00, 1, 0x2001'0410, 4), 0U);
  EXPECT_EQ(rig.write(0x1A00, 2, 0x2001'0A10, 4), 0U);
  EXPECT_EQ(rig.write(0x1A00, 0, 2, 1), 0U);
  EXPECT_EQ(rig.write(0x1800, 1, 0x0000'0185, 4), 0U);
  EXPECT_EQ(mapping_of(rig.dictionary, 0x1A00), (Mapping{{{0x2001, 4}, 16}, {{0x2001, 10}, 16}}));
  EXPECT_EQ(bits_of(mapping_of(rig.dictionary, 0x1A00)), 32U);
}

TEST(CanopenObjects, WhatCanBeMapped) {
  PROVES("MDB-TOC-09");
  ObjectRig rig;
  const auto map = [&](uint16_t index, uint32_t entry) { return rig.write(index, 1, entry, 4); };
  EXPECT_EQ(map(0x1601, 0x2000'0110), 0U);
  EXPECT_EQ(map(0x1A01, 0x2001'0110), 0U);
  EXPECT_EQ(map(0x1601, 0x2001'0110), 0x0604'0041U);  // a receive PDO writes no input
  EXPECT_EQ(map(0x1A01, 0x2000'0110), 0x0604'0041U);
  EXPECT_EQ(map(0x1601, 0x2000'0108), 0x0604'0041U);  // 8 bits of 16
  EXPECT_EQ(map(0x1601, 0x2000'0008), 0x0604'0041U);  // the number of words
  EXPECT_EQ(map(0x1601, 0x2000'0B10), 0x0609'0011U);
  EXPECT_EQ(map(0x1601, 0x1017'0010), 0x0604'0041U);
  EXPECT_EQ(map(0x1601, (8318U << 16) | 32), 0x0604'0041U);
  EXPECT_EQ(map(0x1601, 0x6040'0010), 0x0602'0000U);
  EXPECT_EQ(map(0x1601, 0x0007'0020), 0U);  // dummy: 32 bits for somebody else
  EXPECT_EQ(map(0x1A01, 0x0007'0020), 0x0604'0041U);
  EXPECT_EQ(map(0x1601, 0), 0U);
  EXPECT_EQ(rig.write(0x1601, 0, 1, 1), 0x0602'0000U);  // the one that counts maps nothing
  EXPECT_EQ(rig.write(0x1601, 0, 9, 1), 0x0609'0031U);
}

TEST(CanopenObjects, EightBytesAPdo) {
  PROVES("MDB-TOC-09");
  ObjectRig rig;
  for (uint8_t n = 1; n <= 5; ++n) EXPECT_EQ(rig.write(0x1A01, n, 0x2001'0010U | uint32_t{n} << 8, 4), 0U);
  EXPECT_EQ(rig.write(0x1A01, 0, 5, 1), 0x0604'0042U);
  EXPECT_EQ(rig.write(0x1A01, 0, 4, 1), 0U);
  for (uint8_t n = 1; n <= 8; ++n) EXPECT_EQ(rig.write(0x1601, n, 0x0005'0008, 4), 0U);
  EXPECT_EQ(rig.write(0x1601, 0, 8, 1), 0U);
}

TEST(CanopenObjects, TransmissionTypes) {
  ObjectRig rig;
  for (uint32_t type = 0; type < 256; ++type) {
    EXPECT_EQ(rig.write(0x1402, 2, type, 1), type <= 240 || type >= 254 ? 0U : 0x0609'0030U) << type;
    EXPECT_EQ(rig.write(0x1802, 2, type, 1), type <= 240 || type >= 252 ? 0U : 0x0609'0030U) << type;
  }
}

// An output is taken in operational only, as over a PDO.
TEST(CanopenObjects, OutputsBySdo) {
  ObjectRig rig;
  EXPECT_EQ(rig.write(0x2000, 2, 0x1234, 2), 0x0800'0022U);
  rig.state = State::Operational;
  EXPECT_EQ(rig.write(0x2000, 2, 0x1234, 2), 0U);
  EXPECT_EQ(rig.read(0x2000, 2), (Bytes{0x34, 0x12}));
  rig.unit.inputs[9] = 0xABCD;
  EXPECT_EQ(rig.read(0x2001, 10), (Bytes{0xCD, 0xAB}));
}

// Bits 0 to 29 of a COB-ID are the identifier and the kind of frame: an identifier of more than 11 bits is refused,
// also of a PDO that is off, and only an equal one may be written while it is on.
TEST(CanopenObjects, EveryBitOfAPdoIdentifierCounts) {
  ObjectRig rig;
  for (unsigned bit = 11; bit <= 29; ++bit) {
    EXPECT_EQ(rig.write(0x1401, 1, 0x8000'0305 | 1U << bit, 4), 0x0609'0030U) << bit;
    EXPECT_EQ(rig.write(0x1400, 1, 0x0000'0205 | 1U << bit, 4), 0x0609'0030U) << bit;
  }
  EXPECT_EQ(rig.write(0x1401, 1, 0xC000'0305, 4), 0U) << "bit 30 does not belong to it";
  EXPECT_EQ(rig.write(0x1401, 1, 0x8000'06DF, 4), 0U) << "the highest that is not restricted below the SDO";
  for (unsigned bit = 0; bit <= 10; ++bit)
    EXPECT_EQ(rig.write(0x1400, 1, 0x205U ^ 1U << bit, 4), 0x0609'0030U) << "it is on: " << bit;
  EXPECT_EQ(rig.write(0x1400, 1, 0x205, 4), 0U);
  EXPECT_EQ(rig.write(0x1400, 1, 0x4000'0205, 4), 0U);
}

}  // namespace
}  // namespace ipos::tests

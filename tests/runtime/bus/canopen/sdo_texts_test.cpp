// Every answer to an SDO client in every step of a transfer, and every kind of frame of a CANopen line in words.
#include <gtest/gtest.h>

#include "runtime/bus/canopen/eds.hpp"
#include "runtime/bus/canopen/sdo_client.hpp"
#include "runtime/bus/canopen/words.hpp"
#include "tests/runtime/bus/canopen/object_rig.hpp"

namespace ipos::tests {
namespace {

constexpr SdoBytes client_abort(uint32_t code) { return sdo::abort({0x1008, 2}, static_cast<Abort>(code)); }

// Brings a client to one of its steps.
struct ClientStep {
  const char* name;
  void (*begin)(SdoClient&);
  unsigned answer;  // the upper three bits of byte 0 that are the right ones
};
const ClientStep kClientSteps[] = {{"upload",
                                    [](SdoClient& c) {
                                      c.read({0x1008, 2});
                                    },
                                    2},
                                   {"upload segment",
                                    [](SdoClient& c) {
                                      c.read({0x1008, 2});
                                      c.take({0x40, 0x08, 0x10, 2});
                                    },
                                    0},
                                   {"download",
                                    [](SdoClient& c) {
                                      c.write({0x1008, 2}, std::vector<uint8_t>(2));
                                    },
                                    3},
                                   {"download of segments",
                                    [](SdoClient& c) {
                                      c.write({0x1008, 2}, std::vector<uint8_t>(9));
                                    },
                                    3},
                                   {"download segment",
                                    [](SdoClient& c) {
                                      c.write({0x1008, 2}, std::vector<uint8_t>(9));
                                      c.take({0x60, 0x08, 0x10, 2});
                                    },
                                    1}};

// A wrong command specifier ends the transfer with 05040001h, a server's abort with its own code; an answer of another
// object is none, as long as the transfer begins.
TEST(CanopenSdoClient, EveryAnswerInEveryStep) {
  for (const ClientStep& step : kClientSteps)
    for (unsigned says = 0; says < 8; ++says) {
      SdoClient client;
      step.begin(client);
      ASSERT_TRUE(client.is_busy());
      EXPECT_EQ(client.address(), (Address{0x1008, 2}));
      const auto request =
          client.take({static_cast<uint8_t>(says << 5), 0x08, 0x10, 2, 0x11, 0x22, 0x33, 0x44});
      if (says == 4) {
        EXPECT_EQ(request, std::nullopt);
        EXPECT_FALSE(client.is_busy());
        EXPECT_EQ(client.result().error(), 0x4433'2211U);
      } else if (says == step.answer) {
        EXPECT_TRUE(client.is_busy() || client.result().has_value()) << step.name;
        EXPECT_EQ(request.has_value(), client.is_busy());
      } else {
        EXPECT_EQ(request, client_abort(0x0504'0001)) << step.name << ' ' << says;
        EXPECT_FALSE(client.is_busy());
        EXPECT_EQ(client.result().error(), 0x0504'0001U);
      }
      if (std::string(step.name).find("segment") != std::string::npos && step.answer != 3) continue;
      for (const SdoBytes& other : {SdoBytes{static_cast<uint8_t>(says << 5), 0x09, 0x10, 2},
                                    SdoBytes{static_cast<uint8_t>(says << 5), 0x08, 0x10, 1}}) {
        if (says == 4) continue;
        SdoClient patient;
        step.begin(patient);
        EXPECT_EQ(patient.take(other), std::nullopt);
        EXPECT_TRUE(patient.is_busy());
      }
    }
}

TEST(CanopenSdoClient, ToggleBitsOfBothWays) {
  SdoClient client;
  client.read({0x1008, 2});
  client.take({0x40, 0x08, 0x10, 2});
  EXPECT_EQ(client.take({0x10, 1}), client_abort(0x0503'0000));
  EXPECT_EQ(client.result().error(), 0x0503'0000U);
  client.write({0x1008, 2}, std::vector<uint8_t>(9));
  client.take({0x60, 0x08, 0x10, 2});
  EXPECT_EQ(client.take({0x30}), client_abort(0x0503'0000));
  EXPECT_EQ(client.expire(), client_abort(0x0504'0000));
  EXPECT_EQ(client.result().error(), 0x0504'0000U);
  EXPECT_EQ(client.take({0x60, 0x08, 0x10, 2}), std::nullopt) << "nothing is under way";
}

// Expedited with one to four octets, or with four where no length is told; the rest is not looked at.
TEST(CanopenSdoClient, ExpeditedOfEachLength) {
  for (unsigned unused = 0; unused < 4; ++unused)
    for (const unsigned sized : {0U, 1U}) {
      SdoClient client;
      EXPECT_EQ(client.read({0x1234, 5}), (SdoBytes{0x40, 0x34, 0x12, 5}));
      const auto byte0 = static_cast<uint8_t>(0x42 | unused << 2 | sized);
      EXPECT_EQ(client.take({byte0, 0x34, 0x12, 5, 1, 2, 3, 4}), std::nullopt);
      std::vector<uint8_t> expected = {1, 2, 3, 4};
      expected.resize(4 - (sized != 0 ? unused : 0));
      EXPECT_EQ(client.result(), (tl::expected<std::vector<uint8_t>, uint32_t>(expected))) << unused << sized;
    }
  const SdoBytes expected[] = {{0x21, 0x34, 0x12, 5, 0},          {0x2F, 0x34, 0x12, 5, 7},
                               {0x2B, 0x34, 0x12, 5, 7, 7},       {0x27, 0x34, 0x12, 5, 7, 7, 7},
                               {0x23, 0x34, 0x12, 5, 7, 7, 7, 7}, {0x21, 0x34, 0x12, 5, 5}};
  for (size_t length = 0; length <= 5; ++length) {
    SdoClient client;
    EXPECT_EQ(client.write({0x1234, 5}, std::vector<uint8_t>(length, 7)), expected[length]) << length;
    // Nothing at all goes out as one empty segment.
    const auto next = client.take({0x60, 0x34, 0x12, 5});
    if (length == 0) {
      EXPECT_EQ(next, (SdoBytes{0x0F}));
    }
    if (length == 5) {
      EXPECT_EQ(next, (SdoBytes{0x05, 7, 7, 7, 7, 7}));
    }
    EXPECT_EQ(client.is_busy(), length == 0 || length == 5);
    if (client.is_busy()) {
      EXPECT_EQ(client.take({0x20}), std::nullopt);
    }
    EXPECT_TRUE(client.result().has_value());
  }
}

// Segments of fourteen octets have no remainder: the last one is full.
TEST(CanopenSdoClient, FullSegments) {
  SdoClient client;
  client.write({0x1234, 5}, std::vector<uint8_t>(14, 7));
  EXPECT_EQ(client.take({0x60, 0x34, 0x12, 5}), (SdoBytes{0x00, 7, 7, 7, 7, 7, 7, 7}));
  EXPECT_EQ(client.take({0x20}), (SdoBytes{0x11, 7, 7, 7, 7, 7, 7, 7}));
  EXPECT_EQ(client.take({0x30}), std::nullopt);
  EXPECT_FALSE(client.is_busy());
  // What was told before is not kept: as many as there are, in the length that is told.
  client.read({0x1234, 5});
  client.take({0x41, 0x34, 0x12, 5, 14});
  EXPECT_EQ(client.take({0x00, 1, 2, 3, 4, 5, 6, 7}), (SdoBytes{0x70}));
  EXPECT_EQ(client.take({0x11, 1, 2, 3, 4, 5, 6, 7}), std::nullopt);
  EXPECT_EQ(client.result().value().size(), 14U);
  client.read({0x1234, 5});
  client.take({0x40, 0x34, 0x12, 5, 3});  // the length counts only where it is told
  EXPECT_EQ(client.take({0x01, 1, 2, 3, 4, 5, 6, 7}), std::nullopt);
  EXPECT_EQ(client.result().value().size(), 7U);
}

// --- words

TEST(CanopenWords, TheFirstFrameOfANodeIsKnown) {
  const std::pair<Frame, const char*> rows[] = {
      {{0x185, 6, {1, 0, 2, 0, 3, 0}}, "185 TPDO1 PI1 0001h, PI2 0002h, PI3 0003h <- node 5"},
      {{0x205, 6, {1, 0, 2, 0, 3, 0}}, "205 RPDO1 PO1 0001h, PO2 0002h, PO3 0003h -> node 5"},
      {{0x205, 6, {}, false, true}, "205 RPDO1 asked for -> node 5"},
      {{0x305, 2, {1, 2}}, "305 RPDO2 not mapped: 01 02 -> node 5"},
      {{0x485, 0}, "485 TPDO4 not mapped: no data <- node 5"},
      {{0x385, 0, {}, false, true}, "385 TPDO3 not mapped: no data -> node 5"},
      {{0x185, 5, {1, 0, 2, 0, 3}}, "185 TPDO1 5 of 6 bytes: 01 00 02 00 03 <- node 5"},
      {{0x185, 8, {1, 0, 2, 0, 3, 0, 4, 0}}, "185 TPDO1 PI1 0001h, PI2 0002h, PI3 0003h <- node 5"}};
  for (const auto& [frame, text] : rows) {
    LineWords words;
    const Description description = words.describe(frame);
    EXPECT_EQ(description.text, text);
    EXPECT_TRUE(description.known);
  }
}

TEST(CanopenWords, FramesThatAreNoGood) {
  LineWords words({{5, "saw", nullptr, {}, {}}});
  const std::pair<Frame, const char*> rows[] = {
      {{0x000, 1, {1}}, "000 NMT with 1 bytes in place of 2: 01"},
      {{0x000, 3, {1, 5, 0}}, "000 NMT with 3 bytes in place of 2: 01 05 00"},
      {{0x000, 2, {0x33, 5}}, "000 NMT unknown command 33h -> saw"},
      {{0x000, 2, {0x80, 127}}, "000 NMT enter pre-operational -> node 127"},
      {{0x000, 2, {0x02, 128}}, "000 NMT stop -> node 128"},
      {{0x000, 2, {0x81, 0}}, "000 NMT reset node -> all nodes"},
      {{0x705, 0}, "705 0 bytes in place of 1: no data <- saw"},
      {{0x705, 2, {5, 0}}, "705 2 bytes in place of 1: 05 00 <- saw"},
      {{0x705, 1, {0x33}}, "705 state 33h <- saw"},
      {{0x705, 1, {0xB3}}, "705 state 33h, toggle 1 <- saw"},
      {{0x705, 1, {0x7F}}, "705 pre-operational <- saw"},
      {{0x085, 7, {1, 2, 3}}, "085 EMCY with 7 bytes in place of 8: 01 02 03 00 00 00 00 <- saw"},
      {{0x085, 8, {0x34, 0x12, 9}}, "085 EMCY 1234h, error register 09h <- saw"},
      {{0x085, 8, {0x30, 0x81, 0x11, 9, 0, 1}},
       "085 EMCY 8130h life guarding or heartbeat missed, error register 11h, status word 1 0100h <- saw"},
      {{0x605, 7, {0x40, 0, 0x10}}, "605 SDO with 7 bytes in place of 8: 40 00 10 00 00 00 00 -> saw"},
      {{0x585, 0, {}, false, true}, "585 SDO with 0 bytes in place of 8: no data -> saw"},
      {{0x605, 8, {0xA0, 0x00, 0x10}}, "605 SDO block read 1000h Device type -> saw"},
      {{0x605, 8, {0xC0, 0x00, 0x10}}, "605 SDO block write 1000h Device type -> saw"},
      {{0x605, 8, {0xE1, 0x00, 0x10}}, "605 SDO unknown command E1h -> saw"},
      {{0x585, 8, {0xA1, 0x00, 0x10}}, "585 SDO unknown answer A1h <- saw"},
      {{0x585, 8, {0xC1, 0x00, 0x10}}, "585 SDO unknown answer C1h <- saw"},
      {{0x585, 8, {0xE1, 0x00, 0x10}}, "585 SDO unknown answer E1h <- saw"},
      {{0x605, 8, {0x80, 0x00, 0x10, 0, 0, 0, 4, 5}},
       "605 SDO abort 1000h Device type: SDO protocol timed out (05040000h) -> saw"},
      {{0x585, 8, {0x80, 0x00, 0x10, 0, 1, 0, 0, 9}},
       "585 SDO abort 1000h Device type: unknown reason (09000001h) <- saw"}};
  for (const auto& [frame, text] : rows) {
    const Description description = words.describe(frame);
    EXPECT_EQ(description.text, text);
    EXPECT_TRUE(description.known);
  }
  EXPECT_EQ(words.describe({0x7FF, 0}).text, "7FF no data");
  EXPECT_EQ(words.describe({0x185, 2, {1, 2}, true, false}).text, "00000185 01 02");
  EXPECT_FALSE(words.describe({0x185, 2, {1, 2}, true, false}).known);
}

TEST(CanopenWords, SegmentsBelongToTheObjectThatWasAskedFor) {
  LineWords words;
  const auto text = [&](const Frame& frame) { return words.describe(frame).text; };
  EXPECT_EQ(text({0x605, 8, {0x60}}), "605 SDO next segment of an unknown object -> node 5");
  EXPECT_EQ(text({0x585, 8, {0x20}}), "585 SDO segment taken of an unknown object <- node 5");
  EXPECT_EQ(text({0x605, 8, {0x21, 0x00, 0x50, 3, 9}}), "605 SDO write 5000h:3 in segments -> node 5");
  EXPECT_EQ(text({0x585, 8, {0x60, 0x00, 0x50, 3}}), "585 SDO written 5000h:3 <- node 5");
  EXPECT_EQ(text({0x605, 8, {0x00, 'a', 0x1F, ' ', '~', 0x7F, 0x80, 0xFF}}),
            "605 SDO segment 61 1F 20 7E 7F 80 FF of 5000h:3 -> node 5");
  EXPECT_EQ(text({0x585, 8, {0x20}}), "585 SDO segment taken of 5000h:3 <- node 5");
  EXPECT_EQ(text({0x605, 8, {0x19, ' ', 'a', '~'}}), "605 SDO segment \" a~\" of 5000h:3, the last -> node 5")
      << "three characters, from the lowest to the highest that is printed";
  EXPECT_EQ(text({0x585, 8, {0x41, 0x00, 0x50, 3, 9}}), "585 SDO 5000h:3 has 9 bytes, in segments <- node 5");
  EXPECT_EQ(text({0x606, 8, {0x60}}), "606 SDO next segment of an unknown object -> node 6");
}

// What is written is known when the node has confirmed it, for the object that was asked for.
TEST(CanopenWords, ConfirmationsOfOtherObjectsChangeNothing) {
  LineWords words;
  words.describe({0x605, 8, sdo::initiate(0x23, {0x1005, 0}, 0x81)});
  words.describe({0x585, 8, sdo::initiate(0x60, {0x1006, 0})});
  words.describe({0x585, 8, sdo::initiate(0x60, {0x1005, 0})});
  EXPECT_EQ(words.describe({0x081, 0}).text, "081 EMCY with 0 bytes in place of 8: no data <- node 1");
  words.describe({0x605, 8, sdo::initiate(0x23, {0x1005, 0}, 0x4000'0081)});
  words.describe({0x585, 8, sdo::initiate(0x60, {0x1005, 0})});
  EXPECT_EQ(words.describe({0x081, 0}).text, "081 SYNC");
  EXPECT_EQ(words.describe({0x080, 0}).text, "080 SYNC") << "of the other nodes";
  // An object that is not in the list is written without a trace.
  words.describe({0x605, 8, sdo::initiate(0x23, {0x12FF, 0}, 1)});
  EXPECT_EQ(words.describe({0x585, 8, sdo::initiate(0x60, {0x12FF, 0})}).text,
            "585 SDO written 12FFh <- node 5");
}

TEST(CanopenWords, ValuesByLengthAndObject) {
  LineWords words;
  const auto text = [&](const SdoBytes& bytes) { return words.describe({0x605, 8, bytes}).text; };
  EXPECT_EQ(text({0x23, 0x17, 0x10, 0, 0x78, 0x56, 0x34, 0x12}),
            "605 SDO write 1017h Producer heartbeat time = 12345678h -> node 5");
  EXPECT_EQ(text({0x27, 0x17, 0x10, 0, 0x78, 0x56, 0x34, 0x12}),
            "605 SDO write 1017h Producer heartbeat time = 3430008 -> node 5");
  EXPECT_EQ(text({0x22, 0x17, 0x10, 0, 0x78, 0x56, 0x34, 0x12}),
            "605 SDO write 1017h Producer heartbeat time = 12345678h -> node 5")
      << "no length is told";
  EXPECT_EQ(text({0x23, 0x7E, 0x20, 0, 0xE8, 3, 0, 0}),
            "605 SDO write 207Eh P000 Speed = 1.000 rpm -> node 5");
  EXPECT_EQ(text({0x23, 0x7E, 0x20, 1, 0xE8, 3, 0, 0}), "605 SDO write 207Eh:1 = 1000 -> node 5");
  EXPECT_EQ(text({0x2B, 0x7E, 0x20, 0, 0xE8, 3, 0, 0}), "605 SDO write 207Eh P000 Speed = 1000 -> node 5");
  EXPECT_EQ(text({0x2B, 0x00, 0x20, 10, 0xE8, 3, 0, 0}), "605 SDO write 2000h:10 PO10 = 1000 -> node 5");
}

// Words beyond the third have no assignment.
TEST(CanopenWords, ProcessWordsByTheirAssignment) {
  LineWords words({{5, "saw", &mdxb(), {9, 1, 8}, {1, 0, 2}}});
  const auto write = [&](uint16_t index, uint8_t sub, uint32_t value) {
    words.describe({0x605, 8, sdo::initiate(0x23, {index, sub}, value)});
    words.describe({0x585, 8, sdo::initiate(0x60, {index, sub})});
  };
  write(0x1A00, 1, 0x2001'0310);
  write(0x1A00, 2, 0x2001'0410);
  write(0x1A00, 3, 0x2001'0210);
  EXPECT_EQ(words.describe({0x185, 6, {1, 0, 2, 0, 3, 0}}).text,
            "185 TPDO1 PI3 OUTP. CURRENT 0.1 % In, PI4 0002h, PI2 0003h <- saw");
  // Dummies leave out the words of others.
  write(0x1600, 1, 0x0006'0010);
  write(0x1600, 2, 0x2000'0210);
  EXPECT_EQ(words.describe({0x205, 6, {1, 0, 2, 0, 3, 0}}).text,
            "205 RPDO1 PO2 SPEED 0.4 rpm, PO3 RAMP 3 ms -> saw");
  write(0x1600, 2, 0x0006'0010);
  write(0x1600, 3, 0x0006'0010);
  EXPECT_EQ(words.describe({0x205, 6, {1, 0, 2, 0, 3, 0}}).text, "205 RPDO1 01 00 02 00 03 00 -> saw");
}

// --- EDS

std::string eds_section(const std::string& text, const std::string& name) {
  const size_t at = ("\n" + text).find("\n[" + name + "]\n");
  EXPECT_NE(at, std::string::npos) << name;
  return at == std::string::npos ? "" : text.substr(at, text.find("\n\n", at) + 1 - at);
}

// The keys are those of CiA 306; values as the objects have them.
TEST(CanopenEds, SectionsOfObjects) {
  const std::string text = eds_text(mdxb());
  EXPECT_EQ(eds_section(text, "1000"),
            "[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=const\n"
            "DefaultValue=0x0\nPDOMapping=0\n");
  EXPECT_EQ(
      eds_section(text, "1008"),
      "[1008]\nParameterName=Manufacturer device name\nObjectType=0x7\nDataType=0x0009\nAccessType=const\n"
      "DefaultValue=\nPDOMapping=0\n");
  EXPECT_EQ(eds_section(text, "1014"),
            "[1014]\nParameterName=COB-ID EMCY\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\n"
            "DefaultValue=$NODEID+0x80\nPDOMapping=0\n");
  EXPECT_EQ(eds_section(text, "1400"),
            "[1400]\nParameterName=RPDO1 communication parameter\nObjectType=0x9\nSubNumber=3\n");
  EXPECT_EQ(eds_section(text, "1600sub0"),
            "[1600sub0]\nParameterName=RPDO1 number of mapped objects\nObjectType=0x7\nDataType=0x0005\n"
            "AccessType=rw\nDefaultValue=0x3\nHighLimit=0x8\nPDOMapping=0\n");
  EXPECT_EQ(
      eds_section(text, "1600sub2"),
      "[1600sub2]\nParameterName=RPDO1 mapped object 2\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\n"
      "DefaultValue=0x20000210\nPDOMapping=0\n");
  EXPECT_EQ(eds_section(text, "2000"),
            "[2000]\nParameterName=Process output data\nObjectType=0x8\nSubNumber=11\n");
  EXPECT_EQ(eds_section(text, "2000subA"),
            "[2000subA]\nParameterName=PO10\nObjectType=0x7\nDataType=0x0006\nAccessType=rww\n"
            "DefaultValue=0x0\nPDOMapping=1\n");
  EXPECT_EQ(eds_section(text, "2001sub1"),
            "[2001sub1]\nParameterName=PI1\nObjectType=0x7\nDataType=0x0006\nAccessType=ro\n"
            "DefaultValue=0x0\nPDOMapping=1\n");
  EXPECT_EQ(eds_section(text, "2116"),
            "[2116]\nParameterName=P130 Ramp t11 UP CW\nObjectType=0x7\nDataType=0x0004\nAccessType=rw\n"
            "DefaultValue=2000\nLowLimit=0\nHighLimit=2000000\nPDOMapping=0\n");
  // An unsigned one, and one without a number of its own.
  EXPECT_EQ(eds_section(text, "2136"),
            "[2136]\nParameterName=P221 Master gear ratio factor\nObjectType=0x7\nDataType=0x0007\n"
            "AccessType=rw\nDefaultValue=1\nLowLimit=1\nHighLimit=3999999999\nPDOMapping=0\n");
  EXPECT_NE(eds_section(text, "20B3").find("ParameterName=Input terminals"), std::string::npos);
}

TEST(CanopenEds, ListsOfObjects) {
  const std::string text = eds_text(mdxb());
  EXPECT_EQ(eds_section(text, "MandatoryObjects"),
            "[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n");
  EXPECT_EQ(eds_section(text, "OptionalObjects"),
            "[OptionalObjects]\nSupportedObjects=28\n1=0x1003\n2=0x1005\n3=0x1008\n4=0x1009\n5=0x100A\n"
            "6=0x100C\n7=0x100D\n8=0x1014\n9=0x1015\n10=0x1016\n11=0x1017\n12=0x1200\n13=0x1400\n14=0x1401\n"
            "15=0x1402\n16=0x1403\n17=0x1600\n18=0x1601\n19=0x1602\n20=0x1603\n21=0x1800\n22=0x1801\n"
            "23=0x1802\n24=0x1803\n25=0x1A00\n26=0x1A01\n27=0x1A02\n28=0x1A03\n");
  EXPECT_EQ(eds_section(text, "DummyUsage"),
            "[DummyUsage]\nDummy0001=0\nDummy0002=0\nDummy0003=0\nDummy0004=0\nDummy0005=1\nDummy0006=1\n"
            "Dummy0007=1\n");
  const std::string manufacturer = eds_section(text, "ManufacturerObjects");
  EXPECT_EQ(manufacturer.substr(manufacturer.find("\n1="), 24), "\n1=0x2000\n2=0x2001\n3=0x2");
  const std::string device = eds_section(text, "DeviceInfo");
  for (const char* line :
       {"\nBaudRate_10=0\n", "\nBaudRate_125=1\n", "\nBaudRate_250=1\n", "\nBaudRate_500=1\n",
        "\nBaudRate_800=0\n", "\nBaudRate_1000=1\n", "\nNrOfRXPDO=4\n", "\nNrOfTXPDO=4\n",
        "\nProductName=MOVIDRIVE MDX60B/61B\n", "\nOrderCode=mdxb\n"})
    EXPECT_NE(device.find(line), std::string::npos) << line;
}

}  // namespace
}  // namespace ipos::tests

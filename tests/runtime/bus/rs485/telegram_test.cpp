// Characters and telegrams against the examples and tables of the manuals.
#include "runtime/bus/movilink/serial_telegram.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/runtime/bus/rs485/serial_rig.hpp"

namespace ipos::tests {
namespace {

SerialTelegram request(uint8_t address, int type, ProcessWords words, ParameterTelegram channel = {}) {
  return {false, address, *telegram_format(type), channel, words};
}
SerialTelegram response(uint8_t address, int type, ProcessWords words, ParameterTelegram channel = {}) {
  return {true, address, *telegram_format(type), channel, words};
}

// Bytes and fields are two forms of one telegram.
void expect_same(const SerialTelegram& fields, const std::string& bytes) {
  EXPECT_EQ(text_of(encode(fields).span()), bytes);
  const auto decoded = decode_serial(hex(bytes));
  ASSERT_TRUE(decoded.has_value()) << bytes;
  EXPECT_EQ(*decoded, fields) << bytes;
}

std::string wire_text(uint8_t byte) {
  std::string text;
  for (int n = 0; n < 11; ++n) text += (wire_character(byte) >> n & 1) != 0 ? '1' : '0';
  return text;
}

TEST(Character, ElevenBits) {
  PROVES("MDB-RS485-01");
  EXPECT_EQ(wire_text(0x02), "00100000011");
  EXPECT_EQ(wire_text(0x98), "00001100111");
  EXPECT_EQ(wire_text(0x57), "01110101011");
  for (int byte = 0; byte < 256; ++byte) {
    const std::string text = wire_text(static_cast<uint8_t>(byte));
    EXPECT_EQ(text[0], '0');
    EXPECT_EQ(text[10], '1');
    int ones = 0;
    for (int n = 1; n <= 9; ++n) ones += text[static_cast<size_t>(n)] == '1';
    EXPECT_EQ(ones % 2, 0) << byte;
    const Character read = read_wire(wire_character(static_cast<uint8_t>(byte)));
    EXPECT_EQ(read.data, byte);
    EXPECT_FALSE(read.parity_error || read.framing_error);
  }
}

TEST(Telegram, BlockCheckExample) {
  PROVES("EX-01", "EX-02", "RS485-01", "MDB-RS485-28");
  const std::string example = "02 01 05 00 06 3A 98 01 F4 57";
  expect_same(request(1, 5, {0x0006, 0x3A98, 0x01F4}), example);
  EXPECT_EQ(block_check(hex("02 01 05 00 06 3A 98 01 F4")), 0x57);
  std::string parity;
  for (const uint8_t byte : hex(example)) parity += parity_bit(byte) ? '1' : '0';
  EXPECT_EQ(parity, "1100001111");
  EXPECT_EQ(wire_text(0x02), "00100000011");
  for (size_t n = 0; n < 10; ++n)
    for (int change = 1; change < 256; ++change) {
      Bytes bytes = hex(example);
      bytes[n] = static_cast<uint8_t>(bytes[n] ^ change);
      EXPECT_FALSE(decode_serial(bytes).has_value()) << n << ' ' << change;
    }
  SlaveBench bench({1});
  bench.feed(hex(example), 10 * kMillisecond);
  EXPECT_EQ(bench.answers().size(), 1U);
}

TEST(Telegram, SamplesOfTheManual) {
  PROVES("EX-03", "EX-04", "MDB-RS485-29");
  expect_same(request(1, 0x85, {0x0006, 0x2000, 0x0BB8}), "02 01 85 00 06 20 00 0B B8 13");
  expect_same(response(1, 0x85, {0x0206, 0x0000, 0x0606}), "1D 01 85 02 06 00 00 06 06 9D");
  expect_same(request(1, 0x05, {0x0006, 0x2000, 0x0BB8}), "02 01 05 00 06 20 00 0B B8 93");
  expect_same(response(1, 0x05, {0x0407, 0x3A98, 0}), "1D 01 05 04 07 3A 98 00 00 B8");
  const ParameterTelegram read = parameter_request(Service::Read, 8318, 0, 0);
  expect_same(request(1, 0x86, {}, read), "02 01 86 31 00 20 7E 00 00 00 00 EA");
  expect_same(response(1, 0x86, {}, parameter_response(read, 1'000'000)),
              "1D 01 86 31 00 20 7E 00 0F 42 40 F8");
  expect_same(request(101, 5, {0x0006, 0x07D0, 0}), "02 65 05 00 06 07 D0 00 00 B3");
  // Swapping the start character changes the direction only.
  Bytes swapped = hex("1D 01 05 04 07 3A 98 00 00");
  swapped[0] = 0x02;
  EXPECT_FALSE(decode_serial(with_check(swapped))->response);
}

// PDU lengths as printed (p. 23-24), by TYP.
struct TypeRow {
  int type;
  bool parameter;
  int words;
  int pdu;
  int length;
};
constexpr TypeRow kTypes[] = {{0, true, 1, 10, 14}, {1, false, 1, 2, 6},  {2, true, 2, 12, 16},
                              {3, false, 2, 4, 8},  {4, true, 3, 14, 18}, {5, false, 3, 6, 10},
                              {6, true, 0, 8, 12}};

TEST(Telegram, TypesOfTheManual) {
  PROVES("RS485-15", "MDB-RS485-15", "MDB-RS485-23", "MDB-RS485-24");
  for (const TypeRow& row : kTypes)
    for (const int acyclic : {0, 0x80}) {
      const auto format = telegram_format(row.type | acyclic);
      ASSERT_TRUE(format.has_value());
      EXPECT_EQ(*format, (TelegramFormat{row.parameter, static_cast<uint8_t>(row.words), acyclic != 0}));
      EXPECT_EQ(format_code(*format), row.type | acyclic);
      EXPECT_EQ(pdu_length(*format), row.pdu);
      EXPECT_EQ(telegram_length(*format), row.length);
      const SerialBytes bytes = encode(SerialTelegram{false, 1, *format, {}, {}});
      EXPECT_EQ(bytes.size, row.length);
    }
  int known = 0;
  for (int type = 0; type < 256; ++type) known += telegram_format(type).has_value();
  EXPECT_EQ(known, 14);
  for (const int type : {0x07, 0x7F, 0x87, 0xFF}) EXPECT_FALSE(telegram_format(type).has_value());
}

TEST(Telegram, ChannelFirstThenWordsHighByteFirst) {
  PROVES("RS485-03", "RS485-16", "MDB-RS485-25", "MDB-RS485-26");
  const ParameterTelegram channel = parameter_request(Service::Write, 0x2116, 0, 1'000'000);
  const SerialBytes bytes = encode(request(9, 4, {0x3A98, 0x1122, 0x3344}, channel));
  EXPECT_EQ(text_of(bytes.span().subspan(3, 8)), "32 00 21 16 00 0F 42 40");
  EXPECT_EQ(text_of(bytes.span().subspan(11, 6)), "3A 98 11 22 33 44");
  for (const TypeRow& row : kTypes)
    for (const int acyclic : {0, 0x80}) {
      SlaveBench bench({1});
      const SerialBytes sent = encode(request(1, row.type | acyclic, {6, 5, 4}, channel));
      bench.feed({sent.span().begin(), sent.span().end()}, 10 * kMillisecond);
      const auto answers = bench.answers();
      ASSERT_EQ(answers.size(), 1U);
      EXPECT_EQ(answers[0].size(), sent.size);
      EXPECT_EQ(answers[0][0], 0x1D);
      EXPECT_EQ(answers[0][2], row.type | acyclic);
    }
}

TEST(Telegram, AddressRanges) {
  PROVES("RS485-07", "MDB-RS485-17");
  for (int address = 0; address < 256; ++address) {
    const AddressKind expected = address <= 99    ? AddressKind::Single
                                 : address == 100 ? AddressKind::NoGroup
                                 : address <= 199 ? AddressKind::Group
                                 : address <= 252 ? AddressKind::None
                                 : address == 253 ? AddressKind::Local
                                 : address == 254 ? AddressKind::Universal
                                                  : AddressKind::Broadcast;
    EXPECT_EQ(address_kind(static_cast<uint8_t>(address)), expected) << address;
    SlaveBench bench({5, 101});
    const SerialBytes bytes = encode(request(static_cast<uint8_t>(address), 5, {6, 7, 8}));
    bench.feed({bytes.span().begin(), bytes.span().end()}, 10 * kMillisecond);
    const bool reacts = address == 5 || address == 101 || address >= 254;
    EXPECT_EQ(!bench.unit.untouched(), reacts) << address;
    EXPECT_EQ(bench.answers().size(), address == 5 || address == 254 ? 1U : 0U) << address;
  }
}

SerialTelegram any_telegram() {
  const TypeRow& row = kTypes[*rc::gen::inRange<size_t>(0, 7)];
  SerialTelegram t;
  t.response = *rc::gen::arbitrary<bool>();
  t.address = *rc::gen::arbitrary<uint8_t>();
  t.format = *telegram_format(row.type | (*rc::gen::arbitrary<bool>() ? 0x80 : 0));
  if (t.format.parameter)
    t.parameter = {*rc::gen::arbitrary<uint8_t>(), *rc::gen::arbitrary<uint8_t>(),
                   *rc::gen::arbitrary<uint16_t>(), *rc::gen::arbitrary<uint32_t>()};
  for (size_t n = 0; n < t.format.words; ++n) t.words[n] = *rc::gen::arbitrary<uint16_t>();
  return t;
}

TEST(Telegram, RoundTrips) {
  PROVES("RS485-17");
  EXPECT_TRUE(rc::check("fields to bytes to fields", [] {
    const SerialTelegram t = any_telegram();
    const SerialBytes bytes = encode(t);
    uint8_t all = 0;
    for (const uint8_t byte : bytes.span()) all ^= byte;
    RC_ASSERT(all == 0);
    const auto decoded = decode_serial(bytes.span());
    RC_ASSERT(decoded.has_value());
    RC_ASSERT(*decoded == t);
  }));
  EXPECT_TRUE(rc::check("bytes that decode encode to themselves", [] {
    Bytes bytes = *rc::gen::container<Bytes>(*rc::gen::inRange<size_t>(0, 20), rc::gen::arbitrary<uint8_t>());
    if (!bytes.empty()) bytes[0] = *rc::gen::arbitrary<bool>() ? 0x02 : 0x1D;
    if (bytes.size() > 3) bytes[2] = static_cast<uint8_t>(bytes[2] & 0x87);
    if (bytes.size() > 3) {
      bytes.pop_back();
      bytes = with_check(bytes);
    }
    const auto decoded = decode_serial(bytes);
    if (decoded) RC_ASSERT(text_of(encode(*decoded).span()) == text_of(bytes));
  }));
}

TEST(Telegram, TextForPeople) {
  EXPECT_EQ(describe(request(1, 5, {6, 0x3A98, 0x1F4})), "request to 1, 3PD cyclic, PO 0006 3A98 01F4");
  const ParameterTelegram read = parameter_request(Service::Read, 8318, 0, 0);
  EXPECT_EQ(describe(response(1, 0x86, {}, parameter_refusal(read, return_codes::kInvalidIndex))),
            "response of 1, PARAM acyclic, read 8318: class 8 code 0 additional 10h: invalid parameter "
            "index");
  EXPECT_EQ(decode_serial(hex("02 01")).error(), SerialError::Gap);
  EXPECT_EQ(decode_serial(hex("03 01 05 00")).error(), SerialError::Start);
  EXPECT_EQ(decode_serial(hex("02 01 05 00")).error(), SerialError::Gap);
}

TEST(Telegram, EveryPartHasItsText) {
  const ParameterTelegram write = parameter_request(Service::Write, 8470, 0, -2);
  EXPECT_EQ(describe(request(7, 0x04, {6, 5, 4}, write)),
            "request to 7, PARAM + 3PD cyclic, write 8470: FFFFFFFE (-2), PO 0006 0005 0004");
  ParameterTelegram handed = write;
  handed.management |= 0x40;
  EXPECT_EQ(describe(request(7, 0x82, {6, 5, 4}, handed)),
            "request to 7, PARAM + 2PD acyclic, write 8470 (handshake 1): FFFFFFFE (-2), PO 0006 0005");
  EXPECT_EQ(describe(response(7, 0x00, {6, 5, 4}, parameter_response(write, 3))),
            "response of 7, PARAM + 1PD cyclic, write 8470: 00000003 (3), PI 0006");
  // A request has not failed, whatever its bit 7 is; a service without a number of its own is unknown.
  ParameterTelegram odd{0xBF, 0, 1, 0x05050000};
  EXPECT_EQ(describe(request(7, 6, {}, odd)),
            "request to 7, PARAM cyclic, unknown service 1: 05050000 (84213760)");
  EXPECT_EQ(describe(response(7, 6, {}, odd)),
            "response of 7, PARAM cyclic, unknown service 1: " + describe(return_codes::kWrongManagement));
  EXPECT_EQ(describe(request(255, 0x81, {6, 5, 4})), "request to 255, 1PD acyclic, PO 0006");
  EXPECT_EQ(format_text({}), " cyclic");
}

TEST(Telegram, WhatIsNoTelegram) {
  const auto error = [](const std::string& text) { return decode_serial(hex(text)).error(); };
  EXPECT_EQ(error(""), SerialError::Gap);
  EXPECT_EQ(error("02 01"), SerialError::Gap);
  EXPECT_EQ(error("03 01 01 00 01 02"), SerialError::Start);
  EXPECT_EQ(error("02 01 07"), SerialError::Type);
  EXPECT_EQ(error("02 01 01"), SerialError::Gap);
  EXPECT_EQ(error("02 01 01 00 01"), SerialError::Gap);
  EXPECT_EQ(error("02 01 01 00 01 03 00"), SerialError::Gap);
  EXPECT_EQ(error("02 01 01 00 01 02"), SerialError::BlockCheck);
}

}  // namespace
}  // namespace ipos::tests

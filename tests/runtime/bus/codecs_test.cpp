// SBus identifiers, parameter telegrams, process data, formats and return codes, each exhaustively or by the
// manual's tables.
#include <gtest/gtest.h>

#include <set>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/parameter_telegram.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/return_code.hpp"
#include "tests/harness/proves.hpp"

namespace ipos::runtime {
namespace {

uint32_t id(Telegram telegram, int address) {
  return sbus_identifier(telegram, static_cast<uint8_t>(address));
}

TEST(SbusIdentifiers, TableOfTheManual) {
  PROVES("SBUS-02", "SBUS-03", "SBUS-04", "SBUS-05", "SBUS-06", "SBUS-07", "SBUS-08");
  EXPECT_EQ(id(Telegram::ProcessOutput, 0), 3U);
  EXPECT_EQ(id(Telegram::ProcessOutput, 1), 11U);
  EXPECT_EQ(id(Telegram::ProcessOutput, 33), 267U);
  EXPECT_EQ(id(Telegram::ProcessOutput, 63), 507U);
  EXPECT_EQ(id(Telegram::ProcessInput, 0), 4U);
  EXPECT_EQ(id(Telegram::ProcessInput, 1), 12U);
  EXPECT_EQ(id(Telegram::ProcessInput, 63), 508U);
  EXPECT_EQ(id(Telegram::ProcessOutputSync, 0), 5U);
  EXPECT_EQ(id(Telegram::ProcessOutputSync, 1), 13U);
  EXPECT_EQ(id(Telegram::ProcessOutputSync, 63), 509U);
  EXPECT_EQ(id(Telegram::GroupProcessOutput, 0), 6U);
  EXPECT_EQ(id(Telegram::GroupProcessOutput, 2), 22U);
  EXPECT_EQ(id(Telegram::GroupProcessOutput, 63), 510U);
  EXPECT_EQ(id(Telegram::ParameterRequest, 0), 515U);
  EXPECT_EQ(id(Telegram::ParameterRequest, 1), 523U);
  EXPECT_EQ(id(Telegram::ParameterRequest, 63), 1019U);
  EXPECT_EQ(id(Telegram::ParameterResponse, 0), 516U);
  EXPECT_EQ(id(Telegram::ParameterResponse, 1), 524U);
  EXPECT_EQ(id(Telegram::ParameterResponse, 63), 1020U);
  EXPECT_EQ(id(Telegram::GroupParameterRequest, 0), 518U);
  EXPECT_EQ(id(Telegram::GroupParameterRequest, 2), 534U);
  EXPECT_EQ(id(Telegram::GroupParameterRequest, 63), 1022U);
  // MOVIDRIVE B, second parameter channel: 8 a + 512 + 5 and + 7.
  EXPECT_EQ(id(Telegram::ParameterRequest2, 5), 8U * 5 + 512 + 5);
  EXPECT_EQ(id(Telegram::ParameterResponse2, 63), 1023U);
}

TEST(SbusIdentifiers, ExampleOfFourInverters) {  // 1053 1610 p. 63
  std::set<uint32_t> all;
  const struct {
    int address;
    uint32_t ids[5];
  } rows[] = {{33, {267, 268, 269, 779, 780}},
              {17, {139, 140, 141, 651, 652}},
              {11, {91, 92, 93, 603, 604}},
              {7, {59, 60, 61, 571, 572}}};
  for (const auto& row : rows) {
    EXPECT_EQ(id(Telegram::ProcessOutput, row.address), row.ids[0]);
    EXPECT_EQ(id(Telegram::ProcessInput, row.address), row.ids[1]);
    EXPECT_EQ(id(Telegram::ProcessOutputSync, row.address), row.ids[2]);
    EXPECT_EQ(id(Telegram::ParameterRequest, row.address), row.ids[3]);
    EXPECT_EQ(id(Telegram::ParameterResponse, row.address), row.ids[4]);
    all.insert(std::begin(row.ids), std::end(row.ids));
  }
  EXPECT_EQ(all.size(), 20U);
}

TEST(SbusIdentifiers, ComposeAndSplitForAllAddresses) {
  std::set<uint32_t> used;
  for (const TelegramType& type : kTelegrams)
    for (uint8_t address = 0; address < kSbusAddresses; ++address) {
      const uint32_t identifier = sbus_identifier(type.telegram, address);
      EXPECT_LT(identifier, 1024U);  // bit 10 is never set
      EXPECT_TRUE(used.insert(identifier).second);
      EXPECT_EQ(classify_identifier(identifier), (SbusIdentifier{type.telegram, address}));
    }
  for (uint32_t other = 0; other < 3000; ++other)
    EXPECT_EQ(classify_identifier(other).has_value(), used.contains(other)) << other;
  EXPECT_FALSE(classify_identifier(~0U).has_value());
}

TEST(ParameterTelegramCodec, BytesOfTheManual) {
  PROVES("MLK-01", "MLK-07", "MLK-08", "SBUS-17");
  EXPECT_EQ(encode(parameter_request(Service::Read, 8318, 0, 123)),
            (ParameterBytes{0x31, 0x00, 0x20, 0x7E, 0, 0, 0, 0}));
  EXPECT_EQ(encode(parameter_request(Service::Write, 8470, 0, 3000)),
            (ParameterBytes{0x32, 0x00, 0x21, 0x16, 0x00, 0x00, 0x0B, 0xB8}));
  EXPECT_EQ(encode(parameter_request(Service::WriteVolatile, 1, 0, -1)),
            (ParameterBytes{0x33, 0x00, 0x00, 0x01, 0xFF, 0xFF, 0xFF, 0xFF}));
  const ParameterTelegram request = parameter_request(Service::Read, 8318, 0, 0);
  EXPECT_EQ(decode_parameter(encode(request)), request);
  EXPECT_EQ(encode(parameter_response(request, 1'000'000)),
            (ParameterBytes{0x31, 0x00, 0x20, 0x7E, 0x00, 0x0F, 0x42, 0x40}));
  EXPECT_EQ(encode(parameter_refusal(parameter_request(Service::Write, 8318, 0, 1), return_codes::kReadOnly)),
            (ParameterBytes{0xB2, 0x00, 0x20, 0x7E, 0x08, 0x00, 0x00, 0x12}));
}

TEST(ParameterTelegramCodec, EveryByteOfEveryFieldSurvives) {
  for (size_t position = 0; position < 8; ++position)
    for (int value = 0; value < 256; ++value) {
      ParameterBytes bytes{1, 2, 3, 4, 5, 6, 7, 8};
      bytes[position] = static_cast<uint8_t>(value);
      EXPECT_EQ(encode(decode_parameter(bytes)), bytes);
    }
}

// 1053 1688 p. 29: bits 4 and 5 are 00 for 1 byte, 01 for 2, 10 for 3, 11 for 4.
TEST(ParameterTelegramCodec, LengthOfTheData) {
  PROVES("MLK-03");
  for (unsigned value = 0; value < 256; ++value) {
    ParameterTelegram telegram;
    telegram.management = static_cast<uint8_t>(value);
    const std::string bits{(value & 0x20) != 0 ? '1' : '0', (value & 0x10) != 0 ? '1' : '0'};
    const std::map<std::string, int> printed = {{"00", 1}, {"01", 2}, {"10", 3}, {"11", 4}};
    EXPECT_EQ(telegram.data_length(), printed.at(bits)) << value;
  }
  for (uint32_t service = 0; service <= 8; ++service) {
    const ParameterTelegram request = parameter_request(*service_from_code(service), 8470, 0, 3000);
    EXPECT_EQ(encode(request)[0] & 0x30, 0x30) << service;
    EXPECT_EQ(encode(parameter_response(request, 1))[0] & 0x30, 0x30) << service;
    EXPECT_EQ(encode(parameter_refusal(request, return_codes::kReadOnly))[0] & 0x30, 0x30) << service;
  }
}

TEST(ParameterTelegramCodec, ManagementByteBits) {
  for (unsigned value = 0; value < 256; ++value) {
    ParameterTelegram telegram;
    telegram.management = static_cast<uint8_t>(value);
    EXPECT_EQ(telegram.service_code(), value % 16);
    EXPECT_EQ(telegram.synchronous(), value / 64 % 2 == 1);
    EXPECT_EQ(telegram.failed(), value >= 128);
    EXPECT_EQ(service_from_code(value % 16).has_value(), value % 16 <= 8);
  }
  EXPECT_EQ(service_from_code(2), Service::Write);
  EXPECT_EQ(service_from_code(8), Service::ReadAttribute);
  EXPECT_EQ(service_text(Service::ReadScale), "read scale");
}

TEST(ProcessData, ThreeWordsHighByteFirst) {
  PROVES("PD-01");
  const Frame frame = process_frame(11, {0x0006, 0x1388, 0x3A98});
  EXPECT_EQ(frame, (Frame{11, 6, {0x00, 0x06, 0x13, 0x88, 0x3A, 0x98}, false, false}));
  EXPECT_EQ(process_words(frame), (ProcessWords{6, 5000, 15000}));
  for (uint8_t length = 0; length <= 8; ++length)
    EXPECT_EQ(process_words(Frame{11, length, {}, false, false}).has_value(), length == 6);
  EXPECT_FALSE(process_words(Frame{11, 6, {}, true, false}).has_value());
  EXPECT_FALSE(process_words(Frame{11, 6, {}, false, true}).has_value());
}

TEST(Format, TypesOfTheTelegram) {
  const TelegramFormat rows[] = {{true, 1, false}, {false, 1, false}, {true, 2, false}, {false, 2, false},
                                 {true, 3, false}, {false, 3, false}, {true, 0, false}};
  for (int32_t code = 0; code < 7; ++code) {
    TelegramFormat row = rows[code];
    EXPECT_EQ(telegram_format(code), row);
    row.acyclic = true;
    EXPECT_EQ(telegram_format(code + 128), row);
  }
  for (const int32_t bad : {-1, 7, 127, 135, 256, INT32_MAX, INT32_MIN}) EXPECT_FALSE(telegram_format(bad));
}

TEST(ReturnCodes, TableAndPacking) {
  EXPECT_EQ(return_codes::kInvalidIndex.packed(), 0x08000010U);
  EXPECT_EQ(return_codes::kWrongManagement.packed(), 0x05050000U);
  EXPECT_EQ(return_codes::kCommunication.packed(), 0x06020000U);
  std::set<uint32_t> packed;
  for (const stdlib::ReturnCodeRow& row : stdlib::return_code_table()) {
    EXPECT_TRUE(packed.insert(row.code.packed()).second);
    EXPECT_EQ(ReturnCode::unpack(row.code.packed()), row.code);
    EXPECT_FALSE(stdlib::return_class_meaning(row.code.error_class).empty());
  }
  EXPECT_EQ(packed.size(), 21U);  // 3 special cases and the additional codes 00, 10..20 of class 8
  EXPECT_EQ(describe(return_codes::kReadOnly), "class 8 code 0 additional 12h: read access only");
  EXPECT_EQ(describe({4, 9, 0x77}), "class 4 code 9 additional 77h: resource error");
  EXPECT_EQ(describe({99, 0, 0}), "class 99 code 0 additional 00h: unknown");
}

}  // namespace
}  // namespace ipos::runtime

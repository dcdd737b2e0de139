// Which identifiers a unit uses by its profile, and telegrams in words.
#include "runtime/bus/movilink/profile.hpp"
#include "runtime/bus/movilink/unit_words.hpp"

#include <gtest/gtest.h>

#include <set>

#include "runtime/bus/movilink/describe.hpp"
#include "runtime/bus/movilink/process_data.hpp"
#include "runtime/bus/movilink/variable_telegram.hpp"
#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/sbus_rig.hpp"

namespace ipos::tests {
namespace {

std::vector<uint32_t> ids(const std::vector<IdentifierUse>& uses) {
  std::vector<uint32_t> out;
  for (const IdentifierUse& use : uses) out.push_back(use.id);
  return out;
}

SlaveSettings m07(uint8_t address, uint8_t group) {
  SlaveSettings settings{address, group, 0};
  settings.synchronous = false;
  return settings;
}

TEST(Profile, IdentifiersOfAUnit) {
  EXPECT_EQ(ids(slave_identifiers({0, 0, 0})), (std::vector<uint32_t>{3, 4, 5, 6, 515, 516, 518}));
  EXPECT_EQ(ids(slave_identifiers({1, 2, 0})), (std::vector<uint32_t>{11, 12, 13, 22, 523, 524, 534}));
  EXPECT_EQ(ids(slave_identifiers(m07(1, 2))), (std::vector<uint32_t>{11, 12, 22, 523, 524, 534}));
  SlaveSettings b{1, 2, 0};
  b.second_channel = true;
  EXPECT_EQ(ids(slave_identifiers(b)), (std::vector<uint32_t>{11, 12, 13, 22, 523, 524, 525, 527, 534}));
  for (const IdentifierUse& use : slave_identifiers(b))
    EXPECT_EQ(use.transmits, use.id == 12 || use.id == 524 || use.id == 527) << use.id;
  EXPECT_EQ(ids(master_identifiers(1, {})), (std::vector<uint32_t>{11, 12, 13, 523, 524}));
  EXPECT_EQ(ids(master_identifiers(102, {})), (std::vector<uint32_t>{22, 534}));
  for (const IdentifierUse& use : master_identifiers(1, b))
    EXPECT_EQ(use.transmits, use.id != 12 && use.id != 524) << use.id;
}

// The second channel is not used by MOVLNK (ours).
TEST(Profile, TelegramsAndAddressesOfTheIdentifiers) {
  SlaveSettings b{1, 2, 0};
  b.second_channel = true;
  using Uses = std::vector<IdentifierUse>;
  EXPECT_EQ(slave_identifiers(b), (Uses{{11, Telegram::ProcessOutput, 1, false},
                                        {12, Telegram::ProcessInput, 1, true},
                                        {13, Telegram::ProcessOutputSync, 1, false},
                                        {22, Telegram::GroupProcessOutput, 2, false},
                                        {523, Telegram::ParameterRequest, 1, false},
                                        {524, Telegram::ParameterResponse, 1, true},
                                        {525, Telegram::ParameterRequest2, 1, false},
                                        {527, Telegram::ParameterResponse2, 1, true},
                                        {534, Telegram::GroupParameterRequest, 2, false}}));
  EXPECT_EQ(master_identifiers(3, b), (Uses{{27, Telegram::ProcessOutput, 3, true},
                                            {28, Telegram::ProcessInput, 3, false},
                                            {29, Telegram::ProcessOutputSync, 3, true},
                                            {539, Telegram::ParameterRequest, 3, true},
                                            {540, Telegram::ParameterResponse, 3, false}}));
  EXPECT_EQ(master_identifiers(100, m07(1, 2)), (Uses{{6, Telegram::GroupProcessOutput, 0, true},
                                                      {518, Telegram::GroupParameterRequest, 0, true}}));
}

TEST(Profile, FieldsOfTheIdentifier) {
  PROVES("SBUS-01", "M07-SBUS-01", "M07-SBUS-02");
  std::set<uint32_t> used;
  for (int address = 0; address < 64; ++address)
    for (const TelegramType& type : kTelegrams) {
      const uint32_t id = sbus_identifier(type.telegram, static_cast<uint8_t>(address));
      EXPECT_EQ(id & 7, type.function);
      EXPECT_EQ(id >> 3 & 63, static_cast<uint32_t>(address));
      EXPECT_EQ((id >> 9 & 1) != 0, type.parameter);
      EXPECT_EQ(id >> 10, 0U);
      EXPECT_EQ(classify_identifier(id), (SbusIdentifier{type.telegram, static_cast<uint8_t>(address)}));
      if (has_telegram(m07(0, 0), type.telegram)) used.insert(id);
    }
  EXPECT_EQ(*used.begin(), 3U);
  EXPECT_EQ(*used.rbegin(), 1022U);
  EXPECT_EQ(classify_identifier(267), (SbusIdentifier{Telegram::ProcessOutput, 33}));
  EXPECT_EQ(classify_identifier(918), (SbusIdentifier{Telegram::GroupParameterRequest, 50}));
  EXPECT_EQ(sbus_identifier(Telegram::ProcessOutput, 33), 267U);
  EXPECT_EQ(sbus_identifier(Telegram::GroupParameterRequest, 50), 918U);
  for (uint32_t id = 1024; id < kStandardIdLimit; ++id) EXPECT_FALSE(classify_identifier(id));
  // What the encoder makes is always standard; an extended frame is no telegram.
  Frame frame = process_frame(11, {6, 0, 0});
  EXPECT_FALSE(frame.extended);
  frame.extended = true;
  EXPECT_FALSE(process_words(frame));
  EventQueue queue;
  CanLine line(queue, 9, "sbus", 500'000);
  Hand master(line, "control");
  Unit unit(queue, 1, line, "unit1", SlaveSettings{1, 2, 0});
  master.port.send(frame, 0);
  queue.run_until(kMillisecond);
  EXPECT_TRUE(unit.outputs.empty());
  EXPECT_EQ(unit.ignored, std::vector<Ignored>{Ignored::Extended});
}

TEST(Profile, IdentifierTablesOfMovitrac07) {
  PROVES("M07-SBUS-03", "M07-SBUS-04", "M07-SBUS-05");
  const auto id = [](Telegram telegram, int address) {
    return sbus_identifier(telegram, static_cast<uint8_t>(address));
  };
  EXPECT_EQ(id(Telegram::ProcessOutput, 17), 139U);
  EXPECT_EQ(id(Telegram::ProcessInput, 17), 140U);
  EXPECT_EQ(id(Telegram::ProcessOutput, 0), 3U);
  EXPECT_EQ(id(Telegram::ProcessInput, 0), 4U);
  EXPECT_EQ(id(Telegram::ProcessOutput, 63), 507U);
  EXPECT_EQ(id(Telegram::ProcessInput, 63), 508U);
  EXPECT_EQ(id(Telegram::ParameterRequest, 1), 523U);
  EXPECT_EQ(id(Telegram::ParameterResponse, 1), 524U);
  EXPECT_EQ(id(Telegram::ParameterRequest, 0), 515U);
  EXPECT_EQ(id(Telegram::ParameterResponse, 0), 516U);
  EXPECT_EQ(id(Telegram::GroupProcessOutput, 2), 22U);
  EXPECT_EQ(id(Telegram::GroupParameterRequest, 2), 534U);
  EXPECT_EQ(id(Telegram::GroupProcessOutput, 0), 6U);
  EXPECT_EQ(id(Telegram::GroupParameterRequest, 0), 518U);
}

struct M07Rig {
  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Hand master{line, "control"};
  Unit a{queue, 1, line, "a", m07(5, 50)};
  Unit b{queue, 2, line, "b", m07(6, 50)};
  Unit c{queue, 3, line, "c", m07(50, 50)};
  std::vector<Frame> ask(const Frame& frame) {
    master.frames.clear();
    master.port.send(frame, 0);
    queue.run_until(queue.now() + 10 * kMillisecond);
    return master.frames;
  }
};

TEST(Profile, ProcessDataOfMovitrac07) {
  PROVES("M07-SBUS-06", "M07-SBUS-14", "M07-SBUS-15", "M07-SBUS-16");
  M07Rig rig;
  rig.queue.run_until(kSecond);
  EXPECT_TRUE(rig.master.frames.empty());  // no PI without PO
  for (int n = 0; n < 10; ++n) {
    const std::vector<Frame> answer = rig.ask(process_frame(43, {6, 0, 0}));
    ASSERT_EQ(answer.size(), 1U);
    EXPECT_EQ(answer[0].id, 44U);
    EXPECT_EQ(answer[0].length, 6);
  }
  EXPECT_EQ(rig.a.outputs.size(), 10U);
  for (const uint8_t length : std::initializer_list<uint8_t>{0, 4, 5, 7, 8})
    EXPECT_TRUE(rig.ask({43, length, {0, 7}, false, false}).empty());
  EXPECT_EQ(rig.a.outputs.size(), 10U);
  // Station c has address 50 and group 50: 403 is its PO, 406 the group's.
  EXPECT_EQ(rig.ask(process_frame(403, {6, 1, 0})).size(), 1U);
  EXPECT_TRUE(rig.ask(process_frame(406, {6, 2, 0})).empty());
  EXPECT_EQ(rig.a.outputs.back(), (ProcessWords{6, 2, 0}));
  EXPECT_EQ(rig.b.outputs.back(), (ProcessWords{6, 2, 0}));
  EXPECT_EQ(rig.c.outputs, (std::vector<ProcessWords>{{6, 1, 0}, {6, 2, 0}}));
  // The function decides, also where both numbers are equal: 46 is a group PO, 43 a single one.
  Unit d(rig.queue, 4, rig.line, "d", m07(9, 9));
  EXPECT_EQ(rig.ask(process_frame(8 * 9 + 3, {6, 3, 0})).size(), 1U);
  EXPECT_TRUE(rig.ask(process_frame(8 * 9 + 6, {6, 4, 0})).empty());
  EXPECT_EQ(d.channels, (std::vector<OutputChannel>{OutputChannel::Single, OutputChannel::Group}));
  // No synchronous telegrams.
  EXPECT_TRUE(rig.ask(process_frame(45, {6, 9, 0})).empty());
  EXPECT_TRUE(rig.ask({0, 0, {}, false, false}).empty());
  EXPECT_EQ(rig.a.outputs.back(), (ProcessWords{6, 2, 0}));
  EXPECT_EQ(rig.a.syncs, 0);
}

TEST(Profile, ParametersOfMovitrac07) {
  PROVES("M07-SBUS-17", "M07-SBUS-18");
  M07Rig rig;
  for (Unit* unit : {&rig.a, &rig.b, &rig.c}) unit->parameters[8517] = 0;  // P302 Maximum speed 1
  const std::vector<Frame> answer = rig.ask({8 * 5 + 515, 8, {0x31, 0, 0x20, 0x7E}, false, false});
  ASSERT_EQ(answer.size(), 1U);
  EXPECT_EQ(answer[0].id, 8U * 5 + 516);
  EXPECT_EQ(answer[0].length, 8);
  EXPECT_TRUE(rig.ask({918, 8, {0x32, 0, 0x21, 0x45, 0, 0, 0x0B, 0xB8}, false, false}).empty());
  for (Unit* unit : {&rig.a, &rig.b, &rig.c}) EXPECT_EQ(unit->parameters[8517], 3000);
  EXPECT_TRUE(rig.ask({918, 8, {0x31, 0, 0x21, 0x45, 0, 0, 0, 1}, false, false}).empty());
  for (Unit* unit : {&rig.a, &rig.b, &rig.c}) EXPECT_EQ(unit->parameters[8517], 3000);
}

TEST(Profile, VariableTelegramsOfMovitrac07) {
  PROVES("M07-SCOM-27", "M07-SCOM-28");
  const VariablePair pair{0x11223344, 0x55667788};
  const Frame motorola = variable_frame(1024, {8, VariableLayout::Motorola}, pair);
  EXPECT_EQ(motorola.data, (std::array<uint8_t, 8>{0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}));
  EXPECT_EQ(frame_variables(motorola, {8, VariableLayout::Motorola}), pair);
  const Frame intel = variable_frame(1024, {8, VariableLayout::Intel}, pair);
  EXPECT_EQ(intel.data, (std::array<uint8_t, 8>{0x44, 0x33, 0x22, 0x11, 0x88, 0x77, 0x66, 0x55}));
  EXPECT_EQ(frame_variables(intel, {8, VariableLayout::Intel}), pair);
}

// --- in words

TelegramNames names() {
  TelegramNames all;
  UnitNames unit;
  unit.name = "unit1";
  unit.unit = stdlib::find_unit("md60a");
  unit.settings = {1, 2, 0};
  unit.output = {9, 1, 5};
  unit.input = {6, 1, 2};
  unit.variables = {{426, "lTrDataLow"}};
  all.units.push_back(unit);
  ObjectNames object;
  object.id = 1024;
  object.station = "unit1";
  object.sent = true;
  object.format = {8, VariableLayout::Motorola};
  object.variables = {"lTrDataLow", "lTrDataHigh"};
  object.cycle = 100;
  all.objects.push_back(object);
  return all;
}

std::string words(const Frame& frame) { return describe(names(), frame).text; }

TEST(Describe, ParameterTelegrams) {
  EXPECT_EQ(words({523, 8, {0x31, 0, 0x20, 0x7E}, false, false}), "20B read 8318 Speed -> unit1");
  EXPECT_EQ(words({524, 8, {0x31, 0, 0x20, 0x7E, 0, 0x0F, 0x42, 0x40}, false, false}),
            "20C read 8318 Speed = 1000.000 rpm <- unit1");
  EXPECT_EQ(words({523, 8, {0x32, 0, 0x21, 0x16, 0, 0, 0x0B, 0xB8}, false, false}),
            "20B write 8470 Ramp t11 UP CW = 3.000 s -> unit1");
  EXPECT_EQ(words({523, 8, {0x12, 0, 0x21, 0x16, 0, 0, 0x0B, 0xB8}, false, false}),
            "20B write 8470 Ramp t11 UP CW = 3.000 s, length 2 in place of 4 bytes -> unit1");
  EXPECT_EQ(words({524, 8, {0xB2, 0, 0x20, 0x7E, 8, 0, 0, 0x12}, false, false}).substr(0, 47),
            "20C write 8318 Speed refused: class 8 code 0 ad");
  EXPECT_EQ(words({534, 8, {0x33, 0, 0x2C, 0xA2, 0xFF, 0xFF, 0xFF, 0xFF}, false, false}),
            "216 write volatile 11426 lTrDataLow = -1 -> group 2");
  EXPECT_EQ(words({523, 8, {0x71, 0, 0x2A, 0xFD}, false, false}),
            "20B read 11005 H5, answer after sync -> unit1");
  EXPECT_EQ(words({523, 8, {0x37, 0, 0x20, 0x7E}, false, false}), "20B read scale 8318 Speed -> unit1");
  // 1053 1610 p. 31: P131, quantity 4 = time, conversion -3; FFh: none is given.
  EXPECT_EQ(words({524, 8, {0x37, 0, 0x21, 0x17, 0, 0, 0x04, 0xFD}, false, false}),
            "20C read scale 8471 Ramp t11 DOWN CW = quantity 4 time, conversion -3 (ms) <- unit1");
  EXPECT_EQ(words({524, 8, {0x37, 0, 0x20, 0x7E, 0, 0, 0x0B, 0x42}, false, false}),
            "20C read scale 8318 Speed = quantity 11 rotational velocity, conversion 66 <- unit1");
  EXPECT_EQ(words({524, 8, {0x37, 0, 0x20, 0x7E, 0, 0, 0xFF, 0x00}, false, false}),
            "20C read scale 8318 Speed = no quantity, conversion 0 <- unit1");
  EXPECT_EQ(words({524, 8, {0x37, 0, 0x20, 0x7E, 0, 0, 0x30, 0x00}, false, false}),
            "20C read scale 8318 Speed = quantity 48 unknown, conversion 0 <- unit1");
  // p. 32: next index, then the attributes.
  EXPECT_EQ(
      words({524, 8, {0x38, 0, 0x21, 0x17, 0x21, 0x18, 0, 0x21}, false, false}),
      "20C read attribute 8471 Ramp t11 DOWN CW = next index 8472, attributes 0021h (writable, needs no "
      "inhibit) <- unit1");
  EXPECT_EQ(words({524, 8, {0x38, 0, 0x22, 0xBB, 0, 0, 0, 0}, false, false}),
            "20C read attribute 8891 Encoder type (X14) = last index, attributes 0000h <- unit1");
  EXPECT_EQ(words({523, 8, {0x3F, 0, 0xFF, 0xFF}, false, false}),
            "20B service 15 65535 unknown index -> unit1");
  EXPECT_EQ(words({523, 3, {0x31}, false, false}), "20B 3 bytes in place of 8: 31 00 00 -> unit1");
  EXPECT_EQ(words({531, 8, {0x31, 0, 0x20, 0x7E}, false, false}), "213 read 8318 Speed -> address 2");
}

TEST(Describe, RequestAndResponseAreNotMixedUp) {
  PROVES("M07-SBUS-19");
  for (uint32_t a = 0; a < 64; ++a) {
    const Frame request{8 * a + 515, 8, {0x31, 0, 0x20, 0x7E}, false, false};
    EXPECT_EQ(telegram_type(classify_identifier(request.id)->telegram).text, "parameter request");
    EXPECT_NE(describe({}, request).text.find(" -> "), std::string::npos);
    const Frame response{8 * a + 516, 8, {0x31, 0, 0x20, 0x7E}, false, false};
    EXPECT_EQ(telegram_type(classify_identifier(response.id)->telegram).text, "parameter response");
    EXPECT_NE(describe({}, response).text.find(" <- "), std::string::npos);
  }
}

TEST(Describe, ProcessDataByAssignment) {
  PROVES("M07-SCOM-09");
  // The sample of MOVITRAC 07 chapter 5.1: P870..P872 control word, speed, max. speed; P873, P874 status
  // word, speed.
  EXPECT_EQ(words(process_frame(11, {6, 5000, 15000})),
            "00B PO CTRL. WORD 1 0006h (enable), SPEED 1000.0 rpm, MAX. SPEED 3000.0 rpm -> unit1");
  EXPECT_EQ(words(process_frame(12, {7, 5011, 0})),
            "00C PI STATUS WORD1 0007h (ready, output stage on, PO data on; state 0 not ready), SPEED 1002.2 "
            "rpm, OUTP. CURRENT 0.0 % In <- unit1");
  EXPECT_EQ(process_word_text(false, 1, 5000), "1000.0 rpm");
  EXPECT_EQ(process_word_text(false, 5, 15000), "3000.0 rpm");
  EXPECT_EQ(process_word_text(true, 1, 5011), "1002.2 rpm");
}

// MOVITRAC 07 chapters 6.2, 6.3, 6.5.
TEST(Describe, BitsOfTheUnitProfile) {
  PROVES("M07-SW-06", "M07-MON-09");
  const stdlib::UnitType& m07 = *stdlib::find_unit("mc07");
  const stdlib::UnitType& mdx = *stdlib::find_unit("md60a");
  EXPECT_EQ(status_word_text(m07, 1, 0x0000), "not ready; state 0 not ready");
  EXPECT_EQ(status_word_text(m07, 1, 0x0020), "fault");
  EXPECT_EQ(status_word_text(m07, 1, 0x0002), "ready; state 0 not ready");
  EXPECT_EQ(status_word_text(m07, 1, 0x0022), "warning");
  EXPECT_EQ(status_word_text(m07, 2, 0x0022), "warning");
  EXPECT_EQ(status_word_text(m07, 1, 0x0407), "ready, output stage on, PO data on; state 4 enable");
  EXPECT_EQ(status_word_text(m07, 1, 0x0500), "not ready; state 5 factory setting");
  EXPECT_EQ(status_word_text(m07, 1, 0x2F24), "fault, PO data on; F47 SBus timeout");
  EXPECT_EQ(status_word_text(mdx, 1, 0x0529), "fault, output stage on, ramp set 2; F05");
  EXPECT_EQ(status_word_text(mdx, 2, 0x8142), "ready, CW limit switch, DO10, DO17");

  EXPECT_EQ(control_word_text(m07, 1, 0x0000), "rapid stop");
  EXPECT_EQ(control_word_text(m07, 1, 0x0001), "controller inhibit");
  EXPECT_EQ(control_word_text(m07, 1, 0x0002), "stop");
  EXPECT_EQ(control_word_text(m07, 1, 0x0046), "enable, reset");
  EXPECT_EQ(control_word_text(m07, 2, 0xA506), "enable, data bit 8, data bit 10, data bit 13, data bit 15");
  EXPECT_EQ(control_word_text(mdx, 2, 0x0106), "enable, DI10");
  // One word under two assignments.
  EXPECT_EQ(process_word_text(false, 1, 0xF15A), "-750.0 rpm");
  EXPECT_EQ(
      unit_word_text(m07, false, 9, 0xF15A),
      "stop, reserved bit 3, reserved bit 4, reset, motor potentiometer CCW, fixed setpoint bit 1, other "
      "set of fixed setpoints, reserved bit 14, reserved bit 15");
  EXPECT_EQ(unit_word_text(m07, false, 1, 0xF15A), "");
}

TEST(Describe, ScalesOfTheUnitProfile) {
  // Examples of MOVITRAC 07 chapter 6.1.
  EXPECT_EQ(process_word_text(false, 1, 2000), "400.0 rpm");
  EXPECT_EQ(process_word_text(false, 1, 0xF15A), "-750.0 rpm");
  EXPECT_EQ(process_word_text(false, 11, 0x1000), "25.00 %");
  EXPECT_EQ(process_word_text(false, 11, 0xD000), "-75.00 %");
  EXPECT_EQ(process_word_text(true, 2, 0x01C2), "45.0 % In");
  EXPECT_EQ(process_word_text(true, 3, 0x0483), "115.5 % In");
  EXPECT_EQ(process_word_text(false, 8, 0x012C), "300 ms");
  EXPECT_EQ(process_word_text(false, 8, 0x0578), "1400 ms");
  EXPECT_EQ(process_word_text(false, 8, 0xFFFF), "65535 ms");
  EXPECT_EQ(process_word_text(false, 1, 0x8000), "-6553.6 rpm");
  EXPECT_EQ(process_word_text(false, 3, 0xFFFF), "-1");
  EXPECT_EQ(process_word_text(true, 6, 0x0202), "0202h");
}

// P885 = 300 makes an identifier of address 37 the sync telegram's (examples/isync): 300 = 8 * 37 + 4.
TEST(Describe, TheSyncTelegramHasTheIdentifierOfAnAddressThatNobodyHas) {
  TelegramNames with_sync = names();
  with_sync.units[0].settings.sync_id = 300;
  EXPECT_EQ(describe(with_sync, {300, 0, {}, false, false}).text, "12C sync telegram");
  with_sync.units.push_back(with_sync.units[0]);
  with_sync.units[1].settings.address = 37;
  EXPECT_NE(describe(with_sync, {300, 6, {}, false, false}).text.find("12C PI"), std::string::npos);
}

TEST(Describe, VariableAndOtherTelegrams) {
  EXPECT_EQ(words({1024, 8, {0x55, 0x66, 0x77, 0x88, 0x11, 0x22, 0x33, 0x44}, false, false}),
            "400 lTrDataLow = 287454020 (11223344h), lTrDataHigh = 1432778632 (55667788h) <- unit1");
  EXPECT_EQ(words({1024, 2, {1, 2}, false, false}), "400 object of unit1 with 2 bytes in place of 8: 01 02");
  EXPECT_EQ(words({0, 0, {}, false, false}), "000 sync telegram");
  const Description unknown = describe(names(), {2000, 2, {0xAB, 0xCD}, false, false});
  EXPECT_FALSE(unknown.known);
  EXPECT_EQ(unknown.text, "7D0 AB CD");
  EXPECT_FALSE(describe(names(), {11, 6, {}, true, false}).known);
  EXPECT_FALSE(describe(names(), {523, 0, {}, false, true}).known);
  EXPECT_EQ(describe({}, process_frame(11, {6, 0, 0})).text, "00B PO 0006h, 0000h, 0000h -> address 1");
}

}  // namespace
}  // namespace ipos::tests

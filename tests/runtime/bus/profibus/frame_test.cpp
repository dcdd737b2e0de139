// The five frame formats against captured frames, the norm's table and properties in both directions.
#include "runtime/bus/profibus/fdl_frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "runtime/bus/profibus/frame_text.hpp"
#include "tests/runtime/bus/profibus/octets.hpp"

namespace ipos::tests {
namespace {

// A start-up of an S7 with an ET 200S as it was captured, and what it means.
struct Captured {
  std::string octets;
  FdlFrame frame;
  std::string text;
};
const Captured kStartUp[] = {
    {"68 07 07 68 FF 81 46 3A 3E 00 00 3E 16",
     {Delimiter::SD2, 127, 1, 0x46, 58, 62, {0, 0}},
     "1 -> 127 Global_Control, SDN high: Operate, all"},
    {"68 05 05 68 88 81 6D 3C 3E F0 16",
     {Delimiter::SD2, 8, 1, 0x6D, 60, 62, {}},
     "1 -> 8 Slave_Diag, SRD high, FCB 1 (first)"},
    {"68 0B 0B 68 81 88 08 3E 3C 02 05 00 FF 80 E0 F1 16",
     {Delimiter::SD2, 1, 8, 0x08, 62, 60, {2, 5, 0, 0xFF, 0x80, 0xE0}},
     "8 -> 1 Slave_Diag answer, DL: Station_Not_Ready, Prm_Req; master none, ident 80E0h"},
    {"68 05 05 68 88 81 5D 3B 3E DF 16",
     {Delimiter::SD2, 8, 1, 0x5D, 59, 62, {}},
     "1 -> 8 Get_Cfg, SRD high, FCB 0"},
    {"68 08 08 68 81 88 08 3E 3B 00 10 10 AA 16",
     {Delimiter::SD2, 1, 8, 0x08, 62, 59, {0, 0x10, 0x10}},
     "8 -> 1 Get_Cfg answer, DL: 00 10 10 (empty place + inputs of 1 octet + inputs of 1 octet)"},
    {"68 08 08 68 88 81 5D 3E 3E 00 10 10 02 16",
     {Delimiter::SD2, 8, 1, 0x5D, 62, 62, {0, 0x10, 0x10}},
     "1 -> 8 Chk_Cfg, SRD high, FCB 0: 00 10 10 (empty place + inputs of 1 octet + inputs of 1 octet)"},
    {"68 05 05 68 88 81 7D 3C 3E 00 16",
     {Delimiter::SD2, 8, 1, 0x7D, 60, 62, {}},
     "1 -> 8 Slave_Diag, SRD high, FCB 1"},
    {"E5", {}, "short acknowledgement"},
    {"DC 02 01", {Delimiter::SD4, 2, 1, 0, {}, {}, {}}, "1 -> 2 token"},
    {"10 03 02 49 4E 16", {Delimiter::SD1, 3, 2, 0x49, {}, {}, {}}, "2 -> 3 FDL status"},
    {"10 02 03 00 05 16", {Delimiter::SD1, 2, 3, 0x00, {}, {}, {}}, "3 -> 2 OK (slave)"},
    {"10 02 03 03 08 16",
     {Delimiter::SD1, 2, 3, 0x03, {}, {}, {}},
     "3 -> 2 RS: service or access point not available (slave)"},
    {"A2 08 01 5D 00 06 05 DC 00 00 00 00 4D 16",
     {Delimiter::SD3, 8, 1, 0x5D, {}, {}, {0, 6, 5, 0xDC, 0, 0, 0, 0}},
     "1 -> 8 Data_Exchange, SRD high, FCB 0: 00 06 05 DC 00 00 00 00"}};

TEST(FdlFrame, CapturedFrames) {
  for (const Captured& captured : kStartUp) {
    const auto frame = decode(hex(captured.octets));
    ASSERT_TRUE(frame.has_value()) << captured.octets << ": " << frame_error_text(frame.error());
    EXPECT_EQ(*frame, captured.frame) << captured.octets;
    EXPECT_EQ(text_of(encode(captured.frame)), captured.octets);
    EXPECT_EQ(describe(captured.frame), captured.text);
  }
}

TEST(FdlFrame, SetPrmOfTheCapture) {
  const auto frame = decode(sd2("88 81 7D 3D 3E B8 0D 0F 0B 80 E0 00"));
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(describe(*frame),
            "1 -> 8 Set_Prm, SRD high, FCB 1: lock, sync, freeze, watchdog 1.95 s, min Tsdr 11, ident 80E0h, "
            "groups 00h");
}

TEST(FdlFrame, OtherTexts) {
  const auto text = [](const Octets& octets) { return describe(*decode(octets)); };
  EXPECT_EQ(text(sd2("FF 82 46 3A 3E 3A 05")),
            "2 -> 127 Global_Control, SDN high: Clear_Data, Unsync, Freeze, groups 05h");
  EXPECT_EQ(text(sd2("82 83 08 3E 3C 08 0C 00 02 31 00 02 2F")),
            "3 -> 2 Slave_Diag answer, DL: Ext_Diag, WD_On; master 2, ident 3100h, fault 47");
  EXPECT_EQ(text(sd2("83 82 5D 32 3E 01")), "2 -> 3 access point 50, SRD high, FCB 0: 01");
  EXPECT_EQ(text(sd2("83 82 7D 3D 3E 40 00 00 00 31 00 00 AA")),
            "2 -> 3 Set_Prm, SRD high, FCB 1: unlock, no watchdog, min Tsdr 0, ident 3100h, groups 00h, user "
            "parameters AA");
  EXPECT_EQ(text(sd2("83 82 7D 3E 3E C0")), "2 -> 3 Chk_Cfg, SRD high, FCB 1: C0 (an identifier is cut off)");
}

rc::Gen<std::optional<uint8_t>> access_point() {
  return rc::gen::oneOf(rc::gen::just(std::optional<uint8_t>{}),
                        rc::gen::map(rc::gen::inRange(0, 64),
                                     [](int n) { return std::optional<uint8_t>(static_cast<uint8_t>(n)); }));
}
uint8_t octet(int from, int to) { return static_cast<uint8_t>(*rc::gen::inRange(from, to)); }
Octets some(size_t size) { return *rc::gen::container<std::vector<uint8_t>>(size, rc::gen::arbitrary<uint8_t>()); }

FdlFrame any_frame() {
  const int kind = *rc::gen::inRange(0, 8);
  if (kind == 0) return make_acknowledgement();
  if (kind == 1) return make_token(octet(0, 127), octet(0, 127));
  const uint8_t destination = octet(0, 128), source = octet(0, 127), code = octet(0, 256);
  if (kind == 2) return make_frame(destination, source, code);
  const auto dsap = *access_point(), ssap = *access_point();
  const size_t points = dsap.has_value() + ssap.has_value();
  if (kind == 3) return {Delimiter::SD3, destination, source, code, dsap, ssap, some(8 - points)};
  const auto size =
      static_cast<size_t>(*rc::gen::inRange(points == 0 ? 1 : 0, 247 - static_cast<int>(points)));
  return {Delimiter::SD2, destination, source, code, dsap, ssap, some(size)};
}

RC_GTEST_PROP(FdlFrameProperty, FieldsThroughOctets, ()) {
  const FdlFrame frame = any_frame();
  const Octets octets = encode(frame);
  const auto decoded = decode(octets);
  RC_ASSERT(decoded.has_value());
  RC_ASSERT(*decoded == frame);
  RC_ASSERT(!describe(frame).empty());
  // Each longer or shorter row of octets is none.
  Octets longer = octets;
  longer.push_back(octet(0, 256));
  RC_ASSERT(decode(longer).error() == FrameError::Size);
  RC_ASSERT(!decode(std::span(octets).first(octets.size() - 1)).has_value());
}

RC_GTEST_PROP(FdlFrameProperty, OctetsThroughFields, ()) {
  // Octets that are often nearly a frame.
  Octets octets = encode(any_frame());
  const int changes = *rc::gen::inRange(0, 4);
  for (int n = 0; n < changes; ++n)
    octets[static_cast<size_t>(*rc::gen::inRange(0, static_cast<int>(octets.size())))] = octet(0, 256);
  const auto frame = decode(octets);
  if (frame) RC_ASSERT(encode(*frame) == octets);
}

// The Hamming distance of the formats with a check octet is 4: one to three disturbed bits of the characters
// never make another valid frame (EN 50170, format class FT 1.2). A disturbed start or stop bit costs the
// character, a disturbed single bit its parity.
TEST(FdlFrame, EveryPairOfDisturbedBitsIsSeen) {
  const Octets good = sd2("88 81 5D 3D 3E 88 0D");
  const size_t bits = good.size() * 9;  // data and parity
  const auto valid_with = [&](std::initializer_list<size_t> flipped) {
    Octets octets = good;
    std::vector<int> odd(good.size());
    for (const size_t bit : flipped) {
      ++odd[bit / 9];
      if (bit % 9 < 8) octets[bit / 9] = static_cast<uint8_t>(octets[bit / 9] ^ 1U << bit % 9);
    }
    const bool parity = std::all_of(odd.begin(), odd.end(), [](int n) { return n % 2 == 0; });
    return parity && decode(octets).has_value();
  };
  for (size_t a = 0; a < bits; ++a) {
    EXPECT_FALSE(valid_with({a}));
    for (size_t b = a + 1; b < bits; ++b) {
      EXPECT_FALSE(valid_with({a, b})) << a << ' ' << b;
    }
  }
}

TEST(FdlFrame, WhatIsNoFrame) {
  const std::pair<std::string, FrameError> kBad[] = {
      {"11", FrameError::Start},
      {"68 03 03 68 81 88 08 11 16", FrameError::Length},
      {"68 FA FA 68", FrameError::Length},
      {"68 05 06 68 88 81 6D 3C 3E F0 16", FrameError::LengthTwice},
      {"68 05 05 69 88 81 6D 3C 3E F0 16", FrameError::SecondStart},
      {"68 05 05 68 88 81 6D 3C 3E F1 16", FrameError::Check},
      {"68 05 05 68 88 81 6D 3C 3E F0 17", FrameError::End},
      {"68 05 05 68 88 81 6D 3C 3E F0", FrameError::Size},
      {"10 03 02 49 4E 16 16", FrameError::Size},
      {"DC 02", FrameError::Size},
      {"DC FF 01", FrameError::Address},
      {"DC 02 7F", FrameError::Address},
      {"10 03 7F 49 CB 16", FrameError::Address},                 // broadcast does not send
      {"10 83 02 49 CE 16", FrameError::Address},                 // an access point without octet
      {"68 05 05 68 88 81 6D 40 3E F4 16", FrameError::Address},  // a segment address
      {"68 05 05 68 88 81 6D BC 3E 70 16", FrameError::Address},  // a second extension octet
  };
  for (const auto& [octets, error] : kBad) {
    const auto frame = decode(hex(octets));
    ASSERT_FALSE(frame.has_value()) << octets;
    EXPECT_EQ(frame.error(), error) << octets << ": " << frame_error_text(frame.error());
    EXPECT_FALSE(frame_error_text(error).empty());
  }
  EXPECT_EQ(decode({}).error(), FrameError::Size);
}

// The words of an error lead back to it: a log is read by them.
TEST(FdlFrame, ErrorsByTheirWords) {
  for (const FrameError error :
       {FrameError::Size, FrameError::Start, FrameError::Length, FrameError::LengthTwice,
        FrameError::SecondStart, FrameError::Check, FrameError::End, FrameError::Address, FrameError::Parity,
        FrameError::Framing, FrameError::Gap, FrameError::Idle})
    EXPECT_EQ(frame_error(frame_error_text(error)), error);
  EXPECT_EQ(frame_error("nothing of that kind"), std::nullopt);
  EXPECT_EQ(frame_error(""), std::nullopt);
}

TEST(FdlFrame, RolesAndFunctions) {
  EXPECT_TRUE(make_token(2, 1).needs_idle());
  EXPECT_TRUE(make_frame(8, 1, 0x6D, 60, 62).needs_idle());
  const FdlFrame ready = make_frame(1, 2, 0x20);
  EXPECT_FALSE(ready.needs_idle());
  EXPECT_TRUE(ready.answers(FdlAnswer::Ok));
  EXPECT_EQ(ready.station(), StationKind::MasterReady);
  const FdlFrame request = make_frame(8, 1, 0x5D, 60, 62);
  EXPECT_TRUE(request.asks(FdlRequest::SrdHigh) && request.frame_count_valid() && !request.frame_count());
  EXPECT_FALSE(request.is_answer());
  EXPECT_TRUE(make_acknowledgement().is_answer());
}

}  // namespace
}  // namespace ipos::tests

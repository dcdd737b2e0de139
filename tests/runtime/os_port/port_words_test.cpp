// Ports by themselves, without a device: errors in words, waiting bytes, pauses of telegrams, rates and names.
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <cerrno>
#include <cstring>

#include "runtime/os_port/can_error_frame.hpp"
#include "runtime/os_port/out_bytes.hpp"
#include "runtime/os_port/port_error.hpp"
#include "runtime/os_port/serial_bridge.hpp"
#include "runtime/os_port/serial_port.hpp"
#include "runtime/os_port/slcan_text.hpp"
#include "runtime/os_port/system_clock.hpp"

namespace ipos::tests {
namespace {

using namespace ipos::runtime;  // NOLINT: everything here is about the runtime

TEST(CanErrorFrames, ClassesInWords) {
  const std::pair<uint32_t, const char*> classes[] = {
      {CAN_ERR_TX_TIMEOUT, "transmit timeout"},
      {CAN_ERR_LOSTARB, "arbitration lost"},
      {CAN_ERR_CRTL, "controller"},
      {CAN_ERR_PROT, "protocol violation"},
      {CAN_ERR_TRX, "transceiver"},
      {CAN_ERR_ACK, "no acknowledge: no other station on the bus, or another bit rate"},
      {CAN_ERR_BUSOFF, "bus-off: the controller takes no part until it is restarted"},
      {CAN_ERR_BUSERROR, "bus error"},
      {CAN_ERR_RESTARTED, "the controller has been restarted"}};
  for (const auto& [bit, text] : classes) EXPECT_EQ(describe(CanErrorFrame{bit, {}}), text);
  EXPECT_EQ(describe(CanErrorFrame{CAN_ERR_TX_TIMEOUT | CAN_ERR_RESTARTED, {}}),
            "transmit timeout, the controller has been restarted");
  EXPECT_EQ(describe(CanErrorFrame{0, {}}), "error frame of unknown class 0h");
  EXPECT_EQ(describe(CanErrorFrame{0x1000, {}}), "error frame of unknown class 1000h");
}

// The bits of linux/can/error.h: of the controller in data[1], of the protocol in data[2].
TEST(CanErrorFrames, DetailsStandWithTheirClass) {
  const auto with = [](uint32_t classes, size_t byte, uint8_t bits) {
    CanErrorFrame error{classes, {}};
    error.data[byte] = bits;
    return describe(error);
  };
  const char* const controller[] = {
      "receive buffer overrun",      "transmit buffer overrun",         "receive errors: 96 or more",
      "transmit errors: 96 or more", "error passive by receive errors", "error passive by transmit errors",
      "error active again"};
  for (size_t n = 0; n < std::size(controller); ++n) {
    EXPECT_EQ(with(CAN_ERR_CRTL, 1, static_cast<uint8_t>(1 << n)),
              "controller (" + std::string(controller[n]) + ")");
    EXPECT_EQ(with(CAN_ERR_CRTL, 2, static_cast<uint8_t>(1 << n)), "controller");
    EXPECT_EQ(with(CAN_ERR_ACK, 1, static_cast<uint8_t>(1 << n)), describe(CanErrorFrame{CAN_ERR_ACK, {}}));
  }
  const std::pair<uint8_t, const char*> protocol[] = {{0x01, "bit"},
                                                      {0x02, "form"},
                                                      {0x04, "stuff"},
                                                      {0x08, "dominant bit not possible"},
                                                      {0x10, "recessive bit not possible"},
                                                      {0x20, "overload"},
                                                      {0x80, "while sending"}};
  for (const auto& [bit, text] : protocol)
    EXPECT_EQ(with(CAN_ERR_PROT, 2, bit), "protocol violation (" + std::string(text) + ")");
  EXPECT_EQ(with(CAN_ERR_PROT, 2, 0x81), "protocol violation (bit, while sending)");
}

TEST(PortErrors, OfTheSystem) {
  const std::pair<int, PortFault> rows[] = {
      {EACCES, PortFault::NoPermission}, {EPERM, PortFault::NoPermission}, {ENOENT, PortFault::NoSuchDevice},
      {EBUSY, PortFault::InUse},         {ENOTTY, PortFault::NotSerial},   {ENODEV, PortFault::Gone},
      {ENXIO, PortFault::Gone},          {EIO, PortFault::Gone},           {ENOMEM, PortFault::System}};
  for (const auto& [number, fault] : rows) {
    const PortError error = system_error(number, "p");
    EXPECT_EQ(error.fault, fault) << number;
    const bool says_more =
        fault == PortFault::NoPermission || fault == PortFault::Gone || fault == PortFault::System;
    EXPECT_EQ(error.text, port_error(fault, "p", says_more ? std::strerror(number) : "").text);
  }
  EXPECT_EQ(port_error(PortFault::Gone, "p").text, "p: the device has gone");
  EXPECT_EQ(port_error(PortFault::Gone, "p", "why").text, "p: the device has gone: why");
}

TEST(OutBytes, WaitAsWholeMessages) {
  OutBytes out(5);
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(out.push("abc"));
  EXPECT_FALSE(out.push("def")) << "six do not fit, and none of them is taken";
  EXPECT_TRUE(out.push("de"));
  EXPECT_EQ(out.waiting(), "abcde");
  EXPECT_FALSE(out.push("f"));
  std::string written;
  const auto write = [&written](size_t most) {
    return [&written, most, left = true](std::string_view bytes) mutable -> tl::expected<size_t, int> {
      if (!std::exchange(left, false)) return size_t{0};
      written += bytes.substr(0, most);
      return std::min(most, bytes.size());
    };
  };
  EXPECT_EQ(out.write_by(write(2)), 0);
  EXPECT_EQ(out.waiting(), "cde");
  EXPECT_FALSE(out.empty());
  EXPECT_TRUE(out.push("fg")) << "there is room again";
  EXPECT_FALSE(out.push("h"));
  EXPECT_EQ(out.waiting(), "cdefg");
  EXPECT_EQ(out.write_by([](std::string_view) -> tl::expected<size_t, int> { return tl::unexpected(EIO); }),
            EIO);
  EXPECT_EQ(out.waiting(), "cdefg") << "a failure loses nothing";
  EXPECT_EQ(out.write_by(write(9)), 0);
  EXPECT_EQ(written, "abcdefg");
  EXPECT_TRUE(out.empty());
  EXPECT_TRUE(out.push("12345"));
  out.clear();
  EXPECT_TRUE(out.empty());
  EXPECT_EQ(out.write_by(write(1)), 0);
}

// Of LAWICEL's manual: S0 10 kbit/s, S1 20, S2 50, S3 100, S4 125, S5 250, S6 500, S7 800, S8 1000.
TEST(SlcanRates, AreThoseOfTheProtocol) {
  const uint32_t rates[] = {10'000, 20'000, 50'000, 100'000, 125'000, 250'000, 500'000, 800'000, 1'000'000};
  for (size_t n = 0; n < std::size(rates); ++n) {
    EXPECT_EQ(slcan_rate_digit(rates[n]), static_cast<char>('0' + n));
    EXPECT_EQ(slcan_rate_digit(rates[n] + 1), std::nullopt);
  }
  EXPECT_EQ(slcan_rate_digit(0), std::nullopt);
  EXPECT_EQ(slcan_lines(""), 0U);
  EXPECT_EQ(slcan_lines("t1000\rz\rt"), 2U);
}

TEST(SlcanRates, StampsAreBelowAMinute) {
  EXPECT_EQ(parse_slcan("t1000EA5F").value().stamp, 59'999);
  EXPECT_FALSE(parse_slcan("t1000EA60"));
  EXPECT_FALSE(parse_slcan("t1000EA5"));
  EXPECT_FALSE(parse_slcan("t1000EA5F0"));
  EXPECT_FALSE(parse_slcan("t7FF9"));
  EXPECT_FALSE(parse_slcan("t8000"));
  EXPECT_TRUE(parse_slcan("T1FFFFFFF0"));
  EXPECT_FALSE(parse_slcan("T200000000"));
  EXPECT_TRUE(parse_slcan("r1238"));
  for (const char* wrong :
       {"t10g0", "t10@0", "t10`0", "t10/0", "t10:0", "t10G0", "t1001F", "t1001", "t100", "x1000", ""})
    EXPECT_FALSE(parse_slcan(wrong)) << wrong;
}

// The name of a device, and how late it is, up to a second: of what is no terminal the name has been understood.
TEST(SerialNames, HaveALatency) {
  SystemClock clock;
  const auto fault = [&](const std::string& name, uint32_t baud = 9'600, bool movilink = true) {
    const SerialPortResult port = open_serial_port(name, {baud, true, movilink}, clock);
    return port ? PortFault::System : port.error().fault;
  };
  for (const char* name : {"/dev/null", "/dev/null@0ms", "/dev/null@16ms", "/dev/null@1000ms"})
    EXPECT_EQ(fault(name), PortFault::NotSerial) << name;
  for (const char* name : {"/dev/null@1001ms", "/dev/null@ms", "/dev/null@16", "/dev/null@16s",
                           "/dev/null@-1ms", "/dev/null@x16ms", "/dev/null@"})
    EXPECT_EQ(fault(name), PortFault::BadName) << name;
  for (const uint32_t baud : {9'600U, 57'600U}) EXPECT_EQ(fault("/dev/null", baud), PortFault::NotSerial);
  for (const uint32_t baud : {9'599U, 19'200U, 500'000U}) {
    const auto text = [&](bool movilink) {
      return open_serial_port("/dev/null", {baud, true, movilink}, clock).error().text;
    };
    EXPECT_NE(text(true).find("MOVILINK has 9600 and 57600 bit/s"), std::string::npos);
    EXPECT_EQ(text(false).find("MOVILINK"), std::string::npos) << "other lines have other rates";
  }
}

// Characters within a telegram follow each other; behind a gap, or what the format of the telegram has, a new one begins,
// which the adapter may have held back for its latency.
TEST(ArrivalPaces, OfTelegrams) {
  constexpr Time kCharacter = 1'145'833, kLatency = 16 * kMillisecond;
  const auto begins = [&](const std::vector<std::pair<Time, uint8_t>>& bytes) {
    ArrivalPace pace(kLatency, kCharacter);
    std::vector<bool> new_ones;
    for (const auto& [at, value] : bytes) new_ones.push_back(pace.begin({at, value, false}) == at + kLatency);
    return new_ones;
  };
  using Begins = std::vector<bool>;
  const Time most = kCharacter + kCharacterGap + kLatency;
  EXPECT_EQ(begins({{0, 2}, {most, 1}, {2 * most, 5}}), (Begins{true, false, false}));
  EXPECT_EQ(begins({{0, 2}, {most + 1, 1}}), (Begins{true, true}));
  // A code that is none: the telegram ends with it.
  EXPECT_EQ(begins({{0, 2}, {1, 1}, {2, 0x7F}, {3, 2}}), (Begins{true, false, false, true}));
}

TEST(SystemClocks, GoOn) {
  SystemClock clock;
  const Time begin = clock.now();
  EXPECT_GT(begin, 0);
  clock.wait(begin - 1, {});
  clock.wait(begin + 3 * kMillisecond, {});
  EXPECT_GE(clock.now(), begin + 3 * kMillisecond);
  const Time before = clock.now();
  const PortNeeds soon{-1, false, before + kMillisecond};
  clock.wait(before + 60 * kSecond, std::span(&soon, 1));
  EXPECT_GE(clock.now(), before + kMillisecond);
  EXPECT_LT(clock.now(), before + 30 * kSecond) << "a port wanted to be woken";
  // Since 1970, in nanoseconds: later than 2020 and before 2200.
  EXPECT_GT(clock.wall(), Time{1'577'836'800} * kSecond);
  EXPECT_LT(clock.wall(), Time{7'258'118'400} * kSecond);
}

}  // namespace
}  // namespace ipos::tests

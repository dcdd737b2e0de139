// Adapters that their maker's library drives, over stand-ins for the libraries (stand_in/): frames both ways, what the
// controller tells, full queues, bus-off, adapters that are pulled out, and the errors of opening.
#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <cstdlib>
#include <map>

#include "runtime/os_port/adapter_port.hpp"
#include "runtime/os_port/returning_port.hpp"
#include "tests/runtime/os_port/port_rig.hpp"
#include "tests/runtime/os_port/stand_in/shared_bus.hpp"
#include "tests/tools/command.hpp"

namespace ipos::tests {
namespace {

using AdapterNotes = std::vector<std::string>;

struct Adapter {
  const char* library;
  uint32_t first;                     // bit of the first channel
  std::array<const char*, 3> names;   // of the first three
  // Error frames in words: bit, form, stuff, other, no acknowledge.
  std::array<const char*, 5> errors;
  bool tells_passive = true;
};
constexpr const char* kNoAck = "no acknowledge: no other station on the bus, or another bit rate";
const Adapter kAdapters[] = {
    {"libpcanbasic.so", kPcanChannels, {"pcan:USB1", "pcan:USB2", "pcan:usb3"},
     {"protocol violation (bit)", "protocol violation (form)", "protocol violation (stuff)", "bus error", kNoAck}},
    {"libvxlapi64.so", kVectorChannels, {"vector:0", "vector:1", "vector:2"},
     {"bus error", "bus error", "bus error", "bus error", "bus error"}},
    {"libcanlib.so", kKvaserChannels, {"kvaser:0", "kvaser:1", "kvaser:2"},
     {"protocol violation (dominant bit not possible)", "protocol violation (form)", "protocol violation (stuff)", "bus error",
      "bus error"}},
    {"libvcinpl.so", kIxxatChannels, {"ixxat:HW0", "ixxat:0.1", "ixxat:HW1.0"},
     {"protocol violation (bit)", "protocol violation (form)", "protocol violation (stuff)", "bus error", kNoAck}, false}};

std::string stand_in(const Adapter& adapter) { return std::string(IPOS_STAND_INS "/") + adapter.library; }

// One file for the whole test program, as a library maps it once.
SharedBusFile& bus_file() {
  static const TemporaryFolder folder;
  static SharedBusFile* const bus = [] {
    const std::string path = (folder.path() / "bus").string();
    setenv("IPOS_STAND_IN_BUS", path.c_str(), 1);
    setenv("LD_LIBRARY_PATH", IPOS_STAND_INS, 1);  // of `ipos` run by a test
    return map_bus(path.c_str());
  }();
  return *bus;
}

class AdapterPorts : public ::testing::TestWithParam<size_t> {
 protected:
  AdapterPorts() : bus_(bus_file()) { std::memset(static_cast<void*>(&bus_.switches), 0, sizeof bus_.switches); }
  ~AdapterPorts() override { std::memset(static_cast<void*>(&bus_.switches), 0, sizeof bus_.switches); }

  static const Adapter& adapter() { return kAdapters[GetParam()]; }
  CanPortResult try_open(const std::string& name, uint32_t baud = 500'000) {
    return open_adapter_port(name, baud, clock_, stand_in(adapter()));
  }
  std::unique_ptr<CanPort> open(size_t channel = 0, uint32_t baud = 500'000) {
    CanPortResult opened = try_open(adapter().names[channel], baud);
    EXPECT_TRUE(opened) << opened.error().text;
    return opened ? std::move(*opened) : nullptr;
  }
  uint32_t bit(size_t channel = 0) const {
    return 1U << (adapter().first + channel);
  }
  // All that is there.
  std::vector<CanArrival> take(CanPort& port) {
    std::vector<CanArrival> all;
    for (;;) {
      const auto got = port.receive();
      EXPECT_TRUE(got) << got.error().text;
      if (!got || !*got) return all;
      all.push_back(**got);
    }
  }
  // In words, after enough looks at the controller.
  std::string told(CanPort& port) {
    std::string words;
    for (int looks = 0; looks < 3; ++looks) {
      for (const CanArrival& arrival : take(port)) words += arrival.error ? describe(*arrival.error) + ";" : "frame;";
      clock_.advance(20 * kMillisecond);
      EXPECT_TRUE(port.flush());
    }
    return words;
  }

  SharedBusFile& bus_;
  ManualClock clock_;
};

std::string maker(size_t number) {
  const std::string name = kAdapters[number].names[0];
  return name.substr(0, name.find(':'));
}
INSTANTIATE_TEST_SUITE_P(, AdapterPorts, ::testing::Range(size_t{0}, std::size(kAdapters)),
                         [](const auto& row) { return maker(row.param); });

const Frame kKinds[] = {{0x000, 0}, {0x7FF, 8, {1, 2, 3, 4, 5, 6, 7, 8}}, {0x123, 3, {0xFF, 0, 0x80}}, {0x7F, 5, {}, false, true},
                        {0, 1, {9}, true}, {0x1FFFFFFF, 8, {8, 7, 6, 5, 4, 3, 2, 1}, true}, {0x800, 0, {}, true, true}};

TEST_P(AdapterPorts, FramesOfAllKindsGoBothWays) {
  const auto one = open(0), two = open(1), three = open(2);
  ASSERT_TRUE(one && two && three);
  EXPECT_EQ(one->name(), adapter().names[0]);
  EXPECT_EQ(one->take_notes(), AdapterNotes{});
  for (const Frame& sent : kKinds) {
    one->send(sent);
    for (CanPort* other : {two.get(), three.get()}) {
      const auto got = take(*other);
      ASSERT_EQ(got.size(), 1U);
      EXPECT_EQ(got[0].frame, sent) << sent.id;
      EXPECT_FALSE(got[0].error);
      EXPECT_EQ(got[0].at, clock_.now());
    }
    EXPECT_TRUE(take(*one).empty()) << "what it has sent does not come back";
  }
  EXPECT_EQ(one->counts().sent, std::size(kKinds));
  EXPECT_EQ(two->counts().received, std::size(kKinds));
  two->send(kKinds[1]);
  EXPECT_EQ(take(*one).size(), 1U);
}

// Adapters of all makers on one bus.
TEST_P(AdapterPorts, OneMakersFramesComeToTheOthers) {
  const auto sender = open(0);
  std::vector<std::unique_ptr<CanPort>> others;
  for (const Adapter& other : kAdapters) {
    auto opened = open_adapter_port(other.names[1], 500'000, clock_, stand_in(other));
    ASSERT_TRUE(opened) << opened.error().text;
    others.push_back(std::move(*opened));
  }
  for (const Frame& sent : kKinds) sender->send(sent);
  for (const auto& other : others) {
    const auto got = take(*other);
    ASSERT_EQ(got.size(), std::size(kKinds)) << other->name();
    for (size_t n = 0; n < got.size(); ++n) EXPECT_EQ(got[n].frame, kKinds[n]) << other->name();
  }
}

// The stamp is the adapter's own: here microseconds, of all of them, also when a counter of 32 bits has begun again.
TEST_P(AdapterPorts, StampsAreTheAdapters) {
  const auto port = open();
  const uint64_t times[] = {1'234'567, 4'294'967'295, 4'294'967'296 + 5, 2 * 4'294'967'296 + 3};
  for (const uint64_t time : times) put(bus_, BusSlot::kData, kTester, 500'000, 1, 0, false, false, nullptr, time);
  const auto got = take(*port);
  ASSERT_EQ(got.size(), std::size(times));
  for (size_t n = 0; n < got.size(); ++n) {
    ASSERT_TRUE(got[n].device_time);
    EXPECT_EQ(*got[n].device_time, static_cast<Time>(times[n]) * kMicrosecond);
  }
}

TEST_P(AdapterPorts, ErrorFramesInWords) {
  const auto port = open();
  const uint32_t kinds[] = {1, 2, 4, 8, 16};
  for (size_t n = 0; n < std::size(kinds); ++n) {
    put(bus_, BusSlot::kError, kTester, 0, kinds[n], 0, false, false, nullptr, 1);
    const auto got = take(*port);
    ASSERT_EQ(got.size(), 1U);
    ASSERT_TRUE(got[0].error);
    EXPECT_EQ(describe(*got[0].error), adapter().errors[n]);
  }
  EXPECT_EQ(port->counts().received, 0U);
}

TEST_P(AdapterPorts, AnotherRateIsHeardAsErrors) {
  const auto port = open(0, 250'000), other = open(1, 500'000);
  other->send(frame(0x100));
  const auto got = take(*port);
  ASSERT_EQ(got.size(), 1U);
  EXPECT_TRUE(got[0].error);
}

TEST_P(AdapterPorts, EveryRateOfThePlantFileIsThere) {
  for (const uint32_t baud : {100'000U, 125'000U, 250'000U, 500'000U, 1'000'000U}) {
    const auto one = open(0, baud), two = open(1, baud);
    ASSERT_TRUE(one && two);
    one->send(frame(0x123, 7));
    put(bus_, BusSlot::kData, kTester, baud, 0x124, 0, false, false, nullptr, 1);
    const auto got = take(*two);
    ASSERT_EQ(got.size(), 2U);
    EXPECT_EQ(got[0].frame, frame(0x123, 7));
    EXPECT_EQ(got[1].frame.id, 0x124U) << "it is this rate on the wire";
  }
  EXPECT_EQ(try_open(adapter().names[0], 12'345).error().text,
            std::string(adapter().names[0]) + ": the device does not take this baud rate: 12345 bit/s");
}

TEST_P(AdapterPorts, TheStateOfTheControllerIsToldWhenItChanges) {
  const auto port = open();
  EXPECT_EQ(told(*port), "");
  bus_.switches.warning = bit();
  EXPECT_EQ(told(*port), "controller (receive errors: 96 or more, transmit errors: 96 or more);");
  EXPECT_EQ(told(*port), "") << "once";
  bus_.switches.passive = bit();
  const std::string passive = "controller (error passive by receive errors, error passive by transmit errors);";
  EXPECT_EQ(told(*port), adapter().tells_passive ? passive : "");
  bus_.switches.warning = bus_.switches.passive = 0;
  EXPECT_EQ(told(*port), "controller (error active again);");
}

TEST_P(AdapterPorts, BusOffEndsByARestart) {
  const auto port = open(0), other = open(1);
  bus_.switches.off = bit();
  std::string words;
  const Time begin = clock_.now();
  for (int looks = 0; looks < 4 && words.empty(); ++looks) {
    for (const CanArrival& arrival : take(*port)) words += describe(arrival.error.value());
    if (words.empty()) clock_.advance(20 * kMillisecond);
  }
  EXPECT_EQ(words, "bus-off: the controller takes no part until it is restarted");
  const Time off = clock_.now();
  EXPECT_LE(off - begin, 60 * kMillisecond);
  EXPECT_EQ(port->absence(), "the controller is bus-off");
  port->send(frame(0x100, 1));
  port->send(frame(0x101, 2));
  EXPECT_EQ(port->waiting(), 2U);
  clock_.advance(off + 100 * kMillisecond - clock_.now() - 1);
  ASSERT_TRUE(port->flush());
  EXPECT_TRUE(take(*other).empty());
  EXPECT_NE(bus_.switches.off & bit(), 0U);
  clock_.advance(1);
  ASSERT_TRUE(port->flush());
  EXPECT_EQ(bus_.switches.off & bit(), 0U) << "its library has been asked";
  EXPECT_EQ(port->absence(), "");
  EXPECT_EQ(told(*port), "the controller has been restarted;");
  const auto got = take(*other);
  ASSERT_EQ(got.size(), 2U);
  EXPECT_EQ(got[0].frame.id, 0x100U);
  EXPECT_EQ(got[1].frame.id, 0x101U);
  EXPECT_EQ(port->counts().lost_out, 0U);
}

TEST_P(AdapterPorts, FramesWaitForAFullQueue) {
  const auto port = open(0), other = open(1);
  bus_.switches.full = bit();
  for (size_t n = 0; n < kCanPortQueue + 2; ++n) port->send(frame(0x100, static_cast<uint8_t>(n)));
  EXPECT_EQ(port->waiting(), kCanPortQueue);
  EXPECT_EQ(port->counts().sent, 0U);
  EXPECT_EQ(port->counts().lost_out, 2U);
  EXPECT_EQ(port->counts().waited, 1U) << "it is asked once a millisecond";
  EXPECT_EQ(port->take_notes(),
            AdapterNotes{"frames are lost: 1024 wait to be sent and the adapter takes none; is there another station on the bus, "
                         "and the same bit rate?"});
  bus_.switches.full = 0;
  ASSERT_TRUE(port->flush());
  EXPECT_EQ(port->waiting(), kCanPortQueue);
  clock_.advance(kMillisecond);
  ASSERT_TRUE(port->flush());
  EXPECT_EQ(port->waiting(), 0U);
  EXPECT_EQ(port->counts().sent, kCanPortQueue);
  size_t got = 0;
  for (int turns = 0; turns < 8; ++turns)
    for (const CanArrival& arrival : take(*other)) EXPECT_EQ(arrival.frame.data[0], static_cast<uint8_t>(got++));
  EXPECT_EQ(got, kCanPortQueue);
}

TEST_P(AdapterPorts, ARefusedFrameIsLostAlone) {
  const auto port = open(0), other = open(1);
  bus_.switches.bad_frame = bit();
  port->send(frame(0x100));
  bus_.switches.bad_frame = 0;
  port->send(frame(0x101));
  EXPECT_EQ(port->counts().lost_out, 1U);
  EXPECT_EQ(take(*other).size(), 1U);
  const AdapterNotes notes = port->take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with("a frame is lost: the adapter refuses it: ")) << notes[0];
}

TEST_P(AdapterPorts, AnOverrunIsCounted) {
  const auto port = open(0);
  take(*port);
  clock_.advance(20 * kMillisecond);
  bus_.switches.lost = bit();
  put(bus_, BusSlot::kData, kTester, 500'000, 0x100, 0, false, false, nullptr, 1);
  EXPECT_NE(told(*port).find("controller (receive buffer overrun);"), std::string::npos);
  EXPECT_EQ(port->counts().lost_in, 1U);
  EXPECT_EQ(port->counts().received, 1U);
}

// The work between two "nothing" is bounded, and the loop comes again at once.
TEST_P(AdapterPorts, AFloodLetsTheOthersHaveTheirTurn) {
  const auto port = open();
  EXPECT_EQ(port->needs().wake, clock_.now() + kMillisecond);
  for (int n = 0; n < 300; ++n) put(bus_, BusSlot::kData, kTester, 500'000, 0x100, 0, false, false, nullptr, 1);
  EXPECT_EQ(take(*port).size(), 256U);
  EXPECT_EQ(port->needs().wake, clock_.now());
  EXPECT_EQ(take(*port).size(), 44U);
  EXPECT_EQ(port->needs().wake, clock_.now() + kMillisecond);
}

TEST_P(AdapterPorts, AnAdapterThatIsPulledOutIsAnError) {
  const auto port = open();
  bus_.switches.gone = bit();
  const auto got = port->receive();
  ASSERT_FALSE(got);
  EXPECT_EQ(got.error().fault, PortFault::Gone);
  EXPECT_TRUE(got.error().text.starts_with(std::string(adapter().names[0]) + ": the device has gone: ")) << got.error().text;
  port->send(frame(1));
  const auto flushed = port->flush();
  ASSERT_FALSE(flushed);
  EXPECT_EQ(flushed.error().fault, PortFault::Gone);
}

TEST_P(AdapterPorts, AnAdapterComesBack) {
  const auto returning = open_returning([this] { return try_open(adapter().names[0]); }, clock_);
  ASSERT_TRUE(returning);
  CanPort& port = **returning;
  bus_.switches.gone = bit();
  ASSERT_TRUE(port.receive());
  EXPECT_TRUE(port.absence().starts_with("the device has gone")) << port.absence();
  clock_.advance(kReopenPause);
  ASSERT_TRUE(port.flush());
  EXPECT_NE(port.absence(), "");
  bus_.switches.gone = 0;
  clock_.advance(kReopenPause);
  ASSERT_TRUE(port.flush());
  EXPECT_EQ(port.absence(), "");
  const auto other = open(1);
  port.send(frame(0x77));
  EXPECT_EQ(take(*other).size(), 1U);
}

TEST_P(AdapterPorts, OnePortMoreThanOnce) {
  for (int times = 0; times < 3; ++times) ASSERT_TRUE(open());
}

TEST_P(AdapterPorts, WhatAChannelIsNotIsSaid) {
  const std::string prefix = maker(GetParam()) + ":";
  for (const char* channel : {"", "x", "-1", "0x", "USB", "USB0", "USB17", "TTY1", "0.x", "99999999999"}) {
    const auto opened = try_open(prefix + channel);
    ASSERT_FALSE(opened) << channel;
    EXPECT_EQ(opened.error().fault, PortFault::BadName) << opened.error().text;
    EXPECT_NE(opened.error().text.find("write " + prefix), std::string::npos) << opened.error().text;
  }
  const std::map<std::string, std::pair<std::string, std::string>> far = {
      {"pcan:", {"USB5", "there is USB1, USB2, USB3, USB4"}},
      {"vector:", {"4", "there is 0 (Stand-in VN1610 Channel 1), 1 (Stand-in VN1610 Channel 2), 2 (Stand-in VN1610 Channel 3), 3 "
                        "(Stand-in VN1610 Channel 4)"}},
      {"kvaser:", {"9", "there is 0 (Stand-in Leaf), 1 (Stand-in Leaf), 2 (Stand-in Leaf), 3 (Stand-in Leaf)"}},
      {"ixxat:", {"2", "there is 0 (Stand-in USB-to-CAN, HW0), 1 (Stand-in USB-to-CAN, HW1)"}}};
  const auto& [channel, there] = far.at(prefix);
  EXPECT_EQ(try_open(prefix + channel).error().text, prefix + channel + ": there is no such channel: " + there);
  if (prefix == "ixxat:") {
    EXPECT_TRUE(try_open("ixxat:0"));
    EXPECT_EQ(try_open("ixxat:HW1.2").error().text, "ixxat:HW1.2: there is no such channel: HW1 has no CAN line 2");
    EXPECT_EQ(try_open("ixxat:HW7").error().fault, PortFault::NoSuchChannel);
  }
  bus_.switches.gone = 0xFU << adapter().first;
  EXPECT_EQ(try_open(adapter().names[0]).error().text,
            std::string(adapter().names[0]) + ": there is no such channel: no adapter is plugged in");
}

// PCAN-Basic and CANlib refuse it; Vector and VCI share it, if the other program has set the same rate.
TEST_P(AdapterPorts, AnotherProgramHasIt) {
  bus_.switches.in_use = bit();
  const std::string name = adapter().names[0];
  const PortError error = try_open(name).error();
  if (name.starts_with("pcan") || name.starts_with("kvaser")) {
    EXPECT_EQ(error.text, name + ": is in use by another program");
    return;
  }
  EXPECT_EQ(error.fault, PortFault::WrongBitRate) << error.text;
  const auto shared = open(0, 125'000), other = open(1, 125'000);
  ASSERT_TRUE(shared && other);
  shared->send(frame(0x100));
  EXPECT_EQ(take(*other).size(), 1U);
}

TEST_P(AdapterPorts, ALibraryThatIsNotHereOrTooOld) {
  const std::string name = adapter().names[0];
  const PortError missing = open_adapter_port(name, 500'000, clock_, "libnothere.so").error();
  EXPECT_TRUE(missing.text.starts_with(name + ": the library of the adapter's maker is not here: libnothere.so: ")) << missing.text;
  EXPECT_NE(missing.text.find("; it comes with "), std::string::npos) << missing.text;
  const Adapter& other = kAdapters[(GetParam() + 1) % std::size(kAdapters)];
  const PortError old = open_adapter_port(name, 500'000, clock_, stand_in(other)).error();
  EXPECT_EQ(old.fault, PortFault::OldLibrary);
  EXPECT_TRUE(old.text.starts_with(name + ": the library of the adapter's maker lacks a function, a newer one has it: ")) << old.text;
}

// By the names of a plant file. Two of the makers have a library for Linux.
TEST(AdapterNames, GoToTheLibraries) {
  ManualClock clock;
  for (const char* name : {"pcan:USB1", "kvaser:0"}) {
    EXPECT_TRUE(is_adapter_port(name));
    EXPECT_EQ(open_can_port(name, 500'000, clock).error().fault, PortFault::NoLibrary) << "none is installed here";
  }
  EXPECT_EQ(open_can_port("vector:0", 500'000, clock).error().text,
            "vector:0: the library of the adapter's maker exists for Windows only: the XL Driver Library by Vector");
  EXPECT_EQ(open_can_port("ixxat:0", 500'000, clock).error().fault, PortFault::WindowsOnly);
  for (const char* name : {"can0", "pcan", "slcan:pcan:USB1", ""}) EXPECT_FALSE(is_adapter_port(name)) << name;
}

// The program itself, with two stations at one adapter and a master at another one.
TEST(AdapterRun, StationsAnswerAMasterAtAnotherAdapter) {
  SharedBusFile& bus = bus_file();
  std::memset(static_cast<void*>(&bus.switches), 0, sizeof bus.switches);
  const TemporaryFolder folder;
  for (const char* program : {"SCOM1.IPC", "SCOM2.IPC"}) folder.write(program, read_text(project("examples/scom") / program));
  std::string plant = read_text(project("examples/scom/scom.toml"));
  const std::string kind = "kind = \"can\"";
  plant.replace(plant.find(kind), kind.size(), kind + "\nport = \"pcan:USB1\"");
  RunningIpos run({"run", folder.write("scom.toml", plant), "--realtime", "--for", "1000s"});
  ASSERT_TRUE(run.tells("is joined to pcan:USB1"));
  for (const auto& [port, address] : {std::pair("kvaser:1", "0"), std::pair("pcan:USB2", "1")}) {
    const CommandResult got = run_ipos({"param", "get", "--port", port, "--address", address, "P130"});
    EXPECT_EQ(got.exit_code, 0) << got.err;
    EXPECT_NE(got.out.find("P130"), std::string::npos) << got.out << got.err;
  }
  bus.switches.gone = 1U;
  const CommandResult ended = run.wait();
  EXPECT_EQ(ended.exit_code, 74);
  EXPECT_NE(ended.err.find("pcan:USB1: the device has gone"), std::string::npos) << ended.err;
  EXPECT_NE(ended.err.find("pcan:USB1: "), std::string::npos);
  bus.switches.gone = 0;
}

}  // namespace
}  // namespace ipos::tests

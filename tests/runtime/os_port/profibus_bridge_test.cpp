// The bridge between a simulated PROFIBUS line and a serial port: a master outside and the slave of a card here, frame by
// frame. The octets are those of docs/reference/protocols/profibus.md.
#include "runtime/os_port/profibus_bridge.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/profibus/slave_station.hpp"
#include "tests/runtime/os_port/bytes_in_memory.hpp"
#include "tests/runtime/os_port/port_rig.hpp"

namespace ipos::tests {
namespace {

using Octets = std::vector<uint8_t>;

Octets octets(const std::string& text) {
  Octets out;
  for (size_t at = 0; at + 1 < text.size(); at += 3)
    out.push_back(static_cast<uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16)));
  return out;
}

// A unit whose inputs are its outputs.
struct Mirror final : profibus::SlaveUnit {
  void configured(Time, const profibus::Configuration&) override {}
  void take_outputs(Time, std::span<const uint8_t> outputs) override {
    taken.assign(outputs.begin(), outputs.end());
  }
  void read_inputs(Time, std::span<uint8_t> inputs) override {
    std::copy_n(taken.begin(), std::min(taken.size(), inputs.size()), inputs.begin());
  }
  void watchdog_set(Time, std::optional<Time>) override {}
  void watchdog_expired(Time) override {}
  void exchange_ended(Time) override {}
  Octets taken;
};

struct DpRig {
  DpRig() {
    bridge.emplace(queue, 9, line, port);
    // To nobody: the slave finds the rate, the second from above, from what it hears for more than 100 ms.
    for (int n = 0; n < 10; ++n) ask("10 7D 01 49 C7 16");
  }
  // What comes back within 20 ms; the octets of a frame arrive together, as a host reads them.
  Octets ask(const Octets& frame) {
    port.sent.clear();
    for (const uint8_t octet : frame) port.incoming.push_back({clock.now(), octet, false});
    for (int step = 0; step < 80; ++step) {
      clock.advance(kMillisecond / 4);
      EXPECT_TRUE(bridge->collect(0));
      queue.run_until(clock.now());
    }
    return port.sent.empty() ? Octets{} : port.sent.front().bytes;
  }
  Octets ask(const std::string& frame) { return ask(octets(frame)); }

  ManualClock clock{0};
  EventQueue queue;
  profibus::Line line{queue, 0, "dp", 500'000};
  Mirror unit;
  profibus::SlaveStation slave{queue, 1,   line, "inv", profibus::option_type(profibus::OptionKind::Ffp31),
                               {8},   unit};
  BytesInMemory port{clock};
  std::optional<ProfibusBridge> bridge;
};

TEST(ProfibusBridge, AMasterOutsideStartsTheSlave) {
  DpRig rig;
  EXPECT_EQ(rig.ask("68 05 05 68 88 81 6D 3C 3E F0 16"),
            octets("68 0B 0B 68 81 88 08 3E 3C 02 05 00 FF 31 00 C2 16"));
  EXPECT_EQ(rig.ask("68 0C 0C 68 88 81 5D 3D 3E B8 14 01 0B 31 00 00 EA 16"), octets("E5"));
  EXPECT_EQ(rig.ask("68 06 06 68 88 81 7D 3E 3E F2 F4 16"), octets("E5"));
  EXPECT_EQ(rig.ask("68 05 05 68 88 81 5D 3C 3E E0 16"),
            octets("68 0B 0B 68 81 88 08 3E 3C 00 0C 00 01 31 00 C9 16"));
  EXPECT_EQ(rig.ask("68 09 09 68 08 01 7D 00 06 05 DC 00 00 6D 16"),
            octets("68 09 09 68 01 08 08 00 06 05 DC 00 00 F8 16"));
  EXPECT_EQ(rig.unit.taken, octets("00 06 05 DC 00 00"));
}

// Whatever bit is wrong: silence, and the next frame is heard.
TEST(ProfibusBridge, DamagedFramesAreDropped) {
  DpRig rig;
  const Octets request = octets("68 05 05 68 88 81 6D 3C 3E F0 16");
  for (size_t bit = 0; bit < 8 * request.size(); ++bit) {
    Octets damaged = request;
    damaged[bit / 8] = static_cast<uint8_t>(damaged[bit / 8] ^ 1 << bit % 8);
    EXPECT_TRUE(rig.ask(damaged).empty()) << bit;
    EXPECT_FALSE(rig.ask(request).empty()) << bit;
  }
  EXPECT_TRUE(rig.unit.taken.empty());
}

// A host that comes late with a frame must not put it into the past: the watchdog of 200 ms counts from when it came.
TEST(ProfibusBridge, TheWatchdogCountsFromWhenAFrameHasCome) {
  DpRig rig;
  rig.ask("68 05 05 68 88 81 6D 3C 3E F0 16");
  rig.ask("68 0C 0C 68 88 81 5D 3D 3E B8 14 01 0B 31 00 00 EA 16");
  rig.ask("68 06 06 68 88 81 7D 3E 3E F2 F4 16");
  rig.clock.advance(150 * kMillisecond);  // not executed meanwhile
  EXPECT_FALSE(rig.ask("68 05 05 68 88 81 5D 3C 3E E0 16").empty());
  rig.clock.advance(150 * kMillisecond);
  rig.queue.run_until(rig.clock.now());
  EXPECT_EQ(rig.slave.slave().state(), profibus::SlaveState::DataExchange);
  rig.clock.advance(50 * kMillisecond);
  rig.queue.run_until(rig.clock.now());
  EXPECT_EQ(rig.slave.slave().state(), profibus::SlaveState::WaitPrm);
}

// A repetition that has overtaken its answer: each request waits for the answer to the one before.
TEST(ProfibusBridge, RequestsInOneGoAreAnsweredOneAfterTheOther) {
  DpRig rig;
  const Octets request = octets("68 05 05 68 88 81 6D 3C 3E F0 16");
  Octets twice = request;
  twice.insert(twice.end(), request.begin(), request.end());
  EXPECT_FALSE(rig.ask(twice).empty());
  EXPECT_EQ(rig.port.sent.size(), 2U);
}

TEST(ProfibusBridge, AParityErrorVoidsTheFrame) {
  DpRig rig;
  const Octets request = octets("68 05 05 68 88 81 6D 3C 3E F0 16");
  for (const uint8_t octet : request) rig.port.incoming.push_back({rig.clock.now(), octet, octet == 0x6D});
  EXPECT_TRUE(rig.ask(Octets{}).empty());
  const auto notes = rig.bridge->take_notes();
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes.front().find("parity error"), std::string::npos) << notes.front();
}

// As many frames as there is room for; the rest waits at the port, and is not asked for.
TEST(ProfibusBridge, TakesAsManyFramesAsItHasRoomFor) {
  DpRig rig;
  const Octets token = octets("DC 01 01");
  for (int n = 0; n < 66; ++n)
    for (const uint8_t octet : token) rig.port.incoming.push_back({rig.clock.now(), octet, false});
  for (int n = 0; n < 3; ++n) ASSERT_TRUE(rig.bridge->collect(0));
  EXPECT_EQ(rig.bridge->waiting(), 64U + 2U) << "a reading takes 256 octets at once";
  EXPECT_EQ(rig.bridge->take_notes(),
            std::vector<std::string>{
                "serial: frames wait for the simulated line: they come faster than its 500000 baud"});
  rig.port.incoming.push_back({rig.clock.now(), 0xE5, false});
  ASSERT_TRUE(rig.bridge->collect(0));
  EXPECT_EQ(rig.port.incoming.size(), 1U) << "there is no room";
  EXPECT_EQ(rig.bridge->needs().descriptor, -1);
  rig.ask(Octets{});
  EXPECT_TRUE(rig.port.incoming.empty());
  EXPECT_EQ(rig.bridge->waiting(), 0U);
}

// What is disturbed on the simulated line is void outside, too: a port cannot send a character with an error.
TEST(ProfibusBridge, DisturbedFramesAreNotPassedOn) {
  for (const bool disturbed : {false, true}) {
    DpRig rig;
    OctetFault fault;
    fault.kind = OctetFaultKind::Parity;
    fault.sender = rig.slave.node();
    fault.from = rig.queue.now();
    if (disturbed) rig.line.add_fault(fault);
    EXPECT_EQ(rig.ask("68 05 05 68 88 81 6D 3C 3E F0 16").empty(), disturbed);
    const auto notes = rig.bridge->take_notes();
    EXPECT_EQ(notes, disturbed
                         ? std::vector<std::string>{"serial: disturbed frames of the simulated line are not "
                                                    "passed on"}
                         : std::vector<std::string>{});
  }
}

// What came is no frame: told once a kind, with the reason, and counted.
TEST(ProfibusBridge, WhatIsNoFrameIsTold) {
  DpRig rig;
  rig.bridge->take_notes();
  for (int n = 0; n < 2; ++n) EXPECT_TRUE(rig.ask("10 7D 01 49 C8 16").empty());
  const auto notes = rig.bridge->take_notes();
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(notes[0].starts_with("serial: what came is no frame: ")) << notes[0];
  EXPECT_EQ(rig.bridge->repeats(), std::vector<std::string>{notes[0] + ": 2 times"});
}

// Frames for a line that the bridge is not connected to are counted, and none of them stays.
TEST(ProfibusBridge, WhatTheLineDoesNotTakeIsCounted) {
  DpRig rig;
  const auto bridge = static_cast<NodeId>(rig.slave.node() + 1);
  rig.line.set_connected(bridge, false);
  for (int n = 0; n < 3; ++n) EXPECT_TRUE(rig.ask("68 05 05 68 88 81 6D 3C 3E F0 16").empty());
  EXPECT_EQ(std::as_const(*rig.bridge).counts().undelivered, 3U);
  EXPECT_EQ(rig.bridge->waiting(), 0U);
}

}  // namespace
}  // namespace ipos::tests

// Any traffic on a line: the state of a node follows its NMT commands, and what it sends and takes is what the state
// allows.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "tests/harness/proves.hpp"
#include "tests/runtime/bus/canopen/node_rig.hpp"

namespace ipos::tests {
namespace {

// The state machine of CiA 301 for a node that needs no time to start.
State after(State state, uint8_t command) {
  switch (command) {
    case 0x01: return State::Operational;
    case 0x02: return State::Stopped;
    case 0x80:
    case 0x81:
    case 0x82: return State::PreOperational;
    default: return state;
  }
}

Frame any_frame() {
  static const std::vector<Frame> kUsual = {{0x080, 0},
                                            {0x205, 6, {1, 2, 3, 4, 5, 6}},
                                            {0x205, 2, {1, 2}},
                                            {0x705, 1, {}, false, true},
                                            {0x185, 6, {}, false, true},
                                            {0x605, 8, {0x40, 0x08, 0x10, 0x00}},
                                            {0x605, 8, {0x60}},
                                            {0x605, 8, {0x70}},
                                            {0x605, 8, {0x40, 0x7E, 0x20, 0x00}},
                                            {0x605, 8, {0x2F, 0x00, 0x18, 0x02, 0xFF}},
                                            {0x605, 8, {0x2F, 0x00, 0x14, 0x02, 0xFF}}};
  if (*rc::gen::inRange(0, 4) != 0) return *rc::gen::elementOf(kUsual);
  Frame frame;
  frame.id = *rc::gen::inRange<uint32_t>(1, 0x800);
  frame.length = *rc::gen::inRange<uint8_t>(0, 9);
  frame.remote = *rc::gen::inRange(0, 6) == 0;
  for (uint8_t& byte : frame.data) byte = *rc::gen::arbitrary<uint8_t>();
  return canonical(frame);
}

void state_law() {
  NodeRig rig;
  State expected = State::PreOperational;
  for (int n = *rc::gen::inRange(1, 80); n > 0; --n) {
    const bool commands = *rc::gen::inRange(0, 4) == 0;
    uint8_t command = 0;
    uint8_t target = 0;
    Frame frame = any_frame();
    if (commands) {
      static const std::vector<uint8_t> kCommands = {0x01, 0x01, 0x02, 0x80, 0x81, 0x82, 0x03};
      command = *rc::gen::elementOf(kCommands);
      target = *rc::gen::inRange<uint8_t>(4, 7);
      if (target == 4) target = 0;
      frame = {0x000, 2, {command, target}};
    }
    const size_t taken = rig.station.unit.taken.size();
    rig.station.unit.inputs[0] = *rc::gen::inRange<uint16_t>(0, 4);
    rig.station.unit.state.fault = *rc::gen::inRange(0, 5) == 0;
    rig.clear();
    rig.station.node.unit_changed(rig.queue.now());
    rig.run(kMillisecond);
    const std::vector<Frame> by_itself = rig.master.frames;
    std::vector<Frame> sent = rig.ask(frame, 20 * kMillisecond);
    const State before = expected;
    if (commands && (target == 0 || target == 5)) expected = after(expected, command);
    RC_ASSERT(rig.station.node.state() == expected);
    const bool resets = commands && command >= 0x81 && target != 6;
    sent.insert(sent.end(), by_itself.begin(), by_itself.end());
    size_t boots = 0;
    for (const Frame& heard : sent) {
      const bool pdo = heard.id == 0x185;
      const bool sdo = heard.id == 0x585;
      const bool emergency = heard.id == 0x085;
      RC_ASSERT(pdo || sdo || emergency || heard.id == 0x705);
      RC_ASSERT(!pdo || before == State::Operational || expected == State::Operational);
      RC_ASSERT(!(sdo || emergency) || before != State::Stopped || expected != State::Stopped);
      boots += heard.id == 0x705 && heard.data[0] == 0;
    }
    RC_ASSERT(boots == (resets ? 1U : 0U));
    if (rig.station.unit.taken.size() != taken) RC_ASSERT(before == State::Operational);
  }
}

TEST(CanopenStateLaw, AnyTraffic) {
  PROVES("MDB-TOC-06", "MDB-TOC-08");
  EXPECT_TRUE(rc::check("the state allows what is sent and taken", state_law));
}

}  // namespace
}  // namespace ipos::tests

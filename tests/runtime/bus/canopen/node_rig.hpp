// CANopen nodes with their units on a CAN line, and a hand-driven master.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/canopen/node.hpp"
#include "tests/runtime/bus/canopen/fake_unit.hpp"
#include "tests/runtime/bus/hand.hpp"

namespace ipos::tests {

class Station final : public CanNode, public NodeObserver {
 public:
  Station(EventQueue& queue, uint32_t source, CanLine& line, uint8_t number)
      : port(line, line.attach("node" + std::to_string(number), line.baud(), *this)),
        node({queue, source, port, 1}, number, mdxb(), {}, unit, unit, this) {
    line.close_filter(port.node());
  }
  void on_frame(Time now, const Frame& frame) override {
    if (!node.on_frame(now, frame)) ++foreign;
  }
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}
  void on_ignored(Time, const Frame&, IgnoredMessage reason) override { ignored.push_back(reason); }

  FakeUnit unit;
  LinePort port;
  canopen::Node node;
  int foreign = 0;
  std::vector<IgnoredMessage> ignored;
};

struct NodeRig {
  NodeRig() {
    station.node.start(0);
    run(10 * kMillisecond);
  }
  void run(Time span) { queue.run_until(queue.now() + span); }
  // The frames that come within `span` of one sent by the master.
  std::vector<Frame> ask(const Frame& frame, Time span = 10 * kMillisecond) {
    clear();
    master.port.send(frame, 0);
    run(span);
    return master.frames;
  }
  void clear() {
    master.frames.clear();
    master.times.clear();
  }
  void nmt(NmtCommand command) { ask(nmt_frame(command, 5)); }
  // Must succeed.
  void write(uint16_t index, uint8_t sub, uint32_t value, uint8_t bytes) {
    const auto answer = ask({0x605,
                             8,
                             {static_cast<uint8_t>(0x23 | (4 - bytes) << 2), static_cast<uint8_t>(index),
                              static_cast<uint8_t>(index >> 8), sub, static_cast<uint8_t>(value),
                              static_cast<uint8_t>(value >> 8), static_cast<uint8_t>(value >> 16),
                              static_cast<uint8_t>(value >> 24)}});
    uint8_t command = 0;
    for (const Frame& frame : answer)
      if (frame.id == 0x585) command = frame.data[0];
    ASSERT_EQ(command, 0x60) << std::hex << index << ":" << int{sub};
  }
  // How many frames with this identifier have come since clear().
  size_t count(uint32_t id) const {
    size_t found = 0;
    for (const Frame& frame : master.frames) found += frame.id == id;
    return found;
  }
  std::vector<Frame> sync(Time span = kMillisecond) { return ask({0x080, 0}, span); }

  EventQueue queue;
  CanLine line{queue, 9, "sbus", 500'000};
  Hand master{line, "master"};
  Station station{queue, 1, line, 5};
};

inline Frame remote(uint32_t id, uint8_t length) { return {id, length, {}, false, true}; }

}  // namespace ipos::tests

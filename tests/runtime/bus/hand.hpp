// A hand-driven station on a CAN line: sends what a test wants and keeps what it hears.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/can/line.hpp"

namespace ipos::tests {

using namespace ipos::runtime;  // NOLINT: a test header, everything here is about the runtime

class Hand final : public CanNode {
 public:
  Hand(CanLine& line, std::string name) : port(line, line.attach(std::move(name), line.baud(), *this)) {}
  void on_frame(Time now, const Frame& frame) override {
    frames.push_back(frame);
    times.push_back(now);
  }
  void on_sent(Time now, const Frame&, uint64_t) override { last_sent = now; }
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}

  std::vector<Frame> frames;
  std::vector<Time> times;
  Time last_sent = 0;
  LinePort port;
};

}  // namespace ipos::tests

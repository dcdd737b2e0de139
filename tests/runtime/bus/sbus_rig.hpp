// A small SBus for tests: a unit with a few parameters as slave.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <span>
#include <vector>

#include "runtime/bus/can/line.hpp"
#include "runtime/bus/movilink/sbus_slave.hpp"
#include "tests/runtime/bus/hand.hpp"

namespace ipos::tests {

using namespace ipos::runtime;  // NOLINT: a test header, everything here is about the runtime

class Unit final : public CanNode, public ParameterServer, public ProcessDataServer, public SlaveObserver {
 public:
  Unit(EventQueue& queue, uint32_t source, CanLine& line, std::string name, SlaveSettings settings,
       SlaveTiming timing = {})
      : port(line, line.attach(std::move(name), line.baud(), *this)),
        slave(queue, source, port, 1, settings, timing, *this, *this, this) {}

  void on_frame(Time now, const Frame& frame) override {
    if (!slave.on_frame(now, frame)) ++foreign;
  }
  void on_sent(Time, const Frame&, uint64_t) override {}
  void on_not_sent(Time, const Frame&, uint64_t, NotSent) override {}

  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest& request) override {
    requests.push_back(request);
    const auto found = parameters.find(request.index);
    if (found == parameters.end()) return tl::unexpected(return_codes::kInvalidIndex);
    if (request.service == Service::ReadMaximum) return 9999;
    if (!is_write(request.service)) return found->second;
    if (request.index == 8318) return tl::unexpected(return_codes::kReadOnly);
    return found->second = request.value;
  }
  void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override {
    ASSERT_EQ(words.size(), 3U);
    outputs.push_back({words[0], words[1], words[2]});
    output_times.push_back(now);
    channels.push_back(channel);
  }
  ProcessWords input(Time) override { return inputs; }
  void synchronize(Time) override { ++syncs; }
  void on_ignored(Time, const Frame&, Ignored reason, ReturnCode code) override {
    ignored.push_back(reason);
    last_code = code;
  }

  std::map<int, int32_t> parameters = {{8318, 1'000'000}, {8470, 0}};
  std::vector<ParameterRequest> requests;
  std::vector<ProcessWords> outputs;
  std::vector<Time> output_times;
  std::vector<OutputChannel> channels;
  ProcessWords inputs{7, 5011, 0};
  int syncs = 0;
  int foreign = 0;
  std::vector<Ignored> ignored;
  ReturnCode last_code;
  LinePort port;
  SbusSlave slave;
};

}  // namespace ipos::tests

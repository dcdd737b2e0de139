// A unit for CANopen tests: some parameters, process data that are kept, and a count of what it is told.
#pragma once

#include <map>
#include <vector>

#include "runtime/bus/canopen/unit.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::tests {

using namespace ipos::runtime;           // NOLINT: a test header, everything here is about the runtime
using namespace ipos::runtime::canopen;  // NOLINT
using canopen::Unit;

inline const stdlib::UnitType& mdxb() { return *stdlib::find_unit("mdxb"); }

class FakeUnit final : public Unit, public ParameterServer {
 public:
  tl::expected<int32_t, ReturnCode> serve(Time, const ParameterRequest& request) override {
    ++requests;
    const auto found = parameters.find(request.index);
    if (found == parameters.end()) return tl::unexpected(return_codes::kInvalidIndex);
    if (!is_write(request.service)) return found->second;
    if (refusal != ReturnCode{}) return tl::unexpected(refusal);
    return found->second = request.value;
  }
  void take_output(Time now, const Words& words, uint16_t written) override {
    for (size_t n = 0; n < words.size(); ++n)
      if ((written >> n & 1) != 0) outputs[n] = words[n];
    taken.push_back(now);
    last_written = written;
  }
  // Nothing of what was not asked for.
  Words input(Time, uint16_t which) override {
    Words words{};
    for (size_t n = 0; n < words.size(); ++n)
      if ((which >> n & 1) != 0) words[n] = inputs[n];
    return words;
  }
  UnitStatus status(Time) override { return state; }
  void synchronize(Time now) override { syncs.push_back(now); }
  void state_changed(Time, State to) override { states.push_back(to); }
  void reset_node(Time) override { ++resets; }
  void partner_lost(Time now) override { lost.push_back(now); }
  void partner_back(Time now) override { back.push_back(now); }

  std::map<int, int32_t> parameters = {{8300, 822'609'711}, {8318, 1'000'000}, {8300 + 8, 5}};
  ReturnCode refusal;  // of every write
  int requests = 0;
  Words outputs{};
  Words inputs{};
  UnitStatus state;
  uint16_t last_written = 0;
  std::vector<Time> taken, syncs, lost, back;
  std::vector<State> states;
  int resets = 0;
};

}  // namespace ipos::tests

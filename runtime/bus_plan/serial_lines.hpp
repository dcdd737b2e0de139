// The RS-485 and RS-232 lines of a plan: their stations, which telegrams the trial run showed, and what is
// against the rules (1053 1610 p. 14-22; MDX60B/61B p. 14-20, 29). What cannot be wired at all is refused
// with the plant file (runtime/plant_file/serial_plan.hpp).
#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus_plan/plan.hpp"

namespace ipos::runtime {

// Listens to the serial lines of a plant during the trial run.
class SerialWatcher final : public SerialObserver {
 public:
  struct Seen {
    std::string sender;
    uint64_t count = 0;
    Time last = 0;
    Time closest = kNever;  // shortest distance of two, from start to start
  };
  using Key = std::tuple<uint8_t, uint8_t, bool>;  // address, format code, response
  struct Line {
    SerialReceiver receiver;
    std::map<Key, Seen> telegrams;
    std::vector<std::string> masters;  // in the order in which they were heard
  };

  void on_character(const Rs485Line& line, NodeId sender, const Character& character) override;
  void on_serial_event(const Rs485Line&, const SerialEvent&) override {}

  std::map<std::string, Line, std::less<>> lines;  // by name
};

// The lines of the plant file; keypads have lines of their own, which are not planned.
void plan_serial_lines(const Plant& plant, const SerialWatcher& watcher, BusPlan& plan);

}  // namespace ipos::runtime

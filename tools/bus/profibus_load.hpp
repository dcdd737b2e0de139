// Load of a PROFIBUS line by its log: in windows of one second, and by kind of frame ("1 -> 8 Set_Prm"). A frame has 11 bits
// an octet; idle times are not counted.
#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/bus/profibus/fdl_receiver.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::tools {

class ProfibusLoad {
 public:
  struct Count {
    uint64_t frames = 0;
    uint64_t bits = 0;
    runtime::Time first = 0, last = 0;  // begin of the first and the last one

    void add(runtime::Time time, uint64_t more);
    // Mean time from one to the next, 0 for a single one.
    runtime::Time every() const {
      return frames < 2 ? 0 : (last - first) / static_cast<runtime::Time>(frames - 1);
    }
  };

  explicit ProfibusLoad(uint32_t baud) : baud_(baud) {}

  // In rising order of time.
  void add(const profibus::Reception& reception);

  std::string text() const;
  nlohmann::ordered_json json() const;

 private:
  double percent(uint64_t bits, runtime::Time span) const;
  // From the begin of the first frame to the end of the last one.
  runtime::Time span() const;

  uint32_t baud_;
  Count all_;
  uint64_t last_bits_ = 0;      // of the last frame
  std::vector<Count> windows_;  // without gaps, from the first frame on
  std::map<std::string, Count> kinds_;
};

}  // namespace ipos::tools

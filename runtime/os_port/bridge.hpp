// What all bridges between a simulated line and a real port have in common: members of the real-time loop
// that tell what they lost.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/os_port/port.hpp"
#include "runtime/os_port/real_time.hpp"

namespace ipos::runtime {

struct BridgeCounts {
  uint64_t undelivered = 0;  // from the port, while no simulated station took part in the line
  uint64_t late = 0;         // from the port, at a virtual time that had passed: put on the line at once
  Time worst_late = 0;
};

class Bridge : public RealTimeMember {
 public:
  virtual ~Bridge() = default;

  virtual const Port& port() const = 0;
  virtual std::string_view goods() const = 0;  // what it carries: "frames", "bytes"
  virtual const BridgeCounts& counts() const = 0;
  virtual size_t waiting() const = 0;                    // from the port, not on the line yet
  virtual std::vector<std::string> take_notes() = 0;     // of the bridge and its port
  virtual std::vector<std::string> repeats() const = 0;  // at the end, as those of ports
};

}  // namespace ipos::runtime

// `ipos run --realtime`: opens the ports of a plant's buses, keeps the plant in step with the clock of this
// machine and with the real buses, and tells what went wrong with both.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "runtime/os_port/system_clock.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/plant_port/join.hpp"

namespace ipos::tools {

// Throws when the plant has a bus with a port: that needs real time.
void refuse_ports(const runtime::PlantFile& plant, const std::string& file);

class RealTimeRun {
 public:
  // Opens all ports; throws with the place in the plant file for each that cannot be opened.
  RealTimeRun(runtime::Plant& plant, const std::string& file);

  // Until virtual time `limit`, or until `keep_going` says no: it is asked once a virtual millisecond. False
  // when a port has gone.
  bool run(runtime::Time limit, const std::function<bool(runtime::Time)>& keep_going);

 private:
  void tell_news(const runtime::RealTimeLoop& loop);
  void report(const runtime::Punctuality& punctuality) const;

  runtime::Plant& plant_;
  runtime::SystemClock clock_;
  std::vector<runtime::JoinedPort> joined_;
  bool told_late_ = false;
  bool told_left_out_ = false;
};

}  // namespace ipos::tools

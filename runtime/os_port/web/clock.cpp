// A worker cannot wait: it looks at its clock until the time has come. Only a run beside real time asks for that.
#include <chrono>

#include "runtime/os_port/system_clock.hpp"

namespace ipos::runtime {

Time SystemClock::now() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

Time SystemClock::wall() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

void SystemClock::wait(Time until, std::span<const PortNeeds>) {
  while (now() < until) {
  }
}

}  // namespace ipos::runtime

// The performance counter, and a look at the ports every millisecond: Windows waits for no serial device and a time at once
// without a thread for each.
#include <windows.h>

#include <timeapi.h>

#include <algorithm>
#include <chrono>

#include "runtime/os_port/system_clock.hpp"

namespace ipos::runtime {
namespace {

// While it lives, Sleep() is exact to a millisecond instead of 16.
class ExactSleep {
 public:
  ExactSleep() { timeBeginPeriod(1); }
  ~ExactSleep() { timeEndPeriod(1); }
  ExactSleep(const ExactSleep&) = delete;
  ExactSleep& operator=(const ExactSleep&) = delete;
};

}  // namespace

Time SystemClock::now() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

Time SystemClock::wall() {
  using namespace std::chrono;
  return duration_cast<nanoseconds>(system_clock::now().time_since_epoch()).count();
}

void SystemClock::wait(Time until, std::span<const PortNeeds> ports) {
  static const ExactSleep exact;
  for (const PortNeeds& port : ports) until = std::min(until, port.wake);
  if (!ports.empty()) until = std::min(until, now() + kMillisecond);
  const Time left = until - now();
  if (left <= 0) return;
  constexpr Time kLongest = kSecond;  // then the caller asks again
  Sleep(static_cast<DWORD>((std::min(left, kLongest) + kMillisecond - 1) / kMillisecond));
}

}  // namespace ipos::runtime

// clock_gettime and ppoll.
#include "runtime/os_port/system_clock.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <ctime>

namespace ipos::runtime {
namespace {

Time read_clock(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<Time>(time.tv_sec) * kSecond + time.tv_nsec;
}

}  // namespace

Time SystemClock::now() { return read_clock(CLOCK_MONOTONIC); }

Time SystemClock::wall() { return read_clock(CLOCK_REALTIME); }

void SystemClock::wait(Time until, std::span<const PortNeeds> ports) {
  std::array<pollfd, 64> polled;  // more ports than this are served at `until` only
  nfds_t count = 0;
  for (const PortNeeds& port : ports) {
    until = std::min(until, port.wake);
    if (port.descriptor < 0 || count == polled.size()) continue;
    polled[count++] = {port.descriptor, static_cast<short>(port.output ? POLLIN | POLLOUT : POLLIN), 0};
  }
  const Time left = until - now();
  if (left <= 0) return;
  const timespec timeout{static_cast<time_t>(left / kSecond), static_cast<long>(left % kSecond)};
  ppoll(polled.data(), count, &timeout, nullptr);
}

}  // namespace ipos::runtime

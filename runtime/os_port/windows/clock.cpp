// The performance counter, and a wait for the events of the ports and a timer at once.
#include "runtime/os_port/system_clock.hpp"

#include <windows.h>

#include <timeapi.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace ipos::runtime {
namespace {

// While it lives, waits are exact to a millisecond instead of 16, where there is no better timer.
class ExactWaits {
 public:
  ExactWaits() { timeBeginPeriod(1); }
  ~ExactWaits() { timeEndPeriod(1); }
  ExactWaits(const ExactWaits&) = delete;
  ExactWaits& operator=(const ExactWaits&) = delete;
};

class Timer {
 public:
  // Windows 10 1803 and later has timers that are exact to some tens of microseconds.
  Timer() : handle_(make(kHighResolution)) {
    if (handle_ == nullptr) handle_ = make(0);
  }
  ~Timer() { CloseHandle(handle_); }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

  HANDLE set(Time left) {
    LARGE_INTEGER due{};
    due.QuadPart = -std::max<Time>(1, left / 100);  // relative, in 100 ns
    SetWaitableTimer(handle_, &due, 0, nullptr, nullptr, FALSE);
    return handle_;
  }

 private:
  static constexpr DWORD kHighResolution = 2;  // CREATE_WAITABLE_TIMER_HIGH_RESOLUTION
  static HANDLE make(DWORD flags) { return CreateWaitableTimerExW(nullptr, nullptr, flags, TIMER_ALL_ACCESS); }
  HANDLE handle_;
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
  static const ExactWaits exact;
  static thread_local Timer timer;
  constexpr Time kLongest = 100 * kMillisecond;  // then the caller looks whether it is to end: Ctrl+C wakes no thread
  std::array<HANDLE, MAXIMUM_WAIT_OBJECTS> handles{};
  DWORD count = 0;
  bool has_output = false;
  for (const PortNeeds& port : ports) {
    until = std::min(until, port.wake);
    has_output |= port.output;
    // More ports than there is room for are served at `until` only. The last place is the timer's.
    if (port.descriptor >= 0 && count + 1 < handles.size())
      handles[count++] = reinterpret_cast<HANDLE>(static_cast<intptr_t>(port.descriptor));
  }
  const Time begin = now();
  if (has_output) until = std::min(until, begin + kMillisecond);
  const Time left = std::min(until - begin, kLongest);
  if (left <= 0) return;
  handles[count++] = timer.set(left);
  WaitForMultipleObjects(count, handles.data(), FALSE, static_cast<DWORD>(left / kMillisecond + 2));
}

}  // namespace ipos::runtime

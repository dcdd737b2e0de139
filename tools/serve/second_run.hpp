// A copy of this process that does something beside it and ends; what it finds it leaves in SharedMemory. It gives way to
// the process that it came from, and ends with it.
#pragma once

#include <sys/types.h>

#include <functional>
#include <optional>

namespace ipos::tools::serve {

class SecondRun {
 public:
  // `body` is what the copy does; it never comes back here.
  explicit SecondRun(const std::function<void()>& body);
  // Ends the copy: after this it writes no more. Another process than the one that began it leaves it alone.
  ~SecondRun();
  SecondRun(const SecondRun&) = delete;
  SecondRun& operator=(const SecondRun&) = delete;

  // Once it has ended: whether it came to the end of `body`.
  std::optional<bool> result();

 private:
  int pipe_ = -1;
  pid_t owner_ = -1;
  pid_t copy_ = -1;
  std::optional<bool> result_;
};

}  // namespace ipos::tools::serve

// A process whose forked snapshots may take its place.
#pragma once

#include <functional>

namespace ipos::tools {

// Runs `body` in a process whose snapshots may take its place. wait() returns what the last of them returns; -1 when
// it ended without that.
class ReplaceableProcess {
 public:
  explicit ReplaceableProcess(const std::function<int()>& body);
  ReplaceableProcess(const ReplaceableProcess&) = delete;
  ReplaceableProcess& operator=(const ReplaceableProcess&) = delete;
  ~ReplaceableProcess();

  bool started() const { return pipe_ >= 0; }  // else there is no room for another process
  int wait();

 private:
  int pipe_ = -1;  // what it returns comes here
};

// The same while the caller waits; in the caller's own process where there is no room for another.
int run_replaceable(const std::function<int()>& body);

}  // namespace ipos::tools

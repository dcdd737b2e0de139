// Something that is done beside the caller. Where a process can be copied it is a process of its own, whose forked snapshots
// may take its place (posix); else it is a thread, and time goes back by running again from the beginning (windows).
#pragma once

#include <functional>
#include <memory>

#include "tools/debugger/snapshots.hpp"

namespace ipos::tools {

// Runs `body`. wait() returns what the last of the processes returns; -1 when it ended without that.
class ReplaceableProcess {
 public:
  explicit ReplaceableProcess(const std::function<int()>& body);
  ReplaceableProcess(const ReplaceableProcess&) = delete;
  ReplaceableProcess& operator=(const ReplaceableProcess&) = delete;
  ~ReplaceableProcess();

  bool started() const { return running_ != nullptr; }  // else there is no room for another process
  int wait();

  // The body has copies of all files that are open, and gets Ctrl-C itself; else it shares what its caller has.
  static const bool kHasCopies;

 private:
  struct Running;
  std::unique_ptr<Running> running_;
};

// The same while the caller waits; in the caller's own process where there is no room for another.
int run_replaceable(const std::function<int()>& body);

// Of a replaceable process; null where it cannot be copied.
std::unique_ptr<debug::Snapshots> snapshots_of_process();

}  // namespace ipos::tools

// Who works on a shard: a file beside it, which only one process can make, on any file system, also over a network. Its owner
// writes a number into it again and again; where the number stands still its owner is gone.
#pragma once

#include <cstdint>
#include <string>

namespace ipos::tools::campaign {

class ShardLock {
 public:
  // A Failure with kTaken when another runner has it; of a runner on another machine that is seen after kPatience.
  explicit ShardLock(std::string path);
  ~ShardLock();
  ShardLock(const ShardLock&) = delete;
  ShardLock& operator=(const ShardLock&) = delete;

  // At least every second. A Failure when somebody else has it now.
  void beat();

 private:
  bool make();
  bool wait_for_owner() const;
  void take_over(const std::string& stale);

  std::string path_;
  std::string owner_;  // this process: machine, number, time of its start
  uint64_t beats_ = 0;
};

}  // namespace ipos::tools::campaign

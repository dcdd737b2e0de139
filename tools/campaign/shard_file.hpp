// The file of one shard of a campaign, DIR/shard-K-of-N.jsonl: one writer, a line a case. At any kill every line is whole but
// the last one, which is dropped when the shard is taken up again.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/os_port/descriptor.hpp"
#include "tools/campaign/row.hpp"
#include "tools/campaign/shard_lock.hpp"

namespace ipos::tools::campaign {

struct Shard {
  uint32_t number = 1;  // K, from 1
  uint32_t count = 1;   // N

  bool has(uint64_t rank) const { return rank % count == number - 1; }
  std::string file_name() const;
};

// "3/16". A Failure for anything else.
Shard shard_of(const std::string& text);

// The names of all files of results in a folder, in order.
std::vector<std::string> shard_files(const std::string& folder);

class ShardFile {
 public:
  // Makes the folder and the file where they are not there. A Failure with 75 where another runner has the shard, with 74
  // where nothing can be written.
  ShardFile(const std::string& folder, const Shard& shard);

  // Of a whole case; its end of line included. A Failure with 74 when there is no room; then the file ends with the line
  // before.
  void append(std::string_view lines);
  // Now and then: what was written is on the disk, and others see that the shard is worked on. A Failure with 75 when
  // another runner has taken it.
  void keep();

  // Bytes of a last line that was not whole.
  size_t dropped() const { return dropped_; }

 private:
  void drop_torn_line();

  std::string path_;
  ShardLock lock_;
  runtime::Descriptor file_;
  size_t size_ = 0;
  size_t dropped_ = 0;
};

}  // namespace ipos::tools::campaign

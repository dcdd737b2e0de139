// What a host has more where its process can be copied: going back without running again from the beginning, and
// a look at what was while the plant goes on. A host without copies does the same, slower or not at all.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>

#include "tools/cli/failure.hpp"
#include "tools/debugger/snapshots.hpp"

namespace ipos::tools::serve {

// Of a recording. It begins as zeros, and what nobody has written takes no room.
using Memory = std::shared_ptr<std::byte>;

// Something that is done beside the host.
class SecondRun {
 public:
  virtual ~SecondRun() = default;  // it is given up
  // Once it has ended: whether it came to its end.
  virtual std::optional<bool> result() = 0;
};

class Copies {
 public:
  virtual ~Copies() = default;
  virtual std::unique_ptr<debug::Snapshots> snapshots() { return nullptr; }
  // What one copy writes there the others read. Empty: there is no room.
  virtual Memory memory(size_t bytes) {
    return {static_cast<std::byte*>(std::calloc(bytes, 1)), [](std::byte* begin) { std::free(begin); }};
  }
  virtual void give_way() {}  // to the others
  // A copy does it and ends; what it finds it leaves in memory(). Nothing: there are no copies.
  virtual std::unique_ptr<SecondRun> beside(const std::function<void()>& /*body*/) { return nullptr; }
};

// A Failure: there is none.
inline Memory room_for(Copies& copies, size_t bytes) {
  Memory memory = copies.memory(bytes);
  if (!memory) throw Failure(kIoError, "the system gives no memory for what is recorded");
  return memory;
}

}  // namespace ipos::tools::serve

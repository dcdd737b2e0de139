// The last telegrams of each line, so that a busy line takes nothing from a quiet one. Like the scope's (scope_memory.hpp)
// this memory is that of all copies of the process; what a copy knows itself is how far it has come.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <vector>

#include "tools/serve/host/copies.hpp"
#include "tools/serve/host/telegram.hpp"

namespace ipos::tools::serve {

// A telegram with its number among those of all lines, from 1.
struct NumberedTelegram {
  uint64_t number = 0;
  Telegram telegram;
};

class TraceMemory {
 public:
  static constexpr size_t kKept = 100'000;          // telegrams a line, at most
  static constexpr size_t kBytes = size_t{24} << 20U;  // of all lines together (ours)

  explicit TraceMemory(Copies& copies) : copies_(copies) {}

  // Nothing is known any more. The number of lines stays what it is the first time.
  void restart(size_t lines);
  void add(uint64_t number, const Telegram& telegram);
  // Those of later times do not come any more. What they have overwritten stays gone.
  void forget_later();

  // Telegrams of a line, from first to before end.
  uint64_t first(size_t line) const;
  uint64_t end(size_t line) const { return lines_[line].count; }
  uint64_t number(size_t line, uint64_t n) const;
  NumberedTelegram at(size_t line, uint64_t n) const;

 private:
  struct Shared {
    std::atomic<uint64_t> count, bytes;  // how far any copy has come
    std::atomic<uint64_t> first;         // those before it were overwritten by what does not come any more
  };
  struct Line {
    uint64_t count = 0;  // telegrams
    uint64_t bytes = 0;
  };
  struct Head;

  Shared& shared(size_t line) const;
  uint64_t& begin_of(size_t line, uint64_t n) const;
  void copy_in(size_t line, uint64_t at, const void* from, size_t size) const;
  void copy_out(size_t line, uint64_t at, void* to, size_t size) const;

  template <typename Type>
  Type* at_byte(size_t byte) const {
    return reinterpret_cast<Type*>(memory_.get() + byte);
  }

  Copies& copies_;
  Memory memory_;
  std::vector<Line> lines_;
  size_t room_ = 0;  // bytes of a line
};

}  // namespace ipos::tools::serve

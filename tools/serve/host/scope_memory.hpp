// What the scope has recorded: a sample of each channel a millisecond, the last million of them, numbered by their
// milliseconds. Copies of the process share it, so that going back keeps nothing twice: what a copy knows itself is how far
// it has come. Extremes of long ranges are found without looking at every sample; of words they are the bits that were on
// all the time, and those that were on at some time.
#pragma once

#include <atomic>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tools/serve/host/copies.hpp"

namespace ipos::tools::serve {

class ScopeMemory {
 public:
  static constexpr uint64_t kKept = 1'000'000;  // samples a channel, at least
  // With 32 bits a sample they take 66 MB at most, and only as far as it is written.
  static constexpr size_t kMostChannels = 16;

  // What the 32 bits of a sample are.
  struct Kind {
    bool is_unsigned = false;  // else with sign
    bool is_word = false;      // its bits count, each by itself
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Kind, is_unsigned, is_word)
  };
  // Where a channel stands, and from which sample to which it is known: after the way back also later than now.
  struct Column {
    size_t place = 0;
    uint64_t from = 0;
    uint64_t to = 0;
    Kind kind{};
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Column, place, from, to, kind)
  };

  explicit ScopeMemory(Copies& copies);

  // Nothing is known any more; the next sample will have this number.
  void restart(uint64_t next);
  // The same comes once more: what is known of later times stays.
  void go_on_from(uint64_t next);
  // The channels are others: each is one that was there, by its number, or a new one, of which nothing is known yet.
  // `kinds` is of all of them; left out: plain numbers with sign.
  void choose(const std::vector<std::optional<size_t>>& channels, const std::vector<Kind>& kinds = {});
  // As another copy of the process had them.
  void use(std::vector<Column> columns);
  const std::vector<Column>& columns() const { return columns_; }

  // What is known of later times is not what will be.
  void forget_later();

  // What is known must be without holes: after a hole it starts again. False then.
  bool push(uint64_t number, std::span<const int64_t> samples);
  // The first sample that is kept once there are those up to before `end`.
  static uint64_t first_kept(uint64_t end);

  // What a copy that runs again writes of the time before a channel was known, in order from `from` on; and that it is there.
  // What is known already stays.
  void fill(size_t channel, uint64_t from, uint64_t number, int64_t sample);
  void filled(size_t channel, uint64_t from);

  // Of all channels, and of one: numbers from first to before end are known.
  uint64_t first() const;
  uint64_t first(size_t channel) const;
  uint64_t end() const { return end_; }
  // After the way back: of any channel the number after the last one that was known of later times.
  uint64_t later_end() const;
  size_t channels() const { return columns_.size(); }

  // Nothing where it is not known.
  std::optional<int64_t> at(size_t channel, uint64_t number) const;
  // Least and greatest of those known from `begin` to before `end`, also of later times; of a word the bits of all, and of
  // any.
  using Extremes = std::pair<int64_t, int64_t>;
  std::optional<Extremes> extremes(size_t channel, uint64_t begin, uint64_t end) const;

 private:
  static constexpr uint64_t kBlock = 64;
  static constexpr uint64_t kRing = (kKept / kBlock + 1) * kBlock;
  static constexpr uint64_t kBlocks = kRing / kBlock;
  // Of all copies together.
  struct Shared {
    std::atomic<uint64_t> reached;  // how far any of them has come: what was there a whole ring before is overwritten
    std::atomic<uint64_t> filling;  // the number that is just being filled in, plus one
  };

  // As they lie there: a number counts from the least one of its kind, so that all compare as what they are.
  using Stored = uint32_t;
  struct Block {
    Stored least, greatest;
  };

  static Stored stored(const Column& column, int64_t sample);
  static int64_t read(const Column& column, Stored stored);
  static Block join(const Column& column, Block a, Block b);
  Stored& sample(size_t place, uint64_t number) const;
  Block& block(size_t place, uint64_t number) const;
  void count_block(const Column& column, uint64_t from, uint64_t end) const;
  void put(const Column& column, uint64_t number, int64_t sample, bool begins) const;

  template <typename Type>
  Type* at_byte(size_t byte) const {
    return reinterpret_cast<Type*>(memory_.get() + byte);
  }

  Copies& copies_;
  Memory memory_;
  Shared* shared_;
  std::vector<Column> columns_;
  uint64_t end_ = 0;
  bool begins_ = true;  // the extremes of the block may be those of another future
};

}  // namespace ipos::tools::serve

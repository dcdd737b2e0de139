// A ring of samples and one of their blocks' extremes for each channel; whole blocks are forgotten at once.
#include "tools/serve/host/scope_memory.hpp"

#include <algorithm>

namespace ipos::tools::serve {
namespace {

constexpr size_t kHead = 64;  // bytes
constexpr int kPatience = 10'000;

}  // namespace

ScopeMemory::ScopeMemory(Copies& copies)
    : copies_(copies),
      memory_(room_for(copies, kHead + kMostChannels * (kRing * sizeof(Stored) + kBlocks * sizeof(Block)))),
      shared_(at_byte<Shared>(0)) {}

// What no sample of the kind can be is the nearest one.
ScopeMemory::Stored ScopeMemory::stored(const Column& column, int64_t sample) {
  const int64_t least = column.kind.is_unsigned || column.kind.is_word ? 0 : INT32_MIN;
  return static_cast<Stored>(std::clamp<int64_t>(sample - least, 0, UINT32_MAX));
}
int64_t ScopeMemory::read(const Column& column, Stored stored) {
  return int64_t{stored} + (column.kind.is_unsigned || column.kind.is_word ? 0 : INT32_MIN);
}
ScopeMemory::Block ScopeMemory::join(const Column& column, Block a, Block b) {
  if (column.kind.is_word) return {a.least & b.least, a.greatest | b.greatest};
  return {std::min(a.least, b.least), std::max(a.greatest, b.greatest)};
}

ScopeMemory::Stored& ScopeMemory::sample(size_t place, uint64_t number) const {
  return at_byte<Stored>(kHead)[place * kRing + number % kRing];
}
ScopeMemory::Block& ScopeMemory::block(size_t place, uint64_t number) const {
  return at_byte<Block>(kHead + kMostChannels * kRing * sizeof(Stored))[place * kBlocks + number / kBlock % kBlocks];
}

void ScopeMemory::restart(uint64_t next) {
  shared_->reached = 0;
  end_ = next;
  begins_ = true;
  for (Column& column : columns_) column.from = column.to = next;
}

void ScopeMemory::go_on_from(uint64_t next) {
  end_ = next;
  use(std::move(columns_));
}

void ScopeMemory::choose(const std::vector<std::optional<size_t>>& channels, const std::vector<Kind>& kinds) {
  std::vector<Column> columns;
  std::vector<bool> taken(kMostChannels, false);
  for (const auto& channel : channels)
    if (channel) taken[columns_[*channel].place] = true;
  for (size_t n = 0; n < channels.size(); ++n) {
    if (channels[n]) {
      columns.push_back(columns_[*channels[n]]);
      continue;
    }
    const auto free = std::find(taken.begin(), taken.end(), false);
    *free = true;
    columns.push_back({static_cast<size_t>(free - taken.begin()), end_, end_, n < kinds.size() ? kinds[n] : Kind{}});
  }
  use(std::move(columns));
}

void ScopeMemory::use(std::vector<Column> columns) {
  columns_ = std::move(columns);
  for (Column& column : columns_)
    if (end_ < column.from || end_ > column.to) column.from = column.to = end_;
  begins_ = true;
}

// What others have overwritten stays gone, though they are no more.
void ScopeMemory::forget_later() {
  const uint64_t kept = first_kept(shared_->reached);
  for (Column& column : columns_) {
    column.from = std::min(std::max(column.from, kept), end_);
    column.to = end_;
  }
  shared_->reached = end_;
  begins_ = true;
}

uint64_t ScopeMemory::first_kept(uint64_t end) {
  const uint64_t blocks = (end + kBlock - 1) / kBlock;
  return blocks > kBlocks ? (blocks - kBlocks) * kBlock : 0;
}

uint64_t ScopeMemory::first(size_t channel) const {
  return std::max(columns_[channel].from, first_kept(shared_->reached));
}
uint64_t ScopeMemory::first() const {
  uint64_t least = end_;
  for (size_t n = 0; n < columns_.size(); ++n) least = std::min(least, first(n));
  return least;
}

uint64_t ScopeMemory::later_end() const {
  uint64_t latest = end_;
  for (const Column& column : columns_) latest = std::max(latest, column.to);
  return latest;
}

bool ScopeMemory::push(uint64_t number, std::span<const int64_t> samples) {
  const bool follows = number == end_;
  if (!follows) {
    begins_ = true;
    for (Column& column : columns_) column.from = column.to = number;
  }
  end_ = number + 1;
  // Its place is that of a later one, which is known.
  if (number < first_kept(shared_->reached)) return follows;
  if (shared_->reached <= number) shared_->reached = number + 1;
  // The copy that fills in looks at `reached` after its sign, so one of the two sees the other.
  for (int n = 0; n < kPatience && number >= kRing && shared_->filling == number - kRing + 1; ++n) copies_.give_way();
  for (size_t n = 0; n < columns_.size(); ++n) {
    put(columns_[n], number, samples[n], begins_);
    columns_[n].to = std::max(columns_[n].to, end_);
  }
  begins_ = false;
  return follows;
}

void ScopeMemory::fill(size_t channel, uint64_t from, uint64_t number, int64_t sample) {
  Column column = columns_[channel];
  if (number >= column.from) return;
  column.from = from;
  column.to = number + 1;
  shared_->filling = number + 1;
  if (number >= first_kept(shared_->reached)) put(column, number, sample, number == from);
  shared_->filling = 0;
}

void ScopeMemory::filled(size_t channel, uint64_t from) {
  Column& column = columns_[channel];
  const uint64_t seam = column.from / kBlock * kBlock;
  column.from = from;
  if (seam < end_) count_block(column, std::max(seam, from), std::min(seam + kBlock, column.to));
}

void ScopeMemory::put(const Column& column, uint64_t number, int64_t value, bool begins) const {
  const Stored one = stored(column, value);
  sample(column.place, number) = one;
  const uint64_t from = number / kBlock * kBlock;
  if (begins || from == number)
    return count_block(column, std::max(from, column.from), std::max(number + 1, std::min(from + kBlock, column.to)));
  Block& all = block(column.place, number);
  all = join(column, all, {one, one});
}

void ScopeMemory::count_block(const Column& column, uint64_t from, uint64_t end) const {
  Block counted{sample(column.place, from), sample(column.place, from)};
  for (uint64_t n = from; n < end; ++n) {
    const Stored one = sample(column.place, n);
    counted = join(column, counted, {one, one});
  }
  block(column.place, from) = counted;
}

std::optional<int64_t> ScopeMemory::at(size_t channel, uint64_t number) const {
  if (number < first(channel) || number >= end_) return std::nullopt;
  return read(columns_[channel], sample(columns_[channel].place, number));
}

std::optional<ScopeMemory::Extremes> ScopeMemory::extremes(size_t channel, uint64_t begin, uint64_t end) const {
  const Column& column = columns_[channel];
  begin = std::max(begin, first(channel));
  end = std::min(end, column.to);
  if (begin >= end) return std::nullopt;
  Block found{sample(column.place, begin), sample(column.place, begin)};
  for (uint64_t n = begin; n < end;) {
    const bool whole = n % kBlock == 0 && n + kBlock <= end;
    const Stored one = sample(column.place, n);
    found = join(column, found, whole ? block(column.place, n) : Block{one, one});
    n += whole ? kBlock : 1;
  }
  return Extremes{read(column, found.least), read(column, found.greatest)};
}

}  // namespace ipos::tools::serve

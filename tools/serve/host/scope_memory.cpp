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
      memory_(room_for(copies, kHead + kMostChannels * (kRing * sizeof(int64_t) + kBlocks * sizeof(Extremes)))),
      shared_(at_byte<Shared>(0)) {}

int64_t& ScopeMemory::sample(size_t place, uint64_t number) const {
  return at_byte<int64_t>(kHead)[place * kRing + number % kRing];
}
ScopeMemory::Extremes& ScopeMemory::block(size_t place, uint64_t number) const {
  return at_byte<Extremes>(kHead + kMostChannels * kRing * sizeof(int64_t))[place * kBlocks +
                                                                              number / kBlock % kBlocks];
}

void ScopeMemory::restart(uint64_t next) {
  shared_->reached = 0;
  end_ = next;
  begins_ = true;
  for (Column& column : columns_) column.from = next;
}

void ScopeMemory::choose(const std::vector<std::optional<size_t>>& channels) {
  std::vector<Column> columns;
  std::vector<bool> taken(kMostChannels, false);
  for (const auto& channel : channels)
    if (channel) taken[columns_[*channel].place] = true;
  for (const auto& channel : channels) {
    if (channel) {
      columns.push_back(columns_[*channel]);
      continue;
    }
    const auto free = std::find(taken.begin(), taken.end(), false);
    *free = true;
    columns.push_back({static_cast<size_t>(free - taken.begin()), end_});
  }
  use(std::move(columns));
}

void ScopeMemory::use(std::vector<Column> columns) {
  columns_ = std::move(columns);
  for (Column& column : columns_) column.from = std::min(column.from, end_);
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

bool ScopeMemory::push(uint64_t number, std::span<const int64_t> samples) {
  const bool follows = number == end_;
  if (!follows) {
    begins_ = true;
    for (Column& column : columns_) column.from = number;
  }
  if (shared_->reached <= number) shared_->reached = number + 1;
  // The copy that fills in looks at `reached` after its sign, so one of the two sees the other.
  for (int n = 0; n < kPatience && number >= kRing && shared_->filling == number - kRing + 1; ++n) copies_.give_way();
  for (size_t n = 0; n < columns_.size(); ++n) put(columns_[n], number, samples[n], begins_);
  end_ = number + 1;
  begins_ = false;
  return follows;
}

void ScopeMemory::fill(size_t channel, uint64_t from, uint64_t number, int64_t sample) {
  shared_->filling = number + 1;
  if (number >= first_kept(shared_->reached)) put({columns_[channel].place, from}, number, sample, number == from);
  shared_->filling = 0;
}

void ScopeMemory::filled(size_t channel, uint64_t from) {
  Column& column = columns_[channel];
  const uint64_t seam = column.from / kBlock * kBlock;
  column.from = from;
  if (seam < end_) count_block(column.place, std::max(seam, from), std::min(seam + kBlock, end_));
}

void ScopeMemory::put(const Column& column, uint64_t number, int64_t value, bool begins) const {
  sample(column.place, number) = value;
  const uint64_t from = number / kBlock * kBlock;
  if (begins || from == number)
    return count_block(column.place, std::max(from, column.from), number + 1);
  auto& [least, greatest] = block(column.place, number);
  least = std::min(least, value);
  greatest = std::max(greatest, value);
}

void ScopeMemory::count_block(size_t place, uint64_t from, uint64_t end) const {
  Extremes counted{sample(place, from), sample(place, from)};
  for (uint64_t n = from; n < end; ++n) {
    counted.first = std::min(counted.first, sample(place, n));
    counted.second = std::max(counted.second, sample(place, n));
  }
  block(place, from) = counted;
}

std::optional<int64_t> ScopeMemory::at(size_t channel, uint64_t number) const {
  if (number < first(channel) || number >= end_) return std::nullopt;
  return sample(columns_[channel].place, number);
}

std::optional<ScopeMemory::Extremes> ScopeMemory::extremes(size_t channel, uint64_t begin, uint64_t end) const {
  const size_t place = columns_[channel].place;
  begin = std::max(begin, first(channel));
  end = std::min(end, end_);
  if (begin >= end) return std::nullopt;
  Extremes found{sample(place, begin), sample(place, begin)};
  for (uint64_t n = begin; n < end;) {
    const bool whole = n % kBlock == 0 && n + kBlock <= end;
    const Extremes of = whole ? block(place, n) : Extremes{sample(place, n), sample(place, n)};
    found = {std::min(found.first, of.first), std::max(found.second, of.second)};
    n += whole ? kBlock : 1;
  }
  return found;
}

}  // namespace ipos::tools::serve

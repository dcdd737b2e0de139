// Of each line a ring of bytes with one telegram after the other, and a ring of where each begins.
#include "tools/serve/host/trace_memory.hpp"

#include <algorithm>
#include <cstring>

namespace ipos::tools::serve {

struct TraceMemory::Head {
  uint64_t number;
  runtime::Time time;
  uint32_t took;  // ns: no telegram lasts for 4 s
  uint32_t id;
  uint16_t data, words;  // bytes after it
  uint16_t sender;
  uint8_t bus, reason;
  bool extended, remote, error;
};

void TraceMemory::restart(size_t lines) {
  if (lines == 0) return lines_.clear();
  if (!memory_) {
    room_ = kBytes / lines / 8 * 8;
    memory_ = room_for(copies_, lines * (sizeof(Shared) + kKept * sizeof(uint64_t) + room_));
  }
  lines_.assign(lines, {});
  for (size_t line = 0; line < lines; ++line) shared(line).count = shared(line).bytes = shared(line).first = 0;
}

TraceMemory::Shared& TraceMemory::shared(size_t line) const {
  return at_byte<Shared>(0)[line];
}
uint64_t& TraceMemory::begin_of(size_t line, uint64_t n) const {
  return at_byte<uint64_t>(lines_.size() * sizeof(Shared))[line * kKept + n % kKept];
}

void TraceMemory::copy_in(size_t line, uint64_t at, const void* from, size_t size) const {
  auto* const ring = at_byte<char>(lines_.size() * (sizeof(Shared) + kKept * sizeof(uint64_t)) + line * room_);
  const auto begin = static_cast<size_t>(at % room_);
  const size_t first = std::min(size, room_ - begin);
  std::memcpy(ring + begin, from, first);
  std::memcpy(ring, static_cast<const char*>(from) + first, size - first);
}
void TraceMemory::copy_out(size_t line, uint64_t at, void* to, size_t size) const {
  const auto* const ring =
      at_byte<char>(lines_.size() * (sizeof(Shared) + kKept * sizeof(uint64_t)) + line * room_);
  const auto begin = static_cast<size_t>(at % room_);
  const size_t first = std::min(size, room_ - begin);
  std::memcpy(to, ring + begin, first);
  std::memcpy(static_cast<char*>(to) + first, ring, size - first);
}

void TraceMemory::add(uint64_t number, const Telegram& telegram) {
  const size_t line = telegram.bus;
  Line& of = lines_[line];
  Head head{};
  head.number = number;
  head.time = telegram.time;
  head.took = static_cast<uint32_t>(telegram.took);
  head.id = telegram.id;
  head.sender = telegram.sender;
  head.data = static_cast<uint16_t>(telegram.data.size());
  head.words = static_cast<uint16_t>(telegram.words.size());
  head.bus = telegram.bus;
  head.reason = telegram.reason;
  head.extended = telegram.extended;
  head.remote = telegram.remote;
  head.error = telegram.error;
  Shared& all = shared(line);
  // Where it was once is a later one, which is known.
  const bool gone = of.count + kKept < all.count || of.bytes + room_ < all.bytes;
  if (!gone) {
    begin_of(line, of.count) = of.bytes;
    copy_in(line, of.bytes, &head, sizeof head);
    copy_in(line, of.bytes + sizeof head, telegram.data.data(), head.data);
    copy_in(line, of.bytes + sizeof head + head.data, telegram.words.data(), head.words);
  }
  of.bytes += sizeof head + head.data + head.words;
  ++of.count;
  all.count = std::max(all.count.load(), of.count);
  all.bytes = std::max(all.bytes.load(), of.bytes);
}

// What any copy has overwritten is gone for all of them. Those that are left follow each other.
uint64_t TraceMemory::first(size_t line) const {
  const Line& of = lines_[line];
  const uint64_t counted = shared(line).count > kKept ? shared(line).count - kKept : 0;
  uint64_t least = std::min(std::max<uint64_t>(counted, shared(line).first), of.count), end = of.count;
  const uint64_t bytes = shared(line).bytes;
  while (least < end) {
    const uint64_t middle = (least + end) / 2;
    if (begin_of(line, middle) + room_ < bytes)
      least = middle + 1;
    else
      end = middle;
  }
  return least;
}

void TraceMemory::forget_later() {
  for (size_t line = 0; line < lines_.size(); ++line) {
    Shared& all = shared(line);
    all.first = first(line);
    all.count = lines_[line].count;
    all.bytes = lines_[line].bytes;
  }
}

uint64_t TraceMemory::number(size_t line, uint64_t n) const {
  uint64_t number = 0;
  copy_out(line, begin_of(line, n), &number, sizeof number);
  return number;
}

NumberedTelegram TraceMemory::at(size_t line, uint64_t n) const {
  const uint64_t begin = begin_of(line, n);
  Head head{};
  copy_out(line, begin, &head, sizeof head);
  NumberedTelegram out{head.number, {}};
  Telegram& telegram = out.telegram;
  telegram.time = head.time;
  telegram.took = head.took;
  telegram.id = head.id;
  telegram.sender = head.sender;
  telegram.bus = head.bus;
  telegram.reason = head.reason;
  telegram.extended = head.extended;
  telegram.remote = head.remote;
  telegram.error = head.error;
  telegram.data.resize(head.data);
  telegram.words.resize(head.words);
  copy_out(line, begin + sizeof head, telegram.data.data(), head.data);
  copy_out(line, begin + sizeof head + head.data, telegram.words.data(), head.words);
  return out;
}

}  // namespace ipos::tools::serve

// The longest common subsequence of the lines that differ tells which lines are the same.
#include "tools/serve/host/running_texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <vector>

namespace ipos::tools::serve {
namespace {

constexpr size_t kMostPairs = 4'000'000;  // of lines that are compared; of larger changes only their borders count

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  for (size_t at = 0; at <= text.size();) {
    const size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    at = end + 1;
  }
  return lines;
}

using Lines = std::span<const std::string_view>;

// For each line the one it is afterwards, or nothing.
std::vector<std::optional<size_t>> matches(Lines a, Lines b) {
  std::vector<std::optional<size_t>> same(a.size());
  if (a.size() * b.size() > kMostPairs) return same;
  std::vector<std::vector<uint32_t>> length(a.size() + 1, std::vector<uint32_t>(b.size() + 1));
  for (size_t n = a.size(); n-- > 0;)
    for (size_t m = b.size(); m-- > 0;)
      length[n][m] = a[n] == b[m] ? length[n + 1][m + 1] + 1 : std::max(length[n + 1][m], length[n][m + 1]);
  for (size_t n = 0, m = 0; n < a.size() && m < b.size();)
    if (a[n] == b[m])
      same[n++] = m++;
    else if (length[n + 1][m] >= length[n][m + 1])
      ++n;
    else
      ++m;
  return same;
}

}  // namespace

void RunningTexts::restarted(Texts texts) {
  base_ = std::move(texts);
  loaded_.clear();
}

void RunningTexts::loaded(uint32_t station, Texts texts) { loaded_[station] = std::move(texts); }

std::optional<std::string> RunningTexts::text(uint32_t station, const std::string& file) const {
  const auto own = loaded_.find(station);
  const Texts* const all = own != loaded_.end() ? &own->second : base_ ? &*base_ : nullptr;
  if (all == nullptr) return files_->compiled(file);
  const auto found = all->find(file);
  return found == all->end() ? std::nullopt : std::optional(found->second);
}

// FNV-1a, 64 bits.
std::string version_of(std::string_view text) {
  uint64_t sum = 0xCBF29CE484222325;
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  return fmt::format("{:016x}", sum);
}

uint32_t line_in(std::string_view before, std::string_view after, uint32_t line) {
  const std::vector<std::string_view> old_lines = lines_of(before), new_lines = lines_of(after);
  const size_t at = line - 1;
  if (line == 0 || at >= old_lines.size()) return line;
  const size_t shorter = std::min(old_lines.size(), new_lines.size());
  size_t head = 0, tail = 0;
  while (head < shorter && old_lines[head] == new_lines[head]) ++head;
  while (tail < shorter - head && old_lines[old_lines.size() - 1 - tail] == new_lines[new_lines.size() - 1 - tail]) ++tail;
  if (at < head) return line;
  if (at >= old_lines.size() - tail) return static_cast<uint32_t>(at + new_lines.size() - old_lines.size() + 1);
  const auto same = matches(Lines(old_lines).subspan(head, old_lines.size() - tail - head),
                            Lines(new_lines).subspan(head, new_lines.size() - tail - head));
  // Between the last line before it that is still there and the next one behind it.
  size_t begin = 0, end = new_lines.size() - tail - head, distance = at - head;
  for (size_t n = 0; n < same.size(); ++n) {
    if (!same[n]) continue;
    if (n == at - head) return static_cast<uint32_t>(head + *same[n] + 1);
    if (n < at - head) {
      begin = *same[n] + 1;
      distance = at - head - n - 1;
    } else {
      end = *same[n];
      break;
    }
  }
  return static_cast<uint32_t>(head + std::min(begin + distance, end) + 1);
}

}  // namespace ipos::tools::serve

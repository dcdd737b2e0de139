// Longest common run of lines by the textbook table; what equals at both ends is taken off before.
#include "tools/build/line_diff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace ipos::tools {
namespace {

constexpr size_t kContext = 3;
constexpr size_t kMaxCells = 16U << 20U;  // of the table; beyond, the middle counts as replaced as a whole

struct Edit {
  char mark;  // ' ', '-' or '+'
  std::string_view line;
};

// Each line with its end.
std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return lines;
}

using Lines = std::vector<std::string_view>;

void compare(const Lines& a, const Lines& b, size_t first, size_t a_end, size_t b_end,
             std::vector<Edit>& out) {
  const size_t rows = a_end - first;
  const size_t columns = b_end - first;
  std::vector<uint32_t> common;  // length of the common run from (row, column) on
  const bool small = rows == 0 || columns == 0 || (rows + 1) < kMaxCells / (columns + 1);
  if (small) common.assign((rows + 1) * (columns + 1), 0);
  const auto cell = [&](size_t row, size_t column) -> uint32_t& {
    return common[row * (columns + 1) + column];
  };
  if (small)
    for (size_t row = rows; row-- > 0;)
      for (size_t column = columns; column-- > 0;)
        cell(row, column) = a[first + row] == b[first + column]
                                ? cell(row + 1, column + 1) + 1
                                : std::max(cell(row + 1, column), cell(row, column + 1));
  size_t row = 0, column = 0;
  while (row < rows || column < columns) {
    if (small && row < rows && column < columns && a[first + row] == b[first + column]) {
      out.push_back({' ', a[first + row]});
      ++row, ++column;
    } else if (row < rows &&
               (column == columns || !small || cell(row + 1, column) >= cell(row, column + 1))) {
      out.push_back({'-', a[first + row++]});
    } else {
      out.push_back({'+', b[first + column++]});
    }
  }
}

std::vector<Edit> edits(const Lines& a, const Lines& b) {
  size_t first = 0;
  while (first < a.size() && first < b.size() && a[first] == b[first]) ++first;
  size_t a_end = a.size(), b_end = b.size();
  while (a_end > first && b_end > first && a[a_end - 1] == b[b_end - 1]) --a_end, --b_end;
  std::vector<Edit> out;
  for (size_t n = 0; n < first; ++n) out.push_back({' ', a[n]});
  compare(a, b, first, a_end, b_end, out);
  for (size_t n = a_end; n < a.size(); ++n) out.push_back({' ', a[n]});
  return out;
}

// `count` lines from `first` (from 0) in the words of a hunk's head.
std::string place(size_t first, size_t count) {
  return count == 1 ? fmt::format("{}", first + 1)
                    : fmt::format("{},{}", count == 0 ? first : first + 1, count);
}

}  // namespace

std::string unified_diff(std::string_view name, std::string_view before, std::string_view after) {
  const std::vector<Edit> all = edits(lines_of(before), lines_of(after));
  std::string out;
  size_t a = 0, b = 0;  // lines before `n`
  for (size_t n = 0; n < all.size();) {
    if (all[n].mark == ' ') {
      ++n, ++a, ++b;
      continue;
    }
    if (out.empty()) out = fmt::format("--- {0}\n+++ {0}\n", name);
    const size_t lead = std::min(n, kContext);
    size_t last = n;  // the last changed line of this hunk
    for (size_t k = n; k < all.size() && k <= last + 2 * kContext + 1; ++k)
      if (all[k].mark != ' ') last = k;
    const size_t end = std::min(last + 1 + kContext, all.size());
    std::string body;
    size_t a_count = 0, b_count = 0;
    for (size_t k = n - lead; k < end; ++k) {
      a_count += all[k].mark != '+';
      b_count += all[k].mark != '-';
      body += all[k].mark;
      body += all[k].line;
      if (!all[k].line.ends_with('\n')) body += "\n\\ No newline at end of file\n";
    }
    out += fmt::format("@@ -{} +{} @@\n{}", place(a - lead, a_count), place(b - lead, b_count), body);
    a += a_count - lead;
    b += b_count - lead;
    n = end;
  }
  return out;
}

}  // namespace ipos::tools

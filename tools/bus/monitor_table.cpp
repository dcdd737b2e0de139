// Rows, their order, and how they are written.
#include "tools/bus/monitor_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "compiler/diag/places.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

constexpr std::array<const char*, 3> kOrders{"identifier", "count", "last change"};
constexpr const char* kMarked = "\033[1;33m";
constexpr const char* kPlain = "\033[0m";
constexpr size_t kBytesShown = 18;  // the longest telegram

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

std::string after_begin(Time time) {
  return fmt::format("{}.{:03}", time / runtime::kSecond, time % runtime::kSecond / runtime::kMillisecond);
}

// Milliseconds between two telegrams; nothing for the first one.
std::string period(Time gap) {
  return gap == 0 ? ""
                  : fmt::format("{}.{}", gap / runtime::kMillisecond, gap % runtime::kMillisecond / 100'000);
}

// Without the bytes of a letter that would not fit.
std::string_view cut(std::string_view text, size_t width) {
  if (text.size() <= width) return text;
  while (width > 0 && (static_cast<unsigned char>(text[width]) & 0xC0) == 0x80) --width;
  return text.substr(0, width);
}

}  // namespace

void MonitorTable::put(Time time, const std::string& bus, uint32_t number, const std::string& id,
                       std::span<const uint8_t> bytes, const std::string& text) {
  if (total_++ == 0) begin_ = time;
  Row& row = rows_[{bus, id}];
  if (row.count == 0) {
    row.bus = bus;
    row.id = id;
    row.number = number;
    row.first = time;
  } else {
    row.gap = time - row.last;
  }
  row.changed.assign(bytes.size(), false);
  for (size_t n = 0; n < bytes.size(); ++n)
    row.changed[n] = row.count != 0 && (n >= row.bytes.size() || row.bytes[n] != bytes[n]);
  row.bytes.assign(bytes.begin(), bytes.end());
  row.last = time;
  row.text = text;
  ++row.count;
}

bool MonitorTable::press(char key) {
  constexpr char kEscape = 27, kBackspace = 127;
  if (typing_) {
    if (key == '\n' || key == '\r' || key == kEscape) {
      typing_ = false;
      if (key == kEscape) filter_.clear();
    } else if (key == kBackspace || key == '\b') {
      if (!filter_.empty()) filter_.pop_back();
    } else if (key >= ' ') {
      filter_ += key;
    }
    return true;
  }
  switch (key) {
    case 'q': return false;
    case 'p':
    case ' ':
      paused_ = !paused_;
      if (paused_)
        shown_ = rows_;
      else
        shown_.clear();
      break;
    case 's': order_ = static_cast<Order>((static_cast<size_t>(order_) + 1) % kOrders.size()); break;
    case '/':
      typing_ = true;
      filter_.clear();
      break;
    case 'c': rows_.clear(); break;
    default: break;
  }
  return true;
}

bool MonitorTable::passes(const Row& row) const {
  if (filter_.empty()) return true;
  return lower(row.bus + " " + row.id + " " + row.text).find(lower(filter_)) != std::string::npos;
}

std::vector<const MonitorTable::Row*> MonitorTable::chosen() const {
  std::vector<const Row*> rows;
  for (const auto& [key, row] : paused_ ? shown_ : rows_)
    if (passes(row)) rows.push_back(&row);
  std::stable_sort(rows.begin(), rows.end(), [this](const Row* a, const Row* b) {
    if (order_ == Order::Count && a->count != b->count) return a->count > b->count;
    if (order_ == Order::Last && a->last != b->last) return a->last > b->last;
    return a->bus != b->bus ? a->bus < b->bus : a->number < b->number;
  });
  return rows;
}

std::string MonitorTable::line(const Row& row, bool colours, size_t width) const {
  std::string head = fmt::format("{:<8} {:<10} {:>7} {:>9} {:>9}  ", compiler::printable(row.bus), row.id,
                                 row.count, period(row.gap), after_begin(row.last - begin_));
  size_t used = head.size();
  for (size_t n = 0; n < std::min(row.bytes.size(), kBytesShown); ++n) {
    const bool changed = row.changed[n];
    const std::string byte = fmt::format("{:02X}", row.bytes[n]);
    if (colours)
      head += changed ? fmt::format("{}{}{} ", kMarked, byte, kPlain) : byte + " ";
    else
      head += changed ? fmt::format("[{}]", byte) : fmt::format(" {} ", byte);
    used += colours ? 3 : 4;
  }
  const size_t column =
      std::max(used, size_t{8 + 1 + 10 + 1 + 7 + 1 + 9 + 1 + 9 + 2} + 8 * (colours ? 3U : 4U));
  head.append(column - used + 1, ' ');
  if (width <= column + 1) return head;
  return head + std::string(cut(row.text, width - column - 1));
}

std::string MonitorTable::draw(size_t width, size_t height, bool colours) const {
  const std::vector<const Row*> rows = chosen();
  std::string out = std::string(cut(fmt::format("{:<8} {:<10} {:>7} {:>9} {:>9}  {}", "bus", "id", "count",
                                                "ms", "at s", "bytes"),
                                    width)) +
                    '\n';
  constexpr size_t kOtherLines = 2;
  size_t left = height == 0 ? rows.size() : height > kOtherLines ? height - kOtherLines : 0;
  for (const Row* row : rows) {
    if (left-- == 0) break;
    out += line(*row, colours, width) + '\n';
  }
  std::string foot = fmt::format("{} telegrams, {} of {} rows, sorted by {}{}", total_, rows.size(),
                                 (paused_ ? shown_ : rows_).size(), kOrders[static_cast<size_t>(order_)],
                                 paused_ ? ", PAUSED" : "");
  if (typing_ || !filter_.empty()) foot += fmt::format(", filter /{}{}", filter_, typing_ ? "_" : "");
  if (!told_.empty()) foot += "; " + told_;
  return out + std::string(cut(foot, width));
}

}  // namespace ipos::tools

// The monitor as a table: a row an identifier, or a kind of telegram of a serial line, with how often and how
// far apart it comes, its last bytes with the changed ones marked, and its words. Times are relative to the
// first telegram. Keys filter, pause and sort (docs/guide/bus-tools.md).
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::tools {

class MonitorTable {
 public:
  enum class Order : uint8_t { Identifier, Count, Last };

  // `id` is what stands in front: "20B", "line1 -> 5"; rows sort by `number` within a bus.
  void put(runtime::Time time, const std::string& bus, uint32_t number, const std::string& id,
           std::span<const uint8_t> bytes, const std::string& text);
  // What the line lost, errors of the bus: the last one is shown below the table.
  void tell(const std::string& text) { told_ = text; }

  // A key; false: the user wants to end.
  bool press(char key);
  bool paused() const { return paused_; }

  // As it stands, in lines of at most `width` letters; `height` lines at most, 0: all of it. With colours the
  // changed bytes stand out, else they are in brackets.
  std::string draw(size_t width, size_t height, bool colours) const;

 private:
  struct Row {
    std::string bus, id, text;
    uint32_t number = 0;
    uint64_t count = 0;
    runtime::Time first = 0, last = 0;
    runtime::Time gap = 0;  // before the last one
    std::vector<uint8_t> bytes;
    std::vector<bool> changed;
  };

  bool passes(const Row& row) const;
  std::vector<const Row*> chosen() const;
  std::string line(const Row& row, bool colours, size_t width) const;

  std::map<std::pair<std::string, std::string>, Row> rows_;   // by bus and id
  std::map<std::pair<std::string, std::string>, Row> shown_;  // while it is paused
  runtime::Time begin_ = 0;
  uint64_t total_ = 0;
  Order order_ = Order::Identifier;
  bool paused_ = false;
  bool typing_ = false;  // of the filter
  std::string filter_;
  std::string told_;
};

}  // namespace ipos::tools

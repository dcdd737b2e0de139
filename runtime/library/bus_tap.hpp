// The library's ear and mouth on the lines of a plant: what a line carries is kept until somebody takes it, and a station
// of its own sends. On a CAN line it listens only until it joins, so that who only looks changes nothing.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/profibus/line.hpp"
#include "runtime/plant/actions.hpp"

namespace ipos::library {

using runtime::NodeId;
using runtime::Refusal;
using runtime::Time;

inline constexpr size_t kKept = 100'000;  // frames or telegrams of a line; older ones are thrown away

// The last ones of something that is taken from the front.
template <typename Item>
class Kept {
 public:
  void put(Item item) {
    if (items_.size() == kKept) {
      items_.pop_front();
      ++lost_;
    }
    items_.push_back(std::move(item));
  }
  std::optional<Item> take() {
    if (items_.empty()) return std::nullopt;
    Item item = std::move(items_.front());
    items_.pop_front();
    return item;
  }
  bool empty() const { return items_.empty(); }
  uint64_t lost() const { return lost_; }

 private:
  std::deque<Item> items_;
  uint64_t lost_ = 0;
};

struct Heard {
  Time time = 0;
  runtime::Frame frame;
  NodeId sender = runtime::kNoNode;
  uint32_t tag = 0;
  bool own = false;
  bool error = false;  // frame.id has the classes of SocketCAN
};

class CanTap final : private runtime::CanObserver, private runtime::CanNode {
 public:
  explicit CanTap(runtime::CanLine& line);
  CanTap(const CanTap&) = delete;
  CanTap& operator=(const CanTap&) = delete;

  void join();
  Refusal send(const runtime::Frame& frame, uint32_t tag);
  bool is_full() const { return queued_ >= runtime::kSendQueueLimit; }
  Kept<Heard>& heard() { return heard_; }
  const Kept<Heard>& heard() const { return heard_; }
  runtime::CanLine& line() { return line_; }
  const runtime::CanLine& line() const { return line_; }

 private:
  void on_frame(const runtime::CanLine&, const runtime::FrameRecord& record) override;
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent& event) override;
  void on_frame(Time, const runtime::Frame&) override {}
  void on_sent(Time, const runtime::Frame&, uint64_t) override { leave_queue(); }
  bool minds_repeats() const override { return false; }
  void on_not_sent(Time, const runtime::Frame&, uint64_t, runtime::NotSent why) override {
    if (why == runtime::NotSent::Dropped) leave_queue();  // for every other reason it is tried again
  }
  // At bus-off all are dropped, also the one on the wire, which may be carried to its end all the same.
  void leave_queue() { queued_ -= queued_ == 0 ? 0 : 1; }
  void on_bus_off(Time) override { line_.recover(*node_); }

  runtime::CanLine& line_;
  std::optional<NodeId> node_;
  size_t queued_ = 0;  // of what was sent here: neither on the line nor given up yet
  std::deque<std::pair<runtime::Frame, uint32_t>> waiting_;  // with their tags
  Kept<Heard> heard_;
};

class SerialTap final : private runtime::SerialObserver, private runtime::SerialNode {
 public:
  static constexpr size_t kLongest = 1000;  // bytes in one sending (ours)

  explicit SerialTap(runtime::Rs485Line& line);
  SerialTap(const SerialTap&) = delete;
  SerialTap& operator=(const SerialTap&) = delete;

  Refusal send(std::span<const uint8_t> bytes);
  Kept<runtime::Reception>& heard() { return heard_; }
  const Kept<runtime::Reception>& heard() const { return heard_; }
  const runtime::Rs485Line& line() const { return line_; }

 private:
  void on_character(const runtime::Rs485Line&, NodeId, const runtime::Character& character) override;
  void on_serial_event(const runtime::Rs485Line&, const runtime::SerialEvent&) override {}
  void on_character(Time, const runtime::Character&) override {}
  void on_sent(Time) override {}

  runtime::Rs485Line& line_;
  std::optional<NodeId> node_;
  runtime::SerialReceiver receiver_;
  Kept<runtime::Reception> heard_;
};

class ProfibusTap final : private profibus::LineObserver, private profibus::Node {
 public:
  static constexpr size_t kLongest = 300;  // octets in one sending (ours); a frame has 255 at most

  explicit ProfibusTap(profibus::Line& line);
  ProfibusTap(const ProfibusTap&) = delete;
  ProfibusTap& operator=(const ProfibusTap&) = delete;

  // After the idle time that a request wants; into a frame that is under way.
  Refusal send(std::span<const uint8_t> octets);
  Kept<profibus::Reception>& heard() { return heard_; }
  const Kept<profibus::Reception>& heard() const { return heard_; }
  const profibus::Line& line() const { return line_; }

 private:
  void on_frame(const profibus::Line&, NodeId sender, const profibus::Reception& reception) override;
  void on_line_event(const profibus::Line&, const profibus::LineEvent&) override {}
  void on_reception(Time, const profibus::Reception&) override {}
  void on_sent(Time) override {}

  profibus::Line& line_;
  std::optional<NodeId> node_;
  Kept<profibus::Reception> heard_;
};

}  // namespace ipos::library

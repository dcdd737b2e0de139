// A CAN line in integer bit times: arbitration, acknowledge, error frames, retransmission and load (ISO
// 11898-1).
//
// Bit n begins at n times the bit time. A frame queued at time t takes part in the arbitration at the first
// bit boundary after t (ours); if the line is busy then, at the end of the intermission. A frame is
// delivered, and its sending confirmed, at the end of the last bit of its end-of-frame field: observers
// first, then the receivers in order of attachment, then the sender. A cut line has segments, each a line of
// its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/can/contenders.hpp"
#include "runtime/bus/can/error_counters.hpp"
#include "runtime/bus/can/known_frames.hpp"
#include "runtime/bus/can/line_fault.hpp"
#include "runtime/bus/can/node.hpp"
#include "runtime/bus/can/node_set.hpp"
#include "runtime/bus/can/repeats.hpp"
#include "runtime/bus/can/standing_frames.hpp"
#include "runtime/bus/can/transfer.hpp"
#include "runtime/bus/line/line_load.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

// P816 (1053 1610 p. 41).
inline constexpr std::array<uint32_t, 4> kBaudRates = {125'000, 250'000, 500'000, 1'000'000};
bool is_baud_rate(uint32_t baud);

inline constexpr size_t kSendQueueLimit = 64;  // waiting frames of one node (ours)

class CanLine final : private EventTarget {
 public:
  // `source` orders the line's events among those of equal time. `baud` must be one of kBaudRates.
  CanLine(EventQueue& queue, uint32_t source, std::string name, uint32_t baud);

  // Nodes are attached before the first event runs, in the order in which they sit on the cable; one that comes
  // later, between two events, is plugged in at its end. A node of another rate understands nobody and destroys the
  // frames of the others, and the observers hear why.
  NodeId attach(std::string name, uint32_t baud, CanNode& node);
  void add_observer(CanObserver& observer);
  void add_observer(LineObserver& observer);

  // From now on the node is told only of data and remote frames with the standard identifiers it listens to,
  // and of all extended ones. Frames it is not told of count and are acknowledged like the others.
  void close_filter(NodeId node) { filter_.close(node); }
  void listen(NodeId node, uint32_t id) {
    if (id < kStandardIdLimit) filter_.open(node, id);
  }

  // The node may be skipped for this frame until it asks again or another frame with the identifier has come.
  // Optional: telling it anyway is harmless.
  void rest(NodeId node, const Frame& frame) { known_.rest(node, frame); }
  void want_again(NodeId node, uint32_t id) { known_.want_again(node, id); }

  // `overtakes`: those of the node with this tag that still wait are withdrawn.
  SendStatus send(NodeId node, const Frame& frame, uint64_t tag, bool overtakes = false) {
    return is_valid(frame) ? send_canonical(node, canonical(frame), tag, overtakes) : SendStatus::InvalidFrame;
  }
  // The same of a valid frame that is canonical(), as one that is sent again is.
  SendStatus send_canonical(NodeId node, const Frame& frame, uint64_t tag, bool overtakes = false);
  void withdraw(NodeId node, uint64_t tag);
  // What stations at rest leave to the line.
  StandingFrames& standing() { return standing_; }

  bool has_waiting(NodeId node) const { return !nodes_[node].queue.empty(); }  // frames, or one on the wire

  void set_baud(NodeId node, uint32_t baud);
  void set_connected(NodeId node, bool connected);
  void replace(NodeId node, CanNode& by);  // the station behind it has been rebuilt
  void restart(NodeId node);               // leaves bus-off at once with cleared counters
  // Leaves bus-off once the node has seen 128 times 11 recessive bits in a row (ISO 11898-1).
  void recover(NodeId node);

  // A controller outside of the line tells its error state; what the line has counted of it is forgotten.
  void tell_error_state(NodeId node, ErrorState state);
  // Its controller is outside and counts by itself: at another rate it takes no part, and disturbs nobody.
  void stand_outside(NodeId node) { nodes_[node].outside = true; }
  // Another rate for all who have that of the line. False: frames have been sent already, or wait.
  bool set_line_baud(uint32_t baud);

  // Plants a fault; its node must be attached. A cut waits for the end of the frames under way, its repair
  // also (ours).
  void plant(const LineFault& fault);
  // Ends those of this kind, node and identifier that have begun and would last for ever; false: there are none.
  bool repair(const LineFault& like);

  // The plain run: each repetition of a frame that nobody acknowledges is sent in its turn (line_repeats.cpp).
  void repeat_in_turn() { in_turn_ = true; }

  const std::string& name() const { return name_; }
  uint32_t baud() const { return baud_; }
  Time bit_time() const { return bit_time_; }
  size_t node_count() const { return nodes_.size(); }
  const std::string& node_name(NodeId node) const { return nodes_[node].name; }
  uint32_t node_baud(NodeId node) const { return nodes_[node].rate(); }
  const ErrorCounters& counters(NodeId node) const { return nodes_[node].counters; }
  bool is_active(NodeId node) const {  // right rate, connected, not bus-off
    return is_active(nodes_[node]);
  }
  bool is_reachable(NodeId from, NodeId to) const;  // both active, and no cut between them
  LineLoad load(Time now) const;
  // When the frame ends that begins next; nothing where more than its length decides that, or nobody wants to send.
  std::optional<Time> plain_end();

 private:
  struct Pending {
    Frame frame;
    uint64_t tag : 62;
    uint64_t on_wire : 1 = 0;
    uint64_t withdrawn : 1 = 0;  // while on the wire
    uint64_t ready_bit;          // takes part in arbitration from here on

    Pending(const Frame& sent, uint64_t its_tag, uint64_t ready)
        : frame(sent), tag(its_tag & kTagMask), ready_bit(ready) {}
    uint32_t key() const { return arbitration_key(frame); }
  };
  static constexpr uint64_t kTagMask = (uint64_t{1} << 62) - 1;
  struct alignas(64) Node {
    // What every frame asks for stands in one line of memory.
    CanNode* node = nullptr;
    std::vector<Pending> queue;    // by key, equal keys in order of sending
    uint64_t suspended_until = 0;  // an error-passive sender pauses 8 bits
    ErrorCounters counters;
    uint32_t segment = 0;
    uint32_t recovery_runs = 0;   // of 11 recessive bits, still wanted on the way back from bus-off
    bool wired = false;           // connected as it should be, with the rate of the line
    bool unacknowledged = false;  // since its last frame that got through; reported once

    bool connected = true;
    bool swapped = false;  // high and low interchanged
    bool outside = false;  // stand_outside()
    bool told_stranger = false;
    uint32_t baud = 0;
    uint32_t fault_baud = 0;  // of a planted fault, in place of its own; 0: none
    uint64_t recovery_from = 0;  // bits before this one do not count
    EventId recovery = kNoEvent;
    std::string name;

    uint32_t rate() const { return fault_baud != 0 ? fault_baud : baud; }
  };
  static constexpr uint32_t kSuspendBits = 8;     // pause of an error-passive sender after a transmission
  static constexpr uint32_t kRecessiveTail = 11;  // every transfer ends with delimiter bits and intermission
  static constexpr uint64_t kBusy = 0, kNoBit = ~uint64_t{0};
  struct Segment {
    uint64_t start_bit = kNoBit;  // when the next transfer begins; kBusy: one is under way
    uint64_t free_bit = 0;        // first bit after the last intermission
    uint64_t recessive_from = 0;
    EventId start_event = kNoEvent;
    Transfer transfer;

    bool busy() const { return start_bit == kBusy; }
    void end_at(uint64_t bit) {  // of the intermission
      free_bit = bit;
      recessive_from = bit - kRecessiveTail;
    }
  };
  struct LateFrame {
    Frame frame;
    NodeId sender;
    NodeId only;  // kNoNode: all of the segment
    uint32_t segment;
  };

  // line.cpp: frames
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void begin_and_end(uint32_t segment, bool begins);
  static bool is_active(const Node& node) {
    return node.wired && node.counters.state() != ErrorState::BusOff;
  }
  // On the wires, but not as one of the line.
  static bool is_stranger(const Node& node) { return node.connected && !node.wired && !node.outside; }
  static bool takes_bus(const Node& node) {
    return node.connected && (node.wired || !node.outside) && node.counters.state() != ErrorState::BusOff;
  }
  NodeId plain_sender(uint64_t bit);
  bool pass_plain(uint64_t bit);
  void begin_plain(NodeId id, uint64_t bit);
  void note_plain(NodeId id, const Frame& frame, uint64_t tag, uint64_t bit, uint32_t bits);
  void end_plain(const FrameRecord& record, uint64_t begin, uint64_t tag, const KnownFrames::Known& known);
  bool begin_transfer(uint32_t segment, uint64_t bit);
  Listeners listeners_of(uint32_t segment) const;
  bool find_sound();
  void release(Segment& segment, uint64_t begin, uint32_t bits);
  void report_frame(const FrameRecord& record);
  void settle_line();
  void end_transfer(Time now, uint32_t segment);
  void deliver(Time now, const Segment& segment, NodeId listener);
  void settle_sender(Time now, const Segment& segment, const Transfer::Sender& sender);
  void count_error_state(Time now, NodeId node, ErrorState before);
  uint64_t next_start(uint32_t segment) const;
  void schedule_start();
  void schedule_start(uint32_t segment);
  void cancel_start(Segment& segment) {
    queue_.cancel(segment.start_event);
    segment.start_bit = kNoBit;
  }
  static const Pending* first_ready(const Node& node, uint64_t bit);
  uint64_t next_ready(const Node& node) const;
  void queue_changed(NodeId node);
  void deliver_clean(Time now, const Segment& segment, uint64_t resting);
  void queue_behind(NodeId node, const Pending& pending);
  void drop_queue(NodeId node);

  // line_repeats.cpp: many repetitions of a frame that nobody acknowledges at once
  bool begin_repeats(uint64_t bit);
  uint64_t passed_bit() const;
  void wake() {  // before anything of the line changes
    if (repeats_.any()) catch_up();
  }
  void catch_up();
  // line_strangers.cpp: who is on the wires and does not belong there
  void find_strangers();
  uint64_t next_stranger(uint32_t segment) const;
  bool stranger_sends(uint32_t segment, uint64_t bit) const;
  void meet_strangers(uint32_t segment, uint64_t bit, const Listeners& listeners);
  void settle_strangers(Time now, uint32_t segment);

  // line_wiring.cpp: who takes part
  void wire(Node& node) {
    node.wired = node.connected && !node.swapped && node.rate() == baud_;
    sound_ = false;
  }
  void rewire(NodeId node);
  void switch_fault(Time now, size_t fault, bool on);
  void rebuild_segments();
  void deliver_late(Time now, size_t number);
  void pause_recovery(uint32_t segment, uint64_t bit);
  void schedule_recovery(NodeId node);
  void finish_recovery(Time now, NodeId node);

  // line_report.cpp: what observers and users hear
  void report(const LineEvent& event);
  void report_absence(NodeId node, LineObserver* only);
  void report_error(const FrameRecord& frame, bool unacknowledged);

  EventQueue& queue_;
  uint32_t source_;
  std::string name_;
  uint32_t baud_;
  Time bit_time_;
  std::vector<Node> nodes_;
  Contenders contenders_;        // queue_changed() keeps them up to date; all of them are active
  std::vector<NodeId> winners_;  // of an arbitration
  std::vector<NodeId> strangers_;  // in order of attachment; their frames are no contenders
  AcceptanceFilter filter_;
  NodeSet erring_;           // receive counter not 0
  bool recovering_ = false;  // some node may be
  // No fault is planted, no node recovers, none is a stranger, and every sender is acknowledged. False: not known yet.
  bool sound_ = false;
  std::vector<LineObserver*> observers_;
  std::vector<CanObserver*> frame_observers_;  // those of them who look at frames
  std::vector<Segment> segments_{1};
  KnownFrames known_;

  LineFaults faults_;
  std::vector<NodeId> cuts_;  // behind these nodes
  bool rewire_ = false;       // cuts_ has changed, the segments have not
  uint32_t shorts_ = 0;
  uint32_t stuck_ = 0;
  std::vector<std::optional<LateFrame>> late_;

  Repeats repeats_;
  bool in_turn_ = false;
  StandingFrames standing_{queue_, *this};

  uint64_t frames_ = 0;
  LoadMeter meter_;
};

// The sending half of an attached node.
class LinePort final : public FrameSender {
 public:
  LinePort(CanLine& line, NodeId node) : line_(&line), node_(node) {}
  SendStatus send(const Frame& frame, uint64_t tag) override { return line_->send(node_, frame, tag); }
  void withdraw(uint64_t tag) override { line_->withdraw(node_, tag); }
  void send_latest(const Frame& frame, uint64_t tag) override { line_->send(node_, frame, tag, true); }
  void recover() override { line_->recover(node_); }
  void listen(uint32_t id) override { line_->listen(node_, id); }
  NodeId node() const { return node_; }

 private:
  CanLine* line_;
  NodeId node_;
};

// One line of text for the user, with names, identifier and baud rates.
std::string describe(const CanLine& line, const LineEvent& event);

}  // namespace ipos::runtime

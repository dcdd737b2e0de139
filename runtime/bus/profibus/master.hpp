// A model master of class 1 on a PROFIBUS line: token ring with one or more masters, GAP poll, repetitions,
// and the slaves of its configuration in turn. All times are bit times of the line.
//
// With the token it sends each slave one request, then the Global_Controls that wait, polls one address of its
// GAP every few rotations, and passes the token on, alone on the line to itself.
#pragma once

#include <bitset>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "runtime/bus/profibus/line.hpp"
#include "runtime/bus/profibus/slave_handler.hpp"
#include "runtime/clock/event_queue.hpp"

namespace ipos::profibus {

struct MasterSettings {
  uint8_t address = 1;
  uint8_t highest = kLastStation;   // HSA, the end of the GAP
  uint32_t retries = 1;             // of an unanswered request
  uint32_t gap_factor = 10;         // rotations from one GAP poll to the next; 0: none
  Bits slot = 0;                    // TSL; 0: that of the rate
  Bits idle_1 = 37;                 // TID1, from an answer to what comes next; 33 bits of SYN follow
  Bits idle_2 = 150;                // TID2, from a token or a request without answer
  Time rotation = runtime::kNever;  // TTR: a longer rotation leaves one request a token
};

class MasterClient {
 public:
  // All slaves have had their turn; what is set now goes out in the next cycle.
  virtual void on_cycle(Time now) = 0;

 protected:
  ~MasterClient() = default;
};

class Master final : public Node, private runtime::EventTarget {
 public:
  Master(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name, MasterSettings settings,
         MasterClient* client = nullptr);
  ~Master() { queue_.cancel_all(*this); }
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;

  size_t add_slave(SlavePlan plan);  // before start()
  void add_partner(MasterPartner& partner) { partners_.push_back(&partner); }  // it must outlive the master
  SlaveHandler& slave(size_t n) { return slaves_[n]; }

  void start();
  void stop();  // falls silent, with the token or without
  void control(GlobalCommand command) { controls_.push_back(command); }

  bool in_ring() const { return in_ring_; }
  uint8_t next_station() const { return next_; }
  NodeId node() const { return node_; }
  uint64_t cycles() const { return cycles_; }
  Bits cycle_bits() const { return cycle_bits_; }  // of the last cycle, from token to token
  uint64_t repetitions() const { return repetitions_; }

  void on_reception(Time now, const Reception& reception) override;
  void on_sent(Time now) override;

 private:
  enum class State : uint8_t {
    Off,
    Listening,
    Idle,
    Holding,
    AwaitAnswer,
    AwaitStatus,
    Claiming,
    PassingToken
  };

  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void arm(Bits at);
  void listen();
  void await_silence();
  void silence_over();
  void slot_over();

  void take_token(Bits from);
  void work(Bits from);
  bool send_slave_request(Bits from);
  bool send_control(Bits from);
  bool send_gap_poll(Bits from);
  void pass_token(Bits from);
  void send(State then, Bits from, FdlFrame frame);
  void repeat_or_give_up();

  void hear_token(const FdlFrame& token);
  void hear_request(const FdlFrame& request);
  void hear_answer(const FdlFrame& answer);
  void hear_garbage();
  uint8_t next_in_list() const;
  void set_next(uint8_t address);

  runtime::EventQueue& queue_;
  uint32_t source_;
  Line& line_;
  NodeId node_;
  MasterSettings settings_;
  MasterClient* client_;
  std::deque<SlaveHandler> slaves_;
  std::vector<MasterPartner*> partners_;  // all whom it asks, in turn
  std::deque<GlobalCommand> controls_;

  State state_ = State::Off;
  FdlFrame sent_;          // last, for repetitions
  uint32_t attempts_ = 0;  // of it
  runtime::EventId timer_ = runtime::kNoEvent;

  bool in_ring_ = false;
  bool ready_ = false;            // for the ring: has listened long enough
  std::bitset<kBroadcast> list_;  // of active stations (LAS), as tokens show them
  uint8_t next_ = 0;              // NS
  FdlFrame watched_;              // the token by which rotations are counted while listening
  uint32_t rotations_heard_ = 0;

  size_t turn_ = 0;      // partner whose turn it is
  bool worked_ = false;  // a request in this token
  bool gap_polled_ = false;
  uint32_t rotations_ = 0;  // since the last GAP poll
  uint8_t gap_ = 0;         // address polled last
  Time token_at_ = 0;
  Time hold_until_ = runtime::kNever;
  Bits cycle_from_ = 0;
  Bits cycle_bits_ = 0;
  uint64_t cycles_ = 0;
  uint64_t repetitions_ = 0;
};

}  // namespace ipos::profibus

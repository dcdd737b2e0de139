// ISYNC, internal synchronous operation: where the master is, from its positions that come with the sync
// telegrams of the SBus (MDX60B/61B chapter 5.5.4; the manuals name the function only, all rules are ours and
// in docs/inside/positioning.md). Between two telegrams the master is taken to go on as in the last cycle.
#pragma once

#include <cstdint>
#include <type_traits>

#include "runtime/positioning/fixed_point.hpp"

namespace ipos::runtime {

struct MasterInputs {
  bool follow = false;   // the program wants it, and it is possible
  bool catch_up = false;  // and makes up for the way that it loses while it couples
  bool sync = false;     // a sync telegram has come since the last millisecond
  int32_t position = 0;  // of the master, as the slave has it
  // Way of the slave for a way of the master: slave / master.
  int32_t gear_master = 1;
  int32_t gear_slave = 1;
  bool operator==(const MasterInputs&) const = default;
};

enum class FollowState : uint8_t { Free = 0, Coupling = 1, Synchronous = 2 };

class Follower {
 public:
  // A millisecond of the master.
  void tick(const MasterInputs& inputs) {
    if (inputs.sync) take(inputs.position);
    if (syncs_ != 0) advance(inputs);
  }

  // Cycle and speed are known, and the last telegram is not too old.
  bool known() const { return syncs_ == kEnough; }
  bool silent() const { return syncs_ == 0; }
  // What the master moved on in this millisecond, in increments of the slave; at most 2^32.
  Fine step() const { return step_; }
  bool operator==(const Follower&) const = default;

 private:
  static constexpr int kEnough = 3;  // telegrams: two make a speed, the third one ends their cycle
  static constexpr int kLost = 3;    // cycles without a telegram

  void take(int32_t position);
  void advance(const MasterInputs& inputs);
  static Wide scaled(Fine way, const MasterInputs& inputs);

  int32_t syncs_ = 0;
  int32_t last_ = 0;      // position of the last telegram
  int64_t reported_ = 0;  // the same, without wrapping
  int32_t since_ = 0;     // ms since it came
  int32_t cycle_ = 1;     // ms between the last two
  // In this cycle the master goes from here to there.
  Fine from_ = 0;
  Fine to_ = 0;
  Fine path_ = 0;
  Fine step_ = 0;
};

static_assert(std::is_trivially_copyable_v<Follower>, "a copy is a snapshot");

}  // namespace ipos::runtime

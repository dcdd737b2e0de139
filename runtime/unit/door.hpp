// The only way into a unit from outside: buses, surroundings, tools. Who goes in finds it at the present.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/pace/pacer.hpp"
#include "runtime/unit/many_ticks.hpp"
#include "runtime/unit/unit.hpp"

namespace ipos::runtime {

class Door final {
 public:
  Door(Unit& unit, ManyTicks& ticks, Pacer& pacer) : unit_(unit), ticks_(ticks), pacer_(pacer) {}

  // To read: everything is as it is now.
  const Unit& look() const {
    pacer_.catch_up();
    return unit_;
  }
  // To write: the same, and the next tick finds what was written.
  Unit& touch() const {
    pacer_.touch();
    return unit_;
  }
  // To read, for who comes after the tick of this moment: an event of the unit's own that is less than a millisecond old, such as
  // an answer.
  const Unit& look_after_tick() const {
    pacer_.catch_up_after_tick();
    return unit_;
  }
  // To write what no tick minds as long as the unit only counts or moves on: everything is as it is now, and the next ticks stay as
  // they were found. Null: the unit does more; touch().
  Unit* while_it_goes_on() const {
    pacer_.catch_up();
    return ticks_.goes_on() ? &unit_ : nullptr;
  }

  // A SYNC came, and its process data have been taken. Only who follows a master, or the SYNC itself, minds.
  void synchronize(Time now) const {
    Unit* const going_on = while_it_goes_on();
    (going_on != nullptr ? *going_on : touch()).server().synchronize(now);
    if (unit_.server().follows_sync()) pacer_.align(kBehindSync, kMostShift);
  }

  // Ticks are still to be executed.
  bool is_behind() const { return pacer_.behind(); }
  // Grows with each millisecond that has executed more than counting.
  uint32_t executed() const { return unit_.executed(); }
  // Its milliseconds, which may not be those of the plant.
  const OwnMilliseconds& milliseconds() const { return unit_.milliseconds(); }
  // PI words that may change in the others, PI1 in bit 0.
  uint16_t counting_words() const { return unit_.drive().counting_words(); }
  // There is something to tell about what telegrams wanted.
  bool has_reasons() const { return unit_.server().has_reasons(); }

  // --- for telegrams of variables, which come often ---
  // A telegram that only writes variables waits for its reader; false: it must be read at once.
  bool post(TelegramReader& reader, size_t number, const TelegramData& data) const {
    return pacer_.post(reader, number, data);
  }
  // The variables as program and unit have left them by now; none of a unit without IPOS.
  std::span<const int32_t> variables() const {
    pacer_.execute_pending();
    if (!ticks_.shows_variables()) ticks_.settle();
    return unit_.variables();
  }
  // They stay as they are until somebody writes, or the port wants repeated frames again.
  bool variables_rest() const { return pacer_.rests(); }
  // After variables(): to write this one and the next.
  std::span<int32_t> variables_to_write(uint32_t first) const {
    const bool ahead = pacer_.behind() || ticks_.mode() == ManyTicks::Mode::Moving;  // it goes on with other variables
    if (!ahead || ticks_.minds(first)) return touch().variables();
    return unit_.variables();
  }
  // To read what has waited, in its turn.
  std::span<int32_t> variables_in_turn() const { return unit_.variables(); }

 private:
  // What a SYNC has brought counts in the millisecond behind it, which a SYNC shifts as much as a quartz that is wrong by 1000 ppm
  // loses between two that are 20 ms apart (both ours).
  static constexpr Time kBehindSync = 250 * kMicrosecond, kMostShift = 20 * kMicrosecond;

  Unit& unit_;
  ManyTicks& ticks_;
  Pacer& pacer_;
};

}  // namespace ipos::runtime

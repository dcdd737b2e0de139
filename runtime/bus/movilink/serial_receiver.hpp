// Characters to telegrams: the receiver that slave, master and monitor share, on a simulated line and at a
// real port (1053 1610 p. 19 and 27-28). It knows no clock: each character brings its times along.
//
// A telegram begins with SD1 or SD2 after a pause of at least 3.44 ms; no gap within it is longer than 3.43
// ms (MDX60B/61B p. 18-20; a gap between the two voids a telegram and starts none). After an error the rest
// is skipped until the next pause. A telegram is complete with its BCC.
#pragma once

#include <array>
#include <optional>

#include "runtime/bus/movilink/serial_telegram.hpp"
#include "runtime/bus/rs485/character.hpp"

namespace ipos::runtime {

// A telegram, or what came of one.
struct Reception {
  tl::expected<SerialTelegram, SerialError> telegram;
  SerialBytes bytes;  // up to the end or the error
  Time start = 0;     // of the first start bit
  Time end = 0;       // of the last stop bit
};

// How often each error came.
class SerialStatistics {
 public:
  void count(SerialError error) { ++counts_[static_cast<size_t>(error)]; }
  uint32_t of(SerialError error) const { return counts_[static_cast<size_t>(error)]; }

 private:
  std::array<uint32_t, kSerialErrors> counts_{};
};

class SerialReceiver {
 public:
  // The next character; what it completes or voids. When a character voids a telegram by its gap and begins
  // another one, the void one is returned.
  std::optional<Reception> take(const Character& character);

  // The line was busy with something the receiver did not hear (its own station sent) until `end`.
  void occupied(Time end);

  // A telegram under way is void if no character has begun until then; kNever when there is none.
  Time deadline() const { return receiving() ? quiet_since_.value() + kCharacterGap : kNever; }
  std::optional<Reception> give_up();

  bool receiving() const { return bytes_.size > 0; }
  Time start() const { return start_; }  // of the telegram under way

 private:
  void begin(const Character& character);
  Reception end(tl::expected<SerialTelegram, SerialError> telegram, bool skip);

  std::optional<Time> quiet_since_;  // nothing: the line has been quiet for ever
  SerialBytes bytes_;                // of the telegram under way
  Time start_ = 0;
  bool skip_ = false;  // until the next pause
};

}  // namespace ipos::runtime

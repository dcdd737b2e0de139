// Warns of what wears out the non-volatile memory: cyclic storing. The manuals forbid it (1053 1610 p. 31)
// and give a life of 100 000 writes (MOVITRAC 07 chapter 5); from which rate on it counts as cyclic is ours.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::runtime {

inline constexpr uint32_t kEepromLife = 100'000;
inline constexpr size_t kCyclicWrites = 10;  // of one index, within:
inline constexpr Time kCyclicSpan = 60 * kSecond;

// How long the memory lasts at one write every `interval`: "34.7 days".
std::string memory_life(Time interval);

class WearWatch {
 public:
  // A write of `index`, which has been stored `total` times in its life. A warning when it is the write that
  // makes it cyclic, or the one that ends the life; each once since power-on.
  std::optional<std::string> note(Time now, uint16_t index, uint32_t total, std::string_view name);

  // What was stored more than once since power-on, in the order of the indices.
  struct Use {
    uint16_t index;
    size_t writes;
    Time interval;  // on average
  };
  std::vector<Use> uses() const;

 private:
  struct Recent {
    std::array<Time, kCyclicWrites> times{};  // a ring
    size_t count = 0;
    Time first = 0;
    bool told = false;
  };
  std::map<uint16_t, Recent> recent_;
};

}  // namespace ipos::runtime

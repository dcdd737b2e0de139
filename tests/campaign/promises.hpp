// What a plant in trouble still has to keep, whatever happened to it: a telegram arrives whole or not at all, an exchange
// ends, and a plant does not grow without end. For the first, each plant gets a pair of stations that nobody else talks to.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "runtime/plant/plant.hpp"

namespace ipos::tests {

// The object number of the pair, which is its identifier on the line; hostile peers leave it alone.
inline constexpr int kPairObject = 1301;
inline constexpr int kPairStations = 2;

// Two stations on the bus `can`. The first sends a number and three times this number in one telegram; its program sets both
// by one command. The second one has a receive object for them.
struct Pair {
  std::string stations;                         // tables of the plant file
  std::map<std::string, std::string> programs;  // by file name
};
Pair make_pair_at(std::string_view baud);  // "500000"

// Nothing, or what the second station has of a telegram that is not whole.
std::optional<std::string> torn_telegram(const runtime::Plant& plant);

// Which tasks of a plant wait for the answer to a _MoviLink, and since how many commands of theirs.
class Exchanges {
 public:
  explicit Exchanges(const runtime::Plant& plant);
  // Nothing, or a task that is still waiting in the same exchange.
  std::optional<std::string> same_as(const Exchanges& before) const;

 private:
  std::map<std::string, uint64_t> waiting_;  // commands executed, by station and context
};

// Bytes of the heap that are in use. 0 with a sanitizer, which has a heap of its own.
size_t heap_bytes();

}  // namespace ipos::tests

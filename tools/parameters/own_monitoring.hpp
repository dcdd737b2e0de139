// The net under everything that moves a drive over a line: the drive's own monitoring of process data. Which parameter
// says how long the words of a line may stay away, which one says what then happens, and which words need it at all.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "tools/parameters/parameter_access.hpp"

namespace ipos::tools {

// Lines over which ipos can send process data to a drive. DP slaves get zeros only.
enum class WordLine : uint8_t { Rs485, Sbus, Canopen };

// By index: it is the same for the units that name the parameter otherwise.
struct Monitoring {
  uint16_t address;  // the parameter with the unit's address on an SBus; 0: there is one line only
  uint16_t node;     // the same of CANopen
  uint16_t timeout, response;
  std::string_view timeout_name, response_name;
};
// What monitors the words to this address: a MOVIDRIVE B has a second SBus, and the line may be either, or both where
// they have one address. An error: the unit does not answer. `read` asks it for a parameter.
tl::expected<std::vector<Monitoring>, AccessError> monitorings(
    WordLine line, uint8_t address, const std::function<AccessReply(uint16_t index)>& read);

// Of the monitoring that ends a movement in time (ours).
inline constexpr int32_t kLongestSilence = 500;  // ms
// 0 switches it off, and on MOVIDRIVE 650 s do (1053 1610 p. 41).
constexpr bool ends_in_time(int32_t timeout_ms) { return timeout_ms > 0 && timeout_ms <= kLongestSilence; }
// NO RESPONSE and DISPLAY ERROR let the drive go on with its last words (P830).
constexpr bool lets_go_on(int32_t response) { return response <= 1; }

// Whether one of the words would release a drive, if it is a control word: no inhibit, no rapid stop, no stop (1053 1610
// p. 40). A word of another meaning may look so, too.
constexpr bool could_enable(std::span<const uint16_t> words) {
  for (const uint16_t word : words)
    if ((word & 7U) == 6U) return true;
  return false;
}

}  // namespace ipos::tools

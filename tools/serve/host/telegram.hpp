// One telegram of a line as the tab Bus keeps it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/clock/event_queue.hpp"

namespace ipos::tools::serve {

struct Telegram {
  static constexpr uint16_t kNobody = UINT16_MAX;  // several at once, or nobody knows

  runtime::Time time = 0;  // of its end
  runtime::Time took = 0;  // from its first bit on
  uint32_t id = 0;  // CAN: the identifier; RS-485: the address; PROFIBUS: a number for frames of one kind
  uint8_t bus = 0;  // number in the reply to `plant`
  bool extended = false, remote = false, error = false;
  uint16_t sender = kNobody;  // who has put it on the line, by the number on it
  uint8_t reason = 0;  // of the error, where the bytes do not tell it (profibus::FrameError, runtime::SerialError)
  std::vector<uint8_t> data;
  std::string words;  // where they depend on what went before on the line; else they are made when wanted

  std::span<const uint8_t> bytes() const { return remote ? std::span<const uint8_t>() : data; }
};

}  // namespace ipos::tools::serve

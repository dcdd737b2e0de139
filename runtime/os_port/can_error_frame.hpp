// What a CAN controller reports besides frames, as the kernel passes it on: an error frame with CAN_ERR_FLAG.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace ipos::runtime {

struct CanErrorFrame {
  uint32_t classes = 0;  // CAN_ERR_* of linux/can/error.h
  std::array<uint8_t, 8> data{};
};

// "no acknowledge: ..., controller (error passive by transmit errors)"
std::string describe(const CanErrorFrame& error);

}  // namespace ipos::runtime

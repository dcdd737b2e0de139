// The messages of a CANopen node by its dictionary: what it sends and takes, and how often.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/bus/canopen/node.hpp"

namespace ipos::runtime {

struct CanopenMessage {
  uint32_t id;
  std::string what;  // "TPDO1", "SDO request"
  bool transmits;
  uint8_t bytes;
  bool asked = false;  // sent only when somebody asks or something goes wrong
  unsigned syncs = 0;  // sent at each so-many-th SYNC; 0: not at SYNC
  Time period = 0;     // sent that often by itself; 0: not by time
};

std::vector<CanopenMessage> canopen_messages(const canopen::Node& node);

}  // namespace ipos::runtime

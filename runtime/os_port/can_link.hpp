// What the kernel knows of a network interface that is to be a CAN bus: asked once, before it is opened.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "runtime/os_port/port_error.hpp"

namespace ipos::runtime {

struct CanLink {
  int index = 0;
  std::string kind;                  // "vcan", "can", "slcan", ...; empty when it does not say
  std::optional<uint32_t> bit_rate;  // a virtual interface has none
};

// NoSuchInterface, NotCan and Down are errors here.
tl::expected<CanLink, PortError> query_can_link(const std::string& name);

}  // namespace ipos::runtime

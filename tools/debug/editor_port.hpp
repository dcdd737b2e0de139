// An editor that comes to a port of the loopback, in place of standard input and output.
#pragma once

#include <cstdint>
#include <functional>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::tools::debug {

// Waits for the only one; a file to read and write. `listening` is called with the port, which may be any free one (0). A
// Failure: the port cannot be listened at, or nobody came.
runtime::Descriptor editor_at(uint16_t port, const std::function<void(uint16_t)>& listening);

}  // namespace ipos::tools::debug

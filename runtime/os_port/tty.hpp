// A serial device in raw mode: 8 data bits, 1 stop bit, parity as asked. Its former settings come back at the
// end.
#pragma once

#include <termios.h>

#include <memory>
#include <string>

#include <tl/expected.hpp>

#include "runtime/os_port/descriptor.hpp"
#include "runtime/os_port/port.hpp"

namespace ipos::runtime {

struct TtySettings {
  uint32_t baud = 9600;
  bool even_parity = false;  // and bytes with parity or framing errors marked, see parity_marks.hpp
  bool rs485 = false;        // half duplex by the driver, where it can
};

class Tty {
 public:
  // What the device does not have (parity, RS-485 switching, low latency) comes as a note.
  static tl::expected<Tty, PortError> open(const std::string& path, const TtySettings& settings,
                                           PortNotes& notes);
  ~Tty();
  Tty(Tty&&) = default;
  Tty& operator=(Tty&&) = delete;

  int descriptor() const { return descriptor_.get(); }
  bool has_parity() const { return parity_; }
  bool marks_errors() const { return marks_; }

 private:
  Tty(Descriptor descriptor, const termios& former) : descriptor_(std::move(descriptor)), former_(former) {}

  Descriptor descriptor_;
  termios former_;
  bool parity_ = false;
  bool marks_ = false;
};

}  // namespace ipos::runtime

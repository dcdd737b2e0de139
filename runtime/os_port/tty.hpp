// A serial device in raw mode: 8 data bits, 1 stop bit, parity as asked. Its former settings come back at the
// end.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

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
  Tty(Tty&&) noexcept;
  Tty& operator=(Tty&&) = delete;

  // Neither blocks: the number of bytes, 0 for none now, or an errno value.
  tl::expected<size_t, int> read(std::span<char> into);
  tl::expected<size_t, int> write(std::string_view bytes);

  int descriptor() const;  // to be polled; on Windows the handle of an event
  bool has_parity() const { return parity_; }
  bool marks_errors() const { return marks_; }

 private:
  struct System;  // what the operating system has of it
  explicit Tty(std::unique_ptr<System> system);

  std::unique_ptr<System> system_;
  bool parity_ = false;
  bool marks_ = false;
};

}  // namespace ipos::runtime

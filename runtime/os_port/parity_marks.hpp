// Takes the marks out of the bytes of a terminal with PARMRK (termios(3)): FF 00 X is a byte X with a parity
// or framing error, FF 00 00 also a break, FF FF the byte FF.
#pragma once

#include <cstdint>
#include <optional>

namespace ipos::runtime {

struct MarkedByte {
  uint8_t value = 0;
  bool bad = false;
};

class ParityMarks {
 public:
  std::optional<MarkedByte> push(uint8_t byte) {
    switch (state_) {
      case State::Plain:
        if (byte != 0xFF) return MarkedByte{byte, false};
        state_ = State::Escape;
        return std::nullopt;
      case State::Escape:
        state_ = byte == 0 ? State::Bad : State::Plain;
        if (byte == 0) return std::nullopt;
        return MarkedByte{byte,
                          byte != 0xFF};  // other bytes cannot follow; if one does, the pair is not trusted
      case State::Bad: break;
    }
    state_ = State::Plain;
    return MarkedByte{byte, true};
  }

 private:
  enum class State : uint8_t { Plain, Escape, Bad } state_ = State::Plain;
};

}  // namespace ipos::runtime

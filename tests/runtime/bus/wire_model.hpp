// An independent model of CAN on the wire, for comparison: frames as text of '0' (dominant) and '1'
// (recessive), CRC by long division, nodes that look at the bus bit by bit. Shares no code with runtime/bus.
#pragma once

#include <cstdint>
#include <string>

#include "runtime/bus/can/frame.hpp"

namespace ipos::tests {

inline std::string binary(uint64_t value, int digits) {
  std::string text;
  for (int i = digits - 1; i >= 0; --i) text += (value >> i & 1U) != 0 ? '1' : '0';
  return text;
}

// Remainder of message * x^15 by x^15 + x^14 + x^10 + x^8 + x^7 + x^4 + x^3 + 1.
inline std::string crc15(const std::string& message) {
  const std::string divisor = "1100010110011001";
  std::string work = message + std::string(15, '0');
  for (size_t i = 0; i < message.size(); ++i)
    if (work[i] == '1')
      for (size_t k = 0; k < divisor.size(); ++k) work[i + k] = work[i + k] == divisor[k] ? '0' : '1';
  return work.substr(message.size());
}

inline std::string arbitration_field(const runtime::Frame& f) {
  const std::string rtr = f.remote ? "1" : "0";
  const std::string id = binary(f.id, f.extended ? 29 : 11);
  return f.extended ? id.substr(0, 11) + "11" + id.substr(11) + rtr : id + rtr + "0";
}

inline std::string stuffed_part(const runtime::Frame& f) {
  // Standard: IDE is in the arbitration text above, then r0; extended: r1, r0.
  std::string bits = "0" + arbitration_field(f) + (f.extended ? "00" : "0") + binary(f.length, 4);
  for (int i = 0; i < f.length && !f.remote; ++i) bits += binary(f.data[static_cast<size_t>(i)], 8);
  bits += crc15(bits);
  std::string stuffed;
  for (const char bit : bits) {
    stuffed += bit;
    const size_t n = stuffed.size();
    if (n >= 5 && stuffed.substr(n - 5) == std::string(5, bit)) stuffed += bit == '0' ? '1' : '0';
  }
  return stuffed;
}

// Start of frame to end of frame.
inline std::string wire(const runtime::Frame& f) { return stuffed_part(f) + "1" + "11" + "1111111"; }

}  // namespace ipos::tests

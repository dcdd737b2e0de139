// Builds the bit sequence of a frame (ISO 11898-1): fields, CRC-15 with polynomial 4599h, stuffing after five
// equal bits from the start of frame to the end of the CRC.
#include "runtime/bus/can/frame_bits.hpp"

namespace ipos::runtime {
namespace {

constexpr uint32_t kCrcPolynomial = 0x4599;

class BitWriter {
 public:
  void put(bool recessive) {
    crc_ = (crc_ << 1) ^ (((crc_ >> 14 & 1U) != 0) != recessive ? kCrcPolynomial : 0U);
    crc_ &= 0x7FFF;
    append(recessive);
    if (run_ == 0 || recessive != last_) {
      last_ = recessive;
      run_ = 1;
    } else if (++run_ == 5) {
      last_ = !recessive;
      append(last_);
      run_ = 1;
    }
  }

  void put(uint32_t value, uint32_t bits) {
    for (uint32_t i = bits; i-- > 0;) put((value >> i & 1U) != 0);
  }

  void put_crc() { put(crc_, 15); }  // the argument is read before put() changes the register

  void end() {  // CRC delimiter, acknowledge slot and delimiter, end of frame
    for (int i = 0; i < 10; ++i) append(true);
  }

  const WireBits& bits() const { return bits_; }

 private:
  void append(bool recessive) { bits_.recessive[bits_.count++] = recessive; }

  WireBits bits_;
  uint32_t crc_ = 0;
  uint32_t run_ = 0;
  bool last_ = false;
};

}  // namespace

WireBits wire_bits(const Frame& frame) {
  BitWriter out;
  out.put(false);  // start of frame
  if (frame.extended) {
    out.put(frame.id >> 18, 11);
    out.put(3, 2);  // SRR, IDE
    out.put(frame.id & 0x3FFFF, 18);
    out.put(frame.remote);
    out.put(0, 2);  // r1, r0
  } else {
    out.put(frame.id, 11);
    out.put(frame.remote);
    out.put(0, 2);  // IDE, r0
  }
  out.put(frame.length, 4);
  if (!frame.remote)
    for (uint32_t i = 0; i < frame.length; ++i) out.put(frame.data[i], 8);
  out.put_crc();
  out.end();
  return out.bits();
}

uint32_t frame_bits(const Frame& frame) { return wire_bits(frame).count + kIntermissionBits; }

}  // namespace ipos::runtime

// Builds the bit sequence of a frame (ISO 11898-1): fields, CRC-15 with polynomial 4599h, stuffing after five
// equal bits from the start of frame to the end of the CRC.
#include "runtime/bus/can/frame_bits.hpp"

#include <array>

namespace ipos::runtime {
namespace {

constexpr uint32_t kCrcPolynomial = 0x4599;

class BitWriter {
 public:
  void put(bool recessive) {
    crc_ = (crc_ << 1) ^ (((crc_ >> 14 & 1U) != 0) != recessive ? kCrcPolynomial : 0U);
    crc_ &= 0x7FFF;
    append(recessive);
    if (recessive != last_) {
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
  uint32_t run_ = 0;   // equal bits up to here
  bool last_ = false;  // a frame begins with a dominant bit
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

uint32_t next_recessive(const WireBits& bits, uint32_t from) {
  while (from < bits.count && !bits.recessive[from]) ++from;
  return from;
}

namespace {

// The same by bytes, for the length alone. State of the stuffing: the last bit, and how many bits before it
// are equal to it (0..3; after four equal ones a fifth ends the run).
struct StuffStep {
  uint8_t state;  // last bit * 4 + equal bits before it
  uint8_t added;  // stuff bits
};

struct Tables {
  std::array<std::array<StuffStep, 256>, 8> stuff{};
  std::array<uint16_t, 256> crc{};

  constexpr Tables() {
    for (uint32_t begin = 0; begin < 8; ++begin)
      for (uint32_t byte = 0; byte < 256; ++byte) {
        uint32_t last = begin / 4, before = begin % 4, added = 0;
        for (uint32_t i = 8; i-- > 0;) {
          const uint32_t bit = byte >> i & 1;
          before = bit == last ? before + 1 : 0;
          last = bit;
          if (before < 4) continue;
          last = 1 - bit;  // the stuff bit
          before = 0;
          ++added;
        }
        stuff[begin][byte] = {static_cast<uint8_t>(last * 4 + before), static_cast<uint8_t>(added)};
      }
    for (uint32_t byte = 0; byte < 256; ++byte) {
      uint32_t value = byte << 7;
      for (int i = 0; i < 8; ++i) value = (value << 1) ^ ((value & 0x4000) != 0 ? kCrcPolynomial : 0);
      crc[byte] = static_cast<uint16_t>(value & 0x7FFF);
    }
  }
};
constexpr Tables kTables;

class LengthCounter {
 public:
  // `state` of the stuffing after the three bits that come before the first byte.
  explicit LengthCounter(uint8_t state) : state_(state) {}

  void put(uint32_t byte) {
    const StuffStep step = kTables.stuff[state_][byte];
    state_ = step.state;
    added_ += step.added;
  }
  uint32_t added() const { return added_; }

 private:
  uint32_t state_;
  uint32_t added_ = 0;
};

uint32_t next_crc(uint32_t crc, uint32_t byte) {
  return ((crc << 8) ^ kTables.crc[(crc >> 7 ^ byte) & 0xFF]) & 0x7FFF;
}

}  // namespace

uint32_t frame_bits(const Frame& frame) {
  if (frame.extended) return wire_bits(frame).count + kIntermissionBits;
  // Start of frame, identifier, RTR, IDE, r0 and length are 19 bits. Zeros in front do not change the CRC.
  const uint32_t header = frame.id << 7 | (frame.remote ? 1U << 6 : 0U) | frame.length;
  constexpr uint8_t kBehindStart[] = {2, 4, 0, 5};  // of 0 and the two highest bits of the identifier
  LengthCounter length(kBehindStart[header >> 16]);
  uint32_t crc = next_crc(0, header >> 16);
  const auto put = [&](uint32_t byte) {
    length.put(byte);
    crc = next_crc(crc, byte);
  };
  put(header >> 8 & 0xFF);
  put(header & 0xFF);
  const uint32_t bytes = frame.remote ? 0 : frame.length;
  for (uint32_t i = 0; i < bytes; ++i) put(frame.data[i]);
  // The CRC has 15 bits; a 16th that is unlike the last one adds no stuff bit.
  length.put(crc >> 7);
  length.put((crc << 1 & 0xFF) | (~crc & 1));
  return unstuffed_bits(bytes, false) + length.added();
}

}  // namespace ipos::runtime

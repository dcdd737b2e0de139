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
constexpr uint32_t kMostBytes = 8;

struct Tables {
  // For state and byte in one number the next state in the upper byte, the stuff bits in the lower one.
  std::array<uint16_t, 8 * 256> stuff{};
  // [n]: what a byte leaves in the register when n bytes of zeros follow it. The register is linear, so what each byte
  // leaves is put together in any order.
  std::array<std::array<uint16_t, 256>, kMostBytes> crc{};

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
        stuff[begin << 8 | byte] = static_cast<uint16_t>((last * 4 + before) << 8 | added);
      }
    for (uint32_t byte = 0; byte < 256; ++byte) {
      uint32_t value = byte << 7;
      for (std::array<uint16_t, 256>& behind : crc) {
        for (int i = 0; i < 8; ++i) value = (value << 1) ^ ((value & 0x4000) != 0 ? kCrcPolynomial : 0);
        value &= 0x7FFF;
        behind[byte] = static_cast<uint16_t>(value);
      }
    }
  }
};
constexpr Tables kTables;

class LengthCounter {
 public:
  LengthCounter(uint32_t state, uint32_t added) : step_(state << 8), added_(added) {}

  void put(uint32_t byte) {
    step_ = kTables.stuff[(step_ & 0x700) | byte];
    added_ += step_ & 0xFF;
  }
  uint32_t state() const { return step_ >> 8; }
  uint32_t added() const { return added_; }

 private:
  uint32_t step_;
  uint32_t added_;
};

// What the register, 15 bits, leaves behind so many bytes of zeros.
uint32_t behind(uint32_t crc, uint32_t bytes) {
  if (bytes == 0) return crc;
  const uint32_t low = crc << 1 & 0xFF;  // its last 7 bits meet the second byte
  return kTables.crc[bytes - 1][crc >> 7] ^ (bytes == 1 ? low << 7 : kTables.crc[bytes - 2][low]);
}

}  // namespace

FrameHead frame_head(const Frame& frame) {
  if (frame.extended) return {};
  // Start of frame, identifier, RTR, IDE, r0 and length are 19 bits. Zeros in front do not change the CRC.
  const uint32_t header = frame.id << 7 | (frame.remote ? 1U << 6 : 0U) | frame.length;
  // State behind the three bits that come before the first whole byte: 0 and the two highest of the identifier.
  constexpr uint8_t kBehindStart[] = {2, 4, 0, 5};
  LengthCounter length(kBehindStart[header >> 16], 0);
  length.put(header >> 8 & 0xFF);
  length.put(header & 0xFF);
  const uint32_t crc = kTables.crc[2][header >> 16] ^ kTables.crc[1][header >> 8 & 0xFF] ^ kTables.crc[0][header & 0xFF];
  return {static_cast<uint16_t>(crc), static_cast<uint8_t>(length.state()), static_cast<uint8_t>(length.added())};
}

uint32_t frame_bits(const Frame& frame, const FrameHead& head) {
  if (frame.extended) return wire_bits(frame).count + kIntermissionBits;
  const uint32_t bytes = frame.remote ? 0 : frame.length;
  LengthCounter length(head.stuffing, head.added);
  uint32_t crc = behind(head.crc, bytes);
  const std::array<uint16_t, 256>* followed_by = kTables.crc.data() + bytes;  // so many bytes
  for (uint32_t i = 0; i < bytes; ++i) {
    length.put(frame.data[i]);
    crc ^= (*--followed_by)[frame.data[i]];
  }
  // The CRC has 15 bits; a 16th that is unlike the last one adds no stuff bit.
  length.put(crc >> 7);
  length.put((crc << 1 & 0xFF) | (~crc & 1));
  return unstuffed_bits(bytes, false) + length.added();
}

}  // namespace ipos::runtime

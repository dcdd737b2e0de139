// The octets of FMS on the line. Public (EN 50170 volume 2, part 6): a component is an ID Info octet (bit 7 constructed, bits 6-4
// tag, bits 3-0 length; 7 and 15 say that the number follows in an octet) and its octets; of a SEQUENCE the length is the number of
// components; the numbers of the services. The heads of LLI and FMS are printed in no public text and are ours
// (docs/reference/protocols/profibus.md#fms).
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>

#include "runtime/bus/profibus/fms/objects.hpp"

namespace ipos::profibus::fms {

// The first octet (ours).
enum class Lli : uint8_t { Data, Associate, Associated, Refused, Abort, Idle };
// The tag of the unit behind it (ours).
enum class PduKind : uint8_t { Request = 1, Response = 2, Error = 3, Reject = 5, Initiate = 6 };

struct Part {
  uint8_t tag = 0;
  Octets octets;
  friend bool operator==(const Part&, const Part&) = default;
};

// The components of a unit. They lie in place, as answers come again and again.
class Parts {
 public:
  static constexpr size_t kMost = 16;  // more than any service has

  Parts() = default;
  Parts(std::initializer_list<Part> parts) {
    for (const Part& part : parts) push_back(part);
  }

  size_t size() const { return count_; }
  const Part* begin() const { return parts_.data(); }
  const Part* end() const { return parts_.data() + count_; }
  void push_back(const Part& part) {
    assert(count_ < kMost);
    parts_[count_++] = part;
  }

  friend bool operator==(const Parts& a, const Parts& b) { return std::equal(a.begin(), a.end(), b.begin(), b.end()); }

 private:
  std::array<Part, kMost> parts_;
  size_t count_ = 0;
};

struct Pdu {
  PduKind kind = PduKind::Request;
  uint8_t invoke = 0;   // not in Initiate
  uint8_t service = 0;  // its number; not in Reject and Initiate
  Parts parts;

  const Octets* part(uint8_t tag) const;
  std::optional<uint16_t> word(uint8_t tag) const;  // of a part of two octets
  std::optional<uint8_t> octet(uint8_t tag) const;
  friend bool operator==(const Pdu&, const Pdu&) = default;
};

struct Message {
  Lli lli = Lli::Data;
  uint16_t interval = 0;  // of Associate, in 10 ms
  uint8_t originator = 0;  // of Abort
  uint8_t reason = 0;
  std::optional<Pdu> pdu;  // of all but Abort and Idle
  friend bool operator==(const Message&, const Message&) = default;
};

Octets encode(const Message& message);
std::optional<Message> decode(std::span<const uint8_t> octets);  // the whole, no octet more or less

// Of the unit without the head of the LLI, which largest sizes do not count.
constexpr size_t pdu_size(std::span<const uint8_t> message) { return message.empty() ? 0 : message.size() - 1; }

inline Octets word_octets(uint16_t value) { return {static_cast<uint8_t>(value >> 8), static_cast<uint8_t>(value)}; }

}  // namespace ipos::profibus::fms

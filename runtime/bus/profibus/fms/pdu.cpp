// Components and heads, in both directions. Whatever comes is read with its length before it.
#include "runtime/bus/profibus/fms/pdu.hpp"

#include <algorithm>

namespace ipos::profibus::fms {
namespace {

constexpr uint8_t kConstructed = 0x80, kTagFollows = 7, kLengthFollows = 15;

struct IdInfo {
  bool constructed = false;
  uint8_t tag = 0;
  uint8_t length = 0;
};

void put(Octets& out, const IdInfo& id) {
  out.push_back(static_cast<uint8_t>((id.constructed ? kConstructed : 0) | std::min(id.tag, kTagFollows) << 4 |
                                     std::min(id.length, kLengthFollows)));
  if (id.tag >= kTagFollows) out.push_back(id.tag);
  if (id.length >= kLengthFollows) out.push_back(id.length);
}

void put(Octets& out, const Parts& parts) {
  for (const Part& part : parts) {
    put(out, IdInfo{false, part.tag, static_cast<uint8_t>(part.octets.size())});
    out.insert(out.end(), part.octets.begin(), part.octets.end());
  }
}

bool has_service(PduKind kind) {
  return kind == PduKind::Request || kind == PduKind::Response || kind == PduKind::Error;
}

bool has_pdu(Lli lli) { return lli != Lli::Abort && lli != Lli::Idle; }

class Reader {
 public:
  explicit Reader(std::span<const uint8_t> octets) : rest_(octets) {}

  bool at_end() const { return rest_.empty(); }
  std::optional<uint8_t> octet() {
    if (rest_.empty()) return std::nullopt;
    const uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  std::optional<IdInfo> id() {
    const auto first = octet();
    if (!first) return std::nullopt;
    IdInfo id{(*first & kConstructed) != 0, static_cast<uint8_t>(*first >> 4 & kTagFollows),
              static_cast<uint8_t>(*first & kLengthFollows)};
    for (uint8_t* number : {id.tag == kTagFollows ? &id.tag : nullptr,
                            id.length == kLengthFollows ? &id.length : nullptr}) {
      if (number == nullptr) continue;
      const auto next = octet();
      if (!next) return std::nullopt;
      *number = *next;
    }
    return id;
  }
  bool parts(size_t count, Parts& out) {
    if (count > Parts::kMost) return false;
    for (size_t n = 0; n < count; ++n) {
      const auto head = id();
      if (!head || head->constructed || head->length > rest_.size()) return false;
      out.push_back({head->tag, Octets(rest_.begin(), rest_.begin() + head->length)});
      rest_ = rest_.subspan(head->length);
    }
    return true;
  }

 private:
  std::span<const uint8_t> rest_;
};

std::optional<Pdu> read_pdu(Reader& in) {
  const auto head = in.id();
  if (!head || !head->constructed) return std::nullopt;
  Pdu pdu;
  pdu.kind = static_cast<PduKind>(head->tag);
  size_t count = head->length;
  if (pdu.kind != PduKind::Initiate) {
    const auto invoke = in.octet();
    if (!invoke) return std::nullopt;
    pdu.invoke = *invoke;
  }
  if (has_service(pdu.kind)) {
    const auto service = in.id();
    if (count != 1 || !service || !service->constructed) return std::nullopt;
    pdu.service = service->tag;
    count = service->length;
  } else if (pdu.kind != PduKind::Reject && pdu.kind != PduKind::Initiate) {
    return std::nullopt;
  }
  if (!in.parts(count, pdu.parts) || !in.at_end()) return std::nullopt;
  return pdu;
}

}  // namespace

const Octets* Pdu::part(uint8_t tag) const {
  const auto found = std::find_if(parts.begin(), parts.end(), [tag](const Part& part) { return part.tag == tag; });
  return found == parts.end() ? nullptr : &found->octets;
}

std::optional<uint16_t> Pdu::word(uint8_t tag) const {
  const Octets* octets = part(tag);
  if (octets == nullptr || octets->size() != 2) return std::nullopt;
  return static_cast<uint16_t>((*octets)[0] << 8 | (*octets)[1]);
}

std::optional<uint8_t> Pdu::octet(uint8_t tag) const {
  const Octets* octets = part(tag);
  if (octets == nullptr || octets->size() != 1) return std::nullopt;
  return octets->front();
}

Octets encode(const Message& message) {
  Octets out{static_cast<uint8_t>(message.lli)};
  if (message.lli == Lli::Associate) {
    const Octets interval = word_octets(message.interval);
    out.insert(out.end(), interval.begin(), interval.end());
  }
  if (message.lli == Lli::Abort) {
    out.push_back(message.originator);
    out.push_back(message.reason);
  }
  if (!message.pdu) return out;
  const Pdu& pdu = *message.pdu;
  const auto count = static_cast<uint8_t>(pdu.parts.size());
  put(out, IdInfo{true, static_cast<uint8_t>(pdu.kind), has_service(pdu.kind) ? uint8_t{1} : count});
  if (pdu.kind != PduKind::Initiate) out.push_back(pdu.invoke);
  if (has_service(pdu.kind)) put(out, IdInfo{true, pdu.service, count});
  put(out, pdu.parts);
  return out;
}

std::optional<Message> decode(std::span<const uint8_t> octets) {
  Reader in(octets);
  const auto head = in.octet();
  if (!head || *head > static_cast<uint8_t>(Lli::Idle)) return std::nullopt;
  Message message;
  message.lli = static_cast<Lli>(*head);
  if (message.lli == Lli::Associate || message.lli == Lli::Abort) {
    const auto first = in.octet(), second = in.octet();
    if (!second) return std::nullopt;
    if (message.lli == Lli::Associate) {
      message.interval = static_cast<uint16_t>(*first << 8 | *second);
    } else {
      message.originator = *first;
      message.reason = *second;
    }
  }
  if (!has_pdu(message.lli)) return in.at_end() ? std::optional(message) : std::nullopt;
  message.pdu = read_pdu(in);
  const bool initiates = message.pdu && message.pdu->kind == PduKind::Initiate;
  if (!message.pdu || initiates != (message.lli != Lli::Data)) return std::nullopt;
  return message;
}

}  // namespace ipos::profibus::fms

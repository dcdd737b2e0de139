// Planted faults of a line that carries octets, RS-485, RS-232 or PROFIBUS: which frames they strike, by number or by chance with
// a seed, and which of them last at a station. What is left of a struck frame is decided by its line.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/bus/line/node_id.hpp"
#include "runtime/clock/event_queue.hpp"
#include "runtime/clock/random.hpp"

namespace ipos::runtime {

enum class OctetFaultKind : uint8_t {
#define OCTET_FAULT(name, word, scope, from, text) name,
#include "runtime/bus/rs485/octet_faults.def"
};
enum class OctetFaultScope : uint8_t { Frame, Station };
// Each has the faults of those before it.
enum class OctetLine : uint8_t { Rs232, Rs485, Profibus };

struct OctetFaultType {
  OctetFaultKind kind;
  std::string_view word;  // `kind` in a plant file
  OctetFaultScope scope;
  OctetLine from;
  std::string_view text;

  bool is_of(OctetLine line) const { return from <= line; }
};
std::span<const OctetFaultType> octet_fault_types();
const OctetFaultType& octet_fault_type(OctetFaultKind kind);
const OctetFaultType* find_octet_fault(std::string_view word, OctetLine line);  // nullptr: it has none of this word

inline constexpr uint32_t kMostDisturbedBits = 3;  // by noise

struct OctetFault {
  OctetFaultKind kind = OctetFaultKind::Noise;
  Time from = 0;
  Time until = kNever;
  NodeId sender = kNoNode;  // only what this station sends; kNoNode: all
  uint64_t frame = 0;       // only the n-th of these frames, from 1; 0: by chance
  uint32_t per_mille = 1000;
  uint64_t seed = 1;
};

class OctetFaults {
 public:
  size_t add(const OctetFault& fault) {
    faults_.push_back({fault, Random(fault.seed)});
    return faults_.size() - 1;
  }
  const OctetFault& operator[](size_t n) const { return faults_[n].fault; }
  // Such a fault of the station lasts.
  bool lasts(OctetFaultKind kind, NodeId station, Time now) const;

  // Ends those of the kind and the sender that have begun and have no end of their own. False: there is none.
  bool end(OctetFaultKind kind, NodeId sender, Time now);

  struct Struck {
    OctetFaultKind kind;
    Random* chance;  // chooses what of the frame
  };
  // Of several that strike the same frame the first one planted counts.
  std::optional<Struck> strike(Time now, NodeId sender);

 private:
  struct Planted {
    OctetFault fault;
    Random random;
    uint64_t seen = 0;
  };
  std::vector<Planted> faults_;
};

}  // namespace ipos::runtime

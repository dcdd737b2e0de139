// Planted faults of a PROFIBUS line: which frames they strike, by number or by chance with a seed, and what is
// left of a struck frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "runtime/bus/line/node_id.hpp"
#include "runtime/bus/profibus/fdl_frame.hpp"
#include "runtime/clock/event_queue.hpp"
#include "runtime/clock/random.hpp"

namespace ipos::profibus {

using runtime::NodeId;
using runtime::Time;

enum class LineFaultKind : uint8_t {
#define DP_LINE_FAULT(name, word, scope, text) name,
#include "runtime/bus/profibus/line_faults.def"
};
enum class LineFaultScope : uint8_t { Frame, Station };
struct LineFaultType {
  LineFaultKind kind;
  std::string_view word;  // `kind` in a plant file
  LineFaultScope scope;
  std::string_view text;
};
std::span<const LineFaultType> line_fault_types();
const LineFaultType& line_fault_type(LineFaultKind kind);
std::optional<LineFaultKind> find_line_fault(std::string_view word);

struct LineFault {
  LineFaultKind kind = LineFaultKind::Noise;
  Time from = 0;
  Time until = runtime::kNever;
  NodeId sender = runtime::kNoNode;  // only what this station sends; kNoNode: all
  uint64_t frame = 0;                // only the n-th of these frames, from 1; 0: by chance
  uint32_t per_mille = 1000;
  uint64_t seed = 1;
};

// A frame as it goes over the line. Without octets nobody hears anything.
struct WireFrame {
  Octets octets;
  std::optional<FrameError> damage;  // of a character: parity or frame
};

class LineFaults {
 public:
  size_t add(const LineFault& fault) {
    faults_.push_back({fault, runtime::Random(fault.seed)});
    return faults_.size() - 1;
  }
  const LineFault& operator[](size_t n) const { return faults_[n].fault; }
  // Such a fault of the station lasts.
  bool lasts(LineFaultKind kind, NodeId station, Time now) const;

  // Ends those of the kind and the sender that have begun and have no end of their own. False: there is none.
  bool end(LineFaultKind kind, NodeId sender, Time now);

  // Of several that strike the same frame the first one planted counts.
  std::optional<LineFaultKind> strike(Time now, NodeId sender, WireFrame& frame);

 private:
  struct Planted {
    LineFault fault;
    runtime::Random random;
    uint64_t seen = 0;
  };
  std::vector<Planted> faults_;
};

}  // namespace ipos::profibus

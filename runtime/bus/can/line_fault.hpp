// Planted faults of a CAN line: which frames they strike, by number or by chance with a seed. What a struck
// frame does on the wire is decided in transfer.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "runtime/bus/can/node.hpp"
#include "runtime/clock/random.hpp"

namespace ipos::runtime {

enum class FaultKind : uint8_t {
#define LINE_FAULT(name, word, scope, at, text) name,
#include "runtime/bus/can/line_faults.def"
};
enum class FaultScope : uint8_t { Frame, Wiring };
enum class FaultPlace : uint8_t { Line, Station, Either };

struct FaultType {
  FaultKind kind;
  std::string_view word;
  FaultScope scope;
  FaultPlace at;
  std::string_view text;
};

inline constexpr FaultType kFaultTypes[] = {
#define LINE_FAULT(name, word, scope, at, text) \
  {FaultKind::name, word, FaultScope::scope, FaultPlace::at, text},
#include "runtime/bus/can/line_faults.def"
};

constexpr const FaultType& fault_type(FaultKind kind) { return kFaultTypes[static_cast<size_t>(kind)]; }
const FaultType* find_fault_type(std::string_view word);  // nullptr: there is none

struct LineFault {
  FaultKind kind = FaultKind::Drop;
  Time from = 0;
  Time until = kNever;
  NodeId node = kNoNode;  // the only station that suffers; kNoNode: all
  bool behind = false;    // Cut: the line behind this station, not its own connection

  // Faults of frames:
  std::optional<uint32_t> id;  // only frames with this identifier
  uint64_t frame = 0;          // only the n-th of them, from 1; 0: by chance
  uint32_t per_mille = 1000;
  uint64_t seed = 1;
  Time lag = 0;  // of Delay

  uint32_t baud = 0;     // of Baud: what the station is set to
  bool of_line = false;  // nobody has planted it: the data of the line say it
};

// What strikes one transfer.
struct FrameFault {
  std::optional<FaultKind> kind;
  NodeId node = kNoNode;
  uint64_t chance = 0;  // chooses the bit
  Time lag = 0;
  bool of_line = false;

  bool is(FaultKind wanted) const { return kind == wanted; }
  bool disturbs_a_bit() const { return is(FaultKind::Corrupt) || is(FaultKind::Terminator) || is(FaultKind::Length); }
};

class LineFaults {
 public:
  size_t add(const LineFault& fault);
  const LineFault& operator[](size_t n) const { return faults_[n].fault; }
  size_t size() const { return faults_.size(); }
  void end(size_t n, Time now) { faults_[n].fault.until = now; }

  // Of several that strike the same frame the first one planted counts. Repetitions are frames of their own.
  FrameFault strike(Time now, uint32_t id);
  bool empty() const { return faults_.empty(); }
  // One of frames strikes now or later.
  bool may_strike(Time now) const;

 private:
  struct Planted {
    LineFault fault;
    Random random;
    uint64_t seen = 0;
  };
  std::vector<Planted> faults_;
};

}  // namespace ipos::runtime

// Counting and drawing. A fault that draws does so for each frame it could strike, so its numbers do not depend on the other
// faults.
#include "runtime/bus/rs485/octet_fault.hpp"

#include <algorithm>

namespace ipos::runtime {
namespace {

constexpr OctetFaultType kTypes[] = {
#define OCTET_FAULT(name, word, scope, from, text) \
  {OctetFaultKind::name, word, OctetFaultScope::scope, OctetLine::from, text},
#include "runtime/bus/rs485/octet_faults.def"
};

}  // namespace

std::span<const OctetFaultType> octet_fault_types() { return kTypes; }

const OctetFaultType& octet_fault_type(OctetFaultKind kind) { return kTypes[static_cast<size_t>(kind)]; }

const OctetFaultType* find_octet_fault(std::string_view word, OctetLine line) {
  for (const OctetFaultType& type : kTypes)
    if (type.word == word && type.is_of(line)) return &type;
  return nullptr;
}

bool OctetFaults::end(OctetFaultKind kind, NodeId sender, Time now) {
  bool found = false;
  for (Planted& planted : faults_) {
    OctetFault& fault = planted.fault;
    if (fault.kind != kind || fault.sender != sender || fault.from > now || fault.until != kNever) continue;
    fault.until = now;
    found = true;
  }
  return found;
}

bool OctetFaults::lasts(OctetFaultKind kind, NodeId station, Time now) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Planted& planted) {
    const OctetFault& fault = planted.fault;
    return fault.kind == kind && fault.sender == station && fault.from <= now && now < fault.until;
  });
}

std::optional<OctetFaults::Struck> OctetFaults::strike(Time now, NodeId sender) {
  std::optional<Struck> struck;
  for (Planted& planted : faults_) {
    const OctetFault& fault = planted.fault;
    if (now < fault.from || now >= fault.until || octet_fault_type(fault.kind).scope != OctetFaultScope::Frame) continue;
    if (fault.sender != kNoNode && fault.sender != sender) continue;
    ++planted.seen;
    const bool meant = fault.frame == 0 ? planted.random.below(1000) < fault.per_mille : planted.seen == fault.frame;
    if (meant && !struck) struck = {fault.kind, &planted.random};
  }
  return struck;
}

}  // namespace ipos::runtime

// The functions of FMI 3.0 for clocks and what is clocked, which are the members of terminals (chapters 2.2.8, 2.2.9 and 2.2.10).
#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "runtime/fmi/component.hpp"

using namespace ipos::fmi;

namespace {

using Reference = uint32_t;
using Member = Instance::Member;

// `wanted`: of which members the function is; then `action` for each of them. None, if one is wrong.
template <typename Is, typename Do>
int for_members(void* instance, const Reference references[], size_t count, bool has_values, Is wanted, Do action) noexcept {
  return enter(instance, Call::Clocks, [&](Instance& inside, Component&) {
    if (count != 0 && (references == nullptr || !has_values)) return inside.fail("a pointer is null");
    std::vector<Member> found;
    for (size_t n = 0; n < count; ++n) {
      const auto member = inside.member(references[n]);
      if (!member || !wanted(*member)) return inside.fail(fmt::format("value reference {} is nothing of the kind", references[n]));
      found.push_back(*member);
    }
    for (size_t n = 0; n < count; ++n) action(inside, found[n], n);
    return Status::Ok;
  });
}

bool is_countdown(const Member& member) { return member.kind == TerminalMember::TxClock && member.is_of_the_line(); }

}  // namespace

IPOS_FMI_EXPORT int fmi3GetBinary(void* instance, const Reference references[], size_t count, size_t sizes[],
                                  const uint8_t* values[], size_t value_count) {
  return for_members(
      instance, references, count, sizes != nullptr && values != nullptr && count == value_count,
      [](const Member& member) { return member.kind == TerminalMember::TxData; },
      [&](Instance&, const Member& member, size_t n) {
        const std::string& out = member.terminal->buffers.out;
        sizes[n] = out.size();
        values[n] = reinterpret_cast<const uint8_t*>(out.data());
      });
}
IPOS_FMI_EXPORT int fmi3SetBinary(void* instance, const Reference references[], size_t count, const size_t sizes[],
                                  const uint8_t* const values[], size_t value_count) {
  bool good = sizes != nullptr && values != nullptr && count == value_count;
  for (size_t n = 0; good && n < count; ++n) good = sizes[n] == 0 || values[n] != nullptr;
  return for_members(
      instance, references, count, good, [](const Member& member) { return member.kind == TerminalMember::RxData; },
      [&](Instance&, const Member& member, size_t n) {
        member.terminal->buffers.in.assign(reinterpret_cast<const char*>(values[n]), sizes[n]);
      });
}

// Of triggered ones that are outputs: active once for what there is.
IPOS_FMI_EXPORT int fmi3GetClock(void* instance, const Reference references[], size_t count, bool values[]) {
  return for_members(
      instance, references, count, values != nullptr,
      [](const Member& member) { return member.kind == TerminalMember::TxClock && !member.is_of_the_line(); },
      [&](Instance&, const Member& member, size_t n) {
        BusTerminal& terminal = *member.terminal;
        values[n] = !terminal.buffers.out.empty() && !terminal.fetched;
        terminal.fetched |= values[n];
      });
}
// They cannot be deactivated again: the end of the event does that (canBeDeactivated is false).
IPOS_FMI_EXPORT int fmi3SetClock(void* instance, const Reference references[], size_t count, const bool values[]) {
  return for_members(
      instance, references, count, values != nullptr,
      [](const Member& member) { return member.kind == TerminalMember::RxClock || is_countdown(member); },
      [&](Instance&, const Member& member, size_t n) {
        (is_countdown(member) ? member.terminal->fetched : member.terminal->buffers.rx_active) |= values[n];
      });
}

IPOS_FMI_EXPORT int fmi3GetIntervalDecimal(void* instance, const Reference references[], size_t count, double values[], int known[]) {
  return for_members(instance, references, count, values != nullptr && known != nullptr, is_countdown,
                     [&](Instance& inside, const Member& member, size_t n) {
                       const Instance::Interval interval = inside.interval(*member.terminal);
                       values[n] = static_cast<double>(interval.length) * 1e-9;
                       known[n] = static_cast<int>(interval.known);
                     });
}
IPOS_FMI_EXPORT int fmi3GetIntervalFraction(void* instance, const Reference references[], size_t count, uint64_t counters[],
                                            uint64_t resolutions[], int known[]) {
  return for_members(instance, references, count, counters != nullptr && resolutions != nullptr && known != nullptr, is_countdown,
                     [&](Instance& inside, const Member& member, size_t n) {
                       const Instance::Interval interval = inside.interval(*member.terminal);
                       counters[n] = static_cast<uint64_t>(interval.length);
                       resolutions[n] = static_cast<uint64_t>(ipos::runtime::kSecond);
                       known[n] = static_cast<int>(interval.known);
                     });
}

// Shifts of clocks, and intervals that are the importer's.
#define IPOS_FMI3_CLOCK(name, ...)                                                                       \
  IPOS_FMI_EXPORT int fmi3##name(void* instance, const Reference[], size_t count __VA_OPT__(, ) __VA_ARGS__) { \
    return no_values(instance, Call::Clocks, count);                                                          \
  }
IPOS_FMI3_CLOCK(GetShiftDecimal, double[])
IPOS_FMI3_CLOCK(GetShiftFraction, uint64_t[], uint64_t[])
IPOS_FMI3_CLOCK(SetIntervalDecimal, const double[])
IPOS_FMI3_CLOCK(SetIntervalFraction, const uint64_t[], const uint64_t[])
IPOS_FMI3_CLOCK(SetShiftDecimal, const double[])
IPOS_FMI3_CLOCK(SetShiftFraction, const uint64_t[], const uint64_t[])

// Signals of a plant as the C functions number them: a station, a kind, and a number in it. What they are, and how each is
// read and written, is runtime/signals.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/plant/actions.hpp"
#include "runtime/signals/find.hpp"

namespace ipos::library {

using runtime::Station;
using signals::Refusal;

// As ipos_plant_kind.
enum class Kind : uint8_t { Any, Variable, Parameter, Input, Output, Analog, State, Word, Signal, Shaft };
inline constexpr Kind kLastKind = Kind::Shaft;

// Which signal: plain numbers, so that a record of what was done can hold it.
struct SignalId {
  uint32_t station = 0;
  Kind kind = Kind::Variable;
  uint32_t number = 0;  // signals::Signal::number; 0 of kind Signal, which has only a name
  bool operator==(const SignalId&) const = default;
};

// Gateways are numbered after the stations with a drive. They have power and signals, which can only be read.
size_t station_count(const runtime::Plant& plant);
// Lines have the numbers kLine + 0 and up, CAN lines first, then serial ones, then PROFIBUS. They have signals, which can only be read.
inline constexpr uint32_t kLine = 0x8000'0000;
runtime::Bus* line_of(const runtime::Plant& plant, uint32_t station);  // nullptr: it is none
bool has_signals(const runtime::Plant& plant, uint32_t station);       // a station, gateway or line of this number is there
runtime::Gateway* gateway_of(const runtime::Plant& plant, uint32_t station);  // nullptr: it is none
std::string station_names(const runtime::Plant& plant);                       // "saw, feed"

// The error says what there is instead.
tl::expected<SignalId, std::string> find_id(const runtime::Plant& plant, uint32_t station, Kind kind,
                                            std::string_view name);
// Nothing when the plant has none: numbers may come from anywhere. `name` is that of kind Signal.
std::optional<signals::Signal> signal_of(const runtime::Plant& plant, const SignalId& id, std::string_view name = {});

// Of a signal that can be written; nothing for one that cannot.
std::optional<SignalId> id_of(const runtime::Plant& plant, const signals::Signal& signal);

// What the station has of this kind; of variables those of the program, member by member, or only the members of the whole
// `part`.
std::vector<std::string> signal_names(const runtime::Plant& plant, uint32_t station, Kind kind,
                                      std::optional<std::string_view> part = std::nullopt);

}  // namespace ipos::library

// A long mixed run of one axis: orders drawn from a seed, plausible ones and any 32-bit ones, and the hash of
// all states it passes through.
#pragma once

#include <cstdint>
#include <random>

#include "runtime/motion/axis.hpp"

namespace ipos::tests {

// Detailed: plausible, with real control, loads by speed and place, brake times and a second mass.
enum class Taste : uint8_t { Plausible, Any, Detailed };

// Distributions of the standard library differ between vendors; the bits of the generator do not.
runtime::AxisOrder draw_order(std::mt19937_64& random, Taste taste);
runtime::MachineData draw_machine(std::mt19937_64& random, Taste taste);

// FNV-1a over every member.
uint64_t add_to_hash(uint64_t hash, const runtime::AxisState& state);

// Hash of `ticks` milliseconds, a new order every 1..400 ms.
uint64_t hash_of_run(uint64_t seed, uint64_t ticks, Taste taste);

}  // namespace ipos::tests

// What every image and every accepted program must keep to, whatever made it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tests/fuzz/fuzz.hpp"
#include "tests/fuzz/valid_code.hpp"
#include "vm/image/image.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {

// Limits of a unit by its number in the image; nothing for a number that is no unit.
std::optional<vm::Limits> limits_of(uint8_t unit);

// Writing and reading, and disassembling and assembling, give the same image again.
void check_round_trips(const vm::Image& image);

// Runs all tasks of a program with a host that answers at random after `seed`, in pieces of at most `piece`
// commands. Whatever happens, the machine has to stay sound; the result tells its final state and must not
// depend on `piece`.
uint64_t run_program(const vm::VerifiedImage& program, uint64_t seed, uint32_t piece);

// How many interrupt routines run_program has seen running, over all its calls.
uint64_t routines_begun();

// The same in big pieces and in single steps; both must agree.
void check_execution(const vm::VerifiedImage& program, uint64_t seed);

}  // namespace ipos::tests

// The interpreter of the simulation with the orders of orders.h: what the file for firmware must equal, state by state.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "tests/embed/orders.h"

namespace ipos::tests {

// A program with all that its run depends on.
struct OrderedRun {
  std::string name;
  std::vector<uint8_t> image;
  uint32_t seed = 1;
  uint32_t ticks = 40;
};

// Programs of commands by chance that the verifier accepts, for units with two and three tasks.
OrderedRun random_run(uint32_t number);
// Every language program that compiles, and the examples.
std::vector<OrderedRun> language_runs();

// The machine is behind a pointer: the size of one is another in a test of the small library.
class Reference {
 public:
  explicit Reference(const OrderedRun& run);
  ~Reference();

  // A tick and the order after it; false: the program has a fault, and nothing follows.
  bool tick();
  std::vector<uint8_t> state() const;
  std::string fault_reason() const;

 private:
  struct Rig;
  std::unique_ptr<Rig> rig_;
};

// The hash of a whole run, as tests/embedding/firmware_run.c prints it.
uint32_t reference_hash(const OrderedRun& run);

}  // namespace ipos::tests

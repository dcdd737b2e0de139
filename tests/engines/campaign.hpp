// Many pairs (pair.hpp): what they have executed and where the first difference was.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <set>
#include <string>
#include <vector>

#include "vm/fast/predecode.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tests {

// A program with all that its orders depend on.
struct EngineProgram {
  std::string name;
  std::vector<uint32_t> code;
  vm::Limits limits;
  uint64_t seed = 0;
  uint32_t orders = 0;
};

// As lines of text, so that a program of another processor can read what this one has made. read() stops at
// the end of what is well formed.
void write(std::ostream& out, const EngineProgram& program);
bool read(std::istream& in, EngineProgram& program);

class EngineCampaign {
 public:
  void run(const EngineProgram& program);

  // "3 programs, 3 of them as machine code, ..."
  std::string summary() const;

  uint64_t programs = 0;
  uint64_t native = 0;  // of them as machine code, too
  uint64_t orders = 0;
  uint64_t commands = 0;
  std::set<vm::fast::Operation> operations;  // of the table, that were chosen in a program at least once
  std::string difference;                    // the first; empty: none
};

}  // namespace ipos::tests

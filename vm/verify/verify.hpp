// The verifier: the only maker of VerifiedImage, which is all the interpreter accepts. After it every command
// is known, whole, within the limits of the unit, and every jump leads to the start of a command, so
// execution needs no checks but those on values (indirect numbers, division by zero, call depth).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "vm/host/build.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::vm {

// What a unit type allows; the rows stand in stdlib/unit_types.def.
struct Limits {
  uint16_t variables = 0;      // H0 .. variables - 1
  uint16_t program_words = 0;  // longest code
  uint8_t tasks = 0;           // 1..3
  uint8_t call_depth = 0;      // nested CALLs of one task
};

enum class Rule : uint8_t {
#define RULE(code, name, meaning) name = code,
#include "vm/verify/rules.def"
};

struct Violation {
  Rule rule;
  uint32_t address;  // word address of the command
};

// "V03" and the meaning of a rule.
struct RuleInfo {
  Rule rule;
  const char* code;
  const char* meaning;
};
std::span<const RuleInfo> rule_table();
const RuleInfo& info(Rule rule);

class VerifiedImage {
 public:
  std::span<const uint32_t> code() const { return code_; }
  const Limits& limits() const { return limits_; }

 private:
  friend struct Verification verify(std::span<const uint32_t>, const Limits&, std::span<Violation>);
  VerifiedImage(std::span<const uint32_t> code, const Limits& limits) : code_(code), limits_(limits) {}

  std::span<const uint32_t> code_;
  Limits limits_;
};

struct Verification {
  std::optional<VerifiedImage> image;  // set when there is no violation
  uint32_t violations = 0;             // how many there are, also beyond those that fitted
};

// Checks all code. Violations are written to `out`, as many as fit, those of labels last. No heap; uses
// a bit of stack for each word of the longest program (kMaxProgramWords). The verified image refers to
// `code`, which must stay alive and unchanged while in use.
Verification verify(std::span<const uint32_t> code, const Limits& limits, std::span<Violation> out);

}  // namespace ipos::vm

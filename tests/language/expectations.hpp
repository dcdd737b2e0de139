// The expectations a language program states in its comments, see README.md.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace ipos::tests {

struct ExpectedValue {
  uint32_t line;
  std::string variable;  // symbol, symbol[n] or Hn
  int32_t value;
  std::optional<int64_t> at;  // ns; at the end of the program when empty
};

struct ExpectedDiagnostic {
  uint32_t line;
  std::string code;
  bool operator==(const ExpectedDiagnostic&) const = default;
};

struct ExpectedFault {
  uint32_t line;
  int number;
};

struct Expectations {
  std::string unit;
  uint32_t speed = 1000;
  std::vector<ExpectedValue> values;
  std::vector<ExpectedDiagnostic> diagnostics;
  std::optional<ExpectedFault> fault;
  std::vector<std::string> mistakes;  // comments that start like an expectation and are none

  bool empty() const { return values.empty() && diagnostics.empty() && !fault; }
};

Expectations read_expectations(std::string_view source);

}  // namespace ipos::tests

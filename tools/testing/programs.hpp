// Programs of tests: each source is compiled once for a unit, however many tests use it. Nothing is printed;
// messages stay with the program. May be asked from several threads.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/input/program.hpp"
#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

struct Program {
  std::optional<vm::Image> image;
  const stdlib::UnitType* unit = nullptr;
  std::string messages;                         // as the compiler prints them
  std::vector<ExpectedDiagnostic> diagnostics;  // in the order of lines; 1 for the program as a whole
};

class Programs {
 public:
  explicit Programs(CompileFlags flags) : flags_(std::move(flags)) {}

  // A source or an image. `unit` is null where the source decides.
  std::shared_ptr<const Program> load(const std::string& path, const stdlib::UnitType* unit);
  bool allow_fmu() const { return flags_.allow_fmu; }

 private:
  Program make(const std::string& path, const stdlib::UnitType* unit) const;

  CompileFlags flags_;
  std::mutex mutex_;
  std::map<std::pair<std::string, const stdlib::UnitType*>, std::shared_ptr<const Program>> known_;
};

}  // namespace ipos::tools::testing

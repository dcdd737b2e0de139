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

#include "runtime/unit/program_shelf.hpp"
#include "tools/input/program.hpp"
#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

struct Program {
  std::optional<vm::Image> image;
  const stdlib::UnitType* unit = nullptr;
  std::string messages;                         // as the compiler prints them
  std::vector<ExpectedDiagnostic> diagnostics;  // in the order of lines; 1 for the program as a whole
};

// The program of a station: a source or an image, and its unit, which is null where the source decides.
using ProgramName = std::pair<std::string, const stdlib::UnitType*>;
using KnownPrograms = std::map<ProgramName, std::shared_ptr<const Program>>;

// As tests compile a source.
compiler::Compilation compile_for_test(const ProgramName& name, std::string text, const CompileFlags& flags);

class Programs {
 public:
  // `known` are not looked for any more.
  explicit Programs(CompileFlags flags, KnownPrograms known = {}) : flags_(std::move(flags)), known_(std::move(known)) {}

  std::shared_ptr<const Program> load(const std::string& path, const stdlib::UnitType* unit);
  bool allow_fmu() const { return flags_.allow_fmu; }
  // How the plants of tests are executed; what is made of a program they share.
  const runtime::Execution& execution() const { return execution_; }
  // When nobody loads any more.
  const KnownPrograms& known() const { return known_; }

 private:
  Program make(const ProgramName& name) const;

  CompileFlags flags_;
  runtime::Execution execution_{.shelf = std::make_shared<runtime::ProgramShelf>()};
  std::mutex mutex_;
  KnownPrograms known_;
};

}  // namespace ipos::tools::testing

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
  // What the programs of a plant say together, for who wants it at the end: looked for once for each file of a plant.
  void want_objects() { wants_objects_ = true; }
  void look_at_objects(const std::string& plant_path, const runtime::Plant& plant);
  std::vector<std::string> told_objects() const;  // each once, in the order of the files
  bool allow_fmu() const { return flags_.allow_fmu; }
  // How the plants of tests are executed; what is made of a program they share.
  const runtime::Execution& execution() const { return execution_; }
  // When nobody loads any more.
  const KnownPrograms& known() const { return known_; }

 private:
  Program make(const ProgramName& name) const;

  CompileFlags flags_;
  runtime::Execution execution_{.shelf = std::make_shared<runtime::ProgramShelf>()};
  bool wants_objects_ = false;
  mutable std::mutex mutex_;
  std::map<std::string, std::vector<std::string>> objects_;  // by the file of the plant
  KnownPrograms known_;
};

}  // namespace ipos::tools::testing

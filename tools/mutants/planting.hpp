// The programs of some tests, and the mistakes that can be planted into them. A program is compiled once; each mistake is a
// change of its checked tree, of which code is generated again.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>
#include <vector>

#include "compiler/codegen/codegen.hpp"
#include "compiler/compile.hpp"
#include "tools/mutants/mutant.hpp"
#include "tools/testing/programs.hpp"

namespace ipos::tools::mutants {

struct Lines {
  std::string file;
  uint32_t first = 0;
  uint32_t last = 0;
};

// One source, compiled for one unit.
class PlantedProgram {
 public:
  PlantedProgram(testing::ProgramName name, compiler::Compilation compiled, compiler::GenerateOptions options);

  const testing::ProgramName& name() const { return name_; }
  const compiler::SourceMap& sources() const { return *compiled_.sources; }
  const std::vector<compiler::mutants::Change>& changes() const { return changes_; }

  // With the change. Nothing where it does not compile, is refused by the verifier, or is the same code. May be asked from
  // several threads.
  std::optional<vm::Image> image_with(size_t change);

 private:
  testing::ProgramName name_;
  compiler::Compilation compiled_;
  compiler::GenerateOptions options_;
  std::vector<compiler::mutants::Change> changes_;
  std::mutex mutex_;
};

// A mistake, and where it is: a header is part of several programs, and each has it.
struct Planted {
  Mutant mutant;
  std::vector<std::pair<PlantedProgram*, size_t>> in;  // number of the change
  std::vector<Lines> executed;
  std::vector<Lines> functions;
};

class Planting {
 public:
  // Programs that do not compile, and images, have none.
  Planting(const std::vector<testing::TestCase>& tests, const CompileFlags& flags);

  // In the order of files and lines; equivalent ones have their fate.
  std::vector<Planted>& mutants() { return mutants_; }
  // The sources and headers of the programs, by the paths that mutants have.
  std::map<std::string, std::string> sources() const;
  // Marks that say nothing, as messages.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void find(PlantedProgram& program);
  void leave_out_doubles();
  void take_marks();

  std::vector<std::unique_ptr<PlantedProgram>> programs_;
  std::vector<Planted> mutants_;
  std::map<std::tuple<std::string, uint32_t, uint32_t, std::string>, size_t> known_;  // by place and text, while they are found
  std::vector<std::string> notes_;
};

}  // namespace ipos::tools::mutants

// The files of a plant in folders: the plant file, the programs that it names and what these include beside themselves,
// its tests and sessions. Only these are written; standard C++ and tools/cli are all that is asked of the system.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/input/plant_input.hpp"
#include "tools/serve/host/outside.hpp"

namespace ipos::tools::serve {

// A test with its script; mistakes as of testing::debugged_test().
debug::Debuggee debuggee_of(const sessions::OfTest& test, const CompileFlags& compile);

class PlantFiles final : public Files {
 public:
  // `path`: of the plant file, or of a single program or image. `read_only`: why nothing may be written; empty: it may.
  // `test`: whose script runs beside the plant.
  PlantFiles(std::string path, CompileFlags compile, std::string read_only = {},
             std::optional<sessions::OfTest> test = {});

  std::vector<Entry> list() override;
  std::optional<std::string> compiled(const std::string& file) override;
  std::optional<std::string> text(const std::string& file) override;
  std::string write(const std::string& file, const std::string& text) override;
  Build build() override;
  std::string test(const std::vector<std::string>& files) override;
  Texts templates() override;
  std::optional<sessions::OfTest> test_beside() override { return test_; }

 private:
  std::vector<std::string> programs() const;  // that the plant names now, as files
  bool is_near(const std::string& file, const std::vector<std::string>& programs) const;
  std::string place_of_new(const std::string& file) const;  // a Mistake: not there

  std::string path_;
  CompileFlags compile_;
  std::string read_only_;
  std::optional<sessions::OfTest> test_;
  std::set<std::string> read_;  // by the builds so far
};

}  // namespace ipos::tools::serve

// Small plants for the debugger's tests, compiled from text.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "compiler/compile.hpp"
#include "runtime/plant/plant.hpp"
#include "tools/debugger/debugger.hpp"

namespace ipos::tests {

// unit1, unit2, ... of type mdxb with a program each, named P1.IPC, P2.IPC, ...
inline tools::debug::MakePlant plant_of(const std::vector<std::string>& programs) {
  std::string text;
  std::vector<std::optional<vm::Image>> images;
  for (const std::string& program : programs) {
    const std::string number = std::to_string(images.size() + 1);
    text +=
        "[[station]]\nname = \"unit" + number + "\"\nunit = \"mdxb\"\nprogram = \"P" + number + ".IPC\"\n";
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit("mdxb");
    images.push_back(compiler::compile("P" + number + ".IPC", "", program, options).image);
  }
  return [text, images] {
    std::vector<runtime::PlantError> errors;
    return std::make_unique<runtime::Plant>(runtime::read_plant_file(text).plant, images, std::nullopt,
                                            errors);
  };
}

// Says nothing and never interrupts.
struct Quiet : tools::debug::FrontEnd {
  tools::debug::Json save() override { return nullptr; }
  void load(const tools::debug::Json&) override {}
  bool keep_going() override { return true; }
  void output(const std::string& more) override { text += more; }
  std::string text;
};

}  // namespace ipos::tests

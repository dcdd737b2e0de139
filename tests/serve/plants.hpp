// A plant of two stations on a line, one of them with a program.
#pragma once

#include <gtest/gtest.h>

#include "compiler/compile.hpp"
#include "tools/debugger/debugger.hpp"

namespace ipos::tests {

// Line numbers count from 1; line 1 is the header. DI02 and DI03 of a MOVIDRIVE as delivered: CW and enable.
inline constexpr const char* kProgram = R"(#include <const.h>
long lCount;
long lTable[3];
main()
{
  while (1)
  {
    lCount++;
    lTable[1] = lCount * 2;
    _Wait(5);
  }
}
)";
inline constexpr const char* kPlant = R"(
[[bus]]
name = "sbus"
kind = "can"
[[station]]
name = "saw"
unit = "md60a"
program = "SAW.IPC"
sbus = "sbus"
[station.inputs]
DI00 = 1
[[station]]
name = "lift"
unit = "mdxb"
sbus = "sbus"
[station.parameters]
P881 = 2
[[wire]]
from = "saw.DO01"
to = "lift.DI05"
)";

// The first station has the program, the others have none.
inline tools::debug::MakePlant plant_of(const std::string& text, const std::optional<vm::Image>& program = std::nullopt) {
  return [text, program] {
    runtime::PlantFileResult file = runtime::read_plant_file(text);
    std::vector<runtime::PlantError> errors = file.errors;
    std::vector<std::optional<vm::Image>> images(file.plant.stations.size());
    images[0] = program;
    auto plant = std::make_unique<runtime::Plant>(file.plant, std::move(images), std::nullopt, errors);
    EXPECT_TRUE(errors.empty()) << errors.front().text;
    return plant;
  };
}

inline tools::debug::MakePlant the_plant() {
  compiler::CompileOptions options;
  options.unit = stdlib::find_unit("md60a");
  return plant_of(kPlant, compiler::compile("SAW.IPC", "", kProgram, options).image);
}

}  // namespace ipos::tests

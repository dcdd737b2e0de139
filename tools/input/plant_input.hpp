// Plants for the verbs: a plant file with its programs, or a single program as a plant of one station.
// Messages go to stderr; errors end the verb.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/input/engine.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

struct PlantInput {
  std::string path;
  runtime::PlantFile file;
  std::vector<std::optional<vm::Image>> programs;
};

// Reads the plant, compiles or loads its programs. All mistakes that can be found without a run are told before the
// Failure: of the file, of its programs, and what the units refuse. A single program becomes a station named after the file;
// with `sbus` it is alone on a line of that name.
PlantInput read_plant_input(const std::string& path, const CompileFlags& compile,
                            const std::string& sbus = {});

// Builds it. Only a run keeps in the memories of its units what it changes; a verb that looks takes copies.
std::unique_ptr<runtime::Plant> make_plant(PlantInput input, runtime::FileUse memories,
                                           std::optional<vm::Rates> rates = {},
                                           const runtime::Execution& execution = execution_of(),
                                           BuildRecord* record = nullptr);

}  // namespace ipos::tools

// Compiling and loading without a word on the terminal.
#include "tools/testing/programs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "compiler/compile.hpp"
#include "compiler/diag/once.hpp"
#include "compiler/diag/render.hpp"
#include "runtime/unit/program_image.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools::testing {
namespace {

Program read_image(const std::string& path, const std::string& bytes) {
  Program program;
  auto image = runtime::read_program_image({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
  if (!image) {
    program.messages = fmt::format("{}: image {}\n", path, image.error());
    return program;
  }
  program.unit = stdlib::find_unit(image->unit);
  program.image = *std::move(image);
  return program;
}

}  // namespace

std::shared_ptr<const Program> Programs::load(const std::string& path, const stdlib::UnitType* unit) {
  const std::lock_guard lock(mutex_);
  auto& known = known_[{path, unit}];
  if (!known) known = std::make_shared<const Program>(make({path, unit}));
  return known;
}

void Programs::look_at_objects(const std::string& plant_path, const runtime::Plant& plant) {
  if (!wants_objects_) return;
  {
    const std::lock_guard lock(mutex_);
    if (!objects_.try_emplace(plant_path).second) return;
  }
  std::vector<std::string> texts;
  for (const ObjectFinding& one : object_findings(plant)) texts.push_back(text_of(one));
  const std::lock_guard lock(mutex_);
  objects_[plant_path] = std::move(texts);
}

std::vector<std::string> Programs::told_objects() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> all;
  for (const auto& [plant, texts] : objects_)
    for (const std::string& text : texts)
      if (std::find(all.begin(), all.end(), text) == all.end()) all.push_back(text);
  return all;
}

compiler::Compilation compile_for_test(const ProgramName& name, std::string text, const CompileFlags& flags) {
  compiler::CompileOptions options = options_of(flags);
  if (name.second != nullptr) options.unit = name.second;
  options.is_unit_value = nullptr;  // a test names errors and warnings
  return compiler::compile(name.first, name.first, std::move(text), options);
}

Program Programs::make(const ProgramName& name) const {
  const std::string& path = name.first;
  Program program;
  const auto text = load_file(path);
  if (!text) {
    program.messages = fmt::format("{}: {}\n", path, text.error());
    return program;
  }
  if (!is_source(path)) return read_image(path, *text);
  compiler::Compilation compiled = compile_for_test(name, *text, flags_);
  const auto& all = compiled.diagnostics.all();
  program.messages = compiler::render_text(compiler::each_once(all, *compiled.sources), *compiled.sources, false);
  for (const compiler::Diagnostic& diagnostic : all) {
    const uint32_t line = compiled.sources->position(diagnostic.span.begin).line;
    program.diagnostics.push_back({std::max(line, 1U), std::string(compiler::info(diagnostic.diag).code)});
  }
  std::sort(program.diagnostics.begin(), program.diagnostics.end());
  program.unit = compiled.unit;
  program.image = std::move(compiled.image);
  return program;
}

}  // namespace ipos::tools::testing

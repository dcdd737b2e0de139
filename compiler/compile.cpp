// Front end, semantic check and code generation, one after the other; a stage runs when the one before it was
// good.
#include "compiler/compile.hpp"

#include <algorithm>

#include "compiler/codegen/codegen.hpp"
#include "compiler/parse/parse.hpp"
#include "compiler/sema/sema.hpp"
#include "stdlib/headers.hpp"

namespace ipos::compiler {
namespace {

// The headers of MOVIDRIVE B (IPOSplus p. 29).
bool includes_b_headers(const SourceMap& sources) {
  return std::any_of(sources.files().begin(), sources.files().end(), [](const auto& file) {
    return file->path.empty() && (file->name == "constb.h" || file->name == "iob.h");
  });
}

}  // namespace

Compilation compile(const std::string& name, const std::string& path, std::string text,
                    const CompileOptions& options, FrontEnd* front) {
  FrontEnd unwanted;
  if (front == nullptr) front = &unwanted;
  Compilation out;
  out.diagnostics = Diagnostics(options.warnings);
  PreprocessOptions preprocessing;
  preprocessing.include_dirs = options.include_dirs;
  preprocessing.defines = options.defines;
  preprocessing.headers = stdlib::built_in_files();
  preprocessing.read_file = options.read_file;
  preprocessing.list_files = options.list_files;

  const SourceFile& main = out.sources->add(name, path, std::move(text));
  front->text = preprocess(*out.sources, main, preprocessing, out.diagnostics);
  if (front->text.complete) front->tree = parse_tokens(*out.sources, front->text, out.diagnostics);
  out.unit = options.unit;
  if (out.unit == nullptr)
    out.unit = includes_b_headers(*out.sources) ? &stdlib::unit_with(stdlib::Trait::NewVariables) : &stdlib::usual_unit();
  if (out.diagnostics.has_errors()) return out;
  out.program = check(front->tree, *out.unit, *out.sources, out.diagnostics, options.is_unit_value);
  if (!out.program) return out;
  auto generated = generate(*out.program, *out.unit, *out.sources, {options.atomic, options.as_written}, out.diagnostics);
  if (!generated) return out;
  (out.diagnostics.has_errors() ? out.too_long : out.image) = std::move(generated->image);
  out.map = std::move(out.program->map);
  for (checked::MapEntry& row : generated->temporaries)
    out.map.insert(std::upper_bound(out.map.begin(), out.map.end(), row,
                                    [](const checked::MapEntry& a, const checked::MapEntry& b) {
                                      return a.number < b.number;
                                    }),
                   std::move(row));
  return out;
}

}  // namespace ipos::compiler

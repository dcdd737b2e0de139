// Programs for the verbs: source files are compiled, images are read. Messages go to stderr.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "compiler/asm/disassembler.hpp"
#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "tools/cli/verb.hpp"
#include "tools/input/record.hpp"
#include "vm/image/image.hpp"

namespace ipos::tools {

struct CompileFlags {
  std::vector<std::string> include_dirs;  // -I
  std::vector<std::string> defines;       // -D NAME=V
  std::vector<std::string> warnings;      // -W...
  std::string unit;                       // --unit; empty: from the source
  bool atomic = false;                    // --atomic
  std::string optimization = "1";         // -O: 0 or 1
  std::string diagnostics = "text";       // text, json or sarif
  bool allow_fmu = false;                 // --allow-fmu: machines of the plant may be programs of others
  BuildRecord* record = nullptr;          // takes what is read and told, in place of sources.hpp and standard error
};

// -I, -D, -W, --unit and --diagnostics, for every verb that compiles.
void add_compile_options(cli::Verb& verb, CompileFlags& flags);

// These, and --allow-fmu, for every verb that runs a plant.
void add_plant_options(cli::Verb& verb, CompileFlags& flags);

// What the compiler is told; an unknown warning or unit is a Failure.
compiler::CompileOptions options_of(const CompileFlags& flags);

// *.IPC in any case.
bool is_source(std::string_view path);

// Compiles; on errors they are printed and a Failure ends the verb.
vm::Image compile_file(const std::string& path, const CompileFlags& flags);

// The files that a source includes, those that its headers include, too; none of the built-in ones. Whatever
// else is wrong with it is not told.
std::vector<std::string> included_files(const std::string& path, const CompileFlags& flags = {});

// Reads an .ipx; refused images are a Failure with the place of the damage.
vm::Image load_image(const std::string& path);

// Either of the two.
vm::Image load_program(const std::string& path, const CompileFlags& flags);

// Text of a stage of the compilation: tokens, ast, asm, map or listing.
std::string emit_stage(const std::string& path, const CompileFlags& flags, const std::string& stage);

// Word addresses, code words and commands below the source lines they come from, as far as those can be read.
std::string program_listing(const vm::Image& image, compiler::VariableNames names);

// Prints to stderr in the form asked for: text, json or sarif.
void print_diagnostics(const compiler::SourceMap& sources, const compiler::Diagnostics& diagnostics,
                       const std::string& form);

// Text of everything in an image.
std::string dump_image(const vm::Image& image);

// Prints the verifier's findings for the image's unit; true when there are none.
bool verify_image(const std::string& path, const vm::Image& image);

}  // namespace ipos::tools

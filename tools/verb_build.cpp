// ipos build: from source to image, and every stage on the way in text.
#include <fmt/format.h>

#include <filesystem>

#include "tools/failure.hpp"
#include "tools/files.hpp"
#include "tools/program.hpp"
#include "tools/verbs.hpp"

namespace ipos::tools {
namespace {

struct BuildFlags {
  std::string file;
  std::string output;
  std::string emit;
  CompileFlags compile;
};

int build(const BuildFlags& flags) {
  if (!is_source(flags.file)) throw Failure(kUsage, fmt::format("{}: sources are called *.IPC", flags.file));
  if (!flags.emit.empty() && flags.emit != "image") {
    fmt::print("{}", emit_stage(flags.file, flags.compile, flags.emit));
    return kGood;
  }
  const vm::Image image = compile_file(flags.file, flags.compile);
  if (flags.emit == "image") {
    fmt::print("{}", dump_image(image));
    return kGood;
  }
  if (!verify_image(flags.file, image))
    throw Failure(kInternal, "the compiler made an image the verifier refuses");
  const std::string output = flags.output.empty()
                                 ? std::filesystem::path(flags.file).replace_extension(".ipx").string()
                                 : flags.output;
  write_file(output, vm::write_image(image));
  return kGood;
}

}  // namespace

void add_compile_options(CLI::App& verb, CompileFlags& flags) {
  verb.add_option("-I", flags.include_dirs, "folder for #include")->allow_extra_args(false);
  verb.add_option("-D", flags.defines, "NAME=VALUE, as #define")->allow_extra_args(false);
  verb.add_option("-W", flags.warnings, "warning by name: -Wunused-variable, -Wno-..., -Werror")
      ->allow_extra_args(false);
  verb.add_option("--unit", flags.unit, "unit type: md60a, compact, mc07 or mdxb");
  verb.add_option("--diagnostics", flags.diagnostics, "text, json or sarif")
      ->check(CLI::IsMember({"text", "json", "sarif"}));
}

void add_build(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<BuildFlags>();
  CLI::App* verb = app.add_subcommand("build", "compile a source file to an image");
  verb->add_option("FILE", flags->file, "source, *.IPC")->required();
  verb->add_option("-o", flags->output, "image to write; default: the source's name with .ipx");
  verb->add_option("--emit", flags->emit, "print a stage instead: tokens, ast, asm, image, map or listing")
      ->check(CLI::IsMember({"tokens", "ast", "asm", "image", "map", "listing"}));
  add_compile_options(*verb, flags->compile);
  verb->footer("Example:\n  ipos build SCOM1.IPC --emit=asm");
  verb->callback([flags, &exit_code] { exit_code = build(*flags); });
}

}  // namespace ipos::tools

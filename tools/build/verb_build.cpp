// ipos build: from source to image, and every stage on the way in text.
#include <fmt/format.h>

#include <filesystem>

#include "tools/build/c_text.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/program.hpp"

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
  const bool as_c = flags.emit == "c";
  if (!flags.emit.empty() && flags.emit != "image" && !as_c) {
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
  if (as_c) {
    const std::string text = c_text(image, flags.file);
    if (flags.output.empty())
      fmt::print("{}", text);
    else
      replace_file(flags.output, text);
    return kGood;
  }
  const std::string output = flags.output.empty()
                                 ? std::filesystem::path(flags.file).replace_extension(".ipx").string()
                                 : flags.output;
  replace_file(output, vm::write_image(image));
  return kGood;
}

}  // namespace

void add_build(cli::Verb& app) {
  auto flags = std::make_shared<BuildFlags>();
  cli::Verb& verb = app.verb("build", "compile a source file to an image");
  verb.option("FILE", flags->file, "source, *.IPC").required();
  verb.option("-o", flags->output, "image to write; default: the source's name with .ipx");
  verb.option("--emit", flags->emit, "print a stage instead: tokens, ast, asm, image, map or listing; c: the image as a C header, also to the file of -o")
      .one_of({"tokens", "ast", "asm", "image", "map", "listing", "c"});
  add_compile_options(verb, flags->compile);
  verb.footer("Example:\n  ipos build SCOM1.IPC --emit=asm");
  verb.runs([flags] { return build(*flags); });
}

}  // namespace ipos::tools

// ipos build: from source to image, and every stage on the way in text.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/build/c_text.hpp"
#include "tools/build/maps_report.hpp"
#include "tools/build/time_report.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

struct BuildFlags {
  std::string file;
  std::string output;
  std::string emit;
  bool time = false;
  bool maps = false;
  uint32_t speed = 0;
  std::string format = "text";
  CompileFlags compile;
};

// Of a program or of all programs of a plant.
int tell(const BuildFlags& flags) {
  if (flags.time && flags.maps) throw Failure(kUsage, "ask for one of --time and --maps");
  if (!flags.output.empty() || !flags.emit.empty()) throw Failure(kUsage, "--time and --maps print; they go with neither -o nor --emit");
  if (flags.maps && flags.speed != 0) throw Failure(kUsage, "--speed goes with --time");
  if (flags.time && flags.format == "dot") throw Failure(kUsage, "--format dot goes with --maps");
  const auto plant = make_plant(read_plant_input(flags.file, flags.compile), runtime::FileUse::Look);
  if (std::none_of(plant->stations().begin(), plant->stations().end(), [](const auto& one) { return one->image() != nullptr; }))
    throw Failure(kBadInput, fmt::format("{}: no station has a program", flags.file));
  const auto speed = flags.speed == 0 ? std::nullopt : std::optional(flags.speed);
  fmt::print("{}", flags.maps               ? maps_report(*plant, flags.format)
                   : flags.format == "json" ? time_json(*plant, speed)
                                            : time_table(*plant, speed));
  return kGood;
}

int build(const BuildFlags& flags) {
  if (flags.time || flags.maps) return tell(flags);
  if (flags.speed != 0 || flags.format != "text") throw Failure(kUsage, "--speed and --format go with --time and --maps");
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
  verb.flag("--time", flags->time,
            "print how many commands and ms each function and each turn of an endless loop takes at most; FILE may be a plant, *.toml");
  verb.option("--speed", flags->speed, "with --time: commands per ms of every task, instead of P938 and P939").between(1U, 1'000'000U);
  verb.flag("--maps", flags->maps, "print who reads and writes each variable, who calls whom, telegrams and states; FILE may be a plant");
  verb.option("--format", flags->format, "with --time and --maps: text or json; of maps also dot, for Graphviz").one_of({"text", "json", "dot"});
  add_compile_options(verb, flags->compile);
  verb.footer("Example:\n  ipos build SCOM1.IPC --emit=asm");
  verb.runs([flags] { return build(*flags); });
}

}  // namespace ipos::tools

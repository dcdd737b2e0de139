// ipos disasm: an image as assembler text that gives the same image again, or as a listing.
#include <fmt/format.h>

#include <map>

#include "compiler/asm/disassembler.hpp"
#include "compiler/source/source.hpp"
#include "tools/exit_codes.hpp"
#include "tools/files.hpp"
#include "tools/verbs.hpp"

namespace ipos::tools {
namespace {

using compiler::VariableNames;

const std::map<std::string, VariableNames> kNames{{"numbers", VariableNames::Numbers},
                                                  {"assembler", VariableNames::Assembler},
                                                  {"compiler", VariableNames::Compiler}};

}  // namespace

void add_disasm(CLI::App& app, int& exit_code) {
  auto file = std::make_shared<std::string>();
  auto names = std::make_shared<VariableNames>(VariableNames::Numbers);
  auto with_source = std::make_shared<bool>(false);
  CLI::App* verb = app.add_subcommand("disasm", "print an image as assembler text");
  verb->add_option("FILE", *file, "image, *.ipx")->required();
  verb->add_option("--names", *names, "system variables as numbers, assembler or compiler names")
      ->transform(CLI::CheckedTransformer(kNames));
  verb->add_flag("--listing", *with_source, "word addresses, code words and source lines instead");
  verb->footer("Example:\n  ipos disasm SCOM1.ipx --listing");
  verb->callback([file, names, with_source, &exit_code] {
    const vm::Image image = load_image(*file);
    fmt::print("{}", *with_source ? program_listing(image, *names) : compiler::disassemble(image, *names));
    exit_code = kGood;
  });
}

}  // namespace ipos::tools

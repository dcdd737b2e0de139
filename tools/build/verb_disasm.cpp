// ipos disasm: an image as assembler text that gives the same image again, or as a listing.
#include <fmt/format.h>

#include <map>

#include "compiler/asm/disassembler.hpp"
#include "compiler/source/source.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

using compiler::VariableNames;

const std::map<std::string, VariableNames> kNames{{"numbers", VariableNames::Numbers},
                                                  {"assembler", VariableNames::Assembler},
                                                  {"compiler", VariableNames::Compiler}};

}  // namespace

void add_disasm(cli::Verb& app) {
  auto file = std::make_shared<std::string>();
  auto names = std::make_shared<std::string>("numbers");
  auto with_source = std::make_shared<bool>(false);
  cli::Verb& verb = app.verb("disasm", "print an image as assembler text");
  verb.option("FILE", *file, "image, *.ipx").required();
  verb.option("--names", *names, "system variables as numbers, assembler or compiler names")
      .one_of({"numbers", "assembler", "compiler"});
  verb.flag("--listing", *with_source, "word addresses, code words and source lines instead");
  verb.footer("Example:\n  ipos disasm SCOM1.ipx --listing");
  verb.runs([file, names, with_source] {
    const vm::Image image = load_image(*file);
    const VariableNames form = kNames.at(*names);
    fmt::print("{}", *with_source ? program_listing(image, form) : compiler::disassemble(image, form));
    return kGood;
  });
}

}  // namespace ipos::tools

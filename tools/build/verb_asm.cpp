// ipos asm: assembler text to an image.
#include <fmt/format.h>

#include <filesystem>

#include "compiler/asm/assembler.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

void add_asm(cli::Verb& app) {
  auto file = std::make_shared<std::string>();
  auto output = std::make_shared<std::string>();
  auto diagnostics = std::make_shared<std::string>("text");
  cli::Verb& verb = app.verb("asm", "assemble text in the form 'ipos disasm' prints");
  verb.option("FILE", *file, "assembler text, or - for standard input").required();
  verb.option("-o", *output, "image to write; default: the text's name with .ipx");
  verb.option("--diagnostics", *diagnostics, "text, json or sarif").one_of({"text", "json", "sarif"});
  verb.footer("Example:\n  ipos asm SCOM1.ipa -o SCOM1.ipx");
  verb.runs([file, output, diagnostics] {
    compiler::SourceMap sources;
    compiler::Diagnostics found;
    const compiler::SourceFile& source = sources.add(*file, *file, read_file(*file));
    const auto image = compiler::assemble(source, found);
    print_diagnostics(sources, found, *diagnostics);
    if (!image) throw Failure(kBadInput, "");
    if (output->empty() && *file == "-") throw Failure(kUsage, "standard input needs -o FILE");
    replace_file(output->empty() ? std::filesystem::path(*file).replace_extension(".ipx").string() : *output,
                 vm::write_image(*image));
    return kGood;
  });
}

}  // namespace ipos::tools

// ipos verify: says whether an image would be run, and if not, what is wrong with it and where.
#include <fmt/format.h>

#include "tools/cli/exit_codes.hpp"
#include "compiler/diag/places.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

void add_verify(cli::Verb& app) {
  auto file = std::make_shared<std::string>();
  cli::Verb& verb = app.verb("verify", "check an image as the interpreter does before it runs it");
  verb.option("FILE", *file, "image, *.ipx").required();
  verb.footer("Example:\n  ipos verify SCOM1.ipx");
  verb.runs([file] {
    const vm::Image image = load_image(*file);
    if (!verify_image(*file, image)) return kFindings;
    fmt::print("{}: good, {} words\n", compiler::printable(*file), image.code.size());
    return kGood;
  });
}

}  // namespace ipos::tools

// ipos verify: says whether an image would be run, and if not, what is wrong with it and where.
#include <fmt/format.h>

#include "tools/exit_codes.hpp"
#include "tools/verbs.hpp"

namespace ipos::tools {

void add_verify(CLI::App& app, int& exit_code) {
  auto file = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("verify", "check an image as the interpreter does before it runs it");
  verb->add_option("FILE", *file, "image, *.ipx")->required();
  verb->footer("Example:\n  ipos verify SCOM1.ipx");
  verb->callback([file, &exit_code] {
    const vm::Image image = load_image(*file);
    if (!verify_image(*file, image)) {
      exit_code = kFindings;
      return;
    }
    fmt::print("{}: good, {} words\n", *file, image.code.size());
    exit_code = kGood;
  });
}

}  // namespace ipos::tools

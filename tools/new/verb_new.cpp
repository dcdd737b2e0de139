// ipos new: a folder to begin with: two drives on a bus, a test, what a CI server needs; or a copy of an
// example.
#include <fmt/format.h>

#include <filesystem>

#include "stdlib/spelling.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/examples/examples.hpp"

namespace ipos::tools {
namespace {

struct NewFlags {
  std::string folder;
  std::string example;
};

// Those of examples/NAME.
const NewFiles& example_files_of(const std::string& name) {
  if (const Example* example = find_example(name)) return example->files;
  std::vector<std::string_view> names;
  std::string known;
  for (const Example& example : all_examples()) {
    names.push_back(example.name);
    known += fmt::format("\n  {}", example.name);
  }
  const std::string_view meant = stdlib::nearest(name, names);
  throw Failure(kUsage, fmt::format("there is no example '{}'{}; there are{}", name,
                                    meant.empty() ? "" : fmt::format(", did you mean '{}'?", meant), known));
}

int make(const NewFlags& flags) {
  const NewFiles files = flags.example.empty() ? template_files() : example_files_of(flags.example);
  write_new_files(flags.folder, files);
  for (const auto& [path, text] : files)
    fmt::print("{}\n", (std::filesystem::path(flags.folder) / path).generic_string());
  fmt::print("\nNext:\n  cd {}\n  ipos test .\n", flags.folder);
  return kGood;
}

}  // namespace

void add_new(cli::Verb& program) {
  auto flags = std::make_shared<NewFlags>();
  cli::Verb& verb = program.verb("new", "make a folder to begin with: plant, programs, test, CI files");
  verb.option("DIR", flags->folder, "folder to make, or one without these files").required();
  verb.option("--from", flags->example, "copy an example instead, for example scom, hoist, jog")
      .offers([](const auto&) {
    std::vector<std::string> names;
    for (const Example& example : all_examples()) names.push_back(example.name);
    return names;
  });
  verb.footer("Example:\n  ipos new line\n  ipos new shaft --from hoist");
  verb.runs([flags] { return make(*flags); });
}

}  // namespace ipos::tools

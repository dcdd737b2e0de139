// ipos new: a folder to begin with: two drives on a bus, a test, what a CI server needs; or a copy of an
// example.
#include <fmt/format.h>

#include <filesystem>
#include <map>

#include "stdlib/embedded.hpp"
#include "stdlib/spelling.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"

namespace ipos::tools {

namespace new_project {
std::span<const stdlib::EmbeddedFile> embedded_files();
}
namespace examples {
std::span<const stdlib::EmbeddedFile> embedded_files();
}

namespace {

namespace fs = std::filesystem;

struct NewFlags {
  std::string folder;
  std::string example;
};

// Files of the template that lie elsewhere in a project.
constexpr std::pair<std::string_view, std::string_view> kPlaces[] = {
    {"github.yml", ".github/workflows/ipos.yml"},
    {"gitlab.yml", ".gitlab-ci.yml"},
};

using Files = std::map<std::string, std::string_view>;  // text by path

Files template_files() {
  Files files;
  for (const stdlib::EmbeddedFile& file : new_project::embedded_files()) {
    std::string path(file.name);
    for (const auto& [name, place] : kPlaces)
      if (path == name) path = place;
    files[path] = file.text;
  }
  return files;
}

// Those of examples/NAME.
Files example_files(const std::string& name) {
  Files files;
  std::vector<std::string_view> names;
  for (const stdlib::EmbeddedFile& file : examples::embedded_files()) {
    const size_t slash = file.name.find('/');
    const std::string_view folder = file.name.substr(0, slash);
    if (folder == name) files[std::string(file.name.substr(slash + 1))] = file.text;
    if (names.empty() || names.back() != folder) names.push_back(folder);
  }
  if (!files.empty()) return files;
  std::string known;
  for (const std::string_view one : names) known += fmt::format("\n  {}", one);
  const std::string_view meant = stdlib::nearest(name, names);
  throw Failure(kUsage, fmt::format("there is no example '{}'{}; there are{}", name,
                                    meant.empty() ? "" : fmt::format(", did you mean '{}'?", meant), known));
}

int make(const NewFlags& flags) {
  const Files files = flags.example.empty() ? template_files() : example_files(flags.example);
  const fs::path folder = flags.folder;
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error)) && !fs::is_directory(folder, error))
    throw Failure(kIoError, fmt::format("{}: is no folder", flags.folder));
  for (const auto& [path, text] : files)
    if (fs::exists(fs::symlink_status(folder / path, error)))
      throw Failure(kIoError,
                    fmt::format("{}: is there already; nothing was written", (folder / path).string()));
  for (const auto& [path, text] : files) {
    fs::create_directories((folder / path).parent_path(), error);
    if (error)
      throw Failure(kIoError, fmt::format("{}: {}", (folder / path).parent_path().string(), error.message()));
    replace_file((folder / path).string(), text);
    fmt::print("{}\n", (folder / path).generic_string());
  }
  fmt::print("\nNext:\n  cd {}\n  ipos test .\n", flags.folder);
  return kGood;
}

}  // namespace

void add_new(cli::Verb& program) {
  auto flags = std::make_shared<NewFlags>();
  cli::Verb& verb = program.verb("new", "make a folder to begin with: plant, programs, test, CI files");
  verb.option("DIR", flags->folder, "folder to make, or one without these files").required();
  verb.option("--from", flags->example, "copy an example instead, for example scom, hoist, jog");
  verb.footer("Example:\n  ipos new line\n  ipos new shaft --from hoist");
  verb.runs([flags] { return make(*flags); });
}

}  // namespace ipos::tools

// ipos fmt: sources in the one layout, in place, to standard output, or only checked.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "compiler/format/format.hpp"
#include "tools/failure.hpp"
#include "tools/files.hpp"
#include "tools/line_diff.hpp"
#include "tools/program.hpp"
#include "tools/verbs.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

struct FmtFlags {
  std::vector<std::string> paths;
  bool check = false;
  bool diff = false;
};

bool is_header(const fs::path& path) { return path.extension() == ".h" || path.extension() == ".H"; }

// A folder stands for the sources and headers below it.
std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> files;
  for (const std::string& path : paths) {
    if (!fs::is_directory(path)) {
      files.push_back(path);
      continue;
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(path))
      if (entry.is_regular_file() && (is_source(entry.path().string()) || is_header(entry.path())))
        found.push_back(entry.path().string());
    std::sort(found.begin(), found.end());
    files.insert(files.end(), found.begin(), found.end());
  }
  return files;
}

void write_text(const std::string& path, const std::string& text) {
  write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

int format(const FmtFlags& flags) {
  bool changed = false, failed = false;
  for (const std::string& path :
       files_of(flags.paths.empty() ? std::vector<std::string>{"-"} : flags.paths)) {
    const std::string name = path == "-" ? "<stdin>" : path;
    const std::string before = read_file(path);
    const auto after = compiler::format_source(before);
    if (!after) {
      fmt::print(stderr, "{}:{}: error: not formatted: {}\n", name, after.error().line, after.error().text);
      failed = true;
      continue;
    }
    const bool differs = *after != before;
    changed = changed || differs;
    if (flags.diff)
      fmt::print("{}", unified_diff(name, before, *after));
    else if (flags.check && differs)
      fmt::print("{}\n", name);
    else if (!flags.check && (differs || path == "-"))
      write_text(path, *after);
  }
  if (failed) return kBadInput;
  return changed && flags.check ? kFindings : kGood;
}

}  // namespace

void add_fmt(cli::Verb& app) {
  auto flags = std::make_shared<FmtFlags>();
  cli::Verb& verb = app.verb("fmt", "bring sources into the one layout");
  verb.option("PATH", flags->paths,
              "sources and folders, changed in place; - or none: standard input to standard output");
  verb.flag("--check", flags->check, "change nothing; print what would be changed and end with 1");
  verb.flag("--diff", flags->diff, "change nothing; print the changes");
  verb.footer("Example:\n  ipos fmt --check examples");
  verb.runs([flags] { return format(*flags); });
}

}  // namespace ipos::tools

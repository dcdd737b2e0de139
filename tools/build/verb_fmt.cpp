// ipos fmt: sources in the one layout, in place, to standard output, or only checked. What is no IPOS source is
// never touched.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "compiler/diag/places.hpp"
#include "compiler/format/format.hpp"
#include "tools/build/line_diff.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

struct FmtFlags {
  std::vector<std::string> paths;
  bool check = false;
  bool diff = false;
};

bool is_header(const fs::path& path) { return path.extension() == ".h" || path.extension() == ".H"; }

// The sources below a folder, and the headers there that one of them includes: others may be of C or C++.
std::vector<std::string> sources_below(const std::string& folder) {
  const std::vector<std::string> all = files_below(folder);
  std::set<fs::path> included;
  for (const std::string& file : all)
    if (is_source(file))
      for (const std::string& header : included_files(file)) included.insert(fs::weakly_canonical(header));
  std::vector<std::string> sources;
  for (const std::string& file : all)
    if (is_source(file) || (is_header(file) && included.contains(fs::weakly_canonical(file))))
      sources.push_back(file);
  return sources;
}

// Each folder stands for its sources. Returns false when something that was named is no source; it is told.
bool find_sources(const std::vector<std::string>& paths, std::vector<std::string>& sources) {
  bool good = true;
  for (const std::string& path : paths) {
    if (is_folder(path)) {
      const std::vector<std::string> below = sources_below(path);
      sources.insert(sources.end(), below.begin(), below.end());
    } else if (path == "-" || is_source(path) || is_header(path)) {
      sources.push_back(path);
    } else {
      fmt::print(stderr, "{}: error: no IPOS source: those are called *.IPC, their headers *.h\n",
                 compiler::printable(path));
      good = false;
    }
  }
  return good;
}

int format(const FmtFlags& flags) {
  std::vector<std::string> sources;
  bool changed = false;
  bool failed = !find_sources(flags.paths.empty() ? std::vector<std::string>{"-"} : flags.paths, sources);
  for (const std::string& path : sources) {
    const std::string name = path == "-" ? "<stdin>" : compiler::printable(path);
    const std::string before = read_file(path);
    const auto foreign = is_header(path) ? compiler::foreign_word(before) : std::nullopt;
    const auto after = foreign ? tl::unexpected(*foreign) : compiler::format_source(before);
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
      rewrite_file(path, *after);
  }
  if (failed) return kBadInput;
  return changed && flags.check ? kFindings : kGood;
}

}  // namespace

void add_fmt(cli::Verb& app) {
  auto flags = std::make_shared<FmtFlags>();
  cli::Verb& verb = app.verb("fmt", "bring sources into the one layout");
  verb.option(
      "PATH", flags->paths,
      "*.IPC, their *.h, and folders of them, changed in place; - or none: standard input to standard "
      "output");
  verb.flag("--check", flags->check, "change nothing; print what would be changed and end with 1");
  verb.flag("--diff", flags->diff, "change nothing; print the changes");
  verb.footer("Example:\n  ipos fmt --check examples");
  verb.runs([flags] { return format(*flags); });
}

}  // namespace ipos::tools

// ipos: one program, a verb for each arrow of the toolchain.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "tools/cli/commit.hpp"
#include "tools/cli/end_of_process.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/parser.hpp"
#include "tools/cli/streams.hpp"
#include "tools/program_verbs.hpp"

namespace {

// All verbs cost a third of the start of a short run: only the one asked for is made. Help, mistakes and the
// two that write about all verbs get them all.
void add_verbs(ipos::tools::cli::Verb& program, std::string_view asked) {
  const std::span<const ipos::tools::VerbRow> verbs = ipos::tools::program_verbs();
  const auto one =
      std::find_if(verbs.begin(), verbs.end(), [asked](const auto& row) { return row.name == asked; });
  const bool about_all = asked == "complete" || asked == "man";
  if (one != verbs.end() && one->add == nullptr)
    throw ipos::tools::Failure(ipos::tools::kUsage,
                               fmt::format("'{}' is not in this build; ipos for Linux and Windows has it", asked));
  if (one != verbs.end() && !about_all) return one->add(program);
  for (const auto& row : verbs) {
    program.begin_group(std::string(row.group));
    if (row.add != nullptr) row.add(program);
  }
}

int run(int argc, char** argv) {
  ipos::tools::cli::Verb program(
      "ipos", "Toolchain for IPOSplus-style drive programs: compile, run and test them without a drive.");
  program.footer(
      "Example:\n  ipos new line\n  ipos serve line --open\n'ipos help VERB' tells its options, with an example.");
  add_verbs(program, argc > 1 ? argv[1] : "");
  std::string version = "ipos " IPOS_VERSION;
  if (*ipos::tools::kCommit != 0) version += std::string(" (commit ") + ipos::tools::kCommit + ")";
  return ipos::tools::cli::run(program, version, argc, argv);
}

// A double click on the program, or on a file that it was chosen to open.
bool is_clicked(int argc, char** argv) {
  if (argc > 2 || !ipos::tools::has_own_window()) return false;
  const std::span<const ipos::tools::VerbRow> verbs = ipos::tools::program_verbs();
  std::error_code error;
  return argc < 2 || (std::filesystem::exists(argv[1], error) &&
                      std::none_of(verbs.begin(), verbs.end(), [&](const auto& row) { return row.name == argv[1]; }));
}

}  // namespace

int main(int argc, char** argv) {
  ipos::tools::prepare_streams();
  ipos::tools::join_rooms();
  std::vector<char*> words(argv, argv + argc);
  char serve[] = "serve", open[] = "--open";
  const bool clicked = is_clicked(argc, argv);
  if (clicked) words.insert(words.begin() + 1, {serve, open});
  const int code = ipos::tools::end_of_process([&] { return run(static_cast<int>(words.size()), words.data()); });
  if (clicked && code != ipos::tools::kGood && code != ipos::tools::kInterrupted) ipos::tools::wait_for_reader();
  return code;
}

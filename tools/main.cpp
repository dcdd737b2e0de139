// ipos: one program, a verb for each arrow of the toolchain.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <iterator>
#include <string_view>

#include "tools/failure.hpp"
#include "tools/verbs.hpp"

namespace {

struct Verb {
  std::string_view name;
  void (*add)(CLI::App& app, int& exit_code);
};

// In the order of --help.
constexpr Verb kVerbs[] = {
    {"build", ipos::tools::add_build},     {"asm", ipos::tools::add_asm},
    {"disasm", ipos::tools::add_disasm},   {"verify", ipos::tools::add_verify},
    {"run", ipos::tools::add_run},         {"test", ipos::tools::add_test},
    {"bus", ipos::tools::add_bus},         {"param", ipos::tools::add_param},
    {"watch", ipos::tools::add_watch},     {"scan", ipos::tools::add_scan},
    {"explain", ipos::tools::add_explain}, {"fmt", ipos::tools::add_fmt},
    {"lsp", ipos::tools::add_lsp},         {"debug", ipos::tools::add_debug},
    {"dap", ipos::tools::add_dap},
};

// All verbs cost a third of the start of a short run: only the one asked for is made, all for help and
// mistakes.
void add_verbs(CLI::App& app, std::string_view asked, int& exit_code) {
  const auto* const one = std::find_if(std::begin(kVerbs), std::end(kVerbs),
                                       [asked](const Verb& verb) { return verb.name == asked; });
  if (one != std::end(kVerbs)) return one->add(app, exit_code);
  for (const Verb& verb : kVerbs) verb.add(app, exit_code);
}

int run(int argc, char** argv) {
  using namespace ipos::tools;
  int exit_code = kGood;
  CLI::App app{"Toolchain for IPOSplus-style drive programs: compile, run and test them without a drive.",
               "ipos"};
  app.set_version_flag("--version", "ipos " IPOS_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Example:\n  ipos run examples/scom/scom.toml --for 1s --watch\nEvery verb has --help with an "
      "example.");
  add_verbs(app, argc > 1 ? argv[1] : "", exit_code);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success))
      return app.exit(error);  // --help, --version
    fmt::print(stderr, "ipos: {}\n", error.what());
    const auto verbs = app.get_subcommands();
    fmt::print(stderr, "Try 'ipos {}--help'.\n", verbs.empty() ? "" : verbs.front()->get_name() + " ");
    return kUsage;
  }
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const ipos::tools::Failure& failure) {
    if (failure.what()[0] != '\0') fmt::print(stderr, "ipos: {}\n", failure.what());
    return failure.exit_code();
  } catch (const std::exception& error) {
    fmt::print(stderr, "ipos: internal error: {}\n", error.what());
    return ipos::tools::kInternal;
  }
}

// ipos: one program, a verb for each arrow of the toolchain.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "tools/failure.hpp"
#include "tools/verbs.hpp"

namespace {

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
  add_build(app, exit_code);
  add_asm(app, exit_code);
  add_disasm(app, exit_code);
  add_verify(app, exit_code);
  add_run(app, exit_code);
  add_test(app, exit_code);
  add_bus(app, exit_code);
  add_param(app, exit_code);
  add_watch(app, exit_code);
  add_scan(app, exit_code);
  add_explain(app, exit_code);
  add_fmt(app, exit_code);
  add_lsp(app, exit_code);
  add_debug(app, exit_code);
  add_dap(app, exit_code);
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

// ipos explain: what a code means: of a message, a verifier rule, a return code or a drive fault.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "compiler/diag/diag.hpp"
#include "tools/failure.hpp"
#include "tools/verbs.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::tools {
namespace {

std::string explain(std::string code) {
  std::transform(code.begin(), code.end(), code.begin(), [](unsigned char c) { return std::toupper(c); });
  for (const compiler::DiagInfo& row : compiler::diagnostic_table())
    if (row.code == code) {
      const bool warning = row.severity == compiler::Severity::Warning;
      return fmt::format("{}: {}\n  {}\n{}", row.code, warning ? "warning" : "error", row.format,
                         warning ? fmt::format("  switched off by -Wno-{}, made an error by -Werror={}\n", row.flag, row.flag)
                                 : "");
    }
  for (const vm::RuleInfo& row : vm::rule_table())
    if (row.code == code) return fmt::format("{}: rule of the verifier\n  {}\n", row.code, row.meaning);
  throw Failure(kBadInput, fmt::format("there is no code '{}'; codes look like E0101, W0201 or V03", code));
}

}  // namespace

void add_explain(CLI::App& app, int& exit_code) {
  auto code = std::make_shared<std::string>();
  CLI::App* verb = app.add_subcommand("explain", "what a message code means");
  verb->add_option("CODE", *code, "for example E0203")->required();
  verb->footer("Example:\n  ipos explain V03");
  verb->callback([code, &exit_code] {
    fmt::print("{}", explain(*code));
    exit_code = kGood;
  });
}

}  // namespace ipos::tools

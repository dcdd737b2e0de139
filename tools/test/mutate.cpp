// The way of --mutate: all tests have to pass first.
#include "tools/test/mutate.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "compiler/diag/places.hpp"
#include "tools/cli/exit_codes.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/mutants/reports.hpp"
#include "tools/mutants/trial.hpp"
#include "tools/survivors/survivors.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools {
namespace {

using mutants::Mutant;
using testing::Outcome;
using testing::TestResult;

// What is wrong with them has to be mended first.
int refuse(const std::vector<TestResult>& not_clean) {
  for (const TestResult& result : not_clean) fmt::print(stderr, "{}", testing::text_of(result));
  if (interrupted()) return kInterrupted;
  fmt::print(stderr, "ipos: {} not pass as {} now: nothing was planted\n",
             not_clean.size() == 1 ? "1 test does" : fmt::format("{} tests do", not_clean.size()),
             not_clean.size() == 1 ? "it is" : "they are");
  return testing::count(not_clean, Outcome::Malformed) != 0 ? kBadInput : kFindings;
}

void tell_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) fmt::print(stderr, "ipos: note: {}\n", compiler::printable(note));
}

// For editors. A source of which not all was tried keeps what it had.
void keep(const mutants::Trial& trial) {
  for (const mutants::Source& source : trial.sources) {
    std::vector<Survivor> survivors;
    bool whole = true;
    for (const Mutant& mutant : trial.mutants) {
      if (mutant.file != source.path) continue;
      whole = whole && mutant.fate != mutants::Fate::NotRun;
      if (mutants::survives(mutant))
        survivors.push_back({mutant.place.line, mutant.place.column, mutant.text, mutant.fate == mutants::Fate::Missed});
    }
    if (whole) keep_survivors(source.path, source.text, survivors);
  }
}

}  // namespace

int mutate(const std::vector<testing::TestCase>& tests, const MutateFlags& flags) {
  if (flags.list) {
    const mutants::Trial trial = mutants::list_mutants(tests, flags.suite);
    tell_notes(trial.notes);
    for (const Mutant& mutant : trial.mutants)
      if (mutant.fate != mutants::Fate::Equivalent) fmt::print("{}", mutants::line_of(mutant));
    return kGood;
  }
  for (const std::string& report : {flags.junit, flags.json, flags.html}) check_output(report);
  const bool progress = is_terminal(STDERR_FILENO);
  size_t survivors = 0;
  const mutants::Trial trial = mutants::try_mutants(tests, flags.suite, [&](const Mutant& mutant, size_t done, size_t all) {
    survivors += mutants::survives(mutant) ? 1U : 0U;
    if (progress) fmt::print(stderr, "\r\033[K{} of {}, {} not noticed", done, all, survivors);
  });
  if (progress) fmt::print(stderr, "\r\033[K");
  if (!trial.not_clean.empty()) return refuse(trial.not_clean);
  tell_notes(trial.notes);
  keep(trial);
  const bool alone = is_standard_output(flags.junit) || is_standard_output(flags.json);
  if (!alone && flags.github) fmt::print("{}", mutants::github_report(trial.mutants, flags.root));
  if (!alone) fmt::print("{}", mutants::text_report(trial.mutants));
  std::fflush(stdout);
  for (const auto& [path, report] : {std::pair(&flags.junit, &mutants::junit_report), std::pair(&flags.json, &mutants::json_report),
                                     std::pair(&flags.html, &mutants::html_report)})
    if (!path->empty()) replace_file(*path, report(trial.mutants));
  if (interrupted()) return kInterrupted;
  return survivors == 0 ? kGood : kFindings;
}

}  // namespace ipos::tools

// gcc gets 200 programs a file: most of its time is the start.
#include "tests/generated/campaign.hpp"

#include <algorithm>

#include "tests/generated/difference.hpp"
#include "tests/generated/evaluator.hpp"
#include "tests/generated/gcc_oracle.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"
#include "tests/generated/toolchain.hpp"

namespace ipos::tests {
namespace {

constexpr size_t kProgramsAFile = 200;

void note(Campaign& campaign, uint64_t seed, const std::string& what) {
  if (!what.empty()) campaign.differences.push_back({seed, what});
}

void run_batch(Campaign& campaign, Oracle oracle, uint64_t first, uint64_t count) {
  std::vector<Program> programs;
  std::vector<std::string> sources;
  std::vector<Outcome> expected;
  for (uint64_t seed = first; seed < first + count; ++seed) {
    programs.push_back(generate_program(seed));
    sources.push_back(source_text(programs.back()));
    expected.push_back(evaluate(programs.back()));
    if (!expected.back().ended) note(campaign, seed, "the generated program does not end");
  }
  if (oracle == Oracle::Gcc) {
    GccRun run = run_with_gcc(programs);
    campaign.trouble = run.trouble;
    if (!run.trouble.empty()) return;
    for (size_t i = 0; i < expected.size(); ++i) {
      run.outcomes[i].open = std::move(expected[i].open);
      expected[i] = std::move(run.outcomes[i]);
    }
  }
  for (size_t i = 0; i < programs.size(); ++i) {
    const ToolchainRun run = run_toolchain(programs[i], sources[i]);
    note(campaign, programs[i].seed,
         run.trouble.empty() ? difference(programs[i], expected[i], run.outcome) : run.trouble);
    ++campaign.programs;
    campaign.faults += expected[i].fault != 0;
    campaign.commands += run.commands;
    campaign.lines += static_cast<uint64_t>(std::count(sources[i].begin(), sources[i].end(), '\n'));
  }
}

}  // namespace

Campaign run_campaign(Oracle oracle, uint64_t first, uint64_t count) {
  Campaign out;
  for (uint64_t done = 0; done < count && out.trouble.empty(); done += kProgramsAFile)
    run_batch(out, oracle, first + done, std::min<uint64_t>(kProgramsAFile, count - done));
  return out;
}

std::string summary(const Campaign& campaign) {
  std::string out = std::to_string(campaign.programs) + " programs, " + std::to_string(campaign.lines) +
                    " lines, " + std::to_string(campaign.commands) + " commands executed, " +
                    std::to_string(campaign.faults) + " ended in F10, " +
                    std::to_string(campaign.differences.size()) + " differences";
  if (!campaign.trouble.empty()) out += "; " + campaign.trouble;
  return out;
}

std::string first_difference(Oracle oracle, const Campaign& campaign) {
  if (campaign.differences.empty()) return "";
  const auto compare = oracle == Oracle::Gcc ? difference_to_gcc : difference_to_tree;
  const Difference& first = campaign.differences.front();
  Program program = generate_program(first.seed);
  // The same kind of difference, up to its numbers, so that a cut does not make a wrong program of it.
  const auto kind = [](std::string text) {
    text.resize(std::min(text.find_first_of("0123456789("), text.size()));
    return text;
  };
  Program small = reduce(program, [&](Program& candidate) {
    const std::string text = compare(candidate);
    return !text.empty() && kind(text) == kind(first.text);
  });
  const std::string text = compare(small);
  return "first difference: seed " + std::to_string(first.seed) + ": " + first.text + "\n" +
         source_text(small) + "// " + text + "\n";
}

}  // namespace ipos::tests

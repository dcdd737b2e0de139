#include "tests/engines/campaign.hpp"

#include <set>

#include "compiler/codegen/compile.hpp"
#include "tests/engines/pair.hpp"
#include "tests/generated/program_generator.hpp"
#include "tests/generated/source_text.hpp"
#include "vm/fast/predecode.hpp"

namespace ipos::tests {
namespace {

constexpr uint32_t kOrders = 120;
constexpr vm::Limits kLimits{1024, 16384, 3, 6};  // few calls, so that F32 is met

class Runner {
 public:
  EngineCampaign out;

  void run(const std::vector<uint32_t>& code, const vm::Limits& limits, uint64_t seed, const char* what) {
    if (code.empty()) return;
    const vm::Verification verified = vm::verify(code, limits, {});
    if (!verified.image) {
      out.difference = std::string(what) + " " + std::to_string(seed) + " is not verified";
      return;
    }
    std::vector<vm::fast::Slot> slots(vm::fast::Predecoded::slots_needed(code.size()));
    const vm::fast::Predecoded program(*verified.image, slots);
    for (uint32_t at = 0; at < code.size(); at += vm::decode(code, at).words)
      seen_.insert(program.operation(at));
    out.operations = seen_.size();
    const PairRun pair = run_pair(*verified.image, seed, kOrders);
    ++out.programs;
    out.orders += pair.orders;
    out.commands += pair.commands;
    if (!pair.difference.empty()) out.difference = std::string(what) + ": " + pair.difference;
  }

 private:
  std::set<vm::fast::Operation> seen_;
};

}  // namespace

EngineCampaign run_engine_campaign(uint64_t first, uint64_t count) {
  Runner runner;
  for (uint64_t seed = first; seed < first + count && runner.out.difference.empty(); ++seed) {
    Program program = generate_program(seed);
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit(std::string_view(program.unit));
    const compiler::Compilation made = compiler::compile("generated.IPC", "", source_text(program), options);
    if (made.image) {
      const stdlib::UnitType& unit = *options.unit;
      const vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
      runner.run(made.image->code, limits, seed, "generated");
      if (!runner.out.difference.empty()) break;
      runner.run(with_interrupts(made.image->code, limits, seed), limits, seed, "generated with interrupts");
      if (!runner.out.difference.empty()) break;
    }
    runner.run(with_interrupts(sequence_soup(seed), kLimits, seed), kLimits, seed, "soup");
  }
  return runner.out;
}

std::string summary(const EngineCampaign& campaign) {
  return std::to_string(campaign.programs) + " programs, " + std::to_string(campaign.orders) + " orders, " +
         std::to_string(campaign.commands) + " commands, " + std::to_string(campaign.operations) +
         " operations met" + (campaign.difference.empty() ? "" : "; " + campaign.difference);
}

}  // namespace ipos::tests

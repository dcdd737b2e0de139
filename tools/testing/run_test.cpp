// Runs the plant of a test to where its script wants to go on.
#include "tools/testing/run_test.hpp"

#include <fmt/format.h>

#include <chrono>

#include "tools/cli/interrupt.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/testing/plant_builder.hpp"
#include "tools/testing/script.hpp"

namespace ipos::tools::testing {
namespace {

using Clock = std::chrono::steady_clock;

void run(Script& script, runtime::Plant& plant, const RunOptions& options, const TestResult& result) {
  const Clock::time_point ends = Clock::now() + std::chrono::seconds(options.limit_s);
  const auto is_known = [&] { return options.to_first_finding && !result.findings.empty(); };
  const auto passed = [&](Time now) {
    if (Clock::now() >= ends)
      script.give_up(fmt::format("time: the test takes more than {} s on the clock and is at {} of virtual time; "
                                 "--time-limit allows more",
                                 options.limit_s, time_text(plant.now())));
    for (const runtime::PlantError& failure : plant.machines().failures()) script.give_up(failure.text, failure.place);
    if (options.sample) options.sample(now);
    return script.passed(now) && !interrupted() && !is_known();
  };
  for (script.begin(); !script.over() && !is_known(); script.go_on()) {
    // The plant runs up to a time that lies ahead; what happens at its present time may still be to come.
    if (script.due() == plant.now()) {
      plant.queue().run_until(plant.now());
      passed(plant.now());
    } else {
      plant.run_until(script.due(), passed);
    }
    if (interrupted()) script.give_up("interrupted");
  }
}

void carry_out(const TestCase& test, Programs& programs, const RunOptions& options, TestResult& result) {
  result.messages = mistakes_text(test.errors_in.empty() ? test.file : test.errors_in, test.errors, false);
  if (!test.errors.empty()) {
    result.outcome = Outcome::Malformed;
    return;
  }
  BuiltPlant built = build_plant(test, programs, options);
  result.findings = std::move(built.findings);
  result.checks = built.checks;
  if (built.plant) {
    std::shared_ptr<void> collector;
    if (options.prepare) collector = options.prepare(*built.plant);
    Script script(test, *built.plant, options.seed, result);
    const auto errors = script.resolve();
    if (errors.empty()) run(script, *built.plant, options, result);
    built.messages += mistakes_text(test.file, errors, false);
    result.time = built.plant->now();
    if (options.finish) options.finish();
  }
  result.messages = std::move(built.messages);
  if (!result.messages.empty())
    result.outcome = Outcome::Malformed;
  else if (!result.findings.empty())
    result.outcome = Outcome::Failed;
}

}  // namespace

TestResult run_test(const TestCase& test, Programs& programs, const RunOptions& options) {
  TestResult result;
  result.name = test.name;
  result.file = test.file;
  result.place = test.place;
  result.seed = options.seed;
  const auto begin = std::chrono::steady_clock::now();
  carry_out(test, programs, options, result);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

}  // namespace ipos::tools::testing

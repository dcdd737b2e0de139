// The script is told each millisecond that has passed, no matter what runs the plant and how often.
#include "tools/testing/debugged_test.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tools/cli/failure.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/testing/plant_builder.hpp"
#include "tools/test_file/read_tests.hpp"
#include "tools/testing/report_words.hpp"
#include "tools/testing/script.hpp"

namespace ipos::tools::testing {
namespace {

class ScriptBeside final : public debug::Companion {
 public:
  ScriptBeside(const TestCase& test, runtime::Plant& plant, uint64_t seed, std::function<void(const std::string&)> tell)
      : tell_(std::move(tell)), script_(test, plant, seed, result_) {
    result_.name = test.name;
    script_.resolve();
    script_.begin();
  }

  void passed(runtime::Time now) override {
    if (script_.over() || (now == 0 && script_.due() != 0)) return;
    script_.passed(now);
    script_.go_on();
    for (; told_ < result_.findings.size(); ++told_) tell_(text_of_finding(result_.findings[told_]));
    if (script_.over())
      tell_(fmt::format("{}: the test is over at {}: {} checks, {} not met\n", result_.name, time_text(now),
                        result_.checks, result_.findings.size()));
  }

 private:
  std::function<void(const std::string&)> tell_;
  TestResult result_;
  Script script_;
  size_t told_ = 0;  // findings
};

[[noreturn]] void refuse(int code, const std::string& messages) {
  fmt::print(stderr, "{}", messages);
  throw Failure(code, "");
}

}  // namespace

std::shared_ptr<const TestCase> chosen_test(const std::string& file, const std::string& name) {
  std::vector<TestCase> tests = testing::read_tests(file);
  if (tests.size() == 1 && name.empty()) return std::make_shared<const TestCase>(std::move(tests.front()));
  std::string known;
  for (TestCase& test : tests) {
    const size_t slash = test.name.rfind('/');
    const std::string own = slash == std::string::npos || tests.size() == 1 ? "" : test.name.substr(slash + 1);
    if (!name.empty() && own == name) return std::make_shared<const TestCase>(std::move(test));
    known += (known.empty() ? "" : ", ") + own;
  }
  throw Failure(kUsage, tests.size() == 1
                            ? fmt::format("{} has no cases to choose from", file)
                            : fmt::format("{} has the cases {}: choose one of them (--case NAME)", file, known));
}

debug::Debuggee debugged_test(std::shared_ptr<const TestCase> test, const CompileFlags& compile, const RunOptions& options) {
  if (!test->errors.empty())
    refuse(kBadInput, mistakes_text(test->errors_in.empty() ? test->file : test->errors_in, test->errors, false));
  const auto programs = std::make_shared<Programs>(compile);
  const BuiltPlant first = build_plant(*test, *programs, options);
  if (!first.plant) refuse(kFindings, first.messages);
  TestResult result;
  const auto mistakes = Script(*test, *first.plant, options.seed, result).resolve();
  if (!mistakes.empty()) refuse(kBadInput, mistakes_text(test->file, mistakes, false));
  return {[test, programs, options] { return std::move(build_plant(*test, *programs, options).plant); },
          [test, seed = options.seed](runtime::Plant& plant, std::function<void(const std::string&)> tell) {
            return std::make_unique<ScriptBeside>(*test, plant, seed, std::move(tell));
          }};
}

}  // namespace ipos::tools::testing

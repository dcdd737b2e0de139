// Runs cases of a campaign one after the other in this process: the plant is read and compiled once, and built again for each
// case. Each gives what `ipos run` of the plant with its values gives, to the trace hash.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "tools/campaign/subject.hpp"
#include "tools/testing/result.hpp"

namespace ipos::tools::campaign {

struct Outcome {
  std::vector<std::optional<double>> measures;
  // What is not as it should be: "plant.toml:12:1: lFloor of hoist ...", "overshoot: ...", "time". What stands before the first
  // ": " says which check it is.
  std::vector<std::string> failed;
  std::optional<uint64_t> hash;  // nothing: the run has no end
  double ms = 0;                 // on the clock
};

class CaseRunner {
 public:
  CaseRunner(const Campaign& campaign, const CompileFlags& compile) : campaign_(campaign), subject_(campaign, compile) {}

  Outcome run(const Levels& levels);

  // Called when a plant is built, before its first event; what it returns lives as long as the plant's run.
  using Watcher = std::function<std::shared_ptr<void>(runtime::Plant&)>;
  void use_watcher(Watcher watcher) { watcher_ = std::move(watcher); }
  // As a test tells of what failed, for a person who replays one case.
  using Teller = std::function<void(const testing::TestResult&)>;
  void use_teller(Teller teller) { teller_ = std::move(teller); }

  // Why the plant of a case cannot be built; empty: it can.
  std::string refused(const Levels& levels);
  // Of the number that a signal shows; the error is why there is no such signal.
  tl::expected<std::string, std::string> unit_of(const std::string& signal, const Levels& levels);

  const Subject& subject() const { return subject_; }

 private:
  struct Built {
    std::unique_ptr<runtime::Plant> plant;
    std::string refused;
  };
  class Watch;

  Built build(const Levels& levels);
  testing::TestCase changed(const testing::TestCase& test, const Levels& levels) const;
  void run_plant(const Levels& levels, Outcome& outcome);
  void run_tests(const Levels& levels, Outcome& outcome);
  void judge_measures(Outcome& outcome) const;

  const Campaign& campaign_;
  Subject subject_;
  Watcher watcher_;
  Teller teller_;
};

}  // namespace ipos::tools::campaign

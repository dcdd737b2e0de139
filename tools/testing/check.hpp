// An expectation under way: it is told values and frames in the order of time and decides as soon as it can.
#pragma once

#include <optional>
#include <string>

#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

class Check {
 public:
  enum class Verdict : uint8_t { Open, Met, Failed };

  // Watches from `start` on.
  Check(const Expect& expect, Time start);

  // The value once a millisecond, after all that happens at that time.
  void sample(Time now, int64_t value);
  // A frame or telegram of the subject's bus, at the time of its end.
  void event(Time now, const std::string& text, const std::string& meaning);
  // Nothing more comes: its time is over, or the test.
  void finish(Time now);

  Verdict verdict() const { return verdict_; }
  const std::string& problem() const { return problem_; }  // once it has failed
  const Expect& expect() const { return expect_; }
  // The last time that counts; kNever: as long as the test goes on.
  Time end() const { return end_; }

 private:
  void fail(std::string problem);
  void meet() { verdict_ = Verdict::Met; }
  void occur(Time now);
  void element(Time now, bool fits, const std::string& shown, bool first);
  std::string wanted() const;  // the element of the sequence that is due
  size_t length() const;

  const Expect& expect_;
  Time start_;
  Time end_;
  Verdict verdict_ = Verdict::Open;
  std::string problem_;
  uint64_t seen_ = 0;  // events, or samples
  uint64_t count_ = 0;
  std::optional<Time> last_;  // occurrence
  std::optional<int64_t> last_value_;
  bool held_ = false;  // the condition, at the last sample
  size_t next_ = 0;    // of the sequence
  uint64_t rounds_ = 0;
};

}  // namespace ipos::tools::testing

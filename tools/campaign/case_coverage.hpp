// Which lines of the programs the cases of a campaign reach, summed over all of them. A shard's sum lies beside its results; what
// a shard adds when it is taken up again comes to it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/shard_file.hpp"
#include "tools/campaign/workers.hpp"
#include "tools/coverage/coverage.hpp"

namespace ipos::tools::campaign {

std::string coverage_json(const coverage::Coverage& coverage);
// Nothing: it is no such text.
std::optional<coverage::Coverage> read_coverage_json(const std::string& text);

class CaseCoverage {
 public:
  // Every case is watched from now on; workers hand over what they have seen when their cases are over.
  void attach(CaseRunner& runner, WorkListener& listener);
  void write(const std::string& folder, const Shard& shard, const Outline& outline) const;

 private:
  coverage::Coverage seen_;   // in a worker
  coverage::Coverage total_;
};

// Of all shards; nothing where none has any.
std::optional<coverage::Coverage> read_coverage(const std::vector<std::string>& folders, const Outline& outline);

}  // namespace ipos::tools::campaign

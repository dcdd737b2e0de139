// What the cases of a campaign run: its plant or tests, read and compiled once, and with the values of a case.
#pragma once

#include <list>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/campaign/campaign.hpp"
#include "tools/campaign/toml_edit.hpp"
#include "tools/testing/programs.hpp"

namespace ipos::tools::campaign {

// For the reader of the campaign: the plant with the units of its stations, the tests into the campaign. Mistakes are printed,
// then a Failure.
runtime::PlantFile read_plant_subject(Campaign& campaign, const CompileFlags& compile);
runtime::PlantFile read_test_subject(const std::vector<std::string>& files, Campaign& campaign, const CompileFlags& compile);

// When all else is read: what only a plant that is built can tell, the number over everything, the units of measures. Gives the
// mistakes of the campaign file.
std::vector<runtime::PlantError> finish_campaign(Campaign& campaign, const CompileFlags& compile);

// What keys of the plant file make of it; the other values come to it for each case.
struct Prepared {
  std::string refused;  // why there is none
  runtime::PlantFile plant;
  std::vector<std::optional<vm::Image>> programs;
  std::vector<testing::TestCase> tests;  // in place of the two
};

class Subject {
 public:
  Subject(const Campaign& campaign, const CompileFlags& compile) : campaign_(campaign), programs_(compile) {}

  // The last ones are kept.
  const Prepared& prepared(const Levels& levels);
  // All but keys.
  void apply(const Levels& levels, runtime::PlantFile& plant) const;
  testing::Programs& programs() { return programs_; }

  // The plant file of a case, as `ipos run` takes it; of a campaign of tests that of the first one.
  std::string plant_text(const Levels& levels) const;

 private:
  static constexpr size_t kKept = 64;  // ours: some 100 KB each

  // `refused`: why a key cannot be set, if so.
  TomlEdit with_keys(const Levels& levels, std::string text, std::string& refused) const;
  Prepared prepare(const Levels& levels);
  void load_programs(Prepared& prepared);

  const Campaign& campaign_;
  testing::Programs programs_;
  std::list<std::pair<Levels, Prepared>> kept_;  // by the levels of keys; the last one used first
};

}  // namespace ipos::tools::campaign

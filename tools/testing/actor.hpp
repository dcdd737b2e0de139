// The hands of a test: carries out its steps in the plant, at the beginning of the millisecond of their time, before the
// stations; or by hand, at once, while the plant stands between two milliseconds. Sends from a station of its own on each
// bus the test sends on.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/plant/actions.hpp"
#include "tools/test_file/test_case.hpp"

namespace ipos::tools::testing {

class Actor {
 public:
  // `on_problem` hears what could not be done, when the step's time has come. Its stations are attached before the first
  // event of the plant, of a test by hand with the first telegram, as the page's; `seed` moves the seeds of faults.
  using Problem = std::function<void(const Item&, std::string)>;
  Actor(runtime::Plant& plant, const TestCase& test, uint64_t seed, Problem on_problem);
  Actor(const Actor&) = delete;
  Actor& operator=(const Actor&) = delete;

  // Plans the step of an item; the item must outlive the run. Not for waits and awaits.
  void plan(const Item& item, const Step& step, Time at);
  // The plant stands at this time.
  void act_by_hand(const Item& item, const Step& step, Time at);

 private:
  runtime::Station& station(const std::string& name);
  void act(const Item& item, const Step& step, Time at);
  runtime::Refusal apply(runtime::Stimulus stimulus);
  void set_word(const ProcessDataStep& step);
  runtime::Refusal plant_fault(runtime::FaultConfig fault, Time at);
  runtime::Refusal repair(const runtime::FaultConfig& fault);

  runtime::Plant& plant_;
  runtime::PlantActions actions_;
  bool by_hand_;
  uint64_t seed_;
  Problem on_problem_;
  std::vector<runtime::FaultConfig> planted_;  // those of the plant file, too
};

}  // namespace ipos::tools::testing

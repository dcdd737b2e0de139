// The hands of a test: carries out its steps in the plant, at the beginning of the millisecond of their time,
// before the stations. Sends from a station of its own on each bus the test sends on.
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
  // `on_problem` hears what could not be done, when the step's time has come. Its stations are attached
  // before the first event of the plant; `seed` moves the seeds of faults.
  using Problem = std::function<void(const Item&, std::string)>;
  Actor(runtime::Plant& plant, const std::vector<Item>& items, uint64_t seed, Problem on_problem);
  Actor(const Actor&) = delete;
  Actor& operator=(const Actor&) = delete;

  // Plans the step of an item; the item must outlive the run. Not for waits and awaits.
  void plan(const Item& item, const Step& step, Time at);

 private:
  runtime::Station& station(const std::string& name);
  runtime::Refusal set(const runtime::Stimulus& stimulus);
  void set_word(const ProcessDataStep& step);
  runtime::Refusal plant_fault(runtime::FaultConfig fault, Time at);

  runtime::Plant& plant_;
  runtime::PlantActions actions_;
  uint64_t seed_;
  Problem on_problem_;
};

}  // namespace ipos::tools::testing

// `Keep as test`: what was done on the page as the steps of a test, and what is looked at as its expectations, with the
// values of now. The test does the same run again, so it is green at once.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/serve/host/plant_host.hpp"

namespace ipos::tools::serve {

struct KeptTest {
  std::string text;
  std::vector<std::string> left_out;  // what was done or looked at and does not stand in it, and why
};

// `pinned`: names of the watch. `changed`: of each station the outputs that have changed since the first millisecond, a bit
// each. A Mistake says why there can be no test of this moment.
KeptTest keep_as_test(PlantHost& host, const std::vector<std::string>& pinned, const std::vector<uint32_t>& changed);

}  // namespace ipos::tools::serve

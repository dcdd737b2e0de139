// The faults of lines that the page can plant and end: which kinds each line has and what they take, and which are
// there now.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/plant/plant.hpp"
#include "tools/serve/host/arguments.hpp"

namespace ipos::tools::serve {

class LineFaults {
 public:
  // Another plant: what is planted is that of its file.
  void built(runtime::Plant& plant);

  // The kinds in their order, and what each of them takes; both empty for lines without faults.
  static Json kinds(const runtime::Bus& line);
  static Json rules(const runtime::Bus& line);

  // Of one: its kind in a word, and from when until when.
  static std::string_view word(const runtime::FaultConfig& fault);
  static std::pair<runtime::Time, runtime::Time> times(const runtime::FaultConfig& fault);

  // The command `fault`; a Mistake says why not.
  void carry_out(const Arguments& arguments);

  // What is there now.
  Json planted_on(const std::string& bus) const;

 private:
  runtime::Plant* plant_ = nullptr;
  std::vector<runtime::FaultConfig> planted_;
};

}  // namespace ipos::tools::serve

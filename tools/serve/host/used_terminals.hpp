// Which terminals of a station somebody uses: a function, a wire or a switch, the plant file, the program. The page folds
// the others away.
#pragma once

#include <string>

#include "runtime/plant/plant.hpp"

namespace ipos::tools::serve {

class UsedTerminals {
 public:
  // `program`: its text, as it runs.
  UsedTerminals(const runtime::PlantFile& file, const runtime::StationConfig& station, std::string program);
  bool has(const runtime::BinaryTerminal& terminal, int32_t function) const;

 private:
  bool is_named(const runtime::Signal& signal, std::string_view terminal) const;
  bool is_in_file(std::string_view terminal) const;
  bool is_in_program(std::string_view terminal) const;

  const runtime::PlantFile& file_;
  const runtime::StationConfig& station_;
  std::string program_;  // its text, where it is known
};

}  // namespace ipos::tools::serve

// Values of a unit that are read again and again: what is asked for, and rows of what was read.
#pragma once

#include <string>
#include <vector>

#include "tools/input/program.hpp"
#include "tools/parameters/parameter_access.hpp"
#include "tools/parameters/parameter_target.hpp"

namespace ipos::tools {

struct LiveItem {
  std::string name;  // "P000 Speed", "H420", "lTrDataLow"
  Target target;
  bool hex = false;
};

// "P000", "8318", "H420", "lTrDataLow@PROGRAM.IPC", each with ":hex" after it if wanted. A structure or
// array stands for all its members. Without "@" a symbol is looked up in `image`, the program of a simulated
// station; it may be null. What is not known is a Failure.
std::vector<LiveItem> live_items(const stdlib::UnitType& unit, const std::vector<std::string>& names,
                                 const vm::Image* image, const CompileFlags& compile);

enum class LiveForm : uint8_t { Rows, Once, Json };

class LiveTable {
 public:
  LiveTable(std::vector<LiveItem> items, LiveForm form);

  // Reads everything and prints it: a row (with a head before the first one), a line for each value, or an
  // object. `seconds` stands in front. What the unit refuses or does not answer is told on stderr at its
  // first time, and the cell stays empty.
  void print(double seconds, ParameterAccess& access);

  bool complete() const { return complete_; }  // every value was read, every time

 private:
  void print_rows(double seconds, const std::vector<std::string>& texts);

  std::vector<LiveItem> items_;
  LiveForm form_;
  std::vector<size_t> widths_;     // empty before the first row
  std::vector<std::string> told_;  // reasons
  std::vector<bool> has_reason_;   // of each item: reasons may tell figures, and none may fill the screen
  bool complete_ = true;
};

}  // namespace ipos::tools

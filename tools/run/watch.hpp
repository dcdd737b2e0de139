// The watch window: named variables of a station as the manuals' screens show them.
#pragma once

#include <string>
#include <vector>

#include "runtime/plant/station.hpp"

namespace ipos::tools {

struct WatchRow {
  std::string name;  // symbol, or "H5" for a variable without one
  uint32_t index;
  int32_t value;
  bool hex;  // the plant file shows it in hexadecimal
};

// All named variables in rising order of number, or those asked for, as variable_names.hpp reads them: "TrCycl"
// gives all members of a structure. A name the station does not know is left out.
std::vector<WatchRow> watch_rows(const runtime::Station& station, const std::vector<std::string>& names);

// "H420 TrCycl.ObjectNo   1024", hexadecimal "H426 lTrDataLow        11223344 h".
std::string watch_window(const std::vector<WatchRow>& rows);

}  // namespace ipos::tools

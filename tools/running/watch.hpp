// The watch window: variables of a station as the manuals' screens show them, and its other signals below.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

struct WatchRow {
  std::string name;               // symbol, or "H5" for a variable without one
  std::optional<uint32_t> index;  // of a variable
  double value;      // the number shown
  bool hex;          // the plant file shows it in hexadecimal
  std::string text;  // of another signal: "1500.000 rpm"
};

// All named variables in rising order of number, or those asked for, as variables.hpp reads them: "TrCycl"
// gives all members of a structure; or signals and patterns of them (find.hpp). A name the station
// does not know is left out.
std::vector<WatchRow> watch_rows(const runtime::Station& station, const std::vector<std::string>& names);

// Of gateways and lines, by whole names and patterns: "gw.powered", "sbus.013.PO1". What a station has is not among them.
std::vector<WatchRow> watch_rows(const runtime::Plant& plant, const std::vector<std::string>& names);

// "H420 TrCycl.ObjectNo   1024", hexadecimal "H426 lTrDataLow        11223344 h".
std::string watch_window(const std::vector<WatchRow>& rows);

}  // namespace ipos::tools

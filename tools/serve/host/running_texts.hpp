// The texts of the programs that run, by station: those of the start or of the last restart, and where a program was
// loaded since, those it was compiled from. A file may stand in two programs of which one was loaded anew, so a station
// has texts of its own.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string_view>

#include "tools/serve/host/outside.hpp"

namespace ipos::tools::serve {

class RunningTexts {
 public:
  explicit RunningTexts(Files& files) : files_(&files) {}

  // Everything was built of these.
  void restarted(Texts texts);
  // Power-on again: no program was loaded yet.
  void begin_again() { loaded_.clear(); }
  void loaded(uint32_t station, Texts texts);

  std::optional<std::string> text(uint32_t station, const std::string& file) const;
 private:
  Files* files_;
  std::optional<Texts> base_;  // none: the start, which the files know
  std::map<uint32_t, Texts> loaded_;
};

// Tells two texts apart.
std::string version_of(std::string_view text);

// Where a line of one text is in another, from 1: the same line, else the one that stands in its place.
uint32_t line_in(std::string_view before, std::string_view after, uint32_t line);

}  // namespace ipos::tools::serve

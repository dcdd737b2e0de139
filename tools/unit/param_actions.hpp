// What `ipos param` does with the parameter channel of a unit. Each action returns the exit code.
#pragma once

#include <string>
#include <vector>

#include "tools/parameters/parameter_access.hpp"
#include "tools/parameters/parameter_set.hpp"

namespace ipos::tools {

struct ListChoice {
  std::string group;      // "P1": numbers that begin so
  bool changed = false;   // only what differs from the factory setting
  bool detailed = false;  // with default, limits and access
  bool json = false;
};

int list_parameters(ParameterAccess& access, const ListChoice& choice);
int get_parameters(ParameterAccess& access, const std::vector<std::string>& names, bool json);
// "P130=2.5s". Nothing is written when one of them cannot be read; a refused one does not keep the others.
int set_parameters(ParameterAccess& access, const std::vector<std::string>& assignments, bool is_volatile,
                   bool json);
int save_parameters(ParameterAccess& access, const std::string& file);
// The order is that of docs/guide/param.md; refused rows are printed with their places in `file`.
int load_parameters(ParameterAccess& access, const std::string& file, const ParameterSet& set,
                    bool is_volatile, bool json);
// Exit code 1 when there are differences. The names stand for the two sides.
int diff_parameters(const ParameterSet& a, const std::string& a_name, const ParameterSet& b,
                    const std::string& b_name, bool json);

}  // namespace ipos::tools

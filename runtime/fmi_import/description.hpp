// modelDescription.xml of an FMU for co-simulation, FMI 2.0 or 3.0: what ipos needs of it. The file is a stranger's: documents
// with types of their own are refused, and sizes are bounded.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/fmi_import/host/protocol.h"
#include "runtime/plant_file/foreign_machine.hpp"

namespace ipos::fmi_import {

struct Variable {
  std::string name;
  uint32_t reference = 0;
  std::string causality;  // "local" where none is given
  std::string variability;
  std::string initial;
  std::optional<ipos_fmu_type> type;  // nothing: a text, bytes or a clock
  std::string declared_type;
  std::string unit;
  bool is_array = false;
};

struct Description {
  static constexpr size_t kMostBytes = size_t{64} << 20U;  // ours
  static constexpr size_t kMostVariables = 1'000'000;      // ours

  unsigned version = 0;  // 2 or 3
  std::string model;
  std::string token;  // guid in FMI 2.0
  std::string identifier;  // of the library; a plain name
  bool needs_tool = false;
  bool gives_state = false;  // also as bytes
  double fixed_step = 0;     // s, of its inside; 0: not told
  std::vector<Variable> variables;
  std::map<std::string, std::optional<runtime::PhysicalUnit>, std::less<>> units;  // nothing: without a base unit
};

tl::expected<Description, std::string> read_description(std::string_view xml);

}  // namespace ipos::fmi_import

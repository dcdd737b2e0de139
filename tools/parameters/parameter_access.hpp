// The parameter channel of one unit, however it is reached: a station of a plant, or a drive on a line. The
// services are those of 1053 1610 p. 31; what a unit answers is the same everywhere.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <tl/expected.hpp>

#include "stdlib/return_codes.hpp"
#include "stdlib/services.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::tools {

struct AccessError {
  std::optional<stdlib::ReturnCode> code;  // the unit's refusal
  std::string trouble;                     // without a code: why there is no answer
};
using AccessReply = tl::expected<int32_t, AccessError>;

class ParameterAccess {
 public:
  virtual ~ParameterAccess() = default;

  // A write answers the value written.
  virtual AccessReply execute(stdlib::Service service, uint16_t index, int32_t value = 0) = 0;

  virtual std::string name() const = 0;  // for messages: "unit1 of plant.toml"
  virtual const stdlib::UnitType& unit() const = 0;

  // Why nothing that is written lasts; empty when it does.
  virtual std::string forgets() const { return {}; }
  // What would set this parameter again at the next start; empty when nothing does.
  virtual std::string overridden_by(uint16_t /*index*/) const { return {}; }
};

}  // namespace ipos::tools

// The prefixes, also where there are no adapters.
#include "runtime/os_port/adapter_port.hpp"

#include <algorithm>

namespace ipos::runtime {

bool is_adapter_port(std::string_view name) {
  static constexpr std::string_view kPrefixes[] = {
#define CAN_ADAPTER(prefix, sample, windows, linux_, package, open) prefix,
#include "runtime/os_port/adapters/can_adapters.def"
  };
  return std::any_of(std::begin(kPrefixes), std::end(kPrefixes),
                     [name](std::string_view prefix) { return name.starts_with(prefix); });
}

}  // namespace ipos::runtime

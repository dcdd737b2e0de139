// What `ipos build --time` prints: the longest ways of the functions of each station, as a table or as JSON.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "runtime/plant/plant.hpp"

namespace ipos::tools {

// `speed`: commands per ms of every task, in place of P938 and P939.
std::string time_table(const runtime::Plant& plant, std::optional<uint32_t> speed);
std::string time_json(const runtime::Plant& plant, std::optional<uint32_t> speed);

}  // namespace ipos::tools

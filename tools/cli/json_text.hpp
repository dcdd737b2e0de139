// JSON as every verb writes it: valid UTF-8, whatever bytes names of files and images have.
#pragma once

#include <string>

namespace ipos::tools {

// On one line, or with `indent` blanks for each level. What is no UTF-8 is written as U+FFFD.
template <typename Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace ipos::tools

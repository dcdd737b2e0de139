// Whether a text has a part: what tests of messages and outputs ask.
#pragma once

#include <string>

namespace ipos::tests {

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace ipos::tests

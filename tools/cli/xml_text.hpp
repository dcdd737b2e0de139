// Text as XML has it: valid UTF-8 without control characters but line ends, markup escaped.
#pragma once

#include <string>
#include <string_view>

namespace ipos::tools {

// Lines of valid UTF-8 without control characters; what is neither is written as compiler messages do.
std::string utf8(std::string_view text);

std::string xml_text(std::string_view text);
// In an attribute a line end would be read as a blank.
std::string xml_attribute(std::string_view text);

}  // namespace ipos::tools

// The names that the header files of the language define, with their texts: read from the headers themselves,
// so that a message can say which header a name comes with.
#pragma once

#include <span>
#include <string_view>

namespace ipos::stdlib {

struct HeaderName {
  std::string_view name;
  std::string_view text;    // what it stands for, without a comment
  std::string_view header;  // "const.h"
};

// In the order of the headers and their lines; a name that two headers define stands twice.
std::span<const HeaderName> header_names();

// Of a header that is included: const.h and io.h, or for `b_headers` constb.h and iob.h, which both know
// more.
const HeaderName* find_header_name(std::string_view name, bool b_headers);

}  // namespace ipos::stdlib

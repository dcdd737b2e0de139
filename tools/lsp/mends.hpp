// Mends of a message that are certain: what stands there instead. The message says it in words; here it becomes an edit.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "tools/lsp/features.hpp"

namespace ipos::tools::lsp {

// Bytes of the text that are replaced.
struct Mend {
  uint32_t begin = 0;
  uint32_t end = 0;
  std::string text;
};

// Nothing where the message leaves a choice, or the text is not as the mend expects it.
std::optional<Mend> mend_of(std::string_view text, const Json& diagnostic, Encoding encoding);

}  // namespace ipos::tools::lsp

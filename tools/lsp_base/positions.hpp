// Places between the editor and the compiler: URIs and paths, lines with characters and byte offsets.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "tools/lsp_base/protocol.hpp"

namespace ipos::tools::lsp {

// What the editor counts in a line: UTF-16 units unless it can count bytes.
enum class Encoding : uint8_t { Utf16, Utf8 };

// Built-in headers have no path; the editor asks for their text (ipos/header).
inline constexpr std::string_view kHeaderScheme = "ipos:/";

// Documents that are no files (untitled:...) keep their URI as path.
std::string path_of(std::string_view uri);
std::string uri_of(std::string_view path);

// Without "/../" and the like, also after the scheme of a document that is no file: two spellings are one document.
std::string tidy(const std::string& path);

// Of a name of the language.
constexpr bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

// Every offset and every position is fine: what lies outside is taken to the nearest place inside.
uint32_t offset_of(std::string_view text, const Json& position, Encoding encoding);
Json position_of(std::string_view text, uint32_t offset, Encoding encoding);
Json range_of(std::string_view text, uint32_t begin, uint32_t end, Encoding encoding);

}  // namespace ipos::tools::lsp

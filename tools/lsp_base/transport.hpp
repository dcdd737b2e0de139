// Messages on a byte stream: a header with Content-Length, an empty line, that many bytes of JSON.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace ipos::tools::lsp {

class MessageReader {
 public:
  void feed(std::string_view bytes) { buffer_ += bytes; }
  // The next complete body. Headers that make no sense are skipped; a body larger than kMaxMessage ends the
  // stream.
  std::optional<std::string> next();
  bool broken() const { return broken_; }
  // What was fed and has not come out yet.
  const std::string& rest() const { return buffer_; }

 private:
  std::string buffer_;
  bool broken_ = false;
};

inline constexpr size_t kMaxMessage = 256U << 20U;
inline constexpr size_t kMaxHeader = 64U << 10U;

std::string framed(std::string_view body);

// The JSON of a body; discarded when it is none. What is no character is U+FFFD: a text that is cut within an emoji
// has half a surrogate pair, and editors send it.
nlohmann::json parsed(std::string_view body);

}  // namespace ipos::tools::lsp

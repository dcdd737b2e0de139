// Standard error goes to a file without a name.
#include "tools/debug/heard_messages.hpp"

#include <fmt/format.h>
#include <unistd.h>

namespace ipos::tools::debug {

HeardMessages::HeardMessages() : file_(std::tmpfile()) {
  std::fflush(stderr);
  if (file_ == nullptr) return;
  before_ = dup(STDERR_FILENO);
  if (before_ >= 0) dup2(fileno(file_), STDERR_FILENO);
}

HeardMessages::~HeardMessages() {
  const std::string heard = text();
  if (before_ >= 0) {
    dup2(before_, STDERR_FILENO);
    close(before_);
  }
  if (file_ != nullptr) std::fclose(file_);
  fmt::print(stderr, "{}", heard);
}

std::string HeardMessages::text() const {
  std::fflush(stderr);
  std::string text;
  if (before_ < 0) return text;
  char part[4096];
  for (off_t at = 0;;) {
    const ssize_t count = pread(fileno(file_), part, sizeof part, at);
    if (count <= 0) return text;
    text.append(part, static_cast<size_t>(count));
    at += count;
  }
}

}  // namespace ipos::tools::debug

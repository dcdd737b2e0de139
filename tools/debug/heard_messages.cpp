// Standard error goes to a file without a name.
#include "tools/debug/heard_messages.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "tools/cli/os_file.hpp"

namespace ipos::tools::debug {

HeardMessages::HeardMessages() : file_(open_without_name()) {
  std::fflush(stderr);
  if (!file_.is_open()) return;
  before_ = dup(STDERR_FILENO);
  if (before_ >= 0) dup2(file_.get(), STDERR_FILENO);
}

HeardMessages::~HeardMessages() {
  const std::string heard = text();
  if (before_ >= 0) {
    dup2(before_, STDERR_FILENO);
    close(before_);
  }
  fmt::print(stderr, "{}", heard);
}

std::string HeardMessages::text() const {
  std::fflush(stderr);
  std::string text;
  if (before_ < 0) return text;
  // Both numbers have one place in the file: it is that of the end again when all is read.
  lseek(file_.get(), 0, SEEK_SET);
  char part[4096];
  for (;;) {
    const auto count = read(file_.get(), part, sizeof part);
    if (count <= 0) return text;
    text.append(part, static_cast<size_t>(count));
  }
}

}  // namespace ipos::tools::debug

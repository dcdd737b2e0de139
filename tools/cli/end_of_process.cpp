// Text is buffered, so that a full disk may be noticed in the middle of a verb, which fmt reports by throwing,
// or not before the last bytes are flushed.
#include "tools/cli/end_of_process.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <system_error>

#include "compiler/diag/places.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

// To standard error without an exception of its own.
void tell(const std::string& text) { std::fputs(("ipos: " + compiler::printable(text) + "\n").c_str(), stderr); }

// Brings what is left to standard output. `error` is that of the exception, 0 for none, and then that of the
// flush.
bool output_lost(int& error) {
  const bool lost = std::ferror(stdout) != 0 || std::ferror(stderr) != 0;
  errno = 0;
  if (std::fflush(stdout) == 0 && !lost) return false;
  if (error == 0) error = errno == 0 ? EIO : errno;
  return true;
}

}  // namespace

int end_of_process(const std::function<int()>& body) {
  int code = kInternal;
  int error_code = 0;
  std::string text;
  try {
    code = body();
  } catch (const Failure& failure) {
    code = failure.exit_code();
    text = failure.what();
  } catch (const std::bad_alloc&) {
    code = kBadInput;
    text = "this input needs more memory than there is";
  } catch (const std::system_error& error) {
    error_code = error.code().value();
    text = std::string("internal error: ") + error.what();
  } catch (const std::exception& error) {
    text = std::string("internal error: ") + error.what();
  }
  if (output_lost(error_code)) {
    tell(std::string("output is lost: ") + std::strerror(error_code));
    return kIoError;
  }
  if (!text.empty()) tell(text);
  return code;
}

}  // namespace ipos::tools

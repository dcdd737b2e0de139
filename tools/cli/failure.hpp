// How a verb ends early: a message for stderr and an exit code. Only tools/ throws.
#pragma once

#include <stdexcept>
#include <string>

#include "tools/cli/exit_codes.hpp"

namespace ipos::tools {

class Failure : public std::runtime_error {
 public:
  // An empty message means that everything has been said already.
  Failure(int exit_code, const std::string& message) : std::runtime_error(message), exit_code_(exit_code) {}
  int exit_code() const { return exit_code_; }

 private:
  int exit_code_;
};

}  // namespace ipos::tools

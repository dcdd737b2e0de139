// What is printed on standard error meanwhile: an editor shows its user what stands in a response, and often nothing else.
#pragma once

#include <string>

#include "runtime/os_port/descriptor.hpp"

namespace ipos::tools::debug {

class HeardMessages {
 public:
  HeardMessages();
  // It stands on standard error then, too.
  ~HeardMessages();
  HeardMessages(const HeardMessages&) = delete;
  HeardMessages& operator=(const HeardMessages&) = delete;

  std::string text() const;

 private:
  runtime::Descriptor file_;
  int before_ = -1;  // standard error; -1: nothing is heard
};

}  // namespace ipos::tools::debug

// What is printed on standard error meanwhile: an editor shows its user what stands in a response, and often nothing else.
#pragma once

#include <cstdio>
#include <string>

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
  std::FILE* file_;
  int before_ = -1;  // standard error; -1: nothing is heard
};

}  // namespace ipos::tools::debug

// getrandom.
#include "tools/serve/random_bytes.hpp"

#include <sys/random.h>
#include <sys/types.h>

namespace ipos::tools::serve {

bool random_bytes(std::span<unsigned char> bytes) {
  return getrandom(bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size());
}

}  // namespace ipos::tools::serve

// The system's preferred generator.
#include "tools/serve/random_bytes.hpp"

#include <windows.h>

#include <bcrypt.h>

namespace ipos::tools::serve {

bool random_bytes(std::span<unsigned char> bytes) {
  return BCryptGenRandom(nullptr, bytes.data(), static_cast<ULONG>(bytes.size()), BCRYPT_USE_SYSTEM_PREFERRED_RNG) >= 0;
}

}  // namespace ipos::tools::serve

// Bytes nobody can guess; posix and windows have a source each.
#pragma once

#include <span>

namespace ipos::tools::serve {

// False: the system gives none.
bool random_bytes(std::span<unsigned char> bytes);

}  // namespace ipos::tools::serve

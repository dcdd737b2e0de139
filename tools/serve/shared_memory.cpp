// One anonymous mapping.
#include "tools/serve/shared_memory.hpp"

#include <sys/mman.h>

#include "tools/cli/failure.hpp"

namespace ipos::tools::serve {

SharedMemory::SharedMemory(size_t bytes) : bytes_(bytes) {
  void* const begin =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (begin == MAP_FAILED) throw Failure(kIoError, "the system gives no memory for what is recorded");
  begin_ = static_cast<std::byte*>(begin);
}

SharedMemory::~SharedMemory() { munmap(begin_, bytes_); }

}  // namespace ipos::tools::serve

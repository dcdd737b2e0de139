// No process can be copied.
#include "tools/serve/host_copies.hpp"

namespace ipos::tools::serve {

std::unique_ptr<Copies> host_copies(bool) { return std::make_unique<Copies>(); }

}  // namespace ipos::tools::serve

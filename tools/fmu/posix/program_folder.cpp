// As the kernel tells it.
#include "tools/fmu/libraries.hpp"

namespace ipos::tools {

std::filesystem::path program_folder() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
}

}  // namespace ipos::tools

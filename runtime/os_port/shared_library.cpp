// dlopen(3).
#include "runtime/os_port/shared_library.hpp"

#include <dlfcn.h>

namespace ipos::runtime {

tl::expected<SharedLibrary, std::string> SharedLibrary::load(const std::string& name) {
  // Asked for by its name: a program without shared libraries (docs/guide/install.md) has none that works on every Linux, and
  // is not to be linked with it.
  static const auto open = reinterpret_cast<decltype(&dlopen)>(dlsym(RTLD_DEFAULT, "dlopen"));
  if (open == nullptr) return tl::unexpected(name + ": this program has all inside and loads no libraries");
  if (void* const handle = open(name.c_str(), RTLD_NOW | RTLD_LOCAL)) return SharedLibrary(handle);
  const char* const why = dlerror();  // it begins with the name
  return tl::unexpected(why != nullptr ? std::string(why) : name);
}

void* SharedLibrary::find(const char* function) const { return dlsym(handle_, function); }

}  // namespace ipos::runtime

// A library of somebody else, loaded while the program runs and only when a port asks for it. It stays loaded: some have
// threads of their own, which do not bear being taken away.
#pragma once

#include <string>

#include <tl/expected.hpp>

namespace ipos::runtime {

class SharedLibrary {
 public:
  // By a path, or by a name that the system looks up where libraries are. The error says why there is none.
  static tl::expected<SharedLibrary, std::string> load(const std::string& name);

  // nullptr: it has no function of this name.
  void* find(const char* function) const;

 private:
  explicit SharedLibrary(void* handle) : handle_(handle) {}
  void* handle_;
};

// Takes the functions of a library by their names, and remembers the first one that is missing.
class FunctionFinder {
 public:
  explicit FunctionFinder(const SharedLibrary& library) : library_(library) {}

  template <typename Function>
  FunctionFinder& take(Function*& function, const char* name) {
    function = reinterpret_cast<Function*>(library_.find(name));
    if (function == nullptr && missing_.empty()) missing_ = name;
    return *this;
  }
  const std::string& missing() const { return missing_; }

 private:
  const SharedLibrary& library_;
  std::string missing_;
};

}  // namespace ipos::runtime

// One of several classes that have one base: `self()` of the base says which one it is, and a visit has a case for each. A case
// that is missing does not compile.
#pragma once

#include <utility>
#include <variant>
#include <vector>

namespace ipos::runtime {

// So that a list of classes can begin with a comma.
template <typename Base, typename... Classes>
struct OneOf {
  using Pointer = std::variant<Classes*...>;
};

template <typename... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};

// Calls the case that takes the class of `thing`.
template <typename Thing, typename... Cases>
decltype(auto) visit(Thing& thing, Cases... cases) {
  const Overloaded<Cases...> all{std::move(cases)...};
  return std::visit([&all](auto* one) -> decltype(auto) { return all(*one); }, thing.self());
}

// Null where it is of another class, or there is none. For a socket that fits only one.
template <typename Class, typename Thing>
Class* as(Thing* thing) {
  if (thing == nullptr) return nullptr;
  const auto self = thing->self();
  Class* const* const found = std::get_if<Class*>(&self);
  return found == nullptr ? nullptr : *found;
}

// Those of one class, in the order of the list.
template <typename Class, typename Things>
std::vector<Class*> of_class(const Things& things) {
  std::vector<Class*> found;
  for (const auto& thing : things)
    if (Class* const one = as<Class>(thing.get())) found.push_back(one);
  return found;
}

}  // namespace ipos::runtime

// Memory of a tree: its nodes lie one after the other and are all given back at once, with no destructor.
#pragma once

#include <algorithm>
#include <memory>
#include <memory_resource>
#include <span>
#include <type_traits>
#include <vector>

namespace ipos::compiler {

class Arena {
 public:
  template <typename Node>
  Node* make(const Node& node) {
    return new (place<Node>(1)) Node(node);
  }

  template <typename Item>
  std::span<Item> list(const std::vector<Item>& items) {
    if (items.empty()) return {};
    Item* const first = place<Item>(items.size());
    std::uninitialized_copy(items.begin(), items.end(), first);
    return {first, items.size()};
  }

 private:
  template <typename T>
  T* place(size_t count) {
    static_assert(std::is_trivially_destructible_v<T>);
    return static_cast<T*>(memory_->allocate(count * sizeof(T), alignof(T)));
  }

  // By pointer, so that a tree can be moved.
  std::unique_ptr<std::pmr::monotonic_buffer_resource> memory_ =
      std::make_unique<std::pmr::monotonic_buffer_resource>(kFirstBlock);
  static constexpr size_t kFirstBlock = 16384;
};

}  // namespace ipos::compiler

// Keeps what is made of programs for plants that are built again and again.
#pragma once

#include <list>
#include <memory>
#include <mutex>
#include <span>

#include "runtime/unit/unit_program.hpp"

namespace ipos::runtime {

// The programs that came last. Plants of several threads may share one.
class ProgramShelf {
 public:
  // Null: it is not there.
  std::shared_ptr<const UnitProgram> find(std::span<const uint32_t> code, const vm::Limits& limits, const Execution& execution);
  void put(std::shared_ptr<const UnitProgram> program);

 private:
  static constexpr size_t kKept = 128;  // ours: 20 KB each, if they are long

  std::mutex mutex_;
  std::list<std::shared_ptr<const UnitProgram>> kept_;  // the last one used first
};

}  // namespace ipos::runtime

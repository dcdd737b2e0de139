// A program as units run it: its verified words, and what the engines make of them. It does not change, so units with the same
// program share one (program_shelf.hpp).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "runtime/unit/execution.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/verify/verify.hpp"

namespace ipos::runtime {

class UnitProgram {
 public:
  // From the shelf of `execution`, if it has one; the error is the rule that the words break.
  static tl::expected<std::shared_ptr<const UnitProgram>, std::string> of(std::vector<uint32_t> code, const vm::Limits& limits,
                                                                         const Execution& execution);

  UnitProgram(const UnitProgram&) = delete;
  UnitProgram& operator=(const UnitProgram&) = delete;

  std::span<const uint32_t> code() const { return code_; }
  const vm::VerifiedImage& verified() const { return *verified_; }
  // It has a command of its own that writes the control word.
  bool may_order() const { return may_order_; }
  // Null: the reference interpreter alone, and no machine code.
  const vm::fast::Predecoded* predecoded() const { return predecoded_ ? &*predecoded_ : nullptr; }
  const vm::fast::Native* native() const { return native_.get(); }

 private:
  explicit UnitProgram(std::vector<uint32_t> code) : code_(std::move(code)) {}
  friend class ProgramShelf;

  std::vector<uint32_t> code_;
  std::optional<vm::VerifiedImage> verified_;  // of code_
  std::vector<vm::fast::Slot> slots_;
  std::optional<vm::fast::Predecoded> predecoded_;  // in slots_
  std::shared_ptr<const vm::fast::Native> native_;
  bool may_order_ = false;
  bool fast_ = false;
  Execution::Compiler compiler_ = nullptr;
};

}  // namespace ipos::runtime

// The fast engine in the library for hosts: ipos.c (embed/core) keeps a pointer to the predecoded program and hands over a
// context that stands at commands for it. A Cortex-M has no use for this, so it is not in ipos.c.
#include <new>
#include <type_traits>

#include "vm/fast/engine.hpp"

extern "C" {
#include "embed/core/context.h"
}

namespace {

using ipos::vm::TaskContext;
using ipos::vm::fast::Predecoded;
using ipos::vm::fast::Slot;

constexpr size_t kAlignment = 8;
// In front of the slots, in the caller's memory.
constexpr size_t kHead = (sizeof(Predecoded) + kAlignment - 1) / kAlignment * kAlignment;
static_assert(std::is_trivially_destructible_v<Predecoded> && alignof(Predecoded) <= kAlignment);

// The engine works on the context where it is.
static_assert(std::is_standard_layout_v<TaskContext> && sizeof(TaskContext) == sizeof(ipos_context));
#define SAME_PLACE(member) static_assert(offsetof(TaskContext, member) == offsetof(ipos_context, member))
SAME_PLACE(state);
SAME_PLACE(depth);
SAME_PLACE(task);
SAME_PLACE(rank);
SAME_PLACE(pc);
SAME_PLACE(wait_ms);
SAME_PLACE(commands);
SAME_PLACE(calls);

}  // namespace

size_t ipos_accelerate_size(const ipos_program* program) {
  return program == nullptr ? 0 : kHead + sizeof(Slot) * Predecoded::slots_needed(program->words);
}

ipos_status ipos_program_accelerate(ipos_program* program, void* memory, size_t size) {
  if (program == nullptr || memory == nullptr) return IPOS_INVALID_ARGUMENT;
  if (reinterpret_cast<uintptr_t>(memory) % kAlignment != 0) return IPOS_MISALIGNED;
  if (size < ipos_accelerate_size(program)) return IPOS_MEMORY_TOO_SMALL;
  const unit_type& unit = *program->unit;
  const ipos::vm::Limits limits{unit.variables, unit.program_words, unit.tasks, unit.call_depth};
  const auto verified = ipos::vm::verify({program->code, program->words}, limits, {});
  if (!verified.image) return IPOS_REFUSED;  // the library has loaded it: it is one
  auto* const slots = reinterpret_cast<Slot*>(static_cast<uint8_t*>(memory) + kHead);
  program->fast =
      new (memory) Predecoded(*verified.image, {slots, Predecoded::slots_needed(program->words)});
  return IPOS_OK;
}

uint32_t ipos_fast_run(const void* fast, ipos_context* context, int32_t* h, uint32_t budget) {
  return ipos::vm::fast::run(*static_cast<const Predecoded*>(fast), *reinterpret_cast<TaskContext*>(context), h,
                             budget, nullptr);
}

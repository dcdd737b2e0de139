// What stands behind the opaque types of ipos.h: plain values in the caller's memory, without destructors, so
// that nothing has to be closed.
#pragma once

#include <optional>
#include <type_traits>

#include "embed/include/ipos.h"
#include "runtime/scom/object_table.hpp"
#include "stdlib/unit_types.hpp"
#include "vm/exec/machine.hpp"
#include "vm/fast/predecode.hpp"
#include "vm/image/view.hpp"
#include "vm/sched/scheduler.hpp"

struct ipos_program {
  ipos::vm::VerifiedImage verified;
  const ipos::stdlib::UnitType* unit;
  ipos::vm::ImageView::Place symbols;
  uint32_t symbol_count;
  uint32_t checksum;
#if IPOS_FAST
  std::optional<ipos::vm::fast::Predecoded> fast;
#endif

  ipos::vm::Reader symbol_reader() const { return ipos::vm::Reader(symbols.bytes, symbols.offset); }
};

struct ipos_vm {
  ipos_vm(const ipos_program& loaded, const ipos_host& callbacks);

  ipos::vm::Machine machine;
  const ipos_program* program;
  ipos_host host;
  ipos::runtime::ObjectTable objects;
  ipos::vm::Rates rates;
  uint64_t ticks = 0;
  uint64_t due_us = 0;  // when the next tick of ipos_run_due() begins
  bool due_known = false;
  bool busy = false;        // inside a function that calls back
  bool fault_told = false;  // to the callback
};

static_assert(std::is_trivially_destructible_v<ipos_program> && sizeof(ipos_program) <= IPOS_PROGRAM_BYTES);
static_assert(std::is_trivially_destructible_v<ipos_vm> && sizeof(ipos_vm) <= IPOS_VM_BYTES);
static_assert(alignof(ipos_program) <= 8 && alignof(ipos_vm) <= 8);

namespace ipos::api {

// What the machine calls; `self` is the ipos_vm.
vm::Host machine_host(ipos_vm& self);

// Tells the host about a fault of the program, once, and ends its telegrams.
void tell_fault(ipos_vm& self);

// Marks the time in which callbacks may come; also inside of one.
class Busy {
 public:
  explicit Busy(ipos_vm& self) : self_(self), before_(self.busy) { self_.busy = true; }
  ~Busy() { self_.busy = before_; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  ipos_vm& self_;
  bool before_;
};

// Aligned, and large enough?
ipos_status check_memory(const void* memory, size_t size, size_t needed, size_t alignment);

}  // namespace ipos::api

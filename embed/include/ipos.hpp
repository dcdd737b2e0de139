// ipos.hpp - ipos.h for C++20: objects with their memory inside, spans, and hosts that are classes. Nothing
// here allocates or throws; what ipos.h says of memory, threads and callbacks holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ipos.h"

namespace ipos {

// A verified program. Does not move: machines refer to it.
class Program {
 public:
  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  // The image is not copied and has to outlive the program; aligned to 4.
  ipos_status load(std::span<const std::byte> image, ipos_trouble* trouble = nullptr) {
    return ipos_program_load(memory_, sizeof memory_, image.data(), image.size(), &program_, trouble);
  }
  // Memory of accelerate_size() bytes, aligned to 8, that outlives the program.
  ipos_status accelerate(std::span<std::byte> memory) {
    return ipos_program_accelerate(program_, memory.data(), memory.size());
  }
  size_t accelerate_size() const { return ipos_accelerate_size(program_); }

  ipos_status find(const char* name, ipos_symbol& symbol) const { return ipos_find(program_, name, &symbol); }
  ipos_program_info info() const {
    ipos_program_info out{};
    ipos_program_info_of(program_, &out);
    return out;
  }
  const ipos_program* get() const { return program_; }

 private:
  alignas(8) std::byte memory_[IPOS_PROGRAM_BYTES];
  ipos_program* program_ = nullptr;
};

// The callbacks of a class: each of these member functions that it has is used.
//   ipos_reply command(ipos_vm*, const ipos_command&)      bool nv_write(uint32_t offset, std::span<const
//   std::byte>) void cancel(ipos_vm*, uint8_t context)                 bool nv_read(uint32_t offset,
//   std::span<std::byte>) ipos_sending send(ipos_vm*, const ipos_frame&, uint32_t tag) uint64_t time_us()
//   void fault(ipos_vm*, const ipos_fault&)
//                                                          void trace(ipos_vm*, const ipos_step&)
template <class H>
ipos_host make_host(H& host) {
  ipos_host out{};
  out.user = &host;
  if constexpr (requires(ipos_vm * vm, const ipos_command& c) { host.command(vm, c); })
    out.command = [](void* self, ipos_vm* vm, const ipos_command* c) {
      return static_cast<H*>(self)->command(vm, *c);
    };
  if constexpr (requires(ipos_vm * vm) { host.cancel(vm, uint8_t{}); })
    out.cancel = [](void* self, ipos_vm* vm, uint8_t context) { static_cast<H*>(self)->cancel(vm, context); };
  if constexpr (requires(ipos_vm * vm, const ipos_frame& f) { host.send(vm, f, uint32_t{}); })
    out.send = [](void* self, ipos_vm* vm, const ipos_frame* f, uint32_t tag) {
      return static_cast<H*>(self)->send(vm, *f, tag);
    };
  if constexpr (requires { host.time_us(); })
    out.time_us = [](void* self) -> uint64_t { return static_cast<H*>(self)->time_us(); };
  if constexpr (requires(std::span<const std::byte> b) { host.nv_write(uint32_t{}, b); })
    out.nv_write = [](void* self, uint32_t offset, const void* bytes, uint32_t size) -> bool {
      return static_cast<H*>(self)->nv_write(offset, std::span(static_cast<const std::byte*>(bytes), size));
    };
  if constexpr (requires(std::span<std::byte> b) { host.nv_read(uint32_t{}, b); })
    out.nv_read = [](void* self, uint32_t offset, void* bytes, uint32_t size) -> bool {
      return static_cast<H*>(self)->nv_read(offset, std::span(static_cast<std::byte*>(bytes), size));
    };
  if constexpr (requires(ipos_vm * vm, const ipos_fault& f) { host.fault(vm, f); })
    out.fault = [](void* self, ipos_vm* vm, const ipos_fault* f) { static_cast<H*>(self)->fault(vm, *f); };
  if constexpr (requires(ipos_vm * vm, const ipos_step& s) { host.trace(vm, s); })
    out.trace = [](void* self, ipos_vm* vm, const ipos_step* s) { static_cast<H*>(self)->trace(vm, *s); };
  return out;
}

// A machine. Does not move; the program and the host have to outlive it.
class Machine {
 public:
  Machine() = default;
  Machine(const Machine&) = delete;
  Machine& operator=(const Machine&) = delete;

  ipos_status init(const Program& program) {
    return ipos_init(memory_, sizeof memory_, program.get(), nullptr, &vm_);
  }
  template <class H>
  ipos_status init(const Program& program, H& host) {
    const ipos_host callbacks = make_host(host);
    return ipos_init(memory_, sizeof memory_, program.get(), &callbacks, &vm_);
  }

  ipos_status start() { return ipos_start(vm_); }
  ipos_status stop() { return ipos_stop(vm_); }
  ipos_status run_ticks(uint32_t ticks, ipos_progress* progress = nullptr) {
    return ipos_run_ticks(vm_, ticks, progress);
  }
  ipos_status run_commands(uint8_t task, uint32_t commands, uint32_t* done = nullptr) {
    return ipos_run_commands(vm_, task, commands, done);
  }
  ipos_status run_due(uint32_t most, ipos_progress* progress = nullptr) {
    return ipos_run_due(vm_, most, progress);
  }
  uint64_t ticks() const { return ipos_ticks(vm_); }

  ipos_status read(const char* name, int32_t& value) const { return ipos_read_symbol(vm_, name, &value); }
  ipos_status write(const char* name, int32_t value) { return ipos_write_symbol(vm_, name, value); }
  // Empty before init().
  std::span<int32_t> variables() {
    ipos_program_info info{};
    ipos_program_info_of(ipos_program_of(vm_), &info);
    return {ipos_variables(vm_), info.variables};
  }
  ipos_fault fault() const {
    ipos_fault out{};
    ipos_fault_of(vm_, &out);
    return out;
  }
  ipos_status receive(const ipos_frame& frame) { return ipos_receive(vm_, &frame); }
  ipos_status resume(uint8_t context) { return ipos_resume(vm_, context); }

  size_t state_size() const { return ipos_state_size(vm_); }
  ipos_status save(std::span<std::byte> bytes) const { return ipos_save(vm_, bytes.data(), bytes.size()); }
  ipos_status restore(std::span<const std::byte> bytes) {
    return ipos_restore(vm_, bytes.data(), bytes.size());
  }

  // For everything else of ipos.h.
  ipos_vm* get() { return vm_; }

 private:
  alignas(8) std::byte memory_[IPOS_VM_BYTES];
  ipos_vm* vm_ = nullptr;
};

}  // namespace ipos

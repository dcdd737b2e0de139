// From a program to executable memory. The code is written while its pages can be written, executed when they
// no longer can.
#include "vm/jit/jit.hpp"

#include <asmjit/core.h>

#include <algorithm>
#include <cstring>

#include "vm/jit/emitter.hpp"

namespace ipos::vm::jit {
namespace {

class Pages {
 public:
  ~Pages() {
    if (start_ != nullptr) asmjit::VirtMem::release(start_, size_);
  }
  bool take(size_t size) {
    const size_t page = asmjit::VirtMem::info().pageSize;
    size_ = (size + page - 1) / page * page;
    return asmjit::VirtMem::alloc(&start_, size_, asmjit::VirtMem::MemoryFlags::kAccessRW) ==
           asmjit::kErrorOk;
  }
  // What has been written may still be in the data cache only.
  bool make_executable(size_t written) {
    asmjit::VirtMem::flushInstructionCache(start_, written);
    return asmjit::VirtMem::protect(start_, size_, asmjit::VirtMem::MemoryFlags::kAccessRX) ==
           asmjit::kErrorOk;
  }
  uint8_t* start() const { return static_cast<uint8_t*>(start_); }

 private:
  void* start_ = nullptr;
  size_t size_ = 0;
};

class HostCode : public Code {
 public:
  bool make(const VerifiedImage& image) {
    const Program program(image);
    asmjit::CodeHolder holder;
    if (holder.init(asmjit::Environment::host()) != asmjit::kErrorOk) return false;
    Emitted emitted;
    if (!emit(program, holder, unwind, emitted) || holder.flatten() != asmjit::kErrorOk ||
        holder.resolveUnresolvedLinks() != asmjit::kErrorOk)
      return false;
    bytes_ = holder.codeSize();
    if (!pages_.take(bytes_) ||
        holder.relocateToBase(reinterpret_cast<uintptr_t>(pages_.start())) != asmjit::kErrorOk ||
        holder.copyFlattenedData(pages_.start(), bytes_) != asmjit::kErrorOk ||
        !pages_.make_executable(bytes_))
      return false;
    entries_ = std::move(emitted.entries);
    returns_ = std::move(emitted.returns);
    needs_.assign(entries_.size(), 0);
    for (const Command& command : program.commands)
      if (entries_[command.at].offset != 0) needs_[command.at] = static_cast<uint16_t>(command.need);
    call_depth_ = std::min<uint32_t>(image.limits().call_depth, kMaxCallDepth);
    native_.code = this;
    native_.needs = needs_;
    native_.run = run;
    return true;
  }

  const fast::Native& native() const override { return native_; }
  size_t bytes() const override { return bytes_; }

 private:
  struct Native : fast::Native {
    const HostCode* code = nullptr;
  };

  static uint32_t run(const fast::Native& self, TaskContext& t, int32_t* h, uint32_t left) {
    const HostCode& code = *static_cast<const Native&>(self).code;
    const Entry entry = code.entries_[t.pc];
    const uint8_t* const start = code.pages_.start();
    Frame frame{
        &t, h,    start + entry.offset, code.call_depth_ - t.depth, static_cast<int32_t>(left) - entry.credit,
        0,  &code};
    reinterpret_cast<void (*)(Frame*)>(reinterpret_cast<uintptr_t>(start))(&frame);
    t.pc = frame.pc;
    return static_cast<uint32_t>(frame.number);
  }

  // The stack of machine code grows down from the address of the first call it has not nested itself.
  static void unwind(Frame* frame, const uint64_t* top) {
    const HostCode& code = *static_cast<const HostCode*>(frame->code);
    const auto start = reinterpret_cast<uintptr_t>(code.pages_.start());
    const auto* block =
        reinterpret_cast<const uint64_t*>(reinterpret_cast<uintptr_t>(top) & ~uintptr_t{kBlock - 1});
    TaskContext& t = *frame->context;
    for (const uint64_t* slot = block + (code.call_depth_ - t.depth); slot != top;) {
      const auto offset = static_cast<uint32_t>(*--slot - start);
      const auto site = std::lower_bound(code.returns_.begin(), code.returns_.end(), offset,
                                         [](const ReturnSite& row, uint32_t at) { return row.offset < at; });
      t.calls[t.depth++] = static_cast<uint16_t>(site->at);
    }
  }

  Native native_;
  Pages pages_;
  size_t bytes_ = 0;
  uint32_t call_depth_ = 0;
  std::vector<Entry> entries_;
  std::vector<uint16_t> needs_;
  std::vector<ReturnSite> returns_;
};

}  // namespace

std::unique_ptr<Code> compile(const VerifiedImage& program) {
  auto code = std::make_unique<HostCode>();
  if (!code->make(program)) return nullptr;
  return code;
}

bool available() { return true; }

}  // namespace ipos::vm::jit

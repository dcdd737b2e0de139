// The C API (runtime/api/include/ipos.h) under sequences of calls: an image of any kind, hosts whose
// callbacks fail and call back, memory that is too small or crooked, states that were changed. Every object
// lies in heap memory of exactly its size, so the sanitizers see each step beyond it.
#include <ipos.h>
#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "tests/fuzz/valid_code.hpp"
#include "vm/image/image.hpp"

using namespace ipos;         // NOLINT
using namespace ipos::tests;  // NOLINT

namespace {

constexpr int kMostCalls = 48;
constexpr uint32_t kMostTicks = 8;

// Heap memory of 8-byte alignment, displaced if wanted.
class Memory {
 public:
  explicit Memory(size_t size, size_t shift = 0) : bytes_(new uint8_t[size + shift]), shift_(shift) {}
  uint8_t* at() const { return bytes_.get() + shift_; }

 private:
  std::unique_ptr<uint8_t[]> bytes_;
  size_t shift_;
};

void use(ipos_vm* vm, Input& in, int depth);

struct FuzzHost {
  Input& in;
  int depth = 0;
  uint64_t time = 0;
  std::vector<uint8_t> nv = std::vector<uint8_t>(IPOS_NV_BYTES);

  void meddle(ipos_vm* vm) {
    if (depth > 0 || in.u8() % 4 != 0) return;
    ++depth;
    use(vm, in, depth);
    --depth;
  }
};
FuzzHost& host_of(void* user) { return *static_cast<FuzzHost*>(user); }

ipos_reply command(void* user, ipos_vm* vm, const ipos_command* command) {
  require(command->context >= 1 && command->context <= 10, "a command has a context");
  FuzzHost& host = host_of(user);
  host.meddle(vm);
  return {host.in.u8() % 5, static_cast<uint8_t>(host.in.u8() % 3), nullptr};
}
void cancel(void* user, ipos_vm* vm, uint8_t) { host_of(user).meddle(vm); }
ipos_sending send(void* user, ipos_vm* vm, const ipos_frame* frame, uint32_t) {
  require(frame->length <= 8 && frame->id < 2048, "a frame is one of CAN");
  host_of(user).meddle(vm);
  return host_of(user).in.u8() % 4;
}
uint64_t time_us(void* user) { return host_of(user).time += uint64_t{host_of(user).in.u8()} * 100; }
bool nv_write(void* user, uint32_t offset, const void* bytes, uint32_t size) {
  FuzzHost& host = host_of(user);
  require(offset + size <= host.nv.size(), "non-volatile memory has its size");
  if (host.in.u8() % 4 == 0) return false;
  std::memcpy(host.nv.data() + offset, bytes, size);
  return true;
}
bool nv_read(void* user, uint32_t offset, void* bytes, uint32_t size) {
  FuzzHost& host = host_of(user);
  require(offset + size <= host.nv.size(), "non-volatile memory has its size");
  if (host.in.u8() % 8 == 0) return false;
  std::memcpy(bytes, host.nv.data() + offset, size);
  return true;
}
void fault(void* user, ipos_vm* vm, const ipos_fault* fault) {
  require(fault->number != 0 && fault->reason != nullptr, "a fault has a number and a text");
  host_of(user).meddle(vm);
}
void trace(void* user, ipos_vm* vm, const ipos_step*) { host_of(user).meddle(vm); }

ipos_host random_host(FuzzHost& host, uint8_t which) {
  return {&host,
          which & 1 ? command : nullptr,
          which & 2 ? cancel : nullptr,
          which & 4 ? send : nullptr,
          time_us,
          which & 8 ? nv_write : nullptr,
          which & 16 ? nv_read : nullptr,
          which & 32 ? fault : nullptr,
          which & 64 ? trace : nullptr};
}

void seal(std::vector<uint8_t>& bytes) {
  const uint32_t checksum = vm::crc32(std::span(bytes).first(bytes.size() - 4));
  for (uint32_t n = 0; n < 4; ++n) bytes[bytes.size() - 4 + n] = static_cast<uint8_t>(checksum >> (8 * n));
}

// Saves, changes some bytes, restores; a state that is accepted has to be the one that is saved again.
void save_and_restore(ipos_vm* vm, Input& in) {
  const size_t size = ipos_state_size(vm);
  std::vector<uint8_t> state(size), again(size);
  if (ipos_save(vm, state.data(), size) != IPOS_OK) return;
  const uint8_t changes = in.u8() % 4;
  for (int n = 0; n < changes; ++n) {
    const uint32_t at = in.u16();
    state[at % size] = in.u8();
  }
  if (in.u8() % 8 != 0) seal(state);
  const ipos_status status = ipos_restore(vm, state.data(), size);
  require(changes != 0 || status == IPOS_OK, "what was saved is restored");
  require(ipos_save(vm, again.data(), size) == IPOS_OK, "a machine can be saved");
  require(status != IPOS_OK || state == again, "what was restored is saved as it was");
}

void use(ipos_vm* vm, Input& in, int depth) {
  ipos_progress progress;
  uint32_t done = 0;
  int32_t value = 0;
  switch (in.u8() % 24) {
    case 0:
    case 1:
    case 2:
      ipos_run_ticks(vm, in.u8() % kMostTicks, &progress);
      require(progress.ticks < kMostTicks, "no more ticks than asked for");
      break;
    case 3: {
      const uint32_t most = in.u8();
      ipos_run_commands(vm, in.u8() % 5, most, &done);
      require(done <= most, "no more commands than asked for");
      break;
    }
    case 4: ipos_run_due(vm, in.u8() % kMostTicks, &progress); break;
    case 5: ipos_start(vm); break;
    case 6: ipos_stop(vm); break;
    case 7: {
      const uint32_t rates[3] = {in.u8(), in.u8(), in.u8()};
      ipos_set_rates(vm, rates);
      break;
    }
    case 8: ipos_set_sbus(vm, in.u32() % 1'100'000, in.u8(), in.u8(), in.u16()); break;
    case 9: ipos_write(vm, in.u16() % 1100, in.i32()); break;
    case 10: ipos_read(vm, in.u16(), &value); break;
    case 11: ipos_start_task(vm, in.u8() % 5, in.u8()); break;
    case 12: ipos_stop_task(vm, in.u8() % 5); break;
    case 13: ipos_resume(vm, in.u8() % 12); break;
    case 14: ipos_raise_event(vm, in.u8() % 4); break;
    case 15: ipos_raise_fault(vm, in.u8(), "by chance"); break;
    case 16:
    case 17: {
      ipos_frame frame{static_cast<uint16_t>(in.u16() % 2100), static_cast<uint8_t>(in.u8() % 10), {}};
      for (uint8_t& byte : frame.data) byte = in.u8();
      ipos_receive(vm, &frame);
      break;
    }
    case 18: ipos_sent(vm, in.u32(), in.u8() % 2 != 0); break;
    case 19: ipos_nv_store(vm); break;
    case 20: ipos_nv_load(vm); break;
    case 21: {
      const char name[] = {static_cast<char>(in.u8()), static_cast<char>(in.u8()), static_cast<char>(in.u8()),
                           '\0'};
      ipos_read_symbol(vm, name, &value);
      ipos_write_symbol(vm, name, in.i32());
      break;
    }
    case 22: {
      ipos_task task;
      ipos_task_of(vm, in.u8() % 12, &task);
      break;
    }
    default:
      if (depth == 0) save_and_restore(vm, in);
      break;
  }
}

// Raw bytes, raw bytes with a checksum that is right, or a container around code words or a valid program.
std::vector<uint8_t> make_image(Input& in) {
  const uint8_t kind = in.u8();
  if (kind % 8 < 2) {
    std::vector<uint8_t> bytes;
    for (uint32_t left = in.u16() % 256; left > 0; --left) bytes.push_back(in.u8());
    if (kind % 8 == 1 && bytes.size() >= 4) seal(bytes);
    return bytes;
  }
  vm::Image image;
  image.unit = kind % 8 < 7 ? 4 : static_cast<uint8_t>(in.u8() % 8);
  if (kind % 8 == 2) {
    for (uint32_t left = in.u8() % 32; left > 0; --left) image.code.push_back(in.u32());
  } else {
    const size_t window = std::min<size_t>(in.left(), 160);
    Input choices(in.rest(), window);
    image.code = valid_code(choices);
    for (size_t used = window - choices.left(); used > 0; --used) in.u8();
    if (kind & 64) image.symbols.push_back({"abc", in.u16(), static_cast<uint16_t>(1 + in.u8())});
  }
  return vm::write_image(image);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Input in(data, size);
  const std::vector<uint8_t> bytes = make_image(in);
  const uint8_t memory = in.u8();
  const Memory image(bytes.size(), memory % 32 == 1 ? 1 : 0);
  if (!bytes.empty()) std::memcpy(image.at(), bytes.data(), bytes.size());

  const size_t program_size = ipos_program_size() - (memory % 32 == 2 ? 1 : 0);
  const Memory program_memory(program_size, memory % 32 == 3 ? 4 : 0);
  ipos_program* program = nullptr;
  ipos_trouble trouble;
  if (ipos_program_load(program_memory.at(), program_size, image.at(), bytes.size(), &program, &trouble) !=
      IPOS_OK) {
    require(program == nullptr && trouble.offset <= bytes.size(), "a refused image gives no program");
    return 0;
  }
  ipos_symbol symbol;
  for (uint32_t n = 0; n < 3; ++n) ipos_symbol_at(program, n, &symbol);
  std::optional<Memory> fast;
  if (memory & 32) {
    size_t fast_size = ipos_accelerate_size(program);
    if (fast_size != 0 && memory % 32 == 4) --fast_size;
    fast.emplace(fast_size);
    ipos_program_accelerate(program, fast->at(), fast_size);
  }

  FuzzHost fuzz_host{in};
  const ipos_host host = random_host(fuzz_host, in.u8());
  const size_t vm_size = ipos_vm_size() - (memory % 32 == 5 ? 1 : 0);
  const Memory vm_memory(vm_size, memory % 32 == 6 ? 2 : 0);
  ipos_vm* vm = nullptr;
  if (ipos_init(vm_memory.at(), vm_size, program, &host, &vm) != IPOS_OK) return 0;
  ipos_start(vm);
  for (int n = 0; n < kMostCalls && !in.empty(); ++n) use(vm, in, 0);
  return 0;
}

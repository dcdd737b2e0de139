// Non-volatile memory, and the whole state as bytes:
//
//   NV     u32 "IPNV", u32 CRC-32 of the values, H0..H127
//   state  u32 "IPS1", u32 checksum of the image, u64 ticks, machine, variable telegrams, u32 CRC-32 of
//   all
//
// Layouts are ours, numbers little endian.
#include <array>

#include "embed/objects.hpp"
#include "vm/exec/saved_bytes.hpp"
#include "vm/exec/saved_state.hpp"

namespace ipos::api {
namespace {

constexpr uint32_t kNvMagic = 0x564E5049;     // "IPNV"
constexpr uint32_t kStateMagic = 0x31535049;  // "IPS1"

std::span<const uint8_t> bytes_of(const int32_t* values, size_t count) {
  return {reinterpret_cast<const uint8_t*>(values), count * sizeof(int32_t)};
}

template <class Bytes, class State>
constexpr void visit_objects(Bytes& bytes, State& state) {
  const auto common = [&](auto& object) {
    bytes(object.id), bytes(object.data), bytes(object.format.length), bytes(object.format.layout);
  };
  for (auto& object : state.cyclic) common(object), bytes(object.cycle), bytes(object.offset);
  for (auto& object : state.receive) common(object);
  bytes(state.cyclic_count), bytes(state.receive_count);
  bytes(state.started), bytes(state.closed), bytes(state.start_tick);
}

constexpr size_t kObjectsSize = [] {
  vm::ByteCounter counter;
  const runtime::ObjectTable::State state;
  visit_objects(counter, state);
  return counter.size();
}();
constexpr size_t kHeadSize = 2 * sizeof(uint32_t) + sizeof(uint64_t);

size_t state_size(const ipos_vm& self) {
  return kHeadSize + vm::SavedState::size(self.program->verified) + kObjectsSize + sizeof(uint32_t);
}

ipos_status restore(ipos_vm& self, std::span<const uint8_t> bytes) {
  const auto content = bytes.first(bytes.size() - sizeof(uint32_t));
  vm::ByteReader end(bytes.data() + content.size());
  vm::ByteReader in(bytes.data());
  uint32_t magic = 0, program = 0, checksum = 0;
  in(magic), in(program), end(checksum);
  if (magic != kStateMagic || checksum != vm::crc32(content)) return IPOS_BAD_STATE;
  if (program != self.program->checksum) return IPOS_OTHER_PROGRAM;

  uint64_t ticks = 0;
  in(ticks);
  const uint8_t* const machine = in.at();
  vm::ByteReader tail(machine + vm::SavedState::size(self.program->verified));
  runtime::ObjectTable::State objects;
  visit_objects(tail, objects);
  // Ticks are counted on from here without ever overflowing.
  const auto is_time = [](uint64_t tick) { return tick < uint64_t{1} << 62; };
  if (!tail.ok() || !is_time(ticks) || !is_time(static_cast<uint64_t>(objects.start_tick)) ||
      (objects.started && self.host.send == nullptr) ||
      !vm::SavedState::check(self.program->verified, machine) || !self.objects.restore(objects))
    return IPOS_BAD_STATE;
  vm::SavedState::read(machine, self.machine);
  self.ticks = ticks;
  self.due_known = false;
  self.fault_told = self.machine.fault().number != 0;
  return IPOS_OK;
}

}  // namespace
}  // namespace ipos::api

using namespace ipos;       // NOLINT
using namespace ipos::api;  // NOLINT

ipos_status ipos_nv_store(ipos_vm* vm) {
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->host.nv_write == nullptr) return IPOS_NO_CALLBACK;
  if (vm->busy) return IPOS_BUSY;
  const Busy busy(*vm);
  const int32_t* values = vm->machine.variables().data();
  const auto bytes = bytes_of(values, IPOS_NV_VARIABLES);
  const uint32_t head[] = {kNvMagic, vm::crc32(bytes)};
  // The head last: a store that is interrupted leaves nothing that passes for valid.
  const bool stored =
      vm->host.nv_write(vm->host.user, sizeof head, values, static_cast<uint32_t>(bytes.size())) &&
      vm->host.nv_write(vm->host.user, 0, head, sizeof head);
  return stored ? IPOS_OK : IPOS_HOST_FAILED;
}

ipos_status ipos_nv_load(ipos_vm* vm) {
  if (vm == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->host.nv_read == nullptr) return IPOS_NO_CALLBACK;
  if (vm->busy) return IPOS_BUSY;
  const Busy busy(*vm);
  uint32_t head[2] = {};
  std::array<int32_t, IPOS_NV_VARIABLES> values{};
  if (!vm->host.nv_read(vm->host.user, 0, head, sizeof head) ||
      !vm->host.nv_read(vm->host.user, sizeof head, values.data(), sizeof values))
    return IPOS_HOST_FAILED;
  if (head[0] != kNvMagic || head[1] != vm::crc32(bytes_of(values.data(), values.size())))
    return IPOS_NO_CONTENT;
  for (size_t n = 0; n < values.size(); ++n) vm->machine.variables()[n] = values[n];
  return IPOS_OK;
}

size_t ipos_state_size(const ipos_vm* vm) { return vm != nullptr ? state_size(*vm) : 0; }

ipos_status ipos_save(const ipos_vm* vm, void* bytes, size_t size) {
  if (vm == nullptr || bytes == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (size < state_size(*vm)) return IPOS_MEMORY_TOO_SMALL;
  auto* const begin = static_cast<uint8_t*>(bytes);
  vm::ByteWriter head(begin);
  head(kStateMagic), head(vm->program->checksum), head(vm->ticks);
  vm::ByteWriter tail(vm::SavedState::write(vm->machine, head.at()));
  visit_objects(tail, vm->objects.state());
  tail(vm::crc32({begin, tail.at()}));
  return IPOS_OK;
}

ipos_status ipos_restore(ipos_vm* vm, const void* bytes, size_t size) {
  if (vm == nullptr || bytes == nullptr) return IPOS_INVALID_ARGUMENT;
  if (vm->busy) return IPOS_BUSY;
  if (size != state_size(*vm)) return IPOS_BAD_STATE;
  return restore(*vm, {static_cast<const uint8_t*>(bytes), size});
}

// Two slots on a medium, written in turn: after a power cut at any byte of any write, load() finds the old
// content or the new one, whole. docs/inside/nv-memory.md has the layout and the order of the writes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runtime/nv_memory/medium/nv_content.hpp"
#include "runtime/nv_memory/medium/nv_medium.hpp"

namespace ipos::runtime {

// Bytes from one slot to the next; room for every program and value a unit can have.
inline constexpr uint64_t kSlotStride = 0x20000;
inline constexpr size_t kSlotHeaderSize = 16;
inline constexpr uint16_t kNvVersion = 1;

enum class NvOutcome : uint8_t {
  Fresh,    // nothing was ever written
  Loaded,   // `content` is the newest that is whole
  Damaged,  // something is there, and nothing of it is whole: factory values
  Refused,  // no memory, or that of another unit type or a newer version: must not be written
  Failed,   // the medium cannot be read
};

struct NvLoad {
  NvOutcome outcome;
  NvContent content;
  std::string text;  // about damage, refusal and failure, with the offset in the file; else empty
};

class SlotStore {
 public:
  // `unit` is the code of the unit type. The medium must outlive the store.
  SlotStore(NvMedium& medium, uint8_t unit) : medium_(medium), unit_(unit) {}

  // Must come before the first save(), and must not have been Refused or Failed.
  NvLoad load();

  // Stores the content for good; nothing when that is done, else why not. After a failure the content of
  // before is still there.
  std::optional<std::string> save(const NvContent& content);

 private:
  NvMedium& medium_;
  uint8_t unit_;
  unsigned next_slot_ = 0;
  uint32_t sequence_ = 0;  // of the newest whole slot
  bool is_new_ = false;    // nothing was ever written
  bool loaded_ = false;    // load() has found the slot for the next save()
};

}  // namespace ipos::runtime

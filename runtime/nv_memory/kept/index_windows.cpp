// Working and kept words of the index areas.
#include "runtime/nv_memory/kept/index_windows.hpp"

#include <algorithm>
#include <utility>

#include "vm/image/image.hpp"
#include "vm/isa/isa.hpp"

namespace ipos::runtime {
namespace {

namespace codes = stdlib::return_codes;

uint32_t checksum(std::span<const uint32_t> words) {
  std::vector<uint8_t> bytes;
  bytes.reserve(4 * words.size());
  for (const uint32_t word : words)
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<uint8_t>(word >> shift));
  return vm::crc32(bytes);
}

}  // namespace

ValueWindow::ValueWindow(NonvolatileMemory& memory, uint16_t first_index, uint16_t count, uint16_t kept)
    : memory_(memory), first_index_(first_index), own_(count), kept_(std::min(count, kept)), words_(own_) {}

void ValueWindow::use(std::span<int32_t> words) {
  std::copy_n(words_.begin(), std::min(words_.size(), words.size()), words.begin());
  words_ = words;
}

void ValueWindow::park() {
  if (words_.data() != own_.data()) use(own_);
}

void ValueWindow::restart() {
  words_ = own_;
  std::fill(words_.begin(), words_.end(), 0);
  std::copy(kept_.begin(), kept_.end(), words_.begin());
}

int32_t* ValueWindow::kept_at(uint16_t index) {
  const size_t offset = static_cast<size_t>(index) - first_index_;  // huge for an index before the first
  return offset < kept_.size() ? &kept_[offset] : nullptr;
}

ParameterReply ValueWindow::write(uint16_t offset, int32_t value, bool nonvolatile) {
  words_[offset] = value;
  if (!nonvolatile || !stored(offset)) return value;
  const int32_t before = std::exchange(kept_[offset], value);
  if (memory_.save(static_cast<uint16_t>(first_index_ + offset))) return value;
  kept_[offset] = before;
  return tl::unexpected(codes::kNotSaved);
}

ProgramWindow::ProgramWindow(NonvolatileMemory& memory, uint16_t first_index, uint16_t count)
    : memory_(memory), first_index_(first_index), count_(count) {}

// The operands of a command that ends the program may be words that are 0.
void ProgramWindow::reach(size_t words) {
  const size_t wanted = std::max(words, std::min<size_t>(count_, words + vm::kMaxWords - 1));
  if (words_.size() < wanted) words_.resize(wanted);
}

bool ProgramWindow::restart(std::span<const uint32_t> program) {
  origin_ = checksum(program);
  const bool foreign = kept_ && kept_->origin != origin_;
  if (foreign) kept_.reset();
  if (kept_) program = kept_->words;
  words_.assign(program.begin(), program.end());
  reach(program.size());
  return !foreign;
}

std::vector<uint32_t> ProgramWindow::code() const {
  size_t used = words_.size();
  while (used > 0 && words_[used - 1] == 0) --used;
  size_t end = 0;
  while (end < used) {
    const vm::Decoded decoded = vm::decode(words_, static_cast<uint32_t>(end));
    end += decoded.status == vm::DecodeStatus::Ok ? decoded.words : 1;
  }
  return {words_.begin(), words_.begin() + static_cast<std::ptrdiff_t>(end)};
}

bool ProgramWindow::empty() const {
  return std::all_of(words_.begin(), words_.end(), [](uint32_t word) { return word == 0; });
}

void ProgramWindow::keep() {
  std::vector<uint32_t> words = code();
  if (checksum(words) == origin_)
    kept_.reset();
  else
    kept_ = NvProgram{origin_, std::move(words)};
}

bool ProgramWindow::running() const {
  if (machine_ == nullptr) return false;
  for (int task = 1; task <= vm::kTasks; ++task)
    if (machine_->task(task).state != vm::TaskState::Stopped) return true;
  return false;
}

ParameterReply ProgramWindow::write(uint16_t offset, int32_t value, bool nonvolatile) {
  if (running()) return tl::unexpected(codes::kProtected);
  reach(size_t{offset} + 1);
  words_[offset] = static_cast<uint32_t>(value);
  if (!nonvolatile) return value;
  std::optional<NvProgram> before = kept_;
  keep();
  if (memory_.save(static_cast<uint16_t>(first_index_ + offset))) return value;
  kept_ = std::move(before);
  return tl::unexpected(codes::kNotSaved);
}

}  // namespace ipos::runtime

// The index areas beside the parameters: IPOS variables (11000 + n), curve points (20000 + n) and program
// code (16000 + n) (1053 1610 p. 67). Each has working words, and what of them survives power-off.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/drive/parameters.hpp"
#include "runtime/nv_memory/medium/nv_content.hpp"
#include "vm/exec/machine.hpp"

namespace ipos::runtime {

// Variables or curve points. The first ones of the area can be kept.
class ValueWindow final : public IndexWindow {
 public:
  ValueWindow(NonvolatileMemory& memory, uint16_t first_index, uint16_t count, uint16_t kept);
  ValueWindow(const ValueWindow&) = delete;
  ValueWindow& operator=(const ValueWindow&) = delete;

  // From now on the working words are there; they take over the present values. park() takes them back before
  // those words vanish.
  void use(std::span<int32_t> words);
  void park();
  // Power-on: the kept values, 0 for the others.
  void restart();

  std::span<int32_t> kept() { return kept_; }
  int32_t* kept_at(uint16_t index);  // nullptr for an index that is not kept here
  std::span<const int32_t> kept() const { return kept_; }
  std::span<int32_t> words() { return words_; }
  std::span<const int32_t> words() const { return words_; }
  uint16_t first_index() const { return first_index_; }

  ParameterReply read(uint16_t offset) override { return words_[offset]; }
  ParameterReply write(uint16_t offset, int32_t value, bool nonvolatile) override;
  bool stored(uint16_t offset) const override { return offset < kept_.size(); }

 private:
  NonvolatileMemory& memory_;
  uint16_t first_index_;
  std::vector<int32_t> own_;  // the words until use()
  std::vector<int32_t> kept_;
  std::span<int32_t> words_;
};

// The program memory. It is what is verified and started, not what runs: a running program has words of its
// own. Writing is refused while a task runs.
class ProgramWindow final : public IndexWindow {
 public:
  ProgramWindow(NonvolatileMemory& memory, uint16_t first_index, uint16_t count);
  ProgramWindow(const ProgramWindow&) = delete;
  ProgramWindow& operator=(const ProgramWindow&) = delete;

  // Power-on: the plant's program, or what was kept of a change to it. False: a change of another program was
  // kept; it is dropped.
  bool restart(std::span<const uint32_t> program);
  // Whose tasks keep the memory closed; nullptr for none.
  void watch(const vm::Machine* machine) { machine_ = machine; }

  // The program as it would be started: up to the last word that is not 0, with the command it belongs to.
  std::vector<uint32_t> code() const;
  bool empty() const;

  // What survives power-off; nothing when it is the plant's program.
  const std::optional<NvProgram>& kept() const { return kept_; }
  void set_kept(std::optional<NvProgram> program) { kept_ = std::move(program); }
  // Keeps the program memory as it is now.
  void keep();

  ParameterReply read(uint16_t offset) override { return offset < words_.size() ? static_cast<int32_t>(words_[offset]) : 0; }
  ParameterReply write(uint16_t offset, int32_t value, bool nonvolatile) override;
  bool stored(uint16_t /*offset*/) const override { return true; }

 private:
  bool running() const;
  void reach(size_t words);

  NonvolatileMemory& memory_;
  uint16_t first_index_;
  uint16_t count_;               // words that have an index
  std::vector<uint32_t> words_;  // the first ones; all others are 0
  uint32_t origin_ = 0;          // CRC-32 of the plant's program
  std::optional<NvProgram> kept_;
  const vm::Machine* machine_ = nullptr;
};

}  // namespace ipos::runtime

// The non-volatile memory of one unit: gathers what survives power-off, stores it on a medium and takes it
// back. A write of the parameter channel is on the medium before it is answered; what the drive changes by
// itself is stored at the end of the millisecond (docs/inside/nv-memory.md).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/journal/journal.hpp"
#include "runtime/nv_memory/kept/index_windows.hpp"
#include "runtime/nv_memory/kept/retained_memory.hpp"
#include "runtime/nv_memory/kept/wear.hpp"
#include "runtime/nv_memory/medium/slot_store.hpp"

namespace ipos::runtime {

class UnitMemory final : public NonvolatileMemory, public RetainedMemory {
 public:
  // Opens the index areas of the unit and connects itself to the parameters, which must outlive it.
  explicit UnitMemory(ParameterStore& parameters);

  // Keeps on `medium` from now on and takes over what is there; `name` is its name in messages. An error when
  // it must not be used: another unit's, or not readable. Without a medium all is kept for the run only.
  std::optional<std::string> open(std::unique_ptr<NvMedium> medium, std::string name);

  // Power is back: what the medium holds is checked and taken over again.
  void reload();

  // Stores what has changed. False: it could not be stored; a message says why.
  bool commit();

  // The fault that the state of the memory at power-on is: F94 when nothing in it was whole, F25 when it
  // could not be read; 0 for none.
  uint8_t fault() const { return fault_; }
  // Tells how long the memory lasts at the rate of this run, for each index that was stored more than once.
  void report_wear();

  // The end of a millisecond.
  void tick(Time now) {
    now_ = now;
    if (dirty_) commit();
  }
  void set_time(Time now) { now_ = now; }
  bool has_changed() const { return dirty_; }  // since the last tick

  ValueWindow& variables() { return variables_; }
  const ValueWindow& variables() const { return variables_; }
  ProgramWindow& program() { return program_; }
  bool has_medium() const { return slots_.has_value(); }

  struct Message {
    Weight weight;
    std::string text;
  };
  bool has_messages() const { return !messages_.empty(); }
  // What there is to tell since the last call.
  std::vector<Message> take_messages() { return std::exchange(messages_, {}); }

  bool save(uint16_t index) override;
  void changed() override { dirty_ = true; }
  bool memorize(Memorize what) override;

 private:
  NvLoad load();
  void take_over(const NvContent& content);
  NvContent content() const;
  void count(uint16_t index);
  void tell(Weight weight, const std::string& text);
  std::vector<ValueWindow*> windows() { return {&variables_, &curve_points_}; }

  ParameterStore& parameters_;
  ValueWindow variables_;
  ValueWindow curve_points_;
  ProgramWindow program_;
  std::unique_ptr<NvMedium> medium_;
  std::optional<SlotStore> slots_;
  std::string name_;
  WearWatch wear_;
  std::vector<Message> messages_;
  Time now_ = 0;
  uint8_t fault_ = 0;
  bool dirty_ = false;
  bool failed_ = false;  // the last commit; tried again at the next change and at power-off
};

}  // namespace ipos::runtime

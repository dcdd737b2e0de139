// The state of one unit as its status words show it, and its process data (unit profile: 1053 1610 p. 41,
// MOVITRAC 07 chapter 6, MDX60B/61B p. 84-93).
//
// The drive stands: this is the state of a unit that nobody enables. Terminals, control word, faults and
// factory setting decide between "not ready", "controller inhibit" and "no enable"; evaluate() is the place
// where enabling and setpoints will be decided, and pi_word() where motion will be shown.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "runtime/drive/parameters.hpp"

namespace ipos::runtime {

enum class PoSource : uint8_t { Rs485, Fieldbus, Sbus };

// High byte of status word 1 without fault. MOVITRAC 07 codes the factory setting as 5 (its manual,
// chapter 6.5).
enum class UnitCondition : uint8_t {
  NotReady = 0,
  ControllerInhibit = 1,
  NoEnable = 2,
  FactorySetting = 8,
};

class UnitState final : private DriveLink {
 public:
  static constexpr size_t kWords = 3;
  using Words = std::array<uint16_t, kWords>;

  // Connects itself to the parameters, which must outlive it.
  explicit UnitState(ParameterStore& parameters);
  UnitState(const UnitState&) = delete;
  UnitState& operator=(const UnitState&) = delete;

  // Levels as in InputLevel H483: bits 0..7 DI00..DI07, bits 8..15 DI10..DI17. All 0 at first: open
  // terminals.
  void set_inputs(uint16_t levels) { inputs_ = levels; }
  uint16_t inputs() const { return inputs_; }

  // PO words of a telegram; words it does not carry keep their value. They show in P094..P096 in any case and
  // act only if P876 is ON and the source is the one of P101.
  void take_po(PoSource source, std::span<const uint16_t> words);
  const Words& po() const { return po_; }

  // PI words by P873..P875. Words with assignment IPOS PI-DATA come from the program.
  Words pi() const;
  void set_ipos_pi(const Words& words) { ipos_pi_ = words; }

  // A fault stays until it is reset: by control word bit 6, P840 or the program. 0 is none.
  void raise_fault(uint8_t number);
  void reset_fault() { fault_ = 0; }
  uint8_t fault() const { return fault_; }

  UnitCondition condition() const { return evaluate(); }
  bool ready() const { return fault_ == 0 && !parameters_.factory_setting_running(); }
  bool po_data_enabled() const;
  uint16_t status_word_1() const;
  uint16_t status_word_2() const { return status_block(); }  // virtual output terminals: none yet
  uint16_t status_word_3() const { return status_block(); }  // high byte in no manual read; 0 is ours

  // One millisecond has passed.
  void tick();

 private:
  std::optional<int32_t> live_value(uint16_t index) const override;
  bool controller_inhibited() const override;
  bool output_stage_on() const override { return false; }  // the drive stands
  void on_parameter_written(uint16_t index, int32_t value) override;

  UnitCondition evaluate() const;
  bool terminal_inhibit() const;
  bool bus_inhibit() const;
  bool controls(PoSource source) const;
  // An input has this function (P600..P617) and the level.
  bool any_input(int32_t function, bool level) const;
  void take_control_word(uint16_t word);
  uint8_t status_block() const;
  uint16_t pi_word(size_t n) const;

  ParameterStore& parameters_;
  bool is_m07_;
  uint16_t inputs_ = 0;
  Words po_{};
  Words ipos_pi_{};
  uint16_t control_word_ = 0;
  PoSource control_source_ = PoSource::Rs485;  // where control_word_ came from
  uint8_t fault_ = 0;
  uint32_t factory_setting_ms_ = 0;
  uint32_t minute_ms_ = 0;
};

}  // namespace ipos::runtime

// The parameters of one unit and all services of the MOVILINK parameter channel on them (1053 1610 p. 31-32,
// 65-83). Values live twice: the working value, and for parameters marked N the value in EEPROM that returns
// at restart.
//
// Order in which a write is refused (ours): unknown service, index, read only, factory setting running,
// option card, parameter lock, controller inhibit, output stage, value.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <tl/expected.hpp>

#include "stdlib/parameters.hpp"
#include "stdlib/return_codes.hpp"
#include "stdlib/services.hpp"
#include "stdlib/unit_types.hpp"

namespace ipos::stdlib {
struct Unsimulated;
}

namespace ipos::runtime {

using ParameterService = stdlib::Service;

using ParameterReply = tl::expected<int32_t, stdlib::ReturnCode>;

// What the parameters ask of the drive around them.
class DriveLink {
 public:
  // A value the drive computes; nothing where the stored value counts.
  virtual std::optional<int32_t> live_value(uint16_t index) const = 0;
  virtual bool controller_inhibited() const = 0;
  virtual bool output_stage_on() const = 0;
  // After a write that was carried out. Writing the value a parameter has counts.
  virtual void on_parameter_written(uint16_t index, int32_t value) = 0;

 protected:
  ~DriveLink() = default;
};

// What keeps the values of the unit when it is switched off.
class NonvolatileMemory {
 public:
  // `index` was written by service Write and has its new value. False: it could not be stored.
  virtual bool save(uint16_t index) = 0;
  // The drive itself changed something that is kept: counters, error memory, factory setting.
  virtual void changed() = 0;

 protected:
  ~NonvolatileMemory() = default;
};

enum class IndexArea : uint8_t {
#define INDEX_AREA(name, first, count, everywhere, meaning) name,
#include "stdlib/index_areas.def"
};

// An index area that somebody else holds: IPOS variables, program code, curve points. `offset` counts from
// the first index of the area and is within it.
class IndexWindow {
 public:
  virtual ParameterReply read(uint16_t offset) = 0;
  virtual ParameterReply write(uint16_t offset, int32_t value, bool nonvolatile) = 0;
  // Service Write stores it for good; otherwise both writing services are volatile.
  virtual bool stored(uint16_t /*offset*/) const { return false; }

 protected:
  ~IndexWindow() = default;
};

struct DriveOptions {
  // Option cards; `cards` of the plant file. All fitted where it is left out (ours).
  bool drs = true;
  bool dio = true;
  bool aio = true;
  bool logodrive = true;  // MOVITRAC 07 with IPOS
  // Version in the last two digits of P076; on MOVITRAC 07 it decides about the built-in potentiometer
  // (its manual, table 3). The default is the newest one that table knows (ours).
  uint8_t firmware = 16;
  // How long the unit is not ready after power-on. No manual read has a figure; 0 is ours.
  uint32_t start_up_ms = 0;
  int32_t clock_ppm = 0;      // how much faster its quartz is than the plant's time; slower below 0
  bool mains = true;          // it is switched on with them; without, by its 24 V supply alone
  int32_t type_code = 0;      // P070, whose codes no manual read prints
  bool real_control = false;  // speed and current are what motor and load make of them; else the speed is the setpoint's
  bool own_motor = false;     // the plant describes it
  bool master_encoder = false;  // at X42 of the DRS card: without it there is no synchronous operation

  // The version is at least this one of the standard unit, or of LOGODrive.
  bool firmware_from(uint8_t standard, uint8_t of_logodrive) const {
    return firmware >= (logodrive ? of_logodrive : standard);
  }
};

class ParameterStore {
 public:
  explicit ParameterStore(const stdlib::UnitType& unit, DriveOptions options = {});

  // Both must outlive the store; without them there are no live values, the inhibit is on, and an area
  // answers 11h.
  void connect(DriveLink& drive) { drive_ = &drive; }
  // Without a memory every write counts as stored.
  void connect(NonvolatileMemory& memory) { memory_ = &memory; }
  void plug(IndexArea area, IndexWindow& window) { windows_[static_cast<size_t>(area)] = &window; }

  // A service as it comes over a bus or from MOVLNK. `service` is the raw code; a write answers the value
  // written.
  ParameterReply execute(uint8_t service, uint16_t index, int32_t value = 0);
  ParameterReply execute(ParameterService service, uint16_t index, int32_t value = 0) {
    return execute(static_cast<uint8_t>(service), index, value);
  }

  // The service READ: it changes nothing.
  ParameterReply read(uint16_t index) const;

  // The working value for the drive itself; 0 for an index the unit does not have.
  int32_t value(uint16_t index) const;

  // The same without what the drive computes: what was set.
  int32_t stored(uint16_t index) const;
  // The same by its place, for who asks often: that of an index is the same in all units with one list.
  std::optional<size_t> slot_of(uint16_t index) const;
  int32_t stored_in(size_t slot) const { return slots_[slot].working; }
  // Grows with every change of a setting; display values do not count.
  uint32_t changes() const { return changes_; }

  // A setting made before power-on, from the plant file: EEPROM and working value. Only index, access and
  // value are checked; what needs inhibit needs none here.
  ParameterReply preset(uint16_t index, int32_t value);

  // The drive's own writes, for display values, counters and the error memory. Unknown indices are left
  // alone.
  void set_display(uint16_t index, int32_t value);

  // A working value the program sets (SETSYS, system variables that are parameters): brought into the range,
  // any step of it; the EEPROM keeps its own.
  void set_working(uint16_t index, int32_t value);

  // Power off and on: N from EEPROM, everything else at its default.
  void power_cycle();

  // What the EEPROM holds: the value of every N parameter, in rising order of the indices.
  std::vector<std::pair<uint16_t, int32_t>> kept() const;
  // Takes over what the EEPROM held; what is not named gets its default. Returns the indices of the values
  // that the unit has no parameter for or would refuse.
  std::vector<uint16_t> restore(std::span<const std::pair<uint16_t, int32_t>> values);

  // Fault injection: while a code is set, every service is answered with it and not carried out.
  void inject(std::optional<stdlib::ReturnCode> code) { injected_ = code; }

  // P802 was written: the unit is not ready and refuses writes until the drive says that it is done.
  bool factory_setting_running() const { return factory_setting_; }
  void finish_factory_setting();

  // Writes into EEPROM by index, over the whole life of the unit; PAR-03: cyclic ones wear it out.
  uint32_t eeprom_writes(uint16_t index) const;
  const std::map<uint16_t, uint32_t>& eeprom_writes() const { return eeprom_writes_; }
  void restore_writes(std::map<uint16_t, uint32_t> writes) { eeprom_writes_ = std::move(writes); }
  void count_eeprom_write(uint16_t index) { ++eeprom_writes_[index]; }

  // "P813 SBus address := 64: parameter value too large (0..63)"
  std::string explain(uint8_t service, uint16_t index, int32_t value, stdlib::ReturnCode code) const {
    return stdlib::explain_refusal(table_, service, index, value, code);
  }

  const stdlib::ParameterTable& table() const { return table_; }
  const stdlib::UnitType& unit() const { return unit_; }
  const DriveOptions& options() const { return options_; }

  // What a user has to know of the settings: those that are accepted and not simulated, one text for each
  // reason and parameter. All that now apply; afterwards those that writes have added.
  std::vector<std::string> tell_settings();
  bool has_news() const { return !news_.empty(); }
  std::vector<std::string> take_news() { return std::exchange(news_, {}); }

 private:
  struct Slot {
    const stdlib::Parameter* parameter;
    int32_t working;
    int32_t eeprom;
  };
  struct Place {
    IndexArea area;
    uint16_t offset;
    uint16_t count;
  };

  bool knows_service(uint8_t service) const;
  std::optional<Place> locate(uint16_t index) const;  // of an index that the unit answers to
  Slot* find(uint16_t index);
  const Slot* find(uint16_t index) const;
  int32_t read(const Slot& slot) const;
  ParameterReply serve(Slot& slot, ParameterService service, int32_t value);
  ParameterReply serve_window(const Place& place, ParameterService service, uint16_t index, int32_t value);
  std::optional<stdlib::ReturnCode> refusal(const Slot& slot, int32_t value) const;
  std::optional<stdlib::ReturnCode> value_refusal(const stdlib::Parameter& parameter, int32_t value) const;
  bool has_card(stdlib::OptionCard card) const;
  bool store(Slot& slot, int32_t value, bool nonvolatile);
  void tell(uint16_t index);
  bool counts(const stdlib::Unsimulated& one) const;
  void block_process_data(const stdlib::Parameter& changed);
  void tell_memory();
  void take_effect(uint16_t index, int32_t value);
  int32_t attribute(const Slot& slot) const;

  const stdlib::UnitType& unit_;
  const stdlib::ParameterTable& table_;
  DriveOptions options_;
  std::vector<Slot> slots_;  // in rising order of the indices
  std::array<IndexWindow*, 7> windows_{};
  std::map<uint16_t, uint32_t> eeprom_writes_;
  DriveLink* drive_ = nullptr;
  NonvolatileMemory* memory_ = nullptr;
  std::optional<stdlib::ReturnCode> injected_;
  std::vector<std::string> news_;
  std::set<std::pair<uint16_t, const void*>> told_;  // indices with their rows of unsimulated.def
  bool factory_setting_ = false;
  uint32_t changes_ = 0;
};

}  // namespace ipos::runtime

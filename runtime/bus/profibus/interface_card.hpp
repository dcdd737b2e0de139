// The PROFIBUS interface of a drive put together: slave on its line, parameter channel, FMS, switches and LEDs, over
// the inverter's parameters and its drive. What a plant builds for a station.
#pragma once

#include <optional>
#include <string>

#include "runtime/bus/profibus/dp_unit.hpp"
#include "runtime/bus/profibus/fms/slave_links.hpp"
#include "runtime/bus/profibus/fms_objects.hpp"
#include "runtime/bus/profibus/slave_station.hpp"

namespace ipos::profibus {

class InterfaceCard {
 public:
  // How long the green LED flickers after a service of the parameter channel (ours).
  static constexpr Time kFlicker = 100 * runtime::kMillisecond;

  InterfaceCard(runtime::EventQueue& queue, uint32_t source, Line& line, std::string name,
                const OptionType& option, CardSwitches switches, runtime::ParameterServer& inverter,
                const stdlib::ParameterTable& table, FieldbusDrive& drive, SlaveObserver* observer = nullptr);

  // Mains off and on; with the 24 V kept the old switches stay.
  void power_on(Time now, bool supply_was_kept);

  SlaveStation& station() { return station_; }
  const SlaveStation& station() const { return station_; }
  fms::Server& fms() { return *fms_; }  // of MOVITRAC 31 alone
  FieldbusParameters& parameters() { return parameters_; }
  LedPattern leds(Time now) const;

 private:
  FieldbusDrive& drive_;
  FieldbusParameters parameters_;
  DpUnit unit_;
  SlaveStation station_;
  std::optional<FmsObjects> objects_;
  std::optional<fms::Server> fms_;
  std::optional<fms::SlaveLinks> links_;
};

}  // namespace ipos::profibus

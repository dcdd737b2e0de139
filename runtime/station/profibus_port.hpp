// The PROFIBUS card of a station: the slave on the line over the unit's drive and parameters. MOVITRAC 31
// and MOVIDRIVE differ in the parameters that the card sets, and in who monitors the process data.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "runtime/bus/profibus/interface_card.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/profibus_bus.hpp"
#include "runtime/station/station_port.hpp"
#include "runtime/station/unit_server.hpp"
#include "runtime/unit/door.hpp"

namespace ipos::runtime {

class ProfibusPort final : public StationPort,
                           private ParameterServer,
                           private profibus::FieldbusDrive,
                           private profibus::SlaveObserver {
 public:
  // Attaches to the line. All references must outlive the port.
  ProfibusPort(EventQueue& queue, ProfibusBus& bus, const StationConfig& station, Door& door,
               Journal& journal);

  void power_off() override { card_.station().power_off(); }
  void power_on();

  // After the tasks, at the times it asks for: the fault that Slave_Diag shows is taken over. Returns the next one.
  Time tick(Time now) override;

  profibus::InterfaceCard& card() { return card_; }
  const profibus::InterfaceCard& card() const { return card_; }

 private:
  tl::expected<int32_t, ReturnCode> serve(Time now, const ParameterRequest& request) override;
  void take_output(Time now, OutputChannel channel, std::span<const uint16_t> words) override;
  ProcessWords input(Time now) override { return server_.input(now); }
  profibus::FurtherWords further_input(Time now) override;
  bool has_subindices() const override { return server_.has_subindices(); }
  void cyclic_request(Time now) override;
  void synchronize(Time) override {}  // Sync is done before the words come here
  void set_fieldbus_timeout(Time now, int32_t hundredths) override;
  void fieldbus_timeout_expired(Time now) override;
  void set_fieldbus_address(Time now, uint8_t address) override;
  void on_note(Time now, profibus::SlaveNote what, uint8_t master) override;
  void on_link(Time /*now*/, bool lost) override { link_lost_ = lost; }
  void tell_reasons(Time now);
  void note(Time now, std::string text);

  struct Noted {
    profibus::SlaveNote what;
    uint8_t master;
    bool operator==(const Noted&) const = default;
  };

  EventQueue& queue_;
  std::string_view station_;
  const profibus::Line& line_;
  bool own_numbers_;  // Trait::OwnParameterNumbers
  Door& door_;
  Journal& journal_;
  UnitServer server_;
  bool link_lost_ = false;      // between card and unit; power-off ends it
  Time next_fault_ = 0;         // when it is taken over again
  std::optional<Noted> noted_;  // last; a master that asks on and on is told once
  profibus::InterfaceCard card_;
};

}  // namespace ipos::runtime

// A master of FMS among the controls of a plant: its requests at their times, and what came of them for the journal.
#pragma once

#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "runtime/bus/profibus/fms_partner.hpp"
#include "runtime/bus/profibus/master.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/control.hpp"
#include "runtime/station/profibus_bus.hpp"

namespace ipos::runtime {

class FmsControl final : public Control, private EventTarget, private profibus::FmsClient {
 public:
  // Attaches to the line. All references must outlive it.
  FmsControl(EventQueue& queue, uint32_t source, ProfibusBus& bus, const ControlConfig& config,
             const FmsMasterConfig& settings, Journal& journal);
  ~FmsControl() override { queue_.cancel_all(*this); }

  AnyControl self() override { return this; }
  void start() override;

  const FmsMasterConfig& settings() const { return settings_; }

 private:
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_done(uint8_t address, uint8_t cref, const profibus::fms::Done& done) override;
  profibus::FmsPartner& partner(uint8_t address);

  EventQueue& queue_;
  uint32_t source_;
  Journal& journal_;
  const FmsMasterConfig& settings_;
  profibus::Master master_;
  std::deque<profibus::FmsPartner> partners_;  // one a station
  // The answer that was told last, of each request.
  struct Told {
    uint8_t address;
    uint8_t cref;
    profibus::fms::Request request;
    profibus::fms::Response response;
  };
  std::vector<Told> told_;
};

}  // namespace ipos::runtime

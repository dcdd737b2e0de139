// A master control on a PROFIBUS: the model master with the slaves of the plant file, new outputs and commands at
// their times. What it finds of its slaves goes to the journal.
#pragma once

#include <vector>

#include "runtime/bus/profibus/master.hpp"
#include "runtime/clock/event_queue.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/control.hpp"
#include "runtime/station/profibus_bus.hpp"

namespace ipos::runtime {

class ProfibusControl final : public Control, private EventTarget, private profibus::MasterClient {
 public:
  // Attaches to the line. All references must outlive it.
  ProfibusControl(EventQueue& queue, uint32_t source, ProfibusBus& bus, const ControlConfig& config,
                  const ProfibusMasterConfig& settings, Journal& journal);
  ~ProfibusControl() override { queue_.cancel_all(*this); }

  AnyControl self() override { return this; }
  void start() override;  // plans all of it, and the master begins

  const ProfibusMasterConfig& settings() const { return settings_; }
  profibus::Master& master() { return master_; }
  // The slave as the master sees it, with the bits of the diagnosis that are its own; nullptr: not configured.
  const profibus::Diagnosis* view(uint8_t address);

 private:
  enum class Due : uint32_t { Output, Order };
  void on_event(Time now, uint32_t kind, uint64_t argument) override;
  void on_cycle(Time now) override;
  void tell(Time now, size_t slave, unsigned bits);

  EventQueue& queue_;
  uint32_t source_;
  Journal& journal_;
  const ProfibusMasterConfig& settings_;
  profibus::Master master_;
  std::vector<profibus::Octets> outputs_;  // of each slave, as they are sent
  std::vector<unsigned> told_;             // of each, which of the master's own bits
};

}  // namespace ipos::runtime

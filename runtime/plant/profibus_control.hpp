// A master control on a PROFIBUS: the model master with the slaves of the plant file, new outputs and commands at
// their times.
#pragma once

#include "runtime/bus/profibus/master.hpp"
#include "runtime/clock/event_queue.hpp"
#include "runtime/plant/profibus_bus.hpp"
#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

class ProfibusControl final : private EventTarget {
 public:
  // Attaches to the line. All references must outlive it.
  ProfibusControl(EventQueue& queue, uint32_t source, ProfibusBus& bus, const ControlConfig& config);
  ~ProfibusControl() { queue_.cancel_all(*this); }
  ProfibusControl(const ProfibusControl&) = delete;
  ProfibusControl& operator=(const ProfibusControl&) = delete;

  void start();  // plans all of it, and the master begins
  profibus::Master& master() { return master_; }

 private:
  enum class Due : uint32_t { Output, Order };
  void on_event(Time now, uint32_t kind, uint64_t argument) override;

  EventQueue& queue_;
  uint32_t source_;
  const ProfibusMasterConfig& config_;
  profibus::Master master_;
  std::vector<profibus::Octets> outputs_;  // of each slave, as they are sent
};

}  // namespace ipos::runtime

// What the master does when.
#include "runtime/plant/profibus_control.hpp"

#include <algorithm>

namespace ipos::runtime {

ProfibusControl::ProfibusControl(EventQueue& queue, uint32_t source, ProfibusBus& bus,
                                 const ControlConfig& config)
    : queue_(queue),
      source_(source),
      config_(*config.profibus),
      master_(queue, bus.source(), bus.line(), config.name, config_.settings) {
  for (const profibus::SlavePlan& slave : config_.slaves) {
    master_.add_slave(slave);
    outputs_.emplace_back(slave.outputs);
  }
}

void ProfibusControl::start() {
  const auto plan = [this](Due due, const auto& things) {
    for (size_t n = 0; n < things.size(); ++n)
      queue_.schedule(things[n].at, source_, *this, static_cast<uint32_t>(due), n);
  };
  plan(Due::Output, config_.outputs);
  plan(Due::Order, config_.orders);
  master_.start();
}

void ProfibusControl::on_event(Time, uint32_t kind, uint64_t argument) {
  if (static_cast<Due>(kind) == Due::Output) {
    const ProfibusOutput& output = config_.outputs[argument];
    profibus::Octets& octets = outputs_[output.slave];
    std::copy(output.octets.begin(), output.octets.end(),
              octets.begin() + static_cast<std::ptrdiff_t>(output.first));
    return master_.slave(output.slave).set_outputs(octets);
  }
  const ProfibusOrder& order = config_.orders[argument];
  switch (order.kind) {
    case ProfibusOrder::Kind::Control: return master_.control(order.command);
    case ProfibusOrder::Kind::Start: return master_.start();
    case ProfibusOrder::Kind::Stop: return master_.stop();
  }
}

}  // namespace ipos::runtime

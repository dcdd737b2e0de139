// What the master does when.
#include "runtime/station/profibus_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

namespace ipos::runtime {
namespace {

// The bits that a master sets in its own view of a slave (MOVITRAC 31 PROFIBUS, 3.4.1).
struct OwnBit {
  profibus::DiagBit bit;
  std::string_view text;
};
constexpr OwnBit kOwnBits[] = {
    {profibus::diag::kNonExistent,
     "does not answer (Station_Non_Existent): is it on the line, with this address, and has it power?"},
    {profibus::diag::kMasterLock, "belongs to another master (Master_Lock)"},
    {profibus::diag::kInvalidResponse, "does not answer as it should (Invalid_Slave_Response)"},
    {profibus::diag::kDeactivated, "is out of the cycle (Deactivated)"}};

}  // namespace

ProfibusControl::ProfibusControl(EventQueue& queue, uint32_t source, ProfibusBus& bus,
                                 const ControlConfig& config, const ProfibusMasterConfig& settings,
                                 Journal& journal)
    : Control(config),
      queue_(queue),
      source_(source),
      journal_(journal),
      settings_(settings),
      master_(queue, bus.source(), bus.line(), config.name, settings_.settings, this),
      told_(settings_.slaves.size()) {
  for (const profibus::SlavePlan& slave : settings_.slaves) {
    master_.add_slave(slave);
    outputs_.emplace_back(slave.outputs);
  }
}

void ProfibusControl::start() {
  const auto plan = [this](Due due, const auto& things) {
    for (size_t n = 0; n < things.size(); ++n)
      queue_.schedule(things[n].at, source_, *this, static_cast<uint32_t>(due), n);
  };
  plan(Due::Output, settings_.outputs);
  plan(Due::Order, settings_.orders);
  master_.start();
}

const profibus::Diagnosis* ProfibusControl::view(uint8_t address) {
  for (size_t n = 0; n < settings_.slaves.size(); ++n)
    if (settings_.slaves[n].address == address) return &master_.slave(n).view();
  return nullptr;
}

// Every slave has been asked: what is new of one is told. At the beginning units take their time to start (the time is
// ours).
void ProfibusControl::on_cycle(Time now) {
  constexpr Time kStart = 200 * kMillisecond;
  if (now < kStart) return;
  for (size_t slave = 0; slave < told_.size(); ++slave) {
    const profibus::Diagnosis& view = master_.slave(slave).view();
    unsigned bits = 0;
    for (size_t n = 0; n < std::size(kOwnBits); ++n) bits |= view.has(kOwnBits[n].bit) ? 1U << n : 0U;
    if (bits != told_[slave]) tell(now, slave, bits);
  }
}

void ProfibusControl::tell(Time now, size_t slave, unsigned bits) {
  const unsigned before = std::exchange(told_[slave], bits);
  const auto note = [&](std::string_view text) {
    journal_.note(now, Weight::Why, name(), fmt::format("slave {} {}", settings_.slaves[slave].address, text));
  };
  for (size_t n = 0; n < std::size(kOwnBits); ++n)
    if ((bits & ~before & 1U << n) != 0) note(kOwnBits[n].text);
  if ((before & ~bits & 1U) != 0) note("answers now");
}

void ProfibusControl::on_event(Time, uint32_t kind, uint64_t argument) {
  if (static_cast<Due>(kind) == Due::Output) {
    const ProfibusOutput& output = settings_.outputs[static_cast<size_t>(argument)];
    profibus::Octets& octets = outputs_[output.slave];
    std::copy(output.octets.begin(), output.octets.end(),
              octets.begin() + static_cast<std::ptrdiff_t>(output.first));
    return master_.slave(output.slave).set_outputs(octets);
  }
  const ProfibusOrder& order = settings_.orders[static_cast<size_t>(argument)];
  switch (order.kind) {
    case ProfibusOrder::Kind::Control: return master_.control(order.command);
    case ProfibusOrder::Kind::Start: return master_.start();
    case ProfibusOrder::Kind::Stop: return master_.stop();
    case ProfibusOrder::Kind::Activate: return master_.slave(order.slave).set_active(true);
    case ProfibusOrder::Kind::Deactivate: return master_.slave(order.slave).set_active(false);
  }
}

}  // namespace ipos::runtime

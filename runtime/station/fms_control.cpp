// What the master asks when.
#include "runtime/station/fms_control.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace ipos::runtime {

FmsControl::FmsControl(EventQueue& queue, uint32_t source, ProfibusBus& bus, const ControlConfig& config,
                       const FmsMasterConfig& settings, Journal& journal)
    : Control(config),
      queue_(queue),
      source_(source),
      journal_(journal),
      settings_(settings),
      master_(queue, bus.source(), bus.line(), config.name, settings_.settings, nullptr) {
  for (const FmsMasterConfig::Link& link : settings_.links) partner(link.address).link(*link.connection, link.entry);
}

profibus::FmsPartner& FmsControl::partner(uint8_t address) {
  for (profibus::FmsPartner& partner : partners_)
    if (partner.address() == address) return partner;
  profibus::FmsPartner& made = partners_.emplace_back(settings_.settings.address, address, static_cast<profibus::FmsClient&>(*this));
  master_.add_partner(made);
  return made;
}

void FmsControl::start() {
  for (size_t n = 0; n < settings_.requests.size(); ++n)
    queue_.schedule(settings_.requests[n].at, source_, *this, 0, n);
  master_.start();
}

void FmsControl::on_event(Time now, uint32_t, uint64_t argument) {
  const FmsMasterConfig::Request& wanted = settings_.requests[static_cast<size_t>(argument)];
  const FmsMasterConfig::Link& link = settings_.links[wanted.link];
  profibus::fms::ClientLink& open = partner(link.address).link(*link.connection);
  // One that repeats waits for its answer.
  if (wanted.every == 0 || !open.is_busy()) open.ask(wanted.request);
  if (wanted.every != 0) queue_.schedule(now + wanted.every, source_, *this, 0, argument);
}

// The same answer to the same request is told once.
void FmsControl::on_done(uint8_t address, uint8_t cref, const profibus::fms::Done& done) {
  using profibus::fms::describe;
  auto told = std::find_if(told_.begin(), told_.end(), [&](const Told& one) {
    return one.address == address && one.cref == cref && one.request == done.request;
  });
  if (told != told_.end() && told->response == done.response) return;
  const bool same = told != told_.end() && describe(told->response) == describe(done.response);
  if (told == told_.end())
    told_.push_back({address, cref, done.request, done.response});
  else
    told->response = done.response;
  if (same) return;
  journal_.note(queue_.now(), Weight::Why, name(),
                fmt::format("slave {}, connection {}, {}: {}", address, cref, describe(done.request), describe(done.response)));
}

}  // namespace ipos::runtime

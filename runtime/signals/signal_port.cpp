// Variables are parameters 11000 + n (IPOSplus p. 28), so both go the same way.
#include "runtime/signals/signal_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/signals/gateway_signals.hpp"
#include "runtime/signals/station_state.hpp"
#include "runtime/signals/variable_names.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr uint32_t kFirstVariable = 11'000;

}  // namespace

std::optional<SignalPort> SignalPort::find(const std::vector<std::unique_ptr<Station>>& stations,
                                           const runtime::Signal& signal, std::string& why) {
  why.clear();
  const auto station = std::find_if(stations.begin(), stations.end(), [&](const auto& candidate) {
    return candidate->config().name == signal.station;
  });
  if (station == stations.end()) return std::nullopt;
  uint32_t index = 0;
  if (signal.kind == SignalKind::Variable) {
    const auto number = find_variable(**station, signal.name);
    if (number) index = kFirstVariable + *number;
  } else if (signal.kind == SignalKind::Parameter) {
    const stdlib::Parameter* row = (*station)->drive().parameters().table().find(signal.name);
    if (row != nullptr) index = row->index;
  } else if (signal.kind == SignalKind::Any) {
    auto found = find_station_signals(**station, signal.name);
    if (found.size() == 1)
      return SignalPort(**station, std::make_shared<const Signal>(std::move(found.front())));
    why = fmt::format("station '{}' has no signal '{}'; it has {}", signal.station, signal.name,
                      station_signal_names(**station));
    return std::nullopt;
  } else {
    return SignalPort(**station, signal, 0);
  }
  if (index != 0) return SignalPort(**station, signal, static_cast<uint16_t>(index));
  why = fmt::format("station '{}' has no {} '{}'", signal.station,
                    signal.kind == SignalKind::Variable ? "variable" : "parameter", signal.name);
  return std::nullopt;
}

std::optional<SignalPort> SignalPort::find(const Gateway& gateway, const runtime::Signal& signal, std::string& why) {
  std::vector<Signal> all = gateway_signals(gateway);
  auto found = find_among(all, fmt::format("{}.{}", signal.station, signal.name));
  if (found) return SignalPort(std::make_shared<const Signal>(*std::move(found)));
  why = fmt::format("gateway '{}' has no signal '{}'; it has {}", signal.station, signal.name,
                    names_of(all));
  return std::nullopt;
}

int32_t SignalPort::read() const {
  switch (kind_) {
    case SignalKind::Input: return std::as_const(*station_).inputs().line(line_).value();
    case SignalKind::Output: return station_->outputs() >> line_ & 1;
    case SignalKind::State: return station_states()[line_].read(*station_);
    case SignalKind::Any:
      return static_cast<int32_t>(std::lround(static_cast<double>(any_->read()) * any_->factor));
    case SignalKind::Variable:
    case SignalKind::Parameter: break;
  }
  return station_->read(index_);
}

void SignalPort::drive(int32_t level) const {
  if (std::as_const(*station_).inputs().line(line_).driven != level) line().driven = level;
}

std::optional<std::string> SignalPort::write(int32_t value) const {
  ParameterStore& parameters = station_->drive().parameters();
  const auto service = ParameterService::WriteVolatile;
  const ParameterReply reply = parameters.execute(service, index_, value);
  if (reply) return std::nullopt;
  return parameters.explain(static_cast<uint8_t>(service), index_, value, reply.error());
}

}  // namespace ipos::signals

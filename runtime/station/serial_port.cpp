// The parts of an RS-485 interface share its receiver line and its transmitter.
#include "runtime/station/serial_port.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "runtime/plant_file/serial_plan.hpp"
#include "stdlib/control_sources.hpp"

namespace ipos::runtime {

SerialPort::SerialPort(EventQueue& queue, uint32_t source, Rs485Line& line, uint32_t baud,
                       const std::string& station, std::string socket, bool master_slave, Door& door,
                       MovilinkClient& client, Journal& journal)
    : queue_(queue),
      source_(source),
      line_(line),
      station_(station),
      socket_(std::move(socket)),
      master_slave_(master_slave),
      door_(door),
      server_(door),
      exchanges_(door, client),
      journal_(journal),
      port_(line, line.attach(station, baud, *this)) {
  parts_.emplace(*this);
  take_settings(queue.now());
}

SerialPort::Parts::Parts(SerialPort& port)
    : slave(port.queue_, port.source_, port.port_, {}, {}, port.server_, port.server_.rs485_data(),
            port.server_, &port),
      requester(port.queue_, port.source_, port.port_),
      master(port.queue_, requester, port.exchanges_),
      setpoints(port.queue_, port.source_, requester, port.server_) {}

void SerialPort::power_off() {
  line_.set_connected(port_.node(), false);
  parts_.reset();
}

void SerialPort::power_on(Time now) {
  line_.set_connected(port_.node(), true);
  parts_.emplace(*this);
  take_settings(now);
}

Time SerialPort::tick(Time now) {
  take_settings(now);
  return kNever;
}

void SerialPort::take_settings(Time now) {
  const Unit& unit = door_.look();
  const SerialParameters p = unit.server().serial_parameters();
  if (const uint32_t timeouts = unit.drive().rs485_timeouts(); std::exchange(timeouts_, timeouts) != timeouts)
    parts_->slave.count_timeout();
  const bool sends = master_slave_ && sends_setpoints(p.slave_setpoint);
  parts_->slave.configure(
      {p.address, p.group, sends, master_slave_ && stdlib::follows_rs485_master(p.setpoint_source)});
  if (!sends || p.group <= kNoGroupAddress)
    parts_->setpoints.stop();
  else
    parts_->setpoints.start(now, p.group);
}

void SerialPort::report(Time now) {
  if (!parts_) return;
  std::string errors;
  for (size_t n = 0; n < kSerialErrors; ++n) {
    const auto error = static_cast<SerialError>(n);
    // Both hear the same telegrams; only the requester misses a response, only the slave a cyclic request.
    const uint32_t count = std::max(parts_->slave.statistics().of(error), parts_->requester.statistics().of(error));
    if (count != 0)
      errors += fmt::format("{}{} {}", errors.empty() ? "" : ", ", serial_error_text(error), count);
  }
  if (!errors.empty()) explain(now, "errors so far: " + errors);
}

void SerialPort::on_character(Time now, const Character& character) {
  parts_->slave.on_character(now, character);
  parts_->requester.on_character(now, character);
  for (std::string& reason : server_.take_reasons()) explain(now, std::move(reason));
}

void SerialPort::on_sent(Time now) {
  parts_->slave.on_sent(now);
  parts_->requester.on_sent(now);
}

void SerialPort::on_rejected(Time now, const Reception& reception, SerialError error) {
  if (error == SerialError::Address && reception.telegram)
    return explain(now, fmt::format("request to {} is not for this unit: it has P810 = {} and P811 = {}",
                                    reception.telegram->address, parts_->slave.settings().address,
                                    parts_->slave.settings().group));
  explain(now, fmt::format("telegram not accepted: {}", serial_error_text(error)));
}

void SerialPort::on_ignored(Time now, const SerialTelegram& request, Ignored reason, ReturnCode code) {
  std::string text = fmt::format("request to {} {}", request.address, ignored_text(reason));
  if (code != ReturnCode{}) text += fmt::format(" ({})", describe(code));
  explain(now, std::move(text));
}

void SerialPort::explain(Time now, std::string text) {
  journal_.note(now, Weight::Why, station_, fmt::format("RS-485 {}: {}", socket_, std::move(text)));
}

}  // namespace ipos::runtime

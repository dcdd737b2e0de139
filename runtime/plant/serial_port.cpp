// The parts of an RS-485 interface share its receiver line and its transmitter.
#include "runtime/plant/serial_port.hpp"

#include <fmt/format.h>

#include <utility>

#include "runtime/plant/serial_plan.hpp"

namespace ipos::runtime {

SerialPort::SerialPort(EventQueue& queue, uint32_t source, Rs485Line& line, uint32_t baud,
                       const std::string& station, std::string socket, bool master_slave, DriveServer& drive,
                       MovilinkClient& client, Journal& journal)
    : station_(station),
      socket_(std::move(socket)),
      master_slave_(master_slave),
      drive_(drive),
      journal_(journal),
      port_(line, line.attach(station, baud, *this)),
      slave_(queue, source, port_, {}, {}, drive, drive.rs485_data(), drive, this),
      requester_(queue, source, port_),
      master_(queue, requester_, client),
      setpoints_(queue, source, requester_, drive) {
  configure(queue.now());
}

void SerialPort::configure(Time now) {
  const SerialParameters p = drive_.serial_parameters();
  const bool sends = master_slave_ && sends_setpoints(p.slave_setpoint);
  slave_.configure({p.address, p.group, sends, master_slave_ && p.setpoint_source == kFollowsRs485Master});
  if (!sends || p.group <= kNoGroupAddress)
    setpoints_.stop();
  else
    setpoints_.start(now, p.group);
}

void SerialPort::on_character(Time now, const Character& character) {
  slave_.on_character(now, character);
  requester_.on_character(now, character);
  if (std::string refused = drive_.take_reason(); !refused.empty())
    explain(now, "refused " + std::move(refused));
}

void SerialPort::on_sent(Time now) {
  slave_.on_sent(now);
  requester_.on_sent(now);
}

void SerialPort::on_rejected(Time now, const Reception& reception, SerialError error) {
  if (error == SerialError::Address && reception.telegram)
    return explain(
        now, fmt::format("request to {} is not for this unit: it has P810 = {} and P811 = {}",
                         reception.telegram->address, slave_.settings().address, slave_.settings().group));
  explain(now, fmt::format("telegram not accepted: {}", serial_error_text(error)));
}

void SerialPort::on_ignored(Time now, const SerialTelegram& request, Ignored reason, ReturnCode code) {
  std::string text = fmt::format("request to {} had no effect: {}", request.address, ignored_text(reason));
  if (code != ReturnCode{}) text += fmt::format(" ({})", describe(code));
  explain(now, std::move(text));
}

void SerialPort::explain(Time now, std::string text) {
  journal_.note(now, Weight::Why, station_, fmt::format("RS-485 {}: {}", socket_, std::move(text)));
}

}  // namespace ipos::runtime

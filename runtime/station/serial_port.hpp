// One RS-485 interface of a station: slave, requests of its own and master/slave operation on one line.
#pragma once

#include <optional>
#include <string>

#include "runtime/bus/movilink/master_slave.hpp"
#include "runtime/bus/movilink/serial_master.hpp"
#include "runtime/bus/movilink/serial_slave.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/station/station_port.hpp"
#include "runtime/station/unit_server.hpp"

namespace ipos::runtime {

class SerialPort final : public StationPort, private SerialNode, private SerialSlaveObserver {
 public:
  // `socket` is XT or X13, for messages. Master/slave operation is on X13 only (MDX60B/61B p. 11). `client`
  // hears the ends of the exchanges that MOVLNK begins at master().
  SerialPort(EventQueue& queue, uint32_t source, Rs485Line& line, uint32_t baud, const std::string& station,
             std::string socket, bool master_slave, Door& door, MovilinkClient& client, Journal& journal);

  // Power of the unit: off it neither hears nor answers, and nothing it had under way is sent any more. On
  // again, master() is another one.
  void power_off() override;
  void power_on(Time now);

  // Of a switch that is turned: what is sent now keeps its rate.
  uint32_t baud() const { return line_.node_baud(port_.node()); }
  void set_baud(uint32_t baud) { line_.set_baud(port_.node(), baud); }

  // Takes over P810, P811, P750 and P100, and counts missed requests.
  Time tick(Time now) override;

  // At the end: how often each error came, to the journal.
  void report(Time now);

  MovilinkMaster& master() { return parts_->master; }
  const SerialSlave& slave() const { return parts_->slave; }

 private:
  void take_settings(Time now);
  void on_character(Time now, const Character& character) override;
  void on_sent(Time now) override;
  void on_rejected(Time now, const Reception& reception, SerialError error) override;
  void on_ignored(Time now, const SerialTelegram& request, Ignored reason, ReturnCode code) override;
  void explain(Time now, std::string text);

  struct Parts {
    explicit Parts(SerialPort& port);
    SerialSlave slave;
    SerialRequester requester;
    SerialMaster master;
    SetpointSender setpoints;
  };

  EventQueue& queue_;
  uint32_t source_;
  Rs485Line& line_;
  const std::string& station_;
  std::string socket_;
  bool master_slave_;
  Door& door_;
  UnitServer server_;
  ExchangeDoor exchanges_;
  Journal& journal_;
  SerialLinePort port_;
  std::optional<Parts> parts_;  // while the power is on
  uint32_t timeouts_ = 0;       // of the drive, counted so far
};

}  // namespace ipos::runtime

// The parameter channel over SDO: an exchange of one parameter of a unit, as any other bus carries it. The unit's
// parameters are its objects from 2000h on, with four bytes at sub-index 0 (page 55 of 11264926).
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/bus/canopen/place.hpp"
#include "runtime/bus/canopen/sdo_client.hpp"
#include "runtime/bus/movilink/exchange.hpp"

namespace ipos::runtime::canopen {

class SdoMaster final : public MovilinkMaster, private Timer::Owner {
 public:
  // `timeout` is that of one answer. The client must outlive the master.
  SdoMaster(const Place& place, Time timeout, MovilinkClient& client);

  // Reads and writes alone, without process data: SDO knows no other services, and a write is always stored. The address
  // is 1..127.
  std::optional<ReturnCode> start(Time now, const MovilinkJob& job) override;
  void abort() override;

  bool busy() const { return transfer_.is_busy(); }
  bool on_frame(Time now, const Frame& frame);  // true when it was the awaited answer

 private:
  void on_timer(Time now, uint32_t kind) override;
  void send(Time now, const SdoBytes& bytes);
  void finish(Time now);

  Place place_;
  Time timeout_;
  MovilinkClient& client_;
  SdoClient transfer_;
  uint8_t node_ = 0;
  Timer timer_;
};

}  // namespace ipos::runtime::canopen

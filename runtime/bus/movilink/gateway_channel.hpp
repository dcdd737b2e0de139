// The parameter channel of a gateway: eight octets of a fieldbus, a service of a drive on the SBus. As in every cyclic
// channel a service runs once for each change of the handshake bit (1053 1610 p. 30); here it takes as long as
// the drive and the SBus need. Byte 1, which all manuals call reserved, picks the drive by its SBus address (ours).
#pragma once

#include <functional>
#include <string_view>

#include "runtime/bus/movilink/exchange.hpp"

namespace ipos::runtime {

class GatewayChannel final : public MovilinkClient {
 public:
  using Serves = std::function<bool(uint8_t address)>;  // the gateway has a drive there

  // The master carries out the services of this channel alone. Both must outlive it.
  GatewayChannel(MovilinkMaster& master, Serves serves) : master_(master), serves_(std::move(serves)) {}

  // Takes in the channel of a request. While a service runs nothing else is begun.
  void take(Time now, const ParameterTelegram& request);
  // The channel of the response to this request.
  ParameterTelegram answer(const ParameterTelegram& request) const;

  // As at first; the master has given up its exchange.
  void power_off();

  void on_exchange_done(Time now, const MovilinkResult& result) override;

  bool busy() const { return busy_; }
  const ParameterTelegram& last() const { return response_; }  // answer of the last service
  uint32_t error() const { return response_.failed() ? response_.data : 0; }  // its return code; 0: it was good

 private:
  void finish(const ParameterTelegram& response);

  MovilinkMaster& master_;
  Serves serves_;
  bool acknowledged_ = false;  // handshake bit of the last service done
  bool busy_ = false;
  ParameterTelegram request_;  // of the last service
  ParameterTelegram response_;
};

}  // namespace ipos::runtime

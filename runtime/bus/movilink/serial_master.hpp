// The master side of one MOVLNK exchange over RS-485 (1053 1610 p. 47-49): one request of the TYP that Format
// names, and its response. With a parameter channel in a cyclic TYP the service is handed over by the
// handshake bit (p. 34, figure 22): prepare with the bit as it is, change it, repeat until the response has
// it.
#pragma once

#include <array>

#include "runtime/bus/movilink/exchange.hpp"
#include "runtime/bus/movilink/serial_requester.hpp"

namespace ipos::runtime {

inline constexpr Time kHandshakeTimeout = kSecond;  // ours: how long a service may take

class SerialMaster final : public MovilinkMaster, private RequesterClient {
 public:
  SerialMaster(EventQueue& queue, SerialRequester& requester, MovilinkClient& client);

  // Addresses 0..99, groups 100..199, 254, 255.
  std::optional<ReturnCode> start(Time now, const MovilinkJob& job) override;
  void abort() override;
  bool busy() const { return step_ != Step::Idle; }

 private:
  enum class Step : uint8_t { Idle, Single, Learn, Prepare, Hand };

  void on_request_done(Time now, RequestEnd end, const SerialTelegram* response) override;
  void request(Time now, Step step, bool bit);
  void advance(Time now, const SerialTelegram* response);
  void finish(Time now, const SerialTelegram* response);
  void fail(Time now, std::string_view reason);

  EventQueue& queue_;
  SerialRequester& requester_;
  MovilinkClient& client_;

  Step step_ = Step::Idle;
  SerialTelegram telegram_;
  ParameterTelegram service_;
  bool bit_ = false;                              // handshake bit of the last request
  Time begun_ = 0;                                // of the present step
  std::array<std::optional<bool>, 256> known_{};  // handshake bit of each address, where it is known
};

}  // namespace ipos::runtime

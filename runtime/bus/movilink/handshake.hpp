// The parameter channel in cyclic telegrams, slave side (1053 1610 p. 30, 34 and figure 22): a service runs
// once for each change of the handshake bit; until it is done the answers carry the old bit, and an unchanged
// bit only has the channel returned. Bit 0 after power-on (ours: the figure begins with it).
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "runtime/bus/movilink/unit_servers.hpp"

namespace ipos::runtime {

class CyclicChannel {
 public:
  // Carries a request out and makes its answer: PROFIBUS has rules of its own for that.
  using Execution = std::function<ParameterTelegram(Time now, const ParameterTelegram& request)>;

  // `processing` is how long a service takes.
  CyclicChannel(Execution execution, Time processing)
      : execute_(std::move(execution)), processing_(processing) {}
  CyclicChannel(ParameterServer& parameters, Time processing)
      : CyclicChannel(
            [&parameters](Time now, const ParameterTelegram& request) {
              return execute(now, parameters, request);
            },
            processing) {}

  // Takes in the channel of a request; true when it began a service. While one runs, nothing else is begun.
  bool take(Time now, const ParameterTelegram& request);

  // The channel of the response to this request.
  ParameterTelegram answer(Time now, const ParameterTelegram& request);

  // The answer of the service begun last.
  const ParameterTelegram& result() const { return response_; }

 private:
  void settle(Time now);

  Execution execute_;
  Time processing_;
  bool acknowledged_ = false;  // handshake bit of the last service done
  std::optional<Time> ready_;  // end of the service that runs
  ParameterTelegram request_;  // of the last service
  ParameterTelegram response_;
};

}  // namespace ipos::runtime

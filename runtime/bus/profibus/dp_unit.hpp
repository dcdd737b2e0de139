// What a drive does with the data of DP (MOVITRAC 31 PROFIBUS, 3.1, 3.3, 3.6, 3.7): the parameter channel in the
// first eight octets where it is configured, then the process data words, and the watchdog time in a parameter.
// A card of MOVIDRIVE has the channel of MOVILINK, as the other interfaces of the unit.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "runtime/bus/movilink/handshake.hpp"
#include "runtime/bus/movilink/unit_servers.hpp"
#include "runtime/bus/profibus/dp_slave.hpp"
#include "runtime/bus/profibus/fieldbus_parameters.hpp"

namespace ipos::profibus {

// One service of the parameter channel: 001 reads, 010 writes four octets; everything else is refused.
runtime::ParameterTelegram execute(Time now, FieldbusParameters& parameters,
                                   const runtime::ParameterTelegram& request);

// P571, and P819 of MOVIDRIVE, for a watchdog time, in hundredths of a second: 650.00 s without watchdog, and at most 649.99 s with
// one, though a master can choose up to 650.25 s (the limit is ours).
int32_t fieldbus_timeout(std::optional<Time> watchdog);

inline constexpr size_t kMostWords = 10;  // process data in one direction, of any configuration
using FurtherWords = std::array<uint16_t, kMostWords - runtime::kSbusProcessWords>;

// The drive beside its parameters.
class FieldbusDrive : public runtime::ProcessDataServer {
 public:
  virtual FurtherWords further_input(Time /*now*/) { return {}; }       // PI4 to PI10
  virtual void set_fieldbus_timeout(Time now, int32_t hundredths) = 0;  // P571, P819
  virtual void fieldbus_timeout_expired(Time now) = 0;                  // the reaction is P572, P831
  virtual void set_fieldbus_address(Time now, uint8_t address) = 0;     // P073, P093

 protected:
  ~FieldbusDrive() = default;
};

class DpUnit final : public SlaveUnit {
 public:
  static constexpr Time kProcessing = 10 * runtime::kMillisecond;  // of a parameter service, ours

  DpUnit(FieldbusParameters& parameters, FieldbusDrive& drive, Time processing = kProcessing);
  // With indices and values as MOVILINK has them.
  DpUnit(runtime::ParameterServer& parameters, FieldbusDrive& drive, Time processing = kProcessing);

  void configured(Time now, const Configuration& configuration) override;
  void take_outputs(Time now, std::span<const uint8_t> outputs) override;
  void exchanged(Time now) override { drive_.cyclic_request(now); }
  void read_inputs(Time now, std::span<uint8_t> inputs) override;
  void watchdog_set(Time now, std::optional<Time> period) override;
  void watchdog_expired(Time now) override;
  void exchange_ended(Time now) override;

  // When a parameter service ran last, for the green LED.
  std::optional<Time> accessed() const { return accessed_; }

 private:
  void send_words(Time now, std::span<const uint8_t> octets);

  FieldbusDrive& drive_;
  runtime::CyclicChannel channel_;
  const Configuration* configuration_ = nullptr;
  runtime::ParameterTelegram received_;
  std::optional<Time> accessed_;
};

}  // namespace ipos::profibus

// A signal of the plant file, found in its station: it can be read, and written as far as that makes sense.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/station_signals.hpp"
#include "runtime/station/gateway.hpp"

namespace ipos::signals {

class SignalPort {
 public:
  // Nothing when the station is missing, or has no such thing: then `why` says so (empty for a missing
  // station, which read_plant_file has reported).
  static std::optional<SignalPort> find(const std::vector<std::unique_ptr<runtime::Station>>& stations,
                                        const runtime::Signal& signal, std::string& why);
  // Of a gateway, which has only what can be read.
  static std::optional<SignalPort> find(const runtime::Gateway& gateway, const runtime::Signal& signal, std::string& why);

  int32_t read() const;  // of any other signal the number shown, rounded
  // A variable or parameter, volatile; why not, or nothing.
  std::optional<std::string> write(int32_t value) const;

  // Of an input.
  bool is_input() const { return kind_ == runtime::SignalKind::Input; }
  runtime::InputLine& line() const { return station_->inputs().line(line_); }
  void drive(int32_t level) const;  // what a wire or switch says

  // The same signal; or the other line of an analog input.
  bool shares_terminal(const SignalPort& other) const {
    return station_ == other.station_ && kind_ == other.kind_ && index_ == other.index_ &&
           runtime::same_terminal(line_, other.line_);
  }

  const std::string& station_name() const {
    return station_ == nullptr ? any_->station : station_->config().name;
  }
  bool operator==(const SignalPort&) const = default;

 private:
  SignalPort(runtime::Station& station, const runtime::Signal& signal, uint16_t index)
      : station_(&station), kind_(signal.kind), line_(signal.line), index_(index) {}
  SignalPort(runtime::Station& station, std::shared_ptr<const Signal> any)
      : station_(&station), kind_(runtime::SignalKind::Any), any_(std::move(any)) {}
  explicit SignalPort(std::shared_ptr<const Signal> any)
      : station_(nullptr), kind_(runtime::SignalKind::Any), any_(std::move(any)) {}

  runtime::Station* station_;  // null: that of a gateway
  runtime::SignalKind kind_;
  uint8_t line_ = 0;    // Input, Output, State
  uint16_t index_ = 0;  // Variable, Parameter: in the parameter channel
  std::shared_ptr<const Signal> any_;
};

}  // namespace ipos::signals

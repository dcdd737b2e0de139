// What was asked last of each address of an RS-485 line and what was answered, from the moment on that somebody looks: a
// line that nobody looks at takes no telegram apart for it.
#pragma once

#include <algorithm>
#include <array>

#include "runtime/bus/movilink/serial_receiver.hpp"
#include "runtime/bus/rs485/line.hpp"

namespace ipos::runtime {

struct LastTelegram {
  ProcessWords words{};         // each of the last telegram that had it
  ParameterTelegram parameter;  // of the last one that had a parameter channel
  uint64_t count = 0;
};

class LastTelegrams final : public SerialObserver {
 public:
  explicit LastTelegrams(Rs485Line& line) { line.add_observer(*this); }

  const LastTelegram& of(uint8_t address, bool response) const { return last_[address][response ? 1 : 0]; }

 private:
  void on_character(const Rs485Line&, NodeId, const Character& character) override {
    if (const auto reception = receiver_.take(character); reception && reception->telegram)
      take(*reception->telegram);
  }
  void on_serial_event(const Rs485Line&, const SerialEvent&) override {}
  void take(const SerialTelegram& telegram) {
    LastTelegram& last = last_[telegram.address][telegram.response ? 1 : 0];
    std::copy_n(telegram.words.begin(), telegram.format.words, last.words.begin());
    if (telegram.format.parameter) last.parameter = telegram.parameter;
    ++last.count;
  }

  SerialReceiver receiver_;
  std::array<std::array<LastTelegram, 2>, 256> last_{};  // by address; of each the request and the answer
};

}  // namespace ipos::runtime

// A hand that speaks FMS on a line of a plant: a master of its own in the ring, who asks what a verb, a script or a page wants. It
// joins with the first request.
#pragma once

#include <deque>

#include "runtime/bus/profibus/fms_partner.hpp"
#include "runtime/bus/profibus/master.hpp"

namespace ipos::runtime {

class FmsOperator final : private profibus::FmsClient {
 public:
  FmsOperator(EventQueue& queue, uint32_t source, profibus::Line& line, uint8_t address);

  uint8_t address() const { return address_; }
  void ask(uint8_t slave, const profibus::fms::Connection& connection, profibus::fms::Request request);
  // Given once, in the order in which they came.
  std::optional<profibus::fms::Done> take();

 private:
  void on_done(uint8_t address, uint8_t cref, const profibus::fms::Done& done) override;

  uint8_t address_;
  profibus::Master master_;
  std::deque<profibus::FmsPartner> partners_;
  std::deque<profibus::fms::Done> done_;
};

}  // namespace ipos::runtime

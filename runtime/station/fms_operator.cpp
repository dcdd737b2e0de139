// One partner a slave.
#include "runtime/station/fms_operator.hpp"

#include <algorithm>
#include <utility>

namespace ipos::runtime {

FmsOperator::FmsOperator(EventQueue& queue, uint32_t source, profibus::Line& line, uint8_t address)
    : address_(address), master_(queue, source, line, "FMS operator", profibus::MasterSettings{address}, nullptr) {
  master_.start();
}

void FmsOperator::ask(uint8_t slave, const profibus::fms::Connection& connection, profibus::fms::Request request) {
  auto partner = std::find_if(partners_.begin(), partners_.end(), [slave](const auto& one) { return one.address() == slave; });
  if (partner == partners_.end()) {
    partners_.emplace_back(address_, slave, static_cast<profibus::FmsClient&>(*this));
    partner = std::prev(partners_.end());
    master_.add_partner(*partner);
  }
  partner->link(connection).ask(std::move(request));
}

std::optional<profibus::fms::Done> FmsOperator::take() {
  if (done_.empty()) return std::nullopt;
  profibus::fms::Done first = std::move(done_.front());
  done_.pop_front();
  return first;
}

void FmsOperator::on_done(uint8_t, uint8_t, const profibus::fms::Done& done) { done_.push_back(done); }

}  // namespace ipos::runtime

// One partner a slave.
#include "runtime/station/fms_operator.hpp"

#include <algorithm>
#include <utility>

namespace ipos::runtime {

namespace {

// Long enough for a slave whose switch is at FMS.
profibus::MasterSettings settings_of(const profibus::Line& line, uint8_t address) {
  const profibus::BaudRate& rate = *profibus::find_baud_rate(line.baud());
  profibus::MasterSettings settings{address};
  settings.slot = rate.slot + rate.fms_min_tsdr;
  return settings;
}

}  // namespace

FmsOperator::FmsOperator(EventQueue& queue, uint32_t source, profibus::Line& line, uint8_t address)
    : address_(address), master_(queue, source, line, "FMS operator", settings_of(line, address), nullptr) {
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

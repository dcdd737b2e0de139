// Jobs to transfers, and their ends to results.
#include "runtime/bus/canopen/sdo_master.hpp"

#include <array>
#include <cassert>

#include "runtime/bus/canopen/abort.hpp"
#include "runtime/bus/canopen/connections.hpp"

namespace ipos::runtime::canopen {

SdoMaster::SdoMaster(const Place& place, Time timeout, MovilinkClient& client)
    : place_(place), timeout_(timeout), client_(client), timer_(place, *this, 0) {}

std::optional<ReturnCode> SdoMaster::start(Time now, const MovilinkJob& job) {
  assert(!transfer_.is_busy());
  const auto service = static_cast<Service>(job.service);
  const auto format = telegram_format(job.format);
  const bool known = service == Service::Read || service == Service::Write;
  if (!format || !format->parameter || format->words > 0 || !known ||
      !is_node(static_cast<uint32_t>(job.address)) || job.index < 0 || job.index > 0xFFFF)
    return stdlib::return_codes::kWrongManagement;
  node_ = static_cast<uint8_t>(job.address);
  place_.sender.listen(identifier(Connection::SdoResponse, node_));
  const Address address{static_cast<uint16_t>(job.index), 0};
  const auto value = static_cast<uint32_t>(job.write_value);
  const std::array<uint8_t, 4> data = {static_cast<uint8_t>(value), static_cast<uint8_t>(value >> 8),
                                       static_cast<uint8_t>(value >> 16), static_cast<uint8_t>(value >> 24)};
  send(now, service == Service::Read ? transfer_.read(address) : transfer_.write(address, data));
  return std::nullopt;
}

void SdoMaster::abort() {
  timer_.stop();
  if (transfer_.is_busy())
    place_.sender.send({identifier(Connection::SdoRequest, node_), 8, transfer_.expire()}, place_.tag);
}

bool SdoMaster::on_frame(Time now, const Frame& frame) {
  if (!transfer_.is_busy() || !is_plain(frame) || frame.length != 8 ||
      frame.id != identifier(Connection::SdoResponse, node_))
    return false;
  if (const auto request = transfer_.take(frame.data)) send(now, *request);
  if (!transfer_.is_busy()) finish(now);
  return true;
}

void SdoMaster::on_timer(Time now, uint32_t /*kind*/) {
  abort();
  MovilinkResult result;
  result.result = stdlib::return_codes::kCommunication.packed();
  result.reason = "no answer";
  client_.on_exchange_done(now, result);
}

void SdoMaster::send(Time now, const SdoBytes& bytes) {
  place_.sender.send({identifier(Connection::SdoRequest, node_), 8, bytes}, place_.tag);
  timer_.start(now + timeout_);
}

void SdoMaster::finish(Time now) {
  timer_.stop();
  MovilinkResult result;
  const auto& answer = transfer_.result();
  if (!answer) {
    result.result = return_code_of(answer.error()).packed();
  } else if (!answer->empty()) {
    uint32_t value = 0;
    for (size_t n = 0; n < answer->size() && n < 4; ++n) value |= uint32_t{(*answer)[n]} << 8 * n;
    result.read_value = static_cast<int32_t>(value);
  }
  client_.on_exchange_done(now, result);
}

}  // namespace ipos::runtime::canopen

// Connections and services.
#include "runtime/bus/profibus/fms_server.hpp"

#include <algorithm>
#include <utility>

namespace ipos::profibus {
namespace {

FmsResponse rejected(std::string_view reason) { return {FmsEnd::Rejected, {}, {}, {}, reason}; }
FmsResponse aborted(std::string_view reason) { return {FmsEnd::Aborted, {}, {}, {}, reason}; }
FmsResponse failed(ReturnCode error) { return {FmsEnd::Error, {}, {}, error, {}}; }

// Initiate: class 0, code 1 or 2 by the norm's list; which one the card sends is not printed (ours).
constexpr ReturnCode kPduSize{0, 1, 0}, kFeatures{0, 2, 0};

// Offered in the list of connections, but not there (4.3.2).
bool is_event(FmsService service) {
  return service == FmsService::AcknowledgeEvent || service == FmsService::AlterEvent;
}
bool belongs_to_every_connection(FmsService service) {
  return service == FmsService::Identify || service == FmsService::Status ||
         service == FmsService::GetOvShort;
}

}  // namespace

FmsResponse FmsServer::initiate(Time now, uint8_t cref, uint8_t master, const FmsMasterEntry& entry) {
  if (!option_.fms) return rejected("this interface has no FMS");
  const FmsConnection* connection = find_fms_connection(cref);
  if (connection == nullptr) return rejected("there is no such connection");
  if (open_.erase(cref) != 0) return aborted("the connection was open");
  const bool sizes = entry.pdu.receive_high >= connection->pdu.send_high &&
                     entry.pdu.receive_low >= connection->pdu.send_low &&
                     entry.pdu.send_high <= connection->pdu.receive_high &&
                     entry.pdu.send_low <= connection->pdu.receive_low;
  if (!sizes) return failed(kPduSize);
  if (!check_master_entry(entry, *connection).empty()) return failed(kFeatures);
  open_[cref] = {master, now, std::nullopt};
  return {};
}

std::optional<FmsResponse> FmsServer::request(Time now, uint8_t cref, const FmsRequest& request) {
  if (expire(now, cref)) return aborted("nothing came within the control interval");
  const auto open = open_.find(cref);
  if (open == open_.end()) return aborted("the connection is not open");
  const FmsConnection& connection = *find_fms_connection(cref);
  open->second.heard = now;
  if (open->second.pending) {
    open_.erase(open);
    return aborted("a second request before the answer");
  }
  if (request.data.size() > connection.pdu.receive_low) {
    open_.erase(open);
    return aborted("the unit of data is too long");
  }
  const bool offered = belongs_to_every_connection(request.service)
                           ? !is_cyclic(connection.type)
                           : connection.features.responds(request.service);
  if (!offered || is_event(request.service)) return rejected("the service is not there on this connection");
  open->second.pending = carry_out(now, request);
  return std::nullopt;
}

std::optional<FmsResponse> FmsServer::response(Time now, uint8_t cref) {
  const auto open = open_.find(cref);
  if (open == open_.end() || !open->second.pending || now < open->second.pending->ready) return std::nullopt;
  FmsResponse response = std::move(open->second.pending->response);
  open->second.pending.reset();
  return response;
}

bool FmsServer::expire(Time now, uint8_t cref) {
  const auto open = open_.find(cref);
  if (open == open_.end()) return false;
  const Time watch = find_fms_connection(cref)->watch_time();
  if (watch == 0 || now - open->second.heard < watch) return false;
  open_.erase(open);
  return true;
}

bool FmsServer::busy() const {
  return std::any_of(open_.begin(), open_.end(),
                     [](const auto& open) { return open.second.pending.has_value(); });
}

FmsServer::Pending FmsServer::carry_out(Time now, const FmsRequest& request) {
  const auto done = [now](const tl::expected<FmsAccessed, ReturnCode>& accessed) -> Pending {
    if (!accessed) return {failed(accessed.error()), now + kProcessing};
    return {{FmsEnd::Positive, accessed->data, {}, {}, {}}, now + accessed->services * kProcessing};
  };
  FmsResponse response;
  switch (request.service) {
    case FmsService::Read: return done(objects_.read(now, request.index));
    case FmsService::Write: return done(objects_.write(now, request.index, request.data));
    case FmsService::GetOvShort:
    case FmsService::GetOvLong:
      response.object = objects_.find(request.index);
      if (!response.object) response = failed(fms_errors::kNoObject);
      break;
    case FmsService::Status:
      response.data = {0, 0};
      break;  // ready to communicate, operational; no local detail
    case FmsService::PhysicalRead:
    case FmsService::PhysicalWrite: response = failed(fms_errors::kUnsupported); break;
    default: break;  // Identify: identity() has the texts
  }
  return {response, now};
}

}  // namespace ipos::profibus

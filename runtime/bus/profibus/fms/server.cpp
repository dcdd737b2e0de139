// Connections and services.
#include "runtime/bus/profibus/fms/server.hpp"

#include <algorithm>
#include <utility>

namespace ipos::profibus::fms {
namespace {

// Initiate: class 0, code 1 or 2 by the norm's list; which one the card sends is not printed (ours).
constexpr ReturnCode kWrongSize{0, 1, 0}, kWrongFeatures{0, 2, 0};

// Offered in the list of connections, but not there (4.3.2).
bool is_event(Service service) {
  return service == Service::AcknowledgeEvent || service == Service::AlterEvent;
}
bool belongs_to_every_connection(Service service) {
  return service == Service::Identify || service == Service::Status ||
         service == Service::GetOvShort;
}

}  // namespace

Response Server::initiate(Time now, uint8_t cref, uint8_t master, const MasterEntry& entry) {
  if (!offered_) return Response::rejected(Reason::NoFms);
  const Connection* connection = find_connection(cref);
  if (connection == nullptr) return Response::rejected(Reason::NoConnection);
  if (open_.erase(cref) != 0) return Response::aborted(Reason::WasOpen);
  const bool sizes = entry.pdu.receive_high >= connection->pdu.send_high &&
                     entry.pdu.receive_low >= connection->pdu.send_low &&
                     entry.pdu.send_high <= connection->pdu.receive_high &&
                     entry.pdu.send_low <= connection->pdu.receive_low;
  if (!sizes) return Response::failed(kWrongSize);
  if (!check_master_entry(entry, *connection).empty()) return Response::failed(kWrongFeatures);
  open_[cref] = {master, now, std::nullopt};
  return {};
}

std::optional<Response> Server::request(Time now, uint8_t cref, const Request& request) {
  if (expire(now, cref)) return Response::aborted(Reason::Interval);
  const auto open = open_.find(cref);
  if (open == open_.end()) return Response::aborted(Reason::NotOpen);
  const Connection& connection = *find_connection(cref);
  open->second.heard = now;
  if (open->second.pending) {
    open_.erase(open);
    return Response::aborted(Reason::SecondRequest);
  }
  if (request.data.size() > connection.pdu.receive_low) {
    open_.erase(open);
    return Response::aborted(Reason::TooLong);
  }
  const bool offered = belongs_to_every_connection(request.service)
                           ? !is_cyclic(connection.type)
                           : connection.features.responds(request.service);
  if (!offered || is_event(request.service)) return Response::rejected(Reason::NotOffered);
  open->second.pending = carry_out(now, request);
  return std::nullopt;
}

std::optional<Response> Server::response(Time now, uint8_t cref) {
  const auto open = open_.find(cref);
  if (open == open_.end() || !open->second.pending || now < open->second.pending->ready) return std::nullopt;
  Response response = std::move(open->second.pending->response);
  open->second.pending.reset();
  return response;
}

bool Server::expire(Time now, uint8_t cref) {
  const auto open = open_.find(cref);
  if (open == open_.end() || !is_over(now, cref, open->second)) return false;
  open_.erase(open);
  return true;
}

bool Server::is_over(Time now, uint8_t cref, const Open& open) {
  const Time watch = find_connection(cref)->watch_time();
  return watch != 0 && now - open.heard >= watch;
}

void Server::heard(Time now, uint8_t cref) {
  if (const auto open = open_.find(cref); open != open_.end()) open->second.heard = now;
}

bool Server::connected(Time now) const {
  return std::any_of(open_.begin(), open_.end(),
                     [now](const auto& open) { return !is_over(now, open.first, open.second); });
}

bool Server::busy() const {
  return std::any_of(open_.begin(), open_.end(),
                     [](const auto& open) { return open.second.pending.has_value(); });
}

Server::Pending Server::carry_out(Time now, const Request& request) {
  const auto done = [now](const tl::expected<Accessed, ReturnCode>& accessed) -> Pending {
    if (!accessed) return {Response::failed(accessed.error()), now + kProcessing};
    return {{End::Positive, accessed->data, {}, {}, {}, 0}, now + accessed->services * kProcessing};
  };
  Response response;
  switch (request.service) {
    case Service::Read: return done(objects_.read(now, request.index));
    case Service::Write: return done(objects_.write(now, request.index, request.data));
    case Service::GetOvShort:
    case Service::GetOvLong:
      response.object = objects_.find(request.index);
      if (!response.object) response = Response::failed(fms::errors::kNoObject);
      break;
    case Service::Status:
      response.data = {0, 0};
      break;  // ready to communicate, operational; no local detail
    case Service::PhysicalRead:
    case Service::PhysicalWrite: response = Response::failed(fms::errors::kUnsupported); break;
    case Service::Identify: {
      const Identity own = identity();
      response.texts = {std::string(own.vendor), std::string(own.model), std::string(own.revision)};
      break;
    }
    default: break;
  }
  return {response, now};
}

}  // namespace ipos::profibus::fms

// One message of a master after the other.
#include "runtime/bus/profibus/fms/slave_links.hpp"

namespace ipos::profibus::fms {
namespace {

Octets of_service(uint8_t invoke, const Request& request, const Response& response) {
  if (response.end == End::Aborted) return encode(abort_message(static_cast<Reason>(response.reason)));
  Message message;
  message.pdu = answer_pdu(invoke, request, response);
  return encode(message);
}

Octets rejection(uint8_t invoke, Reason why) { return of_service(invoke, {}, Response::rejected(why)); }

}  // namespace

LinkAnswer SlaveLinks::take(Time now, uint8_t lsap, Partner from, std::span<const uint8_t> data) {
  const Connection& connection = *connection_at(lsap);
  const bool expired = server_.expire(now, connection.cref);
  const bool was_open = server_.is_open(connection.cref);
  Link& link = links_[connection.cref];
  if (was_open && link.partner != from) return {true, {}, LinkAnswer::Event::None};
  link.partner = from;
  LinkAnswer out;
  out.data = expired ? end(connection, Reason::Interval) : answer(now, connection, link, data);
  const bool is_open = server_.is_open(connection.cref);
  if (is_open != (was_open || expired)) out.event = is_open ? LinkAnswer::Event::Opened : LinkAnswer::Event::Ended;
  return out;
}

Octets SlaveLinks::end(const Connection& connection, Reason reason) {
  server_.abort(connection.cref);
  return encode(abort_message(reason));
}

Octets SlaveLinks::answer(Time now, const Connection& connection, Link& link, std::span<const uint8_t> data) {
  if (data.empty()) return waiting(now, connection, link);
  const auto message = decode(data);
  if (!message) return end(connection, Reason::Malformed);
  switch (message->lli) {
    case Lli::Associate: return initiate(now, connection, link, *message);
    case Lli::Abort: server_.abort(connection.cref); return {};
    case Lli::Idle: server_.heard(now, connection.cref); return waiting(now, connection, link);
    case Lli::Data:
      if (pdu_size(data) > connection.pdu.receive_low) return end(connection, Reason::TooLong);
      return request(now, connection, link, *message->pdu);
    case Lli::Associated:
    case Lli::Refused: break;  // a slave opens no connection
  }
  return end(connection, Reason::Malformed);
}

// Type, access point and counters of the master are not on the line: they are taken as those that fit.
Octets SlaveLinks::initiate(Time now, const Connection& connection, const Link& link, const Message& message) {
  const auto wanted = conventions_of(*message.pdu);
  if (!wanted) return end(connection, Reason::Malformed);
  MasterEntry entry = master_entry(connection, link.partner.address);
  entry.interval = message.interval;
  entry.pdu = wanted->pdu;
  entry.features = wanted->features;
  const Response response = server_.initiate(now, connection.cref, link.partner.address, entry);
  Message answer;
  switch (response.end) {
    case End::Rejected:
    case End::Aborted: return end(connection, static_cast<Reason>(response.reason));
    case End::Error:
      answer.lli = Lli::Refused;
      answer.pdu = initiate_error(response.error);
      return encode(answer);
    case End::Positive: break;
  }
  answer.lli = Lli::Associated;
  answer.pdu = initiate_pdu({connection.pdu, connection.features});
  return encode(answer);
}

Octets SlaveLinks::request(Time now, const Connection& connection, Link& link, const Pdu& pdu) {
  if (!server_.is_open(connection.cref)) return end(connection, Reason::NotOpen);
  if (pdu.kind != PduKind::Request) return end(connection, Reason::Malformed);
  server_.heard(now, connection.cref);
  const auto wanted = request_of(pdu);
  if (!wanted) return rejection(pdu.invoke, Reason::NotOffered);
  if (const auto at_once = server_.request(now, connection.cref, *wanted))
    return of_service(pdu.invoke, *wanted, *at_once);
  link.invoke = pdu.invoke;
  link.request = *wanted;
  return waiting(now, connection, link);
}

Octets SlaveLinks::waiting(Time now, const Connection& connection, const Link& link) {
  const auto response = server_.response(now, connection.cref);
  return response ? of_service(link.invoke, link.request, *response) : Octets();
}

}  // namespace ipos::profibus::fms

// The states of a connection: closed, opening, open, with a service under way.
#include "runtime/bus/profibus/fms/client_link.hpp"

#include <utility>

namespace ipos::profibus::fms {

Octets ClientLink::associate() const {
  Message message;
  message.lli = Lli::Associate;
  message.interval = entry_.interval;
  message.pdu = initiate_pdu({entry_.pdu, entry_.features});
  return encode(message);
}

Octets ClientLink::service() {
  Message message;
  message.pdu = request_pdu(++invoke_, wanted_.front());
  return encode(message);
}

std::optional<Octets> ClientLink::next(Time now) {
  if (sent_ != Sent::Nothing) return Octets();
  const bool keeps_alive = open_ && entry_.interval != 0 && now - sent_at_ >= connection_.watch_time() / 3;
  if (wanted_.empty() && !keeps_alive) return std::nullopt;
  sent_at_ = now;
  if (wanted_.empty()) {
    sent_ = Sent::Idle;
    Message message;
    message.lli = Lli::Idle;
    return encode(message);
  }
  const Service wanted = wanted_.front().service;
  if (wanted == Service::Abort) {
    sent_ = Sent::Abort;
    return encode(abort_message(Reason::User));
  }
  if (!open_ || wanted == Service::Initiate) {
    sent_ = Sent::Associate;
    return associate();
  }
  sent_ = Sent::Request;
  return service();
}

// The connection is gone with an abort, and with an answer that says nothing.
std::optional<Done> ClientLink::finish(Response response) {
  sent_ = Sent::Nothing;
  if (response.end == End::Aborted) open_ = false;
  if (wanted_.empty()) return std::nullopt;
  Done done{std::move(wanted_.front()), std::move(response)};
  wanted_.erase(wanted_.begin());
  return done;
}

std::optional<Done> ClientLink::answered(Time now, std::span<const uint8_t> data) {
  if (sent_ == Sent::Abort) {
    open_ = false;
    return finish({});
  }
  if (data.empty()) {
    if (sent_ == Sent::Idle) sent_ = Sent::Nothing;
    if (sent_ == Sent::Nothing || now - sent_at_ < kPatience) return std::nullopt;
    return finish(Response::aborted(Reason::NoAnswer));
  }
  const auto message = decode(data);
  if (!message) return finish(Response::aborted(Reason::Malformed));
  switch (message->lli) {
    case Lli::Abort: {
      Response response = Response::aborted(Reason::User);
      response.reason = message->reason;
      return finish(response);
    }
    case Lli::Associated:
      if (sent_ != Sent::Associate) break;
      open_ = true;
      sent_ = Sent::Nothing;
      if (!wanted_.empty() && wanted_.front().service == Service::Initiate) return finish({});
      return std::nullopt;
    case Lli::Refused:
      open_ = false;
      return finish(answer_of(*message->pdu).value_or(Response::aborted(Reason::Malformed)));
    case Lli::Data: {
      if (sent_ != Sent::Request || message->pdu->invoke != invoke_) break;
      return finish(answer_of(*message->pdu).value_or(Response::aborted(Reason::Malformed)));
    }
    case Lli::Associate:
    case Lli::Idle: break;
  }
  return std::nullopt;
}

}  // namespace ipos::profibus::fms

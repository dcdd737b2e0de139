// Services and the initiate as units of data, in both directions: what a request, its answer and the conventions of a connection
// look like on the line. Numbers of services are those of EN 50170 volume 2, part 6; the tags of their components are ours.
#pragma once

#include <optional>
#include <string>

#include "runtime/bus/profibus/fms/pdu.hpp"
#include "runtime/bus/profibus/fms/service.hpp"

namespace ipos::profibus::fms {

// What one side says of itself as a connection opens.
struct Conventions {
  PduSizes pdu;
  Features features;
  friend bool operator==(const Conventions&, const Conventions&) = default;
};

Pdu initiate_pdu(const Conventions& own);
std::optional<Conventions> conventions_of(const Pdu& pdu);
Pdu initiate_error(ReturnCode code);

// A service that the line has; nothing for the others.
std::optional<Pdu> request_pdu(uint8_t invoke, const Request& request);
std::optional<Request> request_of(const Pdu& pdu);  // nothing: no such service, or a component is missing

Pdu answer_pdu(uint8_t invoke, const Request& request, const Response& response);  // all but Aborted
std::optional<Response> answer_of(const Pdu& pdu);  // to an initiate, too: its error

Message abort_message(Reason reason);

// "Read request 1, index 1025", "Read response 1: 00 00 09 50", "Associate request: .."; the octets where they are none.
std::string describe(std::span<const uint8_t> octets);

}  // namespace ipos::profibus::fms

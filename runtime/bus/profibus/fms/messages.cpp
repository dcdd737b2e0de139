// Which component is what, service by service, and words for them.
#include "runtime/bus/profibus/fms/messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ipos::profibus::fms {
namespace {

// Tags of components (ours but for those of the initiate).
enum Tag : uint8_t { kIndex = 0, kOctets = 1, kAllAttributes = 1, kCode = 0, kAdditional = 1 };
enum InitiateTag : uint8_t { kVersion, kProfile, kProtection, kPassword, kSendHigh, kSendLow, kReceiveHigh, kReceiveLow, kFeatures };
enum ObjectTag : uint8_t { kObjectIndex, kObjectCode, kDataType, kLength, kObjectPassword, kGroups, kRights, kAddress, kName, kExtension };

// Rights of all partners, as bits of two octets (ours).
constexpr uint16_t kReadAll = 1, kWriteAll = 2;
constexpr uint16_t rights_of(Access access) {
  switch (access) {
    case Access::All: break;
    case Access::Read: return kReadAll;
    case Access::Write: return kWriteAll;
  }
  return kReadAll | kWriteAll;
}

std::optional<Service> service_of(uint8_t number, bool all_attributes) {
  if (number == service_type(Service::GetOvLong).number) return all_attributes ? Service::GetOvLong : Service::GetOvShort;
  for (const ServiceType& type : service_types())
    if (type.number == number) return type.service;
  return std::nullopt;
}

Parts object_parts(const Object& object, bool all_attributes) {
  Parts parts{{kObjectIndex, word_octets(object.index)},
                          {kObjectCode, {Object::kObjectCode}},
                          {kDataType, {Object::kDataType}},
                          {kLength, {object.length}}};
  if (!all_attributes) return parts;
  for (const uint8_t none : {kObjectPassword, kGroups}) parts.push_back({none, {}});
  parts.push_back({kRights, word_octets(rights_of(object.access))});
  for (const uint8_t none : {kAddress, kName, kExtension}) parts.push_back({none, {}});
  return parts;
}

std::optional<Object> object_of(const Pdu& pdu) {
  const auto index = pdu.word(kObjectIndex);
  const auto length = pdu.octet(kLength);
  if (!index || !length || pdu.octet(kObjectCode) != Object::kObjectCode || pdu.octet(kDataType) != Object::kDataType)
    return std::nullopt;
  Object object{*index, *length, Access::All, {}};
  for (const Access access : {Access::Read, Access::Write})
    if (pdu.word(kRights) == rights_of(access)) object.access = access;
  return object;
}

Parts error_parts(ReturnCode code) {
  return {{kCode, {code.error_class, code.code}}, {kAdditional, word_octets(code.additional)}};
}

std::optional<ReturnCode> error_of(const Pdu& pdu) {
  const auto code = pdu.word(kCode), additional = pdu.word(kAdditional);
  if (!code || !additional) return std::nullopt;
  return ReturnCode{static_cast<uint8_t>(*code >> 8), static_cast<uint8_t>(*code), *additional};
}

Octets octets_of(const std::string& text) { return {text.begin(), text.end()}; }
std::string text_of(const Octets* octets) { return octets == nullptr ? "" : std::string(octets->begin(), octets->end()); }
std::string hex(std::span<const uint8_t> octets) { return fmt::format("{:02X}", fmt::join(octets, " ")); }

std::string describe(const Pdu& pdu, Lli lli) {
  if (pdu.kind == PduKind::Initiate) {
    if (lli == Lli::Refused) return "Initiate error, " + runtime::describe(error_of(pdu).value_or(ReturnCode{}));
    const auto own = conventions_of(pdu);
    if (!own) return "Initiate, incomplete";
    return fmt::format("Initiate {}, sends {} and {} octets, receives {} and {}, features {}",
                       lli == Lli::Associate ? "request" : "response", own->pdu.send_high, own->pdu.send_low,
                       own->pdu.receive_high, own->pdu.receive_low, hex(own->features.octets()));
  }
  if (pdu.kind == PduKind::Request) {
    const auto request = request_of(pdu);
    return request ? fmt::format("{}, request {}", describe(*request), pdu.invoke)
                   : fmt::format("service {}, request {}", pdu.service, pdu.invoke);
  }
  const auto answer = answer_of(pdu);
  if (!answer) return "an answer that is incomplete";
  const auto service = service_of(pdu.service, true);
  return fmt::format("{} to request {}: {}", service && pdu.kind != PduKind::Reject ? service_type(*service).text : "answer",
                     pdu.invoke, describe(*answer));
}

}  // namespace

std::string describe(const Request& request) {
  std::string text(service_type(request.service).text);
  if (service_type(request.service).of_object) text += fmt::format(" {}", request.index);
  if (!request.data.empty()) text += " = " + hex(request.data);
  return text;
}

Pdu initiate_pdu(const Conventions& own) {
  const auto features = own.features.octets();
  Pdu pdu{PduKind::Initiate, 0, 0, {}};
  pdu.parts = {{kVersion, {0, 0}},
               {kProfile, {0, 0}},
               {kProtection, {0}},
               {kPassword, {0, 0}},
               {kSendHigh, {own.pdu.send_high}},
               {kSendLow, {own.pdu.send_low}},
               {kReceiveHigh, {own.pdu.receive_high}},
               {kReceiveLow, {own.pdu.receive_low}},
               {kFeatures, {features.begin(), features.end()}}};
  return pdu;
}

// Version, profile, protection and password are taken as they come: the list of the unit has none of them.
std::optional<Conventions> conventions_of(const Pdu& pdu) {
  std::array<std::optional<uint8_t>, 4> sizes;
  for (uint8_t n = 0; n < sizes.size(); ++n) sizes[n] = pdu.octet(static_cast<uint8_t>(kSendHigh + n));
  const Octets* features = pdu.part(kFeatures);
  if (pdu.kind != PduKind::Initiate || features == nullptr || features->size() != 6 ||
      std::any_of(sizes.begin(), sizes.end(), [](const auto& size) { return !size; }))
    return std::nullopt;
  uint64_t bits = 0;
  for (const uint8_t octet : *features) bits = bits << 8 | octet;
  return Conventions{{*sizes[0], *sizes[1], *sizes[2], *sizes[3]}, Features(bits)};
}

Pdu initiate_error(ReturnCode code) { return {PduKind::Initiate, 0, 0, error_parts(code)}; }

std::optional<Pdu> request_pdu(uint8_t invoke, const Request& request) {
  const ServiceType& type = service_type(request.service);
  if (type.number < 0) return std::nullopt;
  Pdu pdu{PduKind::Request, invoke, static_cast<uint8_t>(type.number), {}};
  if (type.of_object) pdu.parts.push_back({kIndex, word_octets(request.index)});
  if (type.number == service_type(Service::GetOvLong).number)
    pdu.parts.push_back({kAllAttributes, {static_cast<uint8_t>(request.service == Service::GetOvLong ? 0xFF : 0)}});
  if (!request.data.empty() || request.service == Service::Write) pdu.parts.push_back({kOctets, request.data});
  return pdu;
}

std::optional<Request> request_of(const Pdu& pdu) {
  const auto service = service_of(pdu.service, pdu.octet(kAllAttributes).value_or(0) != 0);
  if (!service || pdu.kind != PduKind::Request) return std::nullopt;
  Request request{*service, pdu.word(kIndex).value_or(0), {}};
  const bool is_ov = *service == Service::GetOvShort || *service == Service::GetOvLong;
  if (service_type(*service).of_object && !pdu.word(kIndex)) return std::nullopt;
  if (const Octets* octets = pdu.part(kOctets); octets != nullptr && !is_ov) request.data = *octets;
  if (*service == Service::Write && pdu.part(kOctets) == nullptr) return std::nullopt;
  return request;
}

Pdu answer_pdu(uint8_t invoke, const Request& request, const Response& response) {
  Pdu pdu{PduKind::Response, invoke, static_cast<uint8_t>(service_type(request.service).number), {}};
  switch (response.end) {
    case End::Rejected: return {PduKind::Reject, invoke, 0, {{kCode, {response.reason}}}};
    case End::Error:
      pdu.kind = PduKind::Error;
      pdu.parts = error_parts(response.error);
      return pdu;
    case End::Positive:
    case End::Aborted: break;
  }
  if (response.object) pdu.parts = object_parts(*response.object, request.service == Service::GetOvLong);
  for (const std::string& text : response.texts)
    pdu.parts.push_back({static_cast<uint8_t>(pdu.parts.size()), octets_of(text)});
  if (request.service == Service::Status)
    for (const uint8_t octet : response.data) pdu.parts.push_back({static_cast<uint8_t>(pdu.parts.size()), {octet}});
  else if (!response.data.empty())
    pdu.parts.push_back({kOctets, response.data});
  return pdu;
}

std::optional<Response> answer_of(const Pdu& pdu) {
  Response response;
  switch (pdu.kind) {
    case PduKind::Request: return std::nullopt;
    case PduKind::Reject:
      response.end = End::Rejected;
      response.reason = pdu.octet(kCode).value_or(0);
      return response;
    case PduKind::Error:
    case PduKind::Initiate: {  // of an initiate only the error is an answer
      const auto error = error_of(pdu);
      if (error) return Response::failed(*error);
      return std::nullopt;
    }
    case PduKind::Response: break;
  }
  const auto service = service_of(pdu.service, true);
  if (!service) return std::nullopt;
  switch (*service) {
    case Service::GetOvLong:
      response.object = object_of(pdu);
      return response.object ? std::optional(response) : std::nullopt;
    case Service::Identify:
      for (const Part& part : pdu.parts) response.texts.push_back(text_of(&part.octets));
      break;
    case Service::Status:
      for (const Part& part : pdu.parts) response.data.insert(response.data.end(), part.octets.begin(), part.octets.end());
      break;
    default:
      if (const Octets* octets = pdu.part(kOctets)) response.data = *octets;
  }
  return response;
}

Message abort_message(Reason reason) {
  static constexpr uint8_t kOriginators[] = {
#define FMS_REASON(name, originator, text) originator,
#include "runtime/bus/profibus/fms/reasons.def"
  };
  Message message;
  message.lli = Lli::Abort;
  message.originator = kOriginators[static_cast<size_t>(reason)];
  message.reason = static_cast<uint8_t>(reason);
  return message;
}

std::optional<Service> service_of_key(std::string_view key) {
  for (const ServiceKey& row : kServiceKeys)
    if (row.key == key) return row.service;
  return std::nullopt;
}

std::string service_keys() {
  std::vector<std::string_view> keys;
  for (const ServiceKey& row : kServiceKeys) keys.push_back(row.key);
  return fmt::format("{}", fmt::join(keys, ", "));
}

std::string_view reason_text(uint8_t reason) {
  static constexpr std::string_view kTexts[] = {
#define FMS_REASON(name, originator, text) text,
#include "runtime/bus/profibus/fms/reasons.def"
  };
  return reason < std::size(kTexts) ? kTexts[reason] : "for a reason that is not known";
}

std::string describe(const Response& response) {
  switch (response.end) {
    case End::Rejected: return fmt::format("rejected: {}", reason_text(response.reason));
    case End::Aborted: return fmt::format("aborted: {}", reason_text(response.reason));
    case End::Error: return "error, " + runtime::describe(response.error);
    case End::Positive: break;
  }
  if (!response.texts.empty()) return fmt::format("{}", fmt::join(response.texts, ", "));
  if (response.object)
    return fmt::format("{}: object code {}, data type {}, {} octets, {}", response.object->index, Object::kObjectCode,
                       Object::kDataType, response.object->length, access_text(response.object->access));
  return response.data.empty() ? "done" : hex(response.data);
}

std::string describe(std::span<const uint8_t> octets) {
  const auto message = decode(octets);
  if (!message) return hex(octets) + " (no unit of FMS)";
  switch (message->lli) {
    case Lli::Abort: return fmt::format("Abort: {}", reason_text(message->reason));
    case Lli::Idle: return "idle";
    default: return describe(*message->pdu, message->lli);
  }
}

}  // namespace ipos::profibus::fms

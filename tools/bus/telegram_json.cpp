// Fields of the MOVILINK profile where the identifier belongs to it, of the telegram on RS-485, of the frame on
// PROFIBUS; the plain bytes always.
#include "tools/bus/telegram_json.hpp"

#include <fmt/format.h>

#include "runtime/bus/movilink/identifiers.hpp"
#include "runtime/bus/movilink/profile.hpp"
#include "runtime/bus/profibus/fdl_frame.hpp"

namespace ipos::tools {
namespace {

using nlohmann::ordered_json;

ordered_json head(runtime::Time time, const std::string& bus, std::span<const uint8_t> bytes) {
  const runtime::Time stamp = time + runtime::kCandumpEpoch;
  return {{"time", fmt::format("{}.{:09}", stamp / runtime::kSecond, stamp % runtime::kSecond)},
          {"bus", bus},
          {"data", fmt::format("{:02X}", fmt::join(bytes, ""))}};
}

void add_parameter(ordered_json& fields, const runtime::ParameterTelegram& telegram, bool request) {
  fields["service"] = telegram.service_code();
  fields["handshake"] = telegram.synchronous();
  fields["index"] = telegram.index;
  fields["subindex"] = telegram.subindex;
  fields["failed"] = telegram.failed();
  if (!request && telegram.failed()) {
    const runtime::ReturnCode code = telegram.return_code();
    fields["error_class"] = code.error_class;
    fields["error_code"] = code.code;
    fields["error_additional"] = code.additional;
  } else {
    fields["value"] = static_cast<int32_t>(telegram.data);
  }
}

}  // namespace

ordered_json telegram_json(const runtime::LogEntry& entry) {
  const runtime::Frame& frame = entry.frame;
  const size_t length = frame.remote ? 0 : frame.length;
  ordered_json fields = head(entry.time, entry.bus, std::span(frame.data).first(length));
  fields["id"] = frame.id;
  fields["extended"] = frame.extended;
  fields["remote"] = frame.remote;
  const auto identifier = is_plain(frame) ? runtime::classify_identifier(frame.id) : std::nullopt;
  if (!identifier) return fields;
  const runtime::TelegramType& type = telegram_type(identifier->telegram);
  if (length != (type.parameter ? 8U : 6U)) return fields;
  fields["telegram"] = type.text;
  fields[type.grouped ? "group" : "address"] = identifier->address;
  if (type.parameter)
    add_parameter(fields, runtime::decode_parameter(frame.data), type.from_master);
  else if (const auto words = runtime::process_words(frame))
    fields[type.from_master ? "po" : "pi"] = *words;
  return fields;
}

ordered_json telegram_json(const runtime::SerialEntry& entry) {
  ordered_json fields =
      head(entry.time.value_or(-runtime::kCandumpEpoch), entry.line, entry.reception.bytes.span());
  if (!entry.time) fields.erase("time");
  const auto& telegram = entry.reception.telegram;
  if (!telegram) {
    fields["void"] = serial_error_text(telegram.error());
    return fields;
  }
  fields["response"] = telegram->response;
  fields["address"] = telegram->address;
  fields["type"] = format_code(telegram->format);
  if (telegram->format.parameter) add_parameter(fields, telegram->parameter, !telegram->response);
  const auto words = telegram->words.begin();
  if (telegram->format.words != 0)
    fields[telegram->response ? "pi" : "po"] = std::vector<uint16_t>(words, words + telegram->format.words);
  return fields;
}

ordered_json telegram_json(const runtime::ProfibusEntry& entry) {
  ordered_json fields = head(entry.reception.start, entry.line, entry.reception.octets);
  const auto& frame = entry.reception.frame;
  if (!frame) {
    fields["void"] = frame_error_text(frame.error());
    return fields;
  }
  if (frame->is_acknowledgement()) return fields;
  fields["destination"] = frame->destination;
  fields["source"] = frame->source;
  if (frame->is_token()) return fields;
  fields["control"] = frame->control;
  if (frame->dsap) fields["dsap"] = *frame->dsap;
  if (frame->ssap) fields["ssap"] = *frame->ssap;
  return fields;
}

}  // namespace ipos::tools

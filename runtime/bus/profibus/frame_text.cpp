// Words for frames. The access points say which service it is; an answer to Data_Exchange has none.
#include "runtime/bus/profibus/frame_text.hpp"

#include <fmt/format.h>

#include <string_view>

#include "runtime/bus/profibus/cfg_data.hpp"
#include "runtime/bus/profibus/fms/messages.hpp"

namespace ipos::profibus {
namespace {

struct FunctionRow {
  uint8_t code;
  std::string_view text;
};
constexpr FunctionRow kRequests[] = {
#define FDL_REQUEST(name, code, text) {code, text},
#include "runtime/bus/profibus/fdl_functions.def"
};
constexpr FunctionRow kAnswers[] = {
#define FDL_ANSWER(name, code, text) {code, text},
#include "runtime/bus/profibus/fdl_functions.def"
};
constexpr std::string_view kStations[] = {"slave", "master, not ready", "master, ready for the ring",
                                          "master in the ring"};

std::string function_text(std::span<const FunctionRow> rows, uint8_t code) {
  for (const FunctionRow& row : rows)
    if (row.code == code) return std::string(row.text);
  return fmt::format("function {:X}h", code);
}

void add(std::string& list, std::string_view word) {
  if (!list.empty()) list += ", ";
  list += word;
}

std::string prm_text(const PrmData& prm) {
  std::string text;
  if (prm.lock) add(text, "lock");
  if (prm.unlock) add(text, "unlock");
  if (prm.sync) add(text, "sync");
  if (prm.freeze) add(text, "freeze");
  add(text, prm.watchdog ? "watchdog " + describe_watchdog(prm) : "no watchdog");
  add(text, fmt::format("min Tsdr {}, ident {:04X}h, groups {:02X}h", prm.min_tsdr, prm.ident, prm.groups));
  if (!prm.user.empty()) add(text, "user parameters " + hex_text(prm.user));
  return text;
}

std::string cfg_text(std::span<const uint8_t> cfg) {
  const auto modules = decode_cfg(cfg);
  if (!modules) return hex_text(cfg) + " (an identifier is cut off)";
  std::string text;
  for (const CfgModule& module : *modules) text += (text.empty() ? "" : " + ") + describe(module);
  return fmt::format("{} ({})", hex_text(cfg), text);
}

std::string command_text(const GlobalCommand& control) {
  std::string text;
  if (control.clears()) add(text, "Clear_Data");
  if (control.unsyncs()) add(text, "Unsync");
  if (control.syncs()) add(text, "Sync");
  if (control.unfreezes()) add(text, "Unfreeze");
  if (control.freezes()) add(text, "Freeze");
  if (text.empty()) text = "Operate";
  return text + (control.groups == 0 ? ", all" : fmt::format(", groups {:02X}h", control.groups));
}

// `answer`: the data come from the slave.
std::string data_text(DpService service, std::span<const uint8_t> data, bool answer) {
  switch (service) {
    case DpService::SetPrm:
      if (const auto prm = decode_prm(data); prm && !answer) return prm_text(*prm);
      break;
    case DpService::ChkCfg:
    case DpService::GetCfg:
      if (!data.empty()) return cfg_text(data);
      break;
    case DpService::GlobalControl:
      if (data.size() == 2) return command_text({data[0], data[1]});
      break;
    case DpService::SlaveDiag:
      if (const auto diagnosis = decode_diagnosis(data); diagnosis && answer) return describe(*diagnosis);
      break;
    case DpService::SetSlaveAddress:
    case DpService::ReadInputs:
    case DpService::ReadOutputs: break;
  }
  return hex_text(data);
}

std::string service_text(const FdlFrame& frame) {
  const auto point = frame.is_request() ? frame.dsap : frame.ssap;
  if (!frame.dsap && !frame.ssap) return "Data_Exchange";
  const auto service = point ? dp_service(*point) : std::nullopt;
  if (service) return std::string(dp_service_text(*service));
  if (const fms::Connection* fms = point ? fms::connection_at(*point) : nullptr)
    return fmt::format("FMS connection {}", fms->cref);
  return point ? fmt::format("access point {}", *point) : "no access point";
}

}  // namespace

std::string hex_text(std::span<const uint8_t> octets) {
  return fmt::format("{:02X}", fmt::join(octets, " "));
}

std::string describe_watchdog(const PrmData& prm) {
  return fmt::format("{} s",
                     static_cast<double>(prm.watchdog_time()) / static_cast<double>(runtime::kSecond));
}

std::string describe(const Diagnosis& diagnosis) {
  std::string text;
#define DIAG_BIT(name, octet, mask, by, word) \
  if (diagnosis.has(diag::k##name) && !std::string_view(word).empty()) add(text, word);
#include "runtime/bus/profibus/diag_bits.def"
  if (text.empty()) text = "ready";
  text += "; master ";
  text += diagnosis.master == kNoMaster ? "none" : fmt::format("{}", diagnosis.master);
  text += fmt::format(", ident {:04X}h", diagnosis.ident);
  if (diagnosis.fault) text += fmt::format(", fault {}", *diagnosis.fault);
  return text;
}

bool is_data_exchange(const FdlFrame& frame) {
  return frame.has_control() && !frame.dsap && !frame.ssap && !frame.data.empty();
}

std::string describe(const FdlFrame& frame, std::string_view data) {
  if (frame.is_acknowledgement()) return "short acknowledgement";
  const std::string way = fmt::format("{} -> {}", frame.source, frame.destination);
  if (frame.is_token()) return way + " token";
  std::string text = way + " ";
  if (!frame.is_request()) {
    if (frame.kind == Delimiter::SD1)
      return text + fmt::format("{} ({})", function_text(kAnswers, frame.function()),
                                kStations[static_cast<size_t>(frame.station())]);
    text += fmt::format("{} answer, {}", service_text(frame), function_text(kAnswers, frame.function()));
  } else {
    const std::string function = function_text(kRequests, frame.function());
    if (frame.asks(FdlRequest::FdlStatus) || frame.asks(FdlRequest::Ident) ||
        frame.asks(FdlRequest::LsapStatus))
      return text + function;
    text += service_text(frame) + ", " + function;
    if (frame.frame_count_valid() || frame.frame_count())
      text +=
          fmt::format(", FCB {}{}", frame.frame_count() ? 1 : 0, frame.frame_count_valid() ? "" : " (first)");
  }
  if (frame.data.empty()) return text;
  if (!data.empty()) return fmt::format("{}: {}", text, data);
  const auto point = frame.is_request() ? frame.dsap : frame.ssap;
  const auto service = point ? dp_service(*point) : std::nullopt;
  return text + ": " +
         (service ? data_text(*service, frame.data, !frame.is_request())
          : point && fms::connection_at(*point) != nullptr ? fms::describe(frame.data)
                                                            : hex_text(frame.data));
}

std::string frame_kind(const FdlFrame& frame) {
  const std::string text = describe(frame);
  const std::string_view head = std::string_view(text).substr(0, text.find_first_of(",:("));
  return std::string(head.substr(0, head.find_last_not_of(' ') + 1));
}

}  // namespace ipos::profibus

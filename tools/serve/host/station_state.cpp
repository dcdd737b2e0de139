// The members of the topic `plant` (docs/reference/serve.md).
#include "tools/serve/host/station_state.hpp"

#include <fmt/format.h>

#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/drive_values.hpp"
#include "runtime/signals/find.hpp"
#include "stdlib/faults.hpp"
#include "tools/serve/host/machine_picture.hpp"
#include "tools/serve/host/station_order.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Station;

Json process_words(const runtime::DriveWords& words) {
  Json list = Json::array();
  for (const uint16_t word : words) list.push_back(fmt::format("{:04X}", word));
  return list;
}

// An input for a voltage and a current shows the one that is there.
Json analog_texts(const Station& station) {
  Json texts = Json::object();
  for (const runtime::AnalogKind& kind : runtime::analog_kinds()) {
    const std::string name(kind.name);
    const int32_t value = station.inputs().line(runtime::line_of(kind)).value();
    if (kind.is_of(*station.config().unit) && (value != 0 || !texts.contains(name)))
      texts[name] = fmt::format("{:.3f} {}", value / kind.factor, kind.unit);
  }
  return texts;
}

// As it is wired: in V, or in mA where its mode is a current (P642, P645).
Json analog_output_texts(const Station& station) {
  Json texts = Json::object();
  for (const auto& [name, mode] : {std::pair("AO1", "642"), std::pair("AO2", "645")}) {
    if (!signals::has_drive_value(*station.config().unit, name)) continue;
    const bool current = std::as_const(station).drive().value(mode) >= 2;
    const std::string signal = current ? std::string(name) + "_current" : name;
    for (const signals::Signal& one : signals::find_station_signals(station, signal))
      texts[name] = fmt::format("{:.2f} {}", static_cast<double>(one.read()) * one.factor, one.unit);
  }
  return texts;
}

}  // namespace

// As fault and reason what keeps the DP master from the drives.
Json gateway_state(const runtime::Gateway& gateway) {
  Json out = Json::array(), in = Json::array();
  const auto add = [](Json& list, const runtime::ProcessWords& words) {
    for (const Json& word : process_words(words)) list.push_back(word);
  };
  std::string lost;
  for (size_t n = 0; n < gateway.drive_count(); ++n) {
    const runtime::Gateway::Drive drive = gateway.drive(n);
    add(out, drive.output);
    add(in, gateway.input(n));
    if (drive.lost) lost += fmt::format("{}{}", lost.empty() ? "" : ", ", drive.address);
  }
  std::string why;
  if (!gateway.powered())
    why = "the power is off";
  else if (!gateway.exchanges())
    why = "no DP master exchanges data with it";
  else if (!lost.empty())
    why = "no answer from the drives with SBus address " + lost;
  return {{"powered", gateway.powered()},
          {"in", 0},
          {"forced", 0},
          {"out", 0},
          {"analog", Json::object()},
          {"state", !gateway.powered() ? "off" : gateway.exchanges() ? "data exchange" : "waits for its DP master"},
          {"enabled", why.empty()},
          {"ordered", gateway.powered()},
          {"why", why},
          {"fault", 0},
          {"fault_text", ""},
          {"error", false},
          {"pd_out", std::move(out)},
          {"pd_in", std::move(in)}};
}

Json station_state(const runtime::Plant& plant, const Station& station) {
  Json json{{"powered", station.powered()}};
  uint32_t in = 0, forced = 0;
  for (size_t n = 0; n < runtime::kBinaryLines; ++n) {
    const runtime::InputLine& line = station.inputs().line(n);
    in |= (line.value() != 0 ? 1U : 0U) << n;
    forced |= (line.forced ? 1U : 0U) << n;
  }
  json["in"] = in;
  json["forced"] = forced;
  json["out"] = station.outputs();
  json["analog"] = analog_texts(station);
  json["analog_outputs"] = analog_output_texts(station);
  json["mains"] = station.switch_value(runtime::StationSwitch::Mains) != 0;
  const runtime::Drive& drive = station.drive().state();
  const runtime::AxisState& axis = drive.axis();
  const bool powered = station.powered();
  const runtime::Block reason = drive.verdict().reason;
  json["state"] = powered ? std::string(runtime::condition_text(drive.condition())) : "off";
  json["enabled"] = powered && reason == runtime::Block::None;
  json["ordered"] = powered && is_ordered(station);
  json["why"] = !powered                         ? "the power is off"
                : reason == runtime::Block::None ? ""
                                                 : runtime::block_text(reason, *station.config().unit);
  json["display"] = powered ? std::string(1, drive.display()) : "";
  json["status"] = station.status_word_1();
  json["fault"] = station.fault();
  const stdlib::FaultRow* row = station.fault() == 0 ? nullptr : stdlib::find_fault(station.fault());
  json["fault_text"] = row == nullptr ? "" : std::string(row->name);
  json["error"] = station.error();
  json["speed"] = axis.speed / 1000.0;
  json["setpoint"] = axis.setpoint / 1000.0;
  json["position"] = axis.position;
  json["shaft"] = static_cast<double>(static_cast<uint32_t>(station.shaft_position()) % runtime::kShaftTurn) / runtime::kShaftTurn;
  json["current"] = axis.output_current / 1000.0;
  json["torque"] = axis.torque / 1000.0;
  json["dc_link"] = axis.dc_link / 1000.0;
  json["pd_out"] = process_words(drive.po());
  json["pd_in"] = process_words(drive.pi());
  json["machine"] = machine_state(station, plant.surroundings());
  return json;
}

}  // namespace ipos::tools::serve

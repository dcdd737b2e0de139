// The machine of a station for the page.
#include "tools/serve/host/machine_picture.hpp"

#include <algorithm>
#include <cmath>

namespace ipos::tools::serve {
namespace {

using runtime::kShaftTurn;
using runtime::Station;

// System variables (IPOSplus p. 34).
constexpr uint32_t kStatusWord = 473, kSetpointPosition = 491, kTargetPosition = 492;
constexpr uint32_t kInPosition = 1U << 19, kReferenced = 1U << 20;

constexpr int32_t kNoReferenceTravel = 5;  // setting of P903

// Of a unit without the parameter 0.
int32_t parameter(const Station& station, std::string_view number) { return station.drive().value(number); }

// A turn of the output has P961 x P963 units, an increment P962 of them (runtime/positioning/modulo.hpp).
double degrees_per_turn(const Station& station) {
  const double turn = static_cast<double>(parameter(station, "961")) * parameter(station, "963");
  return turn == 0 ? 360 : 360.0 * kShaftTurn * parameter(station, "962") / turn;
}

bool has_limits(const Station& station) {
  return station.has_variables() && parameter(station, "921") < parameter(station, "920");
}

bool has_switch(const Station& station, const runtime::PlantFile& file) {
  return std::any_of(file.switches.begin(), file.switches.end(),
                     [&](const auto& row) { return row.input.station == station.config().name; });
}

}  // namespace

Json machine_picture(const Station& station, const runtime::PlantFile& file) {
  Json json{{"kind", "shaft"}, {"unit", "turns"}, {"per_turn", 1.0}, {"given", false}, {"from", nullptr}, {"to", nullptr}};
  if (const auto& machine = station.config().driven) {
    json["kind"] = runtime::info(machine->kind).word;
    json["unit"] = machine->unit;
    json["per_turn"] = machine->per_turn;
    json["given"] = true;
    if (machine->travel) json["from"] = machine->travel->from, json["to"] = machine->travel->to;
    if (machine->carries()) json["part_length"] = machine->part_length;
  } else if (parameter(station, "960") != 0) {
    json["kind"] = "turntable";
    json["unit"] = "deg";
    json["per_turn"] = degrees_per_turn(station);
  } else if (has_switch(station, file) || has_limits(station)) {
    json["kind"] = "axis";
    json["unit"] = "inc";
    json["per_turn"] = kShaftTurn;
  }
  json["limits"] = has_limits(station) ? Json{parameter(station, "921"), parameter(station, "920")} : Json(nullptr);
  const bool travels = station.has_variables() && parameter(station, "903") != kNoReferenceTravel;
  json["reference"] = travels ? Json(parameter(station, "900")) : Json(nullptr);
  return json;
}

Json machine_state(const Station& station, const runtime::Surroundings& surroundings) {
  Json json{{"shaft", station.shaft_position()}};
  if (station.has_variables()) {
    const auto status = static_cast<uint32_t>(station.variable(kStatusWord));
    json["target"] = station.variable(kTargetPosition);
    json["setpoint"] = station.variable(kSetpointPosition);
    json["in_position"] = (status & kInPosition) != 0;
    json["referenced"] = (status & kReferenced) != 0;
  }
  if (const runtime::Belt* belt = surroundings.belt_of(station)) {
    Json parts = Json::array();
    for (const double front : belt->fronts()) parts.push_back(std::round(front * 1000) / 1000);
    json["parts"] = std::move(parts);
  }
  return json;
}

}  // namespace ipos::tools::serve

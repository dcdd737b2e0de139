// The tab Plant: what the plant is, how it stands, and what a hand can do to it: inputs, analog terminals, fault reset,
// power and faults of the lines.
#include <fmt/format.h>

#include "runtime/drive/indices.hpp"
#include "runtime/plant/actions.hpp"
#include "runtime/plant_file/line_names.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/find.hpp"
#include "stdlib/parameters.hpp"
#include "tools/serve/host/line_faults.hpp"
#include "tools/serve/host/story.hpp"
#include "tools/serve/host/line_monitor.hpp"
#include "tools/serve/host/machine_picture.hpp"
#include "tools/serve/host/station_state.hpp"
#include "tools/serve/host/tabs.hpp"
#include "tools/serve/host/used_terminals.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::Station;

// Of units without the parameter there is no such terminal, except the two with a fixed function.
Json terminals(const Station& station, std::span<const runtime::BinaryTerminal> all, const char* fixed,
               const UsedTerminals& used) {
  const stdlib::ParameterTable& table = stdlib::parameter_table(*station.config().unit);
  Json list = Json::array();
  for (const runtime::BinaryTerminal& terminal : all) {
    const bool is_fixed = terminal.parameter.empty();
    const stdlib::Parameter* parameter =
        is_fixed ? nullptr : table.find(terminal.parameter);
    if (!is_fixed && parameter == nullptr) continue;
    const int32_t value = is_fixed ? 0 : station.drive().parameters().value(parameter->index);
    list.push_back({{"name", terminal.name},
                    {"bit", terminal.bit},
                    {"function", is_fixed ? fixed : stdlib::parameter_text(*parameter, value)},
                    {"used", used.has(terminal, value)}});
  }
  return list;
}

// AO1 and AO2 with the functions that P640 and P643 give them.
Json analog_outputs(const Station& station) {
  Json outputs = Json::array();
  const stdlib::ParameterTable& table = stdlib::parameter_table(*station.config().unit);
  for (const auto& [name, number] : {std::pair("AO1", "640"), std::pair("AO2", "643")})
    if (const stdlib::Parameter* row = table.find(number))
      outputs.push_back({{"name", name}, {"function", stdlib::parameter_text(*row, station.read(row->index))}});
  return outputs;
}

class PlantTab final : public Tab {
 public:
  explicit PlantTab(PlantHost& host) : host_(host) {
    Router& router = host.router();
    router.add_command("plant", [this](const Router::Call&) {
      Json plant = describe();
      plant["story"] = story_of(host_);
      plant["planned"] = planned_acts(host_.plant());
      return Json{{"plant", std::move(plant)}};
    });
    router.add_topic("plant",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
    add("input", {"station", "name", "action", "on", "ms"},
        [this](const Json& action) { input(Arguments(action)); });
    add("analog", {"station", "name", "action", "value"},
        [this](const Json& action) { analog(Arguments(action)); });
    add("reset", {"station"}, [this](const Json& action) {
      host_.station(Arguments(action).text("station")).drive().state().reset_fault();
    });
    add("power", {"station", "on"}, [this](const Json& action) { power(Arguments(action)); });
    add("mains", {"station", "on"}, [this](const Json& action) { mains(Arguments(action)); });
    add("fault", {"bus", "kind", "station", "on", "rate", "identifier"},
        [this](const Json& action) { faults_.carry_out(Arguments(action)); });
  }

  void built(runtime::Plant& plant) override { faults_.built(plant); }

 private:
  // A command that is an action on the plant, with the members that count.
  void add(const char* name, std::vector<const char*> members, PlantHost::Action action) {
    host_.add_action(name, std::move(action));
    host_.router().add_command(name, [this, name, members = std::move(members)](const Router::Call& call) {
      Json details = Json::object();
      for (const char* member : members)
        if (call.arguments.has(member)) details[member] = call.arguments.json()[member];
      host_.act(name, std::move(details));
      return Json::object();
    });
  }

  // --- what a hand does ---

  static void succeed(const runtime::Refusal& refused) {
    if (refused) throw Mistake(*refused);
  }

  void input(const Arguments& a) {
    Station& station = host_.station(a.text("station"));
    const std::string name = a.text("name");
    const auto signal = signals::find_in_group(station, signals::Group::Input, name);
    if (!signal) throw Mistake(fmt::format("'{}' is no input; they are DI00 to DI07 and DI10 to DI17", name));
    runtime::PlantActions actions(host_.plant(), kPerson);
    const std::string action = a.text("action", "set");
    if (action == "release") return actions.release(*signal);
    const int32_t level = a.flag("on") ? 1 : 0;
    if (action == "force") return succeed(actions.force(*signal, level));
    if (action == "pulse")
      return succeed(actions.force(*signal, level, a.whole("ms", 1, 3'600'000, 100) * runtime::kMillisecond));
    if (action != "set") throw Mistake("'action' must be set, pulse, force or release");
    if (actions.is_forced(*signal))
      throw Mistake(fmt::format("{} of {} is forced; release it first", name, station.config().name));
    if (std::as_const(station).inputs().line(signal->number).driven)
      throw Mistake(fmt::format("{} of {} is held by a wire or a switch of the plant; force it", name,
                                station.config().name));
    succeed(actions.set(*signal, level));
  }

  void analog(const Arguments& a) {
    Station& station = host_.station(a.text("station"));
    const std::string name = a.text("name");
    const std::string action = a.text("action", "set");
    const int first = runtime::parse_analog_input(name);
    if (first < 0)
      throw Mistake(
          fmt::format("'{}' is no analog terminal; they are AI1, AI2, frequency, potentiometer", name));
    const auto line = [&](int number) {
      return *signals::signal_at(station, signals::Group::Analog, static_cast<uint32_t>(number));
    };
    runtime::PlantActions actions(host_.plant(), kPerson);
    if (action == "release") return actions.release(line(first));
    const std::string value = a.text("value");
    const auto setting = runtime::parse_analog(name, value);
    if (!setting)
      throw Mistake(
          fmt::format("'{}' is no value for {}; write for example 5 V, 12 mA, 5 kHz, 50 %", value, name));
    if (action == "force") return succeed(actions.force(line(setting->line), setting->value));
    if (action != "set") throw Mistake("'action' must be set, force or release");
    succeed(actions.set(line(setting->line), setting->value));
  }

  void power(const Arguments& a) {
    const std::string name = a.text("station");
    const bool on = a.flag("on");
    runtime::Plant& plant = host_.plant();
    const runtime::Gateway* gateway = plant.find_gateway(name);
    if ((gateway != nullptr ? gateway->powered() : host_.station(name).powered()) == on)
      throw Mistake(on ? "it is on" : "it is off");
    plant.surroundings().act(plant.now(), [&plant, name, on] { plant.set_power(name, on); });
  }

  void mains(const Arguments& a) {
    Station& station = host_.station(a.text("station"));
    const bool on = a.flag("on");
    if ((station.switch_value(runtime::StationSwitch::Mains) != 0) == on) throw Mistake(on ? "the mains are on" : "the mains are off");
    succeed(station.set_switch(runtime::StationSwitch::Mains, on ? 1 : 0));
  }

  // --- what it is ---

  Json describe() const {
    const runtime::Plant& plant = host_.plant();
    Json stations = Json::array();
    for (const auto& station : plant.stations()) stations.push_back(describe(*station));
    for (const runtime::Gateway* gateway : plant.all<runtime::Gateway>()) stations.push_back(describe(*gateway));
    Json buses = Json::array();
    for (const auto& bus : plant.buses()) {
      std::vector<std::string> nodes = bus->node_names();
      std::erase(nodes, kPageNode);
      buses.push_back({{"name", bus->name()},
                       {"kind", runtime::info(bus->kind()).word},
                       {"baud", bus->baud()},
                       {"stations", std::move(nodes)},
                       {"faults", LineFaults::kinds(*bus)},
                       {"fault_rules", LineFaults::rules(*bus)}});
    }
    Json controls = Json::array();
    for (const auto& control : plant.controls())
      if (runtime::as<runtime::Gateway>(control.get()) == nullptr)
        for (const std::string& bus : runtime::line_names(control->config())) controls.push_back({{"name", control->name()}, {"bus", bus}});
    Json wires = Json::array();
    const auto name = [](const runtime::Signal& signal) { return signal.station + "." + signal.name; };
    for (const runtime::Wire& wire : plant.file().wires)
      wires.push_back({{"from", name(wire.from)}, {"to", name(wire.to)}, {"invert", wire.invert}});
    Json switches = Json::array();
    for (const runtime::PositionSwitch& row : plant.file().switches) {
      Json json{{"input", name(row.input)}, {"active_high", row.active_high}};
      json["from"] = row.from == INT32_MIN ? Json(nullptr) : Json(row.from);
      json["to"] = row.to == INT32_MAX ? Json(nullptr) : Json(row.to);
      switches.push_back(std::move(json));
    }
    Json barriers = Json::array();
    for (const runtime::LightBarrier& row : plant.file().barriers)
      barriers.push_back({{"input", name(row.input)}, {"belt", row.belt}, {"at", row.at}, {"active_high", row.active_high}});
    return {{"stations", std::move(stations)},
            {"buses", std::move(buses)},
            {"controls", std::move(controls)},
            {"wires", std::move(wires)},
            {"switches", std::move(switches)},
            {"barriers", std::move(barriers)}};
  }

  std::string text_of(const Station& station) const {
    const vm::Image* image = station.image();
    if (image == nullptr || image->files.empty()) return {};
    return host_.texts().text(host_.station_number(station.config().name), image->files.front()).value_or("");
  }

  Json describe(const Station& station) const {
    const runtime::StationConfig& config = station.config();
    const UsedTerminals used(host_.plant().file(), config, text_of(station));
    Json analog = Json::array();
    for (const runtime::AnalogKind& kind : runtime::analog_kinds()) {
      if (!kind.is_of(*config.unit)) continue;
      if (analog.empty() || analog.back()["name"] != kind.name)
        analog.push_back(
            {{"name", kind.name}, {"units", Json::array()}, {"least", kind.minimum}, {"most", kind.maximum}});
      analog.back()["units"].push_back(kind.unit);
    }
    return {{"name", config.name},
            {"unit", config.unit->name},
            {"title", config.unit->title},
            {"program", config.program},
            {"drive", true},
            {"ideal_motor", !config.options.own_motor},
            {"inputs", terminals(station, runtime::binary_inputs(), "/CONTROL.INHIBIT", used)},
            {"outputs", terminals(station, runtime::binary_outputs(), "/BRAKE", used)},
            {"analog", std::move(analog)},
            {"analog_outputs", analog_outputs(station)},
            {"lines", runtime::line_names(config)}};
  }

  // A card without display and terminals.
  static Json describe(const runtime::Gateway& gateway) {
    return {{"name", gateway.name()},
            {"unit", "gateway"},
            {"title", "gateway from PROFIBUS to SBus"},
            {"program", ""},
            {"drive", false},
            {"inputs", Json::array()},
            {"outputs", Json::array()},
            {"analog", Json::array()},
            {"analog_outputs", Json::array()},
            {"lines", runtime::line_names(gateway.config())}};
  }

  // --- how it stands ---

  // Terminals show at once what was done to them; what the unit says of it is older.
  void tell_later(Json& json) const {
    const std::string why = json["why"];
    if (host_.us() == 0 && json["powered"].get<bool>()) {
      json["state"] = "power-on";  // no state of a unit (ours): it has not looked at anything yet
      json["display"] = "";
      json["ordered"] = false;
      json["why"] = "it stands before the first millisecond, with which its terminals act";
    } else if (!why.empty() && json["powered"].get<bool>())
      json["why"] = why + ", at the last millisecond; what was done since acts with the next one";
  }

  Json line_state(const std::string& name, const runtime::LineLoad& load) const {
    return {{"load", load.window_percent}, {"frames", load.frames}, {"faults", faults_.planted_on(name)}};
  }

  void publish(Client& client, Subscription& subscription) {
    const runtime::Plant& plant = host_.plant();
    Json stations = Json::object();
    for (const auto& station : plant.stations()) {
      Json now = station_state(plant, *station);
      if (host_.sees_later(station->config().name)) tell_later(now);
      if (subscription.is_news("s" + station->config().name, now))
        stations[station->config().name] = std::move(now);
    }
    Json machines = Json::object();
    for (const auto& station : plant.stations()) {
      Json now = machine_picture(*station, plant.file());
      if (subscription.is_news("m" + station->config().name, now)) machines[station->config().name] = std::move(now);
    }
    for (const runtime::Gateway* gateway : plant.all<runtime::Gateway>()) {
      Json now = gateway_state(*gateway);
      if (subscription.is_news("s" + gateway->name(), now)) stations[gateway->name()] = std::move(now);
    }
    Json buses = Json::object();
    for (const auto& bus : plant.buses()) {
      Json now = line_state(bus->name(), bus->load(plant.now()));
      if (subscription.is_news("b" + bus->name(), now)) buses[bus->name()] = std::move(now);
    }
    if (stations.empty() && machines.empty() && buses.empty()) return;
    host_.router().send(client, {{"event", "plant"},
                               {"us", host_.us()},
                               {"stations", std::move(stations)},
                               {"machines", std::move(machines)},
                               {"buses", std::move(buses)}});
  }

  PlantHost& host_;
  LineFaults faults_;
};

}  // namespace

std::unique_ptr<Tab> make_plant_tab(PlantHost& host) { return std::make_unique<PlantTab>(host); }

}  // namespace ipos::tools::serve

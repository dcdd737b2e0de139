// The tab Bus of a plant: ears on all its lines.
#include <algorithm>

#include "runtime/bus_plan/names.hpp"
#include "tools/serve/bus_traffic.hpp"
#include "tools/serve/enabling_telegrams.hpp"
#include "tools/serve/tabs.hpp"

namespace ipos::tools::serve {
namespace {

class BusTab final : public Tab, private BusSource {
 public:
  explicit BusTab(PlantHost& host) : host_(host), traffic_(host.desk(), *this) {
    host.add_action("bus.send", [this](const Json& action) { traffic_.send(Arguments(action)); });
  }

  // In the order of the reply to `plant`.
  void built(runtime::Plant& plant) override {
    traffic_.clear();
    for (runtime::CanLine* line : plant.lines())
      traffic_.follow(*line,
                      CanNamesNow{[this, line] { return runtime::can_line_names(host_.plant(), line); },
                                  [this, line] { return runtime::defined_objects(host_.plant(), *line); }});
    for (runtime::SerialBus* bus : plant.serial_lines())
      traffic_.follow(bus->line(), [this] { return runtime::serial_names(host_.plant()); });
    for (runtime::ProfibusBus* bus : profibus_lines(plant)) traffic_.follow(bus->line());
    traffic_.complete();
  }

  void runs_again() override { traffic_.stop_hearing(); }

  void passed(runtime::Time now) override {
    traffic_.settle();
    if (now % runtime::kSecond == 0) traffic_.second_passed();
  }

 private:
  runtime::Time line_now() const override { return host_.plant().now(); }
  void heard() override { host_.telegram_seen(); }
  // Done again when its time comes again.
  void send(const Desk::Call& call) override {
    if (const std::string bus = call.arguments.text("bus"); host_.has_port(bus)) guard(bus, call.arguments);
    host_.act("bus.send", call.arguments.json());
  }
  // A real drive may be at the port.
  void guard(const std::string& bus, const Arguments& arguments) {
    runtime::Plant& plant = host_.plant();
    std::vector<int> addresses;  // that stations of the plant have there
    const auto have = [&](const auto& all, auto address) {
      for (const auto& one : all) addresses.push_back(address(one));
    };
    const auto unit_address = [](const auto& unit) { return int{unit.settings.address}; };
    std::optional<EnablingTelegram> enabling;
    for (const runtime::CanLine* line : plant.lines())
      if (line->name() == bus) {
        const runtime::CanLineNames names = runtime::can_line_names(plant, line);
        enabling = enabling_on_can(arguments, !names.nodes.empty());
        if (names.nodes.empty())
          have(names.movilink.units, unit_address);
        else
          have(names.nodes, [](const auto& node) { return int{node.node}; });
      }
    for (runtime::SerialBus* line : plant.serial_lines())
      if (line->line().name() == bus) {
        enabling = enabling_on_serial(arguments);
        std::vector<runtime::UnitNames> units = runtime::serial_names(plant).units;
        std::erase_if(units, [&](const auto& unit) { return !is_at(plant, unit.name, bus); });
        have(units, unit_address);
      }
    for (const runtime::ProfibusBus* line : profibus_lines(plant))
      if (line->name() == bus) {
        enabling = enabling_on_profibus(traffic_.octets_of(arguments));
        for (const runtime::StationConfig& station : plant.file().stations)
          if (station.profibus.bus.bus == bus) addresses.push_back(station.profibus.address);
      }
    if (!enabling) return;
    refuse_outside(*enabling, [&](uint8_t address) {
      return std::find(addresses.begin(), addresses.end(), int{address}) != addresses.end();
    });
  }

  static bool is_at(const runtime::Plant& plant, const std::string& station, const std::string& serial_bus) {
    const auto& all = plant.file().stations;
    return std::any_of(all.begin(), all.end(), [&](const runtime::StationConfig& one) {
      return one.name == station && (one.serial.x13.bus == serial_bus || one.serial.xt.bus == serial_bus);
    });
  }

  PlantHost& host_;
  BusTraffic traffic_;
};

}  // namespace

std::vector<runtime::ProfibusBus*> profibus_lines(const runtime::Plant& plant) {
  std::vector<runtime::ProfibusBus*> lines;
  for (const auto& bus : plant.buses())
    if (auto* line = dynamic_cast<runtime::ProfibusBus*>(bus.get())) lines.push_back(line);
  return lines;
}

std::unique_ptr<Tab> make_bus_tab(PlantHost& host) { return std::make_unique<BusTab>(host); }

}  // namespace ipos::tools::serve

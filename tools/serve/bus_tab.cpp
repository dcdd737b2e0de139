// The tab Bus of a plant: ears on all its lines.
#include "runtime/bus_plan/names.hpp"
#include "tools/serve/bus_traffic.hpp"
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
      traffic_.follow(*line, [this, line] { return runtime::can_line_names(host_.plant(), line); });
    for (runtime::SerialBus* bus : plant.serial_lines())
      traffic_.follow(bus->line(), [this] { return runtime::serial_names(host_.plant()); });
    for (runtime::ProfibusBus* bus : profibus_lines(plant)) traffic_.follow(bus->line());
  }

  void passed(runtime::Time now) override {
    if (now % runtime::kSecond == 0) traffic_.second_passed();
  }

 private:
  runtime::Time line_now() const override { return host_.plant().now(); }
  void heard() override { host_.telegram_seen(); }
  // Done again when its time comes again.
  void send(const Desk::Call& call) override { host_.act("bus.send", call.arguments.json()); }

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

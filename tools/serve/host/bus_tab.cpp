// The tab Bus of a plant: monitors on all its lines.
#include <algorithm>

#include "runtime/bus_plan/names.hpp"
#include "runtime/signals/telegrams.hpp"
#include "tools/serve/host/bus_traffic.hpp"
#include "tools/serve/host/enabling_telegrams.hpp"
#include "tools/serve/host/tabs.hpp"

namespace ipos::tools::serve {
namespace {

constexpr const char* kTestNode = "test";  // the hand of a test or of a stimulus

class BusTab final : public Tab, private BusSource {
 public:
  explicit BusTab(PlantHost& host) : host_(host), traffic_(host.router(), *this, host.copies()) {
    host.add_action("bus.send", [this](const Json& action) { traffic_.send(Arguments(action)); });
  }

  // In the order of the reply to `plant`.
  void built(runtime::Plant& plant) override {
    traffic_.clear();
    for (const auto& bus : plant.buses())
      visit(
          *bus,
          [this](runtime::CanBus& can) {
            const auto names = [this, &can] { return runtime::can_line_names(host_.plant(), &can.line()); };
            const auto objects = [this, &can] { return runtime::defined_objects(host_.plant(), can.line()); };
            traffic_.follow(can.line(), CanNamesNow{names, objects});
          },
          [this](runtime::SerialBus& serial) {
            traffic_.follow(serial.line(), [this] { return runtime::serial_names(host_.plant()); });
          },
          [this](runtime::ProfibusBus& profibus) {
            traffic_.follow(profibus.line(), DpNamesNow([this, &profibus] { return runtime::dp_names(host_.plant(), profibus); }));
          });
    traffic_.complete();
  }

  void runs_again(Tab&) override { traffic_.stop_hearing(); }
  void dropped(size_t) override { traffic_.dropped(); }

  void passed(runtime::Time now) override {
    traffic_.settle();
    if (now % runtime::kSecond == 0) traffic_.second_passed();
  }

 private:
  runtime::Time line_now() const override { return host_.plant().now(); }
  void heard() override { host_.telegram_seen(); }
  bool is_ours(const std::string&, const std::string& node) const override {
    const auto named = [&node](const auto& one) { return one->name() == node; };
    const auto configured = [&node](const auto& one) { return one->config().name == node; };
    return node.empty() || node == kPageNode || node == kTestNode ||
           std::any_of(host_.plant().stations().begin(), host_.plant().stations().end(), configured) ||
           std::any_of(host_.plant().controls().begin(), host_.plant().controls().end(), named);
  }
  Json fields_of(const std::string& line, const Telegram& telegram) const override {
    const runtime::Bus* const bus = host_.plant().find_bus(line);
    if (bus == nullptr) return nullptr;
    Json fields = Json::array();
    for (const auto& [signal, value] :
         signals::values_of_telegram(host_.plant(), *bus, {telegram.id, telegram.extended, telegram.bytes()}))
      fields.push_back({{"signal", signal.name}, {"meaning", signal.meaning}, {"value", value}, {"bits", signal.bits}});
    return fields;
  }
  // Done again when its time comes again.
  void send(const Router::Call& call) override {
    if (const std::string bus = call.arguments.text("bus"); host_.has_port(bus)) guard(bus, call.arguments);
    host_.act("bus.send", call.arguments.json());
  }
  // A real drive may be at the port.
  void guard(const std::string& name, const Arguments& arguments) {
    runtime::Bus* const bus = host_.plant().find_bus(name);
    if (bus == nullptr) return;
    const Outside outside = visit(*bus, [&](auto& line) { return outside_of(line, arguments); });
    if (!outside.enabling) return;
    refuse_outside(*outside.enabling, [&](uint8_t address) {
      return std::find(outside.simulated.begin(), outside.simulated.end(), int{address}) != outside.simulated.end();
    });
  }

  // A telegram that could enable somebody outside, and the addresses that stations of the plant have on the line.
  struct Outside {
    std::optional<EnablingTelegram> enabling;
    std::vector<int> simulated;
  };

  Outside outside_of(runtime::CanBus& bus, const Arguments& arguments) {
    const runtime::CanLineNames names = runtime::can_line_names(host_.plant(), &bus.line());
    Outside outside{enabling_on_can(arguments, !names.nodes.empty()), {}};
    for (const auto& node : names.nodes) outside.simulated.push_back(node.node);
    if (names.nodes.empty())
      for (const auto& unit : names.movilink.units) outside.simulated.push_back(unit.settings.address);
    return outside;
  }
  Outside outside_of(runtime::SerialBus& bus, const Arguments& arguments) {
    Outside outside{enabling_on_serial(arguments), {}};
    for (const auto& unit : runtime::serial_names(host_.plant()).units)
      if (is_at(host_.plant(), unit.name, bus.name())) outside.simulated.push_back(unit.settings.address);
    return outside;
  }
  Outside outside_of(runtime::ProfibusBus& bus, const Arguments& arguments) {
    Outside outside{enabling_on_profibus(traffic_.octets_of(arguments)), {}};
    for (const runtime::StationConfig& station : host_.plant().file().stations)
      if (station.profibus.bus.bus == bus.name()) outside.simulated.push_back(station.profibus.address);
    return outside;
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

std::unique_ptr<Tab> make_bus_tab(PlantHost& host) { return std::make_unique<BusTab>(host); }

}  // namespace ipos::tools::serve

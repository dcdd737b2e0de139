// Fills the dictionary from stations, parameters, symbols and object definitions.
#include "runtime/bus_plan/names.hpp"

#include <fmt/format.h>

#include "runtime/bus/profibus/fieldbus_parameters.hpp"
#include "runtime/station/dp_slaves.hpp"

namespace ipos::runtime {
namespace {

WordAssignment assignment(const UnitInterface& drive, int first) {
  WordAssignment words{};
  for (size_t n = 0; n < words.size(); ++n)
    words[n] = static_cast<uint8_t>(drive.value(fmt::format("{}", first + static_cast<int>(n))));
  return words;
}

UnitNames unit_names(const Station& station, const SlaveSettings& settings) {
  UnitNames unit;
  unit.name = station.config().name;
  unit.unit = station.config().unit;
  unit.settings = settings;
  // Control word 1, speed, ramp; status word 1, speed, apparent current (docs/reference/protocols/profibus.md, The unit).
  const bool fixed = unit.unit->has(stdlib::Trait::OwnParameterNumbers);
  unit.output = fixed ? WordAssignment{9, 1, 8} : assignment(station.drive(), 870);
  unit.input = fixed ? WordAssignment{6, 1, 2} : assignment(station.drive(), 873);
  if (station.image() != nullptr)
    for (const vm::Symbol& symbol : station.image()->symbols)
      for (uint32_t n = 0; n < symbol.count; ++n)
        unit.variables.push_back({static_cast<uint16_t>(symbol.variable + n),
                                  variable_name(station.image(), symbol.variable + n)});
  return unit;
}

}  // namespace

std::string variable_name(const vm::Image* image, uint32_t variable) {
  if (image != nullptr)
    for (const vm::Symbol& symbol : image->symbols)
      if (variable >= symbol.variable && variable < symbol.variable + uint32_t{symbol.count})
        return symbol.count == 1 ? symbol.name
                                 : fmt::format("{}[{}]", symbol.name, variable - symbol.variable);
  return fmt::format("H{}", variable);
}

namespace {

void add_objects(const Station& station, const VariableObjects& objects, TelegramNames& names) {
  for (const ObjectDefinition& definition : objects.definitions()) {
    if (!definition.accepted) continue;
    ObjectNames object;
    object.id = static_cast<uint32_t>(definition.object);
    object.station = station.config().name;
    object.sent = definition.kind != ObjectKind::Receive;
    object.format = *definition.format;
    object.cycle = definition.kind == ObjectKind::TransmitCyclic ? definition.cycle : 0;
    for (uint32_t n = 0; n < 2; ++n)
      object.variables[n] = variable_name(station.image(), definition.data + n);
    names.objects.push_back(std::move(object));
  }
}

}  // namespace

TelegramNames telegram_names(const Plant& plant, const CanLine* line) {
  TelegramNames names;
  const auto is_on = [line](const CanLine& other) { return line == nullptr || line == &other; };
  for (const auto& station : plant.stations())
    for (const int number : {1, 2}) {
      const SbusPort* port = std::as_const(*station).sbus(number);
      const CanopenPort* canopen = std::as_const(*station).canopen(number);
      if (port != nullptr && is_on(port->line())) {
        names.units.push_back(unit_names(*station, port->settings().slave));
        add_objects(*station, port->objects(), names);
      }
      if (canopen != nullptr && is_on(canopen->line())) add_objects(*station, canopen->objects(), names);
    }
  return names;
}

namespace {

std::vector<canopen::NodeName> node_names(const Plant& plant, const CanLine* line) {
  std::vector<canopen::NodeName> names;
  for (const auto& station : plant.stations())
    for (const int number : {1, 2}) {
      const CanopenPort* port = std::as_const(*station).canopen(number);
      if (port == nullptr || (line != nullptr && &port->line() != line)) continue;
      const StationConfig& config = station->config();
      const canopen::Node* node = port->canopen();
      names.push_back(
          {port->settings().canopen_address, config.name, config.unit, assignment(station->drive(), 870),
           assignment(station->drive(), 873),
           node == nullptr ? nullptr : std::make_shared<canopen::ObjectDictionary>(node->dictionary())});
    }
  return names;
}

}  // namespace

CanLineNames can_line_names(const Plant& plant, const CanLine* line) {
  return {telegram_names(plant, line), node_names(plant, line)};
}

size_t defined_objects(const Plant& plant, const CanLine& line) {
  size_t count = 0;
  for (const auto& station : plant.stations())
    for (const int number : {1, 2}) {
      const SbusPort* port = std::as_const(*station).sbus(number);
      const CanopenPort* canopen = std::as_const(*station).canopen(number);
      if (port != nullptr && &port->line() == &line) count += port->objects().definitions().size();
      if (canopen != nullptr && &canopen->line() == &line) count += canopen->objects().definitions().size();
    }
  return count;
}

CanNames can_names(const Plant& plant) {
  CanNames names;
  names.all = can_line_names(plant);
  for (CanBus* bus : plant.all<CanBus>()) names.lines[bus->name()] = can_line_names(plant, &bus->line());
  return names;
}

TelegramNames serial_names(const Plant& plant) {
  TelegramNames names;
  for (const auto& station : plant.stations()) {
    SlaveSettings settings;
    settings.address = static_cast<uint8_t>(station->drive().value("810"));
    settings.group = static_cast<uint8_t>(station->drive().value("811"));
    names.units.push_back(unit_names(*station, settings));
  }
  return names;
}

namespace {

DpSlaveNames slave_names(const Plant& plant, const Bus& bus, uint8_t address) {
  const DpSlaveOfPlant slave = dp_slave_at(plant, bus, address);
  DpSlaveNames names;
  if (slave.name.empty()) return names;
  names.address = address;
  names.name = slave.name;
  names.accepts = slave.option->accepts;
  names.configuration = dp_configuration_of(plant, bus, address);
  names.gateway = slave.gateway != nullptr;
  if (slave.station != nullptr) {
    UnitNames unit = unit_names(*slave.station, {});
    names.own_numbers = unit.unit->has(stdlib::Trait::OwnParameterNumbers);
    if (names.own_numbers) unit.first_index = profibus::kFirstParameterIndex;
    names.drives.push_back(std::move(unit));
    return names;
  }
  const TelegramNames behind = telegram_names(plant, &slave.gateway->line());
  for (size_t n = 0; n < slave.gateway->drive_count(); ++n) {
    const uint8_t drive = slave.gateway->drive(n).address;
    const UnitNames* known = behind.unit_at(drive);
    UnitNames& unit = names.drives.emplace_back(known != nullptr ? *known : UnitNames{});
    if (known == nullptr) unit.name = fmt::format("address {}", drive);
    unit.settings.address = drive;
  }
  return names;
}

}  // namespace

std::vector<DpSlaveNames> dp_names(const Plant& plant, const Bus& bus) {
  std::vector<DpSlaveNames> slaves;
  for (int address = 0; address <= profibus::kLastStation; ++address)
    if (DpSlaveNames slave = slave_names(plant, bus, static_cast<uint8_t>(address)); !slave.name.empty())
      slaves.push_back(std::move(slave));
  return slaves;
}

BusNames bus_names(const Plant& plant) {
  BusNames names{can_names(plant), serial_names(plant), {}};
  for (const ProfibusBus* bus : plant.all<ProfibusBus>()) names.dp.lines[bus->name()] = dp_names(plant, *bus);
  return names;
}

}  // namespace ipos::runtime

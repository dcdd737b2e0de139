// From the plant file, the parameters and the telegrams of the trial run.
#include "runtime/bus_plan/serial_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "runtime/bus/movilink/format.hpp"
#include "runtime/bus/rs485/line.hpp"
#include "runtime/bus_plan/checks.hpp"
#include "runtime/plant_file/serial_plan.hpp"

namespace ipos::runtime {
namespace {

class LinePlanner {
 public:
  LinePlanner(const Plant& plant, const BusConfig& bus, BusPlan& plan)
      : plant_(plant), bus_(bus), plan_(plan) {
    line_.name = bus.name;
    line_.kind = info(bus.kind).name;
    line_.baud = bus.baud;
    line_.length = (bus.length_mm + 999) / 1000;
    line_.length_limit = serial_length_limit(plant.file(), bus) / 1000;
  }

  void run(const SerialWatcher::Line& seen) {
    stations();
    cable();
    telegrams(seen);
    if (seen.masters.size() > 1)
      find(FindingKind::SeveralMasters,
           fmt::format("{} are masters on this line", fmt::join(seen.masters, ", ")));
    plan_.serial_lines.push_back(std::move(line_));
  }

 private:
  void find(FindingKind kind, std::string text) {
    plan_.findings.push_back({kind, bus_.name, std::move(text)});
  }

  void stations() {
    for (const auto& station : plant_.stations()) {
      const StationConfig& config = station->config();
      if (config.serial.x13.bus == bus_.name) add(*station, "X13", kX13Baud);
      if (config.serial.xt.bus == bus_.name) add(*station, "XT", xt_baud(config));
    }
  }

  void cable() {
    using Rule = SerialCableFinding::Rule;
    for (SerialCableFinding& finding : serial_cable_findings(plant_.file(), bus_))
      find(finding.rule == Rule::TooLong ? FindingKind::LineTooLong : FindingKind::Termination, std::move(finding.text));
    check_octet_faults(plant_.file(), bus_, plan_.findings);
  }

  void add(const Station& station, const char* socket, uint32_t baud) {
    const std::string& name = station.config().name;
    line_.stations.push_back({name, socket, station.drive().value("810"), station.drive().value("811")});
    if (baud != bus_.baud)
      find(FindingKind::BaudRate,
           fmt::format("{} has {} baud at {}, the line has {} baud: it neither hears nor answers", name, baud,
                       socket, bus_.baud));
  }

  bool has_address(uint8_t address) const {
    return std::any_of(line_.stations.begin(), line_.stations.end(),
                       [address](const PlannedSerialStation& station) { return station.address == address; });
  }

  void telegrams(const SerialWatcher::Line& seen) {
    std::optional<uint8_t> told;
    for (const auto& [key, telegram] : seen.telegrams) {
      const auto& [address, code, response] = key;
      const TelegramFormat format = *telegram_format(code);
      const uint8_t bytes = telegram_length(format);
      line_.telegrams.push_back({telegram.sender, address, response, format_text(format), bytes,
                                 bytes * character_time(bus_.baud), telegram.count, telegram.closest});
      if (!bus_.port.empty()) continue;  // it may be a unit behind the port
      if (response || address_kind(address) != AddressKind::Single || has_address(address) || told == address)
        continue;
      told = address;
      find(FindingKind::NobodyThere,
           fmt::format("{} calls address {}, which no station has", telegram.sender, address));
    }
  }

  const Plant& plant_;
  const BusConfig& bus_;
  BusPlan& plan_;
  SerialLinePlan line_;
};

}  // namespace

void SerialWatcher::on_character(const Rs485Line& line, NodeId sender, const Character& character) {
  Line& watched = lines[line.name()];
  const auto reception = watched.receiver.take(character);
  if (!reception || !reception->telegram || sender == kNoNode) return;
  const SerialTelegram& telegram = *reception->telegram;
  const std::string& name = line.node_name(sender);
  Seen& seen = watched.telegrams[{telegram.address, format_code(telegram.format), telegram.response}];
  if (seen.count++ > 0) seen.closest = std::min(seen.closest, reception->start - seen.last);
  seen.last = reception->start;
  seen.sender = name;
  auto& masters = watched.masters;
  if (!telegram.response && std::find(masters.begin(), masters.end(), name) == masters.end())
    masters.push_back(name);
}

void plan_serial_lines(const Plant& plant, const SerialWatcher& watcher, BusPlan& plan) {
  for (const BusConfig& bus : plant.file().buses) {
    if (!is_serial(bus.kind)) continue;
    const auto seen = watcher.lines.find(bus.name);
    LinePlanner(plant, bus, plan).run(seen == watcher.lines.end() ? SerialWatcher::Line{} : seen->second);
  }
  const ParameterOf parameter = [&](size_t station, std::string_view number) {
    return plant.stations()[station]->drive().value(number);
  };
  for (const PlanFinding& finding : serial_findings(plant.file(), parameter))
    plan.findings.push_back(
        {finding.against_rule ? FindingKind::SerialSettings : FindingKind::SerialHint, "",
         finding.station.empty() ? finding.text : fmt::format("{}: {}", finding.station, finding.text)});
}

}  // namespace ipos::runtime

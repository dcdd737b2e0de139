// ipos bus monitor: the telegrams of a port or a log in words, as they come.
#include <fmt/format.h>
#include <unistd.h>

#include <set>

#include "runtime/bus/canopen/connections.hpp"
#include "runtime/bus/profibus/timing.hpp"
#include "runtime/bus/rs485/timing.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/monitor_sources.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/input/offers.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

constexpr uint32_t kProfibusBaud = 500'000;  // as without `baud` in a plant file
constexpr uint32_t kCanBaud = 500'000;       // factory setting of P816 (1053 1610 p. 41)

struct MonitorFlags {
  LogFlags source;  // or a port
  NamesFlags names;
  std::vector<std::string> stations;
  uint64_t count = 0;
  std::string duration;
  uint32_t baud = 0;
  bool profibus = false;
  bool follow = false;
  bool table = false;
  bool scroll = false;
};

// By its name or number. With --canopen a number is that of a node. False: there is no such station.
bool add_station(const runtime::CanNames& names, const std::string& station, runtime::StationFilter& filter) {
  const auto number = runtime::station_number(station);
  bool found =
      names.canopen ? number && runtime::canopen::is_node(*number) : filter.add(names.all.movilink, station);
  std::set<uint8_t> nodes;
  if (names.canopen && found) nodes.insert(*number);
  for (const runtime::canopen::NodeName& node : names.all.nodes)
    if (node.name == station || number == node.node) nodes.insert(node.node);
  for (const uint8_t node : nodes)
    for (const uint32_t id : runtime::canopen::identifiers_of(node)) filter.add(id);
  return found || !nodes.empty();
}

// A log may be of either kind of bus.
Monitor make_monitor(const MonitorFlags& flags, MonitorSource source) {
  runtime::BusNames names = bus_names_of(flags.names);
  if (source == MonitorSource::Serial) names.can = {};
  if (source == MonitorSource::Can) names.serial = {};
  Monitor::Filters filters;
  for (const std::string& station : flags.stations) {
    filters.can.close();
    filters.serial.close();
    const bool on_can = add_station(names.can, station, filters.can);
    if (!filters.serial.add(names.serial, station) && !on_can)
      throw Failure(kUsage, fmt::format("--station {}: {} has no such station, and it is no address", station,
                                        flags.names.plant.empty() ? "nothing known" : flags.names.plant));
  }
  const bool live = source != MonitorSource::Log || flags.follow;
  const bool table = flags.table || (live && !flags.scroll && flags.count == 0 && is_terminal(STDOUT_FILENO));
  return {runtime::BusWords(std::move(names)), std::move(filters), flags.count,
          table ? std::make_unique<MonitorScreen>(live && is_terminal(STDOUT_FILENO)) : nullptr};
}

int monitor(const MonitorFlags& flags) {
  const MonitorSource source = monitor_source(flags.source.path);
  if (flags.follow && source != MonitorSource::Log)
    throw Failure(kUsage, "--follow is for logs: a port is followed anyway");
  if (flags.follow && flags.source.path == "-")
    throw Failure(kUsage, "--follow is for files: standard input is read as it comes");
  if (!flags.source.channels.empty() && source != MonitorSource::Log)
    throw Failure(kUsage, "--channel is for logs: a port is one bus");
  if (flags.baud != 0 && source == MonitorSource::Log)
    throw Failure(kUsage, "--baud is for ports: a log has none");
  if (flags.profibus && source != MonitorSource::Serial)
    throw Failure(kUsage, "--profibus is for serial ports: a log tells by itself");
  if (flags.profibus && flags.baud != 0 && profibus::find_baud_rate(flags.baud) == nullptr)
    throw Failure(
        kUsage,
        fmt::format("--baud {}: PROFIBUS has 9600, 19200, 93750, 187500, 500000 and 1500000", flags.baud));
  const runtime::Time duration =
      flags.duration.empty() ? runtime::kNever : runtime::parse_duration(flags.duration);
  if (flags.table && flags.scroll) throw Failure(kUsage, "either --table or --scroll");
  Monitor view = make_monitor(flags, source);
  catch_interrupts();
  switch (source) {
    case MonitorSource::Can:
      return monitor_can(view, flags.source.path, flags.baud == 0 ? kCanBaud : flags.baud, duration);
    case MonitorSource::Serial:
      if (flags.profibus)
        return monitor_profibus(view, flags.source.path, flags.baud == 0 ? kProfibusBaud : flags.baud,
                                duration);
      return monitor_serial(view, flags.source.path,
                            flags.baud == 0 ? runtime::kSerialBaudRates[0] : flags.baud, duration);
    case MonitorSource::Log: break;
  }
  return monitor_log(view, flags.source, flags.follow, duration);
}

}  // namespace

void add_bus_monitor(cli::Verb& bus) {
  auto flags = std::make_shared<MonitorFlags>();
  cli::Verb& verb = bus.verb("monitor", "telegrams of a port or a log in words and units, live");
  verb.option("PORT|LOG", flags->source.path,
              "can0, slcan:/dev/ttyACM0, slcan:pty:/path, /dev/ttyUSB0, pty:/path, a log as in decode, or -")
      .required();
  add_channel_option(verb, flags->source);
  add_names_options(verb, flags->names);
  verb.option("--station", flags->stations, "only telegrams of this station, by name or address")
      .separated_by(',')
      .one_each()
      .offers(offered_stations);
  verb.option("--count", flags->count, "end after so many telegrams shown").at_least(1);
  verb.option("--for", flags->duration, "end after this time, for example 10s").check(check_time, "TIME");
  verb.option("--baud", flags->baud, "of the port; default 500000, of an RS-485 line 9600");
  verb.flag("--profibus", flags->profibus, "the serial port is at a PROFIBUS line");
  verb.flag("--follow,-f", flags->follow, "wait for more at the end of a log");
  verb.flag("--table", flags->table,
            "a row an identifier, with counts and changed bytes; default for a port on a terminal");
  verb.flag("--scroll", flags->scroll, "a line a telegram; default otherwise");
  verb.footer("Example:\n  ipos bus monitor can0 --plant examples/scom/scom.toml --station unit1");
  verb.runs([flags] { return monitor(*flags); });
}

}  // namespace ipos::tools

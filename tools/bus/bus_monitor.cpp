// ipos bus monitor: the telegrams of a port or a log in words, as they come.
#include <fmt/format.h>

#include "runtime/bus/rs485/timing.hpp"
#include "runtime/plant/plant_file.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/monitor_sources.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {
namespace {

constexpr uint32_t kCanBaud = 500'000;  // factory setting of P816 (1053 1610 p. 41)

struct MonitorFlags {
  std::string source;
  std::string names;
  std::vector<std::string> stations;
  uint64_t count = 0;
  std::string duration;
  uint32_t baud = 0;
  bool follow = false;
  CompileFlags compile;
};

// A log may be of either kind of bus.
Monitor make_monitor(const MonitorFlags& flags, MonitorSource source) {
  Monitor::View sbus, serial;
  if (source != MonitorSource::Serial) sbus.names = names_of(flags.names, flags.compile);
  if (source != MonitorSource::Can) serial.names = serial_names_of(flags.names, flags.compile);
  for (const std::string& station : flags.stations) {
    sbus.filter.close();
    serial.filter.close();
    const bool on_sbus = sbus.filter.add(sbus.names, station);
    if (!serial.filter.add(serial.names, station) && !on_sbus)
      throw Failure(kUsage, fmt::format("--station {}: {} has no such station, and it is no address", station,
                                        flags.names.empty() ? "nothing known" : flags.names));
  }
  return {std::move(sbus), std::move(serial), flags.count};
}

int monitor(const MonitorFlags& flags) {
  const MonitorSource source = monitor_source(flags.source);
  if (flags.follow && source != MonitorSource::Log)
    throw Failure(kUsage, "--follow is for logs: a port is followed anyway");
  if (flags.follow && flags.source == "-")
    throw Failure(kUsage, "--follow is for files: standard input is read as it comes");
  if (flags.baud != 0 && source == MonitorSource::Log)
    throw Failure(kUsage, "--baud is for ports: a log has none");
  const runtime::Time duration =
      flags.duration.empty() ? runtime::kNever : runtime::parse_duration(flags.duration);
  Monitor view = make_monitor(flags, source);
  catch_interrupts();
  switch (source) {
    case MonitorSource::Can:
      return monitor_can(view, flags.source, flags.baud == 0 ? kCanBaud : flags.baud, duration);
    case MonitorSource::Serial:
      return monitor_serial(view, flags.source, flags.baud == 0 ? runtime::kSerialBaudRates[0] : flags.baud,
                            duration);
    case MonitorSource::Log: break;
  }
  return monitor_log(view, flags.source, flags.follow, duration);
}

}  // namespace

void add_bus_monitor(cli::Verb& bus) {
  auto flags = std::make_shared<MonitorFlags>();
  cli::Verb& verb = bus.verb("monitor", "telegrams of a port or a log in words and units, live");
  verb.option("PORT|LOG", flags->source,
              "can0, slcan:/dev/ttyACM0, slcan:pty:/path, /dev/ttyUSB0, pty:/path, a log as in decode, or -")
      .required();
  add_names_option(verb, flags->names);
  verb.option("--station", flags->stations, "only telegrams of this station, by name or address")
      .separated_by(',')
      .one_each();
  verb.option("--count", flags->count, "end after so many telegrams shown").at_least(1);
  verb.option("--for", flags->duration, "end after this time, for example 10s").check(check_time, "TIME");
  verb.option("--baud", flags->baud, "of the port; default 500000, of a serial line 9600");
  verb.flag("--follow,-f", flags->follow, "wait for more at the end of a log");
  add_compile_options(verb, flags->compile);
  verb.footer("Example:\n  ipos bus monitor can0 --plant examples/scom/scom.toml --station unit1");
  verb.runs([flags] { return monitor(*flags); });
}

}  // namespace ipos::tools

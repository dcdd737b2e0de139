// ipos watch: values of a unit at a port, or of a station of a plant that runs in real time, row by row.
#include <fmt/format.h>

#include <limits>

#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"
#include "tools/links/link_access.hpp"
#include "tools/input/offers.hpp"
#include "tools/links/link_options.hpp"
#include "tools/links/live_values.hpp"
#include "tools/parameters/running_station.hpp"
#include "tools/running/real_time_run.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

struct WatchFlags {
  LinkFlags link;  // the port, or a plant file
  std::string unit_at;
  std::vector<std::string> names;
  std::string unit;
  std::string every = "500ms";
  uint64_t count = 0;  // 0: until Ctrl-C
  bool once = false;
  std::string format = "text";
  std::vector<std::string> include_dirs;
  bool allow_fmu = false;

  LiveForm form() const {
    if (format == "json") return LiveForm::Json;
    return once ? LiveForm::Once : LiveForm::Rows;
  }
  uint64_t rounds() const { return once ? 1 : count == 0 ? std::numeric_limits<uint64_t>::max() : count; }
  CompileFlags compile() const {
    CompileFlags flags;
    flags.include_dirs = include_dirs;
    flags.allow_fmu = allow_fmu;
    return flags;
  }
};

double seconds(Time time) { return static_cast<double>(time) / 1e9; }

int end_of(const LiveTable& table, bool stopped) {
  if (stopped) return kInterrupted;
  return table.complete() ? kGood : kFindings;
}

int watch_port(const WatchFlags& flags) {
  if (const std::string wrong = check_address(flags.unit_at); !wrong.empty()) throw Failure(kUsage, wrong);
  const auto address = static_cast<uint8_t>(std::stoi(flags.unit_at));
  std::unique_ptr<BusLink> link = BusLink::open(flags.link);
  BusLink& line = *link;
  const auto access = open_unit(std::move(link), address, flags.unit);
  LiveTable table(live_items(access->unit(), flags.names, nullptr, flags.compile()), flags.form());
  const Time every = runtime::parse_duration(flags.every);
  const Time begin = line.now();
  Time due = begin;
  bool slow = false;
  for (uint64_t round = 0; round < flags.rounds(); ++round) {
    if (!line.serve(std::max<Time>(0, due - line.now()))) return end_of(table, true);
    const Time now = line.now();
    table.print(seconds(now - begin), *access);
    due += every;
    if (line.now() <= due || flags.once) continue;
    if (!slow)
      fmt::print(stderr, "ipos: one round takes {:.0f} ms, longer than --every {}\n",
                 seconds(line.now() - now) * 1e3, flags.every);
    slow = true;
    due = line.now();
  }
  return end_of(table, false);
}

int watch_plant(const WatchFlags& flags) {
  catch_interrupts();
  const auto plant = make_plant(read_plant_input(flags.link.port, flags.compile()), runtime::FileUse::Look);
  runtime::Station& station = find_station(*plant, flags.link.port, flags.unit_at);
  RunningStation access(station, flags.link.port);
  LiveTable table(live_items(access.unit(), flags.names, station.image(), flags.compile()), flags.form());
  const Time every = runtime::parse_duration(flags.every);
  Time due = every;
  uint64_t round = 0;
  RealTimeRun run(*plant, flags.link.port);
  const bool ports_there = run.run(std::numeric_limits<int64_t>::max() / 4, [&](Time now) {
    if (now >= due) {
      table.print(seconds(now), access);
      due += every;
      ++round;
    }
    return round < flags.rounds() && !interrupted();
  });
  return ports_there ? end_of(table, interrupted()) : kIoError;
}

std::string check_rate(const std::string& text) {
  return runtime::parse_duration(text) < runtime::kMillisecond
             ? "'" + text + "' is no time of 1 ms or more; write for example 500ms or 1.5s"
             : "";
}

}  // namespace

void add_watch(cli::Verb& app) {
  auto flags = std::make_shared<WatchFlags>();
  cli::Verb& verb = app.verb("watch", "values of a real or simulated drive, again and again");
  verb.option("PORT", flags->link.port, "port of a real bus, or a plant file: that is run in real time")
      .required();
  verb.option("ADDRESS", flags->unit_at, "address of the unit; of a plant the name of the station")
      .required();
  verb.option("NAME", flags->names,
              "P000, 8318, H420, lTrDataLow@PROGRAM.IPC; with :hex behind it in hexadecimal")
      .required();
  add_link_options(verb, flags->link, false);
  verb.option("--unit", flags->unit, "do not ask the unit what it is: " + stdlib::unit_names())
      .check(check_unit, "UNIT").offers([](const Words&) { return offered_units(); });
  verb.option("--every", flags->every, "time from row to row, default 500ms").check(check_rate, "TIME");
  verb.option("--count", flags->count, "end after so many rows; default: go on until Ctrl-C").at_least(1);
  verb.flag("--once", flags->once, "read once, a line for each value");
  verb.option("--format", flags->format, "text, or json: an object for each row").one_of({"text", "json"});
  verb.flag("--allow-fmu", flags->allow_fmu, "let the FMUs run that are machines of the plant; they are programs of others");
  verb.option("-I", flags->include_dirs, "folder of include files, for PROGRAM.IPC");
  verb.footer("Example:\n  ipos watch /dev/ttyUSB0 1 P000 H420 lTrDataLow@SCOM1.IPC:hex --every 200ms");
  verb.runs([flags] { return is_plant(flags->link.port) ? watch_plant(*flags) : watch_port(*flags); });
}

}  // namespace ipos::tools

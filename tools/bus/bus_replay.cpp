// ipos bus replay: the frames of a log on a simulated line, then what `ipos run` would print.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "compiler/diag/places.hpp"

#include "runtime/bus/log/replay.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/bus/log_input.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/output_forms.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/program.hpp"
#include "tools/logs/log_writer.hpp"
#include "tools/running/run_report.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

struct ReplayFlags {
  LogFlags log;
  std::string plant;
  std::string bus;
  std::vector<std::string> ids;
  std::string begin;
  std::string duration;
  std::string longest_gap = "1h";
  std::string record;
  std::string watch;
  bool why = false;
  CompileFlags compile;
};

runtime::CanLine& line_of(const runtime::Plant& plant, const ReplayFlags& flags) {
  for (runtime::CanBus* bus : plant.all<runtime::CanBus>())
    if (flags.bus.empty() || bus->name() == flags.bus) return bus->line();
  throw Failure(kUsage, flags.bus.empty() ? fmt::format("{}: the plant has no CAN bus", flags.plant)
                                          : fmt::format("{}: there is no bus '{}'", flags.plant, flags.bus));
}

// The frames to be played, in their order in the log. Of several buses the user has to say which: they are for one line.
std::vector<runtime::LogEntry> entries_of(const ReplayFlags& flags, LogFindings& findings) {
  std::set<uint32_t> wanted;
  for (const std::string& id : flags.ids) wanted.insert(static_cast<uint32_t>(std::stoul(id, nullptr, 16)));
  std::vector<runtime::LogEntry> entries;
  std::set<std::string> buses;
  const auto other = [&](const auto&, LogPlace) { findings.leave_out(LeftOut::OtherBus); };
  read_log_file(flags.log, findings,
                {[&](const runtime::LogEntry& entry, LogPlace) {
                   if (!wanted.empty() && !wanted.contains(entry.frame.id)) return;
                   buses.insert(entry.bus);
                   entries.push_back(entry);
                 },
                 other,
                 other,
                 {}});
  const std::string path = compiler::printable(flags.log.path);
  if (buses.size() > 1 && flags.log.channels.empty())
    throw Failure(
        kUsage,
        fmt::format(
            "{}: {} buses are in the log, and a replay is for one line: choose with --channel from {}", path,
            buses.size(), bus_list(buses)));
  if (entries.empty() && (!findings.understood() || findings.left_out().of(LeftOut::OtherBus) != 0)) {
    findings.finish();
    throw Failure(kBadInput, findings.understood() ? path + ": no CAN frame is in it" : "");
  }
  return entries;
}

// In the order of time, without the pauses of a clock that was set or a recorder that slept.
void put_in_order(std::vector<runtime::LogEntry>& entries, const std::string& longest_gap,
                  LogFindings& findings) {
  const auto earlier = [](const runtime::LogEntry& a, const runtime::LogEntry& b) { return a.time < b.time; };
  if (!std::is_sorted(entries.begin(), entries.end(), earlier)) {
    std::stable_sort(entries.begin(), entries.end(), earlier);
    findings.note("its times go back; the frames are played in the order of time");
  }
  const Time longest = runtime::parse_duration(longest_gap);
  Time left_out = 0, before = entries.empty() ? 0 : entries.front().time;
  size_t gaps = 0;
  for (runtime::LogEntry& entry : entries) {
    const Time gap = entry.time - std::exchange(before, entry.time);
    if (gap > longest) {
      left_out += gap - longest;
      ++gaps;
    }
    entry.time -= left_out;
  }
  if (gaps != 0)
    findings.note(fmt::format("{} gap{} longer than {} {} played as {}, {} s are left out (--longest-gap)",
                              gaps, gaps == 1 ? "" : "s", longest_gap, gaps == 1 ? "is" : "are", longest_gap,
                              left_out / runtime::kSecond));
}

int replay(const ReplayFlags& flags) {
  LogFindings findings(flags.log.path);
  std::vector<runtime::LogEntry> entries = entries_of(flags, findings);
  put_in_order(entries, flags.longest_gap, findings);
  const auto plant = make_plant(read_plant_input(flags.plant, flags.compile), runtime::FileUse::Look);
  runtime::CanLine& line = line_of(*plant, flags);
  const Time begin = flags.begin.empty() ? 0 : runtime::parse_duration(flags.begin);
  runtime::Replay player(plant->queue(), plant->next_source(), std::move(entries), begin);
  runtime::LinePort port(line, line.attach("replay", line.baud(), player));
  player.start(port, line.bit_time());

  output_ending("--log", flags.record);
  LogOutput file(flags.record);
  std::unique_ptr<LogWriter> writer;
  std::optional<PlantLog> log;
  if (file.is_open()) {
    writer = make_log_writer(flags.record, file.stream());
    log.emplace(*plant, *writer);
  }
  const Time end = flags.duration.empty() ? player.end() + 100 * runtime::kMillisecond
                                          : runtime::parse_duration(flags.duration);
  plant->run_until(end);
  if (log) log->finish();
  writer.reset();
  file.finish();
  fmt::print("{}", text_report(*plant, watch_choice(flags.watch)));
  print_journal(*plant, flags.why);
  fmt::print("{} of {} frames replayed on {}\n", player.sent(), player.frames(), line.name());
  if (!findings.finish()) return kBadInput;
  return player.sent() == player.frames() ? kGood : kFindings;
}

std::string check_identifier(const std::string& text) {
  const bool good = !text.empty() && text.size() <= 8 &&
                    text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  return good ? "" : "'" + text + "' is no identifier; write it in hexadecimal as in the log";
}

}  // namespace

void add_bus_replay(cli::Verb& bus) {
  auto flags = std::make_shared<ReplayFlags>();
  cli::Verb& verb = bus.verb("replay", "put the frames of a CAN log on a simulated line at their times");
  verb.option("LOG", flags->log.path, "log, candump, pcap, pcapng, ASC, TRC or BLF; - is standard input")
      .required();
  verb.option("PLANT", flags->plant, "plant (.toml)").required();
  add_channel_option(verb, flags->log);
  verb.option("--bus", flags->bus, "line of the plant; default: the first one");
  verb.option("--id", flags->ids, "only frames with these identifiers, in hexadecimal")
      .separated_by(',')
      .check(check_identifier, "ID");
  verb.option("--at", flags->begin, "virtual time of the first frame, for example 50ms; default 0ms")
      .check(check_time, "TIME");
  verb.option("--for", flags->duration, "virtual time to run; default: 100ms longer than the log")
      .check(check_time, "TIME");
  verb.option("--longest-gap", flags->longest_gap,
              "a longer pause between two frames of the log is played as this one; default 1h")
      .check(check_time, "TIME");
  verb.option("--log", flags->record,
              "write the frames of all buses, in the form of its ending: .pcapng, .asc, .trc, else candump");
  verb.flag("--watch", flags->watch, "*", "show named variables at the end, all or --watch=NAME,...");
  verb.flag("--why", flags->why, "also tell what was ignored, and why");
  add_plant_options(verb, flags->compile);
  verb.footer("Example:\n  ipos bus replay can.log plant.toml --id 400,401 --watch");
  verb.runs([flags] { return replay(*flags); });
}

}  // namespace ipos::tools

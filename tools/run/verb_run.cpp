// ipos run: a program or a plant in virtual time, then the watch windows, the bus load and what went wrong.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <thread>

#include "runtime/bus/log/profibus_log.hpp"
#include "runtime/bus/log/serial_log.hpp"
#include "runtime/plant/plant.hpp"
#include "runtime/plant/trace_hash.hpp"
#include "stdlib/parameters.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/interrupt.hpp"
#include "tools/cli/output_forms.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/terminal.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/coverage/collector.hpp"
#include "tools/coverage/coverage_reports.hpp"
#include "tools/input/folder_plant.hpp"
#include "tools/input/mistakes.hpp"
#include "tools/input/offers.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_objects.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/input/program.hpp"
#include "tools/logs/log_writer.hpp"
#include "tools/profile/profiler.hpp"
#include "tools/recording/plot_html.hpp"
#include "tools/recording/plot_svg.hpp"
#include "tools/recording/recording.hpp"
#include "tools/recording/trace.hpp"
#include "tools/recording/trace_forms.hpp"
#include "tools/run/signal_list.hpp"
#include "tools/running/onlooker.hpp"
#include "tools/running/real_time_run.hpp"
#include "tools/running/run_report.hpp"
#include "tools/running/watch.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

struct RunFlags {
  std::string file;
  std::string duration;
  std::string until;
  uint32_t speed = 0;
  std::string engine;
  bool no_skip = false;
  unsigned threads = std::max(1U, std::thread::hardware_concurrency());
  std::string watch;
  std::string log;
  std::string plot;
  std::string trace;
  std::vector<std::string> signals;
  std::string serial_log;
  std::vector<std::string> coverage;
  std::string profile;
  std::string format = "text";
  bool realtime = false;
  bool attach = true;
  bool why = false;
  std::string trace_hash;
  CompileFlags compile;
};

// Asked once a virtual millisecond: shows progress and says when to stop.
class Watcher {
 public:
  Watcher(const RunFlags& flags, const runtime::Plant& plant, Time limit)
      : flags_(flags), plant_(plant), limit_(limit), show_(is_terminal(STDERR_FILENO)) {}
  ~Watcher() {
    if (shown_) fmt::print(stderr, "\r\033[K");
  }
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  bool keep_going(Time now) {
    if (interrupted()) return false;
    if (flags_.until == "end" && plant_.programs_over()) return false;
    if (show_ && now % (100 * runtime::kMillisecond) == 0) progress(now);
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void progress(Time now) {
    const auto wall = Clock::now();
    if (wall - last_shown_ < std::chrono::milliseconds(500)) return;
    last_shown_ = wall;
    shown_ = true;
    fmt::print(stderr, "\r{:.1f} s of {:.1f} s", static_cast<double>(now) / 1e9,
               static_cast<double>(limit_) / 1e9);
  }

  const RunFlags& flags_;
  const runtime::Plant& plant_;
  Time limit_;
  bool show_;
  bool shown_ = false;
  Clock::time_point last_shown_ = Clock::now();
};

// The logs of buses and lines, which others may read while they grow.
class Logs {
 public:
  Logs(runtime::Plant& plant, const RunFlags& flags) : file_(flags.log), serial_file_(flags.serial_log) {
    if (file_.is_open()) {
      writer_ = make_log_writer(flags.log, file_.stream());
      log_.emplace(plant, *writer_);
      if (log_->stays_empty())
        fmt::print(stderr,
                   "ipos: warning: {} stays empty: its form has CAN frames only, and the plant has no CAN; name it "
                   ".pcapng, or use --serial-log\n",
                   flags.log);
    }
    if (!serial_file_.is_open()) return;
    serial_log_.emplace(serial_file_.stream());
    profibus_log_.emplace(serial_file_.stream());
    for (const auto& bus : plant.buses())
      visit(
          *bus, [](runtime::CanBus&) {},  // its frames have logs of their own
          [this](runtime::SerialBus& serial) { serial.line().add_observer(*serial_log_); },
          [this](runtime::ProfibusBus& profibus) { profibus.line().add_observer(*profibus_log_); });
  }
  void flush() {
    file_.flush();
    serial_file_.flush();
  }
  void finish() {
    if (log_) log_->finish();
    if (serial_log_) serial_log_->finish();
    writer_.reset();
    file_.finish();
    serial_file_.finish();
  }

 private:
  LogOutput file_, serial_file_;
  std::unique_ptr<LogWriter> writer_;
  std::optional<PlantLog> log_;
  std::optional<runtime::SerialLog> serial_log_;
  std::optional<runtime::ProfibusLog> profibus_log_;
};

// The trace of the run, part by part; nothing for an empty path.
class TraceFile {
 public:
  TraceFile(const std::string& path, TraceForm form, std::optional<Recorder>& recorder, bool plots)
      : file_(path) {
    if (!file_.is_open()) return;
    writer_ = form(file_.stream(), recorder->signals(), recorder->tracks());
    recorder->give_to(*writer_, plots);
  }
  void flush() {
    if (writer_) writer_->flush();
    file_.flush();
  }
  // After Recorder::finish().
  void finish() {
    if (writer_) writer_->finish();
    file_.finish();
  }

 private:
  LogOutput file_;
  std::unique_ptr<TraceWriter> writer_;
};

// Virtual time in which nobody needs to be asked: a key and a log wait so long, at the pace of the clock a fiftieth of a
// second (ours). Whole stretches fit between two looks at the progress. Islands that run apart need a longer one: each
// begins with empty caches.
constexpr Time kStretch = 20 * runtime::kMillisecond;
constexpr Time kStretchApart = 10 * kStretch;

// When logs and traces are brought to their files.
class FlushTimer {
 public:
  // Asked at whole virtual milliseconds; it asks the clock itself once a stretch.
  bool due(Time virtual_now) {
    if (virtual_now % kStretch != 0) return false;
    const auto now = Clock::now();
    if (now - last_ < kLatest) return false;
    last_ = now;
    return true;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr auto kLatest = std::chrono::milliseconds(200);  // ours
  Clock::time_point last_ = Clock::now();
};

// "2000 (0x7d0)"; of a parameter with the text people read: "2.500 s".
std::string expected_text(const runtime::Plant& plant, const runtime::Signal& signal, int64_t value) {
  for (const auto& station : plant.stations()) {
    if (signal.kind != runtime::SignalKind::Parameter || station->config().name != signal.station) continue;
    const auto* row = stdlib::parameter_table(*station->config().unit).find(signal.name);
    if (row != nullptr) return stdlib::parameter_text(*row, static_cast<int32_t>(value));
  }
  if (signal.decimals > 0) return runtime::decimal_text(value, signal.decimals);
  return fmt::format("{} ({:#x})", value, static_cast<uint32_t>(value));
}

// Prints expectations that were not met or not reached; returns how many.
size_t print_expectations(const runtime::Plant& plant, const std::string& file) {
  size_t failed = 0;
  const auto print = [&](const runtime::Expectation& expectation, const std::string& what) {
    ++failed;
    fmt::print(stderr, "{}:{}:{}: expectation not met: {} of {} at {:.3f} ms: {}\n", file,
               expectation.place.line, expectation.place.column, expectation.signal.name,
               expectation.signal.station, static_cast<double>(expectation.at) / 1e6, what);
  };
  for (const runtime::ExpectationResult& result : plant.results())
    if (!result.met)
      print(*result.expectation,
            fmt::format("is {}, expected {}", expected_text(plant, result.expectation->signal, result.actual),
                        expected_text(plant, result.expectation->signal, result.expectation->equals)));
  for (const runtime::Expectation& expectation : plant.file().expectations)
    if (expectation.at > plant.now()) print(expectation, "the run ended before");
  const size_t total = plant.file().expectations.size();
  if (total != 0) fmt::print(stderr, "{} of {} expectations met\n", total - failed, total);
  if (const size_t others = plant.file().expectations_of_tests; others != 0)
    fmt::print(stderr, "{} more of kinds that `ipos test {}` looks at\n", others, file);
  return failed;
}

// Says which faults make the exit code 1; returns how many.
size_t print_faults(const runtime::Plant& plant, bool can_expect) {
  const auto stations = plant.unforeseen_faults();
  for (const runtime::Station* station : stations)
    fmt::print(stderr, "ipos: exit code 1: {} has fault F{:02}{}\n", station->config().name, station->fault(),
               can_expect ? ", which no [[expect]] looks for" : "");
  return stations.size();
}

// How often everything is looked at: of a whole number of milliseconds.
Time hash_step(const std::string& text) {
  const Time step = runtime::parse_duration(text);
  if (step < runtime::kMillisecond || step % runtime::kMillisecond != 0)
    throw Failure(kUsage, fmt::format("--trace-hash={}: must be whole milliseconds, for example 1ms", text));
  return step;
}

using Plotter = std::string (*)(const Recording&, const std::string& title);

// By the ending of the file's name.
Plotter plot_of(const std::string& path) {
  return output_ending("--plot", path).starts_with(".htm") ? plot_html : plot_svg;
}

// Nobody looks at each millisecond: a plant that stands still costs a sixth where it need not stop at each.
void run_in_stretches(runtime::Plant& plant, Time limit, const std::function<bool(Time)>& keep_going) {
  const Time stretch = plant.islands().count() > 1 ? kStretchApart : kStretch;
  do
    plant.run_until(std::min(limit, plant.now() + stretch));
  while (plant.now() < limit && keep_going(plant.now()));
}

// A log or a recording has what happens on all lines in its order, a profile the commands of all stations: then the lines
// do not run apart.
bool nobody_hears_all(const RunFlags& flags) {
  const auto files = {flags.log, flags.serial_log, flags.plot, flags.trace, flags.profile};
  return !flags.realtime && flags.coverage.empty() &&
         std::all_of(files.begin(), files.end(), [](const std::string& file) { return file.empty(); });
}

int run(const RunFlags& flags) {
  const Time limit = flags.duration.empty() ? 60 * runtime::kSecond : runtime::parse_duration(flags.duration);
  PlantInput input = read_plant_input(flags.file, flags.compile);
  if (!flags.realtime) refuse_ports(input.file, flags.file);
  std::optional<vm::Rates> rates;
  if (flags.speed != 0) rates = vm::Rates{{flags.speed, flags.speed, flags.speed}};
  runtime::Execution execution = execution_of(flags.engine);
  if (flags.no_skip || !flags.profile.empty()) execution.pace = runtime::Pace::InTurn;
  if (nobody_hears_all(flags)) execution.threads = flags.threads;
  const std::unique_ptr<runtime::Plant> built =
      make_plant(std::move(input), runtime::FileUse::Write, rates, execution);
  runtime::Plant& plant = *built;
  tell_objects(plant);

  if (flags.signals == std::vector<std::string>{"list"}) {
    fmt::print("{}", signal_list(plant, flags.format == "json"));
    return kGood;
  }
  if (!flags.signals.empty() && flags.plot.empty() && flags.trace.empty())
    throw Failure(kUsage, "--signals needs --plot or --trace");
  // What goes to standard output stands there alone; the report gives way.
  const auto files = {flags.log, flags.serial_log, flags.plot, flags.trace, flags.profile};
  const auto taking = std::count_if(files.begin(), files.end(), is_standard_output);
  if (taking > 1) throw Failure(kUsage, "only one file can go to standard output");
  const bool output_taken = taking != 0;
  CoverageReports coverage(flags.coverage, flags.format == "json" || output_taken);
  const TraceForm form = trace_form(output_ending("--trace", flags.trace));
  const Plotter plot = plot_of(flags.plot);
  output_ending("--log", flags.log);
  output_ending("--serial-log", flags.serial_log);
  std::optional<Recorder> recorder;
  if (!flags.plot.empty() || !flags.trace.empty()) recorder.emplace(plant, flags.signals);
  // Before the run: a long one must not end without its result.
  check_output(flags.plot);
  TraceFile trace(flags.trace, form, recorder, !flags.plot.empty());
  Logs logs(plant, flags);
  std::optional<coverage::Collector> collector;
  if (coverage.wanted()) {
    collector.emplace(plant);
    if (collector->empty())
      throw Failure(kBadInput, "--coverage: no station has a program that knows its source lines");
    coverage.check();
  }
  std::optional<profile::Profiler> profiler;
  if (!flags.profile.empty()) {
    if (coverage.wanted()) throw Failure(kUsage, "--profile and --coverage count the same commands: ask for one of them");
    profiler.emplace(plant);
    check_output(flags.profile);
  }

  std::optional<runtime::TraceHash> trace_hash;
  if (!flags.trace_hash.empty()) trace_hash.emplace(plant, hash_step(flags.trace_hash));

  const WatchChoice watch = watch_choice(flags.watch);
  watch_rows(plant, watch.names);  // a line keeps its telegrams from the first look on

  catch_interrupts();
  std::optional<RealTimeRun> real_time;
  if (flags.realtime) real_time.emplace(plant, flags.file);
  const std::unique_ptr<Onlooker> onlooker = flags.realtime && flags.attach ? onlooker_of(plant, flags.file) : nullptr;
  bool ports_there = true;
  {
    Watcher watcher(flags, plant, limit);
    FlushTimer flush;
    const auto keep_going = [&](Time now) {
      if (recorder) recorder->sample(now);
      if (trace_hash) trace_hash->sample(now);
      if (onlooker) onlooker->look();
      if (flush.due(now)) {
        logs.flush();
        trace.flush();
      }
      return watcher.keep_going(now);
    };
    if (real_time)
      ports_there = real_time->run(limit, keep_going);
    else if (recorder || trace_hash || flags.until == "end" || !plant.file().machines.empty())
      plant.run_until(limit, keep_going);
    else
      run_in_stretches(plant, limit, keep_going);
  }
  const bool stored = plant.store_memories();
  logs.finish();
  if (recorder) recorder->finish();
  if (!flags.plot.empty())
    replace_file(flags.plot, plot(recorder->recording(),
                                                 std::filesystem::path(flags.file).filename().string()));
  trace.finish();

  for (const std::string& name : watch.names)
    if (std::none_of(plant.stations().begin(), plant.stations().end(),
                     [&](const auto& station) { return !watch_rows(*station, {name}).empty(); }) &&
        watch_rows(plant, {name}).empty())
      fmt::print(stderr, "ipos: warning: no station has a variable or signal '{}'\n", name);
  fmt::print(output_taken ? stderr : stdout, "{}",
             flags.format == "json" ? json_report(plant, watch) : text_report(plant, watch));
  if (collector) coverage.write(collector->coverage());
  if (profiler)
    replace_file(flags.profile, flags.profile.ends_with(".json") ? profile::speedscope(profiler->tasks(), flags.file)
                                                                 : profile::table(profiler->tasks()));
  print_journal(plant, flags.why);
  if (trace_hash) fmt::print(stderr, "trace hash {}\n", trace_hash->text());
  print_mistakes(flags.file, plant.machines().failures());
  const size_t unmet = print_expectations(plant, flags.file) + plant.machines().failures().size();
  if (interrupted()) return kInterrupted;
  if (!ports_there || !stored) return kIoError;
  return print_faults(plant, is_plant(flags.file)) + unmet != 0 ? kFindings : kGood;
}

}  // namespace

void add_run(cli::Verb& app) {
  auto flags = std::make_shared<RunFlags>();
  cli::Verb& verb = app.verb("run", "run a program or a plant in virtual time");
  verb.option("FILE", flags->file, "source (.IPC), image (.ipx), plant (.toml) or folder; default: the only plant of this folder");
  verb.option("--for", flags->duration, "virtual time to run, for example 500ms; default 60s")
      .check(check_time, "TIME");
  verb.option("--until", flags->until, "'end': stop when every program has ended").one_of({"end"});
  verb.option("--speed", flags->speed, "commands per ms of every task, instead of P938 and P939")
      .between(1U, 1'000'000U);
  add_engine_option(verb, flags->engine);
  verb.flag("--no-skip", flags->no_skip,
            "execute every millisecond in its turn, also where nothing happens, with equal results");
  verb.option("--threads", flags->threads,
              "threads for buses that nothing joins, with equal results; default: the number of cores")
      .between(1U, 1024U);
  verb.flag("--watch", flags->watch, "*",
            "show named variables at the end, all or --watch=NAME,..., also other signals");
  verb.option(
      "--log", flags->log,
      "write the frames of all buses, in the form of its ending: .pcapng (RS-485 and PROFIBUS, too), .asc, .trc, else "
      "candump; - is standard output");
  verb.option("--serial-log", flags->serial_log,
              "write the telegrams of all RS-485 lines; - is standard output");
  verb.option("--plot", flags->plot,
              "draw signals over time: .svg, or .html with zoom and cursors; - is standard output");
  verb.option("--trace", flags->trace, "write signals over time: .csv, .vcd, .jsonl, or .ipos-trace, packed and quick");
  verb.option("--signals", flags->signals,
              "what to plot and trace, for example unit1.speed,unit1.D*,unit1.H500,sbus1.frames; default: "
              "speed, setpoint and status of every station; 'list' prints what there is")
      .separated_by(',')
      .one_each()
      .offers(offered_signals);
  add_coverage_option(verb, flags->coverage);
  verb.option("--profile", flags->profile,
              "write where the commands went: .json for speedscope, else a table of lines; - is standard output");
  verb.option("--format", flags->format, "text or json").one_of({"text", "json"});
  verb.flag("--trace-hash", flags->trace_hash,
            fmt::format("{}ms", runtime::TraceHash::kStep / runtime::kMillisecond),
            "print one number over all frames, telegrams and drives, to compare runs and builds; looks at "
            "everything each 100 ms, or =1ms, ...");
  verb.flag("--realtime", flags->realtime,
            "keep pace with the clock, and join buses that have a port to the real world");
  verb.off("--no-attach", flags->attach, "with --realtime: nobody can look at the run (ipos debug --attach)");
  verb.flag("--why", flags->why, "also tell what was ignored, and why");
  add_plant_options(verb, flags->compile);
  verb.footer("Example:\n  ipos run examples/scom/scom.toml --for 1s --watch --log can.log");
  verb.runs([flags] {
    flags->file = plant_or_program(flags->file);
    return run(*flags);
  });
}

}  // namespace ipos::tools

// ipos run: a program or a plant in virtual time, then the watch windows, the bus load and what went wrong.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <thread>

#include "runtime/bus/log/candump.hpp"
#include "runtime/plant/plant.hpp"
#include "tools/failure.hpp"
#include "tools/plant_input.hpp"
#include "tools/run_report.hpp"
#include "tools/verbs.hpp"
#include "tools/watch.hpp"

namespace ipos::tools {
namespace {

using runtime::Time;

struct RunFlags {
  std::string file;
  std::string duration;
  std::string until;
  uint32_t speed = 0;
  std::string watch;
  std::string log;
  std::string format = "text";
  bool realtime = false;
  bool why = false;
  CompileFlags compile;
};

volatile std::sig_atomic_t interrupted = 0;
void on_interrupt(int) { interrupted = 1; }

// Asked once a virtual millisecond: keeps pace with the wall clock, shows progress, and says when to stop.
class Pace {
 public:
  Pace(const RunFlags& flags, const runtime::Plant& plant, Time limit)
      : flags_(flags), plant_(plant), limit_(limit), show_(isatty(STDERR_FILENO) != 0) {}
  ~Pace() {
    if (shown_) fmt::print(stderr, "\r\033[K");
  }
  Pace(const Pace&) = delete;
  Pace& operator=(const Pace&) = delete;

  bool keep_going(Time now) {
    if (interrupted != 0) return false;
    if (flags_.until == "end" && plant_.programs_over()) return false;
    if (flags_.realtime) std::this_thread::sleep_until(start_ + std::chrono::nanoseconds(now));
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
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_ = start_;
};

// Prints expectations that were not met or not reached; returns how many.
size_t print_expectations(const runtime::Plant& plant, const std::string& file) {
  size_t failed = 0;
  const auto print = [&](const runtime::Expectation& expectation, const std::string& what) {
    ++failed;
    fmt::print(stderr, "{}:{}:{}: expectation not met: {} of {} at {:.3f} ms: {}\n", file,
               expectation.place.line, expectation.place.column, expectation.variable, expectation.station,
               static_cast<double>(expectation.at) / 1e6, what);
  };
  for (const runtime::ExpectationResult& result : plant.results())
    if (!result.met)
      print(*result.expectation, fmt::format("is {} ({:#x}), expected {} ({:#x})", result.actual,
                                             static_cast<uint32_t>(result.actual), result.expectation->equals,
                                             static_cast<uint32_t>(result.expectation->equals)));
  for (const runtime::Expectation& expectation : plant.file().expectations)
    if (expectation.at > plant.now()) print(expectation, "the run ended before");
  const size_t total = plant.file().expectations.size();
  if (total != 0) fmt::print(stderr, "{} of {} expectations met\n", total - failed, total);
  return failed;
}

int run(const RunFlags& flags) {
  const Time limit = flags.duration.empty() ? 60 * runtime::kSecond : runtime::parse_duration(flags.duration);
  PlantInput input = read_plant_input(flags.file, flags.compile);
  std::optional<vm::Rates> rates;
  if (flags.speed != 0) rates = vm::Rates{{flags.speed, flags.speed, flags.speed}};
  const std::unique_ptr<runtime::Plant> built = make_plant(std::move(input), rates);
  runtime::Plant& plant = *built;

  std::ofstream log_file;
  std::optional<runtime::CandumpLog> log;
  if (!flags.log.empty()) {
    log_file.open(flags.log, std::ios::binary);
    if (!log_file) throw Failure(kIoError, fmt::format("{}: cannot be written", flags.log));
    log.emplace(log_file);
    plant.add_observer(*log);
  }

  std::signal(SIGINT, on_interrupt);
  {
    Pace pace(flags, plant, limit);
    plant.run_until(limit, [&](Time now) { return pace.keep_going(now); });
  }
  if (log && !log_file.flush()) throw Failure(kIoError, fmt::format("{}: cannot be written", flags.log));

  const WatchChoice watch = watch_choice(flags.watch);
  for (const std::string& name : watch.names)
    if (std::none_of(plant.stations().begin(), plant.stations().end(),
                     [&](const auto& station) { return !watch_rows(*station, {name}).empty(); }))
      fmt::print(stderr, "ipos: warning: no station has a variable '{}'\n", name);
  fmt::print("{}", flags.format == "json" ? json_report(plant, watch) : text_report(plant, watch));
  print_journal(plant, flags.why);
  const size_t unmet = print_expectations(plant, flags.file);
  if (interrupted != 0) return kInterrupted;
  return unmet != 0 || plant.has_fault() ? kFindings : kGood;
}

std::string check_duration(const std::string& text) {
  return runtime::parse_duration(text) < 0 ? "'" + text + "' is no time; write for example 500ms or 1.5s"
                                           : "";
}

}  // namespace

void add_run(CLI::App& app, int& exit_code) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* verb = app.add_subcommand("run", "run a program or a plant in virtual time");
  verb->add_option("FILE", flags->file, "source (.IPC), image (.ipx) or plant (.toml)")->required();
  verb->add_option("--for", flags->duration, "virtual time to run, for example 500ms; default 60s")
      ->check(CLI::Validator(check_duration, "TIME"));
  verb->add_option("--until", flags->until, "'end': stop when every program has ended")
      ->check(CLI::IsMember({"end"}));
  verb->add_option("--speed", flags->speed, "commands per ms of every task, instead of P938 and P939")
      ->check(CLI::Range(1U, 1'000'000U));
  verb->add_flag("--watch{*}", flags->watch, "show named variables at the end, all or --watch=NAME,...");
  verb->add_option("--log", flags->log, "write the frames of all buses in candump format");
  verb->add_option("--format", flags->format, "text or json")->check(CLI::IsMember({"text", "json"}));
  verb->add_flag("--realtime", flags->realtime, "keep pace with the wall clock");
  verb->add_flag("--why", flags->why, "also tell what was ignored, and why");
  add_compile_options(*verb, flags->compile);
  verb->footer("Example:\n  ipos run examples/scom/scom.toml --for 1s --watch --log can.log");
  verb->callback([flags, &exit_code] { exit_code = run(*flags); });
}

}  // namespace ipos::tools

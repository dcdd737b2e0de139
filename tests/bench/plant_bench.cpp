// How many seconds of a plant one second of CPU time simulates: up to 64 MOVIDRIVE B on one SBus of 1 Mbit/s
// near 70 % load, each with three busy tasks and a moving axis, or with programs that only wait, executed as
// `ipos run` does it. Counts frames, commands and the memory taken from the heap once everything runs.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "runtime/plant/plant.hpp"
#include "tests/harness/allocations.hpp"
#include "tools/input/engine.hpp"

namespace ipos {
namespace {

// Every drive sends seven bytes each 10 ms: 64 of them are 6400 frames a second.
constexpr const char* kObjects = R"(
#include <const.h>
SCTRCYCL TrCycl;
long lTrLow;
long lTrHigh;
SCREC Rec;
long lReLow;
long lReHigh;
long lWork;
long lSteps;
long lState;

Objects()
{{
  TrCycl.ObjectNo = {0};
  TrCycl.CycleTime = 10;
  TrCycl.Offset = 0;
  TrCycl.Format = 7;
  TrCycl.DPointer = numof(lTrLow);
  _SBusCommDef(SCD_TRCYCL, TrCycl);
  Rec.ObjectNo = {1};
  Rec.Format = 7;
  Rec.DPointer = numof(lReLow);
  _SBusCommDef(SCD_REC, Rec);
  _SBusCommOn();
}}
)";

// Tasks 2 and 3 of the busy programs.
constexpr const char* kTasks = R"(
Sequence()
{
  while (1)
  {
    lSteps++;
    switch (lState) {
      case 0: if (lReLow > 10) lState = 1; break;
      case 1: lWork = lWork + lReHigh; lState = 2; break;
      case 2: if (lWork < 0) lWork = 0; lState = 0; break;
    }
  }
}

Filter()
{
  while (1)
  {
    lTrHigh = (lTrHigh * 7 + lReLow) / 8;
  }
}

Start()
{
  Objects();
  _SetTask2(T2_START, Sequence);
  _SetTask(T2_START, Filter);
}
)";

constexpr const char* kTurning = R"(
main()
{
  Start();
  while (1)
  {
    lTrLow = lTrLow + 1;
  }
}
)";

// Never at a constant speed for long.
constexpr const char* kTravelling = R"(
main()
{
  Start();
  while (1)
  {
    lTrLow = lTrLow + 1;
    if (H473 & 0x80000) {
      if (H492 == 0) _GoAbs(GO_NOWAIT, 20000);
      else _GoAbs(GO_NOWAIT, 0);
    }
  }
}
)";

constexpr const char* kIdle = R"(
main()
{
  Objects();
  while (1)
  {
  }
}
)";

struct Kind {
  std::string_view name;
  std::vector<const char*> program;
  const char* settings;
};
#define ENABLED "[station.inputs]\nDI00 = 1\nDI01 = 1\nDI03 = 1\nDI04 = 1\n"
const Kind kKinds[] = {{"busy", {kTasks, kTurning}, "P130 = 500\nP160 = 1000000\n" ENABLED},
                       {"travel", {kTasks, kTravelling}, "P700 = 13\nP911 = 300\nP912 = 300\n" ENABLED},
                       {"idle", {kIdle}, ""}};

// Plant file and programs, that of unit N as PN.IPC.
struct Project {
  std::string text = "[[bus]]\nname = \"sbus\"\nkind = \"can\"\nbaud = 1000000\n";
  std::vector<std::string> sources{};
};

Project project_of(const Kind& kind, int drives, bool bus) {
  Project project;
  for (int n = 0; n < drives; ++n) {
    project.text += fmt::format(
        "[[station]]\nname = \"unit{0}\"\nunit = \"mdxb\"\nprogram = \"P{0}.IPC\"\nsbus = \"sbus\"\n"
        "[station.parameters]\nP881 = {0}\nP884 = 3\n{1}",
        n, kind.settings);
    std::string program = bus ? fmt::format(fmt::runtime(kObjects), 1100 + n, 1100 + (n + 1) % drives)
                              : "long lWork; long lTrLow; long lTrHigh; long lReLow; long lReHigh; long "
                                "lSteps; long lState;\nObjects() {}\n#include <const.h>\n";
    for (const char* part : kind.program) program += part;
    project.sources.push_back(std::move(program));
  }
  return project;
}

std::unique_ptr<runtime::Plant> make(const Kind& kind, int drives, bool bus,
                                     const runtime::Execution& execution) {
  const Project project = project_of(kind, drives, bus);
  std::vector<std::optional<vm::Image>> programs;
  for (const std::string& source : project.sources) {
    compiler::CompileOptions options;
    options.unit = stdlib::find_unit("mdxb");
    const auto made = compiler::compile("P.IPC", "", source, options);
    if (!made.image) {
      fmt::print(stderr, "{}", compiler::render_text(made.diagnostics.all(), *made.sources, false));
      std::exit(1);
    }
    programs.push_back(made.image);
  }
  runtime::PlantFileResult file = runtime::read_plant_file(project.text);
  for (const auto& error : file.errors) fmt::print(stderr, "{}: {}\n", error.place.line, error.text);
  std::vector<runtime::PlantError> errors;
  auto plant = std::make_unique<runtime::Plant>(std::move(file.plant), std::move(programs), std::nullopt,
                                                errors, execution);
  for (const auto& error : errors) fmt::print(stderr, "{}: {}\n", error.place.line, error.text);
  if (!errors.empty()) std::exit(1);
  return plant;
}

// As files, for `ipos run`.
void write(const std::filesystem::path& folder, const Project& project) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "plant.toml") << project.text;
  for (size_t n = 0; n < project.sources.size(); ++n)
    std::ofstream(folder / fmt::format("P{}.IPC", n)) << project.sources[n];
}

struct Frames final : runtime::CanObserver {
  void on_frame(const runtime::CanLine&, const runtime::FrameRecord&) override { ++count; }
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
  uint64_t count = 0;
};

uint64_t commands(runtime::Plant& plant) {
  uint64_t sum = 0;
  for (const auto& station : plant.stations())
    for (int context = 1; context <= vm::kContexts; ++context)
      sum += station->machine()->context(context).commands;
  return sum;
}

// Of this thread, so that other work on the machine counts only for what it does to the caches.
double cpu_seconds() {
  timespec used{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + static_cast<double>(used.tv_nsec) * 1e-9;
}

// In place of an engine: every tick in its turn, as with ipos run --no-skip.
constexpr std::string_view kInTurn = "in-turn";

void measure(const Kind& kind, int drives, bool bus, int seconds, const std::string& engine = {}) {
  runtime::Execution execution = tools::execution_of(engine == kInTurn ? "" : engine);
  if (engine == kInTurn) execution.pace = runtime::Pace::InTurn;
  const auto plant = make(kind, drives, bus, execution);
  Frames frames;
  plant->add_observer(frames);
  plant->run_until(runtime::kSecond);  // everything runs, no vector grows any more
  const uint64_t frames_before = frames.count;
  const uint64_t commands_before = commands(*plant);
  const size_t allocations_before = tests::allocations();
  const double begin = cpu_seconds();
  plant->run_until((1 + seconds) * runtime::kSecond);
  const double used = cpu_seconds() - begin;
  fmt::print(
      "{:7}{:10} {:3} drives: {:8.1f} simulated s per CPU s, {:6} frames/s, {:8} commands/s, {:.2f} "
      "allocations/s\n",
      kind.name, bus ? ", frames" : "", drives, seconds / used,
      (frames.count - frames_before) / static_cast<uint64_t>(seconds),
      (commands(*plant) - commands_before) / static_cast<uint64_t>(seconds),
      static_cast<double>(tests::allocations() - allocations_before) / seconds);
  std::fflush(stdout);
}

// How long one thread after the other would be busy if each took the next line that nobody has begun, as runtime/plant/crew does, and
// all waited for the last one.
double time_of_turn(const std::vector<double>& lines, size_t threads) {
  std::vector<double> busy(threads);
  for (const double line : lines) *std::min_element(busy.begin(), busy.end()) += line;
  return *std::max_element(busy.begin(), busy.end());
}

// What more cores could give at most: each line of `drives` is a plant that runs a turn of `ipos run` before the next one does, and the
// measured times are dealt out. What cores take from each other, caches and memory, is not in it.
void simulate_schedule(const Kind& kind, int drives, size_t lines, int seconds) {
  constexpr runtime::Time kTurn = 200 * runtime::kMillisecond;  // kStretchApart of tools/run
  constexpr double kWake = 10e-6;                               // s, as runtime/plant/islands has it
  std::vector<std::unique_ptr<runtime::Plant>> plants;
  for (size_t n = 0; n < lines; ++n) {
    plants.push_back(make(kind, drives, true, tools::execution_of("")));
    plants.back()->run_until(runtime::kSecond);
  }
  constexpr size_t kThreads[] = {1, 2, 4, 8, 16, 32, 64};
  std::map<size_t, double> sums;
  for (runtime::Time end = runtime::kSecond + kTurn; end <= (1 + seconds) * runtime::kSecond; end += kTurn) {
    std::vector<double> times;
    for (const auto& plant : plants) {
      const double begin = cpu_seconds();
      plant->run_until(end);
      times.push_back(cpu_seconds() - begin);
    }
    for (const size_t threads : kThreads) sums[threads] += time_of_turn(times, threads) + (threads > 1 ? kWake : 0);
  }
  for (const auto& [threads, sum] : sums)
    fmt::print("{:7}{} lines of {} drives, {:2} threads: {:6.2f} times as fast as one\n", kind.name, lines, drives, threads,
               sums[1] / sum);
}

}  // namespace
}  // namespace ipos

// ipos_bench_plant [SECONDS [DRIVES busy|travel|idle [ENGINE|in-turn]]]
// ipos_bench_plant write FOLDER     the plants of 64 drives as files, a folder each
// ipos_bench_plant schedule SECONDS DRIVES LINES     so many lines with so many drives each, dealt out to up to 64 threads
int main(int argc, char** argv) {
  using ipos::kKinds;
  if (argc == 3 && std::string_view(argv[1]) == "write") {
    for (const ipos::Kind& kind : kKinds)
      ipos::write(std::filesystem::path(argv[2]) / kind.name, ipos::project_of(kind, 64, true));
    return 0;
  }
  if (argc == 5 && std::string_view(argv[1]) == "schedule") {
    for (const ipos::Kind& kind : kKinds)
      ipos::simulate_schedule(kind, std::atoi(argv[3]), static_cast<size_t>(std::atoi(argv[4])), std::atoi(argv[2]));
    return 0;
  }
  const int seconds = argc > 1 ? std::atoi(argv[1]) : 10;
  if (argc > 3) {
    for (const ipos::Kind& kind : kKinds)
      if (kind.name == argv[3])
        ipos::measure(kind, std::atoi(argv[2]), true, seconds, argc > 4 ? argv[4] : "");
    return 0;
  }
  for (const ipos::Kind& kind : kKinds)
    for (const bool bus : {true, false}) ipos::measure(kind, 64, bus, seconds);
  // Alone on its bus it would repeat a frame that nobody acknowledges.
  ipos::measure(kKinds[0], 1, false, seconds * 10);
}

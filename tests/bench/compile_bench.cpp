// ipos_bench_compile [--source [STATIONS]] [--once] [--most-allocations N] [--start COMMAND...]
// Compiles the long program of dense_program.hpp again and again and prints time and heap allocations of one
// compilation. --source prints the program instead, or one of as many stations, --once compiles it once (for callgrind),
// --most-allocations fails when there are more than N. --start runs a command many times and prints what its
// process takes from start to end.
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "compiler/compile.hpp"
#include "compiler/diag/render.hpp"
#include "tests/bench/dense_program.hpp"
#include "tests/harness/allocations.hpp"

namespace {

using namespace ipos;  // NOLINT

constexpr size_t kRounds = 200;

// Least and middle of many rounds, in milliseconds: other work on the machine makes rounds longer, never
// shorter.
struct Times {
  double least;
  double median;
};

template <typename Work>
Times measure(Work&& work) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  for (size_t n = 0; n < kRounds; ++n) {
    const auto begin = Clock::now();
    work();
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  }
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2]};
}

compiler::Compilation compile(const std::string& source) {
  return compiler::compile("dense.IPC", "", source);
}

int run_command(char** command) {
  bool good = true;
  const Times times = measure([&] {
    pid_t child = 0;
    int status = 0;
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", 1 /* O_WRONLY */, 0);
    good = posix_spawnp(&child, command[0], &quiet, nullptr, command, environ) == 0 &&
           waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0 && good;
    posix_spawn_file_actions_destroy(&quiet);
  });
  std::printf("%s: %.2f ms from start to end, median %.2f ms of %zu\n", command[0], times.least, times.median,
              kRounds);
  return good ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string_view mode = argc > 1 ? argv[1] : "";
  if (mode == "--start" && argc > 2) return run_command(argv + 2);
  const int stations = mode == "--source" && argc > 2 ? std::atoi(argv[2]) : bench::kDenseStations;
  const std::string source = bench::dense_program(stations);
  if (mode == "--source") return std::fputs(source.c_str(), stdout) < 0;

  const size_t before = tests::allocations();
  const compiler::Compilation first = compile(source);
  const size_t used = tests::allocations() - before;
  if (!first.image || !first.diagnostics.all().empty()) {
    std::fputs(compiler::render_text(first.diagnostics.all(), *first.sources, false).c_str(), stderr);
    return 1;
  }
  std::printf("%td lines, %zu code words, %zu heap allocations\n",
              std::count(source.begin(), source.end(), '\n'), first.image->code.size(), used);
  if (mode == "--once") return 0;
  if (mode == "--most-allocations" && argc > 2) return used <= std::strtoul(argv[2], nullptr, 10) ? 0 : 1;
  const Times times = measure([&] { static_cast<void>(compile(source)); });
  std::printf("compiled in %.2f ms, median %.2f ms of %zu\n", times.least, times.median, kRounds);
  return 0;
}

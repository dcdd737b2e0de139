// Recorded are speed, setpoint and status of every station, what the test looks at and sets, and the buses.
#include "tools/testing/artifacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "runtime/bus/log/unique_names.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/logs/log_writer.hpp"
#include "tools/recording/plot_html.hpp"
#include "tools/recording/recording.hpp"
#include "tools/recording/trace.hpp"
#include "tools/testing/failed_state.hpp"
#include "tools/testing/reports.hpp"

namespace ipos::tools::testing {
namespace {

struct TraceFile {
  const char* name;
  TraceForm form;
};
constexpr TraceFile kTraces[] = {{"trace.csv", csv_trace}, {"trace.vcd", vcd_trace}};

// What the items of a test name, as far as it is a signal.
std::vector<std::string> names_in(const TestCase& test) {
  std::vector<std::string> names;
  const auto add = [&](const runtime::Signal& signal) {
    if (!signal.station.empty() && !signal.name.empty()) names.push_back(signal.station + "." + signal.name);
  };
  for (const Item& item : test.items) {
    if (const auto* expect = std::get_if<Expect>(&item.what)) {
      if (!expect->subject.is_event()) add(expect->subject.signal);
    } else if (const auto* stimulus = std::get_if<runtime::Stimulus>(&std::get<Step>(item.what))) {
      add(stimulus->signal);
    }
  }
  return names;
}

std::vector<std::string> signals_of(const TestCase& test, const runtime::Plant& plant) {
  std::vector<std::string> wanted;
  for (const auto& station : plant.stations())
    for (signals::Signal& signal : signals::default_signals(*station)) wanted.push_back(std::move(signal.name));
  for (const std::string& name : names_in(test)) wanted.push_back(name);
  std::vector<std::string> names;
  for (const std::string& name : wanted)
    if (std::find(names.begin(), names.end(), name) == names.end() && signals::find_signals(plant, name))
      names.push_back(name);
  for (const auto& bus : plant.buses()) names.push_back(bus->name() + ".frames");
  return names;
}

// Records one run of a test; writes when it is over, while the plant is still there.
class Witness {
 public:
  Witness(runtime::Plant& plant, const TestCase& test, std::string folder)
      : plant_(plant),
        test_(test),
        folder_(std::move(folder)),
        recorder_(plant, signals_of(test, plant)),
        writer_(make_log_writer("bus.pcapng", log_)),
        bus_(plant, *writer_) {}

  void sample(Time now) {
    if (now <= sampled_) return;
    sampled_ = now;
    recorder_.sample(now);
  }

  void write() {
    recorder_.finish();
    bus_.finish();
    const auto file = [&](const char* name) { return folder_ + "/" + name; };
    replace_file(file("plot.html"), plot_html(recorder_.recording(), test_.name));
    for (const auto& [name, form] : kTraces) {
      std::ostringstream trace;
      write_trace(form, trace, recorder_.recording());
      replace_file(file(name), std::move(trace).str());
    }
    replace_file(file("bus.pcapng"), std::move(log_).str());
    std::string journal;
    for (const runtime::JournalEntry& entry : plant_.journal().entries())
      journal += fmt::format("{:>14}  {}{}{}\n", time_text(entry.time), entry.station,
                             entry.station.empty() ? "" : ": ", entry.text);
    replace_file(file("journal.txt"), journal);
  }

 private:
  runtime::Plant& plant_;
  const TestCase& test_;
  std::string folder_;
  std::ostringstream log_;
  Recorder recorder_;
  std::unique_ptr<LogWriter> writer_;
  PlantLog bus_;
  Time sampled_ = 0;
};

// What cannot be kept leaves a text that says why.
void keep_state(const std::string& folder, const TestCase& test, const TestResult& result, const SuiteOptions& options,
                uint64_t seed) {
  RunOptions run;
  run.speed = options.run.speed;
  run.seed = seed;
  const auto first = std::min_element(result.findings.begin(), result.findings.end(),
                                      [](const Finding& a, const Finding& b) { return a.time < b.time; });
  try {
    replace_file(folder + "/state.ipos", failed_state(test, options.compile, run, first->time));
  } catch (const Failure& failure) {
    replace_file(folder + "/no-state.txt", fmt::format("{}\n", failure.what()));
  }
}

}  // namespace

std::vector<std::string> artifact_folders(const std::vector<TestResult>& results) {
  constexpr size_t kLongest = 200;  // file systems take 255 bytes
  runtime::UniqueNames unique(kLongest);
  std::vector<std::string> folders;
  for (size_t n = 0; n < results.size(); ++n) {
    std::string name = results[n].name;
    for (char& c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
    if (name.empty() || name[0] == '.') name.insert(0, "_");
    folders.push_back(unique.of(fmt::format("{}", n), name));
  }
  return folders;
}

void write_artifacts(const std::string& folder, const std::vector<TestCase>& tests,
                     const std::vector<TestResult>& results, const SuiteOptions& options) {
  Programs programs(options.compile);
  const std::vector<std::string> folders = artifact_folders(results);
  for (size_t n = 0; n < results.size(); ++n) {
    const TestResult& result = results[n];
    if (result.outcome != Outcome::Failed && result.outcome != Outcome::Malformed) continue;
    const std::string own = folder + "/" + folders[n];
    std::filesystem::create_directories(own);
    replace_file(own + "/report.txt", text_of(result));
    if (result.outcome == Outcome::Malformed) continue;
    const TestCase& test = tests[n % tests.size()];
    RunOptions again = options.run;
    again.seed += n / tests.size();
    std::weak_ptr<Witness> present;
    again.prepare = [&](runtime::Plant& plant) -> std::shared_ptr<void> {
      const auto witness = std::make_shared<Witness>(plant, test, own);
      present = witness;
      return witness;
    };
    again.sample = [&](Time now) {
      if (const auto witness = present.lock()) witness->sample(now);
    };
    again.finish = [&] {
      if (const auto witness = present.lock()) witness->write();
    };
    run_test(test, programs, again);
    if (!result.findings.empty()) keep_state(own, test, result, options, again.seed);
  }
}

}  // namespace ipos::tools::testing

// What the subcommands of `ipos bus` read: logs and dictionaries.
#include <fmt/format.h>

#include "runtime/bus_plan/names.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

size_t read_log_file(const std::string& path, LogReader reader) {
  size_t bad = 0;
  reader.wrong = [&](LogPlace place, const std::string& message) {
    ++bad;
    fmt::print(stderr, "{}: error: {}\n", place_text(path, place), message);
  };
  read_log(read_file(path, kLogLimit), reader);
  return bad;
}

size_t read_frames(const std::string& path, const std::function<void(const runtime::LogEntry&)>& take) {
  size_t others = 0;
  const auto other = [&](const auto&, LogPlace place) {
    ++others;
    fmt::print(stderr, "{}: error: no CAN frame\n", place_text(path, place));
  };
  return read_log_file(path,
                       {[&](const runtime::LogEntry& entry, LogPlace) { take(entry); }, other, other, {}}) +
         others;
}

namespace {

std::unique_ptr<runtime::Plant> trial_run(const std::string& path, const CompileFlags& compile) {
  auto plant = make_plant(read_plant_input(path, compile, "sbus"), runtime::FileUse::Look);
  plant->run_until(runtime::PlanOptions{}.trial);
  return plant;
}

}  // namespace

runtime::CanNames can_names_of(const NamesFlags& flags) {
  runtime::CanNames names;
  if (!flags.plant.empty()) names = runtime::can_names(*trial_run(flags.plant, flags.compile));
  names.canopen = flags.canopen;
  return names;
}

runtime::TelegramNames names_of(const std::string& path, const CompileFlags& compile) {
  return path.empty() ? runtime::TelegramNames{} : runtime::telegram_names(*trial_run(path, compile));
}

runtime::TelegramNames serial_names_of(const std::string& path, const CompileFlags& compile) {
  return path.empty() ? runtime::TelegramNames{} : runtime::serial_names(*trial_run(path, compile));
}

void add_names_options(cli::Verb& verb, NamesFlags& flags) {
  verb.option("--names,--plant,--program", flags.plant,
              "plant or program whose stations, parameters and variables are named");
  verb.flag("--canopen", flags.canopen, "the frames are those of CANopen nodes, also where no plant says so");
  add_compile_options(verb, flags.compile);
}

}  // namespace ipos::tools

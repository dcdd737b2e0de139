// What the subcommands of `ipos bus` read: logs and dictionaries.
#include <fmt/format.h>

#include "runtime/bus_plan/names.hpp"
#include "runtime/bus_plan/plan.hpp"
#include "tools/bus/bus_verbs.hpp"
#include "tools/cli/files.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/program.hpp"

namespace ipos::tools {

size_t read_lines(const std::string& path, const TakeLine& take) {
  const std::string text = read_file(path, kLogLimit);
  std::string_view rest = text;
  size_t bad = 0;
  for (size_t line = 1; !rest.empty(); ++line) {
    const size_t end = rest.find('\n');
    const std::string_view row = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
    if (row.find_first_not_of(" \t\r") == std::string_view::npos) continue;
    const auto error = take(row, line);
    if (!error) continue;
    ++bad;
    fmt::print(stderr, "{}:{}:{}: error: {}\n", path, error->line, error->column, error->message);
  }
  return bad;
}

size_t read_log(const std::string& path, const std::function<void(const runtime::LogEntry&, size_t)>& take) {
  return read_lines(path, [&](std::string_view row, size_t line) -> std::optional<runtime::LogError> {
    const auto entry = runtime::parse_candump_line(row, line);
    if (!entry) return entry.error();
    take(*entry, line);
    return std::nullopt;
  });
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

std::string check_time(const std::string& text) {
  return runtime::parse_duration(text) < 0 ? "'" + text + "' is no time; write for example 500ms or 1.5s"
                                           : "";
}

}  // namespace ipos::tools

// ipos fmu: a plant as an FMU, for other simulators.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "compiler/diag/places.hpp"
#include "runtime/fmi/package.hpp"
#include "runtime/plant/plant.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/notices.hpp"
#include "tools/cli/outputs.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/fmu/bus_terminals.hpp"
#include "tools/fmu/description.hpp"
#include "tools/fmu/libraries.hpp"
#include "tools/fmu/zip.hpp"
#include "tools/input/offers.hpp"
#include "tools/input/plant_input.hpp"
#include "tools/input/plant_source.hpp"

namespace ipos::tools {
namespace {

namespace fs = std::filesystem;

struct FmuFlags {
  std::string file;
  std::string output;
  std::string version;
  std::string bus;
  uint32_t terminals = 2;
  fmi::Choice choice;
  bool sources = false;
  CompileFlags compile;
};

// Of a single program: a plant of its station.
std::string text_of(const PlantInput& input) {
  if (is_plant(input.path)) return read_file(input.path);
  const runtime::StationConfig& station = input.file.stations.front();
  return fmt::format("[[station]]\nname = \"{}\"\nunit = \"{}\"\nprogram = \"{}\"\n", station.name, station.unit->name,
                     fs::path(input.path).filename().string());
}

// Names of sources in an image are for messages; their folders are nobody's business.
vm::Image without_folders(vm::Image image) {
  for (std::string& file : image.files) file = fs::path(file).filename().string();
  return image;
}

fmi::Package package_of(const PlantInput& input, const FmuFlags& flags) {
  fmi::Package package;
  package.plant = text_of(input);
  package.choice = flags.choice;
  if (package.choice.line) return package;
  for (size_t n = 0; n < input.file.stations.size(); ++n) {
    fmi::Package::Station& station = package.stations.emplace_back();
    if (input.programs[n]) station.program = without_folders(*input.programs[n]);
    const std::string& memory = input.file.stations[n].nvram;
    if (!memory.empty() && fs::exists(memory)) station.memory = read_file(memory);
  }
  return package;
}

void add_sources(const PlantInput& input, Zip& zip) {
  std::set<std::string> known;
  for (const auto& program : input.programs)
    for (const std::string& file : program ? program->files : std::vector<std::string>()) {
      const auto text = try_read_file(file);
      if (text && known.insert(fs::path(file).filename().string()).second)
        zip.add("resources/sources/" + fs::path(file).filename().string(), *text);
    }
}

// A name for a function of C that stands for the model.
std::string identifier_of(const std::string& model) {
  std::string out;
  for (const char c : model) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    out += is_letter || (c >= '0' && c <= '9') ? c : '_';
  }
  return out.empty() || (out[0] >= '0' && out[0] <= '9') ? "plant_" + out : out;
}

// What the plant has that an FMU does not do. Terminals of buses have clocks, which FMI 2.0 does not know.
void warn_of_ports(const PlantInput& input, bool has_terminals) {
  for (const runtime::BusConfig& bus : input.file.buses) {
    if (bus.port.empty() || (bus.port == runtime::kFmiPort && has_terminals && bus.kind == runtime::BusKind::Can)) continue;
    fmt::print(stderr, "ipos: warning: {}:{}:{}: the port of '{}' is left out: {}\n", compiler::printable(input.path),
               bus.port_place.line, bus.port_place.column, bus.name,
               bus.port != runtime::kFmiPort ? "an FMU opens none" : "terminals are of CAN lines, with --fmi 3");
  }
}

void add_libraries(const Dialect& dialect, const std::string& identifier, Zip& zip) {
  std::string left_out;
  size_t found = 0;
  for (const Platform& platform : kPlatforms) {
    const auto path = find_library(platform);
    const std::string_view folder = platform.folders[dialect.number == 2 ? 0 : 1];
    if (path) {
      zip.add(fmt::format("binaries/{}/{}{}", folder, identifier, platform.ending), read_file(path->string()), true);
      ++found;
    } else {
      left_out += fmt::format("{}{} (no {})", left_out.empty() ? "" : ", ", folder, platform.library);
    }
  }
  if (left_out.empty()) return;
  std::string places;
  for (const fs::path& folder : library_folders()) places += fmt::format("{}{}", places.empty() ? "" : ", ", folder.string());
  const std::string text = fmt::format("left out: {}; looked for in {}", left_out, places);
  if (found == 0) throw Failure(kNoInput, text);
  fmt::print(stderr, "ipos: {}\n", compiler::printable(text));
}

std::string texts_of(size_t count, std::string_view one) { return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s"); }

// Before somebody is asked whether a foreign FMU may run.
void refuse_machines(const std::string& path) {
  if (!is_plant(path)) return;
  const runtime::PlantFile file = runtime::read_plant_file(read_file(path), path).plant;
  if (file.machines.empty()) return;
  const runtime::FilePlace place = file.machines.front().place;
  throw Failure(kBadInput, fmt::format("{}:{}:{}: a plant with foreign machines cannot become an FMU itself", path, place.line, place.column));
}

// The CAN line of that name. Faults of single stations stay with these.
fmi::LineChoice line_of(const PlantInput& input, const FmuFlags& flags) {
  const auto& buses = input.file.buses;
  const auto bus = std::find_if(buses.begin(), buses.end(), [&](const runtime::BusConfig& each) { return each.name == flags.bus; });
  if (bus == buses.end() || bus->kind != runtime::BusKind::Can) {
    std::vector<std::string_view> lines;
    for (const runtime::BusConfig& each : buses)
      if (each.kind == runtime::BusKind::Can) lines.push_back(each.name);
    throw Failure(kUsage, fmt::format("there is no CAN line '{}'; the plant has {}", flags.bus,
                                      lines.empty() ? "none" : fmt::format("{}", fmt::join(lines, ", "))));
  }
  for (const runtime::FaultConfig& fault : input.file.faults)
    if (fault.bus == flags.bus && !fault.station.empty())
      fmt::print(stderr, "ipos: warning: {}:{}:{}: the fault is left out: it needs the station '{}'\n", compiler::printable(input.path),
                 fault.place.line, fault.place.column, fault.station);
  return {flags.bus, flags.terminals};
}

// The plant that the library will make of it.
std::unique_ptr<runtime::Plant> plant_of(const PlantInput& input, const fmi::Package& package) {
  if (!package.choice.line) return make_plant(input, runtime::FileUse::Look);
  auto plant = fmi::contents_of(package).value().build();
  return *std::move(plant);
}

int write_fmu(FmuFlags flags) {
  const bool is_line = !flags.bus.empty();
  if (is_line && (flags.version == "2" || flags.sources || !flags.choice.stations.empty() || !flags.choice.signals.empty()))
    throw Failure(kUsage, "--bus is the line alone, in FMI 3.0: it takes no --fmi 2, --station, --signals and --sources");
  if (flags.version.empty()) flags.version = is_line ? "3" : "2";
  const Dialect& dialect = *std::find_if(std::begin(kDialects), std::end(kDialects),
                                         [&](const Dialect& each) { return fmt::format("{}", each.number) == flags.version; });
  refuse_machines(flags.file);
  const PlantInput input = read_plant_input(flags.file, flags.compile);
  if (is_line) flags.choice.line = line_of(input, flags);
  const bool has_terminals = dialect.number != 2;
  if (!is_line) warn_of_ports(input, has_terminals);
  const auto terminals = has_terminals ? fmi::terminals_of(input.file, flags.choice) : fmi::Terminals();
  fmi::Package package = package_of(input, flags);
  const auto files = fmi::files_of(package, IPOS_VERSION);
  const auto plant = plant_of(input, package);
  auto variables = fmi::variables_of(*plant, flags.choice);
  if (!variables) throw Failure(kUsage, variables.error());

  const std::string stem = fs::path(flags.file).stem().string();
  const std::string model = is_line ? stem + "." + flags.bus : stem;
  const std::string identifier = identifier_of(model);
  Zip zip;
  zip.add("modelDescription.xml", description_of(dialect, {model, identifier, package.token, is_line}, *variables, terminals));
  if (!terminals.empty()) {
    zip.add("terminalsAndIcons/terminalsAndIcons.xml", terminals_xml(terminals));
    zip.add("extra/org.fmi-standard.fmi-ls-bus/fmi-ls-manifest.xml", manifest_xml(is_line));
  }
  add_libraries(dialect, identifier, zip);
  zip.add("documentation/licenses/license.txt", notices_text());
  for (const auto& [name, bytes] : files) zip.add("resources/" + name, bytes);
  if (flags.sources) add_sources(input, zip);
  replace_file(flags.output, zip.finish());

  const auto count = [&](fmi::Causality causality) {
    return static_cast<size_t>(std::count_if(variables->all.begin(), variables->all.end(),
                                             [&](const fmi::Variable& each) { return each.causality == causality; }));
  };
  fmt::print("{}: FMI {}, {}, {}, {}, {}\n", compiler::printable(flags.output), dialect.version,
             texts_of(count(fmi::Causality::Input), "input"), texts_of(count(fmi::Causality::Output), "output"),
             texts_of(count(fmi::Causality::Parameter), "parameter"), texts_of(count(fmi::Causality::Local), "local variable"));
  return kGood;
}

}  // namespace

void add_fmu(cli::Verb& app) {
  auto flags = std::make_shared<FmuFlags>();
  cli::Verb& verb = app.verb("fmu", "write a plant as an FMU for other simulators (FMI, co-simulation)");
  verb.option("PLANT", flags->file, "plant file, or program").required();
  verb.option("-o", flags->output, "FMU to write, *.fmu").required();
  verb.option("--fmi", flags->version, "version of FMI; default: 2").one_of({"2", "3"});
  verb.option("--bus", flags->bus, "this CAN line alone, as a bus simulation for other nodes (FMI 3.0)");
  verb.option("--terminals", flags->terminals, "how many nodes the line has with --bus, 1..64; default: 2").between(1, fmi::kMostTerminals);
  verb.option("--station", flags->choice.stations, "only this station (may be repeated)").one_each().offers(offered_stations);
  verb.option("--signals", flags->choice.signals, "name or pattern of signals that are outputs, too (may be repeated)")
      .one_each()
      .offers(offered_signals);
  verb.flag("--sources", flags->sources, "the sources of the programs go into the FMU, too");
  add_compile_options(verb, flags->compile);
  verb.footer("Example:\n  ipos fmu hoist.toml -o hoist.fmu --fmi 3 --signals 'hoist.TrCycl*'");
  verb.runs([flags] { return write_fmu(*flags); });
}

}  // namespace ipos::tools

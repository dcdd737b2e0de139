// ipos param: the parameters of a unit, read, written, kept as a file and compared (docs/guide/param.md).
#include <fmt/format.h>

#include <unistd.h>

#include "stdlib/unit_names.hpp"
#include "tools/cli/failure.hpp"
#include "tools/cli/files.hpp"
#include "tools/cli/verbs.hpp"
#include "tools/input/plant_source.hpp"
#include "tools/links/dp_units.hpp"
#include "tools/links/link_access.hpp"
#include "tools/input/offers.hpp"
#include "tools/links/link_options.hpp"
#include "tools/unit/param_actions.hpp"
#include "tools/unit/station_access.hpp"

namespace ipos::tools {
namespace {

using runtime::FileUse;

struct ParamFlags {
  std::vector<std::string> words;  // PLANT.toml and what comes after it
  std::string station;
  std::string unit;
  LinkFlags link;
  int address = -1;
  bool yes = false;
  std::string format = "text";
  ListChoice list;
  bool is_volatile = false;

  bool json() const { return format == "json"; }
};

// The unit at a port. Each write into its non-volatile memory wears that, so it must be meant.
std::unique_ptr<ParameterAccess> open_at_port(const ParamFlags& flags, FileUse use) {
  if (flags.address < 0)
    throw Failure(kUsage, "--port needs --address; 'ipos scan PORT' lists those that answer");
  if (!flags.words.empty() && is_plant(flags.words.front()))
    throw Failure(kUsage, "a plant file does not go with --port");
  if (use == FileUse::Write && !flags.is_volatile && !flags.yes)
    throw Failure(
        kUsage,
        "this writes into the EEPROM of the unit, which every write wears: add --yes if it is meant, "
        "or --volatile; never do it cyclically without --volatile");
  if (flags.is_volatile && flags.link.canopen)
    throw Failure(kUsage, "--volatile does not go with --canopen: a write over SDO is always stored");
  if (flags.is_volatile && flags.link.profibus)
    throw Failure(kUsage,
                  "--volatile does not go with --profibus: P802 of the unit says whether a write is stored");
  check_profibus(flags.link);
  if (flags.link.profibus) {
    if (flags.address == kPcAddress || flags.address > profibus::kLastStation)
      throw Failure(kUsage, fmt::format("{} is no address of a slave: 1..125 ({} is this PC's)",
                                        flags.address, kPcAddress));
    return open_dp_unit(flags.link, static_cast<uint8_t>(flags.address));
  }
  auto link = BusLink::open(flags.link);
  if (!link->has_address(flags.address))
    throw Failure(kUsage, fmt::format("{} is no address of a unit at {}: {}..{}", flags.address,
                                      flags.link.port, link->first_address(), link->last_address()));
  return open_unit(std::move(link), static_cast<uint8_t>(flags.address), flags.unit);
}

// The unit that is meant, by a port or as the first word names it; that word is taken away.
std::unique_ptr<ParameterAccess> open(ParamFlags& flags, FileUse use) {
  if (!flags.link.port.empty()) return open_at_port(flags, use);
  const bool plant = !flags.words.empty() && is_plant(flags.words.front());
  if (plant == !flags.unit.empty())
    throw Failure(kUsage,
                  plant ? "--unit does not go with a plant file"
                        : "which unit? Name a plant file (*.toml), or give --port and --address, or --unit");
  if (!plant) return open_factory(*stdlib::find_unit_or_plate(flags.unit));
  const std::string file = flags.words.front();
  flags.words.erase(flags.words.begin());
  return open_station(file, flags.station, use);
}

void no_more_words(const ParamFlags& flags) {
  if (!flags.words.empty())
    throw Failure(kUsage, fmt::format("what is '{}' meant to be?", flags.words.front()));
}

std::string one_file(const ParamFlags& flags) {
  if (flags.words.size() != 1)
    throw Failure(kUsage, flags.link.port.empty() ? "write PLANT.toml FILE" : "write one FILE");
  return flags.words.front();
}

// One side of a comparison: a file of `save`, or the station of a plant, "PLANT.toml" or "PLANT.toml:NAME".
ParameterSet side_of(const std::string& side, const std::string& station) {
  std::string file = side;
  std::string name = station;
  const size_t colon = side.rfind(".toml:");
  if (access(side.c_str(), F_OK) != 0 && colon != std::string::npos) {
    file = side.substr(0, colon + 5);
    name = side.substr(colon + 6);
  }
  const std::string text = read_file(file);
  if (is_parameter_set(text)) return parse_settings(file, text);
  const auto access = open_station(file, name, FileUse::Look);
  bool complete = true;
  return read_settings(*access, complete);
}

int diff_with_unit(ParamFlags& flags) {
  const std::string file = one_file(flags);
  const ParameterSet a = side_of(file, flags.station);
  const auto access = open_at_port(flags, FileUse::Look);
  bool complete = true;
  const ParameterSet b = read_settings(*access, complete);
  return diff_parameters(a, file, b, access->name(), flags.json());
}

class Actions {
 public:
  Actions(cli::Verb& verb, std::shared_ptr<ParamFlags> flags) : verb_(verb), flags_(std::move(flags)) {}

  template <typename Action>
  cli::Verb& add(const char* name, const char* what, const char* words, const char* about,
                 const char* example, Action action) {
    cli::Verb& app = verb_.verb(name, what);
    app.option(words, flags_->words, about).offers(offered_parameters);
    app.option("--station", flags_->station, "which station, where the plant has several").offers(offered_stations);
    add_link_options(app, flags_->link, true);
    add_profibus_option(app, flags_->link);
    app.option("--cfg", flags_->link.cfg,
               "with --profibus: the configuration, \"F3 F0\" to \"F3 F2\"; default \"F3 F0\"");
    app.option("--address", flags_->address, "with --port: address of the unit")
        .check(check_address, "0..127");
    app.footer(std::string("Example:\n  ipos param ") + example);
    app.runs([flags = flags_, action] { return action(*flags); });
    return app;
  }

  void unit(cli::Verb& app) {
    app.option("--unit", flags_->unit,
               fmt::format("instead of a plant: a unit as delivered ({}); with --port: do not ask the unit what it is",
                           stdlib::unit_names()))
        .check(check_unit, "UNIT")
        .offers([](const Words&) { return offered_units(); });
  }
  void format(cli::Verb& app) {
    app.option("--format", flags_->format, "text or json").one_of({"text", "json"});
  }
  void writes(cli::Verb& app) {
    app.flag("--yes", flags_->yes, "with --port: write into the non-volatile memory of the unit");
    app.flag("--volatile", flags_->is_volatile,
             "service 3, write volatile: not into the non-volatile memory");
  }

 private:
  cli::Verb& verb_;
  std::shared_ptr<ParamFlags> flags_;
};

}  // namespace

void add_param(cli::Verb& app) {
  auto flags = std::make_shared<ParamFlags>();
  cli::Verb& verb = app.verb("param", "parameters of a unit: list, get, set, save, load, diff");
  verb.footer("Example:\n  ipos param set plant.toml P130=2.5s\nEach of them has --help with an example.");
  Actions actions(verb, flags);

  cli::Verb& list = actions.add("list", "values with names and units", "PLANT", "plant file",
                                "list plant.toml --group P1", [](ParamFlags& f) {
                                  const auto access = open(f, FileUse::Look);
                                  no_more_words(f);
                                  f.list.json = f.json();
                                  return list_parameters(*access, f.list);
                                });
  list.option("--group", flags->list.group, "numbers that begin so, for example P1 or P13");
  list.flag("--changed", flags->list.changed, "only settings that differ from the factory setting");
  list.flag("--long", flags->list.detailed, "also access, default, minimum and maximum");
  actions.unit(list);
  actions.format(list);

  cli::Verb& get = actions.add("get", "single values", "PLANT NAME", "plant file, then P130, 8470, H20, ...",
                               "get plant.toml P130 8470", [](ParamFlags& f) {
                                 const auto access = open(f, FileUse::Look);
                                 if (f.words.empty())
                                   throw Failure(kUsage, "which parameter? For example P130");
                                 return get_parameters(*access, f.words, f.json());
                               });
  actions.unit(get);
  actions.format(get);

  cli::Verb& set =
      actions.add("set", "write values, by default into the non-volatile memory", "PLANT NAME=VALUE",
                  "plant file, then P130=2.5s, P816=\"500 kBaud\", H20=5, ...",
                  "set plant.toml P130=2.5s P816=\"500 kBaud\"", [](ParamFlags& f) {
                    const auto access = open(f, FileUse::Write);
                    if (f.words.empty()) throw Failure(kUsage, "set what? For example P130=2.5s");
                    return set_parameters(*access, f.words, f.is_volatile, f.json());
                  });
  actions.writes(set);
  actions.unit(set);
  actions.format(set);

  cli::Verb& save = actions.add("save", "keep all settings in a file, a line a parameter", "PLANT FILE",
                                "plant file, then the file to write; - is standard output",
                                "save plant.toml unit1.settings", [](ParamFlags& f) {
                                  const auto access = open(f, FileUse::Look);
                                  return save_parameters(*access, one_file(f));
                                });
  actions.unit(save);

  cli::Verb& load =
      actions.add("load", "write the settings of a file that differ", "PLANT FILE",
                  "plant file, then a file of save", "load plant.toml unit1.settings", [](ParamFlags& f) {
                    const auto access = open(f, FileUse::Write);
                    const std::string file = one_file(f);
                    const ParameterSet settings = parse_settings(file, read_file(file));
                    return load_parameters(*access, file, settings, f.is_volatile, f.json());
                  });
  actions.writes(load);
  actions.unit(load);
  actions.format(load);

  cli::Verb& diff =
      actions.add("diff", "what differs; exit code 1 if something does", "A B",
                  "each a file of save, or PLANT.toml[:STATION]; with --port B is the unit there",
                  "diff unit1.settings plant.toml:unit1", [](ParamFlags& f) {
                    if (!f.link.port.empty()) return diff_with_unit(f);
                    if (f.words.size() != 2) throw Failure(kUsage, "diff needs two sides, A and B");
                    const ParameterSet a = side_of(f.words[0], f.station);
                    const ParameterSet b = side_of(f.words[1], f.station);
                    return diff_parameters(a, f.words[0], b, f.words[1], f.json());
                  });
  actions.unit(diff);
  actions.format(diff);
}

}  // namespace ipos::tools

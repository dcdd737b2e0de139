// What a station has, group by group. A program's own name hides a value of the unit that is called the same, as an
// inner scope does; "drive.NAME" is always the unit's.
#include "runtime/signals/station_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <unordered_set>
#include <utility>

#include "runtime/bus/movilink/process_words.hpp"
#include "runtime/drive/indices.hpp"
#include "runtime/plant_file/signal.hpp"
#include "runtime/signals/station_state.hpp"
#include "runtime/signals/variable_names.hpp"
#include "stdlib/parameters.hpp"
#include "stdlib/system_variables.hpp"

namespace ipos::signals {

using namespace runtime;

namespace {

constexpr size_t kWordBits = 16, kLongBits = 32;

// The signals with a name of their own: a display value, which the drive keeps up to date in its parameter; a
// variable; or what only the simulation knows.
struct DriveValue {
  std::string_view name;
  std::string_view meaning;
  std::string_view parameter;  // number
  int variable = -1;           // of units that position
  int64_t (*read)(const Station&) = nullptr;
  std::string_view unit{};
  double factor = 1;
  int decimals = 0;
  size_t bits = 0;
  int64_t (*decided)(const Drive&) = nullptr;  // Signal::decided
};

template <int32_t (Drive::*value)() const>
int64_t of_drive(const Drive& drive) {
  return (drive.*value)();
}

template <int64_t (*value)(const Drive&)>
int64_t of_station(const Station& station) {
  return value(station.drive().state());
}

template <int32_t (Drive::*value)() const>
constexpr DriveValue decided_value(DriveValue row) {
  row.read = of_station<of_drive<value>>;
  row.decided = of_drive<value>;
  return row;
}

int64_t status_of(const Drive& drive) { return drive.status_word_1(); }
int64_t fault_of(const Drive& drive) { return drive.fault(); }

constexpr DriveValue kDriveValues[] = {
    {.name = "speed", .meaning = "P000", .parameter = "000", .decided = of_drive<&Drive::shown_speed>},
    {"frequency", "P002", "002"},
    {"position", "P003", "003"},
    {"current", "P004", "004"},
    {"active_current", "P005", "005"},
    {"motor_utilization", "P006", "006"},
    {"dc_link", "P008", "008"},
    {"temperature", "P014", "014"},
    decided_value<&Drive::axis_setpoint>(
        {"setpoint", "speed the ramp orders", "", -1, nullptr, "rpm", 0.001, 3}),
    decided_value<&Drive::speed>(
        {"shaft_speed", "of the motor as simulated", "", -1, nullptr, "rpm", 0.001, 3}),
    {"torque", "of the motor as simulated", "", -1,
     [](const Station& station) -> int64_t { return station.drive().state().axis().torque; }, "%Mn", 0.001,
     3},
    {"position_setpoint", "H491", "", 491, nullptr, "inc"},
    {"position_target", "H492", "", 492, nullptr, "inc"},
    {"lag", "H495", "", 495, nullptr, "inc"},
    {"status", "status word 1", "", -1, of_station<status_of>, "", 1, 0, kWordBits, status_of},
    {"fault", "fault number; 0 is none", "", -1, of_station<fault_of>, "", 1, 0, 0, fault_of},
};

const stdlib::Parameter* find_parameter(const Station& station, std::string_view number) {
  const stdlib::Parameter* row = stdlib::parameter_table(*station.config().unit).find(number);
  return row != nullptr && row->index != 0 ? row : nullptr;
}

bool has(const Station& station, const DriveValue& row) {
  if (row.read != nullptr) return true;
  if (row.variable >= 0)
    return station.has_variables() && station.config().unit->generation != stdlib::Generation::M07;
  return find_parameter(station, row.parameter) != nullptr;
}

constexpr std::string_view kUnitPrefix = "drive.";

// Collects them under the name of the station. What the unit calls as the program calls a variable gets the prefix.
class Collector {
 public:
  explicit Collector(const Station& station) : station_(station) {}

  Signal& add(Group group, std::string_view name, std::string_view meaning,
                   std::function<int64_t()> read) {
    const bool hidden = !names_.emplace(name).second;
    Signal& signal = found.emplace_back();
    signal.station = station_.config().name;
    signal.name = fmt::format("{}.{}{}", signal.station, hidden ? kUnitPrefix : "", name);
    signal.group = group;
    signal.meaning = meaning;
    signal.read = std::move(read);
    return signal;
  }

  Signal& add_parameter(const stdlib::Parameter& row, Group group, std::string_view name) {
    Signal& signal = add(
        group, name, fmt::format("P{} {}", row.number, row.name),
        [&station = station_, &row] { return row.number_of(station.drive().parameters().value(row.index)); });
    const stdlib::DisplayScale scale = stdlib::display_scale(row);
    if (row.display == "hex")
      signal.bits = kLongBits;
    else
      signal.unit = row.display;
    signal.factor = scale.factor;
    signal.decimals = scale.decimals;
    return signal;
  }

  Signal& add_variable(Group group, std::string_view name, uint32_t number,
                            std::string_view meaning) {
    return add(group, name, meaning, [&station = station_, number] { return station.variable(number); });
  }

  std::vector<Signal> found;

 private:
  const Station& station_;
  std::unordered_set<std::string> names_;
};

void add_drive(const Station& station, Collector& out) {
  for (const DriveValue& row : kDriveValues) {
    if (!has(station, row)) continue;
    if (row.read == nullptr && row.variable < 0) {
      const stdlib::Parameter& parameter = *find_parameter(station, row.parameter);
      Signal& signal = out.add_parameter(parameter, Group::Drive, row.name);
      if (parameter.index == index::kSpeed) signal.decided = row.decided;
      continue;
    }
    Signal& signal = row.read != nullptr
                              ? out.add(Group::Drive, row.name, row.meaning,
                                        [&station, read = row.read] { return read(station); })
                              : out.add_variable(Group::Drive, row.name,
                                                 static_cast<uint32_t>(row.variable), row.meaning);
    signal.unit = row.unit;
    signal.factor = row.factor;
    signal.decimals = row.decimals;
    signal.bits = row.bits;
    signal.decided = row.decided;
    signal.is_status = row.name == "status";
  }
}

void add_symbols(const Station& station, Collector& out) {
  for (const vm::Symbol& symbol : station.symbols())
    for (const NamedVariable& element : elements_of(symbol))
      out.add_variable(Group::Variable, element.name, element.number,
                       fmt::format("H{}", element.number));
}

// A state that is called like a value of the drive counts in another unit: it is left to expectations.
void add_states(const Station& station, Collector& out) {
  for (const StationState& state : station_states()) {
    const auto same = [&](const DriveValue& row) { return row.name == state.name; };
    if (std::any_of(std::begin(kDriveValues), std::end(kDriveValues), same)) continue;
    out.add(Group::State, state.name, state.meaning,
            [&station, read = state.read]() -> int64_t { return read(station); })
        .bits = state.on_off ? 1 : 0;
  }
}

void add_terminals(const Station& station, Collector& out) {
  for (size_t line = 0; line < kBinaryLines; ++line)
    out.add(Group::Input, fmt::format("DI{}{}", line / 8, line % 8), "binary input",
            [&station, line]() -> int64_t { return station.inputs().line(line).value(); })
        .bits = 1;
  const auto add_output = [&](const std::string& name) {
    out.add(Group::Output, name, "binary output",
            [&station, bit = parse_output(name)]() -> int64_t { return station.outputs() >> bit & 1; })
        .bits = 1;
  };
  add_output("DB00");
  for (int n = 1; n <= 5; ++n) add_output(fmt::format("DO0{}", n));
  for (int n = 0; n < 8; ++n) add_output(fmt::format("DO1{}", n));
  for (const AnalogKind& kind : analog_kinds()) {
    Signal& signal = out.add(
        Group::Analog, kind.signal, "analog input",
        [&station, line = line_of(kind)]() -> int64_t { return station.inputs().line(line).value(); });
    signal.unit = kind.unit;
    signal.factor = 1 / kind.factor;
    signal.decimals = kind.factor == 10 ? 1 : 3;
  }
}

int64_t process_word(const Station& station, bool input, size_t word) {
  const Drive& drive = station.drive().state();
  return input ? drive.pi()[word] : drive.po()[word];
}

// The word as it goes over the bus, and the number that it is by its assignment at present.
void add_process_data(const Station& station, Collector& out) {
  for (const bool input : {false, true})
    for (size_t word = 0; word < kProcessWords; ++word) {
      const std::string name = fmt::format("{}{}", input ? "PI" : "PO", word + 1);
      const auto* row = find_parameter(station, fmt::format("87{}", (input ? 3 : 0) + word));
      const auto code =
          row == nullptr ? uint8_t{0} : static_cast<uint8_t>(station.drive().parameters().value(row->index));
      const std::string_view assigned = process_word_name(*station.config().unit, input, code);
      out.add(Group::ProcessData, name, assigned,
              [&station, input, word] { return process_word(station, input, word); })
          .bits = kWordBits;
      const ProcessWordScale scale = process_word_scale(input, code);
      if (scale.denominator == 0 || scale.unit.empty()) continue;
      Signal& signal = out.add(Group::ProcessData, name + "_value", assigned,
                                    [&station, input, word, is_signed = scale.is_signed]() -> int64_t {
                                      const auto bits =
                                          static_cast<uint16_t>(process_word(station, input, word));
                                      return is_signed ? int64_t{static_cast<int16_t>(bits)} : bits;
                                    });
      signal.unit = scale.unit;
      signal.factor = static_cast<double>(scale.numerator) / scale.denominator;
      signal.decimals = scale.denominator == 1 ? 0 : scale.denominator <= 10 ? 1 : 2;
    }
  if (!station.has_further_words()) return;
  for (const bool input : {false, true})
    for (size_t word = 0; word < kFurtherWords; ++word)
      out.add(Group::ProcessData, fmt::format("{}{}", input ? "PI" : "PO", kProcessWords + word + 1),
              "word of the program", [&station, input, word]() -> int64_t {
                const Drive& drive = station.drive().state();
                return (input ? drive.further_pi() : drive.further_po())[word];
              }).bits = kWordBits;
}

void add_tasks(const Station& station, Collector& out) {
  if (station.image() == nullptr) return;
  for (int task = 1; task <= station.config().unit->tasks; ++task) {
    out.add(Group::Task, fmt::format("task{}.state", task), "0 stopped, 1 ready, 2 waiting",
            [&station, task]() -> int64_t {
              if (station.machine() == nullptr) return 0;
              return static_cast<int64_t>(station.machine()->task(task).state);
            });
    out.add(Group::Task, fmt::format("task{}.line", task), "source line it stands at; 0 stopped",
            [&station, task]() -> int64_t {
              if (station.machine() == nullptr) return 0;
              const vm::TaskContext& context = station.machine()->task(task);
              return context.state == vm::TaskState::Stopped ? 0 : station.source_line(context.pc);
            });
  }
}

void add_system_variables(const Station& station, Collector& out) {
  const stdlib::UnitType& unit = *station.config().unit;
  for (const stdlib::SystemVariable& row : stdlib::system_variables()) {
    const bool known = row.units == stdlib::VariableUnits::A || unit.generation == stdlib::Generation::B;
    if (known && row.number < unit.variables && !row.compiler_name.empty())
      out.add_variable(Group::SystemVariable, row.compiler_name, row.number, row.meaning);
  }
}

void add_unit(const Station& station, Collector& out) {
  add_drive(station, out);
  add_states(station, out);
  add_terminals(station, out);
  add_process_data(station, out);
  add_tasks(station, out);
  add_system_variables(station, out);
}

void add_all(const Station& station, Collector& out) {
  add_symbols(station, out);
  add_unit(station, out);
}

// What the program calls so: a variable, a member, or all that a structure or an array has.
std::vector<NamedVariable> own_variables(const Station& station, std::string_view name) {
  std::vector<NamedVariable> found = named_variables(station.symbols(), *station.config().unit, name);
  if (!found.empty() && found.front().symbol.empty()) found.clear();  // by number or a system variable
  return found;
}

// Whether a pattern can mean what begins with the letter and a number.
bool can_mean(std::string_view pattern, char letter) {
  if (pattern.empty() || pattern[0] != letter) return false;
  return pattern.size() > 1 && (is_pattern(pattern.substr(1, 1)) || (pattern[1] >= '0' && pattern[1] <= '9'));
}

}  // namespace

std::string_view group_text(Group group) {
  switch (group) {
    case Group::Drive: return "drive";
    case Group::State: return "states";
    case Group::Input: return "inputs";
    case Group::Output: return "outputs";
    case Group::Analog: return "analog inputs";
    case Group::ProcessData: return "process data";
    case Group::Task: return "tasks";
    case Group::Variable: return "variables";
    case Group::SystemVariable: return "system variables";
    case Group::Parameter: return "parameters";
    case Group::Bus: break;
  }
  return "bus";
}

std::string Signal::text(int64_t sample) const {
  std::string text;
  append_text(text, sample);
  return text;
}

// A power of ten only sets the point: the digits are those of the sample, without the way over a double.
void Signal::append_text(std::string& out, int64_t sample) const {
  constexpr double kPowers[] = {1, 10, 100, 1000, 10'000, 100'000, 1'000'000};
  constexpr int64_t kExact = int64_t{1} << 40;
  const auto places = static_cast<size_t>(decimals);
  const bool digits = places < std::size(kPowers) && std::abs(factor * kPowers[places] - 1) < 1e-15 &&
                      sample > -kExact && sample < kExact;
  if (!digits) {
    fmt::format_to(std::back_inserter(out), "{:.{}f}", static_cast<double>(sample) * factor, decimals);
    return;
  }
  std::array<char, 24> text;
  char* begin = text.data() + text.size();
  uint64_t rest = static_cast<uint64_t>(sample < 0 ? -sample : sample);
  for (size_t n = 0; n < places; ++n, rest /= 10) *--begin = static_cast<char>('0' + rest % 10);
  if (places != 0) *--begin = '.';
  do {
    *--begin = static_cast<char>('0' + rest % 10);
    rest /= 10;
  } while (rest != 0);
  if (sample < 0) *--begin = '-';
  out.append(begin, text.data() + text.size());
}

Signal bit_of(const Signal& whole, size_t bit) {
  Signal signal = whole;
  signal.name += fmt::format(".{}", bit);
  signal.meaning = fmt::format("bit {} of {}", bit, whole.name);
  signal.bits = 1;
  signal.is_status = false;
  signal.decided = nullptr;
  signal.read = [read = whole.read, bit]() -> int64_t { return read() >> bit & 1; };
  return signal;
}

size_t bit_count(const Signal& signal) {
  const bool variable = signal.group == Group::Variable || signal.group == Group::SystemVariable;
  return variable ? kLongBits : signal.bits > 1 ? signal.bits : 0;
}

std::vector<Signal> station_signals(const Station& station) {
  Collector all(station);
  add_all(station, all);
  return std::move(all.found);
}

std::vector<Signal> find_station_signals(const Station& station, std::string_view name) {
  Collector own(station);
  for (const NamedVariable& variable : own_variables(station, name))
    own.add_variable(Group::Variable, variable.name, variable.number,
                     fmt::format("H{}", variable.number));
  if (!own.found.empty() && !name.starts_with(kUnitPrefix)) return std::move(own.found);
  Collector unit(station);
  add_unit(station, unit);
  const std::string_view of_unit = name.starts_with(kUnitPrefix) ? name.substr(kUnitPrefix.size()) : name;
  const std::string full = fmt::format("{}.{}", station.config().name, of_unit);
  for (Signal& signal : unit.found)
    if (signal.name == full) {
      signal.name = fmt::format("{}.{}", station.config().name, name);
      return {std::move(signal)};
    }
  if (!own.found.empty()) return std::move(own.found);  // a structure of the program that is called "drive"
  Collector more(station);
  const bool may_be_parameter =
      name.starts_with('P') || name.find_first_not_of("0123456789") == std::string_view::npos;
  if (const auto* row = may_be_parameter ? find_parameter(station, name) : nullptr) {
    more.add_parameter(*row, Group::Parameter, name);
    return std::move(more.found);
  }
  for (const NamedVariable& variable : named_variables(station.symbols(), *station.config().unit, name))
    more.add_variable(Group::Variable, variable.name, variable.number,
                      fmt::format("H{}", variable.number));
  if (!more.found.empty()) return std::move(more.found);
  const size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return {};
  size_t bit = 0;
  const auto [end, status] = std::from_chars(name.data() + dot + 1, name.data() + name.size(), bit);
  if (status != std::errc() || end != name.data() + name.size()) return {};
  const auto whole = find_station_signals(station, name.substr(0, dot));
  if (whole.size() != 1 || bit >= bit_count(whole[0])) return {};
  return {bit_of(whole[0], bit)};
}

std::vector<Signal> default_signals(const Station& station) {
  std::vector<Signal> found;
  for (const std::string_view name : {"speed", "setpoint", "status"}) {
    const bool hidden = !own_variables(station, name).empty();
    for (Signal& signal :
         find_station_signals(station, hidden ? std::string(kUnitPrefix).append(name) : std::string(name)))
      found.push_back(std::move(signal));
  }
  return found;
}

std::vector<std::string> hidden_names(const Station& station) {
  const auto is_of_unit = [&station](std::string_view name) {
    const auto is_called = [name](const auto& row) { return row.name == name; };
    const auto is_terminal = [name](const AnalogKind& kind) { return kind.signal == name; };
    const bool drive_value = std::any_of(std::begin(kDriveValues), std::end(kDriveValues), [&](const DriveValue& row) {
      return is_called(row) && has(station, row);
    });
    const bool word = name.size() >= 3 && (name.starts_with("PO") || name.starts_with("PI")) && name[2] >= '1' &&
                      name[2] <= '9' && name.find_first_not_of("0123456789", 2) == std::string_view::npos;
    return drive_value || word || find_state(name) >= 0 || parse_input(name) >= 0 || parse_output(name) >= 0 ||
           std::any_of(analog_kinds().begin(), analog_kinds().end(), is_terminal) ||
           stdlib::find_system_variable(name) != nullptr;
  };
  std::vector<std::string> names;
  for (const vm::Symbol& symbol : station.symbols())
    if (is_of_unit(symbol.name)) names.push_back(symbol.name);
  return names;
}

std::vector<Signal> match_station_signals(const Station& station, std::string_view pattern) {
  Collector all(station);
  add_all(station, all);
  if (can_mean(pattern, 'P'))
    for (const stdlib::Parameter& row : stdlib::parameter_table(*station.config().unit).rows())
      if (row.index != 0 && !row.number.empty())
        all.add_parameter(row, Group::Parameter, fmt::format("P{}", row.number));
  if (can_mean(pattern, 'H'))
    for (uint32_t n = 0; n < station.config().unit->variables; ++n)
      all.add_variable(Group::Variable, fmt::format("H{}", n), n, "");
  const size_t own = station.config().name.size() + 1;
  const size_t dot = pattern.rfind('.');
  std::vector<Signal> found;
  for (Signal& signal : all.found) {
    const std::string_view name = std::string_view(signal.name).substr(own);
    if (dot != std::string_view::npos && matches(pattern.substr(0, dot), name))
      for (size_t bit = 0; bit < bit_count(signal); ++bit)
        if (matches(pattern.substr(dot + 1), fmt::format("{}", bit))) found.push_back(bit_of(signal, bit));
    if (matches(pattern, name)) found.push_back(std::move(signal));
  }
  return found;
}

std::optional<Signal> find_among(std::span<const Signal> all, std::string_view name) {
  for (const Signal& signal : all)
    if (signal.name == name) return signal;
  const size_t dot = name.rfind('.');
  if (dot == std::string_view::npos) return std::nullopt;
  size_t bit = 0;
  const auto [end, status] = std::from_chars(name.data() + dot + 1, name.data() + name.size(), bit);
  if (status != std::errc() || end != name.data() + name.size()) return std::nullopt;
  for (const Signal& signal : all)
    if (signal.name == name.substr(0, dot) && bit < bit_count(signal)) return bit_of(signal, bit);
  return std::nullopt;
}

std::vector<Signal> match_among(std::span<const Signal> all, std::string_view pattern) {
  const size_t dot = pattern.rfind('.');
  std::vector<Signal> found;
  for (const Signal& signal : all) {
    if (dot != std::string_view::npos && matches(pattern.substr(0, dot), signal.name))
      for (size_t bit = 0; bit < bit_count(signal); ++bit)
        if (matches(pattern.substr(dot + 1), fmt::format("{}", bit))) found.push_back(bit_of(signal, bit));
    if (matches(pattern, signal.name)) found.push_back(signal);
  }
  return found;
}

std::string names_of(std::span<const Signal> all) {
  std::vector<std::string_view> names;
  for (const Signal& signal : all)
    names.push_back(std::string_view(signal.name).substr(signal.station.size() + 1));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string station_signal_names(const Station& station) {
  std::vector<std::string> names;
  for (const DriveValue& row : kDriveValues)
    if (has(station, row)) names.emplace_back(row.name);
  if (find_parameter(station, "000") != nullptr) names.emplace_back("parameters as P000");
  names.emplace_back("inputs as DI00 and AI1");
  names.emplace_back("outputs as DO01");
  names.emplace_back("process data as PO1 and PI1");
  names.emplace_back("bits as PO1.6");
  names.push_back("states as " + state_names());
  if (station.image() != nullptr) names.emplace_back("tasks as task1.line");
  if (station.has_variables())
    names.push_back(fmt::format("variables H0 to H{}", station.config().unit->variables - 1));
  for (const vm::Symbol& symbol : station.symbols()) names.push_back(symbol.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

bool is_pattern(std::string_view name) { return name.find_first_of("*?") != std::string_view::npos; }

// Where a letter does not fit, the last '*' takes one more.
bool matches(std::string_view pattern, std::string_view text) {
  size_t at = 0, star = std::string_view::npos, taken = 0;
  for (size_t n = 0; n < text.size();) {
    if (at < pattern.size() && pattern[at] == '*') {
      star = at++;
      taken = n;
    } else if (at < pattern.size() && (pattern[at] == '?' || pattern[at] == text[n])) {
      ++at;
      ++n;
    } else if (star != std::string_view::npos) {
      at = star + 1;
      n = ++taken;
    } else {
      return false;
    }
  }
  while (at < pattern.size() && pattern[at] == '*') ++at;
  return at == pattern.size();
}

}  // namespace ipos::signals

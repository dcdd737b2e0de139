// States, values and time.
#include "runtime/fmi/instance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace ipos::fmi {
namespace {

using runtime::kMillisecond;
using runtime::Time;

struct CallRow {
  std::string_view names[2];  // of FMI 2.0 and 3.0
  std::string_view states;
};
constexpr CallRow kCalls[] = {
#define FMI_CALL(call, fmi2, fmi3, states) {{fmi2, fmi3}, states},
#include "runtime/fmi/calls.def"
};

struct StateRow {
  char letter;
  std::string_view text;
};
constexpr StateRow kStates[] = {{'i', "instantiated"}, {'n', "in initialization mode"}, {'s', "in step mode"},
                                {'e', "in event mode"}, {'t', "terminated"}};

constexpr double kLongest = 9e9;       // s: what 64 bits of ns can count
constexpr double kTimesAgree = 1e-6;   // s, of what the importer and the instance take for the present (ours)
constexpr Time kSnaps = 100;           // ns: so near to a full millisecond is meant to be one; times are sums of doubles (ours)

// Of a time since the start: a plant has ticks.
Time whole_time(Time ns) {
  const Time full = (ns + kMillisecond / 2) / kMillisecond * kMillisecond;
  return std::abs(ns - full) <= kSnaps ? full : ns;
}

}  // namespace

std::unique_ptr<Instance> Instance::make(int version, const std::string& token, const std::string& folder, Log log) {
  const auto refuse = [&](const std::string& why) {
    log(Status::Error, kErrors, why);
    return nullptr;
  };
  auto package = read_package(folder);
  if (!package) return refuse(package.error());
  if (token != package->token)
    return refuse(fmt::format("the description belongs to another FMU: its token is {}, that of the resources {}", token,
                              package->token));
  auto contents = contents_of(*package);
  if (!contents) return refuse(contents.error());
  auto made = std::unique_ptr<Instance>(
      new Instance(version, token, *std::move(package), *std::move(contents), std::move(log)));
  if (const auto why = made->open()) {
    made->fail(*why);
    return nullptr;
  }
  return made;
}

Instance::Instance(int version, std::string token, Package package, library::Contents contents, Log log)
    : version_(version),
      token_(std::move(token)),
      package_(std::move(package)),
      contents_(std::move(contents)),
      log_(std::move(log)) {}

Instance::~Instance() = default;

std::optional<std::string> Instance::open() {
  auto session = library::Session::open(contents_, true);
  if (!session) return session.error().front().text;
  session_ = *std::move(session);
  terminals_.clear();
  if (version_ != 2) terminals_ = terminals_of(std::as_const(*session_).plant().file(), package_.choice);
  for (const auto& terminal : terminals_) terminal->begin(*session_);
  return find_variables();
}

// They read in the plant of now.
std::optional<std::string> Instance::find_variables() {
  auto found = variables_of(session_->plant(), package_.choice);
  if (!found) return std::move(found).error();
  variables_ = *std::move(found);
  return std::nullopt;
}

bool Instance::allows(Call call) {
  const CallRow& row = kCalls[static_cast<size_t>(call)];
  const StateRow& state = kStates[static_cast<size_t>(stage_)];
  if (row.states.find(state.letter) != std::string_view::npos) return true;
  fail(fmt::format("fmi{}{} is not allowed here: the instance is {}", version_, row.names[version_ == 2 ? 0 : 1], state.text));
  return false;
}

Status Instance::fail(Status status, std::string_view category, const std::string& text) {
  log_(status, category.data(), text);
  return status;
}

Status Instance::set_start(double start) {
  if (!std::isfinite(start)) return fail("the start time is no number");
  start_ = time_ = start;
  return Status::Ok;
}

Status Instance::enter_initialization() { return stage_ = Stage::Initialization, Status::Ok; }
Status Instance::exit_initialization(bool with_events) {
  stage_ = with_events ? Stage::Events : Stage::Steps;
  return Status::Ok;
}
Status Instance::enter_events() { return stage_ = Stage::Events, Status::Ok; }
Status Instance::enter_steps() { return stage_ = Stage::Steps, Status::Ok; }
Status Instance::terminate() { return stage_ = Stage::Terminated, Status::Ok; }

Status Instance::reset() {
  if (const auto why = open()) return fail(*why);
  stage_ = Stage::Instantiated;
  start_ = time_ = 0;
  told_ = 0;
  return Status::Ok;
}

std::vector<uint8_t> Instance::faults() const {
  std::vector<uint8_t> faults;
  for (const auto& station : std::as_const(*session_).plant().stations()) faults.push_back(std::as_const(*station).fault());
  return faults;
}

// Of a line alone each nanosecond counts.
Time Instance::plant_time(double time) const {
  const Time ns = std::llround((time - start_) * 1e9);
  return is_line() ? ns : whole_time(ns);
}

// Up to and including `until`, as ipos run and the C library do: what is set then acts in the millisecond that begins there, and
// its tick, a millisecond later, is the first that sees it.
void Instance::run(Time until, bool returns_early, Step& done) {
  runtime::Plant& plant = session_->plant();
  if (until <= plant.now()) return;
  if (!returns_early) return session_->run(until);
  const std::vector<uint8_t> before = faults();
  const auto goes_on = [&](Time) {
    const std::vector<uint8_t> now = faults();
    for (size_t n = 0; n < now.size(); ++n)
      if (now[n] != 0 && now[n] != before[n]) return false;
    return true;
  };
  plant.run_until(until, goes_on);
  if (plant.now() >= until) return;
  done.early = true;
  done.reached = start_ + static_cast<double>(plant.now()) * 1e-9;
}

Status Instance::step(double from, double length, bool returns_early, Step& done) {
  if (!std::isfinite(from) || !(length > 0) || !std::isfinite(length))
    return fail(fmt::format("a step from {} s over {} s is none", from, length));
  if (std::abs(from - time_) > kTimesAgree)
    return fail(fmt::format("the communication point is {} s, but the instance stands at {} s", from, time_));
  const double until = from + length;
  if (until - start_ > kLongest) return fail(fmt::format("{} s is beyond what a plant can count", until));
  done = {until, false, false};
  run(plant_time(until), returns_early, done);
  for (const auto& terminal : terminals_) done.sends |= terminal->collect(*session_) && !terminal->is_of_the_line();
  time_ = done.reached;
  if (logging_) tell_journal();
  return Status::Ok;
}

void Instance::tell_journal() {
  const auto& entries = std::as_const(*session_).plant().journal().entries();
  for (; told_ < entries.size(); ++told_) {
    const runtime::JournalEntry& entry = entries[told_];
    log_(entry.weight == runtime::Weight::Why ? Status::Ok : Status::Warning, kJournal,
         fmt::format("{:.6f} s {}{}{}", static_cast<double>(entry.time) * 1e-9 + start_, entry.station,
                     entry.station.empty() ? "" : ": ", entry.text));
  }
}

Status Instance::check(std::span<const uint32_t> references, Types types) {
  for (const uint32_t reference : references) {
    const bool is_member = reference > variables_.all.size();
    if (is_member && notified_terminal(reference) == nullptr) return fail(fmt::format("no variable has the value reference {}", reference));
    const Type type = is_member ? Type::Boolean : reference == 0 ? Type::Real : variables_.all[reference - 1].type;
    if (std::find(types.begin(), types.end(), type) == types.end())
      return fail(fmt::format("{} is of another type", is_member        ? "BusNotifications"
                                                       : reference == 0 ? "time"
                                                                        : variables_.all[reference - 1].name));
  }
  return Status::Ok;
}

// Of one that check() has let through.
double Instance::value_of(uint32_t reference) const {
  if (reference == 0) return time_;
  if (reference > variables_.all.size()) return notified_terminal(reference)->buffers.notified ? 1 : 0;
  const Variable& variable = variables_.all[reference - 1];
  const double value = variable.value_of(variable.signal.read());
  return variable.type == Type::Real ? value : std::clamp<double>(value, INT32_MIN, INT32_MAX);
}

Status Instance::set(std::span<const uint32_t> references, Types types, const std::function<double(size_t)>& value) {
  if (const Status wrong = check(references, types); wrong != Status::Ok) return wrong;
  for (const uint32_t reference : references)
    if (notified_terminal(reference) == nullptr && (reference == 0 || !variables_.all[reference - 1].is_settable()))
      return fail(fmt::format("{} cannot be set", reference == 0 ? "time" : variables_.all[reference - 1].name));
  Status worst = Status::Ok;
  for (size_t n = 0; n < references.size(); ++n) {
    BusTerminal* terminal = notified_terminal(references[n]);
    worst = std::max(worst, terminal != nullptr ? set_notified(*terminal, value(n) != 0) : set(variables_.all[references[n] - 1], value(n)));
  }
  return worst;
}

// What is there already is not written again: importers give every input before each step, and of an analog input the other line
// would be taken off.
Status Instance::set(const Variable& variable, double value) {
  const auto refuse = [&](std::string_view why) {
    return fail(Status::Discard, kWarnings, fmt::format("{} := {}: {}", variable.name, value, why));
  };
  const double exact = value / variable.per_sample;
  if (!(std::abs(exact) < 1e15)) return refuse("is out of range");
  const int64_t sample = std::llround(exact);
  const bool in_range = !variable.range || variable.signal.parameter != nullptr ||
                        (variable.range->first <= sample && sample <= variable.range->second);
  if (!in_range || variable.signal.check(sample)) return refuse("is out of range");
  const bool is_driven = variable.signal.group == signals::Group::Drive;  // where the shaft is follows a millisecond later
  if (!is_driven && sample == variable.signal.read()) return Status::Ok;
  const auto id = library::id_of(session_->plant(), variable.signal).value();
  if (const auto refused = session_->write(id, variable.signal, sample)) return refuse(*refused);
  return Status::Ok;
}

}  // namespace ipos::fmi

// The whole system from one seed: a random plant with its programs in trouble runs on every engine, in turn and not, and is
// the same each time; no telegram comes torn, exchanges end when the trouble does, the plant does not grow, and what its
// stations keep is in their files at the end. A run that fails is made smaller before it is told.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "tests/campaign/promises.hpp"
#include "tests/campaign/trouble.hpp"
#include "tests/runtime/plant/loop_body.hpp"
#include "tests/runtime/plant/machine_code.hpp"
#include "tests/runtime/plant/picture.hpp"
#include "tests/runtime/plant/plant_rig.hpp"

namespace ipos::tests {
namespace {

using runtime::Plant;
using runtime::Time;

// A plant that grows without end would have more than this after some seconds.
constexpr size_t kMostEntries = 20'000;
constexpr size_t kMostBytes = 32 << 20;
// When all faults are over, and how long an exchange may still take then: some repeats of 50 ms on a line for all.
constexpr Time kQuiet = 3'500 * runtime::kMillisecond, kLongestExchange = runtime::kSecond;

struct Way {
  const char* name;
  bool lazy, fast, machine;
};
// The first one is the expected value.
constexpr Way kWays[] = {{"reference engine, in turn", false, false, false},
                         {"reference engine, lazy", true, false, false},
                         {"threaded code, lazy", true, true, false},
                         {"threaded code, in turn", false, true, false},
                         {"machine code, lazy", true, true, true}};

runtime::Execution execution_of(const Way& way) {
  runtime::Execution execution;
  execution.pace = way.lazy ? runtime::Pace::Lazy : runtime::Pace::InTurn;
  execution.fast = way.fast;
  if (way.machine) execution.compiler = machine_code;
  return execution;
}

void do_action(Plant& plant, const Action& action) {
  runtime::Station& station = *plant.stations()[action.target % plant.stations().size()];
  switch (action.kind) {
    case Action::Kind::PowerOff:
      if (station.powered()) station.power_off();
      break;
    case Action::Kind::PowerOn:
      if (!station.powered()) station.power_on();
      break;
    case Action::Kind::Send: plant.buses()[action.target]->send(action.message); break;
    case Action::Kind::Force: station.inputs().line(action.index).forced = static_cast<int8_t>(action.value); break;
    case Action::Kind::Write:
      if (station.powered())
        (void)station.drive().parameters().execute(runtime::ParameterService::WriteVolatile, action.index,
                                                   action.value);
      break;
    case Action::Kind::Store:
      if (station.powered())
        (void)station.drive().parameters().execute(runtime::ParameterService::Write, action.index, action.value);
      break;
    case Action::Kind::Look: break;
  }
}

// A new one for the files of one run.
class Folder {
 public:
  Folder() : path_(std::filesystem::temp_directory_path() / fmt::format("ipos-campaign-{}", getpid())) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directory(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

// What a unit has kept, right after its power is on: parameters but those that the plant file sets at the begin of every
// run, H0 to H127, and the fault that a memory with nothing whole in it is (F94) or one that cannot be read (F25).
std::string kept(const Plant& plant) {
  constexpr size_t kKeptVariables = 128;
  std::string out;
  for (const auto& owned : plant.stations()) {
    const runtime::Station& station = *owned;
    const auto& parameters = station.drive().parameters();
    std::set<std::string, std::less<>> set;
    for (const auto& setting : station.config().parameters) set.insert(setting.parameter);
    out += fmt::format("{}: F{}", station.config().name, station.drive().state().fault());
    for (const stdlib::Parameter& row : parameters.table().rows())
      if (row.nonvolatile && row.writable && !set.contains(fmt::format("P{}", row.number)))
        out += fmt::format(" {}={}", row.index, parameters.value(row.index));
    if (const vm::Machine* machine = station.machine())
      for (const int32_t value : machine->variables().first(kKeptVariables)) out += fmt::format(" {}", value);
    out += '\n';
  }
  return out;
}

// What each look sees, and at the end all that was on the buses.
struct Course {
  std::vector<std::string> looks;
  std::string frames, telegrams;
  size_t entries = 0, bytes = 0;
  std::optional<std::string> torn, endless;
  std::string kept,
      found;  // by the stations after a power cut at the end, and by new ones with the same files
};

std::optional<Course> run(const Trouble& trouble, const Way& way) {
  const Folder folder;
  const size_t bytes_before = heap_bytes();
  const auto make = [&] {
    return make_plant(trouble.text(folder.path()), trouble.programs, std::nullopt, execution_of(way));
  };
  auto made = make();
  if (!made) return std::nullopt;
  Watched watched(std::move(made));
  Plant& plant = *watched.plant;
  for (const auto& bus : plant.buses()) bus->attach_hand();
  Course course;
  const auto look = [&] {
    course.looks.push_back(picture(plant));
    if (!course.torn) course.torn = torn_telegram(plant);
  };
  for (const Action& action : trouble.actions) {
    plant.run_until(action.at);
    do_action(plant, action);
    if (action.kind == Action::Kind::Look) look();
  }
  plant.run_until(trouble.end);
  look();
  course.frames = watched.frames.str();
  course.telegrams = watched.telegrams.str();
  course.entries = plant.journal().entries().size();
  course.bytes = heap_bytes() - bytes_before;
  if (way.lazy && !trouble.files) {  // with files all ways have to end at the same time
    plant.run_until(kQuiet);
    const Exchanges waiting(plant);
    plant.run_until(kQuiet + kLongestExchange);
    course.endless = Exchanges(plant).same_as(waiting);
    if (!course.torn) course.torn = torn_telegram(plant);
  }
  if (trouble.files) {
    for (const auto& station : plant.stations()) {
      if (station->powered()) station->power_off();
      station->power_on();
    }
    course.kept = kept(plant);
    watched.plant.reset();  // it has locked its files
    made = make();
    if (!made) return std::nullopt;
    course.found = kept(*made);
  }
  return course;
}

// The words of a picture that differ, with what is expected before them.
std::string difference(const std::string& expected, const std::string& actual) {
  std::istringstream wanted(expected), had(actual);
  std::string out;
  std::string wanted_line, had_line;
  for (int line = 1; std::getline(wanted, wanted_line); ++line) {
    if (!std::getline(had, had_line)) return out + fmt::format("line {} '{}' is missing", line, wanted_line);
    if (wanted_line == had_line) continue;
    std::istringstream left(wanted_line), right(had_line);
    std::string a, b;
    out += fmt::format("line {}", line);
    for (int word = 1; left >> a && right >> b; ++word)
      if (a != b) out += fmt::format(" word {}: {} not {},", word, a, b);
    out += '\n';
  }
  if (std::getline(had, had_line)) out += fmt::format("'{}' is too much\n", had_line);
  return out;
}

// Nothing, or what is wrong with it.
std::optional<std::string> complaint(const Trouble& trouble) {
  const auto expected = run(trouble, kWays[0]);
  if (!expected) return "the plant is refused";
  if (expected->torn) return "torn: " + *expected->torn;
  if (expected->found != expected->kept)
    return fmt::format("in the files: {}", difference(expected->kept, expected->found));
  if (expected->entries > kMostEntries) return fmt::format("{} entries in the journal", expected->entries);
  if (expected->bytes > kMostBytes) return fmt::format("{} bytes", expected->bytes);
  for (const Way& way : std::span(kWays).subspan(1)) {
    const auto course = run(trouble, way);
    if (!course) return fmt::format("{}: the plant is refused", way.name);
    for (size_t look = 0; look < expected->looks.size(); ++look)
      if (course->looks[look] != expected->looks[look])
        return fmt::format("{}: look {}: {}", way.name, look,
                           difference(expected->looks[look], course->looks[look]));
    if (course->torn) return fmt::format("{}: torn: {}", way.name, *course->torn);
    if (course->endless)
      return fmt::format("{}: {} waits for an answer without end", way.name, *course->endless);
    if (course->frames != expected->frames) return fmt::format("{}: frames differ", way.name);
    if (course->telegrams != expected->telegrams) return fmt::format("{}: telegrams differ", way.name);
    if (course->kept != expected->kept)
      return fmt::format("{}: kept: {}", way.name, difference(expected->kept, course->kept));
  }
  return std::nullopt;
}

template <typename Part>
void leave_out(std::vector<Part> Trouble::*parts, Trouble& trouble) {
  for (size_t length = (trouble.*parts).size(); length > 0; length /= 2)
    for (size_t at = 0; at < (trouble.*parts).size();) {
      Trouble less = trouble;
      const auto begin = (less.*parts).begin() + static_cast<std::ptrdiff_t>(at);
      (less.*parts)
          .erase(begin, begin + static_cast<std::ptrdiff_t>(std::min(length, (less.*parts).size() - at)));
      if (complaint(less))
        trouble = std::move(less);
      else
        at += length;
    }
}

// Without the actions and faults that it does not need, and no longer than it must be.
Trouble smaller(Trouble trouble) {
  leave_out(&Trouble::actions, trouble);
  leave_out(&Trouble::faults, trouble);
  for (Time shorter = trouble.end / 2; shorter > runtime::kMillisecond; shorter /= 2) {
    Trouble less = trouble;
    less.end -= shorter;
    if ((less.actions.empty() || less.actions.back().at <= less.end) && complaint(less))
      trouble = std::move(less);
  }
  return trouble;
}

TEST(Campaign, PlantsInTroubleAreTheSameInAllWays) {
  for (uint64_t seed = first_plant(); seed <= plant_count(60); ++seed) {
    if (seed % 1000 == 0) std::cout << "seed " << seed << std::endl;
    const Trouble trouble = draw_trouble(seed);
    if (!complaint(trouble)) continue;
    const Trouble least = smaller(trouble);
    ADD_FAILURE() << *complaint(least) << '\n' << describe(least);
  }
}

// The same seed is the same trouble, and what is left out of it is gone.
TEST(Campaign, TroubleIsDrawnFromItsSeed) {
  EXPECT_EQ(describe(draw_trouble(7)), describe(draw_trouble(7)));
  EXPECT_NE(describe(draw_trouble(7)), describe(draw_trouble(8)));
}

}  // namespace
}  // namespace ipos::tests

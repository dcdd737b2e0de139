// Finds signals by name and samples them.
#include "tools/recording/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

#include "runtime/station/bus.hpp"
#include "tools/cli/failure.hpp"

namespace ipos::tools {
namespace {

using runtime::Station;

constexpr std::string_view kFrames = ".frames";

// A part has so many rows: what is held in memory, and how late a trace is (ours).
constexpr size_t kPartRows = 100;

// Fault number, or the condition of the unit.
constexpr int64_t kFaults = 1000;
int64_t state_of(const runtime::Drive& drive) {
  return drive.fault() != 0 ? kFaults + drive.fault() : static_cast<int64_t>(drive.condition());
}
std::string state_text(int64_t state) {
  if (state >= kFaults) return fmt::format("F{:02}", state - kFaults);
  return std::string(runtime::condition_text(static_cast<runtime::UnitCondition>(state)));
}

std::string frames_text(const runtime::Plant& plant) {
  std::string text;
  for (const auto& bus : plant.buses()) text += fmt::format(", {}{}", bus->name(), kFrames);
  return text;
}

// Number of the first row that is not before `time`.
size_t row_of(const std::vector<runtime::Time>& times, runtime::Time time) {
  if (times.empty() || time <= times.front()) return 0;
  const auto guess = static_cast<size_t>((time - times.front() - 1) / runtime::kMillisecond + 1);
  if (guess < times.size() && times[guess] >= time && times[guess - 1] < time) return guess;
  return static_cast<size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
}

}  // namespace

// What only a decision of the drive changes: read where the drive has decided, also in ticks that are executed late,
// so that nobody has to execute them in their turn (runtime/station/station.hpp).
class Recorder::Decided final : public runtime::DriveWatcher {
 public:
  explicit Decided(Station& station) : station_(station) {
    state_.known = state_.last = state_of(station.drive().state());
    told_ = state_text(state_.known);
  }
  Station& station() { return station_; }
  void add(int64_t (*read)(const runtime::Drive&), Course& course) { values_.push_back({read, &course}); }
  void watch() { watched_ = true; }

  // What others have written since the last tick is in no tick yet.
  void sample(runtime::Time now) {
    if (station_.behind()) return;
    const runtime::Drive& drive = std::as_const(station_).drive().state();
    if (drive.changes() != changes_) on_decided(drive, now);
  }

  void on_decided(const runtime::Drive& drive, runtime::Time tick) override {
    for (const Value& value : values_) value.course->note(tick, value.read(drive));
    changes_ = drive.changes();
    if (watched_) state_.note(tick, state_of(drive));
  }

  Course& state() { return state_; }
  // As a text; empty when it is the one that was told last.
  std::string tell(int64_t state) {
    std::string text = state_text(state);
    if (text == told_) return {};
    return told_ = std::move(text);
  }

 private:
  struct Value {
    int64_t (*read)(const runtime::Drive&);
    Course* course;
  };

  Station& station_;
  std::vector<Value> values_;
  uint32_t changes_ = 0;  // Drive::changes() by then
  bool watched_ = false;
  Course state_;
  std::string told_;
};

RecordedPart part_of(const Recording& recording) {
  RecordedPart part{recording.times, {}, recording.events, recording.frames};
  for (size_t n = 0; n < recording.signals.size(); ++n)
    for (size_t row = 0; row < recording.times.size(); ++row)
      if (const auto& samples = recording.samples[n]; row == 0 || samples[row] != samples[row - 1])
        part.changes.push_back({row, n, samples[row]});
  return part;
}

void add_part(Recording& all, const RecordedPart& part) {
  const size_t before = all.times.size(), after = before + part.times.size();
  auto change = part.changes.begin();
  for (size_t n = 0; n < all.samples.size(); ++n) {
    std::vector<int64_t>& samples = all.samples[n];
    int64_t sample = samples.empty() ? 0 : samples.back();
    for (; change != part.changes.end() && change->signal == n; ++change) {
      samples.resize(before + change->row, sample);
      sample = change->sample;
    }
    samples.resize(after, sample);
  }
  all.times.insert(all.times.end(), part.times.begin(), part.times.end());
  all.events.insert(all.events.end(), part.events.begin(), part.events.end());
  all.frames.insert(all.frames.end(), part.frames.begin(), part.frames.end());
}

const std::vector<Change>& ByRow::of(const RecordedPart& part) {
  places_.assign(part.times.size() + 1, 0);
  for (const Change& change : part.changes) ++places_[change.row + 1];
  std::partial_sum(places_.begin(), places_.end(), places_.begin());
  changes_.resize(part.changes.size());
  for (const Change& change : part.changes) changes_[places_[change.row]++] = change;
  return changes_;
}

bool is_binary(const Recording& recording, size_t number) {
  const Signal& signal = recording.signals[number];
  if (signal.bits != 0) return signal.bits == 1;
  const auto& samples = recording.samples[number];
  const auto beyond = [](int64_t sample) { return sample != 0 && sample != 1; };
  return signal.unit.empty() && signal.factor == 1 &&
         std::find(samples.begin(), samples.end(), 1) != samples.end() &&
         std::none_of(samples.begin(), samples.end(), beyond);
}

Recorder::~Recorder() = default;

Recorder::Recorder(runtime::Plant& plant, const std::vector<std::string>& names) : plant_(plant) {
  for (const std::string& name : names) add(name);
  if (names.empty())
    for (const auto& station : plant.stations())
      for (Signal& signal : signals::default_signals(*station)) add(std::move(signal));
  for (const auto& decided : decided_) decided->station().add_watcher(*decided);
}

void Recorder::add(const std::string& name) {
  if (add_frames(name)) return;
  auto found = signals::find_signals(plant_, name);
  if (!found) throw Failure(kUsage, found.error() + frames_text(plant_));
  for (Signal& signal : *found) add(std::move(signal));
}

void Recorder::add(Signal signal) {
  Course& course = courses_.emplace_back();
  course.known = course.last = signal.read();
  if (signal.decided != nullptr || signal.is_status)
    for (const auto& station : plant_.stations()) {
      if (station->config().name != signal.station) continue;
      Decided& decided = decided_of(*station);
      if (signal.decided != nullptr) decided.add(signal.decided, course);
      if (!signal.is_status) continue;
      decided.watch();
      watched_.push_back(&decided);
    }
  if (signal.decided == nullptr) asked_.push_back(recording_.signals.size());
  recording_.signals.push_back(std::move(signal));
  recording_.samples.emplace_back();
}

Recorder::Decided& Recorder::decided_of(runtime::Station& station) {
  for (const auto& decided : decided_)
    if (&decided->station() == &station) return *decided;
  return *decided_.emplace_back(std::make_unique<Decided>(station));
}

bool Recorder::add_frames(std::string_view name) {
  if (!name.ends_with(kFrames)) return false;
  runtime::Bus* bus = plant_.find_bus(name.substr(0, name.size() - kFrames.size()));
  if (bus == nullptr) return false;
  if (track_of(bus->name())) return true;
  bus->add_observer(*this);
  recording_.tracks.push_back({bus->name(), runtime::as<runtime::CanBus>(bus) != nullptr});
  return true;
}

std::optional<size_t> Recorder::track_of(const std::string& bus) const {
  for (size_t n = 0; n < recording_.tracks.size(); ++n)
    if (recording_.tracks[n].bus == bus) return n;
  return std::nullopt;
}

// A telegram is known to be void some time after its last character.
void Recorder::on_message(const runtime::Bus& bus, const runtime::BusMessage& message) {
  const auto behind =
      std::upper_bound(frames_.begin(), frames_.end(), message.end,
                       [](runtime::Time time, const RecordedFrame& other) { return time < other.time; });
  const runtime::Frame frame = message.frame.value_or(runtime::Frame{});
  frames_.insert(behind, {message.end, *track_of(bus.name()), frame.id, frame.extended, frame.remote,
                          message.bytes, message.meaning.empty() ? message.text : message.meaning});
}

void Recorder::give_to(PartReader& reader, bool keep) {
  reader_ = &reader;
  keeps_ = keep;
}

void Recorder::finish() {
  for (const FrameTrack& track : recording_.tracks) plant_.find_bus(track.bus)->finish();
  gather(true);
}

const Recording& Recorder::recording() {
  gather(true);
  return recording_;
}

void Recorder::sample(runtime::Time now) {
  if (now % runtime::kMillisecond != 0) return;
  times_.push_back(now);
  for (const size_t n : asked_) courses_[n].note(now, recording_.signals[n].read());
  for (const auto& decided : decided_) decided->sample(now);
  if (times_.size() >= kPartRows) gather(false);
}

// The rows of which all is known, as a part; `all`: those there are.
void Recorder::gather(bool all) {
  for (const auto& decided : decided_) decided->station().look();  // late ticks tell what they have decided
  runtime::Time told = plant_.now();
  for (const FrameTrack& track : recording_.tracks)
    told = std::min(told, plant_.find_bus(track.bus)->told_until(plant_.now()));
  const auto end = all ? times_.end() : std::upper_bound(times_.begin(), times_.end(), told);
  RecordedPart& part = part_;
  part.times.assign(times_.begin(), end);
  part.events.clear();
  times_.erase(times_.begin(), end);
  if (part.times.empty()) part.changes.clear();
  if (!part.times.empty()) take_changes(part);
  if (!part.times.empty()) take_events(part);
  take_frames(part, all);
  if (reader_ != nullptr) reader_->take(part);
  if (keeps_) add_part(recording_, part);
}

// Of all points that fall into one row the last one counts.
template <typename Take>
void Recorder::take_points(Course& course, const std::vector<runtime::Time>& rows, Take take) {
  size_t n = 0, row = 0;
  const std::span<const Point> points = course.points;
  const runtime::Time last = rows.back();
  while (n < points.size() && points[n].time <= last) {
    if (rows[row] != points[n].time) row = row_of(rows, points[n].time);
    while (n + 1 < points.size() && points[n + 1].time <= rows[row]) ++n;
    take(row, points[n++].sample);
    if (row + 1 < rows.size()) ++row;  // what moves has another value in each
  }
  course.points.erase(course.points.begin(), course.points.begin() + static_cast<std::ptrdiff_t>(n));
}

void Recorder::take_changes(RecordedPart& part) {
  size_t most = courses_.size();
  for (const Course& course : courses_) most += course.points.size();
  part.changes.resize(most);
  Change* change = part.changes.data();
  for (size_t n = 0; n < courses_.size(); ++n) {
    Course& course = courses_[n];
    const auto add = [&](size_t row, int64_t sample) {
      if (!begun_ && row == 0) --change;
      if (sample == course.known && (begun_ || row != 0)) return;
      course.known = sample;
      *change++ = {row, n, sample};
    };
    if (!begun_) *change++ = {0, n, course.known};
    take_points(course, part.times, add);
  }
  part.changes.resize(static_cast<size_t>(change - part.changes.data()));
  begun_ = true;
}

void Recorder::take_events(RecordedPart& part) {
  for (const auto& decided : decided_) {
    const auto times = std::count(watched_.begin(), watched_.end(), decided.get());
    const std::string& name = decided->station().config().name;
    const std::string who = plant_.stations().size() == 1 ? "" : name + ": ";
    take_points(decided->state(), part.times, [&](size_t row, int64_t state) {
      const std::string text = decided->tell(state);
      const RecordedEvent event{part.times[row], who + text, text.starts_with('F')};
      if (!text.empty()) part.events.insert(part.events.end(), static_cast<size_t>(times), event);
    });
  }
  std::stable_sort(part.events.begin(), part.events.end(),
                   [](const RecordedEvent& a, const RecordedEvent& b) { return a.time < b.time; });
}

void Recorder::take_frames(RecordedPart& part, bool all) {
  const runtime::Time last = part.times.empty() ? -1 : part.times.back();
  const auto end = std::find_if(frames_.begin(), frames_.end(),
                                [&](const RecordedFrame& frame) { return !all && frame.time > last; });
  part.frames.assign(std::make_move_iterator(frames_.begin()), std::make_move_iterator(end));
  frames_.erase(frames_.begin(), end);
}

}  // namespace ipos::tools

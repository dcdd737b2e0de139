// Who is on two lines joins them; what is left apart is an island.
#include "runtime/plant/islands.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "runtime/plant_file/line_names.hpp"

namespace ipos::runtime {
namespace {

// Waking a thread takes some 10 us: shorter ways are gone by one alone (ours).
constexpr Time kWorthThreads = 10 * kMillisecond;

// Sets of numbers that grow together. Each has its least number as its name.
class GrowingSets {
 public:
  explicit GrowingSets(size_t count) : to_(count) { std::iota(to_.begin(), to_.end(), size_t{0}); }
  size_t find(size_t n) const { return to_[n] == n ? n : find(to_[n]); }
  void join(size_t a, size_t b) {
    const auto [least, most] = std::minmax({find(a), find(b)});
    to_[most] = least;
  }

 private:
  std::vector<size_t> to_;
};

bool is_joined_to_the_outside(const PlantFile& file) {
  return !file.machines.empty() ||
         std::any_of(file.buses.begin(), file.buses.end(), [](const BusConfig& bus) { return !bus.port.empty(); });
}

}  // namespace

Islands::Islands(const PlantFile& file, EventQueue& whole, Journal& journal, unsigned threads)
    : whole_(whole), journal_(journal), file_(file), crew_(threads) {
  if (threads == 0 || is_joined_to_the_outside(file)) return;
  // A number for each line, and one for all that is on no line.
  const size_t alone = file.buses.size();
  GrowingSets joined(alone + 1);
  const auto land = [&](const auto& configs) {
    std::vector<size_t> first;
    for (const auto& config : configs) {
      order_.push_back(config.name);
      size_t on = alone;
      for (const std::string& line : line_names(config)) {
        const auto bus = std::find_if(file.buses.begin(), file.buses.end(), [&](const BusConfig& row) { return row.name == line; });
        if (bus == file.buses.end()) continue;
        const auto number = static_cast<size_t>(bus - file.buses.begin());
        if (on != alone) joined.join(on, number);
        on = number;
      }
      first.push_back(on);
    }
    return first;
  };
  of_station_ = land(file.stations);
  of_control_ = land(file.controls);
  of_bus_.resize(file.buses.size());
  std::iota(of_bus_.begin(), of_bus_.end(), size_t{0});

  std::vector<size_t> names;  // of the islands, in their order
  for (std::vector<size_t>* list : {&of_bus_, &of_station_, &of_control_})
    for (size_t& number : *list) {
      const size_t name = joined.find(number);
      const auto known = std::find(names.begin(), names.end(), name);
      number = static_cast<size_t>(known - names.begin());
      if (known == names.end()) names.push_back(name);
    }
  if (names.size() < 2) return;
  for (size_t n = 0; n < names.size(); ++n) {
    Island& island = *islands_.emplace_back(std::make_unique<Island>());
    island.journal.ask_first([&island] {
      for (const auto& latecomer : island.latecomers) latecomer();
    });
  }
}

Islands::Place Islands::at(const std::vector<size_t>& islands, size_t number) {
  if (islands_.empty()) return {whole_, journal_, 0};
  Island& island = *islands_[islands[number]];
  return {island.queue, island.journal, islands[number]};
}

Islands::Place Islands::of_bus(std::string_view name) {
  const auto bus = std::find_if(file_.buses.begin(), file_.buses.end(), [&](const BusConfig& row) { return row.name == name; });
  return at(of_bus_, static_cast<size_t>(bus - file_.buses.begin()));
}

Islands::Place Islands::of_station(size_t number) { return at(of_station_, number); }

Islands::Place Islands::of_control(size_t number) { return at(of_control_, number); }

void Islands::ask_first(size_t station, std::function<void()> latecomer) {
  if (!islands_.empty()) islands_[of_station_[station]]->latecomers.push_back(std::move(latecomer));
}

Time Islands::next_time() const {
  Time first = whole_.next_time();
  for (const auto& island : islands_) first = std::min(first, island->queue.next_time());
  return first;
}

void Islands::run(Time length, const std::function<void(EventQueue&)>& part) {
  const auto one = [&](size_t island) { part(islands_[island]->queue); };
  if (length >= kWorthThreads)
    crew_.share(islands_.size(), one);
  else
    for (size_t n = 0; n < islands_.size(); ++n) one(n);
}

void Islands::run_until(Time end) {
  if (islands_.empty()) return whole_.run_until(end);
  while (whole_.next_time() <= end && whole_.next_time() != kNever) {
    const EventQueue::Moment moment = whole_.next_moment();
    run(moment.at - whole_.now(), [&](EventQueue& queue) { queue.run_before(moment); });
    gather();
    whole_.step();
  }
  run(end - whole_.now(), [&](EventQueue& queue) { queue.run_until(end); });
  whole_.run_until(end);
  gather();
}

void Islands::gather() {
  const auto has_new = [](const auto& island) { return island->gathered < island->journal.entries().size(); };
  if (std::none_of(islands_.begin(), islands_.end(), has_new)) return;
  std::vector<JournalEntry> notes;
  for (const auto& island : islands_) {
    for (const auto& latecomer : island->latecomers) latecomer();
    const std::vector<JournalEntry>& all = island->journal.entries();
    notes.insert(notes.end(), all.begin() + static_cast<std::ptrdiff_t>(island->gathered), all.end());
    island->gathered = all.size();
  }
  // Lines come first, as their events do.
  const auto rank = [&](const JournalEntry& entry) {
    return entry.station.empty() ? -1 : std::find(order_.begin(), order_.end(), entry.station) - order_.begin();
  };
  std::stable_sort(notes.begin(), notes.end(), [&](const JournalEntry& a, const JournalEntry& b) {
    return a.time != b.time ? a.time < b.time : rank(a) < rank(b);
  });
  for (JournalEntry& entry : notes) journal_.take(std::move(entry));
}

}  // namespace ipos::runtime

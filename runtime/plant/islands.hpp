// The islands of a plant: lines with their stations and controls that no station and no gateway joins to other lines. Each
// has a queue of events and a journal of its own. So one runs on its own for a while, as long as its stations are at hand in
// the caches, and then the next; or several run at once, on threads. Wires, encoder cables, switches and stimuli act on all
// islands alike: at their moment every island has come so far. The order of events within an island is that of one queue, so
// results are the same.
#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "runtime/clock/event_queue.hpp"
#include "runtime/journal/journal.hpp"
#include "runtime/plant/crew.hpp"
#include "runtime/plant_file/plant_file.hpp"

namespace ipos::runtime {

class Islands {
 public:
  // One island, or threads == 0: everything is in `whole` and `journal`, as it is for plants that are joined to something
  // outside. Otherwise these have what acts on all islands. All references must outlive it.
  Islands(const PlantFile& file, EventQueue& whole, Journal& journal, unsigned threads);

  struct Place {
    EventQueue& queue;
    Journal& journal;
    size_t island;  // below count()
  };
  Place of_bus(std::string_view name);
  Place of_station(size_t number);  // in the order of the file, as controls
  Place of_control(size_t number);

  size_t count() const { return islands_.empty() ? 1 : islands_.size(); }
  EventQueue::Moment moment(size_t island) const { return (islands_.empty() ? whole_ : islands_[island]->queue).moment(); }
  // What is late there adds its notes before others do.
  void ask_first(size_t station, std::function<void()> latecomer);

  Time next_time() const;
  // As EventQueue has it. The journal has all notes afterwards.
  void run_until(Time end);

  // Brings the notes of all islands into the journal, in the order of their times, then of the file.
  void gather();

 private:
  struct Island {
    EventQueue queue;
    Journal journal;
    std::vector<std::function<void()>> latecomers{};
    size_t gathered = 0;  // notes
  };
  Place at(const std::vector<size_t>& islands, size_t number);
  void run(Time length, const std::function<void(EventQueue&)>& part);

  EventQueue& whole_;
  Journal& journal_;
  std::vector<std::string_view> order_;  // stations, then controls: who comes first among equal times
  std::vector<size_t> of_bus_, of_station_, of_control_;  // islands, by numbers of the file
  const PlantFile& file_;
  std::vector<std::unique_ptr<Island>> islands_;  // empty: there is one
  Crew crew_;
};

}  // namespace ipos::runtime

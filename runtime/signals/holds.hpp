// What is forced: which signals, with what value, by what, and until when. The surroundings of a plant have one and let it
// act at the beginning of each millisecond; front ends ask it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/signals/signal.hpp"

namespace ipos::signals {

struct Hold {
  Signal signal;
  int32_t value;
  uint64_t number;            // each one has its own
  std::string_view by;                      // "the plant file", "a person"
  runtime::Time until = runtime::kNever;
  std::optional<int32_t> before{};          // to be written at the end
};

class Holds {
 public:
  // Of what is refused while it is held or given back.
  using Refused = std::function<void(const Signal& signal, std::string text)>;
  explicit Holds(Refused refused) : refused_(std::move(refused)) {}

  // From now on; an input also against wires and switches. Who holds the signal already goes on with the new value.
  Hold& hold(const Signal& signal, int32_t value, std::string_view by);
  // All that hold the terminal of the signal, a debugger too; or one by its number.
  void release(const Signal& signal);
  void release(uint64_t number);

  // Writes again what something else has changed; a word comes each time, like telegrams of a master that never rests.
  void act();

  bool empty() const { return all_.empty(); }
  // Null: it is not forced.
  const Hold* find(const Signal& signal) const;
  const std::vector<Hold>& all() const { return all_; }

 private:
  void end(size_t n);
  void write(const Signal& signal, int32_t value) const;

  std::vector<Hold> all_;
  uint64_t made_ = 0;
  Refused refused_;
};

// Whether the signal is forced, by a hold or by a debugger.
bool is_forced(const Holds& holds, const Signal& signal);

}  // namespace ipos::signals

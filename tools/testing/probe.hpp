// What a test sees of its plant beside the expectations: how the signals it names went, the last frames,
// where the programs stand, what was ignored and why. A report shows it where something is wrong.
#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "runtime/bus/words/bus_words.hpp"
#include "tools/test_file/test_case.hpp"
#include "tools/testing/result.hpp"

namespace ipos::tools::testing {

using Reader = std::function<int64_t()>;

class Probe final : private runtime::BusObserver {
 public:
  // `on_event` hears every frame and telegram: bus, time, bytes, meaning. The plant must outlive the probe.
  using Listener = std::function<void(const std::string&, Time, const std::string&, const std::string&)>;
  Probe(runtime::Plant& plant, Listener on_event);
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  // Follows a subject with a value from now on and says how to read it; an empty function and why when the
  // station has no such thing.
  Reader follow(const Subject& subject, std::string& why);
  void sample(Time now);

  // Everything worth knowing about what `subject` looks at, as it is now.
  void describe(const Subject& subject, Finding& finding) const;

  runtime::Station& station(const std::string& name);  // which exists

 private:
  struct Change {
    Time time;
    int64_t value;
  };
  struct Followed {
    Subject subject;
    Reader read;
    std::deque<Change> changes;  // the last ones
  };
  struct Shown {
    const runtime::Bus* bus;
    runtime::BusMessage message;
  };

  void on_message(const runtime::Bus& bus, const runtime::BusMessage& message) override;
  std::string words_of(const Shown& shown, runtime::BusWords& words) const;
  Reader reader_of(const Subject& subject, std::string& why);
  std::vector<std::string> tasks_of(const std::string& station) const;

  runtime::Plant& plant_;
  Listener on_event_;
  std::deque<Followed> followed_;
  std::deque<Shown> shown_;  // the last ones; their words are made when they are asked for
  runtime::BusWords words_;  // has listened to all before them
};

}  // namespace ipos::tools::testing

// The scope of the page, one for all clients: channels, trigger, memory, views and CSV. It knows neither plant nor drive:
// a source has the channels and the events that it can trigger on. It samples as `ipos run --trace` does, and its CSV is
// written by the same code, so both have the same digits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/signals/find.hpp"
#include "tools/recording/recording.hpp"
#include "tools/serve/host/router.hpp"
#include "tools/serve/host/scope_memory.hpp"

namespace ipos::tools::serve {

class ScopeSource {
 public:
  // What a name stands for. A Mistake says what there is.
  virtual std::vector<signals::Signal> find_channels(const std::string& name) = 0;
  virtual runtime::Time now() const = 0;
  // Watches for an event of this kind from now on, and calls Scope::happened(). Ends what it watched for before; the kinds
  // none, level and edge are the scope's. A Mistake says why it cannot.
  virtual void watch_for(const std::string& kind, const Arguments& settings) = 0;
  virtual void stop(const std::string& why) = 0;  // the trigger is to stop the plant
  virtual void triggered(const std::string& /*why*/) {}
  // What does again what was until now, with a scope that was told to fill_for() this one. Nothing: it cannot.
  virtual std::unique_ptr<SecondRun> run_again() { return nullptr; }

 protected:
  ~ScopeSource() = default;
};

class Scope final {
 public:
  // Adds its commands and its topic.
  Scope(Router& router, ScopeSource& source, Copies& copies);

  static constexpr size_t kMostChannels = ScopeMemory::kMostChannels;

  // The channels of the start; nothing where a client has chosen others.
  void propose(std::vector<std::string> names);
  const std::vector<std::string>& names() const { return names_; }
  // The settings of an earlier start, as far as there still is what they name.
  void restore(const Json& settings);
  // The signals are others: a new recording. What the plant has no more is left out. Where a plant without copies goes back it
  // was built to do the same once more: what is recorded of later times stays.
  void built();
  // A program has other names by now: the recording goes on.
  void renamed();
  void restarted() {
    is_another_ = true;
    armed_at_ = 0;
    hand_at_.reset();
  }
  // What came later does not come any more.
  void dropped();
  // This one runs again what was, and fills in what the first one does not know. The two may be one, in a copy of the process.
  void fill_for(Scope& first);
  // Now and then, between two milliseconds: what was recorded too late for some channel is computed.
  void tend();
  // A millisecond is over.
  void passed(runtime::Time now);
  // What the source watches for.
  void happened(runtime::Time at, std::string why) { seen_ = {at, std::move(why)}; }

  // What it reads each millisecond: its channels, and the signal of its trigger.
  std::vector<const signals::Signal*> asked() const;
  // A recording is to be triggered or ended.
  bool waits() const { return state_ == State::Armed || state_ == State::Triggered; }

  // What a copy of the host that goes on must know.
  Json save();
  void load(const Json& state);

 private:
  enum class State : uint8_t { Free, Armed, Triggered, Done };

  // What starts a recording, beside the events of the source.
  struct Trigger {
    Json settings{{"kind", "none"}};
    std::string kind = "none";
    std::optional<signals::Signal> signal{};  // of level and edge
    double value = 0;
    bool below = false;
    bool rising = false, falling = false;
    bool stops = false;
  };

  void set(const Arguments& settings);
  Trigger trigger_of(const Json& json);
  std::vector<signals::Signal> find(const std::vector<std::string>& names);
  std::vector<std::string> known(std::vector<std::string> names);
  void find_trigger();
  void choose(std::vector<signals::Signal> channels);
  void begin_again(bool is_another);
  void arm(bool single);
  void fire(runtime::Time at, const std::string& why);
  void record(uint64_t number);
  void fill(uint64_t number);
  void compute();
  void look(runtime::Time now);
  std::optional<std::string> value_triggers();

  // What is shown of the memory: a complete recording ends where it was complete.
  uint64_t first() const { return std::min(memory_.first(), end()); }
  uint64_t end() const { return state_ == State::Done ? done_end_ : memory_.end(); }
  uint64_t later_end() const { return state_ == State::Done ? done_end_ : memory_.later_end(); }
  uint64_t number_at(int64_t us, uint64_t end) const;
  std::vector<size_t> incomplete() const;
  Json describe() const;
  std::string points(uint64_t begin, uint64_t end, uint64_t step, uint32_t id, bool exact = false) const;
  Json view(const Router::Call& call);
  // Those that wait until all is computed; null then.
  using Answer = Json (Scope::*)(const Router::Call&);
  Json when_complete(const Router::Call& call, const char* name, Answer answer);
  Json csv(const Router::Call& call);
  Json picture(const Router::Call& call);
  Recording recorded(uint64_t begin, uint64_t end) const;
  void publish(Client& client, Subscription& subscription);

  Router& router_;
  ScopeSource& source_;
  std::vector<std::string> names_;
  std::vector<signals::Signal> channels_;
  ScopeMemory memory_;
  std::vector<int64_t> samples_;
  runtime::Time last_ = 0;  // the last millisecond looked at
  uint32_t recording_ = 0;
  uint64_t orders_ = 0;  // that the state of the trigger depends on, since the start of all
  Trigger trigger_;
  int64_t pre_ = 20;
  int64_t length_ms_ = 5'000;
  State state_ = State::Free;
  bool single_ = false;
  runtime::Time armed_at_ = 0;
  std::optional<runtime::Time> hand_at_;  // somebody triggered by hand, and does it again when that moment comes again
  uint64_t done_end_ = 0;  // after the last sample of a complete recording
  std::optional<runtime::Time> triggered_at_;
  std::string trigger_text_;
  std::optional<std::pair<runtime::Time, std::string>> seen_;  // what the source watches for
  std::optional<double> previous_;                             // of the trigger's signal

  // What the run up to now has of channels that were chosen later.
  bool is_another_ = true;  // plant: it does not do what was recorded
  bool asks_ = false;  // it is to be computed
  std::unique_ptr<SecondRun> computing_;
  ScopeMemory* fills_ = nullptr;  // this scope only computes, for this memory
  std::vector<size_t> late_;      // channels
  uint64_t filled_from_ = 0;
  struct Question {
    uint16_t client = 0;
    Json id, message;
    std::string name;  // of the command
    NLOHMANN_DEFINE_TYPE_INTRUSIVE(Question, client, id, message, name)
  };
  std::vector<Question> questions_;  // for files, until all is there
};

}  // namespace ipos::tools::serve

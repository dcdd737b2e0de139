// An open plant: its instance, the record of what was done to it, and its signals by number. A state is saved as the record
// and restored by doing it again; the trace hash is computed by running again from the start.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/library/contents.hpp"
#include "runtime/library/instance.hpp"
#include "runtime/plant/trace_hash.hpp"
#include "runtime/signals/find.hpp"

namespace ipos::library {

class Session {
 public:
  // `recorded`: the state can be saved and hashed, and the record grows with every action.
  static tl::expected<std::unique_ptr<Session>, Mistakes> open(Contents contents, bool recorded);

  Instance& instance() { return *instance_; }
  runtime::Plant& plant() { return instance_->plant(); }
  const runtime::Plant& plant() const { return instance_->plant(); }
  bool recorded() const { return recorded_; }

  void run(Time until) { plant().run_until(until); }
  // Asked now and at every full millisecond; false: the limit came first.
  bool run_until(Time limit, const std::function<bool()>& condition);

  // Does it now and puts it into the record.
  Refusal perform(Action action);
  // The same for a signal that the caller has found in the plant of now: without looking for it again.
  Refusal write(const SignalId& id, const signals::Signal& signal, int64_t value);
  uint32_t next_tag() { return ++tags_; }

  struct Signal {
    SignalId id;
    std::string name;
    signals::Signal shown;
    bool is_writable() const { return id.kind != Kind::Signal && shown.put != nullptr; }
  };
  uint32_t add_signal(const SignalId& id, std::string_view name);
  const Signal* signal(uint32_t number) const {
    return number < signals_.size() ? &signals_[number] : nullptr;
  }
  // Of an analog input the line that was set last.
  static signals::Signal now(const Signal& signal) { return signals::live_line(signal.shown); }
  static int64_t read(const Signal& signal);

  std::vector<uint8_t> save() const;
  enum class Restored : uint8_t { Done, Damaged, OtherPlant };
  // `look` is asked at every full millisecond on the way; then the session is already the one restored.
  Restored restore(std::span<const uint8_t> bytes, std::string& why, const std::function<void()>& look = {});

  // At time 0 again, with an empty record: the plant is built of what was read. Nothing, or why it cannot be.
  Refusal restart();

  uint64_t trace_hash();

 private:
  // The run once more, watched from its beginning, as far as somebody has asked.
  struct Shadow {
    explicit Shadow(std::unique_ptr<runtime::Plant> plant) : instance(std::move(plant)), hash(instance.plant()) {}
    Instance instance;
    runtime::TraceHash hash;
    size_t done = 0;  // actions
  };

  Session(Contents contents, std::unique_ptr<runtime::Plant> plant, bool recorded);

  void find_again(Signal& signal) const;
  void enter(std::unique_ptr<Instance>& instance);

  Contents contents_;
  std::unique_ptr<Instance> instance_;
  bool recorded_;
  std::vector<Action> record_;
  std::vector<Signal> signals_;
  uint32_t tags_ = 0;
  std::unique_ptr<Shadow> shadow_;
};

}  // namespace ipos::library

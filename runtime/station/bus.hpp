// A line of a plant, whatever its kind: what the plant, its reports, recordings and tests ask of it. A new kind of bus
// is a class of this in a source NAME_bus.cpp, and a row of bus_kinds.def (docs/inside/architecture.md). Who needs the line
// itself visits it: a case for each class, or it does not compile.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/bus/can/frame.hpp"
#include "runtime/bus/line/line_load.hpp"
#include "runtime/bus/line/node_id.hpp"
#include "runtime/clock/event_queue.hpp"
#include "runtime/plant_file/plant_file.hpp"
#include "runtime/station/visit.hpp"

namespace ipos::runtime {

class Bus;

#define BUS_CLASS(Class) class Class;
#include "runtime/plant_file/bus_kinds.def"

// clang-format off
using AnyBus = OneOf<Bus
#define BUS_CLASS(Class) , Class
#include "runtime/plant_file/bus_kinds.def"
>::Pointer;
// clang-format on

// A frame or a telegram that has ended on the line, or what came of one.
struct BusMessage {
  Time end = 0;
  std::string text;     // as tests write it: "40A#8006", "02 01 85 .."
  std::string meaning;  // in words; empty where the text needs none
  std::vector<uint8_t> bytes{};
  std::optional<Frame> frame{};  // CAN
};

class BusObserver {
 public:
  virtual void on_message(const Bus& bus, const BusMessage& message) = 0;

 protected:
  ~BusObserver() = default;
};

// Hears everything there is to know of what happens on the line, as numbers: two runs are equal where these are.
class BusTracer {
 public:
  virtual void on_trace(const Bus& bus, std::span<const uint64_t> facts) = 0;

 protected:
  ~BusTracer() = default;
};

// A kind of fault that can be planted on a line, and what it takes.
struct FaultRule {
  std::string_view word;
  std::string_view text;
  FaultPlace at;
  bool of_frames;    // by chance: it takes a rate
  bool of_one_kind;  // it takes the identifier of the frames
};

// A fault that begins while the plant runs.
struct WantedFault {
  std::string_view word;  // of a rule
  Time from = 0;
  uint32_t per_mille = 1000;
  std::optional<uint32_t> id{};
  bool of_line = false;  // nobody plants it: the data of the line say it
};

// What a line is made of.
struct BusPlace {
  EventQueue& queue;
  uint32_t source;          // orders its events among those of equal time
  const BusConfig& config;  // outlives the line
  std::function<void(Time now, std::string text)> warn;  // of what is wrong on it
};

std::unique_ptr<Bus> make_bus(BusPlace place);

// Nothing when the text is a message that send() of a bus of the kind takes, else why not.
std::optional<std::string> refuse_message(BusKind kind, const std::string& text);

class Bus {
 public:
  explicit Bus(const BusConfig& config) : config_(config) {}
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;
  virtual ~Bus() = default;

  virtual AnyBus self() = 0;

  const BusConfig& config() const { return config_; }
  BusKind kind() const { return config_.kind; }
  const std::string& name() const { return config_.name; }
  uint32_t baud() const { return config_.baud; }
  virtual LineLoad load(Time now) const = 0;  // frames: frames or telegrams
  virtual std::vector<std::string> node_names() const = 0;  // in the order in which they have joined
  // What the plant file has wrong of the line, in words.
  virtual std::vector<std::string> findings(const PlantFile& file) const = 0;

  // Before the first event runs.
  void add_observer(BusObserver& observer) {
    observers_.push_back(&observer);
    look();
  }
  void add_tracer(BusTracer& tracer) {
    tracers_.push_back(&tracer);
    look();
  }
  // What ended before this was told; a message that is not complete yet may turn out to be void.
  virtual Time told_until(Time now) const { return now; }
  virtual void finish() {}  // at the end of a run: the message that was not completed

  // A participant without any manners joins the line, before the first event, to send what a test says. Nothing, or
  // why it cannot be sent.
  virtual void attach_hand() = 0;
  virtual std::optional<std::string> send(const std::string& text) = 0;

  // Lines without rules have no faults.
  virtual std::vector<FaultRule> fault_rules() const { return {}; }
  virtual FaultConfig make_fault(const WantedFault& /*wanted*/) const { return {}; }
  // False: its station is not on the bus.
  virtual bool plant(const FaultConfig& /*fault*/) { return false; }
  // Ends it. False: there is none like it, or it cannot be ended.
  virtual bool repair(const FaultConfig& /*fault*/) { return false; }

 protected:
  // From now on told() and traced() are wanted.
  virtual void watch() = 0;
  bool is_observed() const { return !observers_.empty(); }
  void tell(const BusMessage& message) {
    for (BusObserver* observer : observers_) observer->on_message(*this, message);
  }
  void trace(std::span<const uint64_t> facts) {
    for (BusTracer* tracer : tracers_) tracer->on_trace(*this, facts);
  }
  template <typename... Facts>
  void trace_all(Facts... facts) {
    const uint64_t numbers[] = {static_cast<uint64_t>(facts)...};
    trace(numbers);
  }

 private:
  void look() {
    if (observers_.size() + tracers_.size() == 1) watch();
  }

  const BusConfig& config_;
  std::vector<BusObserver*> observers_;
  std::vector<BusTracer*> tracers_;
};

// Of a line whose nodes have numbers from 0.
template <typename Line>
std::vector<std::string> node_names_of(const Line& line) {
  std::vector<std::string> names;
  for (NodeId node = 0; node < line.node_count(); ++node) names.push_back(line.node_name(node));
  return names;
}

// In the source of each class: bus.cpp makes a line by its row alone and knows no class.
#define IPOS_MAKES_BUS(Class)                                                                                  \
  std::unique_ptr<Bus> make_##Class(BusPlace place) { return std::make_unique<Class>(std::move(place)); } \
  std::optional<std::string> refuse_##Class(const std::string& text) { return Class::refuse(text); }

}  // namespace ipos::runtime

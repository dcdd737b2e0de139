// The tab Scope: one scope for all clients. It samples as `ipos run --trace` does, and its CSV is written by the same
// code, so both have the same digits.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "runtime/plant/plant_signals.hpp"
#include "tools/recording/trace.hpp"
#include "tools/serve/scope_memory.hpp"
#include "tools/serve/tabs.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::kMillisecond;
using runtime::PlantSignal;
using runtime::Time;

constexpr size_t kMostChannels = 8;
constexpr uint64_t kMostPoints = 4'096;             // of a binary frame
constexpr uint64_t kMostBehind = 65'536;            // samples that a client of the topic may be late
constexpr uint64_t kRowsAtOnce = 5'000;             // of CSV
constexpr int64_t kLastUs = 1'000'000'000'000'000;  // us

enum class State : uint8_t { Free, Armed, Triggered, Done };
constexpr const char* kStates[] = {"free", "armed", "triggered", "done"};

// What starts a recording, and how far it has come.
struct Trigger {
  Json settings{{"kind", "none"}};
  std::string kind = "none";
  std::optional<PlantSignal> signal;  // of level and edge
  double value = 0;
  bool below = false;
  bool rising = false, falling = false;
  std::optional<uint32_t> station;  // of fault and line
  std::string bus;                  // of telegram; empty: any
  std::optional<uint32_t> id;
  uint32_t address = 0;  // of line
  bool stops = false;
};

class ScopeTab final : public Tab, private runtime::CanObserver, private runtime::SerialObserver {
 public:
  explicit ScopeTab(PlantHost& host) : host_(host) {
    Desk& desk = host.desk();
    desk.add_command("scope", [this](const Desk::Call& call) { return set(call.arguments); });
    desk.add_command("scope.arm", [this](const Desk::Call& call) {
      arm(call.arguments.flag("single", false));
      return describe();
    });
    desk.add_command("scope.trigger", [this](const Desk::Call&) {
      if (state_ == State::Done) begin_again();
      fire(host_.plant().now(), "by hand");
      return describe();
    });
    desk.add_command("scope.free", [this](const Desk::Call&) {
      if (state_ == State::Done) begin_again();
      state_ = State::Free;
      single_ = false;
      return describe();
    });
    desk.add_command("scope.view", [this](const Desk::Call& call) { return view(call); });
    desk.add_command("scope.csv", [this](const Desk::Call& call) { return csv(call); });
    desk.add_topic("scope",
                   [this](Client& client, Subscription& subscription) { publish(client, subscription); });
  }

  void built(runtime::Plant& plant) override {
    if (names_.empty())
      for (const auto& station : plant.stations())
        for (const char* name : {"speed", "setpoint", "status"})
          if (names_.size() < kMostChannels && !runtime::find_station_signals(*station, name).empty())
            names_.push_back(station->config().name + "." + name);
    channels_ = find(names_);
    if (trigger_.signal) trigger_.signal = find({trigger_.signal->name}).front();
    begin_again();
    plant.add_observer(static_cast<runtime::CanObserver&>(*this));
    plant.add_observer(static_cast<runtime::SerialObserver&>(*this));
  }

  void passed(Time now) override {
    if (now <= last_) return;
    last_ = now;
    if (state_ != State::Done) {
      for (size_t n = 0; n < channels_.size(); ++n) samples_[n] = channels_[n].read();
      if (memory_.end() == 0) begin_ = now;
      memory_.push(samples_);
    }
    look(now);
  }

  void executes(uint32_t station, uint32_t address) override {
    if (trigger_.kind == "line" && trigger_.station == station && trigger_.address == address)
      seen_ = host_.plant().now();
  }

  Json save() const override {
    return {{"names", names_},         {"trigger", trigger_.settings},      {"pre", pre_},
            {"length_ms", length_ms_}, {"state", static_cast<int>(state_)}, {"single", single_},
            {"recording", recording_}};
  }
  void load(const Json& state) override {
    if (const auto names = state["names"].get<std::vector<std::string>>(); names != names_) {
      names_ = names;
      channels_ = find(names_);
      begin_again();
    }
    trigger_ = trigger_of(state["trigger"]);
    pre_ = state["pre"];
    length_ms_ = state["length_ms"];
    single_ = state["single"];
    recording_ = state["recording"];
    // What has triggered it is still to come.
    state_ = state["state"] == static_cast<int>(State::Free) ? State::Free : State::Armed;
    triggered_at_.reset();
    seen_.reset();
  }

 private:
  std::vector<PlantSignal> find(const std::vector<std::string>& names) const {
    std::vector<PlantSignal> signals;
    for (const std::string& name : names) {
      auto found = runtime::find_signals(host_.plant(), name);
      if (!found) throw Mistake(found.error());
      for (PlantSignal& signal : *found) signals.push_back(std::move(signal));
    }
    return signals;
  }

  void begin_again() {
    ++recording_;
    memory_ = ScopeMemory(channels_.size());
    samples_.assign(channels_.size(), 0);
    last_ = host_.plant().now();
    begin_ = last_ + kMillisecond;
    if (state_ == State::Triggered || state_ == State::Done) state_ = State::Armed;
    triggered_at_.reset();
    seen_.reset();
    previous_.reset();
    old_faults_.clear();
    for (const auto& station : host_.plant().stations()) old_faults_.push_back(station->fault());
  }

  // --- settings ---

  Json set(const Arguments& a) {
    if (a.has("channels")) {
      std::vector<PlantSignal> channels = find(a.texts("channels", kMostChannels));
      if (channels.empty() || channels.size() > kMostChannels)
        throw Mistake(
            fmt::format("a scope has 1 to {} channels, these are {}", kMostChannels, channels.size()));
      names_.clear();
      for (const PlantSignal& channel : channels) names_.push_back(channel.name);
      channels_ = std::move(channels);
      begin_again();
    }
    if (a.has("trigger")) trigger_ = trigger_of(a.json()["trigger"]);
    pre_ = a.whole("pre", 0, 100, pre_);
    length_ms_ = a.whole("length_ms", 1, static_cast<int64_t>(ScopeMemory::kKept), length_ms_);
    return describe();
  }

  Trigger trigger_of(const Json& json) const {
    if (!json.is_object()) throw Mistake("'trigger' must be an object");
    const Arguments a(json);
    Trigger trigger;
    trigger.settings = json;
    trigger.kind = a.text("kind");
    trigger.stops = a.flag("stop", false);
    if (trigger.kind == "level" || trigger.kind == "edge") {
      auto found = find({a.text("signal")});
      if (found.size() != 1) throw Mistake("a trigger has one signal");
      trigger.signal = std::move(found.front());
      trigger.value = a.number("value", -1e12, 1e12);
      trigger.below = a.flag("below", false);
      const std::string slope = a.text("slope", "rising");
      if (slope != "rising" && slope != "falling" && slope != "either")
        throw Mistake("'slope' must be rising, falling or either");
      trigger.rising = slope != "falling";
      trigger.falling = slope != "rising";
    } else if (trigger.kind == "fault") {
      if (a.has("station")) trigger.station = host_.station_number(a.text("station"));
    } else if (trigger.kind == "telegram") {
      trigger.bus = a.text("bus", "");
      if (a.has("id")) trigger.id = static_cast<uint32_t>(a.whole("id", 0, UINT32_MAX));
    } else if (trigger.kind == "line") {
      trigger.station = host_.station_number(a.text("station"));
      const debug::CodeMap* code = host_.debugger().code(*trigger.station);
      const auto address =
          code == nullptr
              ? std::nullopt
              : code->address_of(a.text("file"), static_cast<uint32_t>(a.whole("line", 1, INT32_MAX)));
      if (!address) throw Mistake("there is no command at or behind this line");
      trigger.address = *address;
    } else if (trigger.kind != "none") {
      throw Mistake("'kind' must be none, level, edge, fault, telegram or line");
    }
    return trigger;
  }

  void arm(bool single) {
    if (state_ == State::Done) begin_again();
    state_ = State::Armed;
    single_ = single;
    triggered_at_.reset();
    trigger_text_.clear();
    seen_.reset();
    previous_.reset();
  }

  // --- the trigger ---

  void on_frame(const runtime::CanLine& line, const runtime::FrameRecord& record) override {
    if (trigger_.kind != "telegram" || (!trigger_.bus.empty() && line.name() != trigger_.bus)) return;
    if (!trigger_.id || *trigger_.id == record.frame.id) seen_ = record.end;
  }
  void on_line_event(const runtime::CanLine&, const runtime::LineEvent&) override {}
  void on_character(const runtime::Rs485Line& line, runtime::NodeId,
                    const runtime::Character& character) override {
    if (trigger_.kind == "telegram" && !trigger_.id && line.name() == trigger_.bus) seen_ = character.end;
  }
  void on_serial_event(const runtime::Rs485Line&, const runtime::SerialEvent&) override {}

  // Behind a millisecond. Everything is looked at in every one, so that an edge is one when the scope is armed later.
  void look(Time now) {
    const std::optional<Time> seen = std::exchange(seen_, std::nullopt);
    std::string why;
    Time at = now;
    if (trigger_.signal) {
      const double value = static_cast<double>(trigger_.signal->read()) * trigger_.signal->factor;
      const double before = std::exchange(previous_, value).value_or(value);
      const bool level = trigger_.below ? value <= trigger_.value : value >= trigger_.value;
      const bool rises = before < trigger_.value && value >= trigger_.value;
      const bool falls = before > trigger_.value && value <= trigger_.value;
      if (trigger_.kind == "level" ? level : (trigger_.rising && rises) || (trigger_.falling && falls))
        why = fmt::format("{} is {:.{}f}", trigger_.signal->name, value, trigger_.signal->decimals);
    }
    const auto& stations = host_.plant().stations();
    for (uint32_t n = 0; n < stations.size(); ++n) {
      const uint8_t fault = stations[n]->fault();
      const bool is_new = fault != 0 && fault != std::exchange(old_faults_[n], fault);
      if (fault == 0) old_faults_[n] = 0;
      if (is_new && trigger_.kind == "fault" && (!trigger_.station || *trigger_.station == n))
        why = fmt::format("{} has fault F{:02}", stations[n]->config().name, fault);
    }
    if (seen) {
      why = trigger_.kind == "line" ? "the line executes" : "a telegram";
      at = *seen;
    }
    if (state_ == State::Armed && !why.empty()) fire(at, why);
    if (state_ != State::Triggered || now - *triggered_at_ < length_ms_ * (100 - pre_) / 100 * kMillisecond)
      return;
    state_ = single_ ? State::Done : State::Armed;
  }

  void fire(Time at, const std::string& why) {
    state_ = State::Triggered;
    triggered_at_ = at;
    trigger_text_ = why;
    if (trigger_.stops) host_.stop("trigger", why);
  }

  // --- what is shown ---

  int64_t us_of(uint64_t number) const {
    return (begin_ + static_cast<Time>(number) * kMillisecond) / runtime::kMicrosecond;
  }
  // The first sample at or behind a time.
  uint64_t number_at(int64_t us) const {
    const int64_t begin = begin_ / runtime::kMicrosecond;
    const auto number = us <= begin ? 0 : static_cast<uint64_t>((us - begin + 999) / 1000);
    return std::clamp(number, memory_.first(), memory_.end());
  }

  Json describe() const {
    Json channels = Json::array();
    for (const PlantSignal& channel : channels_)
      channels.push_back({{"name", channel.name},
                          {"unit", channel.unit},
                          {"decimals", channel.decimals},
                          {"bits", channel.bits}});
    Json json{{"recording", recording_},
              {"channels", std::move(channels)},
              {"trigger", trigger_.settings},
              {"pre", pre_},
              {"length_ms", length_ms_},
              {"state", kStates[static_cast<size_t>(state_)]},
              {"single", single_},
              {"trigger_text", trigger_text_},
              {"first_us", us_of(memory_.first())}};
    json["trigger_us"] = triggered_at_ ? Json(*triggered_at_ / runtime::kMicrosecond) : Json(nullptr);
    json["last_us"] = memory_.end() == memory_.first() ? us_of(memory_.first()) : us_of(memory_.end() - 1);
    return json;
  }

  // A binary frame of the samples from `begin` to before `end`, `step` of them a point.
  std::string points(uint64_t begin, uint64_t end, uint64_t step, uint32_t id) const {
    const uint64_t count = (end - begin + step - 1) / step;
    const bool pairs = step > 1;
    std::string bytes;
    bytes.reserve(32 + count * channels_.size() * (pairs ? 8 : 4));
    const auto put = [&bytes](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    put(uint8_t{1});
    put(static_cast<uint8_t>(channels_.size()));
    put(static_cast<uint8_t>(pairs ? 2 : 1));
    put(uint8_t{0});
    put(id);
    put(recording_);
    put(static_cast<uint32_t>(count));
    put(static_cast<uint32_t>(step * 1000));
    put(uint32_t{0});
    put(static_cast<uint64_t>(us_of(begin)));
    for (uint64_t n = begin; n < end; n += step)
      for (size_t channel = 0; channel < channels_.size(); ++channel) {
        const double factor = channels_[channel].factor;
        if (!pairs) {
          put(static_cast<float>(static_cast<double>(memory_.at(channel, n)) * factor));
          continue;
        }
        const auto [least, greatest] = memory_.extremes(channel, n, std::min(n + step, end));
        put(static_cast<float>(static_cast<double>(least) * factor));
        put(static_cast<float>(static_cast<double>(greatest) * factor));
      }
    return bytes;
  }

  Json view(const Desk::Call& call) {
    const uint64_t begin = number_at(call.arguments.whole("from_us", 0, kLastUs));
    const uint64_t end = std::max(begin, number_at(call.arguments.whole("to_us", 0, kLastUs) + 1));
    const auto most =
        static_cast<uint64_t>(call.arguments.whole("points", 1, static_cast<int64_t>(kMostPoints)));
    if (!call.id.is_number_unsigned() || call.id.get<uint64_t>() == 0 || call.id.get<uint64_t>() > UINT32_MAX)
      throw Mistake("a view needs an id from 1 to 4294967295");
    const uint64_t step = std::max<uint64_t>(1, (end - begin + most - 1) / most);
    host_.desk().send_binary(call.client, points(begin, end, step, call.id.get<uint32_t>()), true);
    return nullptr;
  }

  Json csv(const Desk::Call& call) {
    uint64_t begin = call.arguments.has("from_us") ? number_at(call.arguments.whole("from_us", 0, kLastUs))
                                                   : memory_.first();
    const uint64_t end = call.arguments.has("to_us")
                             ? number_at(call.arguments.whole("to_us", 0, kLastUs) + 1)
                             : memory_.end();
    bool with_head = true;
    for (;;) {
      const uint64_t stop = std::min(std::max(begin, end), begin + kRowsAtOnce);
      Recording recording;
      recording.signals = channels_;
      recording.samples.resize(channels_.size());
      for (uint64_t n = begin; n < stop; ++n) {
        recording.times.push_back(us_of(n) * runtime::kMicrosecond);
        for (size_t channel = 0; channel < channels_.size(); ++channel)
          recording.samples[channel].push_back(memory_.at(channel, n));
      }
      std::ostringstream out;
      write_csv(out, recording);
      std::string text = std::move(out).str();
      if (!with_head) text.erase(0, text.find('\n') + 1);
      if (stop >= end) return {{"csv", std::move(text)}};
      call.part({{"csv", std::move(text)}});
      with_head = false;
      begin = stop;
    }
  }

  void publish(Client& client, Subscription& subscription) {
    Json now = describe();
    const Json last = now["last_us"];
    const Json first = now["first_us"];
    now.erase("last_us");
    now.erase("first_us");
    if (subscription.is_news("scope", now)) {
      now["event"] = "scope";
      now["last_us"] = last;
      now["first_us"] = first;
      host_.desk().send(client, now);
    }
    const auto step = static_cast<uint64_t>(Arguments(subscription.options).whole("step_ms", 1, 1000, 1));
    const bool other = subscription.is_news("recording", recording_);
    uint64_t from = subscription.fresh ? memory_.end()
                    : other            ? memory_.first()
                                       : std::max(subscription.mark, memory_.first());
    if (memory_.end() - from > kMostBehind) from = memory_.end() - kMostBehind;
    const uint64_t count = std::min((memory_.end() - from) / step, kMostPoints);
    subscription.mark = from + count * step;
    if (count != 0) host_.desk().send_binary(client, points(from, from + count * step, step, 0));
  }

  PlantHost& host_;
  std::vector<std::string> names_;
  std::vector<PlantSignal> channels_;
  ScopeMemory memory_;
  std::vector<int64_t> samples_;
  Time begin_ = kMillisecond;  // of sample 0
  Time last_ = 0;              // the last millisecond looked at
  uint32_t recording_ = 0;
  Trigger trigger_;
  int64_t pre_ = 20;
  int64_t length_ms_ = 5'000;
  State state_ = State::Free;
  bool single_ = false;
  std::optional<Time> triggered_at_;
  std::string trigger_text_;
  std::optional<Time> seen_;        // the telegram, or the line
  std::optional<double> previous_;  // of the trigger's signal
  std::vector<uint8_t> old_faults_;
};

}  // namespace

std::unique_ptr<Tab> make_scope_tab(PlantHost& host) { return std::make_unique<ScopeTab>(host); }

}  // namespace ipos::tools::serve

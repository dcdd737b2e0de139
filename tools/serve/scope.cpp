// Channels, trigger and memory; what clients are shown of them.
#include "tools/serve/scope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tools/recording/trace.hpp"

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
constexpr const char* kStates[] = {"free", "armed", "triggered", "done"};

}  // namespace

Scope::Scope(Desk& desk, ScopeSource& source) : desk_(desk), source_(source) {
  desk.add_command("scope", [this](const Desk::Call& call) { return set(call.arguments); });
  desk.add_command("scope.arm", [this](const Desk::Call& call) {
    arm(call.arguments.flag("single", false));
    return describe();
  });
  desk.add_command("scope.trigger", [this](const Desk::Call&) {
    if (state_ == State::Done) begin_again();
    fire(source_.now(), "by hand");
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

void Scope::propose(std::vector<std::string> names) {
  if (!names_.empty()) return;
  if (names.size() > kMostChannels) names.resize(kMostChannels);
  names_ = std::move(names);
}

void Scope::built() {
  channels_ = find(names_);
  if (trigger_.signal) trigger_.signal = find({trigger_.signal->name}).front();
  begin_again();
}

void Scope::passed(Time now) {
  if (now <= last_) return;
  last_ = now;
  if (state_ != State::Done) {
    for (size_t n = 0; n < channels_.size(); ++n) samples_[n] = channels_[n].read();
    if (memory_.end() == 0) begin_ = now;
    memory_.push(samples_);
  }
  look(now);
}

Json Scope::save() const {
  return {{"names", names_},         {"trigger", trigger_.settings},      {"pre", pre_},
          {"length_ms", length_ms_}, {"state", static_cast<int>(state_)}, {"single", single_},
          {"recording", recording_}};
}

void Scope::load(const Json& state) {
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

std::vector<PlantSignal> Scope::find(const std::vector<std::string>& names) {
  std::vector<PlantSignal> signals;
  for (const std::string& name : names)
    for (PlantSignal& signal : source_.find_channels(name)) signals.push_back(std::move(signal));
  return signals;
}

void Scope::begin_again() {
  ++recording_;
  memory_ = ScopeMemory(channels_.size());
  samples_.assign(channels_.size(), 0);
  last_ = source_.now();
  begin_ = last_ + kMillisecond;
  if (state_ == State::Triggered || state_ == State::Done) state_ = State::Armed;
  triggered_at_.reset();
  seen_.reset();
  previous_.reset();
}

std::vector<const PlantSignal*> Scope::asked() const {
  std::vector<const PlantSignal*> signals;
  for (const PlantSignal& channel : channels_) signals.push_back(&channel);
  if (trigger_.signal) signals.push_back(&*trigger_.signal);
  return signals;
}

// --- settings ---

Json Scope::set(const Arguments& a) {
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

Scope::Trigger Scope::trigger_of(const Json& json) {
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
  }
  source_.watch_for(trigger.kind, a);
  return trigger;
}

void Scope::arm(bool single) {
  if (state_ == State::Done) begin_again();
  state_ = State::Armed;
  single_ = single;
  triggered_at_.reset();
  trigger_text_.clear();
  seen_.reset();
  previous_.reset();
}

// --- the trigger ---

std::optional<std::string> Scope::value_triggers() {
  if (!trigger_.signal) return std::nullopt;
  const double value = static_cast<double>(trigger_.signal->read()) * trigger_.signal->factor;
  const double before = std::exchange(previous_, value).value_or(value);
  const bool level = trigger_.below ? value <= trigger_.value : value >= trigger_.value;
  const bool rises = before < trigger_.value && value >= trigger_.value;
  const bool falls = before > trigger_.value && value <= trigger_.value;
  if (trigger_.kind == "level" ? !level : !(trigger_.rising && rises) && !(trigger_.falling && falls))
    return std::nullopt;
  return fmt::format("{} is {:.{}f}", trigger_.signal->name, value, trigger_.signal->decimals);
}

// Behind a millisecond. Everything is looked at in every one, so that an edge is one when the scope is armed later.
void Scope::look(Time now) {
  const auto seen = std::exchange(seen_, std::nullopt);
  const std::optional<std::string> value = value_triggers();
  if (state_ == State::Armed && (seen || value)) fire(seen ? seen->first : now, seen ? seen->second : *value);
  if (state_ != State::Triggered || now - *triggered_at_ < length_ms_ * (100 - pre_) / 100 * kMillisecond)
    return;
  state_ = single_ ? State::Done : State::Armed;
}

void Scope::fire(Time at, const std::string& why) {
  state_ = State::Triggered;
  triggered_at_ = at;
  trigger_text_ = why;
  if (trigger_.stops) source_.stop(why);
}

// --- what is shown ---

int64_t Scope::us_of(uint64_t number) const {
  return (begin_ + static_cast<Time>(number) * kMillisecond) / runtime::kMicrosecond;
}
// The first sample at or behind a time.
uint64_t Scope::number_at(int64_t us) const {
  const int64_t begin = begin_ / runtime::kMicrosecond;
  const auto number = us <= begin ? 0 : static_cast<uint64_t>((us - begin + 999) / 1000);
  return std::clamp(number, memory_.first(), memory_.end());
}

Json Scope::describe() const {
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
std::string Scope::points(uint64_t begin, uint64_t end, uint64_t step, uint32_t id) const {
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

Json Scope::view(const Desk::Call& call) {
  const uint64_t begin = number_at(call.arguments.whole("from_us", 0, kLastUs));
  const uint64_t end = std::max(begin, number_at(call.arguments.whole("to_us", 0, kLastUs) + 1));
  const auto most =
      static_cast<uint64_t>(call.arguments.whole("points", 1, static_cast<int64_t>(kMostPoints)));
  if (!call.id.is_number_unsigned() || call.id.get<uint64_t>() == 0 || call.id.get<uint64_t>() > UINT32_MAX)
    throw Mistake("a view needs an id from 1 to 4294967295");
  const uint64_t step = std::max<uint64_t>(1, (end - begin + most - 1) / most);
  desk_.send_binary(call.client, points(begin, end, step, call.id.get<uint32_t>()), true);
  return nullptr;
}

Json Scope::csv(const Desk::Call& call) {
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

void Scope::publish(Client& client, Subscription& subscription) {
  Json now = describe();
  const Json last = now["last_us"];
  const Json first = now["first_us"];
  now.erase("last_us");
  now.erase("first_us");
  if (subscription.is_news("scope", now)) {
    now["event"] = "scope";
    now["last_us"] = last;
    now["first_us"] = first;
    desk_.send(client, now);
  }
  const auto step = static_cast<uint64_t>(Arguments(subscription.options).whole("step_ms", 1, 1000, 1));
  const bool other = subscription.is_news("recording", recording_);
  uint64_t from = subscription.fresh ? memory_.end()
                  : other            ? memory_.first()
                                     : std::max(subscription.mark, memory_.first());
  if (memory_.end() - from > kMostBehind) from = memory_.end() - kMostBehind;
  const uint64_t count = std::min((memory_.end() - from) / step, kMostPoints);
  subscription.mark = from + count * step;
  if (count != 0) desk_.send_binary(client, points(from, from + count * step, step, 0));
}

}  // namespace ipos::tools::serve

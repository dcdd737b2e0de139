// Channels, trigger and memory; what clients are shown of them.
#include "tools/serve/host/scope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "tools/recording/channel_json.hpp"
#include "tools/recording/plot_html.hpp"
#include "tools/recording/plot_svg.hpp"
#include "tools/recording/trace.hpp"

namespace ipos::tools::serve {
namespace {

using runtime::kMillisecond;
using signals::Signal;
using runtime::Time;

constexpr uint64_t kMostPoints = 4'096;             // of a binary frame
constexpr uint64_t kMostDrawn = 4'000'000;          // samples in a file with a picture (ours)
constexpr size_t kPartBytes = 1 << 20;              // of such a file
constexpr uint64_t kMostBehind = 65'536;            // samples that a client of the topic may be late
constexpr uint64_t kRowsAtOnce = 5'000;             // of CSV
constexpr int64_t kLastUs = 1'000'000'000'000'000;  // us
constexpr const char* kByHand = "by hand";
constexpr const char* kStates[] = {"free", "armed", "triggered", "done"};

// Of a sample: it has the number of its millisecond.
int64_t us_of(uint64_t number) { return static_cast<int64_t>(number) * 1000; }

std::vector<ScopeMemory::Kind> kinds_of(const std::vector<Signal>& channels) {
  std::vector<ScopeMemory::Kind> kinds;
  for (const Signal& channel : channels)
    kinds.push_back({channel.parameter != nullptr && channel.parameter->is_unsigned(),
                     signals::shape_of(channel).kind == signals::Shape::Kind::Word});
  return kinds;
}

}  // namespace

Scope::Scope(Router& router, ScopeSource& source, Copies& copies)
    : router_(router), source_(source), memory_(copies) {
  router.add_command("scope", [this](const Router::Call& call) {
    set(call.arguments);
    if (call.arguments.has("channels") || call.arguments.has("trigger") || call.arguments.has("pre") ||
        call.arguments.has("length_ms"))
      router_.keep("scope", {{"channels", names_}, {"trigger", trigger_.settings}, {"pre", pre_}, {"length_ms", length_ms_}});
    return describe();
  });
  router.add_command("scope.arm", [this](const Router::Call& call) {
    arm(call.arguments.flag("single", false));
    return describe();
  });
  router.add_command("scope.trigger", [this](const Router::Call&) {
    ++orders_;
    hand_at_ = source_.now();
    fire(*hand_at_, kByHand);
    return describe();
  });
  router.add_command("scope.free", [this](const Router::Call&) {
    ++orders_;
    hand_at_.reset();
    state_ = State::Free;
    single_ = false;
    return describe();
  });
  router.add_command("scope.view", [this](const Router::Call& call) { return view(call); });
  for (const auto& [name, answer] : {std::pair{"scope.csv", &Scope::csv}, {"scope.picture", &Scope::picture}})
    router.add_command(name, [this, name = name, answer = answer](const Router::Call& call) {
      return when_complete(call, name, answer);
    });
  router.add_topic("scope",
                 [this](Client& client, Subscription& subscription) { publish(client, subscription); });
}

void Scope::propose(std::vector<std::string> names) {
  if (!names_.empty()) return;
  if (names.size() > kMostChannels) names.resize(kMostChannels);
  names_ = std::move(names);
}

// Those that there still are: a plant or program that was built anew may have others.
std::vector<std::string> Scope::known(std::vector<std::string> names) {
  std::erase_if(names, [this](const std::string& name) {
    try {
      return source_.find_channels(name).empty();
    } catch (const Mistake&) {
      return true;
    }
  });
  return names;
}

void Scope::find_trigger() {
  try {
    trigger_ = trigger_of(trigger_.settings);
  } catch (const Mistake&) {
    trigger_ = trigger_of({{"kind", "none"}});
  }
}

void Scope::renamed() {
  if (fills_) {
    channels_ = find(names_);
    return;
  }
  std::vector<std::string> names = known(names_);
  choose(find(names));
  channels_ = find(names_);
  find_trigger();
}

void Scope::built() {
  bool is_another = std::exchange(is_another_, false);
  if (!fills_) {
    std::vector<std::string> names = known(names_);
    is_another = is_another || names != names_;
    names_ = std::move(names);
    find_trigger();
  }
  channels_ = find(names_);
  if (fills_ != nullptr) {
    last_ = 0;
    return;
  }
  if (is_another) memory_.choose(std::vector<std::optional<size_t>>(channels_.size()), kinds_of(channels_));
  begin_again(is_another);
}

void Scope::passed(Time now) {
  if (now <= last_) return;
  last_ = now;
  const auto number = static_cast<uint64_t>(now / kMillisecond);
  if (fills_ != nullptr) return fill(number);
  record(number);
  look(now);
}

// A complete recording is shown until another one is wanted: nothing is recorded over it.
void Scope::record(uint64_t number) {
  if (state_ == State::Done) {
    const Time begin = *triggered_at_ - length_ms_ * pre_ / 100 * kMillisecond;
    if (begin / kMillisecond < static_cast<Time>(ScopeMemory::first_kept(number + 1))) return;
  }
  for (size_t n = 0; n < channels_.size(); ++n) samples_[n] = channels_[n].read();
  if (!memory_.push(number, samples_)) asks_ = true;
}

// --- what was before a channel was chosen ---

std::vector<size_t> Scope::incomplete() const {
  const uint64_t least = std::max<uint64_t>(1, ScopeMemory::first_kept(memory_.end()));
  std::vector<size_t> late;
  for (size_t n = 0; n < channels_.size(); ++n)
    if (memory_.first(n) > least && memory_.end() > least) late.push_back(n);
  return late;
}

void Scope::tend() {
  if (computing_) {
    const auto result = computing_->result();
    if (!result) return;
    if (*result)
      for (const size_t channel : late_) memory_.filled(channel, filled_from_);
    computing_.reset();
    ++recording_;  // who looks at it looks again
  } else if (asks_) {
    compute();
  }
  if (computing_ || asks_) return;
  for (const Question& question : std::exchange(questions_, {})) {
    const auto client = router_.clients().find(question.client);
    if (client == router_.clients().end()) continue;
    const Router::Call call{router_, client->second, question.id, Arguments(question.message)};
    try {
      router_.reply(question.client, question.id, question.name == "scope.csv" ? csv(call) : picture(call));
    } catch (const Mistake& mistake) {
      router_.fail(question.client, question.id, mistake.what());
    }
  }
}

Json Scope::when_complete(const Router::Call& call, const char* name, Answer answer) {
  if (!asks_ && !computing_) return (this->*answer)(call);
  questions_.push_back({call.client.number, call.id, call.arguments.json(), name});
  return nullptr;
}

// The same commands at the same times give the same run. What it puts into the memory lies before what is recorded here.
void Scope::compute() {
  asks_ = false;
  late_ = incomplete();
  if (late_.empty()) return;
  filled_from_ = std::max<uint64_t>(1, ScopeMemory::first_kept(memory_.end()));
  computing_ = source_.run_again();  // a copy of the process does not come back from here
}

void Scope::fill_for(Scope& first) {
  fills_ = &first.memory_;
  late_ = first.late_;
  filled_from_ = first.filled_from_;
  names_ = first.names_;
  channels_ = find(names_);
}

void Scope::fill(uint64_t number) {
  if (number < filled_from_) return;
  for (const size_t channel : late_)
    fills_->fill(channel, filled_from_, number, channels_[channel].read());
}

Json Scope::save() {
  if (computing_) asks_ = true;
  computing_.reset();
  Json state{{"names", names_},
             {"columns", memory_.columns()},
             {"trigger", trigger_.settings},
             {"pre", pre_},
             {"length_ms", length_ms_},
             {"state", static_cast<int>(state_)},
             {"single", single_},
             {"armed_at", armed_at_},
             {"done_end", done_end_},
             {"trigger_text", trigger_text_},
             {"asks", asks_},
             {"questions", questions_},
             {"orders", orders_},
             {"hand_at", hand_at_ ? Json(*hand_at_) : Json(nullptr)},
             {"recording", recording_}};
  state["triggered_at"] = triggered_at_ ? Json(*triggered_at_) : Json(nullptr);
  return state;
}

void Scope::load(const Json& state) {
  names_ = state["names"].get<std::vector<std::string>>();
  channels_ = find(names_);
  samples_.assign(channels_.size(), 0);
  computing_.reset();  // that of the time when this copy was made
  memory_.use(state["columns"].get<std::vector<ScopeMemory::Column>>());
  trigger_ = trigger_of(state["trigger"]);
  asks_ = true;
  questions_ = state["questions"].get<std::vector<Question>>();
  recording_ = state["recording"];
  seen_.reset();
  hand_at_.reset();
  if (!state["hand_at"].is_null()) hand_at_ = state["hand_at"].get<Time>();
  // Who was here before with the same orders knows what had triggered by now.
  if (orders_ == state["orders"].get<uint64_t>()) return;
  orders_ = state["orders"];
  previous_.reset();
  pre_ = state["pre"];
  length_ms_ = state["length_ms"];
  single_ = state["single"];
  armed_at_ = state["armed_at"];
  state_ = static_cast<State>(state["state"].get<int>());
  done_end_ = state["done_end"];
  trigger_text_ = state["trigger_text"];
  triggered_at_.reset();
  if (!state["triggered_at"].is_null()) triggered_at_ = state["triggered_at"].get<Time>();
  if (state_ == State::Done && done_end_ > memory_.end()) state_ = State::Triggered;
  if (triggered_at_ && *triggered_at_ > last_) {  // that is still to come, and comes by itself
    triggered_at_.reset();
    trigger_text_.clear();
    if (state_ == State::Triggered) state_ = State::Armed;
  }
}

std::vector<Signal> Scope::find(const std::vector<std::string>& names) {
  std::vector<Signal> signals;
  for (const std::string& name : names)
    for (Signal& signal : source_.find_channels(name)) signals.push_back(std::move(signal));
  return signals;
}

// What is recorded of those that stay is kept.
void Scope::choose(std::vector<Signal> channels) {
  std::vector<std::optional<size_t>> known;
  std::vector<std::string> names;
  for (const Signal& channel : channels) {
    const auto before = std::find(names_.begin(), names_.end(), channel.name);
    known.push_back(before == names_.end() ? std::nullopt : std::optional<size_t>(before - names_.begin()));
    names.push_back(channel.name);
  }
  if (names == names_) return;
  if (computing_) computing_.reset();
  memory_.choose(known, kinds_of(channels));
  names_ = std::move(names);
  channels_ = std::move(channels);
  samples_.assign(channels_.size(), 0);
  asks_ = true;
  ++recording_;
}

void Scope::begin_again(bool is_another) {
  ++recording_;
  computing_.reset();
  asks_ = false;
  samples_.assign(channels_.size(), 0);
  last_ = source_.now();
  const uint64_t next = static_cast<uint64_t>(last_ / kMillisecond) + 1;
  if (is_another) memory_.restart(next);
  else memory_.go_on_from(next);
  if (state_ == State::Triggered || state_ == State::Done) state_ = State::Armed;
  triggered_at_.reset();
  seen_.reset();
  previous_.reset();
}

std::vector<const Signal*> Scope::asked() const {
  std::vector<const Signal*> signals;
  for (const Signal& channel : channels_) signals.push_back(&channel);
  if (trigger_.signal) signals.push_back(&*trigger_.signal);
  return signals;
}

// --- settings ---

void Scope::restore(const Json& settings) {
  if (!settings.is_object()) return;
  for (const char* name : {"channels", "trigger", "pre", "length_ms"}) {
    if (!settings.contains(name)) continue;
    const Json one{{name, settings[name]}};
    try {
      set(Arguments(one));
    } catch (const Mistake&) {  // the plant file or a program is another one by now
    }
  }
}

void Scope::set(const Arguments& a) {
  if (a.has("channels")) {
    std::vector<Signal> channels = find(a.texts("channels", kMostChannels));
    if (channels.empty() || channels.size() > kMostChannels)
      throw Mistake(
          fmt::format("a scope has 1 to {} channels, these are {}", kMostChannels, channels.size()));
    choose(std::move(channels));
  }
  if (a.has("trigger") || a.has("pre") || a.has("length_ms")) ++orders_;
  if (a.has("trigger")) {
    trigger_ = trigger_of(a.json()["trigger"]);
    previous_.reset();
  }
  pre_ = a.whole("pre", 0, 100, pre_);
  length_ms_ = a.whole("length_ms", 1, static_cast<int64_t>(ScopeMemory::kKept), length_ms_);
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
  ++orders_;
  hand_at_.reset();
  state_ = State::Armed;
  armed_at_ = source_.now();
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

void Scope::dropped() {
  memory_.forget_later();
  if (hand_at_ && *hand_at_ > last_) hand_at_.reset();
}

// After a millisecond. Everything is looked at in every one, so that an edge is one when the scope is armed later.
void Scope::look(Time now) {
  const auto seen = std::exchange(seen_, std::nullopt);
  const std::optional<std::string> value = value_triggers();
  if (state_ == State::Armed && now > armed_at_ && (seen || value)) fire(seen ? seen->first : now, seen ? seen->second : *value);
  if (hand_at_ == now) fire(now, kByHand);
  if (state_ != State::Triggered || now - *triggered_at_ < length_ms_ * (100 - pre_) / 100 * kMillisecond)
    return;
  state_ = single_ ? State::Done : State::Armed;
  done_end_ = memory_.end();
}

void Scope::fire(Time at, const std::string& why) {
  state_ = State::Triggered;
  triggered_at_ = at;
  trigger_text_ = why;
  source_.triggered(why);
  if (trigger_.stops) source_.stop(why);
}

// --- what is shown ---

// The first sample at or after a time.
uint64_t Scope::number_at(int64_t us, uint64_t end) const {
  return std::clamp(static_cast<uint64_t>((us + 999) / 1000), first(), end);
}

Json Scope::describe() const {
  Json channels = Json::array();
  for (const Signal& channel : channels_) channels.push_back(channel_json(channel));
  Json json{{"recording", recording_},
            {"channels", std::move(channels)},
            {"most", kMostChannels},
            {"trigger", trigger_.settings},
            {"pre", pre_},
            {"length_ms", length_ms_},
            {"state", kStates[static_cast<size_t>(state_)]},
            {"single", single_},
            {"trigger_text", trigger_text_},
            {"first_us", us_of(first())}};
  json["trigger_us"] = triggered_at_ ? Json(*triggered_at_ / runtime::kMicrosecond) : Json(nullptr);
  json["last_us"] = us_of(end() == first() ? first() : end() - 1);
  json["later_us"] = later_end() > end() ? Json(us_of(later_end() - 1)) : Json(nullptr);
  json["computes"] = Json::array();
  if (asks_ || computing_)
    for (const size_t channel : incomplete()) json["computes"].push_back(channels_[channel].name);
  return json;
}

// A binary frame of the samples from `begin` to before `end`, `step` of them a point. `exact`: numbers of 64 bits.
std::string Scope::points(uint64_t begin, uint64_t end, uint64_t step, uint32_t id, bool exact) const {
  const uint64_t count = (end - begin + step - 1) / step;
  const bool pairs = step > 1;
  std::string bytes;
  bytes.reserve(32 + static_cast<size_t>(count) * channels_.size() * (pairs ? 2 : 1) * (exact ? sizeof(double) : sizeof(float)));
  const auto put = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  put(uint8_t{1});
  put(static_cast<uint8_t>(channels_.size()));
  put(static_cast<uint8_t>(pairs ? 2 : 1));
  put(static_cast<uint8_t>(exact ? 1 : 0));
  put(id);
  put(recording_);
  put(static_cast<uint32_t>(count));
  put(static_cast<uint32_t>(step * 1000));
  put(uint32_t{0});
  put(static_cast<uint64_t>(us_of(begin)));
  for (uint64_t n = begin; n < end; n += step)
    for (size_t channel = 0; channel < channels_.size(); ++channel) {
      const double factor = channels_[channel].factor;
      const auto found = memory_.extremes(channel, n, std::min(n + step, end));
      const auto show = [&](int64_t sample) {
        const double shown = found ? static_cast<double>(sample) * factor : std::numeric_limits<double>::quiet_NaN();
        if (exact) put(shown);
        else put(static_cast<float>(shown));
      };
      show(found.value_or(ScopeMemory::Extremes{}).first);
      if (pairs) show(found.value_or(ScopeMemory::Extremes{}).second);
    }
  return bytes;
}

Json Scope::view(const Router::Call& call) {
  const uint64_t last = call.arguments.flag("later", false) ? later_end() : end();
  const uint64_t begin = number_at(call.arguments.whole("from_us", 0, kLastUs), last);
  const uint64_t end = std::max(begin, number_at(call.arguments.whole("to_us", 0, kLastUs) + 1, last));
  const auto most =
      static_cast<uint64_t>(call.arguments.whole("points", 1, static_cast<int64_t>(kMostPoints)));
  if (!call.id.is_number_unsigned() || call.id.get<uint64_t>() == 0 || call.id.get<uint64_t>() > UINT32_MAX)
    throw Mistake("a view needs an id from 1 to 4294967295");
  const uint64_t step = std::max<uint64_t>(1, (end - begin + most - 1) / most);
  router_.send_binary(call.client, points(begin, end, step, call.id.get<uint32_t>(), call.arguments.flag("exact", false)), true);
  return nullptr;
}

Json Scope::csv(const Router::Call& call) {
  uint64_t begin = call.arguments.has("from_us") ? number_at(call.arguments.whole("from_us", 0, kLastUs), this->end()) : first();
  const uint64_t end = std::max(
      begin, call.arguments.has("to_us") ? number_at(call.arguments.whole("to_us", 0, kLastUs) + 1, this->end()) : this->end());
  std::ostringstream out;
  const std::vector<FrameTrack> no_tracks;
  const auto writer = csv_trace(out, channels_, no_tracks);
  std::vector<std::optional<int64_t>> last(channels_.size());
  for (;;) {
    const uint64_t stop = std::min(end, begin + kRowsAtOnce);
    RecordedPart part;
    for (uint64_t n = begin; n < stop; ++n) part.times.push_back(us_of(n) * runtime::kMicrosecond);
    for (size_t channel = 0; channel < channels_.size(); ++channel)
      for (uint64_t n = begin; n < stop; ++n)
        if (const auto sample = memory_.at(channel, n); sample && sample != std::exchange(last[channel], sample))
          part.changes.push_back({static_cast<size_t>(n - begin), channel, *sample});
    writer->take(part);
    std::string text = std::exchange(out, std::ostringstream()).str();
    if (stop == end) return {{"csv", std::move(text)}};
    call.part({{"csv", std::move(text)}});
    begin = stop;
  }
}

// Where all channels have values; the trigger is an event.
Recording Scope::recorded(uint64_t begin, uint64_t end) const {
  Recording recording;
  recording.signals = channels_;
  for (size_t n = 0; n < channels_.size(); ++n) begin = std::max(begin, memory_.first(n));
  recording.samples.resize(channels_.size());
  for (uint64_t n = begin; n < end; ++n) {
    recording.times.push_back(us_of(n) * runtime::kMicrosecond);
    for (size_t channel = 0; channel < channels_.size(); ++channel)
      recording.samples[channel].push_back(memory_.at(channel, n).value_or(0));
  }
  if (triggered_at_ && !recording.times.empty() && *triggered_at_ >= recording.times.front() &&
      *triggered_at_ <= recording.times.back())
    recording.events.push_back({*triggered_at_, "trigger: " + trigger_text_, false});
  return recording;
}

// The files that `ipos run --plot` writes.
Json Scope::picture(const Router::Call& call) {
  const Arguments& a = call.arguments;
  const std::string form = a.text("form");
  if (form != "svg" && form != "html") throw Mistake("'form' must be svg or html");
  const uint64_t begin = a.has("from_us") ? number_at(a.whole("from_us", 0, kLastUs), this->end()) : first();
  const uint64_t end = std::max(begin, a.has("to_us") ? number_at(a.whole("to_us", 0, kLastUs) + 1, this->end()) : this->end());
  if ((end - begin) * channels_.size() > kMostDrawn)
    throw Mistake(fmt::format("these are {} ms of {} channels, more than a picture takes; zoom in", end - begin, channels_.size()));
  const std::string title = a.text("title", "Scope");
  const Recording recording = recorded(begin, end);
  const std::string text = form == "svg" ? plot_svg(recording, title) : plot_html(recording, title);
  size_t at = 0;
  for (; text.size() - at > kPartBytes;) {
    size_t length = kPartBytes;
    while ((static_cast<unsigned char>(text[at + length]) & 0xC0) == 0x80) --length;  // a letter is not cut in two
    call.part({{"text", text.substr(at, length)}});
    at += length;
  }
  return {{"text", text.substr(at)}};
}

void Scope::publish(Client& client, Subscription& subscription) {
  Json now = describe();
  const Json last_us = now["last_us"];
  const Json first_us = now["first_us"];
  now.erase("last_us");
  now.erase("first_us");
  if (subscription.is_news("scope", now)) {
    now["event"] = "scope";
    now["last_us"] = last_us;
    now["first_us"] = first_us;
    router_.send(client, now);
  }
  const auto step = static_cast<uint64_t>(Arguments(subscription.options).whole("step_ms", 1, 1000, 1));
  const bool other = subscription.is_news("recording", recording_);
  uint64_t from = subscription.fresh ? end() : other ? first() : std::clamp(subscription.mark, first(), end());
  if (end() - from > kMostBehind) from = end() - kMostBehind;
  const uint64_t count = std::min((end() - from) / step, kMostPoints);
  subscription.mark = from + count * step;
  if (count != 0) router_.send_binary(client, points(from, from + count * step, step, 0));
}

}  // namespace ipos::tools::serve

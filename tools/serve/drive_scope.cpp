// A question a turn, so that watch and parameters have their share of the line.
#include "tools/serve/drive_scope.hpp"

#include <fmt/format.h>

#include <utility>

#include "stdlib/parameters.hpp"
#include "tools/links/live_values.hpp"
#include "tools/parameters/parameter_set.hpp"

namespace ipos::tools::serve {
namespace {

using signals::Signal;
using runtime::Time;

// A page that is loaded again finds its recording; a drive that nobody looks at is left alone.
constexpr Time kStays = 60 * runtime::kSecond;

// Speed, output current and DC link voltage.
constexpr const char* kFirstOnes[] = {"P000", "P004", "P008"};

}  // namespace

DriveScope::DriveScope(Router& router, Copies& copies, ParameterAccess& access, std::string station, std::function<Time()> now)
    : router_(router),
      access_(access),
      station_(std::move(station)),
      now_(std::move(now)),
      scope_(router, *this, copies) {
  std::vector<std::string> names;
  for (const char* number : kFirstOnes) {
    const stdlib::Parameter* row = stdlib::parameter_table(access_.unit()).find(std::string_view(number + 1));
    if (row == nullptr) continue;
    const AccessReply reply = access_.execute(stdlib::Service::Read, row->index, 0);
    if (reply || !reply.error().code) names.push_back(station_ + "." + number);
  }
  scope_.propose(std::move(names));
  begin();
}

bool DriveScope::begin() {
  try {  // a drive that is silent has its channels none the less; it is asked again
    for (const std::string& name : scope_.names()) find_channels(name);
    scope_.built();
  } catch (const Mistake&) {
    return false;
  }
  return true;
}

bool DriveScope::wanted() {
  scope_.tend();
  bool looks = scope_.waits();
  for (const auto& [number, client] : router_.clients()) looks = looks || client.subscriptions.contains("scope");
  const Time now = now_();
  if (looks) looked_ = now;
  const bool wanted = looks || (was_wanted_ && now - looked_ < kStays);
  if (wanted && !was_wanted_) {
    recorded_ = now;
    if (!begin()) return false;
  }
  was_wanted_ = wanted;
  return wanted;
}

void DriveScope::sample() {
  const auto asked = scope_.asked();
  if (asked.empty()) return;
  const auto index = index_names_.find(asked[next_++ % asked.size()]->name);
  if (index != index_names_.end())
    if (const AccessReply reply = access_.execute(stdlib::Service::Read, index->second, 0)) {
      const stdlib::Parameter* row = stdlib::parameter_table(access_.unit()).find(index->second);
      last_[index->second] = row == nullptr ? int64_t{*reply} : row->number_of(*reply);
    }
  for (const Time now = now_(); recorded_ + runtime::kMillisecond <= now;)
    scope_.passed(recorded_ += runtime::kMillisecond);
}

std::vector<Signal> DriveScope::find_channels(const std::string& name) {
  const std::string prefix = station_ + ".";
  const std::string own = name.starts_with(prefix) ? name.substr(prefix.size()) : name;
  std::vector<Signal> signals;
  for (const LiveItem& item : live_items(access_.unit(), {own}, nullptr, {})) {
    const uint16_t index = item.target.index;
    const stdlib::Parameter* row = item.target.parameter;
    const AccessReply reply = access_.execute(stdlib::Service::Read, index, 0);
    if (!reply)
      throw Mistake(why(stdlib::parameter_table(access_.unit()), stdlib::Service::Read, index, 0, reply.error()));
    last_[index] = row == nullptr ? int64_t{*reply} : row->number_of(*reply);
    Signal signal;
    signal.name = prefix + own;
    signal.station = station_;
    if (row != nullptr) {
      const stdlib::DisplayScale scale = stdlib::display_scale(*row);
      signal.meaning = fmt::format("P{} {}", row->number, row->name);
      signal.unit = row->display == "hex" ? "" : std::string(row->display);
      signal.bits = row->display == "hex" ? 32 : 0;
      signal.parameter = row;
      signal.factor = scale.factor;
      signal.decimals = scale.decimals;
    }
    signal.read = [this, index] { return last_[index]; };
    index_names_[signal.name] = index;
    signals.push_back(std::move(signal));
  }
  return signals;
}

void DriveScope::watch_for(const std::string& kind, const Arguments&) {
  if (kind != "none" && kind != "level" && kind != "edge")
    throw Mistake("'kind' must be none, level or edge: a real drive tells no more over its parameter channel");
}

void DriveScope::stop(const std::string&) {}  // real time goes on

}  // namespace ipos::tools::serve
